//! Runs against a bushing or a race, and the closed forms they are held against.

use super::super::PaperError;
use plant_model::analysis::course::{Course, Watch, follow};
use plant_model::analysis::impact::{Criterion, Impact, Outcome, run_impact};
use plant_model::analysis::onset::critical_tangential_speed_m_s;
use plant_model::params::{PlantParams, RaceParams, SpinParams};
use plant_model::{Mode, Options, build};
use std::f64::consts::TAU;

/// A race at rest.
pub(super) fn race(inertia_kg_m2: f64, drag_n_m_s: f64) -> Option<RaceParams> {
    Some(RaceParams {
        inertia_kg_m2,
        drag_n_m_s,
        start_spin_rad_s: 0.0,
    })
}

/// What is read off a run from an impact at the wall.
#[derive(Debug, Clone)]
pub(super) struct Run {
    pub(super) course: Course,
    /// Fastest whirl as a mean over 1 ms \[Hz\].
    pub(super) fastest_hz: Option<f64>,
    /// Largest f_n after the impact itself, from the first whole window of whirl on \[N\].
    pub(super) whirl_force_n: f64,
    /// When sliding ends in the contact that is the whirl \[s\].
    pub(super) slip_ends_s: Option<f64>,
    /// When that contact ends \[s\]; `None` where it lasts as long as the run.
    pub(super) dies_s: Option<f64>,
    /// Whirl at the end of a run that it outlasts \[Hz\].
    pub(super) last_hz: Option<f64>,
}

/// A run from the wall with a radial speed, ended once the rotor has been free for 30 ms.
pub(super) fn run(
    params: &PlantParams,
    (impact_m_s, spin_hz): (f64, f64),
    end_s: f64,
) -> Result<Run, PaperError> {
    let start = super::super::whirl_runs::at_the_wall(params, impact_m_s, spin_hz);
    let mut plant = build(params, &start, Options::default())?;
    let watch = Watch {
        sample_s: 20e-6,
        window_s: 1e-3,
        end_s,
        free_s: 0.03,
        pulse: None,
    };
    let course = follow(&mut plant, &watch)?;
    let whirl = course.longest_contact();
    let inside = |t_s: f64| whirl.is_some_and(|c| c.from_s <= t_s && t_s <= c.to_s);
    let lasts = whirl.is_some_and(|c| c.to_s > end_s - 1e-9);
    let from_s = course.whirl.first().map_or(f64::INFINITY, |r| r.t_s);
    Ok(Run {
        fastest_hz: course.fastest().map(|r| r.backward_hz),
        whirl_force_n: (course.samples.iter())
            .filter(|s| s.t_s >= from_s)
            .map(|s| s.normal_force_n)
            .fold(0.0, f64::max),
        slip_ends_s: (course.samples.iter())
            .find(|s| s.mode == Mode::Roll && inside(s.t_s))
            .map(|s| s.t_s),
        dies_s: whirl.filter(|_| !lasts).map(|c| c.to_s),
        last_hz: (course.whirl.last())
            .filter(|_| lasts)
            .map(|r| r.backward_hz),
        course,
    })
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

/// Tangential speed that friction can give a rotor before slip ends \[m/s\]: an impulse I takes
/// I·(R²/J + R_i²/J_i + κ/m) off the slip and gives κ·I/m to the whirl, κ = 1 − μ_r/μ. Shaft, damping, drag
/// and the motion of the stator are left out.
pub(super) fn most_whirl_m_s(params: &PlantParams, spin_hz: f64) -> f64 {
    let share = driving_share(params);
    let bore = params.bore_radius_m();
    let of_race = (params.race).map_or(0.0, |race| bore * bore / race.inertia_kg_m2);
    let surfaces = rotor_mobility(params) + of_race;
    let surface = params.rotor.contact_radius_m * spin_hz * TAU;
    surface * share / (share + params.rotor.mass_kg * surfaces)
}

/// Race with which that speed is `speed_m_s` \[kg m²\]; `None` where even a bushing gives less.
pub(super) fn inertia_for(params: &PlantParams, spin_hz: f64, speed_m_s: f64) -> Option<f64> {
    let share = driving_share(params);
    let surface = params.rotor.contact_radius_m * spin_hz * TAU;
    let per_mass = share * (surface / speed_m_s - 1.0) / params.rotor.mass_kg;
    let of_race = per_mass - rotor_mobility(params);
    (of_race > 0.0).then(|| params.bore_radius_m().powi(2) / of_race)
}

/// Drag above which rolling whirl stays alive at held spin \[N m s\]: at v_t,crit the race takes
/// b·Ω_i/R_i = μ·N, and N·(μ − μ_r) = d·v there.
pub(super) fn sustaining_drag_n_m_s(params: &PlantParams, spin_hz: f64) -> Option<f64> {
    let speed = critical_tangential_speed_m_s(params)?;
    let mu = params.friction.sliding.coefficient(0.0);
    let driving = mu - params.friction.rolling_coefficient;
    let normal_n = params.rotor.damping_n_s_m * speed / driving;
    let bore = params.bore_radius_m();
    let race_rad_s = (params.rotor.contact_radius_m * spin_hz * TAU - speed) / bore;
    Some(mu * normal_n * bore / race_rad_s)
}

/// Rolling whirl that a drag keeps alive at held spin on a rigid stator \[Hz\]: b·Ω_i/R_i = μ_r·N + d·v with
/// N = m·v²/c − k·c.
pub(super) fn sustained_hz(params: &PlantParams, spin_hz: f64) -> Option<f64> {
    let drag = params.race?.drag_n_m_s;
    let (rotor, c) = (params.rotor, params.contact.clearance_m);
    let bore = params.bore_radius_m();
    let mu_r = params.friction.rolling_coefficient;
    let by_speed = rotor.damping_n_s_m + drag / (bore * bore);
    let by_square = mu_r * rotor.mass_kg / c;
    let given = drag * rotor.contact_radius_m * spin_hz * TAU / (bore * bore)
        + mu_r * rotor.stiffness_n_m * c;
    let root = (by_speed * by_speed + 4.0 * by_square * given).sqrt();
    let speed = 2.0 * given / (by_speed + root);
    let least = critical_tangential_speed_m_s(params)?;
    (speed > least).then(|| speed / c / TAU)
}

/// Lightest race \[kg m²\] with which an impact ends in twice v_t,crit, by bisection of runs.
pub(super) fn lightest_that_whirls(
    params: &PlantParams,
    (impact_m_s, spin_hz): (f64, f64),
) -> Result<f64, PaperError> {
    let whirls = |inertia_kg_m2: f64| -> Result<bool, PaperError> {
        let mut params = *params;
        params.race = race(inertia_kg_m2, 0.0);
        let impact = Impact {
            speed_m_s: impact_m_s,
            inclination_rad: 0.0,
            spin_rad_s: spin_hz * TAU,
            spin_phase_rad: 0.0,
        };
        let after = run_impact(&params, &impact, &Criterion::default())?;
        Ok(after.outcome == Outcome::Whirl)
    };
    let (mut low, mut high) = (1e-5_f64, 1e-1_f64);
    if whirls(low)? || !whirls(high)? {
        return Err(PaperError::Missing("a race between whirl and none".into()));
    }
    while high > low * 1.001 {
        let middle = (low * high).sqrt();
        if whirls(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(high)
}
