//! Whirl, slip and the speeds of the surfaces over time; whirl and force over the race's inertia.

use super::super::{Axis, Chart, Curve, Drawing, Figure, Mark};
use super::runs::most_whirl_m_s;
use super::{SPIN_HZ, Tried};
use std::f64::consts::TAU;

/// Time shown \[ms\].
const SHOWN_MS: f64 = 60.0;
/// Races drawn over time \[kg m²\].
const DRAWN_KG_M2: [Option<f64>; 4] = [None, Some(1e-2), Some(3e-3), Some(1e-3)];

/// A figure's file, caption and label.
type Words = (&'static str, &'static str, &'static str);

fn chart((file, caption, label): Words, (x, y): (Axis, Axis), curves: Vec<Curve>) -> Figure {
    Figure {
        file,
        caption: caption.to_owned(),
        drawing: Drawing::Chart(Chart {
            label: label.to_owned(),
            x,
            y,
            curves,
        }),
    }
}

/// Highest of what is shown of some curves, with room above.
fn top(curves: &[Curve]) -> f64 {
    let values = curves.iter().flat_map(|c| &c.points).map(|p| p.1);
    1.05 * values.filter(|y| y.is_finite()).fold(0.0, f64::max)
}

fn over_time(all: &[Tried], points: impl Fn(&Tried) -> Vec<(f64, f64)>) -> Vec<Curve> {
    (DRAWN_KG_M2.iter().enumerate())
        .filter_map(|(colour, inertia)| {
            let tried = all.iter().find(|t| t.inertia_kg_m2 == *inertia)?;
            let name = match inertia {
                None => "bushing".to_owned(),
                Some(inertia) => format!("race of {inertia:.0e} kg m²"),
            };
            Some(Curve::line(name, points(tried), colour))
        })
        .collect()
}

/// All of the chapter.
pub(super) fn all(all: &[Tried]) -> Vec<Figure> {
    let time = || Axis::linear("Time [ms]", (0.0, SHOWN_MS));
    let shown = |t_s: f64| 1e3 * t_s <= SHOWN_MS;
    let whirl = over_time(all, |t| {
        let readings = t.run.course.whirl.iter().filter(|r| shown(r.t_s));
        readings.map(|r| (1e3 * r.t_s, r.backward_hz)).collect()
    });
    let slip = over_time(all, |t| {
        let samples = t.run.course.samples.iter().filter(|s| shown(s.t_s));
        samples.map(|s| (1e3 * s.t_s, s.sliding_m_s)).collect()
    });
    let (highest_hz, highest_m_s) = (top(&whirl), top(&slip));
    let mut figures = vec![
        chart(
            (
                "retainer-whirl-over-time",
                "Whirl frequency (1 ms mean) from the same impact. The lighter the race, the slower the whirl at which slip ends; what follows is rolling, braked by μ_r.",
                "Whirl frequency over time by retainer bearing",
            ),
            (
                time(),
                Axis::linear("Whirl frequency [Hz]", (0.0, highest_hz)),
            ),
            whirl,
        ),
        chart(
            (
                "retainer-slip-over-time",
                "Sliding speed in contact. A bushing keeps slipping until the rotor's spin is used up.",
                "Sliding speed over time by retainer bearing",
            ),
            (
                time(),
                Axis::linear("Sliding speed [m/s]", (0.0, highest_m_s)),
            ),
            slip,
        ),
    ];
    figures.extend(surfaces(all, time()));
    figures.push(over_inertia(all));
    figures
}

/// Speeds of rotor's surface, race and whirl for one race.
fn surfaces(all: &[Tried], time: Axis) -> Option<Figure> {
    let tried = all.iter().find(|t| t.inertia_kg_m2 == Some(3e-3))?;
    let samples = &tried.run.course.samples;
    let bore = tried.params.bore_radius_m();
    let radius = tried.params.rotor.contact_radius_m;
    let of = |speed: &dyn Fn(&plant_model::analysis::course::Sample) -> f64| {
        (samples.iter().filter(|s| 1e3 * s.t_s <= SHOWN_MS))
            .map(|s| (1e3 * s.t_s, speed(s)))
            .collect::<Vec<_>>()
    };
    let touching = |s: &plant_model::analysis::course::Sample| s.mode.in_contact();
    let curves = vec![
        Curve::line(
            "rotor's surface R·Ω".to_owned(),
            of(&|s| radius * TAU * s.spin_hz),
            0,
        ),
        Curve::line(
            "race R_i·Ω_i".to_owned(),
            of(&|s| bore * TAU * s.race_spin_hz),
            1,
        ),
        Curve::line(
            "backward whirl, in contact".to_owned(),
            of(&|s| {
                if touching(s) {
                    s.backward_m_s
                } else {
                    f64::NAN
                }
            }),
            2,
        ),
    ];
    let highest = top(&curves);
    Some(chart(
        (
            "retainer-surfaces",
            "Race of 3e-3 kg m²: sliding ends where the rotor's surface is as fast as race and whirl together.",
            "Speeds of the surfaces and of the whirl over time",
        ),
        (time, Axis::linear("Speed [m/s]", (0.0, highest))),
        curves,
    ))
}

fn over_inertia(all: &[Tried]) -> Figure {
    let of = |value: &dyn Fn(&Tried) -> f64| {
        let mut points: Vec<(f64, f64)> = (all.iter())
            .filter_map(|t| Some((t.inertia_kg_m2?, value(t))))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let bushing = (all.iter().find(|t| t.inertia_kg_m2.is_none()))
        .and_then(|t| t.run.fastest_hz)
        .unwrap_or(f64::NAN);
    let bound = |t: &Tried| {
        let hz = most_whirl_m_s(&t.params, SPIN_HZ) / t.params.contact.clearance_m / TAU;
        if hz < 2000.0 { hz } else { f64::NAN }
    };
    let curve = |name: &str, points, mark, colour| Curve {
        name: name.to_owned(),
        points,
        mark,
        colour,
    };
    chart(
        (
            "retainer-over-inertia",
            "Fastest whirl over the race's inertia: the bound where it is low, the stator's limit where it is not.",
            "Fastest whirl over the inertia of the race",
        ),
        (
            Axis::log("Inertia of the race [kg m²]", (1e-4, 1e-1)),
            Axis::log("Fastest whirl [Hz]", (10.0, 2000.0)),
        ),
        vec![
            curve(
                "runs",
                of(&|t| t.run.fastest_hz.unwrap_or(f64::NAN)),
                Mark::Dots,
                0,
            ),
            curve("bound by the race", of(&bound), Mark::Dashed, 1),
            curve(
                "bushing",
                vec![(1e-4, bushing), (1e-1, bushing)],
                Mark::Dashed,
                2,
            ),
        ],
    )
}
