//! Files of the project that say what the table of parameters says: `parameters` names those that say something else, and
//! `parameters --write` writes them.

use crate::root;
use firmware_bench::scene::Scene;
use firmware_bench::scene::schema::json_schema;
use std::error::Error;
use std::path::PathBuf;
use supervisor::{Archive, ArchivePlace, DefaultRule, Group, PARAMETERS, Parameter};

/// The C header.
pub const HEADER: &str = "supervisor/capi/include/amb_supervisor.h";
/// The page with the tables of parameters.
pub const TABLES: &str = "docs/src/supervisor/parameters.md";
/// The page that says how large a record is, which has the parameters in it.
pub const RECORDS: &str = "docs/src/supervisor/records.md";
/// The JSON Schema of scenes.
pub const SCHEMA: &str = "firmware-host/scene.schema.json";
/// What scenes give the supervisor, a line a value.
pub const GIVEN: &str = "tests/golden/suggested_config.txt";
/// What each file is made of: the file as it is.
type Maker = fn(&str) -> Option<String>;
/// All of them.
pub const FILES: [(&str, Maker); 5] = [
    (HEADER, header),
    (TABLES, tables),
    (RECORDS, records),
    (SCHEMA, schema),
    (GIVEN, with_new_values),
];

/// A file as it is, and as it should be.
///
/// # Errors
/// Of reading it, and where there is no place in it for what is to be written.
pub fn now_and_wanted(file: &str, maker: Maker) -> Result<[String; 2], Box<dyn Error>> {
    let now = std::fs::read_to_string(root().join(file)).map_err(|e| format!("{file}: {e}"))?;
    let wanted =
        maker(&now).ok_or_else(|| format!("{file}: there is no place for the parameters"))?;
    Ok([now, wanted])
}

/// Holds a file to what the table says.
///
/// # Panics
/// Where it says something else, with the command that writes it.
pub fn check(file: &str) {
    let maker = FILES.into_iter().find(|(name, _)| *name == file);
    let checked = maker.map(|(name, maker)| now_and_wanted(name, maker));
    let as_it_should_be = matches!(&checked, Some(Ok([now, wanted])) if now == wanted);
    assert!(
        as_it_should_be,
        "{file}: write it with `cargo run --release -p system-tests --bin parameters -- --write`"
    );
}

/// A limit of the table with few digits, as the C library's errors have it: 0.99, 7, 1e-6.
fn number(value: f32) -> String {
    let scientific = format!("{value:e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let digits = digits.replace('.', "");
    let behind = digits.trim_start_matches('-').len() as i32 - 1;
    match exponent.parse().unwrap_or(0) - behind {
        -3..=3 => value.to_string(),
        exponent => format!("{digits}e{exponent}"),
    }
}

/// Range of a parameter.
pub fn range(parameter: &Parameter) -> String {
    format!("{} to {}", number(parameter.low), number(parameter.high))
}

/// The text with `new` in the place of what stands from `start` up to `end`.
fn between(text: &str, start: &str, end: &str, new: &str) -> Option<String> {
    let from = text.find(start)?;
    let to = from + text[from..].find(end)?;
    Some(format!("{}{new}{}", &text[..from], &text[to..]))
}

fn header(now: &str) -> Option<String> {
    let line = |(index, p): (usize, &Parameter)| {
        let (name, unit, text) = (p.name.to_uppercase(), p.unit, p.text);
        format!(
            "#define AMB_P_{name} {index} /**< {unit}, {}: {text} */\n",
            range(p)
        )
    };
    let lines: String = PARAMETERS.iter().enumerate().map(line).collect();
    let text = between(now, "#define AMB_P_", "/** How many there are. */", &lines)?;
    let define = |text: &str, name: &str, value: usize| {
        let start = format!("#define {name} ");
        between(text, &start, "\n", &format!("{start}{value}"))
    };
    let text = define(&text, "AMB_PARAMETERS", PARAMETERS.len())?;
    define(&text, "AMB_ARCHIVE_PLACE_BYTES", size_of::<ArchivePlace>())
}

/// The last column, how to choose it, is the page's own.
fn tables(now: &str) -> Option<String> {
    let row = |p: &Parameter| {
        let start = format!("| `{}` | {} | {} | ", p.name, p.unit, range(p));
        let default = match p.default {
            DefaultRule::Given => "**given**".to_owned(),
            DefaultRule::Derived(rule) => rule.to_owned(),
            DefaultRule::Constant(value, reason) => format!("{}: {reason}", number(value)),
        };
        let old = now
            .lines()
            .find(|l| l.starts_with(&format!("| `{}` | ", p.name)));
        let choice = old.and_then(|row| row.trim_end_matches(" |").rsplit(" | ").next());
        format!(
            "{start}{default} | {} | {} |\n",
            p.text,
            choice.unwrap_or("–")
        )
    };
    let groups = [Group::Machine, Group::Drive, Group::Sensor, Group::Tuning];
    groups.iter().try_fold(now.to_owned(), |text, group| {
        let at = text.find(&format!("\n## {group:?}\n"))?;
        let (before, section) = text.split_at(at);
        let of_group = PARAMETERS.iter().filter(|p| p.group == *group);
        let rows: String = of_group.map(row).collect();
        Some(before.to_owned() + &between(section, "| `", "\n\n", rows.trim_end())?)
    })
}

fn records(now: &str) -> Option<String> {
    const fn per_event<const N: usize>() -> usize {
        size_of::<Archive<f32, N, 3>>() - size_of::<Archive<f32, N, 2>>()
    }
    let sizes = [
        (64, per_event::<64>()),
        (128, per_event::<128>()),
        (256, per_event::<256>()),
        (512, per_event::<512>()),
        (1024, per_event::<1024>()),
    ];
    let row = |(entries, bytes)| format!("| {entries} | {} {:03} |\n", bytes / 1000, bytes % 1000);
    let rows: String = sizes.map(row).concat();
    between(now, "| 64 | ", "\n\n", rows.trim_end())
}

fn schema(_: &str) -> Option<String> {
    let text = serde_json::to_string_pretty(&json_schema()).ok()?;
    Some(text + "\n")
}

/// What scenes and plants give the supervisor, a line a value. Shortest decimals that give the same f32 again.
///
/// # Errors
/// Of reading them.
pub fn given() -> Result<String, Box<dyn Error>> {
    let mut text = String::new();
    for path in scenes()? {
        let scene = Scene::load(&path)?;
        let Some(config) = scene.planes[0].supervisor else {
            continue;
        };
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        for (parameter, value) in PARAMETERS.iter().zip(config.values()) {
            text += &format!("{name} {} {value:e}\n", parameter.name);
        }
    }
    Ok(text)
}

/// Scenes and plants, sorted.
fn scenes() -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for folder in ["firmware-host/scenes", "firmware-host/scenes/plants"] {
        for entry in std::fs::read_dir(root().join(folder))? {
            files.push(entry?.path());
        }
    }
    files.retain(|path| path.extension().is_some_and(|x| x == "toml"));
    files.sort();
    Ok(files)
}

/// A value that is there stays as it is: whether it is still given is asked by a test of its own.
fn with_new_values(now: &str) -> Option<String> {
    let line = |line: &str| {
        let key = line.trim_end_matches(|c| c != ' ');
        let before = now.lines().find(|old| old.starts_with(key));
        before.unwrap_or(line).to_owned() + "\n"
    };
    Some(given().ok()?.lines().map(line).collect())
}
