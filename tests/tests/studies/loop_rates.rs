//! What a slower call of the supervisor costs: the impacts and whirls it recovers from, by the rate of the loop.

use firmware_bench::run::controller::{Supervise, supervised};
use firmware_bench::scene::Scene;
use firmware_studies::loop_rates::{self, Recovered};
use firmware_studies::machines::plants::{PlantCase, plants};
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::impact::recoverable_m_s;
use supervisor::{Command, Config, Mode, Sample, Supervisor};

fn plant(name: &str, rate_hz: f64) -> PlantCase {
    let cases = plants(rate_hz).expect("the catalogue's plants are valid");
    let case = cases.into_iter().find(|case| case.name == name);
    case.expect("one of the catalogue's")
}

fn recovered(name: &str, rate_hz: f64) -> Recovered {
    loop_rates::recovered(&plant(name, rate_hz), 1).expect("runs that can be trusted")
}

/// The supervisor in a task that is so many times slower than the loop, as the chapter on linking tells it: it has a whole
/// period of its own for a tick, whose command the loop takes over at the next. Between ticks the loop holds the force, or
/// lets the levitation controller through while that has the bearing.
#[derive(Debug)]
struct InSlowerTask {
    supervisor: Supervisor,
    times: u32,
    /// Of the tick that is under way.
    coming: Command,
    /// Of the one before: what the loop acts by.
    current: Command,
}

impl InSlowerTask {
    fn new(config: &Config, times: u32) -> Self {
        let idle = Command::default();
        Self {
            supervisor: Supervisor::new(config).expect("the catalogue's are valid"),
            times,
            coming: idle,
            current: idle,
        }
    }
}

impl Supervise for InSlowerTask {
    fn tick(&mut self, sample: &Sample) -> Command {
        if sample.sequence.is_multiple_of(self.times) {
            let sequence = sample.sequence / self.times;
            let coming = (self.supervisor).tick(&Sample {
                sequence,
                ..*sample
            });
            self.coming = coming;
        }
        // The loop's own delay is one sample: the force acts from the next tick of the slower task on.
        if (sample.sequence + 1).is_multiple_of(self.times) {
            self.current = self.coming;
        }
        let force_n = match self.current.mode {
            Mode::Levitated => sample.levitation_n,
            _ => self.current.force_n,
        };
        Command {
            force_n,
            ..self.current
        }
    }
}

/// Hardest impact with the supervisor in a task that is so many times slower than its loop of 20 kHz [m/s].
fn in_slower_task(name: &str, times: u32) -> f64 {
    let [slow, quick] = [2e4 / f64::from(times), 2e4].map(|rate_hz| plant(name, rate_hz).scene);
    let config = slow.planes[0].supervisor.expect("the catalogue's have one");
    let make = |scene: &Scene| {
        let mut scene = scene.clone();
        scene.planes[0].levitation = stored(name, 2e4).map(|found| found.tuned);
        supervised(&scene, Box::new(InSlowerTask::new(&config, times)))
    };
    recoverable_m_s(&quick, "slower task", &make).expect("a run that can be trusted")
}

/// The same in a loop of its own rate, one for which gains are stored.
fn in_slower_loop(name: &str, rate_hz: f64) -> f64 {
    let make = |scene: &Scene| {
        let mut scene = scene.clone();
        scene.planes[0].levitation = stored(name, rate_hz).map(|found| found.tuned);
        let config = scene.planes[0].supervisor?;
        let own: Supervisor = Supervisor::new(&config).ok()?;
        supervised(&scene, Box::new(own))
    };
    let slow = plant(name, rate_hz).scene;
    recoverable_m_s(&slow, "slower loop", &make).expect("a run that can be trusted")
}

/// It recovers from what it does in a loop of its own rate, give or take a step of the grid of 5 %. At a quarter of the rate,
/// for which gains have to be searched, on one plant.
#[test]
fn in_a_slower_task_it_does_what_it_does_in_a_slower_loop() {
    for (plant, times) in [("P1 150 N", 2), ("P2", 2), ("P2", 4), ("P4", 2)] {
        let slow_hz = 2e4 / f64::from(times);
        let task = in_slower_task(plant, times);
        let slow = if times == 2 {
            in_slower_loop(plant, slow_hz)
        } else {
            recovered(plant, slow_hz).own[0]
        };
        println!("{plant}, {slow_hz} Hz: {task} m/s, in a loop of this rate {slow} m/s");
        assert!(
            (0.94..1.06).contains(&(task / slow)),
            "{plant}: {task} of {slow}"
        );
    }
}

/// A supervisor that is called at a quarter of the rate recovers from at least what levitation does at the whole of it.
#[test]
fn at_5_khz_it_is_worth_more_than_the_best_controller_at_20_khz() {
    let [slow, usual] = [5e3, 2e4].map(|rate_hz| recovered("P2", rate_hz));
    for (slow, usual) in slow.own.into_iter().zip(usual.tuned) {
        assert!(slow > 1.02 * usual, "{slow} of {usual}");
    }
}
