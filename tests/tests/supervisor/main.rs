//! The supervisor where it needs more than itself: in closed loops with the plant, against studies, and read by the host. What it
//! does at its border alone is in its own crate, `supervisor/tests`.

mod aim_in_whirl;
mod closed_loop_fixed_point;
mod common;
mod fixed_point;
mod forward_rub;
mod loads_that_stay;
mod ready_to_hold;
mod recoverable_impact;
mod replayed;
mod soft_controller;
mod static_overload;
mod suggested_config;
mod unbalance;
