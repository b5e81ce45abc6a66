//! What a key varies over.

use crate::run::columns::{Cell, Kind};
use crate::scene::keys::{number, short};
use crate::scene::values::Pair;
use crate::sweep::tables::{AnyValues, NormalTable, SpacedTable, VaryTable};
use statrs::distribution::{ContinuousCDF as _, Normal};
use toml::Value;

/// Most values of a list.
const MOST_LEVELS: u32 = 100_000;

/// What a key varies over.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// These, each as likely.
    Listed(Vec<Value>),
    /// Every number between two as likely.
    Uniform {
        /// The least.
        low: f64,
        /// The largest.
        high: f64,
    },
    /// Every ratio as likely.
    LogUniform {
        /// The least, above 0.
        low: f64,
        /// The largest.
        high: f64,
    },
    /// Normal between limits, which it is cut off at: beyond them there is nothing, and at them no heap.
    Normal {
        /// Of the distribution without limits.
        mean: f64,
        /// Of the distribution without limits.
        standard_deviation: f64,
        /// The least.
        low: f64,
        /// The largest.
        high: f64,
    },
}

/// A key of scenes that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Its path, as [`Spec::set`](crate::scene::spec::Spec::set) has it.
    pub key: String,
    /// What it varies over.
    pub values: Values,
    /// The key of the sweep file that sets it.
    pub(crate) written_at: String,
}

/// What is wrong with a table, at which of its keys, and what to do; no key: the table itself.
pub(crate) type Wrong = (Option<&'static str>, String, String);

/// What a table may have beside `key`.
const KINDS: &str = "values, linspace, logspace, uniform, log_uniform or normal";

impl VaryTable {
    /// What it says, checked, with the key that says it.
    pub(crate) fn checked(&self) -> Result<(Values, &'static str), Wrong> {
        let given = [
            ("values", self.values.is_some()),
            ("linspace", self.linspace.is_some()),
            ("logspace", self.logspace.is_some()),
            ("uniform", self.uniform.is_some()),
            ("log_uniform", self.log_uniform.is_some()),
            ("normal", self.normal.is_some()),
        ];
        let mut given = given
            .iter()
            .filter(|(_, given)| *given)
            .map(|(name, _)| *name);
        let Some(name) = given.next() else {
            let message = "says not what it varies over".to_owned();
            return Err((None, message, format!("give {KINDS}")));
        };
        if let Some(other) = given.next() {
            let message = format!("is given together with {name}");
            return Err((Some(other), message, format!("give one of {KINDS}")));
        }
        let wrong = |message: &str, help: &str| (Some(name), message.to_owned(), help.to_owned());
        let values = if let Some(AnyValues(values)) = &self.values {
            if values.is_empty() {
                return Err(wrong("is empty", "give at least one value, [1.0, 2.0]"));
            }
            Values::Listed(values.clone())
        } else if let Some(spaced) = self.linspace.as_ref().or(self.logspace.as_ref()) {
            let logarithmic = self.logspace.is_some();
            let SpacedTable { from, to, count } = *spaced;
            if !(2..=MOST_LEVELS).contains(&count) || !from.is_finite() || !to.is_finite() {
                let message = format!("is from {} to {} in {count}", short(from), short(to));
                let help = format!("give two finite numbers, and a count from 2 to {MOST_LEVELS}");
                return Err(wrong(&message, &help));
            }
            if logarithmic && (from <= 0.0 || to <= 0.0) {
                return Err(wrong(
                    "begins or ends at 0 or below",
                    "give two positive numbers, or linspace",
                ));
            }
            Values::Listed(spaced.levels(logarithmic))
        } else if let Some(Pair([low, high])) = self.uniform {
            check_limits(low, high).map_err(|message| wrong(&message, "give [low, high]"))?;
            Values::Uniform { low, high }
        } else if let Some(Pair([low, high])) = self.log_uniform {
            check_limits(low, high).map_err(|message| wrong(&message, "give [low, high]"))?;
            if low <= 0.0 {
                return Err(wrong(
                    "begins at 0 or below",
                    "give two positive numbers, or uniform",
                ));
            }
            Values::LogUniform { low, high }
        } else if let Some(of) = &self.normal {
            check_limits(of.low, of.high)
                .map_err(|message| wrong(&message, "give low and high, low the less"))?;
            let Some([below, above]) = of.shares() else {
                let message = "is no distribution";
                return Err(wrong(
                    message,
                    "give a finite mean and a standard_deviation above 0",
                ));
            };
            if above - below < 1e-9 {
                return Err(wrong(
                    "has next to nothing between its limits",
                    "move low, high or mean",
                ));
            }
            let NormalTable {
                mean,
                standard_deviation,
                low,
                high,
            } = *of;
            Values::Normal {
                mean,
                standard_deviation,
                low,
                high,
            }
        } else {
            return Err((
                None,
                "says not what it varies over".to_owned(),
                format!("give {KINDS}"),
            ));
        };
        Ok((values, name))
    }
}

fn check_limits(low: f64, high: f64) -> Result<(), String> {
    match low < high && low.is_finite() && high.is_finite() {
        true => Ok(()),
        false => Err(format!(
            "is from {} to {}, expected two finite numbers, the lower first",
            short(low),
            short(high)
        )),
    }
}

impl SpacedTable {
    fn levels(&self, logarithmic: bool) -> Vec<Value> {
        let last = self.count - 1;
        let level = |i: u32| {
            let share = f64::from(i) / f64::from(last);
            // The ends as they are written.
            match i {
                0 => self.from,
                i if i == last => self.to,
                _ if logarithmic => self.from * (self.to / self.from).powf(share),
                _ => self.from + (self.to - self.from) * share,
            }
        };
        (0..self.count).map(|i| Value::Float(level(i))).collect()
    }
}

impl NormalTable {
    /// Shares of the distribution below its limits.
    fn shares(&self) -> Option<[f64; 2]> {
        let normal = Normal::new(self.mean, self.standard_deviation).ok()?;
        Some([normal.cdf(self.low), normal.cdf(self.high)])
    }
}

impl Values {
    /// How many there are, of a list.
    pub fn levels(&self) -> Option<u64> {
        match self {
            Self::Listed(values) => Some(values.len() as u64),
            _ => None,
        }
    }

    /// The value that a share of the distribution lies below.
    pub fn at(&self, share: f64) -> Value {
        Value::Float(match *self {
            Self::Listed(ref values) => {
                let level = (share * values.len() as f64) as usize;
                let nearest = values.get(level).or(values.last());
                return nearest.cloned().unwrap_or(Value::Boolean(false));
            }
            Self::Uniform { low, high } => (low + (high - low) * share).min(high),
            Self::LogUniform { low, high } => (low * (high / low).powf(share)).max(low).min(high),
            Self::Normal {
                mean,
                standard_deviation,
                low,
                high,
            } => {
                let of = NormalTable {
                    mean,
                    standard_deviation,
                    low,
                    high,
                };
                let between = |[below, above]: [f64; 2]| below + (above - below) * share;
                let normal = Normal::new(mean, standard_deviation).ok();
                let value = normal
                    .zip(of.shares())
                    .map(|(normal, shares)| normal.inverse_cdf(between(shares)));
                value.unwrap_or(mean).max(low).min(high)
            }
        })
    }

    /// The values of a list as its cells have them, for a list that is not of numbers.
    pub(crate) fn words(&self) -> Vec<String> {
        match self {
            Self::Listed(values) if self.kind() == Kind::Text => (values.iter())
                .map(|value| match self.cell(value) {
                    Cell::Text(text) => text.unwrap_or_default(),
                    _ => String::new(),
                })
                .collect(),
            _ => Vec::new(),
        }
    }

    /// What a column of its values holds.
    pub fn kind(&self) -> Kind {
        let all = |is: fn(&Value) -> bool| match self {
            Self::Listed(values) => values.iter().all(is),
            _ => false,
        };
        if all(Value::is_bool) {
            Kind::Truth
        } else if !matches!(self, Self::Listed(_)) || all(|value| number(value).is_some()) {
            Kind::Number
        } else {
            Kind::Text
        }
    }

    /// A value in such a column; what is no text, in one of texts, as TOML has it.
    pub fn cell(&self, value: &Value) -> Cell {
        match self.kind() {
            Kind::Truth => Cell::Truth(value.as_bool()),
            Kind::Number | Kind::Whole => Cell::Number(number(value)),
            Kind::Text => Cell::Text(Some(match value {
                Value::String(text) => text.clone(),
                other => in_toml(other),
            })),
        }
    }
}

/// A value as one writes it in a file.
fn in_toml(value: &Value) -> String {
    match value {
        Value::Array(all) => format!(
            "[{}]",
            all.iter().map(in_toml).collect::<Vec<_>>().join(", ")
        ),
        Value::String(text) => format!("{text:?}"),
        Value::Integer(x) => x.to_string(),
        Value::Float(x) => format!("{x:?}"),
        Value::Boolean(x) => x.to_string(),
        Value::Datetime(x) => x.to_string(),
        Value::Table(table) => {
            let pairs = table
                .iter()
                .map(|(key, value)| format!("{key} = {}", in_toml(value)));
            format!("{{ {} }}", pairs.collect::<Vec<_>>().join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::read::KeyType as _;

    fn read(text: &str) -> Result<(Values, &'static str), Wrong> {
        let table = toml::from_str(&format!("key = \"a\"\n{text}")).unwrap();
        VaryTable::read(&Value::Table(table)).unwrap().checked()
    }

    fn numbers(values: &Values, shares: &[f64]) -> Vec<f64> {
        (shares.iter())
            .map(|share| values.at(*share).as_float().unwrap())
            .collect()
    }

    #[test]
    fn distributions_have_their_quantiles() {
        let of = |text| read(text).unwrap().0;
        assert_eq!(numbers(&of("uniform = [2, 4]"), &[0.25, 0.5]), [2.5, 3.0]);
        let decades = numbers(&of("log_uniform = [0.01, 1.0]"), &[0.25, 0.5]);
        assert!((decades[0] - 0.0316227766).abs() < 1e-9 && (decades[1] - 0.1).abs() < 1e-12);
        let wide =
            of("normal = { mean = 1.0, standard_deviation = 2.0, low = -100.0, high = 100.0 }");
        // Quantiles of the normal distribution, from tables.
        let [at, median, high] =
            [0.025, 0.5, 0.8413447].map(|share| wide.at(share).as_float().unwrap());
        assert!((at - (1.0 - 2.0 * 1.959964)).abs() < 1e-4, "{at}");
        assert!(
            (median - 1.0).abs() < 1e-9 && (high - 3.0).abs() < 1e-5,
            "{median}, {high}"
        );
        // Half of a normal distribution: its median is the whole's upper quartile.
        let half = of("normal = { mean = 0.0, standard_deviation = 1.0, low = 0.0, high = 50.0 }");
        assert!((numbers(&half, &[0.5])[0] - 0.6744898).abs() < 1e-6);
        assert!(
            numbers(&half, &[1e-9, 1.0 - 1e-9])
                .iter()
                .all(|x| (0.0..=50.0).contains(x))
        );
    }

    #[test]
    fn lists_are_evenly_spaced_and_end_where_they_say() {
        let lin = read("linspace = { from = 0.1, to = 0.7, count = 4 }")
            .unwrap()
            .0;
        let all = numbers(&lin, &[0.1, 0.3, 0.6, 0.9]);
        let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(&all, &[0.1, 0.3, 0.5, 0.7]) && all[3] == 0.7);
        let log = read("logspace = { from = 1.0, to = 100.0, count = 3 }")
            .unwrap()
            .0;
        assert!(close(&numbers(&log, &[0.1, 0.5, 0.9]), &[1.0, 10.0, 100.0]));
        let words = read("values = [\"nan\", [1, 2.0]]").unwrap().0;
        assert_eq!(words.kind(), Kind::Text);
        assert_eq!(
            words.cell(&words.at(0.9)),
            Cell::Text(Some("[1, 2.0]".to_owned()))
        );
    }

    #[test]
    fn what_is_no_distribution_is_refused_at_its_key() {
        for (text, at) in [
            ("", None),
            ("uniform = [1, 1]", Some("uniform")),
            ("log_uniform = [0, 1]", Some("log_uniform")),
            ("values = []", Some("values")),
            ("values = [1]\nuniform = [1, 2]", Some("uniform")),
            (
                "linspace = { from = 0, to = 1, count = 1 }",
                Some("linspace"),
            ),
            (
                "logspace = { from = -1, to = 1, count = 3 }",
                Some("logspace"),
            ),
            (
                "normal = { mean = 0, standard_deviation = 0, low = 0, high = 1 }",
                Some("normal"),
            ),
            (
                "normal = { mean = 0, standard_deviation = 1, low = 50, high = 60 }",
                Some("normal"),
            ),
        ] {
            assert_eq!(read(text).unwrap_err().0, at, "{text}");
        }
    }
}
