//! A retainer bearing as it is: drag of its race by speed and by load, heat.

use crate::support::*;

const INERTIA_KG_M2: f64 = 2e-6;

fn drag(arm_m: f64) -> Option<LoadDrag> {
    Some(LoadDrag {
        arm_m,
        still_rad_s: 20.0,
    })
}

const WEIGHT_N: f64 = 98.1;

/// A rotor that lies on its lower walls without friction.
fn seated() -> MachineParams {
    let mut params = machine();
    params.unbalances.clear();
    params.supports.clear();
    params.gravity_m_s2 = V2::new(0.0, -9.81);
    for plane in &mut params.planes {
        plane.friction.sliding = constant(0.0);
    }
    params
}

fn lying() -> MachineStart {
    placed(V2::new(0.0, -PLAY_M - WEIGHT_N / 1e8), 0.0)
}

/// In one long call, on the wall: by viscous drag Ω falls as e^{−bt/J}; by load √(Ω² + Ω_0²) − Ω_0·arsinh(Ω_0/Ω), which is
/// ∫ √(Ω² + Ω_0²)/Ω dΩ, falls by κ·N·t/J.
#[test]
fn drag_brakes_a_race_as_its_closed_forms_say() {
    let mut params = seated();
    let run = |params: &MachineParams, t_s: f64| {
        let mut rotor = rotor(params, &lying(), options(Method::Collocation, 1e-11));
        advance(&mut rotor, t_s);
        closes("drag", rotor.audit().residual(), 1e-9);
        rotor
    };
    for plane in &mut params.planes {
        plane.race = Some(race(INERTIA_KG_M2, 1e-5, 300.0));
    }
    for plane in run(&params, 1.0).snapshot().planes() {
        let left = 300.0 * (-5.0_f64).exp();
        near("viscous", plane.race_spin_rad_s, left, 1e-8);
    }
    for plane in &mut params.planes {
        (plane.race, plane.load_drag) = (Some(race(INERTIA_KG_M2, 0.0, 300.0)), drag(2e-5));
    }
    assert_eq!(params.method(Method::Auto), Ok(Method::Collocation));
    let t_s = 0.8;
    let mut rotor = run(&params, t_s);
    let left = |spin: f64| spin.hypot(20.0) - 20.0 * (20.0 / spin).asinh();
    for (plane, flows) in rotor.snapshot().planes().zip(rotor.plane_flows()) {
        let spin = plane.race_spin_rad_s;
        assert!(spin < 20.0, "{spin}");
        let fallen = 2e-5 * 0.5 * WEIGHT_N * t_s / INERTIA_KG_M2;
        near("by load", left(300.0) - left(spin), fallen, 1e-7);
        let lost_j = 0.5 * INERTIA_KG_M2 * (300.0_f64.powi(2) - spin * spin);
        near("lost", flows.race_drag, lost_j, 1e-9);
    }
}

/// A race that friction spins up and load brakes: energy closes, and the method agrees with itself at another tolerance.
#[test]
fn a_race_in_bouncing_is_braked_by_its_load() {
    let run = |arm_m: f64, rtol: f64| {
        let mut params = machine();
        for plane in &mut params.planes {
            (plane.race, plane.load_drag) = (Some(race(INERTIA_KG_M2, 0.0, 0.0)), drag(arm_m));
        }
        let from = moving([0.2, 0.05], [0.3, 0.0], 400.0);
        let mut rotor = rotor(&params, &from, options(Method::Auto, rtol));
        advance(&mut rotor, 0.02);
        closes("braked", rotor.audit().residual(), 100.0 * rtol);
        assert!(rotor.meters().iter().all(|m| m.impacts > 2));
        rotor
    };
    let [mut fine, mut coarse] = [1e-11, 1e-8].map(|rtol| run(1e-4, rtol));
    for (a, b) in fine.snapshot().planes().zip(coarse.snapshot().planes()) {
        near("spin", b.race_spin_rad_s, a.race_spin_rad_s, 1e-4);
    }
    let drag_j = |of: &Machine| of.plane_flows().iter().map(|p| p.race_drag).sum::<f64>();
    near("drag", drag_j(&coarse), drag_j(&fine), 1e-4);
    // Of some 0.1 J in each race.
    assert!(drag_j(&fine) > 1e-3);
    assert_eq!(drag_j(&run(0.0, 1e-11)), 0.0);
}

/// However fast its drag stops it against the sample and the step: alone by the exponential, and touched as by a smaller
/// tolerance and the other method.
#[test]
fn drag_of_any_strength_is_under_control() {
    let run = |rate: f64, velocity_m_s: f64, rtol: f64, method: Method| {
        let mut params = machine();
        for plane in &mut params.planes {
            plane.race = Some(race(1e-6, 1e-6 * rate, 60.0));
        }
        let from = moving([velocity_m_s, 0.0], [0.0; 2], 200.0);
        let mut rotor = rotor(&params, &from, options(method, rtol));
        carry_sampled(&mut rotor, 5e-3, 100);
        closes("race", rotor.audit().residual(), 1e-7);
        rotor.snapshot().planes().next().unwrap().race_spin_rad_s
    };
    for rate in [1.0, 1e3, 2e4, 1e5, 1e6] {
        let alone = run(rate, 0.01, 1e-6, Method::Series);
        let exact = 60.0 * (-rate * 5e-3_f64).exp();
        assert!((alone - exact).abs() <= 1e-9 * exact, "{rate} /s: {alone}");
        let tight = run(rate, 0.5, 1e-10, Method::Series);
        for (rtol, method, share) in [
            (1e-6, Method::Series, 1e-4),
            (1e-10, Method::Collocation, 1e-7),
        ] {
            let other = run(rate, 0.5, rtol, method);
            let off = (other - tight).abs() / (60.0 + tight.abs());
            assert!(off < share, "{rate} /s: {other}, {tight}");
        }
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
    let from = moving([0.3, 0.0], [0.2, 0.1], 400.0);
    let mut rotor = rotor(&params, &from, options(method, 1e-11));
    carry_sampled(&mut rotor, 0.04, 400);
    rotor
}

/// Everything that a bearing loses warms it, and nothing else changes where it does not expand.
#[test]
fn losses_warm_a_bearing() {
    let [warm, cold] = [Some(HEAT), None].map(|heat| warmed(heat, Method::Auto));
    assert_eq!(warm.audit(), cold.audit());
    assert_eq!(cold.warmth(0), None);
    for (p, flows) in warm.plane_flows().iter().enumerate() {
        let warmth = warm.warmth(p).unwrap();
        assert_eq!(warmth.heat_j, flows.losses_j());
        assert!(warmth.heat_j > 1.0);
        // The last call's losses are not yet in the temperature.
        let behind = warmth.heat_j / 2.0 - warmth.rise_k;
        assert!((0.0..0.02 * warmth.rise_k).contains(&behind), "{behind}");
        assert_eq!(warmth.clearance_m, PLAY_M);
    }
}

/// Clearance that follows the heat, both ways and by both methods: energy closes, and clearance is what the rise says. Without
/// losses a warm bearing cools.
#[test]
fn a_clearance_follows_its_heat() {
    for (method, expansion_m_k) in each(&METHODS, &[2e-5, -2e-5]) {
        let heat = BearingHeat {
            conductance_w_k: 3.0,
            expansion_m_k,
            ..HEAT
        };
        let rotor = warmed(Some(heat), method);
        closes("heat", rotor.audit().residual(), 1e-8);
        for p in [0, 1] {
            let warmth = rotor.warmth(p).unwrap();
            let want = PLAY_M + expansion_m_k * warmth.rise_k;
            near("clearance", warmth.clearance_m, want, 1e-9);
            assert!((want / PLAY_M - 1.0).abs() > 0.02, "{warmth:?}");
        }
    }
    let mut params = seated();
    params.planes[0].heat = Some(BearingHeat {
        conductance_w_k: 3.0,
        start_rise_k: 50.0,
        ..HEAT
    });
    let mut rotor = rotor(&params, &lying(), options(Method::Auto, 1e-11));
    for t_s in [0.1, 0.7, 0.7 + 1e-6] {
        advance(&mut rotor, t_s);
    }
    let cooled_k = 50.0 * (-1.5_f64 * 0.7).exp();
    near("rise", rotor.warmth(0).unwrap().rise_k, cooled_k, 1e-9);
}
