//! Drawings of the chapter: four quantities over time and the orbit, with the phases.

use super::Whirl;
use crate::paper::established::figures::{axis, curve, figure};
use crate::paper::{Chart, Curve, Figure, Mark};
use plant_model::analysis::course::Sample;
use plant_model::analysis::phases::NAMES;

/// Points a curve has at most.
const POINTS: usize = 1200;
/// Of the phases 1 to 9, none like the clearance.
const PHASE_COLOURS: [usize; 9] = [0, 1, 2, 3, 4, 8, 7, 6, 2];

/// All of them.
pub(super) fn all(whirl: &Whirl) -> Vec<Figure> {
    let whirl_hz = {
        let of = &whirl.course.whirl;
        let step = of.len().div_ceil(POINTS).max(1);
        (of.iter().step_by(step)).map(|r| (1e3 * r.t_s, r.backward_hz))
    };
    let samples = |quantity: fn(&Sample) -> f64| peaks(&whirl.course.samples, quantity);
    vec![
        over_time(
            whirl,
            ("phases_whirl", "Whirl frequency [Hz]", 800.0),
            "Whirl frequency while in contact for at least 1 ms.",
            whirl_hz.collect(),
        ),
        over_time(
            whirl,
            ("phases_sliding", "Sliding speed [m/s]", 28.0),
            "Sliding speed in contact. It falls to zero at the maximum: from there the rotor rolls.",
            samples(|s| s.sliding_m_s),
        ),
        over_time(
            whirl,
            ("phases_force", "Normal force [kN]", 110.0),
            "Normal force (largest of each stretch drawn as one point).",
            samples(|s| 1e-3 * s.normal_force_n),
        ),
        over_time(
            whirl,
            ("phases_spin", "Spin [Hz]", 45.0),
            "Spin (Fig. 6, upper part).",
            samples(|s| s.spin_hz),
        ),
        displacement(whirl),
        orbit(
            whirl,
            (
                "phases_orbit",
                "Orbit of the rotor from the first impact on",
                520.0,
            ),
            // Later phases would cover earlier ones: large orbits first.
            &[5, 6, 4, 7, 8, 3, 2],
        ),
        orbit(
            whirl,
            (
                "phases_orbit_begin",
                "Orbit of the rotor up to the whirl",
                260.0,
            ),
            &[8, 3, 2, 1, 0],
        ),
    ]
}

/// The largest of each stretch; not finite where all are.
fn peaks(samples: &[Sample], quantity: fn(&Sample) -> f64) -> Vec<(f64, f64)> {
    let size = samples.len().div_ceil(POINTS).max(1);
    (samples.chunks(size))
        .filter_map(|chunk| {
            let value = chunk.iter().map(quantity).fold(f64::NAN, f64::max);
            chunk.first().map(|s| (1e3 * s.t_s, value))
        })
        .collect()
}

/// Vertical lines where the phases 2 to 9 begin, and the number of each phase at the top, those of phases too
/// short for a number of their own together.
fn phases(whirl: &Whirl, (low, high): (f64, f64)) -> Vec<Curve> {
    let ms = |i: usize| 1e3 * whirl.bounds[i];
    let lines = (1..9).flat_map(|i| [(ms(i), low), (ms(i), high), (f64::NAN, f64::NAN)]);
    let mut curves = vec![curve("a phase begins", lines.collect(), Mark::Dashed, 5)];
    let closest_ms = 0.02 * (ms(9) - ms(0));
    let mut labels: Vec<(f64, String)> = Vec::new();
    for i in 0..9 {
        let middle = 0.5 * (ms(i) + ms(i + 1));
        match labels.last_mut() {
            Some((at, name)) if middle - *at < closest_ms => *name += &format!(",{}", i + 1),
            _ => labels.push((middle, (i + 1).to_string())),
        }
    }
    let height = low + 0.95 * (high - low);
    curves
        .extend((labels.iter()).map(|(at, name)| curve(name, vec![(*at, height)], Mark::Name, 3)));
    curves
}

/// The numbers with their names.
fn names() -> String {
    let names: Vec<String> = (NAMES.iter().enumerate())
        .map(|(i, name)| format!("{} {name}", i + 1))
        .collect();
    format!("Phases: {}.", names.join(", "))
}

fn over_time(
    whirl: &Whirl,
    (file, name, largest): (&'static str, &str, f64),
    caption: &str,
    points: Vec<(f64, f64)>,
) -> Figure {
    let mut curves = phases(whirl, (0.0, largest));
    curves.push(curve(name, points, Mark::Line, 0));
    figure(
        file,
        &format!("{caption} {}", names()),
        Chart {
            label: format!("{name} over time"),
            x: axis("Time [ms]", (0.0, 1e3 * whirl.bounds[9])),
            y: axis(name, (0.0, largest)),
            curves,
        },
    )
}

fn displacement(whirl: &Whirl) -> Figure {
    let samples = &whirl.course.samples;
    // Smallest and largest of each stretch, so that the envelope of the whirl is seen.
    let size = samples.len().div_ceil(POINTS).max(1);
    let mut points = Vec::new();
    for chunk in samples.chunks(size) {
        let x = |s: &&Sample| 1e6 * s.position_m.x;
        let order = |a: &&Sample, b: &&Sample| x(a).total_cmp(&x(b));
        let ends = [chunk.iter().min_by(order), chunk.iter().max_by(order)];
        let mut ends: Vec<&Sample> = ends.into_iter().flatten().collect();
        ends.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        points.extend(ends.iter().map(|s| (1e3 * s.t_s, x(s))));
    }
    let mut curves = vec![curve("x displacement", points, Mark::Line, 0)];
    curves.extend(phases(whirl, (-600.0, 600.0)));
    figure(
        "phases_displacement",
        &format!(
            "Displacement of the rotor along x (Fig. 6, lower part). {}",
            names()
        ),
        Chart {
            label: "Displacement along x over time".to_owned(),
            x: axis("Time [ms]", (0.0, 1e3 * whirl.bounds[9])),
            y: axis("x [µm]", (-600.0, 600.0)),
            curves,
        },
    )
}

fn orbit(
    whirl: &Whirl,
    (file, label, half_height_um): (&'static str, &str, f64),
    order: &[usize],
) -> Figure {
    // Long phases are shown by their first turns.
    const LONGEST_S: f64 = 0.06;
    let mut curves: Vec<Curve> = order
        .iter()
        .map(|&i| {
            let (from, to) = (whirl.bounds[i], whirl.bounds[i + 1]);
            let shown = (whirl.course.samples.iter())
                .filter(|s| s.t_s >= from && s.t_s <= to.min(from + LONGEST_S));
            let step = if i == 0 || i == 3 || i == 8 { 10 } else { 2 };
            let points = shown
                .step_by(step)
                .map(|s| (1e6 * s.position_m.x, 1e6 * s.position_m.y))
                .collect();
            let name = format!("{} {}", i + 1, NAMES[i]);
            curve(&name, points, Mark::Line, PHASE_COLOURS[i])
        })
        .collect();
    let clearance = (0..=120)
        .map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 120.0;
            (200.0 * angle.cos(), 200.0 * angle.sin())
        })
        .collect();
    curves.push(curve("clearance", clearance, Mark::Dashed, 5));
    // As wide against high as the drawing area: circles stay round.
    let half_width_um = 1.823 * half_height_um;
    figure(
        file,
        &format!("{label} (Fig. 5); of each phase the first 60 ms."),
        Chart {
            label: label.to_owned(),
            x: axis("x [µm]", (-half_width_um, half_width_um)),
            y: axis("y [µm]", (-half_height_um, half_height_um)),
            curves,
        },
    )
}
