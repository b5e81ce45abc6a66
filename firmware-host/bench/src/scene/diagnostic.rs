//! Errors for people: which file, which line, which key, what was expected.

use crate::scene::guess;
use crate::scene::keys::{Key, row, short};
use crate::scene::read::{Refusal, Slip};
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
        /// The system's message.
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
    /// Of which plane is spoken; its own tables come before the scene's.
    pub(crate) plane: Option<usize>,
    /// Whether anybody wants to hear of what is allowed and yet unlikely to be meant.
    pub(crate) warns: bool,
}

impl SceneText {
    /// The same, speaking of a plane.
    pub(crate) fn of_plane(&self, index: usize) -> Self {
        Self {
            plane: Some(index),
            ..self.clone()
        }
    }

    /// Where a key of the plane that is spoken of stands: in its own tables, or in the scene's.
    fn placed(&self, key: &str) -> String {
        let Some(index) = self.plane else {
            return key.to_owned();
        };
        let own = match key {
            "rotor.contact_radius_m" => "contact_radius_m",
            key => key,
        };
        let table = own.split(['.', '[']).next().unwrap_or(own);
        let of_plane = format!("plane[{index}]");
        let all = |key: &str| self.spans(key).count();
        match all(&format!("{of_plane}.{table}")) == 2 {
            true => format!("{of_plane}.{own}"),
            false => key.to_owned(),
        }
    }

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
            plane: None,
            warns: true,
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

    /// An error of the TOML reader: its message with the key of the line.
    pub(crate) fn error_in_toml(&self, range: std::ops::Range<usize>, message: &str) -> SceneError {
        let mut message = match message.ends_with("expected any valid TOML value") {
            true => format!("is too far from 0, expected at most {}", i64::MAX),
            false => message.to_owned(),
        };
        let start = range.start.min(self.text.len());
        let line_start = self.text[..start].rfind('\n').map_or(0, |i| i + 1);
        let line = self.text[line_start..].lines().next().unwrap_or_default();
        let mut help = None;
        if let Some((key, value)) = line.split_once('=') {
            if !message.contains(key.trim()) {
                message = format!("{}: {message}", key.trim());
            }
            help = written_otherwise(value);
        }
        self.error_at(range, message, help)
    }

    /// An error at a dotted key, or at its longest part that is there, or at the top of the file.
    pub(crate) fn error_at_key(
        &self,
        key: &str,
        message: String,
        help: Option<String>,
    ) -> SceneError {
        let key = self.placed(key);
        let range = self.spans(&key).last().unwrap_or(0..0);
        self.error_at(range, format!("{key}: {message}"), help)
    }

    /// What such an error would say on its one line.
    pub(crate) fn warning(&self, key: &str, message: String) -> String {
        self.error_at_key(key, message, None).to_string()
    }

    /// An error of a value that could not be read.
    pub(crate) fn error_of(&self, refusal: Refusal, keys: &'static [Key]) -> SceneError {
        let key = row(keys, &refusal.path);
        let is_value = |key: &&Key| key.below().is_empty();
        let to_give = || key.filter(is_value).map(Key::what_to_give);
        let help = match refusal.slip {
            Slip::Missing => {
                let to_give = key.map_or_else(String::new, Key::what_to_give);
                return self.missing_at(&refusal.path, to_give);
            }
            Slip::Value => to_give(),
            Slip::Key(known) => {
                let name = refusal.path.rsplit('.').next();
                guess::key(name.unwrap_or(&refusal.path), known)
            }
            Slip::Word { found, known } => {
                guess::word(&found, known.iter().copied()).or_else(to_give)
            }
        };
        self.error_at_key(&refusal.path, refusal.message, help)
    }

    /// An error of a key that is not there, at its table.
    pub(crate) fn missing_at(&self, key: &str, help: String) -> SceneError {
        let range = self.spans(key).last().unwrap_or(0..0);
        let is = if key.contains('.') { ": is" } else { " is" };
        self.error_at(range, format!("{key}{is} missing"), Some(help))
    }

    /// Where the parts of a dotted key are, as far as they are there.
    fn spans(&self, key: &str) -> impl Iterator<Item = std::ops::Range<usize>> {
        use toml::de::{DeTable, DeValue};
        let mut spans = Vec::new();
        let document = DeTable::parse(&self.text).ok();
        let mut table = document.as_ref().map(toml::Spanned::get_ref);
        for part in key.split('.') {
            // `disturbance[1]` is the second of an array of tables.
            let (name, index) = match part.split_once('[') {
                Some((name, rest)) => (name, rest.trim_end_matches(']').parse::<usize>().ok()),
                None => (part, None),
            };
            let Some(mut value) = table.and_then(|table| table.get(name)) else {
                break;
            };
            if let (Some(index), DeValue::Array(array)) = (index, value.get_ref()) {
                match array.get(index) {
                    Some(element) => value = element,
                    None => break,
                }
            }
            spans.push(value.span());
            table = match value.get_ref() {
                DeValue::Table(inner) => Some(inner),
                _ => None,
            };
        }
        spans.into_iter()
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

/// A key that may be given, with its value as another key means it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Given {
    pub(crate) key: &'static str,
    pub(crate) value: Option<f64>,
}

impl Given {
    pub(crate) fn new(key: &'static str, value: Option<f64>) -> Self {
        Self { key, value }
    }
}

impl SceneText {
    /// An error of a number that is another one than expected.
    pub(crate) fn refused(&self, key: &str, value: f64, expected: &str) -> SceneError {
        let message = format!("is {}, expected {expected}", short(value));
        self.error_at_key(key, message, Some(format!("give {expected}")))
    }

    /// An error at the first of these keys that is given, none of which may be.
    pub(crate) fn none_given(
        &self,
        keys: &[(&str, bool)],
        message: &str,
        help: &str,
    ) -> Result<(), SceneError> {
        match keys.iter().find(|(_, given)| *given) {
            None => Ok(()),
            Some((key, _)) => {
                Err(self.error_at_key(key, message.to_owned(), Some(help.to_owned())))
            }
        }
    }

    /// One of two keys that say the same.
    pub(crate) fn either(&self, a: Given, b: Given) -> Result<Option<f64>, SceneError> {
        if a.value.is_some() && b.value.is_some() {
            let message = format!("given together with {}, which says the same", b.key);
            let help = format!("remove {} or {}", a.key, b.key);
            return Err(self.error_at_key(a.key, message, Some(help)));
        }
        Ok(a.value.or(b.value))
    }
}
