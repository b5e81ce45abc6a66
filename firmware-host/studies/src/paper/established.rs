//! Established whirl: how fast, with what force, for how long.

mod falling;
mod pareto;

use self::falling::{Law, Laws, PAPER_STANDSTILL_S};
use self::pareto::{PLATEAU_HZ, RING_M, STANDSTILL_S, Search};
use super::data::*;
use super::rotors::footnote_4;
use super::runs::{Violence, violence};
use plant_model::V2;
use plant_model::analysis::black::SteadyWhirl;
use plant_model::params::StatorParams;

/// Speeds of the tests \[Hz\]; the first four and the last are in every extent.
const SPEEDS_HZ: [f64; 13] = [
    15.0, 40.0, 80.0, 120.0, 166.0, 20.0, 30.0, 50.0, 60.0, 70.0, 100.0, 140.0, 150.0,
];

/// Footnote 4 with stiffness and damping of both rings 10 % up along x and 10 % down along y.
fn anisotropic() -> PlantParams {
    let mut params = footnote_4();
    if let StatorParams::TwoMass { inner, outer } = &mut params.stator {
        let factor = V2::new(1.1, 0.9);
        for ring in [inner, outer] {
            ring.stiffness_n_m.component_mul_assign(&factor);
            ring.damping_n_s_m.component_mul_assign(&factor);
        }
    }
    params
}

/// Spin-downs from all speeds, in order of speed.
struct SpinDowns {
    isotropic: Vec<Violence>,
    anisotropic: Vec<Violence>,
    /// Black's limit of the isotropic stator.
    limit_hz: f64,
}

impl SpinDowns {
    fn run(extent: Extent) -> Result<Self> {
        let mut speeds = SPEEDS_HZ[..extent.pick(5, 13)].to_vec();
        speeds.sort_by(f64::total_cmp);
        let of = |params: &PlantParams| each(&speeds, |hz| violence(params, *hz, 0.4));
        let limit = SteadyWhirl::from_params(&footnote_4()).and_then(|w| w.upper_limit(5000.0));
        Ok(Self {
            isotropic: of(&footnote_4())?,
            anisotropic: of(&anisotropic())?,
            limit_hz: limit.or_missing("no upper whirl limit")?.frequency_hz(),
        })
    }
}

fn from(of: &[Violence], spin_hz: f64) -> Result<Violence> {
    let found = of.iter().find(|v| v.spin_hz == spin_hz).copied();
    found.or_missing(format!("no run from {spin_hz} Hz"))
}

/// The chapter.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let (runs, (search, laws)) = rayon::join(
        || SpinDowns::run(extent),
        || rayon::join(|| pareto::search(extent), Laws::fit),
    );
    let (runs, search, laws) = (runs?, search?, laws?);
    let used = laws.used()?;
    let mut rows = spin_down_rows(&runs, &search)?;
    rows.extend(nearest_rows(&search));
    rows.extend(fast_rows(used, laws.constant_m_s));
    let mut figures = figures(&runs);
    figures.push(used.figure());
    Ok(Chapter {
        title: "Established whirl",
        story: story(&search, used),
        rows,
        tables: vec![spin_downs(&runs), search.table(), laws.table()],
        figures,
    })
}

fn story(search: &Search, law: &Law) -> Vec<String> {
    let near = &search.nearest;
    let met = match search.met {
        0 => "no set meets all four".to_owned(),
        n => format!("{n} sets meet all four"),
    };
    vec![
        "Rotor and two-mass stator of footnote 4. The paper leaves out k_c, d_c, J and R; used are k_c = 1e9 N/m, d_c = 1.6e4 N s/m, J = 0.05 kg m², R = 0.1 m (disc of 200 mm). Start at the wall with 0.4 m/s outwards, spin free, no drive, relative tolerance 1e-9 (1e-6 gives the same digits). Whirl frequency: rate of the contact angle over a centred window of 1 ms. Anisotropy: stiffness and damping of both rings +10 % in x, −10 % in y.".to_owned(),
        format!("k_c, d_c and J were searched over {} sets for the plateau of 660 Hz, the bound of 0.05 mm on the outer ring, 12 ms to standstill from 40 Hz and a maximum that no longer rises (less than 2 % from 80 to 166 Hz): {met}; {} meet all but the last. J = 0.05 kg m² is the whole mass as a solid disc; with less, spin ends before a soft contact lets the ring move far, but then the maximum still rises with speed. Nearest in the first three: k_c = {:.0e} N/m, d_c = {:.0} N s/m, J = {} kg m², with a rise of {:.1} % (rows \"nearest set\"). Which set the rig had cannot be told from the paper.",
            search.all.len(), search.met_three, near.left_out.contact_stiffness_n_m, near.left_out.contact_damping_n_s_m, near.left_out.inertia_kg_m2, 100.0 * near.rise),
        format!("The test at 166 Hz: μ = μ_∞ + (0.15 − μ_∞)·exp(−v/v_0), v the sliding speed. μ_∞ = {:.4} was fitted to 0.8 s (from a start with 0.4 m/s against the spin as well); v_0 = {} m/s is assumed (table: other v_0). The whirl frequency follows. The same law cannot give 12 ms from 40 Hz: friction fell with time in contact (melting), not with speed alone. Heat is not modelled.",
            law.at_speed, law.speed_scale_m_s),
    ]
}

fn spin_down_rows(runs: &SpinDowns, search: &Search) -> Result<Vec<Row>> {
    const SIMULATED: &str = "Results, simulation";
    const TEST: &str = "Results, test at 40 Hz";
    const FATAL: &str = "the paper calls force and torque fatal, without a number";
    let at = |hz: f64| from(&runs.isotropic, hz);
    let (slow, middle, fast) = (at(40.0)?, at(80.0)?, at(166.0)?);
    let anisotropic = from(&runs.anisotropic, 166.0)?;
    let plateau = match search.met {
        0 => {
            "hangs on k_c and J; sets nearer to 660 Hz miss ring, standstill or the plateau itself (Pareto table)"
        }
        _ => "hangs on k_c and J (Pareto table)",
    };
    Ok(rows! {
        "Plateau of the maximum whirl frequency (166 Hz)", "Hz", SIMULATED, 660.0 => fast.whirl_hz, Assumed, "{plateau}";
        "The same, anisotropic stator", "Hz", "Results, simulation; footnote 4", 660.0 => anisotropic.whirl_hz, Assumed,
            "the paper does not say which calculations had it; outer ring then {:.3} mm", 1e3 * anisotropic.displacement_m[2];
        "Rise of the maximum from 80 to 166 Hz", "%", "Fig. 7", Silent => 100.0 * (fast.whirl_hz / middle.whirl_hz - 1.0), Assumed,
            "paper: not exceeded at higher speed; constant μ";
        "Maximum whirl frequency from 40 Hz (measured)", "Hz", TEST, 530.0 => slow.whirl_hz, Assumed,
            "the paper's own model exceeds its tests too: 660 Hz as maximum";
        "Standstill from 40 Hz", "s", TEST, 0.012 => slow.standstill_s, Assumed, "90 % of the speed to 2 Hz";
        "Spin at the maximum, from 40 Hz", "Hz", TEST, 2.0 => slow.spin_at_middle_hz, Assumed,
            "middle of the window of 1 ms, in which the spin falls fast; {:.1} Hz at its end, where slip ends", slow.spin_at_end_hz;
        "Outer ring, from 40 Hz", "mm", TEST, AtMost(0.05) => 1e3 * slow.displacement_m[2], Assumed, "paper: order of magnitude; a bound in its fit";
        "Outer ring, from 166 Hz", "mm", SIMULATED, AtMost(0.05) => 1e3 * fast.displacement_m[2], Assumed, "the paper's fit kept it within the measured value";
        "Rotor, from 40 Hz: displacement over clearance", "", TEST, AtLeast(1.0) => slow.displacement_m[0] / footnote_4().contact.clearance_m, Assumed,
            "paper: considerably larger than 1";
        "Peak normal force, from 40 Hz", "kN", "Results; Conclusions", Silent => 1e-3 * slow.force_n, Assumed, "{FATAL}";
        "Peak normal force, from 166 Hz", "kN", "Results; Conclusions", Silent => 1e-3 * fast.force_n, Assumed, "{FATAL}";
        "Peak friction torque, from 40 Hz", "N m", "Results; Conclusions", Silent => slow.torque_n_m, Assumed, "{FATAL}";
        "Peak friction torque, from 166 Hz", "N m", "Results; Conclusions", Silent => fast.torque_n_m, Assumed, "{FATAL}";
    })
}

/// What the set gives that comes nearest in plateau, ring and standstill.
fn nearest_rows(search: &Search) -> Vec<Row> {
    const CHOSEN: &str = "k_c and J chosen for plateau, ring and standstill";
    const TEST: &str = "Results, test at 40 Hz";
    let near = &search.nearest;
    rows! {
        "Nearest set: maximum whirl frequency (166 Hz)", "Hz", "Results, simulation", PLATEAU_HZ => near.plateau_hz, Fitted, "{CHOSEN}";
        "Nearest set: outer ring, larger of 40 and 166 Hz", "mm", TEST, AtMost(1e3 * RING_M) => 1e3 * near.ring_m, Fitted, "{CHOSEN}";
        "Nearest set: standstill from 40 Hz", "s", TEST, STANDSTILL_S => near.standstill_s, Fitted, "{CHOSEN}";
        "Nearest set: maximum whirl frequency from 40 Hz (measured)", "Hz", TEST, 530.0 => near.slow_hz, Predicted,
            "not chosen for; its maximum keeps rising with speed (Pareto table)";
        "Nearest set: k_c", "N/m", "not in the paper", Silent => near.left_out.contact_stiffness_n_m, Fitted, "{CHOSEN}";
        "Nearest set: J_r", "kg m²", "not in the paper", Silent => near.left_out.inertia_kg_m2, Fitted, "{CHOSEN}";
    }
}

fn fast_rows(law: &Law, [slow_m_s, fast_m_s]: [f64; 2]) -> Vec<Row> {
    const SOURCE: &str = "Results, test at 166 Hz";
    let [falling_slow_m_s, falling_fast_m_s] = law.critical_m_s;
    rows! {
        "166 Hz: μ_∞ of the falling friction", "", SOURCE, Silent => law.at_speed, Fitted, "fitted to the time to standstill alone";
        "166 Hz: standstill", "s", SOURCE, PAPER_STANDSTILL_S => law.fast_standstill_s, Fitted, "90 % of the speed to 2 Hz; μ_∞ = {:.4} chosen for it", law.at_speed;
        "166 Hz: whirl frequency (median, 90 % to 10 % of the spin)", "Hz", SOURCE, 400.0 => law.median_hz, Predicted,
            "μ_∞ was fitted to the time only; v_0 assumed";
        "166 Hz: maximum whirl frequency", "Hz", SOURCE, 400.0 => law.largest_hz, Assumed,
            "miss: as sliding ends μ rises to 0.15 again; a molten surface would not let it";
        "166 Hz: lowest whirl frequency meanwhile", "Hz", SOURCE, 100.0 => law.lowest_hz, Predicted,
            "miss: with a law of speed alone the whirl is steady; intervals need μ that changes in time (melting)";
        "Excitation for whirl, 166 against 40 Hz, falling μ", "", SOURCE, AtLeast(1.0) => falling_fast_m_s / falling_slow_m_s, Assumed,
            "radial impact {falling_fast_m_s:.2} against {falling_slow_m_s:.2} m/s; paper: considerably higher; hangs on v_0";
        "The same, constant μ", "", SOURCE, Silent => fast_m_s / slow_m_s, Assumed, "{fast_m_s:.3} against {slow_m_s:.3} m/s: spin alone does not matter";
    }
}

/// Spin-downs from all speeds.
fn spin_downs(runs: &SpinDowns) -> Table {
    let limit_hz = runs.limit_hz;
    let over = |v: &Violence| 100.0 * (v.whirl_hz / limit_hz - 1.0);
    let ring = |v: &Violence, i: usize| 1e3 * v.displacement_m[i];
    table! {
        "Spin-down to standstill at constant μ, isotropic / anisotropic stator; beside the whirl its distance from Black's limit of the isotropic stator, {limit_hz:.1} Hz";
        for (a, b) in runs.isotropic.iter().zip(&runs.anisotropic);
        "From [Hz]" => "{:.0}", a.spin_hz;
        "Whirl [Hz]" => "{:.0} / {:.0}", a.whirl_hz, b.whirl_hz;
        "Over the limit [%]" => "{:.1} / {:.1}", over(a), over(b);
        "Force [kN]" => "{:.1} / {:.1}", 1e-3 * a.force_n, 1e-3 * b.force_n;
        "Torque [N m]" => "{:.0} / {:.0}", a.torque_n_m, b.torque_n_m;
        "Rotor [mm]" => "{:.3} / {:.3}", ring(a, 0), ring(b, 0);
        "Inner ring [mm]" => "{:.3} / {:.3}", ring(a, 1), ring(b, 1);
        "Outer ring [mm]" => "{:.3} / {:.3}", ring(a, 2), ring(b, 2);
        "Spin at max [Hz]" => "{:.1} / {:.1}", a.spin_at_middle_hz, b.spin_at_middle_hz;
        "Standstill [ms]" => "{:.1} / {:.1}", 1e3 * a.standstill_s, 1e3 * b.standstill_s;
    }
}

/// Whirl (Fig. 7), force, torque and displacements over the spin at the start.
fn figures(runs: &SpinDowns) -> Vec<Figure> {
    const RANGE: (f64, f64) = (0.0, 170.0);
    let spin = || Axis::linear("Spin at the start [Hz]", RANGE);
    let over = |of: &[Violence], value: &dyn Fn(&Violence) -> f64| -> Vec<(f64, f64)> {
        of.iter().map(|v| (v.spin_hz, value(v))).collect()
    };
    let both = |value: &dyn Fn(&Violence) -> f64| {
        curves! {
            "isotropic stator", Line, 0 => over(&runs.isotropic, value);
            "±10 % anisotropy", Line, 1 => over(&runs.anisotropic, value);
        }
    };
    let displacement = |i: usize| over(&runs.isotropic, &|v| 1e3 * v.displacement_m[i]);
    let mut whirl = both(&|v| v.whirl_hz);
    whirl.extend(curves! {
        "Black's upper limit", Dashed, 2 => level(RANGE, runs.limit_hz);
        "paper, simulated", Dashed, 5 => level(RANGE, 660.0);
        "paper, measured", Crosses, 3 => vec![(40.0, 530.0), (166.0, 400.0)];
    });
    vec![
        chart! {
            "established_whirl", "Maximum whirl frequency over spin",
            "Maximum whirl frequency over the spin at the start (Fig. 7). Crosses: the paper's tests where its text gives a number. Dashed: the maximum of its own simulation, and the upper whirl limit by Black's condition.";
            spin(), Axis::linear("Maximum whirl frequency [Hz]", (0.0, 800.0));
            whirl
        },
        chart! {
            "established_force", "Peak normal force over spin", "Peak normal force over the spin at the start.";
            spin(), Axis::linear("Peak normal force [kN]", (0.0, 150.0));
            both(&|v| 1e-3 * v.force_n)
        },
        chart! {
            "established_torque", "Peak friction torque over spin",
            "Peak friction torque over the spin at the start: μ·R of the force, 15 N m a kilonewton.";
            spin(), Axis::linear("Peak friction torque [kN m]", (0.0, 2.25));
            both(&|v| 1e-3 * v.torque_n_m)
        },
        chart! {
            "established_displacement", "Displacements over spin",
            "Largest displacements, isotropic stator. Dashed: the paper's bound on the outer ring.";
            spin(), Axis::linear("Displacement [mm]", (0.0, 0.6));
            curves! {
                "rotor", Line, 0 => displacement(0);
                "inner ring", Line, 2 => displacement(1);
                "outer ring", Line, 1 => displacement(2);
                "paper, outer ring", Dashed, 3 => level(RANGE, 0.05);
            }
        },
    ]
}
