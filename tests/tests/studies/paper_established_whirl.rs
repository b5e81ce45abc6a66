//! Established backward whirl in the two-mass stator against an earlier independent computation.

use plant_model::analysis::whirl::WhirlMeter;
use plant_model::params::Start;
use plant_model::{Inputs, Options, V2, build};
use std::f64::consts::TAU;
use system_tests::golden;
use system_tests::plants::footnote_4;

#[test]
fn footnote_4_at_40_hz() {
    const STEP_S: f64 = 20e-6;
    let start = Start {
        position_m: V2::new(2e-4, 0.0),
        velocity_m_s: V2::new(0.4, 0.0),
        spin_rad_s: 40.0 * TAU,
        spin_phase_rad: 0.0,
    };
    let mut plant = build(&footnote_4(), &start, Options::default()).unwrap();
    let mut meter = WhirlMeter::new(1e-3);
    let mut spin_hz = vec![(0.0, 40.0)];
    let mut outer_ring_m: f64 = 0.0;
    for i in 1..=5000 {
        let t = f64::from(i) * STEP_S;
        plant.advance(t, &Inputs::default(), &mut |_| {}).unwrap();
        let now = plant.snapshot();
        meter.push(t, now.whirl_angle_rad, now.mode.in_contact(), 1.0);
        outer_ring_m = outer_ring_m.max(now.outer_ring.position.norm());
        spin_hz.push((t, now.spin_rad_s / TAU));
    }
    let fastest = meter.fastest().unwrap();
    let first_below = |hz: f64| spin_hz.iter().find(|(_, s)| *s < hz).unwrap().0;
    let spin_at_max = spin_hz.iter().find(|(t, _)| *t >= fastest.t_s).unwrap().1;
    let measured = [
        ("max_whirl_hz", fastest.backward_hz),
        ("peak_contact_force_n", plant.meters().peak_contact_force_n),
        ("spin_at_max_whirl_hz", spin_at_max),
        ("outer_ring_m", outer_ring_m),
        (
            "spin_90_percent_to_2_hz_s",
            first_below(2.0) - first_below(36.0),
        ),
    ];
    golden::compare("established_whirl", &measured).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        plant.audit().residual() < 1e-10,
        "{}",
        plant.audit().residual()
    );
}
