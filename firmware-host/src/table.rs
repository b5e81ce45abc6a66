//! The verdicts as a table for people and as JSON for programs.

use crate::scene::Scene;
use crate::verdict::{Outcome, PolicyRun, Verdict};
use comfy_table::{Cell, CellAlignment, Table, presets};

/// Rows of the table: name with unit, and the value as text.
type Figure = (&'static str, fn(&Verdict) -> String);

const FIGURES: &[Figure] = &[
    ("outcome", |v| outcome(v.outcome).to_owned()),
    ("impacts", |v| v.impacts.to_string()),
    ("contact time [ms]", |v| {
        format!("{:.3}", v.contact_time_s * 1e3)
    }),
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
    ("run time [ms]", |v| format!("{:.1}", v.run_time_s * 1e3)),
    ("ratio to real time", |v| {
        format!("{:.0}", v.real_time_ratio)
    }),
];

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

/// The table: one row a figure, one column a policy.
pub fn text(scene: &Scene, runs: &[PolicyRun]) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let mut header = vec![Cell::new("policy")];
    header.extend(
        runs.iter()
            .map(|r| Cell::new(&r.name).set_alignment(CellAlignment::Right)),
    );
    table.set_header(header);
    for (name, value) in FIGURES {
        let mut row = vec![Cell::new(name)];
        let cell = |r: &PolicyRun| Cell::new(value(&r.verdict)).set_alignment(CellAlignment::Right);
        row.extend(runs.iter().map(cell));
        table.add_row(row);
    }
    format!("{}\n{table}", scene.title)
}

/// The verdicts under stable keys: `policies.<name>.<figure>`.
pub fn json(scene: &Scene, runs: &[PolicyRun]) -> serde_json::Value {
    let policies: serde_json::Map<String, serde_json::Value> = (runs.iter())
        .map(|run| (run.name.clone(), serde_json::json!(run.verdict)))
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
