//! The whole supervisor and nothing else, linked with a panic handler that does not exist: if any panic
//! could be reached, linking would fail. It is linked, not run; its sections are the supervisor's size.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use core::hint::black_box;
    use firmware_image::{planted, under_test};
    use supervisor::{Config, PARAMETERS, Sample};

    /// Calls everything that firmware calls, with values that the optimiser knows nothing of.
    // SAFETY: the only symbol of this name in the image.
    #[unsafe(no_mangle)]
    extern "C" fn _start() -> ! {
        let config = Config::from_values(black_box([0.0; PARAMETERS.len()]));
        loop {
            let Some(mut supervisor) = under_test::new(black_box(&config)) else {
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
            planted();
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
