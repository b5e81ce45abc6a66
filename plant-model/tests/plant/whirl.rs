//! Whirl in contact against circles that can be written down.

use crate::support::*;
use nalgebra::Complex;
use plant_model::ContactMode::{Roll, Seated, SlipNegative, SlipPositive};
use plant_model::analysis::arrest::{Arrest, circle_radius_m};
use std::f64::consts::TAU;

/// Steady sliding whirl in an elastic stator (Black's condition with friction): with receptances α, β
/// of rotor and ring, Im[(α + β)(1 + iμ)] = 0 at ω and N = δ/(−Re[(α + β)(1 + iμ)] − 1/k_c).
#[test]
fn steady_sliding_whirl_in_an_elastic_stator() {
    let (m, k, d, ring_m, ring_k, ring_d) = (10.0, 4e5, 200.0, 5.0, 2e7, 3000.0);
    let (mu, clearance, contact_k) = (0.2, 3e-4, 1e8);
    let admittance = |w: f64| {
        let rotor = Complex::new(k - m * w * w, -w * d).inv();
        let ring = Complex::new(ring_k - ring_m * w * w, -w * ring_d).inv();
        (rotor, (rotor + ring) * Complex::new(1.0, mu))
    };
    let omega = root_between([850.0, 950.0], |w| admittance(w).1.im);
    let (rotor, both) = admittance(omega);
    let force = clearance / (-both.re - 1.0 / contact_k);
    let radius = rotor.norm() * force * (1.0 + mu * mu).sqrt();

    let mut params = free_mass(linear(contact_k, 1.0), mu);
    (params.rotor.stiffness_n_m, params.rotor.damping_n_s_m) = (k, d);
    params.stator = StatorParams::OneMass(ring(ring_m, ring_k, ring_d));
    params.contact.clearance_m = clearance;
    let from = start(V2::new(radius, 0.0), V2::new(0.0, -radius * omega), 400.0);
    let mut plant = build(&params, &from, series()).unwrap();
    run_to(&mut plant, 3.0);
    let before = plant.snapshot();
    run_to(&mut plant, 3.0 + 40.0 * TAU / omega);
    let after = plant.snapshot();
    let turns = (after.whirl_angle_rad - before.whirl_angle_rad) / TAU;
    near("ω", turns, -40.0, 1e-8);
    near("N", after.normal_force_n, force, 1e-8);
    near("radius", after.position_m.norm(), radius, 1e-8);
}

/// Below ω0·(D/μ + √(1 + (D/μ)²)) damping wins over friction and the rotor leaves the wall; above it
/// friction wins and the whirl grows.
#[test]
fn sliding_whirl_on_a_rigid_wall_has_its_threshold() {
    let mut params = onset_rig();
    params.contact.law = linear(1e10, 1.0).into();
    let natural = params.natural_frequency_rad_s().unwrap();
    let ratio = 0.003 / 0.125;
    let threshold = natural * (ratio + f64::hypot(ratio, 1.0));
    let (m, k, c) = (MASS_KG, params.rotor.stiffness_n_m, CLEARANCE_M);
    for (share, grows) in [(0.999, false), (1.001, true)] {
        let omega = share * threshold;
        let radius = c + (m * omega * omega - k) * c / 1e10;
        let from = start(V2::new(radius, 0.0), V2::new(0.0, -omega * radius), 2000.0);
        let mut plant = build(&params, &from, Options::default()).unwrap();
        run_to(&mut plant, 0.5);
        assert_eq!(plant.mode().in_contact(), grows, "at {share} of it");
        assert_eq!(plant.snapshot().velocity_m_s.norm() > omega * radius, grows);
    }
}

/// Rolling whirl: v = ΩR on the circle (k + k_c)·r² − k_c·δ·r − m·v² = 0, carried by friction d·v ≤ μN. Fast, it turns several
/// times within one step or sample: the contact angle counts all turns.
#[test]
fn rolling_whirl_keeps_its_circle_and_counts_its_turns() {
    let (k, m, c) = (4e5, 10.0, 3e-4);
    for (v, kc, damping_ratio, damping_n_s_m, t, rtol, share) in [
        (1.0, 1e8, 0.0, 200.0, 0.3, 1e-12, 1e-9),
        (5.0, 1e11, 3.0, 0.0, 0.08, 1e-7, 1e-5),
    ] {
        for (method, samples) in each(&METHODS, &[1, 400]) {
            let mut params = bouncing(kc);
            params.rotor.eccentricity_m = 0.0;
            params.rotor.damping_n_s_m = damping_n_s_m;
            law_of(&mut params).damping_n_s_m = 2.0 * damping_ratio * f64::sqrt(kc * m);
            let half = kc * c / (2.0 * (k + kc));
            let radius = half + (half * half + m * v * v / (k + kc)).sqrt();
            let spin = v / params.rotor.contact_radius_m;
            let from = start(V2::new(0.0, radius), V2::new(v, 0.0), spin);
            let mut plant = build(&params, &from, options(method, rtol)).unwrap();
            sampled(&mut plant, t, samples);
            let now = plant.snapshot();
            assert_eq!(now.mode, Roll);
            near("radius", now.position_m.norm(), radius, share);
            near("angle", now.whirl_angle_rad, -v / radius * t, share);
            let off_n = now.sliding_force_n + damping_n_s_m * v;
            assert!(off_n.abs() < 5e-9 * m * v * v / radius, "{off_n}");
        }
    }
}

/// A rotor that starts rolling rolls on. With j = J/mR² from 1e-9 to 1e9 its speed obeys
/// v^(1 + j)·ρ·exp(d·t/m) = const, the exact integral of eqs (2.1), (2.7) with v + ΩR = 0.
#[test]
fn rolling_goes_on_with_rotor_and_spin_as_one_inertia() {
    let (v, d, t) = (1.0, 50.0, 0.1);
    for (method, j) in each(&METHODS, &[1e-9, 1e-3, 1.0, 1e3, 1e9]) {
        for sense in [1.0, -1.0] {
            let mut params = free_mass(linear(1e10, 1.0), 0.3);
            params.rotor.damping_n_s_m = d;
            params.spin = free_spin(j * MASS_KG * RADIUS_M * RADIUS_M, 0.0);
            let half = 0.5 * CLEARANCE_M;
            let radius = half + (half * half + MASS_KG * v * v / 1e10).sqrt();
            let along = V2::new(0.0, sense * v);
            let from = start(V2::new(radius, 0.0), along, -sense * v / RADIUS_M);
            let mut plant = plant(&params, &from, method);
            let mut changes = 0;
            let end = carry_with(&mut plant, t, V2::zeros(), &mut |_| changes += 1);
            assert_eq!((end.mode, changes), (Roll, 0));
            let now = sense * end.contact_tangential_speed_m_s;
            let slip = (now + sense * RADIUS_M * end.spin_rad_s).abs();
            assert!(slip <= 1e-13 * v, "{slip:e}");
            let shrunk = (1.0 + j) * (now / v).ln() + (end.position_m.norm() / radius).ln();
            // ln v is known to round-off, j times over.
            near("decay", shrunk, -d * t / MASS_KG, 1e-8 + 1e-11 * j);
        }
    }
}

/// The best force, at once and in the best direction all the time, takes the momentum out of a whirl in the time that
/// the circles in balance give: on a hard wall, and on two so soft that the whirl begins at 1.5 and 3.5 clearances.
/// What is left is the vibration that the inward part starts.
#[test]
fn whirl_is_arrested_in_the_time_of_circles_in_balance() {
    for (contact_n_m, within) in [(1e10, 0.001), (1e8, 0.02), (2e7, 0.03)] {
        let mut params = onset_rig();
        params.contact.law = linear(contact_n_m, 0.5).into();
        let (force_n, mu, share) = (1500.0, 0.125, 0.5);
        let arrest = Arrest::new(&params, force_n).unwrap();
        let v = 0.85 * arrest.limit_m_s;
        let r = circle_radius_m(&params, v);
        // Backward is clockwise under a spin that is counter-clockwise.
        let from = start(V2::new(r, 0.0), V2::new(0.0, -v), 300.0);
        params.magnet = Some(magnet_of(2.0 * force_n, 0.0));
        let mut plant = build(&params, &from, series()).unwrap();
        let (step, mut t) = (2e-6, 0.0);
        let momentum = |plant: &mut Plant| {
            let now = plant.snapshot();
            -now.position_m.perp(&now.velocity_m_s)
        };
        while momentum(&mut plant) > share * r * v {
            let n = plant.snapshot().position_m.normalize();
            // Against b̂ + μ·n̂ with b̂ clockwise.
            let against = V2::new(n.y, -n.x) + mu * n;
            let inputs = Inputs {
                command_n: -force_n * against.normalize(),
                external_n: V2::zeros(),
            };
            t += step;
            plant.advance(t, &inputs, &mut |_| {}).unwrap();
            assert!(t < 0.1, "never at {contact_n_m:e}");
        }
        near("time", t, arrest.time_s(v, share), within);
    }
}

/// A load presses a rotor with rolling friction onto the wall: it comes to sit where what is left of
/// the load along the wall lies between μ − μ_r and μ + μ_r of the normal force, and stays.
#[test]
fn a_load_seats_the_rotor_within_the_friction_cones() {
    let mut params = onset_rig();
    params.friction.rolling_coefficient = 0.025;
    params.rotor.damping_n_s_m = 2000.0;
    let from = start(V2::new(1.9e-4, 0.0), V2::zeros(), 250.0);
    let mut plant = build(&params, &from, Options::default()).unwrap();
    let force = V2::new(500.0, 0.0);
    plant.advance(0.3, &load(force), &mut |_| {}).unwrap();
    let now = plant.snapshot();
    assert_eq!(now.mode, Seated);
    assert!(now.velocity_m_s.norm() < 1e-9);
    let normal = now.position_m.normalize();
    let left = force - params.rotor.stiffness_n_m * now.position_m;
    near("N", now.normal_force_n, left.dot(&normal), 1e-6);
    let share = left.dot(&V2::new(-normal.y, normal.x)) / now.normal_force_n;
    assert!((0.1..=0.15).contains(&share), "{share}");
}

/// Mode changes and end state of a problem with flight, slip and roll, from an independent code, at two
/// contact stiffnesses.
#[test]
fn bouncing_into_rolling_matches_an_independent_solution() {
    let soft = V2::new(-4.205_650_712_3e-4, -2.680_261_826_5e-4);
    let stiff = V2::new(2.999_149_339_61e-4, -4.508_778_178_1e-5);
    for (contact_stiffness_n_m, count, last_s, end_m) in [
        (1e8, 6, 0.008_847_779_416, soft),
        (1e10, 14, 0.005_794_092_835, stiff),
    ] {
        let params = bouncing(contact_stiffness_n_m);
        let mut plant = build(&params, &bouncing_start(), series()).unwrap();
        let mut changes = Vec::new();
        let mut on_change = |s: &Snapshot| changes.push((s.t_s, s.mode));
        plant
            .advance(0.2, &Inputs::default(), &mut on_change)
            .unwrap();
        let (t, mode) = *changes.last().unwrap();
        assert_eq!((changes.len(), mode), (count, Roll));
        assert!((t - last_s).abs() < 1e-12, "{t}");
        close("end", plant.snapshot().position_m, end_m, 3e-10 * 3e-4);
    }
}

/// Pressed on with N and pushed along by ±T > μN, turned every microsecond: the slip gains
/// (T − μN)τ/m, loses at (T + μN)/m and reverses within each; below the cone nothing moves.
#[test]
fn slip_that_reverses_every_microsecond_follows_coulomb() {
    let (press, mu, tau, samples, k) = (1e4, 0.3, 1e-6, 2000, 1e9);
    for (method, push) in each(&METHODS, &[5e3, 1e5, 2.9e3]) {
        let mut params = free_mass(linear(k, 0.5), mu);
        params.contact.clearance_m = 1e-2;
        let from = start(V2::new(1e-2 + press / k, 0.0), V2::zeros(), 0.0);
        let mut plant = plant(&params, &from, method);
        let (gain, loss) = ((push - mu * press) / MASS_KG, (push + mu * press) / MASS_KG);
        let (mut v, mut path, mut y, mut turns) = (0.0_f64, 0.0, 0.0, 0_i64);
        let mut end = plant.snapshot();
        for i in 0..samples {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            let t = f64::from(i + 1) * tau;
            end = carry_with(&mut plant, t, V2::new(press, sign * push), &mut |s| {
                turns += i64::from(matches!(s.mode, SlipPositive | SlipNegative));
            });
            if gain > 0.0 {
                // Against the push until it stands, then along with it.
                let stops = (-sign * v / loss).max(0.0);
                let along = gain * (tau - stops);
                let (back, forth) = (0.5 * stops * v.abs(), 0.5 * along * (tau - stops));
                path += back + forth;
                y += sign * (forth - back);
                v = sign * along;
            }
        }
        if gain > 0.0 {
            assert!((turns - i64::from(samples)).abs() <= 1, "{turns}");
            near("v", end.velocity_m_s.y, v, 1e-4);
            near("y", end.position_m.y, y, 1e-2);
            let heat = plant.audit().flows.sliding_friction;
            near("heat", heat, mu * press * path, 1e-6);
        } else {
            assert_eq!((end.mode, turns), (Roll, 0));
            assert!(end.velocity_m_s.norm() <= 1e-12, "{}", end.velocity_m_s);
            assert!(end.position_m.y.abs() <= 1e-15, "{}", end.position_m);
        }
    }
}
