//! What the fuzz targets share.

// The tests' own bench, which needs nothing but the supervisor.
#[path = "../../support/src/rig.rs"]
pub mod rig;

pub mod record;

/// An AMB rotor: 10 kg, 0.2 mm, 1000 N, 20 kHz.
pub use rig::config as plausible;

/// Reads an input to its end; behind it are zeros.
pub struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    /// From the input.
    pub fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    /// Bytes that are left.
    pub fn left(&self) -> usize {
        self.0.len()
    }

    /// The next byte.
    pub fn u8(&mut self) -> u8 {
        match self.0.split_first() {
            Some((first, rest)) => {
                self.0 = rest;
                *first
            }
            None => 0,
        }
    }

    /// The next four.
    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes([0; 4].map(|_: u8| self.u8()))
    }
}
