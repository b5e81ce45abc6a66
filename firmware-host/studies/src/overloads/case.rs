//! A scene of the catalogue, and the sizes of a plant by which it is made.
//!
//! Sizes are taken from the plant: forces from its capacity, speeds from the impact whose bounces, left to
//! themselves, would add up to the fastest whirl that the cap can stop, v_ref = v_lim·(1 − e)/(μ·(1 + e)).

use super::contenders::Contender;
use super::takeover::arrest_of;
use firmware_bench::device::loads::{Disturbance, Shape};
use firmware_bench::run::clairvoyant::restitution;
use firmware_bench::scene::Scene;
use plant_model::V2;
use plant_model::params::Start;

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
        let force_n = scene.plant.magnet?.force_max_n;
        let limit_m_s = arrest_of(scene)?.limit_m_s;
        let e = restitution(&scene.plant);
        let mu = scene.plant.friction.sliding.coefficient(0.0);
        Some(Self {
            force_n,
            limit_m_s,
            impact_m_s: limit_m_s * (1.0 - e) / (mu * (1.0 + e)),
        })
    }
}

/// The start of a scene aimed at the wall at an angle to its normal; positive: along the spin.
pub(super) fn aimed(scene: &Scene, speed_m_s: f64, angle_deg: f64) -> Start {
    let c = scene.plant.contact.clearance_m;
    Start {
        position_m: V2::new(0.0, -0.99 * c * angle_deg.to_radians().sin()),
        velocity_m_s: V2::new(speed_m_s, 0.0),
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
        shape: Shape::Constant,
    }
}
