//! The page of a flight record: what was recorded over time, and what is to be compared with it.

use super::axes::window_of;
use super::document::{Document, Times};
use super::html_page::{Head, HtmlPage};
use super::lines::Lines;
use super::listing::Listing;
use super::markup::Markup;
use super::panels::{View, first_seen};
use super::plot::{PlotError, alone};
use super::table::supervisor_first;
use super::track::Track;
use super::{happenings, push_table, shown};
use crate::run::verdict::PolicyRun;

/// A part of what is printed of a record, under a heading.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordPart {
    /// What it is of.
    pub heading: String,
    /// Paragraphs.
    pub paragraphs: Vec<String>,
    /// Tables with their captions.
    pub tables: Vec<(String, Lines)>,
    /// Runs that are compared, as `run` shows them.
    pub runs: Vec<PolicyRun>,
}

/// What stands above the figures and below them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RecordParts {
    /// Outcome of the event.
    pub above: Vec<RecordPart>,
    /// What it is found out from.
    pub below: Vec<RecordPart>,
}

fn push_parts(page: &mut HtmlPage, parts: &[RecordPart]) {
    /// Of a longer table the rows scroll.
    const IN_SIGHT: usize = 16;
    for part in parts {
        page.section(&part.heading, |page| {
            for text in &part.paragraphs {
                page.paragraph(&Markup::text(text));
            }
            page.columns(|page| {
                for (caption, lines) in &part.tables {
                    let listing = Listing::of_lines(caption, lines);
                    let low = listing.rows.len() > IN_SIGHT;
                    page.table(&Listing { low, ..listing });
                }
            });
            if !part.runs.is_empty() {
                push_table(page, "Verdicts", &supervisor_first(&part.runs));
            }
        });
    }
}

/// Complete HTML document on what was recorded: what is printed of it, then tracks side by side, those of the record, and
/// simulations of it, if any.
/// Deterministic: the same input gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn record_html(
    head: &Head,
    parts: &RecordParts,
    tracks: &[Track],
) -> Result<String, PlotError> {
    let mut document = Document::begun(head);
    let window = window_of(tracks, None);
    // A slow track may go on for long after what was recorded tick by tick.
    let fast = window_of(tracks.iter().filter(|track| track.has_path()), None);
    let fast = Some(fast).filter(|fast| fast.size() < 0.5 * window.size());
    let times = Times {
        window,
        focus: fast,
        shaded: Vec::new(),
    };
    let shown = shown(tracks);
    let any = tracks.iter().any(|track| !track.t.is_empty());
    let rows = match any {
        true => times.view(&shown).whole_run()?,
        false => Vec::new(),
    };
    let (first, others) = first_seen(rows);
    if any {
        document.first_section(&shown, &times, "", &first);
    }
    document.page.columns(|page| {
        page.about(head);
        push_parts(page, &parts.above);
        for track in tracks.iter().filter(|track| !track.events.is_empty()) {
            page.block(|page| happenings::push_of_track(page, track));
        }
    });
    if any {
        let text = "Panels of one row share their axes. Times are counted from the last engagement in the record. A slow track \
                    goes on to the end of the event: it has the largest values of each stretch of ticks, and its mode where that \
                    did not change.";
        document.section(&shown, ("What was recorded", text), &others, false);
        if let Some(window) = times.focus {
            let text = "The stretch that was recorded tick by tick.";
            let view = View {
                window,
                ..times.view(&shown)
            };
            let rows = view.fast()?;
            document.section(&shown, ("Close-up", text), &rows, true);
        }
    }
    push_parts(&mut document.page, &parts.below);
    Ok(document.ended(tracks, &times))
}

/// A figure in a file of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureFile {
    /// Of what and what, such as `recorded-orbit.svg`.
    pub name: String,
    /// The drawing.
    pub svg: String,
}

/// The figures of that page, each track over its own time.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn record_figures(tracks: &[Track]) -> Result<Vec<FigureFile>, PlotError> {
    let mut files = Vec::new();
    for track in tracks.iter().filter(|track| !track.t.is_empty()) {
        let shown = shown(std::slice::from_ref(track));
        let view = View {
            shown: &shown,
            window: window_of([track], None),
            shaded: &[],
        };
        for row in view.whole_run()? {
            let name = file_name(&format!("{} {}", track.name, row.heading));
            files.extend(row.cells.iter().map(|cell| FigureFile {
                name: format!("{name}.svg"),
                svg: alone(&cell.svg),
            }));
        }
    }
    Ok(files)
}

/// Words of letters and digits.
fn file_name(of: &str) -> String {
    let words = of.split(|c: char| !c.is_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("-").to_lowercase()
}
