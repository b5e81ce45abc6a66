//! Runs of established whirl: the stator levels of footnote 4, spin-down and held spin.

use super::PaperError;
pub(super) use super::rotors::ring;
use super::rotors::{LeftOut, USED, footnote_4_with};
use plant_model::analysis::whirl::WhirlMeter;
use plant_model::params::*;
use plant_model::{Inputs, Options, Plant, V2, build};
use std::f64::consts::TAU;

/// Between two readings \[s\].
const SAMPLE_S: f64 = 20e-6;
/// Whirl frequencies are means over this window \[s\].
const WINDOW_S: f64 = 1e-3;
/// Radial speed at the wall that starts the whirl \[m/s\].
const IMPACT_M_S: f64 = 0.4;

/// Footnote 4 with another contact stiffness, of the same damping ratio.
pub(super) fn footnote_4(contact_stiffness_n_m: f64) -> PlantParams {
    footnote_4_with(&LeftOut {
        contact_stiffness_n_m,
        contact_damping_n_s_m: USED.contact_damping_n_s_m
            * (contact_stiffness_n_m / USED.contact_stiffness_n_m).sqrt(),
        ..USED
    })
}

/// At the wall, moving outwards.
pub(super) fn at_the_wall(params: &PlantParams, impact_m_s: f64, spin_hz: f64) -> Start {
    Start {
        position_m: V2::new(params.contact.clearance_m, 0.0),
        velocity_m_s: V2::new(impact_m_s, 0.0),
        spin_rad_s: spin_hz * TAU,
        spin_phase_rad: 0.0,
    }
}

fn carry(plant: &mut Plant, t_s: f64) -> Result<(), PaperError> {
    Ok(plant.advance(t_s, &Inputs::default(), &mut |_| {})?)
}

/// Fastest backward whirl \[Hz\] of a run from an impact at the wall.
pub(super) fn fastest_hz(
    params: &PlantParams,
    spin_hz: f64,
    duration_s: f64,
) -> Result<f64, PaperError> {
    let start = at_the_wall(params, IMPACT_M_S, spin_hz);
    let mut plant = build(params, &start, Options::default())?;
    let mut meter = WhirlMeter::new(WINDOW_S);
    let samples = (duration_s / SAMPLE_S).round() as u32;
    for i in 1..=samples {
        carry(&mut plant, f64::from(i) * SAMPLE_S)?;
        let now = plant.snapshot();
        meter.push(now.t_s, now.whirl_angle_rad, now.mode.in_contact(), 1.0);
    }
    let fastest = meter.fastest().ok_or_else(|| {
        PaperError::Missing(format!("no whirl from {spin_hz} Hz within {duration_s} s"))
    })?;
    Ok(fastest.backward_hz)
}

/// Where whirl at held spin ends up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settled {
    /// Whirl frequency \[Hz\], backward positive.
    pub(super) whirl_hz: f64,
    /// N \[N\].
    pub(super) normal_force_n: f64,
    /// Without sliding.
    pub(super) rolls: bool,
}

/// Whirl at held spin, started as a circle at the wall near `from_hz`, stator at rest: what is left after
/// `duration_s`, the frequency as a mean over the last tenth.
pub(super) fn settled(
    params: &PlantParams,
    spin_hz: f64,
    from_hz: f64,
    duration_s: f64,
) -> Result<Settled, PaperError> {
    let held = PlantParams {
        spin: SpinParams::Held,
        ..*params
    };
    let radius = 1.01 * params.contact.clearance_m;
    let start = Start {
        position_m: V2::new(radius, 0.0),
        velocity_m_s: V2::new(0.0, -radius * from_hz * TAU),
        ..at_the_wall(params, 0.0, spin_hz)
    };
    let mut plant = build(&held, &start, Options::default())?;
    carry(&mut plant, 0.9 * duration_s)?;
    let before = plant.snapshot().whirl_angle_rad;
    carry(&mut plant, duration_s)?;
    let now = plant.snapshot();
    Ok(Settled {
        whirl_hz: (before - now.whirl_angle_rad) / TAU / (0.1 * duration_s),
        normal_force_n: now.normal_force_n,
        rolls: now.mode == plant_model::Mode::Roll,
    })
}
