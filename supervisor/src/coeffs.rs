//! The only unit conversion: [`Config`] in SI becomes coefficients per unit. Inside the supervisor
//! lengths are in clearances, forces in force caps, and time in ticks.

use crate::config::Config;
use crate::math::{exp_neg, max, min, sqrt};
use crate::vec2::Vec2;

/// Smallest share of the lift-off speed from which the damping law spends the whole cap.
const FULL_FORCE_FROM: f32 = 0.4;

/// Longest delay between a sample and its force \[ticks\].
pub(crate) const MAX_DELAY: usize = 8;

/// Immutable coefficients of the tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coeffs {
    /// Caps per newton.
    per_n: f32,
    /// Newtons per cap.
    pub(crate) force_max_n: f32,
    /// Acceleration at the retainer bearing by one cap of force \[clearances/tick²\].
    pub(crate) force_gain: f32,
    /// k·T²/m \[1/tick²\].
    pub(crate) stiffness: f32,
    /// d·T/m \[1/tick\].
    pub(crate) damping: f32,
    /// Share of the way that the delivered force goes in a tick towards the command.
    pub(crate) lag_step: f32,
    /// Mean over a tick of what is left of that way: (τ/T)·(1 − exp(−T/τ)).
    pub(crate) lag_mean: f32,
    /// Amplifier lag \[ticks\].
    pub(crate) lag: f32,
    /// Ticks between a sample and the start of its force.
    pub(crate) delay: usize,
    /// Mean time from a sample to the delivered force that answers it \[ticks\].
    pub(crate) horizon: f32,
    /// μ.
    pub(crate) friction: f32,
    /// e.
    pub(crate) restitution: f32,
    /// Backward speed that all impacts to come will add, per normal speed of the next one:
    /// μ(1 + e)(1 + e + e² + …) = μ(1 + e)/(1 − e).
    pub(crate) bounce_gain: f32,
    /// Observer gains (position, velocity, disturbance) in flight.
    pub(crate) flight_gains: [f32; 3],
    /// Observer gains (position, velocity) in contact.
    pub(crate) contact_gains: [f32; 2],
    /// Touching begins above this radius …
    pub(crate) touch_radius: f32,
    /// … and ends below this one.
    pub(crate) leave_radius: f32,
    /// Largest plausible radius.
    pub(crate) position_limit: f32,
    /// Filter step of the contact share, 1/ticks of the whirl time.
    pub(crate) contact_share_step: f32,
    /// Square of the lift-off speed at rest of a full inward force, F·c/m \[(clearances/tick)²\].
    pub(crate) slow_squared: f32,
    pub(crate) hold_share: f32,
    /// Force per speed of the damping law \[caps per clearance/tick\].
    pub(crate) damper: f32,
    pub(crate) whirl_ticks: u32,
    pub(crate) dwell_ticks: u32,
    /// Weight of the levitation controller gained per tick of hand-over.
    pub(crate) blend_step: f32,
    /// Weight of the force lost per tick of a fault.
    pub(crate) fault_step: f32,
    pub(crate) fault_ticks: u32,
    /// Clearances per metre at the sensor.
    per_sensor_m: f32,
    /// Cap of each axis \[caps\], at most 1 …
    pub(crate) axis_cap: f32,
    /// … and in newtons.
    pub(crate) axis_cap_n: f32,
    /// Longest change of the command in a tick \[N\].
    pub(crate) slew_step_n: f32,
    /// Continuous force \[caps\]; `None` without a budget.
    pub(crate) continuous: Option<f32>,
    /// Share of its way that the thermal state goes in a tick.
    pub(crate) thermal_step: f32,
    /// Weight of the force at the beginning of a tick in its mean, where both ends are measured.
    pub(crate) applied_weight: f32,
    /// Highest backward speed that the cap arrests \[clearances/tick\].
    pub(crate) whirl_limit: f32,
    pub(crate) coast_down_ticks: u32,
    pub(crate) severity_limit: f32,
    /// Farthest plausible way in a tick.
    pub(crate) way_per_tick: f32,
    /// Three steps of the sensor.
    pub(crate) sensor_steps: f32,
    /// Speed that the observer may make up in contact, being blind for the contact force.
    pub(crate) blind_speed: f32,
    /// Metres per second per unit of speed.
    pub(crate) speed_m_s: f32,
}

/// Least coefficient of friction in the whirl limit: without friction there is neither whirl nor limit.
const LEAST_FRICTION: f32 = 1e-3;

/// Highest backward speed that the cap can arrest \[m/s\]: where drive by friction, μ·N, and a force
/// tilted by the best angle atan μ are in balance, N = m·v²/r − k·r − F_inward, on the orbit r to which the
/// normal force at that speed bends the contact.
fn whirl_limit_m_s(config: &Config) -> f32 {
    let (m, d, c) = (config.mass_kg, config.damping_n_s_m, config.clearance_m);
    let mu = max(config.friction_coefficient, LEAST_FRICTION);
    let tilt = sqrt(1.0 + mu * mu);
    // What the actuator has in every direction.
    let force = min(config.force_max_n, config.axis_force_max_n) * config.magnet_plane_ratio;
    let normal = force / (mu * tilt);
    // The estimate is one of a thin ring; a bend of more than the clearance is beyond it.
    let r = c + min(normal / config.contact_stiffness_n_m, c);
    let held = mu * config.stiffness_n_m * r + force * tilt;
    let square = d * d + 4.0 * mu * m * held / r;
    if square > 0.0 {
        r / (2.0 * mu * m) * (d + sqrt(square))
    } else {
        0.0
    }
}

/// Weight of the force at the beginning of a tick in its mean over it, for a first-order lag: with
/// x = T/τ, 1/x − 1/(eˣ − 1). Half for a slow amplifier, nothing for one that follows at once.
fn applied_weight(lag_ticks: f32) -> f32 {
    if lag_ticks <= 0.0 {
        return 0.0;
    }
    let x = 1.0 / lag_ticks;
    if x < 0.5 {
        return 0.5 - x / 12.0;
    }
    let left = exp_neg(x);
    lag_ticks - left / (1.0 - left)
}

fn per_tick(time_s: f32, period_s: f32) -> f32 {
    1.0 / max(time_s / period_s, 1.0)
}

impl Coeffs {
    /// From a valid configuration.
    pub(crate) fn new(config: &Config) -> Self {
        let t = config.sample_period_s;
        let (c, f, m) = (config.clearance_m, config.force_max_n, config.mass_kg);
        let force_gain = config.magnet_plane_ratio * f * t * t / (m * c);
        let lag = config.amplifier_lag_s / t;
        let lag_step = if lag > 0.0 {
            1.0 - exp_neg(1.0 / lag)
        } else {
            1.0
        };
        // Whole ticks: the line of delayed commands knows no others.
        let delay = (config.delay_samples + 0.5) as usize;
        let horizon = delay as f32 + 0.5 + lag;
        let (mu, e) = (config.friction_coefficient, config.restitution);
        let (pole, free) = (
            config.observer_pole_flight,
            1.0 - config.observer_pole_flight,
        );
        let (touch_pole, touch_free) = (
            config.observer_pole_contact,
            1.0 - config.observer_pole_contact,
        );
        let stiffness = config.stiffness_n_m * t * t / m;
        // What the model may accelerate by while the wall holds against it.
        let blind = force_gain + 1.5 * max(stiffness, -stiffness);
        Self {
            per_n: 1.0 / f,
            force_max_n: f,
            force_gain,
            stiffness,
            damping: config.damping_n_s_m * t / m,
            lag_step,
            lag_mean: lag * lag_step,
            lag,
            delay,
            horizon,
            friction: mu,
            restitution: e,
            bounce_gain: mu * (1.0 + e) / (1.0 - e),
            // Critically damped fading-memory filters of second and first order.
            flight_gains: [
                1.0 - pole * pole * pole,
                1.5 * free * free * (1.0 + pole),
                free * free * free,
            ],
            contact_gains: [1.0 - touch_pole * touch_pole, touch_free * touch_free],
            touch_radius: 1.0 - config.contact_band,
            leave_radius: 1.0 - 1.5 * config.contact_band,
            position_limit: config.position_limit,
            contact_share_step: per_tick(config.whirl_time_s, t),
            slow_squared: force_gain,
            hold_share: config.hold_share,
            // A full force stops the speed of a full force within twice the reaction time, but that speed is
            // no smaller a share of the lift-off speed than this: below, noise would be all it damps.
            damper: 1.0
                / max(
                    force_gain * (2.0 * horizon + 2.0),
                    FULL_FORCE_FROM * sqrt(force_gain),
                ),
            whirl_ticks: (config.whirl_time_s / t) as u32,
            dwell_ticks: (config.handover_dwell_s / t) as u32,
            blend_step: per_tick(config.handover_blend_s, t),
            fault_step: per_tick(config.fault_blend_s, t),
            fault_ticks: config.fault_ticks as u32,
            per_sensor_m: config.retainer_plane_ratio / c,
            axis_cap: min(config.axis_force_max_n / f, 1.0),
            axis_cap_n: min(config.axis_force_max_n, f),
            slew_step_n: config.force_slew_n_s * t,
            continuous: (config.continuous_force_n < f).then_some(config.continuous_force_n / f),
            thermal_step: min(t / config.thermal_time_s, 1.0),
            applied_weight: applied_weight(lag),
            // Divided by in every severity.
            whirl_limit: max(whirl_limit_m_s(config) * t / c, 1e-6),
            coast_down_ticks: (config.coast_down_s / t) as u32,
            severity_limit: config.severity_limit,
            way_per_tick: config.speed_max_m_s * t / c,
            sensor_steps: 3.0 * config.sensor_step_m * config.retainer_plane_ratio / c,
            blind_speed: blind * (1.0 + touch_pole) / touch_free,
            speed_m_s: c / t,
        }
    }

    /// Position at the retainer bearing from one at the sensor.
    #[inline]
    pub(crate) fn position(&self, sensor_m: [f32; 2]) -> Vec2 {
        Vec2::from_array(sensor_m) * self.per_sensor_m
    }

    #[inline]
    pub(crate) fn force(&self, force_n: [f32; 2]) -> Vec2 {
        Vec2::from_array(force_n) * self.per_n
    }

    #[inline]
    pub(crate) fn force_n(&self, force: Vec2) -> [f32; 2] {
        (force * self.force_max_n).to_array()
    }
}
