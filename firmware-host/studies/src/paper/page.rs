//! The chapters as a page, and as a study: what the paper says of a number is the claim.

use super::rows::{COLUMNS, values};
use super::summary::sentences;
use super::{CHAPTERS, Chapter, ChapterError, MISS, Paper, Row};
use crate::campaign::{
    Block, Chapter as Shown, Claim, Extent, Progress, Report, StudyError, Table, each,
};

/// Every chapter, on the threads of the pool that it is called in.
///
/// # Errors
/// [`ChapterError`].
pub fn chapters(extent: Extent, progress: &dyn Progress) -> Result<Vec<Chapter>, ChapterError> {
    progress.begin(CHAPTERS.len() as u64, "chapters");
    let chapters = each(CHAPTERS, |(name, compute)| {
        let chapter = compute(extent).map_err(|reason| ChapterError { name, reason });
        progress.add(1);
        chapter
    });
    chapters.into_iter().collect()
}

/// The paper as a study.
///
/// # Errors
/// [`ChapterError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    Ok(report(&chapters(extent, progress)?))
}

/// What the chapters come to, with the rows that miss before them.
pub fn report(chapters: &[Chapter]) -> Report {
    let rows = chapters.iter().flat_map(|chapter| &chapter.rows);
    Report {
        classes: values(chapters),
        cases: rows.clone().count() as u64,
        claims: rows.flat_map(claims).collect(),
        title: TITLE.to_owned(),
        chapters: ([summary(chapters)].into_iter())
            .chain(chapters.iter().map(shown))
            .map(|chapter| Shown {
                in_docs: false,
                ..chapter
            })
            .collect(),
    }
}

/// That a row meets what the paper has; a range has two sides.
fn claims(row: &Row) -> Vec<Claim> {
    let Some(computed) = row.computed else {
        return Vec::new();
    };
    let name = match row.unit {
        "" => row.item.clone(),
        unit => format!("{} [{unit}]", row.item),
    };
    match row.paper {
        Paper::Silent => Vec::new(),
        Paper::Value(_) => {
            let name = format!("{}: off the paper's value", row.item);
            let off = row.deviation().map(f64::abs);
            (off.into_iter())
                .map(|off| Claim::at_most(&name, MISS, off))
                .collect()
        }
        Paper::AtMost(high) => vec![Claim::at_most(name, high, computed)],
        Paper::AtLeast(low) => vec![Claim::at_least(name, low, computed)],
        Paper::Between(low, high) => vec![
            Claim::at_least(name.clone(), low, computed),
            Claim::at_most(name, high, computed),
        ],
    }
}

const TITLE: &str = "Dry friction backward whirl: the paper, reproduced";
const ABOUT: &str = "Numbers and figures of the paper \u{201c}Dry Friction Backward Whirl of Rotors: \
     Theory, Experiments, Results, and Recommendations\u{201d}, computed from its equations (2.1) to (2.9). \
     Where the paper's figures are not legible as numbers, only what its text says is compared.";

fn summary(chapters: &[Chapter]) -> Shown {
    let misses = chapters.iter().flat_map(|chapter| {
        let missed = (chapter.rows.iter()).filter(|row| row.holds() == Some(false));
        missed.map(|row| with_chapter(chapter.title.to_owned(), row.cells()))
    });
    let misses = Table {
        caption: "Rows that miss, and why".to_owned(),
        columns: with_chapter("Chapter".to_owned(), COLUMNS.map(str::to_owned)),
        rows: misses.collect(),
    };
    let mut blocks = vec![Block::text(ABOUT), Block::List(sentences(chapters))];
    if !misses.rows.is_empty() {
        blocks.push(Block::Table(misses, Vec::new()));
    }
    Shown::new("How good the predictions are", blocks)
}

fn with_chapter(chapter: String, cells: [String; 8]) -> Vec<String> {
    [chapter].into_iter().chain(cells).collect()
}

/// A chapter: its story, its rows with those that miss marked, figures, tables.
fn shown(chapter: &Chapter) -> Shown {
    let rows = &chapter.rows;
    let table = Table {
        caption: "Paper and model".to_owned(),
        columns: COLUMNS.map(str::to_owned).to_vec(),
        rows: rows.iter().map(|row| row.cells().to_vec()).collect(),
    };
    let missed = rows.iter().map(|row| row.holds() == Some(false));
    let mut blocks: Vec<Block> = chapter.story.iter().map(Block::text).collect();
    blocks.push(Block::Table(table, missed.collect()));
    blocks.push(Block::Figures(chapter.figures.clone()));
    let tables = chapter.tables.iter().cloned();
    blocks.extend(tables.map(|table| Block::Table(table, Vec::new())));
    Shown::new(chapter.title, blocks)
}
