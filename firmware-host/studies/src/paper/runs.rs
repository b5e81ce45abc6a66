//! Runs of established whirl from an impact at the wall, and what is read off them.

use super::data::*;
use plant_model::analysis::course::{Course, Watch, follow};
use plant_model::params::{SpinParams, Start};
use plant_model::{ContactMode, Inputs, Meters, Options, V2, build};

/// Radial speed at the wall that starts the whirl \[m/s\].
pub(super) const IMPACT_M_S: f64 = 0.4;

/// At the wall, moving outwards.
pub(super) fn at_the_wall(params: &PlantParams, impact_m_s: f64, spin_hz: f64) -> Start {
    Start {
        position_m: V2::new(params.contact.clearance_m, 0.0),
        velocity_m_s: V2::new(impact_m_s, 0.0),
        spin_rad_s: spin_hz * TAU,
        spin_phase_rad: 0.0,
    }
}

/// How a run without excitation is followed: read so often \[s\], for so long \[s\], or until the rotor has been free for
/// some time \[s\].
pub(super) fn watch(sample_s: f64, end_s: f64, free_s: f64) -> Watch {
    Watch {
        sample_s,
        window_s: 1e-3,
        end_s,
        free_s,
        pulse: None,
    }
}

/// A run.
pub(super) struct Run {
    pub(super) course: Course,
    pub(super) meters: Meters,
}

impl Run {
    /// Carried through from its start.
    pub(super) fn of(params: &PlantParams, start: &Start, watch: &Watch) -> Result<Self> {
        let mut plant = build(params, start, Options::default())?;
        let course = follow(&mut plant, watch)?;
        let meters = plant.meters();
        Ok(Self { course, meters })
    }

    /// From [`IMPACT_M_S`] at the wall.
    fn from_impact(params: &PlantParams, spin_hz: f64, end_s: f64) -> Result<Self> {
        let start = at_the_wall(params, IMPACT_M_S, spin_hz);
        Self::of(params, &start, &watch(20e-6, end_s, 0.1))
    }

    /// Whether it ends in whirl: a contact of more than 0.1 s.
    pub(super) fn whirls(&self) -> bool {
        let long = self.course.longest_contact();
        long.is_some_and(|c| c.to_s - c.from_s > 0.1)
    }
}

/// Fastest backward whirl \[Hz\], as a mean over 1 ms, of a run from an impact at the wall.
pub(super) fn fastest_hz(params: &PlantParams, spin_hz: f64, end_s: f64) -> Result<f64> {
    let run = Run::from_impact(params, spin_hz, end_s)?;
    (run.course.fastest().map(|reading| reading.backward_hz))
        .or_missing(format!("no whirl from {spin_hz} Hz within {end_s} s"))
}

/// What is read off a run to standstill.
#[derive(Debug, Clone, Copy)]
pub(super) struct Violence {
    /// Spin at the start \[Hz\].
    pub(super) spin_hz: f64,
    /// Largest whirl frequency over 1 ms \[Hz\].
    pub(super) whirl_hz: f64,
    /// Spin in the middle of that window \[Hz\].
    pub(super) spin_at_middle_hz: f64,
    /// Spin at its end \[Hz\].
    pub(super) spin_at_end_hz: f64,
    /// From 90 % of the spin at the start to 2 Hz \[s\].
    pub(super) standstill_s: f64,
    /// Largest normal force \[N\].
    pub(super) force_n: f64,
    /// Largest friction torque \[N m\].
    pub(super) torque_n_m: f64,
    /// Largest displacements of rotor, inner and outer ring \[m\].
    pub(super) displacement_m: [f64; 3],
}

/// A whirl from an impact at the wall to standstill.
pub(super) fn violence(params: &PlantParams, spin_hz: f64, end_s: f64) -> Result<Violence> {
    let run = Run::from_impact(params, spin_hz, end_s)?;
    (run.violence(spin_hz)).or_missing(format!("no whirl to standstill from {spin_hz} Hz"))
}

impl Run {
    /// From 90 % of the spin at the start to 2 Hz \[s\].
    pub(super) fn standstill_s(&self, spin_hz: f64) -> Option<f64> {
        let below_s = |spin_hz: f64| self.course.spin_below_s(spin_hz);
        Some(below_s(2.0)? - below_s(0.9 * spin_hz)?)
    }

    fn violence(&self, spin_hz: f64) -> Option<Violence> {
        let course = &self.course;
        let fastest = course.fastest()?;
        let spin_at = |t_s: f64| course.at(t_s + 1e-9).map(|s| s.spin_hz);
        Some(Violence {
            spin_hz,
            whirl_hz: fastest.backward_hz,
            spin_at_middle_hz: spin_at(fastest.t_s)?,
            spin_at_end_hz: spin_at(fastest.t_s + 0.5e-3)?,
            standstill_s: self.standstill_s(spin_hz)?,
            force_n: self.meters.peak_contact_force_n,
            torque_n_m: self.meters.peak_friction_torque_n_m,
            displacement_m: [
                course.largest(|s| s.position_m.norm()),
                course.largest(|s| s.inner_ring_m.norm()),
                course.largest(|s| s.outer_ring_m.norm()),
            ],
        })
    }
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

impl Settled {
    /// Whether it rolls or slides, in a word.
    pub(super) fn state(&self) -> &'static str {
        if self.rolls { "rolls" } else { "slides" }
    }
}

/// Spin of the runs at held spin \[Hz\].
pub(super) const HELD_SPIN_HZ: f64 = 166.0;

/// Whirl at held spin, started as a circle at the wall near 700 Hz, stator at rest: what is left after 0.3 s, the
/// frequency as a mean over the last tenth.
pub(super) fn settled(params: &PlantParams) -> Result<Settled> {
    const END_S: f64 = 0.3;
    let spin = SpinParams::Held;
    let held = PlantParams { spin, ..*params };
    let radius = 1.01 * params.contact.clearance_m;
    let start = Start {
        position_m: V2::new(radius, 0.0),
        velocity_m_s: V2::new(0.0, -radius * 700.0 * TAU),
        ..at_the_wall(params, 0.0, HELD_SPIN_HZ)
    };
    let mut plant = build(&held, &start, Options::default())?;
    let mut turned = |t_s: f64| -> Result<f64> {
        plant.advance(t_s, &Inputs::default(), &mut |_| {})?;
        Ok(plant.snapshot().whirl_angle_rad)
    };
    let (before, after) = (turned(0.9 * END_S)?, turned(END_S)?);
    let now = plant.snapshot();
    Ok(Settled {
        whirl_hz: (before - after) / TAU / (0.1 * END_S),
        normal_force_n: now.normal_force_n,
        rolls: now.mode == ContactMode::Roll,
    })
}
