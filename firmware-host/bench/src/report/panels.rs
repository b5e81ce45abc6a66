//! Panels: which data of a trace goes into which axes, and which axes the policies share.

use plant_model::Mode;
use plotters::style::RGBColor;

use super::axes::{axes, disturbances, one_axis, run_window};
use super::quantities::{
    CONTACT_FORCE, CONTROL_FORCE, Chart, Quantity, RADIUS, SPIN, TANGENTIAL_SPEED, radial,
};
use crate::report::plot::text::hex;
use crate::report::plot::thin::{Band, Interval, PathPoint, drawable, thinned};
use crate::report::plot::{
    COLUMNS, FREE, LIMIT, Lane, Line, OrbitPlot, PlotError, TOUCHING, TimeAxis, TimePlot, Wall,
    orbit_plot, strip_plot, time_plot,
};
use crate::report::summary::SceneSummary;
use crate::run::trace::TraceRow;
use crate::run::verdict::PolicyRun;

/// One panel of every policy.
pub(super) struct PanelRow {
    /// What is shown.
    pub(super) heading: &'static str,
    /// What a reader must know to read it; may be empty.
    pub(super) note: &'static str,
    /// What the colours stand for.
    pub(super) legend: Vec<Key>,
    /// One for each policy, in their order.
    pub(super) cells: Vec<PanelCell>,
}

/// One entry of a legend.
pub(super) struct Key {
    /// What is drawn so.
    pub(super) name: &'static str,
    /// CSS colour.
    pub(super) colour: String,
    /// A dashed line.
    pub(super) dashed: bool,
}

/// One panel of one policy.
pub(super) struct PanelCell {
    /// The figure.
    pub(super) svg: String,
    /// Whether its axes differ from those of the other policies.
    pub(super) own_scale: bool,
}

/// What a section shows: all runs, one stretch of time \[ms\].
struct View<'a> {
    scene: &'a SceneSummary,
    runs: &'a [PolicyRun],
    window: Interval,
    shaded: Vec<Interval>,
}

const MODES: [(Mode, RGBColor); 5] = [
    (Mode::Flight, RGBColor(0xd5, 0xde, 0xe8)),
    (Mode::SlipPositive, TOUCHING),
    (Mode::SlipNegative, RGBColor(0x2f, 0x80, 0xc9)),
    (Mode::Roll, RGBColor(0x7a, 0x4f, 0xb5)),
    (Mode::Seated, RGBColor(0x4a, 0x52, 0x5c)),
];

const SUPERVISOR_COLOURS: [(supervisor::Mode, RGBColor); 8] = [
    (supervisor::Mode::Levitated, RGBColor(0xa8, 0xd5, 0xba)),
    (supervisor::Mode::Approach, RGBColor(0xf3, 0xc0, 0x6b)),
    (supervisor::Mode::Bounce, RGBColor(0xe3, 0x8f, 0x8f)),
    (supervisor::Mode::BackwardWhirl, RGBColor(0xc9, 0xa7, 0xe0)),
    (supervisor::Mode::Pinned, RGBColor(0xd6, 0xc6, 0xa5)),
    (supervisor::Mode::Handover, RGBColor(0x9d, 0xb7, 0xe8)),
    (supervisor::Mode::HandedBack, RGBColor(0xa8, 0xd5, 0xa2)),
    (supervisor::Mode::SensorFault, RGBColor(0xc4, 0xc9, 0xd0)),
];

/// The whole run: orbit, every quantity, modes.
pub(super) fn whole_run(
    scene: &SceneSummary,
    runs: &[PolicyRun],
) -> Result<Vec<PanelRow>, PlotError> {
    let view = View::new(scene, runs, run_window(scene, runs));
    let mut rows = vec![view.orbits()?];
    rows.extend(view.fast()?);
    rows.push(view.chart(&SPIN)?);
    Ok(rows)
}

/// Orbits of one policy in several planes, each with axes of its own.
pub(super) fn orbits_of_planes(
    scenes: &[SceneSummary],
    runs: &[PolicyRun],
) -> Result<Option<PanelRow>, PlotError> {
    let mut all: Option<PanelRow> = None;
    for (scene, run) in scenes.iter().zip(runs) {
        let runs = std::slice::from_ref(run);
        let row = View::new(scene, runs, run_window(scene, runs)).orbits()?;
        match &mut all {
            Some(all) => all.cells.extend(row.cells),
            None => all = Some(row),
        }
    }
    Ok(all)
}

/// What changes fast, over `window` \[ms\].
pub(super) fn close_up(
    scene: &SceneSummary,
    runs: &[PolicyRun],
    window: Interval,
) -> Result<Vec<PanelRow>, PlotError> {
    View::new(scene, runs, window).fast()
}

impl Key {
    fn new(name: &'static str, colour: RGBColor) -> Self {
        Self {
            name,
            colour: hex(colour),
            dashed: false,
        }
    }
}

impl<'a> View<'a> {
    fn new(scene: &'a SceneSummary, runs: &'a [PolicyRun], window: Interval) -> Self {
        Self {
            scene,
            runs,
            window,
            shaded: disturbances(scene),
        }
    }

    fn time(&self) -> TimeAxis<'_> {
        TimeAxis {
            window: self.window,
            shaded: &self.shaded,
        }
    }

    fn fast(&self) -> Result<Vec<PanelRow>, PlotError> {
        Ok(vec![
            self.chart(&RADIUS)?,
            self.chart(&CONTACT_FORCE)?,
            self.chart(&CONTROL_FORCE)?,
            self.chart(&TANGENTIAL_SPEED)?,
            self.modes()?,
        ])
    }

    fn chart(&self, chart: &Chart) -> Result<PanelRow, PlotError> {
        let ranges: Vec<_> = self
            .runs
            .iter()
            .map(|run| chart.range(self.scene, run, self.window))
            .collect();
        let axes = if chart.own_scale {
            axes(&ranges, self.runs)
        } else {
            one_axis(&ranges)
        };
        let mut cells = Vec::new();
        for ((run, range), (axis, own_scale)) in self.runs.iter().zip(&ranges).zip(axes) {
            let limit = chart.limit_at(self.scene, run);
            let label = self.label(run, chart.heading, chart.y_name, *range);
            let svg = time_plot(&TimePlot {
                label: &label,
                time: self.time(),
                y: axis.widened(0.05),
                y_name: chart.y_name,
                lines: &self.lines(chart, run),
                limit,
            })?;
            cells.push(PanelCell { svg, own_scale });
        }
        Ok(PanelRow {
            heading: chart.heading,
            note: chart.note,
            legend: legend(chart),
            cells,
        })
    }

    fn lines(&self, chart: &Chart, run: &PolicyRun) -> Vec<Line> {
        let line = |quantity: &Quantity| {
            let rows = run.trace.rows.iter();
            let points = rows.map(|row| (1e3 * row.plant.t_s, (quantity.value)(row)));
            Line {
                points: thinned(points, self.window, COLUMNS),
                colour: quantity.colour,
            }
        };
        chart.lines.iter().map(line).collect()
    }

    fn orbits(&self) -> Result<PanelRow, PlotError> {
        let circle = Some(1e3 * self.scene.clearance_m)
            .filter(|c| drawable(*c))
            .unwrap_or(0.0);
        let (ellipticity, tilt_rad) = self.scene.out_of_round.unwrap_or_default();
        let wall = Wall {
            semi_axes: [1.0 + ellipticity, 1.0 - ellipticity].map(|share| share * circle),
            tilt_rad,
        };
        let widest = wall.semi_axes[0];
        let paths: Vec<_> = self.runs.iter().map(path).collect();
        let reach = |path: &Vec<PathPoint>| {
            let all = Interval::of(path.iter().flat_map(|p| [p.0, p.1]).chain([widest]));
            Interval::symmetric(all.map_or(widest, Interval::magnitude))
        };
        let ranges: Vec<_> = paths.iter().map(reach).collect();
        let mut cells = Vec::new();
        for (((run, path), range), (axis, own_scale)) in self
            .runs
            .iter()
            .zip(&paths)
            .zip(&ranges)
            .zip(axes(&ranges, self.runs))
        {
            let svg = orbit_plot(&OrbitPlot {
                label: &self.label(run, "Orbit", "x and y / mm", *range),
                reach: axis.widened(0.05).hi,
                wall,
                path,
            })?;
            cells.push(PanelCell { svg, own_scale });
        }
        Ok(PanelRow {
            heading: "Orbit",
            note: "Rotor against the centre of the inner ring; ring mark: start, dot: end.",
            legend: vec![
                Key::new("flight", FREE),
                Key::new("contact", TOUCHING),
                Key::new(
                    match self.scene.out_of_round {
                        None => "clearance circle",
                        Some(_) => "clearance ellipse",
                    },
                    LIMIT,
                ),
            ],
            cells,
        })
    }

    fn modes(&self) -> Result<PanelRow, PlotError> {
        let plant = MODES.map(|(mode, colour)| (mode.name(), colour));
        let supervisor = supervisor_classes(self.runs);
        let mut cells = Vec::new();
        for run in self.runs {
            let (motion, modes) = (plant_bands(run), supervisor_bands(run, &supervisor));
            let mut lanes = vec![Lane {
                name: "rotor",
                classes: &plant,
                bands: &motion,
            }];
            // Every policy gets the lane, so that the panels stay comparable.
            if !supervisor.is_empty() {
                lanes.push(Lane {
                    name: "supervisor",
                    classes: &supervisor,
                    bands: &modes,
                });
            }
            let label = format!("{}, modes: {} stretches of motion", run.name, motion.len());
            let svg = strip_plot(&label, self.time(), &lanes)?;
            cells.push(PanelCell {
                svg,
                own_scale: false,
            });
        }
        let classes = plant.iter().chain(&supervisor);
        Ok(PanelRow {
            heading: "Modes",
            note: "slip+: friction drives the rotor clockwise; slip-: counter-clockwise. Where modes \
                   share a pixel, the one that is rarest in the window is drawn.",
            legend: classes
                .map(|(name, colour)| Key::new(name, *colour))
                .collect(),
            cells,
        })
    }

    /// What a screen reader says of a figure.
    fn label(&self, run: &PolicyRun, heading: &str, quantity: &str, range: Interval) -> String {
        let time = self.window;
        format!(
            "{}, {heading}: {quantity} between {:.4} and {:.4}, from {:.1} ms to {:.1} ms",
            run.name, range.lo, range.hi, time.lo, time.hi
        )
    }
}

fn legend(chart: &Chart) -> Vec<Key> {
    let lines = chart
        .lines
        .iter()
        .map(|line| Key::new(line.name, line.colour));
    let limit = chart.limit.as_ref().map(|limit| Key {
        dashed: true,
        ..Key::new(limit.name, LIMIT)
    });
    lines.chain(limit).collect()
}

fn path(run: &PolicyRun) -> Vec<PathPoint> {
    let point = |row: &TraceRow| {
        let r = 1e3 * radial(row);
        (r.x, r.y, row.plant.mode.in_contact())
    };
    let points = run.trace.rows.iter().map(point);
    points.filter(|p| drawable(p.0) && drawable(p.1)).collect()
}

fn plant_bands(run: &PolicyRun) -> Vec<Band> {
    let bands = run.trace.mode_bands().into_iter();
    let band = |(mode, from, to): (Mode, f64, f64)| {
        let class = MODES.iter().position(|known| known.0 == mode)?;
        let span = Interval::of([1e3 * from, 1e3 * to])?;
        Some(Band { class, span })
    };
    bands.filter_map(band).collect()
}

/// Names of the supervisor's modes that occur, each with its colour, which is the same in every report.
fn supervisor_classes(runs: &[PolicyRun]) -> Vec<(&'static str, RGBColor)> {
    let occurs = |mode: supervisor::Mode| {
        let mut rows = runs.iter().flat_map(|run| &run.trace.rows);
        rows.any(|row| row.supervisor_mode() == Some(mode))
    };
    (SUPERVISOR_COLOURS.into_iter())
        .filter(|(mode, _)| occurs(*mode))
        .map(|(mode, colour)| (mode.name(), colour))
        .collect()
}

fn supervisor_bands(run: &PolicyRun, classes: &[(&'static str, RGBColor)]) -> Vec<Band> {
    let mut bands: Vec<Band> = Vec::new();
    for row in &run.trace.rows {
        let t = 1e3 * row.plant.t_s;
        let named = |mode: supervisor::Mode| classes.iter().position(|c| c.0 == mode.name());
        let (Some(now), Some(class)) = (Interval::of([t]), row.supervisor_mode().and_then(named))
        else {
            continue;
        };
        match bands.last_mut() {
            Some(last) if last.class == class => last.span = last.span.with(now),
            Some(last) => {
                last.span = last.span.with(now);
                bands.push(Band { class, span: now });
            }
            None => bands.push(Band { class, span: now }),
        }
    }
    bands
}
