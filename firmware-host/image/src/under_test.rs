//! The supervisors that the images run, one for each kind of number.

use crate::wire::{self, CommandBits, Hash, SampleBits};
use supervisor::{
    Command, Config, Core, CoreCommand, CoreSample, HalfTick, Mode, PlanePositions, Prepared, Q,
    RotorCommand, RotorSupervisor, Sample, Shaft, Stamp, Supervisor,
};

/// Ticks of the flight record in floats. Host and image must agree: the tick at which a record freezes is part of
/// a command.
pub const RECORD: usize = 512;
/// The same in fixed point, for a processor with 16 KiB of RAM.
pub const SHORT_RECORD: usize = 32;

/// Floats in SI.
pub type Float = Supervisor<RECORD>;
/// Fixed point per unit: the core alone, behind whatever converts there.
pub type Fixed = Core<Q, SHORT_RECORD>;

/// Floats in SI, of a rotor in two bearing planes.
pub type Pair = RotorSupervisor<RECORD>;

/// The same with a tick in two halves, of which the second is ticked here.
pub struct SecondHalf {
    rotor: Pair,
    first: Option<HalfTick>,
}

/// What can be ticked, and its ticks counted.
pub trait Ticked: Sized {
    /// Bytes of its state without the recorder.
    const RAM_BYTES: usize;
    /// One tick with the recorder's part, as firmware calls it.
    const TICK: fn(&mut Self, &Self::Sample) -> Self::Command;
    /// Its samples.
    type Sample;
    /// What it commands.
    type Command: Default;

    /// A new one; `None` for a configuration that is not valid or does not fit.
    fn new(config: &Config) -> Option<Self>;
    /// Whether this processor computes as it should.
    fn self_test(&mut self) -> bool;
    /// The sample of these bits.
    fn sample(bits: &SampleBits) -> Self::Sample;
    /// What comes before a tick and is no part of it.
    fn prepare(&mut self, _sample: &Self::Sample) {}
    /// Mode after a tick.
    fn mode_of(command: &Self::Command) -> Mode;
    /// What the background of a firmware does between ticks: it drains the events, and a frozen record makes way for
    /// the next one.
    fn background(&mut self);
}

/// A supervisor under test.
pub trait UnderTest: Ticked {
    /// Name of its numbers.
    const NUMBER: &'static str;

    /// The bits of a command.
    fn bits(command: &Self::Command) -> CommandBits;
    /// Takes what it leaves behind into a hash: its report, the events in its queue, its frozen record.
    fn read_out(&mut self, hash: &mut Hash);
    /// Everything else that firmware calls, so that it is linked.
    fn everything_else(&mut self);
}

// The methods have the same names but belong to different types.
macro_rules! served {
    () => {
        fn self_test(&mut self) -> bool {
            Self::ticker(self).self_test().passed
        }
        fn background(&mut self) {
            while Self::next_event(self).is_some() {}
            if Self::record(self).is_some() {
                Self::rearm(self);
            }
        }
    };
}

macro_rules! asked {
    () => {
        fn read_out(&mut self, hash: &mut Hash) {
            wire::add_report(hash, &Self::report(self));
            while let Some(event) = Self::next_event(self) {
                wire::add_event(hash, &event);
            }
            if let Some(record) = Self::record(self) {
                let sections = (0..).map_while(|i| record.section(i, &Stamp::default()));
                sections.for_each(|mut section| hash.add(section.seal()));
            }
        }
        fn everything_else(&mut self) {
            use core::hint::black_box;
            black_box(Self::mode(self));
            black_box(Self::report(self));
            if let Some(event) = Self::next_event(self) {
                black_box(event);
            }
            if let Some(record) = Self::record(self) {
                black_box(record.summary());
                for entry in record.entries() {
                    black_box(entry);
                }
                let sections = (0..).map_while(|i| record.section(i, &Stamp::default()));
                for mut section in sections {
                    black_box(section.seal());
                }
            }
            Self::rearm(self);
        }
    };
}

impl Ticked for Float {
    const RAM_BYTES: usize = size_of::<Self>() - Core::<f32, RECORD>::RECORDER_BYTES;
    const TICK: fn(&mut Self, &Self::Sample) -> Self::Command =
        |supervisor, sample| supervisor.ticker().tick(sample);
    type Sample = Sample;
    type Command = Command;

    fn new(config: &Config) -> Option<Self> {
        Supervisor::new(&fitting(config)).ok()
    }
    fn sample(bits: &SampleBits) -> Sample {
        wire::sample_of_bits(bits)
    }
    fn mode_of(command: &Command) -> Mode {
        command.mode
    }
    served!();
}

impl UnderTest for Float {
    const NUMBER: &'static str = "f32";

    fn bits(command: &Command) -> CommandBits {
        wire::command_bits(command)
    }
    asked!();
}

/// Both planes at once in what is dearest for one of them: the second one's samples are those of the first, turned by
/// half a turn about the centre.
impl Ticked for Pair {
    const RAM_BYTES: usize = size_of::<Self>() - 2 * Core::<f32, RECORD>::RECORDER_BYTES;
    const TICK: fn(&mut Self, &Self::Sample) -> Self::Command =
        |rotor, samples| rotor.ticker().tick(samples);
    type Sample = [Sample; 2];
    type Command = RotorCommand;

    fn new(config: &Config) -> Option<Self> {
        Self::new(&shaft(config), &[fitting(config); 2]).ok()
    }
    fn sample(bits: &SampleBits) -> [Sample; 2] {
        let sample = wire::sample_of_bits(bits);
        [sample, half_a_turn(&sample)]
    }
    fn mode_of(command: &RotorCommand) -> Mode {
        let [first, _] = command.planes;
        first.mode
    }
    fn self_test(&mut self) -> bool {
        Self::ticker(self).self_test().passed
    }
    fn background(&mut self) {
        for end in [0, 1] {
            while self.plane(end).next_event().is_some() {}
        }
        self.collect(|_, _| ());
    }
}

impl Ticked for SecondHalf {
    const RAM_BYTES: usize = Pair::RAM_BYTES + size_of::<HalfTick>();
    const TICK: fn(&mut Self, &Self::Sample) -> Self::Command =
        |halves, [_, sample]| match &halves.first {
            Some(first) => halves.rotor.ticker().tick_second(first, sample),
            None => RotorCommand::default(),
        };
    type Sample = [Sample; 2];
    type Command = RotorCommand;

    fn new(config: &Config) -> Option<Self> {
        let rotor = <Pair as Ticked>::new(config)?;
        Some(Self { rotor, first: None })
    }
    fn sample(bits: &SampleBits) -> [Sample; 2] {
        Pair::sample(bits)
    }
    fn prepare(&mut self, [sample, _]: &[Sample; 2]) {
        self.first = Some(self.rotor.ticker().tick_first(sample));
    }
    fn mode_of(command: &RotorCommand) -> Mode {
        Pair::mode_of(command)
    }
    fn self_test(&mut self) -> bool {
        Ticked::self_test(&mut self.rotor)
    }
    fn background(&mut self) {
        self.rotor.background();
    }
}

/// A supervisor without a thermal budget refuses one.
fn fitting(config: &Config) -> Config {
    let continuous_force_n = if cfg!(feature = "all-parts") {
        config.continuous_force_n
    } else {
        config.force_max_n
    };
    Config {
        continuous_force_n,
        ..*config
    }
}

/// A gyroscopic rotor whose impacts at either end move the mass of this configuration.
pub fn shaft(config: &Config) -> Shaft {
    let (mass_kg, arm_m) = (2.0 * config.mass_kg, 0.2);
    let end = |place_m: f32| PlanePositions {
        retainer_m: place_m,
        sensor_m: place_m,
        magnet_m: 0.8 * place_m,
    };
    let transverse = mass_kg * arm_m * arm_m;
    Shaft {
        mass_kg,
        transverse_inertia_kg_m2: transverse,
        polar_inertia_kg_m2: 0.8 * transverse,
        places: [end(-arm_m), end(arm_m)],
    }
}

/// The same seen from the other side.
pub fn half_a_turn(sample: &Sample) -> Sample {
    let turned = |v: [f32; 2]| v.map(|x| -x);
    Sample {
        position_m: turned(sample.position_m),
        levitation_n: turned(sample.levitation_n),
        applied_n: turned(sample.applied_n),
        ..*sample
    }
}

impl Ticked for Fixed {
    const RAM_BYTES: usize = size_of::<Self>() - Self::RECORDER_BYTES;
    const TICK: fn(&mut Self, &Self::Sample) -> Self::Command =
        |core, sample| core.ticker().tick(sample);
    type Sample = CoreSample<Q>;
    type Command = CoreCommand<Q>;

    fn new(config: &Config) -> Option<Self> {
        let prepared = Prepared::new(&fitting(config)).ok()?;
        Some(Core::new(&prepared))
    }
    fn sample(bits: &SampleBits) -> CoreSample<Q> {
        wire::core_sample_of_bits(bits)
    }
    fn mode_of(command: &CoreCommand<Q>) -> Mode {
        command.mode
    }
    served!();
}

impl UnderTest for Fixed {
    const NUMBER: &'static str = "Q";

    fn bits(command: &CoreCommand<Q>) -> CommandBits {
        wire::core_command_bits(command)
    }
    asked!();
}
