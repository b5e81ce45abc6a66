//! What the supervisor makes of a single sample: of a rotor that it is switched on into, and after a gap.

use supervisor::{Command, Events, Mode, Status, Supervisor};
use system_tests::rig::{RADIUS_M, config, length, sample};

/// Command to the very first sample, at a radius on the x axis \[clearances\].
fn first(radius: f32, status: Status) -> Command {
    let mut s = sample(0, [radius * config().clearance_m, 0.0]);
    s.status = status;
    // Of a controller that has no force to spare.
    s.levitation_n = [-900.0, 0.0];
    Supervisor::<64>::new(&config()).unwrap().tick(&s)
}

/// Pressed deeper than the contact band, with a known spin: the whole cap against backward whirl, and ahead of the
/// rotor by delay and lag at the lift-off speed on a circle of this radius, (5.12).
#[test]
fn a_whirl_is_braked_from_the_first_sample_on() {
    let c = config();
    let unit_s = f64::from(c.mass_kg * c.clearance_m / c.force_max_n).sqrt();
    let delay_s = 1.5 * f64::from(c.sample_period_s);
    let on = Status::BEARING_ON | Status::SPIN_VALID | Status::LEVITATED_BEFORE;
    for radius in [1.025_f32, 1.5] {
        let command = first(radius, on);
        let rate = 1.0 / (unit_s * f64::from(radius));
        let lead = delay_s * rate + (f64::from(c.amplifier_lag_s) * rate).atan();
        // The spin is counter-clockwise: backward is clockwise, and ahead of a rotor at +x is towards −y.
        let [x, y] = command.force_n.map(f64::from);
        assert!(length(command.force_n) > 0.999 * f64::from(c.force_max_n));
        assert!((x.atan2(y) - lead).abs() < 0.01, "{command:?}");
    }
}

/// Where nothing says so it is not taken for whirl: inwards, and nothing along the wall.
#[test]
fn nothing_is_braked_that_is_not_known_to_whirl() {
    let on = Status::BEARING_ON | Status::SPIN_VALID | Status::LEVITATED_BEFORE;
    let blind = on - Status::SPIN_VALID;
    for (radius, status) in [(1.025, blind), (1.015, on), (0.999, on)] {
        let command = first(radius, status);
        let [x, y] = command.force_n;
        assert!(x < 0.0 && y == 0.0, "{radius}, {status:?}: {command:?}");
    }
}

/// A guess is not reported, and severity does not follow from it.
#[test]
fn a_guess_is_not_reported() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let command = supervisor.tick(&sample(0, [1.5 * config().clearance_m, 0.0]));
    assert_eq!(command.severity, 0.0);
    assert_eq!(supervisor.report().backward_speed_max_m_s, 0.0);
}

/// Only the very first sample is taken so: after missed ticks a rotor that a load presses into the wall is held on.
#[test]
fn a_gap_makes_no_whirl_of_a_load() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut events_after = Events::empty();
    for i in 0..400 {
        let jitter_m = 1e-8 * (i % 7) as f32;
        // A gap of six ticks at 200.
        let sequence = if i < 200 { i } else { i + 6 };
        let command = supervisor.tick(&sample(sequence, [RADIUS_M + jitter_m, jitter_m]));
        if i == 199 {
            assert_eq!(command.mode, Mode::Pinned);
        }
        if i >= 200 {
            events_after |= command.events;
            let [x, y] = command.force_n;
            assert!(x < -300.0 && y.abs() < 300.0, "{i}: {command:?}");
        }
    }
    assert!(events_after.contains(Events::SEQUENCE) && !events_after.contains(Events::WHIRL));
}
