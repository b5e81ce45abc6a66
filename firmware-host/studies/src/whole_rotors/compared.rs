//! A rotor with levitation alone, and with the supervisor in front of it.

use super::drawn::{Event, RotorCase};
use firmware_bench::run::closed_loop::{MachineRecorders, Rigour, record_machine};
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::machine::MachineScene;
use firmware_bench::scene::policy_kind::PolicyKind;

/// What counts of a run, of both planes together.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Run {
    /// Back in the middle in both.
    pub recovered: bool,
    /// Number of touches.
    pub touches: u64,
    /// Largest normal force \[N\].
    pub force_n: f64,
    /// ∫ N dt \[N s\].
    pub impulse_n_s: f64,
}

/// Both runs of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ran {
    /// Levitation alone.
    pub alone: Run,
    /// With the supervisor.
    pub own: Run,
}

/// A policy on a scene.
///
/// # Errors
/// Why the run cannot be trusted.
pub(super) fn run(scene: &MachineScene, kind: PolicyKind) -> Result<Run, String> {
    let recorders = MachineRecorders {
        planes: Vec::new(),
        axis: None,
    };
    let planes = record_machine(scene, kind, recorders, Rigour::default(), &mut |_| {})
        .map_err(|error| error.to_string())?;
    let mut sum = Run {
        recovered: true,
        ..Run::default()
    };
    for (figures, _) in &planes {
        sum.recovered &= figures.recovered;
        sum.touches += figures.impacts;
        sum.force_n = sum.force_n.max(figures.peak_contact_force_n);
        sum.impulse_n_s += figures.contact_impulse_n_s;
    }
    Ok(sum)
}

/// So long levitation alone has to hold a rotor for it to count \[s\]: some loops drive a mode so slowly that they recover
/// from an event first.
pub(super) const HOLDS_S: f64 = 3.0;

/// Whether levitation alone has the rotor in the middle at the end of a scene, one of [`HOLDS_S`].
pub(super) fn is_held(scene: Result<MachineScene, SceneError>) -> bool {
    scene.is_ok_and(|scene| run(&scene, PolicyKind::Levitation).is_ok_and(|ran| ran.recovered))
}

/// Both runs of a scene, or why one of them cannot be trusted.
pub(super) type Tried = Result<Ran, String>;

/// What a list says of a pair; `None` where there is nothing to say.
pub(super) fn told_of(tried: &Tried) -> Option<String> {
    match tried {
        Err(why) => Some(format!("cannot be trusted ({why})")),
        Ok(ran) if ran.is_lost() => Some("lost".to_owned()),
        Ok(ran) if ran.is_hammered() => Some("struck on and on".to_owned()),
        Ok(_) => None,
    }
}

impl Ran {
    /// What comes of an event.
    ///
    /// # Errors
    /// Why a run cannot be trusted.
    pub fn new(rotor: &RotorCase, event: Event) -> Result<Self, String> {
        Self::of(rotor.scene(event))
    }

    /// What comes of a scene.
    ///
    /// # Errors
    /// Why there is none, or why a run cannot be trusted.
    pub(super) fn of(scene: Result<MachineScene, SceneError>) -> Tried {
        let scene = scene.map_err(|error| error.to_string())?;
        Ok(Self {
            alone: run(&scene, PolicyKind::Levitation)?,
            own: run(&scene, PolicyKind::Supervisor)?,
        })
    }

    /// Whether only levitation alone recovered.
    pub fn is_lost(&self) -> bool {
        self.alone.recovered && !self.own.recovered
    }

    /// Whether the rotor is struck on and on with the supervisor alone: twice the touches, and ten more.
    pub fn is_hammered(&self) -> bool {
        self.own.touches > 2 * self.alone.touches + 10
    }
}

/// What came of many scenes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sum {
    pub(super) runs: u64,
    pub(super) untrusted: u64,
    pub(super) alone: u64,
    pub(super) own: u64,
    pub(super) lost: u64,
    pub(super) gained: u64,
    pub(super) hammered: u64,
    /// Where both recover.
    touches: [u64; 2],
    impulse_n_s: [f64; 2],
}

impl Sum {
    pub(super) fn of<'a>(all: impl Iterator<Item = &'a Tried>) -> Self {
        let mut sum = Self::default();
        for ran in all {
            sum.runs += 1;
            let Ok(ran) = ran else {
                sum.untrusted += 1;
                continue;
            };
            let (alone, own) = (&ran.alone, &ran.own);
            sum.alone += u64::from(alone.recovered);
            sum.own += u64::from(own.recovered);
            sum.lost += u64::from(ran.is_lost());
            sum.gained += u64::from(own.recovered && !alone.recovered);
            sum.hammered += u64::from(ran.is_hammered());
            if alone.recovered && own.recovered {
                for (i, run) in [alone, own].into_iter().enumerate() {
                    sum.touches[i] += run.touches;
                    sum.impulse_n_s[i] += run.impulse_n_s;
                }
            }
        }
        sum
    }

    pub(super) fn touched(&self) -> f64 {
        self.touches[1] as f64 / self.touches[0] as f64
    }

    pub(super) fn cells(&self, name: String) -> [String; 9] {
        let impulse = self.impulse_n_s[1] / self.impulse_n_s[0];
        let ratio = |x: f64| match x.is_finite() {
            true => format!("{x:.2}"),
            false => "–".to_owned(),
        };
        [
            name,
            self.runs.to_string(),
            self.alone.to_string(),
            self.own.to_string(),
            self.lost.to_string(),
            self.gained.to_string(),
            self.hammered.to_string(),
            ratio(self.touched()),
            ratio(impulse),
        ]
    }
}

/// Headings of [`Sum::cells`].
pub(super) const COLUMNS: [&str; 9] = [
    "event",
    "pairs",
    "levitation alone",
    "supervisor",
    "lost",
    "gained",
    "struck on and on",
    "touches",
    "impulse",
];
