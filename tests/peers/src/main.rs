//! Runs the native solvers in turns and prints one JSON object per measurement.

mod cvode_peer;
mod diffsol_peer;
mod ivp_peer;
mod problem;
mod project;
mod ride;

use cvode_peer::Family;
use diffsol_peer::Solver;
use plant_model::Method;
use problem::Problem;
use ride::Ending;
use std::hint::black_box;
use std::time::Instant;

type Run = fn(&Problem, f64) -> Result<Ending, String>;

const SOLVERS: [(&str, Run); 7] = [
    ("project, series", |p, r| project::run(p, Method::Series, r)),
    ("project, explicit", |p, r| {
        project::run(p, Method::Explicit, r)
    }),
    ("ivp DOP853", ivp_peer::dop853),
    ("CVODE Adams", |p, r| cvode_peer::run(p, Family::Adams, r)),
    ("CVODE BDF", |p, r| cvode_peer::run(p, Family::Bdf, r)),
    ("diffsol tsit45", |p, r| {
        diffsol_peer::run(p, Solver::Tsit45, r)
    }),
    ("diffsol BDF", |p, r| diffsol_peer::run(p, Solver::Bdf, r)),
];
/// Only for the stiff problem.
const STIFF: (&str, Run) = ("project, stiff", |p, r| project::run(p, Method::Stiff, r));

const REPETITIONS: usize = 30;
/// A solver that has used this much time on one problem and tolerance is not repeated further.
const LONG_ENOUGH_S: f64 = 3.0;
const SWEEP_TOLERANCES: [f64; 3] = [1e-6, 1e-8, 1e-10];
const SWEEP_STARTS: u32 = 400;
/// Half a clearance: an error of that size is no error of accuracy.
const WRONG: f64 = 0.5;

fn tolerances() -> impl Iterator<Item = f64> {
    (4..=12).map(|digits| format!("1e-{digits}").parse().expect("a number"))
}

/// Best time of each solver, the solvers taking turns so that a busy moment hits all of them.
fn measure(name: &str, problem: &Problem, solvers: &[(&str, Run)], repetitions: usize) {
    for rtol in tolerances() {
        let mut best = vec![f64::INFINITY; solvers.len()];
        let mut total = vec![0.0; solvers.len()];
        let mut last = vec![Err(String::new()); solvers.len()];
        let mut runs = vec![0; solvers.len()];
        for _ in 0..repetitions {
            for (i, (_, run)) in solvers.iter().enumerate() {
                if total[i] > LONG_ENOUGH_S {
                    continue;
                }
                let start = Instant::now();
                last[i] = run(black_box(problem), black_box(rtol));
                let seconds = start.elapsed().as_secs_f64();
                total[i] += seconds;
                best[i] = best[i].min(seconds);
                runs[i] += 1;
            }
        }
        for (i, (solver, _)) in solvers.iter().enumerate() {
            let head = format!(
                r#"{{"problem":"{name}","solver":"{solver}","rtol":{rtol:e},"seconds":{:e},"repetitions":{},"#,
                best[i], runs[i]
            );
            match &last[i] {
                Ok(e) => println!(
                    r#"{head}"x":{:e},"y":{:e},"changes":{},"evaluations":{}}}"#,
                    e.x, e.y, e.changes, e.evaluations
                ),
                Err(error) => println!(r#"{head}"failed":{error:?}}}"#),
            }
        }
    }
}

fn agree(problem: &Problem, a: &Ending, b: &Ending) -> bool {
    let off = (a.x - b.x).hypot(a.y - b.y) / problem.clearance;
    a.changes == b.changes && off < WRONG
}

/// Runs from many start speeds, each against a reference that the project gives at a tight tolerance
/// and a peer confirms; starts without that are left out.
fn sweep(name: &str, problem: &Problem) {
    let mut references = Vec::new();
    let mut left_out = Vec::new();
    for i in 0..SWEEP_STARTS {
        let start_speed = 0.05 + 0.399 * f64::from(i) / f64::from(SWEEP_STARTS - 1);
        let problem = Problem {
            start_speed,
            ..*problem
        };
        let reference = project::run(&problem, Method::Series, 1e-13);
        let judges = [
            ivp_peer::dop853(&problem, 1e-12),
            cvode_peer::run(&problem, Family::Adams, 1e-12),
            diffsol_peer::run(&problem, Solver::Tsit45, 1e-10),
        ];
        let confirmed = |r: &Ending| judges.iter().flatten().any(|j| agree(&problem, r, j));
        match reference {
            Ok(r) if confirmed(&r) => references.push((problem, r)),
            _ => left_out.push(start_speed),
        }
    }
    let list: Vec<String> = references
        .iter()
        .map(|(p, r)| format!("[{:e},{:e},{:e},{}]", p.start_speed, r.x, r.y, r.changes))
        .collect();
    println!(
        r#"{{"references":"{name}","starts":[{}],"left_out":{left_out:?}}}"#,
        list.join(",")
    );
    for rtol in SWEEP_TOLERANCES {
        for (solver, run) in SOLVERS {
            let (mut wrong, mut failed) = (0, 0);
            for (problem, reference) in &references {
                match run(problem, rtol) {
                    Ok(ending) => wrong += u32::from(!agree(problem, reference, &ending)),
                    Err(_) => failed += 1,
                }
            }
            println!(
                r#"{{"sweep":"{name}","solver":"{solver}","rtol":{rtol:e},"runs":{},"wrong":{wrong},"failed":{failed}}}"#,
                references.len()
            );
        }
    }
}

fn main() {
    let (soft, stiff) = (Problem::bouncing(1e8), Problem::bouncing(1e10));
    let stators = [(1.0, 2e4), (1.0, 2e6), (0.1, 2e6)].map(|(m, d)| Problem::in_stator(m, d));
    // Without arguments: all. `quick` is a look at all solvers while working on one.
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let on = |part: &str| asked.is_empty() || asked.iter().any(|a| a == part);
    if on("rigid") || on("quick") {
        let repetitions = if on("rigid") { REPETITIONS } else { 1 };
        measure("B1", &soft, &SOLVERS, repetitions);
        measure("B2", &stiff, &SOLVERS, repetitions);
    }
    if on("elastic") {
        let with_stiff: Vec<_> = SOLVERS.into_iter().chain([STIFF]).collect();
        for (name, problem) in ["B3a", "B3b", "B3c"].into_iter().zip(&stators) {
            measure(name, problem, &with_stiff, 3);
        }
    }
    if on("sweep") {
        sweep("B1", &soft);
        sweep("B2", &stiff);
    }
}
