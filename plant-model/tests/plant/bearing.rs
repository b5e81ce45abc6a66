//! A retainer bearing as it is, and an amplifier of second order.

use crate::support::rotor::*;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Method, Options, V2};

const OPTIONS: Options = Options {
    rtol: 1e-11,
    method: Method::Auto,
    steps_per_sample: 200_000,
    steps: 50_000_000,
};

const RACE: RaceParams = RaceParams {
    inertia_kg_m2: 2e-6,
    drag_n_m_s: 0.0,
    start_spin_rad_s: 300.0,
};

/// A rotor that lies on its lower walls, and what it weighs.
fn seated() -> (MachineParams, MachineStart, f64) {
    let mut params = machine();
    params.unbalances.clear();
    params.supports.clear();
    params.gravity_m_s2 = V2::new(0.0, -9.81);
    let start = MachineStart {
        centre_m: V2::new(0.0, -CLEARANCE_M - 98.1 / 1e8),
        spin_rad_s: 0.0,
        ..MachineStart::default()
    };
    (params, start, 98.1)
}

/// An impact of both ends on balls: depth, largest force and restitution of the closed forms.
#[test]
fn balls_give_way_as_closed_forms_say() {
    for damping_s_m in [0.0, 0.8] {
        let law = HuntCrossley {
            stiffness_n_mn: 2e10,
            exponent: 1.5,
            damping_s_m,
        };
        let (mut params, _, _) = seated();
        params.gravity_m_s2 = V2::zeros();
        for plane in &mut params.planes {
            plane.contact.law = law.into();
            plane.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
        }
        let speed = 0.3;
        let start = MachineStart {
            centre_velocity_m_s: V2::new(speed, 0.0),
            ..MachineStart::default()
        };
        let mut machine = Machine::new(&params, &start, OPTIONS).unwrap();
        let nothing = MachineInputs::default();
        machine.advance(1.9e-3, &nothing, &mut |_, _| {}).unwrap();
        let (mass_kg, back) = (5.0, -machine.axis().centre.velocity.x / speed);
        for meters in machine.meters() {
            assert_eq!(meters.impacts, 1);
            let force = meters.peak_contact_force_n / law.peak_force_n(speed, mass_kg);
            let depth = meters.peak_penetration_m / law.depth_m(speed, mass_kg);
            let restitution = back / law.restitution(speed);
            for ratio in [force, depth, restitution] {
                assert!((ratio - 1.0).abs() < 1e-8, "{force} {depth} {restitution}");
            }
        }
        assert!(machine.audit().residual() < 1e-9);
    }
}

/// ∫ √(Ω² + Ω_0²)/Ω dΩ = √(Ω² + Ω_0²) − Ω_0·arsinh(Ω_0/Ω) falls by κ·N·t/J, viscous drag and friction apart.
#[test]
fn drag_by_load_brakes_a_race_as_its_closed_form_says() {
    let (mut params, start, weight_n) = seated();
    let drag = LoadDrag {
        arm_m: 2e-5,
        still_rad_s: 20.0,
    };
    for plane in &mut params.planes {
        plane.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
        (plane.race, plane.load_drag) = (Some(RACE), Some(drag));
    }
    let mut machine = Machine::new(&params, &start, OPTIONS).unwrap();
    assert_eq!(machine.method(), Method::Collocation);
    let t_s = 0.8;
    machine
        .advance(t_s, &MachineInputs::default(), &mut |_, _| {})
        .unwrap();
    let left = |spin: f64| spin.hypot(20.0) - 20.0 * (20.0 / spin).asinh();
    for (plane, flows) in machine.snapshot().planes().zip(machine.plane_flows()) {
        let spin = plane.race_spin_rad_s;
        let fallen = drag.arm_m * 0.5 * weight_n * t_s / RACE.inertia_kg_m2;
        assert!(spin < 20.0, "{spin}");
        let off = left(300.0) - left(spin) - fallen;
        assert!(off.abs() < 1e-7 * fallen, "{off:e} of {fallen}");
        let lost_j = 0.5 * RACE.inertia_kg_m2 * (300.0_f64.powi(2) - spin * spin);
        assert!((flows.race_drag / lost_j - 1.0).abs() < 1e-9);
    }
    assert!(machine.audit().residual() < 1e-9);
}

/// A race that friction spins up and load brakes: energy closes, and the method agrees with itself at another tolerance.
#[test]
fn a_race_in_bouncing_is_braked_by_its_load() {
    let run = |arm_m: f64, rtol: f64| {
        let mut params = machine();
        for plane in &mut params.planes {
            plane.race = Some(RaceParams {
                start_spin_rad_s: 0.0,
                ..RACE
            });
            plane.load_drag = Some(LoadDrag {
                arm_m,
                still_rad_s: 20.0,
            });
        }
        let start = MachineStart {
            centre_velocity_m_s: V2::new(0.2, 0.05),
            tilt_rate_rad_s: V2::new(0.3, 0.0),
            spin_rad_s: 400.0,
            ..MachineStart::default()
        };
        let options = Options { rtol, ..OPTIONS };
        let mut machine = Machine::new(&params, &start, options).unwrap();
        let nothing = MachineInputs::default();
        machine.advance(0.02, &nothing, &mut |_, _| {}).unwrap();
        let audit = machine.audit().residual();
        assert!(audit < 100.0 * rtol, "{audit:e}");
        assert!(machine.meters().iter().all(|m| m.impacts > 2));
        let now = machine.snapshot();
        let spins: Vec<f64> = now.planes().map(|p| p.race_spin_rad_s).collect();
        let drag_j: f64 = machine.plane_flows().iter().map(|p| p.race_drag).sum();
        (spins, drag_j)
    };
    let (fine, coarse) = (run(1e-4, 1e-11), run(1e-4, 1e-8));
    for (a, b) in fine.0.iter().zip(&coarse.0) {
        assert!((a - b).abs() < 1e-4 * a.abs(), "{a}, {b}");
    }
    assert!((fine.1 / coarse.1 - 1.0).abs() < 1e-4);
    // Of some 0.1 J in each race.
    assert!(fine.1 > 1e-3, "{fine:?}");
    assert_eq!(run(0.0, 1e-11).1, 0.0);
}

/// The race's own spin is held to the tolerance, however long a call is.
#[test]
fn a_race_runs_out_in_one_long_call() {
    let (mut params, start, _) = seated();
    for plane in &mut params.planes {
        plane.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
        plane.race = Some(RaceParams {
            drag_n_m_s: 1e-5,
            ..RACE
        });
    }
    let options = Options {
        method: Method::Collocation,
        ..OPTIONS
    };
    let mut machine = Machine::new(&params, &start, options).unwrap();
    let nothing = MachineInputs::default();
    machine.advance(1.0, &nothing, &mut |_, _| {}).unwrap();
    for plane in machine.snapshot().planes() {
        let closed = 300.0 * (-1e-5_f64 / 2e-6).exp();
        let off = (plane.race_spin_rad_s / closed - 1.0).abs();
        assert!(off < 1e-8, "{off:e}");
    }
}

const HEAT: BearingHeat = BearingHeat {
    capacity_j_k: 2.0,
    conductance_w_k: 0.0,
    expansion_m_k: 0.0,
    start_rise_k: 0.0,
};

fn warmed(heat: Option<BearingHeat>, method: Method) -> Machine {
    let mut params = machine();
    for plane in &mut params.planes {
        plane.heat = heat;
    }
    let start = MachineStart {
        centre_velocity_m_s: V2::new(0.3, 0.0),
        tilt_rate_rad_s: V2::new(0.2, 0.1),
        spin_rad_s: 400.0,
        ..MachineStart::default()
    };
    let options = Options { method, ..OPTIONS };
    let mut machine = Machine::new(&params, &start, options).unwrap();
    for i in 1..=400 {
        let nothing = MachineInputs::default();
        let t_s = 1e-4 * f64::from(i);
        machine.advance(t_s, &nothing, &mut |_, _| {}).unwrap();
    }
    machine
}

/// Everything that a bearing loses warms it, and nothing else changes where it does not expand.
#[test]
fn losses_warm_a_bearing() {
    let (warm, cold) = (warmed(Some(HEAT), Method::Auto), warmed(None, Method::Auto));
    assert_eq!(warm.audit(), cold.audit());
    assert_eq!(cold.warmth(0), None);
    for (p, flows) in warm.plane_flows().iter().enumerate() {
        let warmth = warm.warmth(p).unwrap();
        assert_eq!(warmth.heat_j, flows.losses_j());
        assert!(warmth.heat_j > 1.0);
        // The last call's losses are not yet in the temperature.
        let behind = warmth.heat_j / 2.0 - warmth.rise_k;
        assert!((0.0..0.02 * warmth.rise_k).contains(&behind), "{behind}");
        assert_eq!(warmth.clearance_m, CLEARANCE_M);
    }
}

/// Clearance that follows the heat, both ways and by both methods: energy closes, and clearance is what the rise says.
#[test]
fn a_clearance_follows_its_heat() {
    for expansion_m_k in [2e-5, -2e-5] {
        for method in [Method::Series, Method::Collocation] {
            let heat = BearingHeat {
                conductance_w_k: 3.0,
                expansion_m_k,
                ..HEAT
            };
            let machine = warmed(Some(heat), method);
            let residual = machine.audit().residual();
            assert!(residual < 1e-8, "{expansion_m_k}: {residual:e}");
            for p in [0, 1] {
                let warmth = machine.warmth(p).unwrap();
                let said = CLEARANCE_M + expansion_m_k * warmth.rise_k;
                assert!((warmth.clearance_m - said).abs() < 1e-9 * CLEARANCE_M);
                assert!((said / CLEARANCE_M - 1.0).abs() > 0.02, "{warmth:?}");
            }
        }
    }
    // Without losses a warm bearing cools.
    let (mut params, start, _) = seated();
    params.planes[0].heat = Some(BearingHeat {
        conductance_w_k: 3.0,
        start_rise_k: 50.0,
        ..HEAT
    });
    let mut machine = Machine::new(&params, &start, OPTIONS).unwrap();
    for t_s in [0.1, 0.7, 0.7 + 1e-6] {
        let nothing = MachineInputs::default();
        machine.advance(t_s, &nothing, &mut |_, _| {}).unwrap();
    }
    let rise_k = machine.warmth(0).unwrap().rise_k;
    let cooled_k = 50.0 * (-1.5_f64 * 0.7).exp();
    assert!(
        (rise_k / cooled_k - 1.0).abs() < 1e-9,
        "{rise_k}, {cooled_k}"
    );
}

/// The step response of an amplifier of second order, below and above critical damping.
#[test]
fn an_amplifier_of_second_order_answers_a_step() {
    for ratio in [0.3, 1.5] {
        let mut params = machine();
        params.magnets = vec![MachineMagnet {
            position_m: 0.1,
            force_max_n: 100.0,
            lag_s: 1e-4,
            lag_damping_ratio: Some(ratio),
            poles: None,
        }];
        let mut machine = Machine::new(&params, &MachineStart::default(), OPTIONS).unwrap();
        assert_eq!(machine.method(), Method::Collocation);
        let inputs = MachineInputs {
            commands_n: vec![V2::new(80.0, -40.0)],
            loads_n: vec![],
        };
        for i in 1..=20 {
            let t_s = 5e-5 * f64::from(i);
            machine.advance(t_s, &inputs, &mut |_, _| {}).unwrap();
            let x = t_s / 1e-4;
            // e^{−ζx}·(cosh(sx) + ζ·sinh(sx)/s), with s imaginary below critical damping.
            let s2: f64 = ratio * ratio - 1.0;
            let (cosh, sinh) = match s2 < 0.0 {
                true => {
                    let w = (-s2).sqrt();
                    ((w * x).cos(), (w * x).sin() / w)
                }
                false => {
                    let s = s2.sqrt();
                    ((s * x).cosh(), (s * x).sinh() / s)
                }
            };
            let share = 1.0 - (-ratio * x).exp() * (cosh + ratio * sinh);
            let off = machine.delivered_n(0).unwrap() - share * inputs.commands_n[0];
            assert!(off.norm() < 1e-8 * 80.0, "{ratio}: {off:?}");
        }
        assert!(machine.audit().residual() < 1e-9);
        params.magnets[0].lag_s = 0.0;
        let refused = Machine::new(&params, &MachineStart::default(), OPTIONS).unwrap_err();
        assert_eq!(refused.field, "magnets[0].lag_damping_ratio");
    }
}

/// However fast its drag stops it against the sample and the step: alone by the exponential, and touched as by a smaller
/// tolerance and the other method.
#[test]
fn drag_of_any_strength_is_under_control() {
    let run = |rate: f64, velocity_m_s: f64, rtol: f64, method: Method| {
        let mut params = machine();
        for plane in &mut params.planes {
            plane.race = Some(RaceParams {
                inertia_kg_m2: 1e-6,
                drag_n_m_s: 1e-6 * rate,
                start_spin_rad_s: 60.0,
            });
        }
        let start = MachineStart {
            centre_velocity_m_s: V2::new(velocity_m_s, 0.0),
            spin_rad_s: 200.0,
            ..MachineStart::default()
        };
        let options = Options {
            rtol,
            method,
            ..Options::default()
        };
        let mut machine = Machine::new(&params, &start, options).unwrap();
        for i in 1..=100 {
            machine
                .advance(
                    f64::from(i) / 2e4,
                    &MachineInputs::default(),
                    &mut |_, _| {},
                )
                .unwrap_or_else(|e| panic!("{rate} /s: {e}"));
        }
        let residual = machine.audit().residual();
        assert!(residual < 1e-7, "{rate} /s: {residual:e} of the energy");
        machine.snapshot().planes().next().unwrap().race_spin_rad_s
    };
    for rate in [1.0, 1e3, 2e4, 1e5, 1e6] {
        let alone = run(rate, 0.01, 1e-6, Method::Series);
        let exact = 60.0 * (-rate * 5e-3_f64).exp();
        assert!((alone - exact).abs() <= 1e-9 * exact, "{rate} /s: {alone}");
        let [loose, tight, other] = [
            (1e-6, Method::Series),
            (1e-10, Method::Series),
            (1e-10, Method::Collocation),
        ]
        .map(|(rtol, method)| run(rate, 0.5, rtol, method));
        assert!(
            (loose - tight).abs() < 1e-4 * (60.0 + tight.abs()),
            "{rate} /s: {loose}, {tight}"
        );
        assert!(
            (other - tight).abs() < 1e-7 * (60.0 + tight.abs()),
            "{rate} /s: {other}, {tight}"
        );
    }
}
