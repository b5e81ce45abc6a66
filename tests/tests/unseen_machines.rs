//! The catalogue's scenes on machines that nothing was tuned on.

use firmware_host::overloads::results::run_case;
use firmware_host::overloads::seats::Seat;
use rayon::prelude::*;
use std::ops::Range;
use system_tests::unseen::{machine, sound_cases};

/// What came of some machines.
#[derive(Debug, Default)]
struct Summary {
    machines: usize,
    runs: usize,
    /// Recovered with levitation alone, and with the supervisor.
    alone: usize,
    own: usize,
    /// Runs that only levitation alone recovered from.
    lost: Vec<String>,
}

impl Summary {
    fn with(mut self, other: Self) -> Self {
        self.machines += other.machines;
        self.runs += other.runs;
        self.alone += other.alone;
        self.own += other.own;
        self.lost.extend(other.lost);
        self
    }
}

/// Of these numbers, the machines whose forces come so late.
fn on_machines(numbers: Range<u64>, lateness: Range<f64>) -> Summary {
    let of_machine = |number| {
        let unseen = machine(number);
        if !lateness.contains(&unseen.lateness) {
            return Summary::default();
        }
        let at = (unseen.plant.name.as_str(), unseen.plant.rate_hz);
        let found = unseen.found();
        let mut summary = Summary {
            machines: 1,
            ..Summary::default()
        };
        for case in sound_cases(&unseen.plant, found.tuned) {
            let [alone, own] = [Seat::Tuned, Seat::Supervisor]
                .map(|seat| run_case(&case, at, (seat, 1), &found).recovered());
            summary.runs += 1;
            summary.alone += usize::from(alone);
            summary.own += usize::from(own);
            if alone && !own {
                summary.lost.push(format!("{}: {}", unseen.text, case.name));
            }
        }
        summary
    };
    (numbers.into_par_iter().map(of_machine)).reduce(Summary::default, Summary::with)
}

/// Whatever levitation alone recovers from, the supervisor does, and from more, as long as a force comes within 0.8 of
/// the time in which the cap crosses the clearance.
#[test]
fn nothing_is_lost_that_levitation_alone_recovers_from() {
    let Summary {
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
