//! A rotor with levitation alone, and with the supervisor in front of it.

use super::drawn::{Event, RotorCase};
use firmware_bench::run::closed_loop::{MachineRecorders, Rigour, record_machine};
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

/// Both runs of an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ran {
    /// What happened.
    pub event: Event,
    /// Levitation alone.
    pub alone: Run,
    /// With the supervisor.
    pub own: Run,
}

/// A policy on a scene; `None` where the run cannot be trusted.
pub(super) fn run(scene: &MachineScene, kind: PolicyKind) -> Option<Run> {
    let recorders = MachineRecorders {
        planes: Vec::new(),
        axis: None,
    };
    let planes = record_machine(scene, kind, recorders, Rigour::default(), &mut |_| {}).ok()?;
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
    Some(sum)
}

impl Ran {
    /// What comes of an event; `None` where a run cannot be trusted.
    pub fn new(rotor: &RotorCase, event: Event) -> Option<Self> {
        let scene = rotor.scene(event).ok()?;
        Some(Self {
            event,
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
