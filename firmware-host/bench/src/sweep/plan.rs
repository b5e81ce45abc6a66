//! A sweep that can be run: any of its runs by number.

use crate::run::columns::{Cell, Column, Kind};
use crate::scene::Scene;
use crate::scene::diagnostic::SceneError;
use crate::scene::guess;
use crate::scene::keys::number;
use crate::scene::policy_kind::PolicyKind;
use crate::scene::spec::{Spec, names_a_file};
use crate::sweep::error::SweepError;
use crate::sweep::figures_of::{cells, columns};
use crate::sweep::file::SweepFile;
use crate::sweep::table::Rows;
use crate::sweep::values::{Values, Variation};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use toml::Value;

/// Runs of a chunk: so many are lost at most by each thread that is stopped, and a sweep of few runs still has work for all.
const CHUNK_RUNS: u64 = 64;

/// A sweep, checked.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What was asked for.
    pub file: SweepFile,
    /// The scene as written, with the sweep's policies.
    spec: Spec,
    /// The same, resolved.
    scene: Scene,
    policies: Vec<PolicyKind>,
    columns: Arc<[Column]>,
    /// Digests of the files that results hang on, by their names.
    pub(crate) inputs: BTreeMap<String, String>,
}

/// A run's keys and values, in the order of the sweep file, and its seed.
#[derive(Debug, Clone, PartialEq)]
pub struct RunPoint {
    /// Values of the keys that vary.
    pub values: Vec<Value>,
    /// `run.seed`.
    pub seed: i64,
}

impl Plan {
    /// Reads a sweep file, its scene, and what that names.
    ///
    /// # Errors
    /// [`SweepError`] with file, line and key.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let file = SweepFile::load(path)?;
        let mut spec = Spec::load(&file.scene).map_err(|error| match error {
            SceneError::Read { path, reason } => {
                let message = format!("cannot read {}: {reason}", path.display());
                let help = "give the path of a scene file, from the folder of this file";
                file.error("scene", message, Some(help.to_owned()))
            }
            other => other,
        })?;
        if let Some(policies) = &file.policies {
            let names = policies
                .iter()
                .map(|kind| Value::String(kind.name().to_owned()));
            spec.set("run.policies", names.collect::<Vec<Value>>())?;
        }
        for (i, variation) in file.variations.iter().enumerate() {
            check(&file, &spec, i, variation)?;
        }
        let scene = spec.resolve()?;
        let policies = scene.policies.clone();
        let columns = all_columns(&file, &scene);
        let plan = Self {
            inputs: inputs(&file, &spec)?,
            columns: columns.into(),
            policies,
            scene,
            // They are those of the scene as written, which are said once.
            spec: spec.without_warnings(),
            file,
        };
        plan.check_worst()?;
        Ok(plan)
    }

    /// Whether there is the figure, and the policy, that the worst runs are chosen by.
    fn check_worst(&self) -> Result<(), SceneError> {
        let worst = &self.file.worst;
        let figures = || {
            let ends = self.file.variations.len() + 3;
            let figures = self.columns.iter().skip(ends);
            figures
                .filter(|c| matches!(c.kind, Kind::Number | Kind::Whole))
                .map(|c| c.name.as_str())
        };
        if !figures().any(|name| name == worst.by) {
            let message = format!("there is no figure {}", worst.by);
            let help = guess::before("give a column of numbers of the results, as peak_contact_force_n or severity_index".to_owned(), &worst.by, figures());
            return Err(self.file.error("worst_by", message, Some(help)));
        }
        match &worst.policy {
            Some(name) if !self.policies.iter().any(|kind| kind.name() == name) => {
                let names: Vec<&str> = self.policies.iter().map(|kind| kind.name()).collect();
                let message = format!("\"{name}\" is not run");
                let help = format!("give one of {}", names.join(", "));
                Err(self.file.error("worst_policy", message, Some(help)))
            }
            _ => Ok(()),
        }
    }

    /// Title of the scene.
    pub fn title(&self) -> &str {
        &self.scene.title
    }

    /// What the scene warns of.
    pub fn warnings(&self) -> &[String] {
        &self.scene.warnings
    }

    /// The policies, in the order of a run's rows.
    pub fn policies(&self) -> &[PolicyKind] {
        &self.policies
    }

    /// The policy by which the worst runs are chosen, and that influences are of: as asked for, or the supervisor, or the last.
    pub fn worst_policy(&self) -> &str {
        let default = || match self.policies.contains(&PolicyKind::Supervisor) {
            true => Some(PolicyKind::Supervisor),
            false => self.policies.last().copied(),
        };
        let named = self.file.worst.policy.as_deref();
        named
            .or_else(|| default().map(PolicyKind::name))
            .unwrap_or_default()
    }

    /// Whether a policy, by its place, is that one.
    pub(crate) fn is_worst_policy(&self, place: usize) -> bool {
        (self.policies.get(place)).is_some_and(|kind| kind.name() == self.worst_policy())
    }

    /// Columns of the results.
    pub fn columns(&self) -> Arc<[Column]> {
        self.columns.clone()
    }

    /// Number of runs.
    pub fn runs(&self) -> u64 {
        self.file.points.runs()
    }

    /// Runs of every chunk but the last.
    pub(crate) fn chunk_runs(&self) -> u64 {
        (self.runs() / CHUNK_RUNS).clamp(1, CHUNK_RUNS)
    }

    /// Number of chunks.
    pub fn chunks(&self) -> u64 {
        self.runs().div_ceil(self.chunk_runs())
    }

    /// Runs of a chunk.
    pub fn runs_of(&self, chunk: u64) -> std::ops::Range<u64> {
        let from = chunk * self.chunk_runs();
        from..(from + self.chunk_runs()).min(self.runs())
    }

    /// What a run draws.
    pub fn point(&self, run: u64) -> RunPoint {
        let point = self.file.points.at(run);
        let shares = point.shares.iter().zip(&self.file.variations);
        let mut seed = point.seed.cast_signed();
        let values = shares.map(|(share, variation)| {
            let value = variation.values.at(*share);
            // Who varies it has the last word.
            if let ("run.seed", Some(own)) = (variation.key.as_str(), number(&value)) {
                seed = own as i64;
            }
            value
        });
        RunPoint {
            values: values.collect(),
            seed,
        }
    }

    /// The scene of a run as one would write it.
    ///
    /// # Errors
    /// [`SceneError`] of values that make no scene.
    pub fn spec(&self, point: &RunPoint) -> Result<Spec, SceneError> {
        let mut spec = self.spec.clone();
        let varied = self.file.variations.iter().zip(&point.values);
        let mut all = vec![("run.seed", Value::Integer(point.seed))];
        all.extend(varied.map(|(variation, value)| (variation.key.as_str(), value.clone())));
        spec.set_all(&all)?;
        Ok(spec)
    }

    /// Runs a run under each policy, and adds its rows to others.
    pub fn run(&self, run: u64, rows: &mut Rows) {
        let point = self.point(run);
        let scene = self.spec(&point).and_then(|spec| spec.resolve());
        let scene = scene.map_err(|error| in_one_line(&error));
        for kind in &self.policies {
            let mut row = vec![
                Cell::Whole(Some(run.cast_signed())),
                Cell::Text(Some(kind.name().to_owned())),
                Cell::Whole(Some(point.seed)),
            ];
            let varied = self.file.variations.iter().zip(&point.values);
            row.extend(varied.map(|(variation, value)| variation.values.cell(value)));
            let ended = match &scene {
                Ok(scene) => cells(scene, *kind).map_err(|error| error.to_string()),
                Err(error) => Err(error.clone()),
            };
            match ended {
                Ok(cells) => row.extend(cells),
                Err(error) => {
                    let empty = self.columns.iter().skip(row.len()).map(|c| c.kind.empty());
                    row.extend(empty);
                    row.pop();
                    row.push(Cell::Text(Some(error)));
                }
            }
            rows.push(row);
        }
    }
}

/// What is the same wherever the files lie.
fn in_one_line(error: &SceneError) -> String {
    match error {
        SceneError::Content {
            path,
            line,
            message,
            ..
        } => {
            let name = path.file_name().unwrap_or(path.as_os_str());
            format!("{}:{line}: {message}", name.display())
        }
        other => other.to_string(),
    }
}

/// Whether a key is one of scenes, and its values of the type that it has. Whether they make a scene each run says.
fn check(
    file: &SweepFile,
    spec: &Spec,
    index: usize,
    variation: &Variation,
) -> Result<(), SceneError> {
    let at = |key: &str, error: SceneError| match error {
        SceneError::Content { message, help, .. } => file.error(key, message, help),
        other => other,
    };
    let Variation {
        key,
        values,
        written_at,
    } = variation;
    spec.get(key)
        .map_err(|error| at(&format!("vary[{index}].key"), error))?;
    if key == "run.policies" {
        let message = "run.policies does not vary: each run is under every policy".to_owned();
        let help =
            Some("give policies = [\"levitation\", \"supervisor\"] above the tables".to_owned());
        return Err(file.error(&format!("vary[{index}].key"), message, help));
    }
    let tried: Vec<Value> = match values {
        Values::Listed(all) => all.iter().take(1000).cloned().collect(),
        // One that is not whole by chance.
        _ => vec![values.at(1.0 / 3.0)],
    };
    for value in tried {
        (spec.clone().set(key, value)).map_err(|error| at(written_at, error))?;
    }
    Ok(())
}

fn all_columns(file: &SweepFile, scene: &Scene) -> Vec<Column> {
    let column = |name: &str, kind| Column {
        name: name.to_owned(),
        kind,
    };
    let mut all = vec![
        column("run", Kind::Whole),
        column("policy", Kind::Text),
        column("seed", Kind::Whole),
    ];
    let varied = file.variations.iter();
    all.extend(varied.map(|variation| column(&variation.key, variation.values.kind())));
    all.extend(columns(scene));
    all.push(column("error", Kind::Text));
    all
}

/// Digests of the scene and of the files that it names, or that are put into it.
fn inputs(file: &SweepFile, spec: &Spec) -> Result<BTreeMap<String, String>, SweepError> {
    let name = file.scene.file_name().unwrap_or(file.scene.as_os_str());
    let mut inputs = BTreeMap::new();
    inputs.insert(name.to_string_lossy().into_owned(), digest(&file.scene)?);
    let varied = file.variations.iter().filter(|v| names_a_file(&v.key));
    let varied = varied.flat_map(|variation| match &variation.values {
        Values::Listed(all) => all.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    });
    let folder = file.scene.parent().unwrap_or(Path::new(""));
    for named in spec.files().into_iter().chain(varied) {
        inputs.insert(named.to_owned(), digest(&folder.join(named))?);
    }
    Ok(inputs)
}

/// SHA-256 of a file, in hexadecimal digits.
///
/// # Errors
/// [`SweepError`] where it cannot be read.
pub fn digest(path: &Path) -> Result<String, SweepError> {
    let refused = |reason: std::io::Error| SweepError::Read {
        what: "file",
        path: path.to_owned(),
        reason: reason.to_string(),
        help: "give a file that can be read",
    };
    let mut file = std::fs::File::open(path).map_err(refused)?;
    let mut hash = Sha256::new();
    let mut part = [0; 1 << 16];
    loop {
        match std::io::Read::read(&mut file, &mut part).map_err(refused)? {
            0 => break,
            n => hash.update(&part[..n]),
        }
    }
    Ok(hash
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect())
}
