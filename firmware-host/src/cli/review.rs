//! `review`: a flight record from a machine, for a person who asks what happened.

use crate::cli::error::{CommandError, pretty, print};
use comfy_table::Cell;
use firmware_bench::record::file::{RecordFile, begins};
use firmware_bench::record::replay::Replay;
use firmware_bench::record::story::{Event, Told};
use firmware_bench::record::ticks::{ANY_UNIT, FlightRecord, PER_UNIT, Tick, Ticks, Units};
use firmware_bench::report::table::{lined, right};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `review`.
#[derive(Debug, Clone, clap::Args)]
pub struct ReviewArgs {
    /// The sections of one or more records, one after the other, as firmware has written them; or the entries of one of
    /// version 2.
    pub file: PathBuf,
    /// Of version 2: checksum that the firmware gave with the record, e.g. 0x1d9a40c2; eight hexadecimal digits may stand
    /// without 0x.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub crc: Option<String>,
    /// Of version 2: clearance of the retainer bearing, for positions in µm.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub clearance_m: Option<f64>,
    /// Of version 2: force cap, for forces in N.
    #[arg(long, allow_negative_numbers = true, value_name = "NUMBER")]
    pub force_max_n: Option<f64>,
    /// Of version 2: control rate, for times in ms.
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
pub fn execute(args: &ReviewArgs) -> Result<(), CommandError> {
    let units = units(args)?;
    let expected = args.crc.as_deref().map(checksums).transpose()?;
    let name = args.file.display();
    let bytes = std::fs::read(&args.file).map_err(|e| CommandError::Numbers {
        message: format!("{name}: {e}"),
        help: "give the file that the record was written to".to_owned(),
    })?;
    // Damaged at its very beginning it is still no record of version 2, which has no words like these.
    let sections = RecordFile::of(&bytes);
    if begins(&bytes) || !sections.records.is_empty() {
        if units != Units::default() || expected.is_some() {
            return Err(CommandError::Numbers {
                message: format!(
                    "{name} is a record of version 3, which has its own checksums and units"
                ),
                help: "leave --crc, --clearance-m, --force-max-n and --sample-rate-hz out"
                    .to_owned(),
            });
        }
        return of_sections(args, &sections);
    }
    let record = FlightRecord::of(&bytes, units).map_err(|e| CommandError::Numbers {
        message: format!("{name} is no flight record: of version 3 no section is whole, and as one of version 2, {e}"),
        help: "write the sections of a frozen record one after the other, and nothing else".to_owned(),
    })?;
    if record.of.ticks.is_empty() {
        return Err(CommandError::Numbers {
            message: format!("{name}: none of its {} entries was ever written", record.empty),
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
        csv(&record.of)
    } else {
        text(&record, units, expected.is_some())
    })
}

/// An event for programs.
#[derive(Serialize)]
struct Reviewed {
    summary: Option<Told>,
    replay: Option<Replay>,
    /// Why there is no replay.
    no_replay: Option<String>,
    /// Number that the firmware has, and its clock.
    firmware: u32,
    time_us: u64,
    at_sequence: u32,
    /// Events before this one that found a record frozen, and are in none.
    dropped: u32,
    /// Ticks of each plane.
    planes: Vec<Ticks>,
}

/// A file for programs: its first event, and the others.
#[derive(Serialize)]
struct Review {
    intact: bool,
    format: u32,
    error: Option<String>,
    #[serde(flatten)]
    first: Option<Reviewed>,
    others: Vec<Reviewed>,
}

fn reviewed(event: &Event<'_>) -> Reviewed {
    let head = event.records[0].head;
    Reviewed {
        summary: event.told(),
        replay: event.replay.ok(),
        no_replay: event.replay.err().map(|why| why.to_string()),
        firmware: head.firmware,
        time_us: head.time_us,
        at_sequence: head.at_sequence,
        dropped: head.dropped,
        planes: event.records.iter().map(|r| Ticks::of(r)).collect(),
    }
}

/// What is whole is shown; that something is not is an error all the same.
fn of_sections(args: &ReviewArgs, file: &RecordFile) -> Result<(), CommandError> {
    let events = file.events();
    let damage: Vec<String> = file.damage.iter().map(ToString::to_string).collect();
    let error = (!file.is_intact()).then(|| damage.join("; "));
    if args.json {
        let mut all = events.iter().map(reviewed);
        let review = Review {
            intact: file.is_intact(),
            format: 3,
            error: error.clone(),
            first: all.next(),
            others: all.collect(),
        };
        print(&(pretty(&review, "writing JSON")? + "\n"))?;
    } else if args.csv {
        let mut out = String::new();
        for (number, event) in events.iter().enumerate() {
            for record in &event.records {
                let ticks = csv(&Ticks::of(record));
                let mut lines = ticks.lines();
                let head = lines.next().unwrap_or_default();
                if out.is_empty() {
                    let _ = writeln!(out, "event,plane,{head}");
                }
                for line in lines {
                    let _ = writeln!(out, "{number},{},{line}", record.head.plane);
                }
            }
        }
        print(&out)?;
    } else {
        let texts: Vec<String> = events.iter().map(told).collect();
        print(&texts.join("\n"))?;
    }
    match error {
        None => Ok(()),
        Some(error) => Err(CommandError::Numbers {
            message: format!("{}: {error}", args.file.display()),
            help: "what is shown was written so; take the rest from the firmware once more, if it still has it".to_owned(),
        }),
    }
}

/// An event for a person.
fn told(event: &Event<'_>) -> String {
    let head = event.records[0].head;
    let mut out = String::new();
    match event.told() {
        Some(told) => _ = writeln!(out, "{}\n", told.paragraph()),
        None => {
            out += "What came of the event is not whole in this file, or not there of all planes: no verdict.\n\n";
        }
    }
    let _ = match &event.replay {
        Ok(Replay {
            ticks,
            differing: 0,
            ..
        }) => writeln!(
            out,
            "Replayed: {ticks} ticks, all to the last bit as they are recorded."
        ),
        Ok(replay) => writeln!(
            out,
            "Replayed: {} of {} ticks are NOT as they are recorded, the first with sequence number {}.",
            replay.differing,
            replay.ticks,
            replay.first_difference.unwrap_or_default()
        ),
        Err(why) => writeln!(out, "Not replayed: {why}."),
    };
    if head.dropped > 0 {
        let _ = writeln!(
            out,
            "{} events came while a record waited to be read, and are in none.",
            head.dropped
        );
    }
    if head.time_us > 0 {
        let _ = writeln!(
            out,
            "Firmware {}; its clock was {:.6} s at sequence number {}.",
            head.firmware,
            head.time_us as f64 * 1e-6,
            head.at_sequence
        );
    }
    for record in &event.records {
        let ticks = Ticks::of(record);
        let config = record.config.unwrap_or_else(supervisor::Config::example);
        let units = match record.config {
            Some(_) => Units {
                clearance_m: Some(config.clearance_m.into()),
                force_max_n: Some(config.force_max_n.into()),
                sample_rate_hz: Some(1.0 / f64::from(config.sample_period_s)),
            },
            None => Units::default(),
        };
        if event.records.len() > 1 || head.planes > 1 {
            let _ = writeln!(out, "\nPlane {}:", record.head.plane);
        }
        out += &tables(&ticks, units);
        out += &track(record, &ticks, units);
    }
    out
}

/// The slow track, neighbours of the same modes together.
fn track(
    record: &firmware_bench::record::file::PlaneRecord,
    recorded: &Ticks,
    units: Units,
) -> String {
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
    // From the same tick on as those of the other tables.
    let zero = recorded
        .ticks
        .first()
        .map_or(0, |t| t.sequence.wrapping_sub(t.tick as u32));
    let since = |sequence: u32| i64::from(sequence.wrapping_sub(zero).cast_signed());
    for same in record.track.chunk_by(|a, b| a.modes == b.modes) {
        let ticks: i64 = same.iter().map(|s| i64::from(s.ticks)).sum();
        let contact: i64 = same.iter().map(|s| i64::from(s.contact_ticks)).sum();
        let most = |of: fn(&supervisor::Stretch) -> u32| {
            let all = same.iter().map(|s| record.number(of(s)));
            all.fold(0.0, f64::max)
        };
        let names: Vec<&str> = (0..8)
            .filter(|mode| same[0].modes & 1 << mode != 0)
            .filter_map(|mode| firmware_bench::record::ticks::mode_name(mode))
            .collect();
        let touches: u32 = same.iter().map(|s| u32::from(s.touches)).sum();
        table.add_row([
            right(time(
                since(same[0].sequence) - i64::from(same[0].ticks) + 1,
                units,
            )),
            right(time(since(same[same.len() - 1].sequence) + 1, units)),
            Cell::new(names.join(", ")),
            right(touches.to_string()),
            right(format!(
                "{:.0}",
                100.0 * contact as f64 / ticks.max(1) as f64
            )),
            right(scaled(most(|s| s.radius_square).sqrt(), length(units))),
            right(scaled(most(|s| s.force_square).sqrt(), force(units))),
            right(format!("{:.2}", most(|s| s.severity))),
        ]);
    }
    format!("\nThe largest of each, to the end of the event:\n\n{table}\n")
}

fn units(args: &ReviewArgs) -> Result<Units, CommandError> {
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

fn csv(record: &Ticks) -> String {
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
    (PER_UNIT / unit).log10().floor().max(0.0) as usize
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

fn text(record: &FlightRecord, units: Units, compared: bool) -> String {
    let mut out = format!(
        "{} ticks; checksum {:#010x}{}\n",
        record.of.ticks.len(),
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
    out + &tables(&record.of, units)
}

/// Modes of the ticks, and what happened in them.
fn tables(record: &Ticks, units: Units) -> String {
    let (time_unit, length, force) = (time_unit(units), length(units), force(units));
    let mut out = String::new();
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
        "\n{modes}\n\nThese ticks end in the last of the modes.\n\n{happened}"
    );
    out
}
