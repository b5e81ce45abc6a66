//! What the choices of this chapter do to its numbers: the same five configurations with each choice
//! made otherwise.

use super::{
    Configuration, Fit, aim, configurations, critical_speeds, fit_restitution, rms_log_error,
};
use crate::paper::data::*;
use plant_model::analysis::impact::{Aim, Criterion, Search};

/// The choices.
struct Variant {
    name: &'static str,
    /// Times v_t,crit that counts as whirl.
    multiple: f64,
    spin_hz: f64,
    rtol: f64,
    /// Upwards in the search, as a share of the speed.
    step: f64,
    /// Contact stiffness \[N/m\], with the restitution fitted anew where it is another.
    stiffness_n_m: f64,
}

fn variants() -> Vec<Variant> {
    let of = |name, multiple, spin_hz, rtol, step, stiffness_n_m| Variant {
        name,
        multiple,
        spin_hz,
        rtol,
        step,
        stiffness_n_m,
    };
    vec![
        of("as in the rows", 2.0, 40.0, 1e-9, 5e-3, 1e8),
        of("whirl at 1.2 v_t,crit", 1.2, 40.0, 1e-9, 5e-3, 1e8),
        of("whirl at 3 v_t,crit", 3.0, 40.0, 1e-9, 5e-3, 1e8),
        of("spin 15 Hz", 2.0, 15.0, 1e-9, 5e-3, 1e8),
        of("spin 166 Hz", 2.0, 166.0, 1e-9, 5e-3, 1e8),
        of("spin -40 Hz", 2.0, -40.0, 1e-9, 5e-3, 1e8),
        of("rtol 1e-12", 2.0, 40.0, 1e-12, 5e-3, 1e8),
        of("upwards in steps of 0.05 %", 2.0, 40.0, 1e-9, 5e-4, 1e8),
        of("k_c = 3e7 N/m, e fitted anew", 2.0, 40.0, 1e-9, 5e-3, 3e7),
        of("k_c = 1e9 N/m, e fitted anew", 2.0, 40.0, 1e-9, 5e-3, 1e9),
        of("k_c = 1e10 N/m, e fitted anew", 2.0, 40.0, 1e-9, 5e-3, 1e10),
    ]
}

impl Variant {
    /// The critical speeds of the configurations \[m/s\], after the restitution.
    fn solve(&self, fit: &Fit, five: &[Configuration; 5]) -> Result<(f64, Vec<f64>)> {
        let search = Search {
            step: self.step,
            ..Search::default()
        };
        let mut criterion = Criterion {
            whirl_multiple: self.multiple,
            ..Criterion::default()
        };
        criterion.options.rtol = self.rtol;
        let restitution = match self.stiffness_n_m == five[0].rig.contact_stiffness_n_m {
            true => fit.restitution,
            false => fit_restitution(self.stiffness_n_m)?,
        };
        let case = |configuration: &Configuration| {
            let mut rig = configuration.rig;
            rig.restitution = restitution;
            rig.contact_stiffness_n_m = self.stiffness_n_m;
            let aim = Aim {
                spin_rad_s: TAU * self.spin_hz,
                ..aim(configuration.inclination_rad)
            };
            Ok((rig.params()?, aim))
        };
        let cases = five.iter().map(case).collect::<Result<Vec<_>>>()?;
        Ok((restitution, critical_speeds(&cases, &search, &criterion)?))
    }
}

/// The table of variants; the finest search is left out of a quick run.
pub(super) fn table(fit: &Fit, extent: Extent) -> Result<Table> {
    let five = configurations(fit);
    let mut all = variants();
    all.retain(|v| extent == Extent::Full || v.step >= 5e-3);
    let solved = each(&all, |variant| variant.solve(fit, &five))?;
    Ok(table! {
        "v_r,crit with one choice made otherwise; the μ of the seals stays";
        for (variant, (restitution, speeds)) in all.iter().zip(&solved);
        "Variant" => "{}", variant.name;
        "e" => "{restitution:.3}";
        "solid disc, 0.3 % [m/s]" => "{:.4}", speeds[0];
        "solid disc, 3.5 % [m/s]" => "{:.4}", speeds[1];
        "inclined 30° [m/s]" => "{:.4}", speeds[2];
        "inclined 50° [m/s]" => "{:.4}", speeds[3];
        "seal elements [m/s]" => "{:.4}", speeds[4];
        "rms log error of the predictions" => "{:.3}", rms_log_error(&five, speeds);
    })
}
