//! Planes that no controller knows of, beside those of a levitated rotor.

use super::levitated::LEVITATED;
use super::{machine, planes};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use system_tests::ran::{Folder, edited, has, lacks, list, number};

/// One supervisor over two bearings, by gains of each plane.
fn supervised() -> String {
    let both = "policies = [\"levitation\", \"supervisor\"]";
    let gains = "proportional_n_m = 1.4e6\nintegral_n_m_s = 4e6";
    let edits = [
        ("policies = [\"levitation\"]", both),
        ("duration_s = 0.4", "duration_s = 0.08"),
        ("coefficient = 0.15", "coefficient = 0.05"),
        (gains, "proportional_n_m = 7e5"),
    ];
    let by_mode = edited(LEVITATED, &edits);
    let (head, rest) = by_mode.split_once("[levitation.tilt]").unwrap();
    let (_, of_planes) = rest.split_once("[[plane]]").unwrap();
    let load = "[[disturbance]]\nstart_s = 0.01\nduration_s = 0.003\nforce_n = [2500.0, 600.0]\nposition_m = 0.1\n";
    format!("{head}{load}[[plane]]{of_planes}")
}

/// With a seal before the first plane.
fn with_seal(text: &str, position_m: f64, clearance_m: f64) -> String {
    let seal = format!(
        "[[plane]]\nname = \"seal\"\nposition_m = {position_m}\ncontact_radius_m = 0.03\nseal = true\n\
         contact = {{ clearance_m = {clearance_m:e}, stiffness_n_m = 2e7, restitution = 0.5 }}\n\
         friction = {{ coefficient = 0.3 }}\n[[plane]]\nname = \"A\""
    );
    text.replace("[[plane]]\nname = \"A\"", &seal)
}

/// Figures and rows of the bearings; no seal is touched.
fn bearings(scene: &Scene, kind: PolicyKind) -> Vec<(Figures, Trace)> {
    let all = planes(scene, kind).into_iter().zip(&scene.planes);
    all.filter(|((figures, _), plane)| {
        assert!(!plane.seal || figures.impacts == 0);
        !plane.seal
    })
    .map(|(ended, _)| ended)
    .collect()
}

/// A seal that is never touched changes nothing, wherever it stands among the planes: not for controllers of each plane, by mode or
/// by matrices, and not for the supervisor, which has the two bearings.
#[test]
fn who_levitates_does_not_know_of_a_seal() {
    let by_mode = supervised().replace(
        "feed_forward_weight = true",
        "feed_forward_weight = true\n[levitation.tilt]\nproportional_n_m_rad = 3e4\nderivative_n_m_s_rad = 60.0\ncross_feedback = 0.5",
    );
    // A PD of each coordinate: the state is the last reading.
    let diagonal = |x: &str| {
        let row = |i: u32| if i.is_multiple_of(5) { x } else { "0.0" };
        (0..16).map(row).collect::<Vec<_>>().join(", ")
    };
    let (before, after) = by_mode.split_once("[levitation]").unwrap();
    let (_, after) = after.split_once("cross_feedback = 0.5").unwrap();
    let by_matrices = format!(
        "{before}[state_space]\na = [{}]\nb = [{}]\nc = [{}]\nd = [{}]\n{after}",
        diagonal("0.0"),
        diagonal("1.0"),
        diagonal("6e7"),
        diagonal("-6.08e7")
    );
    for text in [supervised(), by_mode, by_matrices] {
        let (without, with) = (machine(&text), machine(&with_seal(&text, 0.0, 3e-3)));
        assert_eq!(with.supervised(), Some([1, 2]));
        assert_eq!(with.shaft(), without.shaft());
        for kind in [PolicyKind::Levitation, PolicyKind::Supervisor] {
            let ended = [&without, &with].map(|scene| bearings(scene, kind));
            assert!(ended[0].iter().any(|(figures, _)| figures.impacts > 0));
            for (a, b) in ended[0].iter().zip(&ended[1]) {
                assert_eq!(a.0.impacts, b.0.impacts);
                // Not shown where they differ: they are thousands.
                assert!(a.1.rows == b.1.rows, "{}", kind.name());
                assert!(a.1.read_out == b.1.read_out);
            }
        }
    }
}

/// What is touched there counts for the machine, and is the seal's own.
#[test]
fn a_seal_that_is_touched_is_judged() {
    let scene = machine(&with_seal(&supervised(), 0.1, 1e-4));
    // From what the magnets do there: 1000 N at each end, and the force of an impact is no weaker in between.
    let mut limits = scene.planes.iter().map(|plane| plane.whirl_speed_m_s);
    assert!(limits.all(|limit| (0.1..1.0).contains(&limit)));
    for kind in [
        PolicyKind::Passive,
        PolicyKind::Levitation,
        PolicyKind::Supervisor,
    ] {
        let ended = planes(&scene, kind);
        let figures: Vec<Figures> = ended.iter().map(|(figures, _)| figures.clone()).collect();
        let (seal, whole) = (&figures[0], Figures::of_machine(&figures).unwrap());
        assert!(seal.impacts > 0 && seal.contact_impulse_n_s > 0.0);
        let impacts = figures.iter().map(|f| f.impacts);
        assert_eq!(whole.impacts, impacts.sum::<u64>());
        assert!(whole.outcome >= seal.outcome);
        assert!(whole.energy_residual < 1e-8);
        let supervised = kind == PolicyKind::Supervisor;
        for ((_, trace), said) in ended.iter().zip([false, supervised, supervised]) {
            assert_eq!(trace.rows.iter().any(|row| row.supervisor.is_some()), said);
        }
        let forces = ended[0].1.rows.iter().map(|row| row.commanded_n.norm());
        assert_eq!(forces.fold(0.0, f64::max), 0.0);
    }
}

/// Verdict, page, traces and records of a scene with a seal.
#[test]
fn what_is_written_has_the_seal() {
    let folder = Folder::fresh();
    let line = "run @machines/blade_lost_over_a_seal --out out --json";
    let verdict = folder.ran(line).json();
    let plane = |policy: &str, name: &str| {
        let mut planes = list(&verdict["policies"][policy]["planes"]).iter();
        planes.find(|p| p["name"] == name).unwrap().clone()
    };
    let impulse = |policy: &str| {
        let seal = plane(policy, "seal");
        assert_eq!(seal["outcome"], "recovered");
        assert!(seal["impacts"].as_u64().unwrap() > 0 && seal["supervision"].is_null());
        assert!(seal["peak_backward_speed_m_s"].is_number());
        number(&seal["contact_impulse_n_s"])
    };
    // As the story has it.
    assert!(impulse("supervisor") < 0.25 * impulse("levitation"));
    for bearing in ["drive end", "turbine end"] {
        for policy in ["levitation", "supervisor"] {
            assert_eq!(plane(policy, bearing)["impacts"], 0);
        }
        assert!(plane("supervisor", bearing)["supervision"].is_object());
    }
    let page = folder.text("out/report.html");
    has(&page, &["Plane: seal", "seal (seal) at 100 mm"]);
    has(&page, &["800 g mm of unbalance more", "115 N m"]);
    let mut of_seal = folder.names("out");
    of_seal.retain(|name| name.contains("seal"));
    assert!(of_seal.contains(&"trace_supervisor_seal.parquet".to_owned()));
    lacks(&of_seal.join(" "), &[".bin"]);
}
