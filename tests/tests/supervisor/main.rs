//! The supervisor: what it promises, what it is told wrong, what it costs a rotor.

mod aim_in_whirl;
mod arbitrary_bits;
mod border;
mod closed_loop_fixed_point;
mod comes_back;
mod derating;
mod drive;
mod faults;
mod first_sample;
mod fixed_point;
mod little_known;
mod loads_that_stay;
mod numbers;
mod promises;
mod ready_to_hold;
mod recoverable_impact;
mod refusals;
mod rotor;
mod service;
mod severity;
mod soft_controller;
mod split;
mod static_overload;
mod suggested_config;
mod trust;
mod unbalance;
