//! A retainer bearing out of round, against what can be written down of ellipses.

use crate::support::bouncing::{bouncing, bouncing_start};
use crate::support::plants::onset_rig;
use plant_model::analysis::black::SteadyWhirl;
use plant_model::params::*;
use plant_model::{BuildError, Inputs, Method, Mode, Options, Plant, Snapshot, V2, build};
use std::f64::consts::TAU;

fn options(method: Method, rtol: f64) -> Options {
    Options {
        rtol,
        method,
        ..Options::default()
    }
}

fn elliptic(mut params: PlantParams, ellipticity: f64, long_axis_rad: f64) -> PlantParams {
    params.stator = StatorParams::RigidEllipse(EllipseParams {
        ellipticity,
        long_axis_rad,
    });
    params
}

/// A disc without shaft, friction and damping, in a contact of some stiffness.
fn free_disc(stiffness_n_m: f64) -> PlantParams {
    let mut params = onset_rig();
    params.rotor.stiffness_n_m = 0.0;
    params.rotor.damping_n_s_m = 0.0;
    params.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    params.contact.law = LinearContact {
        stiffness_n_m,
        damping_n_s_m: 0.0,
    }
    .into();
    params
}

fn moving(position_m: V2, velocity_m_s: V2) -> Start {
    Start {
        position_m,
        velocity_m_s,
        spin_rad_s: 200.0,
        spin_phase_rad: 0.0,
    }
}

fn direction(angle_rad: f64) -> V2 {
    V2::new(angle_rad.cos(), angle_rad.sin())
}

/// Runs to a time in samples and calls back at every change of mode.
fn run(plant: &mut Plant, end_s: f64, sample_s: f64, on_change: &mut dyn FnMut(&Snapshot)) {
    let samples = (end_s / sample_s).round() as u64;
    for i in 1..=samples {
        let to_s = i as f64 * sample_s;
        plant.advance(to_s, &Inputs::default(), on_change).unwrap();
    }
}

/// From the middle a free disc meets the ellipse after r(φ)/v, r = a·b/√(b²cos²φ + a²sin²φ), φ from the longer
/// axis: the wall is found on the exact solution, and is the wall to round-off.
#[test]
fn flight_ends_on_the_ellipse() {
    let (c, axis, v) = (2e-4, 0.6, 0.05);
    for ellipticity in [0.01, 0.1, 0.2] {
        let params = elliptic(free_disc(1e9), ellipticity, axis);
        let (a, b) = (c * (1.0 + ellipticity), c * (1.0 - ellipticity));
        for i in 0..24 {
            let phi = f64::from(i) * TAU / 24.0;
            let radius = a * b / (b * phi.cos()).hypot(a * phi.sin());
            let from = moving(V2::zeros(), v * direction(axis + phi));
            let mut plant = build(&params, &from, Options::default()).unwrap();
            let mut touch = None;
            run(&mut plant, 0.01, 5e-5, &mut |s| {
                touch.get_or_insert(*s);
            });
            let touch = touch.unwrap();
            assert!(touch.mode.in_contact());
            assert!((touch.t_s * v / radius - 1.0).abs() < 1e-13, "{phi}");
            assert!(touch.penetration_m.abs() < 1e-14 * c, "{phi}");
        }
    }
}

/// A billiard in an ellipse keeps the product of the angular momenta about its foci. The wall gives way by
/// v·√(m/k), so the product drifts by about that over the clearance, and a hundred times stiffer by a tenth.
#[test]
fn billiard_keeps_the_product_about_the_foci() {
    let (c, e, axis, v) = (2e-4, 0.1, -0.4, 0.05);
    let focus_m = c * ((1.0_f64 + e).powi(2) - (1.0 - e).powi(2)).sqrt() * direction(axis);
    let product = |s: &Snapshot| {
        let about = |f: V2| (s.position_m - f).perp(&s.velocity_m_s);
        about(focus_m) * about(-focus_m)
    };
    let mut drifts = Vec::new();
    for stiffness in [1e12, 1e14] {
        let params = elliptic(free_disc(stiffness), e, axis);
        let from = moving(V2::new(3e-5, 5e-5), v * direction(0.9));
        let mut plant = build(&params, &from, options(Method::Auto, 1e-11)).unwrap();
        assert_eq!(plant.method(), Method::Collocation);
        let first = product(&plant.snapshot());
        let mut drift = 0.0_f64;
        run(&mut plant, 0.3, 5e-5, &mut |s| {
            if s.mode == Mode::Flight {
                drift = drift.max((product(s) - first).abs());
            }
        });
        assert!(plant.meters().impacts > 40);
        let energy = plant.snapshot().velocity_m_s.norm() / v - 1.0;
        assert!(energy.abs() < 1e-8, "{energy}");
        drifts.push(drift / (v * c).powi(2));
    }
    let soft = v * (10.0_f64 / 1e12).sqrt() / c;
    assert!(drifts[0] < 4.0 * soft, "{drifts:?} {soft}");
    assert!(drifts[1] < 0.15 * drifts[0], "{drifts:?}");
}

/// Bounces, slip and roll with friction, damping, unbalance, a free spin and a lagging magnet: two tolerances
/// end in the same place, and the audit of energy closes.
#[test]
fn tolerances_agree_and_the_audit_closes() {
    for (params, from, end_s) in [
        (bouncing(1e8), bouncing_start(), 0.02),
        (onset_rig(), moving(V2::zeros(), V2::new(0.08, 0.02)), 0.05),
    ] {
        let mut params = elliptic(params, 0.05, 0.3);
        params.spin = SpinParams::Free {
            inertia_kg_m2: 0.05,
            drive_torque_n_m: 1.0,
        };
        params.magnet = Some(MagnetParams {
            force_max_n: 100.0,
            lag_s: 1.6e-4,
        });
        let rtol = 1e-11;
        let ends = [rtol, 0.01 * rtol].map(|rtol| {
            let mut plant = build(&params, &from, options(Method::Auto, rtol)).unwrap();
            assert_eq!(plant.method(), Method::Collocation);
            let inputs = Inputs {
                command_n: V2::new(60.0, -30.0),
                external_n: V2::new(0.0, 20.0),
            };
            for i in 1..=(end_s / 5e-5_f64).round() as u64 {
                let to_s = i as f64 * 5e-5;
                plant.advance(to_s, &inputs, &mut |_| {}).unwrap();
            }
            assert!(plant.meters().impacts > 2);
            let residual = plant.audit().residual();
            assert!(residual < 100.0 * rtol, "{residual:e}");
            plant.snapshot()
        });
        let apart_m = (ends[0].position_m - ends[1].position_m).norm();
        let clearance_m = params.contact.clearance_m;
        assert!(apart_m < 1e-5 * clearance_m, "{:e}", apart_m / clearance_m);
        assert_eq!(ends[0].mode, ends[1].mode);
    }
}

/// Turned with its ellipse, a run is the same run turned; without ellipticity it is the round bearing's.
#[test]
fn turns_with_the_ellipse_and_ends_in_the_circle() {
    let end = |params: &PlantParams, from: &Start| {
        let mut plant = build(params, from, options(Method::Collocation, 1e-11)).unwrap();
        run(&mut plant, 0.02, 5e-5, &mut |_| {});
        assert!(plant.meters().impacts > 0);
        plant.snapshot()
    };
    let mut params = bouncing(1e8);
    params.rotor.eccentricity_m = 0.0;
    let clearance_m = params.contact.clearance_m;
    let from = bouncing_start();
    let turned = |v: V2, angle: f64| {
        let t = direction(angle);
        V2::new(t.x * v.x - t.y * v.y, t.y * v.x + t.x * v.y)
    };
    let a = end(&elliptic(params, 0.1, 0.2), &from);
    for angle in [0.5, 2.0, -1.0] {
        let start = Start {
            velocity_m_s: turned(from.velocity_m_s, angle),
            ..from
        };
        let b = end(&elliptic(params, 0.1, 0.2 + angle), &start);
        let apart_m = (turned(a.position_m, angle) - b.position_m).norm();
        assert!(apart_m < 1e-7 * clearance_m, "{:e}", apart_m / clearance_m);
    }
    let (round, none) = (end(&params, &from), end(&elliptic(params, 0.0, 0.2), &from));
    assert!((round.position_m - none.position_m).norm() < 1e-7 * clearance_m);
    assert!((round.position_m - a.position_m).norm() > 1e-2 * clearance_m);
}

/// What the ellipse has not: a power series, a race, ellipticity that a bearing never has.
#[test]
fn refuses_what_it_has_not() {
    let from = bouncing_start();
    let params = elliptic(bouncing(1e8), 0.05, 0.0);
    assert!(!params.has_series() && bouncing(1e8).has_series());
    let made = build(&params, &from, options(Method::Series, 1e-9));
    assert_eq!(made.err(), Some(BuildError::NoSeries));
    let field = |params: &PlantParams| params.validate().unwrap_err().field;
    for ellipticity in [-0.01, 0.21, f64::NAN] {
        let params = elliptic(params, ellipticity, 0.0);
        assert_eq!(field(&params), "retainer.ellipticity");
    }
    let tilted = elliptic(params, 0.05, f64::INFINITY);
    assert_eq!(field(&tilted), "retainer.long_axis_deg");
    let mut raced = params;
    raced.race = Some(RaceParams {
        inertia_kg_m2: 1e-3,
        drag_n_m_s: 0.0,
        start_spin_rad_s: 0.0,
    });
    assert_eq!(field(&raced), "race.inertia_kg_m2");
}

/// Circles of steady whirl are for a bore that is the same all round: none is named for an ellipse, as for rings whose axes
/// differ, and none for a race, which turns along.
#[test]
fn steady_whirl_is_named_for_round_bores_only() {
    let round = SteadyWhirl::from_params(&onset_rig()).unwrap();
    assert_eq!(
        SteadyWhirl::from_params(&elliptic(onset_rig(), 0.0, 0.4)),
        Some(round)
    );
    for ellipticity in [1e-6, 0.05, 0.2] {
        assert_eq!(
            SteadyWhirl::from_params(&elliptic(onset_rig(), ellipticity, 0.4)),
            None
        );
    }
    let mut params = onset_rig();
    params.race = Some(RaceParams {
        inertia_kg_m2: 1e-3,
        drag_n_m_s: 0.0,
        start_spin_rad_s: 0.0,
    });
    assert_eq!(SteadyWhirl::from_params(&params), None);
}
