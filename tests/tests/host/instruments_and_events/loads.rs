//! Loads with a course, base motion, and the retainer bearing off the centre.

use crate::instruments_and_events::{free_rotor, last, near, ridden, samples};
use crate::refusals::rows;
use firmware_bench::device::loads::{BaseMotion, Disturbance, Shape};
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::outcome::Outcome;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use plant_model::machine::params::Support;
use std::f64::consts::{PI, TAU};
use system_tests::ran::{Folder, has, scene_text};
use system_tests::scene;

/// ∫ F·sin(πt/D) dt = 2FD/π, and what a double integral of it gives for the way.
#[test]
fn a_half_sine_gives_its_momentum_and_its_way() {
    let mut scene = free_rotor();
    // Neither begins nor ends at a sample.
    let (start_s, duration_s, force_n) = (0.010_013, 0.011_007, 1500.0);
    scene.disturbances = vec![Disturbance {
        position_m: 0.0,
        start_s,
        duration_s,
        force_n: V2::new(force_n, -0.5 * force_n),
        shape: Shape::HalfSine,
    }];
    scene.duration_s = 0.03;
    let end = last(&ridden(&scene, PolicyKind::Passive).1).plant;
    let speed = 2.0 * force_n * duration_s / (PI * 10.0);
    near("speed", end.velocity_m_s.x, speed, 1e-12);
    near("speed y", end.velocity_m_s.y, -0.5 * speed, 1e-12);
    // By symmetry half the speed on average during the shock.
    let way = speed * (0.5 * duration_s + (0.03 - start_s - duration_s));
    // Edges cut the first and the last period in two.
    near("way", end.position_m.x, way, 1e-9);
}

/// r = F/(mω²)·(ωt − sin ωt) for a force F·sin ωt on a free mass at rest, within 1e-4 of the amplitude.
#[test]
fn a_sine_moves_a_free_rotor_by_its_closed_form() {
    for frequency_hz in [100.0, 1730.0] {
        let mut scene = free_rotor();
        let (force_n, rate) = (1000.0, TAU * frequency_hz);
        scene.duration_s = 0.02;
        scene.disturbances = vec![Disturbance {
            position_m: 0.0,
            start_s: 0.0,
            duration_s: 1.0,
            force_n: V2::new(force_n, 0.0),
            shape: Shape::Sine {
                frequency_hz,
                phase_rad: 0.0,
            },
        }];
        let amplitude_m = force_n / (10.0 * rate * rate);
        for row in samples(&ridden(&scene, PolicyKind::Passive).1) {
            let phase = rate * row.plant.t_s;
            let exact = amplitude_m * (phase - phase.sin());
            let error = (row.plant.position_m.x - exact).abs() / amplitude_m;
            assert!(error < 1e-4, "{frequency_hz} Hz: {error:e}");
        }
    }
}

/// Housing a·sin(ωt + π/2): a free rotor stays behind by a/ω²·(1 − cos ωt).
#[test]
fn base_motion_leaves_a_free_rotor_behind() {
    let mut scene = free_rotor();
    let (frequency_hz, a) = (50.0, 147.15);
    let rate = TAU * frequency_hz;
    scene.duration_s = 0.04;
    scene.base_motions = vec![BaseMotion {
        start_s: 0.0,
        duration_s: 1.0,
        acceleration_m_s2: V2::new(0.0, a),
        shape: Shape::Sine {
            frequency_hz,
            phase_rad: 0.5 * PI,
        },
    }];
    let amplitude_m = a / (rate * rate);
    for row in samples(&ridden(&scene, PolicyKind::Passive).1) {
        let exact = -amplitude_m * (1.0 - (rate * row.plant.t_s).cos());
        let error = (row.plant.position_m.y - exact).abs() / amplitude_m;
        assert!(error < 2e-4, "{error:e}");
    }
}

/// A levitated rotor rests in the centre of the magnets, which is not that of the retainer bearing, and
/// that is what counts as the middle.
#[test]
fn a_levitated_rotor_rests_in_the_centre_of_the_magnets() {
    let mut scene = scene("overload_then_release");
    scene.disturbances.clear();
    scene.planes[0].sensor = Default::default();
    // A third of the clearance: not in the middle of the retainer bearing.
    let offset_m = V2::new(7e-5, -3e-5);
    scene.machine.planes[0].centre_m = offset_m;
    scene.start.centre_m = offset_m;
    let (verdict, trace) = ridden(&scene, PolicyKind::Levitation);
    let end = last(&trace).plant.position_m;
    assert!((end + offset_m).norm() < 1e-9, "{end}");
    assert_eq!(verdict.outcome, Outcome::Recovered);
    // Without force it falls away from there, as e^(t·√(k/m)).
    scene.start.centre_m = V2::new(1e-6, 0.0);
    scene.duration_s = 0.02;
    let (_, trace) = ridden(&scene, PolicyKind::Passive);
    let row = samples(&trace)[200];
    let rate = (2e5f64 / 10.0).sqrt();
    let away = row.plant.position_m + offset_m;
    near("fall", away.x, 1e-6 * (rate * row.plant.t_s).cosh(), 1e-9);
    near("as measured", row.measured_m.x, away.x, 1e-15);
}

/// A shaft that carries the rotor's weight, about the centre of the magnets.
#[test]
fn the_shaft_acts_about_the_centre_of_the_magnets() {
    let mut scene = free_rotor();
    scene.machine.supports = vec![Support {
        stiffness_n_m: V2::repeat(1e5),
        damping_n_s_m: V2::repeat(2e3),
        ..Support::default()
    }];
    scene.machine.gravity_m_s2 = V2::new(0.0, -9.81);
    scene.machine.planes[0].centre_m = V2::new(2e-5, 1e-5);
    scene.start.centre_m = V2::new(2e-5, 1e-5);
    scene.duration_s = 2.0;
    let end = last(&ridden(&scene, PolicyKind::Passive).1)
        .plant
        .position_m;
    near("x", end.x, -2e-5, 1e-9);
    near("y", end.y, -98.1 / 1e5 - 1e-5, 1e-9);
}

/// A retainer bearing far off the centre of the magnets reaches into the middle: a rotor that lies on it
/// there has not been recovered, and one that has left it has only after 5 ms without contact.
#[test]
fn a_rotor_on_the_wall_is_not_recovered_in_the_middle() {
    let mut scene = scene("overload_then_release");
    let clearance_m = scene.clearance_m(0);
    scene.disturbances.clear();
    scene.machine.planes[0].centre_m = V2::new(0.8 * clearance_m, 0.0);
    scene.machine.gravity_m_s2 = V2::new(-20.0, 0.0);
    scene.start.centre_m = V2::new((0.8 - 0.99) * clearance_m, 0.0);
    for keep in [Keep::Verdict, Keep::Decision] {
        let (verdict, _) = run(&scene, PolicyKind::Passive, keep, &mut |_| {}).unwrap();
        assert!(verdict.contact_time_s > 0.9 * scene.duration_s);
        assert!(!verdict.recovered, "{verdict:?}");
        assert_eq!(verdict.relevitation_time_s, None);
    }
}

/// A rotor that a load from a file moves, against the exact way under a course of straight pieces; and a base that shakes.
#[test]
fn a_recorded_course_moves_a_free_rotor_exactly() {
    let folder = Folder::fresh();
    // Rises to 300 N in 7 ms, falls to nothing in 5 ms, along y a constant; at no sample.
    let course = "time,fy,fx\n0.001003,200,0\n0.008003,200,300\n0.013003,200,0\n";
    folder.put("force.csv", course);
    let text = r#"
title = "a force from a file"
run = { duration_s = 0.03, sample_rate_hz = 20000, policies = ["passive"] }
rotor = { mass_kg = 10.0, contact_radius_m = 0.05 }
spin = { frequency_hz = 0.0 }
contact = { clearance_m = 1.0, stiffness_n_m = 1e8 }
friction = { coefficient = 0.1 }
verdict = { whirl_speed_m_s = 1.0 }
"#;
    let load = "[[disturbance]]\nfile = \"force.csv\"\ntime_column = \"time\"\nx_column = \"fx\"\n";
    let run_of = |more: &str| {
        let path = folder.put("scene.toml", format!("{text}{more}"));
        let scene = Scene::load(&path).unwrap();
        last(&ridden(&scene, PolicyKind::Passive).1).plant
    };
    let end = run_of(&format!("{load}y_column = \"fy\"\nforce_n = [1.0, -0.5]\n"));
    let (rise, fall, rest) = (0.007, 0.005, 0.03 - 0.013003);
    let speed = 0.5 * 300.0 * (rise + fall) / 10.0;
    let after_rise = 30.0 * rise / 2.0;
    let way = 30.0 * rise * rise / 6.0 + after_rise * fall + 30.0 * fall * fall / 3.0;
    near("speed", end.velocity_m_s.x, speed, 1e-11);
    near("way", end.position_m.x, way + speed * rest, 1e-9);
    near("speed y", end.velocity_m_s.y, -100.0 * 0.012 / 10.0, 1e-11);
    // One axis alone, later, and cut before its end: 2 ms of it at 200 N.
    let late = load.replace("x_column = \"fx\"", "y_column = \"fy\"");
    let end = run_of(&format!("{late}start_s = 0.01\nduration_s = 0.003003\n"));
    assert_eq!(end.velocity_m_s.x, 0.0);
    near("cut", end.velocity_m_s.y, 200.0 * 0.002 / 10.0, 1e-11);
    let base = load.replace("[[disturbance]]", "[[base_motion]]");
    let end = run_of(&base);
    near("base", end.velocity_m_s.x, -10.0 * speed, 1e-11);
}

/// What of a file cannot be had is said with key, file and what there is.
#[test]
fn a_file_that_is_no_course_is_refused() {
    let folder = Folder::fresh();
    let text = scene_text("overload_then_release");
    // The last of its tables.
    let (before, _) = text.split_once("[[disturbance]]").unwrap();
    for row in rows("files/course_of_a_load", 8) {
        let [file, keys, part] = &row[..] else {
            panic!("{row:?}")
        };
        folder.put("f.csv", file);
        let scene = format!("{before}[[disturbance]]\n{keys}\n");
        let refused = Scene::load(&folder.put("scene.toml", scene)).unwrap_err();
        let said = format!("{:?}", miette::Report::new(refused));
        has(&said.replace('\n', " "), &[part]);
    }
}
