//! What the fuzz targets share.

use supervisor::Config;

/// Reads an input to its end; behind it are zeros.
pub struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    /// From the input.
    pub fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    /// Bytes that are left.
    pub fn left(&self) -> usize {
        self.0.len()
    }

    /// The next byte.
    pub fn u8(&mut self) -> u8 {
        match self.0.split_first() {
            Some((first, rest)) => {
                self.0 = rest;
                *first
            }
            None => 0,
        }
    }

    /// The next four.
    pub fn u32(&mut self) -> u32 {
        u32::from_le_bytes([0; 4].map(|_: u8| self.u8()))
    }
}

/// An AMB rotor: 10 kg, 0.2 mm, 1000 N, 20 kHz.
pub fn plausible() -> Config {
    Config {
        sample_period_s: 50e-6,
        mass_kg: 10.0,
        stiffness_n_m: -2e5,
        damping_n_s_m: 0.0,
        clearance_m: 2e-4,
        force_max_n: 1000.0,
        amplifier_lag_s: 1.6e-4,
        delay_samples: 1.0,
        friction_coefficient: 0.15,
        restitution: 0.7,
        observer_pole_flight: 0.6,
        observer_pole_contact: 0.4,
        contact_band: 0.02,
        position_limit: 20.0,
        whirl_time_s: 1e-3,
        hold_share: 0.8,
        handover_dwell_s: 5e-4,
        handover_blend_s: 2e-3,
        fault_blend_s: 1e-3,
        fault_ticks: 10.0,
        axis_force_max_n: 1000.0,
        force_slew_n_s: 1e10,
        continuous_force_n: 1000.0,
        thermal_time_s: 5.0,
        contact_stiffness_n_m: 1e9,
        coast_down_s: 5e-3,
        severity_limit: 1e6,
        retainer_plane_ratio: 1.0,
        magnet_plane_ratio: 1.0,
        speed_max_m_s: 2.0,
        sensor_step_m: 1e-6,
    }
}
