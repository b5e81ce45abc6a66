//! The archive of a unit.

use crate::description::description;
use crate::resources::{self, ResourceError};
use crate::unit::{Unit, Version};
use std::io::{Cursor, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Why there is no archive.
#[derive(Debug, thiserror::Error)]
pub enum BundleError {
    /// The scene or a file that it names cannot be read.
    #[error(transparent)]
    Resource(#[from] ResourceError),
    /// The interface has no name for this platform.
    #[error("FMI 2.0 has no name for {0}")]
    Platform(&'static str),
    /// The archive cannot be written.
    #[error(transparent)]
    Archive(#[from] zip::result::ZipError),
}

/// Licences of this program, which its library is under.
const LICENCES: [(&str, &str); 3] = [
    (
        "license.txt",
        "This unit is licensed under either of Apache-2.0 or MIT, at your choice; see the two files beside this one.\n",
    ),
    ("LICENSE-APACHE", include_str!("../LICENSE-APACHE")),
    ("LICENSE-MIT", include_str!("../LICENSE-MIT")),
];

/// The folder of binaries that fit this program.
fn platform(version: Version) -> Result<String, BundleError> {
    use std::env::consts::{ARCH, OS};
    match (version, ARCH, OS) {
        (Version::Fmi3, arch, os) => Ok(format!("{arch}-{os}")),
        (Version::Fmi2, "x86_64", "linux") => Ok("linux64".to_owned()),
        (Version::Fmi2, arch, _) => Err(BundleError::Platform(arch)),
    }
}

/// The archive of a unit of a scene file, with the shared library that is to run it. The same gives the same bytes.
///
/// # Errors
/// [`BundleError`].
pub fn bundle(
    unit: &Unit,
    scene: &Path,
    version: Version,
    library: &[u8],
) -> Result<Vec<u8>, BundleError> {
    let which = unit.which();
    let resources = resources::of_scene(scene)?;
    let token = resources::token(which, &resources);
    let xml = description(unit, version, &token);
    let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    archive.file("modelDescription.xml", xml.as_bytes(), 0o644)?;
    let binary = format!("binaries/{}/{}.so", platform(version)?, which.name());
    archive.file(&binary, library, 0o755)?;
    archive.file("documentation/index.html", page(unit).as_bytes(), 0o644)?;
    for (name, text) in LICENCES {
        archive.file(
            &format!("documentation/licenses/{name}"),
            text.as_bytes(),
            0o644,
        )?;
    }
    for file in &resources {
        archive.file(&format!("resources/{}", file.name), &file.bytes, 0o644)?;
    }
    Ok(archive.0.finish()?.into_inner())
}

struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    fn file(&mut self, name: &str, bytes: &[u8], mode: u32) -> Result<(), BundleError> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(mode);
        self.0.start_file(name, options)?;
        self.0
            .write_all(bytes)
            .map_err(zip::result::ZipError::from)?;
        Ok(())
    }
}

/// The page that the archive has for people.
fn page(unit: &Unit) -> String {
    let scene = unit.scene();
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title></head>\n<body>\n\
         <h1>{title}: {name}</h1>\n<p>{about}. One step is {whole} of {period:?} s; time counts from the start of the \
         simulation. Parameters are the keys of the scene in <code>resources/scene.toml</code>.</p>\n\
         <p>{story}</p>\n</body></html>\n",
        title = escaped(&scene.title),
        name = unit.which().name(),
        about = unit.which().about(),
        whole = match unit.takes_several_samples() {
            true => "a whole number of control periods",
            false => "one control period",
        },
        period = unit.period_s(),
        story = escaped(scene.story.trim()),
    )
}
