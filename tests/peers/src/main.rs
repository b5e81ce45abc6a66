//! Runs the native solvers and prints one JSON object per measurement; progress goes to stderr.
//!
//! `peers times`: error and time, the solvers in turns, on one core.
//! `peers sweep soft|stiff THREADS`: silently wrong runs, which are not timed.
//! `peers batch B1|B2 RTOL`: many starts by lanes and one by one.
//! `peers quick`: a look at all solvers while working on one.

mod cvode_peer;
mod diffsol_peer;
mod ivp_peer;
mod problem;
mod project;
mod ride;

use cvode_peer::Family;
use diffsol_peer::Solver;
use plant_model::{Method, V2};
use problem::Problem;
use ride::Ending;
use std::ffi::c_long;
use std::hint::black_box;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Instant;

type Run = fn(&Problem, f64) -> Result<Ending, String>;

const SERIES: (&str, Run) = ("project, series", |p, r| project::run(p, Method::Series, r));
const SOLVERS: [(&str, Run); 7] = [
    SERIES,
    ("project, collocation", |p, r| {
        project::run(p, Method::Collocation, r)
    }),
    ("ivp DOP853", ivp_peer::dop853),
    ("CVODE Adams", |p, r| cvode_peer::run(p, Family::Adams, r)),
    ("CVODE BDF", |p, r| cvode_peer::run(p, Family::Bdf, r)),
    ("diffsol tsit45", |p, r| {
        diffsol_peer::run(p, Solver::Tsit45, r)
    }),
    ("diffsol BDF", |p, r| diffsol_peer::run(p, Solver::Bdf, r)),
];
/// What a user gets who names no method; timed, but it is one of the others.
const AUTO: (&str, Run) = ("project, auto", |p, r| project::run(p, Method::Auto, r));

/// Most repetitions, and the time after which a solver is not repeated further, for each problem and
/// tolerance.
#[derive(Clone, Copy)]
struct Patience {
    repetitions: usize,
    seconds: f64,
}
const RIGID: Patience = Patience {
    repetitions: 30,
    seconds: 1.5,
};
const ELASTIC: Patience = Patience {
    repetitions: 10,
    seconds: 0.5,
};
const ONCE: Patience = Patience {
    repetitions: 1,
    seconds: 0.0,
};
const SWEEP_TOLERANCES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
const SWEEP_STARTS: u32 = 400;
/// Half a clearance: an error of that size is no error of accuracy.
const WRONG: f64 = 0.5;

fn start_speed(i: u32) -> f64 {
    0.05 + 0.399 * f64::from(i) / f64::from(SWEEP_STARTS - 1)
}

fn tolerances() -> impl Iterator<Item = f64> {
    (4..=12).map(|digits| format!("1e-{digits}").parse().expect("a number"))
}

/// CPU time of the process \[s\]: what else the machine does matters less to it.
fn cpu_seconds() -> f64 {
    unsafe extern "C" {
        safe fn clock() -> c_long;
    }
    // POSIX counts it in millionths of a second.
    clock() as f64 * 1e-6
}

/// Best time of each solver, the solvers taking turns so that a busy moment hits all of them.
fn measure(name: &str, problem: &Problem, solvers: &[(&str, Run)], patience: Patience) {
    let begin = Instant::now();
    for rtol in tolerances() {
        let mut best = vec![f64::INFINITY; solvers.len()];
        let mut total = vec![0.0; solvers.len()];
        let mut last = vec![Err(String::new()); solvers.len()];
        let mut runs = vec![0; solvers.len()];
        for _ in 0..patience.repetitions {
            for (i, (_, run)) in solvers.iter().enumerate() {
                if total[i] > patience.seconds {
                    continue;
                }
                let start = cpu_seconds();
                last[i] = run(black_box(problem), black_box(rtol));
                let seconds = cpu_seconds() - start;
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
                    r#"{head}"x":{:e},"y":{:e},"changes":{},"evaluations":{},"factorisations":{}}}"#,
                    e.x, e.y, e.changes, e.evaluations, e.factorisations
                ),
                Err(error) => println!(r#"{head}"failed":{error:?}}}"#),
            }
        }
        eprintln!(
            "  {name} at {rtol:e}: {:.0} s",
            begin.elapsed().as_secs_f64()
        );
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Right,
    OtherChanges,
    /// As many mode changes as the reference, but another end.
    OtherEnd,
    Failed,
}

fn judge(problem: &Problem, reference: &Ending, run: Result<Ending, String>) -> Verdict {
    let Ok(run) = run else {
        return Verdict::Failed;
    };
    let off = (reference.x - run.x).hypot(reference.y - run.y) / problem.clearance;
    if run.changes != reference.changes {
        Verdict::OtherChanges
    } else if off < WRONG {
        Verdict::Right
    } else {
        Verdict::OtherEnd
    }
}

/// Runs from many start speeds.
struct Sweep<'a> {
    name: &'a str,
    problem: Problem,
    /// External forces, each held for an equal part of the run: the project's series only.
    forces_n: &'a [V2],
    solvers: &'a [(&'a str, Run)],
}

/// What became of one start: the reference, and the verdict for each tolerance and solver.
struct Start {
    speed: f64,
    judged: Option<(Ending, Vec<Verdict>)>,
}

impl Sweep<'_> {
    /// Against a reference that the project gives at a tight tolerance and another solver confirms.
    fn start(&self, i: u32) -> Start {
        let speed = start_speed(i);
        let problem = Problem {
            start_speed: speed,
            ..self.problem
        };
        let forced = !self.forces_n.is_empty();
        let run = |solver: Run, rtol| {
            if forced {
                project::run_under(&problem, self.forces_n, Method::Series, rtol)
            } else {
                solver(&problem, rtol)
            }
        };
        let confirmed = |reference: &Ending| {
            let by = |run| judge(&problem, reference, run) == Verdict::Right;
            if forced {
                // No peer takes part: another method of the project, and a start next to this one.
                let near = Problem {
                    start_speed: speed * (1.0 + 1e-12),
                    ..problem
                };
                return by(project::run_under(
                    &near,
                    self.forces_n,
                    Method::Collocation,
                    1e-10,
                ));
            }
            by(ivp_peer::dop853(&problem, 1e-12))
                || by(cvode_peer::run(&problem, Family::Adams, 1e-12))
                || by(diffsol_peer::run(&problem, Solver::Tsit45, 1e-10))
        };
        let reference = run(SERIES.1, 1e-13).ok().filter(confirmed);
        let judged = reference.map(|reference| {
            let runs = SWEEP_TOLERANCES.iter().flat_map(|rtol| {
                self.solvers
                    .iter()
                    .map(|(_, solver)| judge(&problem, &reference, run(*solver, *rtol)))
            });
            (reference, runs.collect())
        });
        Start { speed, judged }
    }

    fn run(&self, threads: usize) {
        let begin = Instant::now();
        let next = AtomicU32::new(0);
        let starts = Mutex::new(Vec::new());
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    loop {
                        let i = next.fetch_add(1, Ordering::Relaxed);
                        if i >= SWEEP_STARTS {
                            break;
                        }
                        let start = self.start(i);
                        starts.lock().expect("no thread panics").push(start);
                        if (i + 1).is_multiple_of(100) {
                            let seconds = begin.elapsed().as_secs_f64();
                            eprintln!("  sweep {}: {} starts, {seconds:.0} s", self.name, i + 1);
                        }
                    }
                });
            }
        });
        let mut starts = starts.into_inner().expect("no thread panics");
        starts.sort_by(|a, b| a.speed.total_cmp(&b.speed));
        self.print(&starts);
    }

    fn print(&self, starts: &[Start]) {
        let judged = || {
            starts
                .iter()
                .filter_map(|s| Some((s.speed, s.judged.as_ref()?)))
        };
        let list: Vec<String> = judged()
            .map(|(speed, (r, _))| format!("[{speed:e},{:e},{:e},{}]", r.x, r.y, r.changes))
            .collect();
        let out = starts.iter().filter(|s| s.judged.is_none());
        println!(
            r#"{{"references":"{}","starts":[{}],"left_out":{:?}}}"#,
            self.name,
            list.join(","),
            out.map(|s| s.speed).collect::<Vec<_>>()
        );
        for (i, rtol) in SWEEP_TOLERANCES.iter().enumerate() {
            for (j, (solver, _)) in self.solvers.iter().enumerate() {
                let of = |what| {
                    let index = i * self.solvers.len() + j;
                    judged()
                        .filter(|(_, (_, runs))| runs[index] == what)
                        .count()
                };
                println!(
                    r#"{{"sweep":"{}","solver":"{solver}","rtol":{rtol:e},"runs":{},"wrong":{},"other_changes":{},"failed":{}}}"#,
                    self.name,
                    list.len(),
                    of(Verdict::OtherChanges) + of(Verdict::OtherEnd),
                    of(Verdict::OtherChanges),
                    of(Verdict::Failed)
                );
            }
        }
    }
}

fn times(for_rigid: Patience, for_elastic: Patience) {
    let solvers: Vec<_> = SOLVERS.into_iter().chain([AUTO]).collect();
    measure("B1", &Problem::bouncing(1e8), &solvers, for_rigid);
    measure("B2", &Problem::bouncing(1e10), &solvers, for_rigid);
    for (name, m_s, d_c) in [("B3a", 1.0, 2e4), ("B3b", 1.0, 2e6), ("B3c", 0.1, 2e6)] {
        measure(name, &Problem::in_stator(m_s, d_c), &solvers, for_elastic);
    }
}

fn sweep_soft(threads: usize) {
    let problem = Problem::bouncing(1e8);
    // A held force that turns, as a controller's would, but given beforehand.
    let forces_n: Vec<V2> = (0..400)
        .map(|i| 0.37 * f64::from(i))
        .map(|angle| 40.0 * V2::new(angle.cos(), angle.sin()))
        .collect();
    let all = Sweep {
        name: "B1",
        problem,
        forces_n: &[],
        solvers: &SOLVERS,
    };
    let series = Sweep {
        solvers: &[SERIES],
        ..all
    };
    all.run(threads);
    Sweep {
        name: "B1 without unbalance",
        problem: Problem {
            eccentricity: 0.0,
            ..problem
        },
        ..series
    }
    .run(threads);
    Sweep {
        name: "B1 in an elastic stator of one mass",
        problem: Problem {
            m_s: 5.0,
            k_s: 2e7,
            d_s: 3000.0,
            ..problem
        },
        ..series
    }
    .run(threads);
    Sweep {
        name: "B1 under held forces",
        forces_n: &forces_n,
        ..series
    }
    .run(threads);
}

fn sweep_stiff(threads: usize) {
    Sweep {
        name: "B2",
        problem: Problem::bouncing(1e10),
        forces_n: &[],
        solvers: &SOLVERS,
    }
    .run(threads);
}

/// All starts of a sweep, one by one and by lanes; the time is that of one run.
fn batch(name: &str, problem: Problem, rtol: f64) {
    let of = |i| Problem {
        start_speed: start_speed(i),
        ..problem
    };
    let problems: Vec<Problem> = (0..SWEEP_STARTS).map(of).collect();
    let one_by_one = || problems.iter().map(|p| (SERIES.1)(p, rtol)).collect();
    let by_lanes = || project::by_lanes(&problems, rtol);
    let timed = |solver: &str, run: &dyn Fn() -> Result<Vec<Ending>, String>| {
        let begin = cpu_seconds();
        let endings = run().expect("the project runs them all");
        let seconds = (cpu_seconds() - begin) / f64::from(SWEEP_STARTS);
        let ends: Vec<String> = endings
            .iter()
            .map(|e| format!("[{:e},{:e},{}]", e.x, e.y, e.changes))
            .collect();
        println!(
            r#"{{"batch":"{name}","solver":"{solver}","rtol":{rtol:e},"seconds":{seconds:e},"ends":[{}]}}"#,
            ends.join(",")
        );
    };
    timed(SERIES.0, &one_by_one);
    timed("project, lanes", &by_lanes);
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let threads = |text: &str| text.parse().expect("THREADS is a number");
    let number = |text: &str| text.parse().expect("RTOL is a number");
    match arguments[..] {
        ["times"] => times(RIGID, ELASTIC),
        ["quick"] => times(ONCE, ONCE),
        ["batch", "B1", r] => batch("B1", Problem::bouncing(1e8), number(r)),
        ["batch", "B2", r] => batch("B2", Problem::bouncing(1e10), number(r)),
        ["sweep", "soft", n] => sweep_soft(threads(n)),
        ["sweep", "stiff", n] => sweep_stiff(threads(n)),
        _ => panic!("times | quick | batch B1|B2 RTOL | sweep soft|stiff THREADS"),
    }
}
