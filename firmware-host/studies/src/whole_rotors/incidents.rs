//! What else happens to the catalogue's whole rotors than blows and overloads.

use super::plants::{Blow, RotorPlant, load_at};
use crate::overloads::takeover::{arrest_of, lost_beyond_m_s};
use firmware_bench::device::actuator::{Delivers, Outage};
use firmware_bench::device::axis::Axis;
use firmware_bench::device::loads::{BaseMotion, Disturbance, Shape};
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::scene::machine::MachineScene;
use plant_model::V2;
use plant_model::analysis::arrest::circle_radius_m;
use plant_model::machine::params::Unbalance;
use plant_model::params::SpinParams;
use std::f64::consts::{FRAC_PI_2, TAU};

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
    /// A force that turns with the spin at the first plane, of so many percent of the cap, for 100 ms.
    BladeLost(u32),
    /// The same until the end.
    BladeLostForGood(u32),
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
    /// A blow with both retainers off the centre by so many percent of the clearance, against each other, untold.
    Misaligned(u32),
    /// The spin falls through the criticals of the levitated rotor with an unbalance at the first plane.
    SpinDown,
}

impl Incident {
    /// All.
    pub const ALL: [Self; 25] = [
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
            Self::Shock(g, ms) => format!("shock of {g} g, {ms} ms"),
            Self::PowerGone(ms) => format!("power gone for {ms} ms"),
            Self::Cylindrical(percent) => format!("cylindrical whirl, {percent} % of v_lim"),
            Self::Conical(percent) => format!("conical whirl, {percent} % of v_lim"),
            Self::Runout(percent) => format!("blow, runout of {percent} % of c"),
            Self::Misaligned(percent) => format!("blow, retainers {percent} % of c off"),
            Self::SpinDown => "spin-down through the criticals".to_owned(),
        }
    }

    /// The scene in which it happens, in this direction \[rad\] and with other noise. `struck_m_s` is the hardest blow at the
    /// first end that the file's loop alone recovers from.
    pub fn scene(
        self,
        plant: &RotorPlant,
        struck_m_s: f64,
        (angle_rad, seed): (f64, u64),
    ) -> MachineScene {
        let struck = || plant.struck(Blow::End(0), BLOW * struck_m_s, angle_rad, seed);
        // From rest, not in the very middle.
        let resting = || plant.struck(Blow::End(0), 1e-3, angle_rad, seed);
        let (sin, cos) = angle_rad.sin_cos();
        let along = V2::new(cos, sin);
        let seconds = |ms: u32| 1e-3 * f64::from(ms);
        let share = |percent: u32| 0.01 * f64::from(percent);
        match self {
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
            Self::BladeLost(percent) => turning_load(resting(), share(percent), Some(0.1)),
            Self::BladeLostForGood(percent) => turning_load(resting(), share(percent), None),
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
                for (plane, phase_rad) in scene.planes.iter_mut().zip([0.0, TAU / 2.0]) {
                    let c = plane.scene.plant.contact.clearance_m;
                    plane.scene.sensor.runout_m = share(percent) * c;
                    plane.scene.sensor.runout_phase_rad = phase_rad;
                }
                scene
            }
            Self::Misaligned(percent) => {
                let mut scene = struck();
                let planes = scene.planes.iter_mut().zip(&mut scene.machine.planes);
                for ((plane, of_machine), sense) in planes.zip([1.0, -1.0]) {
                    let c = plane.scene.plant.contact.clearance_m;
                    let off_m = sense * share(percent) * c * V2::new(0.6, 0.8);
                    (plane.scene.centre_offset_m, of_machine.centre_m) = (off_m, off_m);
                }
                scene
            }
            Self::SpinDown => spinning_down(resting()),
        }
    }
}

/// Runs until some time after what ends last.
fn until(scene: &mut MachineScene, end_s: f64) {
    for plane in &mut scene.planes {
        plane.scene.duration_s = end_s + AFTER_S;
    }
}

/// Some magnets, or one axis of them, give nothing for a while, which firmware knows.
fn without_force(
    mut scene: MachineScene,
    (start_s, duration_s): (f64, f64),
    axis: Axis,
    planes: std::ops::Range<usize>,
) -> MachineScene {
    let outage = Outage {
        start_s,
        duration_s,
        delivers: Delivers::Nothing,
        axis,
        known: true,
    };
    for plane in scene.planes.iter_mut().take(planes.end).skip(planes.start) {
        plane.scene.outages = vec![outage];
    }
    until(&mut scene, start_s + duration_s);
    scene
}

/// The first sensor reads no number for a while.
fn without_reading(mut scene: MachineScene, (start_s, duration_s): (f64, f64)) -> MachineScene {
    if let Some(first) = scene.planes.first_mut() {
        first.scene.faults = vec![Fault {
            start_s,
            duration_s,
            kind: FaultKind::Nan,
            axis: Axis::Both,
        }];
    }
    until(&mut scene, start_s + duration_s);
    scene
}

/// The force of an unbalance that is there from a time on at the first plane, a share of its magnet's cap. The spin being
/// held, it is two that swing.
fn turning_load(mut scene: MachineScene, share: f64, lasts_s: Option<f64>) -> MachineScene {
    let spin_hz = scene.start.spin_rad_s / TAU;
    let force_n = share * scene.machine.magnets.first().map_or(0.0, |m| m.force_max_n);
    let position_m = scene.machine.planes.first().map_or(0.0, |p| p.position_m);
    until(&mut scene, BEGIN_S + lasts_s.unwrap_or(0.1));
    let duration_s = lasts_s.unwrap_or(scene.common().duration_s - BEGIN_S);
    let part = |force_n: V2, phase_rad: f64| Disturbance {
        start_s: BEGIN_S,
        duration_s,
        force_n,
        shape: Shape::Sine {
            frequency_hz: spin_hz.abs(),
            phase_rad,
        },
    };
    let sense = spin_hz.signum();
    for part in [
        part(V2::new(force_n, 0.0), FRAC_PI_2),
        part(V2::new(0.0, sense * force_n), 0.0),
    ] {
        load_at(&mut scene, part, position_m);
    }
    scene
}

/// The base moves.
fn shaken(mut scene: MachineScene, motion: &BaseMotion) -> MachineScene {
    let mass_kg = scene.machine.rotor.rigid().mass_kg;
    scene.loads.push(motion.on_mass(mass_kg));
    scene.machine.loads_m.push(0.0);
    for plane in &mut scene.planes {
        plane.scene.base_motions.push(*motion);
    }
    until(&mut scene, motion.end_s());
    scene
}

/// Lies across the axis in the earth's field, each magnet told to carry its share.
fn with_weight(mut scene: MachineScene) -> MachineScene {
    let gravity_m_s2 = V2::new(0.0, -G_M_S2);
    scene.machine.gravity_m_s2 = gravity_m_s2;
    let mass_kg = scene.machine.rotor.rigid().mass_kg;
    let places_m: Vec<f64> = scene.machine.magnets.iter().map(|m| m.position_m).collect();
    if let [first_m, second_m] = places_m[..] {
        let apart_m = second_m - first_m;
        let carried = [second_m / apart_m, -first_m / apart_m];
        for (plane, share) in scene.planes.iter_mut().zip(carried) {
            plane.scene.feed_forward_n = -mass_kg * share * gravity_m_s2;
        }
    }
    scene
}

/// Starts in backward whirl, at a share of the speed that the weaker plane's cap can stop; conical whirl is that of the plane
/// that is farther out.
fn whirling(mut scene: MachineScene, share: f64, along: V2, conical: bool) -> MachineScene {
    let limits = scene.planes.iter().filter_map(|p| arrest_of(&p.scene));
    let speed_m_s = share * limits.fold(f64::INFINITY, |least, a| least.min(a.limit_m_s));
    let radius_m = (scene.planes.iter())
        .map(|p| circle_radius_m(&p.scene.plant, speed_m_s))
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
        let lost = lost_beyond_m_s(speed_m_s);
        plane.scene.whirl_speed_m_s = plane.scene.whirl_speed_m_s.max(lost);
    }
    scene
}

/// A drive brakes it.
fn spinning_down(mut scene: MachineScene) -> MachineScene {
    let (from_hz, to_hz) = SPIN_DOWN_HZ;
    let from = scene.start.spin_rad_s.abs().min(TAU * from_hz);
    let sense = scene.start.spin_rad_s.signum();
    let rigid = scene.machine.rotor.rigid();
    let inertia_kg_m2 = rigid.polar_inertia_kg_m2;
    scene.machine.spin = SpinParams::Free {
        inertia_kg_m2,
        drive_torque_n_m: -sense * (from - TAU * to_hz) / SPIN_DOWN_S * inertia_kg_m2,
    };
    scene.start.spin_rad_s = sense * from;
    if let (Some(plane), Some(own)) = (scene.machine.planes.first(), scene.planes.first()) {
        let orbit_m = SPIN_DOWN_ORBIT * own.scene.plant.contact.clearance_m;
        let unbalance = Unbalance {
            position_m: plane.position_m,
            moment_kg_m: orbit_m / rigid.mobility(plane.position_m, plane.position_m),
            angle_rad: 0.0,
        };
        scene.machine.unbalances.push(unbalance);
    }
    for plane in &mut scene.planes {
        plane.scene.duration_s = SPIN_DOWN_S;
    }
    scene
}
