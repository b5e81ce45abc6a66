//! A scene's loop sample by sample, for a program that has a clock of its own.

use super::bench::Bench;
use super::{Keep, Recorders, RunError, Task, bench_of_policy};
use crate::run::controller::{Force, Seen};
use crate::run::trace::TraceRow;
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use plant_model::{Change, V2};
use self_cell::self_cell;
use supervisor::Mode;

/// Who commands the magnets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driver {
    Policy(PolicyKind),
    /// Whoever calls, by [`Stepwise::command`].
    Caller,
}

self_cell!(
    struct Ride {
        owner: Scene,
        #[not_covariant]
        dependent: Bench,
    }
);

/// A scene at a control sample. Under a policy a whole run of it has the same rows, bit for bit, as the same scene has in
/// [`record`](super::record).
pub struct Stepwise {
    ride: Ride,
    driver: Driver,
    task: Task,
    /// The sample that it stands at.
    tick: u64,
    /// Commands of whoever calls \[N\].
    commands_n: Vec<V2>,
    /// What tells whether something has begun: touches, and the mode of each supervisor.
    state: (u64, Vec<Option<Mode>>),
}

impl Stepwise {
    /// A scene at its first sample.
    ///
    /// # Errors
    /// [`RunError`] where the scene lacks what the policy needs, or cannot be built.
    pub fn new(scene: Scene, driver: Driver) -> Result<Self, RunError> {
        let (kind, name) = match driver {
            Driver::Policy(kind) => (kind, kind.name()),
            Driver::Caller => (PolicyKind::Passive, "of the caller"),
        };
        let task = Task::keeping(Keep::Verdict, name);
        let planes = scene.planes.len();
        let ride = Ride::try_new(scene, |scene| {
            bench_of_policy(scene, kind, Recorders::default(), task)
        })?;
        let mut stepwise = Self {
            ride,
            driver,
            task,
            tick: 0,
            commands_n: vec![V2::zeros(); planes],
            state: (0, Vec::new()),
        };
        stepwise.sample()?;
        stepwise.state = stepwise.state_now();
        Ok(stepwise)
    }

    pub fn scene(&self) -> &Scene {
        self.ride.borrow_owner()
    }

    /// How many planes it has.
    pub fn planes(&self) -> usize {
        self.commands_n.len()
    }

    /// Time of the sample that it stands at \[s\].
    pub fn t_s(&self) -> f64 {
        self.ride.with_dependent(|_, bench| bench.at_s(self.tick))
    }

    /// The row of a plane at this sample, and what firmware sees there; `None` of a plane that there is not.
    pub fn at(&self, plane: usize) -> Option<(TraceRow, Seen)> {
        self.ride.with_dependent(|_, bench| {
            let station = bench.stations.get(plane)?;
            let (now, seen) = (bench.now.get(plane)?, bench.seen.get(plane)?);
            Some((station.sampled(now), *seen))
        })
    }

    /// Energy from nowhere over energy turned over, so far.
    pub fn energy_residual(&self) -> f64 {
        (self.ride).with_dependent(|_, bench| bench.rig.audit().residual())
    }

    /// The force that answers this sample \[N\], of a plane; what is fed forward comes on top. Without a policy.
    pub fn command(&mut self, plane: usize, force_n: V2) {
        if let Some(command_n) = self.commands_n.get_mut(plane) {
            *command_n = force_n;
        }
    }

    /// A force on the centre of mass beside the scene's loads, from now on \[N\]; where it [takes](Scene::takes_push) one.
    pub fn push(&mut self, force_n: V2) {
        (self.ride).with_dependent_mut(|_, bench| bench.rig.push(force_n));
    }

    /// Changes parameters of the plant from now on.
    ///
    /// # Errors
    /// [`RunError`] for values out of range, and for a change that the plant is not built for.
    pub fn change(&mut self, change: &Change) -> Result<(), RunError> {
        Ok((self.ride).with_dependent_mut(|_, bench| bench.rig.change(change))?)
    }

    /// To the next control sample. Returns whether something began on the way: a touch, another mode of a supervisor.
    ///
    /// # Errors
    /// [`RunError`]; after one nothing that is read counts.
    pub fn advance(&mut self) -> Result<bool, RunError> {
        let (tick, task) = (self.tick, self.task);
        let (driver, commands_n) = (self.driver, &self.commands_n);
        self.ride.with_dependent_mut(|_, bench| {
            if driver == Driver::Caller {
                let stations = bench.stations.iter_mut().zip(&bench.now);
                for ((station, now), force_n) in stations.zip(commands_n) {
                    station.command(tick, Force::Computed(*force_n), now);
                }
            }
            bench.carry_on(tick, task)
        })?;
        self.tick += 1;
        self.sample()?;
        let state = self.state_now();
        let began = state != self.state;
        self.state = state;
        Ok(began)
    }

    /// Whether the energy audit closes, as a run's has to at its end.
    ///
    /// # Errors
    /// [`RunError::Energy`].
    pub fn trusted(&self) -> Result<(), RunError> {
        let task = self.task;
        (self.ride).with_dependent(|_, bench| bench.trusted(task))
    }

    fn sample(&mut self) -> Result<(), RunError> {
        let (tick, task, driver) = (self.tick, self.task, self.driver);
        self.ride.with_dependent_mut(|_, bench| match driver {
            Driver::Policy(_) => bench.sample(tick, task),
            Driver::Caller => {
                bench.see(tick);
                Ok(())
            }
        })
    }

    fn state_now(&self) -> (u64, Vec<Option<Mode>>) {
        let planes = 0..self.planes();
        let touches = |plane| {
            let meters = |bench: &Bench<'_>| bench.rig.meters(plane).impacts;
            self.ride.with_dependent(|_, bench| meters(bench))
        };
        let mode = |plane| self.at(plane)?.0.supervisor_mode();
        (
            planes.clone().map(touches).sum(),
            planes.map(mode).collect(),
        )
    }
}
