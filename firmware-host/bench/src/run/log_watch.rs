//! A log of a machine, of whatever program, watched by the supervisor as if it had been there in shadow: what it would have seen
//! is in flight records as firmware writes them.

use crate::log_file::{COMMAND, LogError, LogFile, POSITION, Renamed, SPIN, TIME};
use crate::run::controller::written;
use crate::scene::Scene;
use crate::scene::diagnostic::SceneError;
use crate::scene::spec::Spec;
use serde::Serialize;
use std::path::Path;
use supervisor::{Command, Record, RotorSupervisor, Sample, Stamp, Status, Supervisor};

/// For x and y. Of a scene with several planes the plane's name stands before all names of columns but time and spin, with a dot.
const DELIVERED: [&str; 2] = ["delivered_x_n", "delivered_y_n"];

/// Ticks of a record.
const RECORD: usize = 512;

/// An event in a log.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct InLog {
    /// When the supervisor would have engaged, in the log's time \[s\].
    pub from_s: f64,
    /// When it would have given the bearing back; null where the log ends before.
    pub to_s: Option<f64>,
}

/// What a log is, and what of it the supervisor had.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LogSummary {
    pub rows: usize,
    pub rate_hz: f64,
    pub from_s: f64,
    pub to_s: f64,
    /// Planes of which there are positions, by their numbers in the scene.
    pub planes: Vec<usize>,
    /// The farthest from the middle that each plane was read \[clearances\]; null where no reading was a number.
    pub largest_radius: Vec<Option<f64>>,
    /// Whether the log has forces, of every plane.
    pub has_force: bool,
    /// Whether the log has the spin, or it is the scene's.
    pub has_spin: bool,
    /// What of its columns counts as if it was not there, in sentences.
    pub left_out: Vec<String>,
    pub events: Vec<InLog>,
}

impl LogSummary {
    /// In words: what it is, what it lacks, and when its events begin.
    pub fn sentences(&self) -> String {
        let mut out = format!(
            "A log of {} rows at {:.6} kHz, from {:.6} s to {:.6} s, watched by the supervisor of the scene",
            self.rows,
            1e-3 * self.rate_hz,
            self.from_s,
            self.to_s
        );
        out += match (self.has_force, self.has_spin) {
            (true, true) => ".",
            (true, false) => "; it has no spin: the scene's is taken.",
            (false, true) => "; it has no force: what the bearing did counts as load.",
            (false, false) => {
                "; it has no force, which counts as load, and no spin: the scene's is taken."
            }
        };
        for sentence in &self.left_out {
            out += &format!(" {sentence}");
        }
        let radii: Vec<String> = (self.largest_radius.iter())
            .map(|radius| match radius {
                Some(radius) => format!("{radius:.2} of the clearance"),
                None => "not known, for no position is a number".to_owned(),
            })
            .collect();
        out += &format!(" Largest radius read: {}.", radii.join(" and "));
        if self
            .largest_radius
            .iter()
            .flatten()
            .any(|radius| *radius > BEYOND)
        {
            out += " No rotor goes so far: the unit of the readings is another, which --column measured_x_m=COLUMN*FACTOR turns \
                    into m, or they do not count from the middle.";
        }
        match &self.events[..] {
            [] => out += " The supervisor would not have engaged: there is no event in it.",
            events => {
                let begun: Vec<String> = events
                    .iter()
                    .map(|event| match event.to_s {
                        Some(to_s) => format!("{:.6} s to {to_s:.6} s", event.from_s),
                        None => format!("{:.6} s to the end, where it is not over", event.from_s),
                    })
                    .collect();
                out += &format!(" It would have engaged from {}.", begun.join(", from "));
            }
        }
        out
    }
}

/// A log that was watched.
pub struct Watched {
    pub summary: LogSummary,
    /// Flight records of its events, one after the other.
    pub records: Vec<u8>,
}

/// Rows of a plane.
struct Rows {
    position_m: Vec<[f64; 2]>,
    /// Readings that were left out: no length of a machine.
    no_length: usize,
    command_n: Option<Vec<[f64; 2]>>,
    delivered_n: Option<Vec<[f64; 2]>>,
}

impl Rows {
    fn of(log: &LogFile, prefix: &str) -> Result<Self, LogError> {
        let named = |names: [&str; 2]| names.map(|name| format!("{prefix}{name}"));
        let pair = |names: [&str; 2]| {
            let [x, y] = named(names);
            log.pair(TIME, [&x, &y])
        };
        let if_there = |names: [&str; 2]| {
            let there = named(names).iter().any(|name| log.has(name));
            there.then(|| pair(names)).transpose()
        };
        let mut position_m = pair(POSITION)?;
        let readings = position_m.iter_mut().flatten();
        let mut far: Vec<&mut f64> = readings.filter(|x| x.abs() > LONGEST_M).collect();
        far.iter_mut().for_each(|x| **x = f64::NAN);
        Ok(Self {
            no_length: far.len(),
            position_m,
            command_n: if_there(COMMAND)?,
            delivered_n: if_there(DELIVERED)?,
        })
    }

    fn sample(&self, row: usize, common: Sample) -> Sample {
        let at = |pairs: &Option<Vec<[f64; 2]>>| {
            let pair = pairs.as_ref().and_then(|pairs| pairs.get(row));
            pair.map(|pair| pair.map(|x| x as f32))
        };
        let (command, delivered) = (at(&self.command_n), at(&self.delivered_n));
        let mut status = common.status;
        status.set(Status::APPLIED_VALID, delivered.is_some());
        Sample {
            status,
            position_m: self.position_m[row].map(|x| x as f32),
            levitation_n: command.or(delivered).unwrap_or_default(),
            applied_n: delivered.unwrap_or_default(),
            ..common
        }
    }
}

/// Who watches: a plane, or both of a rotor together.
enum Watcher {
    Plane(Box<Supervisor<RECORD>>),
    Rotor(Box<RotorSupervisor<RECORD>>),
}

impl Watcher {
    /// Whether it has the bearing now.
    fn tick(&mut self, samples: &[Sample]) -> bool {
        let engaged = |command: &Command| command.mode.is_engaged();
        match (self, samples) {
            (Self::Plane(plane), [sample]) => engaged(&plane.tick(sample)),
            (Self::Rotor(rotor), [a, b]) => rotor.tick(&[*a, *b]).planes.iter().any(engaged),
            _ => false,
        }
    }

    /// Takes what has frozen.
    fn drain(&mut self, stamp: &Stamp, into: &mut Vec<u8>) {
        let mut write = |record: &Record<'_, f32, RECORD>| into.extend(written(record, stamp));
        match self {
            Self::Plane(plane) => {
                if let Some(record) = plane.record() {
                    write(&record);
                    plane.rearm();
                }
            }
            Self::Rotor(rotor) => rotor.collect(|_, record| write(record)),
        }
    }
}

/// Readings beyond are no lengths of a machine \[m\], in whatever unit of them.
const LONGEST_M: f64 = 1e6;
/// Nothing that touches a retainer bearing goes so far \[clearances\].
const BEYOND: f64 = 3.0;

/// Rates that are the same: times of a log are rounded.
const SAME_RATE: f64 = 1e-3;

/// Reads a log, and has the supervisors of a scene at the log's rate watch it.
///
/// # Errors
/// [`WatchError`].
pub fn watch(spec: &mut Spec, path: &Path, renamed: &[Renamed]) -> Result<Watched, WatchError> {
    let log = LogFile::of_ticks(path, renamed)?;
    let (period_s, ticks) = log.ticks(TIME)?;
    let rate_hz = 1.0 / period_s;
    let hz = spec
        .get("run.sample_rate_hz")?
        .and_then(toml::Value::as_float);
    if hz.is_none_or(|hz| (hz / rate_hz - 1.0).abs() > SAME_RATE) {
        spec.set("run.sample_rate_hz", rate_hz)?;
    }
    // A row has readings of both planes.
    spec.set("run.planes_in_turn", false)?;
    Ok(watched(&spec.resolve()?, &log, (period_s, &ticks))?)
}

/// Why a log is not watched.
#[derive(Debug, thiserror::Error)]
pub enum WatchError {
    /// The log.
    #[error(transparent)]
    Log(#[from] LogError),
    /// The scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// The same of a log whose rows stand at these ticks.
fn watched(
    scene: &Scene,
    log: &LogFile,
    (period_s, ticks): (f64, &[u32]),
) -> Result<Watched, LogError> {
    let (planes, rows) = rows(scene, log)?;
    let spin = log.beside_if_there(TIME, SPIN)?;
    let mut left_out = Vec::new();
    if spin.is_some_and(|spin| !spin.iter().any(|s| s.is_finite())) {
        left_out.push(format!("{SPIN} has no number in any row."));
    }
    let spin = spin.filter(|_| left_out.is_empty());
    let no_length: usize = rows.iter().map(|rows| rows.no_length).sum();
    if no_length > 0 {
        left_out.push(format!(
            "Readings of the position beyond {LONGEST_M:e} m, no length of a machine, count as unknown: {no_length}."
        ));
    }
    let mut watcher = watcher(scene, &planes)?;
    let times = log.column(TIME)?;
    let mut records = Vec::new();
    let mut events: Vec<InLog> = Vec::new();
    let status = Status::BEARING_ON | Status::SHADOW | Status::LEVITATED_BEFORE;
    let mut last = Vec::new();
    let mut engaged = false;
    for (row, sequence) in ticks.iter().enumerate() {
        let reported = spin.map_or(scene.start.spin_rad_s, |spin| spin[row]);
        let mut common = Sample {
            sequence: *sequence,
            status,
            spin_rad_s: reported as f32,
            ..Sample::default()
        };
        common.status.set(Status::SPIN_VALID, reported.is_finite());
        last.clear();
        last.extend(rows.iter().map(|of| of.sample(row, common)));
        let now = watcher.tick(&last);
        match (engaged, now) {
            (false, true) => events.push(InLog {
                from_s: times[row],
                to_s: None,
            }),
            (true, false) => {
                if let Some(event) = events.last_mut() {
                    event.to_s = Some(times[row]);
                }
            }
            _ => {}
        }
        engaged = now;
        watcher.drain(&stamp(times[row] - times[0], *sequence), &mut records);
    }
    // A record that is still open goes on for as long as it must, with a bearing that is off and nothing read.
    let (end_s, taken) = (period_s * ticks.len() as f64, records.len());
    for _ in 0..RECORD {
        for sample in &mut last {
            sample.sequence = sample.sequence.wrapping_add(1);
            sample.status.remove(Status::BEARING_ON);
            sample.position_m = [f32::NAN; 2];
        }
        watcher.tick(&last);
        let sequence = last.first().map_or(0, |sample| sample.sequence);
        watcher.drain(&stamp(end_s, sequence), &mut records);
        if records.len() > taken {
            break;
        }
    }
    let largest = planes.iter().zip(&rows).map(|(plane, rows)| {
        let radii = rows.position_m.iter().map(|[x, y]| x.hypot(*y));
        let largest_m = radii.filter(|r| r.is_finite()).reduce(f64::max);
        largest_m.map(|r| r / scene.clearance_m(*plane))
    });
    Ok(Watched {
        summary: LogSummary {
            rows: ticks.len(),
            rate_hz: 1.0 / period_s,
            from_s: times[0],
            to_s: times[times.len() - 1],
            largest_radius: largest.collect(),
            has_force: (rows.iter()).all(|r| r.command_n.is_some() || r.delivered_n.is_some()),
            has_spin: spin.is_some(),
            left_out,
            planes,
            events,
        },
        records,
    })
}

fn stamp(time_s: f64, sequence: u32) -> Stamp {
    Stamp {
        time_us: (1e6 * time_s).round() as u64,
        at_sequence: sequence,
        ..Stamp::default()
    }
}

/// The planes that have both a supervisor and positions in the log, and these.
fn rows(scene: &Scene, log: &LogFile) -> Result<(Vec<usize>, Vec<Rows>), LogError> {
    let with_supervisor = scene
        .planes
        .iter()
        .enumerate()
        .filter(|(_, p)| p.supervisor.is_some());
    let known: Vec<(usize, String)> = match scene.planes.len() {
        1 => with_supervisor.map(|(i, _)| (i, String::new())).collect(),
        _ => with_supervisor
            .map(|(i, p)| (i, format!("{}.", p.name)))
            .collect(),
    };
    let pairs = [POSITION, COMMAND, DELIVERED].concat();
    let of_planes = known
        .iter()
        .flat_map(|(_, prefix)| pairs.iter().map(move |name| format!("{prefix}{name}")));
    let common = [TIME, SPIN].map(str::to_owned);
    log.expect(&common.into_iter().chain(of_planes).collect::<Vec<_>>())?;
    let there = known.iter().filter(|(_, prefix)| {
        POSITION
            .iter()
            .any(|name| log.has(&format!("{prefix}{name}")))
    });
    let found: Vec<&(usize, String)> = there.collect();
    let Some((_, prefix)) = known.first() else {
        return Err(LogError::new(
            "no plane of the scene has a supervisor",
            "give the scene of the machine, with a [magnet]",
        ));
    };
    if found.is_empty() {
        // Names what is missing, and what is there.
        log.column(&format!("{prefix}{}", POSITION[0]))?;
    }
    let rows: Result<Vec<Rows>, LogError> = found.iter().map(|(_, p)| Rows::of(log, p)).collect();
    Ok((found.iter().map(|(plane, _)| *plane).collect(), rows?))
}

fn watcher(scene: &Scene, planes: &[usize]) -> Result<Watcher, LogError> {
    if let Some(both) = scene.supervised()
        && planes == both
        && let Some(rotor) = scene.supervisor_recording()
    {
        return Ok(Watcher::Rotor(Box::new(rotor)));
    }
    let [plane] = planes else {
        return Err(LogError::new(
            "positions of several planes that no supervisor of the scene has together",
            "give those of one plane, or of the two that have magnets",
        ));
    };
    let made = (scene.planes[*plane].supervisor).and_then(|c| Supervisor::new(&c).ok());
    let help = "give a scene of the machine that run takes with the policy supervisor";
    let made = made.ok_or_else(|| LogError::new("the scene has no supervisor", help))?;
    Ok(Watcher::Plane(Box::new(made)))
}
