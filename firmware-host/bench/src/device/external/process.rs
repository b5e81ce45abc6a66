//! A controller in a process of its own, which is asked through a socket.

use super::Language;
use firmware_controller::PYTHON;
use firmware_controller::frame::Answer;
use std::fmt::Display;
use std::io::{ErrorKind, Write, stderr};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The program with the hidden command that serves shared libraries.
static SERVER: OnceLock<PathBuf> = OnceLock::new();

/// Says which program serves shared libraries as `firmware-host` does; the first word counts. Without one it is the
/// `firmware-host` in the folder of the program that runs, or in the folder above.
pub fn serve_libraries_by(program: PathBuf) {
    let _earlier_holds = SERVER.set(program);
}

/// The command of [`serve_libraries_by`]'s program.
pub(crate) const SERVE: &str = "serve-controller";

fn server() -> Option<PathBuf> {
    let known = SERVER.get().cloned();
    known.or_else(|| {
        let here = std::env::current_exe().ok()?;
        let mut folders = here.ancestors().skip(1).take(2);
        folders.find_map(|folder| {
            let program = folder.join("firmware-host");
            program.is_file().then_some(program)
        })
    })
}

/// A process that answers.
#[derive(Debug)]
pub(super) struct Process {
    child: Child,
    /// Its standard input; none where it is closed.
    socket: Option<UnixStream>,
    timeout: Duration,
}

impl Process {
    /// Starts it with so long for an answer \[s\].
    ///
    /// # Errors
    /// In words: what it needs.
    pub(super) fn start(
        (language, file): (Language, &Path),
        timeout_s: f64,
    ) -> Result<Self, String> {
        let mut command = match language {
            Language::Python => {
                let mut python = Command::new("python3");
                // What it compiles does not stay beside the scene, and sets are in the same order every time.
                python.args(["-B", "-c", PYTHON]).env("PYTHONHASHSEED", "0");
                python
            }
            Language::Library => {
                let program = server()
                    .ok_or("needs firmware-host to load it, which is not beside this program")?;
                let mut host = Command::new(program);
                host.arg(SERVE);
                host
            }
        };
        // Sums that several threads share differ from run to run, and policies run side by side as it is.
        for threads in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"] {
            command.env(threads, "1");
        }
        command.arg(file);
        command.current_dir(file.parent().unwrap_or(Path::new("/")));
        let program = command.get_program().to_string_lossy().into_owned();
        let unstarted = |error: &dyn Display| format!("needs {program}: {error}");
        let (socket, theirs) = UnixStream::pair().map_err(|error| unstarted(&error))?;
        let timeout = Duration::from_secs_f64(timeout_s);
        for set in [UnixStream::set_read_timeout, UnixStream::set_write_timeout] {
            set(&socket, Some(timeout)).map_err(|error| unstarted(&error))?;
        }
        // What it prints must not get between what the host prints.
        let child = command
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(Stdio::from(stderr()))
            .spawn();
        Ok(Self {
            child: child.map_err(|error| unstarted(&error))?,
            socket: Some(socket),
            timeout,
        })
    }

    /// Asks, and waits for the answer; or what it did instead.
    pub(super) fn asked(&mut self, bytes: &[u8]) -> Result<Vec<f64>, String> {
        let answer = match &mut self.socket {
            Some(socket) => socket
                .write_all(bytes)
                .and_then(|()| Answer::read(&mut *socket)),
            None => Err(ErrorKind::BrokenPipe.into()),
        };
        match answer {
            Ok(Answer::Forces(forces_n)) => Ok(forces_n),
            Ok(Answer::Failed(text)) => Err(text),
            Err(error) => Err(match error.kind() {
                ErrorKind::WouldBlock | ErrorKind::TimedOut => {
                    let timeout_s = self.timeout.as_secs_f64();
                    format!("did not answer within {timeout_s} s, its controller.timeout_s")
                }
                ErrorKind::UnexpectedEof | ErrorKind::BrokenPipe | ErrorKind::ConnectionReset => {
                    match self.ended() {
                        Some(status) => described(status),
                        None => "has closed its standard input".to_owned(),
                    }
                }
                _ => format!("cannot be asked: {error}"),
            }),
        }
    }

    /// Ends it; or what it did instead.
    pub(super) fn close(&mut self) -> Result<(), String> {
        drop(self.socket.take());
        match self.ended() {
            Some(status) if status.success() => Ok(()),
            Some(status) => Err(described(status)),
            None => Err(format!(
                "has not ended within {} s and was stopped",
                self.timeout.as_secs_f64()
            )),
        }
    }

    /// How it has ended, where it does so in time.
    fn ended(&mut self) -> Option<ExitStatus> {
        let until = Instant::now() + self.timeout;
        let mut pause = Duration::from_micros(50);
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return Some(status),
                Err(_) => return None,
                Ok(None) if Instant::now() >= until => return None,
                Ok(None) => sleep(pause),
            }
            pause = (2 * pause).min(Duration::from_millis(20));
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // One that has ended is not there to be killed, and nobody waits for what this says.
        let _gone = self.child.kill();
        let _status = self.child.wait();
    }
}

fn described(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("ended with exit code {code}"),
        None => format!("crashed: {status}"),
    }
}
