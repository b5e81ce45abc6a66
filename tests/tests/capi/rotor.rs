//! The supervisor of a rotor in C: what Rust computes, in the emulator too; and the example with a model of its own.

use crate::firmware::said_on_boards;
use crate::library::{Target, built, capi, host_program, said_with_rig};
use crate::rig::Rig;
use std::process::Command;
use supervisor::{PlanePositions, RotorSupervisor, Shaft};
use system_tests::ran::{Folder, ran};

pub(crate) fn shaft() -> Shaft {
    let place = |retainer_m, sensor_m, magnet_m| PlanePositions {
        retainer_m,
        sensor_m,
        magnet_m,
    };
    Shaft {
        mass_kg: 20.0,
        transverse_inertia_kg_m2: 0.8,
        polar_inertia_kg_m2: 0.5,
        places: [place(-0.2, -0.19, -0.17), place(0.22, 0.21, 0.19)],
    }
}

/// The last line of `pair.c`.
fn pair_of_rust() -> String {
    let config = Rig::config();
    let mut rotor = RotorSupervisor::<512>::new(&shaft(), &[config; 2]).unwrap();
    let mut ends = [Rig::new(), Rig::new()];
    let (mut engaged, mut asked) = (0, 0);
    while ends[0].tick < Rig::TICKS {
        if let Some(config) = ends[0].reconfigures() {
            rotor.reconfigure(&shaft(), &[config; 2]).unwrap();
        }
        let samples = [ends[0].sample(), ends[1].sample()];
        let command = rotor.tick(&samples);
        for (end, command) in ends.iter_mut().zip(&command.planes) {
            end.actuate(command);
        }
        engaged += command.other_engaged.map(u32::from).iter().sum::<u32>();
        asked += u32::from(command.coast_down);
    }
    let [first, second] = ends;
    assert!(engaged > 100 && first.hash != second.hash, "{engaged}");
    format!(
        "ticks {} engaged {engaged} coast-down {asked} hashes 0x{:08x} 0x{:08x}",
        first.tick, first.hash, second.hash
    )
}

/// Requirement: SR-34
#[test]
fn a_rotor_in_c_does_what_it_does_in_rust() {
    let Some(said) = said_with_rig("pair.c") else {
        return;
    };
    assert_eq!(said.lines().last(), Some(pair_of_rust().as_str()));
}

#[test]
fn a_rotor_in_firmware_does_what_it_does_in_rust() {
    for (target, said) in said_on_boards("pair.c") {
        let last = said.lines().last();
        assert_eq!(last, Some(pair_of_rust().as_str()), "{target:?}: {said}");
    }
}

/// The example with a rotor of its own: a blow that levitation alone does not recover from, and a lighter one after which
/// the supervisor leaves fewer touches.
#[test]
fn a_model_of_someone_elses_is_driven() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let folder = Folder::fresh();
    let program = folder.at("two_planes");
    let sources = [capi().join("examples/two_planes.c")];
    let Some(compiled) = host_program(&sources, &library, &program) else {
        return;
    };
    compiled.good();
    let run = |blow: &str| -> [(usize, bool); 2] {
        let said = ran(Command::new(&program).arg(blow)).good();
        let mut lines = said.lines().map(|line| {
            let (_, figures) = line.split_once(": ").unwrap();
            let (touches, _) = figures.split_once(' ').unwrap();
            let recovered = figures.ends_with(" recovered") && !figures.contains("not ");
            (touches.parse().unwrap(), recovered)
        });
        let two = [lines.next().unwrap(), lines.next().unwrap()];
        assert_eq!(lines.next(), None);
        two
    };
    let [alone, supervised] = run("5");
    let fewer = alone.1 && supervised.1 && supervised.0 < alone.0;
    assert!(fewer, "{alone:?} {supervised:?}");
    let [alone, supervised] = run("7");
    assert!(!alone.1 && supervised.1, "{alone:?} {supervised:?}");
}
