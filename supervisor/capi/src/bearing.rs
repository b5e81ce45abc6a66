//! The functions of the header that make a configuration of what is known of a bearing.

use crate::calls::ending;
use crate::code::Code;
use crate::halves;
use crate::pointer::{Argument, OutPtr};
use crate::structs::{CBearing, CShaft};
use supervisor::{Bearing, Config, PARAMETERS, RotorCore};

/// Where the values of so many planes go.
///
/// # Safety
/// `values` is null, misaligned, or points to memory for `count` floats.
unsafe fn values_place<const PLANES: usize>(
    values: *mut f32,
    count: usize,
) -> Result<OutPtr<[[f32; PARAMETERS.len()]; PLANES]>, Code> {
    Argument::Values.check(values.cast_const())?;
    if count != PLANES * PARAMETERS.len() {
        return Err(Code::ERROR_VALUES_COUNT);
    }
    // SAFETY: the caller's promise; there is room for an array of this type, which is aligned as its elements.
    unsafe { OutPtr::new(Argument::Values, values.cast()) }
}

/// The values of a configuration of one plane, from nine numbers.
///
/// # Safety
/// `bearing` is null, misaligned, or points to its struct; `values` is null, misaligned, or points to memory for `count` floats.
// SAFETY: all names of this library begin with amb_, and none twice.
#[unsafe(export_name = concat!("amb_config_for_bearing", ending!()))]
pub unsafe extern "C" fn amb_config_for_bearing(
    bearing: *const CBearing,
    values: *mut f32,
    count: usize,
) -> Code {
    // SAFETY: the caller's promise.
    let bearing = unsafe { Argument::Bearing.read(bearing) };
    let done = bearing.and_then(|bearing| {
        // SAFETY: the caller's promise.
        let place = unsafe { values_place(values, count) }?;
        let config = Config::for_bearing(&bearing.into());
        (config.validate()).map_err(|error| halves::code_of(&error))?;
        place.write([config.values()]);
        Ok(())
    });
    Code::from_result(done)
}

/// The values of configurations of both planes of a rotor, from its shaft and nine numbers each.
///
/// # Safety
/// `shaft` is null, misaligned, or points to its struct; `bearings` is null, misaligned, or points to two of them; `values` is null,
/// misaligned, or points to memory for `count` floats.
// SAFETY: a name of its own, see `amb_config_for_bearing`.
#[unsafe(export_name = concat!("amb_config_for_rotor", ending!()))]
pub unsafe extern "C" fn amb_config_for_rotor(
    shaft: *const CShaft,
    bearings: *const CBearing,
    values: *mut f32,
    count: usize,
) -> Code {
    // SAFETY: the caller's promise.
    let shaft = unsafe { Argument::Shaft.read(shaft) };
    let done = shaft.and_then(|shaft| {
        // SAFETY: the caller's promise; an array is aligned as its elements.
        let bearings = unsafe { Argument::Bearing.read(bearings.cast::<[CBearing; 2]>()) }?;
        // SAFETY: the caller's promise.
        let place = unsafe { values_place(values, count) }?;
        let shaft = shaft.into();
        let configs = Config::for_rotor(&shaft, &bearings.map(Bearing::from));
        let (_, configs) =
            RotorCore::new(&shaft, &configs).map_err(|error| halves::code_of_shaft(&error))?;
        place.write(configs.map(|config| config.values()));
        Ok(())
    });
    Code::from_result(done)
}
