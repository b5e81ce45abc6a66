//! `record`: a flight record from a machine, for a person who asks what happened.

use crate::cli::error::{CommandError, pretty, print};
use comfy_table::Cell;
use firmware_bench::report::table::{lined, right};
use firmware_bench::run::flight_record::{ANY_UNIT, FlightRecord, Tick, Units, entries};
use std::fmt::Write;
use std::path::PathBuf;
use supervisor::PER_UNIT;

/// Arguments of `record`.
#[derive(Debug, Clone, clap::Args)]
pub struct RecordArgs {
    /// The entries as they are in memory, 16 bytes each, oldest first.
    pub file: PathBuf,
    /// Checksum that the firmware gave with the record, e.g. 0x1d9a40c2; eight hexadecimal digits may stand without 0x.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub crc: Option<String>,
    /// Clearance of the retainer bearing: positions in µm.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub clearance_m: Option<f64>,
    /// Force cap: forces in N.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub force_max_n: Option<f64>,
    /// Control rate: times in ms.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub sample_rate_hz: Option<f64>,
    /// Print every tick as CSV instead of tables.
    #[arg(long, conflicts_with = "json")]
    pub csv: bool,
    /// Print JSON instead of tables.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &RecordArgs) -> Result<(), CommandError> {
    let units = units(args)?;
    let expected = args.crc.as_deref().map(checksums).transpose()?;
    let name = args.file.display();
    let bytes = std::fs::read(&args.file).map_err(|e| CommandError::Numbers {
        message: format!("{name}: {e}"),
        help: "give the file that the entries were written to".to_owned(),
    })?;
    let entries = entries(&bytes).map_err(|e| CommandError::Numbers {
        message: format!("{name}: {e}"),
        help: "write the entries of a frozen record one after the other, oldest first, 16 bytes each, \
               little-endian, and nothing else"
            .to_owned(),
    })?;
    let record = FlightRecord::of(&entries, units);
    if record.ticks.is_empty() {
        return Err(CommandError::Numbers {
            message: format!("{name}: none of its {} entries was ever written", entries.len()),
            help: "read the entries of a record that has frozen: memory of another place, or a supervisor that has \
                   not engaged, is all zeros"
                .to_owned(),
        });
    }
    if let Some(expected) = &expected
        && !expected.contains(&record.crc)
    {
        return Err(CommandError::Numbers {
            message: format!(
                "{name}: the checksum is {:#010x}, and not {}",
                record.crc,
                expected
                    .iter()
                    .map(|crc| format!("{crc:#010x}"))
                    .collect::<Vec<_>>()
                    .join(" or ")
            ),
            help:
                "the file is damaged, or its entries are not in the order from oldest to newest; \
                   without --crc it is shown as it is"
                    .to_owned(),
        });
    }
    print(&if args.json {
        pretty(&record, "writing JSON")? + "\n"
    } else if args.csv {
        csv(&record)
    } else {
        text(&record, units, expected.is_some())
    })
}

fn units(args: &RecordArgs) -> Result<Units, CommandError> {
    let checked = |name: &str, value: Option<f64>| match value {
        Some(x) if !ANY_UNIT.contains(&x) => Err(CommandError::Numbers {
            message: format!("--{name} is {x}, expected a number from 1e-9 to 1e9"),
            help: "give it in SI units".to_owned(),
        }),
        value => Ok(value),
    };
    Ok(Units {
        clearance_m: checked("clearance-m", args.clearance_m)?,
        force_max_n: checked("force-max-n", args.force_max_n)?,
        sample_rate_hz: checked("sample-rate-hz", args.sample_rate_hz)?,
    })
}

/// What a text may mean: eight digits are those of a debugger's hexadecimal as well as a decimal number.
fn checksums(text: &str) -> Result<Vec<u32>, CommandError> {
    let hexadecimal = |digits: &str| u32::from_str_radix(digits, 16).ok();
    let numbers: Vec<u32> = match text.strip_prefix("0x").or(text.strip_prefix("0X")) {
        Some(digits) => hexadecimal(digits).into_iter().collect(),
        None => {
            let bare = Some(text)
                .filter(|text| text.len() == 8)
                .and_then(hexadecimal);
            text.parse().ok().into_iter().chain(bare).collect()
        }
    };
    if numbers.is_empty() {
        return Err(CommandError::Numbers {
            message: format!("--crc is {text}, expected a number of 32 bits"),
            help: "give it as eight hexadecimal digits, with or without 0x, or in decimal"
                .to_owned(),
        });
    }
    Ok(numbers)
}

fn csv(record: &FlightRecord) -> String {
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

/// Digits behind the point of what is recorded in steps of this unit's 1/[`PER_UNIT`]: none that is finer than a step.
fn digits(unit: f64) -> usize {
    (f64::from(PER_UNIT) / unit).log10().floor().max(0.0) as usize
}

fn text(record: &FlightRecord, units: Units, compared: bool) -> String {
    let (time_unit, length, force) = (
        units.sample_rate_hz.map_or("ticks", |_| "ms"),
        units.clearance_m.map_or(("c", 1.0), |c| ("µm", 1e6 * c)),
        units.force_max_n.map_or(("caps", 1.0), |cap| ("N", cap)),
    );
    let scaled = |x: f64, (_, unit): (&str, f64)| format!("{:.*}", digits(unit), x * unit);
    let mut out = format!(
        "{} ticks; checksum {:#010x}{}\n",
        record.ticks.len(),
        record.crc,
        if compared { ", as given" } else { "" }
    );
    if !record.whole {
        out += "no engagement at the end of its first quarter: entries are missing or there twice, or they are not in the \
                order from oldest to newest\n";
    }
    if record.empty > 0 {
        let _ = writeln!(
            out,
            "{} entries before them were never written",
            record.empty
        );
    }
    if record.missing > 0 {
        let _ = writeln!(
            out,
            "{} sequence numbers are missing between neighbours: lost ticks, or the oldest entries are of the \
             event before",
            record.missing
        );
    }

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
            right(scaled(s.largest_radius, length)),
            right(scaled(s.largest_force, force)),
        ]);
    }
    let mut happened = lined([
        format!("at [{time_unit}]"),
        "mode".to_owned(),
        format!("x, y [{}]", length.0),
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
    let _ = writeln!(
        out,
        "\n{modes}\nthe record ends in the last of them\n\n{happened}"
    );
    out
}
