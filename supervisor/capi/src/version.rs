//! The version of the binary interface, for the library and for its build script.

/// Goes up with every change that a program compiled against the old header would not survive: a
/// function's arguments, the layout of a struct, the meaning of a number, the order of the parameters.
pub const ABI: u32 = 6;
