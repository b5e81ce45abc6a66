//! Onset: the lowest radial impact that ends in whirl.

use super::{RESTITUTION, matched_at_impact, with_law};
use crate::paper::data::*;
use crate::paper::onset::{Configuration, Fit, configurations, critical_m_s, impact};
use plant_model::analysis::impact::{Criterion, Outcome, run_impact};
use plant_model::contact::hunt_crossley::damping_for_restitution;
use plant_model::params::HuntCrossley;

const SOURCE: &str = "Results, onset phase; Fig. 3";

/// Configurations of the chapter on onset in the order of this one; a quick run has the first two.
fn used(extent: Extent) -> Vec<Configuration> {
    let fit = Fit {
        restitution: RESTITUTION,
        seal_friction: 1.0,
    };
    let [solid, damped, by_30, by_50, _] = configurations(&fit);
    [solid, by_30, damped, by_50][..extent.pick(2, 4)].to_vec()
}

/// The critical speeds of a configuration \[m/s\] by both laws, with the restitution of the nonlinear one
/// at its own; and that by the fitted law.
struct Critical {
    of: Configuration,
    linear_m_s: f64,
    hardening_m_s: f64,
    restitution: f64,
    fitted_m_s: f64,
}

impl Critical {
    fn new(of: &Configuration, fitted: HuntCrossley) -> Result<Self> {
        let params = of.rig.params()?;
        let by = |law| critical_m_s(&with_law(&params, law), of.inclination_rad);
        let linear_m_s = critical_m_s(&params, of.inclination_rad)?;
        // What meets the wall is the radial part.
        let radial = of.inclination_rad.cos();
        let law = matched_at_impact(&params, linear_m_s * radial)?;
        let hardening_m_s = by(law)?;
        Ok(Self {
            of: *of,
            linear_m_s,
            hardening_m_s,
            restitution: law.restitution(hardening_m_s * radial),
            fitted_m_s: by(fitted)?,
        })
    }
}

/// The law with a restitution at the speed measured for a configuration, depth as the linear one.
fn law_of(solid: &Configuration, restitution: f64) -> Result<HuntCrossley> {
    let damping_s_m = damping_for_restitution(restitution, solid.measured_m_s);
    Ok(HuntCrossley {
        damping_s_m: damping_s_m.or_missing(format!("no restitution: {restitution}"))?,
        ..matched_at_impact(&solid.rig.params()?, solid.measured_m_s)?
    })
}

/// The restitution with which v_r,crit of a configuration is the measured one, k_h kept.
fn fit(solid: &Configuration) -> Result<f64> {
    let params = solid.rig.params()?;
    let impact = impact(solid.measured_m_s, solid.inclination_rad);
    // v_r,crit falls with e; whirl at the measured speed says that it lies below.
    let free = |restitution: f64| {
        let tried = with_law(&params, law_of(solid, restitution)?);
        let after = run_impact(&tried, &impact, &Criterion::default())?;
        Ok(after.outcome != Outcome::Whirl)
    };
    let (low, high) = halved((0.02, RESTITUTION), |high| 1e-3 * high, free)?;
    Ok(0.5 * (low + high))
}

/// Adds rows and table of the critical speeds.
pub(super) fn add(chapter: &mut Chapter, extent: Extent) -> Result<()> {
    let used = used(extent);
    let restitution = fit(&used[0])?;
    let law = law_of(&used[0], restitution)?;
    let all = each(&used, |of| Critical::new(of, law))?;
    for c in &all {
        let (name, linear_m_s) = (c.of.name, c.linear_m_s);
        chapter.rows.extend(rows! {
            "v_r,crit, {name}, Hunt and Crossley", "m/s", SOURCE, c.of.measured_m_s => c.hardening_m_s, Assumed,
                "e = {RESTITUTION} and depth as the linear law at its own v_r,crit, {linear_m_s:.4} m/s; {:+.1} % from it", 100.0 * (c.hardening_m_s / linear_m_s - 1.0);
        });
    }
    for (i, c) in all.iter().enumerate() {
        let (name, kind) = (c.of.name, if i == 0 { Fitted } else { Predicted });
        chapter.rows.extend(rows! {
            "v_r,crit, {name}, Hunt and Crossley fitted", "m/s", SOURCE, c.of.measured_m_s => c.fitted_m_s, kind,
                "λ = {:.2} s/m chosen for the first configuration: e = {restitution:.3} at {} m/s", law.damping_s_m, used[0].measured_m_s;
        });
    }
    chapter.tables.push(table! {
        "Lowest radial impact that ends in whirl; k_c = 1e8 N/m, linear e = {RESTITUTION}";
        for c in &all;
        "Configuration" => "{}", c.of.name;
        "Linear [m/s]" => "{:.4}", c.linear_m_s;
        "Hunt and Crossley [m/s]" => "{:.4}", c.hardening_m_s;
        "its e there" => "{:.3}", c.restitution;
    });
    Ok(())
}
