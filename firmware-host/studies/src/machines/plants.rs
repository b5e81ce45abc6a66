//! The plants of the catalogue, from their scene files.

use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::spec::Spec;

/// A plant of the catalogue at one control rate.
#[derive(Debug, Clone)]
pub struct PlantCase {
    /// Name, e.g. `P1 150 N`.
    pub name: String,
    /// Control rate \[Hz\].
    pub rate_hz: f64,
    /// Rotor in the middle, at rest, nothing happening.
    pub scene: Scene,
}

struct File {
    name: &'static str,
    file: &'static str,
    text: &'static str,
    /// Force caps \[N\]; none: the file's.
    caps_n: &'static [f64],
}

const FILES: [File; 4] = [
    File {
        name: "P1",
        file: "plants/p1.toml",
        text: include_str!("../../scenes/plants/p1.toml"),
        caps_n: &[50.0, 150.0, 500.0, 1500.0],
    },
    File {
        name: "P2",
        file: "plants/p2.toml",
        text: include_str!("../../scenes/plants/p2.toml"),
        caps_n: &[],
    },
    File {
        name: "P3",
        file: "plants/p3.toml",
        text: include_str!("../../scenes/plants/p3.toml"),
        caps_n: &[],
    },
    File {
        name: "P4",
        file: "plants/p4.toml",
        text: include_str!("../../scenes/plants/p4.toml"),
        caps_n: &[],
    },
];

/// Control rates of the catalogue \[Hz\].
pub const RATES_HZ: [f64; 2] = [10_000.0, 20_000.0];

/// Every plant at one control rate.
///
/// # Errors
/// [`SceneError`] if a file of the catalogue is not valid.
pub fn plants(rate_hz: f64) -> Result<Vec<PlantCase>, SceneError> {
    let mut cases = Vec::new();
    for file in &FILES {
        let caps: Vec<Option<f64>> = match file.caps_n {
            [] => vec![None],
            caps => caps.iter().map(|cap| Some(*cap)).collect(),
        };
        for cap in caps {
            let mut spec = Spec::parse(file.file, file.text)?;
            spec.set("run.sample_rate_hz", rate_hz)?;
            if let Some(cap) = cap {
                spec.set("magnet.force_max_n", cap)?;
            }
            let scene = spec.resolve()?;
            let name = match cap {
                Some(cap) => format!("{} {cap:.0} N", file.name),
                None => file.name.to_owned(),
            };
            cases.push(PlantCase {
                name,
                rate_hz,
                scene,
            });
        }
    }
    Ok(cases)
}
