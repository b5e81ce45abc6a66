//! The plan: every event with every kind of sensors, each on the same machines.

use super::compared::{Pair, compare};
use super::conditions::Condition;
use super::events::Event;
use crate::campaign::{Progress, run_all};
use crate::machines::draw::Draw;
use crate::machines::drawn::Machine;
use firmware_bench::scene::Scene;

/// A run of the study, both ways.
#[derive(Debug, Clone)]
pub struct Run {
    /// What happened.
    pub event: Event,
    /// What the sensors were.
    pub condition: Condition,
    /// Number of the machine.
    pub number: u64,
    /// What came of it; `None` where it cannot be trusted.
    pub pair: Option<Pair>,
}

/// Sets the draw of what happens apart from that of the machine.
const OF_EVENTS: u64 = 0x5eed;

/// The scene of a run, and its machine.
pub fn scene(seed: u64, (event, condition): (Event, Condition), number: u64) -> (Machine, Scene) {
    let machine = Machine::drawn(seed, number)
        .unwrap_or_else(|error| unreachable!("machine {number} of {seed}: {error}"));
    let mut scene = machine.scene.clone();
    let mut draw = Draw::new(seed ^ OF_EVENTS, number);
    scene.seed = draw.number();
    event.happen(&machine, &mut draw, &mut scene);
    condition.apply(&machine, &mut draw, &mut scene);
    let of = &machine.scene.title;
    scene.title = format!("{}, {}, {of}", event.name(), condition.name());
    (machine, scene)
}

/// What will be run.
#[derive(Debug, Clone)]
pub struct Plan {
    seed: u64,
    jobs: Vec<(Event, Condition, u64)>,
}

impl Plan {
    /// Events with sensors on so many machines.
    pub fn new(seed: u64, machines: u64, events: &[Event], conditions: &[Condition]) -> Self {
        let mut jobs = Vec::new();
        for event in events {
            for condition in conditions {
                jobs.extend((0..machines).map(|number| (*event, *condition, number)));
            }
        }
        Self { seed, jobs }
    }

    /// Runs them on the threads of the pool that it is called in; what comes out does not depend on how many.
    pub fn run(&self, progress: &dyn Progress) -> Vec<Run> {
        run_all(&self.jobs, progress, |(event, condition, number)| {
            let (_, scene) = scene(self.seed, (*event, *condition), *number);
            Run {
                event: *event,
                condition: *condition,
                number: *number,
                pair: compare(&scene),
            }
        })
    }
}
