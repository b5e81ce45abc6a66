//! The C interface of the supervisor, from C: every misuse gives its error, the header says what the
//! library does, another version neither compiles nor links, and firmware in C does what Rust does.
//!
//! Needs a C compiler; the firmware needs arm-none-eabi-gcc with newlib and QEMU. What is missing skips a
//! test on a user's machine, and fails it in CI; tests/run installs it.

mod advised;
mod archive;
mod bearing;
mod firmware;
mod header;
mod ledger;
mod library;
mod misra;
mod misuse;
mod packages;
mod prebuilt;
mod rig;
mod rotor;
mod simulink;
mod versions;
