//! A progress bar for commands that take their time, and their threads.

use crate::cli::error::CommandError;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::{Duration, Instant};

/// A progress bar that shows itself only when the work takes longer than a second.
pub(crate) struct LateProgress {
    bar: ProgressBar,
    started: Instant,
}

impl LateProgress {
    /// A bar of `total` pieces of work, called `what`.
    pub(crate) fn new(total: u64, what: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
        let template = format!("{{bar:40}} {{percent:>3}} % of {what}, {{eta}} left");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        Self {
            bar,
            started: Instant::now(),
        }
    }

    pub(crate) fn add(&self, done: u64) {
        self.bar.inc(done);
        if self.bar.is_hidden() && self.started.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
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
