//! What contradicts itself is refused by name.

use crate::support::*;

fn refused_by(method: Method, field: &str, change: impl Fn(&mut MachineParams)) {
    let mut params = machine();
    change(&mut params);
    let error = Machine::new(&params, &MachineStart::default(), options(method, 1e-9))
        .err()
        .unwrap_or_else(|| panic!("{field} was taken"));
    assert_eq!(error.field, field, "{error}");
}

fn refused(field: &str, change: impl Fn(&mut MachineParams)) {
    refused_by(Method::Auto, field, change);
}

#[test]
fn values_out_of_range_are_named() {
    let rotor = |field: &str, rotor: Rotor| refused(field, |p| p.rotor = rotor.clone());
    let (polar, transverse) = (
        "rotor.polar_inertia_kg_m2",
        "rotor.transverse_inertia_kg_m2",
    );
    rotor(polar, rigid(0.2, 0.41));
    rotor(polar, rigid(f64::INFINITY, 0.1));
    rotor(transverse, rigid(0.0, 0.0));
    rotor(
        transverse,
        modal(&rigid(f64::INFINITY, 0.0), bending(1, 2500.0)),
    );
    rotor(
        "rotor.bending",
        modal(&rigid(0.2, 0.0), bending(63, 2500.0)),
    );
    refused("spin.inertia_kg_m2", |p| p.spin = free_spin(0.04, 0.0));
    refused("planes", |p| p.planes.clear());
    refused("planes", |p| p.planes = vec![plane(0.0, 1.0); 5]);
    let stator = |field: &str, of: StatorParams| refused(field, |p| p.planes[0].stator = of);
    let light = ring(0.0, 0.0, 0.0);
    stator(
        "planes[0].stator.inner.mass_kg",
        StatorParams::OneMass(light),
    );
    stator("planes[0].stator.ellipticity", ellipse(0.3, 0.0));
    refused("planes[1].contact.clearance_m", |p| {
        p.planes[1].contact.clearance_m = 0.0;
    });
    refused("supports[1].stiffness_n_m", |p| {
        p.supports[1].stiffness_n_m.x = f64::NAN;
    });
    refused("unbalances[0].moment_kg_m", |p| {
        p.unbalances[0].moment_kg_m = -1.0;
    });
}

#[test]
fn what_has_no_series_is_named() {
    let series =
        |field: &str, change: fn(&mut MachineParams)| refused_by(Method::Series, field, change);
    series("planes[0].stator.ellipticity", |p| {
        p.planes[0].stator = ellipse(0.05, 0.4);
    });
    series("planes[0].contact.stiffness_n_mn", |p| {
        p.planes[0].contact.law = hertz(1.5, 1e-5, 0.2, 0.0).into();
    });
    let made = |params: &PlantParams| {
        build(params, &bouncing_start(), options(Method::Series, 1e-9)).err()
    };
    let mut elliptic = bouncing(1e8);
    assert!(elliptic.has_series());
    elliptic.stator = ellipse(0.05, 0.0);
    for params in [free_mass(hertz(1.5, 1e-5, 0.2, 0.0), 0.1), elliptic] {
        assert!(!params.has_series());
        assert_eq!(made(&params), Some(BuildError::NoSeries));
    }
    assert!(BuildError::NoSeries.to_string().contains("collocation"));
}

/// A point mass names its values as its scenes do.
#[test]
fn values_of_a_point_mass_out_of_range_are_named() {
    let refused = |field: &str, change: &dyn Fn(&mut PlantParams)| {
        let mut params = bouncing(1e8);
        change(&mut params);
        match build(&params, &bouncing_start(), Options::default()) {
            Err(BuildError::Param(e)) => assert_eq!(e.field, field),
            _ => panic!("{field} was taken"),
        }
    };
    for (field, law) in [
        ("contact.stiffness_n_mn", hardening(0.0, 1.5, 0.0)),
        ("contact.exponent", hardening(1e9, 0.9, 0.0)),
        ("contact.exponent", hardening(1e9, f64::NAN, 0.0)),
        ("contact.damping_s_m", hardening(1e9, 1.5, -1.0)),
    ] {
        refused(field, &|p| p.contact.law = law.into());
    }
    let stator = |field: &str, stator: StatorParams| refused(field, &|p| p.stator = stator);
    for ellipticity in [-0.01, 0.21, f64::NAN] {
        stator("retainer.ellipticity", ellipse(ellipticity, 0.0));
    }
    stator("retainer.long_axis_deg", ellipse(0.05, f64::INFINITY));
    let raced = |field: &str, race: RaceParams| refused(field, &|p| p.race = Some(race));
    raced("race.inertia_kg_m2", race(0.0, 0.0, 0.0));
    raced("race.drag_n_m_s", race(1e-3, -1.0, 0.0));
    raced("race.start_spin_rad_s", race(1e-3, 0.0, f64::NAN));
    refused("race.inertia_kg_m2", &|p| {
        (p.stator, p.race) = (ellipse(0.05, 0.0), Some(race(1e-3, 0.0, 0.0)));
    });
}

/// A plane beyond the end of the shaft, of which no shape knows how it bends there.
#[test]
fn a_place_off_the_shaft_is_named() {
    let shaft = || modal(&rigid(0.2, 0.05), bending(2, 2000.0));
    refused("planes[1].position_m", |p| {
        p.rotor = shaft();
        p.planes[1].position_m = 0.26;
    });
    refused("rotor.damping_n_s_m", |p| {
        p.rotor = shaft();
        if let Rotor::Modal { damping_n_s_m, .. } = &mut p.rotor {
            // It would drive the second mode.
            *damping_n_s_m = vec![0.0; 16];
            damping_n_s_m[15] = -1.0;
        }
    });
    refused("rotor.polar_coupling_kg_m2", |p| {
        p.rotor = shaft();
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
