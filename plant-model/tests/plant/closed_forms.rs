//! The plant against solutions that can be written down.

use crate::support::bouncing::{bouncing, bouncing_start};
use crate::support::plants::onset_rig;
use nalgebra::Complex;
use plant_model::analysis::arrest::{Arrest, circle_radius_m};
use plant_model::contact::damping_for_restitution;
use plant_model::params::*;
use plant_model::{Inputs, Method, Mode, Options, Plant, V2, build};

const TIGHT: Options = Options {
    rtol: 1e-12,
    steps_per_sample: 10_000_000,
    steps: 10_000_000,
    method: Method::Series,
};

fn run_to(plant: &mut Plant, t_s: f64) {
    plant.advance(t_s, &Inputs::default(), &mut |_| {}).unwrap();
}

fn start(position: V2, velocity: V2, spin_rad_s: f64) -> Start {
    Start {
        position_m: position,
        velocity_m_s: velocity,
        spin_rad_s,
        spin_phase_rad: 0.0,
    }
}

/// Steady sliding whirl in an elastic stator (Black's condition with friction): with receptances α, β
/// of rotor and ring, Im[(α + β)(1 + iμ)] = 0 at ω and N = δ/(−Re[(α + β)(1 + iμ)] − 1/k_c).
#[test]
fn steady_sliding_whirl_in_an_elastic_stator() {
    let (m, k, d, ring_m, ring_k, ring_d) = (10.0, 4e5, 200.0, 5.0, 2e7, 3000.0);
    let (mu, clearance, contact_k) = (0.2, 3e-4, 1e8);
    let admittance = |w: f64| {
        let one = Complex::new(1.0, 0.0);
        let rotor = one / Complex::new(k - m * w * w, -w * d);
        let ring = one / Complex::new(ring_k - ring_m * w * w, -w * ring_d);
        (rotor, (rotor + ring) * Complex::new(1.0, mu))
    };
    let (mut low, mut high) = (850.0, 950.0);
    assert!(
        admittance(low).1.im * admittance(high).1.im < 0.0,
        "no root in the bracket"
    );
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if admittance(low).1.im * admittance(middle).1.im <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let omega = 0.5 * (low + high);
    let (rotor, both) = admittance(omega);
    let force = clearance / (-both.re - 1.0 / contact_k);
    let radius = rotor.norm() * force * (1.0 + mu * mu).sqrt();

    let ring = RingParams {
        mass_kg: ring_m,
        stiffness_n_m: V2::repeat(ring_k),
        damping_n_s_m: V2::repeat(ring_d),
    };
    let params = PlantParams {
        rotor: RotorParams {
            mass_kg: m,
            stiffness_n_m: k,
            damping_n_s_m: d,
            eccentricity_m: 0.0,
            contact_radius_m: 0.1,
        },
        spin: SpinParams::Held,
        stator: StatorParams::OneMass(ring),
        contact: ContactParams {
            clearance_m: clearance,
            law: LinearContact {
                stiffness_n_m: contact_k,
                damping_n_s_m: 0.0,
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: mu },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    };
    let from = start(V2::new(radius, 0.0), V2::new(0.0, -radius * omega), 400.0);
    let mut plant = build(&params, &from, TIGHT).unwrap();
    run_to(&mut plant, 3.0);
    let (before, n) = (plant.snapshot(), 40);
    run_to(
        &mut plant,
        3.0 + f64::from(n) * std::f64::consts::TAU / omega,
    );
    let after = plant.snapshot();
    let turns = (after.whirl_angle_rad - before.whirl_angle_rad) / std::f64::consts::TAU;
    assert!(
        (turns / f64::from(n) + 1.0).abs() < 1e-8,
        "ω off by {}",
        turns / f64::from(n) + 1.0
    );
    assert!(
        (after.normal_force_n / force - 1.0).abs() < 1e-8,
        "N = {}",
        after.normal_force_n
    );
    assert!((after.position_m.norm() / radius - 1.0).abs() < 1e-8);
}

/// Below ω0·(D/μ + √(1 + (D/μ)²)) damping wins over friction and the rotor leaves the wall; above it
/// friction wins and the whirl grows.
#[test]
fn sliding_whirl_on_a_rigid_wall_has_its_threshold() {
    let mut params = onset_rig();
    params.contact.law.linear_mut().unwrap().stiffness_n_m = 1e10;
    params.contact.law.linear_mut().unwrap().damping_n_s_m = 0.0;
    let natural = params.natural_frequency_rad_s().unwrap();
    let ratio = 0.003 / 0.125;
    let threshold = natural * (ratio + f64::hypot(ratio, 1.0));
    let (m, k, c) = (10.0, params.rotor.stiffness_n_m, params.contact.clearance_m);
    for (share, grows) in [(0.999, false), (1.001, true)] {
        let omega = share * threshold;
        let force = (m * omega * omega - k) * c;
        let radius = c + force / params.contact.law.linear().unwrap().stiffness_n_m;
        let from = start(V2::new(radius, 0.0), V2::new(0.0, -omega * radius), 2000.0);
        let mut plant = build(&params, &from, Options::default()).unwrap();
        run_to(&mut plant, 0.5);
        assert_eq!(
            plant.mode().in_contact(),
            grows,
            "at {share} of the threshold"
        );
        assert_eq!(plant.snapshot().velocity_m_s.norm() > omega * radius, grows);
    }
}

/// Rolling whirl: v = ΩR on the circle (k + k_c)·r² − k_c·δ·r − m·v² = 0, carried by friction d·v ≤ μN.
#[test]
fn rolling_whirl_on_a_rigid_wall_keeps_its_circle() {
    let mut params = bouncing(1e8);
    params.rotor.eccentricity_m = 0.0;
    params.contact.law.linear_mut().unwrap().damping_n_s_m = 0.0;
    let (k, kc, m, c) = (4e5, 1e8, 10.0, 3e-4);
    let v: f64 = 400.0 * 2.5e-3;
    let half = kc * c / (2.0 * (k + kc));
    let radius = half + (half * half + m * v * v / (k + kc)).sqrt();
    let from = start(V2::new(0.0, radius), V2::new(v, 0.0), 400.0);
    let mut plant = build(&params, &from, TIGHT).unwrap();
    assert_eq!(plant.mode(), Mode::Roll);
    let t = 0.3;
    run_to(&mut plant, t);
    let now = plant.snapshot();
    assert_eq!(now.mode, Mode::Roll);
    assert!((now.position_m.norm() / radius - 1.0).abs() < 1e-9);
    assert!((now.whirl_angle_rad / (-v / radius * t) - 1.0).abs() < 1e-9);
    let damper_n = 200.0 * v;
    assert!(
        (now.sliding_force_n + damper_n).abs() < 1e-6 * damper_n,
        "{}",
        now.sliding_force_n
    );
}

/// The best force, at once and in the best direction all the time, takes the momentum out of a whirl in the time that
/// the circles in balance give: on a hard wall, and on two so soft that the whirl begins at 1.5 and 3.5 clearances.
/// What is left is the vibration that the inward part starts.
#[test]
fn whirl_is_arrested_in_the_time_of_circles_in_balance() {
    for (contact_n_m, within) in [(1e10, 0.001), (1e8, 0.02), (2e7, 0.03)] {
        let mut params = onset_rig();
        params.contact.law.linear_mut().unwrap().stiffness_n_m = contact_n_m;
        params.contact.law.linear_mut().unwrap().damping_n_s_m =
            damping_for_restitution(0.5, contact_n_m, params.rotor.mass_kg).unwrap();
        let (force_n, mu, share) = (1500.0, 0.125, 0.5);
        let arrest = Arrest::new(&params, force_n).unwrap();
        let v = 0.85 * arrest.limit_m_s;
        let r = circle_radius_m(&params, v);
        // Backward is clockwise under a spin that is counter-clockwise.
        let from = start(V2::new(r, 0.0), V2::new(0.0, -v), 300.0);
        params.magnet = Some(MagnetParams {
            force_max_n: 2.0 * force_n,
            lag_s: 0.0,
        });
        let mut plant = build(&params, &from, TIGHT).unwrap();
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
        let expected = arrest.time_s(v, share);
        assert!(
            (t / expected - 1.0).abs() < within,
            "k_c {contact_n_m:e}, r/c {:.2}: {t} {expected}",
            r / params.contact.clearance_m
        );
    }
}

/// Fast rolling whirl turns several times within one step or sample: the contact angle counts them all.
#[test]
fn whole_turns_within_a_step_are_counted() {
    let v = 5.0_f64;
    for method in [Method::Series, Method::Collocation] {
        for samples in [1_u32, 400] {
            let mut params = bouncing(1e11);
            params.rotor.eccentricity_m = 0.0;
            params.rotor.damping_n_s_m = 0.0;
            params.contact.law.linear_mut().unwrap().damping_n_s_m = 6.0 * (1e11_f64 * 10.0).sqrt();
            let (k, kc, m, c) = (4e5, 1e11, 10.0, 3e-4);
            let half = kc * c / (2.0 * (k + kc));
            let radius = half + (half * half + m * v * v / (k + kc)).sqrt();
            let spin = v / params.rotor.contact_radius_m;
            let from = start(V2::new(0.0, radius), V2::new(v, 0.0), spin);
            let options = Options {
                method,
                rtol: 1e-7,
                ..Options::default()
            };
            let mut plant = build(&params, &from, options).unwrap();
            let t = 0.08;
            for i in 1..=samples {
                run_to(&mut plant, t * f64::from(i) / f64::from(samples));
            }
            let angle = plant.snapshot().whirl_angle_rad;
            assert!(
                (angle / (-v / radius * t) - 1.0).abs() < 1e-5,
                "{method:?}: {angle}"
            );
        }
    }
}

/// An impact gives back e of the normal speed and takes μ(1 + e) of it along the wall, the more
/// exactly the stiffer the contact.
#[test]
fn impact_follows_restitution_and_friction() {
    for e in [0.2, 0.7, 1.0] {
        let mut params = onset_rig();
        params.rotor.stiffness_n_m = 0.0;
        params.rotor.damping_n_s_m = 0.0;
        params.contact.law.linear_mut().unwrap().stiffness_n_m = 1e11;
        params.contact.law.linear_mut().unwrap().damping_n_s_m =
            damping_for_restitution(e, 1e11, 10.0).unwrap();
        let v = 0.01;
        let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), 250.0);
        let mut plant = build(&params, &from, TIGHT).unwrap();
        run_to(&mut plant, 2e-3);
        let after = plant.snapshot().velocity_m_s;
        let mu = 0.125;
        // The contact point moves along the curved wall by v_t·t during the contact.
        let curved = (1.0 + e) * v / 2e-4 * (10.0_f64 / 1e11).sqrt() * std::f64::consts::PI;
        assert!(
            (after.x / (-e * v) - 1.0).abs() < curved,
            "e = {e}: {after}"
        );
        assert!(
            (after.y / (-mu * (1.0 + e) * v) - 1.0).abs() < curved,
            "e = {e}: {after}"
        );
        assert_eq!(plant.meters().impacts, 1);
    }
}

/// Synchronous circle of a rotor with unbalance, in flight.
#[test]
fn unbalance_response_is_exact_in_flight() {
    let mut params = onset_rig();
    params.rotor.eccentricity_m = 2e-5;
    let spin = 400.0;
    let RotorParams {
        mass_kg: m,
        stiffness_n_m: k,
        damping_n_s_m: d,
        eccentricity_m: e,
        ..
    } = params.rotor;
    let circle =
        Complex::new(m * e * spin * spin, 0.0) / Complex::new(k - m * spin * spin, d * spin);
    let from = start(
        V2::new(circle.re, circle.im),
        spin * V2::new(-circle.im, circle.re),
        spin,
    );
    let mut plant = build(&params, &from, Options::default()).unwrap();
    let t = 1.7;
    run_to(&mut plant, t);
    let exact = circle * Complex::from_polar(1.0, spin * t);
    let error = (plant.snapshot().position_m - V2::new(exact.re, exact.im)).norm();
    assert!(error < 1e-11 * circle.norm(), "{error:e}");
    assert!(plant.audit().residual() < 1e-12);
}

/// Unbalance while a drive torque spins the rotor up, against many small classical steps.
#[test]
fn unbalance_under_spin_acceleration_is_exact_in_flight() {
    let mut params = onset_rig();
    params.rotor.eccentricity_m = 2e-5;
    params.spin = SpinParams::Free {
        inertia_kg_m2: 0.05,
        drive_torque_n_m: 40.0,
    };
    let (m, k, d) = (10.0, params.rotor.stiffness_n_m, params.rotor.damping_n_s_m);
    let (e, spin, gain) = (2e-5, 100.0, 40.0 / 0.05);
    let mut plant = build(&params, &start(V2::zeros(), V2::zeros(), spin), TIGHT).unwrap();
    let end = 0.1;
    run_to(&mut plant, end);

    let rate = |t: f64, (r, v): (V2, V2)| {
        let (sigma, w) = (spin * t + 0.5 * gain * t * t, spin + gain * t);
        let push = m
            * e
            * (w * w * V2::new(sigma.cos(), sigma.sin())
                + gain * V2::new(sigma.sin(), -sigma.cos()));
        (v, (push - k * r - d * v) / m)
    };
    let plus = |y: (V2, V2), h: f64, f: (V2, V2)| (y.0 + h * f.0, y.1 + h * f.1);
    let (mut y, steps) = ((V2::zeros(), V2::zeros()), 20_000);
    let h = end / f64::from(steps);
    for i in 0..steps {
        let t = f64::from(i) * h;
        let a = rate(t, y);
        let b = rate(t + h / 2.0, plus(y, h / 2.0, a));
        let c = rate(t + h / 2.0, plus(y, h / 2.0, b));
        let f = rate(t + h, plus(y, h, c));
        y = plus(
            plus(plus(plus(y, h / 6.0, a), h / 3.0, b), h / 3.0, c),
            h / 6.0,
            f,
        );
    }
    let error = (plant.snapshot().position_m - y.0).norm();
    assert!(error < 1e-10 * y.0.norm(), "{error:e} of {:e}", y.0.norm());
    assert!(plant.audit().residual() < 1e-12);
}

/// A free mass under a command that the amplifier follows with a lag: v = F/m·(t − τ·(1 − exp(−t/τ))).
#[test]
fn amplifier_lag_is_exact_in_flight() {
    let mut params = onset_rig();
    params.rotor.stiffness_n_m = 0.0;
    params.rotor.damping_n_s_m = 0.0;
    params.magnet = Some(MagnetParams {
        force_max_n: 100.0,
        lag_s: 2e-4,
    });
    let mut plant = build(&params, &start(V2::zeros(), V2::zeros(), 0.0), TIGHT).unwrap();
    let inputs = Inputs {
        command_n: V2::new(300.0, 400.0),
        external_n: V2::zeros(),
    };
    let (t, lag): (f64, f64) = (1e-3, 2e-4);
    plant.advance(t, &inputs, &mut |_| {}).unwrap();
    let exact = 100.0 / 10.0 * (t - lag * (1.0 - (-t / lag).exp()));
    let v = plant.snapshot().velocity_m_s;
    assert!(
        (v - exact * V2::new(0.6, 0.8)).norm() < 1e-14,
        "the cap keeps the direction"
    );
    assert!(plant.audit().residual() < 1e-13);
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
    let inputs = Inputs {
        command_n: V2::zeros(),
        external_n: V2::new(500.0, 0.0),
    };
    plant.advance(0.3, &inputs, &mut |_| {}).unwrap();
    let now = plant.snapshot();
    assert_eq!(now.mode, Mode::Seated);
    assert!(now.velocity_m_s.norm() < 1e-9);
    let normal = now.position_m / now.position_m.norm();
    let load = inputs.external_n - params.rotor.stiffness_n_m * now.position_m;
    let along = load.dot(&V2::new(-normal.y, normal.x));
    assert!((now.normal_force_n / load.dot(&normal) - 1.0).abs() < 1e-6);
    assert!(
        (0.1..=0.15).contains(&(along / now.normal_force_n)),
        "{}",
        along / now.normal_force_n
    );
}

/// Mode changes and end state of a problem with flight, slip and roll, from an independent code, at two
/// contact stiffnesses.
#[test]
fn bouncing_into_rolling_matches_an_independent_solution() {
    let soft = (
        1e8,
        6,
        0.008_847_779_416,
        [-4.205_650_712_3e-4, -2.680_261_826_5e-4],
    );
    let stiff = (
        1e10,
        14,
        0.005_794_092_835,
        [2.999_149_339_61e-4, -4.508_778_178_1e-5],
    );
    for (contact_stiffness_n_m, count, last_s, end_m) in [soft, stiff] {
        let params = bouncing(contact_stiffness_n_m);
        let mut plant = build(&params, &bouncing_start(), TIGHT).unwrap();
        let mut changes = Vec::new();
        plant
            .advance(0.2, &Inputs::default(), &mut |s| {
                changes.push((s.t_s, s.mode));
            })
            .unwrap();
        let (t, mode) = *changes.last().unwrap();
        assert_eq!((changes.len(), mode), (count, Mode::Roll));
        assert!((t - last_s).abs() < 1e-12, "{t}");
        let error = plant.snapshot().position_m - V2::from(end_m);
        assert!(error.norm() < 3e-10 * 3e-4, "{error:e}");
    }
}
