//! What collocation takes for an error on the benchmark problems B3.

use crate::support::*;

struct Problem {
    name: &'static str,
    ring_kg: f64,
    damping_n_s_m: f64,
    end_m: V2,
}

/// Ends from extrapolated midpoint steps in 128-bit arithmetic (`tests/peers/reference`); of B3c from the
/// series at 1e-12, which agrees with another solver to 1e-12 clearances.
const PROBLEMS: [Problem; 3] = [
    Problem {
        name: "B3a",
        ring_kg: 1.0,
        damping_n_s_m: 2e4,
        end_m: V2::new(2.88418984290071e-4, 3.635701631807502e-4),
    },
    Problem {
        name: "B3b",
        ring_kg: 1.0,
        damping_n_s_m: 2e6,
        end_m: V2::new(3.087230269639085e-4, 3.486426392106153e-4),
    },
    Problem {
        name: "B3c",
        ring_kg: 0.1,
        damping_n_s_m: 2e6,
        end_m: V2::new(4.84379526839962e-4, 7.37550202391739e-5),
    },
];

/// Error in clearances, the tolerance that keeps it, and evaluations for each problem: a tenth more than were counted. The best
/// general solvers with steps of many points (CVODE's and diffsol's BDF) need 2063, 1331 and 1686 for the first line and 5501, 3476
/// and 6867 for the last, where they reach it.
const MOST: [(f64, f64, [u64; 3]); 3] = [
    (1e-5, 1e-4, [10_000, 7200, 31_000]),
    (1e-6, 1e-5, [11_600, 7100, 37_500]),
    (1e-7, 1e-6, [12_800, 8100, 43_200]),
];

/// The error is met with the evaluations that it takes.
#[test]
fn evaluations_are_as_many_as_they_were() {
    for (error, rtol, most) in MOST {
        for (problem, most) in PROBLEMS.iter().zip(most) {
            let mut params = bouncing(1e10);
            law_of(&mut params).damping_n_s_m = problem.damping_n_s_m;
            params.stator = StatorParams::OneMass(ring(problem.ring_kg, 2e7, 3000.0));
            let options = options(Method::Collocation, rtol);
            let mut plant = build(&params, &bouncing_start(), options).unwrap();
            run_to(&mut plant, 0.02);
            let what = format!("{} at {rtol:e}", problem.name);
            let within_m = error * params.contact.clearance_m;
            close(&what, plant.snapshot().position_m, problem.end_m, within_m);
            let evaluations = plant.work().evaluations;
            assert!(evaluations <= most, "{what}: {evaluations} for {most}");
        }
    }
}
