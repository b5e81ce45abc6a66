//! Messages between the host and the image in the loop, over the console of the debugger.
//!
//! Not over the board's own serial port: the emulator passes that on a byte at a time, each a turn of its own, and the
//! console a message at a time.

/// First byte of a message to the image in the loop: a configuration follows, answered by [`READY`] or
/// [`REFUSED`].
pub const CONFIGURE: u8 = b'C';
/// A sample follows, answered by a command.
pub const TICK: u8 = b'T';
/// The image ends, without an answer.
pub const QUIT: u8 = b'Q';
/// The configuration is valid; the supervisor is new.
pub const READY: u8 = b'R';
/// The configuration is not valid.
pub const REFUSED: u8 = b'X';
