//! Who drives the magnet: the baselines, the supervisor, and the reference that knows everything.

use crate::machines::tuned_gains::TunedGains;
use firmware_bench::device::levitation::{LevitationParams, TrueLevitation};
use firmware_bench::run::clairvoyant::{Clairvoyant, ClairvoyantLaw};
use firmware_bench::run::controller::Policy;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::contact::restitution_of;
use plant_model::params::PlantParams;

/// A policy of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Seat {
    /// No force.
    Passive,
    /// The whole capacity inwards outside a band.
    Radial,
    /// Pure damping.
    Damping,
    /// An ordinary levitation loop: K_p ten times the (negative) stiffness.
    Stiff,
    /// The levitation loop tuned for its own best impact result.
    Tuned,
    /// The supervisor in front of the tuned loop.
    Supervisor,
    /// The supervisor in front of the ordinary loop.
    SupervisorOnStiff,
    /// True state, no delay, the best law found.
    Clairvoyant,
}

impl Seat {
    /// All of them, from nothing to everything.
    pub const ALL: [Self; 8] = [
        Self::Passive,
        Self::Radial,
        Self::Damping,
        Self::Stiff,
        Self::Tuned,
        Self::Supervisor,
        Self::SupervisorOnStiff,
        Self::Clairvoyant,
    ];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passive => "passive",
            Self::Radial => "radial",
            Self::Damping => "damping",
            Self::Stiff => "stiff",
            Self::Tuned => "tuned",
            Self::Supervisor => "supervisor",
            Self::SupervisorOnStiff => "supervisor on stiff",
            Self::Clairvoyant => "clairvoyant",
        }
    }

    /// Whether sensor noise, and with it the seed, matters.
    pub fn measures(self) -> bool {
        !matches!(self, Self::Passive | Self::Clairvoyant)
    }
}

/// What a task asks of the reference: its weights were searched for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Task {
    /// Impacts and everything else.
    Impact,
    /// Established whirl at take-over.
    Whirl,
}

/// The policy set up for a scene on this plant; `None` where the scene lacks what it needs.
pub fn seated(seat: Seat, task: Task, found: &TunedGains, scene: &Scene) -> Option<Policy> {
    match seat {
        Seat::Passive => Policy::new(PolicyKind::Passive, scene),
        Seat::Radial => Policy::new(PolicyKind::Radial, scene),
        Seat::Damping => {
            let scene = Scene {
                damping_n_s_m: full_at_lift_off_n_s_m(&scene.plant),
                ..scene.clone()
            };
            with_loop(PolicyKind::Damping, found.tuned, &scene)
        }
        Seat::Stiff => levitation(found.stiff, scene),
        Seat::Tuned => levitation(found.tuned, scene),
        Seat::Supervisor => with_loop(PolicyKind::Supervisor, found.tuned, scene),
        Seat::SupervisorOnStiff => with_loop(PolicyKind::Supervisor, found.stiff, scene),
        Seat::Clairvoyant => Some(Policy::Clairvoyant(clairvoyant(
            match task {
                Task::Impact => found.impact_law,
                Task::Whirl => found.whirl_law,
            },
            scene,
        ))),
    }
}

/// What is tried on a scene of the catalogue for a seat, where the best counts. Only the reference has more than
/// one: both of its laws, and the loops of the baselines with the true state, since a law made for impacts need
/// not levitate best.
pub fn tries(seat: Seat, found: &TunedGains, scene: &Scene) -> Vec<Policy> {
    if seat != Seat::Clairvoyant {
        return seated(seat, Task::Impact, found, scene)
            .into_iter()
            .collect();
    }
    let laws = [found.impact_law, found.whirl_law];
    let loops = [found.tuned, found.stiff];
    let force_max_n = scene.plant.magnet.map_or(0.0, |m| m.force_max_n);
    let seeing = |params| TrueLevitation {
        params,
        force_max_n,
    };
    (laws.into_iter())
        .map(|law| Policy::Clairvoyant(clairvoyant(law, scene)))
        .chain(loops.map(|params| Policy::TrueLevitation(seeing(params), -scene.centre_offset_m)))
        .collect()
}

/// Restitution of a scene's contact.
pub fn restitution(scene: &Scene) -> f64 {
    // The catalogue's contacts are linear; a nonlinear one loses little at low speed.
    scene.plant.contact.law.linear().map_or(1.0, |law| {
        let critical = 2.0 * (law.stiffness_n_m * scene.plant.contact_mass_kg()).sqrt();
        restitution_of(law.damping_n_s_m / critical)
    })
}

/// The reference with given weights.
pub fn clairvoyant(law: ClairvoyantLaw, scene: &Scene) -> Clairvoyant {
    Clairvoyant::new(law, &scene.plant, restitution(scene), scene.sample_rate_hz)
}

/// The damping that spends the whole cap at the lift-off speed √(F·c/m) \[N s/m\].
fn full_at_lift_off_n_s_m(plant: &PlantParams) -> f64 {
    let force_n = plant.magnet.map_or(0.0, |m| m.force_max_n);
    force_n / (force_n * plant.contact.clearance_m / plant.rotor.mass_kg).sqrt()
}

/// A policy with other gains of the levitation controller than the scene's.
fn with_loop(kind: PolicyKind, params: LevitationParams, scene: &Scene) -> Option<Policy> {
    let scene = Scene {
        levitation: Some(params),
        ..scene.clone()
    };
    Policy::new(kind, &scene)
}

/// The levitation controller alone.
pub fn levitation(params: LevitationParams, scene: &Scene) -> Option<Policy> {
    with_loop(PolicyKind::Levitation, params, scene)
}
