//! What users write, in a form that the catalogue's pages, file names and command lines can take.

use std::borrow::Cow;
use std::path::Path;

/// Text that neither ends a cell of a table nor begins markup.
pub(super) fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '\\' | '|' | '`' | '*' | '[' | ']' => out.extend(['\\', c]),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Name of the file of a scene, without its ending.
pub(super) fn slug(name: &str) -> String {
    /// File systems take 255.
    const MOST_BYTES: usize = 200;
    let mut slug = String::new();
    for c in name.chars() {
        match c {
            c if c.is_alphanumeric() || c == '.' => slug.extend(c.to_lowercase()),
            '+' => slug.push_str("plus-"),
            // A minus in front of a number, not a hyphen.
            '-' if slug.ends_with('-') || slug.is_empty() => slug.push_str("minus-"),
            _ if slug.ends_with('-') => {}
            _ => slug.push('-'),
        }
        if slug.len() > MOST_BYTES {
            break;
        }
    }
    let slug = slug.trim_matches(['-', '.']);
    // Signs alone name no file.
    if slug.is_empty() { "scene" } else { slug }.to_owned()
}

/// A file as one argument of a shell.
pub(super) fn argument(file: &Path) -> String {
    let file = file.display().to_string();
    // Only a zero byte cannot be quoted, and no path has one.
    shlex::try_quote(&file).map_or(file.clone(), Cow::into_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_stay_in_their_cells() {
        assert_eq!(plain("a|b <i> *c*\n[d](e)"), r"a\|b &lt;i> \*c\* \[d\](e)");
        assert_eq!(plain("30°, 1.0 × capacity"), "30°, 1.0 × capacity");
    }

    #[test]
    fn file_names_tell_titles_of_any_script_apart() {
        let cases = [
            ("impact, 30°, +20 %", "impact-30-plus-20"),
            ("offset -20 %", "offset-minus-20"),
            ("Stoß von Osten", "stoß-von-osten"),
            ("磁気軸受", "磁気軸受"),
            ("../../etc", "etc"),
            ("???", "scene"),
        ];
        for (name, file) in cases {
            assert_eq!(slug(name), file);
        }
        assert!(slug(&"ẞ".repeat(1000)).len() < 210);
    }

    #[test]
    fn a_path_is_one_argument() {
        let cases = [
            ("my/scene.toml", "my/scene.toml"),
            ("my scene's.toml", "\"my scene's.toml\""),
            ("$(x).toml", "'$(x).toml'"),
        ];
        for (path, quoted) in cases {
            assert_eq!(argument(Path::new(path)), quoted);
        }
    }
}
