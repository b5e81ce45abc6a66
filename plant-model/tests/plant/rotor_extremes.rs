//! A whole rotor at its limits: an answer whose energy closes.

use crate::support::rotor::*;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Mode, Options, V2};

fn base() -> MachineParams {
    let mut params = machine();
    params.supports = vec![support(-0.15), support(0.12)];
    params.planes = vec![plane(-0.2, 0.5), plane(0.18, 0.5)];
    params.gravity_m_s2 = V2::new(0.0, -9.81);
    params.spin = SpinParams::Free {
        inertia_kg_m2: 0.4,
        drive_torque_n_m: 0.0,
    };
    params
}

/// The same in the air.
fn dropped() -> MachineParams {
    let mut params = base();
    params.supports.clear();
    params
}

fn struck(spin_rad_s: f64) -> MachineStart {
    MachineStart {
        centre_velocity_m_s: V2::new(0.3, 0.1),
        tilt_rate_rad_s: V2::new(-1.0, 2.0),
        spin_rad_s,
        ..MachineStart::default()
    }
}

fn run(what: &str, params: &MachineParams, start: &MachineStart, duration_s: f64) -> Machine {
    let mut machine = Machine::new(params, start, Options::default()).unwrap();
    let nothing = MachineInputs::default();
    for i in 1..=(duration_s * 2e4) as u32 {
        let t = f64::from(i) / 2e4;
        machine
            .advance(t, &nothing, &mut |_, _| {})
            .unwrap_or_else(|e| panic!("{what}: {e}"));
    }
    let residual = machine.audit().residual();
    assert!(residual < 1e-7, "{what}: {residual:e} of the energy");
    machine
}

fn modes(machine: &Machine) -> Vec<Mode> {
    (0..4).map_while(|p| machine.mode(p)).collect()
}

fn spin_of(mut machine: Machine) -> f64 {
    machine.snapshot().spin_rad_s
}

#[test]
fn inertias_and_spins() {
    let disc = || {
        let mut params = base();
        params.rotor = rigid(0.2, 0.4);
        params
    };
    run("a thin disc", &disc(), &struck(400.0), 0.5);
    run("no spin", &base(), &struck(0.0), 0.5);
    let fast = run("3 kHz", &disc(), &struck(18_850.0), 0.2);
    assert!(fast.meters()[1].peak_backward_speed_m_s > 40.0);
}

#[test]
fn planes() {
    let mut params = base();
    params.planes[1].contact.clearance_m = 1e-9;
    run("no clearance left", &params, &struck(400.0), 0.2);

    let mut params = base();
    params.planes[1] = params.planes[0];
    let same = run("two planes at one place", &params, &struck(400.0), 0.5);
    // What both hold they share equally.
    assert_eq!(modes(&same), [Mode::Roll; 2]);
    let [a, b] = [0, 1].map(|p| same.meters()[p].peak_friction_torque_n_m);
    assert!((a / b - 1.0).abs() < 1e-6, "{a}, {b}");

    let mut params = base();
    let law = params.planes[1].contact.law.linear_mut().unwrap();
    law.stiffness_n_m *= 100.0;
    run("100 times stiffer at one end", &params, &struck(400.0), 0.3);

    let mut params = base();
    params.planes = [-0.2, -0.07, 0.07, 0.2].map(|z| plane(z, 0.5)).to_vec();
    for (i, plane) in params.planes.iter_mut().enumerate() {
        plane.centre_m = V2::new(1e-5 * i as f64, 0.0);
        plane.friction.rolling_coefficient = 0.003;
    }
    run("four planes out of line", &params, &struck(400.0), 0.5);
}

/// Three planes roll at once: two speeds that are held say what the third is wherever the contact normals are parallel, and
/// there it goes through zero, which no friction can hold.
#[test]
fn three_planes_that_roll() {
    let mut params = base();
    params.rotor = rigid(0.15, 0.195);
    params.spin = SpinParams::Held;
    params.supports.clear();
    params.planes = vec![plane(-0.2, 2.0), plane(0.08, 2.0), plane(-0.06, 1.0)];
    for plane in &mut params.planes {
        plane.radius_m = 0.03;
    }
    params.planes[2].contact.clearance_m = 0.6 * CLEARANCE_M;
    let start = MachineStart {
        centre_velocity_m_s: V2::new(0.5, 0.2),
        tilt_rate_rad_s: V2::new(-1.0, 0.5),
        spin_rad_s: 600.0,
        ..MachineStart::default()
    };
    let rolling = run("a seal between two planes", &params, &start, 0.3);
    assert!(
        rolling
            .meters()
            .iter()
            .all(|m| m.peak_backward_speed_m_s > 15.0)
    );
}

#[test]
fn shafts_and_supports() {
    let mut params = base();
    let mut modes = bending(1, 62_832.0);
    modes[0].damping_ratio = 0.001;
    params.rotor = Rotor::Modal {
        rigid: *rigid(0.2, 0.05).rigid(),
        bending: modes,
        polar_coupling_kg_m2: vec![],
        damping_n_s_m: vec![],
    };
    run("bending at 10 kHz", &params, &struck(400.0), 0.2);

    let mut params = base();
    for support in &mut params.supports {
        (support.stiffness_n_m, support.damping_n_s_m) = (V2::repeat(-2e5), V2::zeros());
    }
    run("unstable in tilt", &params, &struck(400.0), 0.3);
}

#[test]
fn drops() {
    let spinning = MachineStart {
        spin_rad_s: 1500.0,
        ..MachineStart::default()
    };
    let rolling = run("a drop at speed", &dropped(), &spinning, 1.0);
    assert_eq!(modes(&rolling), [Mode::Roll; 2]);
    assert!(spin_of(rolling) < 1500.0);

    let mut params = dropped();
    for plane in &mut params.planes {
        plane.friction.rolling_coefficient = 0.002;
    }
    (params.spin, params.unbalances) = (SpinParams::Held, vec![]);
    let still = run(
        "a drop without spin",
        &params,
        &MachineStart::default(),
        2.0,
    );
    assert_eq!(modes(&still), [Mode::Seated; 2]);

    let leaning = MachineStart {
        spin_rad_s: 100.0,
        tilt_rad: V2::new(1e-4, 0.0),
        ..MachineStart::default()
    };
    let mut params = dropped();
    for plane in &mut params.planes {
        plane.contact.law.linear_mut().unwrap().damping_n_s_m = 0.0;
    }
    run("no contact damping", &params, &leaning, 0.5);
    for plane in &mut params.planes {
        plane.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    }
    run("neither damping nor friction", &params, &leaning, 0.5);
}

/// What an unbalance takes from a spin that is free is read off to the last order, also where one wall is so much stiffer than the
/// other that the first step tried is far too long.
#[test]
fn walls_of_very_different_stiffness() {
    for i in 0..12 {
        let mut params = dropped();
        params.gravity_m_s2 = V2::zeros();
        params.rotor = Rotor::Rigid(RigidRotor {
            mass_kg: 1.4,
            transverse_inertia_kg_m2: 0.44,
            polar_inertia_kg_m2: 0.0,
        });
        params.spin = SpinParams::Free {
            inertia_kg_m2: 11.0,
            drive_torque_n_m: 0.0,
        };
        params.unbalances[0].moment_kg_m = 1e-5;
        params.unbalances[0].angle_rad = 0.7 * i as f64;
        params.planes = vec![plane(-0.55, 80.0), plane(0.34, 0.8)];
        for plane in &mut params.planes {
            plane.radius_m = 0.13;
            plane.contact.clearance_m = 5e-5;
            plane.contact.law.linear_mut().unwrap().damping_n_s_m = 0.0;
        }
        params.planes[0].friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
        let mut machine = Machine::new(&params, &struck(100.0), Options::default()).unwrap();
        for ms in 1..=10 {
            let t = f64::from(ms) * 1e-3;
            let nothing = MachineInputs::default();
            machine.advance(t, &nothing, &mut |_, _| {}).unwrap();
        }
        let residual = machine.audit().residual();
        assert!(residual < 1e-9, "{i}: {residual:e} of the energy");
    }
}

/// A ring next to nothing on a stiff wall takes more steps than there are: the run ends, and says what is too fast.
#[test]
fn a_ring_of_a_microgram_is_named() {
    let mut params = dropped();
    for plane in &mut params.planes {
        plane.stator = StatorParams::OneMass(RingParams {
            mass_kg: 1e-9,
            stiffness_n_m: V2::repeat(1e7),
            damping_n_s_m: V2::repeat(1e3),
        });
    }
    let start = struck(400.0);
    let options = Options {
        steps_per_sample: 20_000,
        ..Options::default()
    };
    let mut machine = Machine::new(&params, &start, options).unwrap();
    let nothing = MachineInputs::default();
    let ended = (1..=2000).find_map(|i| {
        let t = 5e-5 * f64::from(i);
        machine.advance(t, &nothing, &mut |_, _| {}).err()
    });
    let ended = ended.expect("it takes more steps than that").to_string();
    assert!(ended.contains("ring on"), "{ended}");
    assert!(ended.contains("too fast for this scene"), "{ended}");
}
