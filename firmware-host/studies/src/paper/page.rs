//! The chapters as a page, and as a study: what the paper says of a number is the claim.

use super::rows::{computed, deviation, kind, paper};
use super::summary::Summary;
use super::{CHAPTERS, Chapter, ChapterError, MISS, Row, Stated};
use crate::campaign::{
    Block, Chapter as Shown, Claim, Extent, Page, Progress, Report, StudyError, Table,
};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};

/// Every chapter, on the threads of the pool that it is called in.
///
/// # Errors
/// [`ChapterError`].
pub fn chapters(extent: Extent, progress: &dyn Progress) -> Result<Vec<Chapter>, ChapterError> {
    progress.begin(CHAPTERS.len() as u64, "chapters");
    (CHAPTERS.par_iter())
        .map(|(name, compute)| {
            let chapter = compute(extent).map_err(|reason| ChapterError { name, reason });
            progress.add(1);
            chapter
        })
        .collect()
}

/// The paper as a study.
///
/// # Errors
/// [`ChapterError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let chapters = chapters(extent, progress)?;
    let Page {
        title,
        chapters: shown,
        ..
    } = page(&chapters);
    let rows = chapters.iter().flat_map(|chapter| &chapter.rows);
    Ok(Report {
        classes: Vec::new(),
        title,
        cases: rows.clone().count() as u64,
        claims: rows.flat_map(claims).collect(),
        chapters: shown,
    })
}

/// That a row meets what the paper states; a range has two sides.
fn claims(row: &Row) -> Vec<Claim> {
    let Some(computed) = row.computed else {
        return Vec::new();
    };
    let unit = if row.unit.is_empty() {
        String::new()
    } else {
        format!(" [{}]", row.unit)
    };
    let name = format!("{}{unit}", row.quantity);
    match row.stated {
        Stated::Value => (row.deviation.iter())
            .map(|d| {
                Claim::at_most(
                    format!("{}: off the paper's value", row.quantity),
                    MISS,
                    d.abs(),
                )
            })
            .collect(),
        Stated::AtMost(high) => vec![Claim::at_most(name, high, computed)],
        Stated::AtLeast(low) => vec![Claim::at_least(name, low, computed)],
        Stated::Between(low, high) => vec![
            Claim::at_least(name.clone(), low, computed),
            Claim::at_most(name, high, computed),
        ],
    }
}

/// The page: a summary with the rows that miss, and every chapter.
pub fn page(chapters: &[Chapter]) -> Page {
    let summary = Summary::of(chapters);
    let mut lead = vec![
        Block::Paragraph(
            "Numbers and figures of the paper \u{201c}Dry Friction Backward Whirl of Rotors: \
             Theory, Experiments, Results, and Recommendations\u{201d}, computed from its equations (2.1) to (2.9). \
             Where the paper's figures are not legible as numbers, only what its text says is compared."
                .to_owned(),
        ),
        Block::List(summary.sentences()),
    ];
    if !summary.misses.is_empty() {
        let with_chapter = |(chapter, row): &(&Chapter, &Row)| {
            [chapter.title.to_owned()]
                .into_iter()
                .chain(cells(row))
                .collect()
        };
        let table = Table {
            caption: "Rows that miss, and why".to_owned(),
            columns: ["Chapter"]
                .into_iter()
                .chain(COLUMNS)
                .map(str::to_owned)
                .collect(),
            rows: summary.misses.iter().map(with_chapter).collect(),
        };
        lead.push(Block::Table(table, Vec::new()));
    }
    Page {
        title: "Dry friction backward whirl: the paper, reproduced".to_owned(),
        headline: summary.conclusion(),
        lead,
        chapters: chapters.iter().map(shown).collect(),
    }
}

fn shown(chapter: &Chapter) -> Shown {
    let mut blocks: Vec<Block> = chapter
        .story
        .iter()
        .cloned()
        .map(Block::Paragraph)
        .collect();
    if !chapter.rows.is_empty() {
        let table = Table {
            caption: "Paper and model".to_owned(),
            columns: COLUMNS.map(str::to_owned).to_vec(),
            rows: chapter.rows.iter().map(|row| cells(row).to_vec()).collect(),
        };
        let missed = chapter
            .rows
            .iter()
            .map(|row| row.holds() == Some(false))
            .collect();
        blocks.push(Block::Table(table, missed));
    }
    blocks.push(Block::Figures(chapter.figures.clone()));
    blocks.extend(
        chapter
            .tables
            .iter()
            .map(|table| Block::Table(table.clone(), Vec::new())),
    );
    Shown::new(chapter.title, blocks)
}

const COLUMNS: [&str; 8] = [
    "Quantity",
    "Source",
    "Paper",
    "Computed",
    "Unit",
    "Deviation",
    "Kind",
    "Note",
];

fn cells(row: &Row) -> [String; 8] {
    [
        row.quantity.clone(),
        row.source.to_owned(),
        paper(row),
        computed(row),
        row.unit.to_owned(),
        deviation(row),
        kind(row.kind).to_owned(),
        row.note.clone(),
    ]
}
