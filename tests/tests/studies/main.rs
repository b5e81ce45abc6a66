//! The studies: what they compute and what they claim.

mod accuracy;
mod drops;
mod found_in_records;
mod harm;
mod loop_rates;
mod optimum;
mod overloads;
mod paper;
mod paper_established_whirl;
mod records;
mod rotor_catalogue;
mod rub;
mod sensitivity;
mod silently_wrong_runs;
mod situations;
mod study_command;
mod validation;
