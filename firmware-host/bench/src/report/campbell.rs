//! A whole rotor as a linear system, for people: tables, Campbell diagram, response to the unbalance, mode shapes.

use super::html_page::{Head, HtmlPage};
use super::lines::{Cell, lined, right};
use super::plot::PlotError;
use super::plot::chart::{Axis, Chart, Curve, Mark};
use super::plot::text::figures;
use super::rendered::Rendered;
use crate::modes::{Analysis, Coupling, HeldWhirl, LoopAnalysis, ModeAtSpin, SensitivityCourse};
use crate::scene::Scene;
use plant_model::machine::linear::Direction;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;

/// Tables of it: modes at standstill, at the spin nearest to that of the scene and at the highest, critical speeds, coupling.
pub fn text(scene: &Scene, analysis: &Analysis) -> String {
    let mut text = format!("{}\n", analysis.scene);
    if let Some(levitation) = &analysis.levitation {
        let _ = write!(text, "{}\n\n", of_the_loop(analysis, levitation));
    }
    let last = (analysis.range.points - 1) as f64;
    let nearest = (scene.start.spin_rad_s.abs() / TAU / analysis.range.to_hz * last).round();
    let mut shown = vec![0.0, nearest.min(last), last];
    shown.dedup();
    let mut table = lined(["spin [Hz]", "frequency [Hz]", "whirl", "damping ratio"]);
    for at in shown {
        let spin_rad_s = TAU * analysis.range.to_hz * at / last;
        let modes = analysis
            .modes
            .iter()
            .filter(|mode| mode.spin_rad_s == spin_rad_s);
        for mode in modes {
            table.add_row([
                right(figures(spin_rad_s / TAU)),
                right(figures(mode.frequency_hz)),
                Cell::new(mode.whirl),
                right(figures(mode.damping_ratio)),
            ]);
        }
    }
    let _ = write!(text, "{table}\n\n");
    if analysis.levitation.is_none() {
        let mut table = lined(["critical speed [Hz]", "whirl"]);
        for speed in &analysis.critical_speeds {
            let spin_hz = figures(speed.spin_rad_s / TAU);
            table.add_row([right(spin_hz), Cell::new(speed.whirl)]);
        }
        let _ = write!(text, "{table}\n\n");
    }
    text += &coupling(&analysis.coupling);
    if let Some(ranges) = &analysis.held_whirl {
        let _ = write!(text, "\n\n{}", held_whirl(analysis, ranges));
    }
    for rate in &analysis.growth_1_s {
        let _ = write!(
            text,
            "\nunstable at {} Hz: a motion grows by {} 1/s",
            figures(analysis.range.to_hz),
            figures(*rate)
        );
    }
    text + "\n"
}

/// Whether the loop is stable, its modes, its sensitivity, and how far its critical speeds are from the spin.
fn of_the_loop(analysis: &Analysis, levitation: &LoopAnalysis) -> String {
    let spin_hz = figures(analysis.spin_rad_s.abs() / TAU);
    let mut text = match levitation.stable {
        true => format!("The loop is stable at {spin_hz} Hz.\n"),
        false => format!("The loop is NOT stable at {spin_hz} Hz: a motion grows.\n"),
    };
    let mut table = lined(["loop mode [Hz]", "whirl", "damping ratio", "growth [1/s]"]);
    for mode in &levitation.loop_modes {
        table.add_row([
            right(figures(mode.frequency_hz)),
            Cell::new(mode.whirl),
            right(figures(mode.damping_ratio)),
            right(figures(mode.growth_1_s)),
        ]);
    }
    let _ = write!(text, "{table}");
    if !levitation.sensitivity.is_empty() {
        let mut table = lined(["sensitivity", "peak", "[dB]", "at [Hz]", "zone"]);
        for axis in &levitation.sensitivity {
            table.add_row([
                Cell::new(&axis.axis),
                right(figures(axis.peak)),
                right(format!("{:.1}", axis.peak_db)),
                right(figures(axis.frequency_hz)),
                Cell::new(axis.zone.name()),
            ]);
        }
        let _ = write!(text, "\n\n{table}\nZones of ISO 14839-3.");
    }
    if !levitation.speed_margins.is_empty() {
        let mut table = lined([
            "critical speed [Hz]",
            "whirl",
            "amplification",
            "separation [%]",
            "asked [%]",
        ]);
        for margin in &levitation.speed_margins {
            table.add_row([
                right(figures(margin.spin_rad_s / TAU)),
                Cell::new(margin.whirl),
                right(figures(margin.amplification)),
                right(format!("{:.1}", 100.0 * margin.separation)),
                right(format!("{:.1}", 100.0 * margin.separation_asked)),
            ]);
        }
        let _ = write!(text, "\n\n{table}\nAsked by API 617.");
    }
    text
}

/// Whirl that friction can hold.
fn held_whirl(analysis: &Analysis, ranges: &[HeldWhirl]) -> String {
    let spin_hz = figures(analysis.spin_rad_s.abs() / TAU);
    let header = format!("backward whirl that friction can hold at {spin_hz} Hz");
    let mut table = lined([header.as_str(), "from [Hz]", "to [Hz]"]);
    if ranges.is_empty() {
        return format!("{header}: none");
    }
    for range in ranges {
        let shape = |phase_rad: f64| match phase_rad.abs() < FRAC_PI_2 {
            true => "cylindrical",
            false => "conical",
        };
        let [low, high] = range.phases_rad.map(shape);
        let shapes = match (range.planes.len(), low == high) {
            (1, _) => String::new(),
            (_, true) => format!(", {low}"),
            (_, false) => format!(", {low} to {high}"),
        };
        let [from, to] = range.rates_rad_s.map(|rate| right(figures(rate / TAU)));
        table.add_row([Cell::new(range.planes.join(" and ") + &shapes), from, to]);
    }
    table.to_string()
}

/// Mass of each plane, and how far each other one moves when it is struck.
pub fn coupling(coupling: &Coupling) -> String {
    let mut header = vec!["plane".to_owned(), "effective mass [kg]".to_owned()];
    header.extend(coupling.planes.iter().map(|name| format!("{name} moves")));
    let mut table = lined(header);
    for (i, name) in coupling.planes.iter().enumerate() {
        let row = &coupling.mobility_1_kg[i];
        // Without the sign of a rounded zero.
        let moves = row
            .iter()
            .map(|m| right(format!("{:.3}", (1e3 * m / row[i]).round() / 1e3 + 0.0)));
        let mass = right(figures(coupling.effective_mass_kg[i]));
        table.add_row(
            [Cell::new(format!("{name} struck")), mass]
                .into_iter()
                .chain(moves),
        );
    }
    table.to_string()
}

/// A page with the Campbell diagram and the response to the unbalance.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(scene: &Scene, analysis: &Analysis) -> Result<String, PlotError> {
    let head = Head {
        title: analysis.scene.clone(),
        story: scene.story.clone(),
        ..Head::default()
    };
    let mut page = HtmlPage::begun(&head);
    let mut plots = vec![
        diagram(analysis),
        responses(analysis),
        shapes(scene, analysis),
    ];
    if let Some(levitation) = &analysis.levitation
        && let Some(course) = &levitation.sensitivity_course
    {
        plots.push(sensitivity(levitation, course));
    }
    // Without unbalance there is no response to it.
    plots.retain(|plot| plot.curves.iter().any(|curve| !curve.points.is_empty()));
    let drawn: Vec<Rendered> = (plots.iter().map(Rendered::of_chart)).collect::<Result<_, _>>()?;
    page.section("Modes", |page| page.figures(&drawn));
    page.about(&head);
    page.section("Tables", |page| page.lines(&text(scene, analysis)));
    Ok(page.ended())
}

fn diagram(analysis: &Analysis) -> Chart {
    let to_hz = analysis.range.to_hz;
    // What hardly swings, as much of a controller, would press the rest together.
    let shown = |m: &&ModeAtSpin| analysis.levitation.is_none() || m.damping_ratio < 0.5;
    let highest = (analysis.modes.iter().filter(shown))
        .map(|m| m.frequency_hz)
        .fold(to_hz, f64::max);
    let of = |direction: Direction, colour: usize| {
        let modes = analysis
            .modes
            .iter()
            .filter(|mode| mode.whirl == direction.name() && shown(mode));
        Curve {
            name: direction.name().to_owned(),
            points: modes
                .map(|mode| (mode.spin_rad_s / TAU, mode.frequency_hz))
                .collect(),
            mark: Mark::Dots,
            colour,
        }
    };
    let once = Curve {
        name: "once a turn".to_owned(),
        points: vec![(0.0, 0.0), (to_hz, to_hz)],
        mark: Mark::Dashed,
        colour: 5,
    };
    let mut curves = vec![once];
    curves.extend(
        [
            (Direction::Forward, 0),
            (Direction::Backward, 1),
            (Direction::Planar, 2),
        ]
        .map(|(d, c)| of(d, c)),
    );
    curves.retain(|curve| !curve.points.is_empty());
    Chart {
        label: "Campbell diagram: natural frequencies over the spin".to_owned(),
        x: Axis::linear("spin / Hz", (0.0, to_hz)),
        y: Axis::linear("frequency / Hz", (0.0, 1.05 * highest)),
        curves,
    }
}

fn sensitivity(levitation: &LoopAnalysis, course: &SensitivityCourse) -> Chart {
    let axes = levitation.sensitivity.iter().zip(&course.axes_db);
    let curves: Vec<Curve> = axes
        .enumerate()
        .map(|(i, (axis, sizes_db))| {
            let points = course.frequencies_hz.iter().zip(sizes_db);
            let points = points.map(|(hz, db)| (*hz, *db)).collect();
            Curve::line(axis.axis.clone(), points, i)
        })
        .collect();
    let highest = (levitation.sensitivity.iter())
        .map(|axis| axis.peak_db)
        .fold(15.0, f64::max);
    let ends = (course.frequencies_hz.first()).zip(course.frequencies_hz.last());
    let ends = ends.map_or((1.0, 10.0), |(first, last)| (*first, *last));
    Chart {
        label: "Sensitivity of each axis, the others closed".to_owned(),
        x: Axis::log("frequency / Hz", ends),
        y: Axis::linear("|S| / dB", (-40.0, highest + 2.0)),
        curves,
    }
}

/// The slowest shapes, along the place that moves most.
fn shapes(scene: &Scene, analysis: &Analysis) -> Chart {
    const SHOWN: usize = 6;
    let places = &analysis.shape_positions_m;
    let curves = analysis.mode_shapes.iter().take(SHOWN).enumerate();
    let mut curves: Vec<Curve> = curves
        .map(|(i, shape)| {
            let points = places.iter().copied().zip(shape.along.iter().copied());
            let name = format!("{} Hz {}", figures(shape.frequency_hz), shape.whirl);
            Curve::line(name, points.collect(), i)
        })
        .collect();
    curves.extend(
        scene
            .planes
            .iter()
            .zip(&scene.machine.planes)
            .map(|(plane, at)| Curve {
                name: plane.shown().to_owned(),
                points: vec![(at.position_m, 0.0)],
                mark: Mark::Name,
                colour: 8,
            }),
    );
    let (first, last) = (places.first(), places.last());
    let ends = (first.copied().unwrap_or(0.0), last.copied().unwrap_or(1.0));
    let ends = if ends.1 > ends.0 {
        ends
    } else {
        (ends.0 - 0.1, ends.0 + 0.1)
    };
    let spin_hz = figures(analysis.spin_rad_s.abs() / TAU);
    Chart {
        label: format!("Mode shapes at {spin_hz} Hz"),
        x: Axis::linear("place from the centre of mass / m", ends),
        y: Axis::linear("displacement, largest 1", (-1.1, 1.1)),
        curves,
    }
}

fn responses(analysis: &Analysis) -> Chart {
    let of = |(plane, name): (usize, &String)| {
        let points = (analysis.unbalance_response.iter())
            .filter_map(|at| Some((at.spin_rad_s / TAU, 1e6 * at.planes_m.as_ref()?[plane])))
            .filter(|point| point.1 > 0.0);
        Curve::line(name.clone(), points.collect(), plane)
    };
    let curves: Vec<Curve> = analysis
        .coupling
        .planes
        .iter()
        .enumerate()
        .map(of)
        .collect();
    let values = || {
        curves
            .iter()
            .flat_map(|curve| &curve.points)
            .map(|point| point.1)
    };
    let (low, high) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(0.0, f64::max),
    );
    let range = match high > low {
        true => (low.max(1e-4 * high), high),
        false => (0.1, 1.0),
    };
    Chart {
        label: "Distance from the middle over the spin".to_owned(),
        x: Axis::linear("spin / Hz", (0.0, analysis.range.to_hz)),
        y: Axis::log("amplitude / µm", range),
        curves,
    }
}
