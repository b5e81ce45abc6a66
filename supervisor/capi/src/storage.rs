//! The supervisor in memory of the caller's, and who may use it: one call at a time.
//!
//! The first word says what is in the memory. Static memory is zero in C, so that a supervisor which was
//! forgotten to be made is found; and a call that interrupts another on the same supervisor is refused
//! instead of seeing it half changed.

use crate::code::Code;
use crate::layout::defined;
use crate::pointer::Argument;
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};
use supervisor::{Config, Supervisor};

/// Entries of the flight record.
pub const RECORD: usize = 512;

/// A supervisor is there and nobody uses it. Two numbers that memory does not hold by chance.
const READY: u32 = 0xA3B1_5AFE;
/// It is there, and a call is using it.
const BUSY: u32 = 0xA3B1_B5E1;

/// What is in an `amb_supervisor`.
#[repr(C)]
pub struct Storage {
    state: AtomicU32,
    supervisor: UnsafeCell<MaybeUninit<Supervisor<RECORD>>>,
}

// What the header promises is enough …
const BYTES: usize = defined("AMB_SUPERVISOR_BYTES");
const ALIGN: usize = defined("AMB_SUPERVISOR_ALIGN");
const _: () = {
    assert!(size_of::<Storage>() <= BYTES && align_of::<Storage>() <= ALIGN);
    assert!(BYTES.is_multiple_of(ALIGN) && ALIGN.is_power_of_two());
    // … and no waste: room for the pointers and the alignment of any target, and to grow a little.
    assert!(BYTES <= size_of::<Storage>() + 2048);
    assert!(defined("AMB_RECORD_ENTRIES") == RECORD);
};

/// Makes a supervisor; after an error the storage is as it was.
///
/// # Safety
/// Where `storage` is neither null nor misaligned it points to `bytes` bytes that have been written to
/// (static memory has), are used through this crate alone, and live for `'a`.
pub(crate) unsafe fn make(
    storage: *mut Storage,
    bytes: usize,
    config: &Config,
) -> Result<(), Code> {
    check(storage)?;
    if bytes < BYTES {
        return Err(Code::ERROR_SUPERVISOR_TOO_SMALL);
    }
    // SAFETY: not null, aligned and large enough; any bytes are a valid `Storage`, because its word is
    // an integer and the rest may be uninitialised.
    let storage = unsafe { &*storage };
    let before = storage.state.load(Ordering::Acquire);
    if before == BUSY {
        return Err(Code::ERROR_BUSY);
    }
    config
        .validate()
        .map_err(|error| code_of(error.parameter()))?;
    // From here on a call that interrupts this one finds no supervisor.
    storage.state.store(BUSY, Ordering::Release);
    // SAFETY: the word is BUSY, so that no lease is given out: this is the only access. A supervisor that
    // was there is not dropped: it owns nothing but its own bytes.
    let place = unsafe { &mut *storage.supervisor.get() };
    // So written, after the check, it is on the stack once; mapped to a code it was there twice, which
    // are nine kilobytes more.
    let (after, result) = match Supervisor::new(config) {
        Ok(supervisor) => {
            place.write(supervisor);
            (READY, Ok(()))
        }
        Err(error) => (before, Err(code_of(error.parameter()))),
    };
    storage.state.store(after, Ordering::Release);
    result
}

/// Number of the parameter that was refused.
fn code_of(refused: &supervisor::Parameter) -> Code {
    let index = supervisor::PARAMETERS
        .iter()
        .position(|p| p.name == refused.name);
    // Refused parameters are in the table; were one not, its index would be the first beyond.
    Code::parameter(index.unwrap_or(supervisor::PARAMETERS.len()))
}

/// `ALIGN` may be stricter than this target needs, so that the header holds on all of them.
fn check(storage: *const Storage) -> Result<(), Code> {
    Argument::Supervisor.check(storage)?;
    if storage.addr() & (ALIGN - 1) != 0 {
        return Err(Code::ERROR_SUPERVISOR_MISALIGNED);
    }
    Ok(())
}

/// The only use of a supervisor at this time.
pub(crate) struct Lease<'a> {
    storage: &'a Storage,
}

impl<'a> Lease<'a> {
    /// # Safety
    /// As for [`make`]; a supervisor is there if the first word says so.
    pub(crate) unsafe fn new(storage: *mut Storage) -> Result<Self, Code> {
        check(storage)?;
        // SAFETY: not null, aligned, and large enough by the caller's promise; see `make`.
        let storage: &'a Storage = unsafe { &*storage };
        match begin(&storage.state) {
            Ok(()) => Ok(Self { storage }),
            Err(BUSY) => Err(Code::ERROR_BUSY),
            Err(_) => Err(Code::ERROR_NOT_INITIALISED),
        }
    }

    pub(crate) fn supervisor(&mut self) -> &mut Supervisor<RECORD> {
        // SAFETY: the word was READY, so `make` has written a supervisor; it is BUSY now, so this lease
        // is the only one, and the borrow of the lease lets only one reference exist.
        unsafe { (*self.storage.supervisor.get()).assume_init_mut() }
    }
}

impl Drop for Lease<'_> {
    fn drop(&mut self) {
        self.storage.state.store(READY, Ordering::Release);
    }
}

/// From READY to BUSY, or what was there instead.
#[cfg(target_has_atomic = "32")]
fn begin(state: &AtomicU32) -> Result<(), u32> {
    state
        .compare_exchange(READY, BUSY, Ordering::Acquire, Ordering::Relaxed)
        .map(|_| ())
}

/// The same where the core has no exchange (Cortex-M0). There is one core then, and what comes between
/// the two steps is an interrupt, which has given the supervisor back when it returns.
#[cfg(not(target_has_atomic = "32"))]
fn begin(state: &AtomicU32) -> Result<(), u32> {
    let found = state.load(Ordering::Acquire);
    if found != READY {
        return Err(found);
    }
    state.store(BUSY, Ordering::Relaxed);
    core::sync::atomic::compiler_fence(Ordering::Acquire);
    Ok(())
}
