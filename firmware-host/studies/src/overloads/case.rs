//! A scene of the catalogue, and the sizes of a plant by which it is made.
//!
//! Sizes are taken from the plant: forces from its capacity, speeds from the impact whose bounces, left to
//! themselves, would add up to the fastest whirl that the cap can stop, v_ref = v_lim·(1 − e)/(μ·(1 + e)).

use super::contenders::Contender;
use super::takeover::arrest_of;
use firmware_bench::device::loads::Disturbance;
use firmware_bench::run::clairvoyant::restitution;
use firmware_bench::scene::Scene;
use plant_model::V2;
use plant_model::machine::params::MachineStart;

/// A scene of the catalogue.
#[derive(Debug, Clone)]
pub struct Case {
    /// Kind of overload: what results are summed over.
    pub group: &'static str,
    /// Name, unique on a plant.
    pub name: String,
    /// What happens.
    pub scene: Scene,
    /// Who takes part.
    pub contenders: &'static [Contender],
}

/// Sizes of a plant.
#[derive(Debug, Clone, Copy)]
pub struct Sizes {
    /// Cap of the magnet \[N\].
    pub force_n: f64,
    /// Fastest whirl that it can stop \[m/s\].
    pub limit_m_s: f64,
    /// Reference speed of impacts \[m/s\].
    pub impact_m_s: f64,
}

impl Sizes {
    /// `None` without a magnet or without friction.
    pub fn of(scene: &Scene) -> Option<Self> {
        let plant = scene.plant(0);
        let force_n = plant.magnet?.force_max_n;
        let limit_m_s = arrest_of(scene, 0)?.limit_m_s;
        let e = restitution(&plant);
        let mu = plant.friction.sliding.coefficient(0.0);
        Some(Self {
            force_n,
            limit_m_s,
            impact_m_s: limit_m_s * (1.0 - e) / (mu * (1.0 + e)),
        })
    }
}

/// The start of a scene aimed at the wall at an angle to its normal; positive: along the spin.
pub(super) fn aimed(scene: &Scene, speed_m_s: f64, angle_deg: f64) -> MachineStart {
    let off_m = V2::new(
        0.0,
        -0.99 * scene.clearance_m(0) * angle_deg.to_radians().sin(),
    );
    MachineStart {
        centre_m: scene.machine.planes[0].centre_m + off_m,
        centre_velocity_m_s: V2::new(speed_m_s, 0.0),
        ..scene.start
    }
}

/// A load of so many caps in a direction that is no axis.
pub(super) fn load(sizes: Sizes, share: f64, start_s: f64, duration_s: f64) -> Disturbance {
    let direction = V2::new(30_f64.to_radians().cos(), 30_f64.to_radians().sin());
    Disturbance {
        start_s,
        duration_s,
        force_n: share * sizes.force_n * direction,
        ..Disturbance::default()
    }
}

/// The scene with another seed of its first plane's noise; noise of others goes with it, and stays one of its own.
pub(crate) fn seeded(scene: &Scene, seed: u64) -> Scene {
    let mut scene = scene.clone();
    let by = seed.wrapping_sub(scene.planes[0].seed);
    for plane in &mut scene.planes {
        plane.seed = plane.seed.wrapping_add(by);
    }
    scene
}

/// The scene with the retainer bearing of its only plane off the centre of magnets and sensors, and the rotor off with it.
pub(super) fn off_centre(scene: &mut Scene, by_m: V2) {
    scene.machine.planes[0].centre_m += by_m;
    scene.start.centre_m += by_m;
}
