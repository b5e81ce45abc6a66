//! What lives in memory of the caller's, and who may use it: one call at a time.
//!
//! The first word says what is in the memory. Static memory is zero in C, so that a supervisor which was
//! forgotten to be made is found; and a call that interrupts another on the same one is refused instead of
//! seeing it half changed.

use crate::code::Code;
use crate::layout::defined;
use crate::pointer::Argument;
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};
use supervisor::{CommandWatchdog, Config, ConfigError, Rotor, Shaft, ShaftError, Supervisor};

/// Entries of the flight record.
pub const RECORD: usize = 512;

/// Memory of the caller's for a `T`.
#[repr(C)]
pub struct Kept<T> {
    state: AtomicU32,
    content: UnsafeCell<MaybeUninit<T>>,
}

/// What is in an `amb_supervisor`.
pub type Storage = Kept<Supervisor<RECORD>>;
/// What is in an `amb_rotor`.
pub type RotorStorage = Kept<Rotor<RECORD>>;
/// What is in an `amb_watch`.
pub type WatchStorage = Kept<CommandWatchdog<f32>>;

/// What can be in memory of the caller's. It owns nothing but its own bytes, so that none is ever dropped.
pub(crate) trait Content: Sized {
    /// Name of the argument that points to it.
    const ARGUMENT: Argument;
    /// What the header promises to be enough, in bytes …
    const BYTES: usize;
    /// … and its alignment, which may be stricter than a target needs, so that it holds on all of them.
    const ALIGN: usize;
    /// It is there and nobody uses it. Numbers that memory does not hold by chance …
    const READY: u32;
    /// … and the one that says that a call is using it.
    const BUSY: u32;
    /// It is not there.
    const NOT_MADE: Code;
    /// It is in use.
    const IN_USE: Code;
}

impl Content for Supervisor<RECORD> {
    const ARGUMENT: Argument = Argument::Supervisor;
    const BYTES: usize = defined("AMB_SUPERVISOR_BYTES");
    const ALIGN: usize = defined("AMB_SUPERVISOR_ALIGN");
    const READY: u32 = 0xA3B1_5AFE;
    const BUSY: u32 = 0xA3B1_B5E1;
    const NOT_MADE: Code = Code::ERROR_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_BUSY;
}

impl Content for Rotor<RECORD> {
    const ARGUMENT: Argument = Argument::Rotor;
    const BYTES: usize = defined("AMB_ROTOR_BYTES");
    const ALIGN: usize = defined("AMB_SUPERVISOR_ALIGN");
    const READY: u32 = 0xA3B1_2070;
    const BUSY: u32 = 0xA3B1_20B5;
    const NOT_MADE: Code = Code::ERROR_ROTOR_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_ROTOR_BUSY;
}

impl Content for CommandWatchdog<f32> {
    const ARGUMENT: Argument = Argument::Watch;
    const BYTES: usize = defined("AMB_WATCH_BYTES");
    const ALIGN: usize = defined("AMB_WATCH_ALIGN");
    const READY: u32 = 0xA3B1_07C8;
    const BUSY: u32 = 0xA3B1_07B5;
    const NOT_MADE: Code = Code::ERROR_WATCH_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_WATCH_BUSY;
}

/// The header promises enough, and no more than so many bytes too many.
const fn fits<T: Content>(spare: usize) -> bool {
    let size = size_of::<Kept<T>>();
    size <= T::BYTES
        && T::BYTES <= size + spare
        && align_of::<Kept<T>>() <= T::ALIGN
        && T::BYTES.is_multiple_of(T::ALIGN)
        && T::ALIGN.is_power_of_two()
}

const _: () = {
    // Room for the pointers and the alignment of any target, and to grow a little.
    assert!(fits::<Supervisor<RECORD>>(2048) && fits::<CommandWatchdog<f32>>(16));
    assert!(fits::<Rotor<RECORD>>(4096));
    assert!(defined("AMB_RECORD_ENTRIES") == RECORD);
};

/// Makes a supervisor; after an error the storage is as it was.
///
/// # Safety
/// As for [`Making::new`], with `bytes` bytes.
pub(crate) unsafe fn make_supervisor(
    storage: *mut Storage,
    bytes: usize,
    config: &Config,
) -> Result<(), Code> {
    check(storage)?;
    if bytes < Supervisor::<RECORD>::BYTES {
        return Err(Code::ERROR_SUPERVISOR_TOO_SMALL);
    }
    // SAFETY: large enough now, the rest is the caller's promise.
    let mut making = unsafe { Making::new(storage) }?;
    put(making.place(), config).map_err(|error| code_of(error.parameter()))?;
    making.done();
    Ok(())
}

/// Makes a supervisor of a rotor; after an error the storage is as it was.
///
/// # Safety
/// As for [`Making::new`], with `bytes` bytes.
pub(crate) unsafe fn make_rotor(
    storage: *mut RotorStorage,
    bytes: usize,
    (shaft, configs): (&Shaft, &[Config; 2]),
) -> Result<(), Code> {
    check(storage)?;
    if bytes < Rotor::<RECORD>::BYTES {
        return Err(Code::ERROR_ROTOR_TOO_SMALL);
    }
    // SAFETY: large enough now, the rest is the caller's promise.
    let mut making = unsafe { Making::new(storage) }?;
    put_rotor(making.place(), shaft, configs).map_err(|error| code_of_shaft(&error))?;
    making.done();
    Ok(())
}

/// As [`put`].
#[inline(never)]
fn put_rotor(
    place: &mut MaybeUninit<Rotor<RECORD>>,
    shaft: &Shaft,
    configs: &[Config; 2],
) -> Result<(), ShaftError> {
    match Rotor::new(shaft, configs) {
        Ok(rotor) => {
            place.write(rotor);
            Ok(())
        }
        Err(error) => Err(error),
    }
}

/// What is wrong with a shaft or the configuration of one of its planes.
pub(crate) fn code_of_shaft(error: &ShaftError) -> Code {
    match error {
        ShaftError::Inertia => Code::ERROR_SHAFT_INERTIA,
        ShaftError::Places => Code::ERROR_SHAFT_PLACES,
        ShaftError::Plane(plane, error) => code_of(error.parameter()).of_plane(*plane),
    }
}

/// In a function of its own, after a check of its own: then the compiler makes the supervisor in its place.
/// Otherwise it is on the stack first, which takes nine kilobytes; the test `capi` looks.
#[inline(never)]
fn put(place: &mut MaybeUninit<Supervisor<RECORD>>, config: &Config) -> Result<(), ConfigError> {
    config.validate()?;
    match Supervisor::new(config) {
        Ok(supervisor) => {
            place.write(supervisor);
            Ok(())
        }
        Err(error) => Err(error),
    }
}

/// Memory that is being written to: calls that come meanwhile are refused.
pub(crate) struct Making<'a, T: Content> {
    kept: &'a Kept<T>,
    /// What its word will be.
    after: u32,
}

impl<'a, T: Content> Making<'a, T> {
    /// # Safety
    /// Where `kept` is neither null nor misaligned it points to as many bytes as [`Content`] says, which
    /// have been written to (static memory has), are used through this crate alone, and live for `'a`.
    pub(crate) unsafe fn new(kept: *mut Kept<T>) -> Result<Self, Code> {
        check(kept)?;
        // SAFETY: not null, aligned and large enough; any bytes are valid, because the word is an integer
        // and the rest may be uninitialised.
        let kept: &'a Kept<T> = unsafe { &*kept };
        let after = kept.state.load(Ordering::Acquire);
        if after == T::BUSY {
            return Err(T::IN_USE);
        }
        kept.state.store(T::BUSY, Ordering::Release);
        Ok(Self { kept, after })
    }

    /// What was there is not dropped: it owns nothing but its own bytes.
    pub(crate) fn place(&mut self) -> &mut MaybeUninit<T> {
        // SAFETY: the word is BUSY, so that no lease is given out: this is the only access.
        unsafe { &mut *self.kept.content.get() }
    }

    /// The place has been written to.
    pub(crate) fn done(mut self) {
        self.after = T::READY;
    }
}

impl<T: Content> Drop for Making<'_, T> {
    fn drop(&mut self) {
        self.kept.state.store(self.after, Ordering::Release);
    }
}

/// Number of the parameter that was refused.
pub(crate) fn code_of(refused: &supervisor::Parameter) -> Code {
    let index = supervisor::PARAMETERS
        .iter()
        .position(|p| p.name == refused.name);
    // Refused parameters are in the table; were one not, its index would be the first beyond.
    Code::parameter(index.unwrap_or(supervisor::PARAMETERS.len()))
}

fn check<T: Content>(kept: *const Kept<T>) -> Result<(), Code> {
    T::ARGUMENT.check(kept)?;
    if kept.addr() & (T::ALIGN - 1) != 0 {
        return Err(T::ARGUMENT.misaligned());
    }
    Ok(())
}

/// The only use of a content at this time.
pub(crate) struct Lease<'a, T: Content> {
    kept: &'a Kept<T>,
}

impl<'a, T: Content> Lease<'a, T> {
    /// # Safety
    /// As for [`Making::new`]; a `T` is there if the first word says so.
    pub(crate) unsafe fn new(kept: *mut Kept<T>) -> Result<Self, Code> {
        check(kept)?;
        // SAFETY: not null, aligned, and large enough by the caller's promise; see `Making::new`.
        let kept: &'a Kept<T> = unsafe { &*kept };
        match begin(&kept.state, T::READY, T::BUSY) {
            Ok(()) => Ok(Self { kept }),
            Err(found) if found == T::BUSY => Err(T::IN_USE),
            Err(_) => Err(T::NOT_MADE),
        }
    }

    pub(crate) fn content(&mut self) -> &mut T {
        // SAFETY: the word was READY, so `Making` has put a T there; it is BUSY now, so this lease is the only
        // one, and the borrow of the lease lets only one reference exist.
        unsafe { (*self.kept.content.get()).assume_init_mut() }
    }
}

impl<T: Content> Drop for Lease<'_, T> {
    fn drop(&mut self) {
        self.kept.state.store(T::READY, Ordering::Release);
    }
}

/// From READY to BUSY, or what was there instead.
#[cfg(target_has_atomic = "32")]
fn begin(state: &AtomicU32, ready: u32, busy: u32) -> Result<(), u32> {
    state
        .compare_exchange(ready, busy, Ordering::Acquire, Ordering::Relaxed)
        .map(|_| ())
}

/// The same where the core has no exchange (Cortex-M0). There is one core then, and what comes between
/// the two steps is an interrupt, which has given back what it used when it returns.
#[cfg(not(target_has_atomic = "32"))]
fn begin(state: &AtomicU32, ready: u32, busy: u32) -> Result<(), u32> {
    let found = state.load(Ordering::Acquire);
    if found != ready {
        return Err(found);
    }
    state.store(busy, Ordering::Relaxed);
    core::sync::atomic::compiler_fence(Ordering::Acquire);
    Ok(())
}
