//! Impacts in closed form, on contacts from soft to 1e13 N/m, by the linear law and Hunt and Crossley's.

use crate::support::*;
use plant_model::contact::hunt_crossley::{damping_for_restitution, restitution_of};
use plant_model::contact::restitution_of as linear_restitution;
use std::f64::consts::{PI, TAU};

/// A head-on impact on the linear contact without any other force: with ω = √(k/m),
/// ζ = d/2√(km) and a = acos ζ/√(1 − ζ²) (beyond ζ = 1 acosh ζ/√(ζ² − 1)).
struct HeadOn {
    restitution: f64,
    duration_s: f64,
    depth_m: f64,
    force_n: f64,
}

/// ω, ζ and a.
fn rates(law: &LinearContact, mass_kg: f64) -> [f64; 3] {
    let omega = (law.stiffness_n_m / mass_kg).sqrt();
    let z = 0.5 * law.damping_n_s_m / (law.stiffness_n_m * mass_kg).sqrt();
    let a = match z {
        z if (z - 1.0).abs() < 1e-9 => 1.0,
        z if z < 1.0 => z.acos() / (1.0 - z * z).sqrt(),
        z => z.acosh() / (z * z - 1.0).sqrt(),
    };
    [omega, z, a]
}

/// Deepest at A = v/ω·exp(−ζa); the force is largest at once where ζ ≥ 1/2, with d_c·v, and before the deepest point where
/// ζ < 1/2.
fn head_on(law: &LinearContact, mass_kg: f64, speed_m_s: f64) -> HeadOn {
    let [omega, z, a] = rates(law, mass_kg);
    let until = 3.0 * a - PI / (1.0 - z * z).sqrt();
    HeadOn {
        restitution: linear_restitution(z),
        duration_s: 2.0 * a / omega,
        depth_m: speed_m_s / omega * (-z * a).exp(),
        force_n: match z < 0.5 {
            true => mass_kg * speed_m_s * omega * (-z * until).exp(),
            false => law.damping_n_s_m * speed_m_s,
        },
    }
}

/// From k_c = 1e6 to 1e13 N/m and from e = 1 to a hundredth of a per cent, contact overdamped
/// included: the rotor comes back with e times its speed, after 2a/ω, and the meters have the peaks.
#[test]
fn an_impact_restores_e_at_every_stiffness_and_damping() {
    let v = 0.1;
    for (method, exponent) in each(&METHODS, &[6, 7, 8, 9, 10, 11, 12, 13]) {
        for e in [1.0, 0.999, 0.7, 0.2, (-2.0_f64).exp(), 1e-2, 1e-4] {
            let law = linear(10_f64.powi(exponent), e);
            let exact = head_on(&law, MASS_KG, v);
            let from = start(V2::new(1e-4, 0.0), V2::new(v, 0.0), 0.0);
            let mut plant = plant(&free_mass(law, 0.2), &from, method);
            let t = (CLEARANCE_M - 1e-4) / v + 1.01 * exact.duration_s;
            let end = carry(&mut plant, t, V2::zeros());
            let meters = plant.meters();
            assert_eq!((meters.impacts, end.mode), (1, ContactMode::Flight));
            near("back", -end.velocity_m_s.x / v, exact.restitution, 2e-9);
            near("e", exact.restitution, e, 1e-8);
            near("duration", meters.contact_time_s, exact.duration_s, 1e-6);
            near("depth", meters.peak_penetration_m, exact.depth_m, 1e-3);
            near("force", meters.peak_contact_force_n, exact.force_n, 1e-3);
            assert!(end.velocity_m_s.y.abs() <= 1e-15 * v);
        }
    }
}

/// Depth, force, contact time, restitution, loss and impulse by Hunt and Crossley.
#[test]
fn hunt_crossley_impacts_are_those_of_the_closed_forms() {
    let v = 0.2;
    for (n, p) in each(&[1.0, 1.25, 1.5, 2.0, 3.0], &[0.0, 0.01, 0.2, 0.7, 5.0]) {
        let law = hertz(n, 1e-5, v, p / v);
        let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), 0.0);
        let params = free_mass(law, 0.0);
        let mut plant = build(&params, &from, options(Method::Auto, 1e-12)).unwrap();
        assert_eq!(plant.method(), Method::Collocation);
        let duration = law.undamped_contact_s(v, MASS_KG);
        run_to(&mut plant, 1e-5 / v + 3.0 * duration);
        let (end, meters, audit) = (plant.snapshot(), plant.meters(), plant.audit());
        assert_eq!((end.mode, meters.impacts), (ContactMode::Flight, 1));
        let what = format!("n = {n}, λv = {p}");
        let e = -end.velocity_m_s.x / v;
        near(&what, e, restitution_of(p), 1e-9);
        if p == 0.0 {
            near(&what, meters.contact_time_s, duration, 1e-8);
        }
        let (depth, force) = (law.depth_m(v, MASS_KG), law.peak_force_n(v, MASS_KG));
        near(&what, meters.peak_penetration_m, depth, 1e-8);
        near(&what, meters.peak_contact_force_n, force, 1e-8);
        let lost = 0.5 * MASS_KG * v * v * (1.0 - e * e) - audit.flows.contact_damping;
        assert!(lost.abs() < 1e-9 * audit.turnover_j(), "{what}: {lost}");
        closes(&what, audit.residual(), 1e-10);
        let impulse = MASS_KG * v * (1.0 + e);
        near(&what, audit.flows.normal_impulse_n_s, impulse, 1e-9);
    }
}

/// Hard contact, sliding all along: v_t changes by μ·(1 + e)·v_r, by both laws.
#[test]
fn a_sliding_impact_turns_by_friction_times_the_normal_impulse() {
    let (v, mu) = (0.1, 0.15);
    for e in [1.0, 0.7, 0.2] {
        let depth_m = 1e-9;
        let hertz = hertz(1.5, depth_m, v, damping_for_restitution(e, v).unwrap());
        let hard = linear(MASS_KG * (v / depth_m).powi(2), e);
        for (law, method) in [
            (ContactLaw::from(hard), Method::Series),
            (hard.into(), Method::Collocation),
            (hertz.into(), Method::Collocation),
        ] {
            let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), 250.0);
            let mut plant = plant(&free_mass(law, mu), &from, method);
            let end = carry(&mut plant, 2e-4, V2::zeros());
            assert_eq!((end.mode, plant.meters().impacts), (ContactMode::Flight, 1));
            // Curvature: of the order of depth over clearance.
            near("along", end.velocity_m_s.y, -mu * (1.0 + e) * v, 5e-5);
            near("back", end.velocity_m_s.x, -e * v, 5e-5);
        }
    }
}

/// A free ring is a partner with a reduced mass: momentum is kept and the speed apart is e times the
/// speed of approach. One of a gram, alone or within an outer ring of a gram, up to k_c = 1e12; and by Hunt and Crossley.
#[test]
fn a_free_ring_flies_off_with_momentum_kept() {
    let v = 0.05;
    let flies_off = |mut params: PlantParams, law: ContactLaw, (e, lasts_s): (f64, f64), method| {
        params.contact.law = law;
        let reduced = params.contact_mass_kg();
        let ring_kg = 1.0 / (1.0 / reduced - 1.0 / MASS_KG);
        let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), 0.0);
        let mut plant = plant(&params, &from, method);
        let end = carry(&mut plant, 1e-5 / v + 1.5 * lasts_s, V2::zeros());
        assert_eq!((plant.meters().impacts, end.mode), (1, ContactMode::Flight));
        let change = (1.0 + e) * v * reduced;
        near("rotor", end.velocity_m_s.x, v - change / MASS_KG, 1e-9);
        near("ring", end.inner_ring.velocity.x, change / ring_kg, 1e-8);
        assert_eq!(end.outer_ring.velocity.norm(), 0.0);
    };
    let with = |stator: StatorParams| PlantParams {
        stator,
        ..free_mass(linear(1e9, 1.0), 0.0)
    };
    let inner = ring(1e-3, 0.0, 0.0);
    let outer = ring(1e-3, 3.6e9, 18_970.0);
    let [_, one, two] = stators(inner, outer).map(with);
    for (params, method) in each(&[one, two], &METHODS) {
        for (k, e) in each(&[1e6, 1e9, 1e12], &[1.0, 0.7, 0.05]) {
            let reduced = params.contact_mass_kg();
            let law = spring(k, linear(k, e).damping_n_s_m * (reduced / MASS_KG).sqrt());
            let lasts_s = head_on(&law, reduced, v).duration_s;
            flies_off(params, law.into(), (e, lasts_s), method);
        }
    }
    let params = with(StatorParams::OneMass(ring(5.0, 0.0, 0.0)));
    let law = hertz(1.5, 1e-6, v, damping_for_restitution(0.6, v).unwrap());
    let lasts_s = 2.0 * law.undamped_contact_s(v, params.contact_mass_kg());
    flies_off(params, law.into(), (0.6, lasts_s), Method::Collocation);
}

/// Friction at an impact that slides throughout: angular momentum changes by μ·∫N dt on a lever
/// between c and c + A (not at all without friction), the spin by R·μ·∫N dt/J, at every speed of
/// either sense; reversing the spin gives the mirror image to the bit.
#[test]
fn friction_at_an_impact_is_mu_times_the_impulse() {
    let (v, inertia) = (0.01, 0.05);
    for (method, mu) in each(&METHODS, &[0.0, 0.01, 1.0, 2.0]) {
        for spin in [100.0, TAU * 1000.0] {
            let mut params = free_mass(linear(1e10, 0.7), mu);
            params.spin = free_spin(inertia, 0.0);
            let [(end, flows, meters), (mirrored, ..)] = [spin, -spin].map(|spin| {
                let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), spin);
                let mut plant = plant(&params, &from, method);
                let end = carry(&mut plant, 1.5e-3, V2::zeros());
                assert_eq!((plant.meters().impacts, end.mode), (1, ContactMode::Flight));
                (end, plant.audit().flows, plant.meters())
            });
            let impulse = flows.normal_impulse_n_s;
            near("impulse", impulse, 1.7 * MASS_KG * v, 2e-2);
            let momentum = MASS_KG * end.position_m.perp(&end.velocity_m_s);
            let lever = CLEARANCE_M + meters.peak_penetration_m;
            let [most, least] = [lever, CLEARANCE_M].map(|lever| -mu * impulse * lever);
            let round_off = 1e-9 * lever * impulse;
            assert!((most - round_off..=least + round_off).contains(&momentum));
            let slowed = end.spin_rad_s - spin;
            let exact = -RADIUS_M * mu * impulse / inertia;
            let off = (slowed - exact).abs();
            assert!(off <= 1e-10 * spin, "{slowed:e} {exact:e}");
            if mu == 0.0 {
                assert_eq!((momentum, slowed), (0.0, 0.0));
            }
            let turned = V2::new(mirrored.position_m.x, -mirrored.position_m.y);
            assert_eq!(turned, end.position_m);
            assert_eq!(mirrored.spin_rad_s, -end.spin_rad_s);
        }
    }
}

/// Without spin, friction takes μ(1 + e) times the normal speed off the tangential speed and no more
/// than all of it; a head-on impact stays on its line.
#[test]
fn without_spin_friction_stops_the_slip_and_never_reverses_it() {
    let (vn, vt, e) = (0.1, 0.05, 0.7);
    for (method, mu) in each(&METHODS, &[0.0, 0.01, 0.2, 1.0, 2.0]) {
        let mut params = free_mass(linear(1e13, e), mu);
        params.contact.clearance_m = 1e-2;
        let run = |velocity: V2| {
            let from = start(V2::new(9.99e-3, 0.0), velocity, 0.0);
            let (mut plant, mut touch) = (plant(&params, &from, method), None);
            let end = carry_with(&mut plant, 2e-4, V2::zeros(), &mut |s| {
                touch.get_or_insert(s.position_m.normalize());
            });
            (touch.unwrap(), end.velocity_m_s)
        };
        let before = V2::new(vn, vt);
        let (normal, after) = run(before);
        let tangent = V2::new(-normal.y, normal.x);
        let left = before.dot(&tangent) - mu * (1.0 + e) * before.dot(&normal);
        let slip = after.dot(&tangent) - left.max(0.0);
        assert!(slip.abs() <= 1e-4 * vn, "μ = {mu}: {slip:e}, {left:e}");
        near("e", -after.dot(&normal) / before.dot(&normal), e, 1e-4);
        assert!(run(V2::new(vn, 0.0)).1.y.abs() <= 1e-15 * vn);
    }
}

/// Released at rest from a depth A in the wall, the rotor leaves after a/ω with A·ω·exp(−ζa); moving
/// out faster than the wall follows, it feels nothing at all.
#[test]
fn a_rotor_released_from_inside_the_wall_leaves_at_its_speed() {
    for (method, depth) in each(&METHODS, &[1e-9, 1e-5, 1e-3]) {
        for (k, e) in each(&[1e6, 1e9, 1e13], &[1.0, 0.5, 1e-3]) {
            let law = linear(k, e);
            let [omega, z, a] = rates(&law, MASS_KG);
            let at = V2::new(0.0, -CLEARANCE_M - depth);
            let params = free_mass(law, 0.0);
            let mut held = plant(&params, &start(at, V2::zeros(), 0.0), method);
            assert!(held.mode().in_contact());
            let end = carry(&mut held, 1.001 * a / omega, V2::zeros());
            assert_eq!(end.mode, ContactMode::Flight);
            let speed = depth * omega * (-z * a).exp();
            near("speed", end.velocity_m_s.y, speed, 1e-8);
            near("duration", held.meters().contact_time_s, a / omega, 1e-6);
            if e < 1.0 {
                let out = V2::new(0.0, 1.1 * depth * k / law.damping_n_s_m);
                let mut thrown = plant(&params, &start(at, out, 0.0), method);
                let end = carry(&mut thrown, 0.5 * depth / out.y, V2::zeros());
                assert_eq!(end.mode, ContactMode::Flight);
                near("speed", end.velocity_m_s.y, out.y, 1e-15);
                assert_eq!(thrown.meters().contact_time_s, 0.0);
            }
        }
    }
}

/// Slip at an impact stops after the impulse v_rel/(1/m + R²/J) where friction can give it. A very
/// light spin follows the wall (v stays, Ω = −v/R); a very heavy one is a held one.
#[test]
fn inertia_of_the_spin_decides_who_gives_way() {
    let v = V2::new(0.1, 0.02);
    for method in METHODS {
        let end_with = |spin: SpinParams, mu: f64, omega: f64| {
            let mut params = free_mass(linear(1e13, 0.7), mu);
            params.contact.clearance_m = 1e-2;
            params.spin = spin;
            let from = start(V2::new(9.99e-3, 0.0), v, omega);
            let (mut plant, mut normal) = (plant(&params, &from, method), None);
            let end = carry_with(&mut plant, 2e-4, V2::zeros(), &mut |s| {
                normal.get_or_insert(s.position_m.normalize());
            });
            (end, normal.unwrap())
        };
        for j in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
            let inertia = j * MASS_KG * RADIUS_M * RADIUS_M;
            let (end, normal) = end_with(free_spin(inertia, 0.0), 2.0, 0.0);
            let tangent = V2::new(-normal.y, normal.x);
            let shared = v.dot(&tangent) / (1.0 + j);
            for speed in [end.velocity_m_s.dot(&tangent), -end.spin_rad_s * RADIUS_M] {
                near("shared", 1.0 + (speed - shared) / v.x, 1.0, 1e-4);
            }
        }
        let [(heavy, _), (held, _)] =
            [free_spin(1e9, 0.0), SpinParams::Held].map(|spin| end_with(spin, 0.3, 50.0));
        let most = 1e-9 * v.norm();
        close("heavy", heavy.velocity_m_s, held.velocity_m_s, most);
    }
}

/// Under its weight the rotor bounces ever lower: flights shorten by e each, the more exactly the
/// stiffer the wall (the deviation falls as 1/√k_c), and end in a rest that carries the weight.
#[test]
fn bounces_under_gravity_shorten_by_e_and_end_at_rest() {
    let (e, g) = (0.5, 9.81);
    let weight = V2::new(0.0, -MASS_KG * g);
    for method in METHODS {
        let mut before: Option<f64> = None;
        for k in [1e8, 1e10, 1e12] {
            let mut params = free_mass(linear(k, e), 0.3);
            params.friction.rolling_coefficient = 0.02;
            let mut plant = plant(&params, &start(V2::zeros(), V2::zeros(), 0.0), method);
            let (mut touches, mut leaves) = (Vec::new(), Vec::new());
            let end = carry_with(&mut plant, 0.1, weight, &mut |s| match s.mode {
                ContactMode::Flight => leaves.push(s.t_s),
                _ if touches.len() == leaves.len() => touches.push(s.t_s),
                _ => {}
            });
            near("first", touches[0], (2.0 * CLEARANCE_M / g).sqrt(), 1e-12);
            // Falls by e at each touch; the flight after it lasts 2v/g.
            let mut v = (2.0 * g * CLEARANCE_M).sqrt();
            let mut offs = Vec::new();
            for (leave, touch) in leaves.iter().zip(&touches[1..]) {
                v *= e;
                offs.push((touch - leave) * g / (2.0 * v) - 1.0);
            }
            if k == 1e12 {
                assert!(offs[..4].iter().all(|off| off.abs() < 1e-2), "{offs:?}");
            }
            if let Some(before) = before {
                near("order", before / offs[0], 10.0, 0.2);
            }
            before = Some(offs[0]);
            let total = touches[0] * (1.0 + 2.0 * e / (1.0 - e));
            near("all", *touches.last().unwrap(), total, 1e3 / k.sqrt());
            assert_eq!(end.mode, ContactMode::Seated);
            assert!(end.position_m.x.abs() <= 1e-15 * CLEARANCE_M);
            assert!(end.velocity_m_s.norm() <= 1e-9);
            near("N", end.normal_force_n, -weight.y, 1e-6);
        }
    }
}

/// A step of 1e6 N from the centre: touch after √(2mc/F) at √(2cF/m), peak depth from
/// F(c + A) = k_c·A²/2; with damping it comes to rest under N = F; taken off, the spring's energy
/// comes back.
#[test]
fn a_step_of_a_million_newtons_obeys_energy_and_statics() {
    let force = 1e6;
    for (method, k) in each(&METHODS, &[1e9, 1e11, 1e13]) {
        let from = start(V2::zeros(), V2::zeros(), 0.0);
        let mut elastic = plant(&free_mass(linear(k, 1.0), 0.3), &from, method);
        let mut touch = None;
        let touches = (2.0 * MASS_KG * CLEARANCE_M / force).sqrt();
        let t = touches + 1.5 * PI * (MASS_KG / k).sqrt();
        carry_with(&mut elastic, t, V2::new(force, 0.0), &mut |s| {
            touch.get_or_insert(s.t_s);
        });
        near("touch", touch.unwrap(), touches, 1e-12);
        let (meters, speed) = (
            elastic.meters(),
            (2.0 * CLEARANCE_M * force / MASS_KG).sqrt(),
        );
        near("speed", meters.peak_impact_speed_m_s, speed, 1e-12);
        let depth = (force + (force * force + 2.0 * k * force * CLEARANCE_M).sqrt()) / k;
        near("peak", meters.peak_contact_force_n, k * depth, 1e-3);

        let law = linear(k, 0.1);
        let mut damped = plant(&free_mass(law, 0.3), &from, method);
        let rest = carry(&mut damped, 0.02, V2::new(force, 0.0));
        near("N", rest.normal_force_n, force, 1e-8);
        near("dent", rest.penetration_m, force / k, 1e-8);
        let [omega, z, a] = rates(&law, MASS_KG);
        let off = carry(&mut damped, 0.02 + 1.001 * a / omega, V2::zeros());
        let speed = force / k * omega * (-z * a).exp();
        near("released", -off.velocity_m_s.x, speed, 1e-6);
    }
}
