//! The structs of the header. What comes in holds neither `bool` nor an enum of Rust: C could put a
//! number into them that is no value of theirs.

use crate::layout::{Layout, defined};
use core::ffi::c_char;
use core::mem::offset_of;
use supervisor::{
    Bearing, Command, Mode, PlanePositions, QueuedEvent, Report, RotorCommand, SECTION_BYTES,
    Sample, Shaft, Stamp, Status,
};

/// A struct with the offset of each field, checked at compile time.
macro_rules! c_struct {
    (
        $(#[$doc:meta])*
        $name:ident = $c_name:literal, $size:literal {
            $($(#[$field_doc:meta])* $field:ident: $type:ty = $offset:literal,)*
        }
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Default)]
        #[repr(C)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $type,)*
        }

        impl $name {
            /// Where everything is.
            pub const LAYOUT: Layout = Layout {
                name: $c_name,
                size: $size,
                fields: &[$((stringify!($field), $offset, size_of::<$type>())),*],
            };
        }

        const _: () = {
            assert!(size_of::<$name>() == $size && align_of::<$name>() == 4);
            $(assert!(offset_of!($name, $field) == $offset);)*
        };
    };
}

c_struct! {
    /// What the firmware knows at one sampling instant: [`Sample`].
    CSample = "amb_sample", 36 {
        /// Counts up by one each tick, wrapping.
        sequence: u32 = 0,
        /// Bits of [`Status`]; unknown ones are ignored.
        status: u32 = 4,
        /// Position at the sensor \[m\].
        position_m: [f32; 2] = 8,
        /// Spin \[rad/s\].
        spin_rad_s: f32 = 16,
        /// What the levitation controller wants \[N\].
        levitation_n: [f32; 2] = 20,
        /// What the actuator delivers \[N\].
        applied_n: [f32; 2] = 28,
    }
}

c_struct! {
    /// What to do until the next tick: [`Command`].
    CCommand = "amb_command", 36 {
        /// Force to command \[N\].
        force_n: [f32; 2] = 0,
        /// Force that the supervisor would command \[N\]: another one only in shadow.
        own_n: [f32; 2] = 8,
        /// Backward speed to be expected, over what the cap can arrest.
        severity: f32 = 16,
        /// [`supervisor::Mode`] as a number.
        mode: u32 = 20,
        /// Bits of [`supervisor::Limits`].
        limits: u32 = 24,
        /// Bits of [`supervisor::Events`].
        events: u32 = 28,
        /// [`supervisor::IntegratorHint`] as a number.
        integrator: u32 = 32,
    }
}

c_struct! {
    /// What to do at both ends of a rotor until the next tick: [`RotorCommand`].
    CRotorCommand = "amb_rotor_command", 84 {
        /// Each plane its own.
        planes: [CCommand; 2] = 0,
        /// For each plane, whether the other has engaged since the records were read: 0 or 1.
        other_engaged: [u32; 2] = 72,
        /// Whether a plane has asked for coasting down: 0 or 1.
        coast_down: u32 = 80,
    }
}

c_struct! {
    /// What cannot be guessed of a bearing plane: [`Bearing`].
    CBearing = "amb_bearing", 36 {
        /// Period of the tick \[s\].
        sample_period_s: f32 = 0,
        /// Mass that this plane carries \[kg\].
        mass_kg: f32 = 4,
        /// Shaft stiffness plus the magnets' negative stiffness \[N/m\].
        stiffness_n_m: f32 = 8,
        /// Radial clearance of the retainer bearing \[m\].
        clearance_m: f32 = 12,
        /// Force cap of the magnet \[N\].
        force_max_n: f32 = 16,
        /// Time constant of the amplifier with the magnet \[s\].
        amplifier_lag_s: f32 = 20,
        /// Coefficient of friction on the retainer bearing.
        friction_coefficient: f32 = 24,
        /// Stiffness of the contact \[N/m\].
        contact_stiffness_n_m: f32 = 28,
        /// Noise of the sensor, or its step \[m\].
        sensor_noise_m: f32 = 32,
    }
}

c_struct! {
    /// A rigid rotor: [`Shaft`].
    CShaft = "amb_shaft", 36 {
        /// Mass \[kg\].
        mass_kg: f32 = 0,
        /// Transverse moment of inertia \[kg m²\].
        transverse_inertia_kg_m2: f32 = 4,
        /// Polar moment of inertia \[kg m²\].
        polar_inertia_kg_m2: f32 = 8,
        /// Retainer bearings, from the centre of mass \[m\].
        retainer_m: [f32; 2] = 12,
        /// Sensors \[m\].
        sensor_m: [f32; 2] = 20,
        /// Magnets \[m\].
        magnet_m: [f32; 2] = 28,
    }
}

c_struct! {
    /// An event with its tick: [`QueuedEvent`].
    CEvent = "amb_event", 12 {
        /// Sequence number of the sample.
        sequence: u32 = 0,
        /// Mode after the tick.
        mode: u32 = 4,
        /// Bits of [`supervisor::Events`].
        events: u32 = 8,
    }
}

c_struct! {
    /// What firmware adds to a record: [`Stamp`].
    CStamp = "amb_stamp", 16 {
        /// Which firmware this is.
        firmware: u32 = 0,
        /// Sequence number of the sample at that time.
        at_sequence: u32 = 4,
        /// A clock's time \[µs\], the lower half first.
        time_us: [u32; 2] = 8,
    }
}

impl From<CStamp> for Stamp {
    fn from(stamp: CStamp) -> Self {
        Self {
            firmware: stamp.firmware,
            time_us: whole(stamp.time_us),
            at_sequence: stamp.at_sequence,
        }
    }
}

c_struct! {
    /// What has happened since the supervisor was made: [`Report`].
    CReport = "amb_report", 76 {
        /// Engagements in which the rotor touched.
        landings: u32 = 0,
        /// Touches in them.
        impacts: u32 = 4,
        /// Ticks in contact in them.
        contact_ticks: u32 = 8,
        /// Ticks that were missed.
        missed_ticks: u32 = 12,
        /// Calls with the sequence number of the call before.
        repeated_ticks: u32 = 16,
        /// Commands that came too late.
        late_ticks: u32 = 20,
        /// Whether coasting down was asked for: 0 or 1.
        coast_down: u32 = 24,
        /// [`supervisor::RejectReason`] of the last sample.
        refusal: u32 = 28,
        /// [`supervisor::RejectReason`] that began the last sensor fault.
        fault: u32 = 32,
        /// Fastest normal speed before an impact \[m/s\].
        impact_speed_max_m_s: f32 = 36,
        /// Fastest backward speed in contact \[m/s\].
        backward_speed_max_m_s: f32 = 40,
        /// Highest backward speed that the cap can arrest \[m/s\].
        whirl_limit_m_s: f32 = 44,
        /// Energy borne, over that at the limit.
        severity_index: f32 = 48,
        /// State of the force–time budget.
        thermal_state: f32 = 52,
        /// Force cap now \[N\].
        force_cap_n: f32 = 56,
        /// Engagements without a touch.
        nuisance_engagements: u32 = 60,
        /// Times that the bearing was handed back.
        handed_back: u32 = 64,
        /// What the check has come to: [`supervisor::Finding`].
        finding: u32 = 68,
        /// By how much, as the finding says.
        finding_value: f32 = 72,
    }
}

c_struct! {
    /// Landings of a retainer bearing: [`supervisor::Ledger`].
    CLedger = "amb_ledger", 48 {
        /// The user's number of the bearing.
        bearing: u32 = 0,
        /// How often it has been added to.
        updates: u32 = 4,
        /// Severity that the bearing may bear in all.
        severity_allowed: f32 = 8,
        /// Landings.
        landings: u32 = 12,
        /// Sum of their severities, in millionths, the lower half first.
        severity_millionths: [u32; 2] = 16,
        /// Largest severity of what was added at once.
        worst_severity: f32 = 24,
        /// Fastest normal speed before an impact \[m/s\].
        hardest_impact_m_s: f32 = 28,
        /// Sequence number at which the record froze that was added last.
        closed_at: u32 = 32,
        /// What the supervisor has counted since it was made, as far as it is in here.
        run_landings: u32 = 36,
        /// The same, in millionths, the lower half first.
        run_severity_millionths: [u32; 2] = 40,
    }
}

/// Of a number of 64 bits, the lower half first.
pub(crate) fn whole([low, high]: [u32; 2]) -> u64 {
    u64::from(low) | u64::from(high) << 32
}

/// See [`whole`].
pub(crate) fn halves(x: u64) -> [u32; 2] {
    [x as u32, (x >> 32) as u32]
}

/// A row of the table of parameters; its texts live as long as the program.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CParameter {
    /// Name.
    pub name: *const c_char,
    /// Unit.
    pub unit: *const c_char,
    /// What it is.
    pub text: *const c_char,
    /// Smallest valid value.
    pub low: f32,
    /// Largest valid value.
    pub high: f32,
}

/// A section of a record.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSection {
    /// Bytes that count.
    pub length: u32,
    /// They, and zeros.
    pub bytes: [u8; SECTION_BYTES],
}

impl CSection {
    /// Where everything is.
    pub const LAYOUT: Layout = Layout {
        name: "amb_section",
        size: 740,
        fields: &[("length", 0, 4), ("bytes", 4, SECTION_BYTES)],
    };

    /// Of these bytes, of which a section has no more than there is room for.
    pub(crate) fn new(section: &[u8]) -> Self {
        let mut made = Self {
            length: section.len() as u32,
            bytes: [0; SECTION_BYTES],
        };
        (made.bytes.iter_mut().zip(section)).for_each(|(to, from)| *to = *from);
        made
    }
}

/// Structs without pointers, whose layout is the same everywhere.
pub const LAYOUTS: [Layout; 10] = [
    CBearing::LAYOUT,
    CSample::LAYOUT,
    CCommand::LAYOUT,
    CRotorCommand::LAYOUT,
    CShaft::LAYOUT,
    CEvent::LAYOUT,
    CStamp::LAYOUT,
    CSection::LAYOUT,
    CReport::LAYOUT,
    CLedger::LAYOUT,
];

const _: () = {
    assert!(size_of::<CSection>() == CSection::LAYOUT.size && align_of::<CSection>() == 4);
    assert!(offset_of!(CSection, length) == 0);
    assert!(offset_of!(CSection, bytes) == 4);

    let pointer = size_of::<*const c_char>();
    assert!(offset_of!(CParameter, name) == 0);
    assert!(offset_of!(CParameter, unit) == pointer);
    assert!(offset_of!(CParameter, text) == 2 * pointer);
    assert!(offset_of!(CParameter, low) == 3 * pointer);
    assert!(offset_of!(CParameter, high) == 3 * pointer + 4);
};

// In blocks of few: each searches the header, and the compiler asks what takes long.
const _: () = {
    assert!(defined("AMB_SIZEOF_BEARING") == size_of::<CBearing>());
    assert!(defined("AMB_SIZEOF_SAMPLE") == size_of::<CSample>());
    assert!(defined("AMB_SIZEOF_COMMAND") == size_of::<CCommand>());
    assert!(defined("AMB_SIZEOF_ROTOR_COMMAND") == size_of::<CRotorCommand>());
    assert!(defined("AMB_SIZEOF_SHAFT") == size_of::<CShaft>());
};

const _: () = {
    assert!(defined("AMB_SIZEOF_EVENT") == size_of::<CEvent>());
    assert!(defined("AMB_SIZEOF_STAMP") == size_of::<CStamp>());
    assert!(defined("AMB_SIZEOF_SECTION") == size_of::<CSection>());
    assert!(defined("AMB_SIZEOF_REPORT") == size_of::<CReport>());
    assert!(defined("AMB_SIZEOF_LEDGER") == size_of::<CLedger>());
};

impl From<CSample> for Sample {
    fn from(c: CSample) -> Self {
        Self {
            sequence: c.sequence,
            status: Status::from_bits_truncate(c.status),
            position_m: c.position_m,
            spin_rad_s: c.spin_rad_s,
            levitation_n: c.levitation_n,
            applied_n: c.applied_n,
        }
    }
}

impl From<CBearing> for Bearing {
    fn from(c: CBearing) -> Self {
        Self {
            sample_period_s: c.sample_period_s,
            mass_kg: c.mass_kg,
            stiffness_n_m: c.stiffness_n_m,
            clearance_m: c.clearance_m,
            force_max_n: c.force_max_n,
            amplifier_lag_s: c.amplifier_lag_s,
            friction_coefficient: c.friction_coefficient,
            contact_stiffness_n_m: c.contact_stiffness_n_m,
            sensor_noise_m: c.sensor_noise_m,
        }
    }
}

impl From<CShaft> for Shaft {
    fn from(c: CShaft) -> Self {
        let [retainer, sensor, magnet] = [c.retainer_m, c.sensor_m, c.magnet_m];
        let place = |retainer_m, sensor_m, magnet_m| PlanePositions {
            retainer_m,
            sensor_m,
            magnet_m,
        };
        Self {
            mass_kg: c.mass_kg,
            transverse_inertia_kg_m2: c.transverse_inertia_kg_m2,
            polar_inertia_kg_m2: c.polar_inertia_kg_m2,
            places: [
                place(retainer[0], sensor[0], magnet[0]),
                place(retainer[1], sensor[1], magnet[1]),
            ],
        }
    }
}

impl CCommand {
    /// After an error: so that no old command stays in use.
    pub(crate) const NO_FORCE: Self = Self {
        force_n: [0.0; 2],
        own_n: [0.0; 2],
        severity: 0.0,
        mode: Mode::SensorFault as u32,
        limits: 0,
        events: 0,
        integrator: 0,
    };
}

impl From<RotorCommand> for CRotorCommand {
    fn from(command: RotorCommand) -> Self {
        Self {
            planes: command.planes.map(Into::into),
            other_engaged: command.other_engaged.map(u32::from),
            coast_down: u32::from(command.coast_down),
        }
    }
}

impl From<Command> for CCommand {
    fn from(command: Command) -> Self {
        Self {
            force_n: command.force_n,
            own_n: command.own_n,
            severity: command.severity,
            mode: command.mode as u32,
            limits: command.limits.bits(),
            events: command.events.bits(),
            integrator: command.integrator as u32,
        }
    }
}

impl From<QueuedEvent> for CEvent {
    fn from(event: QueuedEvent) -> Self {
        Self {
            sequence: event.sequence,
            mode: event.mode as u32,
            events: event.events.bits(),
        }
    }
}

impl From<Report> for CReport {
    fn from(report: Report) -> Self {
        Self {
            landings: report.landings,
            impacts: report.impacts,
            contact_ticks: report.contact_ticks,
            missed_ticks: report.missed_ticks,
            repeated_ticks: report.repeated_ticks,
            late_ticks: report.late_ticks,
            coast_down: u32::from(report.coast_down),
            refusal: report.refusal as u32,
            fault: report.fault as u32,
            impact_speed_max_m_s: report.impact_speed_max_m_s,
            backward_speed_max_m_s: report.backward_speed_max_m_s,
            whirl_limit_m_s: report.whirl_limit_m_s,
            severity_index: report.severity_index,
            thermal_state: report.thermal_state,
            force_cap_n: report.force_cap_n,
            nuisance_engagements: report.nuisance_engagements,
            handed_back: report.handed_back,
            finding: report.checked.finding as u32,
            finding_value: report.checked.value,
        }
    }
}
