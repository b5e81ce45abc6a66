//! Runs of a sweep as scene files of their own.

use crate::sweep::error::SweepError;
use crate::sweep::plan::Plan;
use crate::sweep::store::Store;
use crate::sweep::summary::Summary;
use std::path::Path;
use toml::Value;
use toml_edit::{DocumentMut, Item, Table};

/// Writes the worst runs as scene files, and takes those of before away.
///
/// # Errors
/// [`SweepError`] where they cannot be written.
pub fn keep(plan: &Plan, store: &Store, summary: &Summary) -> Result<(), SweepError> {
    for worst in &summary.worst {
        let text = scene_of(plan, worst.run)?;
        store.write(&worst.file, text.as_bytes())?;
    }
    let is_now = |name: &str| summary.worst.iter().any(|worst| worst.file == name);
    store.remove(|name| name.starts_with("worst_") && name.ends_with(".toml") && !is_now(name))
}

/// The scene file of the sweep with what a run draws in the place of what it says, comments and order as they are.
///
/// # Errors
/// [`SweepError`] where the scene cannot be read any more.
pub(crate) fn scene_of(plan: &Plan, run: u64) -> Result<String, SweepError> {
    let path = &plan.file.scene;
    let refused = |reason: String| SweepError::Read {
        what: "scene",
        path: path.clone(),
        reason,
        help: "put it back as it was",
    };
    let text = std::fs::read_to_string(path).map_err(|error| refused(error.to_string()))?;
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error: toml_edit::TomlError| refused(error.to_string()))?;
    let point = plan.point(run);
    let policies = plan
        .policies()
        .iter()
        .map(|kind| Value::String(kind.name().to_owned()));
    let keys = plan
        .file
        .variations
        .iter()
        .map(|variation| variation.key.as_str());
    let mut set: Vec<(&str, Value)> = vec![
        ("run.policies", Value::Array(policies.collect())),
        ("run.seed", Value::Integer(point.seed)),
    ];
    set.extend(keys.clone().zip(point.values.iter().cloned()));
    for (key, value) in set {
        // The plan has set the same in the same file.
        place(&mut document, key, edited(&value));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    absolute_files(document.as_table_mut(), folder);
    let settings: Vec<String> = keys.map(str::to_owned).collect();
    let name = plan.file.text.path.file_name().unwrap_or_default();
    Ok(format!(
        "# Run {run} of {}, which sets run.seed, run.policies{}{}.\n{document}",
        name.to_string_lossy(),
        if settings.is_empty() { "" } else { ", " },
        settings.join(", "),
    ))
}

/// Puts a value at a path, making tables where there are none.
fn place(document: &mut DocumentMut, path: &str, value: toml_edit::Value) {
    let steps: Vec<&str> = (path.split(['.', '[']))
        .map(|step| step.trim_end_matches(']'))
        .collect();
    let mut item: &mut Item = document.as_item_mut();
    for step in steps {
        let next = match step.parse::<usize>() {
            Ok(index) => item.get_mut(index),
            Err(_) => match item.as_table_like_mut() {
                Some(table) => {
                    let made = || Item::Table(Table::new());
                    // A new table within an inline one is inline.
                    Some(table.entry(step).or_insert_with(made))
                }
                None => None,
            },
        };
        match next {
            Some(next) => item = next,
            None => return,
        }
    }
    let mut value = value;
    // The comment behind it stays.
    if let Some(old) = item.as_value() {
        *value.decor_mut() = old.decor().clone();
    }
    *item = Item::Value(value);
}

fn edited(value: &Value) -> toml_edit::Value {
    match value {
        Value::String(text) => text.as_str().into(),
        Value::Integer(x) => (*x).into(),
        Value::Float(x) => (*x).into(),
        Value::Boolean(x) => (*x).into(),
        Value::Datetime(x) => (*x).into(),
        Value::Array(all) => toml_edit::Value::Array(all.iter().map(edited).collect()),
        Value::Table(table) => toml_edit::Value::InlineTable(
            (table.iter())
                .map(|(key, value)| (key.as_str(), edited(value)))
                .collect(),
        ),
    }
}

/// Paths of files count from the scene's folder: elsewhere only whole ones name the same.
fn absolute_files(table: &mut dyn toml_edit::TableLike, folder: &Path) {
    for (key, item) in table.iter_mut() {
        let is_file = crate::scene::spec::names_a_file(key.get());
        if let (true, Some(named)) = (is_file, item.as_str()) {
            let path =
                std::path::absolute(folder.join(named)).unwrap_or_else(|_| folder.join(named));
            *item = toml_edit::value(path.to_string_lossy().into_owned());
        } else if let Some(below) = item.as_table_like_mut() {
            absolute_files(below, folder);
        } else if let Some(all) = item.as_array_of_tables_mut() {
            all.iter_mut()
                .for_each(|below| absolute_files(below, folder));
        }
    }
}
