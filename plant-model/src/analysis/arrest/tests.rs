use super::*;
use crate::params::*;

fn rotor(contact_stiffness_n_m: f64) -> PlantParams {
    PlantParams {
        rotor: RotorParams {
            mass_kg: 10.0,
            stiffness_n_m: 0.0,
            damping_n_s_m: 0.0,
            eccentricity_m: 0.0,
            contact_radius_m: 0.05,
        },
        spin: SpinParams::Held,
        stator: StatorParams::Rigid,
        contact: ContactParams {
            clearance_m: 2e-4,
            law: LinearContact {
                stiffness_n_m: contact_stiffness_n_m,
                damping_n_s_m: 0.0,
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.15 },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

/// √(F·√(1 + μ²)·c/(μm)) on a hard wall, and more on a soft one.
#[test]
fn limits_by_hand() {
    let hard = Arrest::new(&rotor(1e18), 1000.0).unwrap();
    let by_hand = (1000.0 * 1.0225_f64.sqrt() * 2e-4 / 1.5).sqrt();
    assert!((hard.limit_m_s / by_hand - 1.0).abs() < 1e-9);
    let soft = Arrest::new(&rotor(1e8), 1000.0).unwrap();
    assert!((soft.limit_m_s - 0.4234).abs() < 1e-4, "{}", soft.limit_m_s);
    let time = hard.time_s(0.5 * by_hand, 0.0);
    assert!((time / (2e-4 / (0.15 * by_hand) * 0.5_f64.atanh()) - 1.0).abs() < 1e-9);
    let part = hard.time_s(0.5 * by_hand, 0.4);
    let logs = 0.5_f64.atanh() - 0.2_f64.atanh();
    assert!((part / (2e-4 / (0.15 * by_hand) * logs) - 1.0).abs() < 1e-9);
}

/// The time solves the equation of motion it comes from, damping and shaft included.
#[test]
fn time_is_the_integral() {
    let mut params = rotor(2e7);
    (params.rotor.damping_n_s_m, params.rotor.stiffness_n_m) = (300.0, -2e5);
    let (force, mu, m) = (1000.0, 0.15, 10.0_f64);
    let arrest = Arrest::new(&params, force).unwrap();
    let tilt = (1.0_f64 + mu * mu).sqrt();
    // Radius and speed on the circle by fixed-point iteration on r = c + N/k_c, from L.
    let circle = |momentum: f64, inward: f64| {
        let mut r = 2e-4;
        for _ in 0..200 {
            let v = momentum / (m * r);
            r = 0.5 * r + 0.5 * (2e-4 + (m * v * v / r + 2e5 * r - inward) / 2e7);
        }
        (r, momentum / (m * r))
    };
    let from = 0.9 * arrest.limit_m_s;
    let start = m * from * circle_radius_m(&params, from);
    let (n, share) = (20_000, 0.3);
    let step = (1.0 - share) * start / f64::from(n);
    let sum: f64 = (0..n)
        .map(|i| {
            let momentum = share * start + (f64::from(i) + 0.5) * step;
            let (r, v) = circle(momentum, force * mu / tilt);
            let drive = mu * (m * v * v / r + 2e5 * r);
            step / (r * (force * tilt + 300.0 * v - drive))
        })
        .sum();
    let time = arrest.time_s(from, share);
    assert!((time / sum - 1.0).abs() < 1e-6, "{time} {sum}");
}

#[test]
fn circles_balance() {
    for exponent in [None, Some(1.0), Some(1.5), Some(3.0)] {
        let mut params = rotor(1e8);
        params.rotor.stiffness_n_m = -2e5;
        if let Some(exponent) = exponent {
            params.contact.law = hertz(1e8 * 1e-5_f64.powf(1.0 - exponent), exponent);
        }
        let circle = Circle::new(&params);
        for inward in [0.0, 200.0] {
            let (r, slope) = circle.radius_and_slope(0.3, inward);
            let normal = params.contact.law.normal_force_n(r - 2e-4, 0.0);
            let needed = 10.0 * 0.09 / r + 2e5 * r - inward;
            assert!((normal / needed - 1.0).abs() < 1e-9, "{exponent:?}");
            let change = circle.radius_m(0.3 + 1e-5, inward) - circle.radius_m(0.3 - 1e-5, inward);
            assert!((change / 2e-5 / slope - 1.0).abs() < 1e-6, "{exponent:?}");
        }
    }
}

fn hertz(stiffness_n_mn: f64, exponent: f64) -> ContactLaw {
    ContactLaw::HuntCrossley(HuntCrossley {
        stiffness_n_mn,
        exponent,
        damping_s_m: 0.0,
    })
}

/// At the limit the three balances hold together, damped, on a negative stiffness and on Hertz's wall too; values to
/// four digits by a root finder of their own.
#[test]
fn limit_force_and_radius_come_together() {
    let (f, mu, m, c) = (1000.0, 0.15, 10.0, 2e-4);
    let tilt = (1.0_f64 + mu * mu).sqrt();
    for (law, d, k, limit) in [
        (rotor(1e8).contact.law, 0.0, 0.0, 0.4234),
        (rotor(1e8).contact.law, 1000.0, 0.0, 0.5648),
        (rotor(1e8).contact.law, 3000.0, 0.0, 1.3350),
        (rotor(1e8).contact.law, 300.0, -2e5, 0.4572),
        (hertz(1e12, 1.5), 0.0, 0.0, 0.3704),
        (hertz(1e11, 1.5), 0.0, 0.0, 0.3819),
        (hertz(1e10, 1.5), 0.0, 0.0, 0.4311),
        (hertz(1e10, 1.5), 1000.0, 0.0, 0.5633),
    ] {
        let mut params = rotor(1.0);
        params.contact.law = law;
        (params.rotor.damping_n_s_m, params.rotor.stiffness_n_m) = (d, k);
        let arrest = Arrest::new(&params, f).unwrap();
        let (v, r) = (arrest.limit_m_s, arrest.radius_m);
        let normal = law.normal_force_n(r - c, 0.0);
        let along = (d * v + f / tilt) / mu;
        let across = m * v * v / r - k * r - f * mu / tilt;
        assert!((normal / along - 1.0).abs() < 1e-9, "{law:?}");
        assert!((normal / across - 1.0).abs() < 1e-9, "{law:?}");
        assert!((v - limit).abs() < 6e-5, "{v} {law:?}");
        // The time is that of this limit: longer without bound towards it, and not an end beyond it.
        let near = arrest.circle.radius_m(v, f * mu / tilt);
        assert!((near / r - 1.0).abs() < 1e-9);
        assert!(arrest.time_s(v, 0.5).is_infinite());
        let (early, late) = (arrest.time_s(0.5 * v, 0.5), arrest.time_s(0.8 * v, 0.5));
        assert!(early > 0.0 && late > early, "{early} {late}");
    }
}

/// √(r·(k·r + F·√(1 + μ²)/μ)/m) without damping, whatever the stiffness of a linear wall.
#[test]
fn undamped_limit_is_the_closed_form() {
    let (f, mu, m) = (1000.0, 0.15, 10.0);
    let tilt = (1.0_f64 + mu * mu).sqrt();
    for (k_c, k) in [(1e7, 0.0), (1e8, -2e5), (1e9, 8e5)] {
        let mut params = rotor(k_c);
        params.rotor.stiffness_n_m = k;
        let r = 2e-4 + f / (mu * tilt) / k_c;
        let closed = (r * (k * r + f * tilt / mu) / m).sqrt();
        let limit = Arrest::new(&params, f).unwrap().limit_m_s;
        assert!((limit / closed - 1.0).abs() < 1e-12, "{limit} {closed}");
    }
}

#[test]
fn no_limit_where_one_side_always_wins() {
    let none = |edit: fn(&mut PlantParams)| {
        let mut params = rotor(1e8);
        edit(&mut params);
        Arrest::new(&params, 1000.0).is_none()
    };
    assert!(!none(|_| {}));
    assert!(none(|p| p.friction.rolling_coefficient = 0.2));
    // F·√(1 + μ²)/μ = 6741 N against |k|·r with r = 0.266 mm.
    assert!(none(|p| p.rotor.stiffness_n_m = -2.6e7));
    assert!(!none(|p| p.rotor.stiffness_n_m = -2.5e7));
    // μ·√(m·k_c) = 4743 N s/m.
    assert!(none(|p| p.rotor.damping_n_s_m = 4800.0));
    assert!(!none(|p| p.rotor.damping_n_s_m = 4700.0));
}
