//! What a call returns: a number for programs, with a text for people.

use crate::parameters;
use core::ffi::CStr;
use supervisor::{PARAMETERS, RULES, SelfTest};

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
    ONE_COPY = 2, "one of the two copies is not whole: the last landing may be missing";
    ERROR_SUPERVISOR_NULL = -1, "supervisor is null";
    ERROR_SUPERVISOR_MISALIGNED = -2, "supervisor is not aligned to AMB_SUPERVISOR_ALIGN bytes";
    ERROR_SUPERVISOR_TOO_SMALL = -3, "supervisor has fewer than AMB_SUPERVISOR_BYTES bytes";
    ERROR_NOT_INITIALISED = -4, "supervisor was not made by amb_init";
    ERROR_BUSY = -5, "supervisor is in use by a call that this one interrupted";
    ERROR_VALUES_NULL = -6, "values is null";
    ERROR_VALUES_MISALIGNED = -7, "values is not aligned as a float";
    ERROR_VALUES_COUNT = -8, "values has not AMB_PARAMETERS elements for each plane";
    ERROR_SAMPLE_NULL = -9, "sample is null";
    ERROR_SAMPLE_MISALIGNED = -10, "sample is not aligned to 4 bytes";
    ERROR_COMMAND_NULL = -11, "command is null";
    ERROR_COMMAND_MISALIGNED = -12, "command is not aligned to 4 bytes";
    ERROR_NAME_NULL = -13, "name is null";
    ERROR_NAME_UNKNOWN = -14, "no parameter has this name";
    ERROR_INDEX = -15, "index is beyond the end";
    ERROR_STAMP_NULL = -16, "stamp is null";
    ERROR_STAMP_MISALIGNED = -17, "stamp is not aligned to 4 bytes";
    ERROR_RESULT_NULL = -18, "the pointer to the result is null";
    ERROR_RESULT_MISALIGNED = -19, "the pointer to the result is not aligned as its type";
    ERROR_WATCH_NULL = -20, "watch is null";
    ERROR_WATCH_MISALIGNED = -21, "watch is not aligned to AMB_WATCH_ALIGN bytes";
    ERROR_WATCH_NOT_INITIALISED = -22, "watch was not made by amb_watch_init";
    ERROR_WATCH_BUSY = -23, "watch is in use by a call that this one interrupted";
    ERROR_FORCE_NULL = -24, "force is null";
    ERROR_FORCE_MISALIGNED = -25, "force is not aligned as a float";
    ERROR_SELF_TEST = -26, "this processor, compiler or memory computes something else";
    ERROR_ROTOR_NULL = -27, "rotor is null";
    ERROR_ROTOR_MISALIGNED = -28, "rotor is not aligned to AMB_SUPERVISOR_ALIGN bytes";
    ERROR_ROTOR_TOO_SMALL = -29, "rotor has fewer than AMB_ROTOR_BYTES bytes";
    ERROR_ROTOR_NOT_INITIALISED = -30, "rotor was not made by amb_rotor_init";
    ERROR_ROTOR_BUSY = -31, "rotor is in use by a call that this one interrupted";
    ERROR_SHAFT_NULL = -32, "shaft is null";
    ERROR_SHAFT_MISALIGNED = -33, "shaft is not aligned as a float";
    ERROR_SHAFT_INERTIA = -34, "mass and transverse inertia must be above 0, the polar one from 0 to twice the transverse one";
    ERROR_SHAFT_PLACES = -35, "positions must be numbers, those of the retainer bearings must differ, and none be far beyond them";
    ERROR_PLANE = -36, "plane is neither 0 nor 1";
    ERROR_BEARING_NULL = -37, "bearing is null";
    ERROR_BEARING_MISALIGNED = -38, "bearing is not aligned as a float";
    ERROR_LEDGER_NULL = -39, "ledger is null";
    ERROR_LEDGER_MISALIGNED = -40, "ledger is not aligned to 4 bytes";
    ERROR_BYTES_NULL = -41, "bytes is null";
    ERROR_LEDGER_LENGTH = -42, "a ledger has AMB_LEDGER_BYTES bytes";
    ERROR_LEDGER_BLANK = -43, "nothing was ever written there: the ledger is lost, or was never made";
    ERROR_LEDGER_LETTERS = -44, "no ledger begins there";
    ERROR_LEDGER_DAMAGED = -45, "the ledger is damaged: its checksum is another one";
    ERROR_LEDGER_VERSION = -46, "the ledger is of another version";
    ERROR_LEDGER_BEARINGS = -47, "the copies are of two bearings";
    ERROR_ARCHIVE_NULL = -48, "archive is null";
    ERROR_ARCHIVE_MISALIGNED = -49, "archive is not aligned to AMB_SUPERVISOR_ALIGN bytes";
    ERROR_ARCHIVE_NOT_INITIALISED = -50, "archive was not made by amb_archive_init";
    ERROR_ARCHIVE_BUSY = -51, "archive is in use by a call that this one interrupted, or is there twice";
    ERROR_PLACES_NULL = -52, "places is null";
    ERROR_PLACES_MISALIGNED = -53, "places are not aligned to AMB_SUPERVISOR_ALIGN bytes";
    ERROR_PLACES_COUNT = -54, "an archive has a place at least, and no more than there can be";
    ERROR_ROTOR_HALF = -55, "the first plane has not had its half of the tick";
}

/// Code of the first parameter; the others follow downwards, and after them those of a rotor's second plane.
pub const FIRST_PARAMETER: i32 = -1000;

/// Code of the first rule between two parameters; the others follow downwards, and after them those of a rotor's second plane.
pub const FIRST_RULE: i32 = -2000;

/// Texts of the rules, in their order.
const RULE_TEXTS: [&CStr; RULES.len()] = [
    c"sample_period_s is too long for force_max_n, mass_kg and clearance_m",
    c"sensor_step_m is too much for observer_pole_flight",
    c"sensor_step_m is too much for observer_pole_contact",
    c"axis_force_max_n is too little for force_max_n",
    c"force_slew_n_s is too little for force_max_n",
    c"contact_band is too little for sensor_step_m",
];

impl Code {
    /// This rule is broken.
    pub(crate) const fn rule(index: usize) -> Self {
        Self(FIRST_RULE - index as i32)
    }

    /// This parameter is outside its range.
    pub(crate) const fn parameter(index: usize) -> Self {
        // The table has far fewer rows than there are numbers.
        Self(FIRST_PARAMETER - index as i32)
    }

    /// The same parameter of a rotor's plane.
    pub(crate) const fn of_plane(self, plane: usize) -> Self {
        if plane == 0 {
            self
        } else if self.0 <= FIRST_RULE {
            Self(self.0 - RULES.len() as i32)
        } else {
            Self(self.0 - PARAMETERS.len() as i32)
        }
    }

    /// Success, or the error.
    pub(crate) const fn from_result(result: Result<(), Self>) -> Self {
        match result {
            Ok(()) => Self::OK,
            Err(code) => code,
        }
    }

    /// What a self-test says.
    pub(crate) fn of_test(result: Result<SelfTest, Self>) -> Self {
        Self::from_result(result.and_then(|test| match test.passed {
            true => Ok(()),
            false => Err(Self::ERROR_SELF_TEST),
        }))
    }

    /// What happened, for people.
    pub fn text(self) -> &'static CStr {
        if let Some(row) = CODES.iter().find(|row| row.code == self) {
            return row.text;
        }
        let rule = usize::try_from(FIRST_RULE.wrapping_sub(self.0)).ok();
        let of_plane = rule.map(|rule| rule.checked_sub(RULES.len()).unwrap_or(rule));
        if let Some(text) = of_plane.and_then(|rule| RULE_TEXTS.get(rule)) {
            return text;
        }
        let index = FIRST_PARAMETER.wrapping_sub(self.0);
        let texts = usize::try_from(index).ok().and_then(|index| {
            let second = index.checked_sub(PARAMETERS.len());
            parameters::texts(second.unwrap_or(index))
        });
        texts.map_or(c"unknown code", |texts| texts.error)
    }
}
