//! Values of scene files from the tree that TOML is read into, and back. What is refused names its place below the table that it
//! is read from.

use crate::scene::keys::{Key, Kind, joined, short};
use toml::{Table, Value};

/// A type that values of keys have.
pub(crate) trait KeyType: Clone {
    /// How it is written.
    const KIND: Kind;

    /// From a value of a file.
    fn read(value: &Value) -> Result<Self, Refusal>;

    /// As a value of a file; `None` where it is absent, or where a file cannot have it.
    fn write(&self) -> Option<Value>;
}

/// Why a value cannot be read.
#[derive(Debug, Clone)]
pub(crate) struct Refusal {
    /// Where it is, below what was read; empty for that itself.
    pub(crate) path: String,
    /// Behind the path.
    pub(crate) message: String,
    /// What may have been meant.
    pub(crate) slip: Slip,
}

/// A slip that a guess can be made of.
#[derive(Debug, Clone)]
pub(crate) enum Slip {
    /// A value that is of another kind.
    Value,
    /// A key that is not there.
    Missing,
    /// A key that these are not.
    Key(&'static [Key]),
    /// A word that these are not.
    Word {
        /// As it is written.
        found: String,
        /// Words that may be written.
        known: &'static [&'static str],
    },
}

impl Refusal {
    fn new(message: impl Into<String>) -> Self {
        Self {
            path: String::new(),
            message: message.into(),
            slip: Slip::Value,
        }
    }

    /// Of another kind of value than this.
    pub(crate) fn expected(value: &Value, expected: &str) -> Self {
        Self::new(format!("is {}, expected {expected}", described(value)))
    }

    /// The same, below a key or a number in brackets.
    fn below(mut self, step: &str) -> Self {
        self.path = match self.path.starts_with('[') {
            true => format!("{step}{}", self.path),
            false if self.path.is_empty() => step.to_owned(),
            false => joined(step, &self.path),
        };
        self
    }
}

/// What a value is, for an error.
fn described(value: &Value) -> String {
    match value {
        Value::String(text) => format!("the text \"{text}\""),
        Value::Integer(i) => format!("the number {i}"),
        Value::Float(x) => format!("the number {}", short(*x)),
        Value::Boolean(truth) => truth.to_string(),
        Value::Datetime(date) => format!("the date {date}"),
        Value::Array(all) => match all.len() {
            1 => "a list of one value".to_owned(),
            n => format!("a list of {n} values"),
        },
        Value::Table(_) => "a table".to_owned(),
    }
}

/// That a table and those below it have no other keys than these.
pub(crate) fn only_known(table: &Table, keys: &'static [Key]) -> Result<(), Refusal> {
    for (name, value) in table {
        let Some(key) = keys.iter().find(|key| key.name == name) else {
            let known: Vec<String> = keys.iter().map(|key| format!("`{}`", key.name)).collect();
            let unknown = format!("unknown key, expected one of {}", known.join(", "));
            return Err(Refusal {
                slip: Slip::Key(keys),
                ..Refusal::new(unknown)
            }
            .below(name));
        };
        let below = |refusal: Refusal| refusal.below(name);
        match (key.kind, value) {
            (Kind::Table(keys), Value::Table(table)) => only_known(table, keys).map_err(below)?,
            (Kind::Tables(keys), Value::Array(all)) => {
                for (i, value) in all.iter().enumerate() {
                    let Value::Table(table) = value else { continue };
                    only_known(table, keys)
                        .map_err(|refusal| refusal.below(&format!("[{i}]")))
                        .map_err(below)?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// The table that a value is.
pub(crate) fn table(value: &Value) -> Result<&Table, Refusal> {
    (value.as_table()).ok_or_else(|| Refusal::expected(value, "a table with keys"))
}

/// The tables of a file, once all names are known.
pub(crate) fn file<T: KeyType>(values: Table, keys: &'static [Key]) -> Result<T, Refusal> {
    only_known(&values, keys)?;
    T::read(&Value::Table(values))
}

/// The value of a key, `None` where it is absent.
pub(crate) fn value<T: KeyType>(table: &Table, key: &str) -> Result<Option<T>, Refusal> {
    let read = table.get(key).map(T::read).transpose();
    read.map_err(|refusal| refusal.below(key))
}

/// That a key is not there, which its table cannot do without.
pub(crate) fn missing(key: &str) -> Refusal {
    Refusal {
        slip: Slip::Missing,
        ..Refusal::new("is missing")
    }
    .below(key)
}

/// The number of a word among these.
pub(crate) fn word(value: &Value, words: &'static [&'static str]) -> Result<usize, Refusal> {
    let expected = || {
        let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        format!("one of {}", quoted.join(", "))
    };
    let Value::String(text) = value else {
        return Err(Refusal::expected(value, &expected()));
    };
    let found = words.iter().position(|word| word == text);
    found.ok_or_else(|| Refusal {
        slip: Slip::Word {
            found: text.clone(),
            known: words,
        },
        ..Refusal::new(format!("is \"{text}\", expected {}", expected()))
    })
}

fn list(value: &Value) -> Result<&[Value], Refusal> {
    match value {
        Value::Array(all) => Ok(all),
        _ => Err(Refusal::expected(value, "a list in square brackets")),
    }
}

/// Every value of a list.
pub(crate) fn each<T: KeyType>(value: &Value) -> Result<Vec<T>, Refusal> {
    let one = |(i, value)| T::read(value).map_err(|of: Refusal| of.below(&format!("[{i}]")));
    list(value)?.iter().enumerate().map(one).collect()
}

impl KeyType for f64 {
    const KIND: Kind = Kind::Number;

    fn read(value: &Value) -> Result<Self, Refusal> {
        match value {
            Value::Float(x) => Ok(*x),
            Value::Integer(i) => Ok(*i as Self),
            _ => Err(Refusal::expected(value, "a number")),
        }
    }

    fn write(&self) -> Option<Value> {
        Some(Value::Float(*self))
    }
}

macro_rules! whole_numbers {
    ($($type:ty)*) => {$(
        impl KeyType for $type {
            const KIND: Kind = Kind::Whole;

            fn read(value: &Value) -> Result<Self, Refusal> {
                let whole = value.as_integer().and_then(|i| Self::try_from(i).ok());
                let expected = "a whole number, 0 or greater";
                whole.ok_or_else(|| Refusal::expected(value, expected))
            }

            fn write(&self) -> Option<Value> {
                i64::try_from(*self).ok().map(Value::Integer)
            }
        }
    )*};
}
whole_numbers!(u32 u64);

impl KeyType for bool {
    const KIND: Kind = Kind::Truth;

    fn read(value: &Value) -> Result<Self, Refusal> {
        (value.as_bool()).ok_or_else(|| Refusal::expected(value, "true or false"))
    }

    fn write(&self) -> Option<Value> {
        Some(Value::Boolean(*self))
    }
}

impl KeyType for String {
    const KIND: Kind = Kind::Text;

    fn read(value: &Value) -> Result<Self, Refusal> {
        let text = value.as_str().map(str::to_owned);
        text.ok_or_else(|| Refusal::expected(value, "a text in quotes"))
    }

    fn write(&self) -> Option<Value> {
        Some(Value::String(self.clone()))
    }
}

impl KeyType for Table {
    const KIND: Kind = Kind::Parameters;

    fn read(value: &Value) -> Result<Self, Refusal> {
        table(value).cloned()
    }

    fn write(&self) -> Option<Value> {
        Some(Value::Table(self.clone()))
    }
}

impl<T: KeyType> KeyType for Option<T> {
    const KIND: Kind = T::KIND;

    fn read(value: &Value) -> Result<Self, Refusal> {
        T::read(value).map(Some)
    }

    fn write(&self) -> Option<Value> {
        self.as_ref().and_then(T::write)
    }
}

impl<T: KeyType> KeyType for Vec<T> {
    const KIND: Kind = match T::KIND {
        Kind::Table(keys) => Kind::Tables(keys),
        kind => kind,
    };

    fn read(value: &Value) -> Result<Self, Refusal> {
        match (T::KIND, value) {
            (Kind::Table(_), Value::Table(_)) => Err(Refusal::new(
                "is one table where there may be several: write its name in double brackets, [[…]]",
            )),
            _ => each(value),
        }
    }

    fn write(&self) -> Option<Value> {
        let all: Option<Vec<Value>> = self.iter().map(T::write).collect();
        all.map(Value::Array)
    }
}
