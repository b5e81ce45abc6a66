//! The plant with its instruments: sensor, amplifier, loads and faults of a scene, driven by whoever sets its commands.

use crate::model::{Model, Set};
use crate::parameters;
use crate::quantities::of_plane;
use crate::rows::{Of, Rows};
use crate::variable::{Kind, Role, Value, Variable};
use firmware_bench::run::closed_loop::RunError;
use firmware_bench::run::closed_loop::stepwise::{Driver, Stepwise};
use firmware_bench::scene::Scene;
use firmware_bench::scene::spec::Spec;
use plant_model::V2;

/// Planes whose magnet can be commanded.
fn magnets(scene: &Scene) -> Vec<bool> {
    scene.planes.iter().map(|p| p.magnet.is_some()).collect()
}

/// Its variables but the time: parameters, inputs, outputs.
pub(crate) fn variables(spec: &Spec, scene: &Scene) -> Vec<Variable> {
    let mut all = parameters::of_scene(spec);
    let magnets = magnets(scene);
    let planes = magnets.len();
    let mut input = |name: String, about: &str| {
        let signal = Variable::signal(Role::Input, name, about, "N", Kind::Float64);
        all.push(signal);
    };
    let of_magnet = (0..planes).filter(|plane| magnets[*plane]);
    for plane in of_magnet {
        for axis in ["x", "y"] {
            let name = of_plane(planes, plane, &format!("command_{axis}_n"));
            input(
                name,
                "force that the controller commands, in effect after the amplifier's delay",
            );
        }
    }
    for axis in ["x", "y"].into_iter().filter(|_| scene.takes_push()) {
        let about =
            "force on the rotor's centre of mass beside the scene's loads, held over the step";
        input(format!("load_{axis}_n"), about);
    }
    all.extend(Rows::new(Of::Plant).variables(planes));
    all
}

/// The plant at its first sample.
pub(crate) fn start(spec: &Spec, set: &[Set<'_>]) -> Result<Box<dyn Model>, String> {
    let scene = parameters::scene(spec, set)?;
    let magnets = magnets(&scene);
    let stepwise = Stepwise::new(scene, Driver::Caller).map_err(|error| error.to_string())?;
    Ok(Box::new(Plant {
        stepwise,
        magnets,
        rows: Rows::new(Of::Plant),
    }))
}

struct Plant {
    stepwise: Stepwise,
    magnets: Vec<bool>,
    rows: Rows,
}

impl Model for Plant {
    fn step(&mut self, inputs: &[Value]) -> Result<bool, String> {
        let mut pairs = inputs.chunks_exact(2).map(|pair| {
            let [x, y] = [pair[0].number(), pair[1].number()];
            V2::new(x, y)
        });
        for plane in (0..self.magnets.len()).filter(|plane| self.magnets[*plane]) {
            if let Some(force_n) = pairs.next() {
                self.stepwise.command(plane, force_n);
            }
        }
        if let Some(force_n) = pairs.next() {
            if !force_n.iter().all(|x| x.is_finite()) {
                return Err(format!(
                    "load_x_n, load_y_n: {}, {} is no force",
                    force_n.x, force_n.y
                ));
            }
            self.stepwise.push(force_n);
        }
        self.stepwise.advance().map_err(|error| match error {
            // Nobody's policy is at fault.
            RunError::Plant { reason, .. } => reason.to_string(),
            error => error.to_string(),
        })
    }

    fn outputs(&self, into: &mut Vec<Value>) {
        self.rows.values(&self.stepwise, into);
    }

    fn tune(&mut self, name: &str, value: f64) -> Result<(), String> {
        tune(&mut self.stepwise, name, value)
    }

    fn trusted(&self) -> Result<(), String> {
        self.stepwise.trusted().map_err(|error| error.to_string())
    }
}

/// Another value of a parameter of the plant from now on.
pub(crate) fn tune(stepwise: &mut Stepwise, name: &str, value: f64) -> Result<(), String> {
    match parameters::change(name, value) {
        Some(change) => (stepwise.change(&change)).map_err(|error| error.to_string()),
        None => Err(format!("{name} is not tunable")),
    }
}
