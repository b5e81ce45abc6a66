//! A policy's run as `run` wants it: its rows written while it goes on, and kept as far as a report needs them.

use crate::run::closed_loop::{Rigour, RunError, record};
use crate::run::overview::Overview;
use crate::run::supervision::{Happenings, SupervisionCount};
use crate::run::trace::{Recorder, TraceRow};
use crate::run::trace_file::TraceFile;
use crate::run::verdict::{PolicyRun, Verdict};
use crate::run::verify::{Check, Track, check, verification};
use crate::scene::Scene;
use crate::scene::policy_kind::PolicyKind;
use std::io::Write;
use std::time::{Duration, Instant};

/// So long is run beforehand \[s\]: a program that has just begun is slow at first, and that is none of the plant's time.
const WARM_UP_S: f64 = 0.05;

/// Everything that listens to a run.
struct Recording<'a, W: Write + Send> {
    file: Option<&'a mut TraceFile<W>>,
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

/// Runs a policy of a scene, and then once more for each of `checks`; its trace goes to `file` where there is one. A check that
/// cannot be trusted leaves the run as it is.
///
/// # Errors
/// [`RunError`] of the run.
pub fn recorded<W: Write + Send>(
    scene: &Scene,
    kind: PolicyKind,
    checks: &[Scene],
    file: Option<&mut TraceFile<W>>,
    on_tick: &mut dyn FnMut(u64),
) -> Result<PolicyRun, RunError> {
    warm_up(scene, kind);
    let mut recording = Recording {
        file,
        track: (!checks.is_empty()).then(Track::default),
        overview: Overview::default(),
        supervision: SupervisionCount::default(),
        happenings: Happenings::default(),
    };
    let started = Instant::now();
    let (figures, read_out) = record(scene, kind, &mut recording, Rigour::default(), on_tick)?;
    let writing = recording.file.map_or(Duration::ZERO, |file| file.took());
    let elapsed = started.elapsed().saturating_sub(writing);
    let verification = recording.track.map(|track| {
        let all: Result<Vec<Check>, RunError> = (checks.iter())
            .map(|scene| check(scene, kind, &track, on_tick))
            .collect();
        all.map(|all| verification(&figures, &track, all))
            .map_err(|error| error.to_string())
    });
    let mut trace = recording.overview.into_trace();
    trace.read_out = read_out;
    Ok(PolicyRun {
        name: kind.name().to_owned(),
        verdict: Verdict::new(figures, scene, elapsed),
        verification,
        supervision: recording.supervision.ended(trace.read_out.as_ref()),
        happenings: recording.happenings,
        trace,
    })
}

/// Whatever comes of it comes again.
fn warm_up(scene: &Scene, kind: PolicyKind) {
    let duration_s = scene.duration_s.min(WARM_UP_S);
    let brief = Scene {
        duration_s,
        ..scene.clone()
    };
    let (mut unheard, rigour) = (Overview::default(), Rigour::default());
    let _again = record(&brief, kind, &mut unheard, rigour, &mut |_| {});
}
