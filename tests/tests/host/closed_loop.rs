//! Plant, instruments, controllers and supervisor together.

use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::device::loads::Disturbance;
use firmware_bench::run::closed_loop::{Keep, RunError, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::outcome::Outcome;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use system_tests::{golden, scene, scene_path};

pub(crate) fn verdict(scene: &Scene, policy: PolicyKind) -> Figures {
    run(scene, policy, Keep::Verdict, &mut |_| {}).unwrap().0
}

/// The whole chain sees a mirrored scene as the mirror image, to the bit.
#[test]
fn a_mirrored_scene_has_the_mirrored_run() {
    let scene = scene("impact_at_40_hz");
    let mirror = |v: V2| V2::new(-v.x, v.y);
    let mut mirrored = scene.clone();
    mirrored.start.centre_m = mirror(scene.start.centre_m);
    mirrored.start.centre_velocity_m_s = mirror(scene.start.centre_velocity_m_s);
    mirrored.start.spin_rad_s = -scene.start.spin_rad_s;
    for policy in PolicyKind::ALL {
        let (a, left) = run(&scene, policy, Keep::Trace, &mut |_| {}).unwrap();
        let (b, right) = run(&mirrored, policy, Keep::Trace, &mut |_| {}).unwrap();
        assert_eq!((a.outcome, a.impacts), (b.outcome, b.impacts));
        assert!(a.spin_lost_hz > 0.0, "{}", policy.name());
        assert_eq!(a.spin_lost_hz, b.spin_lost_hz, "{}", policy.name());
        assert_eq!(left.rows.len(), right.rows.len());
        for (a, b) in left.rows.iter().zip(&right.rows) {
            assert_eq!(
                mirror(a.plant.position_m),
                b.plant.position_m,
                "{}",
                policy.name()
            );
            assert_eq!(mirror(a.commanded_n), b.commanded_n, "{}", policy.name());
            assert_eq!(a.supervisor_mode(), b.supervisor_mode());
        }
    }
}

/// A rotor that only vibrates inside its clearance is the levitation controller's business alone.
#[test]
fn without_contact_the_supervisor_changes_nothing() {
    let mut scene = scene("overload_then_release");
    scene.disturbances.clear();
    // A converter's step would turn a rounding difference into a whole count.
    scene.planes[0].sensor.quantum_m = 0.0;
    scene.start.centre_m = V2::new(3e-5, -2e-5);
    let (_, alone) = run(&scene, PolicyKind::Levitation, Keep::Trace, &mut |_| {}).unwrap();
    let (_, supervised) = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {}).unwrap();
    for (a, b) in alone.rows.iter().zip(&supervised.rows) {
        // The supervisor's border is single precision.
        let single = a.commanded_n.map(|x| f64::from(x as f32));
        assert!(
            (single - b.commanded_n).norm() <= 1e-6 * (1.0 + single.norm()),
            "{}",
            a.plant.t_s
        );
        assert_eq!(b.supervisor_mode(), Some(supervisor::Mode::Levitated));
    }
}

#[test]
fn scenes_end_as_their_stories_say() {
    let impact = scene("impact_at_40_hz");
    let overload = scene("overload_then_release");
    let outcome = |scene: &Scene, policy| verdict(scene, policy).outcome;
    for kind in [
        PolicyKind::Passive,
        PolicyKind::Radial,
        PolicyKind::Levitation,
    ] {
        assert_eq!(outcome(&impact, kind), Outcome::Whirl);
    }
    assert_eq!(outcome(&overload, PolicyKind::Passive), Outcome::Whirl);

    let saved = verdict(&impact, PolicyKind::Supervisor);
    let released = verdict(&overload, PolicyKind::Supervisor);
    let alone = verdict(&overload, PolicyKind::Levitation);
    assert_eq!(alone.outcome, Outcome::Recovered);
    let recovered = |of: &Figures| f64::from(u8::from(of.outcome == Outcome::Recovered));
    let back_s = |of: &Figures| of.relevitation_time_s.unwrap_or(f64::NAN);
    let over = |of: fn(&Figures) -> f64| of(&released) / of(&alone);
    let force = over(|of| of.peak_contact_force_n);
    let measured = [
        ("impact_recovered", recovered(&saved)),
        ("impact_touches", saved.impacts as f64),
        ("impact_peak_contact_force_n", saved.peak_contact_force_n),
        ("impact_relevitated_s", back_s(&saved)),
        ("overload_recovered", recovered(&released)),
        ("overload_relevitated_s", back_s(&released)),
        ("overload_touches", released.impacts as f64),
        ("overload_peak_force_over_levitation", force),
        (
            "overload_spin_lost_over_levitation",
            over(|of| of.spin_lost_hz),
        ),
    ];
    golden::compare("scenes", &measured).unwrap_or_else(|e| panic!("{e}"));
}

/// A rotor that drifts between two impacts, however slowly, is bouncing; one that never touches is free.
#[test]
fn a_drifting_rotor_has_not_settled() {
    let mut scene = scene("overload_then_release");
    scene.disturbances.clear();
    scene.machine.supports.clear();
    scene.start.centre_velocity_m_s = V2::new(0.02, 0.0);
    let mut after = |duration_s: f64| {
        scene.duration_s = duration_s;
        verdict(&scene, PolicyKind::Passive)
    };
    assert_eq!(
        after(0.005).outcome,
        Outcome::Decayed,
        "has not reached the wall yet"
    );
    let drifting = after(0.02);
    assert_eq!((drifting.outcome, drifting.impacts), (Outcome::Bouncing, 1));
    assert!(!drifting.recovered);
}

/// While a load that the magnet cannot hold is on, the rotor is pinned; that is no whirl and no rest.
#[test]
fn a_load_that_stays_pins_the_rotor() {
    let mut scene = scene("overload_then_release");
    scene.disturbances[0].duration_s = 1.0;
    let held = verdict(&scene, PolicyKind::Supervisor);
    assert_eq!(held.outcome, Outcome::Pinned);
    assert_eq!(held.relevitation_time_s, None);
}

/// A horizontal rotor whose weight the controller's integrator carries: a push to the wall must not
/// make the hand-over drop it.
#[test]
fn a_carried_weight_is_not_dropped_at_hand_over() {
    let mut scene = scene("overload_then_release");
    scene.machine.gravity_m_s2 = V2::new(0.0, -9.81);
    if let Some(levitation) = &mut scene.planes[0].levitation {
        levitation.integral_n_m_s = 2e7;
    }
    scene.duration_s = 0.4;
    for (push_n, seed) in [(3000.0, 1), (5000.0, 2), (7000.0, 3)] {
        scene.planes[0].seed = seed;
        scene.disturbances = vec![Disturbance {
            start_s: 0.2,
            duration_s: 1e-3,
            force_n: V2::new(0.6 * push_n, 0.8 * push_n),
            ..Disturbance::default()
        }];
        let alone = verdict(&scene, PolicyKind::Levitation);
        let supervised = verdict(&scene, PolicyKind::Supervisor);
        assert_eq!(supervised.outcome, Outcome::Recovered, "{push_n} N");
        assert!(
            supervised.impacts <= alone.impacts.max(8),
            "{} impacts",
            supervised.impacts
        );
    }
}

/// A load near what holds a rotor on the wall at first, or near the cap, does not make it chatter: what can be lifted off
/// touches once, and what cannot is thrown onto the wall and stays, but for hops too slow to count as hard.
#[test]
fn a_load_near_the_cap_does_not_chatter() {
    let mut scene = scene("overload_then_release");
    scene.duration_s = 0.6;
    for (share, touches, hard) in [
        (0.75, 1, 1),
        (0.8, 1, 1),
        (0.9, 1, 1),
        (1.0, 30, 1),
        (1.1, 12, 3),
    ] {
        scene.disturbances[0].duration_s = 0.5;
        scene.disturbances[0].force_n = V2::new(share * 1000.0, 0.0);
        let v = verdict(&scene, PolicyKind::Supervisor);
        assert_eq!(v.outcome, Outcome::Recovered, "{share} of the cap");
        assert!(v.impacts <= touches, "{} touches at {share}", v.impacts);
        let most = v.contacts_over_20_mm_s;
        assert!(most <= hard, "{most} hard touches at {share}");
    }
}

/// The drive knows of a power loss at the sample at which it begins, and of the power's return at the sample
/// at which it ends, also where count times period comes out one rounding short of the scene's time: at 12 kHz
/// samples 51 and 102 are at 4.25 and 8.5 ms. Without power the supervisor does not act; with a rotor that a
/// load presses on the wall it acts at all other times.
#[test]
fn a_known_power_loss_is_told_at_its_first_and_last_sample() {
    let (rate_hz, first, end) = (12_000.0_f64, 51, 102);
    let (start_s, end_s) = (0.00425, 2.0 * 0.00425);
    for (tick, at_s) in [(first, start_s), (end, end_s)] {
        assert!((f64::from(tick) / rate_hz - at_s).abs() < 1e-15);
        assert!(
            f64::from(tick) * (1.0 / rate_hz) < at_s,
            "rounds as it should for this test"
        );
    }
    let text = std::fs::read_to_string(scene_path("overload_then_release")).unwrap();
    let text = (text.replace("sample_rate_hz = 20000", "sample_rate_hz = 12000"))
        .replace("duration_s = 0.2\n", "duration_s = 0.012\n")
        .replace("start_s = 0.02\n", "start_s = 0.0\n");
    let outage = format!("[[outage]]\nstart_s = {start_s}\nduration_s = {start_s}\nknown = true\n");
    let mut scene = Scene::parse("power_loss.toml", &(text + &outage)).unwrap();
    let c = scene.clearance_m(0);
    scene.start.centre_m = V2::new(0.87 * c, 0.5 * c);
    scene.levitated_before = true;
    let (_, trace) = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {}).unwrap();
    let modes: Vec<_> = (trace.rows.iter())
        .filter(|row| !row.mode_change)
        .map(|row| row.supervisor_mode().unwrap())
        .collect();
    for (tick, mode) in modes.iter().enumerate().take(end as usize).skip(45) {
        let off = tick >= first as usize && tick < end as usize;
        assert_eq!(*mode == supervisor::Mode::Levitated, off, "sample {tick}");
    }
}

/// A load that the levitation controller can carry is handed back to it, wherever between middle and wall it lets the
/// rotor rest meanwhile.
#[test]
fn a_load_within_the_cap_is_handed_back() {
    let mut scene = scene("overload_then_release");
    scene.duration_s = 1.0;
    scene.planes[0].levitation = Some(LevitationParams {
        proportional_n_m: 3e6,
        integral_n_m_s: 3e8,
        derivative_n_s_m: 2.5e3,
        derivative_filter_s: 0.0,
    });
    for share in [0.4, 0.5, 0.6, 0.7] {
        scene.disturbances[0].duration_s = 2.0;
        scene.disturbances[0].force_n = V2::new(share * 1000.0, 0.0);
        let (_, trace) = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {}).unwrap();
        let last = trace.rows.last().unwrap();
        assert_eq!(
            last.supervisor_mode(),
            Some(supervisor::Mode::Levitated),
            "{share} of the cap"
        );
        let off_m = last.plant.position_m.norm();
        assert!(off_m < 2e-5, "{share} of the cap: {off_m}");
    }
}

/// A rotor that bounces on Hertz's wall for six seconds without loss errs in every impact: at a crude tolerance that is
/// refused, and a finer one helps, as the error says.
#[test]
fn a_run_that_is_refused_can_be_trusted_at_a_finer_tolerance() {
    let text = r#"
        title = "without loss"
        run = { duration_s = 6.0, sample_rate_hz = 1000, policies = ["passive"] }
        rotor = { mass_kg = 10.0, contact_radius_m = 0.1, gravity_m_s2 = [0.0, -9.81] }
        spin = { frequency_hz = 0.0 }
        start = { velocity_m_s = [0.02, 0.05] }
        contact = { clearance_m = 2e-4, stiffness_n_mn = 7e9, exponent = 1.5 }
        friction = { coefficient = 0.0 }
        verdict = { whirl_speed_m_s = 1.0 }
    "#;
    let mut scene = Scene::parse("without loss", text).unwrap();
    let mut at = |rtol| {
        scene.rtol = rtol;
        run(&scene, PolicyKind::Passive, Keep::Verdict, &mut |_| {})
    };
    match at(1e-3) {
        Err(RunError::Energy {
            residual, limit, ..
        }) => assert!(residual > limit),
        other => panic!("{other:?}"),
    }
    let (verdict, _) = at(1e-9).unwrap();
    assert!(verdict.energy_residual < 1e-6 && verdict.impacts > 700);
}
