//! Rotors that hardly spin: sliding and rolling friction turn round at the same speed, and round-off decides between modes.

use crate::support::*;
use plant_model::ContactMode::{Roll, Seated, SlipNegative, SlipPositive};

/// Whatever the start, a rotor that falls under its weight onto the wall, rolls and rests, comes to its end, and its energy adds
/// up.
#[test]
fn a_rotor_that_hardly_spins_comes_to_rest() {
    let weight = load(V2::new(0.0, -9.81 * MASS_KG));
    let free = free_spin(0.05, 0.0);
    for i in 0..30 {
        let velocity = (0.02 + 0.003 * f64::from(i)) * direction(0.7 * f64::from(i));
        for rolling in [0.0, 0.001, 0.025] {
            for (spin, spin_rad_s) in [(SpinParams::Held, 0.0), (free, 0.0), (free, 3.0)] {
                let mut params = free_mass(linear(1e8, 0.7), 0.125);
                params.spin = spin;
                params.friction.rolling_coefficient = rolling;
                let from = start(V2::zeros(), velocity, spin_rad_s);
                let mut plant = build(&params, &from, Options::default()).unwrap();
                for i in 1..=8000 {
                    plant
                        .advance(50e-6 * f64::from(i), &weight, &mut |_| {})
                        .unwrap_or_else(|e| panic!("{velocity:?}, {rolling}: {e}"));
                }
                closes("fallen", plant.audit().residual(), 1e-9);
            }
        }
    }
}

/// Without spin and race the sliding speed is the whirl's: what rests slips as soon as it whirls, in one change of mode and
/// by every method. A load turns away from under the rotor until it slips, swings and rests again.
#[test]
fn without_spin_a_rotor_at_rest_begins_to_slip_and_to_whirl_at_once() {
    for (turn, slip) in [(1.0, SlipPositive), (-1.0, SlipNegative)] {
        for (friction, rolling) in [(0.1, 0.02), (0.02, 0.1), (0.125, 0.125)] {
            let mut params = onset_rig();
            params.rotor.stiffness_n_m = 0.0;
            params.friction.sliding = constant(friction);
            params.friction.rolling_coefficient = rolling;
            let from = start(V2::new(0.0, -CLEARANCE_M - 1e-6), V2::zeros(), 0.0);
            let [modes, others] = METHODS.map(|method| {
                let mut plant = build(&params, &from, options(method, 1e-9)).unwrap();
                let mut modes = vec![plant.mode()];
                // To 30 degrees, where friction holds 7 to 14, and on there.
                for i in 0..1000_i32 {
                    let angle = turn * (0.3 * f64::from(i)).min(30.0).to_radians();
                    let push = load(100.0 * V2::new(angle.sin(), -angle.cos()));
                    let mut on_change = |now: &Snapshot| modes.push(now.mode);
                    plant
                        .advance(5e-5 * f64::from(i + 1), &push, &mut on_change)
                        .unwrap();
                }
                modes
            });
            assert_eq!(modes[..2], [Seated, slip], "{friction}, {rolling}");
            assert_eq!(modes.last(), Some(&Seated), "{friction}, {rolling}");
            assert!(!modes.contains(&Roll), "{friction}, {rolling}");
            assert_eq!(others, modes, "{friction}, {rolling}");
        }
    }
}
