//! The supervisor's numbers: fixed point against f64, and the self-test's known answers.

use proptest::prelude::*;
use supervisor::{Config, Core, Events, Prepared, Q, RotorSupervisor, Scalar, Supervisor};
use test_support::records::written;
use test_support::rig::{LANDING_TICKS, config, landing, sample, shaft};

/// A unit of Q.
const LAST: f64 = 1.0 / 4_194_304.0;

fn real(q: Q) -> f64 {
    f64::from(q.to_bits()) * LAST
}

/// Any bits, and numbers of the size that the supervisor has.
fn any_q() -> impl Strategy<Value = Q> {
    prop_oneof![
        1 => any::<i32>().prop_map(Q::from_bits),
        3 => (-(4 << 22)..(4 << 22)).prop_map(Q::from_bits),
        1 => prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(0), Just(1), Just(-1)].prop_map(Q::from_bits),
    ]
}

fn saturated(x: f64) -> f64 {
    x.clamp(f64::from(i32::MIN) * LAST, f64::from(i32::MAX) * LAST)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Sums are exact, products rounded once, both saturating.
    #[test]
    fn sums_and_products(a in any_q(), b in any_q(), c in any_q(), d in any_q()) {
        prop_assert_eq!(real(a + b), saturated(real(a) + real(b)));
        prop_assert_eq!(real(a - b), saturated(real(a) - real(b)));
        prop_assert_eq!(real(-a), saturated(-real(a)));
        prop_assert!((real(a * b) - saturated(real(a) * real(b))).abs() <= LAST);
        let exact = saturated(real(a) * real(b) + real(c) * real(d));
        prop_assert!((real(Q::products(a, b, c, d)) - exact).abs() <= LAST);
    }

    /// Roots and quotients to some units in the last place or 4e-7 of themselves, whichever is more.
    #[test]
    fn roots_and_quotients(a in any_q(), b in any_q()) {
        let near = |q: Q, exact: f64| (real(q) - exact).abs() <= 2.0 * LAST + 4e-7 * exact.abs();
        let root = real(a).max(0.0).sqrt();
        prop_assert!(near(Scalar::sqrt(a), root), "root of {}: {} {}", real(a), real(Scalar::sqrt(a)), root);
        if b != Q::ZERO {
            let quotient = saturated(real(a) / real(b));
            prop_assert!(near(Scalar::div(a, b), quotient), "{} / {}: {} {}", real(a), real(b), real(Scalar::div(a, b)), quotient);
        }
        let length = real(a).hypot(real(b));
        let inverse = real(Q::inverse_length(a, b));
        if length >= 1.0 / 512.0 {
            prop_assert!((inverse - 1.0 / length).abs() <= 2.0 * LAST + 4e-7 / length, "1/{length}: {inverse}");
        } else {
            prop_assert_eq!(inverse, 0.0);
        }
    }

    /// Comparisons of lengths are exact.
    #[test]
    fn lengths_compare_exactly(a in any_q(), b in any_q(), c in any_q()) {
        let wide = |q: Q| i128::from(q.to_bits());
        let exact = wide(a) * wide(a) + wide(b) * wide(b) > wide(c) * wide(c);
        prop_assert_eq!(Q::exceeds(a, b, c), exact);
    }

    /// The reciprocal root of f32 and f64, over their whole useful range.
    #[test]
    fn floating_point_roots(exponent in -29.0..37.0_f64, share in 1.0..10.0_f64) {
        let x = share * 10_f64.powf(exponent);
        let single = x as f32;
        let exact = f64::from(single).sqrt();
        prop_assert!((f64::from(Scalar::sqrt(single)) / exact - 1.0).abs() < 4e-7);
        prop_assert!((Scalar::sqrt(x) / x.sqrt() - 1.0).abs() < 1e-15 * 8.0);
    }
}

/// The self-test goes through every mode, and has a drive that does not obey; and its answers are the known ones.
/// Requirement: SR-35
#[test]
fn self_test_knows_its_answers() {
    let config = Config::example();
    let mut supervisor = Supervisor::<64>::new(&config).unwrap();
    let mut rotor = RotorSupervisor::<64>::new(&shaft(&config), &[config; 2]).unwrap();
    let tests = [
        ("f32", core_of::<f32>(&config).self_test()),
        ("f64", core_of::<f64>(&config).self_test()),
        ("Q", core_of::<Q>(&config).self_test()),
        (
            "f32 of a ticker",
            core_of::<f32>(&config).split().0.self_test(),
        ),
        ("newtons", supervisor.self_test()),
        ("newtons of a ticker", supervisor.split().0.self_test()),
        ("rotor", rotor.self_test()),
        ("rotor of a ticker", rotor.split().0.self_test()),
    ];
    for (name, test) in tests {
        assert_eq!(test.modes, 0b111_1111, "{name}: {test:x?}");
        let drive = Events::AXIS_LOST | Events::AXIS_BACK;
        assert!(test.events.contains(drive), "{name}: {test:x?}");
        assert!(test.passed, "{name}: {test:x?}");
    }
}

fn core_of<S: Scalar>(config: &Config) -> Core<S, 64> {
    Core::new(&Prepared::new(config).unwrap())
}

/// After the self-test a supervisor is as new, whatever it had gone through; and nothing of the test is in its queue or its record.
#[test]
fn self_test_leaves_a_new_supervisor() {
    let mut untouched = Supervisor::<64>::new(&config()).unwrap();
    let mut used = untouched.clone();
    for i in 0..LANDING_TICKS {
        used.tick(&sample(i, landing(i)));
    }
    assert!(used.record().is_some() && used.report().landings > 0);
    while used.next_event().is_some() {}
    assert!(used.self_test().passed);
    assert_eq!(used.next_event(), None);
    assert!(used.record().is_none());
    assert_eq!(used.report(), untouched.report());
    for i in 0..LANDING_TICKS {
        let sample = sample(i, landing(i));
        assert_eq!(used.tick(&sample), untouched.tick(&sample), "{i}");
    }
    assert_eq!(used.report(), untouched.report());
    let [used, untouched] = [used, untouched].map(|s| s.record().map(|record| written(&record)));
    assert!(used.is_some() && used == untouched);
}

/// A record has room for what a core of either number remembers.
#[test]
fn states_fit_their_place_in_a_record() {
    assert_eq!(Core::<f32, 4>::state_words(), 132);
    assert_eq!(Core::<Q, 4>::state_words(), 132);
}
