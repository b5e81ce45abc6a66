//! The report on a whole rotor: its ends side by side, its axis over time and from the side, then each plane.

use super::panels::orbits_of_planes;
use super::summary::{Fact, SceneSummary, summary};
use super::{
    begun, push, push_list, push_runs, push_section, push_story, push_table, push_warnings,
};
use crate::device::whole_levitation::WholeLevitationParams;
use crate::report::plot::PlotError;
use crate::report::plot::chart::{Axis, Chart, Curve, chart};
use crate::report::plot::text::{escape, figures};
use crate::run::overview::AxisTrack;
use crate::run::trace::AxisRow;
use crate::run::verdict::{MachineResults, PolicyRun};
use crate::scene::machine::MachineScene;
use plant_model::machine::params::MachineParams;
use plant_model::params::SpinParams;
use std::f64::consts::TAU;

/// Complete HTML document on the results of a scene of a whole rotor. Deterministic: the same input gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(scene: &MachineScene, results: &MachineResults) -> Result<String, PlotError> {
    let common = scene.common();
    let summaries: Vec<SceneSummary> = (scene.planes.iter())
        .map(|plane| summary(&plane.scene))
        .collect();
    let mut page = begun(&common.title);
    push_story(&mut page, &common.story);
    push_list(&mut page, &facts(scene));
    super::push_disturbances(&mut page, &summaries[0].disturbances);
    push_warnings(&mut page, &scene.warnings);
    push_warnings(&mut page, &results.whole.untrusted());
    page.push_str("</header>\n<main>\n");
    let narrowest_m = (summaries.iter().map(|s| s.clearance_m)).fold(f64::INFINITY, f64::min);
    push_table(&mut page, &results.whole.runs, narrowest_m);
    page.push_str(
        "<p class=\"note\">Of the machine: the worst of its planes, and their sums.</p>\n",
    );
    push_ends(&mut page, scene, &summaries, results)?;
    push_axes(&mut page, scene, results)?;
    for ((plane, summary), runs) in scene.planes.iter().zip(&summaries).zip(&results.planes) {
        let name = escape(&plane.name);
        push(&mut page, format_args!("<h1>Plane: {name}</h1>\n"));
        push_list(&mut page, &summary.facts);
        push_runs(&mut page, summary, runs)?;
    }
    page.push_str("</main>\n</body>\n</html>\n");
    Ok(page)
}

fn facts(scene: &MachineScene) -> Vec<Fact> {
    let (machine, common) = (&scene.machine, scene.common());
    let rigid = machine.rotor.rigid();
    let held = match machine.spin {
        SpinParams::Held => ", held",
        SpinParams::Free { .. } => "",
    };
    let mut facts = vec![
        ("Mass", figures(rigid.mass_kg) + " kg"),
        ("I_t", figures(rigid.transverse_inertia_kg_m2) + " kg m²"),
        ("I_p", figures(rigid.polar_inertia_kg_m2) + " kg m²"),
        (
            "Spin",
            format!("{} Hz{held}", figures(scene.start.spin_rad_s / TAU)),
        ),
        ("Duration", figures(1e3 * common.duration_s) + " ms"),
    ];
    let rates: Vec<String> = (machine.rotor.bending().iter())
        .map(|mode| figures(mode.frequency_rad_s / TAU))
        .collect();
    if !rates.is_empty() {
        facts.push(("Bending modes", rates.join(", ") + " Hz"));
    }
    let planes: Vec<String> = (scene.planes.iter().zip(&machine.planes))
        .map(|(plane, at)| format!("{} at {} mm", plane.name, figures(1e3 * at.position_m)))
        .collect();
    facts.push(("Planes", planes.join(", ")));
    match &scene.levitation {
        None => {}
        Some(WholeLevitationParams::Modal(_)) => facts.push(("Levitation", "by mode".to_owned())),
        Some(WholeLevitationParams::StateSpace(own)) => {
            let states = format!("a state space with {} states", own.a.nrows());
            facts.push(("Levitation", states));
        }
    }
    facts
}

/// Of each policy the orbits in all planes.
fn push_ends(
    page: &mut String,
    scene: &MachineScene,
    summaries: &[SceneSummary],
    results: &MachineResults,
) -> Result<(), PlotError> {
    for (i, whole) in results.whole.runs.iter().enumerate() {
        let ends: Vec<PolicyRun> = (results.planes.iter().zip(&scene.planes))
            .filter_map(|(runs, plane)| {
                let mut run = runs.get(i)?.clone();
                run.name.clone_from(&plane.name);
                Some(run)
            })
            .collect();
        if let Some(row) = orbits_of_planes(summaries, &ends)? {
            let heading = format!("Planes side by side: {}", escape(&whole.name));
            push_section(page, &ends, &heading, "", &[row]);
        }
    }
    Ok(())
}

/// Of each policy slope and bending over time, and the axis from the side.
fn push_axes(
    page: &mut String,
    scene: &MachineScene,
    results: &MachineResults,
) -> Result<(), PlotError> {
    for (whole, track) in results.whole.runs.iter().zip(&results.axes) {
        let name = escape(&whole.name);
        push(
            page,
            format_args!(
                "<section>\n<h2>Axis: {name}</h2>\n<p class=\"note\">At equal times; of a long run at {} of them.</p>\n",
                track.rows.len()
            ),
        );
        for plot in plots(&scene.machine, track) {
            push(page, format_args!("<figure>{}</figure>\n", chart(&plot)?));
        }
        page.push_str("</section>\n");
    }
    Ok(())
}

fn plots(machine: &MachineParams, track: &AxisTrack) -> Vec<Chart> {
    let over_time = |name: String, colour: usize, value: &dyn Fn(&AxisRow) -> f64| {
        let points = track.rows.iter().map(|row| (1e3 * row.t_s, value(row)));
        Curve::line(name, points.collect(), colour)
    };
    let slope = ["x", "y"].into_iter().enumerate().map(|(axis, name)| {
        over_time(format!("d{name}/dz"), axis, &|row| {
            1e3 * row.axis.tilt.position[axis]
        })
    });
    let mut plots = vec![timed("Slope", "slope / mrad", slope.collect())];
    let modes = machine.rotor.bending().len();
    if modes > 0 {
        let amplitude = |mode: usize| {
            over_time(format!("mode {}", mode + 1), mode, &|row| {
                1e6 * row.bending[mode].position.norm()
            })
        };
        plots.push(timed(
            "Bending",
            "amplitude / µm",
            (0..modes).map(amplitude).collect(),
        ));
        let energy = over_time("bending".to_owned(), 0, &|row| row.axis.bending_j);
        plots.push(timed("Bending energy", "energy / J", vec![energy]));
    }
    plots.push(from_the_side(machine, track));
    plots
}

fn timed(what: &str, y: &str, curves: Vec<Curve>) -> Chart {
    Chart {
        label: format!("{what} over time"),
        x: Axis::linear("t / ms", reach(&curves, |p| p.0)),
        y: Axis::linear(y, reach(&curves, |p| p.1)),
        curves,
    }
}

/// Instants at which the axis is drawn.
const INSTANTS: usize = 9;
/// Places along it.
const PLACES: usize = 41;

/// x over z at equal times.
fn from_the_side(machine: &MachineParams, track: &AxisTrack) -> Chart {
    let places =
        (machine.planes.iter().map(|p| p.position_m)).chain(machine.probes_m.iter().copied());
    let (low, high) = places.fold((0.0_f64, 0.0_f64), |(a, b), z| (a.min(z), b.max(z)));
    let rows = track.rows.len().saturating_sub(1);
    let at = |instant: usize| {
        let row = track.rows.get(instant * rows / (INSTANTS - 1))?;
        let point = |place: usize| {
            let z = low + (high - low) * place as f64 / (PLACES - 1) as f64;
            let line_m = machine.rotor.centre_line_m(&row.axis, &row.bending, z);
            (1e3 * z, 1e3 * line_m.x)
        };
        let name = format!("{} ms", figures(1e3 * row.t_s));
        Some(Curve::line(name, (0..PLACES).map(point).collect(), instant))
    };
    let curves: Vec<Curve> = (0..INSTANTS).filter_map(at).collect();
    Chart {
        label: "The axis from the side, at equal times".to_owned(),
        x: Axis::linear("z / mm", reach(&curves, |p| p.0)),
        y: Axis::linear("x / mm", reach(&curves, |p| p.1)),
        curves,
    }
}

/// From the smallest to the largest finite value, with some room where they are one.
fn reach(curves: &[Curve], of: fn(&(f64, f64)) -> f64) -> (f64, f64) {
    let values = curves.iter().flat_map(|curve| &curve.points).map(of);
    let (low, high) = (values.filter(|x| x.is_finite()))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (a.min(x), b.max(x))
        });
    match high > low {
        true => (low, high),
        false if low.is_finite() => (low - 1e-3, low + 1e-3),
        false => (0.0, 1.0),
    }
}
