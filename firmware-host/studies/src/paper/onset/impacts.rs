//! How many impacts it takes.

use super::Configuration;
use crate::paper::rotors::OnsetRig;
use crate::paper::{Kind, PaperError, Row, Stated, Table};
use plant_model::analysis::impact::{Criterion, Impact, run_impact};
use rayon::prelude::{IntoParallelIterator, ParallelIterator};

/// Number of impacts until v_t,crit is passed, at and above v_r,crit.
pub(super) fn until_whirl(
    five: &[Configuration; 5],
    critical: &[f64],
) -> Result<(Vec<Row>, Table), PaperError> {
    const SHARES: [f64; 6] = [1.0, 1.02, 1.05, 1.1, 1.2, 1.5];
    let counts: Vec<[Option<u32>; 6]> = (0..five.len())
        .into_par_iter()
        .map(|i| {
            let params = five[i].rig.params()?;
            let mut counts = [None; 6];
            for (count, share) in counts.iter_mut().zip(SHARES) {
                let impact = Impact {
                    speed_m_s: share * critical[i],
                    inclination_rad: five[i].inclination_rad,
                    spin_rad_s: OnsetRig::SPIN_RAD_S,
                    spin_phase_rad: 0.0,
                };
                *count = run_impact(&params, &impact, &Criterion::default())?.impacts_to_threshold;
            }
            Ok(counts)
        })
        .collect::<Result<_, PaperError>>()?;
    let row = |share: usize, note: &str| {
        let all = counts.iter().filter_map(|c| c[share]);
        let (low, high) = (all.clone().min(), all.max().map(f64::from));
        let low = low.map_or("–".to_owned(), |n| n.to_string());
        Row::new(
            (
                format!(
                    "Impacts until v_t,crit, {:.0} % above v_r,crit: most",
                    100.0 * (SHARES[share] - 1.0)
                ),
                "",
            ),
            "Results, onset phase",
            (Some(5.0), high),
            Kind::Predicted,
            format!("of the five configurations; fewest {low}; {note}"),
        )
        .stated(Stated::Between(1.0, 5.0))
    };
    let rows = vec![
        row(
            0,
            "exactly at v_r,crit the last bounces are ever smaller, which no test resolves",
        ),
        row(3, "as far above as a test series with finite steps ends"),
    ];
    let mut columns = vec!["Configuration".to_owned()];
    columns.extend(SHARES.map(|s| format!("{s} v_r,crit")));
    let table = Table {
        caption: "Impacts until the backward speed passes v_t,crit, the first included".to_owned(),
        columns,
        rows: (five.iter().zip(&counts))
            .map(|(configuration, counts)| {
                let counts = counts
                    .iter()
                    .map(|n| n.map_or("–".into(), |n| n.to_string()));
                std::iter::once(configuration.name.to_owned())
                    .chain(counts)
                    .collect()
            })
            .collect(),
    };
    Ok((rows, table))
}
