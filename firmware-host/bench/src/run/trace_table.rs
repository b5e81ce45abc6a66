//! Traces in memory, column by column, under the names and in the order of the files.

use crate::run::trace::Recorder;
use crate::run::trace_columns::Columns;

/// A column with a few names, and for each row which.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NameColumn {
    /// Place in `names`, by row.
    pub codes: Vec<i32>,
    /// The names, in the order in which they came.
    pub names: Vec<String>,
}

/// The rows of a run in columns.
pub struct TraceTable<R: 'static> {
    columns: Columns<R>,
    /// Numbers, SI units.
    pub numbers: Vec<Vec<f64>>,
    pub names: Vec<NameColumn>,
    /// Truth values.
    pub flags: Vec<Vec<bool>>,
}

/// Headings of a table's columns, kind by kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Headings {
    /// Of numbers, with their units.
    pub numbers: Vec<String>,
    pub names: Vec<&'static str>,
    /// Of truth values.
    pub flags: Vec<&'static str>,
}

impl<R> TraceTable<R> {
    /// An empty one.
    pub fn new(columns: Columns<R>) -> Self {
        Self {
            numbers: vec![Vec::new(); columns.numbers.len()],
            names: vec![NameColumn::default(); columns.texts.len()],
            flags: vec![Vec::new(); columns.flags.len()],
            columns,
        }
    }

    /// Headings of the columns.
    pub fn headings(&self) -> Headings {
        let columns = &self.columns;
        Headings {
            numbers: columns
                .numbers
                .iter()
                .map(|number| number.name.clone())
                .collect(),
            names: columns.texts.iter().map(|(name, _)| *name).collect(),
            flags: columns.flags.iter().map(|(name, _)| *name).collect(),
        }
    }
}

impl NameColumn {
    /// With one row more.
    pub fn push(&mut self, name: String) {
        let last = self.codes.last().copied().unwrap_or_default();
        // Most rows have the name of the one before.
        let code = match self.names.get(last as usize) {
            Some(same) if *same == name => last,
            _ => match self.names.iter().position(|known| *known == name) {
                Some(place) => place as i32,
                None => {
                    self.names.push(name);
                    self.names.len() as i32 - 1
                }
            },
        };
        self.codes.push(code);
    }
}

impl<R> Recorder<R> for TraceTable<R> {
    fn row(&mut self, row: &R) {
        for (column, number) in self.numbers.iter_mut().zip(&self.columns.numbers) {
            column.push((number.value)(row));
        }
        for (column, (_, name)) in self.names.iter_mut().zip(self.columns.texts) {
            column.push(name(row));
        }
        for (column, (_, flag)) in self.flags.iter_mut().zip(self.columns.flags) {
            column.push(flag(row));
        }
    }
}
