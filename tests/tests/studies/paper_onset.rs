//! The paper's onset: critical tangential speed, and critical impact speeds of its five configurations.

use firmware_studies::campaign::Extent;
use firmware_studies::paper::Kind;
use firmware_studies::paper::onset::{
    chapter, configurations, critical_m_s, fit, rms_log_error, simulated_threshold_m_s,
};
use firmware_studies::paper::rotors::OnsetRig;
use plant_model::analysis::onset::critical_tangential_speed_m_s;

#[test]
fn predictions_keep_their_bounds() {
    let fit = fit().unwrap();
    assert!((0.65..0.75).contains(&fit.restitution), "{fit:?}");
    let five = configurations(&fit);
    let speeds: Vec<f64> = (five.iter())
        .map(|c| critical_m_s(&c.rig, c.inclination_rad).unwrap())
        .collect();
    for fitted in [0, 4] {
        assert_eq!(five[fitted].kind, Kind::Fitted);
        let off = speeds[fitted] / five[fitted].measured_m_s - 1.0;
        assert!(off.abs() < 1e-4, "{}: {off}", five[fitted].name);
    }
    let rms = rms_log_error(&five, &speeds);
    assert!((0.05..0.15).contains(&rms), "{rms}");
    let [solid, damped, by_30, by_50, seals] = speeds[..] else {
        panic!("five configurations");
    };
    assert!(damped > solid && solid > by_30 && by_30 > by_50 && by_50 > seals);
    // Each alone, so that none gets worse behind the others.
    for (i, bound) in [(1, 0.21), (2, 0.08), (3, 0.06)] {
        let off = (speeds[i] / five[i].measured_m_s).ln().abs();
        assert!(off < bound, "{}: {off}", five[i].name);
    }
}

#[test]
fn closed_form_of_the_threshold_is_met() {
    for (friction, damping_ratio) in [(0.125, 0.003), (0.125, 0.035), (0.34, 0.003)] {
        let rig = OnsetRig {
            friction,
            damping_ratio,
            ..OnsetRig::solid_disc(0.7)
        };
        let closed = critical_tangential_speed_m_s(&rig.params().unwrap()).unwrap();
        let off = simulated_threshold_m_s(&rig).unwrap() / closed - 1.0;
        assert!(
            off.abs() < 1e-3,
            "μ = {friction}, D = {damping_ratio}: {off}"
        );
    }
}

/// Neither the multiple that counts as whirl nor spin, tolerance or finer steps change v_r,crit in its
/// printed digits.
#[test]
fn choices_do_not_matter() {
    let chapter = chapter(Extent::Quick).unwrap();
    let variants = &chapter.tables[1];
    let same = variants.rows.iter().filter(|row| !row[0].contains("k_c"));
    assert!(same.clone().count() >= 6);
    for row in same {
        assert_eq!(row[2..], variants.rows[0][2..], "{}", row[0]);
    }
    let stiff = variants.rows.iter().filter(|row| row[0].contains("k_c"));
    for row in stiff {
        let rms: f64 = row[7].parse().unwrap();
        assert!(rms < 0.15, "{}: {rms}", row[0]);
    }
}
