//! `run --verify`: a run's own estimate of its global error, and hints for people on the way.

use firmware_bench::run::closed_loop::{Accuracy, Keep, Recorders, record, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::recording::{TraceFiles, recorded};
use firmware_bench::run::trace::{Recorder, Trace};
use firmware_bench::run::verify::{Track, Verification, check, check_scenes, verification};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::Method;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use system_tests::{run_scene, scene, scene_names, scene_path};
use tempfile::TempDir;

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
    let folder = TempDir::new().unwrap();
    let error_and_estimate = |edits: &[(&str, &str)], kind| {
        let scene = Scene::load(&edited(folder.path(), "overload_then_release", edits)).unwrap();
        let (_, trace, v) = verified(&scene, kind);
        let accuracy = Accuracy {
            parts: 64,
            ..Accuracy::default()
        };
        let mut fine = Trace::default();
        let recorders = Recorders {
            planes: vec![&mut fine],
            axis: None,
        };
        record(&scene, kind, recorders, accuracy, &mut |_| {}).unwrap();
        let apart_m = (trace.rows.iter().zip(&fine.rows))
            .map(|(a, b)| (a.plant.position_m - b.plant.position_m).norm())
            .fold(0.0, f64::max);
        let error = apart_m / scene.clearance_m(0);
        let estimate = v.largest_difference_clearances;
        println!("error {error:.1e}, estimate {estimate:.1e}");
        (error, estimate)
    };
    for (edits, kind) in [
        (&[exact, slow, sine][..], PolicyKind::Passive),
        (&[exact, ramp], PolicyKind::Levitation),
    ] {
        let (error, estimate) = error_and_estimate(edits, kind);
        assert!(error > 1e-7 && error < 1e-5, "{error:e}");
        assert!(
            estimate > 0.3 * error && estimate < 3.0 * error,
            "{estimate:e} for {error:e}"
        );
    }
}

/// A check that would go on and on ends, and the run stays.
#[test]
fn a_check_has_an_end() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("stiff.toml");
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
    fs::write(&path, text).unwrap();
    let result = run_scene(
        &path,
        &folder.path().join("out"),
        &["--verify", "--no-trace"],
    );
    let table = String::from_utf8(result.stdout).unwrap();
    let error = String::from_utf8(result.stderr).unwrap();
    println!("{table}\n{error}");
    assert!(error.contains("steps are not enough"), "{error}");
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
    assert!(
        error.contains("checked by") && error.contains("policy supervisor"),
        "{error}"
    );
    assert_eq!(run.whole.verdict.figures, ridden(&scene, kind).0);
}

fn verdict(out: &Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("verdict.json")).unwrap()).unwrap()
}

/// A scene with something replaced, in a folder of its own.
fn edited(folder: &Path, name: &str, edits: &[(&str, &str)]) -> PathBuf {
    let mut text = fs::read_to_string(scene_path(name)).unwrap();
    for (from, to) in edits {
        assert!(text.contains(from), "{from} is not in {name}");
        text = text.replacen(from, to, 1);
    }
    let path = folder.join("edited.toml");
    fs::write(&path, text).unwrap();
    path
}

/// All that `--verify` does to a verdict is to add to it, and nothing at all to the traces.
#[test]
fn checks_change_nothing_else() {
    let folder = TempDir::new().unwrap();
    let scene = edited(
        folder.path(),
        "overload_then_release",
        &[("duration_s = 0.2", "duration_s = 0.04")],
    );
    let (plain, checked) = (folder.path().join("plain"), folder.path().join("checked"));
    let result = run_scene(&scene, &plain, &[]);
    let table = String::from_utf8(result.stdout).unwrap();
    assert!(result.status.success() && !table.contains("estimated error"));
    let result = run_scene(&scene, &checked, &["--verify", "--threads", "3"]);
    let table = String::from_utf8(result.stdout).unwrap();
    assert!(result.status.success(), "{:?}", result.stderr);
    // Names may be broken between their words.
    for words in ["estimated", "series 1e-11", "collocation"] {
        assert!(table.contains(words), "{words} is missing in\n{table}");
    }

    let (mut a, mut b) = (verdict(&plain), verdict(&checked));
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
        let estimate = v["estimated_error_clearances"].as_f64().unwrap();
        assert!(estimate <= v["largest_difference_clearances"].as_f64().unwrap());
        assert!(v["differs_from_s"].is_null() || v["differs_from_s"].is_number());
        assert_eq!(v["checks"][0]["method"], "series");
        assert_eq!(v["checks"][1]["method"], "collocation");
        let trace = format!("trace_{policy}.parquet");
        assert_eq!(
            fs::read(plain.join(&trace)).unwrap(),
            fs::read(checked.join(&trace)).unwrap()
        );
    }
    assert_eq!(a, b);
    let report = |out: &Path| fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report(&checked).contains("<caption>Checks</caption>"));
    assert!(!report(&plain).contains("<caption>Checks</caption>"));
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
    let folder = TempDir::new().unwrap();
    let edits = [
        ("sample_rate_hz = 50000", "sample_rate_hz = 500"),
        ("[rotor]", &limit),
    ];
    let scene = edited(folder.path(), name, &edits);
    let out = folder.path().join("out");
    assert!(run_scene(&scene, &out, &[]).status.success());
    let result = run_scene(&scene, &out, &["--verify"]);
    let error = String::from_utf8(result.stderr).unwrap();
    let table = String::from_utf8(result.stdout).unwrap();
    assert_eq!(result.status.code(), Some(1), "{error}");
    assert!(
        error.contains("policy passive") && error.contains("but"),
        "{error}"
    );
    assert!(table.contains("OTHER"), "{table}");
    assert_eq!(
        verdict(&out)["policies"]["passive"]["verification"]["same_outcome"],
        false
    );
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("OTHER than the run"));
}

/// What `auto` chose is in the verdict.
#[test]
fn the_method_that_ran_is_named() {
    let folder = TempDir::new().unwrap();
    let scene = edited(
        folder.path(),
        "benchmark_b3c",
        &[("[rotor]", "rtol = 1e-5\n\n[rotor]")],
    );
    let out = folder.path().join("out");
    let result = run_scene(&scene, &out, &[]);
    assert!(result.status.success());
    assert!(String::from_utf8_lossy(&result.stdout).contains("collocation"));
    assert_eq!(
        verdict(&out)["policies"]["passive"]["method"],
        "collocation"
    );
    let report = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("<td>collocation</td>"));
}

/// The supervisor is made for 10 to 50 kHz; other rates run, with a word of warning.
#[test]
fn control_rates_beyond_the_supervisors_are_warned_of() {
    let folder = TempDir::new().unwrap();
    for (rate, warned) in [("50000", false), ("60000", true)] {
        let scene = edited(
            folder.path(),
            "overload_then_release",
            &[
                (
                    "sample_rate_hz = 20000",
                    &format!("sample_rate_hz = {rate}"),
                ),
                ("duration_s = 0.2", "duration_s = 0.03"),
            ],
        );
        let result = run_scene(&scene, &folder.path().join("out"), &[]);
        let error = String::from_utf8(result.stderr).unwrap();
        assert!(result.status.success(), "{error}");
        assert_eq!(
            error.contains("edited.toml:12: run.sample_rate_hz"),
            warned,
            "{error}"
        );
        assert_eq!(error.contains("warning"), warned, "{error}");
    }
}

/// A levitation loop that is unstable or badly damped is no baseline, and the reader is warned; one that swings out, or damps
/// well, shows who is right.
#[test]
fn a_levitation_loop_that_hardly_holds_is_warned_of() {
    let folder = TempDir::new().unwrap();
    for (damping, words) in [
        ("0.0", Some("not stable")),
        ("250.0", Some("badly damped")),
        ("1500.0", None),
    ] {
        let scene = edited(
            folder.path(),
            "overload_then_release",
            &[(
                "derivative_n_s_m = 1500.0",
                &format!("derivative_n_s_m = {damping}"),
            )],
        );
        let warnings = Scene::load(&scene).unwrap().warnings;
        println!("{damping}: {warnings:?}");
        let [warning] = &warnings[..] else {
            assert!(words.is_none() && warnings.is_empty(), "{warnings:?}");
            continue;
        };
        assert!(
            words.is_some_and(|words| warning.contains(words)),
            "{warning}"
        );
        assert!(warning.contains("edited.toml:") && warning.contains("levitation"));
        for word in ["run", "advise"] {
            let out = folder.path().join("out").display().to_string();
            let path = scene.display().to_string();
            let args = match word {
                "run" => vec![word, &path, "--out", &out],
                _ => vec![word, &path],
            };
            let result = system_tests::host().args(args).output().unwrap();
            let shown = String::from_utf8_lossy(&result.stderr);
            assert!(shown.contains(words.unwrap()), "{word}: {shown}");
        }
    }
}
