//! Firmware in C, in an emulator, against the supervisor in Rust on this machine.

use crate::library::{
    STRICT, Target, beside, built, built_at, capi, includes, said_with_rig, tool,
};

use crate::rig::Rig;
use std::path::Path;
use std::process::Command;
use supervisor::{Events, Mode, Supervisor};
use system_tests::ran::{Folder, Ran, has, lacks, ran};
use system_tests::target::OTHER_LEVELS;

/// The last line of the programs in C.
fn summary_of_rust() -> String {
    let mut supervisor = Supervisor::<512>::new(&Rig::config()).unwrap();
    let mut rig = Rig::new();
    let mut shadowed = 0;
    while rig.tick < Rig::TICKS {
        if let Some(config) = rig.reconfigures() {
            supervisor.reconfigure(&config).unwrap();
        }
        let sample = rig.sample();
        let command = supervisor.tick(&sample);
        shadowed += u32::from(command.own_n != command.force_n);
        rig.actuate(&command);
    }
    let story = Events::ENGAGED
        | Events::TOUCHED
        | Events::WHIRL
        | Events::HANDOVER
        | Events::LEVITATED
        | Events::SENSOR_FAULT
        | Events::SENSOR_OK
        | Events::SEQUENCE
        | Events::LATE
        | Events::RECONFIGURED
        | Events::RECORD_FROZEN
        | Events::AXIS_LOST
        | Events::AXIS_BACK;
    assert!(rig.events.contains(story), "{:?}", story - rig.events);
    assert_eq!(
        rig.modes | 1 << Mode::Pinned as u32,
        0x7f,
        "all modes but this"
    );
    assert!(shadowed > 10, "in shadow forces differ: {shadowed} ticks");
    format!(
        "ticks {} modes 0x{:02x} events 0x{:04x} hash 0x{:08x}",
        rig.tick,
        rig.modes,
        rig.events.bits(),
        rig.hash
    )
}

/// Requirement: SR-34
#[test]
fn c_on_this_machine_does_what_rust_does() {
    let Some(said) = said_with_rig("replay.c") else {
        return;
    };
    assert_eq!(said.lines().last(), Some(summary_of_rust().as_str()));
}

/// Links firmware of a main file, the rig, the board and a library; `None` where a tool is missing.
fn linked(target: Target, main: &Path, library: &Path, image: &Path) -> Option<Ran> {
    let mut gcc = target.compiler()?;
    let examples = capi().join("examples");
    // Not pedantic: start-up code must turn functions into addresses.
    gcc.args(STRICT.iter().filter(|a| **a != "-Wpedantic"));
    gcc.args(["-O2", "-ffunction-sections"])
        .args(includes(library));
    gcc.arg(main);
    gcc.args(["rig.c", "mps2.c"].map(|name| examples.join(name)));
    gcc.arg("-T").arg(examples.join("mps2.ld"));
    gcc.args(["-nostartfiles", "--specs=rdimon.specs", "-Wl,--gc-sections"]);
    gcc.arg(library.join("libsupervisor_capi.a")).arg("-lm");
    Some(ran(gcc.arg("-o").arg(image)))
}

/// What firmware says in the emulator; `None` where a tool is missing.
pub(crate) fn said_by(target: Target, main: &Path) -> Option<String> {
    let folder = Folder::fresh();
    let image = folder.at("firmware.elf");
    linked(target, main, &built(target)?, &image)?.good();
    let qemu = tool("qemu-system-arm")?;
    // A fault ends the program, but nothing ends one that waits for ever.
    let mut run = Command::new("timeout");
    run.arg("120").arg(qemu.get_program());
    run.arg("-nographic").args(["-M", target.machine()]);
    // An instruction takes a nanosecond of the board's time, whatever else this machine does meanwhile.
    run.args(["-icount", "shift=0,sleep=off"]);
    run.args(["-semihosting-config", "enable=on,target=native"]);
    Some(ran(run.arg("-kernel").arg(image)).good())
}

/// What a C file beside these tests says on boards with an FPU, and with floats in software; on none where a tool is missing.
pub(crate) fn said_on_boards(source: &str) -> Vec<(Target, String)> {
    let said = |target| Some((target, said_by(target, &beside(source))?));
    [Target::CortexM4F, Target::CortexM0]
        .into_iter()
        .map_while(said)
        .collect()
}

/// Requirement: SR-34
#[test]
fn c_firmware_does_what_rust_does() {
    // With an FPU, and with floats in software.
    for target in [Target::CortexM4F, Target::CortexM0] {
        let Some(said) = said_by(target, &capi().join("examples/firmware.c")) else {
            return;
        };
        let last = said.lines().last();
        assert_eq!(last, Some(summary_of_rust().as_str()), "{target:?}: {said}");
        assert!(said.contains("backward whirl, events 0x0008"), "{said}");
        assert!(said.contains("record of version 4, "), "{said}");
        assert!(!said.contains("checksum wrong"), "{said}");
    }
}

/// Requirement: SR-39
#[test]
fn landings_are_counted_over_a_reset() {
    let Some(said) = said_by(Target::CortexM4F, &beside("kept.c")) else {
        return;
    };
    let landings = |text: &str, begin: &str| -> Vec<u32> {
        let lines = said.lines().filter_map(|line| line.strip_prefix(begin));
        let rests = lines.filter_map(|rest| rest.strip_suffix(text));
        rests.map(|number| number.parse().unwrap()).collect()
    };
    let at_boot = landings(" landings so far", "bearing 1: ");
    let at_end = landings(" landings", "bearing 1: ");
    assert_eq!((at_boot.len(), at_end.len()), (2, 2), "{said}");
    assert!(at_boot[0] == 0 && at_end[0] > 0, "{said}");
    assert_eq!(
        (at_boot[1], at_end[1]),
        (at_end[0], 2 * at_end[0]),
        "{said}"
    );
    // Both courses are the same.
    let summary = summary_of_rust();
    assert_eq!(said.matches(summary.as_str()).count(), 2, "{said}");
}

/// As the page on C says: nothing needs a large stack, and a supervisor of 28 kilobytes is made in its place.
/// Requirement: SR-36
#[test]
fn calls_need_little_stack() {
    let Some(said) = said_by(Target::CortexM4F, &beside("stack.c")) else {
        return;
    };
    let bytes = |name: &str| -> usize {
        let line = said
            .lines()
            .find_map(|l| l.strip_prefix(name)?.strip_prefix(' '));
        line.unwrap().trim().parse().unwrap()
    };
    // What the page says, and no more than a tenth less of it.
    for (call, most) in [
        ("config-for-bearing", 980),
        ("config-for-rotor", 2652),
        ("init", 2132),
        ("tick", 836),
        ("reconfigure", 1796),
        ("self-test", 1596),
        ("rotor-init", 3860),
        ("rotor-reconfigure", 2428),
        ("rotor-tick", 1452),
        ("archive-init", 128),
        ("archive-take", 232),
        ("archive-section", 4552),
    ] {
        let needed = bytes(call);
        assert!(needed <= most && 10 * needed >= 9 * most, "{call}: {said}");
    }
}

/// At whatever level the library is optimised, firmware links: no panic can be reached.
/// Requirement: SR-32
#[test]
fn no_level_of_optimisation_leaves_a_panic_path() {
    for level in OTHER_LEVELS {
        let main = capi().join("examples/firmware.c");
        let Some(linked) = linked_at(level, &main) else {
            return;
        };
        linked.good();
    }
}

/// Firmware of this main file, with the library at another level of optimisation; `None` where a tool is missing.
fn linked_at(level: &str, main: &Path) -> Option<Ran> {
    let library = built_at(Target::CortexM4F, level)?;
    let folder = Folder::fresh();
    linked(
        Target::CortexM4F,
        main,
        &library,
        &folder.at("firmware.elf"),
    )
}

/// Firmware in which a panic can be reached does not link: with the same library, which adds a call that can.
/// Requirement: SR-32
#[test]
fn a_planted_panic_does_not_link() {
    for level in OTHER_LEVELS {
        let Some(linked) = linked_at(level, &beside("planted.c")) else {
            return;
        };
        assert_ne!(linked.code, Some(0), "the planted panic linked");
        has(&linked.said, &["`amb_a_panic_can_be_reached'"]);
        // It is there.
        lacks(&linked.said, &["`amb_planted_panic'"]);
    }
}
