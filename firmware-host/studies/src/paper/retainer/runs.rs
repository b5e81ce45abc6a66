//! Runs against a bushing or a race, and the closed forms they are held against.

use super::{IMPACT_M_S, SPIN_HZ};
use crate::paper::data::*;
use crate::paper::runs::{Run, at_the_wall, watch};
use plant_model::ContactMode;
use plant_model::analysis::course::Course;
use plant_model::analysis::onset::critical_tangential_speed_m_s;
use plant_model::params::{RaceParams, SpinParams};

/// The same plant against a race at rest, or against a bushing.
pub(super) fn with_race(
    params: &PlantParams,
    inertia_kg_m2: Option<f64>,
    drag_n_m_s: f64,
) -> PlantParams {
    PlantParams {
        race: inertia_kg_m2.map(|inertia_kg_m2| RaceParams {
            inertia_kg_m2,
            drag_n_m_s,
            start_spin_rad_s: 0.0,
        }),
        ..*params
    }
}

/// A run against a race or a bushing, and what is read off it.
pub(super) struct Tried {
    /// Of the race \[kg m²\]; `None` for a bushing.
    pub(super) inertia_kg_m2: Option<f64>,
    pub(super) params: PlantParams,
    pub(super) course: Course,
    /// Fastest whirl as a mean over 1 ms \[Hz\].
    pub(super) fastest_hz: Option<f64>,
    /// Largest f_n after the impact itself, from the first whole window of whirl on \[kN\].
    pub(super) force_kn: f64,
    /// When sliding ends in the contact that is the whirl \[ms\].
    pub(super) slip_ends_ms: Option<f64>,
    /// When that contact ends \[ms\]; `None` where it lasts as long as the run.
    pub(super) dies_ms: Option<f64>,
    /// Whirl at the end of a run that it outlasts \[Hz\].
    pub(super) last_hz: Option<f64>,
    /// Spin of the rotor when the whirl dies, or at the end of the run \[Hz\].
    pub(super) spin_left_hz: Option<f64>,
    /// Of the race then \[Hz\].
    pub(super) race_spin_hz: Option<f64>,
}

impl Tried {
    /// From the wall with a radial speed, ended once the rotor has been free for 30 ms.
    pub(super) fn run(params: &PlantParams, end_s: f64) -> Result<Self> {
        let start = at_the_wall(params, IMPACT_M_S, SPIN_HZ);
        let course = Run::of(params, &start, &watch(20e-6, end_s, 0.03))?.course;
        let whirl = course.longest_contact();
        let inside = |t_s: f64| whirl.is_some_and(|c| c.from_s <= t_s && t_s <= c.to_s);
        let lasts = whirl.is_some_and(|c| c.to_s > end_s - 1e-9);
        let from_s = course.whirl.first().map_or(f64::INFINITY, |r| r.t_s);
        let in_whirl = course.samples.iter().filter(|s| s.t_s >= from_s);
        let force_n = in_whirl.map(|s| s.normal_force_n).fold(0.0, f64::max);
        let rolls = (course.samples.iter()).find(|s| s.mode == ContactMode::Roll && inside(s.t_s));
        let dies_s = whirl.filter(|_| !lasts).map(|c| c.to_s);
        let last = course.at(dies_s.unwrap_or(f64::INFINITY));
        Ok(Self {
            inertia_kg_m2: params.race.map(|race| race.inertia_kg_m2),
            params: *params,
            fastest_hz: course.fastest().map(|r| r.backward_hz),
            force_kn: 1e-3 * force_n,
            slip_ends_ms: rolls.map(|s| 1e3 * s.t_s),
            dies_ms: dies_s.map(|s| 1e3 * s),
            last_hz: (course.whirl.last().filter(|_| lasts)).map(|r| r.backward_hz),
            spin_left_hz: last.map(|s| s.spin_hz),
            race_spin_hz: last.map(|s| s.race_spin_hz),
            course,
        })
    }

    /// Fastest whirl that friction can give before slip ends \[Hz\].
    pub(super) fn bound_hz(&self) -> f64 {
        most_whirl_m_s(&self.params) / self.params.contact.clearance_m / TAU
    }
}

/// μ_r as a share of μ taken off: what of the friction that turns the surfaces also drives the whirl.
fn driving_share(params: &PlantParams) -> f64 {
    let mu = params.friction.sliding.coefficient(0.0);
    1.0 - params.friction.rolling_coefficient / mu
}

/// R²/J of the rotor; 0 where its spin is held.
fn rotor_mobility(params: &PlantParams) -> f64 {
    match params.spin {
        SpinParams::Held => 0.0,
        SpinParams::Free { inertia_kg_m2, .. } => {
            params.rotor.contact_radius_m.powi(2) / inertia_kg_m2
        }
    }
}

/// Speed of the rotor's surface \[m/s\].
fn surface_m_s(params: &PlantParams) -> f64 {
    params.rotor.contact_radius_m * SPIN_HZ * TAU
}

/// Tangential speed that friction can give a rotor before slip ends \[m/s\]: an impulse I takes
/// I·(R²/J + R_i²/J_i + κ/m) off the slip and gives κ·I/m to the whirl, κ = 1 − μ_r/μ. Shaft, damping, drag
/// and the motion of the stator are left out.
fn most_whirl_m_s(params: &PlantParams) -> f64 {
    let share = driving_share(params);
    let bore = params.bore_radius_m();
    let of_race = (params.race).map_or(0.0, |race| bore * bore / race.inertia_kg_m2);
    let surfaces = rotor_mobility(params) + of_race;
    surface_m_s(params) * share / (share + params.rotor.mass_kg * surfaces)
}

/// Race with which that speed is `speed_m_s` \[kg m²\]; `None` where even a bushing gives less.
pub(super) fn inertia_for(params: &PlantParams, speed_m_s: f64) -> Option<f64> {
    let share = driving_share(params);
    let per_mass = share * (surface_m_s(params) / speed_m_s - 1.0) / params.rotor.mass_kg;
    let of_race = per_mass - rotor_mobility(params);
    (of_race > 0.0).then(|| params.bore_radius_m().powi(2) / of_race)
}

/// Drag above which rolling whirl stays alive at held spin \[N m s\]: at v_t,crit the race takes
/// b·Ω_i/R_i = μ·N, and N·(μ − μ_r) = d·v there.
pub(super) fn sustaining_drag_n_m_s(params: &PlantParams) -> Option<f64> {
    let speed = critical_tangential_speed_m_s(params)?;
    let mu = params.friction.sliding.coefficient(0.0);
    let driving = mu - params.friction.rolling_coefficient;
    let normal_n = params.rotor.damping_n_s_m * speed / driving;
    let bore = params.bore_radius_m();
    let race_rad_s = (surface_m_s(params) - speed) / bore;
    Some(mu * normal_n * bore / race_rad_s)
}

/// Rolling whirl that a drag keeps alive at held spin on a rigid stator \[Hz\]: b·Ω_i/R_i = μ_r·N + d·v with
/// N = m·v²/c − k·c.
pub(super) fn sustained_hz(params: &PlantParams) -> Option<f64> {
    let drag = params.race?.drag_n_m_s;
    let (rotor, c) = (params.rotor, params.contact.clearance_m);
    let bore = params.bore_radius_m();
    let mu_r = params.friction.rolling_coefficient;
    let by_speed = rotor.damping_n_s_m + drag / (bore * bore);
    let by_square = mu_r * rotor.mass_kg / c;
    let given = drag * surface_m_s(params) / (bore * bore) + mu_r * rotor.stiffness_n_m * c;
    let root = (by_speed * by_speed + 4.0 * by_square * given).sqrt();
    let speed = 2.0 * given / (by_speed + root);
    let least = critical_tangential_speed_m_s(params)?;
    (speed > least).then(|| speed / c / TAU)
}
