//! From mode to mode with any solver that can run one mode up to its first event.

use crate::problem::{Mode, Problem};

/// How a run ended and what it took.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ending {
    pub x: f64,
    pub y: f64,
    pub changes: u64,
    /// Right-hand sides; an analytic Jacobian counts as one.
    pub evaluations: u64,
    /// Matrices factorised, as the solver itself counts them; 0 for explicit methods.
    pub factorisations: u64,
}

/// Where one mode was left: by which guard, or none at the end of the run.
pub struct Stop {
    pub t: f64,
    pub y: Vec<f64>,
    pub guard: Option<usize>,
    pub evaluations: u64,
    pub factorisations: u64,
}

/// More changes than any of the problems has by far: the solver chatters.
const TOO_MANY: u64 = 10_000;

/// Rides `problem` to its end. `solve` gets mode, time and state.
pub fn ride(
    problem: &Problem,
    mut solve: impl FnMut(Mode, f64, &[f64]) -> Result<Stop, String>,
) -> Result<Ending, String> {
    let (mut mode, mut t, mut y) = (Mode::Flight, 0.0, problem.start());
    let mut ending = Ending::default();
    loop {
        let stop = solve(mode, t, &y)?;
        (t, y) = (stop.t, stop.y);
        ending.evaluations += stop.evaluations;
        ending.factorisations += stop.factorisations;
        let Some(guard) = stop.guard else { break };
        ending.changes += 1;
        if ending.changes > TOO_MANY {
            return Err(format!("chatters at t = {t}"));
        }
        mode = problem.next(mode, guard, t, &mut y);
        // An event at the very end leaves nothing to solve.
        if t >= problem.t_end {
            break;
        }
    }
    (ending.x, ending.y) = (y[0], y[1]);
    Ok(ending)
}
