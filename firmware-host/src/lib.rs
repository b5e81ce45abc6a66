//! The command line: what a person types, what is printed and written, and with which exit code it ends.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod cli;
