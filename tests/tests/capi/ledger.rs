//! A ledger of landings in C: the bytes of the one in Rust, on this machine and in the emulator.

use crate::firmware::said_on_boards;
use crate::library::said_with_rig;
use crate::rig::Rig;
use std::fmt::Write;
use supervisor::{Ledger, Supervisor};

/// What `ledger.c` says.
fn said_in_rust() -> String {
    let mut supervisor = Supervisor::<512>::new(&Rig::config()).unwrap();
    let (mut rig, mut ledger, mut writes) = (Rig::new(), Ledger::new(7, 20.0), 0);
    while rig.tick < Rig::TICKS {
        if let Some(config) = rig.reconfigures() {
            supervisor.reconfigure(&config).unwrap();
        }
        let command = supervisor.tick(&rig.sample());
        rig.actuate(&command);
        if let Some(record) = supervisor.record() {
            writes += u32::from(ledger.take_in(&record));
            supervisor.rearm();
        }
    }
    // More than one, so that both places are written to.
    assert!(writes >= 2 && ledger.landings >= 2, "{ledger:?}");
    let mut said = String::new();
    for byte in ledger.to_bytes() {
        let _ = write!(said, "{byte:02x}");
    }
    let left = ledger.landings_left(ledger.worst_severity).unwrap();
    let landings = ledger.landings;
    said + &format!(" {writes} written, {landings} landings, {left} left\n")
}

/// Requirement: SR-39
#[test]
fn a_ledger_in_c_is_that_of_rust() {
    let Some(said) = said_with_rig("ledger.c") else {
        return;
    };
    assert_eq!(said, said_in_rust());
}

#[test]
fn a_ledger_in_firmware_is_that_of_rust() {
    for (target, said) in said_on_boards("ledger.c") {
        assert_eq!(said, said_in_rust(), "{target:?}");
    }
}
