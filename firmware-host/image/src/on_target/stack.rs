//! How deep a call reaches into the stack: paint below the stack pointer, call, look how far the paint is gone.

use cortex_m::register::msp;

/// Painted words.
const WORDS: usize = 1024;
/// Words right below the stack pointer that stay as they are: the frames of painting and looking themselves.
const OWN: usize = 32;
const PAINT: u32 = 0xA5A5_5A5A;

/// A painted stack.
#[derive(Debug, Clone, Copy)]
pub struct Painted {
    /// Stack pointer at painting.
    top: usize,
}

/// Paints below the stack pointer of the caller.
#[inline(always)]
pub fn paint() -> Painted {
    let top = msp::read() as usize;
    for word in OWN..WORDS {
        // SAFETY: below the stack pointer nothing lives: no interrupt is on, and the memory maps have more
        // stack than this. `top` is aligned to words.
        unsafe { ((top - 4 * (word + 1)) as *mut u32).write_volatile(PAINT) };
    }
    Painted { top }
}

impl Painted {
    /// Bytes below the stack pointer at painting that were written to since then, at least `4 * OWN`.
    #[inline(always)]
    pub fn used_bytes(self) -> u32 {
        for word in (OWN..WORDS).rev() {
            // SAFETY: as above.
            let left = unsafe { ((self.top - 4 * (word + 1)) as *const u32).read_volatile() };
            if left != PAINT {
                return 4 * (word as u32 + 1);
            }
        }
        4 * OWN as u32
    }
}
