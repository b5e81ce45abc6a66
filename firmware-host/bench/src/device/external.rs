//! A levitation controller of the user's that runs in a process of its own: a file of Python or a shared library.

use crate::device::actuator::limited_n;
use firmware_controller::PYTHON;
use firmware_controller::frame::{Answer, Question, Setup};
use plant_model::V2;
use std::fmt::Display;
use std::io::{ErrorKind, Write, stderr};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// In what a controller is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// A file that `python3` reads.
    Python,
    /// A shared library with the functions of `amb_controller.h`.
    Library,
}

/// Which controller, and what it is told.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalParams {
    /// In what it is written.
    pub language: Language,
    /// The file, as the scene names it.
    pub named: String,
    /// The same from the root.
    pub file: PathBuf,
    /// The key that names it, with the file and line of the scene.
    pub key: String,
    /// Numbers that it is given.
    pub parameters: Vec<f64>,
    /// It has so long for an answer \[s\].
    pub timeout_s: f64,
    /// From one sample to the next \[s\].
    pub period_s: f64,
    /// Cap of each plane's magnet \[N\]; none where it has no magnet.
    pub caps_n: Vec<Option<f64>>,
}

/// Why a controller of the user's has no forces.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ControllerError {
    /// It cannot be set up: an error of the scene or of the file.
    #[error("{key}: {file} {what}")]
    Setup {
        /// The key that names it, with the file and line of the scene.
        key: String,
        /// The file, as the scene names it.
        file: String,
        /// What it did.
        what: String,
        /// What to do about it.
        help: String,
    },
    /// It fails at a sample.
    #[error("controller {file} at {at_s} s: {what}")]
    Step {
        /// The file, as the scene names it.
        file: String,
        /// Time of the sample, in digits \[s\].
        at_s: String,
        /// What it did.
        what: String,
    },
    /// It fails at the end, when it is closed.
    #[error("controller {file}, closed after the last sample: {what}")]
    Close {
        /// The file, as the scene names it.
        file: String,
        /// What it did.
        what: String,
    },
}

impl ControllerError {
    /// What to do about it, where the scene or the file that it names is wrong and no run can begin.
    pub fn help(&self) -> Option<&str> {
        match self {
            Self::Setup { help, .. } => Some(help),
            Self::Step { .. } | Self::Close { .. } => None,
        }
    }
}

/// The program with the hidden command that serves shared libraries.
static SERVER: OnceLock<PathBuf> = OnceLock::new();

/// Says which program serves shared libraries as `firmware-host` does; the first word counts. Without one it is the
/// `firmware-host` in the folder of the program that runs, or in the folder above.
pub fn serve_libraries_by(program: PathBuf) {
    let _earlier_holds = SERVER.set(program);
}

/// The command of [`serve_libraries_by`]'s program.
pub const SERVE: &str = "serve-controller";

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

/// The controller at work.
#[derive(Debug)]
pub struct External {
    params: ExternalParams,
    process: Process,
    question: Question,
    /// Bytes of a question.
    bytes: Vec<u8>,
}

/// A process that answers.
#[derive(Debug)]
struct Process {
    child: Child,
    /// Its standard input; none where it is closed.
    socket: Option<UnixStream>,
    timeout: Duration,
}

impl External {
    /// Starts the process, and the controller in it at rest.
    ///
    /// # Errors
    /// [`ControllerError::Setup`].
    pub fn start(params: &ExternalParams) -> Result<Self, ControllerError> {
        let refused = |what: String, help: &str| ControllerError::Setup {
            key: params.key.clone(),
            file: params.named.clone(),
            what,
            help: help.to_owned(),
        };
        let mut process = Process::start(params).map_err(|what| {
            let help = match params.language {
                Language::Python => "install Python 3, as `python3` on the search path",
                Language::Library => "run the scene with firmware-host",
            };
            refused(what, help)
        })?;
        let magnets = (0u32..).zip(&params.caps_n);
        let (magnet_plane, force_max_n) = magnets
            .filter_map(|(plane, cap_n)| Some((plane, (*cap_n)?)))
            .unzip();
        let setup = Setup {
            period_s: params.period_s,
            sensors: params.caps_n.len() as u32,
            magnet_plane,
            force_max_n,
            parameters: params.parameters.clone(),
        };
        let help = match params.language {
            Language::Python => {
                "docs/src/host/controllers.md says what the file has to have: make(scene), which returns an object with step(sample)"
            }
            Language::Library => {
                "compile it against amb_controller.h of this version: cc -O2 -shared -fPIC; docs/src/host/controllers.md says what it has to have"
            }
        };
        match process.asked(&setup.bytes()) {
            Ok(_ready) => Ok(Self {
                question: Question {
                    sequence: vec![0; params.caps_n.len()],
                    position_m: vec![0.0; 2 * params.caps_n.len()],
                    ..Question::default()
                },
                bytes: Vec::new(),
                params: params.clone(),
                process,
            }),
            Err(what) => Err(refused(what, help)),
        }
    }

    /// Forces of the planes \[N\] for what their sensors measure \[m\] with the number of the reading, each within its cap;
    /// a reading that is no number counts as the last. `hold`: integrators are to stand.
    ///
    /// # Errors
    /// [`ControllerError::Step`].
    pub fn forces_n(
        &mut self,
        measured: impl Iterator<Item = (u32, V2)>,
        (t_s, spin_rad_s, hold): (f64, f64, bool),
        forces_n: &mut [V2],
    ) -> Result<(), ControllerError> {
        let question = &mut self.question;
        (question.t_s, question.spin_rad_s, question.hold) = (t_s, spin_rad_s, hold);
        let kept = (question.position_m.chunks_exact_mut(2)).zip(&mut question.sequence);
        for ((kept_m, kept_sequence), (sequence, new_m)) in kept.zip(measured) {
            *kept_sequence = sequence;
            for (kept_m, new_m) in kept_m.iter_mut().zip(&new_m) {
                if new_m.is_finite() {
                    *kept_m = *new_m;
                }
            }
        }
        question.put(&mut self.bytes);
        let asked = self.process.asked(&self.bytes);
        let asked = asked.and_then(|asked| self.checked(asked));
        let asked = asked.map_err(|what| ControllerError::Step {
            file: self.params.named.clone(),
            at_s: ((1e9 * t_s).round() / 1e9).to_string(),
            what,
        })?;
        let mut asked = asked.chunks_exact(2);
        for (cap_n, force_n) in self.params.caps_n.iter().zip(forces_n) {
            let wanted = cap_n.and_then(|cap_n| Some((cap_n, asked.next()?)));
            *force_n = wanted.map_or_else(V2::zeros, |(cap_n, f)| {
                let wanted_n = V2::new(f[0], f[1]);
                // What it has limited itself is left to the last bit.
                match wanted_n.norm() <= cap_n * (1.0 + 4.0 * f64::EPSILON) {
                    true => wanted_n,
                    false => limited_n(wanted_n, cap_n),
                }
            });
        }
        Ok(())
    }

    /// As many forces as the magnets have axes, all of them finite.
    fn checked(&self, forces_n: Vec<f64>) -> Result<Vec<f64>, String> {
        let planes = (0..).zip(&self.params.caps_n);
        let magnets: Vec<usize> = planes.filter_map(|(i, cap)| cap.map(|_| i)).collect();
        let expected = 2 * magnets.len();
        if forces_n.len() != expected {
            return Err(format!(
                "answered {} forces, expected {expected}",
                forces_n.len()
            ));
        }
        match forces_n.iter().position(|force| !force.is_finite()) {
            None => Ok(forces_n),
            Some(i) => Err(format!(
                "its force in {} of plane {} is {}",
                ["x", "y"][i % 2],
                magnets[i / 2] + 1,
                forces_n[i]
            )),
        }
    }

    /// Ends the controller.
    ///
    /// # Errors
    /// [`ControllerError::Close`].
    pub fn close(mut self) -> Result<(), ControllerError> {
        drop(self.process.socket.take());
        let what = match self.process.ended() {
            Some(status) if status.success() => return Ok(()),
            Some(status) => said(status),
            None => format!(
                "has not ended within {} s and was stopped",
                self.params.timeout_s
            ),
        };
        Err(ControllerError::Close {
            file: self.params.named.clone(),
            what,
        })
    }
}

impl Process {
    fn start(params: &ExternalParams) -> Result<Self, String> {
        let mut command = match params.language {
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
        command.arg(&params.file);
        command.current_dir(params.file.parent().unwrap_or(Path::new("/")));
        let program = command.get_program().to_string_lossy().into_owned();
        let unstarted = |error: &dyn Display| format!("needs {program}: {error}");
        let (socket, theirs) = UnixStream::pair().map_err(|error| unstarted(&error))?;
        let timeout = Duration::from_secs_f64(params.timeout_s);
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
    fn asked(&mut self, bytes: &[u8]) -> Result<Vec<f64>, String> {
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
                        Some(status) => said(status),
                        None => "has closed its standard input".to_owned(),
                    }
                }
                _ => format!("cannot be asked: {error}"),
            }),
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

fn said(status: ExitStatus) -> String {
    match status.code() {
        Some(code) => format!("ended with exit code {code}"),
        None => format!("crashed: {status}"),
    }
}
