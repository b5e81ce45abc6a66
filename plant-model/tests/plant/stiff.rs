//! Contacts from soft to 1e13 N/m, light rings, hard pushes: impacts and rests in closed form.

use std::f64::consts::{PI, TAU};

use plant_model::contact::damping_for_restitution;
use plant_model::params::*;
use plant_model::{Method, Mode, V2};

use crate::support::bench::{
    CLEARANCE_M, MASS_KG, METHODS, RADIUS_M, carry, carry_with, free_mass, free_spin, half_angle,
    head_on, near, plant, ring, start,
};

/// From k_c = 1e6 to 1e13 N/m and from e = 1 to a hundredth of a per cent, contact overdamped
/// included: the rotor comes back with e times its speed, after 2a/ω.
#[test]
fn an_impact_restores_e_at_every_stiffness_and_damping() {
    let v = 0.1;
    for method in METHODS {
        for exponent in 6..=13 {
            for e in [1.0, 0.999, 0.7, (-2.0_f64).exp(), 1e-2, 1e-4] {
                let params = free_mass(10_f64.powi(exponent), e, 0.2);
                let exact = head_on(&params.contact, MASS_KG, v);
                let from = start(V2::new(1e-4, 0.0), V2::new(v, 0.0), 0.0);
                let mut plant = plant(&params, &from, method);
                let t = (CLEARANCE_M - 1e-4) / v + 1.01 * exact.duration_s;
                let end = carry(&mut plant, t, V2::zeros());
                let meters = plant.meters();
                assert_eq!((meters.impacts, end.mode), (1, Mode::Flight));
                near(
                    "restitution",
                    -end.velocity_m_s.x / v,
                    exact.restitution,
                    2e-9,
                );
                near("e", exact.restitution, e, 1e-8);
                near("duration", meters.contact_time_s, exact.duration_s, 1e-6);
                assert!(end.velocity_m_s.y.abs() <= 1e-15 * v);
            }
        }
    }
}

/// The same impacts' meters: deepest at A = v/ω·exp(−ζa); the force is largest at once where
/// ζ ≥ 1/2, with d_c·v, and before the deepest point where ζ < 1/2.
#[test]
fn peaks_of_an_impact_are_those_of_the_closed_form() {
    let v = 0.1;
    for method in METHODS {
        for k in [1e6, 1e9, 1e13] {
            for e in [1.0, 0.7, 0.2, 1e-2] {
                let params = free_mass(k, e, 0.0);
                let exact = head_on(&params.contact, MASS_KG, v);
                let from = start(V2::new(1e-4, 0.0), V2::new(v, 0.0), 0.0);
                let mut plant = plant(&params, &from, method);
                let t = (CLEARANCE_M - 1e-4) / v + 1.01 * exact.duration_s;
                carry(&mut plant, t, V2::zeros());
                let meters = plant.meters();
                let (depth, force) = (meters.peak_penetration_m, meters.peak_contact_force_n);
                near("peak depth", depth, exact.peak_penetration_m, 1e-3);
                near("peak force", force, exact.peak_force_n, 1e-3);
            }
        }
    }
}

/// A free ring of one gram is an equal partner: momentum is kept and the speed apart is e times the
/// speed of approach, alone or within an outer ring of one gram, up to k_c = 1e12.
#[test]
fn a_ring_of_one_gram_flies_off_with_momentum_kept() {
    let (v, ring_kg) = (0.05, 1e-3);
    let free = ring(ring_kg, V2::zeros(), 0.0);
    let outer = ring(ring_kg, V2::repeat(3.6e9), 18_970.0);
    let stators = [
        StatorParams::OneMass(free),
        StatorParams::TwoMass { inner: free, outer },
    ];
    for (stator, method) in stators.iter().flat_map(|s| METHODS.map(|m| (s, m))) {
        for k in [1e6, 1e9, 1e12] {
            for e in [1.0, 0.7, 0.05] {
                let mut params = free_mass(k, 1.0, 0.0);
                params.stator = *stator;
                let reduced = params.contact_mass_kg();
                params.contact.law.linear_mut().unwrap().damping_n_s_m =
                    damping_for_restitution(e, k, reduced).unwrap();
                let exact = head_on(&params.contact, reduced, v);
                let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), 0.0);
                let mut plant = plant(&params, &from, method);
                let t = 1e-5 / v + 1.5 * exact.duration_s;
                let end = carry(&mut plant, t, V2::zeros());
                assert_eq!(plant.meters().impacts, 1);
                let change = (1.0 + e) * v * reduced;
                near("rotor", end.velocity_m_s.x, v - change / MASS_KG, 1e-9);
                near("ring", end.inner_ring.velocity.x, change / ring_kg, 1e-8);
                assert_eq!(end.outer_ring.velocity.norm(), 0.0);
            }
        }
    }
}

/// A load on rings of one gram, anisotropic by 50 %, comes to rest where each spring carries it:
/// N = F along F, each ring displaced by N·n_i/k_i on what carries it, the contact dented by N/k_c.
#[test]
fn light_anisotropic_rings_carry_a_load_by_their_stiffness() {
    let (inner_k, outer_k) = (V2::new(8.9e8, 4.45e8), V2::new(1.8e9, 3.6e9));
    let force = V2::new(800.0, 600.0);
    for method in METHODS {
        for rings in [1, 2] {
            for mirrored in [false, true] {
                let swap = |v: V2| if mirrored { v.yx() } else { v };
                let (inner_k, outer_k, force) = (swap(inner_k), swap(outer_k), swap(force));
                let mut params = free_mass(1e9, 0.5, 0.0);
                params.rotor.damping_n_s_m = 1.4e4;
                let inner = ring(1e-3, inner_k, 300.0);
                let outer = ring(1e-3, outer_k, 300.0);
                params.stator = match rings {
                    1 => StatorParams::OneMass(inner),
                    _ => StatorParams::TwoMass { inner, outer },
                };
                let along = force / force.norm();
                let from = start(CLEARANCE_M * along, V2::zeros(), 0.0);
                let mut plant = plant(&params, &from, method);
                let end = carry(&mut plant, 0.04, force);
                let outer_at = match rings {
                    1 => V2::zeros(),
                    _ => force.component_div(&outer_k),
                };
                let inner_at = outer_at + force.component_div(&inner_k);
                let at = inner_at + (CLEARANCE_M + force.norm() / 1e9) * along;
                near("N", end.normal_force_n, force.norm(), 1e-8);
                for axis in [0, 1] {
                    near("inner", end.inner_ring.position[axis], inner_at[axis], 1e-7);
                    near("rotor", end.position_m[axis], at[axis], 1e-7);
                }
                let apart = (end.outer_ring.position - outer_at).norm();
                assert!(apart <= 1e-7 * inner_at.norm(), "{apart:e}");
            }
        }
    }
}

/// Friction at an impact that slides throughout: angular momentum changes by μ·∫N dt on a lever
/// between c and c + A (not at all without friction), the spin by R·μ·∫N dt/J, at every speed of
/// either sense; reversing the spin gives the mirror image to the bit.
#[test]
fn friction_at_an_impact_is_mu_times_the_impulse() {
    let (v, inertia) = (0.01, 0.05);
    for method in METHODS {
        for mu in [0.0, 0.01, 1.0, 2.0] {
            for spin in [100.0, TAU * 1000.0] {
                let mut params = free_mass(1e10, 0.7, mu);
                params.spin = free_spin(inertia);
                let ends = [spin, -spin].map(|spin| {
                    let from = start(V2::new(1.9e-4, 0.0), V2::new(v, 0.0), spin);
                    let mut plant = plant(&params, &from, method);
                    let end = carry(&mut plant, 1.5e-3, V2::zeros());
                    assert_eq!((plant.meters().impacts, end.mode), (1, Mode::Flight));
                    (end, plant.audit().flows, plant.meters())
                });
                let [(end, flows, meters), (mirrored, ..)] = ends;
                let impulse = flows.normal_impulse_n_s;
                near("impulse", impulse, 1.7 * MASS_KG * v, 2e-2);
                let momentum = MASS_KG * end.position_m.perp(&end.velocity_m_s);
                let lever = CLEARANCE_M + meters.peak_penetration_m;
                let [most, least] = [lever, CLEARANCE_M].map(|lever| -mu * impulse * lever);
                let round_off = 1e-9 * lever * impulse;
                assert!((most - round_off..=least + round_off).contains(&momentum));
                let slowed = end.spin_rad_s - spin;
                let exact = -RADIUS_M * mu * impulse / inertia;
                assert!(
                    (slowed - exact).abs() <= 1e-10 * spin,
                    "{slowed:e} {exact:e}"
                );
                if mu == 0.0 {
                    assert_eq!((momentum, slowed), (0.0, 0.0));
                }
                let turned = V2::new(mirrored.position_m.x, -mirrored.position_m.y);
                assert_eq!(turned, end.position_m);
                assert_eq!(mirrored.spin_rad_s, -end.spin_rad_s);
            }
        }
    }
}

/// Without spin, friction takes μ(1 + e) times the normal speed off the tangential speed and no more
/// than all of it; a head-on impact stays on its line.
#[test]
fn without_spin_friction_stops_the_slip_and_never_reverses_it() {
    let (vn, vt, e) = (0.1, 0.05, 0.7);
    for method in METHODS {
        for mu in [0.0, 0.01, 0.2, 1.0, 2.0] {
            let mut params = free_mass(1e13, e, mu);
            params.contact.clearance_m = 1e-2;
            let from = start(V2::new(9.99e-3, 0.0), V2::new(vn, vt), 0.0);
            let mut plant = plant(&params, &from, method);
            let mut touch = None;
            let end = carry_with(&mut plant, 2e-4, V2::zeros(), &mut |s| {
                touch.get_or_insert(*s);
            });
            let normal = touch.unwrap().position_m.normalize();
            let tangent = V2::new(-normal.y, normal.x);
            let [before, after] = [from.velocity_m_s, end.velocity_m_s];
            let left = before.dot(&tangent) - mu * (1.0 + e) * before.dot(&normal);
            let slip = after.dot(&tangent);
            assert!(
                (slip - left.max(0.0)).abs() <= 1e-4 * vn,
                "μ = {mu}: {slip:e}, {left:e}"
            );
            near("e", -after.dot(&normal) / before.dot(&normal), e, 1e-4);

            let from = start(V2::new(9.99e-3, 0.0), V2::new(vn, 0.0), 0.0);
            let mut plant = self::plant(&params, &from, method);
            let end = carry(&mut plant, 2e-4, V2::zeros());
            assert!(end.velocity_m_s.y.abs() <= 1e-15 * vn);
        }
    }
}

/// Released at rest from a depth A in the wall, the rotor leaves after a/ω with A·ω·exp(−ζa); moving
/// out faster than the wall follows, it feels nothing at all.
#[test]
fn a_rotor_released_from_inside_the_wall_leaves_at_its_speed() {
    for method in METHODS {
        for (depth, k, e) in [1e-9, 1e-5, 1e-3]
            .iter()
            .flat_map(|a| [1e6, 1e9, 1e13].map(|k| (*a, k)))
            .flat_map(|(a, k)| [1.0, 0.5, 1e-3].map(|e| (a, k, e)))
        {
            let params = free_mass(k, e, 0.0);
            let omega = (k / MASS_KG).sqrt();
            let z = 0.5 * params.contact.law.linear().unwrap().damping_n_s_m / (k * MASS_KG).sqrt();
            let a = half_angle(z);
            let at = V2::new(0.0, -CLEARANCE_M - depth);
            let mut plant = plant(&params, &start(at, V2::zeros(), 0.0), method);
            assert!(plant.mode().in_contact());
            let end = carry(&mut plant, 1.001 * a / omega, V2::zeros());
            assert_eq!(end.mode, Mode::Flight);
            near(
                "speed",
                end.velocity_m_s.y,
                depth * omega * (-z * a).exp(),
                1e-8,
            );
            near("duration", plant.meters().contact_time_s, a / omega, 1e-6);

            if e < 1.0 {
                let out = V2::new(
                    0.0,
                    1.1 * depth * k / params.contact.law.linear().unwrap().damping_n_s_m,
                );
                let mut plant = self::plant(&params, &start(at, out, 0.0), method);
                let end = carry(&mut plant, 0.5 * depth / out.y, V2::zeros());
                assert_eq!(end.mode, Mode::Flight);
                near("speed", end.velocity_m_s.y, out.y, 1e-15);
                assert_eq!(plant.meters().contact_time_s, 0.0);
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
            let mut params = free_mass(1e13, 0.7, mu);
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
            let (end, normal) = end_with(free_spin(inertia), 2.0, 0.0);
            let tangent = V2::new(-normal.y, normal.x);
            let shared = v.dot(&tangent) / (1.0 + j);
            let rolled = -end.spin_rad_s * RADIUS_M;
            for speed in [end.velocity_m_s.dot(&tangent), rolled] {
                near("shared", 1.0 + (speed - shared) / v.x, 1.0, 1e-4);
            }
        }
        let (heavy, _) = end_with(free_spin(1e9), 0.3, 50.0);
        let (held, _) = end_with(SpinParams::Held, 0.3, 50.0);
        let apart = (heavy.velocity_m_s - held.velocity_m_s).norm();
        assert!(apart <= 1e-9 * v.norm(), "{apart:e}");
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
            let mut params = free_mass(k, e, 0.3);
            params.friction.rolling_coefficient = 0.02;
            let from = start(V2::zeros(), V2::zeros(), 0.0);
            let mut plant = plant(&params, &from, method);
            let (mut touches, mut leaves) = (Vec::new(), Vec::new());
            let end = carry_with(&mut plant, 0.1, weight, &mut |s| match s.mode {
                Mode::Flight => leaves.push(s.t_s),
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
            assert_eq!(end.mode, Mode::Seated);
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
    for method in METHODS {
        for k in [1e9, 1e11, 1e13] {
            let mut params = free_mass(k, 1.0, 0.3);
            let from = start(V2::zeros(), V2::zeros(), 0.0);
            let mut elastic = plant(&params, &from, method);
            let mut touch = None;
            let touches = (2.0 * MASS_KG * CLEARANCE_M / force).sqrt();
            let t = touches + 1.5 * PI * (MASS_KG / k).sqrt();
            carry_with(&mut elastic, t, V2::new(force, 0.0), &mut |s| {
                touch.get_or_insert(s.t_s);
            });
            let speed = (2.0 * CLEARANCE_M * force / MASS_KG).sqrt();
            near("touch", touch.unwrap(), touches, 1e-12);
            let meters = elastic.meters();
            near("speed", meters.peak_impact_speed_m_s, speed, 1e-12);
            let depth = (force + (force * force + 2.0 * k * force * CLEARANCE_M).sqrt()) / k;
            near("peak", meters.peak_contact_force_n, k * depth, 1e-3);

            params.contact.law.linear_mut().unwrap().damping_n_s_m =
                damping_for_restitution(0.1, k, MASS_KG).unwrap();
            let mut damped = plant(&params, &from, method);
            let rest = carry(&mut damped, 0.02, V2::new(force, 0.0));
            near("N", rest.normal_force_n, force, 1e-8);
            near("dent", rest.penetration_m, force / k, 1e-8);
            let z = 0.5 * params.contact.law.linear().unwrap().damping_n_s_m / (k * MASS_KG).sqrt();
            let omega = (k / MASS_KG).sqrt();
            let a = half_angle(z);
            let off = carry(&mut damped, 0.02 + 1.001 * a / omega, V2::zeros());
            let speed = force / k * omega * (-z * a).exp();
            near("released", -off.velocity_m_s.x, speed, 1e-6);
        }
    }
}

/// Friction that falls as fast as within a nanometre per second, μ = μ_∞ + Δ·exp(−v/v0): standing
/// holds up to μ_0·N. Pushed beyond with T, or sliding until it sticks, the time for a speed v is
/// m·v0/D·(v/v0 + ln((D + E·exp(−v/v0))/(D + E))), D = T − μ_∞N and E = −ΔN, or D = μ_∞N and E = ΔN.
#[test]
fn falling_friction_with_a_tiny_speed_scale_holds_and_breaks_loose() {
    let (press, k, at_rest, at_speed) = (1e4, 1e9, 0.3, 0.1);
    for method in METHODS {
        // What falls within 5 ps is beyond collocation, which says so.
        let scales: &[f64] = match method {
            Method::Series => &[1e-9, 1e-6, 1e-3],
            _ => &[1e-6, 1e-3],
        };
        for &scale in scales {
            let mut params = free_mass(k, 0.5, 0.0);
            params.contact.clearance_m = 1e-2;
            params.friction.sliding = SlidingFriction::Falling {
                at_rest,
                at_speed,
                speed_scale_m_s: scale,
            };
            let takes_s = |v: f64, d: f64, e: f64| {
                let x = v / scale;
                MASS_KG * scale / d * (x + ((d + e * (-x).exp()) / (d + e)).ln())
            };
            let pressed = V2::new(1e-2 + press / k, 0.0);
            let at = start(pressed, V2::zeros(), 0.0);
            let end = carry(
                &mut plant(&params, &at, method),
                1e-3,
                V2::new(press, 2.9e3),
            );
            assert_eq!(end.mode, Mode::Roll);
            assert!(end.velocity_m_s.norm() <= 1e-12);

            let (t, push) = (1e-4, 3.1e3);
            let end = carry(&mut plant(&params, &at, method), t, V2::new(press, push));
            let fall = (at_rest - at_speed) * press;
            let exact = takes_s(end.velocity_m_s.y, push - at_speed * press, -fall);
            near("loose", t, exact, 1e-3);

            let v = 1e-2;
            let from = start(pressed, V2::new(0.0, v), 0.0);
            let mut plant = plant(&params, &from, method);
            let mut stuck = None;
            let end = carry_with(&mut plant, 2e-4, V2::new(press, 0.0), &mut |s| {
                stuck.get_or_insert((s.t_s, s.mode));
            });
            let (t, mode) = stuck.unwrap();
            assert_eq!((mode, end.mode), (Mode::Roll, Mode::Roll));
            near("brakes", t, takes_s(v, at_speed * press, fall), 1e-3);
        }
    }
}
