//! Where a rotor in two planes is a point mass, it runs as one with a single pair in one plane does, whatever they are made of.

use crate::support::*;
use plant_model::machine::PlaneSnapshot;

/// None, one and two rings.
fn soft_stators() -> [StatorParams; 3] {
    let inner = RingParams {
        mass_kg: 2.0,
        stiffness_n_m: V2::new(2e7, 2.5e7),
        damping_n_s_m: V2::new(3000.0, 2500.0),
    };
    let outer = RingParams {
        mass_kg: 5.0,
        stiffness_n_m: V2::new(4e7, 3e7),
        damping_n_s_m: V2::new(1000.0, 500.0),
    };
    stators(inner, outer)
}

/// Half of everything that two like ends share.
fn half_of(one: &PlantParams) -> MachinePlane {
    let ring = |ring: RingParams| RingParams {
        mass_kg: 0.5 * ring.mass_kg,
        stiffness_n_m: 0.5 * ring.stiffness_n_m,
        damping_n_s_m: 0.5 * ring.damping_n_s_m,
    };
    let mut plane = plane(0.0, 0.5);
    plane.stator = match one.stator {
        StatorParams::OneMass(inner) => StatorParams::OneMass(ring(inner)),
        StatorParams::TwoMass { inner, outer } => StatorParams::TwoMass {
            inner: ring(inner),
            outer: ring(outer),
        },
        bore => bore,
    };
    plane.race = (one.race).map(|r| {
        race(
            0.5 * r.inertia_kg_m2,
            0.5 * r.drag_n_m_s,
            r.start_spin_rad_s,
        )
    });
    plane.friction = one.friction;
    if let ContactLaw::HuntCrossley(mut law) = one.contact.law {
        law.stiffness_n_mn *= 0.5;
        plane.contact.law = law.into();
    }
    plane
}

/// The point mass with both its ends apart, and a magnet at each.
fn in_two_planes(one: &PlantParams) -> MachineParams {
    let mut params = machine();
    params.spin = one.spin;
    params.loads_m = vec![0.0];
    for (plane, position_m) in params.planes.iter_mut().zip([-0.2, 0.2]) {
        *plane = MachinePlane {
            position_m,
            ..half_of(one)
        };
    }
    if let Some(of) = one.magnet {
        params.magnets = [-0.1, 0.1]
            .map(|z| magnet(z, 0.5 * of.force_max_n, of.lag_s))
            .to_vec();
    }
    params
}

/// Both under the same forces, shared equally between the ends.
struct Ran {
    rotor: Machine,
    /// Modes of each plane.
    changes: Vec<Vec<ContactMode>>,
}

fn ran(params: &MachineParams, method: Method) -> Ran {
    let from = moving([0.3, 0.0], [0.0; 2], 400.0);
    let mut rotor = rotor(params, &from, options(method, 1e-11));
    let mut changes = vec![vec![]; params.planes.len()];
    for i in 1..=100 {
        let t = 2e-4 * f64::from(i);
        let command_n = V2::new(-150.0 * (0.1 * f64::from(i)).cos(), 90.0);
        let magnets = params.magnets.len();
        let inputs = MachineInputs {
            commands_n: vec![command_n / magnets as f64; magnets],
            loads_n: vec![V2::new(0.0, -98.1)],
        };
        let mut change = |p: usize, s: &MachineSnapshot| {
            changes[p].push(s.planes().nth(p).unwrap().mode);
        };
        rotor.advance(t, &inputs, &mut change).unwrap();
    }
    Ran { rotor, changes }
}

/// What is read in a plane that has a share of the whole, each of the order of 1.
fn readings(now: &PlaneSnapshot, meters: &Meters, share: f64) -> [f64; 10] {
    [
        now.rotor.position.x / PLAY_M,
        now.rotor.position.y / PLAY_M,
        now.ring.position.x / PLAY_M,
        now.ring.position.y / PLAY_M,
        now.race_spin_rad_s / 400.0,
        now.normal_force_n / share / 1e5,
        now.sliding_force_n / share / 1e5,
        now.rolling_force_n / share / 1e5,
        meters.contact_time_s,
        meters.whirl_angle_rad / 1e2,
    ]
}

/// Compares everything that both have.
fn alike(one: &PlantParams, method: Method, worst: f64, what: &str) {
    let [mut two, mut point] =
        [(in_two_planes(one), method), (one.machine(), Method::Auto)].map(|(p, m)| ran(&p, m));
    assert_eq!(two.rotor.method(), method);
    let (now, then) = (two.rotor.snapshot(), point.rotor.snapshot());
    let (whole, all) = (then.planes().next().unwrap(), &point.rotor.meters()[0]);
    let off = (now.spin_rad_s - then.spin_rad_s).abs();
    assert!(off <= 400.0 * worst, "{what}: {off} rad/s");
    // Hertz's peaks stand where no step ends.
    let linear = one.contact.law.linear().is_some();
    let peak = if linear { worst } else { 1e-5 };
    for (p, plane) in now.planes().enumerate() {
        assert_eq!(two.changes[p], point.changes[0], "{what}, plane {p}");
        let meters = &two.rotor.meters()[p];
        assert_eq!(meters.impacts, all.impacts, "{what}");
        let (a, b) = (readings(plane, meters, 0.5), readings(whole, all, 1.0));
        for (i, (a, b)) in a.iter().zip(&b).enumerate() {
            assert!((a - b).abs() <= worst, "{what}, {p}: {i}: {a:e}, {b:e}");
        }
        let off_n = 2.0 * meters.peak_contact_force_n - all.peak_contact_force_n;
        assert!(off_n.abs() <= 1e5 * peak, "{what}, {p}: {off_n:e} N");
        let off_m_s = meters.peak_backward_speed_m_s - all.peak_backward_speed_m_s;
        assert!(off_m_s.abs() <= peak, "{what}, {p}: {off_m_s:e} m/s");
    }
    closes(what, two.rotor.audit().residual(), worst);
    let [a, b] = [&two, &point].map(|ran| ran.rotor.audit().flows);
    let of_planes = two.rotor.plane_flows().iter().map(|p| p.sliding_friction);
    for (name, a, b) in [
        ("supplied", a.supplied(), b.supplied()),
        ("dissipated", a.dissipated(), b.dissipated()),
        ("contact", a.contact_damping, b.contact_damping),
        ("sliding", a.sliding_friction, b.sliding_friction),
        ("of planes", of_planes.sum(), b.sliding_friction),
        ("control", a.control, b.control),
    ] {
        let scale = worst * point.rotor.audit().turnover_j();
        assert!((a - b).abs() <= scale, "{what}: {name} {a:e} J, {b:e} J");
    }
}

fn point(stator: StatorParams, lag_s: f64) -> PlantParams {
    PlantParams {
        stator,
        magnet: Some(magnet_of(300.0, lag_s)),
        ..bouncing(1e8)
    }
}

/// Two like ends that move together: stator of no, one and two rings, bushing and race, with and without rolling friction,
/// lag and a spin that is free. In most of these both ends roll at once. The second method goes the same way.
#[test]
fn a_rotor_without_tilt_is_a_point_mass() {
    let cases: Vec<i32> = (0..16).collect();
    for (stator, case) in each(&soft_stators(), &cases) {
        let has = |bit: i32| case & bit != 0;
        let mut one = point(stator, if has(4) { 2e-4 } else { 0.0 });
        one.race = has(1).then(|| race(2e-6, 1e-5, 50.0));
        one.friction.rolling_coefficient = if has(2) { 0.01 } else { 0.0 };
        if has(8) {
            one.spin = free_spin(0.05, 1.0);
        }
        for (method, worst) in [(Method::Series, 1e-10), (Method::Collocation, 1e-9)] {
            let what = format!("{}, {stator:?}, case {case:04b}", method.name());
            alike(&one, method, worst, &what);
        }
    }
}

/// The same of friction that falls with speed, by both methods; of balls below the race, a law without a series at the touch; and
/// of bores out of round.
#[test]
fn what_is_in_a_plane_is_that_of_a_point_mass() {
    for stator in soft_stators() {
        let mut falls = point(stator, 2e-4);
        falls.friction.sliding = falling(0.3, 0.1, 0.4);
        for (method, worst) in [(Method::Series, 1e-10), (Method::Collocation, 1e-8)] {
            let what = format!("falling friction, {stator:?}");
            alike(&falls, method, worst, &what);
        }
        for damping_s_m in [0.0, 0.5] {
            let mut hardens = point(stator, 0.0);
            let law = hardening(3e10, 1.5, damping_s_m);
            hardens.contact.law = law.into();
            let what = format!("Hertz, λ = {damping_s_m}, {stator:?}");
            alike(&hardens, Method::Collocation, 1e-7, &what);
        }
    }
    let bore = point(ellipse(0.05, 0.4), 2e-4);
    alike(&bore, Method::Collocation, 1e-8, "out of round");
}

/// Struck at one end with I_t = m·a·b the other end does not notice, and the struck one is a point mass of 1/(1/m + b²/I_t).
#[test]
fn struck_beyond_the_centre_of_percussion_the_other_end_rests() {
    let (a, b, speed) = (0.16, 0.125, 0.3);
    let mut params = machine();
    params.rotor = rigid(10.0 * a * b, 0.0);
    params.planes = vec![plane(-a, 1.0), plane(b, 1.0)];
    params.supports.clear();
    params.unbalances.clear();
    let rate = speed / (a + b);
    let mut rotor = rotor(
        &params,
        &moving([rate * a, 0.0], [rate, 0.0], 400.0),
        series(),
    );
    advance(&mut rotor, 0.2);

    let mut one = bouncing(1e8);
    one.rotor.mass_kg = 1.0 / (0.1 + b * b / (10.0 * a * b));
    (one.rotor.stiffness_n_m, one.rotor.damping_n_s_m) = (0.0, 0.0);
    one.rotor.eccentricity_m = 0.0;
    let from = start(V2::zeros(), V2::new(speed, 0.0), 400.0);
    let mut end = build(&one, &from, series()).unwrap();
    run_to(&mut end, 0.2);

    let now = rotor.snapshot();
    let planes: Vec<_> = now.planes().collect();
    let most = 1e-11 * PLAY_M;
    close("resting", planes[0].rotor.position, V2::zeros(), most);
    let struck = end.snapshot().position_m;
    close("struck", planes[1].rotor.position, struck, most);
    assert_eq!(rotor.meters()[1].impacts, end.meters().impacts);
    assert!(rotor.meters()[1].impacts > 1 && planes[0].mode == ContactMode::Flight);
}

/// Stiffer and stiffer in bending a shaft becomes the rigid rotor, at the rate of its compliance 1/ω².
#[test]
fn a_stiff_shaft_is_a_rigid_rotor() {
    let from = moving([0.2, 0.0], [0.5, -0.3], 400.0);
    let end = |of: Rotor| {
        let mut params = machine();
        params.rotor = of;
        let mut rotor = rotor(&params, &from, series());
        advance(&mut rotor, 3e-3);
        assert!(rotor.meters()[0].impacts > 0);
        rotor.snapshot().planes().next().unwrap().rotor.position
    };
    let stiff = end(rigid(0.2, 0.05));
    let off = |first_rad_s: f64| {
        let mut modes = bending(1, first_rad_s);
        modes[0].damping_ratio = 0.3;
        let shaft = modal(&rigid(0.2, 0.05), modes);
        (end(shaft) - stiff).norm() / PLAY_M
    };
    let (soft, firm, hard) = (off(2e4), off(8e4), off(3.2e5));
    for ratio in [soft / firm, firm / hard] {
        assert!((12.0..22.0).contains(&ratio), "{ratio}");
    }
    assert!(hard < 1e-3, "{hard:e}");
}
