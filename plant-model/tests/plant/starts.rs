//! Starts that are meant to be on the wall: what sine, cosine and a product leave of that decides nothing. A point mass and a
//! whole rotor between two walls.

use crate::support::*;

/// Distance from the middle, speed outwards and along the wall, and load outwards.
#[derive(Clone, Copy)]
struct At {
    distance: f64,
    outwards_m_s: f64,
    along_m_s: f64,
    load_n: f64,
}

/// On the wall at rest, with distances in clearances.
const ON: At = At {
    distance: 1.0,
    outwards_m_s: 0.0,
    along_m_s: 0.0,
    load_n: 0.0,
};

/// Two laws of a point mass, a free rotor, and one that springs draw to the middle.
fn rotors() -> [MachineParams; 4] {
    let mut hardening = onset_rig();
    hardening.contact.law = hertz(1.5, 1e-5, 0.2, 1.0).into();
    let mut held = machine();
    held.unbalances.clear();
    held.loads_m = vec![0.0];
    let mut free = held.clone();
    free.supports.clear();
    for plane in free.planes.iter_mut().chain(&mut held.planes) {
        plane.contact.clearance_m = CLEARANCE_M;
    }
    [onset_rig().machine(), hardening.machine(), free, held]
}

fn started(params: &MachineParams, angle: f64, at: At, samples: u32) -> Machine {
    let n = direction(angle);
    let from = MachineStart {
        centre_m: at.distance * CLEARANCE_M * n,
        centre_velocity_m_s: at.outwards_m_s * n + at.along_m_s * V2::new(-n.y, n.x),
        spin_rad_s: 200.0,
        ..MachineStart::default()
    };
    let mut rotor = rotor(params, &from, Options::default());
    let inputs = MachineInputs {
        commands_n: vec![],
        loads_n: vec![at.load_n * n],
    };
    for i in 1..=samples {
        rotor
            .advance(1e-5 * f64::from(i), &inputs, &mut |_, _| {})
            .unwrap_or_else(|e| panic!("at {angle}: {e}"));
    }
    rotor
}

/// All round, many times.
fn angles(count: u32) -> Vec<f64> {
    (0..count)
        .map(|i| 26.0 * f64::from(i) / f64::from(count))
        .collect()
}

fn never_touched(meters: &Meters) -> bool {
    meters.impacts == 0 && meters.contact_time_s == 0.0
}

/// Against the wall is an impact at its speed, at any angle.
#[test]
fn a_start_into_the_wall_is_an_impact() {
    for params in rotors() {
        for (angle, along_m_s) in each(&angles(1000), &[0.0, 0.3]) {
            let into = At {
                outwards_m_s: 0.1,
                along_m_s,
                ..ON
            };
            for meters in started(&params, angle, into, 1).meters() {
                assert_eq!((meters.impacts, meters.hard_impacts), (1, 1), "{angle}");
                near("speed", meters.peak_impact_speed_m_s, 0.1, 1e-12);
                near("time", meters.contact_time_s, 1e-5, 1e-9);
            }
        }
    }
}

/// Pressed on it by a load, or along it by the curve, is a contact and no impact, with one method at any angle.
#[test]
fn a_start_that_rests_on_the_wall_is_a_contact_and_no_impact() {
    let ways = [(0.0, 500.0), (0.0, 200.0), (0.3, 0.0), (-0.3, 500.0)];
    for params in rotors() {
        let method = params.method(Method::Auto);
        for (angle, (along_m_s, load_n)) in each(&angles(2000), &ways) {
            let on = At {
                along_m_s,
                load_n,
                ..ON
            };
            let rotor = started(&params, angle, on, 1);
            assert_eq!(Ok(rotor.method()), method, "{angle}");
            for meters in rotor.meters() {
                assert_eq!((meters.impacts, meters.hard_impacts), (0, 0), "{angle}");
                near("time", meters.contact_time_s, 1e-5, 1e-3);
            }
        }
    }
}

/// The rule is for rounding only: a millionth of a millionth of the clearance off the wall is off it, and into it, in it.
/// Away from it there is no contact at all, however the start is rounded.
#[test]
fn a_start_beside_the_wall_is_beside_it() {
    for (i, angle) in each(&[0, 1, 2, 3], &angles(200)) {
        let params = &rotors()[i];
        for (off, outwards_m_s, impacts) in [(-1e-12, 0.0, 1), (1e-12, 0.1, 0)] {
            let beside = At {
                distance: 1.0 + off,
                outwards_m_s,
                load_n: 500.0,
                ..ON
            };
            for meters in started(params, angle, beside, 1).meters() {
                assert_eq!(meters.impacts, impacts, "{angle}");
            }
        }
        let away = At {
            outwards_m_s: -0.1,
            ..ON
        };
        let rotor = started(params, angle, away, 1);
        assert!(rotor.meters().iter().all(never_touched), "{angle}");
    }
}

/// Without a force it stays there, and no run stands still; springs lift it off.
#[test]
fn a_rotor_parked_on_its_wall_stays_there_or_is_lifted() {
    let [.., free, held] = rotors();
    for angle in angles(200) {
        let rotor = started(&free, angle, ON, 200);
        let radius_m = rotor.axis().centre.position.norm();
        near("radius", radius_m, CLEARANCE_M, 1e-12);
        assert_eq!(rotor.meters().iter().map(|m| m.impacts).sum::<u64>(), 0);
        assert!(rotor.work().steps < 2 * 200, "{angle}: {:?}", rotor.work());

        let rotor = started(&held, angle, ON, 200);
        assert_eq!(rotor.mode(0), Some(ContactMode::Flight), "{angle}");
        assert!(rotor.meters().iter().all(never_touched), "{angle}");
        // 200 rad/s for 2 ms: by 1 − cos 0.4 of the way.
        let left = rotor.axis().centre.position.norm() / CLEARANCE_M;
        assert!((left - 0.4_f64.cos()).abs() < 0.01, "{angle}: {left}");
    }
}
