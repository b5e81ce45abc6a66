//! Who competes for the magnet: the baselines, the supervisor, and the reference that knows everything.

use crate::machines::tuned_gains::TunedGains;
use firmware_bench::device::levitation::{LevitationParams, TrueLevitation};
use firmware_bench::run::clairvoyant::{Clairvoyant, ClairvoyantLaw, restitution};
use firmware_bench::run::controller::{Controller, controller};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::params::PlantParams;

/// A policy of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Contender {
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

impl Contender {
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

impl Contender {
    /// Set up for a scene on this plant; `None` where the scene lacks what it needs.
    pub fn controller(
        self,
        task: Task,
        found: &TunedGains,
        scene: &Scene,
    ) -> Option<Box<dyn Controller>> {
        match self {
            Self::Passive => controller(PolicyKind::Passive, scene, 0),
            Self::Radial => controller(PolicyKind::Radial, scene, 0),
            Self::Damping => {
                let mut scene = scene.clone();
                scene.planes[0].damping_n_s_m = full_at_lift_off_n_s_m(&scene.plant(0));
                with_loop(PolicyKind::Damping, found.tuned, &scene)
            }
            Self::Stiff => levitation(found.stiff, scene),
            Self::Tuned => levitation(found.tuned, scene),
            Self::Supervisor => with_loop(PolicyKind::Supervisor, found.tuned, scene),
            Self::SupervisorOnStiff => with_loop(PolicyKind::Supervisor, found.stiff, scene),
            Self::Clairvoyant => Some(Box::new(clairvoyant(
                match task {
                    Task::Impact => found.impact_law,
                    Task::Whirl => found.whirl_law,
                },
                scene,
            ))),
        }
    }

    /// What competes for it on a scene of the catalogue, where the best counts. Only the reference has more than one: both
    /// of its laws, and the loops of the baselines with the true state, since a law made for impacts need not levitate best.
    pub(crate) fn candidates(self, found: &TunedGains, scene: &Scene) -> Vec<Box<dyn Controller>> {
        if self != Self::Clairvoyant {
            return (self.controller(Task::Impact, found, scene).into_iter()).collect();
        }
        let boxed = |law| Box::new(clairvoyant(law, scene)) as Box<dyn Controller>;
        let laws = [found.impact_law, found.whirl_law].map(boxed);
        let loops = [found.tuned, found.stiff].map(|params| {
            Box::new(TrueLevitation {
                params,
                force_max_n: scene.force_max_n(0),
                centre_m: -scene.machine.planes[0].centre_m,
            }) as Box<dyn Controller>
        });
        laws.into_iter().chain(loops).collect()
    }
}

/// The reference with given weights.
pub fn clairvoyant(law: ClairvoyantLaw, scene: &Scene) -> Clairvoyant {
    let plant = scene.plant(0);
    Clairvoyant::new(law, &plant, restitution(&plant), scene.sample_rate_hz)
}

/// The damping that spends the whole cap at the lift-off speed √(F·c/m) \[N s/m\].
fn full_at_lift_off_n_s_m(plant: &PlantParams) -> f64 {
    let force_n = plant.magnet.map_or(0.0, |m| m.force_max_n);
    force_n / (force_n * plant.contact.clearance_m / plant.rotor.mass_kg).sqrt()
}

/// A policy with other gains of the levitation controller than the scene's.
fn with_loop(
    kind: PolicyKind,
    params: LevitationParams,
    scene: &Scene,
) -> Option<Box<dyn Controller>> {
    let mut scene = scene.clone();
    scene.planes[0].levitation = Some(params);
    controller(kind, &scene, 0)
}

/// The levitation controller alone.
pub fn levitation(params: LevitationParams, scene: &Scene) -> Option<Box<dyn Controller>> {
    with_loop(PolicyKind::Levitation, params, scene)
}
