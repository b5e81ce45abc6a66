//! Magnets as they are: poles that attract, currents that a drive sets.

use crate::support::rotor::*;
use plant_model::V2;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::{Method, Options};

const CAP_N: f64 = 50.0;
const LAG_S: f64 = 2e-4;
const POLES: Poles = Poles {
    bias_current_a: 3.0,
    current_max_a: 2.5,
    air_gap_m: 5e-4,
    coil: None,
};

fn magnet(position_m: f64, poles: Option<Poles>) -> MachineMagnet {
    MachineMagnet {
        position_m,
        force_max_n: CAP_N,
        lag_s: LAG_S,
        lag_damping_ratio: None,
        poles,
    }
}

fn with(poles: Option<Poles>) -> MachineParams {
    let mut params = machine();
    params.unbalances.clear();
    params.magnets = vec![magnet(-0.1, poles), magnet(0.12, poles)];
    params.probes_m = vec![-0.1, 0.12];
    params
}

fn options(method: Method) -> Options {
    Options {
        rtol: 1e-12,
        method,
        ..Options::default()
    }
}

/// Eq. (6.7) written out.
fn force_n(poles: &Poles, i: f64, x: f64) -> f64 {
    let (i0, s0) = (poles.bias_current_a, poles.air_gap_m);
    let k = CAP_N / poles.current_max_a * s0 * s0 / (4.0 * i0);
    k * (((i0 + i) / (s0 - x)).powi(2) - ((i0 - i) / (s0 + x)).powi(2))
}

/// A swing that far from the middle, and how far it is from that in linear magnets at its end.
fn off(amplitude_m: f64) -> f64 {
    let start = MachineStart {
        centre_m: V2::new(amplitude_m, 0.0),
        tilt_rad: V2::new(0.0, amplitude_m),
        spin_rad_s: 300.0,
        ..MachineStart::default()
    };
    let share = amplitude_m / POLES.air_gap_m;
    let inputs = MachineInputs {
        commands_n: vec![V2::new(CAP_N * share, 0.0), V2::new(0.0, -CAP_N * share)],
        loads_n: vec![],
    };
    let poles = with(Some(POLES));
    let linear = poles.linear_magnets();
    assert!(linear.supports.len() == 4 && linear.magnets.iter().all(|m| m.poles.is_none()));
    let [a, b] = [(&poles, Method::Auto), (&linear, Method::Series)].map(|(params, method)| {
        let mut machine = Machine::new(params, &start, options(method)).unwrap();
        machine.advance(0.02, &inputs, &mut |_, _| {}).unwrap();
        machine.axis().centre.position
    });
    (a - b).norm()
}

/// About the middle they are linear, with the stiffness that `linear_magnets` has; what is left goes with the third power.
#[test]
fn small_motions_find_linear_magnets() {
    let (small, large) = (off(1e-6), off(1e-5));
    assert!(small < 1e-4 * 1e-6, "{small:e}");
    let power = (large / small).log10();
    assert!((power - 3.0).abs() < 0.05, "{power}");
}

#[test]
fn the_force_is_that_of_the_poles_where_the_rotor_is() {
    let start = MachineStart {
        centre_m: V2::new(1.5e-4, -0.8e-4),
        ..MachineStart::default()
    };
    let mut machine = Machine::new(&with(Some(POLES)), &start, options(Method::Auto)).unwrap();
    assert_eq!(machine.method(), Method::Collocation);
    let commands_n = vec![V2::new(10.0, -22.0), V2::new(-CAP_N, 0.0)];
    let inputs = MachineInputs {
        commands_n: commands_n.clone(),
        loads_n: vec![],
    };
    machine
        .advance(30.0 * LAG_S, &inputs, &mut |_, _| {})
        .unwrap();
    for (m, command_n) in commands_n.iter().enumerate() {
        let at = machine.probe(m).unwrap().position;
        let delivered = machine.delivered_n(m).unwrap();
        for axis in [0, 1] {
            let current = command_n[axis] / CAP_N * POLES.current_max_a;
            let expected = force_n(&POLES, current, at[axis]);
            assert!(
                (delivered[axis] - expected).abs() < 1e-9 * CAP_N,
                "{delivered} {expected}"
            );
        }
    }
}

/// At full voltage the current rises by U/L, and comes in with the lag from where that voltage is no more needed.
#[test]
fn the_voltage_limits_how_fast_a_force_rises() {
    let (inductance_h, voltage_max_v) = (0.02, 40.0);
    let poles = Poles {
        coil: Some(Coil {
            inductance_h,
            resistance_ohm: 0.0,
            voltage_max_v,
        }),
        ..POLES
    };
    let mut params = with(Some(poles));
    // So heavy that it stays where it is.
    params.rotor = Rotor::Rigid(RigidRotor {
        mass_kg: 1e9,
        transverse_inertia_kg_m2: 1e9,
        polar_inertia_kg_m2: 0.0,
    });
    let mut machine =
        Machine::new(&params, &MachineStart::default(), options(Method::Auto)).unwrap();
    let inputs = MachineInputs {
        commands_n: vec![V2::new(CAP_N, 0.0), V2::zeros()],
        loads_n: vec![],
    };
    let (rate, most) = (voltage_max_v / inductance_h, POLES.current_max_a);
    let turns_s = (most - rate * LAG_S) / rate;
    for share in [0.2, 0.7, 0.95, 1.05, 1.3, 2.0] {
        let t_s = share * turns_s;
        machine.advance(t_s, &inputs, &mut |_, _| {}).unwrap();
        let current = match t_s < turns_s {
            true => rate * t_s,
            false => most - rate * LAG_S * (-(t_s - turns_s) / LAG_S).exp(),
        };
        let delivered = machine.delivered_n(0).unwrap().x;
        let expected = CAP_N * current / most;
        assert!(
            (delivered - expected).abs() < 1e-6 * CAP_N,
            "{delivered} {expected} at {t_s}"
        );
    }
}

/// With induction and resistance.
#[test]
fn energy_closes_while_poles_pull_a_rotor_about_its_bearings() {
    let poles = Poles {
        coil: Some(Coil {
            inductance_h: 0.02,
            resistance_ohm: 1.5,
            voltage_max_v: 60.0,
        }),
        ..POLES
    };
    let params = with(Some(poles));
    let start = MachineStart {
        centre_velocity_m_s: V2::new(0.3, 0.1),
        tilt_rate_rad_s: V2::new(1.0, -0.5),
        spin_rad_s: 300.0,
        ..MachineStart::default()
    };
    let mut machine = Machine::new(&params, &start, options(Method::Auto)).unwrap();
    for i in 0..200 {
        let angle = 0.2 * f64::from(i);
        let inputs = MachineInputs {
            commands_n: vec![0.75 * CAP_N * V2::new(angle.cos(), angle.sin()); 2],
            loads_n: vec![],
        };
        machine
            .advance(1e-4 * f64::from(i + 1), &inputs, &mut |_, _| {})
            .unwrap();
    }
    assert!(machine.meters().iter().all(|meters| meters.impacts > 0));
    let audit = machine.audit();
    assert!(
        audit.flows.control.abs() > 1e-3 && audit.residual() < 1e-9,
        "{:e}",
        audit.residual()
    );
}

#[test]
fn poles_that_cannot_be_are_refused_by_name() {
    let refused = |field: &str, method: Method, change: &dyn Fn(&mut MachineMagnet)| {
        let mut params = with(Some(POLES));
        change(&mut params.magnets[1]);
        let error = Machine::new(&params, &MachineStart::default(), options(method)).unwrap_err();
        assert_eq!(error.field, field, "{error}");
    };
    refused("magnets[1].lag_s", Method::Auto, &|m| m.lag_s = 0.0);
    refused("magnets[1].poles.air_gap_m", Method::Auto, &|m| {
        m.poles = Some(Poles {
            air_gap_m: 0.0,
            ..POLES
        });
    });
    refused("magnets[1].poles.bias_current_a", Method::Auto, &|m| {
        m.poles = Some(Poles {
            bias_current_a: f64::NAN,
            ..POLES
        });
    });
    // Less than the clearance, and more than the bias.
    refused("magnets[1].poles.air_gap_m", Method::Auto, &|m| {
        m.poles = Some(Poles {
            air_gap_m: 2.9e-4,
            ..POLES
        });
    });
    refused("magnets[1].poles.current_max_a", Method::Auto, &|m| {
        m.poles = Some(Poles {
            current_max_a: 3.1,
            ..POLES
        });
    });
    refused("run.method", Method::Series, &|_| {});
}
