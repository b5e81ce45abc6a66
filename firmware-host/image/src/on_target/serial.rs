//! The first serial port of the MPS2 boards (CMSDK APB UART): an interrupt for each byte that comes, polled
//! where bytes go.
//!
//! Waiting for bytes in a loop would do on a board. In the emulator the loop takes the host's processor from what
//! has to bring the next byte.

use cortex_m::interrupt::InterruptNumber;
use cortex_m::peripheral::NVIC;

const DATA: *mut u32 = 0x4000_4000 as *mut u32;
const STATE: *const u32 = 0x4000_4004 as *const u32;
const CONTROL: *mut u32 = 0x4000_4008 as *mut u32;
const INTERRUPTS: *mut u32 = 0x4000_400C as *mut u32;
const DIVIDER: *mut u32 = 0x4000_4010 as *mut u32;

const SEND_FULL: u32 = 1;
const RECEIVED: u32 = 1 << 1;
/// Sending and receiving, and the interrupt of receiving.
const ENABLE: u32 = 0b1011;
/// The fastest that it knows.
const FASTEST: u32 = 16;

/// Its interrupt, the first of the boards.
#[derive(Clone, Copy)]
struct Receive;

// SAFETY: the number is the one of the boards' manuals, and always the same.
unsafe impl InterruptNumber for Receive {
    fn number(self) -> u16 {
        0
    }
}

/// The port.
#[derive(Debug)]
pub struct Serial(());

impl Serial {
    /// Switches it on; from now on each byte calls the interrupt, which makes a port of its own by
    /// [`Self::in_interrupt`].
    pub fn start() {
        // SAFETY: registers of the port by the manual of the boards; nothing else uses them yet, and the image has
        // no other interrupt that this one could disturb.
        unsafe {
            DIVIDER.write_volatile(FASTEST);
            CONTROL.write_volatile(ENABLE);
            NVIC::unmask(Receive);
        }
    }

    /// The port as the interrupt has it.
    pub fn in_interrupt() -> Self {
        Self(())
    }

    /// A byte that has come.
    pub fn received(&mut self) -> Option<u8> {
        // SAFETY: reading the data register takes the byte out; the interrupt is cleared before, so that the next
        // byte calls again.
        unsafe {
            if STATE.read_volatile() & RECEIVED == 0 {
                return None;
            }
            INTERRUPTS.write_volatile(RECEIVED);
            Some(DATA.read_volatile() as u8)
        }
    }

    /// Sends bytes.
    pub fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            // SAFETY: writing to the data register sends the byte and does nothing else.
            unsafe {
                while STATE.read_volatile() & SEND_FULL != 0 {}
                DATA.write_volatile(u32::from(*byte));
            }
        }
    }
}
