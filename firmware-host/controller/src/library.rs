//! A controller in a shared library, by the functions of `amb_controller.h`. All unsafe code of the host is here.

use crate::frame::{Question, Setup};
use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW, Symbol};
use std::ffi::{c_int, c_void};
use std::path::Path;
use std::ptr::NonNull;

/// Version of the interface, `AMB_CONTROLLER_ABI`.
pub const ABI: u32 = 1;

/// `amb_controller_setup`.
#[derive(Debug)]
#[repr(C)]
struct CSetup {
    period_s: f64,
    sensors: u32,
    magnets: u32,
    parameters: u32,
    reserved: u32,
    magnet_plane: *const u32,
    force_max_n: *const f64,
    parameter: *const f64,
}

/// `amb_controller_sample`.
#[derive(Debug)]
#[repr(C)]
struct CSample {
    t_s: f64,
    spin_rad_s: f64,
    integrator: u32,
    reserved: u32,
    sequence: *const u32,
    position_m: *const f64,
}

type Abi = unsafe extern "C" fn() -> u32;
type Init = unsafe extern "C" fn(*const CSetup) -> *mut c_void;
type Step = unsafe extern "C" fn(*mut c_void, *const CSample, *mut f64) -> c_int;
type Close = unsafe extern "C" fn(*mut c_void);

/// A controller that has been set up. What is not closed stays open until the process ends.
#[derive(Debug)]
pub struct Controller {
    controller: NonNull<c_void>,
    step: Step,
    close: Close,
    sensors: usize,
    forces_n: Vec<f64>,
    /// Below the functions that are in it.
    _library: Library,
}

impl Controller {
    /// Opens a library and sets its controller up.
    ///
    /// # Errors
    /// In words for its author: what is not there, is of another version, or was refused.
    pub fn new(path: &Path, setup: &Setup) -> Result<Self, String> {
        // SAFETY: what its initialisers do is the author's; the process has nothing else to lose. All symbols are bound now,
        // so that a missing one is an error here and not the end of the process later.
        let library = unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) };
        let library = library.map_err(|error| chain(&error))?;
        // SAFETY: that `amb_controller_abi` has this type is what its name says in every version of the header.
        let abi = unsafe { *symbol::<Abi>(&library, "amb_controller_abi")? };
        // SAFETY: as above; it has no arguments.
        let version = unsafe { abi() };
        if version != ABI {
            return Err(format!(
                "was compiled for version {version} of amb_controller.h, and this program has version {ABI}"
            ));
        }
        // SAFETY: the version says that these have the types of the header.
        let (init, step, close) = unsafe {
            (
                *symbol::<Init>(&library, "amb_controller_init")?,
                *symbol::<Step>(&library, "amb_controller_step")?,
                *symbol::<Close>(&library, "amb_controller_close")?,
            )
        };
        let given = CSetup {
            period_s: setup.period_s,
            sensors: setup.sensors,
            magnets: setup.magnet_plane.len() as u32,
            parameters: setup.parameters.len() as u32,
            reserved: 0,
            magnet_plane: setup.magnet_plane.as_ptr(),
            force_max_n: setup.force_max_n.as_ptr(),
            parameter: setup.parameters.as_ptr(),
        };
        // SAFETY: the pointers are to as many numbers as the header says, which outlive the call.
        let controller = NonNull::new(unsafe { init(&raw const given) });
        Ok(Self {
            controller: controller.ok_or("amb_controller_init returned NULL")?,
            step,
            close,
            sensors: setup.sensors as usize,
            forces_n: vec![0.0; setup.forces()],
            _library: library,
        })
    }

    /// Forces for a sample \[N\].
    ///
    /// # Errors
    /// In words: what the controller returned.
    pub fn step(&mut self, question: &Question) -> Result<&[f64], String> {
        if question.sequence.len() != self.sensors || question.position_m.len() != 2 * self.sensors
        {
            return Err("was asked for another number of sensors".to_owned());
        }
        let sample = CSample {
            t_s: question.t_s,
            spin_rad_s: question.spin_rad_s,
            integrator: u32::from(question.hold),
            reserved: 0,
            sequence: question.sequence.as_ptr(),
            position_m: question.position_m.as_ptr(),
        };
        // What the controller leaves out is seen.
        self.forces_n.fill(f64::NAN);
        let (controller, forces_n) = (self.controller.as_ptr(), self.forces_n.as_mut_ptr());
        // SAFETY: the controller is what init has returned and close has not been given; the pointers are to as many numbers
        // as the header says, which outlive the call.
        match unsafe { (self.step)(controller, &raw const sample, forces_n) } {
            0 => Ok(&self.forces_n),
            code => Err(format!("amb_controller_step returned {code}")),
        }
    }

    /// Ends it.
    pub fn close(self) {
        // SAFETY: the controller is what init has returned; nobody can use it any more.
        unsafe { (self.close)(self.controller.as_ptr()) }
    }
}

/// A function by its name.
///
/// # Safety
/// It has that type.
unsafe fn symbol<T>(library: &Library, name: &str) -> Result<Symbol<T>, String> {
    // SAFETY: by the caller.
    unsafe { library.get(name) }.map_err(|_| format!("has no function {name}"))
}

/// What an error says, and what is behind it.
fn chain(error: &dyn std::error::Error) -> String {
    match error.source() {
        Some(source) => source.to_string(),
        None => error.to_string(),
    }
}
