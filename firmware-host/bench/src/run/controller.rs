//! What may drive the magnet: baselines, and the supervisor in front of the levitation controller.

use crate::device::actuator::limited_n;
use crate::device::levitation::{Levitation, TrueLevitation, VelocityFilter};
use crate::device::sensor::Reading;
use crate::run::clairvoyant::Clairvoyant;
use crate::run::history::History;
use crate::run::trace::{FlightRecordBytes, ReadOut, Said};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::{Snapshot, V2};
use supervisor::{Command, Entry, IntegratorHint, Sample, Status, Supervisor};

/// Who supervises: the product as it is linked here, or wherever else it runs.
pub trait Supervise: core::fmt::Debug {
    /// One tick.
    fn tick(&mut self, sample: &Sample) -> Command;

    /// What it leaves behind; `None` where it cannot be asked.
    fn read_out(&self) -> Option<ReadOut> {
        None
    }
}

impl Supervise for Supervisor {
    fn tick(&mut self, sample: &Sample) -> Command {
        Supervisor::tick(self, sample)
    }

    fn read_out(&self) -> Option<ReadOut> {
        Some(ReadOut {
            report: self.report(),
            flight_record: self.record().map(|record| FlightRecordBytes {
                entries: record.entries().flat_map(Entry::to_bytes).collect(),
                crc: record.crc,
            }),
        })
    }
}

/// A policy at work.
#[derive(Debug)]
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
    /// Force against the speed only.
    Damping {
        /// Speed from positions.
        velocity: VelocityFilter,
        /// Force per speed \[N s/m\].
        coefficient_n_s_m: f64,
        /// Capacity \[N\].
        force_max_n: f64,
    },
    /// The saturated levitation controller alone.
    Levitation(Levitation),
    /// The reference that knows the true state.
    Clairvoyant(Clairvoyant),
    /// A levitation controller that knows it; the centre of its magnets \[m\] is seen from the retainer bearing's.
    TrueLevitation(TrueLevitation, V2),
    /// A history laid down beforehand, then that reference.
    History(Box<History>),
    /// The supervisor with that controller behind it.
    Supervisor {
        /// The product.
        supervisor: Box<dyn Supervise>,
        /// What it passes through.
        levitation: Levitation,
        /// What it told the controller's integrator.
        hint: IntegratorHint,
        /// What it said to the last sample.
        said: Option<Said>,
    },
}

/// What firmware knows at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Position and its number.
    pub reading: Reading,
    /// Spin as reported \[rad/s\].
    pub spin_rad_s: f64,
    /// Force that the magnet delivers \[N\]; counts with [`Status::APPLIED_VALID`].
    pub applied_n: V2,
    /// What is valid and ready.
    pub status: Status,
}

impl Policy {
    /// The policy set up for a scene; `None` where the scene lacks what it needs (which
    /// [`Scene::load`] refuses).
    pub fn new(kind: PolicyKind, scene: &Scene) -> Option<Self> {
        let force_n = scene.plant.magnet.map_or(0.0, |m| m.force_max_n);
        Some(match kind {
            PolicyKind::Passive => Self::Passive,
            PolicyKind::Radial => Self::Radial {
                band_m: scene.radial_band * scene.plant.contact.clearance_m,
                force_n,
            },
            PolicyKind::Damping => {
                let filter_s = scene.levitation.map_or(0.0, |l| l.derivative_filter_s);
                Self::Damping {
                    velocity: VelocityFilter::new(filter_s, 1.0 / scene.sample_rate_hz),
                    coefficient_n_s_m: scene.damping_n_s_m,
                    force_max_n: force_n,
                }
            }
            PolicyKind::Levitation => Self::Levitation(levitation_of(scene)?),
            PolicyKind::Supervisor => {
                let supervisor = Supervisor::new(&scene.supervisor?).ok()?;
                return Self::supervised(scene, Box::new(supervisor));
            }
        })
    }

    /// A supervisor of the caller's in front of the scene's levitation controller; `None` where the scene has
    /// no controller.
    pub fn supervised(scene: &Scene, supervisor: Box<dyn Supervise>) -> Option<Self> {
        Some(Self::Supervisor {
            supervisor,
            levitation: levitation_of(scene)?,
            hint: IntegratorHint::Run,
            said: None,
        })
    }

    /// One tick: what is seen in, commanded force \[N\] out.
    pub fn tick(&mut self, seen: &Seen) -> V2 {
        let measured_m = seen.reading.position_m;
        match self {
            Self::Passive | Self::Clairvoyant(_) | Self::TrueLevitation(..) | Self::History(_) => {
                V2::zeros()
            }
            Self::Radial { band_m, force_n } => {
                let radius = measured_m.norm();
                // An infinite reading has no direction.
                if radius.is_finite() && radius > *band_m {
                    measured_m * (-*force_n / radius)
                } else {
                    V2::zeros()
                }
            }
            Self::Damping {
                velocity,
                coefficient_n_s_m,
                force_max_n,
            } => {
                let speed = velocity.velocity_m_s(velocity.usable_m(measured_m));
                limited_n(-*coefficient_n_s_m * speed, *force_max_n)
            }
            Self::Levitation(levitation) => levitation.force_n(measured_m, IntegratorHint::Run),
            Self::Supervisor {
                supervisor,
                levitation,
                hint,
                said,
            } => {
                let single = |v: V2| [v.x as f32, v.y as f32];
                let levitation_n = single(levitation.force_n(measured_m, *hint));
                let command = supervisor.tick(&Sample {
                    sequence: seen.reading.sequence,
                    status: seen.status,
                    position_m: single(measured_m),
                    spin_rad_s: seen.spin_rad_s as f32,
                    levitation_n,
                    applied_n: single(seen.applied_n),
                });
                *hint = command.integrator;
                *said = Some(Said::new(&command, levitation_n));
                let [x, y] = command.force_n;
                V2::new(f64::from(x), f64::from(y))
            }
        }
    }

    /// Force for the true state \[N\], in effect at once; `None` for a policy that has to measure.
    pub fn of_truth(&self, now: &Snapshot) -> Option<V2> {
        match self {
            Self::Clairvoyant(clairvoyant) => Some(clairvoyant.force_n(now)),
            Self::TrueLevitation(levitation, centre_m) => {
                Some(levitation.force_n(now.position_m - *centre_m, now.velocity_m_s))
            }
            Self::History(history) => Some(history.force_n(now)),
            _ => None,
        }
    }

    /// What the supervisor said to the last sample, where there is one.
    pub fn said(&self) -> Option<Said> {
        match self {
            Self::Supervisor { said, .. } => *said,
            _ => None,
        }
    }

    /// What the supervisor leaves behind, where there is one that can be asked.
    pub fn read_out(&self) -> Option<ReadOut> {
        match self {
            Self::Supervisor { supervisor, .. } => supervisor.read_out(),
            _ => None,
        }
    }
}

/// The scene's levitation controller, where it has one.
fn levitation_of(scene: &Scene) -> Option<Levitation> {
    let force_n = scene.plant.magnet.map_or(0.0, |m| m.force_max_n);
    let period_s = 1.0 / scene.sample_rate_hz;
    Some(Levitation::new(scene.levitation?, period_s, force_n))
}
