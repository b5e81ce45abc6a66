//! An archive of several events in C: the bytes of the one in Rust, on this machine and in the emulator.

use crate::firmware::output_on;
use crate::library::{Target, beside, output_with_rig};
use crate::rig::Rig;
use std::fmt::Write;
use supervisor::{Archive, Stamp, Supervisor};

/// What `archive.c` says.
fn output_of_rust() -> String {
    let mut supervisor = Supervisor::<512>::new(&Rig::config()).unwrap();
    let (mut ticker, mut reader) = supervisor.split();
    let (mut rig, mut archive) = (Rig::new(), Box::new(Archive::<f32, 512, 2>::new()));
    let mut taken = 0;
    while rig.tick < Rig::TICKS {
        if let Some(config) = rig.reconfigures() {
            ticker.reconfigure(&config).unwrap();
        }
        let command = ticker.tick(&rig.sample());
        rig.actuate(&command);
        taken += u32::from(archive.take(&mut reader));
    }
    // More than there is room for.
    assert!(taken > 2 && archive.count() == 2, "{taken}");
    let mut output = format!("{taken} taken, {} kept:", archive.count());
    let stamp = Stamp {
        firmware: 7,
        ..Stamp::default()
    };
    while let Some(record) = archive.oldest() {
        let (mut sections, mut sum) = (0, 2_166_136_261_u32);
        for mut section in (0..).map_while(|index| record.section(index, &stamp)) {
            sections += 1;
            for byte in section.seal() {
                sum = (sum ^ u32::from(*byte)).wrapping_mul(16_777_619);
            }
        }
        let _ = write!(output, " {sections} sections {sum:08x}");
        archive.discard();
    }
    output + "\n"
}

/// Requirement: SR-40
#[test]
fn an_archive_in_c_is_that_of_rust() {
    let Some(output) = output_with_rig("archive.c") else {
        return;
    };
    assert_eq!(output, output_of_rust());
}

#[test]
fn an_archive_in_firmware_is_that_of_rust() {
    for target in [Target::CortexM4F, Target::CortexM0] {
        let Some(output) = output_on(target, &beside("archive.c")) else {
            return;
        };
        assert_eq!(output, output_of_rust(), "{target:?}");
    }
}
