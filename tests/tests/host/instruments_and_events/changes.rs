//! Parameters that change during a run, and what a verdict says of contact.

use crate::instruments_and_events::{free_rotor, last, near, ridden, samples};
use firmware_bench::device::loads::TimedChange;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::machine::params::Support;
use plant_model::params::{SlidingFriction, SpinParams, Start, StatorParams};
use plant_model::{Change, Method, Options, Plant, V2, build};
use std::f64::consts::TAU;
use system_tests::scene;

fn at(at_s: f64, change: Change) -> Vec<TimedChange> {
    vec![TimedChange { at_s, change }]
}

fn unbalance(eccentricity_m: f64) -> Change {
    Change {
        eccentricity_m: Some(eccentricity_m),
        ..Change::default()
    }
}

/// A free rotor with a lost blade: r̈ = ε·Ω²·(cos Ωt, sin Ωt) from the exact time of the loss, so that it
/// circles with the amplitude ε about a centre that drifts; and its work is booked.
#[test]
fn a_lost_blade_makes_a_synchronous_circle() {
    for free in [false, true] {
        let mut scene = free_rotor();
        if !free {
            scene.machine.spin = SpinParams::Held;
        }
        let (at_s, e, rate) = (0.010_013, 1e-4, TAU * 200.0);
        scene.start.spin_rad_s = rate;
        scene.start.spin_phase_rad = 0.3;
        scene.duration_s = 0.05;
        scene.changes = at(at_s, unbalance(e));
        let direction = |t: f64| {
            let (sin, cos) = (rate * t + 0.3).sin_cos();
            V2::new(cos, sin)
        };
        for row in samples(&ridden(&scene, PolicyKind::Passive).1) {
            let t = row.plant.t_s;
            let u = direction(at_s);
            let kick = rate * V2::new(-u.y, u.x);
            let expected = match t < at_s {
                true => V2::zeros(),
                false => e * (u + kick * (t - at_s) - direction(t)),
            };
            let error = (row.plant.position_m - expected).norm() / e;
            assert!(error < 1e-9, "{free} {t}: {error:e}");
        }
    }
}

/// On a damped shaft the circle settles at ε·Ω²/|ω₀² − Ω² + i·d·Ω/m|.
#[test]
fn a_lost_blade_settles_at_the_synchronous_amplitude() {
    let mut scene = free_rotor();
    let (natural, rate) = (TAU * 45.0, TAU * 200.0);
    scene.machine.supports = vec![Support {
        stiffness_n_m: V2::repeat(10.0 * natural * natural),
        damping_n_s_m: V2::repeat(1000.0),
        ..Support::default()
    }];
    scene.duration_s = 0.6;
    scene.changes = at(0.1, unbalance(2e-5));
    let end = last(&ridden(&scene, PolicyKind::Passive).1).plant;
    let end = end.position_m;
    let real = natural * natural - rate * rate;
    let size = real.hypot(1000.0 / 10.0 * rate);
    near("amplitude", end.norm(), 2e-5 * rate * rate / size, 1e-6);
}

/// Friction that collapses under a sliding rotor on the wall takes the torque on the spin with it, and the
/// books stay closed under every method.
#[test]
fn a_friction_collapse_frees_the_spin() {
    for method in [Method::Series, Method::Collocation] {
        let mut scene = scene("overload_then_release");
        scene.method = method;
        scene.disturbances[0].start_s = 0.0;
        scene.disturbances[0].duration_s = 1.0;
        scene.duration_s = 0.1;
        scene.planes[0].sensor = Default::default();
        let change = Change {
            friction_coefficient: Some(0.0),
            ..Change::default()
        };
        scene.changes = at(0.060_003, change);
        let trace = ridden(&scene, PolicyKind::Supervisor).1;
        let spin = |i: usize| samples(&trace)[i].plant.spin_rad_s;
        assert!(spin(1000) - spin(1200) > 1.0, "friction brakes before");
        near("spin", spin(2000), spin(1201), 1e-12);
    }
}

/// 4 N m on 0.02 kg m².
#[test]
fn a_drive_torque_sets_in() {
    let mut scene = free_rotor();
    scene.duration_s = 0.1;
    scene.start.spin_rad_s = 100.0;
    let change = Change {
        drive_torque_n_m: Some(4.0),
        ..Change::default()
    };
    scene.changes = at(0.030_003, change);
    let end = last(&ridden(&scene, PolicyKind::Passive).1)
        .plant
        .spin_rad_s;
    near("spin", end, 100.0 + 200.0 * (0.1 - 0.030_003), 1e-12);
}

fn at_rest(scene: &Scene) -> Plant {
    let start = Start {
        position_m: V2::zeros(),
        velocity_m_s: V2::zeros(),
        spin_rad_s: 0.0,
        spin_phase_rad: 0.0,
    };
    build(&scene.plant(0), &start, Options::default()).unwrap()
}

/// A change that the plant has no part for is refused, and changes nothing.
#[test]
fn changes_are_refused_where_nothing_can_change() {
    let mut scene = free_rotor();
    let mut plant = at_rest(&scene);
    let error = plant.change(&unbalance(-1e-5)).unwrap_err();
    assert_eq!(error.field, "rotor.eccentricity_m");
    plant.change(&unbalance(1e-5)).unwrap();
    scene.machine.spin = SpinParams::Held;
    let mut plant = at_rest(&scene);
    plant.change(&unbalance(1e-5)).unwrap();
    let torque = Change {
        drive_torque_n_m: Some(1.0),
        ..Change::default()
    };
    assert_eq!(
        plant.change(&torque).unwrap_err().field,
        "spin.drive_torque_n_m"
    );
}

/// An elastic touch at speed v gives back (1 + e)·m·v; slow touches are not counted as hard.
#[test]
fn the_verdict_counts_impulse_and_hard_contacts() {
    let mut scene = free_rotor();
    let wall = &mut scene.machine.planes[0];
    wall.contact.clearance_m = 2e-4;
    wall.stator = StatorParams::Rigid;
    wall.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    let touch = |scene: &mut Scene, speed: f64| {
        scene.start.centre_velocity_m_s = V2::new(speed, 0.0);
        scene.duration_s = 2.5e-4 / speed;
        ridden(scene, PolicyKind::Passive).0
    };
    let hard = touch(&mut scene, 0.1);
    near("first contact", hard.first_contact_s.unwrap(), 2e-3, 1e-12);
    near("impulse", hard.contact_impulse_n_s, 1.7 * 10.0 * 0.1, 1e-6);
    assert_eq!((hard.impacts, hard.contacts_over_20_mm_s), (1, 1));
    let soft = touch(&mut scene, 0.019);
    assert_eq!((soft.impacts, soft.contacts_over_20_mm_s), (1, 0));
    scene.duration_s = 1e-3;
    let none = ridden(&scene, PolicyKind::Passive).0;
    assert_eq!(
        (none.first_contact_s, none.contact_impulse_n_s),
        (None, 0.0)
    );
}
