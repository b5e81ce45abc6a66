//! Functions of FMI 3.0 that units do not have: they are there, as the interface asks for, and say so.
//!
//! # Safety
//! Of all of them: an instance comes from `fmi3InstantiateCoSimulation` and has not been freed, and one call at a time. What is pointed to is
//! not looked at.

#![allow(
    non_snake_case,
    reason = "the interface says how its functions are called"
)]
#![allow(
    clippy::missing_safety_doc,
    reason = "the same holds for all of them and stands above"
)]
#![allow(
    clippy::too_many_arguments,
    reason = "the interface says how many there are"
)]

use crate::boundary::{Handle, call};
use crate::instance::Fault;
use std::ffi::{c_int, c_void};

/// An array or a place, whatever of.
type Any = *mut c_void;

/// Functions with the types of what comes behind the instance, each with a name: nothing of it is used.
macro_rules! absent {
    ($($name:ident($($type:ty),*);)*) => {$(
        absent!(@one $name [] [a b c d e f g] $($type,)*);
    )*};
    (@one $name:ident [$($done:tt)*] [$next:ident $($more:ident)*] $type:ty, $($rest:ty,)*) => {
        absent!(@one $name [$($done)* ($next: $type)] [$($more)*] $($rest,)*);
    };
    (@one $name:ident [$(($arg:ident: $type:ty))*] [$($more:ident)*]) => {
        /// Not there.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: Handle, $($arg: $type),*) -> c_int {
            let _unused = ($($arg,)*);
            let text = concat!(stringify!($name), ": units have nothing of it");
            // SAFETY: as the module says.
            unsafe { call(instance, |_| Err(Fault::error(text))) }
        }
    };
}

absent! {
    // Modes of other kinds of units.
    fmi3EnterEventMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EnterContinuousTimeMode();
    fmi3EnterStepMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(Any, Any, Any, Any, Any, Any);
    fmi3CompletedIntegratorStep(bool, Any, Any);
    fmi3SetTime(f64);
    fmi3SetContinuousStates(Any, usize);
    fmi3GetContinuousStateDerivatives(Any, usize);
    fmi3GetEventIndicators(Any, usize);
    fmi3GetContinuousStates(Any, usize);
    fmi3GetNominalsOfContinuousStates(Any, usize);
    fmi3GetNumberOfEventIndicators(Any);
    fmi3GetNumberOfContinuousStates(Any);
    fmi3ActivateModelPartition(u32, f64);
    // Types that no variable is of.
    fmi3GetFloat32(Any, usize, Any, usize);
    fmi3SetFloat32(Any, usize, Any, usize);
    fmi3GetInt8(Any, usize, Any, usize);
    fmi3SetInt8(Any, usize, Any, usize);
    fmi3GetUInt8(Any, usize, Any, usize);
    fmi3SetUInt8(Any, usize, Any, usize);
    fmi3GetInt16(Any, usize, Any, usize);
    fmi3SetInt16(Any, usize, Any, usize);
    fmi3GetUInt16(Any, usize, Any, usize);
    fmi3SetUInt16(Any, usize, Any, usize);
    fmi3GetInt32(Any, usize, Any, usize);
    fmi3SetInt32(Any, usize, Any, usize);
    fmi3GetUInt64(Any, usize, Any, usize);
    fmi3SetUInt64(Any, usize, Any, usize);
    fmi3GetString(Any, usize, Any, usize);
    fmi3SetString(Any, usize, Any, usize);
    fmi3GetBinary(Any, usize, Any, Any, usize);
    fmi3SetBinary(Any, usize, Any, Any, usize);
    fmi3GetClock(Any, usize, Any);
    fmi3SetClock(Any, usize, Any);
    // Clocks.
    fmi3GetIntervalDecimal(Any, usize, Any, Any);
    fmi3GetIntervalFraction(Any, usize, Any, Any, Any);
    fmi3GetShiftDecimal(Any, usize, Any);
    fmi3GetShiftFraction(Any, usize, Any, Any);
    fmi3SetIntervalDecimal(Any, usize, Any);
    fmi3SetIntervalFraction(Any, usize, Any, Any);
    fmi3SetShiftDecimal(Any, usize, Any);
    fmi3SetShiftFraction(Any, usize, Any, Any);
    // What the description says that units cannot: states that are kept, derivatives, dependencies at run time.
    fmi3GetNumberOfVariableDependencies(u32, Any);
    fmi3GetVariableDependencies(u32, Any, Any, Any, Any, usize);
    fmi3GetFMUState(Any);
    fmi3SetFMUState(Any);
    fmi3FreeFMUState(Any);
    fmi3SerializedFMUStateSize(Any, Any);
    fmi3SerializeFMUState(Any, Any, usize);
    fmi3DeserializeFMUState(Any, usize, Any);
    fmi3GetDirectionalDerivative(Any, usize, Any, usize, Any, usize, Any);
    fmi3GetAdjointDerivative(Any, usize, Any, usize, Any, usize, Any);
    fmi3GetOutputDerivatives(Any, usize, Any, Any, usize);
}

/// Not there: null.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: Any,
    _token: Any,
    _resources: Any,
    _visible: bool,
    _logging_on: bool,
    _environment: Any,
    _log: Any,
) -> Handle {
    std::ptr::null_mut()
}

/// Not there: null.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: Any,
    _token: Any,
    _resources: Any,
    _visible: bool,
    _logging_on: bool,
    _environment: Any,
    _log: Any,
    _clock_update: Any,
    _lock_preemption: Any,
    _unlock_preemption: Any,
) -> Handle {
    std::ptr::null_mut()
}
