//! Levitation controllers of the user's, each in a process of its own, so that one that hangs, crashes or ends takes nothing
//! with it.
//!
//! The host starts the process with one end of a socket as its standard input: [`PYTHON`] for a file of Python,
//! [`serve`](serve::serve) for a shared library with the functions of `amb_controller.h`. First it sends a
//! [`Setup`](frame::Setup), then a [`Question`](frame::Question) for every control sample, and waits for an
//! [`Answer`](frame::Answer) to each. Where the socket ends, the controller does.
//!
//! Rooms, each importing only from those above it: `frame`, `library`, `serve`.

#![deny(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod frame;
#[allow(
    unsafe_code,
    reason = "functions of a shared library have the types that its author says"
)]
pub mod library;
pub mod serve;

/// The program that serves a file of Python, which `python3 -c` is given together with the file's path.
pub const PYTHON: &str = include_str!("runner.py");
