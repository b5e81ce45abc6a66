//! A rotor whose supervisor ticks one plane in a control sample and the other in the next.

use super::{machine, planes};
use crate::refusals::{all, parsed};
use firmware_bench::record::file::RecordFile;
use firmware_bench::run::closed_loop::{Accuracy, Recorders, record};
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use std::fs;
use system_tests::root;

/// Two bearings of a catalogue's rotor after a blow in the middle.
fn struck(in_turn: bool, blow_m_s: f64) -> Scene {
    let file = root().join("firmware-host/scenes/rotors/p5.toml");
    let text = fs::read_to_string(file).unwrap();
    let rate = "sample_rate_hz = 20000\n";
    assert!(text.contains(rate));
    let text = text.replace(rate, &format!("{rate}planes_in_turn = {in_turn}\n"));
    machine(&format!(
        "{text}\n[start]\nlevitated_before = true\nvelocity_m_s = [{blow_m_s}, 0.0]\n"
    ))
}

/// It recovers from what levitation alone does not, and its records, of ticks of two samples, replay to the bit.
#[test]
fn planes_in_turn_recover_and_replay() {
    let scene = struck(true, 0.72);
    let periods_s = (scene.planes.iter()).map(|plane| plane.supervisor.unwrap().sample_period_s);
    assert_eq!(periods_s.collect::<Vec<f32>>(), [1e-4, 1e-4]);
    let recovered = |kind| {
        let mut planes = planes(&scene, kind).into_iter();
        planes.all(|(figures, _)| figures.recovered)
    };
    assert!(!recovered(PolicyKind::Levitation));
    assert!(recovered(PolicyKind::Supervisor));
    let mut records = Vec::new();
    let mut traces = vec![Trace::default(); 2];
    let recorders = Recorders::of_planes(&mut traces);
    let (kind, accuracy) = (PolicyKind::Supervisor, Accuracy::default());
    for (_, read_out) in record(&scene, kind, recorders, accuracy, &mut |_| {}).unwrap() {
        let read_out = read_out.unwrap();
        assert!(read_out.report.landings > 0);
        assert_eq!(read_out.report.missed_ticks, 0);
        records.extend(read_out.flight_record.unwrap());
    }
    let file = RecordFile::of(&records);
    assert_eq!((&file.damage[..], file.records.len()), (&[][..], 2));
    let replay = file.events()[0].replay.unwrap();
    assert!(replay.ticks > 500 && replay.differing == 0, "{replay:?}");
}

/// A levitated rotor gets what its controllers ask for in every sample, also of the plane whose turn it is not.
#[test]
fn a_levitated_rotor_waits_for_no_turn() {
    let forces = |kind| {
        let traces = planes(&struck(true, 0.01), kind);
        let rows = traces.into_iter().flat_map(|(_, trace)| trace.rows);
        rows.map(|row| row.commanded_n).collect::<Vec<_>>()
    };
    let (alone, supervised) = (
        forces(PolicyKind::Levitation),
        forces(PolicyKind::Supervisor),
    );
    assert!(alone.iter().any(|force| force.norm() > 10.0));
    let apart = alone.iter().zip(&supervised).map(|(a, b)| (a - b).norm());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart < 0.05, "{apart} N"); // forces in single precision, and what comes of that in a loop
}

#[test]
fn a_point_mass_has_no_turns() {
    let text = fs::read_to_string(root().join("firmware-host/scenes/plants/p2.toml")).unwrap();
    all("scenes/p2", 1, &text, parsed);
}
