//! Crate `ivp`: DOP853 with the crate's own events.

use crate::problem::{GUARDS, Mode, Problem};
use crate::ride::{Ending, Stop, ride};
use ivp::prelude::*;
use std::cell::Cell;

struct Segment<'a> {
    problem: &'a Problem,
    mode: Mode,
    since: f64,
    /// The crate's own count leaves out those of the dense output.
    evaluations: Cell<u64>,
}

impl FirstOrderSystem for Segment<'_> {
    fn derivative(&self, t: f64, y: &[f64], dydt: &mut [f64]) {
        self.evaluations.set(self.evaluations.get() + 1);
        self.problem.rhs(self.mode, t, y, dydt);
    }
    fn events(&self, t: f64, y: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.problem.guards(self.mode, self.since, t, y));
    }
    fn n_events(&self) -> usize {
        GUARDS
    }
    fn event_config(&self, _: usize) -> EventConfig {
        EventConfig {
            direction: Direction::Negative,
            terminal_count: Some(1),
        }
    }
}

pub fn dop853(problem: &Problem, rtol: f64) -> Result<Ending, String> {
    ride(problem, |mode, t, y| {
        let segment = Segment {
            problem,
            mode,
            since: t,
            evaluations: Cell::new(0),
        };
        let mut solution = Ivp::first_order(&segment, t, problem.t_end, y)
            .method(Method::DOP853)
            .rtol(rtol)
            .atol(problem.atol(rtol))
            .solve()
            .map_err(|e| e.to_string())?;
        let guard = match solution.status {
            Status::Success => None,
            Status::UserInterrupt => {
                let first = |i: &usize| solution.t_events[*i].last().copied();
                let hit = (0..GUARDS).filter(|i| first(i).is_some());
                hit.min_by(|a, b| first(a).partial_cmp(&first(b)).expect("times are finite"))
            }
            other => return Err(format!("{other:?} at t = {t}")),
        };
        // With no event the last entry is the end.
        let end = guard.map_or(problem.t_end, |g| solution.t_events[g][0]);
        let y = match guard {
            Some(g) => solution.y_events[g].swap_remove(0),
            None => solution.y.pop().expect("a solution has a start"),
        };
        Ok(Stop {
            t: end,
            y,
            guard,
            evaluations: segment.evaluations.get(),
            factorisations: 0,
        })
    })
}
