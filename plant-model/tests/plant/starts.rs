//! A rotor that starts on its wall: it rests there, is lifted, or rolls on, and no run stands still.

use crate::support::rotor::*;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::{Mode, Options, V2};

/// Parked in both planes without a force on it, at an angle; `lifted`: springs draw it to the middle.
fn parked(angle: f64, lifted: bool, along_m_s: f64) -> Machine {
    let mut params = machine();
    params.unbalances.clear();
    if !lifted {
        params.supports.clear();
    }
    let n = V2::new(angle.cos(), angle.sin());
    let start = MachineStart {
        centre_m: CLEARANCE_M * n,
        centre_velocity_m_s: along_m_s * V2::new(-n.y, n.x),
        spin_rad_s: 1000.0,
        ..MachineStart::default()
    };
    let mut machine = Machine::new(&params, &start, Options::default()).unwrap();
    for i in 1..=40 {
        machine
            .advance(
                f64::from(i) / 2e4,
                &MachineInputs::default(),
                &mut |_, _| {},
            )
            .unwrap_or_else(|e| panic!("at {angle}: {e}"));
    }
    machine
}

#[test]
fn a_rotor_parked_on_its_wall_without_a_force_stays_there() {
    for i in 0..200 {
        let angle = 0.137 * f64::from(i);
        let machine = parked(angle, false, 0.0);
        let radius_m = machine.axis().centre.position.norm();
        assert!((radius_m / CLEARANCE_M - 1.0).abs() < 1e-12, "{angle}");
        assert_eq!(machine.meters().iter().map(|m| m.impacts).sum::<u64>(), 0);
        assert!(machine.work().steps < 200, "{angle}: {:?}", machine.work());
    }
}

#[test]
fn a_rotor_lifted_off_its_wall_leaves_it() {
    for i in 0..200 {
        let angle = 0.137 * f64::from(i);
        let machine = parked(angle, true, 0.0);
        assert_eq!(machine.mode(0), Some(Mode::Flight), "{angle}");
        let meters = machine.meters();
        assert!(
            meters
                .iter()
                .all(|m| m.impacts == 0 && m.contact_time_s == 0.0)
        );
        // 200 rad/s for 2 ms: by 1 − cos 0.4 of the way.
        let left = machine.axis().centre.position.norm() / CLEARANCE_M;
        assert!((left - 0.4_f64.cos()).abs() < 0.01, "{angle}: {left}");
    }
}

/// As of a point mass: the curve presses it on, which is a contact and no impact.
#[test]
fn a_rotor_that_starts_along_its_wall_is_in_contact_and_has_no_impact() {
    for i in 0..200 {
        let angle = 0.137 * f64::from(i);
        let machine = parked(angle, false, -0.3);
        for meters in machine.meters() {
            assert_eq!((meters.impacts, meters.hard_impacts), (0, 0), "{angle}");
            assert!(meters.contact_time_s > 1e-4, "{angle}");
        }
    }
}
