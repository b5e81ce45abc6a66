//! Chapter: limits of sliding whirl by Black's condition with friction, against runs.

use super::data::*;
use super::rotors::footnote_4_at;
use super::runs::{HELD_SPIN_HZ, Settled, fastest_hz, settled};
use plant_model::analysis::black::{Circle, SteadyWhirl};

/// Upper end of the search \[Hz\].
const HIGHEST_HZ: f64 = 5000.0;
/// Contact stiffnesses that are run \[N/m\].
const STIFFNESSES_N_M: [f64; 5] = [3e8, 5e8, 1e9, 1e10, 1e11];

fn whirl(contact_stiffness_n_m: f64) -> Result<SteadyWhirl> {
    let params = footnote_4_at(contact_stiffness_n_m.min(1e12));
    let mut whirl = SteadyWhirl::from_params(&params).or_missing("the stator is not isotropic")?;
    whirl.normal_compliance_m_n = 1.0 / contact_stiffness_n_m;
    Ok(whirl)
}

/// One contact stiffness, run.
struct Tried {
    stiffness_n_m: f64,
    held: Settled,
    /// Fastest whirl of a spin-down from 40 Hz and from 166 Hz \[Hz\].
    fastest_hz: [f64; 2],
    /// What held spin ought to end up in: the sliding limit, or else the rolling circle of this spin.
    target: Option<Circle>,
    /// Upper whirl limit \[Hz\].
    limit_hz: Option<f64>,
    /// The same with a contact as soft along the tangent as along the normal \[Hz\].
    soft_limit_hz: Option<f64>,
}

impl Tried {
    fn of(stiffness_n_m: f64) -> Result<Self> {
        let params = footnote_4_at(stiffness_n_m);
        let whirl = whirl(stiffness_n_m)?;
        let from = |spin_hz: f64| fastest_hz(&params, spin_hz, 0.1);
        let mut soft = whirl.clone();
        soft.tangential_compliance_m_n = soft.normal_compliance_m_n;
        let limit = whirl.upper_limit(HIGHEST_HZ);
        let rolling = || whirl.rolling(HELD_SPIN_HZ * TAU, 0.1, (1.0, HIGHEST_HZ));
        let stable = || rolling().into_iter().find(|c| c.growth_rate_s < 0.0);
        Ok(Self {
            stiffness_n_m,
            held: settled(&params)?,
            fastest_hz: [from(40.0)?, from(166.0)?],
            target: limit.or_else(stable),
            limit_hz: limit.map(|c| c.frequency_hz()),
            soft_limit_hz: soft.upper_limit(HIGHEST_HZ).map(|c| c.frequency_hz()),
        })
    }

    /// How far the whirl from 166 Hz is over a limit, in words.
    fn over(&self, limit_hz: Option<f64>) -> String {
        let percent = |limit: f64| 100.0 * (self.fastest_hz[1] / limit - 1.0);
        limit_hz.map_or("–".to_owned(), |limit| {
            format!("{:+.2} %", percent(limit))
        })
    }
}

/// Computes the chapter. Both extents give the same numbers; the chart has fewer points in a quick run.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let hard = whirl(f64::INFINITY)?;
    let all = each(&STIFFNESSES_N_M, |k| Tried::of(*k))?;
    let at_1e9 = all.iter().find(|tried| tried.stiffness_n_m == 1e9);
    Ok(Chapter {
        title: "Black's limits with friction",
        story: vec![
            "Steady sliding whirl in a circle: rotor and ring answer the contact force with their receptances α_r and α_s, the force stands at atan(μ − μ_r) to the normal, and the distance of the centres is c + N/k_c along the normal. That leaves Im[(α_r + α_s)(1 + i(μ − μ_r))] = 0 with N > 0.".to_owned(),
            "The roots do not depend on k_c or d_c; k_c decides which of them have a positive force. The lowest root is the onset (unstable); the next, where friction turns from driving to braking, is the upper whirl limit. For a soft contact the limit needs a pull and is no solution: whirl at held spin then grows through a resonance until it rolls.".to_owned(),
            "Counting the contact spring to the stator, as Black's receptances invite to, makes the contact soft along the tangent as well, and lowers the limit with k_c. Equations (2.1) to (2.9) have no such compliance: their runs meet the limit without it, and against the other one they seem to overshoot.".to_owned(),
        ],
        rows: rows(&hard, at_1e9.or_missing("1e9")?)?,
        tables: vec![roots()?, held(&all), spin_down(&all), rolling(&hard), existence(&hard)],
        figures: vec![needed_friction(extent, &hard)?],
    })
}

fn rows(hard: &SteadyWhirl, at_1e9: &Tried) -> Result<Vec<Row>> {
    let onset = hard.onset(HIGHEST_HZ).or_missing("no onset")?;
    let limit = hard.upper_limit(HIGHEST_HZ).or_missing("no upper limit")?;
    let limit_hz = limit.frequency_hz();
    let least = hard.least_friction(1.0, HIGHEST_HZ);
    let (least, least_hz) = least.or_missing("no whirl at any friction")?;
    let rigid_hz = hard.coupled_frequencies_hz().first().copied();
    let joined_hz = whirl(1e9)?.coupled_frequencies_hz().first().copied();
    let [slow_hz, fast_hz] = at_1e9.fastest_hz;
    let over = 100.0 * (fast_hz / limit_hz - 1.0);
    Ok(rows! {
        "Upper whirl limit", "Hz", "Results, simulation", 660.0 => limit_hz, Predicted,
            "nothing but footnote 4 in it: neither k_c nor d_c, J_r, R_r, spin. Above the paper's computed maximum; why, the paper does not let us see";
        "First coupled natural frequency, joined rigidly", "Hz", "Footnote 5", 660.0 => rigid_hz, Predicted,
            "misses: with these constants the maximum is not this frequency; damping lets friction drive only to the limit below it";
        "First coupled natural frequency, joined by k_c = 1e9 N/m", "Hz", "Footnote 5", 660.0 => joined_hz, Assumed, "misses too";
        "Plateau: fastest whirl from 166 Hz", "Hz", "Fig. 7, simulation", 660.0 => fast_hz, Assumed, "k_c = 1e9 N/m; {over:+.2} % from the limit";
        "Fastest whirl at 40 Hz", "Hz", "Results, test at 40 Hz", 530.0 => slow_hz, Assumed,
            "k_c = 1e9 N/m; measured. The spin is used up before the limit is reached";
        "Whirl frequency at which whirl begins", "Hz", "Results, test at 40 Hz", AtMost(55.0) => onset.frequency_hz(), Predicted,
            "the lowest root is a lower bound: friction drives above it";
        "Least μ − μ_r that keeps any sliding whirl", "", "Footnote 4", Silent => least, Predicted, "at {least_hz:.0} Hz; footnote 4 has 0.125";
        "Driving friction with which the limit is 400 Hz", "", "Results, test at 166 Hz", Silent => hard.friction_needed(400.0 * TAU), Predicted,
            "what melting must leave of μ − μ_r for the measured 400 Hz";
    })
}

fn stiffness(k: f64) -> String {
    match k.is_finite() {
        true => format!("{k:e}"),
        false => "∞".to_owned(),
    }
}

fn stability(circle: &Circle) -> String {
    match circle.growth_rate_s {
        _ if !circle.exists() => "needs a pull".to_owned(),
        rate if rate < 0.0 => format!("stable, {rate:.0}"),
        rate => format!("unstable, {rate:+.0}"),
    }
}

/// Force of a circle that exists \[kN\].
pub(super) fn force_kn(circle: &Circle) -> Option<f64> {
    circle.exists().then_some(circle.normal_force_n / 1e3)
}

/// On which side of a circle's frequency friction drives.
pub(super) fn drives(circle: &Circle) -> &'static str {
    if circle.attracts { "below" } else { "above" }
}

/// All roots for each contact stiffness.
fn roots() -> Result<Table> {
    let mut roots = Vec::new();
    for k in [f64::INFINITY, 1e10, 1e9, 5e8, 3e8] {
        roots.extend(
            (whirl(k)?.sliding(1.0, HIGHEST_HZ).into_iter()).map(|root| (stiffness(k), root)),
        );
    }
    Ok(table! {
        "Steady sliding whirl, 1 to 5000 Hz; growth rate of small disturbances (constant μ; k_c = ∞ as 1e12 N/m with a contact damping ratio of 0.08)";
        for (k, root) in &roots;
        "k_c [N/m]" => "{k}";
        "Whirl [Hz]" => "{:.1}", root.frequency_hz();
        "N [kN]" => "{}", or_dash(force_kn(root), 4);
        "Friction drives" => "{}", drives(root);
        "Growth rate [1/s]" => "{}", stability(root);
    })
}

/// Held spin against the closed forms.
fn held(all: &[Tried]) -> Table {
    let off =
        |tried: &Tried, target: Circle| (tried.held.whirl_hz / target.frequency_hz() - 1.0).abs();
    table! {
        "Run to steady state at {HELD_SPIN_HZ} Hz held spin, against the closed form (sliding limit, or rolling circle where that needs a pull; at 3e8 N/m the circle is centimetres wide, a solution of the equations and of no machine)";
        for tried in all;
        "k_c [N/m]" => "{}", stiffness(tried.stiffness_n_m);
        "Whirl, run [Hz]" => "{:.3}", tried.held.whirl_hz;
        "N, run [kN]" => "{:.2}", tried.held.normal_force_n / 1e3;
        "State" => "{}", tried.held.state();
        "Whirl, closed form [Hz]" => "{}", or_dash(tried.target.map(|c| c.frequency_hz()), 3);
        "N, closed form [kN]" => "{}", or_dash(tried.target.map(|c| c.normal_force_n / 1e3), 2);
        "Relative difference" => "{}", tried.target.map_or("–".to_owned(), |c| format!("{:.1e}", off(tried, c)));
    }
}

/// Spin-down against both limits.
fn spin_down(all: &[Tried]) -> Table {
    let hz = |limit: Option<f64>| limit.map_or("needs a pull".to_owned(), |hz| format!("{hz:.1}"));
    table! {
        "Spin-down: fastest whirl (1 ms mean) against the limit, and against that of a contact as soft along the tangent, which the equations do not have";
        for tried in all;
        "k_c [N/m]" => "{}", stiffness(tried.stiffness_n_m);
        "From 40 Hz [Hz]" => "{:.1}", tried.fastest_hz[0];
        "From 166 Hz [Hz]" => "{:.1}", tried.fastest_hz[1];
        "Limit [Hz]" => "{}", hz(tried.limit_hz);
        "166 Hz over it" => "{}", tried.over(tried.limit_hz);
        "Limit, soft along tangent [Hz]" => "{}", hz(tried.soft_limit_hz);
        "166 Hz over it" => "{}", tried.over(tried.soft_limit_hz);
    }
}

/// Rolling whirl in kinematic contact.
fn rolling(hard: &SteadyWhirl) -> Table {
    const SHOWN_HZ: [f64; 16] = [
        45.0, 50.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 734.0, 740.0, 900.0, 1000.0,
        1500.0, 2000.0, 2500.0,
    ];
    let mu_r = 0.025;
    let cone = -(hard.driving_friction + 2.0 * mu_r)..hard.driving_friction;
    let exists = |circle: &Circle| match circle.exists() {
        false => "no: needs a pull",
        true if cone.contains(&circle.driving_share) => "yes",
        true => "no: slides",
    };
    table! {
        "Whirl in kinematic contact (footnote 1): rolling without slip at c, ω = Ω·R_r/c. The bands in which the cone of friction holds it end at the sliding roots. Its disturbances decay wherever it presses, since the constraint leaves rotor and stator a damped linear system";
        for (hz, (circle, spin)) in SHOWN_HZ.map(|hz| (hz, hard.rolling_at(hz * TAU, 0.1)));
        "Whirl [Hz]" => "{hz:.0}";
        "Spin [Hz]" => "{:.3}", spin / TAU;
        "N [kN]" => "{:.4}", circle.normal_force_n / 1e3;
        "Tangential force/N" => "{:.4}", circle.driving_share;
        "Exists" => "{}", exists(&circle);
        "Growth rate [1/s]" => "{}", stability(&circle);
    }
}

/// Existence and limit over driving friction.
fn existence(hard: &SteadyWhirl) -> Table {
    let with = |driving_friction: f64| {
        let mut whirl = hard.clone();
        whirl.driving_friction = driving_friction;
        whirl
    };
    let hz = |circle: Option<Circle>| or_dash(circle.map(|c| c.frequency_hz()), 1);
    table! {
        "Onset and upper limit over μ − μ_r, k_c = ∞";
        for mu in [0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.125, 0.2, 0.3, 0.5];
        "μ − μ_r" => "{mu}";
        "Onset [Hz]" => "{}", hz(with(mu).onset(HIGHEST_HZ));
        "Upper limit [Hz]" => "{}", hz(with(mu).upper_limit(HIGHEST_HZ));
    }
}

fn needed_friction(extent: Extent, hard: &SteadyWhirl) -> Result<Figure> {
    let points = extent.pick(400, 2000);
    let (low, high) = (40.0_f64, HIGHEST_HZ);
    let needed = |whirl: &SteadyWhirl| -> Vec<(f64, f64)> {
        let share = |i: i32| f64::from(i) / f64::from(points);
        let frequencies = (0..=points).map(|i| low * (high / low).powf(share(i)));
        let shown = |needed: &f64| (1e-3..=1.0).contains(needed);
        let of = |hz: f64| whirl.friction_needed(hz * TAU).filter(shown);
        frequencies
            .map(|hz| (hz, of(hz).unwrap_or(f64::NAN)))
            .collect()
    };
    let mu = hard.driving_friction;
    let roots = hard.sliding(1.0, HIGHEST_HZ);
    Ok(chart! {
        "limits-friction-needed", "Friction needed over whirl frequency",
        "Friction that sliding whirl at a frequency needs. The three curves lie on each other; a softer contact only ends earlier.";
        Axis::log("Whirl frequency [Hz]", (low, high)), Axis::log("Driving friction needed", (1e-3, 1.0));
        curves! {
            "k_c = ∞", Line, 0 => needed(hard);
            "k_c = 1e9 N/m, where it exists", Line, 1 => needed(&whirl(1e9)?);
            "k_c = 3e8 N/m, where it exists", Line, 2 => needed(&whirl(3e8)?);
            "μ − μ_r = {mu:.3}: drives where it is above the curve", Dashed, 3 => level((low, high), mu);
            "roots", Dots, 3 => roots.iter().map(|c| (c.frequency_hz(), mu)).collect();
        }
    })
}
