//! A run with levitation alone beside one with the supervisor in front of it.

use firmware_bench::run::closed_loop::{Keep, run, run_policy};
use firmware_bench::run::controller::{Supervise, supervised};
use firmware_bench::run::trace::ReadOut;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use serde::Serialize;
use std::cell::RefCell;
use std::rc::Rc;
use supervisor::{Command, Events, Sample, Supervisor};

/// What counts of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Figures {
    /// Back in the middle.
    pub recovered: bool,
    /// Number of touches.
    pub touches: u64,
    /// Largest normal force \[N\].
    pub force_n: f64,
    /// ∫ N dt \[N s\].
    pub impulse_n_s: f64,
}

impl Figures {
    /// Whether the rotor has touched, or began on the wall.
    pub fn touched(&self) -> bool {
        self.force_n > 0.0
    }
}

/// What the supervisor did.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Engaged {
    /// Time of the run \[s\].
    pub run_s: f64,
    /// Time in which it had the bearing, alone or in part \[s\] …
    pub engaged_s: f64,
    /// … and the longest without a break \[s\].
    pub longest_s: f64,
    /// Times that it took over.
    pub engagements: u64,
    /// Times that it gave the bearing back because it came no farther.
    pub handed_back: u64,
}

impl Engaged {
    /// Share of the time in which it had the bearing.
    pub fn share(&self) -> f64 {
        self.engaged_s / self.run_s.max(f64::MIN_POSITIVE)
    }
}

/// Both runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pair {
    /// Levitation alone.
    pub alone: Figures,
    /// With the supervisor.
    pub own: Figures,
    /// What it did.
    pub engaged: Engaged,
}

/// The supervisor with somebody who counts what it says.
#[derive(Debug)]
struct Counting {
    inner: Supervisor<64>,
    counted: Rc<RefCell<Engaged>>,
    period_s: f64,
    running_s: f64,
}

impl Supervise for Counting {
    fn tick(&mut self, sample: &Sample) -> Command {
        let command = self.inner.tick(sample);
        let mut counted = self.counted.borrow_mut();
        counted.run_s += self.period_s;
        counted.engagements += u64::from(command.events.contains(Events::ENGAGED));
        counted.handed_back += u64::from(command.events.contains(Events::HANDED_BACK));
        if command.mode.is_engaged() {
            counted.engaged_s += self.period_s;
            self.running_s += self.period_s;
            counted.longest_s = counted.longest_s.max(self.running_s);
        } else {
            self.running_s = 0.0;
        }
        command
    }

    fn read_out(&self) -> Option<ReadOut> {
        None
    }
}

/// Runs a scene both ways; `None` where a run cannot be trusted.
pub fn compare(scene: &Scene) -> Option<Pair> {
    let (alone, _) = run(scene, PolicyKind::Levitation, Keep::Verdict, &mut |_| {}).ok()?;
    let counted = Rc::new(RefCell::new(Engaged::default()));
    let supervisor = Counting {
        inner: Supervisor::new(&scene.supervisor?).ok()?,
        counted: Rc::clone(&counted),
        period_s: 1.0 / scene.sample_rate_hz,
        running_s: 0.0,
    };
    let policy = supervised(scene, Box::new(supervisor))?;
    let (own, _) = run_policy(scene, (policy, "supervisor"), Keep::Verdict, &mut |_| {}).ok()?;
    let figures = |v: &firmware_bench::run::figures::Figures| Figures {
        recovered: v.recovered,
        touches: v.impacts,
        force_n: v.peak_contact_force_n,
        impulse_n_s: v.contact_impulse_n_s,
    };
    let engaged = *counted.borrow();
    Some(Pair {
        alone: figures(&alone),
        own: figures(&own),
        engaged,
    })
}
