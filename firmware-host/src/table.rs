//! The verdicts as a table for people and as JSON for programs.

use crate::scene::Scene;
use crate::verdict::{Check, Outcome, PolicyRun, Verdict, Verification};
use comfy_table::{Cell, CellAlignment, Row, Table, presets};
use std::fmt::Display;

/// Rows of the table: name with unit, and the value as text.
type Figure = (&'static str, fn(&Verdict) -> String);

const FIGURES: &[Figure] = &[
    ("outcome", |v| outcome(v.outcome).to_owned()),
    ("impacts", |v| v.impacts.to_string()),
    ("contact time [ms]", |v| {
        format!("{:.3}", v.contact_time_s * 1e3)
    }),
    ("contact impulse [N s]", |v| {
        format!("{:.3}", v.contact_impulse_n_s)
    }),
    ("contacts over 20 mm/s", |v| {
        v.contacts_over_20_mm_s.to_string()
    }),
    ("first contact [ms]", |v| or_dash(v.first_contact_s, 1e3, 2)),
    ("peak penetration [µm]", |v| {
        format!("{:.2}", v.peak_penetration_m * 1e6)
    }),
    ("peak contact force [N]", |v| {
        format!("{:.0}", v.peak_contact_force_n)
    }),
    ("peak friction torque [N m]", |v| {
        format!("{:.1}", v.peak_friction_torque_n_m)
    }),
    ("spin lost [Hz]", |v| format!("{:.2}", v.spin_lost_hz)),
    ("max backward whirl [Hz]", |v| {
        or_dash(v.max_backward_whirl_hz, 1.0, 1)
    }),
    ("re-levitated after [ms]", |v| {
        or_dash(v.relevitation_time_s, 1e3, 2)
    }),
    ("energy-audit residual", |v| {
        format!("{:.1e}", v.energy_residual)
    }),
    ("method", |v| v.method.to_owned()),
    ("run time [ms]", |v| format!("{:.1}", v.run_time_s * 1e3)),
    ("ratio to real time", |v| {
        format!("{:.0}", v.real_time_ratio)
    }),
];

/// Rows below those, where runs were checked.
type CheckFigure = (&'static str, fn(&Verification) -> String);

const CHECK_FIGURES: &[CheckFigure] = &[
    ("checked by", |v| {
        each(v, |c| format!("{} {:.0e}", c.method, c.rtol))
    }),
    ("outcome when checked", |v| match v.same_outcome {
        true => "the same".to_owned(),
        false => format!("OTHER: {}", each(v, |c| outcome(c.outcome).to_owned())),
    }),
    ("modes when checked", |v| match v.same_modes {
        true => format!("the same {}", v.mode_changes),
        false => format!(
            "{}, not {}",
            each(v, |c| c.mode_changes.to_string()),
            v.mode_changes
        ),
    }),
    ("estimated error at the end [c]", |v| {
        format!("{:.1e}", v.estimated_error_clearances)
    }),
    ("largest difference [c]", |v| {
        format!("{:.1e}", v.largest_difference_clearances)
    }),
    ("apart by 1e-3 c from [ms]", |v| {
        or_dash(v.differs_from_s, 1e3, 2)
    }),
];

/// A word for each check.
pub(crate) fn each(v: &Verification, word: impl Fn(&Check) -> String) -> String {
    v.checks.iter().map(word).collect::<Vec<_>>().join(", ")
}

fn or_dash(value: Option<f64>, factor: f64, digits: usize) -> String {
    value.map_or("–".to_owned(), |x| format!("{:.digits$}", x * factor))
}

/// Word for an outcome, as in `verdict.json`.
pub fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Recovered => "recovered",
        Outcome::Decayed => "decayed",
        Outcome::Resting => "resting",
        Outcome::Pinned => "pinned",
        Outcome::Bouncing => "bouncing",
        Outcome::Whirl => "whirl",
    }
}

/// A table with lines between header and rows only.
pub(crate) fn lined(header: impl Into<Row>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(header);
    table
}

/// A figure in a table.
pub(crate) fn right(value: impl Display) -> Cell {
    Cell::new(value).set_alignment(CellAlignment::Right)
}

/// The table: one row a figure, one column a policy.
pub fn text(scene: &Scene, runs: &[PolicyRun]) -> String {
    let mut header = vec![Cell::new("policy")];
    header.extend(runs.iter().map(|r| right(&r.name)));
    let mut table = lined(header);
    for (name, value) in FIGURES {
        let cells = runs.iter().map(|r| right(value(&r.verdict)));
        table.add_row([Cell::new(name)].into_iter().chain(cells));
    }
    if runs.iter().any(|r| r.verification.is_some()) {
        for (name, value) in CHECK_FIGURES {
            let cells =
                (runs.iter()).map(|r| right(r.verification.as_ref().map_or("–".to_owned(), value)));
            table.add_row([Cell::new(name)].into_iter().chain(cells));
        }
    }
    format!("{}\n{table}", scene.title)
}

/// The verdicts under stable keys: `policies.<name>.<figure>`.
pub fn json(scene: &Scene, runs: &[PolicyRun]) -> serde_json::Value {
    let policies: serde_json::Map<String, serde_json::Value> = (runs.iter())
        .map(|run| {
            let mut figures = serde_json::json!(run.verdict);
            if let Some(verification) = &run.verification {
                figures["verification"] = serde_json::json!(verification);
            }
            (run.name.clone(), figures)
        })
        .collect();
    serde_json::json!({
        "scene": scene.title,
        "duration_s": scene.duration_s,
        "sample_rate_hz": scene.sample_rate_hz,
        "seed": scene.seed,
        "rtol": scene.rtol,
        "whirl_speed_m_s": scene.whirl_speed_m_s,
        "policies": policies,
    })
}
