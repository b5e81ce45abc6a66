//! A retainer ball bearing: the race that the rotor touches spins up, rolls, coasts.

use crate::support::plants::{footnote_4, onset_rig};
use plant_model::params::*;
use plant_model::{BuildError, Inputs, Method, Mode, Options, Plant, Snapshot, V2, build};

const METHODS: [Method; 2] = [Method::Series, Method::Collocation];
const LOAD_N: f64 = 500.0;
const MU: f64 = 0.1;
const INERTIA_KG_M2: f64 = 2e-3;

fn tight(method: Method) -> Options {
    Options {
        rtol: 1e-11,
        method,
        ..Options::default()
    }
}

fn race(inertia_kg_m2: f64, drag_n_m_s: f64) -> Option<RaceParams> {
    Some(RaceParams {
        inertia_kg_m2,
        drag_n_m_s,
        start_spin_rad_s: 0.0,
    })
}

/// A rotor that a load holds against the wall: rolling friction keeps the whirl at rest.
fn pressed(spin: SpinParams, race: Option<RaceParams>) -> PlantParams {
    let mut params = onset_rig();
    params.spin = spin;
    params.race = race;
    params.friction = FrictionParams {
        sliding: SlidingFriction::Constant { coefficient: MU },
        rolling_coefficient: 2.0 * MU,
    };
    params
}

const FREE: SpinParams = SpinParams::Free {
    inertia_kg_m2: 0.05,
    drive_torque_n_m: 0.0,
};

/// Where the load and the contact spring are in balance.
fn resting(params: &PlantParams, spin_rad_s: f64) -> Start {
    let (k, k_c) = (params.rotor.stiffness_n_m, params.contact.stiffness_n_m());
    let x = (LOAD_N + k_c * params.contact.clearance_m) / (k + k_c);
    Start {
        position_m: V2::new(x, 0.0),
        velocity_m_s: V2::zeros(),
        spin_rad_s,
        spin_phase_rad: 0.0,
    }
}

/// f_n there \[N\].
fn normal_n(params: &PlantParams) -> f64 {
    LOAD_N - params.rotor.stiffness_n_m * resting(params, 0.0).position_m.x
}

fn carry(plant: &mut Plant, t_s: f64) -> Snapshot {
    let inputs = Inputs {
        external_n: V2::new(LOAD_N, 0.0),
        ..Inputs::default()
    };
    plant.advance(t_s, &inputs, &mut |_| {}).unwrap();
    plant.snapshot()
}

/// What is left of an audit by rounding: collocation's forces are sums over the walls at eight points.
fn rounding(method: Method) -> f64 {
    match method {
        Method::Collocation => 4e-12,
        _ => 1e-13,
    }
}

fn near(found: f64, expected: f64, share: f64, what: &str) {
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{what}: {found:e}, expected {expected:e}"
    );
}

#[test]
fn friction_spins_the_race_up_until_it_rolls() {
    for (method, spin, inverse_j) in [
        (Method::Series, SpinParams::Held, 0.0),
        (Method::Collocation, SpinParams::Held, 0.0),
        (Method::Series, FREE, 20.0),
        (Method::Collocation, FREE, 20.0),
    ] {
        let params = pressed(spin, race(INERTIA_KG_M2, 0.0));
        let (r, bore) = (params.rotor.contact_radius_m, params.bore_radius_m());
        let spin_rad_s = 250.0;
        let start = resting(&params, spin_rad_s);
        let mut plant = build(&params, &start, tight(method)).unwrap();
        let friction_n = MU * normal_n(&params);
        let gain = bore * friction_n / INERTIA_KG_M2;
        let loss = r * friction_n * inverse_j;
        let rolls_s = r * spin_rad_s / (r * loss + bore * gain);
        for share in [0.2, 0.5, 0.9] {
            let t_s = share * rolls_s;
            let now = carry(&mut plant, t_s);
            assert_eq!(now.mode, Mode::Seated, "{method:?}");
            near(now.race_spin_rad_s, gain * t_s, 1e-9, "race");
            near(now.spin_rad_s, spin_rad_s - loss * t_s, 1e-9, "rotor");
            near(now.sliding_force_n, -friction_n, 1e-9, "friction");
            near(
                now.sliding_speed_m_s,
                r * spin_rad_s * (1.0 - share),
                1e-8,
                "slip",
            );
        }
        let now = carry(&mut plant, 3.0 * rolls_s);
        assert_eq!(now.mode, Mode::Seated);
        near(now.race_spin_rad_s, gain * rolls_s, 1e-9, "rolling race");
        near(
            now.spin_rad_s,
            spin_rad_s - loss * rolls_s,
            1e-9,
            "rolling rotor",
        );
        assert!(now.sliding_speed_m_s.abs() < 1e-12 * r * spin_rad_s);
        assert!(now.sliding_force_n.abs() < 1e-9 * friction_n);
        assert!(now.velocity_m_s.norm() < 1e-9);
        let slipped_j = 0.5 * friction_n * r * spin_rad_s * rolls_s;
        let audit = plant.audit();
        near(audit.flows.sliding_friction, slipped_j, 1e-9, "heat");
        assert!(
            audit.residual() < rounding(method),
            "{:e}",
            audit.residual()
        );
    }
}

/// Against a drag the race creeps up to R_i·μN/b, or rolls, and then friction is what the drag takes.
#[test]
fn a_drag_is_overcome_by_slip_or_by_rolling() {
    for method in METHODS {
        for (drag_n_m_s, rolls) in [(0.05, false), (5e-3, true)] {
            let params = pressed(SpinParams::Held, race(INERTIA_KG_M2, drag_n_m_s));
            let bore = params.bore_radius_m();
            let start = resting(&params, 250.0);
            let surface = params.rotor.contact_radius_m * 250.0;
            let mut plant = build(&params, &start, tight(method)).unwrap();
            let friction_n = MU * normal_n(&params);
            let limit = bore * friction_n / drag_n_m_s;
            assert_eq!(limit * bore > surface, rolls);
            let t_s = 0.02;
            let now = carry(&mut plant, t_s);
            let grown = -(-drag_n_m_s * t_s / INERTIA_KG_M2).exp_m1();
            near(now.race_spin_rad_s, limit * grown, 1e-9, "creeping up");
            let now = carry(&mut plant, 2.0);
            if rolls {
                near(now.race_spin_rad_s, surface / bore, 1e-12, "rolling");
                let drag_n = -drag_n_m_s * now.race_spin_rad_s / bore;
                near(now.sliding_force_n, drag_n, 1e-12, "friction");
                let power_w = drag_n_m_s * now.race_spin_rad_s.powi(2);
                let before = plant.audit().flows;
                carry(&mut plant, 2.5);
                let flows = plant.audit().flows;
                let lost = flows.stator_damping - before.stator_damping;
                near(lost, 0.5 * power_w, 1e-9, "lost in the bearing");
                near(flows.drive - before.drive, lost, 1e-9, "from the drive");
                assert_eq!(flows.sliding_friction, before.sliding_friction);
            } else {
                near(now.race_spin_rad_s, limit, 1e-9, "steady slip");
                near(now.sliding_force_n, -friction_n, 1e-9, "friction");
            }
            let residual = plant.audit().residual();
            assert!(residual < rounding(method), "{method:?}: {residual:e}");
        }
    }
}

/// Rolling whirl that the drag keeps alive: b·Ω_i/R_i = μ_r·N + d·v.
#[test]
fn drag_keeps_a_rolling_whirl_alive() {
    for method in METHODS {
        let mut params = onset_rig();
        params.friction.rolling_coefficient = 0.01;
        params.friction.sliding = SlidingFriction::Constant { coefficient: 0.3 };
        let (rotor, c) = (params.rotor, params.contact.clearance_m);
        let speed: f64 = 0.3;
        // N = m·v²/ρ − k·ρ and ρ = c + N/k_c, by iteration.
        let mut rho = c;
        for _ in 0..200 {
            let n = rotor.mass_kg * speed * speed / rho - rotor.stiffness_n_m * rho;
            rho = c + n / params.contact.stiffness_n_m();
        }
        let n = rotor.mass_kg * speed * speed / rho - rotor.stiffness_n_m * rho;
        let spin_rad_s = 250.0;
        let bore = params.bore_radius_m();
        let race_rad_s = (rotor.contact_radius_m * spin_rad_s - speed) / bore;
        let needed_n = 0.01 * n + rotor.damping_n_s_m * speed;
        params.race = Some(RaceParams {
            inertia_kg_m2: 1e-3,
            drag_n_m_s: needed_n * bore / race_rad_s,
            start_spin_rad_s: race_rad_s,
        });
        let start = Start {
            position_m: V2::new(rho, 0.0),
            velocity_m_s: V2::new(0.0, -speed),
            spin_rad_s,
            spin_phase_rad: 0.0,
        };
        let mut plant = build(&params, &start, tight(method)).unwrap();
        for i in 1..=1000 {
            plant
                .advance(f64::from(i) * 1e-4, &Inputs::default(), &mut |_| {})
                .unwrap();
        }
        let now = plant.snapshot();
        assert_eq!(now.mode, Mode::Roll);
        near(now.velocity_m_s.norm(), speed, 1e-8, "whirl");
        near(now.sliding_force_n, -needed_n, 1e-7, "friction");
        near(now.race_spin_rad_s, race_rad_s, 1e-8, "race");
        assert!(plant.audit().residual() < 1e-11);
    }
}

/// Impact, bouncing, sliding whirl, rolling and the end of it.
fn violent(race: Option<RaceParams>, eccentricity_m: f64, spin: SpinParams) -> PlantParams {
    let mut params = footnote_4();
    params.rotor.eccentricity_m = eccentricity_m;
    params.spin = spin;
    params.race = race;
    params
}

fn hit(params: &PlantParams, options: Options, end_s: f64) -> (Vec<Snapshot>, Plant) {
    let start = Start {
        position_m: V2::new(params.contact.clearance_m, 0.0),
        velocity_m_s: V2::new(0.4, 0.0),
        spin_rad_s: 250.0,
        spin_phase_rad: 0.4,
    };
    let mut plant = build(params, &start, options).unwrap();
    let samples = (end_s / 5e-5).round() as u32;
    let snapshots = (1..=samples)
        .map(|i| {
            plant
                .advance(f64::from(i) * 5e-5, &Inputs::default(), &mut |_| {})
                .unwrap();
            plant.snapshot()
        })
        .collect();
    (snapshots, plant)
}

fn farthest(a: &[Snapshot], b: &[Snapshot]) -> f64 {
    let apart = |(a, b): (&Snapshot, &Snapshot)| (a.position_m - b.position_m).norm();
    a.iter().zip(b).map(apart).fold(0.0, f64::max)
}

/// A race that cannot be moved is a bushing.
#[test]
fn a_heavy_race_is_a_bushing() {
    for spin in [SpinParams::Held, FREE] {
        for eccentricity_m in [0.0, 1e-5] {
            for method in METHODS {
                let options = Options {
                    rtol: 1e-9,
                    ..tight(method)
                };
                let run = |race| hit(&violent(race, eccentricity_m, spin), options, 0.03).0;
                let (bushing, heavy) = (run(None), run(race(1e18, 0.0)));
                let apart = farthest(&bushing, &heavy) / 2e-4;
                // The pairs count the states into their error, and step a little differently.
                let bound = if method == Method::Series {
                    1e-10
                } else {
                    1e-5
                };
                assert!(
                    apart < bound,
                    "{method:?} {spin:?} {eccentricity_m}: {apart:e}"
                );
            }
        }
    }
}

#[test]
fn methods_agree_on_every_mode() {
    let params = violent(race(1e-3, 2e-2), 0.0, FREE);
    let runs = METHODS.map(|method| {
        let (snapshots, plant) = hit(&params, tight(method), 0.05);
        let residual = plant.audit().residual();
        assert!(residual < 1e-11, "{method:?}: {residual:e}");
        snapshots
    });
    for mode in [Mode::Flight, Mode::SlipPositive, Mode::Roll] {
        assert!(runs[0].iter().any(|s| s.mode == mode), "{mode:?}");
    }
    let apart = farthest(&runs[0], &runs[1]) / 2e-4;
    assert!(apart < 1e-7, "{apart:e}");
    let end = |run: &[Snapshot]| run[run.len() - 1].race_spin_rad_s;
    near(end(&runs[1]), end(&runs[0]), 1e-7, "race");
}

/// Sliding friction is one force on two surfaces: without drag and drive J·Ω/R + J_i·Ω_i/R_i stays.
#[test]
fn momentum_of_the_surfaces_stays() {
    let inertia_kg_m2 = 3e-3;
    let params = violent(race(inertia_kg_m2, 0.0), 0.0, FREE);
    for method in METHODS {
        let momentum = |s: &Snapshot| {
            0.05 * s.spin_rad_s / params.rotor.contact_radius_m
                + inertia_kg_m2 * s.race_spin_rad_s / params.bore_radius_m()
        };
        let (snapshots, plant) = hit(&params, tight(method), 0.05);
        for s in &snapshots {
            near(momentum(s), 0.05 * 250.0 / 0.1, 1e-12, "momentum");
        }
        let race_rad_s = snapshots[snapshots.len() - 1].race_spin_rad_s;
        assert!(race_rad_s > 50.0, "{race_rad_s}");
        assert!(plant.audit().residual() < 1e-11);
    }
}

/// Off the wall the race coasts; sample by sample, by the map of flight, and in one go.
#[test]
fn a_race_coasts_exponentially_in_flight() {
    let (inertia, drag, start_spin_rad_s) = (1e-3, 0.03, -200.0);
    for spin in [SpinParams::Held, FREE] {
        for eccentricity_m in [0.0, 1e-6] {
            for samples in [1_u32, 7, 1000] {
                let mut params = onset_rig();
                params.spin = spin;
                params.rotor.eccentricity_m = eccentricity_m;
                params.race = Some(RaceParams {
                    inertia_kg_m2: inertia,
                    drag_n_m_s: drag,
                    start_spin_rad_s,
                });
                let start = Start {
                    position_m: V2::new(5e-5, 0.0),
                    velocity_m_s: V2::new(0.0, 0.01),
                    spin_rad_s: 100.0,
                    spin_phase_rad: 0.0,
                };
                let mut plant = build(&params, &start, Options::default()).unwrap();
                let end_s = 0.1;
                for i in 1..=samples {
                    let t_s = end_s * f64::from(i) / f64::from(samples);
                    plant.advance(t_s, &Inputs::default(), &mut |_| {}).unwrap();
                }
                assert_eq!(plant.meters().impacts, 0);
                let x: f64 = drag / inertia * end_s;
                let now = plant.snapshot();
                near(
                    now.race_spin_rad_s,
                    start_spin_rad_s * (-x).exp(),
                    1e-12,
                    "spin",
                );
                let lost = -0.5 * inertia * start_spin_rad_s.powi(2) * (-2.0 * x).exp_m1();
                let audit = plant.audit();
                near(audit.flows.stator_damping, lost, 1e-12, "lost");
                assert!(audit.residual() < 1e-14, "{:e}", audit.residual());
            }
        }
    }
}

#[test]
fn races_out_of_range_are_refused() {
    let good = RaceParams {
        inertia_kg_m2: 1e-3,
        drag_n_m_s: 0.0,
        start_spin_rad_s: 0.0,
    };
    for (bad, field) in [
        (
            RaceParams {
                inertia_kg_m2: 0.0,
                ..good
            },
            "race.inertia_kg_m2",
        ),
        (
            RaceParams {
                drag_n_m_s: -1.0,
                ..good
            },
            "race.drag_n_m_s",
        ),
        (
            RaceParams {
                start_spin_rad_s: f64::NAN,
                ..good
            },
            "race.start_spin_rad_s",
        ),
    ] {
        let params = violent(Some(bad), 0.0, FREE);
        let start = resting(&params, 0.0);
        match build(&params, &start, Options::default()) {
            Err(BuildError::Param(e)) => assert_eq!(e.field, field),
            _ => panic!("{field} was accepted"),
        }
    }
}
