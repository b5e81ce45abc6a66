//! Instruments, amplifier and controllers of a scene, from its keys.

use crate::device::actuator::AmplifierParams;
use crate::device::levitation::LevitationParams;
use crate::device::sensor::SensorParams;
use crate::scene::diagnostic::SceneError;
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::tables::{LevitationTable, MagnetTable, SensorTable};
use plant_model::V2;

impl From<&SensorTable> for SensorParams {
    fn from(s: &SensorTable) -> Self {
        Self {
            quantum_m: s.quantum_m,
            noise_rms_m: s.noise_rms_m,
            offset_m: s.offset_m.into(),
            gain: s.gain.into(),
            delay_samples: s.delay_samples as usize,
            swapped: s.swapped,
            range_m: s.range_m,
            runout_m: s.runout_m,
            runout_phase_rad: s.runout_phase_rad,
        }
    }
}

impl From<&MagnetTable> for AmplifierParams {
    fn from(m: &MagnetTable) -> Self {
        Self {
            axis_force_max_n: m.axis_force_max_n,
            slew_n_s: m.slew_n_s,
            delay_samples: m.delay_samples as usize,
            jitter_samples: m.delay_jitter_samples as usize,
            force_measured: m.force_measured,
        }
    }
}

impl From<&LevitationTable> for LevitationParams {
    fn from(l: &LevitationTable) -> Self {
        Self {
            proportional_n_m: l.proportional_n_m,
            integral_n_m_s: l.integral_n_m_s,
            derivative_n_s_m: l.derivative_n_s_m,
            derivative_filter_s: l.derivative_filter_s,
        }
    }
}

/// Where the retainer bearing stands as seen from the magnets \[m\].
pub(crate) fn centre_offset_m(spec: &PlaneSpec) -> Result<V2, SceneError> {
    let offset: V2 = spec.tables.retainer.centre_offset_m.into();
    let size = offset.norm();
    if size < spec.contact.clearance_m {
        return Ok(offset);
    }
    let expected = "a length below contact.clearance_m, so that the rotor can be levitated";
    Err((spec.text).refused("retainer.centre_offset_m", size, expected))
}
