//! A supervisor on the bench: a configuration, samples, and what its border promises.

use supervisor::{Command, Config, PlanePositions, Sample, Shaft, Status, Supervisor};

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

/// Length of a force \[N\].
pub fn length(force_n: [f32; 2]) -> f64 {
    f64::hypot(f64::from(force_n[0]), f64::from(force_n[1]))
}

/// Checks a command against the caps and, on axes that act, the slew limit; hands its force on.
///
/// # Errors
/// What is broken.
pub fn check(
    command: &Command,
    last_n: [f32; 2],
    status: Status,
    config: &Config,
) -> Result<[f32; 2], String> {
    let force = command.force_n.map(f64::from);
    let lost = [Status::AXIS_X_LOST, Status::AXIS_Y_LOST].map(|axis| status.contains(axis));
    let cap = f64::from(config.force_max_n);
    let say = |what: &str| Err(format!("{what}: {command:?} after {last_n:?}"));
    if force.iter().any(|f| !f.is_finite()) {
        return say("not finite");
    }
    if length(command.force_n) > cap * (1.0 + 2e-7) {
        return say("beyond the cap");
    }
    let axis_cap = f64::from(config.axis_force_max_n);
    if force.iter().any(|f| f.abs() > axis_cap * (1.0 + 2e-7)) {
        return say("beyond the cap of an axis");
    }
    let mut change = [0.0; 2];
    for axis in 0..2 {
        if lost[axis] {
            if force[axis] != 0.0 {
                return say("force on a lost axis");
            }
        } else {
            change[axis] = force[axis] - f64::from(last_n[axis]);
        }
    }
    let step = f64::from(config.force_slew_n_s) * f64::from(config.sample_period_s);
    // The force itself has only so many digits.
    if f64::hypot(change[0], change[1]) > step * (1.0 + 1e-6) + 3e-7 * cap {
        return say("faster than the slew limit");
    }
    Ok(command.force_n)
}
