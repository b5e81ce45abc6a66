//! Instruments, amplifier and controllers of a scene, from its keys.

use crate::device::actuator::{AmplifierParams, MOST_DELAY};
use crate::device::levitation::LevitationParams;
use crate::device::sensor::{SensorParams, SpinSensorParams};
use crate::scene::diagnostic::{Checks, SceneError};
use crate::scene::file::{LevitationFile, SceneFile};
use crate::scene::values::PerAxis;
use plant_model::V2;

pub(crate) fn sensor_of(file: &SceneFile, check: &Checks<'_>) -> Result<SensorParams, SceneError> {
    let s = &file.sensor;
    check.within("sensor.quantum_m", s.quantum_m, 0.0, 1.0)?;
    check.within("sensor.noise_rms_m", s.noise_rms_m, 0.0, 1.0)?;
    let gain = s.gain.map_or(V2::repeat(1.0), PerAxis::vector);
    for i in [0, 1] {
        check.within("sensor.offset_m", s.offset_m.0[i], -1.0, 1.0)?;
        check.within("sensor.gain", gain[i], -100.0, 100.0)?;
    }
    let delay = f64::from(s.delay_samples);
    check.within("sensor.delay_samples", delay, 0.0, MOST_DELAY as f64)?;
    if let Some(range_m) = s.range_m {
        check.within("sensor.range_m", range_m, 1e-9, 1.0)?;
    }
    Ok(SensorParams {
        quantum_m: s.quantum_m,
        noise_rms_m: s.noise_rms_m,
        offset_m: s.offset_m.0.into(),
        gain,
        delay_samples: s.delay_samples as usize,
        swapped: s.swapped,
        range_m: s.range_m,
    })
}

pub(crate) fn spin_sensor_of(
    file: &SceneFile,
    check: &Checks<'_>,
) -> Result<SpinSensorParams, SceneError> {
    let s = &file.spin_sensor;
    check.within("spin_sensor.gain", s.gain, 0.0, 100.0)?;
    Ok(SpinSensorParams {
        valid: s.valid,
        gain: if s.reversed { -s.gain } else { s.gain },
    })
}

pub(crate) fn amplifier_of(
    file: &SceneFile,
    check: &Checks<'_>,
) -> Result<AmplifierParams, SceneError> {
    let Some(m) = &file.magnet else {
        return Ok(AmplifierParams::default());
    };
    for (key, value) in [
        ("magnet.axis_force_max_n", m.axis_force_max_n),
        ("magnet.slew_n_s", m.slew_n_s),
    ] {
        if let Some(value) = value
            && !(value > 0.0 && value.is_finite())
        {
            return Err(check.refused(key, value, "a finite number greater than 0"));
        }
    }
    let delay = f64::from(m.delay_samples);
    check.within("magnet.delay_samples", delay, 1.0, MOST_DELAY as f64)?;
    Ok(AmplifierParams {
        axis_force_max_n: m.axis_force_max_n,
        slew_n_s: m.slew_n_s,
        delay_samples: m.delay_samples as usize,
        force_measured: m.force_measured,
    })
}

pub(crate) fn centre_offset_of(file: &SceneFile, check: &Checks<'_>) -> Result<V2, SceneError> {
    let offset: V2 = file.retainer.centre_offset_m.0.into();
    let (size, clearance) = (offset.norm(), file.contact.clearance_m);
    if size < clearance {
        return Ok(offset);
    }
    let expected = "a length below contact.clearance_m, so that the rotor can be levitated";
    Err(check.refused("retainer.centre_offset_m", size, expected))
}

pub(crate) fn levitation_of(
    l: &LevitationFile,
    check: &Checks<'_>,
) -> Result<LevitationParams, SceneError> {
    check.within("levitation.proportional_n_m", l.proportional_n_m, 0.0, 1e12)?;
    check.within("levitation.integral_n_m_s", l.integral_n_m_s, 0.0, 1e15)?;
    check.within("levitation.derivative_n_s_m", l.derivative_n_s_m, 0.0, 1e9)?;
    check.within(
        "levitation.derivative_filter_s",
        l.derivative_filter_s,
        0.0,
        1.0,
    )?;
    Ok(LevitationParams {
        proportional_n_m: l.proportional_n_m,
        integral_n_m_s: l.integral_n_m_s,
        derivative_n_s_m: l.derivative_n_s_m,
        derivative_filter_s: l.derivative_filter_s,
    })
}
