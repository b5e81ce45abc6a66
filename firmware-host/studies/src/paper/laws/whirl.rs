//! Established whirl: spin-down by both laws, and held spin against Black's limit.

use super::{matched_at_force, matched_at_impact, with_law};
use crate::paper::data::*;
use crate::paper::rotors::footnote_4_at;
use crate::paper::runs::{HELD_SPIN_HZ, IMPACT_M_S, Settled, Violence, settled, violence};
use plant_model::analysis::black::{Circle, SteadyWhirl};
use plant_model::params::HuntCrossley;

/// Contact stiffness of the linear law \[N/m\], and one with which it has no upper limit.
const STIFFNESS_N_M: f64 = 1e9;
const SOFT_N_M: f64 = 3e8;

/// Normal force \[N\] of a steady whirl whose force is `hard` without deformation: with R = c/N_hard the
/// distance per force, N·R = c + (N/k_h)^(1/n). Its left side overtakes the right one once, for n > 1
/// whatever k_h.
fn steady_force_n(hard: &Circle, clearance_m: f64, law: &HuntCrossley) -> Result<f64> {
    let per_force = clearance_m / hard.normal_force_n;
    let short =
        |n: f64| n * per_force < clearance_m + (n / law.stiffness_n_mn).powf(1.0 / law.exponent);
    let mut high = hard.normal_force_n;
    while short(high) && high.is_finite() {
        high *= 2.0;
    }
    Ok(halved((0.0, high), |high| 1e-15 * high, |n| Ok(short(n)))?.1)
}

/// Footnote 4 with a contact law, held at its spin.
struct Held {
    name: &'static str,
    params: PlantParams,
    end: Settled,
    /// N by the closed form \[N\], of a nonlinear law.
    force_n: Option<f64>,
}

/// Adds the runs: of the linear law, and of the nonlinear one matched at the impact, at the plateau; held spin also with a
/// soft contact.
pub(super) fn add(chapter: &mut Chapter, extent: Extent) -> Result<()> {
    let linear = footnote_4_at(STIFFNESS_N_M);
    let soft = footnote_4_at(SOFT_N_M);
    let mut black = SteadyWhirl::from_params(&linear).or_missing("no isotropic stator")?;
    black.normal_compliance_m_n = 0.0;
    let limit = black.upper_limit(5000.0).or_missing("no upper limit")?;
    let limit_hz = limit.frequency_hz();
    let steady_n = settled(&linear)?.normal_force_n;
    let laws = [
        ("linear, k_c = 1e9 N/m", linear, None),
        (
            "matched at the impact",
            linear,
            Some(matched_at_impact(&linear, IMPACT_M_S)?),
        ),
        (
            "matched at the plateau",
            linear,
            Some(matched_at_force(&linear, steady_n)?),
        ),
        ("linear, k_c = 3e8 N/m", soft, None),
        (
            "matched to it at the impact",
            soft,
            Some(matched_at_impact(&soft, IMPACT_M_S)?),
        ),
    ];
    let held = each(&laws, |(name, params, law)| {
        let params = law.map_or(*params, |law| with_law(params, law));
        let force_n = law.map(|law| steady_force_n(&limit, params.contact.clearance_m, &law));
        Ok(Held {
            name,
            params,
            end: settled(&params)?,
            force_n: force_n.transpose()?,
        })
    })?;
    let spins_hz: &[f64] = match extent {
        Extent::Quick => &[40.0, 166.0],
        Extent::Full => &[40.0, 80.0, 166.0],
    };
    let of_law = |held| spins_hz.iter().map(move |hz| (held, *hz));
    let cases: Vec<(&Held, f64)> = held[..3].iter().flat_map(of_law).collect();
    let downs = each(&cases, |(of, hz)| violence(&of.params, *hz, 0.4))?;
    let of_law = |law: usize| {
        [
            downs[law * spins_hz.len()],
            downs[(law + 1) * spins_hz.len() - 1],
        ]
    };
    chapter
        .rows
        .extend(rows(&held, of_law(0), of_law(1), limit_hz));
    chapter.tables.push(table! {
        "Spin-down of footnote 4 from 0.4 m/s by contact law (Hertz's exponent, λ matched as well)";
        for ((of, _), run) in cases.iter().zip(&downs);
        "Law" => "{}", of.name;
        "From [Hz]" => "{:.0}", run.spin_hz;
        "Fastest whirl [Hz]" => "{:.1}", run.whirl_hz;
        "Peak force [kN]" => "{:.1}", 1e-3 * run.force_n;
        "Outer ring [mm]" => "{:.4}", 1e3 * run.displacement_m[2];
        "Standstill [ms]" => "{:.2}", 1e3 * run.standstill_s;
    });
    chapter.tables.push(table! {
        "Whirl at a held spin of {HELD_SPIN_HZ} Hz after 0.3 s; Black's limit {limit_hz:.2} Hz";
        for of in &held;
        "Law" => "{}", of.name;
        "Whirl [Hz]" => "{:.2}", of.end.whirl_hz;
        "" => "{}", of.end.state();
        "N [kN]" => "{:.2}", 1e-3 * of.end.normal_force_n;
        "N closed form [kN]" => "{}", or_dash(of.force_n.map(|n| 1e-3 * n), 2);
    });
    Ok(())
}

/// Of the law matched at the impact, beside the linear one; spin-downs from 40 Hz and from 166 Hz.
fn rows(held: &[Held], linear: [Violence; 2], matched: [Violence; 2], limit_hz: f64) -> Vec<Row> {
    const BLACK: &str = "Results, on Black's theory";
    const TEST: &str = "Results, test at 40 Hz";
    let ([plain_slow, plain], [slow, fast]) = (linear, matched);
    let (plain_end, end) = (&held[0].end, &held[1].end);
    let closed_kn = 1e-3 * held[1].force_n.unwrap_or(f64::NAN);
    rows! {
        "Whirl at held spin, Hunt and Crossley", "Hz", BLACK, Silent => end.whirl_hz, Predicted,
            "matched at the impact; Black's limit {limit_hz:.1} Hz, in which only f_n matters; linear {:.1} Hz", plain_end.whirl_hz;
        "Its normal force", "kN", BLACK, Silent => 1e-3 * end.normal_force_n, Predicted,
            "closed form {closed_kn:.3} kN; linear {:.3} kN. Matched at the impact the contact gives way less under such a force", 1e-3 * plain_end.normal_force_n;
        "Plateau: fastest whirl from 166 Hz, Hunt and Crossley", "Hz", "figure 7, simulation", 660.0 => fast.whirl_hz, Assumed,
            "matched at the impact of {IMPACT_M_S} m/s; linear {:.1} Hz", plain.whirl_hz;
        "Fastest whirl from 40 Hz, Hunt and Crossley", "Hz", TEST, 530.0 => slow.whirl_hz, Assumed, "the same; linear {:.1} Hz", plain_slow.whirl_hz;
        "Outer ring from 166 Hz, Hunt and Crossley", "mm", TEST, 0.05 => 1e3 * fast.displacement_m[2], Assumed, "linear {:.4} mm", 1e3 * plain.displacement_m[2];
        "Peak force from 166 Hz, Hunt and Crossley", "kN", "footnote 2", Silent => 1e-3 * fast.force_n, Assumed, "linear {:.1} kN", 1e-3 * plain.force_n;
    }
}
