//! The report on a whole rotor: its ends side by side, its axis over time and from the side, then each plane.

use super::document::{Document, Times};
use super::headline::{Concluded, headline};
use super::html_page::Head;
use super::markup::Markup;
use super::panels::{PanelRow, Shown};
use super::quantities::{BENDING_ENERGY, SLOPE, bending};
use super::rendered::Rendered;
use super::summary::{Fact, SceneSummary, summary};
use super::track::Track;
use super::{
    disturbance_lines, happenings, limits, push_far, push_sections, push_table, times_of,
    verification, warnings,
};
use crate::report::plot::PlotError;
use crate::report::plot::chart::{Axis, Chart, Curve};
use crate::report::plot::text::figures;
use crate::run::overview::AxisTrack;
use crate::run::verdict::{PolicyRun, Results};
use crate::scene::Scene;
use plant_model::machine::params::MachineParams;
use plant_model::params::SpinParams;
use std::f64::consts::TAU;

/// What the tracks of a page are of: first the axes of all policies, then plane by plane their runs, the supervisor first.
struct Tracks {
    all: Vec<Track>,
    policies: usize,
}

/// Complete HTML document on the results of a scene of a whole rotor. Deterministic: the same input gives the same bytes.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub(super) fn html(scene: &Scene, results: &Results) -> Result<String, PlotError> {
    let summaries: Vec<SceneSummary> = (0..scene.planes.len())
        .map(|i| of_plane(scene, i))
        .collect();
    // What happens to sensors and magnets a seal does not know.
    let bearing = (scene.planes.iter().zip(&summaries)).find(|(plane, _)| !plane.seal);
    let shown = bearing.map_or(&summaries[0], |(_, summary)| summary);
    let whole = &results.runs;
    let concluded: Vec<Concluded<'_>> = (whole.iter().enumerate())
        .map(|(i, run)| {
            let planes = results.planes.iter().zip(limits(scene));
            Concluded::of(
                run,
                planes.filter_map(|(runs, limit)| Some((runs.get(i)?, limit))),
            )
        })
        .collect();
    let mut order: Vec<usize> = (0..whole.len()).collect();
    order.sort_by_key(|i| !concluded[*i].is_supervised());
    let head = Head {
        title: scene.title.clone(),
        headline: headline(&concluded),
        story: scene.story.clone(),
        facts: facts(scene),
        points: disturbance_lines(&shown.disturbances),
        warnings: warnings(&scene.warnings, results),
    };
    let mut document = Document::begun(&head);
    let axes = (order.iter()).filter_map(|i| Some((whole.get(*i)?, results.axes.get(*i)?)));
    let mut tracks = Tracks {
        all: (axes.clone())
            .map(|(run, axis)| Track::of_axis(&run.name, &scene.machine, axis))
            .collect(),
        policies: order.len(),
    };
    for (summary, runs) in summaries.iter().zip(&results.planes) {
        let runs = in_order(runs, &order).into_iter();
        tracks
            .all
            .extend(runs.map(|run| Track::of_run(summary, run)));
    }
    let times = times_of(shown, &tracks.all);
    for policy in 0..tracks.policies {
        let name = &tracks.all[policy].name;
        let ends = tracks.ends(scene, policy);
        let rows = [times.view(&ends).orbits(false)?];
        match policy {
            0 => document.first_section(&ends, &times, name, &rows),
            _ => document.section(
                &ends,
                (&format!("Planes side by side: {name}"), ""),
                &rows,
                false,
            ),
        }
    }
    document.page.columns(|page| {
        page.about(&head);
        page.block(|page| {
            let caption = "Machine: the worst of its planes, and their sums";
            push_table(page, caption, &in_order(whole, &order));
        });
        for ((plane, summary), runs) in scene.planes.iter().zip(&summaries).zip(&results.planes) {
            let name = plane.shown();
            page.section(&format!("Plane: {name}"), |page| {
                page.facts(&summary.facts);
                let runs_in_order = in_order(runs, &order);
                push_table(page, &format!("Verdicts: {name}"), &runs_in_order);
                push_far(page, runs, summary.clearance_m);
                verification::push_table(page, &runs_in_order);
                happenings::push_tables(page, &runs_in_order, Some(name));
            });
        }
    });
    tracks.push_axes(&mut document, scene, &times)?;
    let sides = axes.map(|(run, axis)| {
        let drawn = Rendered::of_chart(&from_the_side(&scene.machine, axis))?;
        let caption = Markup::written(format!("<b>{}</b>", Markup::text(&run.name).as_html()));
        Ok(Rendered { caption, ..drawn })
    });
    let sides: Vec<Rendered> = sides.collect::<Result<_, PlotError>>()?;
    (document.page).section("Axis from the side, at equal times", |page| {
        page.figures(&sides);
    });
    for (i, plane) in scene.planes.iter().enumerate() {
        let shown = tracks.of_plane(i);
        let rows = times.view(&shown).whole_run()?;
        let of = format!("{}: ", plane.shown());
        push_sections(&mut document, &shown, &times, (&of, &rows))?;
    }
    Ok(document.ended(&tracks.all, &times))
}

/// A plane in words; of a seal nothing that instruments and firmware have.
fn of_plane(scene: &Scene, plane: usize) -> SceneSummary {
    let mut summary = summary(scene, plane);
    if scene.planes[plane].seal {
        let foreign = ["Control rate", "Sensor noise"];
        summary.facts.retain(|(name, _)| !foreign.contains(name));
    }
    summary
}

fn in_order<'a>(runs: &'a [PolicyRun], order: &[usize]) -> Vec<&'a PolicyRun> {
    order.iter().filter_map(|i| runs.get(*i)).collect()
}

impl Tracks {
    /// A track under its own name.
    fn shown(&self, at: usize) -> Shown<'_> {
        let track = &self.all[at];
        Shown {
            name: &track.name,
            at,
            track,
        }
    }

    fn of_plane(&self, plane: usize) -> Vec<Shown<'_>> {
        let first = self.policies * (1 + plane);
        (first..first + self.policies)
            .map(|at| self.shown(at))
            .collect()
    }

    /// Of a policy the track of each plane, under the name of the plane.
    fn ends<'a>(&'a self, scene: &'a Scene, policy: usize) -> Vec<Shown<'a>> {
        (scene.planes.iter().enumerate())
            .map(|(i, plane)| Shown {
                name: plane.shown(),
                ..self.shown(self.policies * (1 + i) + policy)
            })
            .collect()
    }

    /// Slope and bending over time, of all policies.
    fn push_axes(
        &self,
        document: &mut Document,
        scene: &Scene,
        times: &Times,
    ) -> Result<(), PlotError> {
        let axes: Vec<Shown<'_>> = (0..self.policies).map(|at| self.shown(at)).collect();
        let view = times.view(&axes);
        let modes = scene.machine.rotor.bending().len();
        let mut charts = vec![SLOPE];
        if modes > 0 {
            charts.extend([bending(modes), BENDING_ENERGY]);
        }
        let rows = charts.iter().map(|chart| view.chart(chart));
        let rows: Vec<Option<PanelRow>> = rows.collect::<Result<_, _>>()?;
        let rows: Vec<PanelRow> = rows.into_iter().flatten().collect();
        let text = "At equal times; of a long run not at all samples.";
        document.section(&axes, ("Axis", text), &rows, false);
        Ok(())
    }
}

fn facts(scene: &Scene) -> Vec<Fact> {
    let machine = &scene.machine;
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
        ("Duration", figures(1e3 * scene.duration_s) + " ms"),
    ];
    let rates: Vec<String> = (machine.rotor.bending().iter())
        .map(|mode| figures(mode.frequency_rad_s / TAU))
        .collect();
    if !rates.is_empty() {
        facts.push(("Bending modes", rates.join(", ") + " Hz"));
    }
    let planes: Vec<String> = (scene.planes.iter().zip(&machine.planes))
        .map(|(plane, at)| {
            let what = if plane.seal { " (seal)" } else { "" };
            format!(
                "{}{what} at {} mm",
                plane.shown(),
                figures(1e3 * at.position_m)
            )
        })
        .collect();
    facts.push(("Planes", planes.join(", ")));
    let levitation = scene.levitation.as_ref();
    facts.extend(levitation.map(|whole| ("Levitation", whole.described())));
    facts
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
