//! The page of a flight record: what was recorded over time, and what is to be compared with it.

use super::axes::window_of;
use super::document::{Document, Times};
use super::panels::View;
use super::plot::PlotError;
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
    let times = Times {
        window: window_of(tracks, None),
        focus: None,
        shaded: Vec::new(),
    };
    if tracks.iter().any(|track| !track.t.is_empty()) {
        document.controls();
        let shown = shown(tracks);
        let view = View {
            shown: &shown,
            window: times.window,
            shaded: &times.shaded,
        };
        let text = "Panels of one row share their axes. Times are counted from the last engagement in the record.";
        document.section(
            &shown,
            ("What was recorded", text),
            &view.whole_run()?,
            false,
        );
    }
    document.ended(tracks, &times)
}
