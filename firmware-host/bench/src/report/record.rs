//! The page of a flight record: what was recorded over time, and what is to be compared with it.

use super::axes::window_of;
use super::document::{Document, Times};
use super::panels::View;
use super::plot::{PlotError, alone};
use super::track::Track;
use super::{happenings, push_headline, push_story, push_warnings, shown};

/// What stands above the figures.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RecordHead {
    /// Title of the page, one line.
    pub title: String,
    /// What happened, the conclusion of it.
    pub headline: String,
    /// Paragraphs below it, with an empty line between two.
    pub story: String,
    /// What is damaged or does not fit.
    pub warnings: Vec<String>,
}

/// Complete HTML document on what was recorded, tracks side by side: those of the record, and simulations of it, if any.
/// Deterministic: the same input gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn record_html(head: &RecordHead, tracks: &[Track]) -> Result<String, PlotError> {
    let mut document = Document::begun(&head.title);
    let page = &mut document.html;
    push_headline(page, &head.headline);
    push_story(page, &head.story);
    push_warnings(page, &head.warnings);
    page.push_str("</header>\n<main>\n");
    for track in tracks.iter().filter(|track| !track.events.is_empty()) {
        happenings::push_of_track(page, track);
    }
    let window = window_of(tracks, None);
    // A slow track may go on for long after what was recorded tick by tick.
    let fast = window_of(tracks.iter().filter(|track| track.has_path()), None);
    let fast = Some(fast).filter(|fast| fast.size() < 0.5 * window.size());
    let times = Times {
        window,
        focus: fast,
        shaded: Vec::new(),
    };
    if tracks.iter().any(|track| !track.t.is_empty()) {
        document.controls();
        let shown = shown(tracks);
        let view = |window| View {
            shown: &shown,
            window,
            shaded: &times.shaded,
        };
        let text = "Panels of one row share their axes. Times are counted from the last engagement in the record. A slow track \
                    goes on to the end of the event: it has the largest values of each stretch of ticks, and its mode where that \
                    did not change.";
        let rows = view(times.window).whole_run()?;
        document.section(&shown, ("What was recorded", text), &rows, false);
        if let Some(window) = times.focus {
            let text = "The stretch that was recorded tick by tick.";
            let rows = view(window).fast()?;
            document.section(&shown, ("Close-up", text), &rows, true);
        }
    }
    document.ended(tracks, &times)
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
