//! A retainer ball bearing: the race that the rotor touches spins up, rolls, brakes.

use crate::support::*;
use plant_model::ContactMode::{Flight, Roll, Seated, SlipPositive};

const LOAD_N: f64 = 500.0;
const MU: f64 = 0.1;
const INERTIA_KG_M2: f64 = 2e-3;

fn tight(method: Method) -> Options {
    options(method, 1e-11)
}

/// A rotor that a load holds against the wall: rolling friction keeps the whirl at rest.
fn pressed(spin: SpinParams, race: RaceParams) -> PlantParams {
    let mut params = onset_rig();
    params.spin = spin;
    params.race = Some(race);
    params.friction = FrictionParams {
        sliding: constant(MU),
        rolling_coefficient: 2.0 * MU,
    };
    params
}

/// Where the load and the contact spring are in balance, and μ·f_n there \[N\].
fn resting(params: &PlantParams, spin_rad_s: f64) -> (Start, f64) {
    let (k, k_c) = (params.rotor.stiffness_n_m, params.contact.stiffness_n_m());
    let x = (LOAD_N + k_c * params.contact.clearance_m) / (k + k_c);
    let from = start(V2::new(x, 0.0), V2::zeros(), spin_rad_s);
    (from, MU * (LOAD_N - k * x))
}

fn pushed(plant: &mut Plant, t_s: f64) -> Snapshot {
    let push = load(V2::new(LOAD_N, 0.0));
    plant.advance(t_s, &push, &mut |_| {}).unwrap();
    plant.snapshot()
}

/// What is left of an audit by rounding: collocation's forces are sums over the walls at eight points.
fn rounding(method: Method) -> f64 {
    match method {
        Method::Collocation => 4e-12,
        _ => 1e-13,
    }
}

#[test]
fn friction_spins_the_race_up_until_it_rolls() {
    let held = METHODS.map(|m| (m, SpinParams::Held, 0.0));
    let free = METHODS.map(|m| (m, free_spin(0.05, 0.0), 20.0));
    for (method, spin, inverse_j) in held.into_iter().chain(free) {
        let params = pressed(spin, race(INERTIA_KG_M2, 0.0, 0.0));
        let (r, bore) = (params.rotor.contact_radius_m, params.bore_radius_m());
        let spin_rad_s = 250.0;
        let (from, friction_n) = resting(&params, spin_rad_s);
        let mut plant = build(&params, &from, tight(method)).unwrap();
        let gain = bore * friction_n / INERTIA_KG_M2;
        let loss = r * friction_n * inverse_j;
        let rolls_s = r * spin_rad_s / (r * loss + bore * gain);
        for share in [0.2, 0.5, 0.9] {
            let t_s = share * rolls_s;
            let now = pushed(&mut plant, t_s);
            assert_eq!(now.mode, Seated, "{method:?}");
            near("race", now.race_spin_rad_s, gain * t_s, 1e-9);
            near("rotor", now.spin_rad_s, spin_rad_s - loss * t_s, 1e-9);
            near("friction", now.sliding_force_n, -friction_n, 1e-9);
            let slip = r * spin_rad_s * (1.0 - share);
            near("slip", now.sliding_speed_m_s, slip, 1e-8);
        }
        let now = pushed(&mut plant, 3.0 * rolls_s);
        assert_eq!(now.mode, Seated);
        near("rolling race", now.race_spin_rad_s, gain * rolls_s, 1e-9);
        let left = spin_rad_s - loss * rolls_s;
        near("rolling rotor", now.spin_rad_s, left, 1e-9);
        assert!(now.sliding_speed_m_s.abs() < 1e-12 * r * spin_rad_s);
        assert!(now.sliding_force_n.abs() < 1e-9 * friction_n);
        assert!(now.velocity_m_s.norm() < 1e-9);
        let slipped_j = 0.5 * friction_n * r * spin_rad_s * rolls_s;
        let heat_j = plant.audit().flows.sliding_friction;
        near("heat", heat_j, slipped_j, 1e-9);
        closes("spun up", plant.audit().residual(), rounding(method));
    }
}

/// Against a drag the race creeps up to R_i·μN/b, or rolls, and then friction is what the drag takes.
#[test]
fn a_drag_is_overcome_by_slip_or_by_rolling() {
    for (method, drag_n_m_s) in each(&METHODS, &[0.05, 5e-3]) {
        let rolls = drag_n_m_s < 0.01;
        let params = pressed(SpinParams::Held, race(INERTIA_KG_M2, drag_n_m_s, 0.0));
        let bore = params.bore_radius_m();
        let (from, friction_n) = resting(&params, 250.0);
        let surface = params.rotor.contact_radius_m * 250.0;
        let mut plant = build(&params, &from, tight(method)).unwrap();
        let limit = bore * friction_n / drag_n_m_s;
        assert_eq!(limit * bore > surface, rolls);
        let t_s = 0.02;
        let grown = -(-drag_n_m_s * t_s / INERTIA_KG_M2).exp_m1();
        let now = pushed(&mut plant, t_s);
        near("creeping up", now.race_spin_rad_s, limit * grown, 1e-9);
        let now = pushed(&mut plant, 2.0);
        if rolls {
            near("rolling", now.race_spin_rad_s, surface / bore, 1e-12);
            let drag_n = -drag_n_m_s * now.race_spin_rad_s / bore;
            near("friction", now.sliding_force_n, drag_n, 1e-12);
            let power_w = drag_n_m_s * now.race_spin_rad_s.powi(2);
            let before = plant.audit().flows;
            pushed(&mut plant, 2.5);
            let flows = plant.audit().flows;
            let lost = flows.stator_damping - before.stator_damping;
            near("lost in the bearing", lost, 0.5 * power_w, 1e-9);
            near("from the drive", flows.drive - before.drive, lost, 1e-9);
            assert_eq!(flows.sliding_friction, before.sliding_friction);
        } else {
            near("steady slip", now.race_spin_rad_s, limit, 1e-9);
            near("friction", now.sliding_force_n, -friction_n, 1e-9);
        }
        closes("dragged", plant.audit().residual(), rounding(method));
    }
}

/// Rolling whirl that the drag keeps alive: b·Ω_i/R_i = μ_r·N + d·v.
#[test]
fn drag_keeps_a_rolling_whirl_alive() {
    for method in METHODS {
        let mut params = onset_rig();
        params.friction.rolling_coefficient = 0.01;
        params.friction.sliding = constant(0.3);
        let (rotor, speed) = (params.rotor, 0.3_f64);
        // N = m·v²/ρ − k·ρ and ρ = c + N/k_c, by iteration.
        let (mut rho, mut n) = (CLEARANCE_M, 0.0);
        for _ in 0..200 {
            n = rotor.mass_kg * speed * speed / rho - rotor.stiffness_n_m * rho;
            rho = CLEARANCE_M + n / params.contact.stiffness_n_m();
        }
        let (spin_rad_s, bore) = (250.0, params.bore_radius_m());
        let race_rad_s = (rotor.contact_radius_m * spin_rad_s - speed) / bore;
        let needed_n = 0.01 * n + rotor.damping_n_s_m * speed;
        params.race = Some(race(1e-3, needed_n * bore / race_rad_s, race_rad_s));
        let from = start(V2::new(rho, 0.0), V2::new(0.0, -speed), spin_rad_s);
        let mut plant = build(&params, &from, tight(method)).unwrap();
        sampled(&mut plant, 0.1, 1000);
        let now = plant.snapshot();
        assert_eq!(now.mode, Roll);
        near("whirl", now.velocity_m_s.norm(), speed, 1e-8);
        near("friction", now.sliding_force_n, -needed_n, 1e-7);
        near("race", now.race_spin_rad_s, race_rad_s, 1e-8);
        closes("kept alive", plant.audit().residual(), 1e-11);
    }
}

/// Impact, bouncing, sliding whirl, rolling and the end of it, sample by sample.
fn hit(params: &PlantParams, options: Options, end_s: f64) -> (Vec<Snapshot>, Plant) {
    let from = Start {
        spin_phase_rad: 0.4,
        ..start(V2::new(CLEARANCE_M, 0.0), V2::new(0.4, 0.0), 250.0)
    };
    let mut plant = build(params, &from, options).unwrap();
    let samples = 1..=(end_s / 5e-5).round() as u32;
    let snapshots = samples.map(|i| {
        run_to(&mut plant, f64::from(i) * 5e-5);
        plant.snapshot()
    });
    (snapshots.collect(), plant)
}

/// Clearances by which two runs are apart.
fn farthest(a: &[Snapshot], b: &[Snapshot]) -> f64 {
    let apart = |(a, b): (&Snapshot, &Snapshot)| (a.position_m - b.position_m).norm();
    a.iter().zip(b).map(apart).fold(0.0, f64::max) / CLEARANCE_M
}

/// A race that cannot be moved is a bushing.
#[test]
fn a_heavy_race_is_a_bushing() {
    for (method, spin) in each(&METHODS, &[SpinParams::Held, free_spin(0.05, 0.0)]) {
        for eccentricity_m in [0.0, 1e-5] {
            let run = |race| {
                let mut params = footnote_4();
                params.rotor.eccentricity_m = eccentricity_m;
                (params.spin, params.race) = (spin, race);
                hit(&params, options(method, 1e-9), 0.03).0
            };
            let apart = farthest(&run(None), &run(Some(race(1e18, 0.0, 0.0))));
            // Collocation counts the states into its error, and steps a little differently.
            let most = if method == Method::Series {
                1e-10
            } else {
                1e-5
            };
            assert!(apart < most, "{method:?} {spin:?}: {apart:e}");
        }
    }
}

/// Both methods go the same way through every mode. Sliding friction is one force on two surfaces: without drag and drive
/// J·Ω/R + J_i·Ω_i/R_i stays.
#[test]
fn methods_agree_and_momentum_of_the_surfaces_stays() {
    for (inertia_kg_m2, drag_n_m_s) in [(1e-3, 2e-2), (3e-3, 0.0)] {
        let mut params = footnote_4();
        params.race = Some(race(inertia_kg_m2, drag_n_m_s, 0.0));
        let runs = METHODS.map(|method| {
            let (snapshots, plant) = hit(&params, tight(method), 0.05);
            closes("hit", plant.audit().residual(), 1e-11);
            snapshots
        });
        for mode in [Flight, SlipPositive, Roll] {
            assert!(runs[0].iter().any(|s| s.mode == mode), "{mode:?}");
        }
        let apart = farthest(&runs[0], &runs[1]);
        assert!(apart < 1e-7, "{apart:e}");
        let [a, b] = [0, 1].map(|i| runs[i][runs[i].len() - 1].race_spin_rad_s);
        near("race", b, a, 1e-7);
        assert!(drag_n_m_s > 0.0 || a > 50.0, "{a}");
        for s in runs.iter().flatten().filter(|_| drag_n_m_s == 0.0) {
            let momentum = 0.05 * s.spin_rad_s / params.rotor.contact_radius_m
                + inertia_kg_m2 * s.race_spin_rad_s / params.bore_radius_m();
            near("momentum", momentum, 0.05 * 250.0 / 0.1, 1e-12);
        }
    }
}
