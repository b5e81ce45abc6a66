//! The nine phases of the paper's Figs. 5 and 6, found on a run from 40 Hz.

mod figures;

use super::data::*;
use super::rotors::footnote_4;
use super::runs::{Run, watch};
use plant_model::V2;
use plant_model::analysis::course::{Course, Pulse, Sample};
use plant_model::analysis::phases::{self, Bounds, NAMES};
use plant_model::params::Start;

const SPIN_HZ: f64 = 40.0;
/// Unbalance: the paper has some in phase 1 but gives no number \[m\].
const ECCENTRICITY_M: f64 = 1e-5;
/// Largest force of the paper's magnet \[N\].
const LARGEST_N: f64 = 1500.0;
/// Excitation of the run over the smallest that whirls.
const ABOVE_CRITICAL: f64 = 1.05;
/// Between samples \[s\].
const SAMPLE_S: f64 = 20e-6;

/// A run with its phases.
struct Whirl {
    course: Course,
    /// Where each phase begins, and the end \[s\].
    bounds: Bounds,
}

impl Whirl {
    fn of(Run { course, .. }: Run) -> Result<Self> {
        let bounds = phases::find(&course).or_missing("not all nine phases")?;
        Ok(Self { course, bounds })
    }

    /// Samples from one time to before another \[s\].
    fn samples(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = &Sample> {
        (self.course.samples.iter()).filter(move |s| s.t_s >= from_s && s.t_s < to_s)
    }
}

/// A run on the orbit that the unbalance imposes, damping neglected, and then pushed along x with a force.
fn excited(force_n: f64) -> Result<Run> {
    let mut params = footnote_4();
    params.rotor.eccentricity_m = ECCENTRICITY_M;
    let spin_rad_s = SPIN_HZ * TAU;
    let natural = params.rotor.stiffness_n_m / params.rotor.mass_kg;
    let square = spin_rad_s * spin_rad_s;
    let orbit_m = ECCENTRICITY_M * square / (natural - square);
    let start = Start {
        position_m: V2::new(orbit_m, 0.0),
        velocity_m_s: V2::new(0.0, orbit_m * spin_rad_s),
        spin_rad_s,
        spin_phase_rad: 0.0,
    };
    let pulse = Pulse {
        force_n,
        from_s: 0.05,
        until_m: 0.9 * params.contact.clearance_m,
    };
    let mut watch = watch(SAMPLE_S, 0.8, 0.12);
    watch.pulse = Some(pulse);
    Run::of(&params, &start, &watch)
}

/// Smallest force that ends in whirl, as the paper searched it: raised step by step (20 N), here then
/// halved to 1 N.
fn critical_n() -> Result<f64> {
    let free = |force_n: f64| Ok(!excited(force_n)?.whirls());
    first_above((100.0, 120.0), (|n| n + 20.0, LARGEST_N), |_| 1.0, free)
}

/// From the start of the excitation to the largest whirl frequency \[s\].
fn to_maximum_s(course: &Course) -> Result<f64> {
    let ends = course.fastest().zip(course.pulse_s);
    let (fastest, (from_s, _)) = ends.or_missing("no whirl from 40 Hz")?;
    Ok(fastest.t_s - from_s)
}

/// The chapter; every extent computes the same.
pub(super) fn chapter(_: Extent) -> Result<Chapter> {
    let critical_n = critical_n()?;
    let force_n = ABOVE_CRITICAL * critical_n;
    let whirl = Whirl::of(excited(force_n)?)?;
    let strongest = Whirl::of(excited(LARGEST_N)?)?;
    let longest_s = to_maximum_s(&excited(critical_n)?.course)?;
    let rows = rows(&whirl, to_maximum_s(&strongest.course)?, longest_s)?;
    Ok(Chapter {
        title: "The nine phases",
        story: vec![
            format!("Footnote 4 from 40 Hz with what the paper does to start whirl: on the orbit of an unbalance (eccentricity 0.01 mm, assumed) a constant force along x until the rotor is at 90 % of the clearance, raised until it whirls. The smallest force that does is {critical_n:.0} N; shown is 5 % more, {force_n:.0} N, as a test series with steps would find it (assumed; the magnet has 1500 N)."),
            "Phases are found from the run alone, by the criteria in the table; each ends where the next begins. Phase 6: whirl frequency within 5 % of its maximum. Phase 8: the deceleration (over 5 ms) has fallen to a tenth of its steepest. Both limits are choices; the paper has words for them.".to_owned(),
        ],
        rows,
        tables: vec![table(&whirl, &strongest)],
        figures: figures::all(&whirl),
    })
}

fn rows(whirl: &Whirl, shortest_s: f64, longest_s: f64) -> Result<Vec<Row>> {
    const SOURCE: &str = "Results, test at 40 Hz";
    let (course, bounds) = (&whirl.course, &whirl.bounds);
    let from_hz = |from_s: f64| {
        let reading = course.whirl.iter().find(|r| r.t_s >= from_s);
        reading.map(|r| r.backward_hz)
    };
    let lowest_hz = (course.whirl.iter()).rfind(|r| r.t_s < bounds[8]);
    let lowest_hz = lowest_hz.map_or(f64::NAN, |r| r.backward_hz);
    let near = (course.whirl.iter()).filter(|r| r.t_s >= bounds[5] && r.t_s < bounds[6]);
    let turns: f64 = near.map(|r| r.backward_hz * SAMPLE_S).sum();
    let rotor: f64 = (whirl.samples(bounds[5], bounds[6]))
        .map(|s| s.spin_hz * SAMPLE_S)
        .sum();
    let impacts = course
        .contacts
        .iter()
        .filter(|c| c.from_s < bounds[4])
        .count();
    let amplitude_m = |from_s: f64| {
        let sizes = whirl
            .samples(from_s, from_s + 0.03)
            .map(|s| s.position_m.norm());
        sizes.fold(0.0, f64::max)
    };
    let decay = amplitude_m(bounds[9] - 0.03) / amplitude_m(bounds[8]);
    Ok(rows! {
        "Phases found, in order", "", SOURCE, 9.0 => (bounds.len() - 1) as f64, Predicted, "criteria in the table";
        "Whirl frequency at the start of continuous contact", "Hz", SOURCE, 55.0 => from_hz(bounds[4]), Predicted, "first full window of 1 ms";
        "Excitation to maximum", "s", SOURCE, 0.1 => to_maximum_s(course)?, Assumed,
            "hangs on the excitation: {shortest_s:.3} s at 1500 N, {longest_s:.3} s at the smallest that whirls";
        "Whirl turns within 5 % of the maximum", "", SOURCE, Between(3.0, 4.0) => turns, Assumed,
            "paper: three to four revolutions; of the whirl, since the rotor makes only {rotor:.2} meanwhile. Hangs on the 5 %";
        "Impacts before continuous contact", "", SOURCE, Silent => impacts as f64, Predicted,
            "paper: a short series; the inner ring springs back, so that some come in pairs";
        "Whirl frequency where phase 8 begins", "Hz", SOURCE, Silent => from_hz(bounds[7]), Assumed,
            "paper: considerably lower, still rather high; {lowest_hz:.0} Hz where contact is lost";
        "Duration of phase 8", "s", SOURCE, Silent => bounds[8] - bounds[7], Assumed, "paper: a short time; here only μ_r and damping slow the whirl once it rolls";
        "Amplitude at the end of phase 9 over its start", "", SOURCE, Silent => decay, Predicted, "paper: decreasing";
    })
}

fn table(whirl: &Whirl, strongest: &Whirl) -> Table {
    const CRITERIA: [&str; 9] = [
        "start of the run",
        "excitation begins",
        "first touch",
        "first lift-off",
        "touch of the longest contact",
        "whirl frequency within 5 % of its maximum",
        "last time within 5 %",
        "deceleration fallen to a tenth of its steepest",
        "lift-off that ends the longest contact",
    ];
    let bounds = &whirl.bounds;
    let spin_hz = |t_s: f64| whirl.course.at(t_s + 1e-9).map_or(f64::NAN, |s| s.spin_hz);
    table! {
        "The phases";
        for i in 0..NAMES.len();
        "Phase" => "{} {}", i + 1, NAMES[i];
        "Begins with" => "{}", CRITERIA[i];
        "From [ms]" => "{:.2}", 1e3 * bounds[i];
        "To [ms]" => "{:.2}", 1e3 * bounds[i + 1];
        "Spin at its start [Hz]" => "{:.1}", spin_hz(bounds[i]);
        "From, at 1500 N [ms]" => "{:.2}", 1e3 * strongest.bounds[i];
    }
}
