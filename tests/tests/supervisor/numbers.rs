//! The supervisor's numbers: fixed point against f64, and the self-test's known answers.

use proptest::prelude::*;
use supervisor::{Core, Events, Q, Scalar, SelfTest, self_test};

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
    for (name, run, passes) in [
        ("f32", SelfTest::run::<f32>(), self_test::<f32>()),
        ("f64", SelfTest::run::<f64>(), self_test::<f64>()),
        ("Q", SelfTest::run::<Q>(), self_test::<Q>()),
    ] {
        assert_eq!(run.modes, 0b111_1111, "{name}: {run:x?}");
        let drive = Events::AXIS_LOST | Events::AXIS_BACK;
        assert!(run.events.contains(drive), "{name}: {run:x?}");
        assert!(passes, "{name}: {run:x?}");
    }
}

/// A record has room for what a core of either number remembers.
#[test]
fn states_fit_their_place_in_a_record() {
    assert_eq!(Core::<f32, 4>::state_words(), 123);
    assert_eq!(Core::<Q, 4>::state_words(), 123);
}
