//! Flight from sample to sample goes by a map once the step length recurs; cut at other times it goes by
//! the series. Both must be the same flight.

use crate::support::*;

const PERIOD_S: f64 = 5e-5;

/// Every part that flies: no, one and two rings (the rings at different stiffness by axis, after a push),
/// lag and none, damping and none, drive torque.
fn point_masses() -> Vec<MachineParams> {
    let [inner, outer] = two_rings();
    let inner = RingParams {
        stiffness_n_m: V2::new(8.9e8, 6.0e8),
        damping_n_s_m: V2::new(300.0, 500.0),
        ..inner
    };
    let outer = RingParams {
        damping_n_s_m: V2::new(200.0, 100.0),
        ..outer
    };
    let mut all = Vec::new();
    for case in 0..12 {
        let mut params = footnote_4();
        params.stator = stators(inner, outer)[case % 3];
        let lag_s = if case < 6 { 0.0 } else { 2e-4 };
        params.rotor.stiffness_n_m = if case % 2 == 0 { 9.1e5 } else { -2e5 };
        params.rotor.damping_n_s_m = if lag_s > 0.0 { 20.5 } else { 0.0 };
        params.spin = free_spin(0.05, 3.0);
        params.magnet = Some(magnet_of(500.0, lag_s));
        all.push(params.machine());
    }
    all
}

/// Four bending modes that are coupled by their slopes and by a damper somewhere along the shaft, a ring, a race, magnets with and
/// without lag, a load and weight.
fn whole_rotor() -> MachineParams {
    let mut params = machine();
    params.rotor = modal(&rigid(0.2, 0.3), bending(4, 1900.0));
    if let Rotor::Modal {
        polar_coupling_kg_m2: coupling,
        damping_n_s_m,
        ..
    } = &mut params.rotor
    {
        *coupling = vec![0.0; 25];
        (coupling[1], coupling[5], coupling[6]) = (0.2, 0.2, 0.5);
        let moved = [1.0, 0.05, 0.7, -0.4, 0.2, 0.1];
        let both = moved.iter().flat_map(|a| moved.map(|b| 40.0 * (a * b)));
        *damping_n_s_m = both.collect();
    }
    params.planes[1].stator = StatorParams::OneMass(RingParams {
        mass_kg: 2.0,
        stiffness_n_m: V2::new(2e7, 3e7),
        damping_n_s_m: V2::new(3000.0, 500.0),
    });
    params.planes[0].race = Some(race(1e-5, 1e-5, 300.0));
    params.magnets = vec![magnet(-0.12, 500.0, 2e-4), magnet(0.14, 500.0, 0.0)];
    params.loads_m = vec![0.2];
    params.gravity_m_s2 = V2::new(0.0, -1.0);
    params
}

/// Each sample in one go or cut in two.
fn fly(
    params: &MachineParams,
    from: &MachineStart,
    (samples, force_n): (u32, f64),
    cut: bool,
) -> Machine {
    // Contact must not blur what is compared here.
    let mut rotor = rotor(params, from, series());
    for sample in 0..samples {
        let phase = f64::from(sample);
        let command = force_n * V2::new((0.3 * phase).sin(), 0.7 * (0.11 * phase).cos());
        let inputs = MachineInputs {
            commands_n: (params.magnets.iter())
                .map(|m| command * (1.0 - m.position_m))
                .collect(),
            loads_n: vec![V2::new(0.0, -0.1 * force_n)],
        };
        let [begin, end] = [sample, sample + 1].map(|n| f64::from(n) * PERIOD_S);
        let mut advance = |t: f64| rotor.advance(t, &inputs, &mut |_, _| {}).unwrap();
        if cut {
            // Nowhere twice the same.
            let share = 0.3 + 0.4 * (0.618 * f64::from(sample)).fract();
            advance(begin + share * (end - begin));
        }
        advance(end);
    }
    rotor
}

/// `most` is the most that they may be apart, of what is usual.
fn same_flight(whole: &mut Machine, cut: &mut Machine, most: f64, what: &str) {
    let (a, b) = (whole.snapshot(), cut.snapshot());
    for (a, b) in a.planes().zip(b.planes()) {
        close(what, a.rotor.position, b.rotor.position, most * 1e-4);
        close(what, a.rotor.velocity, b.rotor.velocity, most * 0.1);
        for (a, b) in [(a.ring, b.ring), (a.outer_ring, b.outer_ring)] {
            close(what, a.position, b.position, most * 1e-5);
            close(what, a.velocity, b.velocity, most * 0.1);
        }
        assert!((a.race_spin_rad_s - b.race_spin_rad_s).abs() < 1e-9);
    }
    for (a, b) in a.delivered_n().zip(b.delivered_n()) {
        close(what, a, b, most * 300.0);
    }
    assert!((a.spin_rad_s - b.spin_rad_s).abs() < 1e-7);
    let [a, b] = [whole.audit(), cut.audit()];
    closes(what, a.residual().max(b.residual()), 0.01 * most);
    let (a, b) = (a.flows, b.flows);
    for (name, a, b) in [
        ("control", a.control, b.control),
        ("external", a.external, b.external),
        ("unbalance", a.unbalance, b.unbalance),
        ("rotor damping", a.rotor_damping, b.rotor_damping),
        ("stator damping", a.stator_damping, b.stator_damping),
        ("drive", a.drive, b.drive),
    ] {
        assert!(
            (a - b).abs() < most * (a.abs() + 1e-3),
            "{what}, {name}: {a} and {b}"
        );
    }
}

/// Point masses touch once, so that rings and spin move, and fly on.
#[test]
fn samples_flown_whole_or_cut_are_the_same_flight() {
    let touching = MachineStart {
        centre_m: V2::new(1.5e-4, 0.2e-4),
        centre_velocity_m_s: V2::new(0.2, 0.02),
        spin_rad_s: 100.0,
        ..MachineStart::default()
    };
    for params in point_masses() {
        let [mut whole, mut cut] =
            [false, true].map(|cut| fly(&params, &touching, (400, 300.0), cut));
        assert_eq!(whole.meters()[0].impacts, cut.meters()[0].impacts);
        assert!(whole.meters()[0].impacts >= 1);
        same_flight(&mut whole, &mut cut, 1e-9, &format!("{params:?}"));
    }
    let flying = MachineStart {
        centre_m: V2::new(2e-5, 1e-5),
        tilt_rate_rad_s: V2::new(0.02, 0.01),
        spin_rad_s: 700.0,
        ..MachineStart::default()
    };
    let params = whole_rotor();
    let [mut whole, mut cut] = [false, true].map(|cut| fly(&params, &flying, (2000, 10.0), cut));
    assert!(whole.work().evaluations < cut.work().evaluations / 5);
    let of = whole.audit().flows;
    for work_j in [
        of.control,
        of.external,
        of.unbalance,
        of.rotor_damping,
        of.stator_damping,
    ] {
        assert!(work_j != 0.0, "{of:?}");
    }
    same_flight(&mut whole, &mut cut, 1e-11, "whole rotor");
}

/// Whole samples are flown by the map only where nothing can reach the wall within: here the path leaves
/// the clearance in the middle of a sample of a quarter period and is back inside at its end.
#[test]
fn a_touch_within_a_whole_sample_is_not_jumped_over() {
    let mut params = footnote_4();
    params.stator = StatorParams::Rigid;
    params.rotor.damping_n_s_m = 0.0;
    let omega = (params.rotor.stiffness_n_m / params.rotor.mass_kg).sqrt();
    let sample_s = 0.5 * std::f64::consts::PI / omega;
    let from = start(V2::new(1e-6, 0.0), V2::zeros(), 0.0);
    // A quarter period about an equilibrium e takes (x, v/ω) to (e + v/ω, e − x). Two of them lead to
    // (0.7, 0.8) clearances; the third one's path swings out to 1.06 and ends at 0.8.
    let reach_n = params.rotor.stiffness_n_m * params.contact.clearance_m;
    for shares in [&[1.0][..], &[0.21, 0.33, 0.46]] {
        let mut plant = build(&params, &from, Options::default()).unwrap();
        let mut t = 0.0;
        let mut sample = |plant: &mut Plant, force_n: f64| {
            for share in shares {
                t += share * sample_s;
                let inputs = load(V2::new(force_n, 0.0));
                plant.advance(t, &inputs, &mut |_| {}).unwrap();
            }
        };
        for _ in 0..40 {
            sample(&mut plant, 0.0);
        }
        assert_eq!(plant.meters().impacts, 0);
        for force in [-0.05, 0.75, 0.0] {
            sample(&mut plant, force * reach_n);
        }
        assert_eq!(plant.meters().impacts, 1);
    }
}
