//! A scene's loop sample by sample, for a program that has a clock of its own.

use super::sample_hold::ClosedLoop;
use super::{Keep, Recorders, RunError, Task, loop_of_policy};
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
    struct OwnedLoop {
        owner: Scene,
        #[not_covariant]
        dependent: ClosedLoop,
    }
);

/// A scene at a control sample. Under a policy a whole run of it has the same rows, bit for bit, as the same scene has in
/// [`record`](super::record).
pub struct Stepwise {
    owned: OwnedLoop,
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
        let owned = OwnedLoop::try_new(scene, |scene| {
            loop_of_policy(scene, kind, Recorders::default(), task)
        })?;
        let mut stepwise = Self {
            owned,
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
        self.owned.borrow_owner()
    }

    /// How many planes it has.
    pub fn planes(&self) -> usize {
        self.commands_n.len()
    }

    /// Time of the sample that it stands at \[s\].
    pub fn t_s(&self) -> f64 {
        self.owned.with_dependent(|_, sim| sim.at_s(self.tick))
    }

    /// The row of a plane at this sample, and what firmware sees there; `None` of a plane that there is not.
    pub fn at(&self, plane: usize) -> Option<(TraceRow, Seen)> {
        self.owned.with_dependent(|_, sim| {
            let station = sim.stations.get(plane)?;
            let (now, seen) = (sim.now.get(plane)?, sim.seen.get(plane)?);
            Some((station.sampled(now), *seen))
        })
    }

    /// Energy from nowhere over energy turned over, so far.
    pub fn energy_residual(&self) -> f64 {
        (self.owned).with_dependent(|_, sim| sim.rig.audit().residual())
    }

    /// The force that answers this sample \[N\], of a plane; what is fed forward comes on top. Without a policy.
    pub fn command(&mut self, plane: usize, force_n: V2) {
        if let Some(command_n) = self.commands_n.get_mut(plane) {
            *command_n = force_n;
        }
    }

    /// A force on the centre of mass beside the scene's loads, from now on \[N\]; where it [takes](Scene::takes_push) one.
    pub fn push(&mut self, force_n: V2) {
        (self.owned).with_dependent_mut(|_, sim| sim.rig.push(force_n));
    }

    /// Changes parameters of the plant from now on.
    ///
    /// # Errors
    /// [`RunError`] for values out of range, and for a change that the plant is not built for.
    pub fn change(&mut self, change: &Change) -> Result<(), RunError> {
        Ok((self.owned).with_dependent_mut(|_, sim| sim.rig.change(change))?)
    }

    /// To the next control sample. Returns whether something began on the way: a touch, another mode of a supervisor.
    ///
    /// # Errors
    /// [`RunError`]; after one nothing that is read counts.
    pub fn advance(&mut self) -> Result<bool, RunError> {
        let (tick, task) = (self.tick, self.task);
        let (driver, commands_n) = (self.driver, &self.commands_n);
        self.owned.with_dependent_mut(|_, sim| {
            if driver == Driver::Caller {
                let stations = sim.stations.iter_mut().zip(&sim.now);
                for ((station, now), force_n) in stations.zip(commands_n) {
                    station.command(tick, Force::Computed(*force_n), now);
                }
            }
            sim.advance_plant(tick, task)
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
        (self.owned).with_dependent(|_, sim| sim.trusted(task))
    }

    fn sample(&mut self) -> Result<(), RunError> {
        let (tick, task, driver) = (self.tick, self.task, self.driver);
        self.owned.with_dependent_mut(|_, sim| match driver {
            Driver::Policy(_) => sim.sample(tick, task),
            Driver::Caller => {
                sim.read_sensors(tick);
                Ok(())
            }
        })
    }

    fn state_now(&self) -> (u64, Vec<Option<Mode>>) {
        let planes = 0..self.planes();
        let touches = |plane| {
            let meters = |sim: &ClosedLoop<'_>| sim.rig.meters(plane).impacts;
            self.owned.with_dependent(|_, sim| meters(sim))
        };
        let mode = |plane| self.at(plane)?.0.supervisor_mode();
        (
            planes.clone().map(touches).sum(),
            planes.map(mode).collect(),
        )
    }
}
