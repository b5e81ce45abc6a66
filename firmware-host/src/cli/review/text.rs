//! An event for a person: as text, and as the parts of the page that say the same.

use super::planes::{figures_of_planes, shapes};
use super::tables::{tick_tables, track};
use super::{Examined, findings, used};
use firmware_bench::record::narrative::{Event, Verdict};
use firmware_bench::record::remaining::Remaining;
use firmware_bench::record::replay::Replay;
use firmware_bench::record::ticks::Ticks;
use firmware_bench::report::lines::Lines;
use firmware_bench::report::record::{RecordPart, RecordParts};
use firmware_bench::report::table;
use firmware_bench::report::tone::Tone;
use std::fmt::Write;

/// Where an event cannot be simulated.
const NOT_SIMULATED: &str =
    "Not simulated: that needs the record of one plane in which the rotor is seen to fly.";

/// Above the slow track.
const TRACK: &str = "The largest of each, to the end of the event";

/// Sentences on retainer bearings, each by its plane where there are several.
pub(super) fn of_bearings(bearings: &[Remaining]) -> Vec<String> {
    let sentences = bearings.iter().map(|bearing| match bearings.len() {
        1 => bearing.sentences(),
        _ => format!("Plane {}. {}", bearing.plane, bearing.sentences()),
    });
    sentences.collect()
}

/// What is wrong with the file, in a sentence; nothing of one that is whole.
pub(super) fn damaged(damage: &[String]) -> Option<String> {
    (!damage.is_empty()).then(|| {
        let what = damage.join("; ");
        format!("The file is damaged: {what}. What follows is of what is whole.")
    })
}

/// Where this build does not do the same.
pub(super) fn differs(event: &Event<'_>) -> Option<String> {
    let replay = event.replay.as_ref().ok()?;
    (replay.differing > 0).then(|| {
        format!(
            "Replayed: {} of {} ticks are NOT as they are recorded, the first with sequence number {}.",
            replay.differing,
            replay.ticks,
            replay.first_difference.unwrap_or_default()
        )
    })
}

/// Whether this build does the same, and what the firmware says of the event; nothing where it was this build that watched.
fn circumstances(of: &Examined<'_>) -> Vec<String> {
    if of.of_log {
        return Vec::new();
    }
    let event = &of.event;
    let head = event.records[0].head;
    let replayed = match &event.replay {
        Ok(Replay { differing: 1.., .. }) => None,
        Ok(Replay { ticks, .. }) => Some(format!(
            "Replayed: {ticks} ticks, all to the last bit as they are recorded."
        )),
        Err(why) => Some(format!("Not replayed: {why}.")),
    };
    let mut sentences: Vec<String> = replayed.into_iter().collect();
    if head.dropped > 0 {
        sentences.push(format!(
            "{} events before this one are in no record: they came while one waited to be read, or had to make room.",
            head.dropped
        ));
    }
    if head.time_us > 0 {
        sentences.push(format!(
            "Firmware {}; its clock was {:.6} s at sequence number {}.",
            head.firmware,
            head.time_us as f64 * 1e-6,
            head.at_sequence
        ));
    }
    sentences
}

/// Of a rotor, both planes beside each other, with captions.
fn of_planes(of: &Examined<'_>) -> Vec<(String, Lines)> {
    let figures = figures_of_planes(&of.event).map(|table| ("Planes".to_owned(), table));
    let moved = of.shapes.map(|moved| {
        let caption = "Motion of both planes while one bounced or whirled".to_owned();
        (caption, shapes(&moved))
    });
    figures.into_iter().chain(moved).collect()
}

fn differing(names: &[&str]) -> Option<String> {
    (!names.is_empty()).then(|| {
        format!(
            "The scene configures the supervisor otherwise than it was on the machine: {}.",
            names.join(", ")
        )
    })
}

fn tone(verdict: Verdict) -> Tone {
    match verdict {
        Verdict::RunOn => Tone::Good,
        Verdict::Plan | Verdict::Look => Tone::Fair,
        Verdict::Inspect => Tone::Bad,
    }
}

/// As text; `asked`: whether it was to be simulated.
pub(super) fn text(of: &Examined<'_>, asked: bool, bearings: &[Remaining]) -> String {
    let event = &of.event;
    let mut out = String::new();
    if let Some(differs) = differs(event) {
        let _ = writeln!(out, "{differs}\n");
    }
    match event.narrative() {
        Some(narrative) => {
            let verdict = narrative.verdict(used(bearings));
            let verdict = tone(verdict).paint(verdict.sentence());
            let _ = writeln!(out, "{} {verdict}\n", narrative.sentences());
        }
        None => {
            out += "The outcome of the event is not whole in this file, or not there for all planes: no verdict.\n\n";
        }
    }
    for bearing in of_bearings(bearings) {
        let _ = writeln!(out, "{bearing}\n");
    }
    for sentence in circumstances(of) {
        let _ = writeln!(out, "{sentence}");
    }
    for (_, table) in of_planes(of) {
        let _ = writeln!(out, "\n{table}");
    }
    let planes = event.records[0].head.planes;
    for record in &event.records {
        let ticks = Ticks::of(record);
        let units = record.units();
        if planes > 1 {
            let _ = writeln!(out, "\nPlane {}:", record.head.plane);
        }
        out += &tick_tables(&ticks, units).text();
        if let (Some(findings), Some(rate)) = (&of.findings, units.sample_rate_hz) {
            for (_, table) in findings::tables(findings, record, 1.0 / rate) {
                let _ = writeln!(out, "\n{table}");
            }
        }
        let _ = write!(out, "\n{TRACK}:\n\n{}\n", track(record, units));
    }
    if let Some(again) = &of.again {
        let _ = writeln!(out, "\n{}", table::text(&again.scene, &again.results));
        if let Some(sentence) = differing(&again.differing) {
            let _ = writeln!(out, "{sentence}");
        }
    } else if asked {
        let _ = writeln!(out, "\n{NOT_SIMULATED}");
    }
    out
}

/// The same as parts of a page, but for what stands in its head and in its list of events.
pub(super) fn parts(events: &[Examined<'_>], asked: bool) -> RecordParts {
    let mut parts = RecordParts::default();
    for (i, of) in events.iter().enumerate() {
        let event = &of.event;
        let of_event = match events.len() {
            1 => String::new(),
            _ => format!("Event {}: ", i + 1),
        };
        parts.above.push(RecordPart {
            heading: format!("{of_event}Outcome"),
            paragraphs: circumstances(of),
            tables: of_planes(of),
            runs: Vec::new(),
        });
        let planes = event.records[0].head.planes;
        for record in &event.records {
            let ticks = Ticks::of(record);
            let units = record.units();
            let heading = match planes {
                1 => format!("{of_event}Tables"),
                _ => format!("{of_event}Tables of plane {}", record.head.plane),
            };
            let of_ticks = tick_tables(&ticks, units);
            let mut tables = vec![("Modes of the recorded ticks".to_owned(), of_ticks.modes)];
            if let (Some(findings), Some(rate)) = (&of.findings, units.sample_rate_hz) {
                let found = findings::tables(findings, record, 1.0 / rate);
                tables.extend(found.map(|(caption, table)| (caption.to_owned(), table)));
            }
            tables.push((TRACK.to_owned(), track(record, units)));
            parts.below.push(RecordPart {
                heading,
                paragraphs: of_ticks.missing.into_iter().collect(),
                tables,
                runs: Vec::new(),
            });
        }
        let (paragraphs, runs) = match &of.again {
            Some(again) => (
                again
                    .results
                    .untrusted()
                    .into_iter()
                    .map(str::to_owned)
                    .chain(differing(&again.differing))
                    .collect(),
                again.results.runs.clone(),
            ),
            None if asked => (vec![NOT_SIMULATED.to_owned()], Vec::new()),
            None => continue,
        };
        parts.below.push(RecordPart {
            heading: format!("{of_event}The event once more"),
            paragraphs,
            tables: Vec::new(),
            runs,
        });
    }
    parts
}
