//! The test at 166 Hz: friction that falls with sliding speed.

use super::rig::{IMPACT_M_S, at_the_wall, run, watch};
use crate::paper::PaperError;
use crate::paper::rotors::footnote_4;
use plant_model::analysis::course::{Course, Watch};
use plant_model::params::{PlantParams, SlidingFriction};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};

/// Speed scales of the friction law that are tried \[m/s\]; the third is the one used.
pub(super) const SCALES_M_S: [f64; 4] = [2.0, 5.0, 10.0, 20.0];
/// The paper's time to standstill \[s\].
pub(super) const PAPER_STANDSTILL_S: f64 = 0.8;
const FAST_HZ: f64 = 166.0;
const SLOW_HZ: f64 = 40.0;

/// Footnote 4 with friction that falls from its 0.15.
fn falling(at_speed: f64, speed_scale_m_s: f64) -> PlantParams {
    let mut params = footnote_4();
    params.friction.sliding = SlidingFriction::Falling {
        at_rest: 0.15,
        at_speed,
        speed_scale_m_s,
    };
    params
}

/// One friction law, fitted, with what it predicts.
pub(super) struct Law {
    pub(super) speed_scale_m_s: f64,
    /// μ at high sliding speed, fitted to the standstill from 166 Hz.
    pub(super) at_speed: f64,
    /// From 166 Hz and from 40 Hz \[s\].
    pub(super) standstill_s: [f64; 2],
    /// Median whirl frequency from 90 % to 10 % of the spin, from 166 Hz.
    pub(super) median_hz: f64,
    /// Lowest in the same stretch.
    pub(super) lowest_hz: f64,
    /// Largest of the run.
    pub(super) largest_hz: f64,
    /// Lowest radial impact at the wall that ends in whirl, at 40 and at 166 Hz \[m/s\].
    pub(super) critical_m_s: [f64; 2],
    /// The run from 166 Hz.
    pub(super) course: Course,
}

/// Established whirl: the rotor comes to the wall outwards and already against its spin, so that it whirls
/// with the least friction that is tried.
fn standstill_s(
    params: &PlantParams,
    spin_hz: f64,
    sample_s: f64,
) -> Result<(Option<f64>, Course), PaperError> {
    let mut start = at_the_wall(spin_hz, IMPACT_M_S);
    start.velocity_m_s.y = -BACKWARD_M_S;
    let watch = Watch {
        sample_s,
        free_s: 0.03,
        ..watch(3.0)
    };
    let (course, _) = run(params, &start, &watch)?;
    let time = (course.spin_below_s(2.0))
        .zip(course.spin_below_s(0.9 * spin_hz))
        .map(|(to, from)| to - from);
    Ok((time, course))
}

/// Tangential speed at the start \[m/s\].
const BACKWARD_M_S: f64 = 0.4;
const FINE_S: f64 = 20e-6;
const COARSE_S: f64 = 200e-6;

/// Fits and predicts, one law a speed scale.
pub(super) fn laws() -> Result<Vec<Law>, PaperError> {
    SCALES_M_S.par_iter().map(|scale| law(*scale)).collect()
}

fn law(speed_scale_m_s: f64) -> Result<Law, PaperError> {
    // The more friction at speed the sooner standstill; no whirl counts as for ever.
    let (mut low, mut high) = (0.027, 0.06);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        let (time, _) = standstill_s(&falling(middle, speed_scale_m_s), FAST_HZ, COARSE_S)?;
        if time.is_none_or(|t| t > PAPER_STANDSTILL_S) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let params = falling(high, speed_scale_m_s);
    let missing = |spin_hz: f64| PaperError::Missing(format!("no standstill from {spin_hz} Hz"));
    let (fast_s, course) = standstill_s(&params, FAST_HZ, FINE_S)?;
    let (slow_s, _) = standstill_s(&params, SLOW_HZ, FINE_S)?;
    let stretch = (course.spin_below_s(0.9 * FAST_HZ))
        .zip(course.spin_below_s(0.1 * FAST_HZ))
        .ok_or_else(|| missing(FAST_HZ))?;
    let mut whirl: Vec<f64> = (course.whirl.iter())
        .filter(|r| r.t_s > stretch.0 && r.t_s < stretch.1)
        .map(|r| r.backward_hz)
        .collect();
    whirl.sort_by(f64::total_cmp);
    let largest_hz = course.fastest().map(|r| r.backward_hz);
    Ok(Law {
        speed_scale_m_s,
        at_speed: high,
        standstill_s: [
            fast_s.ok_or_else(|| missing(FAST_HZ))?,
            slow_s.ok_or_else(|| missing(SLOW_HZ))?,
        ],
        median_hz: (whirl.get(whirl.len() / 2).copied()).ok_or_else(|| missing(FAST_HZ))?,
        lowest_hz: (whirl.first().copied()).ok_or_else(|| missing(FAST_HZ))?,
        largest_hz: largest_hz.ok_or_else(|| missing(FAST_HZ))?,
        critical_m_s: [
            critical_m_s(&params, SLOW_HZ)?,
            critical_m_s(&params, FAST_HZ)?,
        ],
        course,
    })
}

/// Lowest radial impact at the wall that ends in whirl, with constant friction at both speeds \[m/s\].
pub(super) fn critical_with_constant_friction_m_s() -> Result<[f64; 2], PaperError> {
    let params = footnote_4();
    Ok([
        critical_m_s(&params, SLOW_HZ)?,
        critical_m_s(&params, FAST_HZ)?,
    ])
}

/// Searched upwards in steps of 8 %, the first step that whirls then halved to 0.3 %.
fn critical_m_s(params: &PlantParams, spin_hz: f64) -> Result<f64, PaperError> {
    let whirls = |speed_m_s: f64| -> Result<bool, PaperError> {
        let watch = Watch {
            sample_s: COARSE_S,
            ..watch(0.5)
        };
        let (course, _) = run(params, &at_the_wall(spin_hz, speed_m_s), &watch)?;
        let long = course.longest_contact();
        Ok(long.is_some_and(|c| c.to_s - c.from_s > 0.1))
    };
    let (mut low, mut high) = (0.05, 0.05 * 1.08);
    while !whirls(high)? {
        low = high;
        high *= 1.08;
        if high > 10.0 {
            let what = format!("no whirl from {spin_hz} Hz up to an impact of 10 m/s");
            return Err(PaperError::Missing(what));
        }
    }
    while high > 1.003 * low {
        let middle = 0.5 * (low + high);
        if whirls(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(high)
}
