//! Supports whose springs and dampers push across the motion, as seals do.

use crate::support::rotor::*;
use plant_model::machine::linear::{Direction, LinearMachine, Walls};
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::{Method, Options, V2};

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

/// The two roots of m·s² + (d − j·d_c)·s + k − j·k_c = 0 for z = x + j·y, by growth and rate.
fn roots(cross_n_m: f64, cross_n_s_m: f64) -> [(f64, f64); 2] {
    type C = nalgebra::Complex<f64>;
    let damping = C::new(DAMPING_N_S_M, -cross_n_s_m);
    let stiffness = C::new(STIFFNESS_N_M, -cross_n_m);
    let root = (damping * damping - stiffness * (4.0 * MASS_KG)).sqrt();
    [1.0, -1.0].map(|sign| {
        let s = (-damping + root * sign) / (2.0 * MASS_KG);
        (s.re, s.im)
    })
}

#[test]
fn modes_are_those_of_the_closed_form() {
    // At the limit d·√(k/m) forward whirl neither grows nor dies.
    let limit = DAMPING_N_S_M * (STIFFNESS_N_M / MASS_KG).sqrt();
    for (cross_n_m, cross_n_s_m) in [(0.6 * limit, 0.0), (1.3 * limit, 0.0), (0.5 * limit, 40.0)] {
        let params = sealed(cross_n_m, cross_n_s_m);
        let modes = LinearMachine::new(&params, Walls::Off)
            .unwrap()
            .modes(0.0)
            .unwrap();
        for (growth, rate) in roots(cross_n_m, cross_n_s_m) {
            let (turning, size) = match rate > 0.0 {
                true => (Direction::Forward, rate),
                false => (Direction::Backward, -rate),
            };
            let found = modes.iter().any(|mode| {
                mode.direction == turning
                    && (mode.frequency_rad_s / size - 1.0).abs() < 1e-9
                    && (mode.growth_s - growth).abs() < 1e-7 * size
            });
            assert!(found, "{growth:e}, {rate:e} not in {modes:?}");
        }
        let forward = roots(cross_n_m, cross_n_s_m)[0];
        assert_eq!(forward.0 > 0.0, cross_n_m > limit, "{forward:?}");
    }
}

/// Both methods, in flight by the step and by the sample, go as the closed form does, and what the seal gives is booked.
#[test]
fn a_run_grows_as_the_closed_form_and_energy_closes() {
    let (cross_n_m, cross_n_s_m) = (4.0e4, 25.0);
    let params = sealed(cross_n_m, cross_n_s_m);
    let (growth, rate) = roots(cross_n_m, cross_n_s_m)[0];
    let place = V2::new(1e-5, 0.0);
    let start = MachineStart {
        centre_m: place,
        centre_velocity_m_s: V2::new(growth * place.x, rate * place.x),
        spin_rad_s: 400.0,
        ..MachineStart::default()
    };
    for method in [Method::Series, Method::Collocation] {
        let options = Options {
            rtol: 1e-11,
            method,
            ..Options::default()
        };
        let mut rotor = Machine::new(&params, &start, options).unwrap();
        let nothing = MachineInputs::default();
        let mut t = 0.0;
        for i in 1..=800_u32 {
            t = 5e-5 * f64::from(i);
            rotor.advance(t, &nothing, &mut |_, _| {}).unwrap();
        }
        let size = place.x * (growth * t).exp();
        let expected = size * V2::new((rate * t).cos(), (rate * t).sin());
        let snapshot = rotor.snapshot();
        let now = snapshot.planes().next().unwrap().rotor.position;
        assert!(
            (now - expected).norm() < 1e-9 * size,
            "{}: {now:?}, {expected:?}",
            method.name()
        );
        assert!(growth > 0.0 && size > 1.1 * place.x);
        let books = rotor.audit();
        assert!(books.flows.external > 0.0);
        assert!(
            books.residual() < 1e-10,
            "{}: {:e}",
            method.name(),
            books.residual()
        );
    }
}

/// In contact, too.
#[test]
fn energy_closes_where_a_sealed_rotor_bounces() {
    for (k, d) in [(8e4, 0.0), (-3e4, 30.0)] {
        let mut params = sealed(k, d);
        params.supports[0].cross_stiffness_n_m = V2::new(k, 0.2 * k);
        let start = MachineStart {
            centre_velocity_m_s: V2::new(0.3, 0.0),
            tilt_rate_rad_s: V2::new(0.5, -0.2),
            spin_rad_s: 400.0,
            ..MachineStart::default()
        };
        for method in [Method::Series, Method::Collocation] {
            let options = Options {
                method,
                ..Options::default()
            };
            let mut rotor = Machine::new(&params, &start, options).unwrap();
            for i in 1..=400_u32 {
                let t = 5e-5 * f64::from(i);
                rotor
                    .advance(t, &MachineInputs::default(), &mut |_, _| {})
                    .unwrap();
            }
            assert!(rotor.meters()[0].impacts > 0);
            let residual = rotor.audit().residual();
            assert!(residual < 1e-8, "{}: {residual:e}", method.name());
        }
    }
}

#[test]
fn dampers_that_would_give_power_are_refused() {
    let mut params = sealed(0.0, 0.0);
    params.supports[0].cross_damping_n_s_m = V2::new(70.0, 60.0);
    let refused = Machine::new(&params, &MachineStart::default(), Options::default()).unwrap_err();
    assert_eq!(refused.field, "supports[0].cross_damping_n_s_m");
    assert_eq!(refused.value, 65.0);
    params.supports[0].cross_damping_n_s_m = V2::new(70.0, -70.0);
    Machine::new(&params, &MachineStart::default(), Options::default()).unwrap();
    params.supports[0].cross_stiffness_n_m.y = f64::NAN;
    let refused = Machine::new(&params, &MachineStart::default(), Options::default()).unwrap_err();
    assert_eq!(refused.field, "supports[0].cross_stiffness_n_m");
}
