//! A whole rotor at its limits: an answer whose energy closes.

use crate::support::*;

fn base() -> MachineParams {
    let mut params = machine();
    params.supports = vec![support(-0.15), support(0.12)];
    params.planes = vec![plane(-0.2, 0.5), plane(0.18, 0.5)];
    params.gravity_m_s2 = V2::new(0.0, -9.81);
    params.spin = free_spin(0.4, 0.0);
    params
}

fn changed(change: impl FnOnce(&mut MachineParams)) -> MachineParams {
    let mut params = base();
    change(&mut params);
    params
}

/// The same in the air.
fn dropped(change: impl FnOnce(&mut MachineParams)) -> MachineParams {
    let mut params = base();
    params.supports.clear();
    change(&mut params);
    params
}

fn struck(spin_rad_s: f64) -> MachineStart {
    moving([0.3, 0.1], [-1.0, 2.0], spin_rad_s)
}

fn run(what: &str, params: &MachineParams, start: &MachineStart, duration_s: f64) -> Machine {
    let mut machine = rotor(params, start, Options::default());
    for i in 1..=(duration_s * 2e4) as u32 {
        let nothing = MachineInputs::default();
        let done = machine.advance(f64::from(i) / 2e4, &nothing, &mut |_, _| {});
        done.unwrap_or_else(|e| panic!("{what}: {e}"));
    }
    closes(what, machine.audit().residual(), 1e-7);
    machine
}

fn modes(machine: &Machine) -> Vec<ContactMode> {
    (0..4).map_while(|p| machine.mode(p)).collect()
}

fn slippery(plane: &mut MachinePlane) {
    plane.friction.sliding = constant(0.0);
}

#[test]
fn inertias_and_spins() {
    let disc = changed(|p| p.rotor = rigid(0.2, 0.4));
    run("a thin disc", &disc, &struck(400.0), 0.5);
    run("no spin", &base(), &struck(0.0), 0.5);
    let fast = run("3 kHz", &disc, &struck(18_850.0), 0.2);
    assert!(fast.meters()[1].peak_backward_speed_m_s > 40.0);
}

#[test]
fn planes() {
    let none = changed(|p| p.planes[1].contact.clearance_m = 1e-9);
    run("no clearance left", &none, &struck(400.0), 0.2);

    let one_place = changed(|p| p.planes[1] = p.planes[0]);
    let same = run("two planes at one place", &one_place, &struck(400.0), 0.5);
    // What both hold they share equally.
    assert_eq!(modes(&same), [ContactMode::Roll; 2]);
    let [a, b] = [0, 1].map(|p| same.meters()[p].peak_friction_torque_n_m);
    near("shared", a, b, 1e-6);

    let stiffer = changed(|p| p.planes[1].contact.law.linear_mut().unwrap().stiffness_n_m *= 100.0);
    run("100 times stiffer", &stiffer, &struck(400.0), 0.3);

    let four = changed(|p| {
        p.planes = [-0.2, -0.07, 0.07, 0.2].map(|z| plane(z, 0.5)).to_vec();
        for (i, plane) in p.planes.iter_mut().enumerate() {
            plane.centre_m = V2::new(1e-5 * i as f64, 0.0);
            plane.friction.rolling_coefficient = 0.003;
        }
    });
    run("four planes out of line", &four, &struck(400.0), 0.5);
}

/// Three planes roll at once: two speeds that are held say what the third is wherever the contact normals are parallel, and
/// there it goes through zero, which no friction can hold.
#[test]
fn three_planes_that_roll() {
    let params = dropped(|p| {
        p.rotor = rigid(0.15, 0.195);
        p.spin = SpinParams::Held;
        p.planes = vec![plane(-0.2, 2.0), plane(0.08, 2.0), plane(-0.06, 1.0)];
        for plane in &mut p.planes {
            plane.radius_m = 0.03;
        }
        p.planes[2].contact.clearance_m = 0.6 * PLAY_M;
    });
    let from = moving([0.5, 0.2], [-1.0, 0.5], 600.0);
    let rolling = run("a seal between two planes", &params, &from, 0.3);
    let fast = |m: &Meters| m.peak_backward_speed_m_s > 15.0;
    assert!(rolling.meters().iter().all(fast));
}

#[test]
fn shafts_and_supports() {
    let mut mode = bending(1, 62_832.0);
    mode[0].damping_ratio = 0.001;
    let bends = changed(|p| p.rotor = modal(&rigid(0.2, 0.05), mode));
    run("bending at 10 kHz", &bends, &struck(400.0), 0.2);

    let unstable = changed(|p| undamped(p, -2e5));
    run("unstable in tilt", &unstable, &struck(400.0), 0.3);
}

#[test]
fn drops() {
    let mut rolling = run("a drop at speed", &dropped(|_| {}), &spinning(1500.0), 1.0);
    assert_eq!(modes(&rolling), [ContactMode::Roll; 2]);
    assert!(rolling.snapshot().spin_rad_s < 1500.0);

    let still = dropped(|p| {
        for plane in &mut p.planes {
            plane.friction.rolling_coefficient = 0.002;
        }
        (p.spin, p.unbalances) = (SpinParams::Held, vec![]);
    });
    let still = run("a drop without spin", &still, &spinning(0.0), 2.0);
    assert_eq!(modes(&still), [ContactMode::Seated; 2]);

    let leaning = MachineStart {
        tilt_rad: V2::new(1e-4, 0.0),
        ..spinning(100.0)
    };
    let mut elastic = dropped(|p| {
        for plane in &mut p.planes {
            plane.contact.law.linear_mut().unwrap().damping_n_s_m = 0.0;
        }
    });
    run("no contact damping", &elastic, &leaning, 0.5);
    elastic.planes.iter_mut().for_each(slippery);
    run("neither damping nor friction", &elastic, &leaning, 0.5);
}

/// What an unbalance takes from a spin that is free is read off to the last order, also where one wall is so much stiffer than the
/// other that the first step tried is far too long.
#[test]
fn walls_of_very_different_stiffness() {
    for i in 0..12 {
        let params = dropped(|p| {
            p.gravity_m_s2 = V2::zeros();
            p.rotor = Rotor::Rigid(RigidRotor {
                mass_kg: 1.4,
                transverse_inertia_kg_m2: 0.44,
                polar_inertia_kg_m2: 0.0,
            });
            p.spin = free_spin(11.0, 0.0);
            p.unbalances[0].moment_kg_m = 1e-5;
            p.unbalances[0].angle_rad = 0.7 * f64::from(i);
            p.planes = vec![plane(-0.55, 80.0), plane(0.34, 0.8)];
            for plane in &mut p.planes {
                plane.radius_m = 0.13;
                plane.contact.clearance_m = 5e-5;
                plane.contact.law.linear_mut().unwrap().damping_n_s_m = 0.0;
            }
            slippery(&mut p.planes[0]);
        });
        let mut rotor = rotor(&params, &struck(100.0), Options::default());
        carry_sampled(&mut rotor, 0.01, 10);
        closes("walls", rotor.audit().residual(), 1e-9);
    }
}

/// A ring next to nothing on a stiff wall takes more steps than there are: the run ends, and says what is too fast.
#[test]
fn a_ring_of_a_microgram_is_named() {
    let params = dropped(|p| {
        for plane in &mut p.planes {
            plane.stator = StatorParams::OneMass(ring(1e-9, 1e7, 1e3));
        }
    });
    let options = Options {
        steps_per_sample: 20_000,
        ..Options::default()
    };
    let mut machine = rotor(&params, &struck(400.0), options);
    let nothing = MachineInputs::default();
    let mut advance = |t: f64| machine.advance(t, &nothing, &mut |_, _| {}).err();
    let ended = (1..=2000).find_map(|i| advance(5e-5 * f64::from(i)));
    let ended = ended.expect("it takes more steps than that").to_string();
    assert!(ended.contains("ring on"), "{ended}");
    assert!(ended.contains("too fast for this scene"), "{ended}");
}
