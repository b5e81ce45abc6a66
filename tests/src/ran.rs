//! The program run in a folder of its own, and what it leaves there.

use crate::{host, scene_path};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A folder that goes with its test.
pub struct Folder(TempDir);

impl Folder {
    pub fn fresh() -> Self {
        Self(TempDir::new().unwrap())
    }

    pub fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn put(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.at(name);
        fs::write(&path, content).unwrap();
        path
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.at(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).unwrap()
    }

    /// Names of what a folder in it has, in order; `.` is itself.
    pub fn names(&self, name: &str) -> Vec<String> {
        let entries = fs::read_dir(self.at(name)).unwrap();
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = entries.map(|entry| name(entry.unwrap())).collect();
        names.sort();
        names
    }

    /// One of the project's scenes with these pieces replaced, each at its first place.
    pub fn scene(&self, name: &str, of: &str, edits: &[(&str, &str)]) -> PathBuf {
        self.put(name, edited(&scene_text(of), edits))
    }

    /// The program with these words, in this folder; `@` begins the name of one of the project's scenes.
    pub fn command(&self, line: &str) -> Command {
        let mut command = host();
        command.args(words(line)).current_dir(self.0.path());
        command.stdin(Stdio::null());
        command
    }

    pub fn ran(&self, line: &str) -> Ran {
        ran(&mut self.command(line))
    }
}

/// Words of a command line, in which `@` begins the name of one of the project's scenes.
fn words(line: &str) -> impl Iterator<Item = String> {
    line.split_whitespace()
        .map(|word| match word.strip_prefix('@') {
            Some(name) => scene_path(name).display().to_string(),
            None => word.to_owned(),
        })
}

pub fn scene_text(name: &str) -> String {
    fs::read_to_string(scene_path(name)).unwrap()
}

/// A text with these pieces replaced, each at its first place.
#[track_caller]
pub fn edited(text: &str, edits: &[(&str, &str)]) -> String {
    edits.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from} is not in\n{text}");
        text.replacen(from, to, 1)
    })
}

/// What a program came to.
pub struct Ran {
    pub code: Option<i32>,
    pub printed: String,
    /// On standard error.
    pub said: String,
}

#[track_caller]
pub fn ran(command: &mut Command) -> Ran {
    let output = command.output().expect("it starts");
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran {
        code: output.status.code(),
        printed: text(output.stdout),
        said: text(output.stderr),
    }
}

impl Ran {
    /// What is printed where all goes well.
    #[track_caller]
    pub fn good(self) -> String {
        assert_eq!(self.code, Some(0), "{}", self.said);
        self.printed
    }

    #[track_caller]
    pub fn json(self) -> Value {
        serde_json::from_str(&self.good()).unwrap()
    }

    /// What is said, in one line, where it ends with this code.
    #[track_caller]
    pub fn fails(self, code: i32) -> String {
        assert_eq!(self.code, Some(code), "{}{}", self.said, self.printed);
        flat(&self.said)
    }

    /// The same of what was asked wrongly: then nothing is printed.
    #[track_caller]
    pub fn refused(self) -> String {
        assert_eq!(self.printed, "");
        self.fails(2)
    }
}

/// In one line: what is said is wrapped to the terminal's width.
pub fn flat(said: &str) -> String {
    let text = said.replace('│', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Each of these is in a text.
#[track_caller]
pub fn has(text: &str, all: &[&str]) {
    for one in all {
        assert!(text.contains(one), "no \"{one}\" in\n{text}");
    }
}

/// None of these is in a text.
#[track_caller]
pub fn lacks(text: &str, all: &[&str]) {
    for one in all {
        assert!(!text.contains(one), "\"{one}\" in\n{text}");
    }
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

pub fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("{value}"))
}
