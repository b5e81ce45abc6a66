//! Chapter: what Hunt and Crossley's contact law changes, which footnote 2 leaves open.

mod impact;
mod onset;
mod whirl;

use super::data::*;
use plant_model::contact::hunt_crossley::damping_for_restitution;
use plant_model::contact::restitution_of;
use plant_model::params::{ContactLaw, HuntCrossley, LinearContact};

/// Restitution of the linear contact against onset; near what the chapter on onset fits.
const RESTITUTION: f64 = 0.7;
/// Hertz's exponent.
const EXPONENT: f64 = 1.5;

/// The same plant with another contact law.
fn with_law(params: &PlantParams, law: impl Into<ContactLaw>) -> PlantParams {
    let mut params = *params;
    params.contact.law = law.into();
    params
}

/// The linear law of a plant.
fn linear_of(params: &PlantParams) -> Result<LinearContact> {
    (params.contact.law.linear()).or_missing("no linear contact")
}

/// Damping ratio of the linear contact of a plant, and the undamped rate \[rad/s\].
fn damping_and_rate(params: &PlantParams) -> Result<(f64, f64)> {
    let (law, mass_kg) = (linear_of(params)?, params.contact_mass_kg());
    let rate = (law.stiffness_n_m / mass_kg).sqrt();
    Ok((0.5 * law.damping_n_s_m / (mass_kg * rate), rate))
}

/// Hertz's law with the restitution and the largest penetration that the linear contact of a plant has in
/// an impact at a speed. The linear one is v/ω·exp(−ζ·acos ζ/√(1 − ζ²)) deep, (2.10) at Ȧ = 0.
fn matched_at_impact(params: &PlantParams, speed_m_s: f64) -> Result<HuntCrossley> {
    let (ratio, rate) = damping_and_rate(params)?;
    let damping_s_m = damping_for_restitution(restitution_of(ratio), speed_m_s);
    let damping_s_m = damping_s_m.filter(|_| ratio < 1.0);
    let depth_m = speed_m_s / rate * (-ratio * ratio.acos() / (1.0 - ratio * ratio).sqrt()).exp();
    let law = HuntCrossley {
        stiffness_n_mn: 1.0,
        exponent: EXPONENT,
        damping_s_m: damping_s_m.or_missing(format!("no impact with ζ = {ratio}"))?,
    };
    Ok(law.with_depth(depth_m, speed_m_s, params.contact_mass_kg()))
}

/// Hertz's law with the penetration and the damper of the linear contact of a plant at a steady force:
/// k_h·Aⁿ = N = k_c·A and λ·N = d_c.
fn matched_at_force(params: &PlantParams, normal_force_n: f64) -> Result<HuntCrossley> {
    let law = linear_of(params)?;
    let depth_m = normal_force_n / law.stiffness_n_m;
    Ok(HuntCrossley {
        stiffness_n_mn: normal_force_n / depth_m.powf(EXPONENT),
        exponent: EXPONENT,
        damping_s_m: law.damping_n_s_m / normal_force_n,
    })
}

/// Computes the chapter. A quick run leaves onset with two configurations and whirl with fewer runs.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let mut chapter = Chapter::new(
        "Contact laws",
        [
            "Footnote 2: the linear law (2.8) could be replaced by a nonlinear one. Here it is Hunt and Crossley's with Hertz's exponent, f_n = k_h·A^1.5·(1 + λB), beside the linear one with the same restitution and depth at one impact speed. The paper has no number for it: paper values in the rows are those of its tests and calculations with whatever law they had.",
            "What differs: the force starts and ends without a step, no dent is left after a free impact, and restitution is a matter of speed, 1 − e ≈ (2/3)·λ·v. A linear contact loses the same share at every bounce, this one ever less: a series of impacts that shrinks brings more friction impulse in all, so whirl begins at a lower impact speed although the first impact is the same. With λ fitted to the first configuration of Fig. 3 instead, the others are predicted worse than by the linear law: the inclined impacts too low, the damped shaft far too high. These tests speak against losses that vanish at low speed.",
            "What does not: a steady whirl needs nothing of the law but f_n, so Black's frequencies stay. Only the force that goes with a frequency changes, by the penetration: N·|u|/N_hard = c + (N/k_h)^(2/3). For every frequency that a contact without deformation has, this has a solution, since the penetration grows more slowly than the force; a soft linear contact (k_c = 3e8 N/m) needs a pull there and has none. Whether whirl is stable there is another matter; the table of held spin says what runs do.",
        ],
    );
    onset::add(&mut chapter, extent)?;
    impact::add(&mut chapter, extent)?;
    whirl::add(&mut chapter, extent)?;
    Ok(chapter)
}
