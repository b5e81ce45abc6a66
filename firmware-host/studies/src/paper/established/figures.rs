//! Drawings of the chapter.

use super::SpinDowns;
use super::rig::Violence;
use crate::paper::{Axis, Chart, Curve, Drawing, Figure, Mark};
use plant_model::analysis::course::Course;

pub(in crate::paper) fn axis(name: &str, range: (f64, f64)) -> Axis {
    Axis {
        name: name.to_owned(),
        range,
        log: false,
    }
}

pub(in crate::paper) fn curve(
    name: &str,
    points: Vec<(f64, f64)>,
    mark: Mark,
    colour: usize,
) -> Curve {
    Curve {
        name: name.to_owned(),
        points,
        mark,
        colour,
    }
}

pub(in crate::paper) fn figure(file: &'static str, caption: &str, chart: Chart) -> Figure {
    Figure {
        file,
        caption: caption.to_owned(),
        drawing: Drawing::Chart(chart),
    }
}

fn over_spin(of: &[Violence], quantity: impl Fn(&Violence) -> f64) -> Vec<(f64, f64)> {
    of.iter().map(|v| (v.spin_hz, quantity(v))).collect()
}

const SPIN: &str = "Spin at the start [Hz]";
const SPIN_RANGE: (f64, f64) = (0.0, 170.0);

/// Fig. 7.
pub(super) fn whirl_over_spin(runs: &SpinDowns, limit_hz: f64) -> Figure {
    let whirl = |of: &[Violence]| over_spin(of, |v| v.whirl_hz);
    figure(
        "established_whirl",
        "Maximum whirl frequency over the spin at the start (Fig. 7). Crosses: the paper's tests where its text \
         gives a number. Dashed: the maximum of its own simulation, and the upper whirl limit by Black's condition.",
        Chart {
            label: "Maximum whirl frequency over spin".to_owned(),
            x: axis(SPIN, SPIN_RANGE),
            y: axis("Maximum whirl frequency [Hz]", (0.0, 800.0)),
            curves: vec![
                curve("isotropic stator", whirl(&runs.isotropic), Mark::Line, 0),
                curve("±10 % anisotropy", whirl(&runs.anisotropic), Mark::Line, 1),
                curve(
                    "Black's upper limit",
                    vec![(0.0, limit_hz), (170.0, limit_hz)],
                    Mark::Dashed,
                    2,
                ),
                curve(
                    "paper, simulated",
                    vec![(0.0, 660.0), (170.0, 660.0)],
                    Mark::Dashed,
                    5,
                ),
                curve(
                    "paper, measured",
                    vec![(40.0, 530.0), (166.0, 400.0)],
                    Mark::Crosses,
                    3,
                ),
            ],
        },
    )
}

pub(super) fn force_over_spin(runs: &SpinDowns) -> Figure {
    let force = |of: &[Violence]| over_spin(of, |v| 1e-3 * v.force_n);
    figure(
        "established_force",
        "Peak normal force over the spin at the start.",
        Chart {
            label: "Peak normal force over spin".to_owned(),
            x: axis(SPIN, SPIN_RANGE),
            y: axis("Peak normal force [kN]", (0.0, 150.0)),
            curves: vec![
                curve("isotropic stator", force(&runs.isotropic), Mark::Line, 0),
                curve("±10 % anisotropy", force(&runs.anisotropic), Mark::Line, 1),
            ],
        },
    )
}

pub(super) fn torque_over_spin(runs: &SpinDowns) -> Figure {
    let torque = |of: &[Violence]| over_spin(of, |v| 1e-3 * v.torque_n_m);
    figure(
        "established_torque",
        "Peak friction torque over the spin at the start: μ·R of the force, 15 N m a kilonewton.",
        Chart {
            label: "Peak friction torque over spin".to_owned(),
            x: axis(SPIN, SPIN_RANGE),
            y: axis("Peak friction torque [kN m]", (0.0, 2.25)),
            curves: vec![
                curve("isotropic stator", torque(&runs.isotropic), Mark::Line, 0),
                curve("±10 % anisotropy", torque(&runs.anisotropic), Mark::Line, 1),
            ],
        },
    )
}

pub(super) fn displacement_over_spin(runs: &SpinDowns) -> Figure {
    let of = |i: usize| over_spin(&runs.isotropic, |v| 1e3 * v.displacement_m[i]);
    figure(
        "established_displacement",
        "Largest displacements, isotropic stator. Dashed: the paper's bound on the outer ring.",
        Chart {
            label: "Displacements over spin".to_owned(),
            x: axis(SPIN, SPIN_RANGE),
            y: axis("Displacement [mm]", (0.0, 0.6)),
            curves: vec![
                curve("rotor", of(0), Mark::Line, 0),
                curve("inner ring", of(1), Mark::Line, 2),
                curve("outer ring", of(2), Mark::Line, 1),
                curve(
                    "paper, outer ring",
                    vec![(0.0, 0.05), (170.0, 0.05)],
                    Mark::Dashed,
                    3,
                ),
            ],
        },
    )
}

/// The test at 166 Hz over time.
pub(super) fn fast_test(course: &Course) -> Figure {
    let end_s = course.samples.last().map_or(1.0, |s| s.t_s);
    let step = (course.whirl.len() / 600).max(1);
    let whirl = (course.whirl.iter().step_by(step))
        .map(|r| (r.t_s, r.backward_hz))
        .collect();
    let step = (course.samples.len() / 600).max(1);
    let spin = (course.samples.iter().step_by(step))
        .map(|s| (s.t_s, s.spin_hz))
        .collect();
    figure(
        "established_166_hz",
        "Whirl from 166 Hz with friction that falls with sliding speed. Dashed: the paper's about 400 Hz.",
        Chart {
            label: "Whirl frequency and spin over time from 166 Hz".to_owned(),
            x: axis("Time [s]", (0.0, end_s)),
            y: axis("Frequency [Hz]", (0.0, 800.0)),
            curves: vec![
                curve("whirl", whirl, Mark::Line, 0),
                curve("spin", spin, Mark::Line, 1),
                curve(
                    "paper, whirl",
                    vec![(0.0, 400.0), (end_s, 400.0)],
                    Mark::Dashed,
                    3,
                ),
            ],
        },
    )
}
