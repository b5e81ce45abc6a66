//! A levitation controller of the user's by a program: a file of Python or a shared library in a process of its own, or a
//! function of whoever calls this library.

mod process;

use self::process::Process;
use crate::device::actuator::limited_n;
use plant_model::V2;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

pub use firmware_controller::frame::{Question, Setup};
pub use process::serve_libraries_by;

/// In what a controller is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// A file that `python3` reads.
    Python,
    /// A shared library with the functions of `amb_controller.h`.
    Library,
}

/// What computes the forces.
#[derive(Debug, Clone, PartialEq)]
pub enum Program {
    /// A process of its own.
    Process {
        /// In what it is written.
        language: Language,
        /// The file, from the root.
        file: PathBuf,
        /// It has so long for an answer \[s\].
        timeout_s: f64,
    },
    /// The caller, in this process.
    Caller(Caller),
}

/// Makes controllers in this process: one for each run, which begins at rest.
pub trait Make: Send + Sync {
    /// One more.
    ///
    /// # Errors
    /// In words: why there is none.
    fn make(&self, setup: &Setup) -> Result<Box<dyn Step>, String>;
}

/// A controller in this process.
pub trait Step: fmt::Debug {
    /// Forces for a sample \[N\], x and y of each magnet.
    ///
    /// # Errors
    /// In words: why there are none.
    fn step(&mut self, question: &Question) -> Result<Vec<f64>, String>;

    /// The last sample was answered.
    ///
    /// # Errors
    /// In words: what went wrong then.
    fn close(&mut self) -> Result<(), String> {
        Ok(())
    }
}

/// Who makes controllers in this process.
#[derive(Clone)]
pub struct Caller {
    /// What they are called where people read of them.
    pub name: String,
    make: Arc<dyn Make>,
}

impl Caller {
    /// From whoever makes them, under a name.
    pub fn new(name: impl Into<String>, make: impl Make + 'static) -> Self {
        Self {
            name: name.into(),
            make: Arc::new(make),
        }
    }
}

impl fmt::Debug for Caller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Caller").field(&self.name).finish()
    }
}

/// The same one.
impl PartialEq for Caller {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.make, &other.make)
    }
}

/// Which controller, and its configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct ExternalParams {
    /// What computes the forces.
    pub program: Program,
    /// The file, as the scene names it, or what the caller calls it.
    pub named: String,
    /// The key that names it, with the file and line of the scene.
    pub key: String,
    /// Numbers that it is given.
    pub parameters: Vec<f64>,
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

/// The controller at work.
#[derive(Debug)]
pub struct External {
    params: ExternalParams,
    asked: Asked,
    question: Question,
}

/// Who is asked.
#[derive(Debug)]
enum Asked {
    /// A process, with the bytes of a question.
    Process(Process, Vec<u8>),
    /// The caller's.
    Caller(Box<dyn Step>),
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
        let asked = match &params.program {
            Program::Process {
                language,
                file,
                timeout_s,
            } => {
                let mut process = Process::start((*language, file), *timeout_s)
                    .map_err(|what| refused(what, language.help_to_start()))?;
                (process.asked(&setup.bytes()))
                    .map_err(|what| refused(what, language.help_to_answer()))?;
                Asked::Process(process, Vec::new())
            }
            Program::Caller(caller) => {
                let help = "give a function of the controller's setup that returns a controller";
                Asked::Caller((caller.make.make(&setup)).map_err(|what| refused(what, help))?)
            }
        };
        Ok(Self {
            question: Question {
                sequence: vec![0; params.caps_n.len()],
                position_m: vec![0.0; 2 * params.caps_n.len()],
                ..Question::default()
            },
            params: params.clone(),
            asked,
        })
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
        let asked = match &mut self.asked {
            Asked::Process(process, bytes) => {
                question.encode(bytes);
                process.asked(bytes)
            }
            Asked::Caller(controller) => controller.step(question),
        };
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
        let closed = match &mut self.asked {
            Asked::Process(process, _) => process.close(),
            Asked::Caller(controller) => controller.close(),
        };
        closed.map_err(|what| ControllerError::Close {
            file: self.params.named.clone(),
            what,
        })
    }
}

impl Language {
    /// What to do where it does not start.
    fn help_to_start(self) -> &'static str {
        match self {
            Self::Python => "install Python 3, as `python3` on the search path",
            Self::Library => "run the scene with firmware-host",
        }
    }

    /// What to do where it does not answer.
    fn help_to_answer(self) -> &'static str {
        match self {
            Self::Python => {
                "docs/src/host/controllers.md says what the file has to have: make(scene), which returns an object with step(sample)"
            }
            Self::Library => {
                "compile it against amb_controller.h of this version: cc -O2 -shared -fPIC; docs/src/host/controllers.md says what it has to have"
            }
        }
    }
}
