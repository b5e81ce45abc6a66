//! The supervisor in a loop with a plant on the host: samples in and commands out over the serial port, in
//! lock step. The messages are those of [`firmware_image::line`](mod@firmware_image::line).
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use core::cell::RefCell;
    use cortex_m_rt::{entry, exception};
    use critical_section::Mutex;
    use firmware_image::line::{self, CONFIGURE_BYTES, Line, MAP_BYTES};
    use firmware_image::serial::Serial;
    use firmware_image::under_test::{self, Float, UnderTest};
    use firmware_image::{checked, exit, planted, report, wire};
    use supervisor::Command;

    #[entry]
    fn main() -> ! {
        planted();
        checked::<Float>();
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

    /// A configuration is longer than any sample.
    const LONGEST: usize = CONFIGURE_BYTES;

    struct Dialogue {
        /// What has come of the message so far.
        message: [u8; LONGEST],
        length: usize,
        /// With what is known of its line.
        supervisor: Option<(Float, Line)>,
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
                line::CONFIGURE => CONFIGURE_BYTES,
                line::TICK => match rest.first_chunk() {
                    Some(map) if self.length > MAP_BYTES => 1 + MAP_BYTES + line::rest_of(*map),
                    _ => 1 + MAP_BYTES,
                },
                _ => 1,
            };
            if self.length < whole {
                return;
            }
            self.length = 0;
            match (*kind, &mut self.supervisor) {
                (line::CONFIGURE, _) => {
                    let config = rest.first_chunk().map(wire::config_of);
                    let new = config.as_ref().and_then(<Float as UnderTest>::new);
                    self.supervisor = new.map(|s| (s, Line::default()));
                    serial.send(&[match self.supervisor {
                        Some(_) => line::READY,
                        None => line::REFUSED,
                    }]);
                }
                (line::TICK, Some((supervisor, line))) => {
                    let sample = wire::sample_of_bits(&line.sample(rest));
                    let mut command = Command::default();
                    under_test::tick(supervisor, &sample, &mut command);
                    serial.send(line.pack_command(&wire::command_bits(&command)).bytes());
                }
                (line::QUIT, _) => exit::success(),
                _ => report::failed("a message that has no meaning here"),
            }
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
