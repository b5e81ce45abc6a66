//! Sweep files.

use crate::scene::diagnostic::{SceneError, SceneText, in_words};
use crate::scene::guess;
use crate::scene::policy_kind::PolicyKind;
use crate::sweep::design::{Design, MOST_RUNS, Points, SOBOL_DIMENSIONS, SOBOL_POINTS};
use crate::sweep::error::SweepError;
use crate::sweep::values::{Values, VaryTable};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::{Spanned, Table};

/// Keys that say what is shown of results, and not what they are.
const OF_THE_SUMMARY: [&str; 3] = ["worst", "worst_by", "worst_policy"];

/// A sweep file as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    scene: PathBuf,
    design: Design,
    runs: Option<u64>,
    repeats: Option<u64>,
    #[serde(default)]
    seed: u64,
    policies: Option<Vec<String>>,
    #[serde(default = "three")]
    worst: u32,
    worst_by: Option<String>,
    worst_policy: Option<String>,
    #[serde(default)]
    vary: Vec<Spanned<VaryTable>>,
}

fn three() -> u32 {
    3
}

/// A key of scenes that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Its path, as [`Spec::set`](crate::scene::spec::Spec::set) has it.
    pub key: String,
    /// What it varies over.
    pub values: Values,
    /// The key of the sweep file that says so.
    pub(crate) said_by: String,
}

/// Which runs are kept as scene files.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Worst {
    /// So many.
    pub count: u32,
    /// Those with the largest of this figure.
    pub by: String,
    /// Under this policy.
    pub policy: Option<String>,
}

/// A sweep file, its values checked by themselves.
#[derive(Debug, Clone)]
pub struct SweepFile {
    pub(crate) text: SceneText,
    /// The scene file.
    pub scene: PathBuf,
    /// How runs are spread.
    pub design: Design,
    /// The runs.
    pub points: Points,
    /// What varies.
    pub variations: Vec<Variation>,
    /// Policies in the place of the scene's.
    pub policies: Option<Vec<PolicyKind>>,
    /// Which runs are kept.
    pub worst: Worst,
    /// What decides about results, as written.
    pub(crate) settings: Table,
}

impl SweepFile {
    /// Reads a sweep file.
    ///
    /// # Errors
    /// [`SweepError`] with file, line and key.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let text = SceneText::read(path).map_err(|error| match error {
            SceneError::Read { path, reason } => SweepError::Read {
                what: "sweep",
                path,
                reason: reason.to_string(),
                help: "give the path of a sweep file, e.g. firmware-host/scenes/sweeps/impact.toml",
            },
            other => other.into(),
        })?;
        Ok(Self::of(text)?)
    }

    fn of(text: SceneText) -> Result<Self, SceneError> {
        let written: Written = toml::from_str(&text.text).map_err(|error| {
            let message = in_words(error.message());
            let help = guess::from_message(&message).or_else(|| missing(&message));
            text.error_at(error.span().unwrap_or(0..0), message, help)
        })?;
        let mut settings: Table = toml::from_str(&text.text).unwrap_or_default();
        for key in OF_THE_SUMMARY {
            settings.remove(key);
        }
        let folder = text.path.parent().unwrap_or(Path::new(""));
        let variations = variations(&written, &text)?;
        Ok(Self {
            scene: folder.join(&written.scene),
            design: written.design,
            points: points(&written, &variations, &text)?,
            variations,
            policies: policies(&written, &text)?,
            worst: Worst {
                count: written.worst,
                by: (written.worst_by).unwrap_or_else(|| "peak_contact_force_n".to_owned()),
                policy: written.worst_policy,
            },
            settings,
            text,
        })
    }

    pub(crate) fn error(&self, key: &str, message: String, help: Option<String>) -> SceneError {
        self.text.error_at_key(key, message, help)
    }
}

/// What to give where a key is missing.
fn missing(message: &str) -> Option<String> {
    let (_, name) = message.split_once("missing field `")?;
    let give = match name.trim_end_matches('`') {
        "scene" => "give the scene that is varied: scene = \"…\", by its path from this file",
        "design" => "give design = \"grid\", \"latin_hypercube\", \"sobol\" or \"monte_carlo\"",
        "key" => "give the key of the scene that varies: key = \"friction.coefficient\"",
        "from" | "to" | "count" => "give { from = 1.0, to = 2.0, count = 11 }",
        "mean" | "standard_deviation" | "low" | "high" => {
            "give { mean = 1.0, standard_deviation = 0.1, low = 0.8, high = 1.2 }"
        }
        _ => return None,
    };
    Some(give.to_owned())
}

fn variations(written: &Written, text: &SceneText) -> Result<Vec<Variation>, SceneError> {
    let mut variations: Vec<Variation> = Vec::new();
    for (i, table) in written.vary.iter().enumerate() {
        let path = format!("vary[{i}]");
        let key = &table.get_ref().key;
        if let Some(j) = variations.iter().position(|other| other.key == *key) {
            let message = format!("{key} varies in vary[{j}] already");
            let help = "give each key one table".to_owned();
            return Err(text.error_at_key(&format!("{path}.key"), message, Some(help)));
        }
        let (values, name) = table
            .get_ref()
            .read()
            .map_err(|(at, message, help)| match at {
                Some(at) => text.error_at_key(&format!("{path}.{at}"), message, Some(help)),
                None => text.error_at(table.span(), format!("{path}: {key} {message}"), Some(help)),
            })?;
        variations.push(Variation {
            key: key.clone(),
            values,
            said_by: format!("{path}.{name}"),
        });
    }
    Ok(variations)
}

fn points(
    written: &Written,
    variations: &[Variation],
    text: &SceneText,
) -> Result<Points, SceneError> {
    let refused = |key: &str, message: String, help: &str| {
        Err(text.error_at_key(key, message, Some(help.to_owned())))
    };
    let design = written.design.name();
    if written.seed > i64::MAX.cast_unsigned() {
        return refused(
            "seed",
            "is too large".to_owned(),
            "give a whole number below 2^63",
        );
    }
    if written.design != Design::Grid {
        if written.repeats.is_some() {
            let message = format!("goes with a grid, and not with {design}");
            return refused("repeats", message, "give runs alone");
        }
        let Some(runs) = written.runs else {
            let help = "give the number of runs: runs = 1000".to_owned();
            return Err(text.error_at(0..0, "runs is missing".to_owned(), Some(help)));
        };
        let (most, why) = match written.design {
            Design::Sobol => (SOBOL_POINTS, "; a latin_hypercube or monte_carlo has more"),
            _ => (MOST_RUNS, ""),
        };
        if !(1..=most).contains(&runs) {
            let message = format!("is {runs}, expected a whole number from 1 to {most}{why}");
            return refused("runs", message, "give another number of runs");
        }
        if written.design == Design::Sobol && variations.len() > SOBOL_DIMENSIONS {
            let message = format!(
                "{} keys vary, a Sobol sequence has {SOBOL_DIMENSIONS}",
                variations.len()
            );
            return refused("vary", message, "take latin_hypercube or monte_carlo");
        }
        return Ok(Points::spread(
            written.design,
            runs,
            variations.len(),
            written.seed,
        ));
    }
    if let Some(runs) = written.runs {
        let message = format!("is {runs}, but a grid has as many runs as combinations");
        return refused(
            "runs",
            message,
            "remove it; repeats = 10 runs each combination ten times",
        );
    }
    let mut levels = Vec::new();
    for variation in variations {
        match variation.values.levels() {
            Some(count) => levels.push(count),
            None => {
                let message = format!(
                    "is a distribution of {}, and a grid has none",
                    variation.key
                );
                return refused(
                    &variation.said_by,
                    message,
                    "give values, linspace or logspace, or take another design",
                );
            }
        }
    }
    let points = Points::grid(levels, written.repeats.unwrap_or(1), written.seed);
    match points.runs() {
        0 => refused("repeats", "is 0".to_owned(), "give a whole number from 1"),
        runs if runs > MOST_RUNS => {
            let message = format!("grid of {runs} combinations, at most {MOST_RUNS}");
            refused("design", message, "take fewer values, or another design")
        }
        _ => Ok(points),
    }
}

fn policies(written: &Written, text: &SceneText) -> Result<Option<Vec<PolicyKind>>, SceneError> {
    let known = PolicyKind::ALL.map(PolicyKind::name);
    let refused =
        |message: String, help: String| text.error_at_key("policies", message, Some(help));
    let Some(names) = &written.policies else {
        return Ok(None);
    };
    let mut policies = Vec::new();
    for name in names {
        let help = || guess::before(format!("policies are {}", known.join(", ")), name, known);
        let kind = PolicyKind::from_name(name)
            .ok_or_else(|| refused(format!("there is no policy \"{name}\""), help()))?;
        if policies.contains(&kind) {
            return Err(refused(
                format!("\"{name}\" is named twice"),
                "name each policy once".to_owned(),
            ));
        }
        policies.push(kind);
    }
    match policies.is_empty() {
        true => Err(refused(
            "is empty".to_owned(),
            "name at least one, or remove the key: then the scene's are run".to_owned(),
        )),
        false => Ok(Some(policies)),
    }
}
