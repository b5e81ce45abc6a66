//! What may drive the magnet: baselines, and the supervisor in front of the levitation controller.

use crate::levitation::Levitation;
use crate::policy_kind::PolicyKind;
use crate::scene::Scene;
use plant_model::V2;
use supervisor::{IntegratorHint, Mode, Sample, Status, Supervisor};

/// A policy at work.
#[derive(Debug, Clone)]
pub enum Policy {
    /// No force.
    Passive,
    /// The whole capacity inwards outside a band.
    Radial {
        /// Radius of the band \[m\].
        band_m: f64,
        /// Capacity \[N\].
        force_n: f64,
    },
    /// The saturated levitation controller alone.
    Levitation(Levitation),
    /// The supervisor with that controller behind it.
    Supervisor {
        /// The product.
        supervisor: Box<Supervisor>,
        /// What it passes through.
        levitation: Levitation,
        /// What it told the controller's integrator.
        hint: IntegratorHint,
        /// Tick counter.
        sequence: u32,
    },
}

impl Policy {
    /// The policy set up for a scene; `None` where the scene lacks what it needs (which
    /// [`Scene::load`] refuses).
    pub fn new(kind: PolicyKind, scene: &Scene) -> Option<Self> {
        let force_n = scene.plant.magnet.map_or(0.0, |m| m.force_max_n);
        let levitation = || {
            let params = scene.levitation?;
            Some(Levitation::new(params, 1.0 / scene.sample_rate_hz, force_n))
        };
        Some(match kind {
            PolicyKind::Passive => Self::Passive,
            PolicyKind::Radial => Self::Radial {
                band_m: scene.radial_band * scene.plant.contact.clearance_m,
                force_n,
            },
            PolicyKind::Levitation => Self::Levitation(levitation()?),
            PolicyKind::Supervisor => Self::Supervisor {
                supervisor: Box::new(Supervisor::new(&scene.supervisor?).ok()?),
                levitation: levitation()?,
                hint: IntegratorHint::Run,
                sequence: 0,
            },
        })
    }

    /// One tick: measured position and spin in, commanded force \[N\] out.
    pub fn tick(&mut self, measured_m: V2, spin_rad_s: f64) -> V2 {
        match self {
            Self::Passive => V2::zeros(),
            Self::Radial { band_m, force_n } => {
                let radius = measured_m.norm();
                if radius > *band_m {
                    measured_m * (-*force_n / radius)
                } else {
                    V2::zeros()
                }
            }
            Self::Levitation(levitation) => levitation.force_n(measured_m, IntegratorHint::Run),
            Self::Supervisor {
                supervisor,
                levitation,
                hint,
                sequence,
            } => {
                let single = |v: V2| [v.x as f32, v.y as f32];
                let command = supervisor.tick(&Sample {
                    sequence: *sequence,
                    status: Status::SPIN_VALID | Status::BEARING_ON,
                    position_m: single(measured_m),
                    spin_rad_s: spin_rad_s as f32,
                    levitation_n: single(levitation.force_n(measured_m, *hint)),
                    // The stand-in firmware has no feedback of current or flux.
                    applied_n: [0.0; 2],
                });
                *hint = command.integrator;
                *sequence = sequence.wrapping_add(1);
                let [x, y] = command.force_n;
                V2::new(f64::from(x), f64::from(y))
            }
        }
    }

    /// Mode of the supervisor, where there is one.
    pub fn supervisor_mode(&self) -> Option<Mode> {
        match self {
            Self::Supervisor { supervisor, .. } => Some(supervisor.mode()),
            _ => None,
        }
    }
}
