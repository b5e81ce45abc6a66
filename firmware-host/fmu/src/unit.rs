//! The three units of a scene.

use crate::model::{Model, Set};
use crate::variable::{Kind, Role, Variable};
use crate::{closed_loop, plant, supervision};
use firmware_bench::scene::Scene;
use firmware_bench::scene::spec::Spec;

/// Which version of the interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    Fmi3,
    Fmi2,
}

/// Which unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The plant with its instruments.
    Plant,
    Supervisor,
    ClosedLoop,
}

impl Which {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Plant, Self::Supervisor, Self::ClosedLoop];

    /// Its name: that of its file, and the identifier of its model.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plant => "plant",
            Self::Supervisor => "supervisor",
            Self::ClosedLoop => "closed_loop",
        }
    }

    /// What it is.
    pub(crate) fn about(self) -> &'static str {
        match self {
            Self::Plant => "the rotor in its bearings, with sensors and amplifiers",
            Self::Supervisor => "the supervisor, as firmware calls it at every control sample",
            Self::ClosedLoop => "the rotor in closed loop under one of the scene's policies",
        }
    }
}

/// A unit of a scene.
#[derive(Debug)]
pub struct Unit {
    which: Which,
    spec: Spec,
    scene: Scene,
}

impl Unit {
    /// A unit of the scene that a file describes; `None` of a supervisor where the scene has none.
    ///
    /// # Errors
    /// What is wrong with the scene.
    pub fn new(
        which: Which,
        spec: Spec,
    ) -> Result<Option<Self>, firmware_bench::scene::diagnostic::SceneError> {
        let scene = spec.resolve()?;
        let there = which != Which::Supervisor || supervision::is_in(&scene);
        Ok(there.then_some(Self { which, spec, scene }))
    }

    pub fn which(&self) -> Which {
        self.which
    }

    /// What it is of.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// From one control sample to the next \[s\].
    pub fn period_s(&self) -> f64 {
        1.0 / self.scene.sample_rate_hz
    }

    /// Whether one step may be several control samples long: not where each needs inputs of its own.
    pub fn takes_several_samples(&self) -> bool {
        self.which != Which::Supervisor
    }

    /// Its variables; their places in the list are their value references. The time is the first, then come parameters, inputs
    /// and outputs.
    pub fn variables(&self) -> Vec<Variable> {
        let time = Variable::signal(Role::Time, "time".to_owned(), "", "s", Kind::Float64);
        let (spec, scene) = (&self.spec, &self.scene);
        let own = match self.which {
            Which::Plant => plant::variables(spec, scene),
            Which::Supervisor => supervision::variables(scene),
            Which::ClosedLoop => closed_loop::variables(spec, scene),
        };
        std::iter::once(time).chain(own).collect()
    }

    /// Its model at the start, with parameters that are set to other values than they have.
    ///
    /// # Errors
    /// Why there is none.
    pub fn start(&self, set: &[Set<'_>]) -> Result<Box<dyn Model>, String> {
        match self.which {
            Which::Plant => plant::start(&self.spec, set),
            Which::Supervisor => supervision::start(&self.scene, set),
            Which::ClosedLoop => closed_loop::start(&self.spec, &self.scene, set),
        }
    }
}
