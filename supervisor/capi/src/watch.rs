//! The functions of the header on an output watch.

use crate::calls::ending;
use crate::code::Code;
use crate::layout::defined;
use crate::pointer::{Argument, OutPtr};
use crate::storage::{Content, Lease, Making, Slot};
use supervisor::CommandWatchdog;

/// What is in an `amb_watch`.
pub type WatchStorage = Slot<CommandWatchdog<f32>>;

impl Content for CommandWatchdog<f32> {
    const READY: u32 = 0xA3B1_07C8;
    const BUSY: u32 = 0xA3B1_07B5;
    const NOT_MADE: Code = Code::ERROR_WATCH_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_WATCH_BUSY;
}

const _: () = {
    let (bytes, align) = (defined("AMB_WATCH_BYTES"), defined("AMB_WATCH_ALIGN"));
    assert!(size_of::<WatchStorage>() <= bytes && bytes <= size_of::<WatchStorage>() + 16);
    assert!(align_of::<WatchStorage>() == align);
};

/// # Safety
/// Where `watch` is neither null nor misaligned it points to an `amb_watch` that has been written to (static memory has) and that
/// only this library touches.
unsafe fn slot<'a>(watch: *mut WatchStorage) -> Result<&'a WatchStorage, Code> {
    Argument::Watch.check(watch.cast_const())?;
    // SAFETY: not null, aligned and large enough; any bytes are valid, because its word is an integer and the rest may be
    // uninitialised.
    Ok(unsafe { &*watch })
}

/// Makes a watch without a command in storage of the caller's.
///
/// # Safety
/// `watch` is null, misaligned, or points to an `amb_watch` that has been written to, and that only this
/// library touches from now on.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_watch_init", ending!()))]
pub unsafe extern "C" fn amb_watch_init(watch: *mut WatchStorage, periods: u32) -> Code {
    // SAFETY: the caller's promise.
    let making = unsafe { slot(watch) }.and_then(Making::new);
    Code::from_result(making.map(|making| making.finish(CommandWatchdog::new(periods))))
}

/// After each tick: its force is the command from now on.
///
/// # Safety
/// `watch` is null, misaligned, or points to storage given to [`amb_watch_init`] or full of zeros; `force`
/// is null, misaligned, or points to two floats.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_watch_renew", ending!()))]
pub unsafe extern "C" fn amb_watch_renew(watch: *mut WatchStorage, force: *const f32) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { slot(watch) }.and_then(Lease::new);
    let done = lease.and_then(|mut lease| {
        // SAFETY: the caller's promise. An array is aligned as its elements.
        let force = unsafe { Argument::Force.read(force.cast::<[f32; 2]>()) }?;
        lease.content().renew(force);
        Ok(())
    });
    Code::from_result(done)
}

/// Once in each period of the actuator. An error gives no force, so that no old one stays in use.
///
/// # Safety
/// `watch` as for [`amb_watch_renew`]; `force` is null, misaligned, or points to memory for two floats.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_watch_force", ending!()))]
pub unsafe extern "C" fn amb_watch_force(watch: *mut WatchStorage, force: *mut f32) -> Code {
    // SAFETY: the caller's promise. An array is aligned as its elements.
    let place = match unsafe { OutPtr::new(Argument::Force, force.cast::<[f32; 2]>()) } {
        Ok(place) => place,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    match unsafe { slot(watch) }.and_then(Lease::new) {
        Ok(mut lease) => {
            place.write(lease.content().force());
            Code::OK
        }
        Err(code) => {
            place.write([0.0; 2]);
            code
        }
    }
}

/// Whether the next period would have no command: 0 or 1.
///
/// # Safety
/// `watch` as for [`amb_watch_renew`]; `expired` is null, misaligned, or points to memory for a number.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_watch_expired", ending!()))]
pub unsafe extern "C" fn amb_watch_expired(watch: *mut WatchStorage, expired: *mut u32) -> Code {
    // SAFETY: the caller's promise.
    let place = unsafe { OutPtr::new(Argument::Result, expired) };
    // SAFETY: the caller's promise.
    let lease = unsafe { slot(watch) }.and_then(Lease::new);
    let answer = lease.and_then(|mut lease| {
        place?.write(u32::from(lease.content().expired()));
        Ok(())
    });
    Code::from_result(answer)
}
