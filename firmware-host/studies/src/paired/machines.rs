//! Classes of machines.

use super::written_events::{Measures, Whole};
use crate::machines::random::RandomMachine;
use crate::machines::rotors::{Class, RotorCase};

/// A class of machines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MachineClass {
    /// A point mass in one plane.
    PointMass,
    /// The same on a mount that gives way.
    ResilientMount,
    /// A rotor in two bearings.
    Rotor(Class),
}

/// A machine of a number.
#[derive(Debug, Clone)]
pub enum Model {
    /// In one plane.
    PointMass(Box<RandomMachine>),
    /// In two.
    Rotor(Box<RotorCase>),
}

impl MachineClass {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::PointMass => "point mass",
            Self::ResilientMount => "point mass on a resilient mount",
            Self::Rotor(class) => class.name(),
        }
    }

    /// The machine of a number.
    ///
    /// # Errors
    /// A machine that is no valid scene: a mistake of the draw.
    pub fn machine(self, seed: u64, number: u64) -> Result<Model, String> {
        let of = |machine: RandomMachine| Model::PointMass(Box::new(machine));
        match self {
            Self::PointMass => RandomMachine::sampled(seed, number).map(of),
            Self::ResilientMount => RandomMachine::resilient(seed, number).map(of),
            Self::Rotor(class) => Ok(Model::Rotor(Box::new(RotorCase::new(seed, class, number)))),
        }
        .map_err(|error| error.to_string())
    }
}

impl Model {
    /// Its scene file, in which nothing happens.
    pub fn toml(&self) -> String {
        match self {
            Self::PointMass(machine) => machine.toml.clone(),
            Self::Rotor(rotor) => rotor.toml(),
        }
    }

    /// In a line.
    pub fn text(&self) -> String {
        match self {
            Self::PointMass(machine) => machine.text.clone(),
            Self::Rotor(rotor) => rotor.text(),
        }
    }

    /// What events are measured by.
    pub fn measures(&self) -> Measures {
        match self {
            Self::PointMass(machine) => {
                let scene = &machine.scene;
                let plane = &scene.planes[0];
                Measures {
                    mass_kg: scene.machine.rotor.rigid().mass_kg,
                    clearance_m: machine.clearance_m(),
                    force_n: machine.force_n(),
                    spin_hz: scene.start.spin_rad_s / std::f64::consts::TAU,
                    proportional_n_m: plane.levitation.map_or(0.0, |l| l.proportional_n_m),
                    weighs: plane.weight_n.norm() > 0.0,
                    whole: None,
                }
            }
            Self::Rotor(rotor) => {
                let of = rotor.measures();
                Measures {
                    mass_kg: of.mass_kg,
                    clearance_m: of.clearance_m,
                    force_n: of.force_n,
                    spin_hz: of.spin_hz,
                    proportional_n_m: of.proportional_n_m,
                    weighs: false,
                    whole: Some(Whole {
                        ends_m: of.ends_m,
                        transverse_kg_m2: of.transverse_kg_m2,
                    }),
                }
            }
        }
    }
}
