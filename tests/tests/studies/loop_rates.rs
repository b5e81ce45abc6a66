//! What a slower call of the supervisor costs: the impacts and whirls it recovers from, by the rate of the loop.

use firmware_bench::run::controller::{Policy, Supervise};
use firmware_bench::scene::Scene;
use firmware_studies::overloads::found::{Found, kept};
use firmware_studies::overloads::impact::recoverable_m_s;
use firmware_studies::overloads::plants::{PlantCase, RATES_HZ, plants};
use firmware_studies::overloads::seats::Seat;
use firmware_studies::overloads::sweeps::{SweepPoint, SweepRow, median, row, sweep};
use firmware_studies::overloads::tune;
use rayon::prelude::*;
use supervisor::{Command, Config, Mode, Sample, Supervisor};
use system_tests::unseen::Compared;

/// Gains tuned at this rate, as the catalogue tunes them; laws of the reference have no part in this.
fn found(case: &PlantCase) -> Found {
    let mut found = kept(&case.name, RATES_HZ[1]).expect("the catalogue keeps all of its plants");
    let tuned = tune::tuned(&case.scene).expect("a run that can be trusted");
    found.tuned = tuned.expect("a loop that meets the limits");
    found
}

fn plant(name: &str, rate_hz: f64) -> PlantCase {
    let cases = plants(rate_hz).expect("the catalogue's plants are valid");
    let case = cases.into_iter().find(|case| case.name == name);
    case.expect("one of the catalogue's")
}

fn swept(case: &PlantCase, seat: Seat, seeds: u64) -> SweepRow {
    let found = found(case);
    let points: Vec<SweepPoint> = (1..=seeds)
        .map(|seed| sweep(case, &found, (seat, seed)).expect("a run that can be trusted"))
        .collect();
    row(case, seat, &points)
}

/// Medians of impact [m/s] and whirl (share of v_lim) of a plant under tuned levitation and under the supervisor.
#[derive(Debug)]
struct Recovered {
    tuned: [f64; 2],
    own: [f64; 2],
}

fn recovered(name: &str, rate_hz: f64, seeds: u64) -> Recovered {
    let case = plant(name, rate_hz);
    let [tuned, own] = [Seat::Tuned, Seat::Supervisor].map(|seat| {
        let row = swept(&case, seat, seeds);
        [median(&row.impact_m_s), median(&row.whirl_share)]
    });
    Recovered { tuned, own }
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
    let config = slow.supervisor.expect("the catalogue's have one");
    let make = |scene: &Scene| {
        let mut scene = scene.clone();
        scene.levitation = kept(name, 2e4).map(|found| found.tuned);
        Policy::supervised(&scene, Box::new(InSlowerTask::new(&config, times)))
    };
    recoverable_m_s(&quick, "slower task", &make).expect("a run that can be trusted")
}

/// It recovers from what it does in a loop of its own rate, give or take a step of the grid of 5 %.
#[test]
fn in_a_slower_task_it_does_what_it_does_in_a_slower_loop() {
    for (plant, times) in ["P1 150 N", "P2", "P4"]
        .into_iter()
        .flat_map(|p| [(p, 2), (p, 4)])
    {
        let slow_hz = 2e4 / f64::from(times);
        let task = in_slower_task(plant, times);
        let slow = recovered(plant, slow_hz, 1).own[0];
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
    let [slow, usual] = [5e3, 2e4].map(|rate_hz| recovered("P2", rate_hz, 1));
    for (slow, usual) in slow.own.into_iter().zip(usual.tuned) {
        assert!(slow > 1.02 * usual, "{slow} of {usual}");
    }
}

/// The table of the documentation: impacts are on a grid of 5 %, whirls on one of 0.01.
#[test]
#[ignore = "a minute; the figures are in docs/src/supervisor/targets.md"]
fn impact_and_whirl_by_rate() {
    const RATES_HZ: [f64; 4] = [5e3, 1e4, 2e4, 5e4];
    let names: Vec<String> = (plants(RATES_HZ[0]).expect("the catalogue's plants are valid"))
        .into_iter()
        .map(|case| case.name)
        .collect();
    let rows: Vec<(String, [Recovered; 4])> = (names.into_par_iter())
        .map(|name| {
            let row = RATES_HZ.map(|rate_hz| recovered(&name, rate_hz, 3));
            (name, row)
        })
        .collect();
    for (name, [slow, half, usual, quick]) in &rows {
        println!("{name}: {:?}", [slow, half, usual, quick]);
        let over = |of: &Recovered| of.own[0] / usual.own[0];
        assert!((0.78..=1.0).contains(&over(slow)), "{name}: {}", over(slow));
        assert!((0.90..=1.0).contains(&over(half)), "{name}: {}", over(half));
        assert!(
            (1.0..=1.06).contains(&over(quick)),
            "{name}: {}",
            over(quick)
        );
        assert!(
            slow.own[0] >= usual.tuned[0],
            "{name}: below levitation at 20 kHz"
        );
    }
}

/// The catalogue's scenes with sound sensors at a rate.
fn scenes(rate_hz: f64) -> Compared {
    let all = plants(rate_hz).expect("the catalogue's plants are valid");
    (all.par_iter()
        .map(|case| Compared::on(case, &found(case), &case.name)))
    .reduce(Compared::default, Compared::with)
}

/// Half of the rate costs next to no scene, and a quarter of it a few; more with levitation alone.
#[test]
#[ignore = "half a minute; the figures are in docs/src/supervisor/targets.md"]
fn scenes_by_rate() {
    let [slow, half, usual] = [5e3, 1e4, 2e4].map(scenes);
    println!("{:?}", [&slow, &half, &usual]);
    assert!(usual.lost.is_empty() && half.lost.is_empty() && slow.lost.len() <= 1);
    assert!(100 * half.own > 99 * usual.own && half.own <= usual.own);
    assert!(100 * slow.own > 95 * usual.own && slow.own > slow.alone + 20);
}
