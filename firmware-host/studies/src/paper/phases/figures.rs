//! Drawings of the chapter: five quantities over time and the orbit, with the phases.

use super::Whirl;
use crate::paper::data::*;
use plant_model::analysis::course::Sample;
use plant_model::analysis::phases::NAMES;

/// Points a curve has at most.
const POINTS: usize = 1200;
/// Of the phases 1 to 9, none like the clearance.
const PHASE_COLOURS: [usize; 9] = [0, 1, 2, 3, 4, 8, 7, 6, 2];

/// All of them. Later phases would cover earlier ones in an orbit: large orbits first.
pub(super) fn all(whirl: &Whirl) -> Vec<Figure> {
    let (readings, names) = (&whirl.course.whirl, names());
    let step = readings.len().div_ceil(POINTS).max(1);
    let whirl_hz = (readings.iter().step_by(step)).map(|r| (1e3 * r.t_s, r.backward_hz));
    let time = || Axis::linear("Time [ms]", (0.0, 1e3 * whirl.bounds[9]));
    let over = |name: &str, top: f64, points: Vec<(f64, f64)>| {
        let mut curves = phases(whirl, (0.0, top));
        curves.extend(curves! { "{name}", Line, 0 => points; });
        curves
    };
    let largest = |of: fn(&Sample) -> f64| largest(&whirl.course.samples, of);
    let mut x = curves! { "x displacement", Line, 0 => envelope(&whirl.course.samples); };
    x.extend(phases(whirl, (-600.0, 600.0)));
    vec![
        chart! {
            "phases_whirl", "Whirl frequency [Hz] over time", "Whirl frequency while in contact for at least 1 ms. {names}";
            time(), Axis::linear("Whirl frequency [Hz]", (0.0, 800.0));
            over("Whirl frequency [Hz]", 800.0, whirl_hz.collect())
        },
        chart! {
            "phases_sliding", "Sliding speed [m/s] over time", "Sliding speed in contact. It falls to zero at the maximum: from there the rotor rolls. {names}";
            time(), Axis::linear("Sliding speed [m/s]", (0.0, 28.0));
            over("Sliding speed [m/s]", 28.0, largest(|s| s.sliding_m_s))
        },
        chart! {
            "phases_force", "Normal force [kN] over time", "Normal force (largest of each stretch drawn as one point). {names}";
            time(), Axis::linear("Normal force [kN]", (0.0, 110.0));
            over("Normal force [kN]", 110.0, largest(|s| 1e-3 * s.normal_force_n))
        },
        chart! {
            "phases_spin", "Spin [Hz] over time", "Spin (Fig. 6, upper part). {names}";
            time(), Axis::linear("Spin [Hz]", (0.0, 45.0));
            over("Spin [Hz]", 45.0, largest(|s| s.spin_hz))
        },
        chart! {
            "phases_displacement", "Displacement along x over time", "Displacement of the rotor along x (Fig. 6, lower part). {names}";
            time(), Axis::linear("x [µm]", (-600.0, 600.0));
            x
        },
        chart! {
            "phases_orbit", "Orbit of the rotor from the first impact on", "Orbit of the rotor from the first impact on (Fig. 5); of each phase the first 60 ms.";
            across(520.0), Axis::linear("y [µm]", (-520.0, 520.0));
            orbit(whirl, &[5, 6, 4, 7, 8, 3, 2])
        },
        chart! {
            "phases_orbit_begin", "Orbit of the rotor up to the whirl", "Orbit of the rotor up to the whirl (Fig. 5); of each phase the first 60 ms.";
            across(260.0), Axis::linear("y [µm]", (-260.0, 260.0));
            orbit(whirl, &[8, 3, 2, 1, 0])
        },
    ]
}

/// The numbers of the phases with their names.
fn names() -> String {
    let names = (1..).zip(NAMES).map(|(i, name)| format!("{i} {name}"));
    format!("Phases: {}.", names.collect::<Vec<_>>().join(", "))
}

/// As wide against high as the drawing area: circles stay round.
fn across(half_height_um: f64) -> Axis {
    let half_width_um = 1.823 * half_height_um;
    Axis::linear("x [µm]", (-half_width_um, half_width_um))
}

/// The largest of each stretch; not finite where all are.
fn largest(samples: &[Sample], quantity: fn(&Sample) -> f64) -> Vec<(f64, f64)> {
    let size = samples.len().div_ceil(POINTS).max(1);
    let value = |chunk: &[Sample]| chunk.iter().map(quantity).fold(f64::NAN, f64::max);
    (samples.chunks(size))
        .map(|chunk| (1e3 * chunk[0].t_s, value(chunk)))
        .collect()
}

/// Smallest and largest displacement along x \[µm\] of each stretch, so that the envelope of the whirl is seen.
fn envelope(samples: &[Sample]) -> Vec<(f64, f64)> {
    let size = samples.len().div_ceil(POINTS).max(1);
    let order = |a: &&Sample, b: &&Sample| a.position_m.x.total_cmp(&b.position_m.x);
    let ends = samples.chunks(size).flat_map(|chunk| {
        let ends = [chunk.iter().min_by(order), chunk.iter().max_by(order)];
        let mut ends: Vec<&Sample> = ends.into_iter().flatten().collect();
        ends.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        ends
    });
    ends.map(|s| (1e3 * s.t_s, 1e6 * s.position_m.x)).collect()
}

/// Vertical lines where the phases 2 to 9 begin, and the number of each phase at the top, those of phases too
/// short for a number of their own together.
fn phases(whirl: &Whirl, (low, high): (f64, f64)) -> Vec<Curve> {
    let ms = |i: usize| 1e3 * whirl.bounds[i];
    let lines = (1..9).flat_map(|i| [(ms(i), low), (ms(i), high), (f64::NAN, f64::NAN)]);
    let mut curves = curves! { "a phase begins", Dashed, 5 => lines.collect(); };
    let closest_ms = 0.02 * (ms(9) - ms(0));
    let height = low + 0.95 * (high - low);
    for i in 0..9 {
        let middle = 0.5 * (ms(i) + ms(i + 1));
        match curves.last_mut().filter(|last| last.mark == Mark::Name) {
            Some(last) if middle - last.points[0].0 < closest_ms => {
                last.name += &format!(",{}", i + 1);
            }
            _ => {
                let number = (i + 1).to_string();
                curves.push(curve(number, Mark::Name, 3, vec![(middle, height)]));
            }
        }
    }
    curves
}

/// Long phases are shown by their first turns, and with every tenth sample.
fn orbit(whirl: &Whirl, order: &[usize]) -> Vec<Curve> {
    const LONGEST_S: f64 = 0.06;
    let phase = |i: usize| {
        let (from, to) = (whirl.bounds[i], whirl.bounds[i + 1]);
        let shown = (whirl.course.samples.iter())
            .filter(|s| s.t_s >= from && s.t_s <= to.min(from + LONGEST_S));
        let step = if [0, 3, 8].contains(&i) { 10 } else { 2 };
        let points = shown
            .step_by(step)
            .map(|s| (1e6 * s.position_m.x, 1e6 * s.position_m.y));
        let name = format!("{} {}", i + 1, NAMES[i]);
        curve(name, Mark::Line, PHASE_COLOURS[i], points.collect())
    };
    let mut curves: Vec<Curve> = order.iter().map(|i| phase(*i)).collect();
    let angles = (0..=120).map(|i| f64::from(i) * TAU / 120.0);
    let clearance = angles.map(|angle| (200.0 * angle.cos(), 200.0 * angle.sin()));
    curves.extend(curves! { "clearance", Dashed, 5 => clearance.collect(); });
    curves
}
