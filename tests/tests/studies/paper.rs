//! `paper`: what its rows, tables and figures keep to, as a quick run gives them.

use firmware_bench::report::plot::chart::Curve;
use firmware_studies::campaign::{Drawing, Extent, Table, html};
use firmware_studies::paper::rotors::OnsetRig;
use firmware_studies::paper::{CHAPTERS as ALL, Chapter, chapters, report};
use plant_model::Options;
use plant_model::analysis::impact::{Criterion, Impact, Outcome, run_impact};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::sync::LazyLock;
use system_tests::browser::Browser;

/// On one thread.
static CHAPTERS: LazyLock<Vec<Chapter>> = LazyLock::new(|| {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let chapters = pool.unwrap().install(|| chapters(Extent::Quick, &()));
    chapters.unwrap_or_else(|e| panic!("{e}"))
});

fn chapter(title: &str) -> &'static Chapter {
    (CHAPTERS.iter().find(|c| c.title == title)).unwrap_or_else(|| panic!("no chapter {title}"))
}

fn computed(title: &str, item: &str) -> f64 {
    let row = chapter(title).rows.iter().find(|row| row.item == item);
    row.and_then(|row| row.computed)
        .unwrap_or_else(|| panic!("no {item} in {title}"))
}

fn table(title: &str, caption: &str) -> &'static Table {
    let tables = &chapter(title).tables;
    (tables.iter().find(|t| t.caption.starts_with(caption)))
        .unwrap_or_else(|| panic!("no table {caption}"))
}

/// Curves of a chart.
fn curves(title: &str, file: &str) -> &'static [Curve] {
    let figure = chapter(title).figures.iter().find(|f| f.file == file);
    match figure.map(|figure| &figure.drawing) {
        Some(Drawing::Chart(chart)) => &chart.curves,
        _ => panic!("no chart {file}"),
    }
}

fn number(cell: &str) -> f64 {
    let digits = cell.trim_end_matches(" %");
    digits.parse().unwrap_or_else(|_| panic!("{cell}"))
}

const ONSET: &str = "Onset";
const MAPS: &str = "Stability maps";
const ESTABLISHED: &str = "Established whirl";
const PHASES: &str = "The nine phases";
const LIMITS: &str = "Black's limits with friction";
const LEVELS: &str = "Levels of stator model";
const LAWS: &str = "Contact laws";
const MOUNTING: &str = "Stator on a compliant mounting";
const RETAINER: &str = "Retainer bearing";

/// Row of a chapter, and the least and the most that it may be.
macro_rules! kept {
    ($($title:ident, $item:literal, $low:literal, $high:literal;)*) => {
        $({
            let value = computed($title, $item);
            assert!(($low..=$high).contains(&value), "{}: {value}", $item);
        })*
    };
}

/// What the paper has no bound for, or a wider one: earlier runs, closed forms, what a constant was fitted to.
fn rows_keep_to_what_they_were() {
    kept! {
        ONSET, "Restitution e", 0.65, 0.75;
        ONSET, "v_r,crit, solid disc, 0.3 %", 0.09299, 0.09301;
        ONSET, "v_r,crit, seal elements", 0.04299, 0.04301;
        ONSET, "v_r,crit, solid disc, 3.5 %", 0.111, 0.169;
        ONSET, "v_r,crit, inclined 30°", 0.0591, 0.0693;
        ONSET, "v_r,crit, inclined 50°", 0.0527, 0.0595;
        ONSET, "rms log error of the three predictions", 0.05, 0.15;
        MAPS, "Exponent of v_r,crit in eigenfrequency at 45 Hz", 0.8, 1.2;
        MAPS, "Exponent of v_r,crit in clearance at 0.2 mm", 0.8, 1.2;
        MAPS, "Exponent of v_r,crit in μ at 0.125", -1.0, -0.6;
        MAPS, "Changes of the outcome over impact speed, balanced: most", 1.0, 1.0;
        MAPS, "Changes of the outcome over impact speed, unbalanced: most", 3.0, 1e3;
        ESTABLISHED, "Standstill from 40 Hz", 9e-3, 15e-3;
        ESTABLISHED, "166 Hz: standstill", 0.784, 0.816;
        ESTABLISHED, "166 Hz: whirl frequency (median, 90 % to 10 % of the spin)", 360.0, 440.0;
        ESTABLISHED, "The same, constant μ", 0.98, 1.02;
        ESTABLISHED, "Spin at the maximum, from 40 Hz", 3.4, 5.2;
        ESTABLISHED, "Excitation for whirl, 166 against 40 Hz, falling μ", 1.5, 5.0;
        PHASES, "Whirl frequency at the start of continuous contact", 48.0, 62.0;
        PHASES, "Excitation to maximum", 0.07, 0.13;
        PHASES, "Whirl turns within 5 % of the maximum", 3.0, 5.0;
        PHASES, "Impacts before continuous contact", 2.0, 15.0;
        LIMITS, "Upper whirl limit", 733.9, 735.3;
        LIMITS, "First coupled natural frequency, joined rigidly", 940.1, 941.9;
        LEVELS, "Rigid stator, k_c = 1e9 N/m, from 40 Hz", 1271.0, 1349.0;
        LEVELS, "Rigid stator, k_c = 1e9 N/m, from 166 Hz", 1466.0, 1556.0;
        LEVELS, "Stator of one mass, from 40 Hz", 743.0, 789.0;
        LEVELS, "Stator of two masses, from 40 Hz", 690.0, 732.0;
        LEVELS, "Rolling limit without drive over measured, 40 Hz", 10.0, 50.0;
        LAWS, "Whirl at held spin, Hunt and Crossley", 734.53, 734.67;
        LAWS, "Restitution at a tenth of the speed", 0.95, 1.0;
        MOUNTING, "Slow motion of the rotor", 47.0, 57.0;
        MOUNTING, "Fast whirl of the rotor", 380.0, 420.0;
        MOUNTING, "Largest displacement of the ring", 1.0, 2.0;
        MOUNTING, "Share of the contact force's power above 150 Hz", 0.9, 1.0;
        RETAINER, "Fastest whirl in a bushing", 710.8, 712.2;
        RETAINER, "Race of 1e-3 kg m²: fastest whirl over the bound κ·ΩR/(κ + m·(R²/J_r + R_i²/J_i))", 0.965, 0.983;
        RETAINER, "Race of 1e-3 kg m² over bushing: largest normal force in whirl", 0.0356, 0.0370;
        RETAINER, "Race of 1e-2 kg m² over bushing: fastest whirl", 0.761, 0.775;
        RETAINER, "Race of 1e-1 kg m² over bushing: fastest whirl", 0.9, 1.0;
        RETAINER, "The same with k_c = 1e11 N/m", 4.42e-4, 4.88e-4;
        RETAINER, "Onset rig, race of 1e-3 kg m² over bushing: critical radial impact", 0.999, 1.001;
        RETAINER, "No shaft stiffness, race of 1e-3 kg m²: whirl left after 0.5 s", 1.0, 100.0;
    }
    // Free decay: e^(−D·ω0·t) with D·ω0 = d/(2m), from the first 30 ms to the last of 120 ms.
    let decay = computed(PHASES, "Amplitude at the end of phase 9 over its start");
    let expected = (-20.5_f64 / 20.0 * 0.09).exp();
    assert!((decay / expected - 1.0).abs() < 0.02, "{decay}");
}

/// The simulated v_t,crit is in the note, with how far it is off.
fn closed_form_of_the_threshold_is_met() {
    let rows = chapter(ONSET).rows.iter();
    let thresholds: Vec<_> = rows.filter(|r| r.item.starts_with("v_t,crit,")).collect();
    assert_eq!(thresholds.len(), 3);
    for row in thresholds {
        let (_, off) = row.note.split_once('(').unwrap();
        assert!(
            number(off.trim_end_matches(')')).abs() < 0.1,
            "{}",
            row.note
        );
    }
}

/// Neither the multiple that counts as whirl nor spin, tolerance or finer steps change v_r,crit in its
/// printed digits.
fn choices_of_the_onset_do_not_matter() {
    let variants = &table(ONSET, "v_r,crit with one choice").rows;
    let (stiff, same): (Vec<_>, Vec<_>) = variants.iter().partition(|row| row[0].contains("k_c"));
    assert!(same.len() >= 7 && stiff.len() == 3);
    for row in same {
        assert_eq!(row[2..], variants[0][2..], "{}", row[0]);
    }
    for row in stiff {
        assert!(number(&row[7]) < 0.15, "{row:?}");
    }
}

fn robustness_goes_the_way_the_paper_says() {
    for (file, rises) in [
        ("maps_friction", false),
        ("maps_damping", true),
        ("maps_eigenfrequency", true),
        ("maps_restitution", false),
        ("maps_clearance", true),
    ] {
        for curve in &curves(MAPS, file)[..2] {
            assert!(curve.points.len() >= 20);
            for pair in curve.points.windows(2) {
                assert!((pair[1].1 > pair[0].1) == rises, "{file}: {pair:?}");
            }
        }
    }
}

/// The fringe is the rotor's and not the integrator's: a thousandth of the tolerance moves next to none
/// of its outcomes.
#[test]
fn fringe_does_not_come_from_the_tolerance() {
    let rig = OnsetRig {
        eccentricity_m: 1e-5,
        ..OnsetRig::solid_disc(0.71)
    };
    let params = rig.params().unwrap();
    let whirls = |rtol: f64| -> Vec<bool> {
        let options = Options {
            rtol,
            ..Options::default()
        };
        let criterion = Criterion {
            options,
            ..Criterion::default()
        };
        let whirls = |i: i32| {
            let impact = Impact {
                speed_m_s: 0.06 + 1e-4 * f64::from(i),
                inclination_rad: 0.0,
                spin_rad_s: 100.0 * TAU,
                spin_phase_rad: 2.0,
            };
            run_impact(&params, &impact, &criterion).unwrap().outcome == Outcome::Whirl
        };
        (0..400).map(whirls).collect()
    };
    let (loose, tight) = (whirls(1e-9), whirls(1e-12));
    let changes = tight.windows(2).filter(|w| w[0] != w[1]).count();
    assert!(changes >= 3, "{changes}");
    let differing = loose.iter().zip(&tight).filter(|(a, b)| a != b).count();
    assert!(differing <= 2, "{differing}");
}

fn whirl_rises_to_a_plateau() {
    let of = |file, curve: usize| &curves(ESTABLISHED, file)[curve].points[..];
    let [isotropic, anisotropic] = [0, 1].map(|curve| of("established_whirl", curve));
    for line in [isotropic, anisotropic] {
        assert!(line.windows(2).all(|w| w[0].1 < w[1].1));
        let at = |hz: f64| line.iter().find(|p| p.0 == hz).unwrap().1;
        assert!(at(80.0) / at(15.0) > 1.1 && at(166.0) / at(80.0) < 1.02);
        assert!((at(166.0) / 734.0 - 1.0).abs() < 0.02, "{}", at(166.0));
    }
    // Stiffer one way, softer the other: close to the isotropic stator, as the paper says.
    for (a, b) in isotropic.iter().zip(anisotropic) {
        assert!((b.1 / a.1 - 1.0).abs() < 0.02);
    }
    let [rotor, inner, outer] = [0, 1, 2].map(|curve| of("established_displacement", curve));
    for ((rotor, inner), outer) in rotor.iter().zip(inner).zip(outer) {
        assert!(outer.1 > 0.02 && outer.1 <= 0.05, "{outer:?}");
        assert!(rotor.1 > 0.3 && inner.1 > outer.1, "{rotor:?} {inner:?}");
    }
    // Sliding torque is μ·R of the normal force, and slip lasts to the largest force.
    let (torque, force) = (of("established_torque", 0), of("established_force", 0));
    for (torque, force) in torque.iter().zip(force) {
        let ratio = torque.1 / (0.15 * 0.1 * force.1);
        assert!((0.97..1.0 + 1e-9).contains(&ratio), "{ratio}");
    }
    // The set that is used is shown in the Pareto table.
    let sets = &table(ESTABLISHED, "Constants that the paper leaves out").rows;
    assert!(sets.iter().any(|row| row[8] == "used"));
}

fn nine_phases_in_order() {
    let phases = &table(PHASES, "The phases").rows;
    let from = |i: usize| number(&phases[i][2]);
    let to = |i: usize| number(&phases[i][3]);
    let spin_hz = |i: usize| number(&phases[i][4]);
    assert!(phases.len() == 9 && (0..9).all(|i| from(i) < to(i)));
    // Sliding speed of each stretch that lies in phases as they are counted; none without contact.
    let last = |file| &curves(PHASES, file).last().unwrap().points;
    let sliding = last("phases_sliding");
    let stretch = sliding[1].0 - sliding[0].0;
    let touching = |first: usize, last: usize| {
        let inside = sliding
            .iter()
            .filter(move |p| p.0 > from(first - 1) && p.0 + stretch < to(last - 1));
        inside.map(|p| p.1.is_finite())
    };
    // 1, 2 and 9 without contact, 5 to 8 all contact, 4 both.
    assert!(!touching(1, 2).any(|c| c) && !touching(9, 9).any(|c| c));
    assert!(touching(5, 8).all(|c| c));
    assert!(touching(4, 4).any(|c| c) && touching(4, 4).any(|c| !c));
    // The maximum is in 6, and 6 is short; friction stops the spin in 5 and 6.
    let whirl = last("phases_whirl");
    let fastest = whirl.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!(
        (from(5) - 0.01..=to(5) + 0.01).contains(&fastest.0),
        "{fastest:?}"
    );
    assert!(to(5) - from(5) < 10.0);
    assert!(spin_hz(4) > 39.0 && spin_hz(6) < 3.0);
}

/// Held spin meets the closed forms, and spin-down never passes the limit of the equations; against a contact that is
/// as soft along the tangent it seems to overshoot.
fn runs_meet_the_limits() {
    let held = &table(LIMITS, "Run to steady state").rows;
    assert_eq!(held.len(), 5);
    for row in held {
        assert!(number(&row[6]) < 1e-3, "{row:?}");
    }
    let down = &table(LIMITS, "Spin-down").rows;
    for (row, apparent) in down.iter().zip([10.0, 10.0, 5.8, 0.6]) {
        assert!((number(&row[6]) - apparent).abs() < 0.3, "{row:?}");
        assert!(
            row[4] == "–" || (-2.0..0.01).contains(&number(&row[4])),
            "{row:?}"
        );
    }
    for row in &table(LAWS, "Whirl at a held spin").rows {
        if row[2] == "slides" && row[4] != "–" {
            assert!(
                (number(&row[3]) / number(&row[4]) - 1.0).abs() < 1e-3,
                "{row:?}"
            );
        }
    }
}

/// Drag that keeps a rolling whirl alive, from closed form, between two runs.
fn drag_keeps_a_whirl_alive() {
    let drags = &table(RETAINER, "Race of 1e-3 kg m² with drag").rows;
    assert_ne!(drags[1][3], "lives on");
    assert_eq!(drags[2][3], "lives on");
    for row in &drags[2..] {
        assert!(
            (number(&row[4]) / number(&row[5]) - 1.0).abs() < 0.01,
            "{row:?}"
        );
    }
    // A bushing and five races; every figure has its curves.
    assert_eq!(table(RETAINER, "Footnote 4 from 40 Hz").rows.len(), 6);
    assert_eq!(chapter(RETAINER).figures.len(), 4);
}

/// Promised keys, their types and the kinds.
fn rows_are_for_programs(rows: &[serde_json::Value]) {
    assert!(rows.len() > 60, "{}", rows.len());
    let mut names = BTreeSet::new();
    for row in rows {
        for key in ["item", "source", "unit", "chapter", "note"] {
            assert!(row[key].is_string(), "{key} of {row}");
        }
        for key in ["item", "source"] {
            assert_ne!(row[key], "", "{row}");
        }
        for key in ["paper", "computed", "deviation"] {
            let value = row.get(key).unwrap_or_else(|| panic!("no {key} in {row}"));
            assert!(value.is_number() || value.is_null(), "{key} of {row}");
        }
        let kind = row["kind"].as_str().expect("a kind");
        assert!(["fitted", "predicted", "assumed"].contains(&kind), "{kind}");
        // A miss says why.
        if row["holds"] == false {
            assert_ne!(row["note"], "", "{row}");
        }
        names.insert((row["chapter"].to_string(), row["item"].to_string()));
    }
    assert_eq!(names.len(), rows.len(), "no two of a chapter are alike");
}

fn the_page_has_all_of_it() {
    let report = report(&CHAPTERS);
    rows_are_for_programs(&report.classes);
    let page = html(&report.page("study paper --quick")).unwrap();
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
    for word in [
        "<nav",
        "Rows that miss, and why",
        "predicted (nothing was chosen for them)",
        "<svg",
    ] {
        assert!(page.contains(word), "{word}");
    }
    for outside in ["<script", "src=", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Every link inside the page has a target, and no target is there twice.
    for link in page.split("href=\"#").skip(1) {
        let id = link.split('"').next().unwrap();
        assert_eq!(page.matches(&format!("id=\"{id}\"")).count(), 1, "{id}");
    }
    if let Some(browser) = Browser::found() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("paper.html");
        std::fs::write(&file, page).unwrap();
        browser.check("chapters.mjs", &[&file]);
    }
}

/// Of a chapter that spreads its own runs.
fn threads_do_not_matter() {
    let (_, compute) = (ALL.iter().find(|(name, _)| *name == "retainer bearing")).unwrap();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let on_two = pool.unwrap().install(|| compute(Extent::Quick)).unwrap();
    assert_eq!(format!("{on_two:?}"), format!("{:?}", chapter(RETAINER)));
}

/// One quick run serves all of them.
#[test]
fn a_quick_run_keeps_to_all_of_this() {
    rows_keep_to_what_they_were();
    closed_form_of_the_threshold_is_met();
    choices_of_the_onset_do_not_matter();
    robustness_goes_the_way_the_paper_says();
    whirl_rises_to_a_plateau();
    nine_phases_in_order();
    runs_meet_the_limits();
    drag_keeps_a_whirl_alive();
    the_page_has_all_of_it();
    threads_do_not_matter();
}
