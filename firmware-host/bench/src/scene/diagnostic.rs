//! Errors for people: which file, which line, which key, what was expected.

use crate::scene::required_keys::{Missing, missing};
use miette::{Diagnostic, NamedSource, SourceSpan};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Why a scene could not be used.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum SceneError {
    /// The file could not be read.
    #[error("cannot read scene {}: {reason}", path.display())]
    #[diagnostic(help(
        "give the path of a scene file, e.g. firmware-host/scenes/impact_at_40_hz.toml"
    ))]
    Read {
        /// The path given.
        path: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// The file is no text that TOML may be.
    #[error("{}:{line}: is no UTF-8 text", path.display())]
    #[diagnostic(help(
        "save it as UTF-8, which any editor can, without umlauts or signs of another encoding"
    ))]
    Encoding {
        /// The file.
        path: PathBuf,
        /// Line of the first byte that is not, counted from 1.
        line: usize,
    },
    /// Something in the file is wrong.
    #[error("{}:{line}: {message}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Key and what was expected.
        message: String,
        /// The text of the file.
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        /// Where in it.
        #[label("here")]
        span: SourceSpan,
        /// What to do.
        #[help]
        help: Option<String>,
    },
}

impl SceneError {
    /// With doubts about other keys, one of which may be the reason.
    pub(crate) fn beside(mut self, slips: &[String]) -> Self {
        if let (Self::Content { help, .. }, false) = (&mut self, slips.is_empty()) {
            let doubts = format!("or look here first: {}", slips.join("; "));
            *help = Some(match help.take() {
                Some(help) => format!("{help}\n{doubts}"),
                None => doubts,
            });
        }
        self
    }
}

/// A scene file's text, able to point into itself.
#[derive(Debug, Clone)]
pub(crate) struct SceneText {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
}

impl SceneText {
    pub(crate) fn read(path: &Path) -> Result<Self, SceneError> {
        let bytes = std::fs::read(path).map_err(|reason| SceneError::Read {
            path: path.to_owned(),
            reason,
        })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            SceneError::Encoding {
                path: path.to_owned(),
                line: 1 + good.iter().filter(|b| **b == b'\n').count(),
            }
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
        })
    }

    /// An error at a byte range.
    pub(crate) fn error_at(
        &self,
        range: std::ops::Range<usize>,
        message: String,
        help: Option<String>,
    ) -> SceneError {
        let start = range.start.min(self.text.len());
        let end = range.end.clamp(start, self.text.len());
        let line = 1 + self.text.as_bytes()[..start]
            .iter()
            .filter(|b| **b == b'\n')
            .count();
        SceneError::Content {
            path: self.path.clone(),
            line,
            message,
            source_code: Arc::new(NamedSource::new(
                self.path.display().to_string(),
                self.text.clone(),
            )),
            span: (start, end - start).into(),
            help,
        }
    }

    /// An error of the TOML reader: its message in the words of the file, with the key of the line.
    pub(crate) fn error_in_toml(&self, range: std::ops::Range<usize>, message: &str) -> SceneError {
        let mut message = message.to_owned();
        for (code, words) in [
            ("expected f64", "expected a number"),
            ("expected u64", "expected a whole number, 0 or greater"),
            ("expected u32", "expected a whole number, 0 or greater"),
            (
                "invalid type: map, expected a sequence",
                "is one table where there may be several: write its name in double brackets, [[…]]",
            ),
            ("expected a string", "expected a text in quotes"),
            ("expected a sequence", "expected a list in square brackets"),
            ("integer `", "the number `"),
            ("floating point `", "the number `"),
            ("` as i128", "`, which is too far from 0"),
        ] {
            message = message.replace(code, words);
        }
        if let Some(name) = message.strip_prefix("missing field ") {
            // The place is that of the whole table; its first line has nothing to do with it.
            let name = name.trim_matches('`');
            if let Some(Missing { table, help }) =
                missing(name, |table, key| self.first_without(table, key))
            {
                let message = format!("{table}.{name}: is missing");
                let range = self.find(&table).unwrap_or(range);
                return self.error_at(range, message, Some(help));
            }
            let help = match name {
                "title" => "give a name in one line: title = \"…\", above all tables".to_owned(),
                _ => format!("add a table [{name}]"),
            };
            return self.error_at(range, format!("{name} is missing"), Some(help));
        }
        let start = range.start.min(self.text.len());
        let line_start = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line = self.text[line_start..].lines().next().unwrap_or_default();
        let mut help = None;
        if let Some((key, value)) = line.split_once('=') {
            if !message.contains(key.trim()) {
                message = format!("{}: {message}", key.trim());
            }
            help = written_otherwise(value);
            // All lists of numbers are pairs.
            if message.ends_with("a list in square brackets") && key.trim() != "policies" {
                help = Some("give x and y, [x, y]".to_owned());
            }
        }
        let help = guess_from(&message).or(help);
        self.error_at(range, message, help)
    }

    /// An error at a dotted key, or at its longest part that is there, or at the top of the file.
    pub(crate) fn error_at_key(
        &self,
        key: &str,
        message: String,
        help: Option<String>,
    ) -> SceneError {
        self.error_at(
            self.find(key).unwrap_or(0..0),
            format!("{key}: {message}"),
            help,
        )
    }

    /// What such an error would say on its one line.
    pub(crate) fn warning(&self, key: &str, message: String) -> String {
        self.error_at_key(key, message, None).to_string()
    }

    /// The first of these tables that has not this key, as `disturbance[1]`; none where all have it, or there are none.
    pub(crate) fn first_without(&self, table: &str, key: &str) -> Option<String> {
        use toml::de::{DeTable, DeValue};
        let document = DeTable::parse(&self.text).ok()?;
        let mut parts = table.split('.');
        let mut value = document.get_ref().get(parts.next()?)?;
        for part in parts {
            value = value.get_ref().get(part)?;
        }
        let lacks =
            |value: &DeValue<'_>| matches!(value, DeValue::Table(t) if !t.contains_key(key));
        match value.get_ref() {
            DeValue::Array(all) => {
                let index = all.iter().position(|element| lacks(element.get_ref()))?;
                Some(format!("{table}[{index}]"))
            }
            value => lacks(value).then(|| table.to_owned()),
        }
    }

    fn find(&self, key: &str) -> Option<std::ops::Range<usize>> {
        use toml::de::{DeTable, DeValue};
        let document = DeTable::parse(&self.text).ok()?;
        let mut table = document.get_ref();
        let mut span = None;
        for part in key.split('.') {
            // `disturbance[1]` is the second of an array of tables.
            let (name, index) = match part.split_once('[') {
                Some((name, rest)) => (name, rest.trim_end_matches(']').parse::<usize>().ok()),
                None => (part, None),
            };
            let Some(mut value) = table.get(name) else {
                break;
            };
            if let (Some(index), DeValue::Array(array)) = (index, value.get_ref()) {
                match array.get(index) {
                    Some(element) => value = element,
                    None => break,
                }
            }
            span = Some(value.span());
            match value.get_ref() {
                DeValue::Table(inner) => table = inner,
                _ => break,
            }
        }
        span
    }
}

/// How a number is to be written that TOML does not take: with a decimal comma, or with its unit behind it.
fn written_otherwise(value: &str) -> Option<String> {
    let value = value.split('#').next()?.trim();
    let digits = |text: &str| {
        !text.is_empty()
            && text
                .chars()
                .all(|c| c.is_ascii_digit() || "+-.eE_".contains(c))
    };
    if let Some((whole, decimals)) = value.split_once(',') {
        return (digits(whole) && digits(decimals)).then(|| {
            "write decimals with a point, thousands without a mark, and two numbers as [x, y]"
                .to_owned()
        });
    }
    let number = value.trim_end_matches(|c: char| c.is_alphabetic() || "/²³%·° ".contains(c));
    let plain = number.parse::<f64>().is_ok() && number != value;
    plain.then(|| format!("write the number alone: {number}; the key says the unit"))
}

/// What serde says of an unknown name lists the known ones, all in backticks.
fn guess_from(message: &str) -> Option<String> {
    if !message.contains("unknown field") && !message.contains("unknown variant") {
        return None;
    }
    let (_, names) = message.split_once("unknown")?;
    let mut names = names.split('`').skip(1).step_by(2);
    let word = names.next()?;
    guess(word, names)
}

/// The known name that a misspelt one comes close to, as a question.
fn guess<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let limit = word.chars().count().div_ceil(3);
    // A key without its unit is the commonest mistake.
    let distance = |name: &str| match name.strip_prefix(word) {
        Some(unit) if unit.starts_with('_') => 1,
        _ => strsim::damerau_levenshtein(word, name),
    };
    let (distance, name) = (known.into_iter())
        .map(|name| (distance(name), name))
        .min_by_key(|(distance, _)| *distance)?;
    (distance <= limit).then(|| format!("did you mean `{name}`?"))
}

/// Advice with a guess before it, where there is one.
pub(crate) fn with_guess<'a>(
    help: String,
    word: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> String {
    guess(word, known).map_or(help.clone(), |guess| format!("{guess} {help}"))
}

/// A number as people write it: with an exponent where it would be long.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

/// Range checks that point at the key.
pub(crate) struct Checks<'a> {
    pub(crate) text: &'a SceneText,
}

impl Checks<'_> {
    pub(crate) fn refused(&self, key: &str, value: f64, expected: &str) -> SceneError {
        let help = Some(format!("give {expected}"));
        self.text.error_at_key(
            key,
            format!("is {}, expected {expected}", short(value)),
            help,
        )
    }

    pub(crate) fn within(
        &self,
        key: &str,
        value: f64,
        low: f64,
        high: f64,
    ) -> Result<(), SceneError> {
        if value >= low && value <= high {
            Ok(())
        } else {
            let expected = format!("a number from {} to {}", short(low), short(high));
            Err(self.refused(key, value, &expected))
        }
    }

    /// One of two keys that say the same.
    pub(crate) fn either(
        &self,
        (first, a): (&str, Option<f64>),
        (second, b): (&str, Option<f64>),
    ) -> Result<Option<f64>, SceneError> {
        if a.is_some() && b.is_some() {
            let message = format!("given together with {second}, which says the same");
            let help = Some(format!("remove {first} or {second}"));
            return Err(self.text.error_at_key(first, message, help));
        }
        Ok(a.or(b))
    }
}
