//! `run --verify`: a run's own estimate of its global error, and hints for people on the way.

use firmware_bench::run::closed_loop::{Accuracy, Keep, Recorders, record, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::recording::{TraceFiles, recorded};
use firmware_bench::run::trace::{Recorder, Trace};
use firmware_bench::run::verify::{Track, Verification, check, check_scenes, verification};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::Method;
use std::fs;
use system_tests::ran::{Folder, edited, has, lacks, number, scene_text};
use system_tests::{scene, scene_names};

fn ridden(scene: &Scene, kind: PolicyKind) -> (Figures, Trace) {
    run(scene, kind, Keep::Trace, &mut |_| {}).unwrap()
}

fn verified(scene: &Scene, kind: PolicyKind) -> (Figures, Trace, Verification) {
    let (figures, trace) = ridden(scene, kind);
    let mut track = Track::default();
    trace.rows.iter().for_each(|row| track.row(row));
    let scenes = check_scenes(scene).unwrap();
    let tracks = [track];
    let checks = scenes.map(|scene| check(&scene, kind, &tracks, &mut |_| {}).unwrap().remove(0));
    let verification = verification(&figures, &tracks[0], checks.into());
    (figures, trace, verification)
}

fn with(scene: &Scene, method: Method, rtol: f64) -> Scene {
    Scene {
        method,
        rtol,
        ..scene.clone()
    }
}

/// Where errors neither drown in round-off nor grow for ever, the estimate is the true error within a
/// factor of ten.
#[test]
fn the_estimate_is_of_the_size_of_the_error() {
    let cases = [
        ("benchmark_b1", PolicyKind::Passive),
        ("benchmark_b3a", PolicyKind::Passive),
        ("established_whirl_two_mass_stator", PolicyKind::Passive),
    ];
    for (name, kind) in cases {
        let mut scene = scene(name);
        // Long samples, so that the tolerance and not the sample sets the steps.
        scene.sample_rate_hz = 500.0;
        let end = |method| {
            let (_, trace) = ridden(&with(&scene, method, 1e-13), kind);
            trace.rows.last().unwrap().plant.position_m
        };
        let clearance_m = scene.clearance_m(0);
        let (series, explicit) = (end(Method::Series), end(Method::Collocation));
        let uncertainty = (series - explicit).norm() / clearance_m;
        for (method, rtol) in [
            (Method::Series, 1e-4),
            (Method::Series, 1e-6),
            (Method::Collocation, 1e-4),
            (Method::Collocation, 1e-6),
        ] {
            let (_, trace, v) = verified(&with(&scene, method, rtol), kind);
            let end = trace.rows.last().unwrap().plant.position_m;
            // The one that is not the check.
            let truth = match method {
                Method::Series => series,
                _ => explicit,
            };
            let error = (end - truth).norm() / clearance_m;
            let estimate = v.estimated_error_clearances;
            println!("{name} {method:?} {rtol:e}: error {error:.1e}, estimate {estimate:.1e}");
            assert!(error > 3.0 * uncertainty, "{name} {method:?} {rtol:e}");
            assert!(
                estimate > 0.1 * error && estimate < 10.0 * error,
                "{name} {method:?} {rtol:e}: {estimate:e} for {error:e}"
            );
            assert!(v.largest_difference_clearances >= estimate);
            assert!(v.same_outcome && v.same_modes && v.checks.len() == 2);
        }
    }
}

/// Every scene file runs under each of its policies, and two methods confirm outcome and modes.
#[test]
fn every_scene_is_confirmed() {
    for name in scene_names() {
        let scene = scene(&name);
        assert!(scene.warnings.is_empty(), "{name}: {:?}", scene.warnings);
        for kind in &scene.policies {
            let (verdict, _, v) = verified(&scene, *kind);
            let about = format!("{name}, {}: {:?} {v:?}", kind.name(), verdict.outcome);
            assert!(v.same_outcome && v.same_modes, "{about}");
            // Where a converter's steps are in the loop, they set this.
            assert!(v.estimated_error_clearances < 0.02, "{about}");
        }
    }
}

/// A load that varies is held over parts, which a tighter tolerance does not mend: checks hold it over shorter ones, and see
/// that error too; so it is of the parts in which ramps of the amplifier end.
#[test]
fn the_estimate_sees_what_is_held_over_parts() {
    let exact = ("noise_rms_m = 1e-6\nquantum_m = 1e-7", "");
    let slow = ("sample_rate_hz = 20000", "sample_rate_hz = 2500");
    let sine = (
        "force_n = [1300.0, 750.0]",
        "force_n = [6.0, 0.0]\nshape = \"sine\"\nfrequency_hz = 45.0",
    );
    let ramp = ("lag_s = 1.6e-4", "lag_s = 1.6e-4\nslew_n_s = 2e6");
    for (edits, kind) in [
        (&[exact, slow, sine][..], PolicyKind::Passive),
        (&[exact, ramp], PolicyKind::Levitation),
    ] {
        let text = edited(&scene_text("overload_then_release"), edits);
        let scene = Scene::parse("edited.toml", &text).unwrap();
        let (_, trace, v) = verified(&scene, kind);
        let rigour = Accuracy {
            parts: 64,
            ..Accuracy::default()
        };
        let mut fine = [Trace::default()];
        let recorders = Recorders::of_planes(&mut fine);
        record(&scene, kind, recorders, rigour, &mut |_| {}).unwrap();
        let apart_m = (trace.rows.iter().zip(&fine[0].rows))
            .map(|(a, b)| (a.plant.position_m - b.plant.position_m).norm())
            .fold(0.0, f64::max);
        let error = apart_m / scene.clearance_m(0);
        let ratio = v.largest_difference_clearances / error;
        println!("error {error:.1e}, estimate {ratio:.1e} of it");
        assert!(error > 1e-7 && error < 1e-5, "{error:e}");
        assert!(ratio > 0.3 && ratio < 3.0, "{ratio} of {error:e}");
    }
}

/// A check that would go on and on ends, and the run stays.
#[test]
fn a_check_has_an_end() {
    let text = r#"
        title = "a shaft too stiff to follow without a matrix"
        run = { duration_s = 1.0, sample_rate_hz = 1000, policies = ["passive"] }
        rotor = { mass_kg = 10.0, stiffness_n_m = 1e12, contact_radius_m = 0.1 }
        spin = { frequency_hz = 0.0 }
        start = { velocity_m_s = [0.02, 0.05] }
        contact = { clearance_m = 2e-4, stiffness_n_m = 1e8 }
        friction = { coefficient = 0.0 }
        verdict = { whirl_speed_m_s = 1.0 }
    "#;
    let folder = Folder::fresh();
    folder.put("stiff.toml", text);
    let ran = folder.ran("run stiff.toml --out out --verify --no-trace");
    println!("{}\n{}", ran.printed, ran.said);
    has(&ran.said, &["steps are not enough"]);
}

/// A check that cannot be trusted leaves the run as it is, and says why.
#[test]
fn a_failed_check_leaves_the_run() {
    let scene = scene("impact_at_40_hz");
    let mut broken = scene.clone();
    broken.planes[0].supervisor = None;
    let kind = PolicyKind::Supervisor;
    let no_file = None::<&mut TraceFiles<fs::File>>;
    let run = recorded(&scene, kind, &[broken], no_file, &mut |_| {}).unwrap();
    let error = run.whole.verification.unwrap().unwrap_err();
    has(&error, &["checked by", "policy supervisor"]);
    assert_eq!(run.whole.verdict.figures, ridden(&scene, kind).0);
}

/// All that `--verify` does to a verdict is to add to it, and nothing at all to the traces.
#[test]
fn checks_change_nothing_else() {
    let folder = Folder::fresh();
    let shorter = [("duration_s = 0.2", "duration_s = 0.04")];
    folder.scene("short.toml", "overload_then_release", &shorter);
    let table = folder.ran("run short.toml --out plain").good();
    lacks(&table, &["estimated error"]);
    let table = folder
        .ran("run short.toml --out checked --verify --threads 3")
        .good();
    // Names may be broken between their words.
    has(&table, &["estimated", "series 1e-11", "collocation"]);

    let [mut a, mut b] =
        ["plain", "checked"].map(|out| folder.json(&format!("{out}/verdict.json")));
    for policy in ["passive", "radial", "levitation", "supervisor"] {
        assert_eq!(a["policies"][policy]["method"], "series");
        for v in [&mut a, &mut b] {
            let figures = v["policies"][policy].as_object_mut().unwrap();
            assert!(figures.remove("run_time_s").is_some());
            assert!(figures.remove("real_time_ratio").is_some());
        }
        let figures = b["policies"][policy].as_object_mut().unwrap();
        let v = figures.remove("verification").expect("asked for");
        let plane = figures["planes"][0].as_object_mut().unwrap();
        assert_eq!(plane.remove("verification").as_ref(), Some(&v));
        assert_eq!(v["same_outcome"], true);
        assert_eq!(v["threshold_clearances"], 1e-3);
        assert!(v["same_modes"].is_boolean() && v["mode_changes"].is_number());
        let [estimate, largest] = [
            "estimated_error_clearances",
            "largest_difference_clearances",
        ]
        .map(|k| number(&v[k]));
        assert!(estimate <= largest);
        assert!(v["differs_from_s"].is_null() || v["differs_from_s"].is_number());
        assert_eq!(v["checks"][0]["method"], "series");
        assert_eq!(v["checks"][1]["method"], "collocation");
        let [one, other] =
            ["plain", "checked"].map(|out| folder.bytes(&format!("{out}/trace_{policy}.parquet")));
        assert!(one == other, "{policy}");
    }
    assert_eq!(a, b);
    let caption = "<caption>Checks</caption>";
    has(&folder.text("checked/report.html"), &[caption]);
    lacks(&folder.text("plain/report.html"), &[caption]);
}

/// A verdict that hangs on the error of integration: the limit of whirl between the peak speeds of a
/// crude and of an exact run.
#[test]
fn a_contradicted_outcome_is_said_and_ends_with_exit_code_1() {
    let name = "established_whirl_two_mass_stator";
    let mut crude = with(&scene(name), Method::Collocation, 1e-2);
    crude.sample_rate_hz = 500.0;
    let exact = with(&crude, Method::Series, 1e-12);
    let peak = |scene| ridden(scene, PolicyKind::Passive).0.peak_backward_speed_m_s;
    let (a, b) = (peak(&crude), peak(&exact));
    assert!((a - b).abs() > 1e-7, "{a} {b}");
    let limit = format!(
        "rtol = 1e-2\nmethod = \"collocation\"\n\n[verdict]\nwhirl_speed_m_s = {}\n\n[rotor]",
        f64::midpoint(a, b)
    );
    let folder = Folder::fresh();
    let edits = [
        ("sample_rate_hz = 50000", "sample_rate_hz = 500"),
        ("[rotor]", &limit),
    ];
    folder.scene("edited.toml", name, &edits);
    folder.ran("run edited.toml --out out").good();
    let ran = folder.ran("run edited.toml --out out --verify");
    has(&ran.printed, &["OTHER"]);
    has(&ran.fails(1), &["policy passive", "but"]);
    let verdict = folder.json("out/verdict.json");
    let v = &verdict["policies"]["passive"]["verification"];
    assert_eq!(v["same_outcome"], false);
    has(&folder.text("out/report.html"), &["OTHER than the run"]);
}

/// What `auto` came to is in the verdict.
#[test]
fn the_method_that_ran_is_named() {
    let folder = Folder::fresh();
    let crude = [("[rotor]", "rtol = 1e-5\n\n[rotor]")];
    folder.scene("edited.toml", "benchmark_b3c", &crude);
    has(
        &folder.ran("run edited.toml --out out").good(),
        &["collocation"],
    );
    let verdict = folder.json("out/verdict.json");
    assert_eq!(verdict["policies"]["passive"]["method"], "collocation");
    has(&folder.text("out/report.html"), &["<td>collocation</td>"]);
}

/// The supervisor is made for 10 to 50 kHz; other rates run, with a word of warning.
#[test]
fn control_rates_beyond_the_supervisors_are_warned_of() {
    let folder = Folder::fresh();
    for (rate, warned) in [(50_000, false), (60_000, true)] {
        let edits = [
            (
                "sample_rate_hz = 20000",
                &*format!("sample_rate_hz = {rate}"),
            ),
            ("duration_s = 0.2", "duration_s = 0.03"),
        ];
        folder.scene("edited.toml", "overload_then_release", &edits);
        let ran = folder.ran("run edited.toml --out out");
        let error = ran.said.clone();
        ran.good();
        for said in ["edited.toml:12: run.sample_rate_hz", "warning"] {
            assert_eq!(error.contains(said), warned, "{error}");
        }
    }
}

/// A levitation loop that is unstable or badly damped is no baseline, and the reader is told; one that swings out, or damps
/// well, shows who is right.
#[test]
fn a_levitation_loop_that_hardly_holds_is_warned_of() {
    let folder = Folder::fresh();
    for (damping, words) in [
        ("0.0", Some("not stable")),
        ("250.0", Some("badly damped")),
        ("1500.0", None),
    ] {
        let damper = format!("derivative_n_s_m = {damping}");
        let edits = [("derivative_n_s_m = 1500.0", &damper[..])];
        let scene = folder.scene("edited.toml", "overload_then_release", &edits);
        let warnings = Scene::load(&scene).unwrap().warnings;
        println!("{damping}: {warnings:?}");
        let Some(words) = words else {
            assert_eq!(warnings, [""; 0]);
            continue;
        };
        assert_eq!(warnings.len(), 1);
        has(&warnings[0], &[words, "edited.toml:", "levitation"]);
        for line in ["run edited.toml --out out", "advise edited.toml"] {
            has(&folder.ran(line).said, &[words]);
        }
    }
}
