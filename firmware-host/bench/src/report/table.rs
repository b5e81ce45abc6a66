//! The verdicts as a table for people and as JSON for programs.

use crate::report::plot::text::figures;
use crate::run::supervision::{Account, Supervision};
use crate::run::verdict::{Check, Outcome, PolicyRun, Verdict, Verification, far_into_the_wall};
use crate::scene::Scene;
use crate::scene::nominal::named;
use comfy_table::{Cell, CellAlignment, LineStyle, Row, Table, TableStyle};
use std::fmt::Display;

/// A row of the table: name with unit, and the value as text.
type Figure<T> = (&'static str, fn(&T) -> String);

const FIGURES: &[Figure<Verdict>] = &[
    ("outcome", |v| outcome(v.outcome).to_owned()),
    ("impacts", |v| v.impacts.to_string()),
    ("contact time [ms]", |v| figures(v.contact_time_s * 1e3)),
    ("contact impulse [N s]", |v| figures(v.contact_impulse_n_s)),
    ("contacts over 20 mm/s", |v| {
        v.contacts_over_20_mm_s.to_string()
    }),
    ("first contact [ms]", |v| or_dash(v.first_contact_s, 1e3, 2)),
    ("peak penetration [µm]", |v| {
        figures(v.peak_penetration_m * 1e6)
    }),
    ("peak contact force [N]", |v| {
        figures(v.peak_contact_force_n)
    }),
    ("peak friction torque [N m]", |v| {
        figures(v.peak_friction_torque_n_m)
    }),
    ("spin lost [Hz]", |v| format!("{:.2}", v.spin_lost_hz)),
    ("max backward whirl [Hz]", |v| {
        or_dash(v.max_backward_whirl_hz, 1.0, 1)
    }),
    ("re-levitated after last event [ms]", |v| {
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
const CHECK_FIGURES: &[Figure<Verification>] = &[
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

/// Rows below those, where a supervisor ran.
const SUPERVISION_FIGURES: &[Figure<Supervision>] = &[
    ("supervisor engaged", |s| times(s.engagements)),
    ("engaged first [ms]", |s| or_dash(s.first_engaged_s, 1e3, 2)),
    ("engaged for [ms]", |s| format!("{:.2}", s.engaged_s * 1e3)),
    ("longest engagement [ms]", |s| {
        format!("{:.2}", s.longest_engagement_s * 1e3)
    }),
    ("engaged without a touch", |s| {
        told(s, |account| account.nuisance_engagements.to_string())
    }),
    ("handed back", |s| s.handed_back.to_string()),
    ("highest expected severity", |s| {
        format!("{:.2}", s.expected_severity_max)
    }),
    ("sensor faults", |s| s.sensor_faults.to_string()),
    ("landings seen", |s| {
        told(s, |account| account.landings.to_string())
    }),
    ("severity index of them", |s| {
        told(s, |account| format!("{:.3}", account.severity_index))
    }),
    ("asks to coast down", |s| {
        told(s, |account| {
            let word = if account.coast_down { "YES" } else { "no" };
            word.to_owned()
        })
    }),
];

fn told(s: &Supervision, word: fn(&Account) -> String) -> String {
    s.account.as_ref().map_or("–".to_owned(), word)
}

fn times(count: u64) -> String {
    match count {
        0 => "never".to_owned(),
        1 => "once".to_owned(),
        _ => format!("{count} times"),
    }
}

/// A word for each check.
pub fn each(v: &Verification, word: impl Fn(&Check) -> String) -> String {
    v.checks.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// A value times a factor, with so many digits after the point; a dash for none.
pub fn or_dash(value: Option<f64>, factor: f64, digits: usize) -> String {
    value.map_or("–".to_owned(), |x| format!("{:.digits$}", x * factor))
}

/// Word for an outcome, as in `verdict.json`.
pub fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Recovered => "recovered",
        Outcome::Decayed => "decayed",
        Outcome::Resting => "resting",
        Outcome::Pinned => "pinned",
        Outcome::Rubbing => "rubbing",
        Outcome::Bouncing => "bouncing",
        Outcome::Whirl => "whirl",
    }
}

/// A table with one line, between header and rows.
pub fn lined(header: impl Into<Row>) -> Table {
    let mut table = Table::new();
    let line = LineStyle::none().fill('─').junction('─');
    table.load_style(TableStyle::new().header_separator(line));
    table.set_header(header);
    table
}

/// A figure in a table.
pub fn right(value: impl Display) -> Cell {
    Cell::new(value).set_alignment(CellAlignment::Right)
}

/// The table: one row a figure, one column a policy.
pub fn text(scene: &Scene, runs: &[PolicyRun]) -> String {
    let mut header = vec![Cell::new("policy")];
    header.extend(runs.iter().map(|r| right(&r.name)));
    let mut table = lined(header);
    add_rows(&mut table, FIGURES, runs, |r| Some(&r.verdict));
    add_rows(&mut table, SUPERVISION_FIGURES, runs, |r| {
        r.supervision.as_ref()
    });
    add_rows(&mut table, CHECK_FIGURES, runs, |r| r.verification.as_ref());
    let note = far_into_the_wall(runs, scene.plant.contact.clearance_m);
    let note = note.map_or(String::new(), |note| format!("\n{note}"));
    format!("{}\n{table}{note}", scene.title)
}

/// Rows of something that not every run has; none where no run has it.
fn add_rows<T>(
    table: &mut Table,
    figures: &[Figure<T>],
    runs: &[PolicyRun],
    of: impl Fn(&PolicyRun) -> Option<&T>,
) {
    if runs.iter().all(|run| of(run).is_none()) {
        return;
    }
    for (name, value) in figures {
        let cells = (runs.iter()).map(|run| right(of(run).map_or("–".to_owned(), value)));
        table.add_row([Cell::new(name)].into_iter().chain(cells));
    }
}

/// The verdicts under stable keys: `policies.<name>.<figure>`.
pub fn json(scene: &Scene, runs: &[PolicyRun]) -> serde_json::Value {
    let policies: serde_json::Map<String, serde_json::Value> = (runs.iter())
        .map(|run| {
            let mut figures = serde_json::json!(run.verdict);
            if let Some(verification) = &run.verification {
                figures["verification"] = serde_json::json!(verification);
            }
            if let Some(supervision) = &run.supervision {
                figures["supervision"] = serde_json::json!(supervision);
            }
            (run.name.clone(), figures)
        })
        .collect();
    let told: serde_json::Map<String, serde_json::Value> = named(&scene.overrides)
        .map(|(name, value)| (name.to_owned(), value.into()))
        .collect();
    let far = far_into_the_wall(runs, scene.plant.contact.clearance_m);
    let warnings: Vec<_> = scene.warnings.iter().cloned().chain(far).collect();
    serde_json::json!({
        "scene": scene.title,
        "duration_s": scene.duration_s,
        "sample_rate_hz": scene.sample_rate_hz,
        "seed": scene.seed,
        "rtol": scene.rtol,
        "whirl_speed_m_s": scene.whirl_speed_m_s,
        "warnings": warnings,
        "supervisor_told": told,
        "policies": policies,
    })
}
