//! Files of the host and its console, through the debugger.

use cortex_m_semihosting::{nr, syscall};

/// What the host answers to an open that failed.
const NONE: usize = usize::MAX;

/// A file in the folder that the emulator runs in.
#[derive(Debug)]
pub struct File {
    handle: usize,
}

impl File {
    /// Opens a file to read. The name ends with a zero.
    pub fn read(name: &core::ffi::CStr) -> Option<Self> {
        Self::open(name, nr::open::R_BINARY)
    }

    /// Makes a file to write. The name ends with a zero.
    pub fn create(name: &core::ffi::CStr) -> Option<Self> {
        Self::open(name, nr::open::W_TRUNC_BINARY)
    }

    fn open(name: &core::ffi::CStr, mode: usize) -> Option<Self> {
        let length = name.count_bytes();
        // SAFETY: OPEN reads `length` bytes and the zero behind them from a name that is borrowed here.
        let handle = unsafe { syscall!(OPEN, name.as_ptr(), mode, length) };
        (handle != NONE).then_some(Self { handle })
    }

    /// Fills the bytes from the file; false where it has not so many. A console is waited for.
    #[must_use]
    pub fn fill(&mut self, bytes: &mut [u8]) -> bool {
        let mut rest = bytes;
        while !rest.is_empty() {
            // SAFETY: READ writes at most `len` bytes to a slice that is borrowed alone here.
            let missing = unsafe { syscall!(READ, self.handle, rest.as_mut_ptr(), rest.len()) };
            // A console gives what has come so far, a file at its end nothing.
            match rest.len().checked_sub(missing) {
                None | Some(0) => return false,
                Some(read) => rest = rest.get_mut(read..).unwrap_or(&mut []),
            }
        }
        true
    }

    /// The next bytes of the file.
    pub fn next_bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        self.fill(&mut bytes).then_some(bytes)
    }

    /// Appends the bytes; false where the host could not.
    #[must_use]
    pub fn append(&mut self, bytes: &[u8]) -> bool {
        // SAFETY: WRITE reads `len` bytes from a slice that is borrowed here.
        unsafe { syscall!(WRITE, self.handle, bytes.as_ptr(), bytes.len()) == 0 }
    }
}
