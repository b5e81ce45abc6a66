//! Chapter: how far the stator must be modelled, from rolling without slip to two masses.

use super::whirl_runs::{fastest_hz, footnote_4, ring};
use super::{
    Axis, Chapter, Chart, Curve, Drawing, Extent, Figure, Kind, Mark, PaperError, Row, Stated,
};
use plant_model::analysis::black::SteadyWhirl;
use plant_model::params::{PlantParams, SpinParams, StatorParams};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::f64::consts::TAU;

/// Contact stiffness of the levels \[N/m\].
const STIFFNESS_N_M: f64 = 1e9;
/// Contact stiffness that stands for a kinematic contact in the check of the closed form \[N/m\].
const HARD_N_M: f64 = 1e13;

/// Whirl at which rolling in a rigid stator begins \[Hz\], spin held: ω = Ω·R/c.
fn rolling_limit_hz(params: &PlantParams, spin_hz: f64) -> f64 {
    spin_hz * params.rotor.contact_radius_m / params.contact.clearance_m
}

/// The same without a drive. While it slides, μN·R brakes the spin and (μ − μ_r)·N speeds the whirl up, so
/// J·(Ω₀ − Ω) = m·v·R·μ/(μ − μ_r); at the end v = Ω·R. Shaft and damping are left out.
fn undriven_limit_hz(params: &PlantParams, spin_hz: f64) -> f64 {
    let SpinParams::Free { inertia_kg_m2, .. } = params.spin else {
        return rolling_limit_hz(params, spin_hz);
    };
    let (m, r) = (params.rotor.mass_kg, params.rotor.contact_radius_m);
    let mu = params.friction.sliding.coefficient(0.0);
    let share = mu / (mu - params.friction.rolling_coefficient);
    rolling_limit_hz(params, spin_hz) / (1.0 + m * r * r * share / inertia_kg_m2)
}

fn level(stator: StatorParams, contact_stiffness_n_m: f64) -> PlantParams {
    PlantParams {
        stator,
        ..footnote_4(contact_stiffness_n_m)
    }
}

/// Computes the chapter. Both extents give the same rows; a quick run draws fewer start speeds.
pub(super) fn chapter(extent: Extent) -> Result<Chapter, PaperError> {
    let two = footnote_4(STIFFNESS_N_M);
    let one = level(
        StatorParams::OneMass(ring(10.0, 8.9e8, 28_300.0)),
        STIFFNESS_N_M,
    );
    let rigid = level(StatorParams::Rigid, STIFFNESS_N_M);
    let hard = level(StatorParams::Rigid, HARD_N_M);
    let spins_hz: &[f64] = match extent {
        Extent::Quick => &[40.0, 166.0],
        Extent::Full => &[10.0, 20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 130.0, 166.0],
    };
    let levels = [&rigid, &one, &two];
    let all = (spins_hz.par_iter())
        .map(|spin| {
            let runs = levels.map(|params| fastest_hz(params, *spin, 0.08));
            let [rigid, one, two] = runs;
            Ok((*spin, [rigid?, one?, two?]))
        })
        .collect::<Result<Vec<(f64, [f64; 3])>, PaperError>>()?;
    let at = |spin: f64| {
        (all.iter()
            .find(|(hz, _)| *hz == spin)
            .map(|(_, whirl)| *whirl))
        .ok_or_else(|| PaperError::Missing(format!("start at {spin} Hz")))
    };
    let ([rigid_40, one_40, two_40], [rigid_166, one_166, two_166]) = (at(40.0)?, at(166.0)?);
    let (m, k) = (rigid.rotor.mass_kg, rigid.rotor.stiffness_n_m);
    let cap_hz = ((k + STIFFNESS_N_M) / m).sqrt() / TAU;
    let hard_40 = fastest_hz(&hard, 40.0, 0.02)?;
    let one_limit = SteadyWhirl::from_params(&one).and_then(|whirl| whirl.upper_limit(5000.0));
    const MEASURED_40_HZ: f64 = 530.0;
    const MEASURED_166_HZ: f64 = 400.0;
    let source = "Results, simulation";
    let factor = |quantity: &str, value: f64, note: &str| {
        Row::new(
            (quantity, ""),
            source,
            (None, Some(value)),
            Kind::Assumed,
            note,
        )
        .stated(Stated::Between(10.0, 50.0))
    };
    let rows = vec![
        factor(
            "Rolling limit without drive over measured, 40 Hz",
            undriven_limit_hz(&two, 40.0) / MEASURED_40_HZ,
            "J_r = 0.05 kg m², R_r = 0.1 m are ours",
        ),
        factor(
            "Rolling limit without drive over measured, 166 Hz",
            undriven_limit_hz(&two, 166.0) / MEASURED_166_HZ,
            "the measured 400 Hz is lowered by melting; over 530 Hz it would be a factor less than 50",
        ),
        factor(
            "Rolling limit at held spin over measured, 40 Hz",
            rolling_limit_hz(&two, 40.0) / MEASURED_40_HZ,
            "independent of J_r",
        ),
        factor(
            "Rolling limit at held spin over measured, 166 Hz",
            rolling_limit_hz(&two, 166.0) / MEASURED_166_HZ,
            "nothing brakes the spin, and no factor of 50 reaches so far",
        ),
        Row::new(
            ("Rigid stator, k_c = 1e13 N/m, from 40 Hz", "Hz"),
            "Established whirl, rigid stator",
            (None, Some(hard_40)),
            Kind::Assumed,
            format!(
                "run, 1 ms mean, in which rolling friction already brakes; closed form {:.0} Hz",
                undriven_limit_hz(&two, 40.0)
            ),
        ),
        Row::new(
            ("Rigid stator, k_c = 1e9 N/m, from 40 Hz", "Hz"),
            source,
            (Some(MEASURED_40_HZ), Some(rigid_40)),
            Kind::Assumed,
            format!("paper: rigid in no way adequate. Capped by √((k + k_c)/m) = {cap_hz:.0} Hz"),
        )
        .stated(Stated::AtLeast(MEASURED_40_HZ)),
        Row::new(
            ("Rigid stator, k_c = 1e9 N/m, from 166 Hz", "Hz"),
            source,
            (Some(MEASURED_166_HZ), Some(rigid_166)),
            Kind::Assumed,
            "still under the cap",
        )
        .stated(Stated::AtLeast(MEASURED_166_HZ)),
        Row::new(
            ("Stator of one mass, from 40 Hz", "Hz"),
            source,
            (Some(MEASURED_40_HZ), Some(one_40)),
            Kind::Assumed,
            format!(
                "inner ring on ground. Paper: better, still much too high; here {:+.1} % over two masses",
                100.0 * (one_40 / two_40 - 1.0)
            ),
        )
        .stated(Stated::AtLeast(MEASURED_40_HZ)),
        Row::new(
            ("Stator of two masses, from 40 Hz", "Hz"),
            source,
            (Some(660.0), Some(two_40)),
            Kind::Assumed,
            "paper: about 660 Hz as computed maximum, adequate. k_c = 1e9 N/m",
        ),
        Row::new(
            ("Stator of two masses, from 166 Hz over from 40 Hz", ""),
            "Fig. 7",
            (Some(1.0), Some(two_166 / two_40)),
            Kind::Assumed,
            "paper: a plateau that higher speeds do not exceed",
        ),
        Row::new(
            ("Upper whirl limit of the stator of one mass", "Hz"),
            "Results, on Black's theory",
            (None, one_limit.map(|c| c.frequency_hz())),
            Kind::Predicted,
            format!(
                "run from 166 Hz: {one_166:.0} Hz; small disturbances grow at {:.0} 1/s (stable where negative)",
                one_limit.map_or(f64::NAN, |c| c.growth_rate_s)
            ),
        ),
    ];
    Ok(Chapter {
        title: "Levels of stator model",
        story: vec![
            "Footnote 4 with a stator that is rolled in without slip, rigid with a contact stiffness, one mass, two masses. Start at the wall with 0.4 m/s, no drive, k_c = 1e9 N/m, J_r = 0.05 kg m², R_r = 0.1 m; whirl frequency as a 1 ms mean.".to_owned(),
            "The rolling limit grows with the spin and is tens of times too high. A rigid stator with a contact stiffness stays below √((k + k_c)/m), and so is capped by a constant that the paper does not give. Stators with masses stop at Black's limit. The step from one mass to two is small with these constants, smaller than the paper's words suggest.".to_owned(),
        ],
        rows,
        tables: vec![],
        figures: vec![figure(&two, cap_hz, &all)],
    })
}

fn figure(two: &PlantParams, cap_hz: f64, all: &[(f64, [f64; 3])]) -> Figure {
    let curve = |name: &str, points, mark, colour| Curve {
        name: name.to_owned(),
        points,
        mark,
        colour,
    };
    let runs = |level: usize| {
        all.iter()
            .map(|(spin, whirl)| (*spin, whirl[level]))
            .collect()
    };
    let limit =
        |f: fn(&PlantParams, f64) -> f64| [5.0, 170.0].map(|spin| (spin, f(two, spin))).to_vec();
    Figure {
        file: "levels",
        caption: "Fastest whirl over the speed at the start, by level of stator model.".to_owned(),
        drawing: Drawing::Chart(Chart {
            label: "Fastest whirl over start speed by level of stator model".to_owned(),
            x: Axis {
                name: "Spin at the start [Hz]".to_owned(),
                range: (5.0, 175.0),
                log: false,
            },
            y: Axis {
                name: "Fastest whirl [Hz]".to_owned(),
                range: (300.0, 1e5),
                log: true,
            },
            curves: vec![
                curve(
                    "rolling, spin held",
                    limit(rolling_limit_hz),
                    Mark::Dashed,
                    5,
                ),
                curve("rolling, no drive", limit(undriven_limit_hz), Mark::Line, 5),
                curve(
                    "√((k + k_c)/m)",
                    vec![(5.0, cap_hz), (170.0, cap_hz)],
                    Mark::Dashed,
                    1,
                ),
                curve("rigid with k_c = 1e9 N/m", runs(0), Mark::Line, 1),
                curve("one mass", runs(1), Mark::Line, 2),
                curve("two masses", runs(2), Mark::Line, 0),
                curve(
                    "measured",
                    vec![(40.0, 530.0), (166.0, 400.0)],
                    Mark::Crosses,
                    3,
                ),
            ],
        }),
    }
}
