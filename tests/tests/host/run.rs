//! The command line as a person uses it: results, errors, exit codes, and what is left behind.

mod causes;
mod command_line;
mod errors;
mod refusals;
mod settings;
mod slips;
pub(crate) mod traces;

use std::fs;
use std::process::Stdio;
use system_tests::ran::{Folder, edited, has, lacks, number, scene_text};

/// A short scene with noise and all policies.
pub(crate) fn short() -> String {
    let shorter = [
        ("duration_s = 0.2", "duration_s = 0.03"),
        ("duration_s = 0.05", "duration_s = 0.005"),
    ];
    edited(&scene_text("overload_then_release"), &shorter)
}

/// That scene in a folder of its own, and what `run` makes of it there, in `out`.
fn short_scene(edits: &[(&str, &str)]) -> Folder {
    let folder = Folder::fresh();
    folder.put("short.toml", edited(&short(), edits));
    folder
}

const RUN: &str = "run short.toml --out out";

#[test]
fn the_impact_scene_shows_the_table_and_writes_everything() {
    let folder = Folder::fresh();
    let table = folder.ran("run @impact_at_40_hz --out new/out").good();
    has(&table, &["passive", "radial", "levitation", "supervisor"]);
    has(&table, &["whirl", "recovered", "impacts"]);
    assert_eq!(
        folder.names("new/out"),
        [
            "record_supervisor.bin",
            "report.html",
            "trace_levitation.parquet",
            "trace_passive.parquet",
            "trace_radial.parquet",
            "trace_supervisor.parquet",
            "verdict.json"
        ]
    );
    let report = folder.text("new/out/report.html");
    has(&report, &["<svg", "Impact at 40 Hz", "script-src 'sha256-"]);
    // One script, which the page names by its hash, and one block of data.
    assert_eq!(report.matches("<script").count(), 2);
    lacks(&report, &["src=\"http"]);
    // The conclusion before everything else, and the supervisor before the others.
    let at = |words: &str| report.find(words).unwrap();
    let conclusion = at("With the supervisor the rotor is back in the middle");
    assert!(conclusion < at("Without it the rotor whirls backward (passive"));
    assert!(at(">supervisor<") < at(">passive<"));
    for row in [
        "landings seen",
        "severity index of them",
        "asks to coast down",
        "contact impulse [N s]",
    ] {
        has(&report, &[&format!("<th scope=\"row\">{row}</th>")]);
    }

    let verdict = folder.json("new/out/verdict.json");
    // Dry friction backward whirl without end presses through the wall. So the screen and the file say.
    let far = "passive, radial, levitation: the wall gave way by more than the clearance";
    let warning = verdict["warnings"][0].as_str().unwrap_or_default();
    assert!(warning.starts_with(far), "{warning}");
    has(&table, &["the wall gave way"]);
    let of = |policy: &str| &verdict["policies"][policy];
    for (policy, outcome) in [
        ("passive", "whirl"),
        ("levitation", "whirl"),
        ("supervisor", "recovered"),
    ] {
        assert_eq!(of(policy)["outcome"], outcome);
        assert_eq!(of(policy)["recovered"], outcome == "recovered");
    }
    for key in [
        "impacts",
        "contact_time_s",
        "peak_penetration_m",
        "peak_contact_force_n",
        "relevitation_time_s",
        "energy_residual",
        "run_time_s",
        "real_time_ratio",
    ] {
        assert!(of("supervisor")[key].is_number(), "{key}");
    }
    let [calm, whirls] = ["supervisor", "passive"].map(|of_| &of(of_)["max_backward_whirl_hz"]);
    assert!(calm.is_null(), "no whirl, no frequency");
    assert!(number(whirls) > 100.0);
}

/// Everything but the wall-clock times, which differ from run to run.
fn stripped(folder: &Folder, out: &str) -> Vec<(String, Vec<u8>)> {
    let strip = |name: &str| {
        let bytes = folder.bytes(&format!("{out}/{name}"));
        if name != "verdict.json" {
            return bytes;
        }
        let text = String::from_utf8(bytes).unwrap();
        let kept = text
            .lines()
            .filter(|l| !l.contains("run_time_s") && !l.contains("real_time_ratio"));
        kept.collect::<Vec<_>>().join("\n").into_bytes()
    };
    (folder.names(out).into_iter())
        .filter(|name| name != "report.html")
        .map(|name| (name.clone(), strip(&name)))
        .collect()
}

/// Drawings of the report and the numbers behind its panels: all but tables, which have wall-clock times.
fn plots(folder: &Folder, out: &str) -> String {
    let report = folder.text(&format!("{out}/report.html"));
    let drawings = report.split("<svg").skip(1);
    let drawings = drawings.filter_map(|rest| rest.split("</svg>").next());
    let (_, data) = report.split_once("id=\"report-data\"").expect("numbers");
    drawings.chain([data]).collect()
}

#[test]
fn the_same_scene_and_seed_give_the_same_bits_on_any_number_of_threads() {
    let folder = short_scene(&[]);
    let ran = |out: &str, more: &str| {
        let line = format!("run short.toml --out {out} {more}");
        folder.ran(&line).good();
        (stripped(&folder, out), plots(&folder, out))
    };
    let first = ran("out0", "--threads 1");
    for (out, threads) in [("out1", 1), ("out2", 2), ("out3", 3)] {
        assert_eq!(ran(out, &format!("--threads {threads}")), first);
    }
    folder.put("short.toml", edited(&short(), &[("seed = 1", "seed = 2")]));
    assert_ne!(ran("other", "").0, first.0, "the seed must matter");
}

#[test]
fn json_goes_to_standard_output() {
    let printed = short_scene(&[])
        .ran("run short.toml --out out --json")
        .json();
    assert_eq!(printed["policies"].as_object().unwrap().len(), 4);
}

/// A scene with the nonlinear contact runs, verifies itself, and refuses the method that it has not.
#[test]
fn a_scene_may_have_a_nonlinear_contact() {
    let contact = "stiffness_n_mn = 1e13\nexponent = 1.5\nrestitution_speed_m_s = 0.3";
    let hardening = ("stiffness_n_m = 1e9", contact);
    short_scene(&[hardening])
        .ran(&format!("{RUN} --verify"))
        .good();
    let folder = short_scene(&[hardening, ("seed = 1", "method = \"series\"")]);
    has(
        &folder.ran(RUN).refused(),
        &["run.method", "auto or collocation"],
    );
}

/// A bearing out of round runs under every policy, verifies itself by the other method, and its report shows
/// the ellipse; the power series is refused where it is asked for.
#[test]
fn a_bearing_may_be_out_of_round() {
    let bore = "[retainer]\nellipticity = 0.05\nlong_axis_deg = 30.0\n\n[friction]";
    let out_of_round = ("[friction]", bore);
    let folder = short_scene(&[out_of_round]);
    folder.ran(&format!("{RUN} --verify")).good();
    let supervisor = &folder.json("out/verdict.json")["policies"]["supervisor"];
    assert_eq!(supervisor["method"], "collocation");
    assert_ne!(supervisor["outcome"], "whirl");
    assert!(supervisor["impacts"].as_u64().unwrap() > 0);
    has(&folder.text("out/report.html"), &["clearance ellipse"]);

    let folder = short_scene(&[out_of_round, ("seed = 1", "method = \"series\"")]);
    has(&folder.ran(RUN).refused(), &["retainer.ellipticity"]);
}

/// Results of an earlier run are replaced, other files in the folder stay.
#[test]
fn a_folder_can_be_used_again() {
    let folder = short_scene(&[]);
    fs::create_dir(folder.at("out")).unwrap();
    folder.put("out/notes.txt", "mine");
    folder.put("out/verdict.json", "old");
    folder.ran(RUN).good();
    assert_eq!(folder.text("out/notes.txt"), "mine");
    assert_ne!(folder.text("out/verdict.json"), "old");
    assert_eq!(folder.names("."), ["out", "short.toml"]);
}

/// A reader that stops reading is no error, and what was asked for is written.
#[test]
fn a_closed_pipe_is_no_panic() {
    let folder = short_scene(&[]);
    let mut run = folder.command(RUN);
    let mut child = run
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let result = child.wait_with_output().unwrap();
    let error = String::from_utf8_lossy(&result.stderr).into_owned();
    assert!(result.status.success() && error.is_empty(), "{error}");
    assert!(folder.at("out/verdict.json").exists());
}

/// What is not printed is in the folder all the same.
#[test]
fn quiet_prints_nothing_and_writes_everything() {
    let folder = short_scene(&[]);
    assert_ne!(folder.ran("run short.toml --out loud").good(), "");
    let quiet = "run short.toml --out quiet --quiet";
    assert_eq!(folder.ran(quiet).good(), "");
    assert!(stripped(&folder, "loud") == stripped(&folder, "quiet"));
    folder.ran(&format!("{quiet} --json")).refused();
}

/// Each shell's script knows commands and options.
#[test]
fn shells_can_complete() {
    for shell in ["bash", "zsh", "fish"] {
        let script = Folder::fresh().ran(&format!("completions {shell}")).good();
        has(&script, &["sweep", "no-trace", "sensitivity"]);
        lacks(&script, &["serve-controller"]);
    }
}
