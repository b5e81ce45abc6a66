//! What the user wrote: a scene file's keys and values, which may be read and edited by their paths.

use crate::device::external::Caller;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::guess;
use crate::scene::keys::{Key, Kind, joined, number, parameter, walk};
use crate::scene::read::{self, KeyType as _};
use crate::scene::tables::{KEYS, SceneTables};
use std::path::Path;
use toml::{Table, Value};

/// A scene file as written, every key known and of its type. Whether the values make a scene
/// [`resolve`](Self::resolve) says.
#[derive(Debug, Clone)]
pub struct Spec {
    pub(crate) text: SceneText,
    /// The same twice: by path, with defaults …
    values: Table,
    /// … and by type.
    pub(crate) tables: SceneTables,
    /// Who levitates in the place of the program that `[controller]` names.
    pub(crate) caller: Option<Caller>,
}

/// A key with a value, as `supervisor.hold_share=0.5`: what is to be put in the place of a file's.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The path of the key, as [`Spec::set`] has it.
    pub path: String,
    pub value: Value,
    text: String,
}

/// A number of a scene.
#[derive(Debug, Clone)]
pub struct NumberAt {
    /// Its path, as [`Spec::set`] has it.
    pub path: String,
    pub key: &'static Key,
    /// The number, whole or not.
    pub value: Value,
}

/// Text that is no key with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("expected KEY=VALUE, with a key and a value of scene files, as supervisor.hold_share=0.5")]
pub struct NoSetting;

impl std::str::FromStr for Setting {
    type Err = NoSetting;

    fn from_str(text: &str) -> Result<Self, NoSetting> {
        let (path, value) = text.split_once('=').ok_or(NoSetting)?;
        let table: Table = toml::from_str(&format!("value = {value}")).map_err(|_| NoSetting)?;
        let value = table.get("value").cloned().ok_or(NoSetting)?;
        let (path, text) = (path.trim().to_owned(), text.to_owned());
        Ok(Self { path, value, text })
    }
}

impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl Spec {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::new(SceneText::read(path)?)
    }

    /// From the text of a file; errors name it `name`.
    ///
    /// # Errors
    /// [`SceneError`] with line and key.
    pub fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        Self::new(SceneText {
            path: name.into(),
            text: text.to_owned(),
            plane: None,
            warns: true,
        })
    }

    /// The same for scenes without warnings, which cost as much as the rest.
    #[must_use]
    pub fn without_warnings(mut self) -> Self {
        self.text.warns = false;
        self
    }

    fn new(text: SceneText) -> Result<Self, SceneError> {
        let values: Table = toml::from_str(&text.text)
            .map_err(|error| text.error_in_toml(error.span().unwrap_or(0..0), error.message()))?;
        if values.contains_key("vary") && values.contains_key("scene") {
            let message = "is of a sweep, and this is to be a scene".to_owned();
            let help = "run a sweep with `firmware-host sweep`".to_owned();
            return Err(text.error_at_key("vary", message, Some(help)));
        }
        let tables: SceneTables =
            read::file(values, KEYS).map_err(|refusal| text.error_of(refusal, KEYS))?;
        Ok(Self {
            values: values_of(&tables),
            text,
            tables,
            caller: None,
        })
    }

    /// The value at a path, as `rotor.mass_kg`, `disturbance[0].force_n` or `start.velocity_m_s[0]`, or its default;
    /// `None` where there is neither.
    ///
    /// # Errors
    /// [`SceneError`] for a path that no scene has.
    pub fn get(&self, path: &str) -> Result<Option<&Value>, SceneError> {
        self.kind(path)?;
        let mut steps = steps(path);
        let first = steps.next().and_then(|step| self.values.get(step));
        Ok(first.and_then(|value| steps.try_fold(value, below)))
    }

    /// Puts a value at a path, in the place of one or where there was none. A whole number may be given as a float.
    ///
    /// # Errors
    /// [`SceneError`] for a path that no scene has, a value of another type, or a table that lacks other keys.
    pub fn set(&mut self, path: &str, value: impl Into<Value>) -> Result<(), SceneError> {
        self.set_all(&[(path, value.into())])
    }

    /// Puts several values at their paths, in this order, and all or none.
    ///
    /// # Errors
    /// As [`Self::set`], for the first that is refused by itself, or else for the last.
    pub fn set_all(&mut self, all: &[(&str, Value)]) -> Result<(), SceneError> {
        let mut values = self.values.clone();
        for (path, value) in all {
            let value = match (self.kind(path)?, value) {
                (Some(Kind::Whole), Value::Float(x))
                    if x.fract() == 0.0 && x.abs() < 2f64.powi(53) =>
                {
                    Value::Integer(*x as i64)
                }
                (_, value) => value.clone(),
            };
            match place(&mut values, path) {
                Some(place) => *place = value,
                None => {
                    let message = "there is none of this number".to_owned();
                    let help = "add it to the file first".to_owned();
                    return Err(self.text.error_at_key(path, message, Some(help)));
                }
            }
        }
        let tables: SceneTables =
            read::file(values, KEYS).map_err(|refusal| self.text.error_of(refusal, KEYS))?;
        self.set_tables(tables);
        Ok(())
    }

    /// Other tables in the place of all.
    pub(crate) fn set_tables(&mut self, tables: SceneTables) {
        // With the defaults of what is new.
        self.values = values_of(&tables);
        self.tables = tables;
    }

    /// Files that the scene names, each as it is written at a key that ends with `file`: relative to the scene's folder.
    pub fn files(&self) -> Vec<&str> {
        let of_table = |(_, keys, table): (String, &[Key], _)| {
            let table: &Table = table;
            let named = keys.iter().filter(|key| names_a_file(key.name));
            named
                .filter_map(|key| table.get(key.name)?.as_str())
                .collect::<Vec<_>>()
        };
        let tables = walk(KEYS, "", &self.values).into_iter();
        tables.flat_map(of_table).collect()
    }

    /// Numbers that the scene has, written or by default, in the order of the tables; of what is written as [x, y] each one.
    /// Lists of numbers are left out, and parameters of the supervisor.
    pub fn numbers(&self) -> Vec<NumberAt> {
        let mut all = Vec::new();
        for (path, keys, table) in walk(KEYS, "", &self.values) {
            for key in keys {
                let Some(value) = table.get(key.name) else {
                    continue;
                };
                let path = joined(&path, key.name);
                let values = match (key.kind, value) {
                    (Kind::Pair | Kind::PerAxis, Value::Array(both)) => {
                        let at = |i| format!("{path}[{i}]");
                        both.iter().enumerate().map(|(i, x)| (at(i), x)).collect()
                    }
                    (Kind::Number | Kind::Whole | Kind::PerAxis, value) => vec![(path, value)],
                    _ => Vec::new(),
                };
                let of_key = |(path, value): (String, &Value)| {
                    let value = number(value).map(|_| value.clone())?;
                    Some(NumberAt { path, key, value })
                };
                all.extend(values.into_iter().filter_map(of_key));
            }
        }
        all
    }

    /// How the value at a path is written; `None` for a part of one.
    fn kind(&self, path: &str) -> Result<Option<Kind>, SceneError> {
        let (mut keys, mut kind, mut table) = (KEYS, None, String::new());
        for step in steps(path) {
            if step.parse::<usize>().is_ok() {
                kind = None;
                table = format!("{table}[{step}]");
                continue;
            }
            let key: Option<&Key> = keys.iter().find(|key| key.name == step);
            kind = match (key, kind) {
                (Some(key), _) => Some(key.kind),
                (None, Some(Kind::Parameters)) if parameter(step).is_some() => Some(Kind::Number),
                (None, _) => {
                    let path = joined(&table, step);
                    let message = "is no key of scenes".to_owned();
                    return Err((self.text).error_at_key(&path, message, guess::key(step, keys)));
                }
            };
            keys = key.map_or(&[], Key::below);
            table = joined(&table, step);
        }
        Ok(kind)
    }

    /// Whether every number is in the range of its key.
    pub(crate) fn check_ranges(&self) -> Result<(), SceneError> {
        for (path, keys, table) in walk(KEYS, "", &self.values) {
            for key in keys {
                let Some(value) = table.get(key.name) else {
                    continue;
                };
                let both = value.as_array().map_or(std::slice::from_ref(value), |v| v);
                let refused = |x: &f64| !key.range.contains(*x);
                if let Some(x) = both.iter().filter_map(number).find(refused) {
                    let path = joined(&path, key.name);
                    return Err(self.text.refused(&path, x, &key.range.expected()));
                }
            }
        }
        Ok(())
    }
}

/// Whether the text at a path is that of a file.
pub fn names_a_file(path: &str) -> bool {
    let key = path.rsplit('.').next().unwrap_or(path);
    key.ends_with("file") || ["python", "library"].contains(&key)
}

/// The values with all defaults.
fn values_of(tables: &SceneTables) -> Table {
    match tables.write() {
        Some(Value::Table(values)) => values,
        _ => Table::new(),
    }
}

/// Names and numbers of a path: `change[1].at_s` is `change`, `1`, `at_s`.
fn steps(path: &str) -> impl Iterator<Item = &str> {
    path.split(['.', '['])
        .map(|step| step.trim_end_matches(']'))
}

fn below<'v>(value: &'v Value, step: &str) -> Option<&'v Value> {
    match step.parse::<usize>() {
        Ok(index) => value.get(index),
        Err(_) => value.get(step),
    }
}

/// Where the value of a path is, or is to be; `None` where that is in an array that is too short.
fn place<'v>(values: &'v mut Table, path: &str) -> Option<&'v mut Value> {
    let mut steps = steps(path);
    let empty = || Value::Table(Table::new());
    let mut place = values.entry(steps.next()?).or_insert_with(empty);
    for step in steps {
        place = match (place, step.parse::<usize>()) {
            (Value::Array(array), Ok(index)) => array.get_mut(index)?,
            (Value::Table(table), Err(_)) => table.entry(step).or_insert_with(empty),
            _ => return None,
        };
    }
    Some(place)
}
