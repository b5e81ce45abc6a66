//! A scene under levitation alone, and with the supervisor in front of it.

use firmware_bench::run::closed_loop::{Accuracy, Recorders, record};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::outcome::Outcome as Ending;
use firmware_bench::run::trace::{Recorder, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use supervisor::Events;

/// What a run is to end in to count as a recovery.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Goal {
    /// Free of the wall.
    Free,
    /// Free of the wall or lying on it: not bouncing, not in whirl.
    SetDown,
}

/// What counts of a run, of all planes together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Outcome {
    /// It ended in its goal, in every plane.
    pub recovered: bool,
    /// Number of touches.
    pub touches: u64,
    /// Largest normal force \[N\].
    pub force_n: f64,
    /// ∫ N dt \[N s\].
    pub impulse_n_s: f64,
    /// Time in contact, of the plane that has the longest \[s\].
    pub contact_s: f64,
    /// It whirled backward, in any plane.
    pub whirled: bool,
}

impl Outcome {
    fn of(planes: &[Figures], goal: Goal) -> Self {
        let ended = |f: &Figures| match goal {
            Goal::Free => f.recovered,
            Goal::SetDown => f.recovered || matches!(f.outcome, Ending::Resting | Ending::Rubbing),
        };
        Self {
            recovered: planes.iter().all(ended),
            touches: planes.iter().map(|f| f.impacts).sum(),
            force_n: (planes.iter().map(|f| f.peak_contact_force_n)).fold(0.0, f64::max),
            impulse_n_s: planes.iter().map(|f| f.contact_impulse_n_s).sum(),
            contact_s: (planes.iter().map(|f| f.contact_time_s)).fold(0.0, f64::max),
            whirled: planes.iter().any(|f| f.outcome == Ending::Whirl),
        }
    }

    /// Whether the rotor has touched, or began on the wall.
    pub fn touched(&self) -> bool {
        self.force_n > 0.0
    }
}

/// What the supervisor did, of all planes together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Engaged {
    /// Time of the run \[s\].
    pub run_s: f64,
    /// Time in which it had the bearing, alone or in part \[s\] …
    pub engaged_s: f64,
    /// … and the longest without a break \[s\].
    pub longest_s: f64,
    /// Times that it took over.
    pub engagements: u64,
    /// Times that it gave the bearing back because it made no progress.
    pub handed_back: u64,
}

impl Engaged {
    /// Share of the time in which it had the bearing.
    pub fn share(&self) -> f64 {
        self.engaged_s / self.run_s.max(f64::MIN_POSITIVE)
    }

    fn and(self, other: &Self) -> Self {
        Self {
            run_s: self.run_s + other.run_s,
            engaged_s: self.engaged_s + other.engaged_s,
            longest_s: self.longest_s.max(other.longest_s),
            engagements: self.engagements + other.engagements,
            handed_back: self.handed_back + other.handed_back,
        }
    }
}

/// Counts what the supervisor says at control samples.
#[derive(Debug, Default)]
struct Counter {
    period_s: f64,
    running_s: f64,
    counted: Engaged,
}

impl Recorder for Counter {
    fn row(&mut self, row: &TraceRow) {
        let Some(trace) = row.supervisor.filter(|_| !row.mode_change) else {
            return;
        };
        let counted = &mut self.counted;
        counted.run_s += self.period_s;
        counted.engagements += u64::from(trace.events.contains(Events::ENGAGED));
        counted.handed_back += u64::from(trace.events.contains(Events::HANDED_BACK));
        if trace.mode.is_engaged() {
            counted.engaged_s += self.period_s;
            self.running_s += self.period_s;
            counted.longest_s = counted.longest_s.max(self.running_s);
        } else {
            self.running_s = 0.0;
        }
    }
}

/// Both runs of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Levitation alone.
    pub levitation: Outcome,
    pub supervisor: Outcome,
    /// What it did.
    pub engaged: Engaged,
}

impl Pair {
    /// Whether only levitation alone recovers.
    pub fn is_lost(&self) -> bool {
        self.levitation.recovered && !self.supervisor.recovered
    }

    /// Whether only the supervisor does.
    pub(crate) fn is_gained(&self) -> bool {
        self.supervisor.recovered && !self.levitation.recovered
    }

    /// Whether the rotor touches with the supervisor only.
    pub(crate) fn newly_touches(&self) -> bool {
        self.supervisor.touched() && !self.levitation.touched()
    }

    /// Whether the rotor is struck on and on with the supervisor alone: twice the touches, and ten more.
    pub(crate) fn is_struck_on(&self) -> bool {
        self.supervisor.touches > 2 * self.levitation.touches + 10
    }

    /// Whether both recover and levitation alone touches.
    pub(crate) fn is_comparable(&self) -> bool {
        self.both_recover() && self.levitation.touched()
    }

    /// Whether both recover.
    pub(crate) fn both_recover(&self) -> bool {
        self.levitation.recovered && self.supervisor.recovered
    }
}

/// Why there is no pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoPair {
    /// The supervisor refuses its configuration.
    Refused(String),
    /// A run cannot be trusted.
    Untrusted(String),
}

/// A pair, or why there is none.
pub type Tried = Result<Pair, NoPair>;

/// What a list says of a pair; `None` where there is nothing to say.
pub fn remark(tried: &Tried) -> Option<String> {
    match tried {
        Err(NoPair::Refused(_)) => None,
        Err(NoPair::Untrusted(why)) => Some(format!("cannot be trusted ({why})")),
        Ok(pair) if pair.is_lost() => Some("lost".to_owned()),
        Ok(pair) if pair.is_struck_on() => Some("struck on and on".to_owned()),
        Ok(pair) if pair.newly_touches() => Some("touches only with the supervisor".to_owned()),
        Ok(_) => None,
    }
}

/// A scene under a policy, to come free of the wall.
///
/// # Errors
/// Why the run cannot be trusted.
pub(crate) fn run_rotor(scene: &Scene, kind: PolicyKind) -> Result<Outcome, String> {
    run(scene, kind, Goal::Free).map(|(outcome, _)| outcome)
}

fn run(scene: &Scene, kind: PolicyKind, goal: Goal) -> Result<(Outcome, Engaged), String> {
    let counter = |_| Counter {
        period_s: 1.0 / scene.sample_rate_hz,
        ..Counter::default()
    };
    let mut counters: Vec<Counter> = scene.planes.iter().map(counter).collect();
    let recorders = Recorders::of_planes(&mut counters);
    let ended = record(scene, kind, recorders, Accuracy::default(), &mut |_| {})
        .map_err(|error| error.to_string())?;
    let engaged = (counters.iter()).fold(Engaged::default(), |sum, c| sum.and(&c.counted));
    let planes: Vec<Figures> = ended.into_iter().map(|(figures, _)| figures).collect();
    Ok((Outcome::of(&planes, goal), engaged))
}

/// Why the supervisor refuses what it is configured with.
fn refused(scene: &Scene) -> Option<String> {
    let mut configs = scene.planes.iter().filter_map(|plane| plane.supervisor);
    let of_a_plane = configs.find_map(|config| config.validate().err());
    let whole = || {
        let refused = scene.supervised().is_some() && scene.supervisor().is_none();
        refused.then(|| "the whole rotor".to_owned())
    };
    of_a_plane.map(|error| error.to_string()).or_else(whole)
}

/// Runs a scene both ways.
///
/// # Errors
/// Why there is no pair.
pub fn pair(scene: &Scene, goal: Goal) -> Tried {
    if let Some(why) = refused(scene) {
        return Err(NoPair::Refused(why));
    }
    let run = |kind| run(scene, kind, goal).map_err(NoPair::Untrusted);
    let (levitation, _) = run(PolicyKind::Levitation)?;
    let (supervisor, engaged) = run(PolicyKind::Supervisor)?;
    Ok(Pair {
        levitation,
        supervisor,
        engaged,
    })
}

/// So long levitation alone has to hold a rotor for it to count \[s\]: some loops drive a mode so slowly that they recover
/// from an event first.
pub(crate) const HOLDS_S: f64 = 3.0;

/// Whether levitation alone has the rotor in the middle at the end of a scene, one of `HOLDS_S`.
pub fn is_held(scene: &Scene) -> bool {
    run_rotor(scene, PolicyKind::Levitation).is_ok_and(|outcome| outcome.recovered)
}
