//! The supervisor of a rotor in C: what Rust computes, in the emulator too; and the example with a model of its own.

use crate::firmware::output_on;
use crate::library::{Target, beside, built, capi, good, host_program, output_with_rig};
use crate::rig::Rig;
use std::process::Command;
use supervisor::{PlanePositions, RotorSupervisor, Shaft};

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
    let (mut others, mut asked) = (0, 0);
    while ends[0].tick < Rig::TICKS {
        if let Some(config) = ends[0].reconfigures() {
            rotor.reconfigure(&shaft(), &[config; 2]).unwrap();
        }
        let samples = [ends[0].sample(), ends[1].sample()];
        let command = rotor.tick(&samples);
        for (end, command) in ends.iter_mut().zip(&command.planes) {
            end.actuate(command);
        }
        others += command.other_engaged.map(u32::from).iter().sum::<u32>();
        asked += u32::from(command.coast_down);
    }
    let [first, second] = ends;
    assert!(others > 100 && first.hash != second.hash, "{others}");
    format!(
        "ticks {} engaged {others} coast-down {asked} hashes 0x{:08x} 0x{:08x}",
        first.tick, first.hash, second.hash
    )
}

/// Requirement: SR-34
#[test]
fn a_rotor_in_c_does_what_it_does_in_rust() {
    let Some(output) = output_with_rig("pair.c") else {
        return;
    };
    assert_eq!(output.lines().last(), Some(pair_of_rust().as_str()));
}

#[test]
fn a_rotor_in_firmware_does_what_it_does_in_rust() {
    for target in [Target::CortexM4F, Target::CortexM0] {
        let Some(output) = output_on(target, &beside("pair.c")) else {
            return;
        };
        let last = output.lines().last();
        assert_eq!(last, Some(pair_of_rust().as_str()), "{target:?}: {output}");
    }
}

/// The example with a rotor of its own: a blow that levitation alone does not recover from, and a lighter one after which
/// the supervisor leaves fewer touches.
#[test]
fn a_model_of_someone_elses_is_driven() {
    let Some(library) = built(Target::Host) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("two_planes");
    let sources = [capi().join("examples/two_planes.c")];
    let Some(output) = host_program(&sources, &library, &program) else {
        return;
    };
    good(&output);
    let run = |blow: &str| -> Vec<(usize, bool)> {
        let output = good(&Command::new(&program).arg(blow).output().unwrap());
        let lines = output.lines().map(|line| {
            let (_, figures) = line.split_once(": ").unwrap();
            let (touches, _) = figures.split_once(' ').unwrap();
            (
                touches.parse().unwrap(),
                figures.ends_with(" recovered") && !figures.contains("not "),
            )
        });
        lines.collect()
    };
    let [alone, supervised] = run("5")[..] else {
        panic!("two lines")
    };
    assert!(
        alone.1 && supervised.1 && supervised.0 < alone.0,
        "{alone:?} {supervised:?}"
    );
    let [alone, supervised] = run("7")[..] else {
        panic!("two lines")
    };
    assert!(!alone.1 && supervised.1, "{alone:?} {supervised:?}");
}
