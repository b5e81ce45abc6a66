//! A first configuration from what a data sheet says of a bearing: nine numbers.

use crate::border::config::Config;
use crate::border::shaft::Shaft;
use crate::number::scalar::{Order, gain_square};

/// What cannot be guessed of a bearing plane; [`Config::for_bearing`] derives all the rest. Each has the range of the parameter
/// of its name in [`crate::PARAMETERS`].
///
/// ```
/// use supervisor::{Bearing, Config, Supervisor};
///
/// const BEARING: Bearing = Bearing {
///     sample_period_s: 50e-6,
///     mass_kg: 10.0,
///     stiffness_n_m: -2e5,
///     clearance_m: 2e-4,
///     force_max_n: 1000.0,
///     amplifier_lag_s: 1.6e-4,
///     friction_coefficient: 0.15,
///     contact_stiffness_n_m: 1e9,
///     sensor_noise_m: 1e-6,
/// };
/// // What this machine has otherwise.
/// static CONFIG: Config = Config {
///     restitution: 0.5,
///     ..Config::for_bearing(&BEARING)
/// };
/// let supervisor = Supervisor::<512>::new(&CONFIG)?;
/// # Ok::<(), supervisor::ConfigError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bearing {
    /// Period of the tick \[s\].
    pub sample_period_s: f32,
    /// Mass of the rotor that this bearing plane carries \[kg\].
    pub mass_kg: f32,
    /// Shaft stiffness plus the magnets' negative stiffness, either sign \[N/m\].
    pub stiffness_n_m: f32,
    /// Radial clearance of the retainer bearing \[m\].
    pub clearance_m: f32,
    /// Force cap of the magnet, as the length of the vector \[N\].
    pub force_max_n: f32,
    /// Time constant of the amplifier with the magnet \[s\].
    pub amplifier_lag_s: f32,
    /// Coefficient of friction on the retainer bearing, the upper end of what is likely.
    pub friction_coefficient: f32,
    /// Stiffness of the contact with the retainer bearing \[N/m\].
    pub contact_stiffness_n_m: f32,
    /// Noise of the sensor (root mean square) or step of its converter, whichever is larger \[m\]: 0 to 1e-3, and at most 7 % of
    /// the clearance.
    pub sensor_noise_m: f32,
}

impl Bearing {
    /// The quickest poles of the observer in flight and in contact: no noise makes them quicker.
    pub const QUICKEST_POLES: [f32; 2] = [0.5, 0.2];
    /// The slowest pole.
    pub const SLOWEST_POLE: f32 = 0.97;
    /// Noise of the estimated speed that the poles aim at, over √(F·c/m): so little the laws do not feel.
    pub const SPEED_NOISE_SHARE: f32 = 0.04;

    /// Noise of the sensor for what is derived from it; none where it cannot be one, which the parameter of its own says.
    const fn noise_m(&self) -> f32 {
        if self.sensor_noise_m >= 0.0 && self.sensor_noise_m <= 1e-3 {
            self.sensor_noise_m
        } else {
            0.0
        }
    }

    /// √(k_c/m) of the rotor on the contact \[rad/s\].
    const fn contact_rate_rad_s(&self) -> f32 {
        root(self.contact_stiffness_n_m / self.mass_kg)
    }

    /// Square of the sensor's noise as a speed, from tick to tick, over √(F·c/m).
    const fn noise_square(&self) -> f32 {
        let per_tick_m_s = self.noise_m() / self.sample_period_s;
        let force_speed_square = self.force_max_n * self.clearance_m / self.mass_kg;
        per_tick_m_s * per_tick_m_s / force_speed_square
    }
}

impl Config {
    /// A configuration from nine numbers. [`crate::PARAMETERS`] says how each value follows ([`crate::DefaultRule`]); what is known
    /// better goes into the place of single values. In a constant it costs firmware nothing.
    ///
    /// Numbers in their ranges that make no contradiction ([`RULES`](crate::RULES)) give a valid configuration. Any others give one that [`Config::validate`] refuses, by the
    /// parameter of the number's name: for the sensor's noise `sensor_step_m`, or `contact_band` where it is too much for the clearance.
    pub const fn for_bearing(bearing: &Bearing) -> Self {
        let Bearing {
            sample_period_s,
            mass_kg,
            stiffness_n_m,
            clearance_m,
            force_max_n,
            amplifier_lag_s,
            friction_coefficient,
            contact_stiffness_n_m,
            sensor_noise_m,
        } = *bearing;
        let (noise_m, noise_square) = (bearing.noise_m(), bearing.noise_square());
        let contact_rate_rad_s = bearing.contact_rate_rad_s();
        let [flight, contact] = Bearing::QUICKEST_POLES;
        Config {
            sample_period_s,
            mass_kg,
            stiffness_n_m,
            clearance_m,
            force_max_n,
            amplifier_lag_s,
            friction_coefficient,
            observer_pole_flight: quickest_pole(flight, noise_square, Order::Second),
            observer_pole_contact: quickest_pole(contact, noise_square, Order::First),
            contact_band: at_least(4.0 * (noise_m / clearance_m), 0.01),
            whirl_time_s: between(core::f32::consts::TAU / contact_rate_rad_s, 1e-3, 0.1),
            axis_force_max_n: force_max_n,
            force_slew_n_s: between(1e3 * force_max_n / sample_period_s, 1.0, 1e12),
            continuous_force_n: force_max_n,
            contact_stiffness_n_m,
            speed_max_m_s: between(1.5 * (clearance_m * contact_rate_rad_s), 2.0, 1000.0),
            // A sensor without noise and steps is not a thing that gets stuck; what is no noise stays what it is, to be refused.
            sensor_step_m: if sensor_noise_m >= 0.0 {
                at_least(sensor_noise_m, at_least(5e-4 * clearance_m, 1e-9))
            } else {
                sensor_noise_m
            },
            ..Self::CONSTANTS
        }
    }

    /// Configurations of both planes of a rotor: mass and ratios of a plane follow from the shaft, and all that follows from
    /// the mass with them. `mass_kg` of the bearings is not used.
    pub const fn for_rotor(shaft: &Shaft, [first, second]: &[Bearing; 2]) -> [Self; 2] {
        [for_plane(shaft, 0, first), for_plane(shaft, 1, second)]
    }
}

const fn for_plane(shaft: &Shaft, end: usize, bearing: &Bearing) -> Config {
    // The ratios do not depend on what is derived from the mass, nor that on them.
    let mass_kg = shaft.plane(end, &Config::for_bearing(bearing)).mass_kg;
    let config = Config::for_bearing(&Bearing {
        mass_kg,
        ..*bearing
    });
    shaft.plane(end, &config)
}

/// The quickest pole, from `quickest` on in hundredths, whose noise of the speed is at most what is aimed at. Squares, so that
/// no root decides.
const fn quickest_pole(quickest: f32, noise_square: f32, order: Order) -> f32 {
    const AIM_SQUARE: f32 = Bearing::SPEED_NOISE_SHARE * Bearing::SPEED_NOISE_SHARE;
    let mut pole = quickest;
    while pole < Bearing::SLOWEST_POLE && noise_square * gain_square(pole, order) > AIM_SQUARE {
        // Not a sum of hundredths, whose errors add up: the number nearest to 0.51, 0.52, …
        pole = ((100.0 * pole + 1.5) as u32) as f32 / 100.0;
    }
    pole
}

/// Held between `low` and `high`; NaN becomes `low`. As `Scalar::clamp`, which no constant can call.
const fn between(x: f32, low: f32, high: f32) -> f32 {
    if x > high { high } else { at_least(x, low) }
}

/// The larger of the two; NaN becomes `low`.
const fn at_least(x: f32, low: f32) -> f32 {
    if x >= low { x } else { low }
}

/// Square root by Heron's method, which a constant can call and which rounds as the exact root nearly everywhere; 0 where there is
/// none or it is infinite.
const fn root(x: f32) -> f32 {
    if !(x > 0.0 && x < f32::INFINITY) {
        return 0.0;
    }
    // Half the exponent: 4 % off at most, and squared in each step.
    let mut y = f32::from_bits((x.to_bits() >> 1).wrapping_add(0x1FBD_1DF5));
    let mut steps = 0;
    while steps < 4 {
        y = 0.5 * (y + x / y);
        steps += 1;
    }
    y
}
