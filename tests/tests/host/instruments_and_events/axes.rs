//! Sensors and magnets whose axes are not those of the scene.

use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::Spec;
use nalgebra::Rotation2;
use plant_model::V2;

const SCENE: &str = r#"
title = "Axes"
[run]
duration_s = 0.1
sample_rate_hz = 20000
policies = ["levitation", "supervisor"]
[rotor]
mass_kg = 10.0
contact_radius_m = 0.05
gravity_m_s2 = [0.0, -9.81]
[spin]
frequency_hz = 100.0
[start]
position_m = [2e-5, 0.0]
levitated_before = true
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.6
[friction]
coefficient = 0.15
[magnet]
force_max_n = 1000.0
lag_s = 1e-4
force_measured = true
axis_force_max_n = 800.0
[levitation]
proportional_n_m = 1e6
derivative_n_s_m = 300.0
derivative_filter_s = 0.0
feed_forward_weight = true
"#;

fn ran(kind: PolicyKind, keys: &[(&str, toml::Value)]) -> (Figures, Trace) {
    let mut spec = Spec::parse("axes.toml", SCENE).unwrap();
    spec.set_all(keys).unwrap();
    run(&spec.resolve().unwrap(), kind, Keep::Trace, &mut |_| {}).unwrap()
}

fn pair(v: V2) -> toml::Value {
    toml::Value::Array(vec![v.x.into(), v.y.into()])
}

/// Sensor and magnet turned alike, with weight, start and load: the same run, turned. An axis' own cap turns with them.
#[test]
fn turned_as_a_whole_nothing_else_changes() {
    let degrees = 37.0_f64;
    let turned = Rotation2::new(degrees.to_radians());
    let at = |turned: Rotation2<f64>, degrees: f64| {
        let mut load = toml::Table::new();
        load.insert("start_s".to_owned(), 0.02.into());
        load.insert("duration_s".to_owned(), 0.004.into());
        load.insert("force_n".to_owned(), pair(turned * V2::new(1800.0, 300.0)));
        [
            ("sensor.axes_deg", degrees.into()),
            ("magnet.axes_deg", degrees.into()),
            ("rotor.gravity_m_s2", pair(turned * V2::new(0.0, -9.81))),
            ("start.position_m", pair(turned * V2::new(2e-5, 0.0))),
            ("disturbance", vec![load].into()),
        ]
    };
    for (kind, apart_m) in [
        (PolicyKind::Levitation, 1e-12),
        (PolicyKind::Supervisor, 1e-7),
    ] {
        let (plain, plain_trace) = ran(kind, &at(Rotation2::identity(), 0.0));
        let (figures, trace) = ran(kind, &at(turned, degrees));
        assert!(plain.impacts > 0 && plain.impacts == figures.impacts);
        assert_eq!(plain.outcome, figures.outcome);
        let samples = |trace: Trace| trace.rows.into_iter().filter(|row| !row.mode_change);
        for (plain, own) in samples(plain_trace).zip(samples(trace)) {
            let t_s = own.plant.t_s;
            for (plain, own) in [
                (plain.plant.position_m, own.plant.position_m),
                (plain.measured_m, own.measured_m),
                (1e-7 * plain.commanded_n, 1e-7 * own.commanded_n),
            ] {
                let apart = (turned * plain - own).norm();
                assert!(apart < apart_m, "{apart:e} at {t_s} s");
            }
        }
    }
}

/// A magnet turned against its sensor pushes across with k·sin δ, which drives a whirl that the damper brakes with d·ω·cos δ, less
/// what delay and hold (1.5 periods) take of it: d − k·75 µs = 225 N s/m, even at 4.1°.
#[test]
fn turned_against_each_other_they_drive_whirl() {
    let after = |degrees: f64| {
        let (figures, _) = ran(
            PolicyKind::Levitation,
            &[
                ("magnet.axes_deg", degrees.into()),
                ("magnet.lag_s", 0.0.into()),
                ("run.duration_s", 0.4.into()),
                ("verdict.whirl_speed_m_s", 1.0.into()),
            ],
        );
        figures
    };
    for degrees in [3.0, -3.0] {
        let figures = after(degrees);
        assert!(figures.recovered && figures.impacts == 0, "{degrees}");
    }
    for degrees in [10.0, -10.0] {
        assert!(after(degrees).impacts > 0, "{degrees}");
    }
}

#[test]
fn poles_stand_along_the_axes_of_the_scene() {
    let mut spec = Spec::parse("axes.toml", SCENE).unwrap();
    let mut poles = toml::Table::new();
    for (key, value) in [("bias_current_a", 3.0), ("air_gap_m", 4e-4)] {
        poles.insert(key.to_owned(), value.into());
    }
    spec.set_all(&[
        ("magnet.poles", poles.into()),
        ("magnet.axes_deg", 45.0.into()),
    ])
    .unwrap();
    let error = spec.resolve().unwrap_err().to_string();
    assert!(error.contains("does not go with magnet.poles"), "{error}");
}
