//! Chapter "The nine phases": all of them, in order, with the events that bound them.

use firmware_studies::campaign::Extent;
use firmware_studies::paper::phases::{chapter, whirl_from_40_hz};

#[test]
fn nine_phases_in_order() {
    let whirl = whirl_from_40_hz().unwrap();
    let (course, bounds) = (&whirl.course, &whirl.bounds);
    assert!(bounds.windows(2).all(|w| w[0] < w[1]), "{bounds:?}");
    let contact_in = |from: f64, to: f64| {
        (course.samples.iter())
            .filter(move |s| s.t_s > from && s.t_s < to)
            .map(|s| s.mode.in_contact())
    };
    // 1, 2 and 9 without contact, 3 and 5 to 8 all contact, 4 both.
    for (from, to) in [(0, 2), (8, 9)] {
        assert!(!contact_in(bounds[from], bounds[to]).any(|c| c));
    }
    for (from, to) in [(2, 3), (4, 8)] {
        assert!(contact_in(bounds[from], bounds[to]).all(|c| c));
    }
    assert!(contact_in(bounds[3], bounds[4]).any(|c| c));
    assert!(contact_in(bounds[3], bounds[4]).any(|c| !c));
    // The maximum is in 6, and 6 is short.
    let fastest = course.fastest().unwrap();
    assert!((bounds[5]..=bounds[6]).contains(&fastest.t_s));
    assert!((bounds[6] - bounds[5]) < 0.01);
    // Friction stops the spin in 5 and 6.
    assert!(course.at(bounds[4]).unwrap().spin_hz > 39.0);
    assert!(course.at(bounds[6]).unwrap().spin_hz < 3.0);
}

#[test]
fn rows_of_the_chapter() {
    let chapter = chapter(Extent::Quick).unwrap();
    let value = |quantity: &str| {
        let row = chapter.rows.iter().find(|r| r.quantity == quantity);
        row.unwrap_or_else(|| panic!("no row {quantity}"))
            .computed
            .unwrap()
    };
    let within = |quantity: &str, low: f64, high: f64| {
        let v = value(quantity);
        assert!((low..=high).contains(&v), "{quantity}: {v}");
    };
    within("Phases found, in order", 9.0, 9.0);
    within(
        "Whirl frequency at the start of continuous contact",
        48.0,
        62.0,
    );
    within("Excitation to maximum", 0.07, 0.13);
    within("Whirl turns within 5 % of the maximum", 3.0, 5.0);
    within("Impacts before continuous contact", 2.0, 15.0);
    // Free decay: e^(−D·ω0·t) with D·ω0 = d/(2m), from the first 30 ms to the last of 120 ms.
    let expected = (-20.5_f64 / 20.0 * 0.09).exp();
    within(
        "Amplitude at the end of phase 9 over its start",
        0.98 * expected,
        1.02 * expected,
    );
}
