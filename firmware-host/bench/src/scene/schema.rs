//! The keys of scene files for editors, as a JSON Schema, and for people, as a table in Markdown.

use crate::scene::keys::{Absent, Key, Kind, Range, joined, number, short};
use crate::scene::policy_kind::PolicyKind;
use crate::scene::tables::KEYS;
use serde_json::{Map, Value, json};
use std::fmt::Write;
use supervisor::PARAMETERS;

/// The schema. Draft 4, which is what editors of TOML understand.
pub fn json_schema() -> Value {
    let mut schema = object(KEYS);
    // What each plane may have of its own.
    schema["anyOf"] = json!([{"required": ["contact", "friction"]}, {"required": ["plane"]}]);
    schema["$schema"] = json!("http://json-schema.org/draft-04/schema#");
    schema["title"] = json!("Scene of an AMB rotor on its retainer bearing");
    schema
}

/// A table with these keys and no others.
fn object(keys: &[Key]) -> Value {
    let required = |key: &&Key| matches!(key.absent, Absent::Required(_));
    let names: Vec<&str> = keys.iter().filter(required).map(|key| key.name).collect();
    let properties: Map<String, Value> = (keys.iter())
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
    let mut object = json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    // Draft 4 has no empty list here.
    if !names.is_empty() {
        object["required"] = json!(names);
    }
    object
}

fn property(key: &Key) -> Value {
    let mut number = bounded(&key.range);
    let pair =
        |number: &Value| json!({"type": "array", "items": number, "minItems": 2, "maxItems": 2});
    let mut property = match key.kind {
        Kind::Number => number,
        Kind::Whole => {
            number["type"] = json!("integer");
            number
        }
        Kind::Truth => json!({"type": "boolean"}),
        Kind::Text => json!({"type": "string"}),
        Kind::Word(words) => json!({"enum": words}),
        Kind::Policies => json!({
            "type": "array",
            "items": {"enum": PolicyKind::ALL.map(PolicyKind::name)},
            "minItems": 1,
            "uniqueItems": true,
        }),
        Kind::Pair => pair(&number),
        Kind::PerAxis => json!({"anyOf": [number, pair(&number)]}),
        Kind::Numbers => json!({"type": "array", "items": number}),
        Kind::Table(keys) => object(keys),
        Kind::Tables(keys) => json!({"type": "array", "items": object(keys)}),
        Kind::Parameters => parameters(),
    };
    property["description"] = json!(description(key));
    if let (Absent::Default(value), true) = (key.absent, key.below().is_empty())
        && let Some(Ok(value)) = value().map(serde_json::to_value)
        && value != json!({})
    {
        property["default"] = value;
    }
    property
}

/// A number in a range.
fn bounded(range: &Range) -> Value {
    let mut number = json!({"type": "number"});
    let [low, high] = range.bounds();
    if let Some(low) = low {
        number["minimum"] = json!(low);
    }
    if let Some(high) = high {
        number["maximum"] = json!(high);
    }
    if range.is_open() {
        number["exclusiveMinimum"] = json!(true);
    }
    number
}

fn parameters() -> Value {
    let property = |p: &supervisor::Parameter| {
        let range = bounded(&Range::Within(f64::from(p.low), f64::from(p.high)));
        let mut property = range;
        property["description"] = json!(with_unit(p.text, p.unit));
        (p.name.to_owned(), property)
    };
    let properties: Map<String, Value> = PARAMETERS.iter().map(property).collect();
    json!({"type": "object", "properties": properties, "additionalProperties": false})
}

fn with_unit(text: &str, unit: &str) -> String {
    match unit {
        "" | "1" => text.to_owned(),
        unit => format!("{text} [{unit}]"),
    }
}

/// Help for an editor: what it is, its unit, and what holds without it.
fn description(key: &Key) -> String {
    let mut text = with_unit(&plain(key.help), key.unit);
    if let Absent::Means(absent) = key.absent
        && absent != NO_DEFAULT
    {
        let _ = write!(text, "; without it: {}", plain(absent));
    }
    text
}

/// What [`Absent::Means`] says of a key without which others say the same.
const NO_DEFAULT: &str = "–";

/// Markdown without its links.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut rest = markdown;
    while let Some((before, (link, after))) =
        (rest.split_once('[')).and_then(|(before, rest)| Some((before, rest.split_once("](")?)))
    {
        let (_, after) = after.split_once(')').unwrap_or(("", after));
        text += before;
        text += link;
        rest = after;
    }
    text + rest
}

/// Head of a table in Markdown.
const HEAD: &str = "| Key | Value | Default | Meaning |\n|---|---|---|---|\n";

/// The page about keys, in Markdown: a heading and a table for each table of a scene, with those below it among its rows.
pub fn markdown_table() -> String {
    let is_table = |key: &&Key| {
        matches!(
            key.kind,
            Kind::Table(_) | Kind::Tables(_) | Kind::Parameters
        )
    };
    let mut text = format!("### Above all tables\n\n{HEAD}");
    let mut listed = Vec::new();
    for key in KEYS.iter().filter(|key| !is_table(key)) {
        row(key, key.name, key.help, &mut text);
    }
    for key in KEYS.iter().filter(is_table) {
        let need = match key.absent {
            Absent::Required(_) => "Required".to_owned(),
            Absent::Means(absent) => format!("Optional, else {absent}"),
            Absent::Default(_) => "Optional".to_owned(),
        };
        let heading = heading(key, key.name);
        let _ = write!(text, "\n### `{heading}`\n\n{need}: {}.\n", key.help);
        if !key.below().is_empty() {
            let _ = write!(text, "\n{HEAD}");
            rows_below(key, key.name.to_owned(), &mut listed, &mut text);
        }
    }
    text
}

/// Rows of these keys; `listed` are the tables that have theirs.
fn rows(
    keys: &'static [Key],
    table: &str,
    listed: &mut Vec<(&'static [Key], String)>,
    text: &mut String,
) {
    for key in keys {
        let path = joined(table, key.name);
        let (below, mut help) = (key.below(), key.help.to_owned());
        let as_before = listed
            .iter()
            .find(|(keys, _)| !below.is_empty() && std::ptr::eq(*keys, below));
        if let Some((_, path)) = as_before {
            let _ = write!(help, "; keys as of `[{path}]`");
        }
        row(key, &path, &help, text);
        if as_before.is_none() && !below.is_empty() {
            rows_below(key, path, listed, text);
        }
    }
}

/// Rows of the keys below this one, which have no others yet.
fn rows_below(
    key: &'static Key,
    mut path: String,
    listed: &mut Vec<(&'static [Key], String)>,
    text: &mut String,
) {
    listed.push((key.below(), path.clone()));
    if matches!(key.kind, Kind::Tables(_)) {
        path += "[]";
    }
    rows(key.below(), &path, listed, text);
}

fn row(key: &Key, path: &str, help: &str, text: &mut String) {
    let heading = heading(key, path);
    let (value, default) = (value(key), default(key));
    let _ = writeln!(text, "| `{heading}` | {value} | {default} | {help} |");
}

/// A key as it is written in a scene.
fn heading(key: &Key, path: &str) -> String {
    match key.kind {
        Kind::Table(_) | Kind::Parameters => format!("[{path}]"),
        Kind::Tables(_) => format!("[[{path}]]"),
        _ => path.to_owned(),
    }
}

/// Type or unit, and the range where there is one.
fn value(key: &Key) -> String {
    match range(&key.range) {
        none if none.is_empty() => kind(key),
        range => format!("{}, {range}", kind(key)),
    }
}

fn kind(key: &Key) -> String {
    let unit = key.unit;
    match key.kind {
        Kind::Number => unit.to_owned(),
        Kind::Whole if unit.is_empty() => "integer".to_owned(),
        Kind::Whole => unit.to_owned(),
        Kind::Truth => "true/false".to_owned(),
        Kind::Text => "text".to_owned(),
        Kind::Word(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
            words.join(", ")
        }
        Kind::Policies => "list of names".to_owned(),
        Kind::Pair => format!("[x, y], {unit}"),
        Kind::PerAxis => format!("{unit} or [x, y]"),
        Kind::Numbers => format!("[a, b, …], {unit}"),
        Kind::Table(_) | Kind::Parameters => "table".to_owned(),
        Kind::Tables(_) => "tables".to_owned(),
    }
}

fn default(key: &Key) -> String {
    match key.absent {
        Absent::Required(_) => NO_DEFAULT.to_owned(),
        Absent::Means(text) => text.to_owned(),
        Absent::Default(value) => value().map_or_else(String::new, |value| written(&value)),
    }
}

/// A value as a person writes it.
fn written(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) if text.is_empty() => "empty".to_owned(),
        toml::Value::String(word) => format!("`{word}`"),
        toml::Value::Boolean(truth) => truth.to_string(),
        toml::Value::Array(all) if all.is_empty() => "none".to_owned(),
        toml::Value::Array(all) => {
            let all: Vec<String> = all.iter().map(written).collect();
            format!("[{}]", all.join(", "))
        }
        value => number(value).map_or_else(String::new, short),
    }
}

fn range(range: &Range) -> String {
    match *range {
        Range::Finite => String::new(),
        Range::Positive => "> 0".to_owned(),
        Range::NotNegative => "≥ 0".to_owned(),
        Range::PositiveUpTo(high) => format!("> 0, ≤ {}", short(high)),
        Range::Within(low, high) | Range::Because(low, high, _) => match low == -high {
            true => format!("±{}", short(high)),
            false => format!("{} to {}", short(low), short(high)),
        },
        Range::Elsewhere(text) => text.to_owned(),
    }
}
