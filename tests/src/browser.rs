//! Pages of the host in a real browser, driven by the scripts in `tests/browser`.

use crate::root;
use crate::target::skipped;
use std::path::{Path, PathBuf};
use std::process::Command;

fn found(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let mut places = std::env::split_paths(&path).map(|folder| folder.join(program));
    places.find(|place| place.is_file())
}

/// A browser, and what drives it.
#[derive(Debug)]
pub struct Browser {
    chromium: PathBuf,
    node: PathBuf,
}

impl Browser {
    /// `None` on a user's machine without one, with a message.
    ///
    /// # Panics
    /// In CI without one.
    pub fn found() -> Option<Self> {
        let (Some(chromium), Some(node)) = (found("chromium"), found("node")) else {
            skipped("chromium or node is not installed");
            return None;
        };
        if !root().join("tests/browser/node_modules").is_dir() {
            skipped("tests/browser has no node_modules");
            return None;
        }
        Some(Self { chromium, node })
    }

    /// Runs a script on pages, and prints what it says.
    ///
    /// # Panics
    /// Where a page is not as the script wants it.
    pub fn check(&self, script: &str, pages: &[&Path]) {
        let driven = Command::new(&self.node)
            .arg(root().join("tests/browser").join(script))
            .arg(&self.chromium)
            .args(pages)
            .output()
            .expect("node starts");
        let text = String::from_utf8_lossy(&driven.stdout);
        let error = String::from_utf8_lossy(&driven.stderr);
        println!("{text}");
        assert!(driven.status.success(), "{text}\n{error}");
    }
}
