//! What both examples know of the machine, and no chip: nine numbers of the bearing, scale factors of sensor and magnet, a
//! levitation controller to be replaced, the ledger of landings in memory that keeps it, and the two rules that say when outputs may go on and when the watchdog is fed.
//!
//! All numbers are made up. They fit each other: a rotor of 10 kg in a clearance of 0.2 mm.
#![no_std]
#![forbid(unsafe_code)]

mod landings;
mod levitation;
mod scale;
mod switch;

pub use landings::{
    Landings, MISSING as LANDINGS_MISSING, NOT_COUNTED as LANDINGS_NOT_COUNTED, RETAINED_WORDS,
    RetainedMemory,
};
pub use levitation::Levitation;
pub use scale::{CURRENT_FULL_SCALE_A, Magnets, SENSOR_RANGE_M, position_m, signed_currents_a};
pub use switch::{Liveness, Request, Switch};

use supervisor::{Bearing, Config, IntegratorHint, Sample, Status, Ticker};

/// Rate of the converter's trigger and of the tick \[Hz\].
pub const TICK_HZ: u32 = 20_000;
/// Ticks without a call after which hardware takes the force off the magnets.
pub const TICKS_TO_EXPIRY: u32 = 5;
/// Time without food after which the independent watchdog resets the chip \[ms\].
pub const WATCHDOG_MS: u32 = 50;
/// Ticks that a flight record can replay: 25 ms.
pub const RECORD: usize = 512;

/// From the data sheets of bearing, magnet and sensor.
pub const BEARING: Bearing = Bearing {
    sample_period_s: 1.0 / TICK_HZ as f32,
    mass_kg: 10.0,
    stiffness_n_m: -2e5,
    clearance_m: 2e-4,
    force_max_n: 1000.0,
    amplifier_lag_s: 1.6e-4,
    friction_coefficient: 0.15,
    contact_stiffness_n_m: 1e8,
    sensor_noise_m: 1e-6,
};

/// All other parameters follow, but for what this machine has otherwise.
pub const CONFIG: Config = Config {
    // Outside of it nothing is measured; less 5 %, so that a sensor at its rail is found.
    position_limit: 0.95 * SENSOR_RANGE_M / BEARING.clearance_m,
    // What the magnets pull at most along one axis, where force is still proportional to current.
    axis_force_max_n: Magnets::FORCE_MAX_N,
    // It is simulated: nothing is there to confirm.
    check_first: 0.0,
    ..Config::for_bearing(&BEARING)
};

/// What the control interrupt owns, whatever chip it is on.
pub struct Control {
    supervisor: Ticker<'static, RECORD>,
    levitation: Levitation,
    hint: IntegratorHint,
    late: bool,
}

impl Control {
    /// The half that ticks, after its self-test.
    pub fn new(supervisor: Ticker<'static, RECORD>) -> Self {
        Self {
            supervisor,
            levitation: Levitation::default(),
            hint: IntegratorHint::Run,
            late: false,
        }
    }

    /// A tick: the force to command \[N\]. `sequence` is the number of the conversion that `position_m` is of; `on` says whether
    /// outputs act, as the hardware has it.
    pub fn tick(&mut self, sequence: u32, position_m: [f32; 2], on: bool) -> [f32; 2] {
        // The spin is not measured on this machine: without SPIN_VALID the supervisor works against the whirl that it sees.
        let mut status = Status::empty();
        status.set(Status::BEARING_ON, on);
        status.set(Status::LATE, self.late);
        let levitation_n = self.levitation.force_n(position_m, self.hint);
        let command = self.supervisor.tick(&Sample {
            sequence,
            status,
            position_m,
            // Outputs that are off deliver nothing: this way the model of the delivered force stays true.
            levitation_n: if on { levitation_n } else { [0.0; 2] },
            ..Sample::default()
        });
        self.hint = command.integrator;
        command.force_n
    }

    /// After the command was handed over: whether the instant at which it should have taken effect was over by then.
    pub fn handed_over(&mut self, late: bool) {
        self.late = late;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{BEARING, CONFIG, Control, SENSOR_RANGE_M, TICK_HZ, position_m};
    use std::boxed::Box;
    use supervisor::{Mode, Supervisor};

    /// Readings of a converter of twelve bits.
    fn readings(position_m: [f32; 2]) -> [u16; 2] {
        position_m.map(|m| ((m / (2.0 * SENSOR_RANGE_M) + 0.5) * 4096.0) as u16)
    }

    /// The rotor lies on its retainer bearing with outputs off, is lifted when they go on, and levitates undisturbed.
    #[test]
    fn it_lifts_a_rotor_and_lets_it_be() {
        let supervisor = Box::leak(Box::new(Supervisor::new(&CONFIG).unwrap()));
        let (mut ticker, reader) = supervisor.split();
        assert!(ticker.self_test().passed);
        let mut control = Control::new(ticker);
        let (mut y_m, mut speed_m_s, mut acting_n) = (-BEARING.clearance_m, 0.0, 0.0);
        let mut command_n = 0.0;
        for sequence in 0..2 * TICK_HZ {
            let on = sequence >= TICK_HZ / 10;
            let seen_m = position_m(readings([0.0, y_m]), 4096);
            let [_, next_n] = control.tick(sequence, seen_m, on);
            assert!(on || next_n == 0.0, "{next_n} N while outputs are off");
            // What was commanded before takes effect now; the drive has its lag.
            acting_n += (command_n - acting_n) * BEARING.sample_period_s / BEARING.amplifier_lag_s;
            command_n = next_n;
            let total_n = acting_n - BEARING.stiffness_n_m * y_m - 9.81 * BEARING.mass_kg;
            speed_m_s += total_n / BEARING.mass_kg * BEARING.sample_period_s;
            y_m += speed_m_s * BEARING.sample_period_s;
            if y_m < -BEARING.clearance_m {
                (y_m, speed_m_s) = (-BEARING.clearance_m, 0.0);
            }
        }
        assert!(y_m.abs() < 1e-6, "{y_m} m");
        let report = reader.published().report().unwrap();
        assert_eq!(reader.published().mode(), Mode::Levitated);
        assert_eq!((report.missed_ticks, report.late_ticks), (0, 0));
    }
}
