//! What the tests share: plants, rotors, runs, and an independent code.

pub(crate) mod bench;
pub(crate) mod bouncing;
pub(crate) mod plants;
pub(crate) mod reference;
pub(crate) mod rotor;
