//! Runs that end without an error and are wrong all the same: there must be none from 1e-6 on.
//!
//! Every eighth of the starts that the page of results tells of; all of them with `ALL_STARTS=1` in the environment.

use plant_model::params::{EllipseParams, PlantParams, RingParams, StatorParams};
use plant_model::{ContactMode, Inputs, Method, Options, V2, build};
use system_tests::plants::{bouncing, bouncing_start};

/// Where a run ends and how it came there.
struct Ending {
    position_m: V2,
    changes: Vec<ContactMode>,
}

fn run(params: &PlantParams, speed_m_s: f64, forced: bool, method: Method, rtol: f64) -> Ending {
    let mut start = bouncing_start();
    start.velocity_m_s = V2::new(speed_m_s, 0.0);
    let options = Options {
        rtol,
        method,
        ..Options::default()
    };
    let mut plant = build(params, &start, options).unwrap();
    let mut changes = Vec::new();
    let samples = if forced { 400 } else { 1 };
    for i in 0..samples {
        // A held force that turns, as a controller's would, but given beforehand.
        let angle = 0.37 * f64::from(i);
        let inputs = Inputs {
            command_n: V2::zeros(),
            external_n: if forced {
                40.0 * V2::new(angle.cos(), angle.sin())
            } else {
                V2::zeros()
            },
        };
        let t = 0.2 * f64::from(i + 1) / f64::from(samples);
        plant
            .advance(t, &inputs, &mut |s| changes.push(s.mode))
            .unwrap();
    }
    Ending {
        position_m: plant.snapshot().position_m,
        changes,
    }
}

/// Numbers of wrong runs (another sequence of modes, or half a clearance off) for each tolerance, of starts left out because
/// the reference itself does not survive a change of method, and of starts.
fn sweep(
    params: &PlantParams,
    forced: bool,
    starts: u32,
    tolerances: &[f64],
) -> (Vec<u32>, u32, u32) {
    let clearance_m = params.contact.clearance_m;
    // The method that `auto` takes, and another one to confirm it. Out of round, where there is no series, a coarser
    // tolerance does (the stiff method confirms the same, in a hundred times the time).
    let ((taken, finest), (other, finer)) = match params.stator {
        StatorParams::RigidEllipse(_) => {
            ((Method::Collocation, 1e-11), (Method::Collocation, 1e-9))
        }
        _ => ((Method::Series, 1e-13), (Method::Collocation, 1e-10)),
    };
    let agree = |a: &Ending, b: &Ending| {
        a.changes == b.changes && (a.position_m - b.position_m).norm() < 0.5 * clearance_m
    };
    let mut wrong = vec![0; tolerances.len()];
    let mut left_out = 0;
    let every = if std::env::var_os("ALL_STARTS").is_some() {
        1
    } else {
        8
    };
    let mut tried = 0;
    for i in (0..starts).step_by(every) {
        tried += 1;
        let speed = 0.05 + 0.399 * f64::from(i) / f64::from(starts - 1);
        let reference = run(params, speed, forced, taken, finest);
        let second = run(params, speed * (1.0 + 1e-12), forced, other, finer);
        if !agree(&reference, &second) {
            left_out += 1;
            continue;
        }
        for (wrong, rtol) in wrong.iter_mut().zip(tolerances) {
            *wrong += u32::from(!agree(
                &reference,
                &run(params, speed, forced, Method::Auto, *rtol),
            ));
        }
    }
    (wrong, left_out, tried)
}

const TOLERANCES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

fn elastic(mut params: PlantParams) -> PlantParams {
    params.stator = StatorParams::OneMass(RingParams {
        mass_kg: 5.0,
        stiffness_n_m: V2::repeat(2e7),
        damping_n_s_m: V2::repeat(3000.0),
    });
    params
}

fn assert_none_wrong(name: &str, params: &PlantParams, forced: bool, starts: u32) {
    none_wrong_at(&TOLERANCES, name, (params, forced), starts);
}

fn none_wrong_at(
    tolerances: &[f64],
    name: &str,
    (params, forced): (&PlantParams, bool),
    starts: u32,
) {
    let (wrong, left_out, starts) = sweep(params, forced, starts, tolerances);
    println!("{name}: wrong {wrong:?} of {starts} at {tolerances:?}, {left_out} left out");
    // The coarsest tolerance is reported, two of 400 at most; from 1e-6 on there is none.
    assert!(
        200 * wrong[0] <= starts,
        "{name}: {} wrong at {}",
        wrong[0],
        tolerances[0]
    );
    assert!(wrong[1..].iter().all(|w| *w == 0), "{name}: {wrong:?}");
    assert!(
        left_out * 50 <= starts,
        "{name}: {left_out} of {starts} left out"
    );
}

#[test]
fn bouncing_soft() {
    assert_none_wrong("k_c = 1e8", &bouncing(1e8), false, 400);
}

#[test]
fn bouncing_stiff() {
    assert_none_wrong("k_c = 1e10", &bouncing(1e10), false, 400);
}

#[test]
fn bouncing_without_unbalance() {
    let mut params = bouncing(1e8);
    params.rotor.eccentricity_m = 0.0;
    assert_none_wrong("no unbalance", &params, false, 400);
}

#[test]
fn bouncing_in_an_elastic_stator() {
    assert_none_wrong("elastic stator", &elastic(bouncing(1e8)), false, 400);
}

#[test]
fn bouncing_out_of_round() {
    let mut params = bouncing(1e8);
    params.stator = StatorParams::RigidEllipse(EllipseParams {
        ellipticity: 0.05,
        long_axis_rad: 1.0,
    });
    none_wrong_at(&TOLERANCES[..3], "out of round", (&params, false), 200);
}

#[test]
fn bouncing_under_held_forces() {
    assert_none_wrong("held forces", &bouncing(1e8), true, 400);
}
