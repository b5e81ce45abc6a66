//! Magnets as they are: poles that attract, currents that a drive sets.

use crate::support::*;

const CAP_N: f64 = 50.0;
const LAG_S: f64 = 2e-4;
const POLES: Poles = Poles {
    bias_current_a: 3.0,
    current_max_a: 2.5,
    air_gap_m: 5e-4,
    coil: None,
};

fn with(poles: Poles) -> MachineParams {
    let mut params = machine();
    params.unbalances.clear();
    params.probes_m = vec![-0.1, 0.12];
    let magnet = |z: &f64| MachineMagnet {
        poles: Some(poles),
        ..magnet(*z, CAP_N, LAG_S)
    };
    params.magnets = params.probes_m.iter().map(magnet).collect();
    params
}

fn coil(inductance_h: f64, resistance_ohm: f64, voltage_max_v: f64) -> Poles {
    Poles {
        coil: Some(Coil {
            inductance_h,
            resistance_ohm,
            voltage_max_v,
        }),
        ..POLES
    }
}

fn auto() -> Options {
    options(Method::Auto, 1e-12)
}

fn commands(commands_n: [V2; 2]) -> MachineInputs {
    MachineInputs {
        commands_n: commands_n.to_vec(),
        loads_n: vec![],
    }
}

fn advance(rotor: &mut Machine, t_s: f64, inputs: &MachineInputs) {
    rotor.advance(t_s, inputs, &mut |_, _| {}).unwrap();
}

/// Eq. (6.7) written out.
fn force_n(poles: &Poles, i: f64, x: f64) -> f64 {
    let (i0, s0) = (poles.bias_current_a, poles.air_gap_m);
    let k = CAP_N / poles.current_max_a * s0 * s0 / (4.0 * i0);
    k * (((i0 + i) / (s0 - x)).powi(2) - ((i0 - i) / (s0 + x)).powi(2))
}

/// A swing that far from the middle, and how far it is from that in linear magnets at its end.
fn off(amplitude_m: f64) -> f64 {
    let from = MachineStart {
        centre_m: V2::new(amplitude_m, 0.0),
        tilt_rad: V2::new(0.0, amplitude_m),
        ..spinning(300.0)
    };
    let force_n = CAP_N * amplitude_m / POLES.air_gap_m;
    let inputs = commands([V2::new(force_n, 0.0), V2::new(0.0, -force_n)]);
    let poles = with(POLES);
    let linear = poles.linear_magnets();
    assert!(linear.supports.len() == 4 && linear.magnets.iter().all(|m| m.poles.is_none()));
    let [a, b] = [(&poles, Method::Auto), (&linear, Method::Series)].map(|(params, method)| {
        let mut rotor = rotor(params, &from, options(method, 1e-12));
        advance(&mut rotor, 0.02, &inputs);
        rotor.axis().centre.position
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
    let from = placed(V2::new(1.5e-4, -0.8e-4), 0.0);
    let mut rotor = rotor(&with(POLES), &from, auto());
    assert_eq!(rotor.method(), Method::Collocation);
    let commands_n = [V2::new(10.0, -22.0), V2::new(-CAP_N, 0.0)];
    advance(&mut rotor, 30.0 * LAG_S, &commands(commands_n));
    for (m, command_n) in commands_n.iter().enumerate() {
        let at = rotor.probe(m).unwrap().position;
        let current_a = command_n / CAP_N * POLES.current_max_a;
        let expected = current_a.zip_map(&at, |i, x| force_n(&POLES, i, x));
        let found = rotor.delivered_n(m).unwrap();
        close("force", found, expected, 1e-9 * CAP_N);
    }
}

/// At full voltage the current rises by U/L, and comes in with the lag from where that voltage is no more needed.
#[test]
fn the_voltage_limits_how_fast_a_force_rises() {
    let (inductance_h, voltage_max_v) = (0.02, 40.0);
    let mut params = with(coil(inductance_h, 0.0, voltage_max_v));
    // So heavy that it stays where it is.
    params.rotor = Rotor::Rigid(RigidRotor {
        mass_kg: 1e9,
        transverse_inertia_kg_m2: 1e9,
        polar_inertia_kg_m2: 0.0,
    });
    let mut rotor = rotor(&params, &MachineStart::default(), auto());
    let inputs = commands([V2::new(CAP_N, 0.0), V2::zeros()]);
    let (rate, most) = (voltage_max_v / inductance_h, POLES.current_max_a);
    let turns_s = (most - rate * LAG_S) / rate;
    for share in [0.2, 0.7, 0.95, 1.05, 1.3, 2.0] {
        let t_s = share * turns_s;
        advance(&mut rotor, t_s, &inputs);
        let current = match t_s < turns_s {
            true => rate * t_s,
            false => most - rate * LAG_S * (-(t_s - turns_s) / LAG_S).exp(),
        };
        let off = rotor.delivered_n(0).unwrap().x - CAP_N * current / most;
        assert!(off.abs() < 1e-6 * CAP_N, "{off} at {t_s}");
    }
}

/// With induction and resistance.
#[test]
fn energy_closes_while_poles_pull_a_rotor_about_its_bearings() {
    let from = moving([0.3, 0.1], [1.0, -0.5], 300.0);
    let mut rotor = rotor(&with(coil(0.02, 1.5, 60.0)), &from, auto());
    for i in 0..200 {
        let command_n = 0.75 * CAP_N * direction(0.2 * f64::from(i));
        let t_s = 1e-4 * f64::from(i + 1);
        advance(&mut rotor, t_s, &commands([command_n; 2]));
    }
    assert!(rotor.meters().iter().all(|meters| meters.impacts > 0));
    assert!(rotor.audit().flows.control.abs() > 1e-3);
    closes("poles", rotor.audit().residual(), 1e-9);
}

#[test]
fn poles_that_cannot_be_are_refused_by_name() {
    let refused = |field: &str, method: Method, change: &dyn Fn(&mut MachineMagnet, &mut Poles)| {
        let mut params = with(POLES);
        let mut poles = POLES;
        change(&mut params.magnets[1], &mut poles);
        params.magnets[1].poles = Some(poles);
        let error = Machine::new(&params, &spinning(0.0), options(method, 1e-9)).unwrap_err();
        assert_eq!(error.field, field, "{error}");
    };
    let gap = "magnets[1].poles.air_gap_m";
    refused("magnets[1].lag_s", Method::Auto, &|m, _| m.lag_s = 0.0);
    refused(gap, Method::Auto, &|_, p| p.air_gap_m = 0.0);
    // Less than the clearance.
    refused(gap, Method::Auto, &|_, p| p.air_gap_m = 2.9e-4);
    let bias = "magnets[1].poles.bias_current_a";
    refused(bias, Method::Auto, &|_, p| p.bias_current_a = f64::NAN);
    // More than the bias.
    let most = "magnets[1].poles.current_max_a";
    refused(most, Method::Auto, &|_, p| p.current_max_a = 3.1);
    refused("run.method", Method::Series, &|_, _| {});
}
