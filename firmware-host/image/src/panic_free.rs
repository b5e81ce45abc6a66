//! The whole supervisor, linked with a panic handler that does not exist: if any panic could be
//! reached, linking would fail. It is linked, not run.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use core::hint::black_box;
    use supervisor::{Config, PARAMETERS, Sample, Supervisor};

    unsafe extern "C" {
        /// Deliberately without a definition.
        fn a_panic_can_be_reached() -> !;
    }

    #[panic_handler]
    fn panic(_info: &core::panic::PanicInfo<'_>) -> ! {
        // SAFETY: never linked; a successful link proves that this function was dropped.
        unsafe { a_panic_can_be_reached() }
    }

    /// Calls everything that firmware calls, with values that the optimiser knows nothing of.
    // SAFETY: the only symbol of this name in the image.
    #[unsafe(no_mangle)]
    extern "C" fn _start() -> ! {
        let config = Config::from_values(black_box([0.0; PARAMETERS.len()]));
        loop {
            let Ok(mut supervisor) = Supervisor::<512>::new(black_box(&config)) else {
                continue;
            };
            for _ in 0..black_box(10) {
                let sample: Sample = black_box(Sample::default());
                black_box(supervisor.tick(&sample));
                black_box(supervisor.mode());
                black_box(supervisor.report());
                if let Some(event) = supervisor.next_event() {
                    black_box(event);
                }
                if let Some(record) = supervisor.record() {
                    black_box(record.crc);
                    for entry in record.entries() {
                        black_box(entry);
                    }
                    black_box(supervisor::crc_of(record.entries()));
                }
                supervisor.rearm();
            }
            #[cfg(feature = "planted-panic")]
            {
                let few = [1, 2, 3];
                black_box(few[black_box(2_usize)]);
            }
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("an image for Cortex-M; build it with --target thumbv7em-none-eabihf");
}
