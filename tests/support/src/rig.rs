//! A supervisor on the bench: a configuration, samples, and what its border promises.

use supervisor::{
    Command, Config, Events, PlanePositions, RotorSupervisor, Sample, Shaft, Status, Supervisor,
};

/// An AMB rotor: 10 kg, 0.2 mm, 1000 N, 20 kHz; neither caps of the axes nor slew limit nor budget.
pub fn config() -> Config {
    Config {
        observer_pole_flight: 0.6,
        observer_pole_contact: 0.4,
        fault_blend_s: 1e-3,
        fault_ticks: 10.0,
        force_slew_n_s: 1e10,
        continuous_force_n: 1000.0,
        severity_limit: 1e6,
        speed_max_m_s: 2.0,
        ..Config::example()
    }
}

/// The same with a change.
pub fn config_with(change: impl FnOnce(&mut Config)) -> Config {
    let mut config = config();
    change(&mut config);
    config
}

/// A supervisor of the bench.
///
/// # Panics
/// If its configuration is not valid.
pub fn new_supervisor() -> Supervisor<64> {
    Supervisor::new(&config()).unwrap()
}

/// A rotor with this configuration at both ends.
///
/// # Panics
/// If it is not valid.
pub fn new_rotor(config: &Config) -> RotorSupervisor<64> {
    RotorSupervisor::new(&shaft(config), &[*config; 2]).unwrap()
}

/// A gyroscopic rotor whose impacts at either end move the mass of this configuration.
pub fn shaft(config: &Config) -> Shaft {
    let (mass_kg, arm_m) = (2.0 * config.mass_kg, 0.2);
    let end = |place_m: f32| PlanePositions {
        magnet_m: 0.8 * place_m,
        ..all_at(place_m)
    };
    let transverse = mass_kg * arm_m * arm_m;
    Shaft {
        mass_kg,
        transverse_inertia_kg_m2: transverse,
        polar_inertia_kg_m2: 0.8 * transverse,
        places: [end(-arm_m), end(arm_m)],
    }
}

/// A plane of a rotor whose bearing, sensor and magnet are at one place \[m\].
pub fn all_at(place_m: f32) -> PlanePositions {
    PlanePositions {
        retainer_m: place_m,
        sensor_m: place_m,
        magnet_m: place_m,
    }
}

/// A reading of a rotor in the middle: no sensor stands still to the last digit.
pub fn quiet(tick: u32) -> [f32; 2] {
    [1e-6 * (tick % 3) as f32; 2]
}

/// A sample of a bearing that is on, spin counter-clockwise, levitation at rest.
pub fn sample(sequence: u32, position_m: [f32; 2]) -> Sample {
    Sample {
        sequence,
        status: Status::SPIN_VALID | Status::BEARING_ON | Status::LEVITATED_BEFORE,
        position_m,
        spin_rad_s: 1000.0,
        ..Sample::default()
    }
}

/// The same with a change.
pub fn sample_with(
    sequence: u32,
    position_m: [f32; 2],
    change: impl FnOnce(&mut Sample),
) -> Sample {
    let mut sample = sample(sequence, position_m);
    change(&mut sample);
    sample
}

/// A sample under a levitation controller that asks for a force.
pub fn asking(sequence: u32, position_m: [f32; 2], levitation_n: [f32; 2]) -> Sample {
    sample_with(sequence, position_m, |now| now.levitation_n = levitation_n)
}

/// Ticks of a [`landing`] with what comes before and after it.
pub const LANDING_TICKS: u32 = 900;

/// From the middle to the wall and back, once in so many ticks, with the last digits of a sensor \[m\].
pub fn landing(tick: u32) -> [f32; 2] {
    let tick = tick % LANDING_TICKS;
    let out = (3e-5 * tick.saturating_sub(99) as f32).min(2.02e-4);
    let back = (2e-6 * tick.saturating_sub(150) as f32).min(out);
    let noise = 4e-7 * (tick % 3) as f32;
    [out - back + noise, noise]
}

/// Point of a backward whirl (clockwise) at this angle \[rad\].
pub fn on_circle(radius_m: f32, angle: f32) -> [f32; 2] {
    [radius_m * angle.cos(), -radius_m * angle.sin()]
}

/// Radius of a whirl on the wall \[m\].
pub const RADIUS_M: f32 = 2.05e-4;
/// Angle of a whirl in a tick: 0.4 m/s.
pub const WHIRL_STEP: f32 = 0.1;

/// Ticks of a backward whirl, with status bits besides those of [`sample`].
pub fn whirl(
    supervisor: &mut Supervisor<64>,
    ticks: std::ops::Range<u32>,
    status: Status,
) -> Vec<Command> {
    whirl_by(WHIRL_STEP, supervisor, ticks, status)
}

/// The same at another angle in a tick \[rad\].
pub fn whirl_by(
    step: f32,
    supervisor: &mut Supervisor<64>,
    ticks: std::ops::Range<u32>,
    status: Status,
) -> Vec<Command> {
    ticks
        .map(|i| {
            let mut s = sample(i, on_circle(RADIUS_M, step * i as f32));
            s.status |= status;
            supervisor.tick(&s)
        })
        .collect()
}

/// Which of the commands tell one of these events.
pub fn ticks_of(commands: &[Command], events: Events) -> Vec<usize> {
    let told = commands.iter().map(|c| c.events.intersects(events));
    (0..)
        .zip(told)
        .filter_map(|(i, told)| told.then_some(i))
        .collect()
}

/// Checks a value to a share of what it should be.
///
/// # Panics
/// If it is farther off, with both.
#[track_caller]
pub fn close(value: impl Into<f64>, expected: impl Into<f64>, share: f64) {
    let (value, expected) = (value.into(), expected.into());
    assert!((value / expected - 1.0).abs() < share, "{value} {expected}");
}

/// Length of a force \[N\].
pub fn length(force_n: [f32; 2]) -> f64 {
    f64::hypot(f64::from(force_n[0]), f64::from(force_n[1]))
}

/// Length of what two forces differ by \[N\].
pub fn apart(a_n: [f32; 2], b_n: [f32; 2]) -> f64 {
    length([a_n[0] - b_n[0], a_n[1] - b_n[1]])
}
