//! Crate `diffsol`: tsit45 and BDF with the crate's own root finding, a new solver for each mode.

use crate::problem::{GUARDS, Problem};
use crate::ride::{Ending, Stop, ride};
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, Vector};
use std::cell::Cell;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    Tsit45,
    Bdf,
}

pub fn run(problem: &Problem, solver: Solver, rtol: f64) -> Result<Ending, String> {
    let n = problem.states();
    ride(problem, |mode, t0, y0| {
        let (calls, products) = (Cell::new(0_u64), Cell::new(0_u64));
        let mut equations = OdeBuilder::<NalgebraMat<f64>>::new()
            .t0(t0)
            .rtol(rtol)
            .atol(problem.atol(rtol))
            .rhs_implicit(
                |y, _, t, out| {
                    calls.set(calls.get() + 1);
                    problem.rhs(mode, t, y, out);
                },
                |y, _, t, v, out| {
                    products.set(products.get() + 1);
                    problem.tangent(mode, t, y, v, out);
                },
            )
            .init(|_, _, y| y.copy_from_slice(y0), n)
            .root(
                |y, _, t, out| out.copy_from_slice(&problem.guards(mode, t0, t, y)),
                GUARDS,
            )
            .build()
            .map_err(|e| e.to_string())?;
        // The limit counts over the whole segment, and the last one is long.
        equations.ode_options.max_nonlinear_solver_failures = 1_000_000;
        let (t, y, guard, factorisations) = match solver {
            Solver::Tsit45 => to_event(equations.tsit45(), problem.t_end),
            Solver::Bdf => to_event(equations.bdf::<NalgebraLU<f64>>(), problem.t_end),
        }
        .map_err(|e| format!("{e} after t = {t0}"))?;
        // A Jacobian is asked for as one product for each state.
        let evaluations = calls.get() + products.get() / n as u64;
        Ok(Stop {
            t,
            y,
            guard,
            evaluations,
            factorisations,
        })
    })
}

/// Time, state, guard, factorisations.
type Reached = (f64, Vec<f64>, Option<usize>, u64);

fn to_event<'a, E, S>(
    solver: Result<S, diffsol::error::DiffsolError>,
    t_end: f64,
) -> Result<Reached, diffsol::error::DiffsolError>
where
    E: diffsol::OdeEquations<T = f64> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let mut solver = solver?;
    solver.set_stop_time(t_end)?;
    let (t, y, guard) = loop {
        match solver.step()? {
            OdeSolverStopReason::InternalTimestep => {}
            OdeSolverStopReason::TstopReached => {
                break (t_end, solver.state().y.clone_as_vec(), None);
            }
            // A root beyond the end of the run is none; the end lies in this step.
            OdeSolverStopReason::RootFound(t, _) if t > t_end => {
                break (t_end, solver.interpolate(t_end)?.clone_as_vec(), None);
            }
            OdeSolverStopReason::RootFound(t, guard) => {
                break (t, solver.interpolate(t)?.clone_as_vec(), Some(guard));
            }
        }
    };
    let setups = solver.get_statistics().number_of_linear_solver_setups;
    Ok((t, y, guard, setups as u64))
}
