//! The catalogue's scenes on machines that nothing was tuned on.

use rayon::prelude::*;
use std::ops::Range;
use system_tests::unseen::{Compared, machine};

/// Of these numbers, the machines whose forces come so late.
fn on_machines(numbers: Range<u64>, lateness: Range<f64>) -> Compared {
    let of_machine = |number| {
        let unseen = machine(number);
        match lateness.contains(&unseen.lateness) {
            true => Compared::on(&unseen.plant, &unseen.found(), &unseen.text),
            false => Compared::default(),
        }
    };
    (numbers.into_par_iter().map(of_machine)).reduce(Compared::default, Compared::with)
}

/// Whatever levitation alone recovers from, the supervisor does, and from more, as long as a force comes within 0.8 of
/// the time in which the cap crosses the clearance.
#[test]
fn nothing_is_lost_that_levitation_alone_recovers_from() {
    let Compared {
        alone, own, lost, ..
    } = on_machines(0..12, 0.0..0.8);
    assert!(lost.is_empty(), "{lost:#?}");
    assert!(own > alone + alone / 50, "{own} of {alone}");
}

/// The same of many, by lateness: the table of the documentation.
#[test]
#[ignore = "minutes; the figures are in docs/src/host/overloads-explained.md"]
fn little_is_lost_on_many_machines() {
    for lateness in [0.0..0.4, 0.4..0.8, 0.8..10.0] {
        let of = on_machines(0..200, lateness.clone());
        println!("{lateness:?}: {of:#?}");
        assert!(of.lost.len() * 50 < of.runs, "{lateness:?}");
    }
}
