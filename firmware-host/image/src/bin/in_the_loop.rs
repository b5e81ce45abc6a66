//! The supervisor in a loop with a plant on the host: samples in and commands out over the debugger's console, in
//! lock step. The messages are those of [`firmware_image::line`](mod@firmware_image::line).
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use cortex_m_rt::entry;
    use firmware_image::file::File;
    use firmware_image::under_test::{Float, Ticked};
    use firmware_image::wire::{self, COMMAND_BYTES};
    use firmware_image::{checked, exit, line, planted, report};

    #[entry]
    fn main() -> ! {
        planted();
        // The name of the console.
        let (Some(mut input), Some(mut output)) = (File::read(c":tt"), File::create(c":tt")) else {
            report::failed("there is no console")
        };
        let mut supervisor = None;
        while let Some([kind]) = input.next_bytes() {
            let answered = match (kind, &mut supervisor) {
                (line::CONFIGURE, _) => {
                    let config = input.next_bytes().map(|bytes| wire::config_of(&bytes));
                    supervisor = config.as_ref().and_then(<Float as Ticked>::new);
                    output.append(&[match &mut supervisor {
                        Some(supervisor) => {
                            checked(supervisor);
                            line::READY
                        }
                        None => line::REFUSED,
                    }])
                }
                (line::TICK, Some(supervisor)) => {
                    let Some(bytes) = input.next_bytes() else {
                        break;
                    };
                    let sample = wire::sample_of_bits(&wire::sample_of(&bytes));
                    let command = supervisor.tick(&sample);
                    let mut bytes = [0; COMMAND_BYTES];
                    wire::encode_command(&wire::command_bits(&command), &mut bytes);
                    output.append(&bytes)
                }
                (line::QUIT, _) => exit::success(),
                _ => report::failed("a message that has no meaning here"),
            };
            if !answered {
                break;
            }
        }
        report::failed("the console has broken")
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
