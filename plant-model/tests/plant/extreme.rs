//! Long, fast, slow, small, large and degenerate runs.

use std::f64::consts::TAU;

use crate::support::bouncing::{bouncing, bouncing_start};
use crate::support::plants::footnote_4;
use plant_model::params::*;
use plant_model::{Method, Mode, PlantError, V2};

use crate::support::bench::{
    CLEARANCE_M, MASS_KG, METHODS, RADIUS_M, carry, carry_with, free_mass, free_spin, load, near,
    plant, start,
};

/// An orbit on the shaft that reaches c·(1 + δ) touches once per half turn for δ > 0, never for δ < 0,
/// and at δ = 0 it makes no difference. How deep it goes follows from energy and angular momentum.
#[test]
fn a_grazing_orbit_touches_just_when_it_reaches_the_wall() {
    let (k, kc) = (4e5, 1e9);
    let omega: f64 = (k / MASS_KG).sqrt();
    let mut params = free_mass(kc, 1.0, 0.0);
    params.rotor.stiffness_n_m = k;
    for method in METHODS {
        for delta in [-1e-3, -1e-6, -1e-9, -1e-12, 0.0, 1e-9, 1e-6, 1e-3, 0.1] {
            let (a, b) = (0.5 * CLEARANCE_M, CLEARANCE_M * (1.0 + delta));
            let v = omega * b;
            let from = start(V2::new(a, 0.0), V2::new(0.0, v), 0.0);
            let mut plant = plant(&params, &from, method);
            let quarter = carry(&mut plant, 0.25 * TAU / omega, V2::zeros());
            if delta <= 0.0 {
                near("closest", quarter.position_m.norm(), b, 1e-12);
            }
            let half = carry(&mut plant, 0.5 * TAU / omega, V2::zeros());
            let meters = plant.meters();
            match delta {
                // Decided by the last bit; the depth is none.
                0.0 => assert!(meters.peak_penetration_m <= 1e-12 * CLEARANCE_M),
                _ => assert_eq!(meters.impacts, u64::from(delta > 0.0), "δ = {delta:e}"),
            }
            if delta <= 0.0 {
                let apart = (half.position_m + from.position_m).norm();
                assert!(apart <= 1e-5 * a, "δ = {delta:e}: {apart:e}");
            } else {
                // The radial speed vanishes: E − L²/2mρ² − kρ²/2 − k_c(ρ − c)²/2 = 0.
                let energy = 0.5 * MASS_KG * v * v + 0.5 * k * a * a;
                let left = |depth: f64| {
                    let r = CLEARANCE_M + depth;
                    let turning = 0.5 * MASS_KG * (a * v / r).powi(2);
                    energy - turning - 0.5 * k * r * r - 0.5 * kc * depth * depth
                };
                let (mut low, mut high) = (0.0, delta * CLEARANCE_M);
                for _ in 0..200 {
                    let middle = 0.5 * (low + high);
                    *(if left(middle) > 0.0 {
                        &mut low
                    } else {
                        &mut high
                    }) = middle;
                }
                near("depth", meters.peak_penetration_m, low, 1e-3);
            }
        }
    }
}

/// At rest in the centre nothing acts, whatever the stiffness, the spin or the stator: there it stays
/// to the bit, without energy turned over.
#[test]
fn at_rest_in_the_centre_it_stays_for_ever() {
    for method in METHODS {
        for stiffness in [9.1e5, 0.0, -3e5] {
            for spin in [0.0, 400.0, -TAU * 1000.0] {
                let mut params = footnote_4();
                params.rotor.stiffness_n_m = stiffness;
                params.stator = match spin {
                    0.0 => params.stator,
                    _ => StatorParams::Rigid,
                };
                let from = start(V2::zeros(), V2::zeros(), spin);
                let mut plant = plant(&params, &from, method);
                let t = if spin == 0.0 { 1.0 } else { 100.0 };
                let end = carry(&mut plant, t, V2::zeros());
                assert_eq!(
                    (end.position_m, end.velocity_m_s),
                    (V2::zeros(), V2::zeros())
                );
                assert_eq!((end.spin_rad_s, plant.meters().impacts), (spin, 0));
                assert_eq!(plant.audit().residual(), 0.0);
            }
        }
    }
}

/// A rotor that starts rolling rolls on. With j = J/mR² from 1e-9 to 1e9 its speed obeys
/// v^(1 + j)·ρ·exp(d·t/m) = const, the exact integral of eqs (2.1), (2.7) with v + ΩR = 0.
#[test]
fn rolling_goes_on_with_rotor_and_spin_as_one_inertia() {
    let (v, d) = (1.0, 50.0);
    for method in METHODS {
        for j in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
            for sense in [1.0, -1.0] {
                let mut params = free_mass(1e10, 1.0, 0.3);
                params.rotor.damping_n_s_m = d;
                params.spin = free_spin(j * MASS_KG * RADIUS_M * RADIUS_M);
                let half = 0.5 * CLEARANCE_M;
                let radius = half + (half * half + MASS_KG * v * v / 1e10).sqrt();
                let from = start(
                    V2::new(radius, 0.0),
                    V2::new(0.0, sense * v),
                    -sense * v / RADIUS_M,
                );
                let mut plant = plant(&params, &from, method);
                let mut changes = 0;
                let t = 0.1;
                let end = carry_with(&mut plant, t, V2::zeros(), &mut |_| changes += 1);
                assert_eq!((end.mode, changes), (Mode::Roll, 0));
                let now = sense * end.contact_tangential_speed_m_s;
                let slip = (now + sense * RADIUS_M * end.spin_rad_s).abs();
                assert!(slip <= 1e-13 * v, "{slip:e}");
                let shrunk = (1.0 + j) * (now / v).ln() + (end.position_m.norm() / radius).ln();
                // ln v is known to round-off, j times over.
                let exact = -d * t / MASS_KG;
                near("decay", shrunk, exact, 1e-8 + 1e-11 * j);
            }
        }
    }
}

/// A wall that a load (or a negative stiffness) overcomes: the rotor leaves everything that the model
/// describes, and the run says so.
#[test]
fn a_wall_that_cannot_hold_ends_in_a_named_error() {
    for method in METHODS {
        let soft = free_mass(1e6, 0.5, 0.1);
        let mut unstable = soft;
        unstable.rotor.stiffness_n_m = -2e6;
        for (params, force) in [(soft, 1e6), (unstable, 1.0)] {
            let from = start(V2::zeros(), V2::zeros(), 100.0);
            let ended =
                plant(&params, &from, method).advance(1.0, &load(V2::new(force, 0.0)), &mut |_| {});
            match ended {
                Err(PlantError::Diverged { radius_m, .. }) => assert!(radius_m > 0.2),
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Pressed on with N and pushed along by ±T > μN, turned every microsecond: the slip gains
/// (T − μN)τ/m, loses at (T + μN)/m and reverses within each; below the cone nothing moves.
#[test]
fn slip_that_reverses_every_microsecond_follows_coulomb() {
    let (press, mu, tau, samples) = (1e4, 0.3, 1e-6, 2000);
    let k = 1e9;
    for method in METHODS {
        for push in [5e3, 1e5, 2.9e3] {
            let mut params = free_mass(k, 0.5, mu);
            params.contact.clearance_m = 1e-2;
            let from = start(V2::new(1e-2 + press / k, 0.0), V2::zeros(), 0.0);
            let mut plant = plant(&params, &from, method);
            let (gain, loss) = ((push - mu * press) / MASS_KG, (push + mu * press) / MASS_KG);
            let (mut v, mut path, mut y) = (0.0_f64, 0.0, 0.0);
            let mut turns = 0;
            let mut end = plant.snapshot();
            for i in 0..samples {
                let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
                let t = f64::from(i + 1) * tau;
                end = carry_with(&mut plant, t, V2::new(press, sign * push), &mut |s| {
                    turns += u32::from(matches!(s.mode, Mode::SlipPositive | Mode::SlipNegative));
                });
                if gain > 0.0 {
                    // Against the push until it stands, then along with it.
                    let stops = -sign * v / loss;
                    let along = gain * (tau - stops.max(0.0));
                    let (back, forth) = (
                        0.5 * stops.max(0.0) * v.abs(),
                        0.5 * along * (tau - stops.max(0.0)),
                    );
                    path += back + forth;
                    y += sign * (forth - back);
                    v = sign * along;
                }
            }
            if gain > 0.0 {
                assert!(
                    (i64::from(turns) - i64::from(samples)).abs() <= 1,
                    "{turns}"
                );
                near("v", end.velocity_m_s.y, v, 1e-4);
                near("y", end.position_m.y, y, 1e-2);
                near(
                    "heat",
                    plant.audit().flows.sliding_friction,
                    mu * press * path,
                    1e-6,
                );
            } else {
                assert_eq!((end.mode, turns), (Mode::Roll, 0));
                assert!(end.velocity_m_s.norm() <= 1e-12, "{}", end.velocity_m_s);
                assert!(end.position_m.y.abs() <= 1e-15, "{}", end.position_m);
            }
        }
    }
}

/// A hundred seconds on the shaft, in one go or sampled at 1 kHz, end where the damped oscillator does.
#[test]
fn a_hundred_seconds_of_flight_end_where_the_oscillator_does() {
    let (k, d, t) = (9.1e5, 0.02, 100.0);
    let mut params = free_mass(1e9, 0.7, 0.1);
    params.rotor.stiffness_n_m = k;
    params.rotor.damping_n_s_m = d;
    let decay = 0.5 * d / MASS_KG;
    let omega = (k / MASS_KG - decay * decay).sqrt();
    let (at, v) = (V2::new(1e-4, 2e-5), V2::new(-0.01, 0.03));
    let exact = (-decay * t).exp()
        * (at * (omega * t).cos() + (v + decay * at) / omega * (omega * t).sin());
    for samples in [1_u32, 100_000] {
        let mut plant = plant(&params, &start(at, v, 100.0), Method::Series);
        for i in 1..=samples {
            plant
                .advance(
                    t * f64::from(i) / f64::from(samples),
                    &load(V2::zeros()),
                    &mut |_| {},
                )
                .unwrap();
        }
        let end = carry(&mut plant, t, V2::zeros());
        near(
            "x",
            (end.position_m - exact).norm() / exact.norm() + 1.0,
            1.0,
            1e-9,
        );
        assert_eq!(plant.meters().impacts, 0);
    }
}

/// Between frictionless elastic walls the rotor goes to and fro at one speed for ever: touches follow
/// each other after a chord's time and a contact's, energy and angular momentum stay.
#[test]
fn an_elastic_billiard_keeps_time_energy_and_angular_momentum() {
    for method in METHODS {
        for k in [1e8, 1e12] {
            let params = free_mass(k, 1.0, 0.0);
            let from = start(V2::new(1e-4, 0.0), V2::new(0.03, 0.08), 300.0);
            let mut plant = plant(&params, &from, method);
            let mut touches = Vec::new();
            let end = carry_with(&mut plant, 0.5, V2::zeros(), &mut |s| {
                if s.mode.in_contact() {
                    touches.push(s.t_s);
                }
            });
            assert!(touches.len() > 95, "{}", touches.len());
            let period = touches[1] - touches[0];
            let all = touches[touches.len() - 1] - touches[0];
            near("periods", all / period, (touches.len() - 1) as f64, 1e-8);
            let momentum = end.position_m.perp(&end.velocity_m_s);
            near(
                "L",
                momentum,
                from.position_m.perp(&from.velocity_m_s),
                1e-8,
            );
            if end.mode == Mode::Flight {
                near("v", end.velocity_m_s.norm(), from.velocity_m_s.norm(), 1e-8);
            }
        }
    }
}

/// All lengths and forces by λ, moments of inertia by λ²: the same motion, λ times as large; for a
/// power of two to the bit. Clearances from below 1 µm to above 10 mm.
#[test]
fn a_scaled_problem_has_the_scaled_solution() {
    let run = |lambda: f64, method: Method| {
        let mut params = bouncing(1e8);
        params.spin = free_spin(1e-4 * lambda * lambda);
        params.rotor.eccentricity_m *= lambda;
        params.rotor.contact_radius_m *= lambda;
        params.contact.clearance_m *= lambda;
        params.friction.rolling_coefficient = 0.01;
        let mut from = bouncing_start();
        from.velocity_m_s *= lambda;
        let mut plant = plant(&params, &from, method);
        (1..=50)
            .map(|i| {
                let force = lambda * V2::new(3.0, if i % 2 == 0 { 20.0 } else { -20.0 });
                carry(&mut plant, f64::from(i) * 1e-3, force)
            })
            .collect::<Vec<_>>()
    };
    for method in METHODS {
        let one = run(1.0, method);
        assert!(one.iter().any(|s| s.mode.in_contact()));
        for lambda in [2_f64.powi(-9), 2_f64.powi(6), 1e-6 / 3e-4, 1e-2 / 3e-4] {
            // Collocation solves linear systems, whose pivots depend on the units.
            let exact = method != Method::Collocation && lambda.log2().fract() == 0.0;
            for (a, b) in one.iter().zip(run(lambda, method)) {
                let apart = (lambda * a.position_m - b.position_m).norm();
                let tolerance = if exact { 0.0 } else { 1e-7 * lambda * 3e-4 };
                assert!(apart <= tolerance, "λ = {lambda:e}: {apart:e} at {}", a.t_s);
                assert_eq!(a.mode, b.mode);
                if exact {
                    assert_eq!(lambda * a.velocity_m_s, b.velocity_m_s);
                    assert_eq!(lambda * a.normal_force_n, b.normal_force_n);
                    assert_eq!(a.spin_rad_s, b.spin_rad_s);
                }
            }
        }
    }
}

/// How often a run is sampled changes nothing: 1 Hz to 100 kHz end in the same state.
#[test]
fn the_control_rate_does_not_change_the_motion() {
    for method in METHODS {
        let ends = [1_u32, 10, 100, 1000, 10_000, 100_000].map(|rate| {
            let mut plant = plant(&bouncing(1e8), &bouncing_start(), method);
            for i in 1..rate {
                let t = f64::from(i) / f64::from(rate);
                plant.advance(t, &load(V2::zeros()), &mut |_| {}).unwrap();
            }
            carry(&mut plant, 1.0, V2::zeros())
        });
        for end in &ends[1..] {
            assert_eq!(end.mode, ends[0].mode);
            let apart = (end.position_m - ends[0].position_m).norm();
            assert!(apart <= 1e-6 * 3e-4, "{apart:e}");
            near(
                "v",
                end.velocity_m_s.norm(),
                ends[0].velocity_m_s.norm(),
                1e-6,
            );
        }
    }
}

/// A negative stiffness drives the rotor out as cosh, onto the wall after acosh(c/x0)/σ, and holds it
/// there: N = |k|·(c + A) with k_c·A = N.
#[test]
fn a_negative_stiffness_lays_the_rotor_on_the_wall() {
    // Its energies cancel to a millionth in flight, which is exact by series.
    for method in [Method::Series] {
        for (k, kc, settles_s) in [(-3e5, 1e8, 0.1), (-9e5, 1e6, 0.8), (-1e5, 1e13, 0.02)] {
            let mut params = free_mass(kc, 0.2, 0.1);
            params.rotor.stiffness_n_m = k;
            let x0 = 1e-7;
            let mut plant = plant(&params, &start(V2::new(x0, 0.0), V2::zeros(), 0.0), method);
            let growth = (-k / MASS_KG).sqrt();
            let touches = (CLEARANCE_M / x0).acosh() / growth;
            let early = carry(&mut plant, 0.9 * touches, V2::zeros());
            near(
                "x",
                early.position_m.x,
                x0 * (growth * 0.9 * touches).cosh(),
                1e-12,
            );
            let mut touch = None;
            let end = carry_with(&mut plant, touches + settles_s, V2::zeros(), &mut |s| {
                touch.get_or_insert(s.t_s);
            });
            near("touch", touch.unwrap(), touches, 1e-12);
            let depth = -k * CLEARANCE_M / (kc + k);
            near("depth", end.penetration_m, depth, 1e-6);
            near("N", end.normal_force_n, kc * depth, 1e-6);
        }
    }
}
