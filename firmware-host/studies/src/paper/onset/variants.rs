//! What the choices of this chapter do to its numbers: the same five configurations with each choice
//! made otherwise.

use super::{Configuration, Fit, configurations, fit_restitution, rms_log_error};
use crate::paper::rotors::OnsetRig;
use crate::paper::{Extent, PaperError, Table};
use plant_model::Options;
use plant_model::analysis::impact::{Criterion, Search, critical_speed_m_s};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::f64::consts::TAU;

/// One choice made otherwise.
struct Variant {
    name: String,
    criterion: Criterion,
    search: Search,
    spin_hz: f64,
    /// Contact stiffness, with the restitution fitted anew.
    contact_stiffness_n_m: Option<f64>,
}

fn variants(extent: Extent) -> Vec<Variant> {
    let base = |name: String| Variant {
        name,
        criterion: Criterion::default(),
        search: Search::default(),
        spin_hz: OnsetRig::SPIN_RAD_S / TAU,
        contact_stiffness_n_m: None,
    };
    let mut all = vec![base("as in the rows".to_owned())];
    for whirl_multiple in [1.2, 3.0] {
        let mut variant = base(format!("whirl at {whirl_multiple} v_t,crit"));
        variant.criterion.whirl_multiple = whirl_multiple;
        all.push(variant);
    }
    for spin_hz in [15.0, 166.0, -40.0] {
        all.push(Variant {
            spin_hz,
            ..base(format!("spin {spin_hz} Hz"))
        });
    }
    let mut variant = base("rtol 1e-12".to_owned());
    variant.criterion.options = Options {
        rtol: 1e-12,
        ..Options::default()
    };
    all.push(variant);
    if extent == Extent::Full {
        let mut variant = base("upwards in steps of 0.05 %".to_owned());
        variant.search.step = 5e-4;
        all.push(variant);
    }
    for (stiffness, name) in [(3e7, "3e7"), (1e9, "1e9"), (1e10, "1e10")] {
        all.push(Variant {
            contact_stiffness_n_m: Some(stiffness),
            ..base(format!("k_c = {name} N/m, e fitted anew"))
        });
    }
    all
}

/// The table of variants.
pub(super) fn table(fit: &Fit, extent: Extent) -> Result<Table, PaperError> {
    let five = configurations(fit);
    let rows = (variants(extent).par_iter())
        .map(|variant| {
            let restitution = match variant.contact_stiffness_n_m {
                Some(k_c) => fit_restitution(k_c)?,
                None => fit.restitution,
            };
            let critical: Vec<f64> = (five.iter())
                .map(|configuration| critical(variant, configuration, restitution))
                .collect::<Result<_, _>>()?;
            let mut cells = vec![variant.name.clone(), format!("{restitution:.3}")];
            cells.extend(critical.iter().map(|v| format!("{v:.4}")));
            cells.push(format!("{:.3}", rms_log_error(&five, &critical)));
            Ok(cells)
        })
        .collect::<Result<_, PaperError>>()?;
    let mut columns = vec!["Variant".to_owned(), "e".to_owned()];
    columns.extend(five.iter().map(|c| format!("{} [m/s]", c.name)));
    columns.push("rms log error of the predictions".to_owned());
    Ok(Table {
        caption: "v_r,crit with one choice made otherwise; the μ of the seals stays".to_owned(),
        columns,
        rows,
    })
}

fn critical(
    variant: &Variant,
    configuration: &Configuration,
    restitution: f64,
) -> Result<f64, PaperError> {
    let mut rig = OnsetRig {
        restitution,
        ..configuration.rig
    };
    if let Some(k_c) = variant.contact_stiffness_n_m {
        rig.contact_stiffness_n_m = k_c;
    }
    let at = (configuration.inclination_rad, TAU * variant.spin_hz);
    critical_speed_m_s(&rig.params()?, at, &variant.search, &variant.criterion)?
        .ok_or_else(|| PaperError::Missing("no impact speed that ends in whirl".to_owned()))
}
