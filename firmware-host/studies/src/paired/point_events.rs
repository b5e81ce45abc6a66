//! What happens to a point mass, put into its scene.

use super::written_events::BEGIN_S;
use crate::machines::draw::Draw;
use crate::machines::random::RandomMachine;
use crate::overloads::takeover::{arrest_of, let_whirl};
use firmware_bench::device::loads::{BaseMotion, Disturbance, Shape};
use firmware_bench::scene::Scene;
use plant_model::V2;
use plant_model::params::SpinParams;

/// What is left to come back in \[s\].
const AFTER_S: f64 = 0.25;

/// Kinds of events.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Point {
    /// Nothing.
    Idle,
    /// A push from the centre that takes the rotor to the wall.
    Impact,
    /// A push that levitation alone may or may not stop before the wall.
    Marginal,
    /// A push of a rotor that a load holds off the centre, in any direction.
    Eccentric,
    /// A shock of the base.
    Shock,
    /// A load beyond the cap, or nearly.
    Overload,
    /// Backward whirl at take-over.
    Whirl,
    /// Run-up through an orbit as wide as most of the clearance.
    RunUp,
}

impl Point {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Idle,
        Self::Impact,
        Self::Marginal,
        Self::Eccentric,
        Self::Shock,
        Self::Overload,
        Self::Whirl,
        Self::RunUp,
    ];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Impact => "impact",
            Self::Marginal => "marginal impact",
            Self::Eccentric => "eccentric impact",
            Self::Shock => "shock",
            Self::Overload => "overload",
            Self::Whirl => "whirl at take-over",
            Self::RunUp => "run-up",
        }
    }

    /// Lets it happen, as large as is drawn.
    pub fn happen(self, machine: &RandomMachine, draw: &mut Draw, scene: &mut Scene) {
        let unit = machine.unit_m_s();
        scene.duration_s = BEGIN_S + AFTER_S;
        let angle = draw.angle_rad();
        let direction = V2::new(angle.cos(), angle.sin());
        match self {
            Self::Idle => {}
            Self::Impact => {
                let speed = unit * draw.between(1.0, 5.0);
                scene.disturbances.push(push(machine, direction * speed));
            }
            Self::Marginal => {
                let speed = unit * draw.between(0.6, 1.6);
                scene.disturbances.push(push(machine, direction * speed));
            }
            Self::Eccentric => {
                let share = draw.between(0.1, 0.5);
                let towards = draw.angle_rad();
                let load = machine.force_n() * share * V2::new(towards.cos(), towards.sin());
                scene.disturbances.push(Disturbance {
                    start_s: 0.1,
                    duration_s: BEGIN_S,
                    force_n: load,
                    ..Disturbance::default()
                });
                let speed = unit * draw.between(0.3, 2.5);
                scene.disturbances.push(push(machine, direction * speed));
            }
            Self::Shock => {
                let duration_s = draw.decades(1.0, 8.0) * machine.unit_s();
                let acceleration = machine.force_n() / mass_kg(&machine.scene);
                scene.base_motions.push(BaseMotion {
                    start_s: BEGIN_S,
                    duration_s,
                    acceleration_m_s2: direction * acceleration * draw.decades(0.5, 4.0),
                    shape: Shape::HalfSine,
                });
                scene.duration_s += duration_s;
            }
            Self::Overload => {
                let duration_s = draw.decades(0.005, 0.3);
                scene.disturbances.push(Disturbance {
                    start_s: BEGIN_S,
                    duration_s,
                    force_n: direction * machine.force_n() * draw.between(0.8, 2.5),
                    ..Disturbance::default()
                });
                scene.duration_s += duration_s;
            }
            Self::Whirl => {
                if let Some(arrest) = arrest_of(scene, 0) {
                    let speed_m_s = arrest.limit_m_s * draw.between(0.3, 1.0);
                    let_whirl(scene, speed_m_s);
                }
                scene.duration_s = AFTER_S;
            }
            Self::RunUp => {
                // A mass centre that far off turns the rotor on its bearing through the whole of it.
                let orbit = draw.between(0.3, 0.7);
                scene.machine.eccentricity_m = orbit * 0.9 * machine.clearance_m();
                let levitation = scene.planes[0].levitation;
                let stiffness_n_m = levitation.map_or(0.0, |l| l.proportional_n_m)
                    + scene.plant(0).rotor.stiffness_n_m;
                let critical = (stiffness_n_m / mass_kg(scene)).sqrt();
                let end = 3.0 * critical * scene.start.spin_rad_s.signum();
                scene.duration_s = 2.0;
                let inertia_kg_m2 = match scene.machine.spin {
                    SpinParams::Free { inertia_kg_m2, .. } => inertia_kg_m2,
                    _ => 1.0,
                };
                scene.start.spin_rad_s = 0.02 * end;
                scene.machine.spin = SpinParams::Free {
                    inertia_kg_m2,
                    drive_torque_n_m: inertia_kg_m2 * end / scene.duration_s,
                };
            }
        }
    }
}

/// A change of speed within two fifths of √(m·c/F): no hammer, whose blow would be over between two samples.
fn push(machine: &RandomMachine, change_m_s: V2) -> Disturbance {
    let duration_s = 0.4 * machine.unit_s();
    Disturbance {
        start_s: BEGIN_S,
        duration_s,
        force_n: change_m_s * (mass_kg(&machine.scene) / duration_s),
        ..Disturbance::default()
    }
}

fn mass_kg(scene: &Scene) -> f64 {
    scene.machine.rotor.rigid().mass_kg
}
