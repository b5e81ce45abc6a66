//! Runs images in QEMU: never without a limit of time, and nothing is left running.

use super::machines::Machine;
use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// The emulator.
const QEMU: &str = "qemu-system-arm";

/// Why a run has no result.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum EmulatorError {
    /// It is not there.
    #[error("{QEMU} is not installed")]
    #[diagnostic(help(
        "apt-get install qemu-system-arm, or the package of your system that has QEMU for Arm"
    ))]
    Missing,
    /// It does not start.
    #[error("{QEMU} cannot be started: {0}")]
    Start(io::Error),
    /// It took too long.
    #[error("{image} on {machine} did not end within {} s", limit.as_secs())]
    #[diagnostic(help("a fault that the image does not see hangs; or the host is very slow"))]
    Late {
        image: String,
        machine: &'static str,
        limit: Duration,
    },
    /// The image says that it failed.
    #[error("{image} on {machine} failed: {output}")]
    Failed {
        image: String,
        machine: &'static str,
        /// Output of it and the emulator.
        output: String,
    },
    /// The image did not say what it should.
    #[error("{image} on {machine} did not print {name}")]
    Silent {
        image: &'static str,
        machine: &'static str,
        /// What is missing.
        name: &'static str,
    },
}

/// How the emulator's time runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Time {
    /// As fast as it can.
    Free,
    /// An instruction takes 2^shift ns, whatever the host does.
    Counted {
        /// The exponent.
        shift: u8,
    },
}

/// An emulator that runs; stopped when it is dropped.
#[derive(Debug)]
pub(crate) struct Running {
    child: Child,
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to stop.
        let _ended = self.child.kill();
        let _status = self.child.wait();
    }
}

impl Running {
    /// Starts an image in a folder, which the image's files are in, with an input to its console.
    ///
    /// # Errors
    /// [`EmulatorError::Missing`], [`EmulatorError::Start`].
    pub(crate) fn start(
        machine: &Machine,
        image: &Path,
        folder: &Path,
        time: Time,
        input: Stdio,
    ) -> Result<Self, EmulatorError> {
        Self::start_with(machine, image, folder, time, input, &[])
    }

    /// The same with more arguments, e.g. what it is to log.
    ///
    /// # Errors
    /// [`EmulatorError::Missing`], [`EmulatorError::Start`].
    pub(crate) fn start_with(
        machine: &Machine,
        image: &Path,
        folder: &Path,
        time: Time,
        input: Stdio,
        more: &[&str],
    ) -> Result<Self, EmulatorError> {
        let mut command = Command::new(QEMU);
        command
            .current_dir(folder)
            .args(["-M", machine.board, "-display", "none", "-monitor", "none"])
            .args(["-serial", "none"])
            .args(["-semihosting-config", "enable=on,target=native"]);
        if let Time::Counted { shift } = time {
            // Without sleep: a waiting processor takes no time of the host.
            command.args(["-icount", &format!("shift={shift},sleep=off")]);
        }
        let child = command
            .args(more)
            .arg("-kernel")
            .arg(image)
            .stdin(input)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| match e.kind() {
                io::ErrorKind::NotFound => EmulatorError::Missing,
                _ => EmulatorError::Start(e),
            })?;
        Ok(Self { child })
    }

    /// The console of an emulator that was started with a piped input, once.
    pub(crate) fn console(&mut self) -> Option<(ChildStdin, ChildStdout)> {
        self.child.stdin.take().zip(self.child.stdout.take())
    }

    /// Waits for the end. `None` after the limit.
    pub(crate) fn wait(&mut self, limit: Duration) -> Option<Ended> {
        let until = Instant::now() + limit;
        let status = loop {
            match self.child.try_wait() {
                Ok(None) if Instant::now() < until => {
                    std::thread::sleep(Duration::from_millis(5));
                }
                Ok(status) => break status?,
                Err(_) => return None,
            }
        };
        // What images say fits into the pipes' buffers.
        let mut ended = Ended {
            well: status.success(),
            output: Vec::new(),
            errors: String::new(),
        };
        if let Some(output) = &mut self.child.stdout {
            let _read = output.read_to_end(&mut ended.output);
        }
        if let Some(errors) = &mut self.child.stderr {
            let _read = errors.read_to_string(&mut ended.errors);
        }
        Some(ended)
    }
}

/// How an image ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ended {
    /// Whether it says that all went well.
    pub well: bool,
    /// What it has written, of what its console was not taken for.
    pub output: Vec<u8>,
    /// Messages of the emulator.
    pub errors: String,
}

impl Ended {
    /// Output and errors in one.
    pub(crate) fn all_output(&self) -> String {
        format!("{}{}", String::from_utf8_lossy(&self.output), self.errors)
    }
}

/// First line of what the emulator says of its version.
///
/// # Errors
/// [`EmulatorError::Missing`], [`EmulatorError::Start`].
pub fn version() -> Result<String, EmulatorError> {
    let output = (Command::new(QEMU).arg("--version").output()).map_err(|e| match e.kind() {
        io::ErrorKind::NotFound => EmulatorError::Missing,
        _ => EmulatorError::Start(e),
    })?;
    let text = String::from_utf8_lossy(&output.stdout);
    Ok(text.lines().next().unwrap_or_default().to_owned())
}

/// Runs an image to its end; what it has written.
///
/// # Errors
/// [`EmulatorError`].
pub fn output_of(
    machine: &Machine,
    image: &Path,
    folder: &Path,
    time: Time,
    limit: Duration,
) -> Result<Vec<u8>, EmulatorError> {
    let name = || {
        let name = image.file_name().unwrap_or(image.as_os_str());
        name.to_string_lossy().into_owned()
    };
    let mut running = Running::start(machine, image, folder, time, Stdio::null())?;
    match running.wait(limit) {
        None => Err(EmulatorError::Late {
            image: name(),
            machine: machine.name,
            limit,
        }),
        Some(ended) if !ended.well => Err(EmulatorError::Failed {
            image: name(),
            machine: machine.name,
            output: ended.all_output().trim().to_owned(),
        }),
        Some(ended) => Ok(ended.output),
    }
}

/// Runs an image to its end; names and values that it has printed.
///
/// # Errors
/// [`EmulatorError`].
pub fn run(
    machine: &Machine,
    image: &Path,
    folder: &Path,
    time: Time,
    limit: Duration,
) -> Result<BTreeMap<String, String>, EmulatorError> {
    let output = output_of(machine, image, folder, time, limit)?;
    let text = String::from_utf8_lossy(&output);
    let pairs = text.lines().filter_map(|line| line.split_once(' '));
    Ok(pairs.map(|(n, v)| (n.to_owned(), v.to_owned())).collect())
}
