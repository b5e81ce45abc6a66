//! Motions without contact that can be written down.

use crate::support::*;
use nalgebra::Complex;

/// ω = Ω·I_p/(2·I_t) ± √((Ω·I_p/(2·I_t))² + k_φ/I_t), forward and backward, to many periods.
#[test]
fn conical_modes_part_with_spin() {
    let spin = 800.0;
    for ratio in [0.05, 0.3, 0.9, 1.0, 1.5, 1.9] {
        let (params, half, root) = conical(ratio, spin);
        for omega in [half + root, half - root] {
            let amplitude = 1e-4;
            let from = MachineStart {
                tilt_rad: V2::new(amplitude, 0.0),
                ..moving([0.0; 2], [0.0, amplitude * omega], spin)
            };
            let mut rotor = rotor(&params, &from, series());
            advance(&mut rotor, 1.0);
            let at = rotor.snapshot().planes().next().unwrap().rotor.position / -ARM_M;
            // Round-off of some thousand radians.
            close("tilt", at / amplitude, direction(omega), 1e-10);
            closes("conical", rotor.audit().residual(), 1e-11);
        }
    }
}

/// Without stiffness a tilt rate goes round forward at Ω·I_p/I_t, and while the spin falls by the angle it has turned through.
#[test]
fn nutation_follows_the_spin() {
    let mut params = machine();
    params.rotor = rigid(0.2, 0.3);
    params.supports.clear();
    params.unbalances.clear();
    params.spin = free_spin(0.5, -200.0);
    let mut rotor = rotor(&params, &moving([0.0; 2], [0.01, 0.0], 500.0), series());
    advance(&mut rotor, 0.5);
    let now = rotor.snapshot();
    assert!((now.spin_rad_s - 300.0).abs() < 1e-9);
    let turned = 1.5 * (500.0 * 0.5 - 0.5 * 400.0 * 0.25);
    let rate = now.planes().next().unwrap().rotor.velocity / -0.2;
    close("rate", rate / 0.01, direction(turned), 1e-11);
    closes("nutation", rotor.audit().residual(), 1e-12);
}

/// Synchronous circles of translation and of tilt on two damped springs, of an eccentricity and of an unbalance off the centre of
/// mass: (k − m·Ω² + iΩd)·r = U·Ω² and (k_φ − (I_t − I_p)·Ω² + iΩd_φ)·φ = z·U·Ω².
#[test]
fn unbalance_gives_its_forced_response() {
    let (spin, arm) = (300.0_f64, 0.15 * 0.15);
    for (z, moment, angle) in [(0.0, 2e-4, 0.0), (0.07, 2e-5, 0.4)] {
        let mut params = machine();
        params.unbalances.clear();
        match z == 0.0 {
            true => params.eccentricity_m = moment / 10.0,
            false => params.unbalances.push(Unbalance {
                position_m: z,
                moment_kg_m: moment,
                angle_rad: angle,
            }),
        }
        let force = Complex::from_polar(moment * spin * spin, angle);
        let centre = force / Complex::new(4e5 - 10.0 * spin * spin, 200.0 * spin);
        let stiff = 4e5 * arm - (0.2 - 0.05) * spin * spin;
        let tilt = force * z / Complex::new(stiff, 200.0 * arm * spin);
        let at = |c: Complex<f64>| V2::new(c.re, c.im);
        let along = |c: Complex<f64>| V2::new(-c.im, c.re);
        let from = MachineStart {
            centre_m: at(centre),
            centre_velocity_m_s: spin * along(centre),
            tilt_rad: at(tilt),
            tilt_rate_rad_s: spin * along(tilt),
            spin_rad_s: spin,
            ..MachineStart::default()
        };
        let mut rotor = rotor(&params, &from, series());
        advance(&mut rotor, 1.7);
        let turned = Complex::from_polar(1.0, 1.7 * spin);
        for (plane, position_m) in rotor.snapshot().planes().zip([-0.2, 0.2]) {
            let expected = at((centre + tilt * position_m) * turned);
            let most = 1e-11 * centre.norm();
            close("at a plane", plane.rotor.position, expected, most);
        }
        closes("unbalance", rotor.audit().residual(), 1e-12);
    }
}

/// A free mass under a command that the amplifier follows with a lag: v = F/m·(t − τ·(1 − exp(−t/τ))), where the cap keeps the
/// direction.
#[test]
fn amplifier_lag_is_exact_in_flight() {
    let (t, lag): (f64, f64) = (1e-3, 2e-4);
    let mut params = free_mass(linear(1e8, 0.7), 0.125);
    params.magnet = Some(magnet_of(100.0, lag));
    let from = start(V2::zeros(), V2::zeros(), 0.0);
    let mut plant = build(&params, &from, series()).unwrap();
    let inputs = Inputs {
        command_n: V2::new(300.0, 400.0),
        external_n: V2::zeros(),
    };
    plant.advance(t, &inputs, &mut |_| {}).unwrap();
    let exact = 100.0 / 10.0 * (t - lag * (1.0 - (-t / lag).exp()));
    let v = plant.snapshot().velocity_m_s;
    close("v", v, exact * V2::new(0.6, 0.8), 1e-14);
    closes("lag", plant.audit().residual(), 1e-13);
}

/// The step response of an amplifier of second order, below and above critical damping.
#[test]
fn an_amplifier_of_second_order_answers_a_step() {
    for ratio in [0.3, 1.5] {
        let mut params = machine();
        params.magnets = vec![MachineMagnet {
            lag_damping_ratio: Some(ratio),
            ..magnet(0.1, 100.0, 1e-4)
        }];
        let from = MachineStart::default();
        let mut rotor = rotor(&params, &from, options(Method::Auto, 1e-11));
        assert_eq!(rotor.method(), Method::Collocation);
        let inputs = MachineInputs {
            commands_n: vec![V2::new(80.0, -40.0)],
            loads_n: vec![],
        };
        for i in 1..=20 {
            let t_s = 5e-5 * f64::from(i);
            rotor.advance(t_s, &inputs, &mut |_, _| {}).unwrap();
            let x = t_s / 1e-4;
            // e^{−ζx}·(cosh(sx) + ζ·sinh(sx)/s), with s imaginary below critical damping.
            let s = Complex::new(ratio * ratio - 1.0, 0.0).sqrt();
            let rings = (s * x).cosh() + (s * x).sinh() / s * ratio;
            let share = 1.0 - (-ratio * x).exp() * rings.re;
            let delivered = rotor.delivered_n(0).unwrap();
            let expected = share * inputs.commands_n[0];
            close("force", delivered, expected, 1e-8 * 80.0);
        }
        closes("amplifier", rotor.audit().residual(), 1e-9);
        params.magnets[0].lag_s = 0.0;
        let refused = Machine::new(&params, &from, series()).unwrap_err();
        assert_eq!(refused.field, "magnets[0].lag_damping_ratio");
    }
}

/// A damped oscillator on the shaft, for a hundred seconds in one go or sampled; and after five hundred: a clock that has run for
/// long rounds coarsely, and a map that is made then has the length of one rounded sample, which must not add up.
#[test]
fn long_flights_end_where_the_oscillator_does() {
    for (begin_s, samples, period_s, damping_n_s_m) in [
        (0.0, 1, 100.0, 0.02),
        (0.0, 100_000, 1e-3, 0.02),
        (500.0, 200_000, 5e-5, 0.0),
    ] {
        let mut params = free_mass(linear(1e9, 0.7), 0.1);
        (params.rotor.stiffness_n_m, params.rotor.damping_n_s_m) = (9.1e5, damping_n_s_m);
        let decay = 0.5 * damping_n_s_m / MASS_KG;
        let omega = (9.1e5 / MASS_KG - decay * decay).sqrt();
        let (at, v) = (V2::new(1e-4, 2e-5), V2::new(-0.01, 0.03));
        let mut plant = build(&params, &start(at, v, 100.0), Options::default()).unwrap();
        if begin_s > 0.0 {
            run_to(&mut plant, begin_s);
        }
        for sample in 1..=samples {
            run_to(&mut plant, begin_s + f64::from(sample) * period_s);
        }
        let t = begin_s + f64::from(samples) * period_s;
        let swings = at * (omega * t).cos() + (v + decay * at) / omega * (omega * t).sin();
        let exact = (-decay * t).exp() * swings;
        let share = if begin_s > 0.0 { 1e-8 } else { 1e-9 };
        let most = share * exact.norm();
        close("end", plant.snapshot().position_m, exact, most);
        assert_eq!(plant.meters().impacts, 0);
        closes("flight", plant.audit().residual(), 1e-9);
    }
}

/// A rotor that swings off the wall may be carried on for as long as one likes: nothing moves too fast. All steps count in the
/// whole run.
#[test]
fn a_long_flight_is_no_work_limit() {
    let params = onset_rig();
    let from = start(V2::new(1e-5, 0.0), V2::zeros(), 200.0);
    let rate = params.natural_frequency_rad_s().unwrap();
    let end_s = 2.0 * Options::default().steps_per_sample as f64 / rate;
    let mut plant = build(&params, &from, Options::default()).unwrap();
    run_to(&mut plant, end_s);
    assert_eq!(plant.snapshot().mode, ContactMode::Flight);
    let few = Options {
        steps: 1000,
        ..Options::default()
    };
    let mut plant = build(&params, &from, few).unwrap();
    let ended = plant.advance(end_s, &load(V2::zeros()), &mut |_| {});
    assert!(matches!(
        ended,
        Err(PlantError::WorkLimit { steps: 1000, .. })
    ));
}

/// At rest in the centre nothing acts, whatever the stiffness, the spin or the stator: there it stays
/// to the bit, without energy turned over.
#[test]
fn at_rest_in_the_centre_it_stays_for_ever() {
    for (method, stiffness) in each(&METHODS, &[9.1e5, 0.0, -3e5]) {
        for spin in [0.0, 400.0, -std::f64::consts::TAU * 1000.0] {
            let mut params = footnote_4();
            params.rotor.stiffness_n_m = stiffness;
            if spin != 0.0 {
                params.stator = StatorParams::Rigid;
            }
            let mut plant = plant(&params, &start(V2::zeros(), V2::zeros(), spin), method);
            let t = if spin == 0.0 { 1.0 } else { 100.0 };
            let end = carry(&mut plant, t, V2::zeros());
            assert_eq!([end.position_m, end.velocity_m_s], [V2::zeros(); 2]);
            assert_eq!((end.spin_rad_s, plant.meters().impacts), (spin, 0));
            assert_eq!(plant.audit().residual(), 0.0);
        }
    }
}

/// Off the wall a race coasts; sample by sample, by the map of flight, and in one go.
#[test]
fn a_race_coasts_exponentially_in_flight() {
    let (inertia, drag, start_spin_rad_s) = (1e-3, 0.03, -200.0);
    for spin in [SpinParams::Held, free_spin(0.05, 0.0)] {
        for (eccentricity_m, samples) in each(&[0.0, 1e-6], &[1, 7, 1000]) {
            let mut params = onset_rig();
            params.spin = spin;
            params.rotor.eccentricity_m = eccentricity_m;
            params.race = Some(race(inertia, drag, start_spin_rad_s));
            let from = start(V2::new(5e-5, 0.0), V2::new(0.0, 0.01), 100.0);
            let mut plant = build(&params, &from, Options::default()).unwrap();
            let end_s = 0.1;
            sampled(&mut plant, end_s, samples);
            assert_eq!(plant.meters().impacts, 0);
            let x: f64 = drag / inertia * end_s;
            let left = start_spin_rad_s * (-x).exp();
            near("spin", plant.snapshot().race_spin_rad_s, left, 1e-12);
            let lost = -0.5 * inertia * start_spin_rad_s.powi(2) * (-2.0 * x).exp_m1();
            near("lost", plant.audit().flows.stator_damping, lost, 1e-12);
            closes("race", plant.audit().residual(), 1e-14);
        }
    }
}
