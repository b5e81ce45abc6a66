//! A policy's run as `run` wants it: its rows written while it goes on, and kept as far as a report needs them.

use crate::device::whole_levitation::WholeLevitationParams;
use crate::run::closed_loop::{Accuracy, Recorders, RunError, fits_in_memory, record};
use crate::run::figures::Figures;
use crate::run::overview::{AxisTrack, Overview};
use crate::run::supervision::{Happenings, SupervisionCount};
use crate::run::trace::{AxisRow, Recorder, Trace, TraceRow};
use crate::run::trace_file::TraceFile;
use crate::run::verdict::{MachineRun, PolicyRun, Verdict};
use crate::run::verify::{Check, Track, Verification, check, verification, worst};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use std::io::Write;
use std::time::{Duration, Instant};

/// So long is run beforehand \[s\]: a program that has just begun is slow at first, and that is none of the plant's time.
const WARM_UP_S: f64 = 0.05;

/// Everything that listens to a run.
struct Recording<'a, W: Write + Send> {
    file: Option<&'a mut TraceFile<W, TraceRow>>,
    /// Only for checks.
    track: Option<Track>,
    overview: Overview,
    supervision: SupervisionCount,
    happenings: Happenings,
}

impl<W: Write + Send> Recorder for Recording<'_, W> {
    fn row(&mut self, row: &TraceRow) {
        if let Some(file) = &mut self.file {
            file.row(row);
        }
        if let Some(track) = &mut self.track {
            track.row(row);
        }
        self.overview.row(row);
        self.supervision.row(row);
        self.happenings.row(row);
    }
}

impl<'a, W: Write + Send> Recording<'a, W> {
    fn new(file: Option<&'a mut TraceFile<W, TraceRow>>, checked: bool) -> Self {
        Self {
            file,
            track: checked.then(Track::default),
            overview: Overview::default(),
            supervision: SupervisionCount::default(),
            happenings: Happenings::default(),
        }
    }

    fn writing(&self) -> Duration {
        self.file
            .as_ref()
            .map_or(Duration::ZERO, |file| file.took())
    }
}

/// Trace files of a run.
pub struct TraceFiles<W: Write + Send> {
    /// Of each plane.
    pub planes: Vec<TraceFile<W, TraceRow>>,
    /// Of the rotor's axis, where it has one.
    pub axis: Option<TraceFile<W, AxisRow>>,
}

/// Listens to the axis.
struct AxisRecording<'a, W: Write + Send> {
    file: Option<&'a mut TraceFile<W, AxisRow>>,
    track: AxisTrack,
}

impl<W: Write + Send> Recorder<AxisRow> for AxisRecording<'_, W> {
    fn row(&mut self, row: &AxisRow) {
        if let Some(file) = &mut self.file {
            file.row(row);
        }
        self.track.row(row);
    }
}

/// Runs a policy of a scene, and then once more for each of `checks`; its rows go to files where there are any. A check that
/// cannot be trusted leaves the run as it is.
///
/// # Errors
/// [`RunError`] of the run.
pub fn recorded<W: Write + Send>(
    scene: &Scene,
    kind: PolicyKind,
    checks: &[Scene],
    files: Option<&mut TraceFiles<W>>,
    on_tick: &mut dyn FnMut(u64),
) -> Result<MachineRun, RunError> {
    let checked = !checks.is_empty();
    if checked {
        fits_in_memory(scene, kind.name())?;
    }
    warm_up(scene, kind);
    let (planes, axis) = match files {
        Some(files) => (Some(&mut files.planes), files.axis.as_mut()),
        None => (None, None),
    };
    let mut files = planes.into_iter().flatten();
    let mut recordings: Vec<Recording<'_, W>> = (scene.planes.iter())
        .map(|_| Recording::new(files.next(), checked))
        .collect();
    let track = AxisTrack::default();
    let mut axis = AxisRecording { file: axis, track };
    let started = Instant::now();
    let recorders = Recorders {
        planes: (recordings.iter_mut())
            .map(|recording| recording as &mut dyn Recorder)
            .collect(),
        axis: match scene.has_axis() {
            true => Some(&mut axis),
            false => None,
        },
    };
    let ended = record(scene, kind, recorders, Accuracy::default(), on_tick)?;
    let writing: Duration = recordings.iter().map(Recording::writing).sum();
    let writing = writing
        + axis
            .file
            .as_ref()
            .map_or(Duration::ZERO, |file| file.took());
    let elapsed = started.elapsed().saturating_sub(writing);
    let tracks: Vec<Track> = (recordings.iter_mut())
        .filter_map(|recording| recording.track.take())
        .collect();
    // By check, and then by plane.
    let checks = checked.then(|| -> Result<Vec<Vec<Check>>, String> {
        let each = checks.iter();
        let checked = each.map(|scene| check(scene, kind, &tracks, on_tick));
        checked
            .collect::<Result<_, _>>()
            .map_err(|error| error.to_string())
    });
    let figures: Vec<Figures> = ended.iter().map(|(figures, _)| figures.clone()).collect();
    let mut runs = Vec::new();
    for (i, ((figures, read_out), recording)) in ended.into_iter().zip(recordings).enumerate() {
        let verification = checks.as_ref().map(|checks| match checks {
            Ok(checks) => {
                let own = checks.iter().map(|of_planes| of_planes[i].clone());
                Ok(verification(&figures, &tracks[i], own.collect()))
            }
            Err(error) => Err(error.clone()),
        });
        let mut trace = recording.overview.into_trace();
        trace.read_out = read_out;
        runs.push(PolicyRun {
            name: kind.name().to_owned(),
            verdict: Verdict::new(figures, scene, elapsed),
            verification,
            supervision: recording.supervision.ended(trace.read_out.as_ref()),
            happenings: recording.happenings,
            trace,
        });
    }
    let policy = kind.name();
    let figures = Figures::of_machine(&figures).ok_or(RunError::Incomplete { policy })?;
    let checked: Vec<&Verification> = runs.iter().filter_map(PolicyRun::checked).collect();
    let whole = PolicyRun {
        name: policy.to_owned(),
        verdict: Verdict::new(figures, scene, elapsed),
        verification: match checks {
            Some(Ok(_)) => Some(Ok(worst(&checked))),
            Some(Err(error)) => Some(Err(error)),
            None => None,
        },
        supervision: match &runs[..] {
            [only] => only.supervision.clone(),
            _ => None,
        },
        happenings: Happenings::default(),
        trace: Trace::default(),
    };
    Ok(MachineRun {
        whole,
        planes: runs,
        axis: axis.track,
    })
}

/// Whatever comes of it comes again.
fn warm_up(scene: &Scene, kind: PolicyKind) {
    // A process of the user's is not started for nothing.
    if matches!(scene.levitation, Some(WholeLevitationParams::External(_))) {
        return;
    }
    let duration_s = scene.duration_s.min(WARM_UP_S);
    let brief = Scene {
        duration_s,
        ..scene.clone()
    };
    let (unheard, accuracy) = (Recorders::default(), Accuracy::default());
    let _again = record(&brief, kind, unheard, accuracy, &mut |_| {});
}
