//! Ticks and the slow track of a record as tables and as CSV.

use firmware_bench::record::file::PlaneRecord;
use firmware_bench::record::ticks::{Tick, Ticks, Units, mode_name};
use firmware_bench::record::unknown::is_unseen;
use firmware_bench::report::lines::{Cell, Lines, lined, right};
use std::fmt::Write;
use supervisor::Stretch;

/// Where no reading carried a figure.
pub(super) const NOT_KNOWN: &str = "not known";

/// The slow track, neighbours of the same modes together.
pub(super) fn track(record: &PlaneRecord, units: Units) -> Lines {
    let mut table = lined([
        format!("from [{}]", time_unit(units)),
        format!("to [{}]", time_unit(units)),
        "modes".to_owned(),
        "touches".to_owned(),
        "contact [%]".to_owned(),
        format!("radius [{}]", length(units).0),
        format!("force [{}]", force(units).0),
        "severity".to_owned(),
    ]);
    let stretches: Vec<(&Stretch, [i64; 2])> = record.stretches().collect();
    let alike = |(a, _): &(&Stretch, [i64; 2]), (b, _): &(&Stretch, [i64; 2])| {
        a.modes == b.modes && is_unseen(a) == is_unseen(b)
    };
    for together in stretches.chunk_by(alike) {
        let (from, to) = (together[0].1[0], together[together.len() - 1].1[1]);
        let same: Vec<&Stretch> = together.iter().map(|(stretch, _)| *stretch).collect();
        let ticks: i64 = same.iter().map(|s| i64::from(s.ticks)).sum();
        let contact: i64 = same.iter().map(|s| i64::from(s.contact_ticks)).sum();
        let most = |of: fn(&Stretch) -> u32| {
            let all = same.iter().map(|s| record.number(of(s)));
            all.fold(0.0, f64::max)
        };
        let names: Vec<&str> = (0..8)
            .filter(|mode| same[0].modes & 1 << mode != 0)
            .filter_map(mode_name)
            .collect();
        let touches: u32 = same.iter().map(|s| u32::from(s.touches)).sum();
        let seen = |text: String| {
            right(if is_unseen(same[0]) {
                NOT_KNOWN.to_owned()
            } else {
                text
            })
        };
        table.add_row([
            right(time(from, units)),
            right(time(to, units)),
            Cell::new(names.join(", ")),
            seen(touches.to_string()),
            seen(format!(
                "{:.0}",
                100.0 * contact as f64 / ticks.max(1) as f64
            )),
            seen(scaled(most(|s| s.radius_square).sqrt(), length(units))),
            right(scaled(most(|s| s.force_square).sqrt(), force(units))),
            seen(format!("{:.2}", most(|s| s.severity))),
        ]);
    }
    table
}

pub(super) fn csv(record: &Ticks) -> String {
    let mut csv =
        "sequence,tick,time_s,x,y,x_m,y_m,force_x,force_y,force_x_n,force_y_n,mode,limits,events\n"
            .to_owned();
    let or_nothing = |value: Option<f64>| value.map_or(String::new(), |x| x.to_string());
    for t in &record.ticks {
        let [x, y] = t.position;
        let [fx, fy] = t.force;
        let in_si = |v: Option<[f64; 2]>| {
            let [x, y] = [0, 1].map(|i| or_nothing(v.map(|v| v[i])));
            format!("{x},{y}")
        };
        let _ = writeln!(
            csv,
            "{},{},{},{x},{y},{},{fx},{fy},{},{},{},{}",
            t.sequence,
            t.tick,
            or_nothing(t.time_s),
            in_si(t.position_m),
            in_si(t.force_n),
            t.mode,
            t.limits.join(" "),
            t.events.join(" "),
        );
    }
    csv
}

/// A count of ticks as time, where the rate is known.
fn time(ticks: i64, units: Units) -> String {
    match units.sample_rate_hz {
        Some(rate) => format!("{:.3}", 1e3 * ticks as f64 / rate),
        None => ticks.to_string(),
    }
}

/// Digits behind the point that tell some 4096 steps of this unit apart.
fn digits(unit: f64) -> usize {
    (4096.0 / unit).log10().floor().max(0.0) as usize
}

fn time_unit(units: Units) -> &'static str {
    units.sample_rate_hz.map_or("ticks", |_| "ms")
}

/// Name of a unit, and how many of it one clearance is.
fn length(units: Units) -> (&'static str, f64) {
    units.clearance_m.map_or(("c", 1.0), |c| ("µm", 1e6 * c))
}

/// The same of the force cap.
fn force(units: Units) -> (&'static str, f64) {
    units.force_max_n.map_or(("caps", 1.0), |cap| ("N", cap))
}

fn scaled(x: f64, (_, unit): (&str, f64)) -> String {
    format!("{:.*}", digits(unit), x * unit)
}

/// What the recorded ticks show.
pub(super) struct TickTables {
    /// Where ticks are missing between others.
    pub(super) missing: Option<String>,
    /// Their modes.
    pub(super) modes: Lines,
    /// Ticks in which something happened.
    happened: Lines,
}

impl TickTables {
    /// For a terminal.
    pub(super) fn text(&self) -> String {
        let missing = self.missing.iter().map(|text| format!("{text}\n"));
        format!(
            "{}\n{}\n\nThese ticks end in the last of the modes.\n\n{}\n",
            missing.collect::<String>(),
            self.modes,
            self.happened
        )
    }
}

/// Modes of the ticks, and what happened in them.
pub(super) fn tick_tables(record: &Ticks, units: Units) -> TickTables {
    let (time_unit, length, force) = (time_unit(units), length(units), force(units));
    let missing = (record.missing > 0).then(|| {
        format!(
            "{} sequence numbers are missing between neighbours: lost ticks, or the oldest entries are of the \
             event before",
            record.missing
        )
    });
    let mut modes = lined([
        "mode".to_owned(),
        format!("from [{time_unit}]"),
        format!("for [{time_unit}]"),
        format!("largest radius [{}]", length.0),
        format!("largest force [{}]", force.0),
    ]);
    for s in &record.stretches {
        modes.add_row([
            Cell::new(s.mode),
            right(time(s.from_tick, units)),
            right(time(s.ticks as i64, units)),
            right(
                s.largest_radius
                    .map_or(NOT_KNOWN.to_owned(), |r| scaled(r, length)),
            ),
            right(scaled(s.largest_force, force)),
        ]);
    }
    let mut happened = lined([
        format!("at [{time_unit}]"),
        "mode".to_owned(),
        format!("reading x, y [{}]", length.0),
        format!("force x, y [{}]", force.0),
        "bound by".to_owned(),
        "events".to_owned(),
    ]);
    let pair = |[x, y]: [f64; 2], unit| format!("{}, {}", scaled(x, unit), scaled(y, unit));
    for Tick {
        tick,
        position,
        force: f,
        mode,
        limits,
        events,
        ..
    } in record.turning_points()
    {
        happened.add_row([
            right(time(*tick, units)),
            Cell::new(mode),
            right(pair(*position, length)),
            right(pair(*f, force)),
            Cell::new(limits.join(" ")),
            Cell::new(events.join(" ")),
        ]);
    }
    TickTables {
        missing,
        modes,
        happened,
    }
}
