//! What is known of a key of scene files: one row a key, from which structs, checks, help, documentation and schema come.

use crate::scene::policy_kind::PolicyKind;
use supervisor::PARAMETERS;
use toml::{Table, Value};

/// A key: the row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// Name, with the unit behind it.
    pub name: &'static str,
    /// How its value is written.
    pub kind: Kind,
    /// Unit; "1" for a plain number.
    pub unit: &'static str,
    /// What holds where it is absent.
    pub absent: Absent,
    /// Which numbers it may be.
    pub range: Range,
    /// What it is, in Markdown.
    pub help: &'static str,
    /// Other words for it, as people try them.
    pub aka: &'static [&'static str],
}

/// How a value is written.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    Number,
    /// A whole number, 0 or greater.
    Whole,
    /// true or false.
    Truth,
    Text,
    /// One of these words.
    Word(&'static [&'static str]),
    /// A list of policies.
    Policies,
    /// [x, y].
    Pair,
    /// One number for both axes, or [x, y].
    PerAxis,
    /// A list of numbers.
    Numbers,
    /// A table with these keys.
    Table(&'static [Key]),
    /// Any number of tables with these keys.
    Tables(&'static [Key]),
    /// Parameters of the supervisor.
    Parameters,
}

/// What holds where a key is absent.
#[derive(Debug, Clone, Copy)]
pub enum Absent {
    /// Its table cannot do without; what to give, where kind and unit do not say it.
    Required(Option<&'static str>),
    /// This value.
    Default(fn() -> Option<Value>),
    /// What these words say.
    Means(&'static str),
}

/// Which numbers a value may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Any finite one.
    Finite,
    /// Above 0.
    Positive,
    /// 0 or above.
    NotNegative,
    /// Above 0 and at most this.
    PositiveUpTo(f64),
    /// From one number to the other.
    Within(f64, f64),
    /// The same, with a reason for those who try another.
    Because(f64, f64, &'static str),
    /// What these words say, which is checked where the value is used.
    Elsewhere(&'static str),
}

impl Range {
    /// Whether a number is in it; NaN is in none.
    pub fn contains(&self, x: f64) -> bool {
        match *self {
            Self::Finite => x.is_finite(),
            Self::Positive => x > 0.0 && x.is_finite(),
            Self::NotNegative => x >= 0.0 && x.is_finite(),
            Self::PositiveUpTo(high) => x > 0.0 && x <= high,
            Self::Within(low, high) | Self::Because(low, high, _) => x >= low && x <= high,
            Self::Elsewhere(_) => true,
        }
    }

    /// Smallest and largest number, where there are such.
    pub fn bounds(&self) -> [Option<f64>; 2] {
        match *self {
            Self::Finite | Self::Elsewhere(_) => [None, None],
            Self::Positive | Self::NotNegative => [Some(0.0), None],
            Self::PositiveUpTo(high) => [Some(0.0), Some(high)],
            Self::Within(low, high) | Self::Because(low, high, _) => [Some(low), Some(high)],
        }
    }

    /// Whether the smallest bound is itself outside.
    pub(crate) fn is_open(&self) -> bool {
        matches!(self, Self::Positive | Self::PositiveUpTo(_))
    }

    /// For an error.
    pub(crate) fn expected(&self) -> String {
        match *self {
            Self::Finite | Self::Elsewhere(_) => "a finite number".to_owned(),
            Self::Positive => "a finite number greater than 0".to_owned(),
            Self::NotNegative => "a finite number, 0 or greater".to_owned(),
            Self::PositiveUpTo(high) => {
                format!("a number greater than 0, at most {}", short(high))
            }
            Self::Within(low, high) => {
                format!("a number from {} to {}", short(low), short(high))
            }
            Self::Because(low, high, reason) => {
                format!("{}: {reason}", Self::Within(low, high).expected())
            }
        }
    }
}

impl Key {
    /// What to give where the key is missing.
    pub(crate) fn what_to_give(&self) -> String {
        if let Absent::Required(Some(text)) = self.absent {
            return text.to_owned();
        }
        let unit = match self.unit {
            "" | "1" => String::new(),
            unit => format!(" in {unit}"),
        };
        match self.kind {
            Kind::Number | Kind::Whole => format!("give a number{unit}"),
            Kind::Pair => format!("give two numbers{unit}, [x, y]"),
            Kind::PerAxis => format!("give a number{unit}, or one for each axis, [x, y]"),
            Kind::Numbers => format!("give a list of numbers{unit}, [a, b, …]"),
            Kind::Word(words) => format!("give one of {}", words.join(", ")),
            Kind::Policies => {
                let names = PolicyKind::ALL.map(PolicyKind::name).join(", ");
                format!("give a list of policies, [\"passive\"]; there are {names}")
            }
            Kind::Truth => "give true or false".to_owned(),
            Kind::Text => "give a text in quotes".to_owned(),
            Kind::Table(_) | Kind::Tables(_) | Kind::Parameters => {
                format!("add a table [{}]", self.name)
            }
        }
    }

    /// Name without the unit: `clearance` of `clearance_m`.
    pub(crate) fn stem(&self) -> &'static str {
        let unit: String = (self.unit.chars())
            .filter_map(|c| match c {
                '(' | ')' => None,
                ' ' | '/' => Some('_'),
                '²' => Some('2'),
                'ⁿ' => Some('n'),
                c => Some(c.to_ascii_lowercase()),
            })
            .collect();
        let unit = if self.unit == "°" { "deg" } else { &unit };
        (self.name.strip_suffix(unit))
            .and_then(|stem| stem.strip_suffix('_'))
            .unwrap_or(self.name)
    }

    /// Keys below this one, of a table or of tables.
    pub fn below(&self) -> &'static [Key] {
        match self.kind {
            Kind::Table(keys) | Kind::Tables(keys) => keys,
            _ => &[],
        }
    }
}

/// A number as people write it: with an exponent where it would be long.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

/// Path of a key in a table of this path.
pub(crate) fn joined(table: &str, name: &str) -> String {
    match table {
        "" => name.to_owned(),
        table => format!("{table}.{name}"),
    }
}

/// The row of the key at a path, as `rotor.mass_kg` or `disturbance[0].force_n[1]`.
pub(crate) fn row(keys: &'static [Key], path: &str) -> Option<&'static Key> {
    let (step, rest) = path.split_once('.').unwrap_or((path, ""));
    let name = step.split('[').next().unwrap_or(step);
    let key = keys.iter().find(|key| key.name == name)?;
    match rest {
        "" => Some(key),
        rest => row(key.below(), rest),
    }
}

/// Every table of a document with its path and the keys that it may have, each before those below it.
pub(crate) fn walk<'v>(
    keys: &'static [Key],
    path: &str,
    table: &'v Table,
) -> Vec<(String, &'static [Key], &'v Table)> {
    let mut all = vec![(path.to_owned(), keys, table)];
    for key in keys {
        let path = joined(path, key.name);
        match (key.kind, table.get(key.name)) {
            (Kind::Table(keys), Some(Value::Table(table))) => {
                all.extend(walk(keys, &path, table));
            }
            (Kind::Tables(keys), Some(Value::Array(array))) => {
                for (i, element) in array.iter().enumerate() {
                    if let Value::Table(table) = element {
                        all.extend(walk(keys, &format!("{path}[{i}]"), table));
                    }
                }
            }
            _ => {}
        }
    }
    all
}

/// The number that a value is.
pub(crate) fn number(value: &Value) -> Option<f64> {
    value
        .as_float()
        .or_else(|| value.as_integer().map(|i| i as f64))
}

/// A parameter of `[supervisor]` by its name.
pub(crate) fn parameter(name: &str) -> Option<usize> {
    PARAMETERS.iter().position(|p| p.name == name)
}

/// Structs from rows. A row is
/// `name: type [what holds where it is absent], unit, range, help, other words …;`
/// and what holds is `required`, `required "what to give"`, `= value`, or, of an `Option`, `or "what that means"`.
macro_rules! key_tables {
    ($($(#[$doc:meta])* $table:ident $([$derived:ident])? {
        $($key:ident: $type:ty [$($absent:tt)*], $unit:literal, $range:expr, $help:literal $(, $aka:literal)*;)*
    })*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone)]
        pub(crate) struct $table {
            $(pub(crate) $key: $type,)*
        }

        impl $table {
            pub(crate) const KEYS: &'static [Key] = &[$(Key {
                name: stringify!($key),
                kind: <$type as KeyType>::KIND,
                unit: $unit,
                absent: absent!(row [$($absent)*] $type),
                range: $range,
                help: $help,
                aka: &[$($aka),*],
            },)*];
        }

        impl KeyType for $table {
            const KIND: Kind = Kind::Table(Self::KEYS);

            fn read(value: &toml::Value) -> Result<Self, Refusal> {
                let table = read::table(value)?;
                Ok(Self {
                    $($key: match read::value(table, stringify!($key))?.or_else(|| absent!(value [$($absent)*])) {
                        Some(value) => value,
                        None => return Err(read::missing(stringify!($key))),
                    },)*
                })
            }

            fn write(&self) -> Option<toml::Value> {
                let values = [$((stringify!($key), self.$key.write()),)*];
                let written = values.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
                Some(toml::Value::Table(written.collect()))
            }
        }

        empty!([$($derived)?] $table { $($key [$($absent)*];)* });
    )*};
}
pub(crate) use key_tables;

/// The table without a key, where it may be so.
macro_rules! empty {
    ([] $table:ident { $($keys:tt)* }) => {};
    ([Default] $table:ident { $($key:ident [$($absent:tt)*];)* }) => {
        impl Default for $table {
            fn default() -> Self {
                Self { $($key: absent!(plain [$($absent)*]),)* }
            }
        }
    };
}
pub(crate) use empty;

/// What holds where a key is absent: for its row, as a value if there is one, and as the value that there is.
macro_rules! absent {
    (row [required] $type:ty) => {
        Absent::Required(None)
    };
    (row [required $text:literal] $type:ty) => {
        Absent::Required(Some($text))
    };
    (row [= $value:expr] $type:ty) => {
        Absent::Default(|| {
            let value: $type = $value;
            KeyType::write(&value)
        })
    };
    (row [or $text:literal] $type:ty) => {
        Absent::Means($text)
    };
    (value [required $($text:literal)?]) => {
        None
    };
    (value [= $value:expr]) => {
        Some($value)
    };
    (value [or $text:literal]) => {
        Some(None)
    };
    (plain [= $value:expr]) => {
        $value
    };
    (plain [or $text:literal]) => {
        None
    };
}
pub(crate) use absent;
