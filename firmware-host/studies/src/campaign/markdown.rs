//! A page in Markdown, short enough for the documentation: what is claimed and the first rows of what was measured.

use super::chapter::{Block, Page, Table};
use firmware_bench::report::listing::Column;

/// Lists and tables with more rows are cut.
const MOST_ROWS: usize = 12;
/// To so many, or to the rows that are to catch the eye where these are more.
const ROWS_OF_CUT: usize = 8;

/// What the documentation has of a page: its chapters without title and lead, long tables cut to their first rows. Figures and
/// what is not for it are in the HTML page alone. Deterministic.
pub fn digest(page: &Page) -> String {
    let mut parts = Vec::new();
    for chapter in page.chapters.iter().filter(|chapter| chapter.in_docs) {
        parts.push(format!("## {}", plain(&chapter.title)));
        parts.extend(chapter.blocks.iter().filter_map(block));
    }
    parts.join("\n\n") + "\n"
}

/// A part of a page; `None` where Markdown has nothing of it.
fn block(block: &Block) -> Option<String> {
    match block {
        // May have markup of its own.
        Block::Paragraph(text) => Some(text.clone()),
        Block::List(points) => {
            let shown = shown(points, &[]);
            let mut lines: Vec<String> = (shown.iter())
                .map(|point| format!("- {}", plain(point)))
                .collect();
            lines.extend(remark(shown.len(), points.len()).map(|remark| format!("- {remark}")));
            (!lines.is_empty()).then(|| lines.join("\n"))
        }
        Block::Table(table, marked) => Some(table_in_markdown(table, marked)),
        Block::Figures(_) => None,
    }
}

fn table_in_markdown(table: &Table, marked: &[bool]) -> String {
    let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
    let rules = (0..table.columns.len()).map(|i| match table.kind_of(i) {
        Column::Numbers => "--:".to_owned(),
        Column::Words | Column::LongTexts => "---".to_owned(),
    });
    let mut lines = vec![line(&table.columns), line(&rules.collect::<Vec<_>>())];
    let shown = shown(&table.rows, marked);
    lines.extend(shown.iter().map(|row| {
        let cells: Vec<String> = row.iter().map(|cell| plain(cell)).collect();
        line(&cells)
    }));
    if !table.caption.is_empty() {
        lines.splice(0..0, [format!("{}:", plain(&table.caption)), String::new()]);
    }
    if let Some(remark) = remark(shown.len(), table.rows.len()) {
        lines.extend([String::new(), remark]);
    }
    lines.join("\n")
}

/// Rows that the documentation shows, in their order: all of a few; of many those that are marked, and the first others.
fn shown<'a, T>(rows: &'a [T], marked: &[bool]) -> Vec<&'a T> {
    let is_marked = |i: usize| marked.get(i).copied().unwrap_or(false);
    let all_marked = marked.iter().filter(|marked| **marked).count();
    let mut others = match rows.len() > MOST_ROWS {
        true => ROWS_OF_CUT.saturating_sub(all_marked),
        false => rows.len(),
    };
    let mut is_shown = |i: usize| {
        let fits = is_marked(i) || others > 0;
        others -= usize::from(fits && !is_marked(i));
        fits
    };
    let numbered = rows.iter().enumerate();
    numbered
        .filter_map(|(i, row)| is_shown(i).then_some(row))
        .collect()
}

/// What is said where rows are left out.
fn remark(shown: usize, rows: usize) -> Option<String> {
    (shown < rows).then(|| format!("{shown} of {rows} rows."))
}

/// Text that neither ends a cell of a table nor begins markup.
fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '\\' | '|' | '`' | '*' | '[' | ']' => out.extend(['\\', c]),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{Block, block, plain, shown};

    #[test]
    fn titles_stay_in_their_cells() {
        assert_eq!(plain("a|b <i> *c*\n[d](e)"), r"a\|b &lt;i> \*c\* \[d\](e)");
        assert_eq!(plain("30°, 1.0 × capacity"), "30°, 1.0 × capacity");
    }

    #[test]
    fn long_tables_are_cut() {
        let table = |rows: usize| Block::table(["n"], (0..rows).map(|n| [n.to_string()]));
        let lines = |rows| block(&table(rows)).unwrap().lines().count();
        assert_eq!([lines(12), lines(13)], [2 + 12, 2 + 8 + 2]);
        assert!(block(&table(40)).unwrap().ends_with("8 of 40 rows."));
    }

    #[test]
    fn what_is_marked_stays() {
        let numbers: Vec<usize> = (0..40).collect();
        let marked = |all: &[usize]| numbers.iter().map(|n| all.contains(n)).collect::<Vec<_>>();
        let of = |all: &[usize]| shown(&numbers, &marked(all)).into_iter().copied().collect();
        let few: Vec<usize> = of(&[39]);
        assert_eq!(few, [0, 1, 2, 3, 4, 5, 6, 39]);
        let many: Vec<usize> = of(&(20..35).collect::<Vec<_>>());
        assert_eq!(many, (20..35).collect::<Vec<_>>());
    }
}
