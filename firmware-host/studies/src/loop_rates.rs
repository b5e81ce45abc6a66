//! What a slower call of the supervisor costs: the impacts and whirls it recovers from, by the rate of the loop.

use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use crate::machines::plants::{PlantCase, RATES_HZ, plants};
use crate::machines::tuned_gains::{TunedGains, stored};
use crate::overloads::contenders::Contender;
use crate::overloads::plan::CatalogueError;
use crate::overloads::sweeps::{median, row, sweep};
use crate::overloads::tune;
use crate::trials::Compared;
use firmware_bench::run::closed_loop::RunError;

/// Rates of the table \[Hz\].
const TABLE_HZ: [f64; 4] = [5e3, 1e4, 2e4, 5e4];
/// The usual one among them.
const USUAL: usize = 2;

/// Gains tuned at the plant's rate, as the catalogue tunes them; laws of the reference have no part in this.
fn gains(case: &PlantCase) -> Result<TunedGains, CatalogueError> {
    let none = || CatalogueError::NotFound {
        plant: case.name.clone(),
        rate_hz: case.rate_hz,
    };
    let tuned = tune::tuned(&case.scene).map_err(failed(case, "search"))?;
    Ok(TunedGains {
        tuned: tuned.ok_or_else(none)?,
        ..stored(&case.name, RATES_HZ[1]).ok_or_else(none)?
    })
}

fn failed<'a>(
    case: &'a PlantCase,
    policy: &'static str,
) -> impl Fn(RunError) -> CatalogueError + 'a {
    move |reason| CatalogueError::Run {
        plant: case.name.clone(),
        policy,
        reason,
    }
}

/// Medians of the hardest impact \[m/s\] and the fastest whirl (share of v_lim) on a plant.
#[derive(Debug, Clone, Copy)]
pub struct Recovered {
    /// Under the best levitation controller of this rate.
    pub tuned: [f64; 2],
    /// Under the supervisor in front of it.
    pub own: [f64; 2],
}

/// A plant of the catalogue in a loop of some rate.
///
/// # Errors
/// [`CatalogueError`] where a run cannot be trusted.
pub fn recovered(case: &PlantCase, seeds: u64) -> Result<Recovered, CatalogueError> {
    let gains = gains(case)?;
    let of = |contender: Contender| {
        let points = (1..=seeds)
            .map(|seed| {
                sweep(case, &gains, (contender, seed)).map_err(failed(case, contender.name()))
            })
            .collect::<Result<Vec<_>, _>>()?;
        let row = row(case, contender, &points);
        Ok::<_, CatalogueError>([median(&row.impact_m_s), median(&row.whirl_share)])
    };
    Ok(Recovered {
        tuned: of(Contender::Tuned)?,
        own: of(Contender::Supervisor)?,
    })
}

/// Every plant at the rates of the table, and the catalogue's scenes at the lower three. Quick takes one seed and leaves
/// the scenes out.
///
/// # Errors
/// [`CatalogueError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let mut cases = Vec::new();
    for rate_hz in TABLE_HZ {
        cases.extend(plants(rate_hz)?);
    }
    let seeds = extent.pick(1, 3);
    let all = run_all(&cases, progress, |case| recovered(case, seeds))
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    let number = cases.len() / TABLE_HZ.len();
    let of = |plant: usize| -> [Recovered; TABLE_HZ.len()] {
        std::array::from_fn(|rate| all[rate * number + plant])
    };
    let mut claims = Vec::new();
    let mut rows = Vec::new();
    for (plant, case) in cases.iter().take(number).enumerate() {
        let rates = of(plant);
        let usual = rates[USUAL];
        for (least, of, khz) in [
            (0.78, rates[0], 5),
            (0.90, rates[1], 10),
            (1.0, rates[3], 50),
        ] {
            let name = format!("{}: impact at {khz} kHz, over that at 20 kHz", case.name);
            claims.push(Claim::at_least(name, least, of.own[0] / usual.own[0]));
        }
        let name = format!("{}: impact at 5 kHz, over levitation at 20 kHz", case.name);
        claims.push(Claim::at_least(name, 1.0, rates[0].own[0] / usual.tuned[0]));
        let impacts = rates.map(|of| format!("{:.3}", of.own[0]));
        let whirls = rates.map(|of| format!("{:.2}", of.own[1]));
        let [a, b, c, d] = impacts;
        let [e, f, g, h] = whirls;
        rows.push([
            case.name.clone(),
            format!("{:.3}", usual.tuned[0]),
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            h,
        ]);
    }
    let mut chapters = vec![Chapter::new(
        "Hardest impact and fastest whirl by the rate of the loop",
        vec![
            Block::text(format!(
                "Hardest impact recovered from [m/s], and whirl arrested at take-over as a share of v_lim, on grids of 5 % and of 0.01; medians of {seeds} seeds. The levitation controller is tuned anew at every rate."
            )),
            Block::table(
                [
                    "plant",
                    "levitation, 20 kHz",
                    "5 kHz",
                    "10 kHz",
                    "20 kHz",
                    "50 kHz",
                    "whirl, 5 kHz",
                    "10 kHz",
                    "20 kHz",
                    "50 kHz",
                ],
                rows,
            ),
        ],
    )];
    let mut scenes_run = 0;
    if extent == Extent::Full {
        let cases = &cases[..(USUAL + 1) * number];
        let compared = run_all(cases, progress, |case| {
            Ok::<_, CatalogueError>(Compared::on(case, &gains(case)?, &case.name))
        });
        let compared = compared.into_iter().collect::<Result<Vec<_>, _>>()?;
        let by_rate: Vec<Compared> = (compared.chunks(number))
            .map(|of| of.iter().cloned().fold(Compared::default(), Compared::and))
            .collect();
        scenes_run = by_rate.iter().map(|of| of.runs).sum();
        chapters.push(scenes(&by_rate, &mut claims));
    }
    Ok(Report {
        classes: Vec::new(),
        title: "Rates of the loop".to_owned(),
        claims,
        cases: (all.len() + scenes_run) as u64,
        chapters,
    })
}

fn scenes(by_rate: &[Compared], claims: &mut Vec<Claim>) -> Chapter {
    let rates = || TABLE_HZ.iter().zip(by_rate);
    for ((hz, of), most) in rates().zip([1.0, 0.0, 0.0]) {
        let name = format!("scenes at {:.0} kHz: lost to levitation alone", 1e-3 * hz);
        claims.push(Claim::at_most(name, most, of.lost.len() as f64));
    }
    let rows = rates().map(|(hz, of)| {
        [
            format!("{:.0}", 1e-3 * hz),
            of.runs.to_string(),
            of.alone.to_string(),
            of.own.to_string(),
            of.lost.join("; "),
        ]
    });
    Chapter::new(
        "The catalogue's scenes by the rate of the loop",
        vec![Block::table(
            [
                "rate [kHz]",
                "runs",
                "levitation alone",
                "supervisor",
                "lost",
            ],
            rows,
        )],
    )
}
