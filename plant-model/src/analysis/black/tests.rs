use super::*;

/// The paper's footnote 4, contact without deformation.
fn footnote_4() -> SteadyWhirl {
    let body = |k: f64, d: f64| Oscillator {
        mass_kg: 10.0,
        stiffness_n_m: k,
        damping_n_s_m: d,
    };
    SteadyWhirl {
        rotor: body(9.1e5, 20.5),
        rings: vec![body(8.9e8, 28_300.0), body(3.6e9, 18_970.0)],
        clearance_m: 2e-4,
        normal_compliance_m_n: 0.0,
        tangential_compliance_m_n: 0.0,
        contact_damping_n_s_m: 1.6e4,
        driving_friction: 0.125,
    }
}

fn hz(circles: &[Circle]) -> Vec<f64> {
    circles.iter().map(|c| c.frequency_hz().round()).collect()
}

#[test]
fn roots_of_footnote_4() {
    let mut whirl = footnote_4();
    let roots = whirl.sliding(1.0, 5000.0);
    assert_eq!(hz(&roots), [49.0, 735.0, 1995.0, 3462.0, 3897.0]);
    assert!(roots.iter().all(Circle::exists));
    let attracts: Vec<bool> = roots.iter().map(|c| c.attracts).collect();
    assert_eq!(attracts, [false, true, false, true, false]);
    // A penetration along the normal moves none of them, but takes the fast ones away.
    whirl.normal_compliance_m_n = 1e-9;
    let soft = whirl.sliding(1.0, 5000.0);
    assert_eq!(hz(&soft), hz(&roots));
    let exists: Vec<bool> = soft.iter().map(Circle::exists).collect();
    assert_eq!(exists, [true, true, true, false, false]);
    whirl.normal_compliance_m_n = 1.0 / 3e8;
    assert_eq!(whirl.upper_limit(5000.0), None);
}

/// Black's condition with the spring of the contact counted to the stator, hence along the tangent too.
#[test]
fn a_contact_that_yields_along_the_tangent_lowers_the_limit() {
    for (k, limit_hz) in [(1e10, 730.0), (1e9, 694.0), (5e8, 656.0), (3e8, 608.0)] {
        let whirl = SteadyWhirl {
            normal_compliance_m_n: 1.0 / k,
            tangential_compliance_m_n: 1.0 / k,
            ..footnote_4()
        };
        let found = whirl.upper_limit(5000.0).unwrap().frequency_hz();
        assert!((found - limit_hz).abs() < 0.6, "{k:e}: {found}");
    }
}

#[test]
fn coupled_frequencies_are_zeros_of_the_undamped_receptance() {
    for compliance in [0.0, 1e-9] {
        let mut whirl = footnote_4();
        whirl.normal_compliance_m_n = compliance;
        whirl.rotor.damping_n_s_m = 0.0;
        for ring in &mut whirl.rings {
            ring.damping_n_s_m = 0.0;
        }
        let all = whirl.coupled_frequencies_hz();
        assert_eq!(all.len(), if compliance == 0.0 { 2 } else { 3 });
        for f in all {
            let alpha = whirl.receptance_m_n(f * std::f64::consts::TAU);
            assert!((alpha.re + compliance).abs() < 1e-16, "{f}: {alpha}");
        }
    }
    assert!((footnote_4().coupled_frequencies_hz()[0] - 941.0).abs() < 1.0);
}

/// On a rigid wall: threshold v = a + √(a² + k·c²/m) of the onset module, growth rate by hand.
#[test]
fn rigid_stator_by_hand() {
    let whirl = SteadyWhirl {
        rings: vec![],
        ..footnote_4()
    };
    let all = whirl.sliding(1.0, 5000.0);
    assert_eq!(all.len(), 1);
    let (a, c) = (2e-4 * 20.5 / (2.0 * 0.125 * 10.0), 2e-4);
    let speed = a + f64::hypot(a, c * 9.1e4_f64.sqrt());
    assert!((all[0].omega_rad_s * c / speed - 1.0).abs() < 1e-9);
    // v̇ = μ(v²/c − k·c/m) − d·v/m: growth 2μω − d/m.
    let growth = 2.0 * 0.125 * all[0].omega_rad_s - 2.05;
    assert!(
        (all[0].growth_rate_s / growth - 1.0).abs() < 1e-3,
        "{} {growth}",
        all[0].growth_rate_s
    );
    assert!(!all[0].attracts);
    assert_eq!(whirl.upper_limit(5000.0), None);
}

/// Rolling circles end where sliding ones are.
#[test]
fn rolling_meets_sliding_at_the_cone() {
    for compliance in [0.0, 1e-9] {
        let mut whirl = footnote_4();
        whirl.normal_compliance_m_n = compliance;
        for slides in whirl.sliding(1.0, 2500.0) {
            let (rolls, spin) = whirl.rolling_at(slides.omega_rad_s, 0.1);
            assert!((rolls.driving_share - 0.125).abs() < 1e-9);
            assert!((rolls.normal_force_n / slides.normal_force_n - 1.0).abs() < 1e-9);
            assert!((spin * 0.1 / slides.omega_rad_s / slides.distance_m - 1.0).abs() < 1e-9);
            assert!(rolls.growth_rate_s < 0.0, "{rolls:?}");
        }
    }
}

#[test]
fn friction_below_the_least_has_no_whirl() {
    let mut whirl = footnote_4();
    let (least, at_hz) = whirl.least_friction(1.0, 5000.0).unwrap();
    whirl.driving_friction = least * 1.001;
    let around = whirl.sliding(1.0, 5000.0);
    assert!(
        around
            .iter()
            .any(|c| (c.frequency_hz() - at_hz).abs() < 50.0)
    );
    whirl.driving_friction = least * 0.999;
    assert!(!whirl.sliding(1.0, 5000.0).iter().any(Circle::exists));
}
