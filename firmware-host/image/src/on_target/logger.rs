//! Where defmt's frames go: to the host's output, through the debugger. Firmware takes `defmt-rtt` instead, which does
//! not halt the processor; the stock logger for semihosting can panic, and then the image would not link.

use super::exit;
use core::cell::{Cell, RefCell};
use cortex_m_semihosting::hio;
use critical_section::{Mutex, RestoreState};
use defmt::{Encoder, Logger, global_logger};

#[global_logger]
struct HostOutput;

/// State to restore once a frame is out: no interrupt may log into another's frame. `None` between frames.
static TAKEN: Mutex<Cell<Option<RestoreState>>> = Mutex::new(Cell::new(None));
static ENCODER: Mutex<RefCell<Encoder>> = Mutex::new(RefCell::new(Encoder::new()));

// SAFETY: interrupts are off from `acquire` to `release`, and an `acquire` in between ends the program.
unsafe impl Logger for HostOutput {
    fn acquire() {
        // SAFETY: `release` gives it back.
        let state = unsafe { critical_section::acquire() };
        let taken = critical_section::with(|cs| TAKEN.borrow(cs).replace(Some(state)));
        if taken.is_some() {
            exit::failure();
        }
        encode(|encoder| encoder.start_frame(to_host));
    }

    unsafe fn flush() {}

    unsafe fn release() {
        encode(|encoder| encoder.end_frame(to_host));
        let state = critical_section::with(|cs| TAKEN.borrow(cs).take());
        if let Some(state) = state {
            // SAFETY: of the `acquire` of this frame.
            unsafe { critical_section::release(state) }
        }
    }

    unsafe fn write(bytes: &[u8]) {
        encode(|encoder| encoder.write(bytes, to_host));
    }
}

fn encode(work: impl FnOnce(&mut Encoder)) {
    critical_section::with(|cs| {
        // It is never borrowed twice: `to_host` logs nothing.
        if let Ok(mut encoder) = ENCODER.borrow(cs).try_borrow_mut() {
            work(&mut encoder);
        }
    });
}

/// A log that cannot be written is no reason to stop a machine.
fn to_host(bytes: &[u8]) {
    if let Ok(mut output) = hio::hstdout() {
        let _written = output.write_all(bytes);
    }
}
