//! One impact by both laws: force over penetration, and restitution over speed.

use super::{RESTITUTION, damping_and_rate, linear_of, matched_at_impact, with_law};
use crate::paper::data::*;
use crate::paper::rotors::OnsetRig;
use crate::paper::runs::at_the_wall;
use plant_model::contact::restitution_of;
use plant_model::params::SlidingFriction;
use plant_model::{Inputs, Meters, Options, build};

/// Impact speed, about v_r,crit of the solid disc \[m/s\].
const SPEED_M_S: f64 = 0.09;
const SOURCE: &str = "footnote 2";

/// What an impact leaves behind.
struct Loop {
    /// Penetration \[µm\] and force \[kN\].
    points: Vec<(f64, f64)>,
    meters: Meters,
}

/// A frictionless impact from the wall, read `samples` times over `longest_s`.
fn impact(params: &PlantParams, longest_s: f64, samples: u32) -> Result<Loop> {
    let mut params = *params;
    params.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    let start = at_the_wall(&params, SPEED_M_S, 0.0);
    let mut plant = build(&params, &start, Options::default())?;
    let mut points = Vec::new();
    for i in 1..=samples {
        let t_s = longest_s * f64::from(i) / f64::from(samples);
        plant.advance(t_s, &Inputs::default(), &mut |_| {})?;
        let now = plant.snapshot();
        if now.mode.in_contact() {
            points.push((1e6 * now.penetration_m, 1e-3 * now.normal_force_n));
        }
    }
    let meters = plant.meters();
    Ok(Loop { points, meters })
}

/// Adds rows and figures of the impact.
pub(super) fn add(chapter: &mut Chapter, extent: Extent) -> Result<()> {
    let params = OnsetRig::solid_disc(RESTITUTION).params()?;
    let mass_kg = params.contact_mass_kg();
    let law = matched_at_impact(&params, SPEED_M_S)?;
    let longest_s = 2.0 * law.undamped_contact_s(SPEED_M_S, mass_kg);
    let of = |params: &PlantParams| impact(params, longest_s, extent.pick(300, 1500));
    let (linear, hardening) = (of(&params)?, of(&with_law(&params, law))?);
    let (a, b) = (linear.meters, hardening.meters);
    let e = restitution_of(damping_and_rate(&params)?.0);
    let step_kn = 1e-3 * linear_of(&params)?.damping_n_s_m * SPEED_M_S;
    let closed_kn = 1e-3 * law.peak_force_n(SPEED_M_S, mass_kg);
    chapter.rows.extend(rows! {
        "Force at the touch, 0.09 m/s", "kN", SOURCE, Silent => 0.0, Assumed, "linear: a step to d_c·v = {step_kn:.3} kN";
        "Largest force of the impact", "kN", SOURCE, Silent => 1e-3 * b.peak_contact_force_n, Assumed,
            "linear: {:.3} kN; closed form, without the shaft, {closed_kn:.3} kN", 1e-3 * a.peak_contact_force_n;
        "Largest penetration of the impact", "µm", SOURCE, Silent => 1e6 * b.peak_penetration_m, Assumed,
            "linear: {:.3} µm; matched to it, but for the force of the shaft", 1e6 * a.peak_penetration_m;
        "Duration of the impact", "ms", SOURCE, Silent => 1e3 * b.contact_time_s, Assumed, "linear: {:.3} ms, with a dent left", 1e3 * a.contact_time_s;
        "Restitution at a tenth of the speed", "", SOURCE, Silent => law.restitution(0.1 * SPEED_M_S), Assumed,
            "linear: {e:.3} at every speed; both the same at 0.09 m/s";
    });
    let far = 1.1e6 * a.peak_penetration_m.max(b.peak_penetration_m);
    let top = 1.1e-3 * a.peak_contact_force_n.max(b.peak_contact_force_n);
    let speeds = (0..=60).map(|i| 1e-3 * 10_f64.powf(0.05 * f64::from(i)));
    chapter.figures.push(chart! {
        "laws-loop", "Force over penetration by contact law",
        "Force over penetration in an impact at {SPEED_M_S} m/s, same restitution and depth. The linear one starts with a step and leaves a dent; what either loop encloses is lost.";
        Axis::linear("Penetration [µm]", (0.0, far)), Axis::linear("Normal force [kN]", (0.0, top));
        curves! {
            "linear", Line, 0 => linear.points;
            "Hunt and Crossley", Line, 1 => hardening.points;
        }
    });
    chapter.figures.push(chart! {
        "laws-restitution", "Restitution over impact speed by contact law", "Restitution over impact speed, closed forms.";
        Axis::log("Impact speed [m/s]", (1e-3, 1.0)), Axis::linear("Restitution", (0.0, 1.0));
        curves! {
            "linear", Line, 0 => level((1e-3, 1.0), e);
            "Hunt and Crossley", Line, 1 => speeds.map(|v| (v, law.restitution(v))).collect();
        }
    });
    Ok(())
}
