//! The rotor of footnote 4 on its two-mass stator, its runs and what is read off them.

use crate::paper::PaperError;
use plant_model::analysis::course::{Course, Watch, follow};
use plant_model::params::{PlantParams, Start, StatorParams};
use plant_model::{Meters, Options, V2, build};
use std::f64::consts::TAU;

/// Clearance \[m\].
pub(in crate::paper) const CLEARANCE_M: f64 = 2e-4;
/// Radial speed at the wall at the start \[m/s\].
pub(in crate::paper) const IMPACT_M_S: f64 = 0.4;

/// Stiffness and damping of both rings 10 % up along x and 10 % down along y.
pub(super) fn anisotropic(mut params: PlantParams) -> PlantParams {
    if let StatorParams::TwoMass { inner, outer } = &mut params.stator {
        let factor = V2::new(1.1, 0.9);
        for ring in [inner, outer] {
            ring.stiffness_n_m.component_mul_assign(&factor);
            ring.damping_n_s_m.component_mul_assign(&factor);
        }
    }
    params
}

/// At the wall, moving outwards.
pub(super) fn at_the_wall(spin_hz: f64, speed_m_s: f64) -> Start {
    Start {
        position_m: V2::new(CLEARANCE_M, 0.0),
        velocity_m_s: V2::new(speed_m_s, 0.0),
        spin_rad_s: spin_hz * TAU,
        spin_phase_rad: 0.0,
    }
}

/// How a run without excitation is followed.
pub(super) fn watch(end_s: f64) -> Watch {
    Watch {
        sample_s: 20e-6,
        window_s: 1e-3,
        end_s,
        free_s: 0.1,
        pulse: None,
    }
}

/// A run.
pub(in crate::paper) fn run(
    params: &PlantParams,
    start: &Start,
    watch: &Watch,
) -> Result<(Course, Meters), PaperError> {
    let mut plant = build(params, start, Options::default())?;
    let course = follow(&mut plant, watch)?;
    Ok((course, plant.meters()))
}

/// What is read off a run to standstill.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Violence {
    /// Spin at the start \[Hz\].
    pub spin_hz: f64,
    /// Largest whirl frequency over 1 ms \[Hz\].
    pub whirl_hz: f64,
    /// Spin in the middle of that window \[Hz\].
    pub spin_at_middle_hz: f64,
    /// Spin at its end \[Hz\].
    pub spin_at_end_hz: f64,
    /// From 90 % of the spin at the start to 2 Hz \[s\].
    pub standstill_s: f64,
    /// Largest normal force \[N\].
    pub force_n: f64,
    /// Largest friction torque \[N m\].
    pub torque_n_m: f64,
    /// Largest displacements of rotor, inner and outer ring \[m\].
    pub displacement_m: [f64; 3],
}

impl Violence {
    /// Of a run that whirled and stood still.
    pub(super) fn of(spin_hz: f64, course: &Course, meters: &Meters) -> Option<Self> {
        let fastest = course.fastest()?;
        let spin_at = |t_s: f64| course.at(t_s + 1e-9).map(|s| s.spin_hz);
        Some(Self {
            spin_hz,
            whirl_hz: fastest.backward_hz,
            spin_at_middle_hz: spin_at(fastest.t_s)?,
            spin_at_end_hz: spin_at(fastest.t_s + 0.5e-3)?,
            standstill_s: course.spin_below_s(2.0)? - course.spin_below_s(0.9 * spin_hz)?,
            force_n: meters.peak_contact_force_n,
            torque_n_m: meters.peak_friction_torque_n_m,
            displacement_m: [
                course.largest(|s| s.position_m.norm()),
                course.largest(|s| s.inner_ring_m.norm()),
                course.largest(|s| s.outer_ring_m.norm()),
            ],
        })
    }
}

/// A whirl from an impact at the wall to standstill.
pub(in crate::paper) fn violence(
    params: &PlantParams,
    spin_hz: f64,
    end_s: f64,
) -> Result<Violence, PaperError> {
    let start = at_the_wall(spin_hz, IMPACT_M_S);
    let (course, meters) = run(params, &start, &watch(end_s))?;
    Violence::of(spin_hz, &course, &meters)
        .ok_or_else(|| PaperError::Missing(format!("no whirl to standstill from {spin_hz} Hz")))
}
