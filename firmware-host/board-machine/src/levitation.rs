//! A levitation controller to be replaced by the machine's own: a PID whose integrator obeys the supervisor's hint.

use supervisor::IntegratorHint;

use crate::TICK_HZ;

const STIFFNESS_N_M: f32 = 8e5;
const DAMPING_N_S_M: f32 = 2500.0;
/// Of the integrator \[N/(m·s)\].
const RESET_N_M_S: f32 = 8e6;
/// Largest part of the integrator \[N\].
const INTEGRAL_MAX_N: f32 = 300.0;
/// Share of a new difference in the speed: a low-pass filter against noise.
const FRESH: f32 = 0.3;

/// Its state.
#[derive(Default)]
pub struct Levitation {
    before_m: [f32; 2],
    speed_m_s: [f32; 2],
    integral_n: [f32; 2],
}

impl Levitation {
    /// The force that it wants \[N\].
    pub fn force_n(&mut self, position_m: [f32; 2], hint: IntegratorHint) -> [f32; 2] {
        [0, 1].map(|axis| {
            let x_m = position_m[axis];
            let difference_m_s = (x_m - self.before_m[axis]) * TICK_HZ as f32;
            self.before_m[axis] = x_m;
            self.speed_m_s[axis] += FRESH * (difference_m_s - self.speed_m_s[axis]);
            if hint == IntegratorHint::Run {
                let integral_n = self.integral_n[axis] + RESET_N_M_S * x_m / TICK_HZ as f32;
                self.integral_n[axis] = integral_n.clamp(-INTEGRAL_MAX_N, INTEGRAL_MAX_N);
            }
            let spring_n = STIFFNESS_N_M * x_m + DAMPING_N_S_M * self.speed_m_s[axis];
            -(spring_n + self.integral_n[axis])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BEARING;

    /// A mass on the magnets' negative stiffness, with weight: the controller brings it from the retainer bearing to the centre.
    #[test]
    fn it_lifts_and_centres() {
        let mut levitation = Levitation::default();
        let (mut x_m, mut speed_m_s, mut force_n) = (-BEARING.clearance_m, 0.0, 0.0);
        let period_s = BEARING.sample_period_s;
        for _ in 0..2 * TICK_HZ {
            let [wanted_n, _] = levitation.force_n([x_m, 0.0], IntegratorHint::Run);
            force_n += (wanted_n - force_n) * period_s / BEARING.amplifier_lag_s;
            let weight_n = 9.81 * BEARING.mass_kg;
            let total_n = force_n - BEARING.stiffness_n_m * x_m - weight_n;
            speed_m_s += total_n / BEARING.mass_kg * period_s;
            x_m = (x_m + speed_m_s * period_s).max(-BEARING.clearance_m);
        }
        assert!(
            x_m.abs() < 1e-6 && speed_m_s.abs() < 1e-4,
            "{x_m} m, {speed_m_s} m/s"
        );
    }

    #[test]
    fn the_hint_holds_the_integrator() {
        let mut levitation = Levitation::default();
        let held = |levitation: &mut Levitation| {
            let force = levitation.force_n([1e-5, 0.0], IntegratorHint::Hold);
            (force, levitation.integral_n)
        };
        for _ in 0..100 {
            levitation.force_n([1e-5, 0.0], IntegratorHint::Run);
        }
        let (_, integral_n) = held(&mut levitation);
        assert!(integral_n[0] > 0.0 && held(&mut levitation).1 == integral_n);
    }
}
