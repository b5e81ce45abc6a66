//! A retainer bearing out of round, against what can be written down of ellipses; and what has no power series, by two
//! tolerances.

use crate::support::*;
use plant_model::analysis::black::SteadyWhirl;
use plant_model::contact::hunt_crossley::damping_for_restitution;
use std::f64::consts::TAU;

fn elliptic(params: PlantParams, ellipticity: f64, long_axis_rad: f64) -> PlantParams {
    PlantParams {
        stator: ellipse(ellipticity, long_axis_rad),
        ..params
    }
}

/// Runs to a time in samples and calls back at every change of mode.
fn run(plant: &mut Plant, end_s: f64, on_change: &mut dyn FnMut(&Snapshot)) {
    for i in 1..=(end_s / 5e-5).round() as u64 {
        plant
            .advance(i as f64 * 5e-5, &Inputs::default(), on_change)
            .unwrap();
    }
}

/// From the middle a free disc meets the ellipse after r(φ)/v, r = a·b/√(b²cos²φ + a²sin²φ), φ from the longer
/// axis: the wall is found on the exact solution, and is the wall to round-off.
#[test]
fn flight_ends_on_the_ellipse() {
    let (c, axis, v) = (CLEARANCE_M, 0.6, 0.05);
    for ellipticity in [0.01, 0.1, 0.2] {
        let params = elliptic(free_mass(linear(1e9, 1.0), 0.0), ellipticity, axis);
        let (a, b) = (c * (1.0 + ellipticity), c * (1.0 - ellipticity));
        for i in 0..24 {
            let phi = f64::from(i) * TAU / 24.0;
            let radius = a * b / (b * phi.cos()).hypot(a * phi.sin());
            let from = start(V2::zeros(), v * direction(axis + phi), 200.0);
            let mut plant = build(&params, &from, Options::default()).unwrap();
            let mut touch = None;
            run(&mut plant, 0.01, &mut |s| {
                touch.get_or_insert(*s);
            });
            let touch = touch.unwrap();
            assert!(touch.mode.in_contact());
            near("touch", touch.t_s, radius / v, 1e-13);
            assert!(touch.penetration_m.abs() < 1e-14 * c, "{phi}");
        }
    }
}

/// A billiard in an ellipse keeps the product of the angular momenta about its foci. The wall gives way by
/// v·√(m/k), so the product drifts by about that over the clearance, and a hundred times stiffer by a tenth.
#[test]
fn billiard_keeps_the_product_about_the_foci() {
    let (c, e, axis, v) = (CLEARANCE_M, 0.1, -0.4, 0.05);
    let focus_m = c * ((1.0_f64 + e).powi(2) - (1.0 - e).powi(2)).sqrt() * direction(axis);
    let product = |s: &Snapshot| {
        let about = |f: V2| (s.position_m - f).perp(&s.velocity_m_s);
        about(focus_m) * about(-focus_m)
    };
    let drifts = [1e12, 1e14].map(|stiffness| {
        let params = elliptic(free_mass(linear(stiffness, 1.0), 0.0), e, axis);
        let from = start(V2::new(3e-5, 5e-5), v * direction(0.9), 200.0);
        let mut plant = build(&params, &from, options(Method::Auto, 1e-11)).unwrap();
        assert_eq!(plant.method(), Method::Collocation);
        let first = product(&plant.snapshot());
        let mut drift = 0.0_f64;
        run(&mut plant, 0.3, &mut |s| {
            if s.mode == ContactMode::Flight {
                drift = drift.max((product(s) - first).abs());
            }
        });
        assert!(plant.meters().impacts > 40);
        near("speed", plant.snapshot().velocity_m_s.norm(), v, 1e-8);
        drift / (v * c).powi(2)
    });
    let soft = v * (10.0_f64 / 1e12).sqrt() / c;
    assert!(drifts[0] < 4.0 * soft, "{drifts:?} {soft}");
    assert!(drifts[1] < 0.15 * drifts[0], "{drifts:?}");
}

/// What has no power series: bores out of round with a free spin and a lagging magnet, and Hunt and Crossley's contact; with
/// friction, damping and unbalance, through bounces, slip and roll.
fn without_series() -> Vec<(PlantParams, Start)> {
    let mut all = Vec::new();
    let slow = start(V2::zeros(), V2::new(0.08, 0.02), 200.0);
    for (params, from) in [(bouncing(1e8), bouncing_start()), (onset_rig(), slow)] {
        let mut params = elliptic(params, 0.05, 0.3);
        params.spin = free_spin(0.05, 1.0);
        params.magnet = Some(magnet_of(100.0, 1.6e-4));
        all.push((params, from));
    }
    let mut falls = footnote_4();
    falls.rotor.eccentricity_m = 1e-5;
    falls.friction.sliding = falling(0.3, 0.1, 3.0);
    let struck = start(V2::new(2e-4, 0.0), V2::new(0.4, 0.0), 250.0);
    for (mut params, from, e) in [
        (bouncing(1e8), bouncing_start(), 0.75),
        (footnote_4(), struck, 0.8),
        (falls, struck, 0.8),
    ] {
        // As hard as the linear contact at the speed of the start.
        let (v, m) = (from.velocity_m_s.norm(), params.contact_mass_kg());
        let force_n = v * (params.contact.stiffness_n_m() * m).sqrt();
        let law = hertz(1.5, 1e-5, v, damping_for_restitution(e, v).unwrap());
        params.contact.law = law.with_peak_force(force_n, v, m).into();
        all.push((params, from));
    }
    all
}

/// Two tolerances end in the same place through the same modes, and the audit of energy closes.
#[test]
fn tolerances_agree_and_the_audit_closes() {
    for (case, (params, from)) in without_series().iter().enumerate() {
        let what = format!("case {case}");
        let ends = [1e-11, 1e-13].map(|rtol| {
            let mut plant = build(params, from, options(Method::Auto, rtol)).unwrap();
            assert_eq!(plant.method(), Method::Collocation);
            let inputs = Inputs {
                command_n: V2::new(60.0, -30.0),
                external_n: V2::new(0.0, 20.0),
            };
            let mut modes = Vec::new();
            for i in 1..=600_u32 {
                let mut on_change = |s: &Snapshot| modes.push(s.mode);
                plant
                    .advance(f64::from(i) * 5e-5, &inputs, &mut on_change)
                    .unwrap();
            }
            assert!(plant.meters().impacts > 1);
            closes(&what, plant.audit().residual(), 100.0 * rtol);
            (plant.snapshot().position_m, modes)
        });
        let [(loose, modes), (tight, others)] = ends;
        close(&what, loose, tight, 1e-5 * params.contact.clearance_m);
        assert_eq!(modes, others, "{what}");
    }
}

/// Turned with its ellipse, a run is the same run turned; without ellipticity it is the round bearing's.
#[test]
fn turns_with_the_ellipse_and_ends_in_the_circle() {
    let end = |params: &PlantParams, from: &Start| {
        let mut plant = build(params, from, options(Method::Collocation, 1e-11)).unwrap();
        run(&mut plant, 0.02, &mut |_| {});
        assert!(plant.meters().impacts > 0);
        plant.snapshot().position_m
    };
    let mut params = bouncing(1e8);
    params.rotor.eccentricity_m = 0.0;
    let near_m = 1e-7 * params.contact.clearance_m;
    let from = bouncing_start();
    let turned = |v: V2, angle: f64| nalgebra::Rotation2::new(angle) * v;
    let a = end(&elliptic(params, 0.1, 0.2), &from);
    for angle in [0.5, 2.0, -1.0] {
        let start = Start {
            velocity_m_s: turned(from.velocity_m_s, angle),
            ..from
        };
        let b = end(&elliptic(params, 0.1, 0.2 + angle), &start);
        close("turned", turned(a, angle), b, near_m);
    }
    let (round, none) = (end(&params, &from), end(&elliptic(params, 0.0, 0.2), &from));
    close("round", round, none, near_m);
    assert!((round - a).norm() > 1e5 * near_m);
}

/// Circles of steady whirl are for a bore that is the same all round: none is named for an ellipse, as for rings whose axes
/// differ, and none for a race, which turns along.
#[test]
fn steady_whirl_is_named_for_round_bores_only() {
    let of = |params: PlantParams| SteadyWhirl::from_params(&params);
    assert!(of(onset_rig()).is_some());
    assert_eq!(of(elliptic(onset_rig(), 0.0, 0.4)), of(onset_rig()));
    for ellipticity in [1e-6, 0.05, 0.2] {
        assert_eq!(of(elliptic(onset_rig(), ellipticity, 0.4)), None);
    }
    let raced = PlantParams {
        race: Some(race(1e-3, 0.0, 0.0)),
        ..onset_rig()
    };
    assert_eq!(of(raced), None);
}
