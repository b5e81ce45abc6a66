use super::*;
use crate::params::*;

/// Bounces, then rolls; and bounces with unbalance.
fn launches() -> Vec<Launch> {
    let params = |k_c: f64, eccentricity_m: f64| PlantParams {
        rotor: RotorParams {
            mass_kg: 10.0,
            stiffness_n_m: 4e5,
            damping_n_s_m: 200.0,
            eccentricity_m,
            contact_radius_m: 2.5e-3,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: 3e-4,
            law: LinearContact {
                stiffness_n_m: k_c,
                damping_n_s_m: 0.1 * (10.0 * k_c).sqrt(),
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.3 },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    };
    let launch = |i: u32| {
        let k_c = [1e8, 1e9, 1e10][i as usize % 3];
        let start = Start {
            position_m: V2::zeros(),
            velocity_m_s: V2::new(0.05 + 0.01 * f64::from(i), 0.02),
            spin_rad_s: 400.0,
            spin_phase_rad: 0.1,
        };
        let params = params(k_c, f64::from(i % 2) * 1e-5);
        Launch::new(LaneParams::of(&params).unwrap(), &start, 0.05).unwrap()
    };
    (0..37).map(launch).collect()
}

/// Every set of instructions that this machine has.
#[cfg(target_arch = "x86_64")]
fn every() -> Vec<Arch> {
    use pulp::x86::{V3, V4};
    let mut all = vec![Arch::Scalar];
    all.extend(V3::try_new().map(Arch::V3));
    all.extend(V4::try_new().map(Arch::V4));
    all
}

#[cfg(not(target_arch = "x86_64"))]
fn every() -> Vec<Arch> {
    vec![Arch::new(), Arch::Scalar]
}

#[test]
fn instructions_change_no_bit() {
    let of = |arch: Arch| {
        let mut all = vec![None; launches().len()];
        let waiting = launches().into_iter().zip(0..);
        Pool::new(arch, 1e-9).run(waiting, |i: usize, ended| {
            all[i] = Some(ended);
            None
        });
        all
    };
    let every = every().into_iter().map(of).collect::<Vec<_>>();
    for other in &every[1..] {
        assert_eq!(other, &every[0]);
    }
    let events: u32 = every[0].iter().flatten().map(|ended| ended.events).sum();
    assert!(events > 200, "{events} changes of mode: nothing happens");
}
