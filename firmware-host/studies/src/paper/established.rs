//! Established whirl: how fast, with what force, for how long.

mod falling;
pub(super) mod figures;
mod pareto;
pub(super) mod rig;
mod tables;

use self::falling::Law;
use self::pareto::Search;
pub use self::rig::Violence;
use super::{Chapter, Extent, Figure, Kind, PaperError, Row, Stated, rotors};
use plant_model::analysis::black::SteadyWhirl;
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};

/// Speeds of the tests \[Hz\]; the first four and the last are in every extent.
const SPEEDS_HZ: [f64; 13] = [
    15.0, 40.0, 80.0, 120.0, 166.0, 20.0, 30.0, 50.0, 60.0, 70.0, 100.0, 140.0, 150.0,
];

/// Spin-downs from all speeds, stator isotropic and anisotropic, in order of speed.
#[derive(Debug, Clone, PartialEq)]
pub struct SpinDowns {
    /// Stiffness and damping of the stator alike in x and y.
    pub isotropic: Vec<Violence>,
    /// 10 % apart from the mean.
    pub anisotropic: Vec<Violence>,
}

/// Runs the spin-downs.
///
/// # Errors
/// [`PaperError`]: a run fails or does not whirl.
pub fn spin_downs(extent: Extent) -> Result<SpinDowns, PaperError> {
    let number = if extent == Extent::Quick { 5 } else { 13 };
    let mut speeds = SPEEDS_HZ[..number].to_vec();
    speeds.sort_by(f64::total_cmp);
    let of = |params: &plant_model::params::PlantParams| {
        (speeds.par_iter())
            .map(|hz| rig::violence(params, *hz, 0.4))
            .collect::<Result<Vec<_>, _>>()
    };
    let isotropic = rotors::footnote_4();
    Ok(SpinDowns {
        isotropic: of(&isotropic)?,
        anisotropic: of(&rig::anisotropic(isotropic))?,
    })
}

/// The chapter.
///
/// # Errors
/// [`PaperError`]: a run fails or something looked for is not there.
pub fn chapter(extent: Extent) -> Result<Chapter, PaperError> {
    let (runs, (search, (laws, constant))) = rayon::join(
        || spin_downs(extent),
        || {
            rayon::join(
                || pareto::search(extent),
                || rayon::join(falling::laws, falling::critical_with_constant_friction_m_s),
            )
        },
    );
    let (runs, search, laws, constant) = (runs?, search?, laws?, constant?);
    let used = (laws.get(2)).ok_or_else(|| PaperError::Missing("no friction law".to_owned()))?;
    let limit_hz = SteadyWhirl::from_params(&rotors::footnote_4())
        .and_then(|whirl| whirl.upper_limit(5000.0))
        .map(|circle| circle.frequency_hz())
        .ok_or_else(|| PaperError::Missing("no upper whirl limit".to_owned()))?;
    let mut rows = spin_down_rows(&runs, &search)?;
    rows.extend(nearest_rows(&search));
    rows.extend(fast_rows(used, constant));
    Ok(Chapter {
        title: "Established whirl",
        story: story(&search, used),
        rows,
        tables: vec![
            tables::violence(&runs, limit_hz),
            search.table,
            tables::laws(&laws, constant),
        ],
        figures: vec![
            figures::whirl_over_spin(&runs, limit_hz),
            figures::force_over_spin(&runs),
            figures::torque_over_spin(&runs),
            figures::displacement_over_spin(&runs),
            figures::fast_test(&used.course),
        ]
        .into_iter()
        .collect::<Vec<Figure>>(),
    })
}

fn story(search: &Search, law: &Law) -> Vec<String> {
    let near = &search.nearest;
    let met = match search.met {
        0 => "no set meets all four".to_owned(),
        n => format!("{n} sets meet all four"),
    };
    vec![
        "Rotor and two-mass stator of footnote 4. The paper leaves out k_c, d_c, J and R; used are \
         k_c = 1e9 N/m, d_c = 1.6e4 N s/m, J = 0.05 kg m², R = 0.1 m (disc of 200 mm). Start at the wall with \
         0.4 m/s outwards, spin free, no drive, relative tolerance 1e-9 (1e-6 gives the same digits). Whirl \
         frequency: rate of the contact angle over a centred window of 1 ms. Anisotropy: stiffness and damping \
         of both rings +10 % in x, −10 % in y."
            .to_owned(),
        format!(
            "k_c, d_c and J were searched over {} sets for the plateau of 660 Hz, the bound of 0.05 mm on the \
             outer ring, 12 ms to standstill from 40 Hz and a maximum that no longer rises (less than 2 % from 80 to \
             166 Hz): {met}; {} meet all but the last. J = 0.05 kg m² is the whole mass as a solid disc; with less, \
             spin ends before a soft contact lets the ring move far, but then the maximum still rises with speed. \
             Nearest in the first three: k_c = {:.0e} N/m, d_c = {:.0} N s/m, J = {} kg m², with a rise of {:.1} % (rows \"nearest set\"). \
             Which set the rig had cannot be told from the paper.",
            search.tried,
search.met_three,
near.left_out.contact_stiffness_n_m,
near.left_out.contact_damping_n_s_m,
near.left_out.inertia_kg_m2,
100.0 * near.rise
        ),
        format!(
            "The test at 166 Hz: μ = μ_∞ + (0.15 − μ_∞)·exp(−v/v_0), v the sliding speed. μ_∞ = {:.4} was fitted to \
             0.8 s (from a start with 0.4 m/s against the spin as well); v_0 = {} m/s is assumed (table: other v_0). The whirl frequency follows. The same law \
             cannot give 12 ms from 40 Hz: friction fell with time in contact (melting), not with speed alone. \
             Heat is not modelled.",
            law.at_speed, law.speed_scale_m_s
        ),
    ]
}

fn spin_down_rows(runs: &SpinDowns, search: &Search) -> Result<Vec<Row>, PaperError> {
    let at = |hz: f64| {
        (runs.isotropic.iter().find(|v| v.spin_hz == hz))
            .ok_or_else(|| PaperError::Missing(format!("no run from {hz} Hz")))
    };
    let (slow, middle, fast) = (at(40.0)?, at(80.0)?, at(166.0)?);
    let anisotropic = (runs.anisotropic.iter().find(|v| v.spin_hz == 166.0))
        .ok_or_else(|| PaperError::Missing("no anisotropic run".to_owned()))?;
    let assumed = |what: &str, unit, source, paper: Option<f64>, computed: f64, note: String| {
        Row::new(
            (what, unit),
            source,
            (paper, Some(computed)),
            Kind::Assumed,
            note,
        )
    };
    let unnamed = |what: &str, unit, computed: f64| {
        let note = "the paper calls force and torque fatal, without a number";
        assumed(
            what,
            unit,
            "Results; Conclusions",
            None,
            computed,
            note.to_owned(),
        )
    };
    let plateau = if search.met == 0 {
        "hangs on k_c and J; sets nearer to 660 Hz miss ring, standstill or the plateau itself (Pareto table)"
    } else {
        "hangs on k_c and J (Pareto table)"
    };
    Ok(vec![
        assumed(
            "Plateau of the maximum whirl frequency (166 Hz)",
            "Hz",
            "Results, simulation",
            Some(660.0),
            fast.whirl_hz,
            plateau.to_owned(),
        ),
        assumed(
            "The same, anisotropic stator",
            "Hz",
            "Results, simulation; footnote 4",
            Some(660.0),
            anisotropic.whirl_hz,
            format!(
                "the paper does not say which calculations had it; outer ring then {:.3} mm",
                1e3 * anisotropic.displacement_m[2]
            ),
        ),
        assumed(
            "Rise of the maximum from 80 to 166 Hz",
            "%",
            "Fig. 7",
            None,
            100.0 * (fast.whirl_hz / middle.whirl_hz - 1.0),
            "paper: not exceeded at higher speed; constant μ".to_owned(),
        ),
        assumed(
            "Maximum whirl frequency from 40 Hz (measured)",
            "Hz",
            "Results, test at 40 Hz",
            Some(530.0),
            slow.whirl_hz,
            "the paper's own model exceeds its tests too: 660 Hz as maximum".to_owned(),
        ),
        assumed(
            "Standstill from 40 Hz",
            "s",
            "Results, test at 40 Hz",
            Some(0.012),
            slow.standstill_s,
            "90 % of the speed to 2 Hz".to_owned(),
        ),
        assumed(
            "Spin at the maximum, from 40 Hz",
            "Hz",
            "Results, test at 40 Hz",
            Some(2.0),
            slow.spin_at_middle_hz,
            format!(
                "middle of the window of 1 ms, in which the spin falls fast; {:.1} Hz at its end, where slip ends",
                slow.spin_at_end_hz
            ),
        ),
        assumed(
            "Outer ring, from 40 Hz",
            "mm",
            "Results, test at 40 Hz",
            Some(0.05),
            1e3 * slow.displacement_m[2],
            "paper: order of magnitude; a bound in its fit".to_owned(),
        )
        .stated(Stated::AtMost(0.05)),
        assumed(
            "Outer ring, from 166 Hz",
            "mm",
            "Results, simulation",
            Some(0.05),
            1e3 * fast.displacement_m[2],
            "the paper's fit kept it within the measured value".to_owned(),
        )
        .stated(Stated::AtMost(0.05)),
        assumed(
            "Rotor, from 40 Hz: displacement over clearance",
            "",
            "Results, test at 40 Hz",
            None,
            slow.displacement_m[0] / rig::CLEARANCE_M,
            "paper: considerably larger than 1".to_owned(),
        )
        .stated(Stated::AtLeast(1.0)),
        unnamed("Peak normal force, from 40 Hz", "kN", 1e-3 * slow.force_n),
        unnamed("Peak normal force, from 166 Hz", "kN", 1e-3 * fast.force_n),
        unnamed("Peak friction torque, from 40 Hz", "N m", slow.torque_n_m),
        unnamed("Peak friction torque, from 166 Hz", "N m", fast.torque_n_m),
    ])
}

/// What the set gives that comes nearest in plateau, ring and standstill.
fn nearest_rows(search: &Search) -> Vec<Row> {
    const CHOSEN: &str = "k_c and J chosen for plateau, ring and standstill";
    let near = &search.nearest;
    let (plateau_hz, ring_m, standstill_s) = pareto::PAPER;
    let row = |what: &str, unit, source, (paper, computed): (f64, f64), kind, note: &str| {
        let name = format!("Nearest set: {what}");
        Row::new(
            (name, unit),
            source,
            (Some(paper), Some(computed)),
            kind,
            note,
        )
    };
    let constant = |what: &str, unit, value: f64| {
        let name = format!("Nearest set: {what}");
        Row::new(
            (name, unit),
            "not in the paper",
            (None, Some(value)),
            Kind::Fitted,
            CHOSEN,
        )
    };
    vec![
        row(
            "maximum whirl frequency (166 Hz)",
            "Hz",
            "Results, simulation",
            (plateau_hz, near.plateau_hz),
            Kind::Fitted,
            CHOSEN,
        ),
        row(
            "outer ring, larger of 40 and 166 Hz",
            "mm",
            "Results, test at 40 Hz",
            (1e3 * ring_m, 1e3 * near.ring_m),
            Kind::Fitted,
            CHOSEN,
        )
        .stated(Stated::AtMost(0.05)),
        row(
            "standstill from 40 Hz",
            "s",
            "Results, test at 40 Hz",
            (standstill_s, near.standstill_s),
            Kind::Fitted,
            CHOSEN,
        ),
        row(
            "maximum whirl frequency from 40 Hz (measured)",
            "Hz",
            "Results, test at 40 Hz",
            (530.0, near.slow_hz),
            Kind::Predicted,
            "not chosen for; its maximum keeps rising with speed (Pareto table)",
        ),
        constant("k_c", "N/m", near.left_out.contact_stiffness_n_m),
        constant("J_r", "kg m²", near.left_out.inertia_kg_m2),
    ]
}

fn fast_rows(law: &Law, constant: [f64; 2]) -> Vec<Row> {
    const SOURCE: &str = "Results, test at 166 Hz";
    let row = |what: &str, unit, paper: Option<f64>, computed: f64, kind, note: String| {
        Row::new((what, unit), SOURCE, (paper, Some(computed)), kind, note)
    };
    vec![
        row(
            "166 Hz: μ_∞ of the falling friction", "", None, law.at_speed,
            Kind::Fitted, "fitted to the time to standstill alone".to_owned(),
        ),
        row(
            "166 Hz: standstill", "s", Some(falling::PAPER_STANDSTILL_S), law.standstill_s[0],
            Kind::Fitted, format!("90 % of the speed to 2 Hz; μ_∞ = {:.4} chosen for it", law.at_speed),
        ),
        row(
            "166 Hz: whirl frequency (median, 90 % to 10 % of the spin)", "Hz", Some(400.0), law.median_hz,
            Kind::Predicted, "μ_∞ was fitted to the time only; v_0 assumed".to_owned(),
        ),
        row(
            "166 Hz: maximum whirl frequency", "Hz", Some(400.0), law.largest_hz,
            Kind::Assumed, "miss: as sliding ends μ rises to 0.15 again; a molten surface would not let it".to_owned(),
        ),
        row(
            "166 Hz: lowest whirl frequency meanwhile", "Hz", Some(100.0), law.lowest_hz,
            Kind::Predicted, "miss: with a law of speed alone the whirl is steady; intervals need μ that changes in time (melting)".to_owned(),
        ),
        row(
            "Excitation for whirl, 166 against 40 Hz, falling μ", "", None,
            law.critical_m_s[1] / law.critical_m_s[0], Kind::Assumed,
            format!(
                "radial impact {:.2} against {:.2} m/s; paper: considerably higher; hangs on v_0",
                law.critical_m_s[1], law.critical_m_s[0]
            ),
        )
        .stated(Stated::AtLeast(1.0)),
        row(
            "The same, constant μ", "", None, constant[1] / constant[0], Kind::Assumed,
            format!("{:.3} against {:.3} m/s: spin alone does not matter", constant[1], constant[0]),
        ),
    ]
}
