//! The catalogue's scenes on machines that nothing was tuned on: half a dozen of those that `study unseen-machines` runs.

use firmware_studies::unseen_machines::by_lateness;

/// Whatever levitation alone recovers from, the supervisor does, and from more, as long as a force comes within 0.8 of
/// the time in which the cap crosses the clearance.
#[test]
fn nothing_is_lost_that_levitation_alone_recovers_from() {
    let [early, middle, _] = by_lateness(0..6, &()).unwrap();
    let of = early.and(middle);
    assert!(of.lost.is_empty(), "{:#?}", of.lost);
    assert!(
        of.own > of.alone + of.alone / 50,
        "{} of {}",
        of.own,
        of.alone
    );
}
