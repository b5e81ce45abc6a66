//! What else happens to the catalogue's whole rotors than blows and overloads.

use super::plants::{Blow, OVERLOAD, RotorPlant};
use crate::overloads::takeover::{arrest_of, lost_beyond_m_s};
use firmware_bench::device::actuator::{Delivers, Outage};
use firmware_bench::device::axis::Axis;
use firmware_bench::device::loads::{BaseMotion, Shape, TimedChange};
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use plant_model::analysis::arrest::circle_radius_m;
use plant_model::machine::params::Unbalance;
use plant_model::params::SpinParams;
use plant_model::{Change, V2};
use std::f64::consts::{PI, TAU};

const G_M_S2: f64 = 9.81;
/// When things begin that happen to a rotor at rest \[s\].
const BEGIN_S: f64 = 0.02;
/// When they begin after a blow: it has touched by then, and is not back \[s\].
const STRUCK_S: f64 = 2e-3;
/// What is left to come back in \[s\].
const AFTER_S: f64 = 0.25;
/// Blow under which something else happens, over the hardest that the file's loop alone recovers from.
const BLOW: f64 = 0.7;
/// Spins of the run-down \[Hz\], from the first or the plant's own, and how long it takes \[s\].
const SPIN_DOWN_HZ: (f64, f64) = (200.0, 8.0);
const SPIN_DOWN_S: f64 = 0.6;
/// Orbit of the first plane far above the criticals of that run-down, over the clearance.
const SPIN_DOWN_ORBIT: f64 = 0.35;

/// Something that happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Incident {
    /// The first magnet is lost for so many ms, and known to be, from rest.
    MagnetLost(u32),
    /// The same after a blow.
    MagnetLostStruck(u32),
    /// Its x axis after a blow.
    AxisLostStruck(u32),
    /// The first sensor reads no number for so many ms, from rest.
    SensorLost(u32),
    /// The same after a blow.
    SensorLostStruck(u32),
    /// An unbalance at the first plane, whose force is so many percent of the cap, for 100 ms.
    BladeLost(u32),
    /// The same until the end.
    BladeLostForGood(u32),
    /// An unbalance at the first plane, whose orbit far above the criticals is so many percent of the clearance; the drive trips
    /// and brakes the rotor through them.
    BladeLostSpinDown(u32),
    /// A half sine of the base: g, ms.
    Shock(u32, u32),
    /// No power for so many ms, known, with the weight fed forward before and after.
    PowerGone(u32),
    /// Backward whirl of both ends alike at take-over, at so many percent of what the cap can stop.
    Cylindrical(u32),
    /// Of both ends against each other.
    Conical(u32),
    /// A blow with runout of both sensors of so many percent of the clearance, against each other.
    Runout(u32),
    /// A blow with both retainers off the centre by so many percent of the clearance, against each other, not configured.
    Misaligned(u32),
    /// The spin falls through the criticals of the levitated rotor with an unbalance at the first plane.
    SpinDown,
    /// A blow at the centre with a seal in the middle, of so many percent of the clearance of the retainer bearings.
    SealStruck(u32),
    /// An overload there.
    SealOverloaded(u32),
}

/// The hardest blows \[m/s\] that the file's loop alone recovers from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hardest {
    /// At the first end.
    pub end_m_s: f64,
    pub centre_m_s: f64,
}

impl Incident {
    pub const ALL: [Self; 31] = [
        Self::MagnetLost(20),
        Self::MagnetLost(100),
        Self::MagnetLostStruck(20),
        Self::AxisLostStruck(20),
        Self::SensorLost(5),
        Self::SensorLost(20),
        Self::SensorLostStruck(5),
        Self::SensorLostStruck(20),
        Self::BladeLost(50),
        Self::BladeLost(120),
        Self::BladeLostForGood(50),
        Self::BladeLostSpinDown(40),
        Self::BladeLostSpinDown(70),
        Self::Shock(5, 30),
        Self::Shock(15, 11),
        Self::Shock(30, 6),
        Self::PowerGone(10),
        Self::PowerGone(30),
        Self::PowerGone(100),
        Self::Cylindrical(50),
        Self::Cylindrical(85),
        Self::Conical(50),
        Self::Conical(85),
        Self::Runout(10),
        Self::Misaligned(10),
        Self::Misaligned(20),
        Self::SpinDown,
        Self::SealStruck(60),
        Self::SealStruck(80),
        Self::SealOverloaded(60),
        Self::SealOverloaded(80),
    ];

    /// In words.
    pub fn name(self) -> String {
        match self {
            Self::MagnetLost(ms) => format!("one magnet lost for {ms} ms"),
            Self::MagnetLostStruck(ms) => format!("blow, one magnet lost for {ms} ms"),
            Self::AxisLostStruck(ms) => format!("blow, one axis lost for {ms} ms"),
            Self::SensorLost(ms) => format!("one sensor lost for {ms} ms"),
            Self::SensorLostStruck(ms) => format!("blow, one sensor lost for {ms} ms"),
            Self::BladeLost(percent) => format!("blade lost, {percent} % of a cap for 100 ms"),
            Self::BladeLostForGood(percent) => format!("blade lost, {percent} % of a cap for good"),
            Self::BladeLostSpinDown(percent) => {
                format!("blade lost, orbit of {percent} % of c, and spun down")
            }
            Self::Shock(g, ms) => format!("shock of {g} g, {ms} ms"),
            Self::PowerGone(ms) => format!("power gone for {ms} ms"),
            Self::Cylindrical(percent) => format!("cylindrical whirl, {percent} % of v_lim"),
            Self::Conical(percent) => format!("conical whirl, {percent} % of v_lim"),
            Self::Runout(percent) => format!("blow, runout of {percent} % of c"),
            Self::Misaligned(percent) => format!("blow, retainers {percent} % of c off"),
            Self::SpinDown => "spin-down through the criticals".to_owned(),
            Self::SealStruck(percent) => format!("blow, seal of {percent} % of c between"),
            Self::SealOverloaded(percent) => format!("overload, seal of {percent} % of c between"),
        }
    }

    /// The scene in which it happens, in this direction \[rad\] and with other noise.
    ///
    /// # Errors
    /// [`SceneError`] of a plant that takes no seal.
    pub fn scene(
        self,
        plant: &RotorPlant,
        hardest: Hardest,
        (angle_rad, seed): (f64, u64),
    ) -> Result<Scene, SceneError> {
        let struck = || plant.struck(Blow::End(0), BLOW * hardest.end_m_s, angle_rad, seed);
        // From rest, not in the very middle.
        let resting = || plant.struck(Blow::End(0), 1e-3, angle_rad, seed);
        let (sin, cos) = angle_rad.sin_cos();
        let along = V2::new(cos, sin);
        let seconds = |ms: u32| 1e-3 * f64::from(ms);
        let share = |percent: u32| 0.01 * f64::from(percent);
        Ok(match self {
            Self::MagnetLost(ms) => {
                without_force(resting(), (BEGIN_S, seconds(ms)), Axis::Both, 0..1)
            }
            Self::MagnetLostStruck(ms) => {
                without_force(struck(), (STRUCK_S, seconds(ms)), Axis::Both, 0..1)
            }
            Self::AxisLostStruck(ms) => {
                without_force(struck(), (STRUCK_S, seconds(ms)), Axis::X, 0..1)
            }
            Self::SensorLost(ms) => without_reading(resting(), (BEGIN_S, seconds(ms))),
            Self::SensorLostStruck(ms) => without_reading(struck(), (STRUCK_S, seconds(ms))),
            Self::BladeLost(percent) => {
                blade_lost(resting(), (share(percent), angle_rad), Some(0.1))
            }
            Self::BladeLostForGood(percent) => {
                blade_lost(resting(), (share(percent), angle_rad), None)
            }
            Self::BladeLostSpinDown(percent) => {
                blade_lost_and_spun_down(resting(), (share(percent), angle_rad))
            }
            Self::Shock(g, ms) => shaken(
                resting(),
                &BaseMotion {
                    start_s: BEGIN_S,
                    duration_s: seconds(ms),
                    acceleration_m_s2: f64::from(g) * G_M_S2 * along,
                    shape: Shape::HalfSine,
                },
            ),
            Self::PowerGone(ms) => without_force(
                with_weight(resting()),
                (BEGIN_S, seconds(ms)),
                Axis::Both,
                0..2,
            ),
            Self::Cylindrical(percent) => whirling(resting(), share(percent), along, false),
            Self::Conical(percent) => whirling(resting(), share(percent), along, true),
            Self::Runout(percent) => {
                let mut scene = struck();
                for (plane, phase_rad) in [0.0, TAU / 2.0].into_iter().enumerate() {
                    let runout_m = share(percent) * scene.clearance_m(plane);
                    let sensor = &mut scene.planes[plane].sensor;
                    (sensor.runout_m, sensor.runout_phase_rad) = (runout_m, phase_rad);
                }
                scene
            }
            Self::Misaligned(percent) => {
                let mut scene = struck();
                for (plane, sense) in scene.machine.planes.iter_mut().zip([1.0, -1.0]) {
                    let c = plane.contact.clearance_m;
                    plane.centre_m = sense * share(percent) * c * V2::new(0.6, 0.8);
                }
                scene
            }
            Self::SpinDown => spinning_down(resting()),
            Self::SealStruck(percent) => {
                let sealed = plant.sealed(share(percent))?;
                sealed.struck(Blow::Centre, BLOW * hardest.centre_m_s, angle_rad, seed)
            }
            Self::SealOverloaded(percent) => {
                let sealed = plant.sealed(share(percent))?;
                sealed.overloaded(None, OVERLOAD, (angle_rad, seed))
            }
        })
    }
}

/// Runs until some time after what ends last.
fn until(scene: &mut Scene, end_s: f64) {
    scene.duration_s = end_s + AFTER_S;
}

/// Some magnets, or one axis of them, give nothing for a while, which firmware knows.
fn without_force(
    mut scene: Scene,
    (start_s, duration_s): (f64, f64),
    axis: Axis,
    planes: std::ops::Range<usize>,
) -> Scene {
    let outage = Outage {
        start_s,
        duration_s,
        delivers: Delivers::Nothing,
        axis,
        known: true,
    };
    for plane in scene.planes.iter_mut().take(planes.end).skip(planes.start) {
        plane.outages = vec![outage];
    }
    until(&mut scene, start_s + duration_s);
    scene
}

/// The first sensor reads no number for a while.
fn without_reading(mut scene: Scene, (start_s, duration_s): (f64, f64)) -> Scene {
    if let Some(first) = scene.planes.first_mut() {
        first.faults = vec![Fault {
            start_s,
            duration_s,
            kind: FaultKind::Nan,
            axis: Axis::Both,
        }];
    }
    until(&mut scene, start_s + duration_s);
    scene
}

/// An unbalance at the first plane, of this moment and at this angle on the rotor.
fn unbalance(scene: &Scene, moment_kg_m: f64, angle_rad: f64) -> Unbalance {
    Unbalance {
        position_m: scene.machine.planes.first().map_or(0.0, |p| p.position_m),
        moment_kg_m,
        angle_rad,
    }
}

/// An unbalance at the first plane whose orbit far above the criticals is this share of the clearance.
fn unbalance_of_orbit(scene: &Scene, share: f64, angle_rad: f64) -> Unbalance {
    let clearance_m = scene.clearance_m(0);
    let mut unbalance = unbalance(scene, 0.0, angle_rad);
    let z = unbalance.position_m;
    unbalance.moment_kg_m = share * clearance_m / scene.machine.rotor.rigid().mobility(z, z);
    unbalance
}

/// An unbalance at the first plane from a time on, its force a share of the magnet's cap; for a while, after which the opposite
/// comes on top, or for good.
fn blade_lost(mut scene: Scene, (share, angle_rad): (f64, f64), lasts_s: Option<f64>) -> Scene {
    let force_n = share * scene.machine.magnets.first().map_or(0.0, |m| m.force_max_n);
    let moment_kg_m = force_n / scene.start.spin_rad_s.powi(2);
    until(&mut scene, BEGIN_S + lasts_s.unwrap_or(0.1));
    let at = |at_s: f64, angle_rad: f64| TimedChange {
        at_s,
        change: Change {
            unbalance: Some(unbalance(&scene, moment_kg_m, angle_rad)),
            ..Change::default()
        },
    };
    let mut changes = vec![at(BEGIN_S, angle_rad)];
    changes.extend(lasts_s.map(|lasts_s| at(BEGIN_S + lasts_s, angle_rad + PI)));
    scene.changes.extend(changes);
    scene
}

/// The base moves.
fn shaken(mut scene: Scene, motion: &BaseMotion) -> Scene {
    scene.base_motions.push(motion.clone());
    until(&mut scene, motion.end_s());
    scene
}

/// Lies across the axis in the earth's field, each magnet configured to carry its share.
fn with_weight(mut scene: Scene) -> Scene {
    let gravity_m_s2 = V2::new(0.0, -G_M_S2);
    scene.machine.gravity_m_s2 = gravity_m_s2;
    let mass_kg = scene.machine.rotor.rigid().mass_kg;
    let places_m: Vec<f64> = scene.machine.magnets.iter().map(|m| m.position_m).collect();
    if let [first_m, second_m] = places_m[..] {
        let apart_m = second_m - first_m;
        let carried = [second_m / apart_m, -first_m / apart_m];
        for (plane, share) in scene.planes.iter_mut().zip(carried) {
            plane.feed_forward_n = -mass_kg * share * gravity_m_s2;
        }
    }
    scene
}

/// Starts in backward whirl, at a share of the speed that the weaker plane's cap can stop; conical whirl is that of the plane
/// that is farther out.
fn whirling(mut scene: Scene, share: f64, along: V2, conical: bool) -> Scene {
    let planes = || 0..scene.planes.len();
    let limits = planes().filter_map(|plane| arrest_of(&scene, plane));
    let speed_m_s = share * limits.fold(f64::INFINITY, |least, a| least.min(a.limit_m_s));
    let radius_m = planes()
        .map(|plane| circle_radius_m(&scene.plant(plane), speed_m_s))
        .fold(f64::INFINITY, f64::min);
    let backward = -scene.start.spin_rad_s.signum();
    let position_m = radius_m * along;
    let velocity_m_s = backward * speed_m_s * V2::new(-along.y, along.x);
    let start = &mut scene.start;
    if conical {
        let places = scene.machine.planes.iter().map(|p| p.position_m.abs());
        let farthest_m = places.fold(0.0, f64::max);
        (start.centre_m, start.centre_velocity_m_s) = (V2::zeros(), V2::zeros());
        (start.tilt_rad, start.tilt_rate_rad_s) =
            (position_m / farthest_m, velocity_m_s / farthest_m);
    } else {
        (start.centre_m, start.centre_velocity_m_s) = (position_m, velocity_m_s);
        (start.tilt_rad, start.tilt_rate_rad_s) = (V2::zeros(), V2::zeros());
    }
    for plane in &mut scene.planes {
        plane.whirl_speed_m_s = plane.whirl_speed_m_s.max(lost_beyond_m_s(speed_m_s));
    }
    scene.levitated_before = true;
    scene
}

/// Free to spin, from the first speed of the run-down or its own; the torque \[N m\] that brakes it down.
fn braked(scene: &mut Scene) -> f64 {
    let (from_hz, to_hz) = SPIN_DOWN_HZ;
    let from = scene.start.spin_rad_s.abs().min(TAU * from_hz);
    let sense = scene.start.spin_rad_s.signum();
    scene.start.spin_rad_s = sense * from;
    let inertia_kg_m2 = scene.machine.rotor.rigid().polar_inertia_kg_m2;
    scene.machine.spin = SpinParams::Free {
        inertia_kg_m2,
        drive_torque_n_m: 0.0,
    };
    -sense * (from - TAU * to_hz) / SPIN_DOWN_S * inertia_kg_m2
}

/// A drive brakes it.
fn spinning_down(mut scene: Scene) -> Scene {
    let torque_n_m = braked(&mut scene);
    if let SpinParams::Free {
        drive_torque_n_m, ..
    } = &mut scene.machine.spin
    {
        *drive_torque_n_m = torque_n_m;
    }
    let unbalance = unbalance_of_orbit(&scene, SPIN_DOWN_ORBIT, 0.0);
    scene.machine.unbalances.push(unbalance);
    scene.duration_s = SPIN_DOWN_S;
    scene
}

/// Balanced at its speed; then a blade is lost, and a drive brakes it.
fn blade_lost_and_spun_down(mut scene: Scene, (share, angle_rad): (f64, f64)) -> Scene {
    let lost = TimedChange {
        at_s: BEGIN_S,
        change: Change {
            drive_torque_n_m: Some(braked(&mut scene)),
            unbalance: Some(unbalance_of_orbit(&scene, share, angle_rad)),
            ..Change::default()
        },
    };
    scene.changes.push(lost);
    scene.duration_s = BEGIN_S + SPIN_DOWN_S;
    scene
}
