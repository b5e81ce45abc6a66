//! Ranges of whirl that friction can hold, against Black's condition of one plane and against like planes written out.

use crate::support::*;
use nalgebra::Complex;
use plant_model::analysis::black::SteadyWhirl;
use plant_model::machine::linear::{LinearMachine, Walls};
use plant_model::machine::whirl_ranges::WhirlRange;
use std::f64::consts::PI;

type C = Complex<f64>;

fn ranges(params: &MachineParams, spin_rad_s: f64) -> Vec<WhirlRange> {
    let machine = LinearMachine::new(params, Walls::Off).unwrap();
    machine.whirl_ranges(spin_rad_s).unwrap()
}

#[test]
fn one_plane_is_blacks_condition() {
    let mut params = machine();
    params.planes = vec![plane(0.0, 1.0)];
    params.planes[0].stator = StatorParams::OneMass(ring(3.0, 2e7, 800.0));
    let point = PlantParams {
        stator: params.planes[0].stator,
        ..bouncing(1e8)
    };
    let mut whirl = SteadyWhirl::from_params(&point).unwrap();
    whirl.tangential_compliance_m_n = whirl.normal_compliance_m_n;
    let found = ranges(&params, 500.0);
    let fastest = 1.5 * (1e8_f64 * (1.0 / 10.0 + 1.0 / 3.0)).sqrt();
    let mut ends = 0;
    for range in &found {
        let [from, to] = range.rates_rad_s;
        let is_end = |rate: &f64| (rate / fastest - 1.0).abs() > 1e-9;
        for end in [from, to].into_iter().filter(is_end) {
            let needed = whirl.friction_needed(end).unwrap_or(f64::NAN).abs();
            near("needed", needed, 0.3, 1e-6);
            ends += 1;
        }
        for share in [0.1, 0.5, 0.9] {
            let needed = whirl.friction_needed(from + share * (to - from));
            assert!(needed.is_some_and(|mu| mu.abs() < 0.3), "{needed:?}");
        }
    }
    assert!(ends >= 3, "{found:?}");
    // And outside none that holds.
    for i in 1..500 {
        let rate = fastest * f64::from(i) / 500.0;
        let needed = whirl.friction_needed(rate);
        let holds = needed.is_some_and(|mu| mu.abs() <= 0.3);
        let has = |range: &WhirlRange| range.rates_rad_s[0] <= rate && rate <= range.rates_rad_s[1];
        assert_eq!(holds, found.iter().any(has), "at {rate}");
    }
}

/// Receptances of the rotor of `machine()` in backward circles: of its translation and, over the arm, of its tilt.
fn receptances(rate: f64, spin: f64) -> (C, C) {
    let arm = 0.15 * 0.15;
    let translation = C::new(4e5 - 10.0 * rate * rate, -200.0 * rate).inv();
    let tilt = C::new(
        4e5 * arm - 0.2 * rate * rate - 0.05 * spin * rate,
        -200.0 * arm * rate,
    );
    (translation, PLANE_M * PLANE_M / tilt)
}

const PLANE_M: f64 = 0.2;

#[test]
fn like_planes_whirl_as_a_cylinder_and_as_a_cone() {
    let mut params = machine();
    params.planes = vec![plane(-PLANE_M, 1.0), plane(PLANE_M, 1.0)];
    for spin in [0.0, 2000.0] {
        let found = ranges(&params, spin);
        let both: Vec<&WhirlRange> = found.iter().filter(|r| r.planes == [0, 1]).collect();
        let needed = |rate: f64, cone: bool| {
            let (translation, tilt) = receptances(rate, spin);
            let force = -(2.0 * if cone { tilt } else { translation } + 1e-8).inv();
            match force.re > 0.0 {
                true => force.im.abs() / force.re,
                false => f64::INFINITY,
            }
        };
        // The slowest whirl of each shape is where friction begins to hold it; the phase says which it is.
        let first = |cone: bool| {
            let mut rate = 1.0;
            while needed(rate, cone) > 0.3 {
                rate *= 1.000_01;
            }
            rate
        };
        let slowest = both[0];
        let (cylinder, cone) = (first(false), first(true));
        let expected = cylinder.min(cone);
        let rate = slowest.rates_rad_s[0];
        assert!(rate < expected * (1.0 + 2e-5), "{rate}, {expected}");
        for range in &both {
            for (rate, phase) in range.rates_rad_s.into_iter().zip(range.phases_rad) {
                if phase.abs() < 1e-3 || PI - phase.abs() < 1e-3 {
                    let share = needed(rate, phase.abs() > 1.0);
                    assert!(share < 0.3 * (1.0 + 1e-3), "{share} at {rate}");
                }
            }
        }
        // Gyroscopics slow the backward cone down, and leave the cylinder alone.
        let alone = found.iter().filter(|r| r.planes.len() == 1).count();
        assert!(alone >= 2, "{found:?}");
        if spin > 0.0 {
            assert!(cone < 0.9 * cylinder, "{cone} {cylinder}");
        }
    }
}

/// Rolling friction that is more than sliding friction leaves none to drive with; of closed walls nothing is said.
#[test]
fn what_drives_nothing_holds_nothing() {
    let mut params = machine();
    for plane in &mut params.planes {
        plane.friction.rolling_coefficient = 0.4;
    }
    assert_eq!(ranges(&params, 500.0), []);
    let closed = LinearMachine::new(&machine(), Walls::Closed).unwrap();
    assert_eq!(closed.whirl_ranges(500.0), None);
}

#[test]
fn whirl_is_no_circle_on_supports_that_differ() {
    let mut params = machine();
    params.supports[0].stiffness_n_m.x *= 1.1;
    let machine = LinearMachine::new(&params, Walls::Off).unwrap();
    assert_eq!(machine.whirl_ranges(100.0), None);
}
