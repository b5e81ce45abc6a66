//! Chapter "Established whirl": the figures it promises.

use firmware_studies::campaign::Extent;
use firmware_studies::paper::Chapter;
use firmware_studies::paper::established::{chapter, spin_downs};

fn value(chapter: &Chapter, quantity: &str) -> f64 {
    let row = chapter.rows.iter().find(|r| r.quantity == quantity);
    row.unwrap_or_else(|| panic!("no row {quantity}"))
        .computed
        .unwrap()
}

#[test]
fn maximum_rises_to_a_plateau() {
    let runs = spin_downs(Extent::Quick).unwrap();
    for of in [&runs.isotropic, &runs.anisotropic] {
        assert!(of.windows(2).all(|w| w[0].whirl_hz < w[1].whirl_hz));
        let at = |hz: f64| of.iter().find(|v| v.spin_hz == hz).unwrap();
        let rise = |from: f64, to: f64| at(to).whirl_hz / at(from).whirl_hz - 1.0;
        assert!(rise(15.0, 80.0) > 0.1, "{}", rise(15.0, 80.0));
        assert!(rise(80.0, 166.0) < 0.02, "{}", rise(80.0, 166.0));
        let plateau_hz = at(166.0).whirl_hz;
        assert!((plateau_hz / 734.0 - 1.0).abs() < 0.02, "{plateau_hz}");
        let standstill_s = at(40.0).standstill_s;
        assert!((9e-3..15e-3).contains(&standstill_s), "{standstill_s}");
    }
    for v in &runs.isotropic {
        let [rotor, inner, outer] = v.displacement_m;
        assert!(outer > 0.02e-3 && outer <= 0.05e-3, "{outer}");
        assert!(rotor > 0.3e-3 && inner > outer, "{rotor} {inner}");
        // Sliding torque is μ·R of the normal force, and slip lasts to the largest force.
        let ratio = v.torque_n_m / (0.15 * 0.1 * v.force_n);
        assert!((0.97..1.0 + 1e-9).contains(&ratio), "{ratio}");
    }
    // Stiffer one way, softer the other: close to the isotropic stator, as the paper says.
    for (a, b) in runs.isotropic.iter().zip(&runs.anisotropic) {
        assert!((b.whirl_hz / a.whirl_hz - 1.0).abs() < 0.02);
    }
}

#[test]
fn rows_of_the_chapter() {
    let chapter = chapter(Extent::Quick).unwrap();
    let near = |quantity: &str, expected: f64, share: f64| {
        let v = value(&chapter, quantity);
        assert!((v / expected - 1.0).abs() < share, "{quantity}: {v}");
    };
    near("166 Hz: standstill", 0.8, 0.02);
    near(
        "166 Hz: whirl frequency (median, 90 % to 10 % of the spin)",
        400.0,
        0.1,
    );
    near("The same, constant μ", 1.0, 0.02);
    near("Spin at the maximum, from 40 Hz", 4.3, 0.2);
    let excitation = value(
        &chapter,
        "Excitation for whirl, 166 against 40 Hz, falling μ",
    );
    assert!((1.5..5.0).contains(&excitation), "{excitation}");
    // The set that is used is shown in the Pareto table.
    let shown = |t: &firmware_studies::paper::Table| t.rows.iter().flatten().any(|c| c == "used");
    assert!(chapter.tables.iter().any(shown));
    // Rows that miss stay in.
    let paper = |q: f64| chapter.rows.iter().any(|r| r.paper == Some(q));
    assert!(
        [660.0, 530.0, 0.012, 2.0, 0.8, 400.0, 100.0]
            .into_iter()
            .all(paper)
    );
}
