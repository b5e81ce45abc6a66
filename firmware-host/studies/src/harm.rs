//! First do no harm: the supervisor against levitation alone, on machines drawn at random, with sensors as told and with
//! sensors as they are.

pub mod compared;
pub mod conditions;
pub mod events;
pub mod page;
pub mod plan;
pub mod study;
