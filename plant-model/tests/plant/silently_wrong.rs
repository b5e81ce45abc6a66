//! Runs of a rotor in two planes that end without an error and are wrong all the same: there are none.

use crate::support::reference::{Reference, State, settled};
use crate::support::*;
use std::f64::consts::TAU;

/// A rotor between two bearings out of line, under gravity and with an unbalance, for both codes.
fn case(bending_modes: usize, stiffness_n_m: f64) -> (MachineParams, Reference) {
    let mut params = machine();
    params.supports = vec![support(-0.15), support(0.12)];
    params.unbalances[0].position_m = 0.05;
    params.gravity_m_s2 = V2::new(0.0, -9.81);
    params.rotor = rigid(0.15, 0.06);
    if bending_modes > 0 {
        params.rotor = modal(&params.rotor, bending(bending_modes, 300.0 * TAU));
    }
    params.planes = vec![plane(-0.2, 1.0), plane(0.18, 1.0)];
    params.planes[0].centre_m = V2::new(2e-5, 0.0);
    params.planes[1].centre_m = V2::new(0.0, -3e-5);
    for (plane, share) in params.planes.iter_mut().zip([1.0, 0.7]) {
        let law = spring(share * stiffness_n_m, 0.1 * (stiffness_n_m * 10.0).sqrt());
        plane.contact.law = law.into();
    }
    let reference = Reference::of(&params, 400.0);
    (params, reference)
}

const TOLERANCES: [f64; 4] = [1e-6, 1e-8, 1e-10, 1e-12];

/// Largest error over rtol, clearances, of runs of `duration_s` from `starts` speeds. A run that passes through other modes
/// than the reference fails; starts at which the reference itself does not survive another step are left out.
fn sweep(
    method: Method,
    bending_modes: usize,
    stiffness_n_m: f64,
    starts: u32,
    duration_s: f64,
) -> [f64; TOLERANCES.len()] {
    let (params, reference) = case(bending_modes, stiffness_n_m);
    let step_s = 5e-6 / (stiffness_n_m / 1e8).sqrt();
    let (mut worst, mut left_out, mut changes) = ([0.0_f64; TOLERANCES.len()], 0, 0);
    for i in 0..starts {
        let speed = 0.05 + 0.399 * f64::from(i) / f64::from(starts - 1);
        let mut y = State::default();
        (y.rate[0], y.rate[1]) = (V2::new(speed, 0.0), V2::new(0.4, -1.0));
        let from = moving([speed, 0.0], [0.4, -1.0], reference.spin);
        let coarse = reference.run(y, duration_s, step_s);
        let (modes, ends) = reference.run(y, duration_s, 0.61 * step_s);
        if coarse.0 != modes || (coarse.1[0] - ends[0]).norm() > 1e-8 {
            left_out += 1;
            continue;
        }
        changes += modes.len();
        for (worst, rtol) in worst.iter_mut().zip(TOLERANCES) {
            let mut machine = rotor(&params, &from, options(method, rtol));
            let mut seen = vec![];
            let nothing = MachineInputs::default();
            machine
                .advance(duration_s, &nothing, &mut |_, s| {
                    let mut planes = s.planes().map(|p| p.mode);
                    seen.push((s.t_s, [planes.next().unwrap(), planes.next().unwrap()]));
                })
                .unwrap();
            let seen = settled(&seen);
            if seen != modes {
                // A slip that is over before the reference looks again.
                let (finer, _) = reference.run(y, duration_s, step_s / 16.0);
                assert_eq!(seen, finer, "{speed} m/s at {rtol:e}");
            }
            for (plane, end) in machine.snapshot().planes().zip(ends) {
                *worst = worst.max((plane.rotor.position - end).norm() / 3e-4);
            }
            let what = format!("{speed} m/s at {rtol:e}");
            closes(&what, machine.audit().residual(), 1e2 * rtol);
        }
    }
    assert!(left_out * 20 <= starts, "{left_out} of {starts} left out");
    assert!(
        changes as u32 > 8 * starts,
        "{changes} changes of mode: nothing happens"
    );
    worst
}

/// Errors follow the tolerance: each hundredfold finer one is at least ten times better, down to what the reference knows.
fn follow(method: Method, worst: [f64; TOLERANCES.len()]) {
    // What bouncing makes of the rounding of a step.
    let floor = if method == Method::Series { 1e-9 } else { 5e-9 };
    for pair in worst.windows(2) {
        assert!(pair[1] < 0.1 * pair[0] || pair[1] < floor, "{worst:?}");
    }
    let [loosest, .., tightest] = worst;
    assert!(loosest < 1e-2 && tightest < 1e-8, "{worst:?}");
}

#[test]
fn rigid_rotor() {
    for method in METHODS {
        follow(method, sweep(method, 0, 1e8, 16, 0.05));
    }
}

#[test]
fn four_bending_modes() {
    for method in METHODS {
        follow(method, sweep(method, 4, 1e8, 10, 0.03));
    }
}

#[test]
fn stiff_walls() {
    for method in METHODS {
        follow(method, sweep(method, 0, 1e10, 4, 0.012));
    }
}

/// 400 starts of each, as [the page on accuracy](../../../docs/src/theory/whole-rotor.md) reports: some ten minutes.
#[test]
#[ignore = "ten minutes"]
fn four_hundred_starts() {
    for bending_modes in [0, 4] {
        for method in METHODS {
            println!(
                "{bending_modes} bending modes, {}: {:?}",
                method.name(),
                sweep(method, bending_modes, 1e8, 400, 0.06)
            );
        }
    }
}
