//! Records of version 2, which are their entries and nothing else: units and checksum come from the command line.

use super::ReviewArgs;
use super::page;
use super::tables::{csv, tick_tables};
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::screen::tell;
use firmware_bench::record::ticks::{ANY_UNIT, FlightRecord, Units};
use firmware_bench::report::html_page::Head;
use firmware_bench::report::record::RecordParts;
use firmware_bench::report::track::Track;
use std::fmt::Write;

/// Shows one; `expected`: what its checksum may be.
pub(super) fn show(
    args: &ReviewArgs,
    bytes: &[u8],
    units: Units,
    expected: Option<&[u32]>,
) -> Result<(), CommandError> {
    let name = args.file.display();
    let record = FlightRecord::of(bytes, units).map_err(|e| CommandError::Numbers {
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
    if let Some(expected) = expected
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
    if let Some(out) = &args.out {
        let head = Head {
            title: format!("Flight record {name}"),
            headline: "A record of version 2 has no summary: what happened is in its ticks."
                .to_owned(),
            ..Head::default()
        };
        page::write(
            out,
            (&head, &RecordParts::default()),
            &[Track::of_ticks("recorded", &record.of, units)],
        )?;
    }
    if let Some(folder) = &args.figures {
        page::write_figures(folder, &[Track::of_ticks("recorded", &record.of, units)])?;
    }
    if args.json {
        print(&(pretty(&record, "writing JSON")? + "\n"))
    } else if args.csv {
        print(&csv(&record.of))
    } else {
        tell(&text(&record, units, expected.is_some()))
    }
}

pub(super) fn units(args: &ReviewArgs) -> Result<Units, CommandError> {
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
pub(super) fn checksums(text: &str) -> Result<Vec<u32>, CommandError> {
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
    out + &tick_tables(&record.of, units).text()
}
