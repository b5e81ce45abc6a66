//! The supervisor of a whole rotor as a unit, against the native one on the samples of a closed loop.

use super::{CHECKS, checked, text, units};
use firmware_bench::run::closed_loop::stepwise::{Driver, Stepwise};
use firmware_bench::run::controller::Seen;
use firmware_bench::run::trace::SupervisorTrace;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::V2;
use std::fmt::Write as _;
use supervisor::{Command, IntegratorHint, Mode, Sample};
use system_tests::ran::{Folder, has};
use system_tests::{python, scene};

/// A sample as firmware has it, with what the levitation controller asks for.
fn sample(seen: &Seen, levitation_n: [f32; 2]) -> Sample {
    let single = |v: V2| [v.x as f32, v.y as f32];
    Sample {
        position_m: single(seen.reading.position_m),
        sequence: seen.reading.sequence,
        status: seen.status,
        spin_rad_s: seen.spin_rad_s as f32,
        levitation_n,
        applied_n: single(seen.applied_n),
    }
}

/// What firmware sees in both planes at each sample, and what the supervisor said to it.
fn closed_loop(scene: &Scene) -> Vec<[(Seen, SupervisorTrace); 2]> {
    let samples = (scene.duration_s * scene.sample_rate_hz).round() as usize;
    let driver = Driver::Policy(PolicyKind::Supervisor);
    let mut stepwise = Stepwise::new(scene.clone(), driver).unwrap();
    let mut all = Vec::new();
    for _ in 0..samples {
        all.push([0, 1].map(|plane| {
            let (row, seen) = stepwise.at(plane).unwrap();
            (seen, row.supervisor.unwrap())
        }));
        stepwise.advance().unwrap();
    }
    all
}

/// A row of a plane: inputs and outputs of the unit, in the order of [`COLUMNS`].
fn row(sample: &Sample, command: &Command) -> String {
    let mut row = String::new();
    let [x, y] = sample.position_m.map(f64::from);
    let (sequence, status) = (sample.sequence, sample.status.bits());
    let _ = write!(row, "{x:?},{y:?},{sequence},{status}");
    let numbers = [
        sample.spin_rad_s,
        sample.levitation_n[0],
        sample.levitation_n[1],
        sample.applied_n[0],
        sample.applied_n[1],
        command.force_n[0],
        command.force_n[1],
        command.severity,
    ];
    for number in numbers {
        let _ = write!(row, ",{:?}", f64::from(number));
    }
    let hold = u8::from(command.integrator == IntegratorHint::Hold);
    let _ = write!(
        row,
        ",{hold},{},{},{}",
        command.mode as u8,
        command.limits.bits(),
        command.events.bits()
    );
    row
}

const COLUMNS: [&str; 16] = [
    "measured_x_m",
    "measured_y_m",
    "sequence",
    "status",
    "spin_reported_rad_s",
    "levitation_x_n",
    "levitation_y_n",
    "applied_x_n",
    "applied_y_n",
    "command_x_n",
    "command_y_n",
    "supervisor_severity",
    "integrator_hold",
    "supervisor_mode",
    "supervisor_limits",
    "supervisor_events",
];

#[test]
fn the_supervisor_of_a_whole_rotor_is_the_native_one() {
    let Some(python) = python() else { return };
    let name = "machines/overload_of_a_flexible_rotor";
    let scene = scene(name);
    let seen = closed_loop(&scene);
    let mut native = scene.supervisor().unwrap();
    let columns = [0, 1].map(|plane| COLUMNS.map(|name| format!("plane[{plane}].{name}")));
    let mut table = columns.concat().join(",") + "\n";
    let mut modes = Vec::new();
    for planes in &seen {
        let samples = planes.map(|(seen, said)| sample(&seen, said.levitation_n));
        let commands = native.tick(&samples).planes;
        for ((_, said), command) in planes.iter().zip(&commands) {
            // What is replayed here is what the loop was told, and what it did.
            assert_eq!(*said, SupervisorTrace::new(command, said.levitation_n));
            modes.push(command.mode);
        }
        let rows: Vec<String> = (samples.iter().zip(&commands))
            .map(|(sample, command)| row(sample, command))
            .collect();
        table += &(rows.join(",") + "\n");
    }
    // A loop that never leaves levitation shows little.
    for mode in [Mode::Levitated, Mode::Bounce, Mode::Handover] {
        assert!(modes.contains(&mode), "{mode:?}");
    }
    let folder = Folder::fresh();
    let csv = text(&folder.put("ticks.csv", table));
    for version in ["3.0", "2.0"] {
        units(&folder, &format!("@{name}"), version);
        let unit = text(&folder.at("supervisor.fmu"));
        let said = checked(&python, CHECKS, &["ticks", &unit, &csv]);
        let expected = format!("{} ticks of 2 planes the same", seen.len());
        has(&said, &[&expected]);
    }
}
