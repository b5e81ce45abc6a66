//! Pointers that come from C: looked at before they are followed.

use crate::code::Code;

/// An argument of a call that is a pointer, for an error to name.
#[derive(Debug, Clone, Copy)]
pub enum Argument {
    Supervisor,
    Values,
    Sample,
    Command,
    Stamp,
    Result,
    Watch,
    Force,
    Rotor,
    Shaft,
    Bearing,
    Ledger,
    /// Of any address.
    Bytes,
    Archive,
    Places,
}

impl Argument {
    const fn null(self) -> Code {
        match self {
            Self::Supervisor => Code::ERROR_SUPERVISOR_NULL,
            Self::Values => Code::ERROR_VALUES_NULL,
            Self::Sample => Code::ERROR_SAMPLE_NULL,
            Self::Command => Code::ERROR_COMMAND_NULL,
            Self::Stamp => Code::ERROR_STAMP_NULL,
            Self::Result => Code::ERROR_RESULT_NULL,
            Self::Watch => Code::ERROR_WATCH_NULL,
            Self::Force => Code::ERROR_FORCE_NULL,
            Self::Rotor => Code::ERROR_ROTOR_NULL,
            Self::Shaft => Code::ERROR_SHAFT_NULL,
            Self::Bearing => Code::ERROR_BEARING_NULL,
            Self::Ledger => Code::ERROR_LEDGER_NULL,
            Self::Bytes => Code::ERROR_BYTES_NULL,
            Self::Archive => Code::ERROR_ARCHIVE_NULL,
            Self::Places => Code::ERROR_PLACES_NULL,
        }
    }

    pub(crate) const fn misaligned(self) -> Code {
        match self {
            Self::Supervisor => Code::ERROR_SUPERVISOR_MISALIGNED,
            Self::Values => Code::ERROR_VALUES_MISALIGNED,
            Self::Sample => Code::ERROR_SAMPLE_MISALIGNED,
            Self::Command => Code::ERROR_COMMAND_MISALIGNED,
            Self::Stamp => Code::ERROR_STAMP_MISALIGNED,
            Self::Result => Code::ERROR_RESULT_MISALIGNED,
            Self::Watch => Code::ERROR_WATCH_MISALIGNED,
            Self::Force => Code::ERROR_FORCE_MISALIGNED,
            Self::Rotor => Code::ERROR_ROTOR_MISALIGNED,
            Self::Shaft => Code::ERROR_SHAFT_MISALIGNED,
            Self::Bearing => Code::ERROR_BEARING_MISALIGNED,
            Self::Ledger => Code::ERROR_LEDGER_MISALIGNED,
            // Never asked for.
            Self::Bytes => Code::ERROR_BYTES_NULL,
            Self::Archive => Code::ERROR_ARCHIVE_MISALIGNED,
            Self::Places => Code::ERROR_PLACES_MISALIGNED,
        }
    }

    /// Neither null nor misaligned.
    pub(crate) fn check<T>(self, pointer: *const T) -> Result<(), Code> {
        if pointer.is_null() {
            Err(self.null())
        } else if !pointer.is_aligned() {
            Err(self.misaligned())
        } else {
            Ok(())
        }
    }

    /// The same of an alignment (a power of two) that the header promises, stricter than a target may need.
    pub(crate) fn check_to<T>(self, align: usize, pointer: *const T) -> Result<(), Code> {
        self.check(pointer)?;
        match pointer.addr() & (align - 1) {
            0 => Ok(()),
            _ => Err(self.misaligned()),
        }
    }

    /// What the pointer points to.
    ///
    /// # Safety
    /// Where it is neither null nor misaligned it points to a `T`.
    pub(crate) unsafe fn read<T: Copy>(self, pointer: *const T) -> Result<T, Code> {
        self.check(pointer)?;
        // SAFETY: neither null nor misaligned, so there is a T by the caller's promise.
        Ok(unsafe { pointer.read() })
    }
}

/// Where a result goes: writable, once it is made.
pub(crate) struct OutPtr<T>(*mut T);

impl<T: Copy> OutPtr<T> {
    /// # Safety
    /// Where the pointer is neither null nor misaligned it points to memory for a `T`, until the call
    /// that this place is made for returns.
    pub(crate) unsafe fn new(argument: Argument, pointer: *mut T) -> Result<Self, Code> {
        argument.check(pointer.cast_const())?;
        Ok(Self(pointer))
    }

    pub(crate) fn write(&self, value: T) {
        // SAFETY: checked, and promised to be memory for a T, in `new`.
        unsafe { self.0.write(value) }
    }
}
