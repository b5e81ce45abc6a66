//! Forward rub that levitation alone stays in is broken where a force within the cap can.

use firmware_studies::campaign::Extent;
use firmware_studies::machines::unbalanced::{Motion, RubCase};
use firmware_studies::paired::rub::study;

#[test]
fn rubs_are_broken_where_the_cap_can() {
    let report = study(Extent::Quick, &()).unwrap();
    let claim = |name: &str| {
        report
            .claims
            .iter()
            .find(|c| c.name.contains(name))
            .unwrap()
    };
    let within = claim("within the cap");
    assert!(within.holds, "{within:?}");
    // Of some two hundred that run free two, driven on to the wall on and on, are lost.
    let lost = claim("only levitation alone");
    assert!(lost.measured < 0.015, "{lost:?}");
}

/// Conical rubs that the supervisor broke, and then left bouncing to a loop at its cap: before it saw them to their end they were
/// lost. Levitation alone is free of each.
#[test]
fn a_rotor_that_was_driven_off_the_wall_is_seen_to_the_middle() {
    for number in [87, 253, 458] {
        let case = RubCase::new(7, Motion::Conical, number);
        let [driven, _] = case.pairs().of_free().unwrap();
        for run in [driven.levitation, driven.supervisor] {
            assert!(run.recovered && !run.whirled, "{}: {run:?}", case.text());
        }
    }
}

/// (4.18) tells where no rub can be: far inside it levitation alone comes free of every wall, far outside it stays in some.
#[test]
fn the_closed_form_parts_them() {
    let (mut inside, mut outside) = (0, 0);
    for number in 0..120 {
        let case = RubCase::new(7, Motion::OnePlane, number);
        let Some([driven, _]) = case.pairs().of_free() else {
            continue;
        };
        let stays = case.stays(&driven.levitation);
        match case.reserve() {
            r if r > 4.0 => {
                inside += 1;
                assert!(!stays, "{}", case.text());
            }
            r if r < 1.5 => outside += u32::from(stays),
            _ => {}
        }
    }
    assert!(inside > 5 && outside > 5, "{inside} {outside}");
}
