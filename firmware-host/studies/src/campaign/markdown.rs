//! A page in Markdown, for the documentation.

use super::chapter::{Block, Page};
use firmware_bench::report::listing::Column;

/// The page. Figures are in the HTML page alone, and so are folded chapters. Deterministic.
pub fn markdown(page: &Page) -> String {
    let mut parts = vec![format!("# {}", plain(&page.title))];
    parts.extend(page.lead.iter().filter_map(block));
    for chapter in page.chapters.iter().filter(|chapter| !chapter.folded) {
        parts.push(format!("## {}", plain(&chapter.title)));
        parts.extend(chapter.blocks.iter().filter_map(block));
    }
    parts.join("\n\n") + "\n"
}

/// A part of a page; `None` where Markdown has nothing of it.
pub fn block(block: &Block) -> Option<String> {
    match block {
        // May have markup of its own.
        Block::Paragraph(text) => Some(text.clone()),
        Block::List(points) => {
            let points: Vec<String> = points.iter().map(|p| format!("- {}", plain(p))).collect();
            (!points.is_empty()).then(|| points.join("\n"))
        }
        Block::Table(table, _) => {
            let line = |cells: &[String]| format!("| {} |", cells.join(" | "));
            let rules = (0..table.columns.len()).map(|i| match table.kind_of(i) {
                Column::Numbers => "--:".to_owned(),
                Column::Words | Column::LongTexts => "---".to_owned(),
            });
            let mut lines = vec![line(&table.columns), line(&rules.collect::<Vec<_>>())];
            lines.extend((table.rows.iter()).map(|row| {
                let cells: Vec<String> = row.iter().map(|cell| plain(cell)).collect();
                line(&cells)
            }));
            if !table.caption.is_empty() {
                lines.splice(0..0, [format!("{}:", plain(&table.caption)), String::new()]);
            }
            Some(lines.join("\n"))
        }
        Block::Figures(_) => None,
    }
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
    use super::plain;

    #[test]
    fn titles_stay_in_their_cells() {
        assert_eq!(plain("a|b <i> *c*\n[d](e)"), r"a\|b &lt;i> \*c\* \[d\](e)");
        assert_eq!(plain("30°, 1.0 × capacity"), "30°, 1.0 × capacity");
    }
}
