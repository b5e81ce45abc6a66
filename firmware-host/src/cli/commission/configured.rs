//! What the supervisor of a scene is configured with, of what a log can tell.

use crate::cli::commission::wrong;
use crate::cli::error::CommandError;
use crate::cli::load;
use firmware_bench::commission::two_planes::TwoPlanes;
use firmware_bench::scene::Scene;
use std::path::{Path, PathBuf};
use supervisor::{PARAMETERS, Shaft};

/// The configured machine, as its scene has it.
pub(super) struct Setup {
    path: PathBuf,
    scene: Scene,
}

impl Setup {
    /// Of a scene file.
    ///
    /// # Errors
    /// [`CommandError`].
    pub(super) fn load(path: &Path) -> Result<Self, CommandError> {
        Ok(Self {
            path: path.to_owned(),
            scene: load(path)?,
        })
    }

    pub(super) fn has_two_planes(&self) -> bool {
        self.shaft().is_some()
    }

    fn shaft(&self) -> Option<Shaft> {
        self.scene.configured_shaft.or_else(|| self.scene.shaft())
    }

    /// The rotor of both planes, as the supervisor is configured.
    ///
    /// # Errors
    /// [`CommandError`] of a scene that has no two planes with a magnet.
    pub(super) fn two_planes(&self) -> Result<TwoPlanes, CommandError> {
        let both = self.shaft().zip(self.scene.supervised());
        let (shaft, planes) = both.ok_or_else(|| {
            let message = format!(
                "{}: has no two planes with a magnet each",
                self.path.display()
            );
            wrong(
                message,
                "give one log with a scene of one plane, or a scene of two",
            )
        })?;
        Ok(TwoPlanes {
            names: planes.map(|plane| self.scene.planes[plane].name.clone()),
            places: shaft.places,
            mass_kg: shaft.mass_kg.into(),
        })
    }

    /// Of one plane.
    ///
    /// # Errors
    /// [`CommandError`] where it has no supervisor.
    pub(super) fn of_plane(&self, plane: usize) -> Result<Vec<(String, f64)>, CommandError> {
        let mut known = self.parameters(plane, "")?;
        known.push(("spin_sense".to_owned(), 1.0));
        Ok(known)
    }

    /// Of a rotor in two.
    ///
    /// # Errors
    /// As [`Self::of_plane`].
    pub(super) fn of_rotor(&self, of: &TwoPlanes) -> Result<Vec<(String, f64)>, CommandError> {
        let (Some(shaft), Some(planes)) = (self.shaft(), self.scene.supervised()) else {
            return Ok(Vec::new());
        };
        let named = [
            ("mass_kg", f64::from(shaft.mass_kg)),
            (
                "transverse_inertia_kg_m2",
                shaft.transverse_inertia_kg_m2.into(),
            ),
            ("polar_inertia_kg_m2", shaft.polar_inertia_kg_m2.into()),
            ("force_factor_ratio", 1.0),
            ("centre_of_mass_m", 0.0),
            ("sensors_turned_rad", 0.0),
            ("spin_sense", 1.0),
        ];
        let mut known: Vec<(String, f64)> =
            named.map(|(name, value)| (name.to_owned(), value)).to_vec();
        for (plane, name) in planes.into_iter().zip(&of.names) {
            known.extend(self.parameters(plane, &format!("{name}."))?);
            known.push((format!("{name}.force_factor"), 1.0));
            let magnet = self.scene.planes[plane].magnet;
            let magnet = magnet.and_then(|magnet| self.scene.machine.magnets.get(magnet));
            if let Some(magnet) = magnet {
                // What is there beside poles of known gaps: the pull of linear magnets.
                let supports = self.scene.machine.supports.iter();
                let pull_n_m: f64 = supports
                    .filter(|support| support.position_m == magnet.position_m)
                    .map(|support| support.stiffness_n_m.x)
                    .sum();
                let name = format!("{name}.magnet_stiffness_n_m");
                known.push((name, magnet.stiffness_n_m() + pull_n_m));
            }
        }
        Ok(known)
    }

    fn parameters(&self, plane: usize, prefix: &str) -> Result<Vec<(String, f64)>, CommandError> {
        let config = (self.scene.planes.get(plane)).and_then(|plane| plane.supervisor);
        let config = config.ok_or_else(|| {
            let message = format!("{}: plane {plane} has no supervisor", self.path.display());
            wrong(message, "give a scene with a magnet in this plane")
        })?;
        let values = PARAMETERS.iter().zip(config.values());
        let mut known: Vec<(String, f64)> = values
            .map(|(p, value)| (format!("{prefix}{}", p.name), f64::from(value)))
            .collect();
        for (name, value) in [
            // Traces have the command in effect: what is left is the lag.
            ("time_to_force_s", f64::from(config.amplifier_lag_s)),
            ("axes_turned_rad", 0.0),
            ("axes_handedness", 1.0),
        ] {
            known.push((format!("{prefix}{name}"), value));
        }
        Ok(known)
    }
}
