//! A bearing of nine numbers in a row.

use supervisor::Bearing;

/// The numbers in the order of the fields.
pub const fn bearing(numbers: [f32; 9]) -> Bearing {
    let [
        period,
        mass,
        stiffness,
        clearance,
        cap,
        lag,
        friction,
        contact,
        noise,
    ] = numbers;
    Bearing {
        sample_period_s: period,
        mass_kg: mass,
        stiffness_n_m: stiffness,
        clearance_m: clearance,
        force_max_n: cap,
        amplifier_lag_s: lag,
        friction_coefficient: friction,
        contact_stiffness_n_m: contact,
        sensor_noise_m: noise,
    }
}
