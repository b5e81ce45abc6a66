//! A progress bar for commands that take their time, and their threads.

use crate::cli::error::{CommandError, say};
use firmware_studies::campaign::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// A progress bar that shows itself only when the work takes longer than a second.
pub(crate) struct LateProgress(ProgressBar);

/// Where nobody watches a bar a line is said so often \[s\].
const LINE_EVERY_S: u64 = 60;

/// A bar of runs with their rate; in a log, which is no terminal, lines in its place.
pub(crate) struct RunProgress {
    bar: LateProgress,
    /// Lines said so far, where lines are said.
    lines: Option<AtomicU64>,
}

impl RunProgress {
    pub(crate) fn new(total: u64) -> Self {
        let bar = LateProgress::new(total, "runs");
        let template = "{bar:40} {percent:>3} % of {len} runs, {per_sec}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.0.set_style(style);
        }
        let watched = std::io::stderr().is_terminal();
        let lines = (!watched).then(AtomicU64::default);
        Self { bar, lines }
    }

    /// One more is done.
    pub(crate) fn add(&self) {
        self.bar.add(1);
        let bar = &self.bar.0;
        let due = bar.elapsed().as_secs() / LINE_EVERY_S;
        let (Some(lines), true) = (&self.lines, due > 0) else {
            return;
        };
        if lines.fetch_max(due, Ordering::Relaxed) < due {
            say(format_args!(
                "{} of {} runs, {:.1} a second, {} min left",
                bar.position(),
                bar.length().unwrap_or_default(),
                bar.per_sec(),
                bar.eta().as_secs().div_ceil(60)
            ));
        }
    }

    /// So many had been done before.
    pub(crate) fn skip(&self, runs: u64) {
        self.bar.0.dec_length(runs);
    }

    pub(crate) fn finish(&self) {
        self.bar.finish();
    }
}

impl Default for LateProgress {
    fn default() -> Self {
        Self(ProgressBar::with_draw_target(
            None,
            ProgressDrawTarget::hidden(),
        ))
    }
}

impl Progress for LateProgress {
    fn begin(&self, pieces: u64, what: &str) {
        self.0.reset();
        self.0.set_length(pieces);
        let template = format!("{{bar:40}} {{percent:>3}} % of {what}, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            self.0.set_style(style);
        }
    }

    fn add(&self, pieces: u64) {
        self.0.inc(pieces);
        if self.0.is_hidden() && self.0.elapsed() > Duration::from_secs(1) {
            self.0.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl LateProgress {
    /// A bar of `total` pieces of work, called `what`.
    pub(crate) fn new(total: u64, what: &str) -> Self {
        let bar = Self::default();
        bar.begin(total, what);
        bar
    }

    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}

/// How many threads a command may use.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct Threads {
    /// Threads to use [default: all cores]. Results do not depend on it.
    #[arg(long, allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

impl Threads {
    /// A pool of so many, or of one for each core.
    pub(crate) fn pool(self) -> Result<rayon::ThreadPool, CommandError> {
        rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads.map_or(0, usize::from))
            .build()
            .map_err(|e| CommandError::other("starting threads", e))
    }
}
