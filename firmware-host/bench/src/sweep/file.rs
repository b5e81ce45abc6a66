//! Sweep files.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::guess;
use crate::scene::policy_kind::PolicyKind;
use crate::scene::read;
use crate::sweep::design::{Design, Points};
use crate::sweep::error::SweepError;
use crate::sweep::size::{Sizes, points};
use crate::sweep::tables::SweepTables;
use crate::sweep::values::Variation;
use std::path::{Path, PathBuf};
use toml::Table;

/// Keys that say what is shown of results, and not what they are.
const OF_THE_SUMMARY: [&str; 4] = ["worst", "worst_by", "worst_policy", "maps"];

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
    /// Pairs of keys, by their places among those that vary, over which outcomes are shown; empty: over the two strongest.
    pub maps: Vec<[usize; 2]>,
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
        let mut settings: Table = toml::from_str(&text.text)
            .map_err(|error| text.error_in_toml(error.span().unwrap_or(0..0), error.message()))?;
        if settings.contains_key("rotor") && settings.contains_key("run") {
            let message = "is of a scene, and this is to be a sweep of one".to_owned();
            let help = "run a scene with `firmware-host run`".to_owned();
            return Err(text.error_at_key("run", message, Some(help)));
        }
        let written: SweepTables = read::file(settings.clone(), SweepTables::KEYS)
            .map_err(|refusal| text.error_of(refusal, SweepTables::KEYS))?;
        for key in OF_THE_SUMMARY {
            settings.remove(key);
        }
        let folder = text.path.parent().unwrap_or(Path::new(""));
        let variations = variations(&written, &text)?;
        Ok(Self {
            scene: folder.join(&written.scene),
            design: written.design,
            points: points(
                (written.design, written.seed),
                &sizes(&written),
                &variations,
                &text,
            )?,
            maps: maps(&written, &variations, &text)?,
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

fn variations(written: &SweepTables, text: &SceneText) -> Result<Vec<Variation>, SceneError> {
    let mut variations: Vec<Variation> = Vec::new();
    for (i, table) in written.vary.iter().enumerate() {
        let path = format!("vary[{i}]");
        let key = &table.key;
        if let Some(j) = variations.iter().position(|other| other.key == *key) {
            let message = format!("{key} varies in vary[{j}] already");
            let help = "give each key one table".to_owned();
            return Err(text.error_at_key(&format!("{path}.key"), message, Some(help)));
        }
        let (values, name) = table.checked().map_err(|(at, message, help)| match at {
            Some(at) => text.error_at_key(&format!("{path}.{at}"), message, Some(help)),
            None => text.error_at_key(&path, format!("{key} {message}"), Some(help)),
        })?;
        variations.push(Variation {
            key: key.clone(),
            values,
            written_at: format!("{path}.{name}"),
        });
    }
    Ok(variations)
}

fn sizes(written: &SweepTables) -> Sizes {
    Sizes {
        runs: written.runs,
        repeats: written.repeats,
    }
}

fn maps(
    written: &SweepTables,
    variations: &[Variation],
    text: &SceneText,
) -> Result<Vec<[usize; 2]>, SceneError> {
    let keys = || variations.iter().map(|variation| variation.key.as_str());
    let place = |i: usize, key: &str| {
        keys().position(|other| other == key).ok_or_else(|| {
            let help = "give pairs of keys that vary, [[\"a.key\", \"another.key\"]]".to_owned();
            let help = guess::before(help, key, keys());
            text.error_at_key(
                "maps",
                format!("maps[{i}]: {key} does not vary"),
                Some(help),
            )
        })
    };
    let pair = |(i, keys): (usize, &Vec<String>)| match &keys[..] {
        [x, y] if x != y => Ok([place(i, x)?, place(i, y)?]),
        [x, y] if x == y => {
            let message = format!("maps[{i}]: is {x} twice");
            let help = "give two keys that vary".to_owned();
            Err(text.error_at_key("maps", message, Some(help)))
        }
        keys => {
            let message = format!("maps[{i}]: has {} keys, expected two", keys.len());
            let help = "give pairs of keys that vary, [[\"a.key\", \"another.key\"]]".to_owned();
            Err(text.error_at_key("maps", message, Some(help)))
        }
    };
    written.maps.iter().enumerate().map(pair).collect()
}

fn policies(
    written: &SweepTables,
    text: &SceneText,
) -> Result<Option<Vec<PolicyKind>>, SceneError> {
    let known = PolicyKind::ALL.map(PolicyKind::name);
    let refused =
        |message: String, help: String| text.error_at_key("policies", message, Some(help));
    let Some(names) = &written.policies else {
        return Ok(None);
    };
    let mut policies = Vec::new();
    for name in &names.0 {
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
