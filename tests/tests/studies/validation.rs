//! The comparison with a measured record, on records that the plant made itself: what it was made with is found again.

use firmware_studies::validation::{Flight, Ran, Record, Rig, Touch};
use plant_model::V2;
use system_tests::ran::{Folder, has};

const SAMPLES: usize = 700;
const FLIGHT: Flight = Flight {
    tilt_rad: V2::new(-5e-4, 2e-3),
    tilt_rate_rad_s: V2::new(0.3, 0.1),
    unbalance_kg_m: V2::new(-3e-5, 1e-4),
    spin_hz: -16.0,
};
const TOUCH: Touch = Touch {
    stiffness_n_m: 2e5,
    restitution: 0.7,
    clearance_m: 1.8e-3,
    friction: 0.0,
    law: None,
};

/// A record of a touch under a rising force, and the run that it is of.
fn made(touch: &Touch) -> (Record, Ran) {
    let blank = Record {
        period_s: 1.0 / 8000.0,
        exciter_n: (0..SAMPLES).map(|i| 0.08 * i as f64).collect(),
        disc_m: vec![V2::zeros(); SAMPLES],
    };
    let ran = Rig::new(&blank)
        .unwrap()
        .run(&FLIGHT, touch, SAMPLES)
        .unwrap();
    let disc_m = ran.disc_m.clone();
    assert_eq!((ran.touches, disc_m.len()), (1, SAMPLES), "{ran:?}");
    (Record { disc_m, ..blank }, ran)
}

/// The samples about the touch.
fn about(record: &Record, ran: &Ran) -> (Record, Rig, Flight) {
    let at = record.samples_to(ran.first_contact_s.unwrap());
    let part = record.part(at - 80..at + 110);
    let begin = Rig::new(record).unwrap().later(&FLIGHT, at - 80).unwrap();
    let near = Rig::new(&part).unwrap();
    (part, near, begin)
}

fn near(found: f64, is: f64, share: f64) {
    assert!((found - is).abs() <= share * is.abs(), "{found}, not {is}");
}

#[test]
fn the_flight_of_a_record_is_found_again() {
    let (record, ran) = made(&TOUCH);
    let before = record.samples_to(ran.first_contact_s.unwrap());
    assert!(before > 300, "{before}");
    let found = Rig::new(&record)
        .unwrap()
        .fit_flight(&record, before)
        .unwrap();
    near(found.spin_hz, FLIGHT.spin_hz, 1e-3);
    for (found, is) in [
        (found.tilt_rad, FLIGHT.tilt_rad),
        (found.tilt_rate_rad_s, FLIGHT.tilt_rate_rad_s),
        (found.unbalance_kg_m, FLIGHT.unbalance_kg_m),
    ] {
        near(found.x, is.x, 5e-3);
        near(found.y, is.y, 5e-3);
    }
}

#[test]
fn the_contact_of_a_record_is_found_again() {
    let (record, ran) = made(&TOUCH);
    let (part, rig, begin) = about(&record, &ran);
    let impact = rig.impact(&part, &begin, None).unwrap();
    near(impact.normal_n_s, ran.normal_impulse_n_s, 0.01);
    assert!(
        impact.tangential_n_s.abs() < 0.01 * impact.normal_n_s,
        "{impact:?}"
    );
    let read = rig.touch(&part, &begin, &impact).unwrap();
    near(read.restitution, TOUCH.restitution, 0.05);
    near(read.stiffness_n_m, TOUCH.stiffness_n_m, 0.2);
    near(read.clearance_m, TOUCH.clearance_m, 0.01);
    let fitted = rig.fit_touch(&part, &begin, &read).unwrap();
    near(fitted.stiffness_n_m, TOUCH.stiffness_n_m, 1e-3);
    near(fitted.restitution, TOUCH.restitution, 1e-3);
    near(fitted.clearance_m, TOUCH.clearance_m, 1e-4);
}

/// The spin is clockwise: friction pushes counter-clockwise.
#[test]
fn friction_shows_in_the_impulse() {
    let (record, ran) = made(&Touch {
        friction: 0.2,
        ..TOUCH
    });
    let (part, rig, begin) = about(&record, &ran);
    let impact = rig.impact(&part, &begin, None).unwrap();
    near(impact.tangential_n_s / impact.normal_n_s, 0.2, 0.1);
}

#[test]
fn without_a_record_it_says_what_it_needs() {
    let folder = Folder::fresh();
    let short = "time_s,exciter_force_x_n,disc_x_m,disc_y_m\n0,0,0,0\n1e-4,0,0,0\n";
    folder.put("short.csv", short);
    for (words, said) in [
        ("validation", "--record FILE.csv"),
        ("validation --record none.csv", "none.csv: "),
        ("validation --record short.csv", "ends before 0.143 s"),
        ("harm --record none.csv", "--record is of validation"),
    ] {
        has(&folder.ran(&format!("study {words}")).fails(2), &[said]);
    }
}
