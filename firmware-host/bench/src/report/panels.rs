//! Panels: which data of a track goes into which axes, and which axes the tracks share.

use plotters::style::RGBColor;
use serde_json::{Value, json};

use super::axes::{axes, one_axis};
use super::data;
use super::listing::Listing;
use super::quantities::{
    CONTACT_FORCE, CONTACT_SHARE, CONTROL_FORCE, Chart, FORCE_COMPONENTS, POSITION, RADIUS,
    SEVERITY, SPIN, TANGENTIAL_SPEED,
};
use super::track::{ROTOR_MODES, SUPERVISOR_MODES, Track};
use crate::report::plot::text::hex;
use crate::report::plot::thin::{Interval, PathPoint, thinned};
use crate::report::plot::{
    COLUMNS, FREE, LIMIT, Lane, Line, OrbitPlot, PlotError, TOUCHING, TimeAxis, TimePlot, Wall,
    orbit_plot, strip_plot, time_plot,
};

const ORBIT: &str = "Orbit";

/// One panel of every track.
pub(super) struct PanelRow {
    /// What is shown.
    pub(super) heading: &'static str,
    /// What a reader must know to read it, as HTML; may be empty.
    pub(super) note: &'static str,
    /// What the colours stand for.
    pub(super) legend: Vec<Key>,
    /// In the order of the tracks, of those that have what is shown.
    pub(super) cells: Vec<PanelCell>,
}

/// The rows that are to be seen first, and the others.
pub(super) fn first_seen(rows: Vec<PanelRow>) -> (Vec<PanelRow>, Vec<PanelRow>) {
    (rows.into_iter()).partition(|row| [ORBIT, RADIUS.heading].contains(&row.heading))
}

/// One entry of a legend.
pub(super) struct Key {
    /// What is drawn so.
    pub(super) name: String,
    /// CSS colour.
    pub(super) colour: String,
    /// A dashed line.
    pub(super) dashed: bool,
}

/// One panel of one track.
pub(super) struct PanelCell {
    /// Place among the shown ones.
    pub(super) shown: usize,
    /// The figure.
    pub(super) svg: String,
    /// Whether its axes differ from those of the others.
    pub(super) own_scale: bool,
    /// What it shows, as a table.
    pub(super) data: Listing,
    /// What the script needs to draw it.
    pub(super) live: Value,
}

/// A track of a page, and its name there.
#[derive(Clone)]
pub(super) struct Shown<'a> {
    pub(super) name: &'a str,
    /// Place among the tracks of the page.
    pub(super) at: usize,
    pub(super) track: &'a Track,
}

/// What a section shows: some tracks, one stretch of time.
pub(super) struct View<'a> {
    pub(super) shown: &'a [Shown<'a>],
    pub(super) window: Interval,
    pub(super) shaded: &'a [Interval],
}

impl View<'_> {
    /// Orbit, every quantity that the tracks have, modes.
    pub(super) fn whole_run(&self) -> Result<Vec<PanelRow>, PlotError> {
        let mut rows = vec![self.orbits(true)?];
        rows.extend(self.fast()?);
        rows.extend(self.chart(&SPIN)?);
        Ok(rows)
    }

    /// What changes fast.
    pub(super) fn fast(&self) -> Result<Vec<PanelRow>, PlotError> {
        const ALL: [Chart; 8] = [
            POSITION,
            RADIUS,
            CONTACT_FORCE,
            CONTROL_FORCE,
            FORCE_COMPONENTS,
            TANGENTIAL_SPEED,
            SEVERITY,
            CONTACT_SHARE,
        ];
        // What is measured is shown of records, and with them of what is laid beside them.
        let recorded = self.shown.iter().any(|s| FORCE_COMPONENTS.is_of(s.track));
        let mut rows = Vec::new();
        for chart in ALL {
            if recorded || chart.heading != POSITION.heading {
                rows.extend(self.chart(&chart)?);
            }
        }
        rows.push(self.modes()?);
        Ok(rows)
    }

    /// `None` where no track has any of it.
    pub(super) fn chart(&self, chart: &Chart) -> Result<Option<PanelRow>, PlotError> {
        let having = self.shown.iter().enumerate();
        let having: Vec<_> = having.filter(|(_, s)| chart.is_of(s.track)).collect();
        let tracks: Vec<&Track> = having.iter().map(|(_, s)| s.track).collect();
        let ranges: Vec<_> = (tracks.iter())
            .map(|track| chart.range(track, self.window))
            .collect();
        let axes = if chart.own_scale {
            axes(&ranges, &tracks)
        } else {
            one_axis(&ranges)
        };
        let mut cells = Vec::new();
        for (((place, shown), range), (axis, own_scale)) in having.iter().zip(&ranges).zip(axes) {
            let track = shown.track;
            let (limit, y) = (chart.limit_at(track), axis.widened(0.05));
            let y_name = chart.y_name(track);
            let label = self.label(shown, chart.heading, &y_name, *range);
            let svg = time_plot(&TimePlot {
                label: &label,
                time: self.time(track),
                y,
                y_name: &y_name,
                lines: &self.lines(chart, track),
                limit,
            })?;
            let lines = chart
                .lines_of(track)
                .map(|(line, _)| json!({ "column": line.column, "colour": hex(line.colour) }));
            cells.push(PanelCell {
                shown: *place,
                svg,
                own_scale,
                data: data::extremes(chart, track, self.window),
                live: json!({
                    "kind": "lines", "track": shown.at, "own": own_scale, "name": y_name,
                    "lines": lines.collect::<Vec<_>>(), "y": [y.lo, y.hi], "limit": limit,
                    "always": chart.always,
                }),
            });
        }
        Ok((!cells.is_empty()).then(|| PanelRow {
            heading: chart.heading,
            note: chart.note,
            legend: legend(chart, &tracks),
            cells,
        }))
    }

    fn lines(&self, chart: &Chart, track: &Track) -> Vec<Line> {
        let line = |(line, values): (&super::quantities::Line, &[f64])| {
            let points = track.t.iter().copied().zip(values.iter().copied());
            Line {
                points: thinned(points, self.window, COLUMNS),
                colour: line.colour,
            }
        };
        chart.lines_of(track).map(line).collect()
    }

    /// Orbits, on one scale where that is wanted.
    pub(super) fn orbits(&self, one_scale: bool) -> Result<PanelRow, PlotError> {
        let having = self.shown.iter().enumerate();
        let having: Vec<_> = having.filter(|(_, s)| s.track.has_path()).collect();
        let tracks: Vec<&Track> = having.iter().map(|(_, s)| s.track).collect();
        let paths: Vec<_> = tracks.iter().map(|track| track.path()).collect();
        let walls: Vec<_> = (tracks.iter())
            .map(|track| track.wall.unwrap_or(Wall::NONE))
            .collect();
        let reach = |(path, wall): (&Vec<PathPoint>, &Wall)| {
            let widest = wall.semi_axes[0];
            let all = Interval::of(path.iter().flat_map(|p| [p.0, p.1]).chain([widest]));
            Interval::symmetric(all.map_or(widest, Interval::magnitude))
        };
        let ranges: Vec<_> = paths.iter().zip(&walls).map(reach).collect();
        let axes = match one_scale {
            true => axes(&ranges, &tracks),
            false => ranges.iter().map(|range| (*range, false)).collect(),
        };
        let mut cells = Vec::new();
        for (i, (axis, own_scale)) in axes.into_iter().enumerate() {
            let ((place, shown), wall) = (having[i], walls[i]);
            let (reach, unit) = (axis.widened(0.05).hi, shown.track.units.length);
            let quantity = format!("x and y / {unit}");
            let svg = orbit_plot(&OrbitPlot {
                label: &self.label(shown, ORBIT, &quantity, ranges[i]),
                reach,
                unit,
                wall,
                path: &paths[i],
            })?;
            cells.push(PanelCell {
                shown: place,
                svg,
                own_scale,
                data: data::places(shown.track, self.window),
                live: json!({
                    "kind": "orbit", "track": shown.at, "own": own_scale, "reach": reach, "unit": unit,
                    "wall": [wall.semi_axes[0], wall.semi_axes[1], wall.tilt_rad],
                }),
            });
        }
        let round = walls.iter().all(|w| w.semi_axes[0] == w.semi_axes[1]);
        let touching = tracks.iter().any(|track| !track.touching.is_empty());
        let mut legend = vec![Key::new("flight", FREE)];
        if touching {
            legend.push(Key::new("contact", TOUCHING));
        } else {
            legend[0].name = "path".to_owned();
        }
        let wall = if round {
            "clearance circle"
        } else {
            "clearance ellipse"
        };
        legend.push(Key::new(wall, LIMIT));
        Ok(PanelRow {
            heading: ORBIT,
            note: "Rotor against the centre of the inner ring. <span class=\"still\">Ring mark: start, dot: end.</span>\
                   <span class=\"moving\">Arrows: direction at equal times; dot: where it is at the time of all panels.</span>",
            legend,
            cells,
        })
    }

    fn modes(&self) -> Result<PanelRow, PlotError> {
        let rotor = ROTOR_MODES.map(|(mode, colour)| (mode.name(), colour));
        let supervisor = SUPERVISOR_MODES.map(|(mode, colour)| (mode.name(), colour));
        let any = |has: fn(&Track) -> bool| self.shown.iter().any(|s| has(s.track));
        // Every track gets a lane that one has, so that the panels stay comparable.
        let lanes = [
            any(|t| !t.rotor.is_empty()),
            any(|t| !t.supervisor.is_empty()),
        ];
        let mut cells = Vec::new();
        for (place, shown) in self.shown.iter().enumerate() {
            let track = shown.track;
            let all = [
                Lane {
                    name: "rotor",
                    classes: &rotor,
                    bands: &track.rotor,
                },
                Lane {
                    name: "supervisor",
                    classes: &supervisor,
                    bands: &track.supervisor,
                },
            ];
            let drawn: Vec<Lane<'_>> = (all.into_iter().zip(lanes))
                .filter_map(|(lane, there)| there.then_some(lane))
                .collect();
            let stretches: Vec<String> = (drawn.iter())
                .map(|lane| format!("{} of the {}", lane.bands.len(), lane.name))
                .collect();
            let label = format!("{}, modes: stretches, {}", shown.name, stretches.join(", "));
            cells.push(PanelCell {
                shown: place,
                svg: strip_plot(&label, self.time(track), &drawn)?,
                own_scale: false,
                data: data::stretches(&drawn, self.window, track.units.time),
                live: json!({
                    "kind": "modes", "track": shown.at,
                    "lanes": drawn.iter().map(|lane| lane.name).collect::<Vec<_>>(),
                }),
            });
        }
        let occurs = |class: usize, of: fn(&Track) -> &[_]| {
            let mut bands = self.shown.iter().flat_map(|s| of(s.track));
            bands.any(|band: &super::plot::thin::Band| band.class == class)
        };
        let rotor = rotor.iter().filter(|_| lanes[0]);
        let supervisor = (supervisor.iter().enumerate())
            .filter(|(class, _)| occurs(*class, |track| &track.supervisor))
            .map(|(_, key)| key);
        Ok(PanelRow {
            heading: "Modes",
            note: match lanes[0] {
                true => {
                    "slip+: friction drives the rotor clockwise; slip-: counter-clockwise. Where modes \
                     share a pixel, the one that is rarest in the window is drawn."
                }
                false => {
                    "Where modes share a pixel, the one that is rarest in the window is drawn."
                }
            },
            legend: rotor
                .chain(supervisor)
                .map(|(name, colour)| Key::new(name, *colour))
                .collect(),
            cells,
        })
    }

    fn time(&self, track: &Track) -> TimeAxis<'_> {
        TimeAxis {
            window: self.window,
            unit: track.units.time,
            shaded: self.shaded,
        }
    }

    /// What a screen reader says of a figure.
    fn label(&self, shown: &Shown<'_>, heading: &str, quantity: &str, range: Interval) -> String {
        let (time, unit) = (self.window, shown.track.units.time);
        format!(
            "{}, {heading}: {quantity} between {:.4} and {:.4}, from {:.1} {unit} to {:.1} {unit}",
            shown.name, range.lo, range.hi, time.lo, time.hi
        )
    }
}

impl Key {
    fn new(name: &str, colour: RGBColor) -> Self {
        Self {
            name: name.to_owned(),
            colour: hex(colour),
            dashed: false,
        }
    }
}

fn legend(chart: &Chart, tracks: &[&Track]) -> Vec<Key> {
    let there = |line: &&super::quantities::Line| {
        (tracks.iter()).any(|track| track.column(&line.column).is_some())
    };
    let lines = (chart.lines.iter().filter(there)).map(|line| Key::new(&line.column, line.colour));
    let limit = (chart.limit.as_ref()).map(|limit| Key {
        dashed: true,
        ..Key::new(limit.name, LIMIT)
    });
    lines.chain(limit).collect()
}
