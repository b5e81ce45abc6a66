//! Scenes of the catalogue with the supervisor on an emulated processor, held against the host alone.

use super::images::Project;
use super::link::{Board, Emulated};
use super::machines::Machine;
use super::measure::TargetError;
use super::results::LoopRow;
use super::tick_log::{Recording, Tick, TickLog};
use crate::machines::plants::{RATES_HZ, plants};
use crate::machines::tuned_gains::stored;
use crate::overloads::catalogue::cases;
use firmware_bench::run::closed_loop::{Keep, RunError, run_policy};
use firmware_bench::run::controller::{Supervise, supervised};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_image::under_test::Float;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;
use supervisor::Config;
use tempfile::TempDir;

/// The plant of the catalogue.
const PLANT: &str = "P1 150 N";
/// Its scenes: impact, established whirl, and a load that is too much.
const SCENES: [&str; 3] = [
    "impact +30°, 1 v_ref",
    "whirl at take-over, 0.5 v_lim",
    "load 1.2 × cap for 50 ms",
];
/// What comes later repeats itself \[s\].
const LASTS_S: f64 = 0.1;

/// The scenes by name.
///
/// # Errors
/// [`TargetError`] if the catalogue is not valid or has none of that name.
fn scenes() -> Result<Vec<(String, Scene, Config)>, TargetError> {
    let [_, rate_hz] = RATES_HZ;
    let none = |name: &str| TargetError::NoScene(format!("{PLANT}, {name}"));
    let all = plants(rate_hz).map_err(|e| TargetError::Catalogue(e.into()))?;
    let plant = all
        .iter()
        .find(|p| p.name == PLANT)
        .ok_or_else(|| none("any"))?;
    let found = stored(PLANT, rate_hz).ok_or_else(|| none("what was found for it"))?;
    let cases = cases(plant, found.tuned);
    (SCENES.iter())
        .map(|name| {
            let case = cases.iter().find(|c| c.name == *name);
            let mut scene = case.ok_or_else(|| none(name))?.scene.clone();
            scene.duration_s = LASTS_S;
            let config = scene.planes[0].supervisor.ok_or_else(|| none(name))?;
            Ok(((*name).to_owned(), scene, config))
        })
        .collect()
}

/// Outcome of a run.
struct Ran {
    log: Vec<Tick>,
    figures: Figures,
    trace: Trace,
}

fn ran(scene: &Scene, supervisor: Box<dyn Supervise>) -> Result<Ran, RunError> {
    let log = TickLog::default();
    let recording = Recording {
        supervisor,
        log: Rc::clone(&log),
    };
    let policy = "supervisor";
    let acting = supervised(scene, Box::new(recording));
    let acting = acting.ok_or(RunError::Incomplete { policy })?;
    let (figures, trace) = run_policy(scene, (acting, policy), Keep::Trace, &mut |_| {})?;
    Ok(Ran {
        log: log.take(),
        figures,
        trace,
    })
}

/// Runs the scenes with the supervisor on a machine, whose images have been built, and on the host alone.
///
/// # Errors
/// [`TargetError`].
pub(crate) fn in_the_loop(
    project: &Project,
    machine: &Machine,
) -> Result<Vec<LoopRow>, TargetError> {
    let folder = TempDir::with_prefix("supervisor-loop-")?;
    let image = project.image(machine, "in-the-loop");
    let board = Board::start(machine, &image, folder.path())?;
    let board = Rc::new(RefCell::new(board));
    let mut rows = Vec::new();
    for (name, scene, config) in scenes()? {
        let incomplete = || RunError::Incomplete {
            policy: "supervisor",
        };
        let alone = Float::new(&config).map_err(|_| incomplete())?;
        let alone = ran(&scene, Box::new(alone))?;
        board.borrow_mut().configure(&config)?;
        let started = Instant::now();
        let emulated = ran(&scene, Box::new(Emulated::new(Rc::clone(&board))));
        let took_s = started.elapsed().as_secs_f64();
        // Without its supervisor a run may fail for any reason; this is the one.
        if let Some(why) = board.borrow_mut().take_broken() {
            return Err(why.into());
        }
        let emulated = emulated?;
        let pairs = alone.log.iter().zip(&emulated.log);
        rows.push(LoopRow {
            name: machine.name,
            number: machine.number.name(),
            scene: name,
            ticks: alone.log.len() as u64,
            bit_exact_ticks: pairs.filter(|(a, b)| a == b).count() as u64,
            same_plant: alone.trace == emulated.trace && alone.figures == emulated.figures,
            ticks_per_s: emulated.log.len() as f64 / took_s,
        });
    }
    if let Some(board) = Rc::into_inner(board) {
        board.into_inner().quit()?;
    }
    Ok(rows)
}
