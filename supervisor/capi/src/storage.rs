//! What lives in memory of the caller's, and who may use it: one call at a time on each side.
//!
//! A word says what is in the memory. Static memory is zero in C, so that a supervisor which was
//! forgotten to be made is found; and a call that interrupts another on the same side is refused instead of
//! seeing it half changed.

use crate::code::Code;
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};

/// Memory of the caller's for a `T`.
#[repr(C)]
pub struct Slot<T> {
    state: AtomicU32,
    content: UnsafeCell<MaybeUninit<T>>,
}

/// What can be in memory of the caller's. It owns nothing but its own bytes, so that none is ever dropped.
pub trait Content: Sized {
    /// It is there and nobody uses it. Numbers that memory does not hold by chance …
    const READY: u32;
    /// … the one that says that a call is using it …
    const BUSY: u32;
    /// … and that it is being made.
    const MAKING: u32 = !Self::READY;
    /// It is not there.
    const NOT_MADE: Code;
    /// It is in use.
    const IN_USE: Code;
}

impl<T: Content> Slot<T> {
    /// Whether it is there, used or not.
    pub(crate) fn is_made(&self) -> bool {
        let state = self.state.load(Ordering::Acquire);
        state == T::READY || state == T::BUSY
    }
}

/// Memory that is being written to: calls that come meanwhile are refused.
pub(crate) struct Making<'a, T: Content> {
    slot: &'a Slot<T>,
    /// What its word will be.
    after: u32,
}

impl<'a, T: Content> Making<'a, T> {
    pub(crate) fn new(slot: &'a Slot<T>) -> Result<Self, Code> {
        let after = slot.state.load(Ordering::Acquire);
        if after == T::BUSY || after == T::MAKING {
            return Err(T::IN_USE);
        }
        slot.state.store(T::MAKING, Ordering::Release);
        Ok(Self { slot, after })
    }

    /// Puts it there. What was there before is not dropped: it owns nothing but its own bytes.
    pub(crate) fn finish(mut self, content: T) {
        // SAFETY: the word is MAKING, so that no lease is given out: this is the only access.
        unsafe { &mut *self.slot.content.get() }.write(content);
        self.after = T::READY;
    }
}

impl<T: Content> Drop for Making<'_, T> {
    fn drop(&mut self) {
        self.slot.state.store(self.after, Ordering::Release);
    }
}

/// The only use of a content at this time.
pub(crate) struct Lease<'a, T: Content> {
    slot: &'a Slot<T>,
}

impl<'a, T: Content> Lease<'a, T> {
    pub(crate) fn new(slot: &'a Slot<T>) -> Result<Self, Code> {
        match begin(&slot.state, T::READY, T::BUSY) {
            Ok(()) => Ok(Self { slot }),
            Err(found) if found == T::BUSY || found == T::MAKING => Err(T::IN_USE),
            Err(_) => Err(T::NOT_MADE),
        }
    }

    pub(crate) fn content(&mut self) -> &mut T {
        // SAFETY: the word was READY, so `Making` has put a T there; it is BUSY now, so this lease is the only
        // one, and the borrow of the lease lets only one reference exist.
        unsafe { (*self.slot.content.get()).assume_init_mut() }
    }
}

impl<T: Content> Drop for Lease<'_, T> {
    fn drop(&mut self) {
        self.slot.state.store(T::READY, Ordering::Release);
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
