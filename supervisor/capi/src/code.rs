//! What a call returns: a number for programs, with a text for people.

use crate::parameters;
use core::ffi::CStr;

/// Result of a call: 0 is success, 1 that there is nothing to be had, negative numbers are errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub struct Code(pub i32);

/// A row of the table of codes.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Name in the header, without `AMB_`.
    pub name: &'static str,
    /// The number.
    pub code: Code,
    /// What happened.
    pub text: &'static CStr,
}

#[expect(clippy::panic, reason = "runs at compile time alone")]
const fn c_text(text: &'static str) -> &'static CStr {
    match CStr::from_bytes_with_nul(text.as_bytes()) {
        Ok(text) => text,
        Err(_) => panic!("a text must end with its only zero byte"),
    }
}

macro_rules! codes {
    ($($name:ident = $number:literal, $text:literal;)*) => {
        impl Code {
            $(#[doc = concat!("`", $text, "`")]
            pub const $name: Self = Self($number);)*
        }

        /// All codes but those of parameters outside their range.
        pub const CODES: &[Row] = &[$(Row {
            name: stringify!($name),
            code: Code::$name,
            text: c_text(concat!($text, "\0")),
        }),*];
    };
}

codes! {
    OK = 0, "done";
    NOTHING = 1, "there is none";
    ERROR_SUPERVISOR_NULL = -1, "supervisor is null";
    ERROR_SUPERVISOR_MISALIGNED = -2, "supervisor is not aligned to AMB_SUPERVISOR_ALIGN bytes";
    ERROR_SUPERVISOR_TOO_SMALL = -3, "supervisor has fewer than AMB_SUPERVISOR_BYTES bytes";
    ERROR_NOT_INITIALISED = -4, "supervisor was not made by amb_init";
    ERROR_BUSY = -5, "supervisor is in use by a call that this one interrupted";
    ERROR_VALUES_NULL = -6, "values is null";
    ERROR_VALUES_MISALIGNED = -7, "values is not aligned as a float";
    ERROR_VALUES_COUNT = -8, "values has not AMB_PARAMETERS elements";
    ERROR_SAMPLE_NULL = -9, "sample is null";
    ERROR_SAMPLE_MISALIGNED = -10, "sample is not aligned to 4 bytes";
    ERROR_COMMAND_NULL = -11, "command is null";
    ERROR_COMMAND_MISALIGNED = -12, "command is not aligned to 4 bytes";
    ERROR_NAME_NULL = -13, "name is null";
    ERROR_NAME_UNKNOWN = -14, "no parameter has this name";
    ERROR_INDEX = -15, "index is beyond the end";
    ERROR_ENTRIES_NULL = -16, "entries is null";
    ERROR_ENTRIES_MISALIGNED = -17, "entries is not aligned to 4 bytes";
    ERROR_RESULT_NULL = -18, "the pointer to the result is null";
    ERROR_RESULT_MISALIGNED = -19, "the pointer to the result is not aligned as its type";
    ERROR_WATCH_NULL = -20, "watch is null";
    ERROR_WATCH_MISALIGNED = -21, "watch is not aligned to AMB_WATCH_ALIGN bytes";
    ERROR_WATCH_NOT_INITIALISED = -22, "watch was not made by amb_watch_init";
    ERROR_WATCH_BUSY = -23, "watch is in use by a call that this one interrupted";
    ERROR_FORCE_NULL = -24, "force is null";
    ERROR_FORCE_MISALIGNED = -25, "force is not aligned as a float";
    ERROR_SELF_TEST = -26, "this processor, compiler or memory computes something else";
}

/// Code of the first parameter; the others follow downwards.
pub const FIRST_PARAMETER: i32 = -1000;

impl Code {
    /// This parameter is outside its range.
    pub(crate) const fn parameter(index: usize) -> Self {
        // The table has far fewer rows than there are numbers.
        Self(FIRST_PARAMETER - index as i32)
    }

    /// Success, or the error.
    pub(crate) const fn from_result(result: Result<(), Self>) -> Self {
        match result {
            Ok(()) => Self::OK,
            Err(code) => code,
        }
    }

    /// What happened, for people.
    pub fn text(self) -> &'static CStr {
        if let Some(row) = CODES.iter().find(|row| row.code == self) {
            return row.text;
        }
        let index = FIRST_PARAMETER.wrapping_sub(self.0);
        let texts = usize::try_from(index).ok().and_then(parameters::texts);
        texts.map_or(c"unknown code", |texts| texts.error)
    }
}
