//! How an image ends: by telling the host, also where it goes wrong.

use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS, ExitStatus};

unsafe extern "C" {
    /// Deliberately without a definition: an image in which a panic can be reached does not link.
    fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_info: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: never linked; a successful link proves that this function was dropped.
    unsafe { a_panic_can_be_reached() }
}

/// A fault would hang the emulator: it ends as a failure instead.
#[exception]
unsafe fn HardFault(_frame: &ExceptionFrame) -> ! {
    failure()
}

/// Everything went well.
pub fn success() -> ! {
    end(EXIT_SUCCESS)
}

/// It did not.
pub fn failure() -> ! {
    end(EXIT_FAILURE)
}

fn end(status: ExitStatus) -> ! {
    // A debugger may let the program go on.
    loop {
        debug::exit(status);
    }
}
