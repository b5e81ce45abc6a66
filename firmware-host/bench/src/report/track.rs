//! What panels show of a run, of a rotor's axis or of a flight record: columns over one time axis, modes, events.

use std::borrow::Cow;
use std::f64::consts::TAU;

use plant_model::machine::params::MachineParams;
use plant_model::{ContactMode, V2};
use plotters::style::RGBColor;

use crate::record::ticks::{Tick, Ticks, Units};
use crate::report::plot::thin::{Band, Interval, PathPoint, drawable};
use crate::report::plot::{TOUCHING, Wall};
use crate::report::summary::SceneSummary;
use crate::run::outcome::Outcome;
use crate::run::overview::AxisTrack;
use crate::run::supervision::names;
use crate::run::trace::TraceRow;
use crate::run::verdict::PolicyRun;

/// Modes of the plant with their colours, in the order of [`Track::rotor`].
pub(super) const ROTOR_MODES: [(ContactMode, RGBColor); 5] = [
    (ContactMode::Flight, RGBColor(0xd5, 0xde, 0xe8)),
    (ContactMode::SlipPositive, TOUCHING),
    (ContactMode::SlipNegative, RGBColor(0x2f, 0x80, 0xc9)),
    (ContactMode::Roll, RGBColor(0x7a, 0x4f, 0xb5)),
    (ContactMode::Seated, RGBColor(0x4a, 0x52, 0x5c)),
];

/// Modes of the supervisor with their colours, in the order of [`Track::supervisor`].
pub(super) const SUPERVISOR_MODES: [(supervisor::Mode, RGBColor); 8] = [
    (supervisor::Mode::Levitated, RGBColor(0xa8, 0xd5, 0xba)),
    (supervisor::Mode::Approach, RGBColor(0xf3, 0xc0, 0x6b)),
    (supervisor::Mode::Bounce, RGBColor(0xe3, 0x8f, 0x8f)),
    (supervisor::Mode::BackwardWhirl, RGBColor(0xc9, 0xa7, 0xe0)),
    (supervisor::Mode::Pinned, RGBColor(0xd6, 0xc6, 0xa5)),
    (supervisor::Mode::Handover, RGBColor(0x9d, 0xb7, 0xe8)),
    (supervisor::Mode::HandedBack, RGBColor(0xa8, 0xd5, 0xa2)),
    (supervisor::Mode::SensorFault, RGBColor(0xc4, 0xc9, 0xd0)),
];

/// Something to be compared over time: a policy's run, a recorded event, a simulation of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    pub(super) name: String,
    /// How it ended, of a run.
    pub(super) outcome: Option<Outcome>,
    pub(super) units: TrackUnits,
    /// Times of all columns, ascending.
    pub(super) t: Vec<f64>,
    /// By their names, as long as the times.
    pub(super) columns: Vec<(Cow<'static, str>, Vec<f64>)>,
    /// Whether the rotor touches at each time; empty where that is not known.
    pub(super) touching: Vec<bool>,
    /// Classes are places in [`ROTOR_MODES`].
    pub(super) rotor: Vec<Band>,
    /// Classes are places in [`SUPERVISOR_MODES`].
    pub(super) supervisor: Vec<Band>,
    /// Dashed lines of charts, by their names.
    pub(super) limits: Vec<(&'static str, f64)>,
    pub(super) wall: Option<Wall>,
    /// What happened, in time order.
    pub(super) events: Vec<TrackEvent>,
}

/// A tick at which something happened or the supervisor's mode changed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TrackEvent {
    pub(super) t: f64,
    pub(super) mode: &'static str,
    /// What bound the command.
    pub(super) limits: String,
    pub(super) events: String,
}

/// Names of the units of a track.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TrackUnits {
    pub(super) time: &'static str,
    pub(super) length: &'static str,
    pub(super) force: &'static str,
    /// Digits behind the point of a time.
    pub(super) decimals: usize,
}

impl TrackUnits {
    /// Those of a record, with how many of each one tick, one clearance and one cap are.
    pub(super) fn of(units: Units) -> (Self, [f64; 3]) {
        let (length, mm) = (units.clearance_m)
            .map_or(("clearances", 1.0), |clearance_m| ("mm", 1e3 * clearance_m));
        let (force, newtons) = (units.force_max_n).map_or(("caps", 1.0), |cap_n| ("N", cap_n));
        let (time, ms) = (units.sample_rate_hz).map_or(("ticks", 1.0), |rate| ("ms", 1e3 / rate));
        let decimals = if time == SI.time { SI.decimals } else { 0 };
        let names = Self {
            time,
            length,
            force,
            decimals,
        };
        (names, [ms, mm, newtons])
    }
}

/// A column of a run: its name, and its value in a row.
type ColumnOf = (&'static str, fn(&TraceRow) -> f64);

const SI: TrackUnits = TrackUnits {
    time: "ms",
    decimals: 3,
    length: "mm",
    force: "N",
};

impl Track {
    pub(super) fn new(name: &str, units: TrackUnits) -> Self {
        Self {
            name: name.to_owned(),
            outcome: None,
            units,
            t: Vec::new(),
            columns: Vec::new(),
            touching: Vec::new(),
            rotor: Vec::new(),
            supervisor: Vec::new(),
            limits: Vec::new(),
            wall: None,
            events: Vec::new(),
        }
    }

    /// Of a policy's run, in mm, N and ms.
    pub fn of_run(scene: &SceneSummary, run: &PolicyRun) -> Self {
        let rows = || run.trace.rows.iter().filter(|r| drawable(r.plant.t_s));
        let column = |value: fn(&TraceRow) -> f64| rows().map(value).collect();
        let columns: [ColumnOf; 8] = [
            ("x", |row| 1e3 * radial(row).x),
            ("y", |row| 1e3 * radial(row).y),
            ("r", |row| 1e3 * radial(row).norm()),
            ("normal force", |row| row.plant.normal_force_n),
            ("commanded", |row| row.commanded_n.norm()),
            ("delivered", |row| row.plant.delivered_n.norm()),
            ("v_t", tangential_speed),
            ("spin", |row| row.plant.spin_rad_s / TAU),
        ];
        let spin = rows().next().map_or(0.0, |row| row.plant.spin_rad_s);
        // Backward is against the spin that the run starts with; without spin, as if counter-clockwise.
        let whirl = scene.whirl_speed_m_s.abs() * if spin < 0.0 { 1.0 } else { -1.0 };
        let mut limits = vec![
            ("clearance", 1e3 * scene.clearance_m),
            ("counts as whirl", whirl),
        ];
        limits.extend(scene.force_max_n.map(|cap| ("force cap", cap)));
        let happenings = run.happenings.all.iter().map(|happening| {
            let supervisor = happening.supervisor;
            TrackEvent {
                t: 1e3 * happening.t_s,
                mode: supervisor.mode.name(),
                limits: names(supervisor.limits.iter_names()),
                events: names(supervisor.events.iter_names()),
            }
        });
        let rotor = |row: &TraceRow| {
            let mode = row.plant.mode;
            ROTOR_MODES.iter().position(|known| known.0 == mode)
        };
        let supervisor = |row: &TraceRow| row.supervisor_mode().and_then(supervisor_class);
        let t: Vec<f64> = column(|row| 1e3 * row.plant.t_s);
        Self {
            outcome: Some(run.verdict.figures.outcome),
            columns: (columns.into_iter())
                .map(|(name, value)| (name.into(), column(value)))
                .collect(),
            touching: rows().map(|row| row.plant.mode.in_contact()).collect(),
            rotor: bands(t.iter().copied().zip(rows().map(rotor))),
            supervisor: bands(t.iter().copied().zip(rows().map(supervisor))),
            limits,
            wall: Some(wall(scene)),
            events: happenings.collect(),
            t,
            ..Self::new(&run.name, SI)
        }
    }

    /// Of a flight record, or of what a simulation of it recorded: in mm, N and ms where the units are known, else in
    /// clearances, force caps and ticks.
    pub fn of_ticks(name: &str, ticks: &Ticks, units: Units) -> Self {
        let (names, [ms, mm, newtons]) = TrackUnits::of(units);
        // A ring that was written down from elsewhere ends before it begins.
        let mut all: Vec<&Tick> = ticks.ticks.iter().collect();
        all.sort_by_key(|tick| tick.tick);
        let t: Vec<f64> = all.iter().map(|tick| ms * tick.tick as f64).collect();
        // A reading that was not believed is nowhere: what cannot be drawn is left out.
        let position = |of: fn([f64; 2]) -> f64| {
            let seen = |tick: &&Tick| if tick.believed { mm } else { f64::NAN };
            let values = all.iter().map(|tick| seen(tick) * of(tick.position));
            values.collect::<Vec<_>>()
        };
        let commanded = |of: fn([f64; 2]) -> f64| {
            let values = all.iter().map(|tick| newtons * of(tick.force));
            values.collect::<Vec<_>>()
        };
        let norm = |[x, y]: [f64; 2]| x.hypot(y);
        let known =
            |name: &str| (SUPERVISOR_MODES.iter()).position(|(mode, _)| mode.name() == name);
        let modes = all.iter().map(|tick| known(tick.mode));
        Self {
            columns: vec![
                ("x".into(), position(|p| p[0])),
                ("y".into(), position(|p| p[1])),
                ("r".into(), position(norm)),
                ("commanded".into(), commanded(norm)),
                ("F_x".into(), commanded(|f| f[0])),
                ("F_y".into(), commanded(|f| f[1])),
            ],
            supervisor: bands(t.iter().copied().zip(modes)),
            limits: vec![("clearance", mm), ("force cap", newtons)],
            wall: Some(Wall {
                semi_axes: [mm; 2],
                tilt_rad: 0.0,
            }),
            events: (ticks.turning_points())
                .map(|tick| TrackEvent {
                    t: ms * tick.tick as f64,
                    mode: tick.mode,
                    limits: tick.limits.join(" "),
                    events: tick.events.join(" "),
                })
                .collect(),
            t,
            ..Self::new(name, names)
        }
    }

    /// The same by so much later, in its unit of time.
    #[must_use]
    pub fn later(mut self, by: f64) -> Self {
        self.t.iter_mut().for_each(|t| *t += by);
        self.events.iter_mut().for_each(|event| event.t += by);
        for band in self.rotor.iter_mut().chain(&mut self.supervisor) {
            band.span.lo += by;
            band.span.hi += by;
        }
        self
    }

    /// Of the axis of a whole rotor: slope, bending of each mode, bending energy.
    pub(super) fn of_axis(name: &str, machine: &MachineParams, axis: &AxisTrack) -> Self {
        let rows = &axis.rows;
        let slope = |along: usize| {
            let values = rows.iter().map(|row| 1e3 * row.axis.tilt.position[along]);
            values.collect::<Vec<_>>()
        };
        let mut columns = vec![("dx/dz".into(), slope(0)), ("dy/dz".into(), slope(1))];
        for mode in 0..machine.rotor.bending().len() {
            let amplitude = rows
                .iter()
                .map(|row| 1e6 * row.bending[mode].position.norm());
            columns.push((bending_name(mode), amplitude.collect()));
        }
        let energy = rows.iter().map(|row| row.axis.bending_j);
        columns.push(("bending energy".into(), energy.collect()));
        Self {
            t: rows.iter().map(|row| 1e3 * row.t_s).collect(),
            columns,
            ..Self::new(name, SI)
        }
    }

    /// Values of a column, where the track has it.
    pub(super) fn column(&self, name: &str) -> Option<&[f64]> {
        let found = self.columns.iter().find(|(known, _)| known == name);
        found.map(|(_, values)| &values[..])
    }

    /// A limit by its name, where it can be drawn.
    pub(super) fn limit(&self, name: &str) -> Option<f64> {
        let found = self.limits.iter().find(|(known, _)| *known == name)?;
        Some(found.1).filter(|at| drawable(*at))
    }

    /// Whether it says where the rotor was at each of its times.
    pub(super) fn has_path(&self) -> bool {
        self.column("x").is_some() && self.column("y").is_some()
    }

    /// The rotor's path, without what cannot be drawn.
    pub(super) fn path(&self) -> Vec<PathPoint> {
        let [Some(x), Some(y)] = ["x", "y"].map(|name| self.column(name)) else {
            return Vec::new();
        };
        let touching = self
            .touching
            .iter()
            .copied()
            .chain(std::iter::repeat(false));
        let points = x.iter().zip(y).zip(touching);
        (points.map(|((x, y), touching)| (*x, *y, touching)))
            .filter(|p| drawable(p.0) && drawable(p.1))
            .collect()
    }

    /// From the first to the last contact or change of the supervisor's mode.
    pub(super) fn eventful(&self) -> Option<Interval> {
        let contacts = self.t.iter().zip(&self.touching);
        let contacts = contacts.filter_map(|(t, touching)| touching.then_some(*t));
        let changes = self.supervisor.iter().skip(1).map(|band| band.span.lo);
        Interval::of(contacts.chain(changes))
    }
}

/// Name of the column of a bending mode, from 0.
pub(super) fn bending_name(mode: usize) -> Cow<'static, str> {
    format!("mode {}", mode + 1).into()
}

/// Rotor against the centre of the ring \[m\].
fn radial(row: &TraceRow) -> V2 {
    row.plant.position_m - row.plant.inner_ring.position
}

fn tangential_speed(row: &TraceRow) -> f64 {
    let (r, v) = (
        radial(row),
        row.plant.velocity_m_s - row.plant.inner_ring.velocity,
    );
    // Exactly in the centre there is no direction to be tangential to.
    if r.norm() > 0.0 {
        r.perp(&v) / r.norm()
    } else {
        0.0
    }
}

fn wall(scene: &SceneSummary) -> Wall {
    let circle = Some(1e3 * scene.clearance_m)
        .filter(|c| drawable(*c))
        .unwrap_or(0.0);
    let (ellipticity, tilt_rad) = scene.out_of_round.unwrap_or_default();
    Wall {
        semi_axes: [1.0 + ellipticity, 1.0 - ellipticity].map(|share| share * circle),
        tilt_rad,
    }
}

fn supervisor_class(mode: supervisor::Mode) -> Option<usize> {
    SUPERVISOR_MODES.iter().position(|known| known.0 == mode)
}

/// Stretches of one class; each lasts until the next one begins.
fn bands(classes: impl Iterator<Item = (f64, Option<usize>)>) -> Vec<Band> {
    let mut bands: Vec<Band> = Vec::new();
    for (t, class) in classes {
        let (Some(now), Some(class)) = (Interval::of([t]), class) else {
            continue;
        };
        if let Some(last) = bands.last_mut() {
            last.span = last.span.with(now);
        }
        if bands.last().is_none_or(|last| last.class != class) {
            bands.push(Band { class, span: now });
        }
    }
    bands
}
