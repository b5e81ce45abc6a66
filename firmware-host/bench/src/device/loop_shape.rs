//! The levitation loop as a linear sampled system: stability, peak sensitivity, force by sensor noise.
//!
//! Rotor m·ẍ + d·ẋ + k·x = F with an amplifier of first order, under a force command that is held for a
//! period and comes into effect `delay` samples after its position. One axis; the axes do not couple.

use crate::device::levitation::LevitationParams;
use nalgebra::{Complex, DMatrix, Matrix3, Matrix4, Vector3};
use plant_model::params::PlantParams;
use std::f64::consts::PI;

type C = Complex<f64>;

/// Rotor and amplifier sampled.
#[derive(Debug, Clone)]
pub struct SampledPlant {
    /// State (x, v, F) after a period, from the state …
    transition: Matrix3<f64>,
    /// … and from the held command.
    input: Vector3<f64>,
    period_s: f64,
    delay: usize,
}

/// What a controller makes of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopShape {
    /// Largest |S| = |1/(1 + L)| over frequency.
    pub peak_sensitivity: f64,
    /// Force by sensor noise, as the root mean square of the vector, per metre of noise on an axis \[N/m\].
    pub noise_gain_n_m: f64,
}

/// Frequencies between zero and half the sampling rate at which the loop is evaluated.
const FREQUENCIES: usize = 2000;

impl SampledPlant {
    /// Exact for a command that is held.
    pub fn new(plant: &PlantParams, sample_rate_hz: f64, delay: usize) -> Self {
        let (m, k, d) = (
            plant.rotor.mass_kg,
            plant.rotor.stiffness_n_m,
            plant.rotor.damping_n_s_m,
        );
        let lag_s = plant.magnet.map_or(0.0, |magnet| magnet.lag_s);
        let period_s = 1.0 / sample_rate_hz;
        // Without a lag the force is the command: a lag of a thousandth of a period is as good.
        let rate = 1.0 / lag_s.max(1e-3 * period_s);
        #[rustfmt::skip]
        let generator = Matrix4::new(
            0.0, 1.0, 0.0, 0.0,
            -k / m, -d / m, 1.0 / m, 0.0,
            0.0, 0.0, -rate, rate,
            0.0, 0.0, 0.0, 0.0,
        ) * period_s;
        let whole = generator.exp();
        Self {
            transition: whole.fixed_view::<3, 3>(0, 0).into_owned(),
            input: whole.fixed_view::<3, 1>(0, 3).into_owned(),
            period_s,
            delay,
        }
    }

    /// Position per command at z.
    fn response(&self, z: C) -> Option<C> {
        let matrix = Matrix3::<C>::identity() * z - self.transition.map(C::from);
        let state = matrix.lu().solve(&self.input.map(C::from))?;
        Some(state.x / z.powu(self.delay as u32))
    }

    /// Force asked for per position at z, the sign of a restoring force taken out.
    fn controller(&self, params: &LevitationParams, z: C) -> C {
        let share = self.period_s / (self.period_s + params.derivative_filter_s);
        let back = z.inv();
        let difference = (C::from(1.0) - back) / self.period_s;
        let filtered = difference * share / (C::from(1.0) - back * (1.0 - share));
        let integral =
            C::from(params.integral_n_m_s * self.period_s) * back / (C::from(1.0) - back);
        integral + filtered * params.derivative_n_s_m + params.proportional_n_m
    }

    /// `None` where the closed loop is not stable.
    pub fn close(&self, params: &LevitationParams) -> Option<LoopShape> {
        self.is_stable(params).then_some(())?;
        let mut peak_sensitivity: f64 = 0.0;
        let mut square = 0.0;
        for i in 0..FREQUENCIES {
            let angle = PI * (i as f64 + 0.5) / FREQUENCIES as f64;
            let z = C::from_polar(1.0, angle);
            let controller = self.controller(params, z);
            let sensitivity = (self.response(z)? * controller + 1.0).inv();
            peak_sensitivity = peak_sensitivity.max(sensitivity.norm());
            square += (controller * sensitivity).norm_sqr() / FREQUENCIES as f64;
        }
        Some(LoopShape {
            peak_sensitivity,
            noise_gain_n_m: (2.0 * square).sqrt(),
        })
    }

    /// Eigenvalues of the closed loop: (x, v, F), the commands on their way, the last position, the
    /// filtered velocity, the integral.
    fn is_stable(&self, params: &LevitationParams) -> bool {
        let delay = self.delay;
        let (last, speed, integral) = (3 + delay, 4 + delay, 5 + delay);
        let size = 6 + delay;
        let share = self.period_s / (self.period_s + params.derivative_filter_s);
        // Rows of what is computed from the state at a sample.
        let mut velocity = vec![0.0; size];
        velocity[0] = share / self.period_s;
        velocity[last] = -share / self.period_s;
        velocity[speed] = 1.0 - share;
        let mut command: Vec<f64> = velocity
            .iter()
            .map(|x| -params.derivative_n_s_m * x)
            .collect();
        command[0] -= params.proportional_n_m;
        command[integral] += 1.0;
        let mut matrix = DMatrix::<f64>::zeros(size, size);
        for row in 0..3 {
            for column in 0..3 {
                matrix[(row, column)] = self.transition[(row, column)];
            }
            for column in 0..size {
                let acting = match delay {
                    0 => command[column],
                    _ => f64::from(u8::from(column == 2 + delay)),
                };
                matrix[(row, column)] += self.input[row] * acting;
            }
        }
        for i in 0..delay {
            for column in 0..size {
                matrix[(3 + i, column)] = match i {
                    0 => command[column],
                    _ => f64::from(u8::from(column == 2 + i)),
                };
            }
        }
        matrix[(last, 0)] = 1.0;
        for column in 0..size {
            matrix[(speed, column)] = velocity[column];
        }
        matrix[(integral, integral)] = if params.integral_n_m_s > 0.0 {
            1.0
        } else {
            0.0
        };
        matrix[(integral, 0)] = -params.integral_n_m_s * self.period_s;
        // Scaled by the diagonal, positions of 1e-4 and forces of 1e3 would cost digits.
        let scales: Vec<f64> = (0..size)
            .map(|i| match i {
                0 => 1.0,
                1 => 1.0 / self.period_s,
                i if i == last => 1.0,
                i if i == speed => 1.0 / self.period_s,
                _ => params.proportional_n_m.max(1.0),
            })
            .collect();
        let scaled = DMatrix::from_fn(size, size, |i, j| matrix[(i, j)] * scales[j] / scales[i]);
        (scaled.complex_eigenvalues().iter()).all(|value| value.norm() < 1.0)
    }
}
