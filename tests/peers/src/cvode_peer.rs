//! SUNDIALS CVODE; the peer itself is `cvode/peer.c`.

use crate::problem::Problem;
use crate::ride::Ending;
use std::ffi::c_int;

/// Linear multistep method, numbered as in `cvode/cvode.h`.
#[derive(Debug, Clone, Copy)]
#[repr(i32)]
pub enum Family {
    Adams = 1,
    Bdf = 2,
}

#[repr(C)]
#[derive(Default)]
struct Outcome {
    x: f64,
    y: f64,
    changes: u64,
    evaluations: u64,
    factorisations: u64,
}

unsafe extern "C" {
    fn cvode_run(problem: *const Problem, family: c_int, rtol: f64, outcome: *mut Outcome)
    -> c_int;
}

pub fn run(problem: &Problem, family: Family, rtol: f64) -> Result<Ending, String> {
    let mut out = Outcome::default();
    // SAFETY: both structs have the layout of their C counterparts and outlive the call.
    let flag = unsafe { cvode_run(problem, family as c_int, rtol, &mut out) };
    if flag < 0 {
        return Err(format!("CVODE returns {flag}"));
    }
    Ok(Ending {
        x: out.x,
        y: out.y,
        changes: out.changes,
        evaluations: out.evaluations,
        factorisations: out.factorisations,
    })
}
