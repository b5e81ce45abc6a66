//! Functions of FMI 3.0 for co-simulation, as its headers declare them. What units do not have is in
//! [`fmi3_absent`](crate::fmi3_absent).
//!
//! # Safety
//! Of all of them: an instance comes from [`fmi3InstantiateCoSimulation`] and has not been freed; one call at a time; arrays have as many
//! values as is said beside them; texts end with a zero. Null is an error and no fault.

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
use crate::instance::{Fault, Instance, Level};
use crate::variable::Value;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::Path;

/// Line of the importer's log.
pub type LogMessage =
    Option<unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char)>;

/// "3.0".
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Errors are said always, and there is nothing else to say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Handle,
    _logging_on: bool,
    _categories_count: usize,
    _categories: *const *const c_char,
) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(instance, |_| Ok(())) }
}

/// A unit of the scene in its resources. `eventModeUsed` and intermediate updates are passed over: units have neither.
#[unsafe(no_mangle)]
#[allow(
    clippy::too_many_arguments,
    reason = "the interface says how many there are"
)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _instance_name: *const c_char,
    instantiation_token: *const c_char,
    resource_path: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _event_mode_used: bool,
    early_return_allowed: bool,
    _intermediate_variables: *const u32,
    _intermediate_variables_count: usize,
    environment: *mut c_void,
    log_message: LogMessage,
    _intermediate_update: *mut c_void,
) -> Handle {
    let log: Log = Box::new(move |level, text: &CStr| {
        if let Some(log) = log_message {
            // SAFETY: the importer's function, called as it has declared it, with texts that live for the call.
            unsafe { log(environment, status(level), CATEGORY.as_ptr(), text.as_ptr()) };
        }
    });
    // SAFETY: as the module says.
    let (token, folder) = unsafe { (text(instantiation_token), text(resource_path)) };
    let (token, folder) = (token.unwrap_or_default(), folder.unwrap_or_default());
    instantiate(&token, Path::new(&folder), early_return_allowed, log)
}

/// Ends an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: Handle) {
    // SAFETY: as the module says.
    unsafe { free(instance) };
}

/// Initialization begins. Tolerance and stop time are those of the scene and of nobody.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: Handle,
    _tolerance_defined: bool,
    _tolerance: f64,
    start_time: f64,
    _stop_time_defined: bool,
    _stop_time: f64,
) -> c_int {
    // SAFETY: as the module says.
    unsafe {
        call(instance, |i| {
            i.begin_at(start_time)?;
            i.enter_initialization()
        })
    }
}

/// Initialization ends.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: Handle) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(instance, Instance::exit_initialization) }
}

/// The end; an error where the energy audit does not close.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: Handle) -> c_int {
    // SAFETY: as the module says.
    unsafe { call(instance, Instance::terminate) }
}

/// Back to the beginning.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: Handle) -> c_int {
    let reset = |i: &mut Instance| {
        i.reset();
        Ok(())
    };
    // SAFETY: as the module says.
    unsafe { call(instance, reset) }
}

/// A step, which ends early where something begins and that is allowed.
#[unsafe(no_mangle)]
#[allow(
    clippy::too_many_arguments,
    reason = "the interface says how many there are"
)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: Handle,
    current_communication_point: f64,
    communication_step_size: f64,
    _no_set_fmu_state_prior: bool,
    event_handling_needed: *mut bool,
    terminate_simulation: *mut bool,
    early_return: *mut bool,
    last_successful_time: *mut f64,
) -> c_int {
    let step = |i: &mut Instance| {
        let stepped = i.step(current_communication_point, communication_step_size)?;
        // SAFETY: as the module says.
        unsafe {
            write(event_handling_needed, false);
            write(terminate_simulation, false);
            write(early_return, stepped.early);
            write(last_successful_time, stepped.to_s);
        }
        Ok(())
    };
    // SAFETY: as the module says.
    unsafe { call(instance, step) }
}

/// A type of the interface's, as values of units are of it.
trait Crosses: Copy {
    fn of(value: Value) -> Option<Self>;
    fn value(self) -> Value;
}

macro_rules! crosses {
    ($($type:ty => $kind:ident;)*) => {$(
        impl Crosses for $type {
            fn of(value: Value) -> Option<Self> {
                match value {
                    Value::$kind(x) => Some(x),
                    _ => None,
                }
            }

            fn value(self) -> Value {
                Value::$kind(self)
            }
        }
    )*};
}

crosses! {
    f64 => Float64;
    i64 => Int64;
    u32 => UInt32;
    bool => Boolean;
}

fn get<T: Crosses>(instance: &mut Instance, reference: u32) -> Result<T, Fault> {
    let value = instance.get(reference)?;
    let other = || Fault {
        level: Level::Error,
        text: format!("variable {reference} is of another type"),
    };
    T::of(value).ok_or_else(other)
}

macro_rules! accessors {
    ($($get:ident, $set:ident: $type:ty;)*) => {$(
        /// Reads variables of this type.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            instance: Handle,
            references: *const u32,
            references_count: usize,
            values: *mut $type,
            _values_count: usize,
        ) -> c_int {
            // SAFETY: as the module says; every variable is one value.
            unsafe { call(instance, |i| get_all(i, references, references_count, values, get)) }
        }

        /// Sets variables of this type.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            instance: Handle,
            references: *const u32,
            references_count: usize,
            values: *const $type,
            _values_count: usize,
        ) -> c_int {
            let set = |i: &mut Instance, reference, value: $type| i.set(reference, value.value());
            // SAFETY: as the module says; every variable is one value.
            unsafe { call(instance, |i| set_all(i, references, references_count, values, set)) }
        }
    )*};
}

accessors! {
    fmi3GetFloat64, fmi3SetFloat64: f64;
    fmi3GetInt64, fmi3SetInt64: i64;
    fmi3GetUInt32, fmi3SetUInt32: u32;
    fmi3GetBoolean, fmi3SetBoolean: bool;
}
