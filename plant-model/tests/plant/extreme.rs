//! Stiff, small, large and degenerate runs: every one states the physics that it must show.

use crate::support::*;
use std::f64::consts::TAU;

/// A load on rings of one gram, anisotropic by 50 %, comes to rest where each spring carries it:
/// N = F along F, each ring displaced by N·n_i/k_i on what carries it, the contact dented by N/k_c.
#[test]
fn light_anisotropic_rings_carry_a_load_by_their_stiffness() {
    for (method, rings) in each(&METHODS, &[1, 2]) {
        for mirrored in [false, true] {
            let swap = |v: V2| if mirrored { v.yx() } else { v };
            let of = |stiffness_n_m: V2| RingParams {
                stiffness_n_m: swap(stiffness_n_m),
                ..ring(1e-3, 0.0, 300.0)
            };
            let inner = of(V2::new(8.9e8, 4.45e8));
            let outer = of(V2::new(1.8e9, 3.6e9));
            let force = swap(V2::new(800.0, 600.0));
            let mut params = free_mass(linear(1e9, 0.5), 0.0);
            params.rotor.damping_n_s_m = 1.4e4;
            params.stator = stators(inner, outer)[rings];
            let outer_at = match rings {
                1 => V2::zeros(),
                _ => force.component_div(&outer.stiffness_n_m),
            };
            let along = force.normalize();
            let from = start(CLEARANCE_M * along, V2::zeros(), 0.0);
            let end = carry(&mut plant(&params, &from, method), 0.04, force);
            let inner_at = outer_at + force.component_div(&inner.stiffness_n_m);
            let at = inner_at + (CLEARANCE_M + force.norm() / 1e9) * along;
            near("N", end.normal_force_n, force.norm(), 1e-8);
            for axis in [0, 1] {
                near("inner", end.inner_ring.position[axis], inner_at[axis], 1e-7);
                near("rotor", end.position_m[axis], at[axis], 1e-7);
            }
            let most = 1e-7 * inner_at.norm();
            close("outer", end.outer_ring.position, outer_at, most);
        }
    }
}

/// Friction that falls as fast as within a nanometre per second, μ = μ_∞ + Δ·exp(−v/v0): standing
/// holds up to μ_0·N. Pushed beyond with T, or sliding until it sticks, the time for a speed v is
/// m·v0/D·(v/v0 + ln((D + E·exp(−v/v0))/(D + E))), D = T − μ_∞N and E = −ΔN, or D = μ_∞N and E = ΔN.
#[test]
fn falling_friction_with_a_tiny_speed_scale_holds_and_breaks_loose() {
    let (press, k, at_rest, at_speed) = (1e4, 1e9, 0.3, 0.1);
    // What falls within 5 ps is beyond collocation, which says so.
    for (method, scale) in [(Method::Series, 1e-9)]
        .into_iter()
        .chain(each(&METHODS, &[1e-6, 1e-3]))
    {
        let mut params = free_mass(linear(k, 0.5), 0.0);
        params.contact.clearance_m = 1e-2;
        params.friction.sliding = falling(at_rest, at_speed, scale);
        let takes_s = |v: f64, d: f64, e: f64| {
            let x = v / scale;
            MASS_KG * scale / d * (x + ((d + e * (-x).exp()) / (d + e)).ln())
        };
        let pressed = |v: f64| start(V2::new(1e-2 + press / k, 0.0), V2::new(0.0, v), 0.0);
        let mut held = plant(&params, &pressed(0.0), method);
        let end = carry(&mut held, 1e-3, V2::new(press, 2.9e3));
        assert_eq!(end.mode, ContactMode::Roll);
        assert!(end.velocity_m_s.norm() <= 1e-12);

        let (t, push) = (1e-4, 3.1e3);
        let mut loose = plant(&params, &pressed(0.0), method);
        let end = carry(&mut loose, t, V2::new(press, push));
        let fall = (at_rest - at_speed) * press;
        let exact = takes_s(end.velocity_m_s.y, push - at_speed * press, -fall);
        near("loose", t, exact, 1e-3);

        let v = 1e-2;
        let mut slides = plant(&params, &pressed(v), method);
        let mut stuck = None;
        let end = carry_with(&mut slides, 2e-4, V2::new(press, 0.0), &mut |s| {
            stuck.get_or_insert((s.t_s, s.mode));
        });
        let (t, mode) = stuck.unwrap();
        assert_eq!((mode, end.mode), (ContactMode::Roll, ContactMode::Roll));
        near("brakes", t, takes_s(v, at_speed * press, fall), 1e-3);
    }
}

/// An orbit on the shaft that reaches c·(1 + δ) touches once per half turn for δ > 0, never for δ < 0,
/// and at δ = 0 it makes no difference. How deep it goes follows from energy and angular momentum.
#[test]
fn a_grazing_orbit_touches_just_when_it_reaches_the_wall() {
    let (k, kc) = (4e5, 1e9);
    let omega: f64 = (k / MASS_KG).sqrt();
    let mut params = free_mass(linear(kc, 1.0), 0.0);
    params.rotor.stiffness_n_m = k;
    let deltas = [-1e-3, -1e-6, -1e-9, -1e-12, 0.0, 1e-9, 1e-6, 1e-3, 0.1];
    for (method, delta) in each(&METHODS, &deltas) {
        let (a, b) = (0.5 * CLEARANCE_M, CLEARANCE_M * (1.0 + delta));
        let v = omega * b;
        let from = start(V2::new(a, 0.0), V2::new(0.0, v), 0.0);
        let mut plant = plant(&params, &from, method);
        let quarter = carry(&mut plant, 0.25 * TAU / omega, V2::zeros());
        let half = carry(&mut plant, 0.5 * TAU / omega, V2::zeros());
        let meters = plant.meters();
        if delta == 0.0 {
            // Decided by the last bit; the depth is none.
            assert!(meters.peak_penetration_m <= 1e-12 * CLEARANCE_M);
        } else {
            assert_eq!(meters.impacts, u64::from(delta > 0.0), "δ = {delta:e}");
        }
        if delta <= 0.0 {
            near("closest", quarter.position_m.norm(), b, 1e-12);
            close("half", half.position_m, -from.position_m, 1e-5 * a);
            continue;
        }
        // The radial speed vanishes: E − L²/2mρ² − kρ²/2 − k_c(ρ − c)²/2 = 0.
        let energy = 0.5 * MASS_KG * v * v + 0.5 * k * a * a;
        let left = |depth: f64| {
            let r = CLEARANCE_M + depth;
            let turning = 0.5 * MASS_KG * (a * v / r).powi(2);
            energy - turning - 0.5 * k * r * r - 0.5 * kc * depth * depth
        };
        let depth = root_between([0.0, delta * CLEARANCE_M], left);
        near("depth", meters.peak_penetration_m, depth, 1e-3);
    }
}

/// A wall that a load (or a negative stiffness) overcomes: the rotor leaves everything that the model
/// describes, and the run says so.
#[test]
fn a_wall_that_cannot_hold_ends_in_a_named_error() {
    for method in METHODS {
        let soft = free_mass(linear(1e6, 0.5), 0.1);
        let mut unstable = soft;
        unstable.rotor.stiffness_n_m = -2e6;
        for (params, force) in [(soft, 1e6), (unstable, 1.0)] {
            let mut plant = plant(&params, &start(V2::zeros(), V2::zeros(), 100.0), method);
            match plant.advance(1.0, &load(V2::new(force, 0.0)), &mut |_| {}) {
                Err(PlantError::Diverged { radius_m, .. }) => assert!(radius_m > 0.2),
                other => panic!("{other:?}"),
            }
        }
    }
}

/// Between frictionless elastic walls the rotor goes to and fro at one speed for ever: touches follow
/// each other after a chord's time and a contact's, energy and angular momentum stay.
#[test]
fn an_elastic_billiard_keeps_time_energy_and_angular_momentum() {
    for (method, k) in each(&METHODS, &[1e8, 1e12]) {
        let params = free_mass(linear(k, 1.0), 0.0);
        let (at, v) = (V2::new(1e-4, 0.0), V2::new(0.03, 0.08));
        let mut plant = plant(&params, &start(at, v, 300.0), method);
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
        near("L", momentum, at.perp(&v), 1e-8);
        if end.mode == ContactMode::Flight {
            near("v", end.velocity_m_s.norm(), v.norm(), 1e-8);
        }
    }
}

/// All lengths and forces by λ, moments of inertia by λ²: the same motion, λ times as large; for a
/// power of two to the bit. Clearances from below 1 µm to above 10 mm.
#[test]
fn a_scaled_problem_has_the_scaled_solution() {
    let run = |lambda: f64, method: Method| {
        let mut params = bouncing(1e8);
        params.spin = free_spin(1e-4 * lambda * lambda, 0.0);
        params.rotor.eccentricity_m *= lambda;
        params.rotor.contact_radius_m *= lambda;
        params.contact.clearance_m *= lambda;
        params.friction.rolling_coefficient = 0.01;
        let mut from = bouncing_start();
        from.velocity_m_s *= lambda;
        let mut plant = plant(&params, &from, method);
        let samples = (1..=50).map(|i| {
            let force = lambda * V2::new(3.0, if i % 2 == 0 { 20.0 } else { -20.0 });
            carry(&mut plant, f64::from(i) * 1e-3, force)
        });
        samples.collect::<Vec<_>>()
    };
    for method in METHODS {
        let one = run(1.0, method);
        assert!(one.iter().any(|s| s.mode.in_contact()));
        for lambda in [2_f64.powi(-9), 2_f64.powi(6), 1e-6 / 3e-4, 1e-2 / 3e-4] {
            // Collocation solves linear systems, whose pivots depend on the units.
            let exact = method != Method::Collocation && lambda.log2().fract() == 0.0;
            for (a, b) in one.iter().zip(run(lambda, method)) {
                let tolerance = if exact { 0.0 } else { 1e-7 * lambda * 3e-4 };
                close("scaled", b.position_m, lambda * a.position_m, tolerance);
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
                run_to(&mut plant, f64::from(i) / f64::from(rate));
            }
            carry(&mut plant, 1.0, V2::zeros())
        });
        let first = ends[0];
        for end in &ends[1..] {
            assert_eq!(end.mode, first.mode);
            close("end", end.position_m, first.position_m, 1e-6 * 3e-4);
            let [a, b] = [end, &first].map(|s| s.velocity_m_s.norm());
            near("v", a, b, 1e-6);
        }
    }
}

/// A negative stiffness drives the rotor out as cosh, onto the wall after acosh(c/x0)/σ, and holds it
/// there: N = |k|·(c + A) with k_c·A = N. By series: its energies cancel to a millionth in flight, which is exact.
#[test]
fn a_negative_stiffness_lays_the_rotor_on_the_wall() {
    for (k, kc, settles_s) in [(-3e5, 1e8, 0.1), (-9e5, 1e6, 0.8), (-1e5, 1e13, 0.02)] {
        let mut params = free_mass(linear(kc, 0.2), 0.1);
        params.rotor.stiffness_n_m = k;
        let x0 = 1e-7;
        let from = start(V2::new(x0, 0.0), V2::zeros(), 0.0);
        let mut plant = plant(&params, &from, Method::Series);
        let growth = (-k / MASS_KG).sqrt();
        let touches = (CLEARANCE_M / x0).acosh() / growth;
        let early = carry(&mut plant, 0.9 * touches, V2::zeros());
        let out = x0 * (growth * 0.9 * touches).cosh();
        near("x", early.position_m.x, out, 1e-12);
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
