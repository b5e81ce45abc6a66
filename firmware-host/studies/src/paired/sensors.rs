//! How the machine's sensors are, beside what the supervisor is configured for.

use super::row::AS_CONFIGURED;
use super::written_events::BEGIN_S;
use crate::machines::draw::Draw;
use firmware_bench::device::axis::Axis;
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::scene::Scene;
use std::f64::consts::TAU;

/// Kinds of sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sensors {
    AsConfigured,
    /// So many times the noise.
    Noise(f64),
    /// Runout of one axis, at the spin times a harmonic; its speed in √(F·c/m), its amplitude at most 10 % of the clearance.
    Runout(f64),
    /// The same in both axes, out of phase and of different size.
    EllipticRunout,
    /// The same at twice or three times the spin.
    Harmonic,
    /// Hum of 5 % of the clearance at 50 to 180 Hz.
    Hum,
    /// Single samples that are off by 0.03 to 1 clearance, 50 to 300 a second.
    Spikes,
    /// A converter with steps of 1 to 3 % of the clearance.
    Coarse,
    /// Two faults for 1 to 20 ms each, within 40 ms around what happens.
    FaultPair,
    /// One coordinate reads zero for 2 to 20 ms around what happens.
    Zero,
    /// One coordinate sticks for as long.
    Stuck,
    /// One reads zero, the other sticks.
    ZeroAndStuck,
}

impl Sensors {
    /// As configured, and what wears, hums or fails.
    pub const WORSE: [Self; 13] = [
        Self::AsConfigured,
        Self::Noise(3.0),
        Self::Noise(5.0),
        Self::Noise(10.0),
        Self::Noise(20.0),
        Self::Runout(0.5),
        Self::Runout(3.0),
        Self::EllipticRunout,
        Self::Harmonic,
        Self::Hum,
        Self::Spikes,
        Self::Coarse,
        Self::FaultPair,
    ];

    /// Coordinates that fail around what happens.
    pub(crate) const FAILING: [Self; 3] = [Self::Zero, Self::Stuck, Self::ZeroAndStuck];

    /// Name in tables.
    pub fn name(self) -> String {
        match self {
            Self::AsConfigured => AS_CONFIGURED.to_owned(),
            Self::Noise(factor) => format!("noise × {factor}"),
            Self::Runout(speed) => format!("runout of one axis, up to {speed} √(Fc/m)"),
            Self::EllipticRunout => "elliptic runout".to_owned(),
            Self::Harmonic => "runout at 2 and 3 times the spin".to_owned(),
            Self::Hum => "hum".to_owned(),
            Self::Spikes => "spikes".to_owned(),
            Self::Coarse => "coarse converter".to_owned(),
            Self::FaultPair => "pair of faults".to_owned(),
            Self::Zero => "one coordinate zero".to_owned(),
            Self::Stuck => "one coordinate stuck".to_owned(),
            Self::ZeroAndStuck => "one coordinate zero, one stuck".to_owned(),
        }
    }

    /// Lets it be so in a plane.
    pub fn apply(self, draw: &mut Draw, scene: &mut Scene, plane: usize) {
        let faults = self.faults(draw, (scene, plane));
        scene.planes[plane].faults.extend(faults);
    }

    fn faults(self, draw: &mut Draw, at: (&Scene, usize)) -> Vec<Fault> {
        let (scene, plane) = at;
        let c = scene.clearance_m(plane);
        let for_good = |kind, axis| Fault {
            start_s: 0.0,
            duration_s: scene.duration_s + 1.0,
            kind,
            axis,
        };
        let mut faults = Vec::new();
        match self {
            Self::AsConfigured => {}
            Self::Noise(factor) => {
                faults.push(for_good(FaultKind::Noise(factor), Axis::Both));
            }
            Self::Runout(speed) => {
                let speed = draw.between(0.5, 1.0) * speed;
                let axis = draw.one_of(&[Axis::X, Axis::Y]);
                runout(&mut faults, at, (1.0, speed, draw.angle_rad()), axis);
            }
            Self::EllipticRunout => {
                let speed = draw.between(0.3, 2.0);
                let phase = draw.angle_rad();
                runout(&mut faults, at, (1.0, speed, phase), Axis::X);
                let other = phase + draw.angle_rad();
                let share = draw.between(0.2, 1.0);
                runout(&mut faults, at, (1.0, share * speed, other), Axis::Y);
            }
            Self::Harmonic => {
                let speed = draw.between(0.3, 1.5);
                let times = draw.one_of(&[2.0, 3.0]);
                let axis = draw.one_of(&[Axis::X, Axis::Y]);
                runout(&mut faults, at, (times, speed, draw.angle_rad()), axis);
            }
            Self::Hum => {
                let kind = FaultKind::Oscillation {
                    frequency_hz: draw.one_of(&[50.0, 60.0, 100.0, 150.0, 180.0]),
                    amplitude_m: 0.05 * c,
                };
                let axis = draw.one_of(&[Axis::X, Axis::Y, Axis::Both]);
                faults.push(for_good(kind, axis));
            }
            Self::Spikes => {
                let kind = FaultKind::Spikes {
                    rate_hz: draw.decades(50.0, 300.0),
                    size_m: c * draw.decades(0.03, 1.0),
                };
                let axis = draw.one_of(&[Axis::X, Axis::Y, Axis::Both]);
                faults.push(for_good(kind, axis));
            }
            Self::Coarse => {
                let step = draw.decades(0.01, 0.03);
                let bits = (8.0 / step).log2().round() as u32;
                faults.push(for_good(FaultKind::Bits(bits), Axis::Both));
            }
            Self::FaultPair => {
                for _ in 0..2 {
                    let kind = draw.one_of(&[
                        FaultKind::Nan,
                        FaultKind::Zero,
                        FaultKind::Rail,
                        FaultKind::Stuck,
                        FaultKind::Offset(0.2 * c),
                        FaultKind::Gain(1.5),
                        FaultKind::Noise(20.0),
                        FaultKind::Dropout,
                        FaultKind::Delay(3),
                    ]);
                    let axis = match draw.one_of(&[Axis::X, Axis::Y, Axis::Both]) {
                        _ if kind.concerns_both() => Axis::Both,
                        axis => axis,
                    };
                    faults.push(Fault {
                        start_s: BEGIN_S + draw.between(-0.02, 0.02),
                        duration_s: draw.decades(1e-3, 0.02),
                        kind,
                        axis,
                    });
                }
            }
            Self::Zero => fail(&mut faults, draw, &[FaultKind::Zero]),
            Self::Stuck => fail(&mut faults, draw, &[FaultKind::Stuck]),
            Self::ZeroAndStuck => fail(&mut faults, draw, &[FaultKind::Zero, FaultKind::Stuck]),
        }
        faults
    }
}

/// Lets coordinates fail around what happens, each in one way.
fn fail(faults: &mut Vec<Fault>, draw: &mut Draw, kinds: &[FaultKind]) {
    let mut axes = draw
        .one_of(&[[Axis::X, Axis::Y], [Axis::Y, Axis::X]])
        .into_iter();
    for kind in kinds {
        let duration_s = draw.between(2e-3, 0.02);
        faults.push(Fault {
            start_s: BEGIN_S - draw.between(0.0, 1.0) * duration_s,
            duration_s,
            kind: *kind,
            axis: axes.next().unwrap_or_default(),
        });
    }
}

/// Steps in which runout grows: a machine runs up to its speed.
const STEPS: usize = 16;
/// Time in which it does \[s\].
const GROWS_S: f64 = 0.1;

/// Runout that grows from nothing: harmonic, speed in √(F·c/m), phase \[rad\].
fn runout(
    faults: &mut Vec<Fault>,
    (scene, plane): (&Scene, usize),
    (times, speed, phase): (f64, f64, f64),
    axis: Axis,
) {
    let frequency_hz = (times * scene.start.spin_rad_s / TAU).abs();
    let speed_m_s = speed * scene.planes[plane].nominal.force_speed_m_s();
    let amplitude_m = (speed_m_s / (TAU * frequency_hz)).min(0.1 * scene.clearance_m(plane));
    // Steps of a whole number of periods, so that all are in phase.
    let periods = (GROWS_S / STEPS as f64 * frequency_hz).ceil().max(1.0);
    for step in 0..STEPS {
        faults.push(Fault {
            start_s: (phase / TAU + step as f64 * periods) / frequency_hz,
            duration_s: scene.duration_s + 1.0,
            kind: FaultKind::Oscillation {
                frequency_hz,
                amplitude_m: amplitude_m / STEPS as f64,
            },
            axis,
        });
    }
}
