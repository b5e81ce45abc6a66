//! Whirl, slip and the speeds of the surfaces over time; whirl over the race's inertia.

use super::Tried;
use crate::paper::data::*;
use plant_model::analysis::course::Sample;

/// Time shown \[ms\].
const SHOWN_MS: f64 = 60.0;
/// Races drawn over time \[kg m²\].
const DRAWN_KG_M2: [Option<f64>; 4] = [None, Some(1e-2), Some(3e-3), Some(1e-3)];

fn over_time(all: &[Tried], points: impl Fn(&Tried) -> Vec<(f64, f64)>) -> Vec<Curve> {
    let curve = |(colour, inertia): (usize, &Option<f64>)| {
        let tried = all.iter().find(|t| t.inertia_kg_m2 == *inertia)?;
        let name = match inertia {
            None => "bushing".to_owned(),
            Some(inertia) => format!("race of {inertia:.0e} kg m²"),
        };
        Some(curve(name, Mark::Line, colour, points(tried)))
    };
    DRAWN_KG_M2.iter().enumerate().filter_map(curve).collect()
}

/// Something of every sample shown.
fn samples(tried: &Tried, value: impl Fn(&Sample) -> f64) -> Vec<(f64, f64)> {
    let points = tried.course.samples.iter().map(|s| (1e3 * s.t_s, value(s)));
    points.filter(|(ms, _)| *ms <= SHOWN_MS).collect()
}

/// An axis as high as the highest of some curves, with room above.
fn high_as(name: &str, curves: &[Curve]) -> Axis {
    Axis::linear(name, (0.0, 1.05 * highest(curves)))
}

/// All of the chapter.
pub(super) fn all(all: &[Tried]) -> Vec<Figure> {
    let time = || Axis::linear("Time [ms]", (0.0, SHOWN_MS));
    let whirl = over_time(all, |t| {
        let points = t.course.whirl.iter().map(|r| (1e3 * r.t_s, r.backward_hz));
        points.filter(|(ms, _)| *ms <= SHOWN_MS).collect()
    });
    let slip = over_time(all, |t| samples(t, |s| s.sliding_m_s));
    let surfaces = all
        .iter()
        .find(|t| t.inertia_kg_m2 == Some(3e-3))
        .map(surfaces);
    let mut figures = vec![
        chart! {
            "retainer-whirl-over-time", "Whirl frequency over time by retainer bearing",
            "Whirl frequency (1 ms mean) from the same impact. The lighter the race, the slower the whirl at which slip ends; what follows is rolling, braked by μ_r.";
            time(), high_as("Whirl frequency [Hz]", &whirl);
            whirl
        },
        chart! {
            "retainer-slip-over-time", "Sliding speed over time by retainer bearing",
            "Sliding speed in contact. A bushing keeps slipping until the rotor's spin is used up.";
            time(), high_as("Sliding speed [m/s]", &slip);
            slip
        },
    ];
    figures.extend(surfaces.map(|curves| chart! {
        "retainer-surfaces", "Speeds of the surfaces and of the whirl over time",
        "Race of 3e-3 kg m²: sliding ends where the rotor's surface is as fast as race and whirl together.";
        time(), high_as("Speed [m/s]", &curves);
        curves
    }));
    figures.push(over_inertia(all));
    figures
}

/// Speeds of rotor's surface, race and whirl.
fn surfaces(tried: &Tried) -> Vec<Curve> {
    let radius = tried.params.rotor.contact_radius_m;
    let bore = tried.params.bore_radius_m();
    let whirl = |s: &Sample| {
        if s.mode.in_contact() {
            s.backward_m_s
        } else {
            f64::NAN
        }
    };
    curves! {
        "rotor's surface R·Ω", Line, 0 => samples(tried, |s| radius * TAU * s.spin_hz);
        "race R_i·Ω_i", Line, 1 => samples(tried, |s| bore * TAU * s.race_spin_hz);
        "backward whirl, in contact", Line, 2 => samples(tried, whirl);
    }
}

fn over_inertia(all: &[Tried]) -> Figure {
    const RANGE: (f64, f64) = (1e-4, 1e-1);
    let of = |value: &dyn Fn(&Tried) -> f64| {
        let races = all
            .iter()
            .filter_map(|t| Some((t.inertia_kg_m2?, value(t))));
        let mut points: Vec<(f64, f64)> = races.collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let fastest = |t: &Tried| t.fastest_hz.unwrap_or(f64::NAN);
    let bushing = all
        .iter()
        .find(|t| t.inertia_kg_m2.is_none())
        .map_or(f64::NAN, fastest);
    let bound = |t: &Tried| {
        Some(t.bound_hz())
            .filter(|hz| *hz < 2000.0)
            .unwrap_or(f64::NAN)
    };
    chart! {
        "retainer-over-inertia", "Fastest whirl over the inertia of the race",
        "Fastest whirl over the race's inertia: the bound where it is low, the stator's limit where it is not.";
        Axis::log("Inertia of the race [kg m²]", RANGE), Axis::log("Fastest whirl [Hz]", (10.0, 2000.0));
        curves! {
            "runs", Dots, 0 => of(&fastest);
            "bound by the race", Dashed, 1 => of(&bound);
            "bushing", Dashed, 2 => level(RANGE, bushing);
        }
    }
}
