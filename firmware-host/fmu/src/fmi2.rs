//! Functions of FMI 2.0 for co-simulation, as its headers declare them.
//!
//! # Safety
//! Of all of them: a component comes from [`fmi2Instantiate`] and has not been freed; one call at a time; arrays have as many values as is
//! said beside them; texts end with a zero. Null is an error and no fault.

#![allow(
    non_snake_case,
    reason = "the interface says how its functions are called"
)]
#![allow(
    clippy::missing_safety_doc,
    reason = "the same holds for all of them and stands above"
)]

use crate::boundary::{
    CATEGORY, Handle, Log, call, free, get_all, instantiate, set_all, status, text, write,
};
use crate::instance::{Fault, Instance};
use crate::variable::{Kind, Value};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;

/// Functions of the importer, of which the log alone is called.
#[repr(C)]
pub struct Callbacks {
    logger: Option<
        unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...),
    >,
    allocate_memory: *mut c_void,
    free_memory: *mut c_void,
    step_finished: *mut c_void,
    environment: *mut c_void,
}

/// Number of co-simulation among the kinds of units.
const CO_SIMULATION: c_int = 1;

/// "default".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// "2.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Errors are said always, and there is nothing else to say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Handle,
    _logging_on: c_int,
    _categories_count: usize,
    _categories: *const *const c_char,
) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(component, |_| Ok(())) }
}

/// The folder that an address of a file names.
fn folder_of(address: &str) -> PathBuf {
    let path = address.strip_prefix("file:").unwrap_or(address);
    let path = match path.strip_prefix("//") {
        // Behind two strokes stands the computer: this one, or nothing.
        Some(rest) => rest.find('/').map_or(rest, |at| &rest[at..]),
        None => path,
    };
    let mut bytes = Vec::with_capacity(path.len());
    let mut rest = path.as_bytes();
    while let [first, after @ ..] = rest {
        let digits = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
        let escape = (*first == b'%').then(|| after.get(..2).and_then(digits));
        bytes.push(escape.flatten().unwrap_or(*first));
        rest = match escape.flatten() {
            Some(_) => &after[2..],
            None => after,
        };
    }
    PathBuf::from(String::from_utf8_lossy(&bytes).into_owned())
}

/// A unit of the scene in its resources.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    resource_location: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging_on: c_int,
) -> Handle {
    // SAFETY: as the module says; the importer keeps its functions for as long as the component lives.
    let (name, logger, environment) = unsafe {
        let callbacks = callbacks.as_ref();
        let name = text(instance_name).unwrap_or_default();
        let environment = callbacks.map_or(std::ptr::null_mut(), |c| c.environment);
        (name, callbacks.and_then(|c| c.logger), environment)
    };
    let name = CString::new(name).unwrap_or_default();
    let log: Log = Box::new(move |level, text: &CStr| {
        // The log reads its line as printf does: a sign of per cent is written twice.
        let text = text.to_string_lossy().replace('%', "%%");
        if let (Some(logger), Ok(text)) = (logger, CString::new(text)) {
            let (name, category) = (name.as_ptr(), CATEGORY.as_ptr());
            // SAFETY: the importer's function, called as it has declared it, with texts that live for the call.
            unsafe { logger(environment, name, status(level), category, text.as_ptr()) };
        }
    });
    if kind != CO_SIMULATION {
        log(
            crate::instance::Level::Error,
            c"units are for co-simulation",
        );
        return std::ptr::null_mut();
    }
    // SAFETY: as the module says.
    let (token, address) = unsafe { (text(guid), text(resource_location)) };
    let folder = folder_of(&address.unwrap_or_default());
    instantiate(&token.unwrap_or_default(), &folder, false, log)
}

/// Ends a component.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Handle) {
    // SAFETY: as the module says.
    unsafe { free(component) };
}

/// When the time begins. Tolerance and stop time are those of the scene and of nobody.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    component: Handle,
    _tolerance_defined: c_int,
    _tolerance: f64,
    start_time: f64,
    _stop_time_defined: c_int,
    _stop_time: f64,
) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(component, |i| i.begin_at(start_time)) }
}

/// Initialization begins.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(component: Handle) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(component, Instance::enter_initialization) }
}

/// Initialization ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(component: Handle) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(component, Instance::exit_initialization) }
}

/// The end; an error where the energy audit does not close.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(component: Handle) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(component, Instance::terminate) }
}

/// Back to the beginning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(component: Handle) -> c_int {
    let reset = |i: &mut Instance| {
        i.reset();
        Ok(())
    };
    // SAFETY: as the module says.
    unsafe { call(component, reset) }
}

/// A step to its end.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: Handle,
    current_communication_point: f64,
    communication_step_size: f64,
    _no_set_fmu_state_prior: c_int,
) -> c_int {
    let (from_s, step_s) = (current_communication_point, communication_step_size);
    // SAFETY: as the module says.
    unsafe { call(component, |i| i.step(from_s, step_s).map(drop)) }
}

fn other(reference: u32) -> Fault {
    Fault::error(format!("variable {reference} is of another type"))
}

macro_rules! accessors {
    ($($get:ident, $set:ident: $type:ty, $read:expr, $write:expr;)*) => {$(
        /// Reads variables of this type.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            component: Handle,
            references: *const u32,
            count: usize,
            values: *mut $type,
        ) -> c_int {
            let read = |i: &mut Instance, reference| {
                let read: fn(Value) -> Option<$type> = $read;
                read(i.get(reference)?).ok_or_else(|| other(reference))
            };
            // SAFETY: as the module says.
            unsafe { call(component, |i| get_all(i, references, count, values, read)) }
        }

        /// Sets variables of this type.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            component: Handle,
            references: *const u32,
            count: usize,
            values: *const $type,
        ) -> c_int {
            let write = |i: &mut Instance, reference, value: $type| {
                let write: fn(Kind, $type) -> Value = $write;
                let kind = i.variable(reference)?.kind;
                i.set(reference, write(kind, value))
            };
            // SAFETY: as the module says.
            unsafe { call(component, |i| set_all(i, references, count, values, write)) }
        }
    )*};
}

accessors! {
    fmi2GetReal, fmi2SetReal: f64,
        |value| match value {
            Value::Float64(x) => Some(x),
            _ => None,
        },
        |_, x| Value::Float64(x);
    fmi2GetInteger, fmi2SetInteger: c_int,
        |value| match value {
            Value::Int64(x) => i32::try_from(x).ok(),
            Value::UInt32(bits) => Some(bits.cast_signed()),
            _ => None,
        },
        |kind, x| match kind {
            Kind::UInt32 => Value::UInt32(x.cast_unsigned()),
            _ => Value::Int64(i64::from(x)),
        };
    fmi2GetBoolean, fmi2SetBoolean: c_int,
        |value| match value {
            Value::Boolean(x) => Some(c_int::from(x)),
            _ => None,
        },
        |_, x| Value::Boolean(x != 0);
}

/// Functions that units have nothing of, with the types of what comes behind the component.
macro_rules! absent {
    ($($name:ident($($arg:ident: $type:ty),*);)*) => {$(
        /// Not there.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(component: Handle, $($arg: $type),*) -> c_int {
            let _unused = ($($arg,)*);
            let text = concat!(stringify!($name), ": units have nothing of it");
            // SAFETY: as the module says.
            unsafe { call(component, |_| Err(Fault::error(text))) }
        }
    )*};
}

/// An array or a place, whatever of.
type Any = *mut c_void;

absent! {
    // No variable is a text.
    fmi2GetString(references: Any, count: usize, values: Any);
    fmi2SetString(references: Any, count: usize, values: Any);
    // What the description says that units cannot.
    fmi2GetFMUstate(state: Any);
    fmi2SetFMUstate(state: Any);
    fmi2FreeFMUstate(state: Any);
    fmi2SerializedFMUstateSize(state: Any, size: Any);
    fmi2SerializeFMUstate(state: Any, bytes: Any, size: usize);
    fmi2DeSerializeFMUstate(bytes: Any, size: usize, state: Any);
    fmi2GetDirectionalDerivative(unknowns: Any, unknowns_count: usize, knowns: Any, knowns_count: usize, seeds: Any, values: Any);
    fmi2SetRealInputDerivatives(references: Any, count: usize, orders: Any, values: Any);
    fmi2GetRealOutputDerivatives(references: Any, count: usize, orders: Any, values: Any);
    // Steps are over when they return.
    fmi2CancelStep();
    fmi2GetStatus(what: c_int, value: Any);
    fmi2GetIntegerStatus(what: c_int, value: Any);
    fmi2GetBooleanStatus(what: c_int, value: Any);
    fmi2GetStringStatus(what: c_int, value: Any);
}

/// Number of the time that was reached among what can be asked for.
const LAST_SUCCESSFUL_TIME: c_int = 2;

/// The time that was reached; there is no other number to ask for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(
    component: Handle,
    what: c_int,
    value: *mut f64,
) -> c_int {
    let read = |i: &mut Instance| match (what, i.get(0)?) {
        (LAST_SUCCESSFUL_TIME, Value::Float64(t_s)) => {
            // SAFETY: as the module says.
            unsafe { write(value, t_s) };
            Ok(())
        }
        _ => Err(Fault::error("fmi2GetRealStatus: units have nothing of it")),
    };
    // SAFETY: as the module says.
    unsafe { call(component, read) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_files_are_paths() {
        let of = |address| folder_of(address).to_string_lossy().into_owned();
        assert_eq!(of("file:///tmp/a%20b/resources"), "/tmp/a b/resources");
        assert_eq!(of("file:/tmp/x"), "/tmp/x");
        assert_eq!(of("file://localhost/tmp/x"), "/tmp/x");
        assert_eq!(of("/tmp/100%"), "/tmp/100%");
    }
}
