//! The plan: classes, each on the same machines.

use super::configured::{AS_IT_IS, Configured};
use super::events::{BEGIN_S, Event, Point, Written};
use super::machines::{MachineClass, Model};
use super::pair::{Goal, HOLDS_S, NoPair, Tried, is_held, pair, remark};
use super::row::{ClassName, Row};
use super::sensors::Sensors;
use crate::campaign::{Progress, run_all};
use crate::machines::draw::Draw;
use firmware_bench::scene::Scene;
use firmware_bench::scene::spec::Spec;

/// A class: a place on every axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Class {
    /// Class of the machines.
    pub machine: MachineClass,
    /// What happens.
    pub event: Event,
    /// How the sensors are.
    pub sensors: Sensors,
    /// What the supervisor is configured with.
    pub configured: Configured,
}

/// The classes that some machines, events, sensors and configurations make.
#[derive(Debug, Clone)]
pub struct Axes<'a> {
    /// Classes of machines.
    pub machines: &'a [MachineClass],
    /// What happens.
    pub events: Vec<Event>,
    /// How the sensors are.
    pub sensors: &'a [Sensors],
    /// What the supervisor is configured with.
    pub configured: &'a [Configured],
}

impl Axes<'_> {
    /// Events on machines, everything else as it should be.
    pub fn new(machines: &[MachineClass], events: Vec<Event>) -> Axes<'_> {
        Axes {
            machines,
            events,
            sensors: &[Sensors::AsConfigured],
            configured: &[AS_IT_IS],
        }
    }

    /// Their classes.
    pub fn classes(&self) -> Vec<Class> {
        let mut classes = Vec::new();
        for machine in self.machines {
            for event in &self.events {
                for sensors in self.sensors {
                    classes.extend(self.configured.iter().map(|configured| Class {
                        machine: *machine,
                        event: *event,
                        sensors: *sensors,
                        configured: *configured,
                    }));
                }
            }
        }
        classes
    }
}

impl Class {
    /// Point masses, configured as they are.
    pub fn of_point_masses(event: Point, sensors: Sensors) -> Self {
        Self {
            machine: MachineClass::PointMass,
            event: Event::Point(event),
            sensors,
            configured: AS_IT_IS,
        }
    }

    /// Its place on every axis, in words.
    pub fn name(&self) -> ClassName {
        ClassName {
            machine: self.machine.name().to_owned(),
            event: self.event.name(),
            sensors: self.sensors.name(),
            configuration: self.configured.name.to_owned(),
        }
    }

    /// Whether sensors and configuration are as they should be.
    pub(crate) fn is_sound(&self) -> bool {
        self.sensors == Sensors::AsConfigured && self.configured == AS_IT_IS
    }

    /// The scene of a number.
    ///
    /// # Errors
    /// Why there is none: a mistake of the draw.
    pub fn scene(&self, seed: u64, number: u64) -> Result<(Scene, Goal), String> {
        let machine = self.machine.machine(seed, number)?;
        let mut draw = Draw::new(seed ^ OF_EVENTS, number);
        let noise = draw.number();
        let (mut scene, goal) = match (self.event, &machine) {
            (Event::Written(event), _) => written(&machine, event, &mut draw)?,
            (Event::Point(event), Model::PointMass(machine)) => {
                let mut scene = machine.scene.clone();
                event.happen(machine, &mut draw, &mut scene);
                (scene, Goal::Free)
            }
            (Event::Point(_), Model::Rotor(_)) => return Err("event of a point mass".to_owned()),
        };
        scene.title = format!("{}, {}", self.name().text(false), machine.text());
        self.configured.apply_to_all(&mut scene);
        let with_magnet: Vec<usize> = (0..scene.planes.len())
            .filter(|plane| !scene.planes[*plane].seal)
            .collect();
        for (plane, plane_number) in with_magnet.into_iter().zip(0_u64..) {
            scene.planes[plane].seed = noise.wrapping_add(plane_number << 32);
            self.sensors.apply(&mut draw, &mut scene, plane);
            self.configured.apply(&mut scene.planes[plane], &mut draw);
        }
        Ok((scene, goal))
    }
}

/// Sets the draw of what happens apart from that of the machine.
const OF_EVENTS: u64 = 0x5eed;

/// The scene of a machine with an event that is written as keys.
fn written(machine: &Model, event: Written, draw: &mut Draw) -> Result<(Scene, Goal), String> {
    let measures = machine.measures();
    let keys = event.keys(&measures, draw);
    let error = |error: firmware_bench::scene::diagnostic::SceneError| error.to_string();
    let text = machine.toml() + &keys.tables;
    let mut spec = Spec::parse(&machine.text(), &text)
        .map_err(error)?
        .without_warnings();
    let after_s = if measures.whole.is_some() { 0.5 } else { 0.25 };
    spec.set("run.duration_s", keys.end_s + after_s)
        .map_err(error)?;
    for (key, value) in keys.set {
        spec.set(&key, value).map_err(error)?;
    }
    Ok((spec.resolve().map_err(error)?, keys.goal))
}

/// A pair of runs.
#[derive(Debug, Clone)]
pub struct Case {
    pub class: Class,
    /// Number of its machine.
    pub number: u64,
    /// Whether levitation alone holds the machine with nothing happening.
    pub held: bool,
    /// What came out.
    pub tried: Tried,
}

impl Case {
    /// What a list says of it.
    pub fn remark(&self, seed: u64) -> Option<String> {
        let what = remark(&self.tried)?;
        let machine = self.class.machine.machine(seed, self.number).ok()?;
        let class = self.class.name().text(false);
        Some(format!("{what}: {}; {class}", machine.text()))
    }
}

/// What will be run.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Seed of the draw.
    pub seed: u64,
    /// Machines of each class.
    pub machines: u64,
    pub classes: Vec<Class>,
}

impl Plan {
    /// Runs it on the threads of the pool that it is called in; what comes out, by class, does not depend on how many.
    pub fn run(&self, progress: &dyn Progress) -> Vec<Case> {
        let mut kinds: Vec<MachineClass> = Vec::new();
        for class in &self.classes {
            if matches!(class.machine, MachineClass::Rotor(_)) && !kinds.contains(&class.machine) {
                kinds.push(class.machine);
            }
        }
        let of = |kind: &MachineClass| (0..self.machines).map(|n| (*kind, n)).collect::<Vec<_>>();
        let rotors: Vec<(MachineClass, u64)> = kinds.iter().flat_map(of).collect();
        let held = run_all(&rotors, progress, |(kind, number)| {
            self.holds(*kind, *number)
        });
        let is_held = |class: &Class, number: u64| {
            let place = (rotors.iter()).position(|rotor| *rotor == (class.machine, number));
            place.is_none_or(|place| held[place])
        };
        let mut jobs = Vec::new();
        for class in &self.classes {
            jobs.extend((0..self.machines).map(|n| (*class, n, is_held(class, n))));
        }
        run_all(&jobs, progress, |(class, number, held)| Case {
            class: *class,
            number: *number,
            held: *held,
            tried: (class.scene(self.seed, *number))
                .map_err(NoPair::Untrusted)
                .and_then(|(scene, goal)| pair(&scene, goal)),
        })
    }

    fn holds(&self, kind: MachineClass, number: u64) -> bool {
        let idle = || {
            let machine = kind.machine(self.seed, number)?;
            let mut draw = Draw::new(self.seed, number);
            written(&machine, Written::Idle, &mut draw)
        };
        idle().is_ok_and(|(mut scene, _)| {
            scene.duration_s = HOLDS_S + BEGIN_S;
            is_held(&scene)
        })
    }
}

/// The row of some cases, under a name.
pub(crate) fn row_of<'a>(class: ClassName, cases: impl Iterator<Item = &'a Case>) -> Row {
    Row::new(class, cases.map(|case| (case.number, &case.tried)))
}

/// A row for each class, in the order of the cases, of machines that levitation alone holds.
pub fn rows(cases: &[Case]) -> Vec<Row> {
    let of_one_class = |a: &Case, b: &Case| a.class == b.class;
    let row = |class: &[Case]| {
        let name = class.first()?.class.name();
        Some(row_of(name, class.iter().filter(|case| case.held)))
    };
    cases.chunk_by(of_one_class).filter_map(row).collect()
}
