//! The core on a reading that vibrates whatever the force does, behind the amplifier that it is configured with.

use firmware_bench::scene::suggest::{Nominal, suggested};
use nalgebra::Complex;
use std::collections::VecDeque;
use std::f64::consts::TAU;
use supervisor::{Config, Core, CoreSample, Mode, Prepared, Status};

/// Where the reading would be without its vibration, at a time [s] \[clearances\].
pub(super) type Path = fn(f64, f64) -> [f64; 2];

/// What vibrates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shake {
    pub(super) hz: f64,
    /// \[clearances\]
    pub(super) amplitude: f64,
    /// Unit vector.
    pub(super) along: [f64; 2],
    pub(super) spin_hz: Option<f64>,
}

/// What the force did to it.
#[derive(Debug, Clone)]
pub(super) struct Done {
    /// \[N s/m\]
    pub(super) damping_n_s_m: f64,
    /// Work put into the vibration in a cycle \[caps · clearances\].
    pub(super) work: f64,
    pub(super) modes: Vec<Mode>,
}

/// Time for whatever begins \[s\], and time in which is measured: of a small vibration in flight, and of motion so fast that no
/// engagement is let last with it.
const STARTS_S: f64 = 0.005;
const SMALL: [f64; 3] = [0.02, 0.15, 0.06];
const LARGE: [f64; 3] = [0.005, 0.02, 0.02];
/// What is small \[lift-off speeds\].
const SMALL_SPEED: f64 = 0.3;

/// The suggested configuration, but for a hand-over that comes no sooner than in a second.
pub(super) fn engaged_for_long(nominal: &Nominal) -> Config {
    Config {
        handover_dwell_s: 1.0,
        ..suggested(nominal).config
    }
}

/// The nearest frequency with whole cycles in what is measured.
pub(super) fn whole(hz: f64) -> f64 {
    // Of both times of measuring.
    (hz * 0.02).round().max(1.0) / 0.02
}

/// Runs it. `hz` is taken as a [`whole`] one.
pub(super) fn shaken(config: &Config, path: Path, shake: Shake) -> Done {
    let of = f64::from;
    let (period_s, lag_s) = (of(config.sample_period_s), of(config.amplifier_lag_s));
    let unit_s = of(config.scaling().time_s);
    let rate = TAU * whole(shake.hz);
    let mut core: Core<f64, 64> = Core::new(&Prepared::new(config).unwrap());
    let mut commands = VecDeque::from(vec![0.0; config.delay_samples as usize]);
    let (mut delivered, mut line) = (0.0, Complex::from(0.0));
    let mut done = Done {
        damping_n_s_m: 0.0,
        work: 0.0,
        modes: vec![],
    };
    let [x, y] = path(SMALL[1], unit_s);
    let flies = x.hypot(y) < 0.9;
    let small = flies && shake.amplitude * rate * unit_s < SMALL_SPEED;
    let [grows_s, settled_s, measured_s] = if small { SMALL } else { LARGE };
    let settled = (settled_s / period_s).round() as u32;
    let measured = (measured_s / period_s).round() as u32;
    for tick in 0..settled + measured {
        let at_s = f64::from(tick) * period_s;
        let begun = ((at_s - STARTS_S) / grows_s).clamp(0.0, 1.0);
        let way = begun * shake.amplitude * (rate * at_s).sin();
        let [x, y] = path(at_s, unit_s);
        let [e_x, e_y] = shake.along;
        // A coordinate that stands still is a stuck sensor.
        let dither = if tick % 2 == 0 { 1e-9 } else { -1e-9 };
        let spin = shake.spin_hz.map(|hz| TAU * hz * unit_s);
        let known = spin.map_or(Status::empty(), |_| Status::SPIN_VALID);
        let command = core.tick(&CoreSample {
            sequence: tick,
            status: Status::BEARING_ON | Status::LEVITATED_BEFORE | known,
            position: [x + e_x * way + dither, y + e_y * way + dither],
            spin: spin.unwrap_or_default(),
            // Of a controller that has no force to spare.
            levitation: inwards(x, y),
            applied: [0.0; 2],
        });
        let [f_x, f_y] = command.force;
        commands.push_back(f_x * e_x + f_y * e_y);
        let held = commands.pop_front().unwrap();
        let away = delivered - held;
        let left = if lag_s > 0.0 {
            (-period_s / lag_s).exp()
        } else {
            0.0
        };
        if tick >= settled {
            // Of the whole course of the force in this tick.
            let share =
                |decay: Complex<f64>| (Complex::from(1.0) - (-decay * period_s).exp()) / decay;
            let turn = Complex::new(0.0, rate);
            let mut part = share(turn) * held;
            if lag_s > 0.0 {
                part += share(turn + 1.0 / lag_s) * away;
            }
            line += part * (-turn * at_s).exp();
            if !done.modes.contains(&command.mode) {
                done.modes.push(command.mode);
            }
        }
        delivered = held + away * left;
    }
    // Mean of force · cosine: the speed is amplitude · rate · cosine.
    let mean = line.re / (f64::from(measured) * period_s);
    done.work = TAU * shake.amplitude * mean;
    let speed_m_s =
        shake.amplitude * rate * of(config.clearance_m) / of(config.retainer_plane_ratio);
    done.damping_n_s_m = -2.0 * mean * of(config.force_max_n) / speed_m_s;
    done
}

/// A touch, and back to the middle within 5 ms: Bounce.
pub(super) fn after_a_touch(at_s: f64, _: f64) -> [f64; 2] {
    let share = (at_s / 5e-3).min(1.0);
    [0.51 * (1.0 + (std::f64::consts::PI * share).cos()), 0.0]
}

/// Out faster than the cap can stop, and back without a touch: Approach.
pub(super) fn after_an_approach(at_s: f64, unit_s: f64) -> [f64; 2] {
    let share = (at_s / (1.5 * unit_s)).min(1.0);
    [0.45 * (1.0 - (TAU * share).cos()), 0.0]
}

pub(super) fn on_the_wall(_: f64, _: f64) -> [f64; 2] {
    [1.01, 0.0]
}

/// Round the wall, clockwise, with 0.8 of the lift-off speed.
pub(super) fn round_the_wall(at_s: f64, unit_s: f64) -> [f64; 2] {
    let (sine, cosine) = (0.8 * at_s / unit_s).sin_cos();
    [1.02 * cosine, -1.02 * sine]
}

/// A command of nine tenths of the cap inwards \[caps\].
fn inwards(x: f64, y: f64) -> [f64; 2] {
    let radius = x.hypot(y).max(1e-3);
    [-0.9 * x / radius, -0.9 * y / radius]
}
