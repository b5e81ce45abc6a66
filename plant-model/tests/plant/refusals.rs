//! What contradicts itself is refused by name.

use crate::support::rotor::*;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::params::*;
use plant_model::{Options, PlantError, V2};

fn refused(field: &str, change: impl Fn(&mut MachineParams)) {
    let mut params = machine();
    change(&mut params);
    let error = Machine::new(&params, &MachineStart::default(), Options::default())
        .err()
        .unwrap_or_else(|| panic!("{field} was taken"));
    assert_eq!(error.field, field, "{error}");
}

#[test]
fn values_out_of_range_are_named() {
    refused("rotor.polar_inertia_kg_m2", |p| p.rotor = rigid(0.2, 0.41));
    refused("rotor.transverse_inertia_kg_m2", |p| {
        p.rotor = rigid(0.0, 0.0);
    });
    refused("spin.inertia_kg_m2", |p| {
        p.spin = SpinParams::Free {
            inertia_kg_m2: 0.04,
            drive_torque_n_m: 0.0,
        };
    });
    refused("rotor.polar_inertia_kg_m2", |p| {
        p.rotor = rigid(f64::INFINITY, 0.1);
    });
    for transverse in [0.2, f64::INFINITY] {
        let many = transverse == 0.2;
        let field = match many {
            true => "rotor.bending",
            false => "rotor.transverse_inertia_kg_m2",
        };
        refused(field, |p| {
            p.rotor = Rotor::Modal {
                rigid: *rigid(transverse, 0.0).rigid(),
                bending: bending(if many { 63 } else { 1 }, 2500.0),
                polar_coupling_kg_m2: vec![],
                damping_n_s_m: vec![],
            };
        });
    }
    refused("planes", |p| p.planes.clear());
    refused("planes", |p| p.planes = vec![plane(0.0, 1.0); 5]);
    refused("planes[1].contact.clearance_m", |p| {
        p.planes[1].contact.clearance_m = 0.0;
    });
    refused("planes[0].stator.inner.mass_kg", |p| {
        p.planes[0].stator = StatorParams::OneMass(RingParams {
            mass_kg: 0.0,
            stiffness_n_m: V2::zeros(),
            damping_n_s_m: V2::zeros(),
        });
    });
    refused("planes[0].stator.ellipticity", |p| {
        p.planes[0].stator = StatorParams::RigidEllipse(EllipseParams {
            ellipticity: 0.3,
            long_axis_rad: 0.0,
        });
    });
    refused("supports[1].stiffness_n_m", |p| {
        p.supports[1].stiffness_n_m.x = f64::NAN;
    });
    refused("unbalances[0].moment_kg_m", |p| {
        p.unbalances[0].moment_kg_m = -1.0;
    });
}

/// A plane beyond the end of the shaft, of which no shape knows how it bends there.
#[test]
fn a_place_off_the_shaft_is_named() {
    let modal = |p: &mut MachineParams| {
        p.rotor = Rotor::Modal {
            rigid: *rigid(0.2, 0.05).rigid(),
            bending: bending(2, 2000.0),
            polar_coupling_kg_m2: vec![],
            damping_n_s_m: vec![],
        };
    };
    refused("planes[1].position_m", |p| {
        modal(p);
        p.planes[1].position_m = 0.26;
    });
    refused("rotor.damping_n_s_m", |p| {
        modal(p);
        if let Rotor::Modal { damping_n_s_m, .. } = &mut p.rotor {
            // It would drive the second mode.
            *damping_n_s_m = vec![0.0; 16];
            damping_n_s_m[15] = -1.0;
        }
    });
    refused("rotor.polar_coupling_kg_m2", |p| {
        modal(p);
        if let Rotor::Modal {
            polar_coupling_kg_m2,
            ..
        } = &mut p.rotor
        {
            *polar_coupling_kg_m2 = vec![0.0; 4];
        }
    });
}

#[test]
fn forces_that_nobody_has_asked_for_are_refused() {
    let start = MachineStart::default();
    let mut rotor = Machine::new(&machine(), &start, Options::default()).unwrap();
    let inputs = |load: V2| MachineInputs {
        commands_n: vec![],
        loads_n: vec![load],
    };
    let mut advance = |inputs: &MachineInputs| rotor.advance(1e-3, inputs, &mut |_, _| {});
    let error = advance(&inputs(V2::zeros())).unwrap_err();
    assert_eq!(error, PlantError::InputCount { t_s: 0.0 });
    advance(&MachineInputs::default()).unwrap();

    let mut params = machine();
    params.loads_m = vec![0.1];
    let mut rotor = Machine::new(&params, &start, Options::default()).unwrap();
    let error = rotor.advance(1e-3, &inputs(V2::new(f64::NAN, 0.0)), &mut |_, _| {});
    assert_eq!(error.unwrap_err(), PlantError::NotFinite { t_s: 0.0 });
}
