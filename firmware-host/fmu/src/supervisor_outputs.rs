//! What a supervisor answers to a sample beside numbers, as outputs of a plane: of the supervisor's unit and of the closed loop's.

use crate::quantities::SUPERVISION;
use crate::variable::{Kind, Output, Value};
use firmware_bench::run::trace::SupervisorTrace;

/// The outputs.
pub(crate) const TRACE: &[Output<SupervisorTrace>] = &[
    (
        "supervisor_mode",
        "",
        "what the supervisor is doing",
        Kind::Enumeration(&SUPERVISION),
        |trace| Value::Int64(trace.mode as i64),
    ),
    (
        "supervisor_limits",
        "",
        "bits of what binds its command",
        Kind::UInt32,
        |trace| Value::UInt32(trace.limits.bits()),
    ),
    (
        "supervisor_events",
        "",
        "bits of what happened at this sample",
        Kind::UInt32,
        |trace| Value::UInt32(trace.events.bits()),
    ),
];
