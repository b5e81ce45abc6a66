//! Figures as the columns of a file with a row a run: which there are, and the cells of a run.

use crate::run::outcome::Outcome;

/// What a column holds; any cell of it may be empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Number,
    /// Whole numbers.
    Whole,
    /// Truth values.
    Truth,
    Text,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its name: the key that the figure has in `verdict.json`, with those above it before points.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
}

/// A cell of a column of its kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    Number(Option<f64>),
    /// A whole number.
    Whole(Option<i64>),
    /// A truth value.
    Truth(Option<bool>),
    Text(Option<String>),
}

impl Kind {
    /// An empty cell.
    pub fn empty(self) -> Cell {
        match self {
            Self::Number => Cell::Number(None),
            Self::Whole => Cell::Whole(None),
            Self::Truth => Cell::Truth(None),
            Self::Text => Cell::Text(None),
        }
    }
}

/// What is written in columns: one, or several of what has parts.
pub(crate) trait Columnar {
    /// Its columns, under a name.
    fn columns(name: &str, into: &mut Vec<Column>);
    /// The cells of one, or empty ones.
    fn cells(this: Option<&Self>, into: &mut Vec<Cell>);
}

/// Name of a part, under a name.
pub(crate) fn below(name: &str, part: &str) -> String {
    match name {
        "" => part.to_owned(),
        name => format!("{name}.{part}"),
    }
}

/// Types of one column.
macro_rules! one_column {
    ($($type:ty => $kind:ident, $cell:expr;)*) => {$(
        impl Columnar for $type {
            fn columns(name: &str, into: &mut Vec<Column>) {
                into.push(Column { name: name.to_owned(), kind: Kind::$kind });
            }

            fn cells(this: Option<&Self>, into: &mut Vec<Cell>) {
                into.push(Cell::$kind(this.map($cell)));
            }
        }
    )*};
}

one_column! {
    f64 => Number, |x| *x;
    u64 => Whole, |x| x.cast_signed();
    u32 => Whole, |x| i64::from(*x);
    bool => Truth, |x| *x;
    &'static str => Text, |text| (*text).to_owned();
    Outcome => Text, |outcome| outcome.name().to_owned();
}

impl<T: Columnar> Columnar for Option<T> {
    fn columns(name: &str, into: &mut Vec<Column>) {
        T::columns(name, into);
    }

    fn cells(this: Option<&Self>, into: &mut Vec<Cell>) {
        T::cells(this.and_then(Option::as_ref), into);
    }
}

/// Columns of a field, whose type its reader says.
pub(crate) fn columns_of<S, T: Columnar>(_: fn(&S) -> &T, name: &str, into: &mut Vec<Column>) {
    T::columns(name, into);
}

/// A struct in columns, a name a field; a `..` before one says that its parts stand beside the others. None can be left out.
macro_rules! columnar {
    ($type:ident { $($field:ident),* $(; .. $flat:ident)? }) => {
        impl Columnar for $type {
            fn columns(name: &str, into: &mut Vec<Column>) {
                $(columns_of(|s: &Self| &s.$field, &below(name, stringify!($field)), into);)*
                $(columns_of(|s: &Self| &s.$flat, name, into);)?
            }

            fn cells(this: Option<&Self>, into: &mut Vec<Cell>) {
                let all = |s: &Self| {
                    let Self { $($field: _,)* $($flat: _)? } = s;
                };
                this.into_iter().for_each(all);
                $(Columnar::cells(this.map(|s| &s.$field), into);)*
                $(Columnar::cells(this.map(|s| &s.$flat), into);)?
            }
        }
    };
}
pub(crate) use columnar;
