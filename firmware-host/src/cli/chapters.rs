//! Chapters and claims for the terminal.

use firmware_bench::report::lines::{Cell, Lines, lined, right};
use firmware_bench::report::tone::Tone;
use firmware_studies::campaign::{Block, CLAIM_COLUMNS, Chapter, Claim, Table};

/// Chapters that are not folded, without figures.
pub(super) fn text(chapters: &[Chapter]) -> String {
    let shown = chapters.iter().filter(|chapter| !chapter.folded);
    let of = |chapter: &Chapter| format!("{}\n{}\n", chapter.title, of_blocks(&chapter.blocks));
    shown.map(of).collect()
}

/// Without figures.
pub(super) fn of_blocks(blocks: &[Block]) -> String {
    blocks.iter().filter_map(block).collect()
}

fn block(block: &Block) -> Option<String> {
    match block {
        Block::Paragraph(text) => Some(format!("{text}\n")),
        Block::List(points) => Some(points.iter().map(|point| format!("- {point}\n")).collect()),
        Block::Table(table, _) => Some(format!("{}\n", lines(table))),
        Block::Figures(_) => None,
    }
}

fn lines(table: &Table) -> Lines {
    let mut lines = lined(&table.columns);
    for row in &table.rows {
        let cells = row.iter().enumerate();
        lines.add_row(cells.map(|(i, cell)| match table.is_numeric(i) {
            true => right(cell),
            false => Cell::new(cell),
        }));
    }
    lines
}

/// A row for each claim, and how many hold.
pub(super) fn of_claims(claims: &[Claim]) -> String {
    let mut lines = lined(CLAIM_COLUMNS);
    for claim in claims {
        let [name, bound, measured, holds] = claim.cells();
        let holds = Cell::new(holds).toned(Tone::of_claim(claim.holds));
        lines.add_row([Cell::new(name), right(bound), right(measured), holds]);
    }
    let kept = claims.iter().filter(|claim| claim.holds).count();
    let verdict = Tone::of_claim(kept == claims.len())
        .paint(&format!("{kept} of {} claims hold", claims.len()));
    format!("{lines}\n{verdict}")
}
