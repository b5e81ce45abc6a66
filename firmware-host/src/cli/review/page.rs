//! `review --out`: the recorded ticks as a page.

use crate::cli::error::CommandError;
use crate::cli::output::{self, Staging};
use crate::cli::review::text::{damaged, differs, of_bearings};
use crate::cli::review::{Examined, of_event, used};
use firmware_bench::record::file::PlaneRecord;
use firmware_bench::record::remaining::Remaining;
use firmware_bench::record::ticks::Ticks;
use firmware_bench::report::html_page::Head;
use firmware_bench::report::record::{FigureFile, RecordParts, record_figures, record_html};
use firmware_bench::report::summary::summary;
use firmware_bench::report::track::Track;
use firmware_bench::run::verdict::PolicyRun;
use std::path::Path;

/// Writes `report.html` to a folder, whole or not at all.
pub(super) fn write(
    out: &Path,
    (head, parts): (&Head, &RecordParts),
    tracks: &[Track],
) -> Result<(), CommandError> {
    output::probe(out)?;
    let html = record_html(head, parts, tracks)
        .map_err(|e| CommandError::other("drawing the report", e))?;
    let staging = Staging::for_folder(out)?;
    staging.write("report.html", html)?;
    staging.publish()?;
    Ok(())
}

/// Writes each figure to a file of its own in a folder, all or none.
pub(super) fn write_figures(folder: &Path, tracks: &[Track]) -> Result<(), CommandError> {
    output::probe(folder)?;
    let figures =
        record_figures(tracks).map_err(|e| CommandError::other("drawing the figures", e))?;
    let staging = Staging::for_folder(folder)?;
    for FigureFile { name, svg } in &figures {
        staging.write(name, svg)?;
    }
    staging.publish()?;
    Ok(())
}

/// What stands above the figures of these events; `damage`: what is wrong with their file, and what a log tells of itself.
pub(super) fn head(
    name: &str,
    (events, bearings): (&[Examined<'_>], &[Remaining]),
    (damage, log): (&[String], Option<String>),
) -> Head {
    let what = if log.is_some() {
        "Log"
    } else {
        "Flight record"
    };
    let many = events.len() > 1;
    let paragraphs: Vec<String> = (events.iter().enumerate())
        .map(|(i, of)| {
            let paragraph = of.event.narrative().map_or_else(
                || "No verdict: the outcome of the event is not whole in the file.".to_owned(),
                |narrative| narrative.paragraph(used(of_event(bearings, i, events))),
            );
            match many {
                true => format!("Event {}: {paragraph}", i + 1),
                false => paragraph,
            }
        })
        .collect();
    let before = damaged(damage).into_iter();
    Head {
        title: format!("{what} {name}"),
        headline: paragraphs.join(" "),
        story: (log.into_iter().chain(of_bearings(bearings)))
            .collect::<Vec<_>>()
            .join("\n\n"),
        warnings: before
            .chain(events.iter().filter_map(|of| differs(&of.event)))
            .collect(),
        ..Head::default()
    }
}

/// What each plane of each event has recorded, under a name that tells it from the others, and what was simulated of it.
pub(super) fn tracks(events: &[Examined<'_>]) -> Vec<Track> {
    let mut tracks = Vec::new();
    for (i, of) in events.iter().enumerate() {
        for record in &of.event.records {
            let name = name(i, record, events.len() > 1);
            let ticks = Ticks::of(record);
            tracks.push(Track::of_ticks(&name, &ticks, record.units()));
            let slow = format!("{name}: slow track");
            tracks.extend(Track::of_stretches(&slow, record));
        }
        let (Some(again), Some(findings)) = (&of.again, &of.findings) else {
            continue;
        };
        let begins =
            of.event.records[0].tick_of(findings.first) as f64 + findings.launch.tick as f64;
        let begins_ms = 1e3 * begins / again.scene.sample_rate_hz;
        let scene = summary(&again.scene, 0);
        for run in again.results.planes.iter().flatten() {
            let run = PolicyRun {
                name: format!("simulated: {}", run.name),
                ..run.clone()
            };
            tracks.push(Track::of_run(&scene, &run).later(begins_ms));
        }
    }
    tracks
}

fn name(event: usize, record: &PlaneRecord, many: bool) -> String {
    let plane = (record.head.planes > 1).then(|| format!("plane {}", record.head.plane));
    let event = many.then(|| format!("event {}", event + 1));
    let parts: Vec<String> = event.into_iter().chain(plane).collect();
    match parts.is_empty() {
        true => "recorded".to_owned(),
        false => format!("recorded, {}", parts.join(", ")),
    }
}
