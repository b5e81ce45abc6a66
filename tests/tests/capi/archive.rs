//! An archive of several events in C: the bytes of the one in Rust, on this machine and in the emulator.

use crate::firmware::said_on_boards;
use crate::library::said_with_rig;
use crate::rig::Rig;
use std::fmt::Write;
use supervisor::{Archive, Stamp, Supervisor};

/// What `archive.c` says.
fn said_in_rust() -> String {
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
    let mut said = format!("{taken} taken, {} kept:", archive.count());
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
        let _ = write!(said, " {sections} sections {sum:08x}");
        archive.discard();
    }
    said + "\n"
}

/// Requirement: SR-40
#[test]
fn an_archive_in_c_is_that_of_rust() {
    let Some(said) = said_with_rig("archive.c") else {
        return;
    };
    assert_eq!(said, said_in_rust());
}

#[test]
fn an_archive_in_firmware_is_that_of_rust() {
    for (target, said) in said_on_boards("archive.c") {
        assert_eq!(said, said_in_rust(), "{target:?}");
    }
}
