//! The nine phases of a whirl, from the orbit before the excitation to the decay after it.
//!
//! The paper ("Established Backward Whirl", Figs. 5 and 6) tells them apart in words. What is measured here:
//!
//! | | phase | begins with |
//! |---|---|---|
//! | 1 | orbit imposed by unbalance | the run |
//! | 2 | excitation | the force of the excitation |
//! | 3 | first impact | the first touch |
//! | 4 | series of impacts | the first lift-off |
//! | 5 | whirl accelerates | the touch of the longest contact |
//! | 6 | largest whirl frequency | the whirl frequency within `NEAR_MAXIMUM` of its largest value |
//! | 7 | whirl decelerates rapidly | the same, left |
//! | 8 | whirl at lower frequency | the deceleration fallen to [`SLOW`] of its steepest in phase 7 |
//! | 9 | free vibration that decays | the lift-off that ends the longest contact |
//!
//! A phase ends where the next begins.

use super::course::Course;
use super::whirl::WhirlReading;

/// Phase 6 lasts while the whirl frequency is within this share of its maximum.
pub(crate) const NEAR_MAXIMUM: f64 = 0.05;
/// Phase 8 begins when the deceleration has fallen to this share of the steepest.
pub const SLOW: f64 = 0.1;
/// Stretch over which the deceleration is taken \[s\]: longer than the swing of the stator after
/// rolling sets in, shorter than the phase.
pub(crate) const DECELERATION_OVER_S: f64 = 5e-3;

/// Short names of the nine, in order.
pub const NAMES: [&str; 9] = [
    "orbit by unbalance",
    "excitation",
    "first impact",
    "series of impacts",
    "whirl accelerates",
    "maximum whirl frequency",
    "rapid deceleration",
    "slower whirl",
    "free decay",
];

/// Beginning of each phase and, last, the end of the run \[s\].
pub type Bounds = [f64; 10];

/// Finds the phases; `None` where a run does not have all nine in this order.
pub fn find(course: &Course) -> Option<Bounds> {
    let end_s = course.samples.last()?.t_s;
    let first = course.contacts.first()?;
    let long = course.longest_contact()?;
    let whirl = within(&course.whirl, (long.from_s, long.to_s));
    let largest_hz = whirl.iter().map(|r| r.backward_hz).reduce(f64::max)?;
    let near = |r: &WhirlReading| r.backward_hz >= (1.0 - NEAR_MAXIMUM) * largest_hz;
    let top = whirl.iter().position(near)?;
    let left = whirl.iter().rposition(near)?;
    let slow = top_of_decline(&whirl[left..])?;
    let bounds = [
        course.samples.first()?.t_s,
        course.pulse_s?.0,
        first.from_s,
        first.to_s,
        long.from_s,
        whirl[top].t_s,
        whirl[left].t_s,
        whirl[left + slow].t_s,
        long.to_s,
        end_s,
    ];
    bounds.windows(2).all(|w| w[0] < w[1]).then_some(bounds)
}

fn within(whirl: &[WhirlReading], (from_s, to_s): (f64, f64)) -> &[WhirlReading] {
    let from = whirl.partition_point(|r| r.t_s < from_s);
    let to = whirl.partition_point(|r| r.t_s <= to_s);
    &whirl[from..to.max(from)]
}

/// Index at which the deceleration, past its steepest, has fallen to [`SLOW`] of it.
fn top_of_decline(whirl: &[WhirlReading]) -> Option<usize> {
    let mut behind = 0;
    let rates: Vec<(usize, f64)> = (whirl.iter().enumerate())
        .filter_map(|(i, now)| {
            // Centred on the reading between the two ends.
            while now.t_s - whirl[behind].t_s > DECELERATION_OVER_S {
                behind += 1;
            }
            let then = &whirl[behind];
            let over = now.t_s - then.t_s;
            (over > 0.9 * DECELERATION_OVER_S).then(|| {
                let rate = (then.backward_hz - now.backward_hz) / over;
                ((i + behind) / 2, rate)
            })
        })
        .collect();
    let mut steepest = 0;
    for (i, (_, rate)) in rates.iter().enumerate() {
        if *rate > rates[steepest].1 {
            steepest = i;
        }
    }
    let limit = SLOW * rates.get(steepest)?.1;
    let mut after = rates.iter().skip(steepest);
    after.find(|(_, rate)| *rate <= limit).map(|(i, _)| *i)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::course::{Contact, Sample};
    use crate::{ContactMode, V2};

    /// A made-up course: the whirl rises linearly to 700 Hz, stays, and decays exponentially with 20 ms.
    fn course() -> Course {
        let sample = |t_s: f64| Sample {
            t_s,
            position_m: V2::zeros(),
            inner_ring_m: V2::zeros(),
            outer_ring_m: V2::zeros(),
            spin_hz: 0.0,
            race_spin_hz: 0.0,
            mode: ContactMode::Flight,
            normal_force_n: 0.0,
            backward_m_s: 0.0,
            sliding_m_s: f64::NAN,
        };
        let whirl = |i: i32| {
            let t_s = 0.1 + f64::from(i) * 1e-4;
            let backward_hz = if t_s < 0.12 {
                50.0 + 650.0 * (t_s - 0.1) / 0.02
            } else {
                700.0 * (-(t_s - 0.125).max(0.0) / 0.02).exp()
            };
            WhirlReading { t_s, backward_hz }
        };
        Course {
            samples: vec![sample(0.0), sample(0.5)],
            whirl: (0..2000).map(whirl).collect(),
            contacts: [(0.052, 0.053), (0.06, 0.061), (0.1, 0.3)]
                .map(|(from_s, to_s)| Contact { from_s, to_s })
                .to_vec(),
            pulse_s: Some((0.05, 0.0515)),
        }
    }

    #[test]
    fn all_nine_where_they_were_put() {
        let bounds = find(&course()).unwrap();
        // Within 5 % of 700 Hz from 665 Hz up; 0.05·20 ms after the plateau; a tenth of the slope
        // after ln 10 time constants (taken over 5 ms: to within that).
        let top = 0.1 + 0.02 * 615.0 / 650.0;
        let left = 0.125 + 0.02 * (1.0f64 / 0.95).ln();
        let slow = left + 0.02 * 10f64.ln();
        let expected = [0.0, 0.05, 0.052, 0.053, 0.1, top, left, slow, 0.3, 0.5];
        for (i, (found, expected)) in bounds.iter().zip(expected).enumerate() {
            let tolerance = if i == 7 { DECELERATION_OVER_S } else { 2e-4 };
            assert!(
                (found - expected).abs() < tolerance,
                "{i}: {found} {expected}"
            );
        }
    }

    #[test]
    fn none_without_excitation_or_decay() {
        let mut no_pulse = course();
        no_pulse.pulse_s = None;
        assert_eq!(find(&no_pulse), None);
        let mut no_decay = course();
        no_decay.whirl.truncate(260);
        assert_eq!(find(&no_decay), None);
    }
}
