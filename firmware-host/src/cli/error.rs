//! Why a command failed, and how its text reaches the terminal.

use crate::cli::output::OutputError;
use firmware_bench::run::closed_loop::RunError;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::sweep::error::SweepError;
use firmware_studies::on_target::images::ImageError;
use firmware_studies::on_target::measure::TargetError;
use miette::MietteHandlerOpts;
use serde::Serialize;
use std::io::{IsTerminal, Write};

/// Why a command failed.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CommandError {
    /// The scene is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The sweep is wrong, or another than what is in its folder.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Sweep(#[from] SweepError),
    /// The results cannot be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Output(#[from] OutputError),
    /// A run ended without a result that can be trusted.
    #[error(transparent)]
    #[diagnostic(help("nothing was written"))]
    Run(RunError),
    /// The controller that the scene names cannot be set up.
    #[error("{message}")]
    #[diagnostic(help("{help}"))]
    Controller {
        /// Which, and why.
        message: String,
        /// What to do.
        help: String,
    },
    /// Some policies' runs, or their checks, ended without a result that can be trusted.
    #[error("{}", .0.join("\n"))]
    #[diagnostic(help("results were written, and what cannot be trusted is marked in them"))]
    Untrusted(Vec<String>),
    /// A policy ends with another outcome when its run is checked.
    #[error("{}", list(.0))]
    #[diagnostic(help(
        "results were written, with the checks in them; the outcome hangs on errors of integration: \
         a smaller run.rtol may settle it, or the scene is too sensitive to be decided"
    ))]
    Contradicted(Vec<Contradiction>),
    /// The targets could not be measured.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Target(#[from] TargetError),
    /// What was measured on the targets is not what it should be.
    #[error("{}", .0.join("\n"))]
    #[diagnostic(help(
        "results were printed; docs/src/measured/target.md says when a budget may be raised"
    ))]
    Targets(Vec<String>),
    /// Claims of a study that do not hold.
    #[error("{}", .0.join("\n"))]
    #[diagnostic(help("results were printed; without --strict this is no error"))]
    Claims(Vec<String>),
    /// Numbers on the command line, or what a scene lacks for this command.
    #[error("{message}")]
    #[diagnostic(help("{help}"))]
    Numbers {
        /// Which, and what was expected.
        message: String,
        /// What to do.
        help: String,
    },
    /// Something else stopped it.
    #[error("{what}: {reason}")]
    Other {
        /// What was being done.
        what: &'static str,
        /// What went wrong.
        reason: String,
    },
}

/// A check that ends with another outcome than its run.
#[derive(Debug, Clone, PartialEq)]
pub struct Contradiction {
    /// The policy.
    pub policy: String,
    /// Outcome of its run.
    pub outcome: &'static str,
    /// Method of the check.
    pub method: &'static str,
    /// Tolerance of the check.
    pub rtol: f64,
    /// Outcome of the check.
    pub other: &'static str,
}

impl std::fmt::Display for Contradiction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            policy,
            outcome,
            method,
            rtol,
            other,
        } = self;
        write!(
            f,
            "policy {policy}: {outcome}, but {other} by {method} at rtol {rtol:.0e}"
        )
    }
}

fn list(contradictions: &[Contradiction]) -> String {
    let lines: Vec<String> = contradictions
        .iter()
        .map(Contradiction::to_string)
        .collect();
    lines.join("\n")
}

impl From<RunError> for CommandError {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Controller { reason, .. } if reason.help().is_some() => Self::Controller {
                message: reason.to_string(),
                help: reason.help().unwrap_or_default().to_owned(),
            },
            error => Self::Run(error),
        }
    }
}

impl CommandError {
    /// Exit code: 2 for what the user gave, 1 for the rest.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(_)
            | Self::Sweep(_)
            | Self::Output(_)
            | Self::Numbers { .. }
            | Self::Controller { .. }
            | Self::Target(TargetError::Image(ImageError::NoProject(_))) => 2,
            Self::Run(_)
            | Self::Untrusted(_)
            | Self::Contradicted(_)
            | Self::Target(_)
            | Self::Targets(_)
            | Self::Claims(_)
            | Self::Other { .. } => 1,
        }
    }

    pub(crate) fn other(what: &'static str, reason: impl std::fmt::Display) -> Self {
        Self::Other {
            what,
            reason: reason.to_string(),
        }
    }
}

/// JSON for people, indented; `what` is for the error.
///
/// # Errors
/// serde's message.
pub(crate) fn pretty(value: &impl Serialize, what: &'static str) -> Result<String, CommandError> {
    serde_json::to_string_pretty(value).map_err(|e| CommandError::other(what, e))
}

/// Says something beside a command's result. Where nobody can hear it, that is no error of its own.
pub fn say(text: impl std::fmt::Display) {
    let _heard = writeln!(std::io::stderr(), "{text}");
}

/// Says why a command failed. Lines are broken for a terminal alone: what a script reads or searches must not depend on how
/// long a path is.
pub fn explain(error: CommandError) {
    let wraps = std::io::stderr().is_terminal();
    // Set once; were it set before, that one would do.
    let _ = miette::set_hook(Box::new(move |_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(wraps).build())
    }));
    say(format_args!("{:?}", miette::Report::new(error)));
}

/// Prints a command's result.
///
/// # Errors
/// The system's message; a reader that has stopped reading is none.
pub(crate) fn print(text: &str) -> Result<(), CommandError> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(|e| CommandError::other("printing", e)),
    }
}
