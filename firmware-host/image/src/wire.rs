//! Samples, commands and configurations as bytes, little-endian, field by field.
//!
//! The one place that knows the fields: each struct is taken apart by name, so that a field that is added
//! to the supervisor's border does not compile here until it has a place in the bytes.
//!
//! A recorded stream is a [`Header`], then for each segment a [`Segment`] and its ticks. A tick is
//! a sample and the command that the host gave to it, [`TICK_BYTES`] in all. Numbers go by their bits, so that
//! floats in SI and fixed point per unit have the same layout.

use supervisor::{
    Command, Config, CoreCommand, CoreSample, Events, IntegratorHint, Limits, Mode, PARAMETERS, Q,
    QueuedEvent, Report, Sample, Status,
};

pub const SAMPLE_BYTES: usize = 36;
pub const COMMAND_BYTES: usize = 30;
/// Bytes of a tick in a stream.
pub const TICK_BYTES: usize = SAMPLE_BYTES + COMMAND_BYTES;
/// Bytes of a configuration.
pub const CONFIG_BYTES: usize = 4 * PARAMETERS.len();
pub const HEADER_BYTES: usize = 8;
pub const SEGMENT_BYTES: usize = CONFIG_BYTES + 4;
/// First bytes of a stream; the last of them is the version of the layout.
const MAGIC: [u8; 4] = *b"AWS\x01";

/// Beginning of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Segments that follow.
    pub segments: u32,
}

/// Beginning of a segment: a new supervisor, and how many ticks it gets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Its configuration.
    pub config: Config,
    /// Ticks that follow.
    pub ticks: u32,
}

/// Writes values one after the other. What does not fit is dropped, which the constants above rule out.
struct Writer<'a> {
    rest: &'a mut [u8],
}

impl Writer<'_> {
    fn write<const N: usize>(&mut self, bytes: [u8; N]) {
        if let Some((head, rest)) = core::mem::take(&mut self.rest).split_first_chunk_mut() {
            *head = bytes;
            self.rest = rest;
        }
    }
    fn word(&mut self, value: u32) {
        self.write(value.to_le_bytes());
    }
    fn pair(&mut self, [x, y]: [u32; 2]) {
        self.word(x);
        self.word(y);
    }
}

/// Reads them back; zero beyond the end, which the constants above rule out.
struct Reader<'a> {
    rest: &'a [u8],
}

impl Reader<'_> {
    fn read<const N: usize>(&mut self) -> [u8; N] {
        let Some((head, rest)) = self.rest.split_first_chunk() else {
            return [0; N];
        };
        self.rest = rest;
        *head
    }
    fn word(&mut self) -> u32 {
        u32::from_le_bytes(self.read())
    }
    fn pair(&mut self) -> [u32; 2] {
        let x = self.word();
        [x, self.word()]
    }
    fn byte(&mut self) -> u8 {
        let [byte] = self.read();
        byte
    }
}

/// A sample of numbers by their bits, whatever the numbers are.
pub type SampleBits = CoreSample<u32>;
/// A command of numbers by their bits.
pub type CommandBits = CoreCommand<u32>;

pub fn sample_bits(sample: &Sample) -> SampleBits {
    let Sample {
        sequence,
        status,
        position_m,
        spin_rad_s,
        levitation_n,
        applied_n,
    } = *sample;
    CoreSample {
        sequence,
        status,
        position: position_m.map(f32::to_bits),
        spin: spin_rad_s.to_bits(),
        levitation: levitation_n.map(f32::to_bits),
        applied: applied_n.map(f32::to_bits),
    }
}

/// The sample of these bits.
pub fn sample_of_bits(bits: &SampleBits) -> Sample {
    Sample {
        sequence: bits.sequence,
        status: bits.status,
        position_m: bits.position.map(f32::from_bits),
        spin_rad_s: f32::from_bits(bits.spin),
        levitation_n: bits.levitation.map(f32::from_bits),
        applied_n: bits.applied.map(f32::from_bits),
    }
}

pub fn command_bits(command: &Command) -> CommandBits {
    let Command {
        force_n,
        own_n,
        mode,
        limits,
        events,
        integrator,
        severity,
    } = *command;
    CoreCommand {
        force: force_n.map(f32::to_bits),
        own: own_n.map(f32::to_bits),
        mode,
        limits,
        events,
        integrator,
        severity: severity.to_bits(),
    }
}

/// The command of these bits.
pub fn command_of_bits(bits: &CommandBits) -> Command {
    Command {
        force_n: bits.force.map(f32::from_bits),
        own_n: bits.own.map(f32::from_bits),
        mode: bits.mode,
        limits: bits.limits,
        events: bits.events,
        integrator: bits.integrator,
        severity: f32::from_bits(bits.severity),
    }
}

const fn q_bits(q: Q) -> u32 {
    q.to_bits() as u32
}

const fn q_of_bits(bits: u32) -> Q {
    Q::from_bits(bits as i32)
}

/// The bits of a sample in fixed point.
pub fn core_sample_bits(sample: &CoreSample<Q>) -> SampleBits {
    CoreSample {
        sequence: sample.sequence,
        status: sample.status,
        position: sample.position.map(q_bits),
        spin: q_bits(sample.spin),
        levitation: sample.levitation.map(q_bits),
        applied: sample.applied.map(q_bits),
    }
}

/// The sample in fixed point of these bits.
pub fn core_sample_of_bits(bits: &SampleBits) -> CoreSample<Q> {
    CoreSample {
        sequence: bits.sequence,
        status: bits.status,
        position: bits.position.map(q_of_bits),
        spin: q_of_bits(bits.spin),
        levitation: bits.levitation.map(q_of_bits),
        applied: bits.applied.map(q_of_bits),
    }
}

/// The bits of a command in fixed point.
pub fn core_command_bits(command: &CoreCommand<Q>) -> CommandBits {
    CoreCommand {
        force: command.force.map(q_bits),
        own: command.own.map(q_bits),
        mode: command.mode,
        limits: command.limits,
        events: command.events,
        integrator: command.integrator,
        severity: q_bits(command.severity),
    }
}

/// A sample as bytes.
pub fn encode_sample(sample: &SampleBits, bytes: &mut [u8; SAMPLE_BYTES]) {
    let CoreSample {
        sequence,
        status,
        position,
        spin,
        levitation,
        applied,
    } = *sample;
    let mut writer = Writer { rest: bytes };
    writer.word(sequence);
    writer.word(status.bits());
    writer.pair(position);
    writer.word(spin);
    writer.pair(levitation);
    writer.pair(applied);
}

/// The sample of these bytes.
pub fn sample_of(bytes: &[u8; SAMPLE_BYTES]) -> SampleBits {
    let mut reader = Reader { rest: bytes };
    CoreSample {
        sequence: reader.word(),
        status: Status::from_bits_retain(reader.word()),
        position: reader.pair(),
        spin: reader.word(),
        levitation: reader.pair(),
        applied: reader.pair(),
    }
}

/// A command as bytes.
pub fn encode_command(command: &CommandBits, bytes: &mut [u8; COMMAND_BYTES]) {
    let CoreCommand {
        force,
        own,
        mode,
        limits,
        events,
        integrator,
        severity,
    } = *command;
    let mut writer = Writer { rest: bytes };
    writer.pair(force);
    writer.pair(own);
    writer.word(limits.bits());
    writer.word(events.bits());
    writer.word(severity);
    writer.write([mode as u8]);
    writer.write([integrator as u8]);
}

/// The command of these bytes; `None` where they are none.
pub fn command_of(bytes: &[u8; COMMAND_BYTES]) -> Option<CommandBits> {
    let mut reader = Reader { rest: bytes };
    Some(CoreCommand {
        force: reader.pair(),
        own: reader.pair(),
        limits: Limits::from_bits(reader.word())?,
        events: Events::from_bits(reader.word())?,
        severity: reader.word(),
        mode: mode_of(reader.byte())?,
        integrator: match reader.byte() {
            0 => IntegratorHint::Run,
            1 => IntegratorHint::Hold,
            _ => return None,
        },
    })
}

/// Every mode, in the order of their numbers.
pub const MODES: [Mode; 8] = [
    Mode::Levitated,
    Mode::Approach,
    Mode::Bounce,
    Mode::BackwardWhirl,
    Mode::Pinned,
    Mode::Handover,
    Mode::SensorFault,
    Mode::HandedBack,
];

/// The mode of a number.
pub fn mode_of(number: u8) -> Option<Mode> {
    MODES.into_iter().find(|mode| *mode as u8 == number)
}

/// A configuration as bytes.
pub fn encode_config(config: &Config, bytes: &mut [u8; CONFIG_BYTES]) {
    let mut writer = Writer { rest: bytes };
    for value in config.values() {
        writer.word(value.to_bits());
    }
}

/// The configuration of these bytes, valid or not.
pub fn config_of(bytes: &[u8; CONFIG_BYTES]) -> Config {
    let mut reader = Reader { rest: bytes };
    Config::from_values(core::array::from_fn(|_| f32::from_bits(reader.word())))
}

/// A header as bytes.
pub fn encode_header(header: Header, bytes: &mut [u8; HEADER_BYTES]) {
    let mut writer = Writer { rest: bytes };
    writer.write(MAGIC);
    writer.word(header.segments);
}

/// The header of these bytes; `None` where they begin no stream of this layout.
pub fn header_of(bytes: &[u8; HEADER_BYTES]) -> Option<Header> {
    let mut reader = Reader { rest: bytes };
    (reader.read() == MAGIC).then(|| Header {
        segments: reader.word(),
    })
}

/// The beginning of a segment as bytes.
pub fn encode_segment(segment: &Segment, bytes: &mut [u8; SEGMENT_BYTES]) {
    if let Some((config, rest)) = bytes.split_first_chunk_mut() {
        encode_config(&segment.config, config);
        Writer { rest }.word(segment.ticks);
    }
}

/// The beginning of a segment of these bytes.
pub fn segment_of(bytes: &[u8; SEGMENT_BYTES]) -> Option<Segment> {
    let (config, rest) = bytes.split_first_chunk()?;
    Some(Segment {
        config: config_of(config),
        ticks: Reader { rest }.word(),
    })
}

/// Takes every field of a report into a hash.
pub fn add_report(hash: &mut Hash, report: &Report) {
    let Report {
        landings,
        nuisance_engagements,
        handed_back,
        impacts,
        contact_ticks,
        impact_speed_max_m_s,
        backward_speed_max_m_s,
        whirl_limit_m_s,
        severity_index,
        coast_down,
        thermal_state,
        force_cap_n,
        missed_ticks,
        repeated_ticks,
        late_ticks,
        refusal,
        fault,
        checked,
    } = *report;
    for counter in [
        landings,
        nuisance_engagements,
        handed_back,
        impacts,
        contact_ticks,
        missed_ticks,
        repeated_ticks,
        late_ticks,
    ] {
        hash.add(&counter.to_le_bytes());
    }
    for number in [
        impact_speed_max_m_s,
        backward_speed_max_m_s,
        whirl_limit_m_s,
        severity_index,
        thermal_state,
        force_cap_n,
    ] {
        hash.add(&number.to_bits().to_le_bytes());
    }
    hash.add(&[
        u8::from(coast_down),
        refusal as u8,
        fault as u8,
        checked.finding as u8,
    ]);
    hash.add(&checked.value.to_bits().to_le_bytes());
}

/// Takes an event of the queue into a hash.
pub fn add_event(hash: &mut Hash, event: &QueuedEvent) {
    let QueuedEvent {
        sequence,
        mode,
        events,
    } = *event;
    hash.add(&sequence.to_le_bytes());
    hash.add(&events.bits().to_le_bytes());
    hash.add(&[mode as u8]);
}

/// Hash over commands (FNV-1a, 64 bits): one number that says whether two runs did the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hash(pub u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// Takes bytes in.
    pub fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
