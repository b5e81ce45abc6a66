//! Supports whose springs and dampers push across the motion, as seals do.

use crate::support::*;
use plant_model::machine::linear::{Direction, LinearMachine, Walls};

/// Of the whole rotor, in its middle \[N/m, N s/m\].
const STIFFNESS_N_M: f64 = 4e5;
const DAMPING_N_S_M: f64 = 60.0;
const MASS_KG: f64 = 10.0;

/// A rotor that moves as one, with a seal in its middle.
fn sealed(cross_n_m: f64, cross_n_s_m: f64) -> MachineParams {
    let mut params = machine();
    params.unbalances.clear();
    params.supports = vec![Support {
        position_m: 0.0,
        stiffness_n_m: V2::repeat(STIFFNESS_N_M),
        damping_n_s_m: V2::repeat(DAMPING_N_S_M),
        cross_stiffness_n_m: V2::new(cross_n_m, -cross_n_m),
        cross_damping_n_s_m: V2::new(cross_n_s_m, -cross_n_s_m),
    }];
    params
}

/// The two roots of m·s² + (d − j·d_c)·s + k − j·k_c = 0 for z = x + j·y: growth and rate.
fn roots(cross_n_m: f64, cross_n_s_m: f64) -> [nalgebra::Complex<f64>; 2] {
    type C = nalgebra::Complex<f64>;
    let damping = C::new(DAMPING_N_S_M, -cross_n_s_m);
    let stiffness = C::new(STIFFNESS_N_M, -cross_n_m);
    let root = (damping * damping - stiffness * (4.0 * MASS_KG)).sqrt();
    [1.0, -1.0].map(|sign| (-damping + root * sign) / (2.0 * MASS_KG))
}

#[test]
fn modes_are_those_of_the_closed_form() {
    // At the limit d·√(k/m) forward whirl neither grows nor dies.
    let limit = DAMPING_N_S_M * (STIFFNESS_N_M / MASS_KG).sqrt();
    for (cross_n_m, cross_n_s_m) in [(0.6 * limit, 0.0), (1.3 * limit, 0.0), (0.5 * limit, 40.0)] {
        let params = sealed(cross_n_m, cross_n_s_m);
        let linear = LinearMachine::new(&params, Walls::Off).unwrap();
        let modes = linear.modes(0.0).unwrap();
        let roots = roots(cross_n_m, cross_n_s_m);
        for root in roots {
            let turning = match root.im > 0.0 {
                true => Direction::Forward,
                false => Direction::Backward,
            };
            let size = root.im.abs();
            let found = modes.iter().any(|mode| {
                mode.direction == turning
                    && (mode.frequency_rad_s / size - 1.0).abs() < 1e-9
                    && (mode.growth_s - root.re).abs() < 1e-7 * size
            });
            assert!(found, "{root} not in {modes:?}");
        }
        assert_eq!(roots[0].re > 0.0, cross_n_m > limit, "{roots:?}");
    }
}

/// Both methods, in flight by the step and by the sample, go as the closed form does, and what the seal gives is booked.
#[test]
fn a_run_grows_as_the_closed_form_and_energy_closes() {
    let params = sealed(4.0e4, 25.0);
    let [root, _] = roots(4.0e4, 25.0);
    let from = MachineStart {
        centre_m: V2::new(1e-5, 0.0),
        ..moving([root.re * 1e-5, root.im * 1e-5], [0.0; 2], 400.0)
    };
    for method in METHODS {
        let mut rotor = rotor(&params, &from, options(method, 1e-11));
        carry_sampled(&mut rotor, 0.04, 800);
        let size = 1e-5 * (root.re * 0.04).exp();
        let expected = size * direction(root.im * 0.04);
        let now = rotor.snapshot().planes().next().unwrap().rotor.position;
        close("grown", now, expected, 1e-9 * size);
        assert!(root.re > 0.0 && size > 1.1e-5);
        assert!(rotor.audit().flows.external > 0.0);
        closes(method.name(), rotor.audit().residual(), 1e-10);
    }
}

/// In contact, too.
#[test]
fn energy_closes_where_a_sealed_rotor_bounces() {
    for (method, (k, d)) in each(&METHODS, &[(8e4, 0.0), (-3e4, 30.0)]) {
        let mut params = sealed(k, d);
        params.supports[0].cross_stiffness_n_m = V2::new(k, 0.2 * k);
        let from = moving([0.3, 0.0], [0.5, -0.2], 400.0);
        let mut rotor = rotor(&params, &from, options(method, 1e-9));
        carry_sampled(&mut rotor, 0.02, 400);
        assert!(rotor.meters()[0].impacts > 0);
        closes(method.name(), rotor.audit().residual(), 1e-8);
    }
}

#[test]
fn dampers_that_would_give_power_are_refused() {
    let mut params = sealed(0.0, 0.0);
    let made = |params: &MachineParams| Machine::new(params, &spinning(0.0), Options::default());
    params.supports[0].cross_damping_n_s_m = V2::new(70.0, 60.0);
    let refused = made(&params).unwrap_err();
    assert_eq!(refused.field, "supports[0].cross_damping_n_s_m");
    assert_eq!(refused.value, 65.0);
    params.supports[0].cross_damping_n_s_m = V2::new(70.0, -70.0);
    made(&params).unwrap();
    params.supports[0].cross_stiffness_n_m.y = f64::NAN;
    let refused = made(&params).unwrap_err();
    assert_eq!(refused.field, "supports[0].cross_stiffness_n_m");
}
