//! The supervisor of a scene by itself, as firmware calls it.

use crate::model::{Model, Set};
use crate::parameters;
use crate::quantities::{of_plane, split_plane};
use crate::supervisor_outputs::TRACE;
use crate::variable::{Kind, Output, Role, Value, Variable};
use firmware_bench::run::trace::SupervisorTrace;
use firmware_bench::scene::Scene;
use supervisor::{
    Command, Config, IntegratorHint, PARAMETERS, RotorSupervisor, Sample, Status, Supervisor,
};

/// Configurations of the planes that have one, with the plane's number in the scene; none where the scene has no supervisor.
fn configs(scene: &Scene) -> Vec<(usize, Config)> {
    let planes = scene.planes.iter().enumerate();
    planes
        .filter_map(|(i, plane)| Some((i, plane.supervisor?)))
        .collect()
}

/// Whether a scene has one.
pub(crate) fn is_in(scene: &Scene) -> bool {
    !configs(scene).is_empty()
}

/// Inputs of a plane, in the order of [`sample`].
const INPUTS: [(&str, &str, &str, Kind); 9] = [
    ("measured_x_m", "m", "position at the sensor", Kind::Float64),
    ("measured_y_m", "m", "the same along y", Kind::Float64),
    ("sequence", "", "counts up by one each sample", Kind::UInt32),
    (
        "status",
        "",
        "bits of what is valid and ready, as of the plant",
        Kind::UInt32,
    ),
    ("spin_reported_rad_s", "rad/s", "spin", Kind::Float64),
    (
        "levitation_x_n",
        "N",
        "force that the levitation controller wants",
        Kind::Float64,
    ),
    ("levitation_y_n", "N", "the same along y", Kind::Float64),
    (
        "applied_x_n",
        "N",
        "what the actuator delivers; counts with bit 4 of status",
        Kind::Float64,
    ),
    ("applied_y_n", "N", "the same along y", Kind::Float64),
];

/// Outputs of a plane that are the command's own; what it says beside numbers follows.
const OUTPUTS: &[Output<Command>] = &[
    ("command_x_n", "N", "force to command", Kind::Float64, |c| {
        Value::Float64(f64::from(c.force_n[0]))
    }),
    ("command_y_n", "N", "the same along y", Kind::Float64, |c| {
        Value::Float64(f64::from(c.force_n[1]))
    }),
    (
        "integrator_hold",
        "",
        "the levitation controller is to keep its integrators",
        Kind::Boolean,
        |c| Value::Boolean(c.integrator == IntegratorHint::Hold),
    ),
    (
        "supervisor_severity",
        "1",
        "severity of what is coming, as a share of what the cap can stop",
        Kind::Float64,
        |c| Value::Float64(f64::from(c.severity)),
    ),
];

/// Its variables but the time.
pub(crate) fn variables(scene: &Scene) -> Vec<Variable> {
    let configs = configs(scene);
    let planes = configs.len();
    let mut all = Vec::new();
    for (plane, config) in &configs {
        all.extend(parameters::of_supervisor(
            config,
            &of_plane(planes, *plane, ""),
        ));
    }
    for (plane, _) in &configs {
        all.extend(INPUTS.iter().map(|(name, unit, about, kind)| {
            let name = of_plane(planes, *plane, name);
            Variable::signal(Role::Input, name, about, unit, *kind)
        }));
    }
    for (plane, _) in &configs {
        let output = |(name, unit, about, kind): (&str, &'static str, &str, Kind)| {
            let name = of_plane(planes, *plane, name);
            Variable::signal(Role::Output, name, about, unit, kind)
        };
        all.extend(OUTPUTS.iter().map(|(n, u, a, k, _)| output((n, u, a, *k))));
        all.extend(TRACE.iter().map(|(n, u, a, k, _)| output((n, u, a, *k))));
    }
    all
}

/// The supervisor before its first sample.
pub(crate) fn start(scene: &Scene, set: &[Set<'_>]) -> Result<Box<dyn Model>, String> {
    let mut configs = configs(scene);
    let only = configs.len() == 1;
    for s in set {
        let (plane, name) = split_plane(s.name);
        let index = PARAMETERS.iter().position(|p| p.name == name);
        let own = configs.iter_mut().find(|(of, _)| only || *of == plane);
        let place = own.map(|(_, config)| config).zip(index);
        let (config, index) = place.ok_or_else(|| format!("{}: is no parameter", s.name))?;
        let mut values = config.values();
        values[index] = s.value.number() as f32;
        *config = Config::from_values(values);
    }
    let configs: Vec<Config> = configs.into_iter().map(|(_, config)| config).collect();
    let commands = vec![Command::default(); configs.len()];
    // As the closed loop has it: one for the whole rotor where the scene has that.
    let of_rotor = match configs.as_slice() {
        [first, second] if scene.supervisor().is_some() => {
            let shaft = scene
                .shaft()
                .ok_or("a supervisor cannot be configured for the rotor")?;
            let rotor = RotorSupervisor::from_planes(&shaft, &[*first, *second]);
            Some(rotor.map_err(|error| error.to_string())?)
        }
        _ => None,
    };
    let supervisors = match of_rotor {
        Some(rotor) => Supervisors::Rotor(Box::new(rotor)),
        None => {
            let each = configs.iter().map(Supervisor::new);
            let all: Result<Vec<_>, _> = each.collect();
            Supervisors::Planes(all.map_err(|error| error.to_string())?)
        }
    };
    Ok(Box::new(Supervision {
        supervisors,
        commands,
    }))
}

enum Supervisors {
    Planes(Vec<Supervisor>),
    Rotor(Box<RotorSupervisor>),
}

struct Supervision {
    supervisors: Supervisors,
    commands: Vec<Command>,
}

/// The sample that inputs of a plane are.
fn sample(inputs: &[Value]) -> Sample {
    let single = |i: usize| inputs.get(i).map_or(0.0, |value| value.number()) as f32;
    let bits = |i: usize| match inputs.get(i) {
        Some(Value::UInt32(bits)) => *bits,
        _ => 0,
    };
    Sample {
        position_m: [single(0), single(1)],
        sequence: bits(2),
        status: Status::from_bits_retain(bits(3)),
        spin_rad_s: single(4),
        levitation_n: [single(5), single(6)],
        applied_n: [single(7), single(8)],
    }
}

impl Model for Supervision {
    fn step(&mut self, inputs: &[Value]) -> Result<bool, String> {
        let samples: Vec<Sample> = inputs.chunks_exact(INPUTS.len()).map(sample).collect();
        let before: Vec<_> = self.commands.iter().map(|c| c.mode).collect();
        match (&mut self.supervisors, samples.as_slice()) {
            (Supervisors::Rotor(rotor), [first, second]) => {
                self.commands = rotor.tick(&[*first, *second]).planes.to_vec();
            }
            (Supervisors::Planes(all), samples) => {
                let ticks = all.iter_mut().zip(samples);
                self.commands = ticks.map(|(one, sample)| one.tick(sample)).collect();
            }
            (Supervisors::Rotor(_), _) => return Err("a rotor has two planes".to_owned()),
        }
        Ok(self.commands.iter().map(|c| c.mode).ne(before))
    }

    fn outputs(&self, into: &mut Vec<Value>) {
        for command in &self.commands {
            into.extend(OUTPUTS.iter().map(|(.., value)| value(command)));
            // No output says what the levitation controller asked for: that is an input.
            let trace = SupervisorTrace::new(command, [0.0; 2]);
            into.extend(TRACE.iter().map(|(.., value)| value(&trace)));
        }
    }

    fn tune(&mut self, name: &str, _value: f64) -> Result<(), String> {
        Err(format!("{name} is not tunable"))
    }

    fn trusted(&self) -> Result<(), String> {
        Ok(())
    }
}
