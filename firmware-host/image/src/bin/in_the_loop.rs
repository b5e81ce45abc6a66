//! The supervisor in a loop with a plant on the host: samples in and commands out over the serial port, in
//! lock step. The messages are those of [`firmware_image::wire`].
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use core::cell::RefCell;
    use cortex_m_rt::{entry, exception};
    use critical_section::Mutex;
    use firmware_image::serial::Serial;
    use firmware_image::under_test::Supervisor;
    use firmware_image::wire::{self, COMMAND_BYTES, CONFIG_BYTES, SAMPLE_BYTES};
    use firmware_image::{exit, planted, report, under_test};
    use supervisor::Command;

    #[entry]
    fn main() -> ! {
        planted();
        Serial::start();
        loop {
            cortex_m::asm::wfi();
        }
    }

    static DIALOGUE: Mutex<RefCell<Dialogue>> = Mutex::new(RefCell::new(Dialogue {
        message: [0; LONGEST],
        length: 0,
        supervisor: None,
    }));

    /// The interrupt of the serial port, the only one that is on.
    #[exception]
    unsafe fn DefaultHandler(_number: i16) {
        critical_section::with(|cs| {
            let Ok(mut dialogue) = DIALOGUE.borrow(cs).try_borrow_mut() else {
                return;
            };
            let mut serial = Serial::in_interrupt();
            while let Some(byte) = serial.received() {
                dialogue.take(byte, &mut serial);
            }
        });
    }

    const LONGEST: usize = 1 + CONFIG_BYTES;

    struct Dialogue {
        /// What has come of the message so far.
        message: [u8; LONGEST],
        length: usize,
        supervisor: Option<Supervisor>,
    }

    impl Dialogue {
        fn take(&mut self, byte: u8, serial: &mut Serial) {
            let Some(place) = self.message.get_mut(self.length) else {
                report::failed("a message that is too long")
            };
            *place = byte;
            self.length += 1;
            let Some((kind, rest)) = self.message.split_first() else {
                return;
            };
            let whole = match *kind {
                wire::CONFIGURE => 1 + CONFIG_BYTES,
                wire::TICK => 1 + SAMPLE_BYTES,
                _ => 1,
            };
            if self.length < whole {
                return;
            }
            self.length = 0;
            match (*kind, &mut self.supervisor) {
                (wire::CONFIGURE, _) => {
                    let config = rest.first_chunk().map(wire::config_of);
                    self.supervisor = config.as_ref().and_then(under_test::new);
                    serial.send(&[match self.supervisor {
                        Some(_) => wire::READY,
                        None => wire::REFUSED,
                    }]);
                }
                (wire::TICK, Some(supervisor)) => {
                    let Some(sample) = rest.first_chunk() else {
                        return;
                    };
                    let mut command = Command::default();
                    under_test::tick(supervisor, &wire::sample_of(sample), &mut command);
                    let mut bytes = [0; COMMAND_BYTES];
                    wire::put_command(&command, &mut bytes);
                    serial.send(&bytes);
                }
                (wire::QUIT, _) => exit::success(),
                _ => report::failed("a message that has no meaning here"),
            }
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
