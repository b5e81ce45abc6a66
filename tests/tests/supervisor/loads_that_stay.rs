//! Overloads after which a load stays that the levitation controller carries: the supervisor gives the bearing back.

use firmware_bench::device::loads::Disturbance;
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::supervision::Supervision;
use firmware_bench::scene::Scene;
use firmware_bench::scene::suggest::suggested;
use firmware_studies::machines::plants::plants;
use firmware_studies::machines::random::RandomMachine;
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::case::Sizes;
use firmware_studies::overloads::contenders::{Contender, Task};
use plant_model::V2;
use supervisor::Mode;

/// On machines that nothing was tuned on: a load of a third to two thirds of the cap comes and stays, alone or with a
/// landing. Where levitation alone carries it in the end without contact, the supervisor has it levitated in the end, too,
/// also where forces come late (the law's own spring would leave such a rotor at the wall) and where magnets pull hard.
/// Requirement: SR-26
#[test]
fn what_levitation_carries_it_is_given() {
    let (mut carried, mut touched) = (0, 0);
    for number in 0..12 {
        let unseen = RandomMachine::unseen(number).unwrap();
        if unseen.lateness() > 0.8 {
            continue;
        }
        let found = unseen.gains_with_integrator().unwrap();
        let base = &unseen.scene;
        let sizes = Sizes::of(base).unwrap();
        for (share, landing) in [
            (0.35, 0.0),
            (0.5, 0.0),
            (0.65, 0.0),
            (0.35, 1.0),
            (0.5, 0.5),
        ] {
            let mut scene = Scene {
                duration_s: 0.6,
                disturbances: vec![Disturbance {
                    start_s: 0.0,
                    duration_s: 1.0,
                    force_n: share * sizes.force_n * V2::new(0.8, 0.6),
                    ..Disturbance::default()
                }],
                ..base.clone()
            };
            scene.start.centre_velocity_m_s = V2::new(0.0, landing * sizes.impact_m_s);
            let run = |contender: Contender| {
                let acting = contender.controller(Task::Impact, &found, &scene).unwrap();
                run_policy(&scene, (acting, contender.name()), Keep::Trace, &mut |_| {}).unwrap()
            };
            let (alone, _) = run(Contender::Tuned);
            if !alone.recovered {
                continue;
            }
            let (own, trace) = run(Contender::Supervisor);
            let shown = format!("{}: {share} caps, landing {landing}", unseen.text);
            assert!(own.recovered, "{shown}: {own:?}");
            let last = trace.rows.iter().filter(|row| row.plant.t_s > 0.45);
            let modes: Vec<Mode> = last
                .filter_map(firmware_bench::run::trace::TraceRow::supervisor_mode)
                .collect();
            let levitated = modes.iter().filter(|m| **m == Mode::Levitated).count();
            assert!(10 * levitated > 9 * modes.len(), "{shown}");
            carried += 1;
            touched += usize::from(own.impacts > 0);
        }
    }
    assert!(carried > 20 && touched > 5, "{carried}, {touched}");
}

/// Magnets that pull at the wall with nearly the whole cap and more: a disturbance that the levitation controller holds in
/// the middle does not end on the bearing.
#[test]
fn magnets_that_pull_with_the_whole_cap_are_overcome() {
    let plant = plants(20_000.0).unwrap().remove(4);
    assert_eq!(plant.name, "P2");
    for pull in [0.9, 0.97, 1.1] {
        let mut scene = plant.scene.clone();
        let cap_n_m = 1000.0 / scene.clearance_m(0);
        let own = &mut scene.planes[0];
        scene.machine.supports[0].stiffness_n_m = V2::repeat(-pull * cap_n_m);
        own.nominal.stiffness_n_m = -pull * cap_n_m;
        own.supervisor = Some(suggested(&own.nominal).config);
        scene.duration_s = 0.5;
        scene.start.centre_velocity_m_s = V2::new(0.02, 0.0);
        let mut found = stored("P2", 20_000.0).unwrap();
        found.tuned.proportional_n_m = 2.0 * pull * cap_n_m;
        found.tuned.derivative_n_s_m = 2.0 * (10.0 * pull * cap_n_m).sqrt();
        let run = |contender: Contender| {
            let acting = contender.controller(Task::Impact, &found, &scene).unwrap();
            run_policy(&scene, (acting, contender.name()), Keep::Trace, &mut |_| {}).unwrap()
        };
        let ((alone, _), (own, trace)) = (run(Contender::Tuned), run(Contender::Supervisor));
        assert!(alone.recovered && alone.impacts == 0, "{pull}: {alone:?}");
        assert!(own.recovered && own.impacts == 0, "{pull}: {own:?}");
        let engaged = Supervision::of(&trace).unwrap().engaged_s;
        assert!(engaged < 0.05, "{pull}: {engaged} s");
    }
}

/// A converter whose step is the noise: readings that are the last one by chance, of x here and of y there, are no stuck
/// sensor. A second of it on each plant, with an unbalance that moves the rotor by some steps a tick.
/// Requirement: SR-15
#[test]
fn a_coarse_converter_is_no_stuck_sensor() {
    for rate_hz in [10_000.0, 20_000.0] {
        for plant in plants(rate_hz).unwrap() {
            let found = stored(&plant.name, rate_hz).unwrap();
            let mut scene = plant.scene.clone();
            scene.duration_s = 1.0;
            scene.planes[0].sensor.quantum_m = 1e-6;
            scene.machine.eccentricity_m = 1e-5;
            let acting = Contender::Supervisor
                .controller(Task::Impact, &found, &scene)
                .unwrap();
            let run = (acting, Contender::Supervisor.name());
            let (_, trace) = run_policy(&scene, run, Keep::Trace, &mut |_| {}).unwrap();
            let seen = Supervision::of(&trace).unwrap();
            assert_eq!(seen.sensor_faults, 0, "{} at {rate_hz} Hz", plant.name);
        }
    }
}
