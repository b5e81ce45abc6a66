//! What the supervisor makes of its first samples, of a rotor that it is switched on into.

use supervisor::{Command, Status, Supervisor};
use test_support::bench::{Bench, WHIRL_STEP};
use test_support::rig::{RADIUS_M, config, length, new_supervisor, on_circle, sample, sample_with};

/// Command to the very first sample, at a radius on the x axis \[clearances\].
fn first(radius: f32, status: Status) -> Command {
    let at_m = [radius * config().clearance_m, 0.0];
    // Of a controller that has no force to spare.
    new_supervisor().tick(&sample_with(0, at_m, |s| {
        (s.status, s.levitation_n) = (status, [-900.0, 0.0]);
    }))
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

/// The first velocity is a difference between two samples that follow each other, whatever was missed or refused before.
#[test]
fn the_first_velocity_is_of_two_samples_in_a_row() {
    let true_m_s = f64::from(RADIUS_M * WHIRL_STEP) / 50e-6;
    for missed in 0..5 {
        for refused in 0..3 {
            let mut bench = Bench::new(&config());
            let mut angle = 0.3;
            bench.tick(on_circle(RADIUS_M, angle));
            for i in 0..40 {
                angle += WHIRL_STEP;
                if i < refused {
                    bench.tick([f32::NAN; 2]);
                } else if i < refused + missed {
                    bench.sequence += 1;
                } else {
                    bench.tick(on_circle(RADIUS_M, angle));
                }
            }
            let most = f64::from(bench.supervisor.report().backward_speed_max_m_s);
            let share = most / true_m_s;
            assert!((0.95..1.1).contains(&share), "{missed}, {refused}: {share}");
        }
    }
}
