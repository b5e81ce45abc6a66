//! Chapter: how far the stator must be modelled, from rolling without slip to two masses.

use super::data::*;
use super::rotors::{footnote_4_at, ring};
use super::runs::fastest_hz;
use plant_model::analysis::black::SteadyWhirl;
use plant_model::params::{SpinParams, StatorParams};

/// Contact stiffness of the levels \[N/m\].
const STIFFNESS_N_M: f64 = 1e9;
/// Contact stiffness that stands for a kinematic contact in the check of the closed form \[N/m\].
const HARD_N_M: f64 = 1e13;
/// What the paper measured, from 40 Hz and from 166 Hz.
const MEASURED_40_HZ: f64 = 530.0;
const MEASURED_166_HZ: f64 = 400.0;

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

fn with_stator(stator: StatorParams, contact_stiffness_n_m: f64) -> PlantParams {
    PlantParams {
        stator,
        ..footnote_4_at(contact_stiffness_n_m)
    }
}

fn one_mass() -> PlantParams {
    let ring = ring(10.0, 8.9e8, 28_300.0);
    with_stator(StatorParams::OneMass(ring), STIFFNESS_N_M)
}

/// Fastest whirl from one speed in every level of stator model \[Hz\].
struct Fastest {
    spin_hz: f64,
    rigid_hz: f64,
    one_hz: f64,
    two_hz: f64,
}

impl Fastest {
    fn from(spin_hz: f64) -> Result<Self> {
        let of = |params: &PlantParams| fastest_hz(params, spin_hz, 0.08);
        Ok(Self {
            spin_hz,
            rigid_hz: of(&with_stator(StatorParams::Rigid, STIFFNESS_N_M))?,
            one_hz: of(&one_mass())?,
            two_hz: of(&footnote_4_at(STIFFNESS_N_M))?,
        })
    }
}

/// Computes the chapter. Both extents give the same rows; a quick run draws fewer start speeds.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let spins_hz: &[f64] = match extent {
        Extent::Quick => &[40.0, 166.0],
        Extent::Full => &[10.0, 20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 130.0, 166.0],
    };
    let all = each(spins_hz, |spin_hz| Fastest::from(*spin_hz))?;
    Ok(Chapter {
        title: "Levels of stator model",
        story: vec![
            "Footnote 4 with a stator that is rolled in without slip, rigid with a contact stiffness, one mass, two masses. Start at the wall with 0.4 m/s, no drive, k_c = 1e9 N/m, J_r = 0.05 kg m², R_r = 0.1 m; whirl frequency as a 1 ms mean.".to_owned(),
            "The rolling limit grows with the spin and is tens of times too high. A rigid stator with a contact stiffness stays below √((k + k_c)/m), and so is capped by a constant that the paper does not give. Stators with masses stop at Black's limit. The step from one mass to two is small with these constants, smaller than the paper's words suggest.".to_owned(),
        ],
        rows: rows(&all)?,
        tables: vec![],
        figures: vec![figure(&all)],
    })
}

/// No whirl of a rigid stator is faster \[Hz\].
fn cap_hz(params: &PlantParams) -> f64 {
    let (m, k) = (params.rotor.mass_kg, params.rotor.stiffness_n_m);
    ((k + STIFFNESS_N_M) / m).sqrt() / TAU
}

fn rows(all: &[Fastest]) -> Result<Vec<Row>> {
    const SOURCE: &str = "Results, simulation";
    let from = |spin_hz: f64| {
        let of = all.iter().find(|fastest| fastest.spin_hz == spin_hz);
        of.or_missing(format!("start at {spin_hz} Hz"))
    };
    let (slow, fast) = (from(40.0)?, from(166.0)?);
    let two = footnote_4_at(STIFFNESS_N_M);
    let hard = with_stator(StatorParams::Rigid, HARD_N_M);
    let limit = SteadyWhirl::from_params(&one_mass()).and_then(|whirl| whirl.upper_limit(5000.0));
    let (undriven_40, undriven_166) = (
        undriven_limit_hz(&two, 40.0),
        undriven_limit_hz(&two, 166.0),
    );
    Ok(rows! {
        "Rolling limit without drive over measured, 40 Hz", "", SOURCE, Between(10.0, 50.0) => undriven_40 / MEASURED_40_HZ, Assumed,
            "J_r = 0.05 kg m², R_r = 0.1 m are ours";
        "Rolling limit without drive over measured, 166 Hz", "", SOURCE, Between(10.0, 50.0) => undriven_166 / MEASURED_166_HZ, Assumed,
            "the measured 400 Hz is lowered by melting; over 530 Hz it would be a factor less than 50";
        "Rolling limit at held spin over measured, 40 Hz", "", SOURCE, Between(10.0, 50.0) => rolling_limit_hz(&two, 40.0) / MEASURED_40_HZ, Assumed,
            "independent of J_r";
        "Rolling limit at held spin over measured, 166 Hz", "", SOURCE, Between(10.0, 50.0) => rolling_limit_hz(&two, 166.0) / MEASURED_166_HZ, Assumed,
            "nothing brakes the spin, and no factor of 50 reaches so far";
        "Rigid stator, k_c = 1e13 N/m, from 40 Hz", "Hz", "Established whirl, rigid stator", Silent => fastest_hz(&hard, 40.0, 0.02)?, Assumed,
            "run, 1 ms mean, in which rolling friction already brakes; closed form {undriven_40:.0} Hz";
        "Rigid stator, k_c = 1e9 N/m, from 40 Hz", "Hz", SOURCE, AtLeast(MEASURED_40_HZ) => slow.rigid_hz, Assumed,
            "paper: rigid in no way adequate. Capped by √((k + k_c)/m) = {:.0} Hz", cap_hz(&two);
        "Rigid stator, k_c = 1e9 N/m, from 166 Hz", "Hz", SOURCE, AtLeast(MEASURED_166_HZ) => fast.rigid_hz, Assumed, "still under the cap";
        "Stator of one mass, from 40 Hz", "Hz", SOURCE, AtLeast(MEASURED_40_HZ) => slow.one_hz, Assumed,
            "inner ring on ground. Paper: better, still much too high; here {:+.1} % over two masses", 100.0 * (slow.one_hz / slow.two_hz - 1.0);
        "Stator of two masses, from 40 Hz", "Hz", SOURCE, 660.0 => slow.two_hz, Assumed, "paper: about 660 Hz as computed maximum, adequate. k_c = 1e9 N/m";
        "Stator of two masses, from 166 Hz over from 40 Hz", "", "Fig. 7", 1.0 => fast.two_hz / slow.two_hz, Assumed,
            "paper: a plateau that higher speeds do not exceed";
        "Upper whirl limit of the stator of one mass", "Hz", "Results, on Black's theory", Silent => limit.map(|c| c.frequency_hz()), Predicted,
            "run from 166 Hz: {:.0} Hz; small disturbances grow at {:.0} 1/s (stable where negative)", fast.one_hz, limit.map_or(f64::NAN, |c| c.growth_rate_s);
    })
}

fn figure(all: &[Fastest]) -> Figure {
    let two = footnote_4_at(STIFFNESS_N_M);
    let runs = |hz: fn(&Fastest) -> f64| all.iter().map(|of| (of.spin_hz, hz(of))).collect();
    let limit =
        |hz: fn(&PlantParams, f64) -> f64| [5.0, 170.0].map(|spin| (spin, hz(&two, spin))).to_vec();
    chart! {
        "levels", "Fastest whirl over start speed by level of stator model",
        "Fastest whirl over the speed at the start, by level of stator model.";
        Axis::linear("Spin at the start [Hz]", (5.0, 175.0)), Axis::log("Fastest whirl [Hz]", (300.0, 1e5));
        curves! {
            "rolling, spin held", Dashed, 5 => limit(rolling_limit_hz);
            "rolling, no drive", Line, 5 => limit(undriven_limit_hz);
            "√((k + k_c)/m)", Dashed, 1 => level((5.0, 170.0), cap_hz(&two));
            "rigid with k_c = 1e9 N/m", Line, 1 => runs(|of| of.rigid_hz);
            "one mass", Line, 2 => runs(|of| of.one_hz);
            "two masses", Line, 0 => runs(|of| of.two_hz);
            "measured", Crosses, 3 => vec![(40.0, MEASURED_40_HZ), (166.0, MEASURED_166_HZ)];
        }
    }
}
