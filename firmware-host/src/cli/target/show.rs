//! The results of `target` as tables.

use crate::cli::chapters;
use firmware_bench::report::lines::{Cell, Lines, lined, right};
use firmware_bench::report::tone::Tone;
use firmware_studies::on_target::results::{LoopRow, Report, StreamRow, TargetRow};
use firmware_studies::on_target::study::chapters as chapters_of;

/// What there is.
pub(crate) fn text(report: &Report) -> String {
    let mut text = String::new();
    if !report.targets.is_empty() {
        text += &format!(
            "{}{}\n\n",
            chapters::text(&chapters_of(report)),
            against_budgets(&report.targets),
        );
    }
    for t in &report.targets {
        if let Some(long) = t.long_stream {
            text += &format!(
                "{} {}: worst of {} ticks {} instructions, stack {} B\n",
                t.name, t.number, long.ticks, long.worst_instructions, long.stack_bytes
            );
        }
    }
    for stream in &report.streams {
        text += &format!("{}\n", stream_line(stream));
    }
    if !report.loops.is_empty() {
        text += &format!("{}\n", loops(&report.loops));
    }
    text + &format!("instructions are those of {}\n", report.qemu)
}

fn named(name: &str, number: &str) -> Cell {
    Cell::new(format!("{name} {number}"))
}

fn yes_or_no(holds: bool) -> Cell {
    Cell::new(if holds { "yes" } else { "NO" }).toned(Tone::of_claim(holds))
}

fn against_budgets(targets: &[TargetRow]) -> Lines {
    let mut table = lined([
        "target", "figure", "measured", "budget", "in it", "required", "met",
    ]);
    for t in targets {
        for v in &t.budgets {
            table.add_row([
                named(t.name, t.number),
                Cell::new(v.figure),
                right(v.measured),
                right(format!("{} to {}", v.least, v.budget)),
                yes_or_no((v.least..=v.budget).contains(&v.measured)),
                right(v.required.map_or_else(String::new, |r| format!("≤ {r}"))),
                match v.met() {
                    None => Cell::new(""),
                    Some(false) if v.known_not_met => Cell::new("not yet").toned(Tone::Fair),
                    Some(met) => yes_or_no(met),
                },
            ]);
        }
    }
    table
}

fn stream_line(stream: &StreamRow) -> String {
    let modes: Vec<String> = (stream.modes.iter())
        .map(|m| format!("{} {}", m.ticks, m.mode))
        .collect();
    format!(
        "stream of {} ticks in {} ({} configurations do not fit), hash {}: {}; {} of {} ways from mode to mode",
        stream.ticks,
        stream.number,
        stream.left_out,
        stream.hash,
        modes.join(", "),
        stream.ways - stream.missing_ways.len(),
        stream.ways
    )
}

fn loops(rows: &[LoopRow]) -> Lines {
    let mut table = lined([
        "target",
        "scene",
        "bit-exact ticks",
        "same plant",
        "ticks/s",
    ]);
    for row in rows {
        table.add_row([
            named(row.name, row.number),
            Cell::new(&row.scene),
            right(format!("{} of {}", row.bit_exact_ticks, row.ticks)),
            yes_or_no(row.same_plant),
            right(format!("{:.0}", row.ticks_per_s)),
        ]);
    }
    table
}
