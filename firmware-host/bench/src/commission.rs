//! What a recorded run of commissioning tells of its machine: numbers with intervals, from the motion that a stimulus makes.
//!
//! Through windows over the stimulus go its lines, the motion X and the commands U, as they are held from tick to tick. Least squares of
//! a model over all lines give its numbers: of a mass in one plane, or of a rigid rotor in two. Noise and loads that the loop answers to
//! are in X and U alike and would draw the fit: what lines beside those of the stimulus show of them is subtracted. Intervals are by what
//! becomes of the numbers without each of the windows, as Student's t has it.

mod cost;
mod fit;
pub mod log;
mod machine;
mod one_plane;
mod orbit;
pub mod record;
mod spectrum;
pub mod two_planes;
pub mod walk;

use crate::commission::cost::Cost;
use crate::commission::fit::Model;
use crate::commission::log::Log;
use crate::commission::one_plane::OnePlane;
use crate::commission::spectrum::{LEAST_TICKS, Line, Window, lines, quiet, windows};
use crate::commission::two_planes::TwoPlanes;
use crate::log_file::LogError;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use std::f64::consts::TAU;

/// A number of the machine, between what it lies with 95 % probability, and what it rests on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// As the supervisor's parameter, or as what it is of; of a plane of a rotor behind its name and a dot.
    pub name: String,
    /// Unit; "1" of a plain number.
    pub unit: &'static str,
    pub value: f64,
    pub low: f64,
    pub high: f64,
    /// What it rests on.
    pub from: String,
}

/// What could not be found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Missing {
    pub name: String,
    /// Why, and which motion would show it.
    pub reason: String,
}

/// A number that is configured otherwise.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contradiction {
    pub name: String,
    pub configured: f64,
    pub low: f64,
    pub high: f64,
    /// Share of blows that are lost by it; null where nobody has measured that.
    pub lost_share: Option<f64>,
    /// What it costs, in words.
    pub costs: String,
}

/// How a plane answers to the stimulus along an axis, and what the fit makes of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Axis, and of which plane, where there are two.
    pub name: String,
    pub points: Vec<AnswerPoint>,
}

/// At a frequency of the stimulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnswerPoint {
    pub frequency_hz: f64,
    /// Amplitude of the motion as it is read \[m\], as the fit makes it of forces, and of what is left between them.
    pub read_m: f64,
    pub fitted_m: f64,
    pub left_m: f64,
}

/// What a log tells.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Commissioned {
    pub parameters: Vec<Found>,
    pub not_found: Vec<Missing>,
    pub contradictions: Vec<Contradiction>,
    /// For drawings.
    #[serde(skip)]
    pub answers: Vec<Answer>,
}

/// Numbers that no levitated rotor shows.
const OF_CONTACT: [&str; 3] = [
    "friction_coefficient",
    "restitution",
    "contact_stiffness_n_m",
];

impl Commissioned {
    /// What a log of one plane tells.
    ///
    /// # Errors
    /// [`LogError`] where nothing can be found.
    pub fn of(log: &Log) -> Result<Self, LogError> {
        let logs = std::slice::from_ref(log);
        let windows = windows(logs);
        enough(&windows, 1, one_plane::LEAST_WINDOWS)?;
        let (fit, lines) = one_plane::fitted(&lines(logs, &windows), log.period_s)?;
        let mut found = Self::default();
        one_plane::say(&fit, &mut found);
        found.of_noise("", &log.position_m);
        found.of_spin(log, quiet(log.stimulus_n.len(), &windows));
        found.of_contact();
        found.answers = answers(&OnePlane, (&lines, &fit.values), &["".to_owned()]);
        Ok(found)
    }

    /// What logs of both planes of a rotor tell, row by row of the same time.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn of_rotor(logs: &[Log; 2], machine: &TwoPlanes) -> Result<Self, LogError> {
        let windows = windows(logs);
        enough(&windows, 2, two_planes::LEAST_WINDOWS)?;
        let [first, _] = logs;
        let lines = lines(logs, &windows);
        let fitted = two_planes::fitted(&lines, first.period_s, machine)?;
        let mut found = Self::default();
        fitted.say(machine, &mut found);
        for (name, log) in machine.names.iter().zip(logs) {
            found.of_noise(&format!("{name}."), &log.position_m);
        }
        found.of_spin(first, quiet(first.stimulus_n.len(), &windows));
        found.of_contact();
        let names = machine.names.each_ref().map(|name| format!("{name}, "));
        let of = (&fitted.lines[..], &fitted.fit.values[..]);
        found.answers = answers(&fitted.model, of, &names);
        Ok(found)
    }

    /// Compares with what is configured, of each the name and its value: what costs most comes first. Intervals are as much wider as
    /// they have to be for all of what is right together to lie in its own with 95 % probability.
    pub fn compare(&mut self, configured: &[(String, f64)]) {
        let pairs = self.parameters.iter().filter_map(|found| {
            let own = configured.iter().find(|(name, _)| *name == found.name);
            own.map(|(_, value)| (found, *value))
        });
        let pairs: Vec<(&Found, f64)> = pairs.collect();
        let wider = wider(pairs.len());
        let mut ordered = Vec::new();
        for (found, value) in pairs {
            let below = found.value - wider * (found.value - found.low);
            let above = found.value + wider * (found.high - found.value);
            if (below..=above).contains(&value) {
                continue;
            }
            let cost = Cost::of(&found.name, value, found.value);
            let nearest = value.clamp(found.low, found.high);
            let off = (value - nearest).abs() / nearest.abs().max(1e-12);
            let one = Contradiction {
                name: found.name.clone(),
                configured: value,
                low: found.low,
                high: found.high,
                lost_share: cost.map(|cost| cost.lost),
                costs: Cost::text(cost),
            };
            let (lost, force) = Cost::order(cost);
            ordered.push(([lost, force, off], one));
        }
        ordered.sort_by(|([a, b, c], _), ([d, e, f], _)| {
            (d.total_cmp(a)).then(e.total_cmp(b)).then(f.total_cmp(c))
        });
        let ordered = ordered.into_iter().map(|(_, one)| one);
        self.contradictions = ordered.collect();
    }

    fn of_contact(&mut self) {
        for name in OF_CONTACT {
            let reason =
                "shows in contact alone: give the record of a touch-down for the first two";
            self.miss(name, reason);
        }
    }
}

/// Degrees of freedom of a usual log.
const DEGREES: f64 = 8.0;

/// By how much an interval of one number in 95 % is wider for so many together.
fn wider(numbers: usize) -> f64 {
    let Ok(student) = StudentsT::new(0.0, 1.0, DEGREES) else {
        return 1.0;
    };
    let of = |numbers: f64| student.inverse_cdf(1.0 - 0.025 / numbers);
    of(numbers.max(1) as f64) / of(1.0)
}

/// Whether each plane is excited often enough.
fn enough(windows: &[Window], planes: usize, least: usize) -> Result<(), LogError> {
    for plane in 0..planes {
        let number = windows.iter().filter(|w| w.plane == plane).count();
        if number < least {
            let of = match planes {
                1 => String::new(),
                _ => format!(" of plane {plane}"),
            };
            return Err(LogError::new(
                format!(
                    "a stimulus{of} in {number} windows of {LEAST_TICKS} ticks and more, {least} at least are needed"
                ),
                "record the check of the supervisor from its beginning to its end, with stimulus_x_n and stimulus_y_n",
            ));
        }
    }
    Ok(())
}

/// Along each axis of each plane what is read there, and what the fit makes of forces.
fn answers(
    model: &impl Model,
    (lines, values): (&[Line], &[f64]),
    names: &[String],
) -> Vec<Answer> {
    let mut all = Vec::new();
    for (plane, name) in names.iter().enumerate() {
        for (axis, of) in ["x", "y"].into_iter().enumerate() {
            let own = |l: &&Line| l.weight > 0.0 && l.plane == plane && l.axis == axis;
            let point = |line: &Line| {
                let read = line.position_m[plane][axis];
                let left = model.residuals_m(line, values)[2 * plane + axis];
                AnswerPoint {
                    frequency_hz: line.omega_rad_s / TAU,
                    read_m: read.norm(),
                    // What is left is an acceleration over −ω².
                    fitted_m: (read + left).norm(),
                    left_m: left.norm(),
                }
            };
            let mut points: Vec<AnswerPoint> = lines.iter().filter(own).map(point).collect();
            points.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
            let name = format!("{name}{of}");
            all.push(Answer { name, points });
        }
    }
    all
}
