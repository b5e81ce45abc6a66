//! The results of `target` as tables.

use comfy_table::{Cell, Table};
use firmware_bench::report::table::{lined, right};
use firmware_studies::on_target::results::{LoopRow, Report, StreamRow, TargetRow};

/// What there is.
pub(crate) fn text(report: &Report) -> String {
    let mut text = String::new();
    if !report.targets.is_empty() {
        text += &format!(
            "{}\n\n{}\n\n{}\n\n",
            figures(&report.targets),
            by_mode(&report.targets),
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
    for t in &report.targets {
        if let Some(pair) = t.pair {
            text += &format!(
                "{} {}: two planes in one tick: median {}, worst {} instructions, RAM {} B, stack {} B\n",
                t.name,
                t.number,
                pair.median_instructions,
                pair.worst_instructions,
                pair.ram_bytes,
                pair.stack_bytes
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

fn figures(targets: &[TargetRow]) -> Table {
    let mut table = lined([
        "target",
        "board",
        "instructions a tick: least",
        "median",
        "worst",
        "text B",
        "RAM B",
        "stack B",
        "bit-exact ticks",
    ]);
    for t in targets {
        table.add_row([
            named(t.name, t.number),
            Cell::new(t.board),
            right(t.min_instructions),
            right(t.median_instructions),
            right(t.worst_instructions),
            right(t.text_bytes),
            right(t.ram_bytes),
            right(t.stack_bytes),
            right(format!("{} of {}", t.bit_exact_ticks, t.ticks)),
        ]);
    }
    table
}

fn by_mode(targets: &[TargetRow]) -> Table {
    let mut table = lined(["target", "mode", "ticks", "least", "median", "worst"]);
    for t in targets {
        for m in &t.modes {
            table.add_row([
                named(t.name, t.number),
                Cell::new(m.mode),
                right(m.spread.ticks),
                right(m.spread.min_instructions),
                right(m.spread.median_instructions),
                right(m.spread.worst_instructions),
            ]);
        }
    }
    table
}

fn against_budgets(targets: &[TargetRow]) -> Table {
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
                Cell::new(if (v.least..=v.budget).contains(&v.measured) {
                    "yes"
                } else {
                    "NO"
                }),
                right(v.required.map_or_else(String::new, |r| format!("≤ {r}"))),
                Cell::new(match v.met() {
                    None => "",
                    Some(true) => "yes",
                    Some(false) if v.known_not_met => "not yet",
                    Some(false) => "NO",
                }),
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

fn loops(rows: &[LoopRow]) -> Table {
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
            Cell::new(if row.same_plant { "yes" } else { "NO" }),
            right(format!("{:.0}", row.ticks_per_s)),
        ]);
    }
    table
}
