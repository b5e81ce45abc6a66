//! What may drive the magnet: baselines, and the supervisor in front of the levitation controller.

use crate::device::actuator::limited_n;
use crate::device::levitation::{Levitation, TrueLevitation, VelocityFilter};
use crate::device::sensor::Reading;
use crate::run::trace::{ReadOut, SupervisorTrace};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::{Snapshot, V2};
use supervisor::{
    Command, Events, IntegratorHint, Mode, Record, Sample, Scalar, Stamp, Status, Supervisor,
};

/// Who drives the magnet.
pub trait Controller: core::fmt::Debug {
    /// The force that answers a sample, from what firmware has seen; a reference may look at the truth.
    fn command(&mut self, seen: &Seen, truth: &Snapshot) -> Force;

    /// What the supervisor of a whole rotor is to be given of this plane; its answer comes by [`Self::answered`] before
    /// [`Self::command`]. `None` of who has nobody to ask.
    fn ask(&mut self, _seen: &Seen) -> Option<Sample> {
        None
    }

    /// What the supervisor of a whole rotor wants added to the force that [`Self::ask`] has \[N\].
    fn stimulated(&mut self, _stimulus_n: [f32; 2]) {}

    /// The answer.
    fn answered(&mut self, _command: Command) {}

    /// None, for it was the other plane's turn: what [`Self::ask`] had goes through to a levitated rotor, and what was commanded is
    /// held for any other.
    fn waits(&mut self) {}

    /// Whether it passes on what a levitation controller of the whole rotor asks for.
    fn levitates(&self) -> bool {
        false
    }

    /// What a levitation controller of the whole rotor is to do about its integrators.
    fn hint(&self) -> IntegratorHint {
        IntegratorHint::Run
    }

    /// Answer of a supervisor in it to the last sample.
    fn supervisor_trace(&self) -> Option<SupervisorTrace> {
        None
    }

    /// What a supervisor in it leaves behind; `None` also where it cannot be asked.
    fn read_out(&self) -> Option<ReadOut> {
        None
    }
}

/// A force asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Force {
    /// By firmware: in effect after the delay of the magnet \[N\].
    Computed(V2),
    /// By a reference: in effect at once \[N\].
    AtOnce(V2),
}

/// What firmware knows at a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Position and its number.
    pub reading: Reading,
    /// Where the levitation controller is to hold the rotor, as readings are counted \[m\].
    pub reference_m: V2,
    /// Spin as reported \[rad/s\].
    pub spin_rad_s: f64,
    /// Force that the magnet delivers \[N\]; counts with [`Status::APPLIED_VALID`].
    pub applied_n: V2,
    /// What is valid and ready.
    pub status: Status,
    /// Force that a levitation controller of the whole rotor, or a reference, asks this plane for \[N\]; zero where there is
    /// none.
    pub levitation_n: V2,
}

impl Seen {
    /// The reading as the levitation controller takes it: from its reference.
    pub(crate) fn off_reference(&self) -> Reading {
        Reading {
            position_m: self.reading.position_m - self.reference_m,
            ..self.reading
        }
    }
}

/// The controller of a policy, set up for a plane of a scene; `None` where the scene lacks what it needs (which
/// [`Scene::load`] refuses).
pub fn controller(kind: PolicyKind, scene: &Scene, plane: usize) -> Option<Box<dyn Controller>> {
    controller_beside(kind, (scene, plane), false)
}

/// The same; of a rotor that is supervised as a whole without a supervisor of its own.
pub(crate) fn controller_beside(
    kind: PolicyKind,
    (scene, plane): (&Scene, usize),
    supervised: bool,
) -> Option<Box<dyn Controller>> {
    let at = (scene, plane);
    if scene.planes[plane].magnet.is_none() {
        return Some(Box::new(Passive));
    }
    match scene.levitation {
        Some(_) => controller_over(kind, at, (Some(Passing), !supervised)),
        None => controller_over(kind, at, (own_levitation(scene, plane), !supervised)),
    }
}

/// The controller of a policy over whoever levitates, where somebody does; `own`: with a supervisor of its own.
fn controller_over<L: Levitate + Controller + 'static>(
    kind: PolicyKind,
    (scene, plane): (&Scene, usize),
    (levitation, own): (Option<L>, bool),
) -> Option<Box<dyn Controller>> {
    let (plane, force_max_n, clearance_m) = (
        &scene.planes[plane],
        scene.force_max_n(plane),
        scene.clearance_m(plane),
    );
    Some(match kind {
        PolicyKind::Passive => Box::new(Passive),
        PolicyKind::Radial => Box::new(Radial {
            band_m: plane.radial_band * clearance_m,
            force_n: force_max_n,
        }),
        PolicyKind::Damping => {
            let filter_s = plane.levitation.map_or(0.0, |l| l.derivative_filter_s);
            Box::new(Damping {
                velocity: VelocityFilter::new(filter_s, 1.0 / scene.sample_rate_hz),
                coefficient_n_s_m: plane.damping_n_s_m,
                force_max_n,
            })
        }
        PolicyKind::Levitation => Box::new(levitation?),
        PolicyKind::Supervisor => {
            let supervisor: Option<Box<dyn Supervise>> = match own {
                true => Some(Box::new(Supervisor::new(&plane.supervisor?).ok()?)),
                false => None,
            };
            Box::new(Supervised::new(supervisor, Box::new(levitation?)))
        }
    })
}

/// A supervisor of the caller's in front of the levitation controller of the first plane; `None` where it has none.
pub fn supervised(scene: &Scene, supervisor: Box<dyn Supervise>) -> Option<Box<dyn Controller>> {
    let levitation: Box<dyn Levitate> = match scene.levitation {
        Some(_) => Box::new(Passing),
        None => Box::new(own_levitation(scene, 0)?),
    };
    Some(Box::new(Supervised::new(Some(supervisor), levitation)))
}

/// Who levitates: a controller of the plane's own, or whoever levitates the whole rotor.
trait Levitate: core::fmt::Debug {
    fn levitation_n(&mut self, seen: &Seen, hint: IntegratorHint) -> V2;
}

impl Levitate for Levitation {
    fn levitation_n(&mut self, seen: &Seen, hint: IntegratorHint) -> V2 {
        self.force_n(seen.off_reference().position_m, hint)
    }
}

/// Passes on what the controller of the whole rotor asks for.
#[derive(Debug)]
struct Passing;

impl Levitate for Passing {
    fn levitation_n(&mut self, seen: &Seen, _hint: IntegratorHint) -> V2 {
        seen.levitation_n
    }
}

impl Controller for Passing {
    fn command(&mut self, seen: &Seen, _truth: &Snapshot) -> Force {
        Force::Computed(seen.levitation_n)
    }

    fn levitates(&self) -> bool {
        true
    }
}

/// Passes on, at once, what a reference of the whole rotor asks for.
#[derive(Debug)]
pub(crate) struct Referred;

impl Controller for Referred {
    fn command(&mut self, seen: &Seen, _truth: &Snapshot) -> Force {
        Force::AtOnce(seen.levitation_n)
    }
}

/// The levitation controller of a plane by gains, where it has one.
fn own_levitation(scene: &Scene, plane: usize) -> Option<Levitation> {
    let (period_s, force_max_n) = (1.0 / scene.sample_rate_hz, scene.force_max_n(plane));
    Some(Levitation::new(
        scene.planes[plane].levitation?,
        period_s,
        force_max_n,
    ))
}

/// No force.
#[derive(Debug)]
struct Passive;

impl Controller for Passive {
    fn command(&mut self, _seen: &Seen, _truth: &Snapshot) -> Force {
        Force::Computed(V2::zeros())
    }
}

/// The whole capacity inwards outside a band.
#[derive(Debug)]
struct Radial {
    /// Radius of the band \[m\].
    band_m: f64,
    /// Capacity \[N\].
    force_n: f64,
}

impl Controller for Radial {
    fn command(&mut self, seen: &Seen, _truth: &Snapshot) -> Force {
        let measured_m = seen.reading.position_m;
        let radius = measured_m.norm();
        // An infinite reading has no direction.
        Force::Computed(if radius.is_finite() && radius > self.band_m {
            measured_m * (-self.force_n / radius)
        } else {
            V2::zeros()
        })
    }
}

/// Force against the speed only.
#[derive(Debug)]
struct Damping {
    /// Speed from positions.
    velocity: VelocityFilter,
    /// Force per speed \[N s/m\].
    coefficient_n_s_m: f64,
    /// Capacity \[N\].
    force_max_n: f64,
}

impl Controller for Damping {
    fn command(&mut self, seen: &Seen, _truth: &Snapshot) -> Force {
        let usable_m = self.velocity.usable_m(seen.reading.position_m);
        let speed = self.velocity.velocity_m_s(usable_m);
        Force::Computed(limited_n(-self.coefficient_n_s_m * speed, self.force_max_n))
    }
}

/// The saturated levitation controller alone.
impl Controller for Levitation {
    fn command(&mut self, seen: &Seen, _truth: &Snapshot) -> Force {
        Force::Computed(self.force_n(seen.off_reference().position_m, IntegratorHint::Run))
    }
}

impl Controller for TrueLevitation {
    fn command(&mut self, _seen: &Seen, truth: &Snapshot) -> Force {
        Force::AtOnce(self.force_n(truth.position_m, truth.velocity_m_s))
    }
}

/// Who supervises: the product as it is linked here, or wherever else it runs.
pub trait Supervise: core::fmt::Debug {
    fn tick(&mut self, sample: &Sample) -> Command;

    /// What it wants added to the force that the levitation controller asks for next \[N\], to check its configuration.
    fn stimulus_n(&self) -> [f32; 2] {
        [0.0; 2]
    }

    /// What it leaves behind; `None` where it cannot be asked.
    fn read_out(&self) -> Option<ReadOut> {
        None
    }
}

impl Supervise for Supervisor {
    fn tick(&mut self, sample: &Sample) -> Command {
        Supervisor::tick(self, sample)
    }

    fn stimulus_n(&self) -> [f32; 2] {
        Supervisor::stimulus_n(self)
    }

    fn read_out(&self) -> Option<ReadOut> {
        Some(ReadOut {
            report: self.report(),
            flight_record: self
                .record()
                .map(|record| written(&record, &Stamp::default())),
        })
    }
}

/// A record as firmware would write it.
pub fn written<S: Scalar, const N: usize>(record: &Record<'_, S, N>, stamp: &Stamp) -> Vec<u8> {
    let sections = (0..).map_while(|i| record.section(i, stamp));
    sections
        .flat_map(|mut section| section.seal().to_vec())
        .collect()
}

/// A supervisor with the levitation controller behind it.
#[derive(Debug)]
struct Supervised {
    /// Its own; none where that of the whole rotor answers.
    supervisor: Option<Box<dyn Supervise>>,
    /// The command of this sample, where it is there already, and that of the sample before.
    command: Option<Command>,
    last: Command,
    /// What it passes through.
    levitation: Box<dyn Levitate>,
    /// What that asked for at the last sample \[N\].
    levitation_n: [f32; 2],
    /// What of it the supervisor had asked for \[N\].
    stimulus_n: [f32; 2],
    /// Its hint to the controller's integrator.
    hint: IntegratorHint,
    trace: Option<SupervisorTrace>,
}

impl Supervised {
    fn new(supervisor: Option<Box<dyn Supervise>>, levitation: Box<dyn Levitate>) -> Self {
        Self {
            supervisor,
            command: None,
            last: Command::default(),
            levitation,
            levitation_n: [0.0; 2],
            stimulus_n: [0.0; 2],
            hint: IntegratorHint::Run,
            trace: None,
        }
    }
}

impl Controller for Supervised {
    fn stimulated(&mut self, stimulus_n: [f32; 2]) {
        self.stimulus_n = stimulus_n;
    }

    fn ask(&mut self, seen: &Seen) -> Option<Sample> {
        let single = |v: V2| [v.x as f32, v.y as f32];
        let [x, y] = single(self.levitation.levitation_n(seen, self.hint));
        if let Some(supervisor) = &self.supervisor {
            self.stimulus_n = supervisor.stimulus_n();
        }
        let [more_x, more_y] = self.stimulus_n;
        self.levitation_n = [x + more_x, y + more_y];
        Some(Sample {
            sequence: seen.reading.sequence,
            status: seen.status,
            position_m: single(seen.reading.position_m),
            spin_rad_s: seen.spin_rad_s as f32,
            levitation_n: self.levitation_n,
            applied_n: single(seen.applied_n),
        })
    }

    fn answered(&mut self, command: Command) {
        self.command = Some(command);
    }

    fn waits(&mut self) {
        let held = match self.last.mode {
            Mode::Levitated => self.levitation_n,
            _ => self.last.force_n,
        };
        self.command = Some(Command {
            force_n: held,
            events: Events::empty(),
            ..self.last
        });
    }

    fn command(&mut self, seen: &Seen, _truth: &Snapshot) -> Force {
        let answered = self.command.take().or_else(|| {
            let sample = self.ask(seen)?;
            Some(self.supervisor.as_mut()?.tick(&sample))
        });
        let Some(command) = answered else {
            return Force::Computed(V2::zeros());
        };
        self.last = command;
        self.hint = command.integrator;
        self.trace = Some(SupervisorTrace {
            stimulus_n: self.stimulus_n,
            ..SupervisorTrace::new(&command, self.levitation_n)
        });
        let [x, y] = command.force_n;
        Force::Computed(V2::new(f64::from(x), f64::from(y)))
    }

    fn levitates(&self) -> bool {
        true
    }

    fn hint(&self) -> IntegratorHint {
        self.hint
    }

    fn supervisor_trace(&self) -> Option<SupervisorTrace> {
        self.trace
    }

    fn read_out(&self) -> Option<ReadOut> {
        self.supervisor.as_ref()?.read_out()
    }
}
