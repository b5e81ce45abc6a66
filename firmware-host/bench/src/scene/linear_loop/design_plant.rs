//! What a controller is designed for, to take away: machine, magnets and sensors without the controller.

use super::{NoLoop, OpenLoop, axes};
use crate::scene::Scene;
use crate::scene::arrays::npz;
use nalgebra::DMatrix;
use serde::Serialize;
use std::io;

/// From commands to readings at a spin: A, B, C, D of ẋ = A·x + B·u, y = C·x + D·u, and of the same as firmware has it.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignPlant {
    /// In continuous time, at once and with the position as it is.
    pub continuous: [DMatrix<f64>; 4],
    /// From sample to sample, with the delays of commands and readings.
    pub sampled: [DMatrix<f64>; 4],
    /// What is what.
    pub names: PlantNames,
}

/// What is what in a [`DesignPlant`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlantNames {
    /// Title of the scene.
    pub scene: String,
    /// \[rad/s\].
    pub spin_rad_s: f64,
    /// \[s\].
    pub sample_period_s: f64,
    /// Forces that are commanded \[N\], along the axes of their magnets.
    pub inputs_n: Vec<String>,
    /// Positions as they are read \[m\], along the axes of their sensors.
    pub outputs_m: Vec<String>,
    /// States in continuous time …
    pub states: Vec<String>,
    /// … and their units; positions are in coordinates of unit mass.
    pub state_units: Vec<&'static str>,
}

impl DesignPlant {
    /// Of a scene at a spin \[rad/s\].
    ///
    /// # Errors
    /// [`NoLoop::NoController`] without a magnet, [`NoLoop::Machine`].
    pub fn new(scene: &Scene, spin_rad_s: f64) -> Result<Self, NoLoop> {
        let open = OpenLoop::new(scene, spin_rad_s)?;
        if open.inputs.ncols() == 0 {
            return Err(NoLoop::NoController);
        }
        let sampled = open.sampled;
        let plant = open
            .plant
            .in_units(&open.inputs, &(open.read * open.sensors));
        let states = plant.states.iter();
        let names = PlantNames {
            scene: scene.title.clone(),
            spin_rad_s,
            sample_period_s: 1.0 / scene.sample_rate_hz,
            inputs_n: axes(scene, |plane| plane.magnet.is_some()),
            outputs_m: axes(scene, |_| true),
            states: states.clone().map(|state| state.name.clone()).collect(),
            state_units: states.map(|state| state.unit).collect(),
        };
        let d = DMatrix::zeros(plant.c.nrows(), plant.b.ncols());
        Ok(Self {
            continuous: [plant.a, plant.b, plant.c, d],
            sampled: [sampled.a, sampled.b, sampled.c, sampled.d],
            names,
        })
    }

    /// As an `.npz` file: A, B, C, D, of the sampled one Ad, Bd, Cd, Dd, and `names.json`.
    ///
    /// # Errors
    /// Those of writing to memory.
    pub fn npz(&self) -> io::Result<Vec<u8>> {
        let names = serde_json::to_string_pretty(&self.names)?;
        npz(self.arrays(), &[("names.json", &names)])
    }

    /// Every matrix by its name.
    pub fn arrays(&self) -> impl Iterator<Item = (&'static str, &DMatrix<f64>)> {
        let continuous = ["A", "B", "C", "D"].into_iter().zip(&self.continuous);
        continuous.chain(["Ad", "Bd", "Cd", "Dd"].into_iter().zip(&self.sampled))
    }
}
