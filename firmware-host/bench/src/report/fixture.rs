//! Small scenes and runs for tests.

use plant_model::{Body, ContactMode, Snapshot, V2};

use crate::report::summary::SceneSummary;
use crate::run::figures::{Figures, Timing};
use crate::run::outcome::Outcome;
use crate::run::supervision::Happenings;
use crate::run::trace::{Trace, TraceRow};
use crate::run::verdict::{PolicyRun, Verdict};

/// (time \[s\], in contact), in time order.
pub(super) type Samples = &'static [(f64, bool)];

/// A scene of 400 ms without disturbances.
pub(super) fn scene() -> SceneSummary {
    SceneSummary {
        title: "Title <b>".to_owned(),
        story: "A first\nparagraph.\n\nAnd a \"second\" one.".to_owned(),
        clearance_m: 2e-4,
        out_of_round: None,
        force_max_n: Some(500.0),
        whirl_speed_m_s: 1.0,
        facts: vec![("Mass", "10 kg".to_owned())],
        warnings: vec!["a <slip>".to_owned()],
        disturbances: Vec::new(),
        duration_s: 0.4,
    }
}

/// A run with a row at each sample.
pub(super) fn run(name: &str, outcome: Outcome, samples: &[(f64, bool)]) -> PolicyRun {
    PolicyRun {
        name: name.to_owned(),
        verdict: verdict(outcome),
        verification: None,
        supervision: None,
        happenings: Happenings::default(),
        trace: Trace {
            read_out: None,
            rows: samples
                .iter()
                .map(|(t_s, contact)| row(*t_s, *contact))
                .collect(),
        },
    }
}

fn verdict(outcome: Outcome) -> Verdict {
    let figures = Figures {
        outcome,
        recovered: outcome.recovered(),
        impacts: 1,
        first_contact_s: Some(0.05),
        peak_contact_force_n: 1e3,
        method: "series",
        ..Figures::default()
    };
    let timing = Timing {
        run_time_s: 0.1,
        real_time_ratio: 4.0,
    };
    Verdict { figures, timing }
}

/// On the x axis, moving up, with spin.
pub(crate) fn row(t_s: f64, contact: bool) -> TraceRow {
    let plant = Snapshot {
        t_s,
        position_m: V2::new(if contact { 2.1e-4 } else { 1e-4 }, 0.0),
        velocity_m_s: V2::new(0.0, 0.2),
        inner_ring: Body::default(),
        outer_ring: Body::default(),
        spin_rad_s: 600.0,
        race_spin_rad_s: 0.0,
        mode: if contact {
            ContactMode::SlipPositive
        } else {
            ContactMode::Flight
        },
        penetration_m: if contact { 1e-5 } else { -1e-4 },
        normal_force_n: if contact { 1e3 } else { 0.0 },
        sliding_force_n: 0.0,
        rolling_force_n: 0.0,
        contact_tangential_speed_m_s: 0.2,
        sliding_speed_m_s: 60.2,
        delivered_n: V2::new(100.0, 0.0),
        whirl_angle_rad: 0.0,
    };
    TraceRow {
        plant,
        measured_m: plant.position_m,
        commanded_n: V2::new(120.0, 0.0),
        supervisor: None,
        mode_change: false,
    }
}
