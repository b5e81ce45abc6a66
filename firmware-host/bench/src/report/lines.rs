//! Tables for a terminal. All of them are laid out here, and none is wider than what it is shown on.

use super::tone::{Tone, coloured, colours};
use comfy_table::{
    CellAlignment, ColumnConstraint, ContentArrangement, LineStyle, Table, TableStyle, Width,
};
use std::fmt::{self, Display};
use std::sync::OnceLock;
use unicode_width::UnicodeWidthStr;

/// Columns where nothing else is known: of a file, a pipe, and of most terminals.
const USUAL_WIDTH: usize = 80;
/// Below this no table can be read, however it is broken.
const LEAST_WIDTH: usize = 40;
/// A figure of at most so many columns is not broken: a number, a pair of them, one of another.
const LONGEST_FIGURE: usize = 18;
/// Spaces beside each cell.
const PADDING: usize = 2;

static WIDTH: OnceLock<usize> = OnceLock::new();

/// Says how many columns the terminal has that tables are shown on. Said once, before any is; later words are not heard.
pub fn set_width(columns: usize) {
    let _first = WIDTH.set(columns.max(LEAST_WIDTH));
}

/// How many columns tables may take.
pub fn width() -> usize {
    WIDTH.get().copied().unwrap_or(USUAL_WIDTH)
}

/// A line broken between its words, with `indent` before all but its first part. What is no sentence stays whole: a word that is
/// longer, such as a path.
pub fn wrapped(line: &str, indent: &str, width: usize) -> String {
    let options = textwrap::Options::new(width)
        .subsequent_indent(indent)
        .break_words(false)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
        .word_splitter(textwrap::WordSplitter::NoHyphenation)
        .wrap_algorithm(textwrap::WrapAlgorithm::FirstFit);
    textwrap::fill(line, options)
}

/// What is in a table at one place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    text: String,
    /// Of a figure, which stands to the right and is not broken.
    figure: bool,
    /// Its colour on a terminal.
    tone: Option<Tone>,
}

impl Cell {
    /// Words.
    pub fn new(words: impl Display) -> Self {
        Self {
            text: words.to_string(),
            figure: false,
            tone: None,
        }
    }

    /// In a colour, where there are colours.
    #[must_use]
    pub fn toned(self, tone: impl Into<Option<Tone>>) -> Self {
        Self {
            tone: tone.into(),
            ..self
        }
    }

    fn marked(&self, colours: bool) -> String {
        match self.tone.filter(|_| colours) {
            None => self.text.clone(),
            Some(tone) => tone.marked(&self.text),
        }
    }

    /// The narrowest it can be: its longest word.
    fn least(&self) -> usize {
        let whole = self.text.width();
        if self.figure && whole <= LONGEST_FIGURE {
            return whole;
        }
        let words = self.text.split(' ').map(UnicodeWidthStr::width);
        words.max().unwrap_or_default()
    }
}

/// A figure in a table.
pub fn right(value: impl Display) -> Cell {
    Cell {
        figure: true,
        ..Cell::new(value)
    }
}

impl<T: Display> From<T> for Cell {
    fn from(words: T) -> Self {
        Self::new(words)
    }
}

/// A table with one line, between header and rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lines {
    /// Empty where there is none.
    header: Vec<Cell>,
    rows: Vec<Vec<Cell>>,
}

/// A table with such headings.
pub fn lined<C: Into<Cell>>(header: impl IntoIterator<Item = C>) -> Lines {
    Lines {
        header: header.into_iter().map(Into::into).collect(),
        rows: Vec::new(),
    }
}

/// A table without headings.
pub(crate) fn unlined() -> Lines {
    lined([""; 0])
}

impl Lines {
    /// Texts of the headings.
    pub(super) fn headings(&self) -> impl Iterator<Item = &str> {
        self.header.iter().map(|cell| &cell.text[..])
    }

    /// Texts of the rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = Vec<&str>> {
        (self.rows.iter()).map(|row| row.iter().map(|cell| &cell.text[..]).collect())
    }

    /// Whether what is in a column stands to the right.
    pub(super) fn is_of_figures(&self, i: usize) -> bool {
        self.column(i).right
    }

    /// One row more.
    pub fn add_row<C: Into<Cell>>(&mut self, row: impl IntoIterator<Item = C>) {
        self.rows.push(row.into_iter().map(Into::into).collect());
    }

    /// As text of at most so many columns: cells of words are broken first, then the columns stand in groups one below the
    /// other, each with the first ones beside it.
    pub fn within(&self, width: usize) -> String {
        let colours = colours();
        let text = self.laid_out(width, colours);
        if colours { coloured(&text) } else { text }
    }

    fn laid_out(&self, width: usize, colours: bool) -> String {
        let columns: Vec<Column> = (0..self.columns()).map(|i| self.column(i)).collect();
        let key = self.key(&columns, width);
        let groups = groups(&columns, key, width);
        let parts: Vec<String> = (groups.iter())
            .map(|group| self.part(&columns, group, width, colours).to_string())
            .collect();
        parts.join("\n\n")
    }

    fn columns(&self) -> usize {
        let rows = self.rows.iter().map(Vec::len);
        rows.chain([self.header.len()]).max().unwrap_or_default()
    }

    fn column(&self, i: usize) -> Column {
        let head = self.header.get(i);
        let cells = || self.rows.iter().filter_map(move |row| row.get(i));
        // A heading breaks between its words, whatever stands below it.
        let heading = head.map(|cell| Cell::new(&cell.text));
        let all = || heading.iter().chain(cells());
        let figures = cells().filter(|cell| cell.figure).count();
        Column {
            least: all().map(Cell::least).max().unwrap_or_default(),
            body: cells().map(|c| c.text.width()).max().unwrap_or_default(),
            natural: all().map(|c| c.text.width()).max().unwrap_or_default(),
            right: head.is_some_and(|cell| cell.figure) || 2 * figures > cells().count(),
        }
    }

    /// How many columns say which row it is: as few as tell the rows apart, or one, where those would leave no room.
    fn key(&self, columns: &[Column], width: usize) -> usize {
        let distinct = |key: &usize| {
            let mut seen = std::collections::BTreeSet::new();
            let texts = |row: &Vec<Cell>| -> Vec<String> {
                row.iter().take(*key).map(|c| c.text.clone()).collect()
            };
            self.rows.iter().all(|row| seen.insert(texts(row)))
        };
        let room = |key: &usize| 2 * taken(&columns[..*key]) <= width;
        (1..columns.len())
            .take_while(room)
            .find(distinct)
            .unwrap_or(usize::from(columns.len() > 1))
    }

    /// Some of the columns.
    fn part(&self, columns: &[Column], group: &[usize], width: usize, colours: bool) -> Table {
        let mut table = Table::new();
        let line = LineStyle::none().fill('─');
        table.load_style(match self.header.is_empty() {
            true => TableStyle::new(),
            false => TableStyle::new().header_separator(line),
        });
        table.set_content_arrangement(ContentArrangement::Dynamic);
        let of = |row: &[Cell], header: bool| -> Vec<comfy_table::Cell> {
            let cell = |i: &usize| {
                let cell = row.get(*i);
                let text = cell.map_or(String::new(), |cell| cell.marked(colours));
                let figure = cell.is_some_and(|cell| cell.figure);
                let aligned = match figure || header && columns[*i].right {
                    true => CellAlignment::Right,
                    false => CellAlignment::Left,
                };
                comfy_table::Cell::new(text).set_alignment(aligned)
            };
            group.iter().map(cell).collect()
        };
        if !self.header.is_empty() {
            table.set_header(of(&self.header, true));
        }
        for row in &self.rows {
            table.add_row(of(row, false));
        }
        let widths = fitted(columns, group, width);
        for (column, content) in table.column_iter_mut().zip(widths) {
            let padded = u16::try_from(content + PADDING).unwrap_or(u16::MAX);
            column.set_constraint(ColumnConstraint::Absolute(Width::Fixed(padded)));
        }
        table
    }
}

impl Display for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.within(width()))
    }
}

#[derive(Debug, Clone, Copy)]
struct Column {
    /// Width with every word on a line of its own.
    least: usize,
    /// Width with every cell below the heading on one line.
    body: usize,
    /// Width with every cell on one line.
    natural: usize,
    /// Most of it are figures.
    right: bool,
}

/// Width of columns at their narrowest.
fn taken(columns: &[Column]) -> usize {
    columns.iter().map(|c| c.least + PADDING).sum()
}

/// Columns that stand beside each other: all of them, or as many as there is room for beside the `key` ones.
fn groups(columns: &[Column], key: usize, width: usize) -> Vec<Vec<usize>> {
    let all = || (0..columns.len()).collect();
    if taken(columns) <= width {
        return vec![all()];
    }
    let beside = taken(&columns[..key]);
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut used = usize::MAX;
    for (i, column) in columns.iter().enumerate().skip(key) {
        let more = column.least + PADDING;
        if used.saturating_add(more) > width {
            groups.push((0..key).collect());
            used = beside;
        }
        used += more;
        if let Some(group) = groups.last_mut() {
            group.push(i);
        }
    }
    if groups.is_empty() {
        vec![all()]
    } else {
        groups
    }
}

/// Widths of the cells in a group: as they are, or the widest made narrower until they fit. Headings are broken before rows.
fn fitted(columns: &[Column], group: &[usize], width: usize) -> Vec<usize> {
    let mut widths: Vec<usize> = group.iter().map(|i| columns[*i].natural).collect();
    let floors: [fn(&Column) -> usize; 2] = [|c| c.body.max(c.least), |c| c.least];
    for floor in floors {
        while widths.iter().map(|w| w + PADDING).sum::<usize>() > width {
            let widest = (widths.iter_mut().zip(group))
                .filter(|(w, i)| **w > floor(&columns[**i]))
                .max_by_key(|(w, _)| **w);
            match widest {
                Some((widest, _)) => *widest -= 1,
                None => break,
            }
        }
    }
    widths
}

#[cfg(test)]
mod tests {
    use super::{Cell, lined, right, unlined};
    use crate::report::tone::{Tone, coloured};
    use unicode_width::UnicodeWidthStr;

    fn widest(text: &str) -> usize {
        text.lines().map(UnicodeWidthStr::width).max().unwrap()
    }

    #[test]
    fn a_table_with_room_is_not_broken() {
        let mut table = lined(["of", "peak force [N]"]);
        table.add_row([right("µ"), right(12)]);
        let wide = " of  peak force [N] \n────────────────────\n  µ              12 ";
        assert_eq!(table.within(80), wide);
    }

    /// Colours change nothing but colours: the same lines at every width, and none goes on into the next cell or line.
    #[test]
    fn colours_take_no_room() {
        let mut plain = lined(["policy", "how it ended", "remark"]);
        let mut toned = plain.clone();
        for (tone, words) in [
            (Tone::Good, "recovered"),
            (Tone::Fair, "held against it by a load"),
            (Tone::Bad, "whirl"),
        ] {
            let row = [
                Cell::new("p"),
                right(words),
                Cell::new("some words behind it"),
            ];
            plain.add_row(row.clone());
            let [policy, ended, remark] = row;
            toned.add_row([policy, ended.toned(tone), remark]);
        }
        for width in [40, 60, 80] {
            let text = coloured(&toned.laid_out(width, true));
            let mut bare = String::new();
            for part in text.split('\u{1b}') {
                let (code, rest) = part
                    .split_once('m')
                    .filter(|(code, _)| code.starts_with('['))
                    .unwrap_or(("", part));
                assert!(
                    rest.matches('\n').count() == 0 || !matches!(code, "[31m" | "[32m" | "[33m")
                );
                bare.push_str(rest);
            }
            assert_eq!(bare, plain.within(width));
            for colour in ["[32m", "[33m", "[31m"] {
                assert!(text.contains(colour), "{text}");
            }
            // Without a terminal nothing of it is there.
            assert_eq!(toned.within(width), plain.within(width));
        }
    }

    #[test]
    fn words_are_broken_before_columns_are_parted_and_figures_never_are() {
        let mut table = lined(["what it is", "value"]);
        table.add_row([
            super::Cell::new("a long remark of many words"),
            right("1234567 of 9"),
        ]);
        let text = table.within(30);
        assert!(
            widest(&text) <= 30 && text.contains(" 1234567 of 9 "),
            "{text}"
        );
        assert_eq!(text.lines().filter(|line| line.contains('─')).count(), 1);
    }

    #[test]
    fn columns_without_room_stand_below_with_what_tells_rows_apart() {
        let mut table = lined(["plant", "rate", "aaaaaaaa", "bbbbbbbb", "cccccccc"]);
        for (plant, rate) in [("P1", "10"), ("P1", "20"), ("P2", "10")] {
            table.add_row([plant, rate, "12345678", "23456789", "34567890"]);
        }
        let text = table.within(40);
        assert!(widest(&text) <= 40, "{text}");
        let rows: Vec<&str> = text.lines().filter(|l| l.contains("P1     20")).collect();
        assert_eq!(rows.len(), 2, "{text}");
        assert!(
            rows[0].contains("23456789") && rows[1].contains("34567890"),
            "{text}"
        );
    }

    #[test]
    fn rows_without_headings_have_no_line() {
        let mut table = unlined();
        table.add_row(["delay", "twice"]);
        assert_eq!(table.within(80), " delay  twice ");
        assert_eq!(unlined().within(80), "");
    }
}
