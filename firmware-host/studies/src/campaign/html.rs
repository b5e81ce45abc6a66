//! A page of chapters as one HTML document without scripts, made by the builder of all report pages.

use super::chapter::{Block, Drawing, Figure, Page, Table};
use firmware_bench::report::html_page::{Head, HtmlPage, anchor};
use firmware_bench::report::listing::Listing;
use firmware_bench::report::markup::Markup;
use firmware_bench::report::plot::PlotError;
use firmware_bench::report::rendered::Rendered;

/// The document. Deterministic: the same page gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(page: &Page) -> Result<String, PlotError> {
    let mut html = HtmlPage::begun(&Head {
        title: page.title.clone(),
        headline: page.headline.clone(),
        ..Head::default()
    });
    let open = || (page.chapters.iter().zip(1..)).filter(|(chapter, _)| !chapter.folded);
    // The first figure is to be seen before anybody scrolls; its chapter goes without it.
    let first = open().find_map(|(chapter, number)| Some((number, first_figure(&chapter.blocks)?)));
    if let Some((number, figure)) = first {
        html.figures(&[drawn(figure, &format!("{number}.1"))?]);
    }
    let shown = first.map(|(_, figure)| figure);
    html.contents(open().map(|(chapter, _)| &chapter.title[..]));
    html.section("Summary", |html| push_blocks(html, &page.lead, 0, shown))?;
    for (chapter, number) in page.chapters.iter().zip(1..) {
        let write = |html: &mut HtmlPage| push_blocks(html, &chapter.blocks, number, shown);
        match chapter.folded {
            true => html.folded(&chapter.title, write),
            false => html.chapter(number, &chapter.title, write),
        }?;
    }
    Ok(html.ended())
}

fn first_figure(blocks: &[Block]) -> Option<&Figure> {
    blocks.iter().find_map(|block| match block {
        Block::Figures(figures) => figures.first(),
        _ => None,
    })
}

/// All but the figure that is shown already.
fn push_blocks(
    html: &mut HtmlPage,
    blocks: &[Block],
    chapter: usize,
    shown: Option<&Figure>,
) -> Result<(), PlotError> {
    for block in blocks {
        match block {
            Block::Paragraph(text) => html.paragraph(&Markup::prose(text)),
            Block::List(points) => {
                html.points(&points.iter().map(Markup::text).collect::<Vec<_>>());
            }
            Block::Table(table, marked) => html.table(&listing(table, marked)),
            Block::Figures(figures) => {
                let drawn: Result<Vec<Rendered>, PlotError> = (figures.iter().zip(1..))
                    .filter(|(figure, _)| !shown.is_some_and(|shown| std::ptr::eq(shown, *figure)))
                    .map(|(figure, number)| drawn(figure, &format!("{chapter}.{number}")))
                    .collect();
                html.figures(&drawn?);
            }
        }
    }
    Ok(())
}

fn listing(table: &Table, marked: &[bool]) -> Listing {
    Listing {
        columns: (0..table.columns.len()).map(|i| table.kind_of(i)).collect(),
        marked: marked.to_vec(),
        ..Listing::of_texts(&table.caption, &table.columns, table.rows.clone())
    }
}

fn drawn(figure: &Figure, number: &str) -> Result<Rendered, PlotError> {
    let drawn = match &figure.drawing {
        Drawing::Chart(plot) => Rendered::of_chart(plot)?,
        Drawing::Map(plot) => Rendered::of_map(plot)?,
    };
    let id = format!("figure-{}", anchor(&figure.file));
    Ok(drawn.numbered(id, number, &figure.caption))
}
