//! What a supervisor says to a sample beside numbers, as outputs of a plane: of the supervisor's unit and of the closed loop's.

use crate::quantities::SUPERVISION;
use crate::variable::{Kind, Output, Value};
use firmware_bench::run::trace::Said;

/// The outputs.
pub(crate) const SAID: &[Output<Said>] = &[
    (
        "supervisor_mode",
        "",
        "what the supervisor is doing",
        Kind::Enumeration(&SUPERVISION),
        |said| Value::Int64(said.mode as i64),
    ),
    (
        "supervisor_limits",
        "",
        "bits of what binds its command",
        Kind::UInt32,
        |said| Value::UInt32(said.limits.bits()),
    ),
    (
        "supervisor_events",
        "",
        "bits of what happened at this sample",
        Kind::UInt32,
        |said| Value::UInt32(said.events.bits()),
    ),
];
