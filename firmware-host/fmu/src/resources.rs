//! What a unit carries of its scene: the file, and the files that it names.

use crate::unit::Which;
use firmware_bench::scene::spec::{Spec, names_a_file};
use sha2::{Digest, Sha256};
use std::io;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// Name of the scene among the resources.
pub(crate) const SCENE: &str = "scene.toml";

/// A file of a unit's resources.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Resource {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

/// Why the resources of a scene cannot be had.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct ResourceError {
    /// The file.
    pub path: PathBuf,
    /// The system's message.
    pub reason: io::Error,
}

/// The resources of a scene, the scene first. Files that it names lie beside it, under their own names with a number before.
pub(crate) fn of_scene(path: &Path) -> Result<Vec<Resource>, ResourceError> {
    let refused = |path: &Path| {
        let path = path.to_owned();
        move |reason| ResourceError { path, reason }
    };
    let text = std::fs::read_to_string(path).map_err(refused(path))?;
    let parsed = text.parse::<DocumentMut>();
    let mut document = parsed.map_err(|error| refused(path)(io::Error::other(error)))?;
    let mut named = Vec::new();
    rename_files(document.as_table_mut(), &mut named);
    let mut all = vec![Resource {
        name: SCENE.to_owned(),
        bytes: document.to_string().into_bytes(),
    }];
    let folder = path.parent().unwrap_or(Path::new(""));
    for (original, name) in named {
        let original = folder.join(original);
        let bytes = std::fs::read(&original).map_err(refused(&original))?;
        all.push(Resource { name, bytes });
    }
    Ok(all)
}

/// Puts in the place of every file's path the name that it has among the resources.
fn rename_files(table: &mut dyn TableLike, named: &mut Vec<(String, String)>) {
    for (key, item) in table.iter_mut() {
        match item {
            Item::Value(Value::String(path)) if names_a_file(key.get()) => {
                let file = Path::new(path.value()).file_name().unwrap_or_default();
                let name = format!("{}_{}", named.len() + 1, file.to_string_lossy());
                named.push((path.value().clone(), name.clone()));
                *item = Item::Value(name.into());
            }
            Item::ArrayOfTables(all) => all.iter_mut().for_each(|t| rename_files(t, named)),
            Item::Value(Value::Array(all)) => (all.iter_mut())
                .filter_map(Value::as_inline_table_mut)
                .for_each(|t| rename_files(t, named)),
            item => {
                if let Some(below) = item.as_table_like_mut() {
                    rename_files(below, named);
                }
            }
        }
    }
}

/// The scene of a folder of resources, and the token that a unit of it has.
///
/// # Errors
/// What is wrong with them, as text.
pub(crate) fn read(folder: &Path, which: Which) -> Result<(Spec, String), String> {
    let path = folder.join(SCENE);
    let spec = Spec::load(&path).map_err(|error| error.to_string())?;
    let mut all = Vec::new();
    let named = spec.files().into_iter().map(str::to_owned);
    for name in std::iter::once(SCENE.to_owned()).chain(named) {
        let path = folder.join(&name);
        let bytes = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        all.push(Resource { name, bytes });
    }
    Ok((spec, token(which, &all)))
}

/// What distinguishes a unit from others: the model, and the digest of its resources and of this program's version.
pub(crate) fn token(which: Which, all: &[Resource]) -> String {
    let mut files: Vec<&Resource> = all.iter().collect();
    files.sort_by(|a, b| a.name.cmp(&b.name));
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    for file in files {
        hash.update(file.name.as_bytes());
        hash.update(file.bytes.len().to_le_bytes());
        hash.update(&file.bytes);
    }
    let digits = hash.finalize();
    let digits = digits.iter().take(16).map(|byte| format!("{byte:02x}"));
    format!("{}-{}", which.name(), digits.collect::<String>())
}

/// Which model a token is of.
pub(crate) fn model_of(token: &str) -> Option<Which> {
    let name = token.split('-').next()?;
    Which::ALL.into_iter().find(|which| which.name() == name)
}
