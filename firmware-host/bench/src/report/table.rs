//! The verdicts as a table for people and as JSON for programs.

use crate::report::lines::{Cell, Lines, lined, right};
use crate::report::plot::text::figures;
use crate::report::tone::Tone;
use crate::run::figures::{BearingFigures, Digits, Figure, Figures, Timing, Value};
use crate::run::supervision::{Account, Supervision};
use crate::run::verdict::{PolicyRun, Results, far_into_the_wall};
use crate::run::verify::{Check, Verification};
use crate::scene::nominal::named;
use crate::scene::{PlaneScene, Scene};
use serde_json::json;
use std::fmt::Write as _;

/// A row of the table: name with unit, and the value as text.
type Row<T> = (&'static str, fn(&T) -> String);

/// Rows of bearings that have heat.
const BEARING_FIGURES: &[Row<BearingFigures>] = &[
    ("heat of the bearing [J]", |b| format!("{:.3}", b.heat_j)),
    ("bearing warmer by [K]", |b| {
        format!("{:.3}", b.temperature_rise_k)
    }),
    ("clearance at the end [µm]", |b| {
        format!("{:.2}", 1e6 * b.clearance_m)
    }),
];

/// Rows below those, where runs were checked.
const CHECK_FIGURES: &[Row<Verification>] = &[
    ("checked by", |v| {
        // Of a machine the checks of all its planes are the same.
        let mut checks: Vec<String> = Vec::new();
        for check in v
            .checks
            .iter()
            .map(|c| format!("{} {:.0e}", c.method, c.rtol))
        {
            if !checks.contains(&check) {
                checks.push(check);
            }
        }
        checks.join(", ")
    }),
    ("outcome when checked", |v| match v.same_outcome {
        true => "the same".to_owned(),
        false => format!("{OTHER}: {}", each(v, |c| c.outcome.name().to_owned())),
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
const SUPERVISION_FIGURES: &[Row<Supervision>] = &[
    ("supervisor engaged", |s| times(s.engagements)),
    ("engaged first [ms]", |s| or_dash(s.first_engaged_s, 1e3, 2)),
    ("engaged for [ms]", |s| format!("{:.2}", s.engaged_s * 1e3)),
    ("longest engagement [ms]", |s| {
        format!("{:.2}", s.longest_engagement_s * 1e3)
    }),
    ("engaged without a touch", |s| {
        account_cell(s, |account| account.nuisance_engagements.to_string())
    }),
    ("handed back", |s| s.handed_back.to_string()),
    ("highest expected severity", |s| {
        format!("{:.2}", s.expected_severity_max)
    }),
    ("sensor faults", |s| s.sensor_faults.to_string()),
    ("landings seen", |s| {
        account_cell(s, |account| account.landings.to_string())
    }),
    ("severity index of them", |s| {
        account_cell(s, |account| format!("{:.3}", account.severity_index))
    }),
    ("hardest impact seen [m/s]", |s| {
        account_cell(s, |account| figures(account.impact_speed_max_m_s))
    }),
    ("backward motion, of limit [%]", |s| {
        account_cell(s, |account| {
            figures(100.0 * account.backward_speed_max_m_s / account.whirl_limit_m_s)
        })
    }),
    ("asks to coast down", |s| {
        account_cell(s, |account| {
            let word = if account.coast_down { ASKS } else { "no" };
            word.to_owned()
        })
    }),
    ("configuration checked", |s| {
        account_cell(s, |account| account.checked.to_owned())
    }),
];

fn account_cell(s: &Supervision, word: fn(&Account) -> String) -> String {
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

/// A figure as text; a dash for none, and for what is no number.
pub fn shown<T>(figure: &Figure<T>, of: &T) -> String {
    let number = match (figure.value)(of) {
        Value::Word(word) => return word.to_owned(),
        Value::Outcome(outcome) => return outcome.name().to_owned(),
        Value::Number(number) => number.filter(|x| x.is_finite()),
    };
    number.map_or("–".to_owned(), |x| shown_as(figure, x))
}

/// A number as the figure's, from SI units.
pub fn shown_as<T>(figure: &Figure<T>, value_si: f64) -> String {
    let x = value_si * figure.per_si;
    match figure.digits {
        Digits::Significant => figures(rounded(x)),
        Digits::Fixed(digits) => format!("{x:.digits$}"),
        Digits::Power => format!("{x:.1e}"),
    }
}

/// To three significant figures.
fn rounded(x: f64) -> f64 {
    let unit = 10_f64.powf(x.abs().log10().floor() - 2.0);
    match unit >= 1.0 && unit.is_finite() {
        true => (x / unit).round() * unit,
        // `figures` does it.
        false => x,
    }
}

/// The tables: one row a figure, one column a policy, the supervisor's first; of several planes as a whole, and plane by plane.
pub fn text(scene: &Scene, results: &Results) -> String {
    let mut text = format!("{}\n", scene.title);
    let of = |name: &str, runs: &[PolicyRun]| table(name, &supervisor_first(runs));
    if results.planes.len() == 1 {
        let _ = write!(text, "{}", of("policy", &results.planes[0]));
    } else {
        let _ = write!(text, "{}", of("machine", &results.runs));
    }
    for (i, runs) in results.planes.iter().enumerate() {
        if results.planes.len() > 1 {
            let _ = write!(text, "\n\n{}", of(&scene.planes[i].name, runs));
        }
        if let Some(note) = far_into_the_wall(runs, scene.clearance_m(i)) {
            let _ = write!(text, "\n{note}");
        }
    }
    let notes = results.untrusted().into_iter();
    text + &notes.map(|note| format!("\n{note}")).collect::<String>()
}

/// Runs in the order in which they are shown.
pub(super) fn supervisor_first(runs: &[PolicyRun]) -> Vec<&PolicyRun> {
    let mut runs: Vec<&PolicyRun> = runs.iter().collect();
    runs.sort_by_key(|run| run.supervision.is_none());
    runs
}

fn table(of: &str, runs: &[&PolicyRun]) -> Lines {
    let mut header = vec![Cell::new(of)];
    header.extend(runs.iter().map(|r| right(&r.name)));
    let mut table = lined(header);
    let outcome = Figures::ALL[0].title();
    for (title, cells) in rows(runs) {
        let cells = cells.into_iter().zip(runs).map(|(cell, run)| {
            let tone = match &cell[..] {
                _ if title == outcome => Some(Tone::of(run.verdict.figures.outcome)),
                ASKS => Some(Tone::Bad),
                cell => cell.starts_with(OTHER).then_some(Tone::Bad),
            };
            right(cell).toned(tone)
        });
        table.add_row([Cell::new(&title)].into_iter().chain(cells));
    }
    table
}

/// Said where the supervisor asks for coasting down, …
const ASKS: &str = "YES";
/// … and before outcomes that are not that of the run.
const OTHER: &str = "OTHER";

/// Every figure that one of the runs has: its title with the unit, and a cell for each run. The outcome first, then what the
/// supervisor did.
pub(super) fn rows(runs: &[&PolicyRun]) -> Vec<(String, Vec<String>)> {
    let mut rows = Vec::new();
    let (outcome, figures) = Figures::ALL.split_at(1);
    add_figures(&mut rows, outcome, runs, |r| &r.verdict.figures);
    add_rows(&mut rows, SUPERVISION_FIGURES, runs, |r| {
        r.supervision.as_ref()
    });
    add_figures(&mut rows, figures, runs, |r| &r.verdict.figures);
    add_rows(&mut rows, BEARING_FIGURES, runs, |r| {
        r.verdict.figures.bearing.as_ref()
    });
    add_rows(&mut rows, CHECK_FIGURES, runs, PolicyRun::checked);
    add_figures(&mut rows, Timing::ALL, runs, |r| &r.verdict.timing);
    rows
}

fn add_figures<T>(
    rows: &mut Vec<(String, Vec<String>)>,
    figures: &[Figure<T>],
    runs: &[&PolicyRun],
    of: impl Fn(&PolicyRun) -> &T,
) {
    for figure in figures {
        let cells = runs.iter().map(|run| shown(figure, of(run)));
        rows.push((figure.title(), cells.collect()));
    }
}

/// Rows of something that not every run has; none where no run has it.
fn add_rows<T>(
    rows: &mut Vec<(String, Vec<String>)>,
    all: &[Row<T>],
    runs: &[&PolicyRun],
    of: impl Fn(&PolicyRun) -> Option<&T>,
) {
    if runs.iter().all(|run| of(run).is_none()) {
        return;
    }
    for (name, value) in all {
        let cells = (runs.iter()).map(|run| of(run).map_or("–".to_owned(), value));
        rows.push(((*name).to_owned(), cells.collect()));
    }
}

/// A run under stable keys.
fn run_json(run: &PolicyRun) -> serde_json::Value {
    let mut figures = json!(run.verdict);
    match &run.verification {
        Some(Ok(verification)) => figures["verification"] = json!(verification),
        Some(Err(error)) => figures["verification"] = json!({ "error": error }),
        None => {}
    }
    if let Some(supervision) = &run.supervision {
        figures["supervision"] = json!(supervision);
    }
    figures
}

fn overrides_of(plane: &PlaneScene) -> serde_json::Map<String, serde_json::Value> {
    named(&plane.overrides)
        .map(|(name, value)| (name.to_owned(), value.into()))
        .collect()
}

/// What failed, and the runs that `json` makes of the others, by their policies.
fn by_policy(
    results: &Results,
    run_json: impl Fn(usize, &PolicyRun) -> serde_json::Value,
) -> serde_json::Map<String, serde_json::Value> {
    let failed = (results.failed.iter())
        .map(|failed| (failed.name.clone(), json!({ "error": failed.error })));
    let runs = results.runs.iter().enumerate();
    runs.map(|(i, run)| (run.name.clone(), run_json(i, run)))
        .chain(failed)
        .collect()
}

/// The verdicts under stable keys: `policies.<name>.<figure>`, and under `policies.<name>.planes` figures of each plane.
pub fn json(scene: &Scene, results: &Results) -> serde_json::Value {
    let planes = || scene.planes.iter().zip(&results.planes);
    let far = planes().enumerate().filter_map(|(i, (plane, runs))| {
        let note = far_into_the_wall(runs, scene.clearance_m(i))?;
        Some(match plane.name.as_str() {
            "" => note,
            name => format!("{name}: {note}"),
        })
    });
    let warnings: Vec<_> = scene.warnings.iter().cloned().chain(far).collect();
    let policies = by_policy(results, |i, whole| {
        let mut figures = run_json(whole);
        let of_plane = planes().filter_map(|(plane, runs)| {
            let mut figures = run_json(runs.get(i)?);
            figures["name"] = json!(plane.name);
            // Of the machine.
            for key in ["run_time_s", "real_time_ratio"] {
                figures.as_object_mut()?.remove(key);
            }
            Some(figures)
        });
        figures["planes"] = of_plane.collect();
        figures
    });
    let of_planes = scene.planes.iter().map(|plane| {
        json!({
            "name": plane.name,
            "whirl_speed_m_s": plane.whirl_speed_m_s,
            "supervisor_told": overrides_of(plane),
        })
    });
    json!({
        "scene": scene.title,
        "duration_s": scene.simulated_s(),
        "sample_rate_hz": scene.sample_rate_hz,
        "seed": scene.planes.first().map(|plane| plane.seed),
        "rtol": scene.rtol,
        "warnings": warnings,
        "planes": of_planes.collect::<Vec<_>>(),
        "policies": policies,
    })
}
