//! The configuration as it is written in a scene or in firmware.

use super::Parameter;

/// Where a configuration is written down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// The table of a scene.
    Toml,
    /// The struct of a firmware in Rust.
    Rust,
    /// The array of a firmware in C.
    C,
}

/// The suggested configuration as a table for a scene, each value with its unit and how it was chosen.
pub fn table(parameters: &[Parameter]) -> String {
    let line = |p: &Parameter| {
        let own = p.replaced_by.map(decimal);
        let own = own.map_or(String::new(), |own| format!(" (this scene sets {own})"));
        Language::Toml.line(p, p.value, &format!("{}{own}", p.reason))
    };
    Language::Toml.listing(parameters.iter().map(line))
}

/// The configuration that holds, with what the scene sets itself.
pub fn listing(parameters: &[Parameter], language: Language) -> String {
    let line = |p: &Parameter| match p.replaced_by {
        None => language.line(p, p.value, &p.reason),
        Some(own) => {
            let remark = format!("set in the scene; suggested {}", decimal(p.value));
            language.line(p, own, &remark)
        }
    };
    language.listing(parameters.iter().map(line))
}

impl Language {
    fn listing(self, lines: impl Iterator<Item = String>) -> String {
        let (begin, end) = match self {
            Self::Toml => ("[supervisor]\n", ""),
            Self::Rust => (
                "static CONFIG: supervisor::Config = supervisor::Config {\n",
                "};\n",
            ),
            Self::C => ("static const float config[AMB_PARAMETERS] = {\n", "};\n"),
        };
        lines.fold(begin.to_owned(), |listing, line| listing + &line) + end
    }

    /// A value with its unit and a remark.
    fn line(self, p: &Parameter, value: f32, remark: &str) -> String {
        let unit = if p.unit == "1" { "–" } else { p.unit };
        let (name, number) = (p.name, decimal(value));
        // In Rust and C a number without a point is an integer.
        let fraction = match number.contains(['.', 'e']) {
            true => number.clone(),
            false => format!("{number}.0"),
        };
        match self {
            Self::Toml => {
                let setting = format!("{name} = {number}");
                format!("{setting:<38}# {unit}; {remark}\n")
            }
            Self::Rust => {
                let setting = format!("    {name}: {fraction},");
                format!("{setting:<42}// {unit}; {remark}\n")
            }
            Self::C => {
                let setting = format!("    [AMB_P_{}] = {fraction}f,", name.to_uppercase());
                format!("{setting:<50}/* {unit}; {remark} */\n")
            }
        }
    }
}

/// The shortest decimals that give the same value again.
fn decimal(value: f32) -> String {
    match value.abs() {
        0.0 | 1e-3..1e5 => value.to_string(),
        _ => format!("{value:e}"),
    }
}
