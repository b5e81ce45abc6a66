//! Outcome of a sweep, as text.

use super::Done;
use firmware_bench::report::lines::{Cell, lined, right};
use firmware_bench::report::table::shown_as;
use firmware_bench::report::tone::Tone;
use firmware_bench::run::figures::Figures;
use firmware_bench::run::outcome::Outcome;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::sweep::influence::Influence;
use firmware_bench::sweep::page::PAGE;
use firmware_bench::sweep::plan::Plan;
use firmware_bench::sweep::summary::{PolicySummary, Summary};
use std::fmt::Write as _;
use std::path::Path;

/// Of a part.
pub(super) fn part(sweep: &Path, done: &Done, [there, all]: [u64; 2]) -> String {
    format!(
        "{} runs of this part are done, {} of them now, {:.1} a second\n\
         {there} of {all} chunks of the sweep are in {}\n\
         when all parts are done: firmware-host sweep {} --merge and their folders; where they share one, \
         the sweep without --shard\n",
        done.runs,
        done.runs_now,
        done.runs_per_second,
        done.folder.display(),
        sweep.display(),
    )
}

/// Of the whole.
pub(super) fn all(plan: &Plan, summary: &Summary, done: &Done) -> String {
    let mut text = format!(
        "{}: {} runs, {}\n",
        summary.scene,
        summary.runs,
        summary.design.name()
    );
    if let Some(sampled) = summary.sampled_runs {
        let _ = writeln!(
            text,
            "quantiles and influences of {sampled} of them, drawn at random"
        );
    }
    let mut policies: Vec<&PolicySummary> = summary.policies.iter().collect();
    policies.sort_by_key(|of| of.policy != PolicyKind::Supervisor.name());
    for policy in policies {
        let _ = write!(text, "\n{}", of_policy(policy));
    }
    for pair in &summary.pairs {
        let _ = writeln!(text, "\n{}", pair.sentence());
    }
    if !summary.influences.is_empty() {
        let _ = write!(text, "\n{}", influences(summary));
    }
    if !summary.worst.is_empty() {
        let _ = writeln!(
            text,
            "\nlargest {} under {}:",
            summary.worst_by, summary.worst_policy
        );
        for (worst, path) in summary.worst.iter().zip(&done.worst) {
            let (value, outcome) = (worst.value, &worst.outcome);
            let _ = writeln!(
                text,
                "  {value:.4e}, {}: firmware-host run {}",
                painted(outcome),
                path.display()
            );
        }
    }
    for error in &summary.errors {
        let _ = writeln!(text, "\nerror in {error}");
    }
    if summary.failed > summary.errors.len() as u64 {
        let _ = writeln!(
            text,
            "and {} more",
            summary.failed - summary.errors.len() as u64
        );
    }
    let rate = match done.runs_now {
        0 => "nothing was left to run".to_owned(),
        now => format!(
            "{now} runs in {:.1} s, {:.1} a second",
            done.seconds, done.runs_per_second
        ),
    };
    let rows = plan.runs() * plan.policies().len() as u64;
    let folder = done.folder.display();
    let _ = writeln!(
        text,
        "\n{rate}\n{rows} rows: {folder}/results.parquet, page: {folder}/{PAGE}"
    );
    text
}

/// In its colour on a terminal.
fn painted(outcome: &str) -> String {
    Outcome::from_name(outcome).map_or_else(|| outcome.to_owned(), |of| Tone::of(of).paint(outcome))
}

fn of_policy(policy: &PolicySummary) -> String {
    let mut outcomes: Vec<(&String, &u64)> = policy.outcomes.iter().collect();
    outcomes.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let mut counts: Vec<String> = outcomes
        .iter()
        .map(|(outcome, count)| format!("{count} {}", painted(outcome)))
        .collect();
    if policy.failed > 0 {
        counts.push(format!("{} failed", policy.failed));
    }
    let mut text = format!("{}: {}", policy.policy, counts.join(", "));
    if let Some(share) = policy.lost_at_most {
        let _ = write!(
            text,
            "; none lost, so at most {:.2} % with a confidence of 95 %",
            100.0 * share
        );
    }
    let mut table = lined(vec![
        Cell::new("figure"),
        right("runs"),
        right("median"),
        right("90 %"),
        right("99 %"),
        right("largest"),
    ]);
    for of in &policy.figures {
        let Some(figure) = Figures::ALL.iter().find(|figure| figure.key == of.key) else {
            continue;
        };
        let mut cells = vec![Cell::new(figure.title()), right(of.runs)];
        let values = [of.median, of.q90, of.q99, of.largest];
        cells.extend(values.map(|x| right(shown_as(figure, x))));
        table.add_row(cells);
    }
    format!("{text}\n{table}\n")
}

fn influences(summary: &Summary) -> String {
    let mut table = lined(vec![
        Cell::new("key"),
        right("loss: share"),
        right("correlation"),
        right(format!("{}: share", summary.worst_by)),
        right("correlation"),
    ]);
    for of in &summary.influences {
        let mut cells = vec![Cell::new(&of.key)];
        for Influence {
            rank_correlation,
            first_order,
        } in [of.lost, of.figure]
        {
            let number = |x: Option<f64>| x.map_or("–".to_owned(), |x| format!("{x:.2}"));
            cells.extend([first_order, rank_correlation].map(|x| right(number(x))));
        }
        table.add_row(cells);
    }
    format!(
        "influence under {}: share of the variance of ranks (first-order index), and Spearman's correlation\n{table}\n",
        summary.worst_policy
    )
}
