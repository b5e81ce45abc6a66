//! The stability maps: what makes a rotor robust, and where the outcome is not monotone.

use firmware_studies::campaign::Extent;
use firmware_studies::paper::maps::chapter;
use firmware_studies::paper::rotors::OnsetRig;
use firmware_studies::paper::{Chapter, Drawing};
use plant_model::Options;
use plant_model::analysis::impact::{Criterion, Impact, Outcome, run_impact};

fn line(chapter: &Chapter, file: &str, curve: usize) -> Vec<f64> {
    let figure = chapter.figures.iter().find(|f| f.file == file).unwrap();
    let Drawing::Chart(chart) = &figure.drawing else {
        panic!("{file} is a chart");
    };
    chart.curves[curve].points.iter().map(|p| p.1).collect()
}

fn computed(chapter: &Chapter, quantity: &str) -> f64 {
    let row = chapter.rows.iter().find(|r| r.quantity.contains(quantity));
    row.unwrap().computed.unwrap()
}

#[test]
fn robustness_goes_the_way_the_paper_says() {
    let chapter = chapter(Extent::Quick).unwrap();
    for (file, rises) in [
        ("maps_friction", false),
        ("maps_damping", true),
        ("maps_eigenfrequency", true),
        ("maps_restitution", false),
        ("maps_clearance", true),
    ] {
        for curve in [0, 1] {
            let line = line(&chapter, file, curve);
            assert!(line.len() >= 20);
            for pair in line.windows(2) {
                assert!((pair[1] > pair[0]) == rises, "{file}: {pair:?}");
            }
        }
    }
    // Hard contact would make v_r,crit proportional to ω0·c; the soft one gives a little less and more.
    for (quantity, expected) in [("in eigenfrequency", 1.0), ("in clearance", 1.0)] {
        let exponent = computed(&chapter, quantity);
        assert!((exponent - expected).abs() < 0.2, "{quantity}: {exponent}");
    }
    let mu = computed(&chapter, "in μ");
    assert!((-1.0..-0.6).contains(&mu), "{mu}");
    // Sharp without unbalance, a fringe with it.
    assert_eq!(computed(&chapter, "impact speed, balanced"), 1.0);
    assert!(computed(&chapter, "impact speed, unbalanced") >= 3.0);
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
        let criterion = Criterion {
            options: Options {
                rtol,
                ..Options::default()
            },
            ..Criterion::default()
        };
        (0..400)
            .map(|i| {
                let impact = Impact {
                    speed_m_s: 0.06 + 1e-4 * f64::from(i),
                    inclination_rad: 0.0,
                    spin_rad_s: 100.0 * std::f64::consts::TAU,
                    spin_phase_rad: 2.0,
                };
                run_impact(&params, &impact, &criterion).unwrap().outcome == Outcome::Whirl
            })
            .collect()
    };
    let (loose, tight) = (whirls(1e-9), whirls(1e-12));
    let changes = tight.windows(2).filter(|w| w[0] != w[1]).count();
    assert!(changes >= 3, "{changes}");
    let differing = loose.iter().zip(&tight).filter(|(a, b)| a != b).count();
    assert!(differing <= 2, "{differing}");
}
