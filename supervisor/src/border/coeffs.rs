//! The only unit conversion: [`Config`] in SI becomes coefficients per unit.
//!
//! Lengths are in clearances c, forces in force caps F, and time is in units of t₀ = √(m·c/F), in which the
//! full force moves a rotor at rest by half a clearance. The unit of speed, c/t₀, is then the lift-off speed
//! of the full force, and acceleration is force. In these units all that counts is near 1, which is what
//! fixed point needs; a tick is h = T/t₀, some hundredths.

use crate::border::config::{Config, NotRepresentable};
use crate::border::modes::Modes;
use crate::border::signal::{Command, CoreCommand, CoreSample, Sample};
use crate::number::scalar::{Accumulator, Scalar, exp_neg, max, min, sqrt};
use crate::number::vec2::Vec2;

/// Smallest share of the lift-off speed from which the damping law spends the whole cap.
const FULL_FORCE_FROM: f32 = 0.4;
/// Most speed that the force of a contact may still give after it \[lift-off speeds\].
const AFTER_LIFT_OFF: f32 = 0.45;
/// Turn of the swing on the wall until a force has come, beyond which an impact is half over by then \[rad\].
const MOST_CONTACT_TURN: f32 = 1.4;
/// Rate of the swing on a wall that gives way by much of the clearance \[1/t₀\].
const SOFT_CONTACT: f32 = 6.5;
/// Largest share of the cap that the restoring law has at the wall.
pub(crate) const NEARLY_ALL: f32 = 0.95;

/// Window of the judge of the model \[t₀\], and its least \[ticks\].
const WINDOW: f32 = 6.0;
const LEAST_WINDOW: f32 = 32.0;
/// Loads of so many caps there are in a shock: what they do in a tick is no cause for doubt, nor is so little \[clearances\].
const SHOCK: f32 = 8.0;
const LEAST_DOUBTED: f32 = 0.02;
/// Noise of the estimated speed (root mean square, of a coordinate) by which an approach can still be detected \[lift-off speeds\].
const QUIET_SPEED: f32 = 0.1;

/// Longest delay between a sample and its force \[ticks\].
pub(crate) const MAX_DELAY: usize = 8;

/// The cap falls from full to continuous while the thermal state goes from 1 to this much more. The force
/// at which it comes to rest exceeds the continuous one by less than half as much.
pub(crate) const FALL: f32 = 0.1;

/// What one unit is in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling {
    /// A position of 1 \[m\] at the retainer bearing.
    pub length_m: f32,
    /// A force of 1 \[N\].
    pub force_n: f32,
    /// Clearances per metre at the *sensor*: what a measured position is multiplied by.
    pub position_per_m: f32,
    /// Caps per newton: what a force is multiplied by. A unit in the last place low, so that the whole cap
    /// does not become more than one.
    pub force_per_n: f32,
    /// A time of 1, t₀ \[s\]: what a spin in rad/s is multiplied by.
    pub time_s: f32,
}

impl Scaling {
    /// A speed of 1 \[m/s\].
    pub fn speed_m_s(&self) -> f32 {
        self.length_m / self.time_s
    }

    /// A sample per unit.
    #[inline]
    pub fn sample(&self, sample: &Sample) -> CoreSample<f32> {
        let forces = |v: [f32; 2]| v.map(|x| x * self.force_per_n);
        CoreSample {
            sequence: sample.sequence,
            status: sample.status,
            position: sample.position_m.map(|x| x * self.position_per_m),
            spin: sample.spin_rad_s * self.time_s,
            levitation: forces(sample.levitation_n),
            applied: forces(sample.applied_n),
        }
    }

    /// A command in SI.
    #[inline]
    pub fn command<S: Scalar>(&self, command: &CoreCommand<S>) -> Command {
        let newtons = |force: [S; 2]| force.map(|x| x.to_f32() * self.force_n);
        Command {
            force_n: newtons(command.force),
            own_n: newtons(command.own),
            mode: command.mode,
            limits: command.limits,
            events: command.events,
            integrator: command.integrator,
            severity: command.severity.to_f32(),
        }
    }
}

impl Config {
    /// Units of the supervisor's core for this bearing: constants for firmware without floating point.
    pub fn scaling(&self) -> Scaling {
        let force_n = self.force_max_n;
        Scaling {
            length_m: self.clearance_m,
            force_n,
            position_per_m: self.retainer_plane_ratio / self.clearance_m,
            force_per_n: (1.0 / force_n) * (1.0 - f32::EPSILON),
            // With the force as it is at the retainer bearing.
            time_s: sqrt(self.mass_kg * self.clearance_m / (self.magnet_plane_ratio * force_n)),
        }
    }
}

/// Rate of a slow sum.
pub(crate) type RateOf<S> = <<S as Scalar>::Accumulator as Accumulator<S>>::Rate;

/// What samples are judged by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GuardCoeffs<S> {
    /// Largest plausible radius.
    pub(crate) position_limit: S,
    pub(crate) fault_ticks: u16,
    /// Farthest plausible way in a tick.
    pub(crate) way_per_tick: S,
    /// Three steps of the sensor, or the shortest way there is, as a sum of speeds over ticks.
    pub(crate) sensor_speeds: S,
    /// Mean distance of a sample from where it was expected, of the configured noise; and up to which of it the speed is
    /// known well enough to tell an approach by.
    pub(crate) configured_noise: S,
    pub(crate) quiet_noise: S,
    /// How far off a sample may be that is not doubted, whatever the noise.
    pub(crate) never_doubted: S,
}

/// What the observer follows samples by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ObserverCoeffs<S> {
    /// Observer gains (position by position, velocity and load step by difference quotient) in flight.
    pub(crate) flight_gains: [S; 3],
    /// Half of how far its load is behind \[ticks\]: three poles ρ with ρ/(1 − ρ) each, and the tick itself.
    pub(crate) flight_lag: S,
    /// Gains in contact, where there is no load.
    pub(crate) contact_gains: [S; 2],
    /// Weight of the force at the beginning of a tick in its mean, where both ends are measured.
    pub(crate) applied_weight: S,
    /// Being blind for the contact force, the observer makes up a speed of so much times the acceleration of all others.
    pub(crate) blind_time: S,
}

/// What the force–time budget goes by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BudgetCoeffs<S: Scalar> {
    /// Continuous force \[caps\], where there is a force–time budget.
    pub(crate) continuous: Option<S>,
    /// Share of its way that the thermal state goes in a tick.
    pub(crate) thermal_rate: RateOf<S>,
}

/// Immutable coefficients of the tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coeffs<S: Scalar> {
    pub(crate) scaling: Scaling,
    /// h, a tick \[t₀\], and ticks per t₀.
    pub(crate) tick: S,
    pub(crate) per_tick: S,
    /// κ = k·c/F, F the cap with its leverage at the retainer bearing.
    pub(crate) stiffness: S,
    /// 1/|κ| where the magnets pull: the radius up to which the cap holds against them, at most 100.
    pub(crate) per_pull: S,
    /// Speed that the shaft takes in a tick per position, κ·h, and with the damping δ = d·(c/t₀)/F per speed,
    /// (δ + κ·h/2)·h.
    pub(crate) stiffness_step: S,
    pub(crate) damping_step: S,
    /// Share of the way from the delivered force to the command that is left after a tick, and its mean
    /// over the tick: exp(−T/τ) and (τ/T)·(1 − exp(−T/τ)).
    pub(crate) lag_left: S,
    pub(crate) lag_mean: S,
    /// Amplifier lag \[t₀\].
    pub(crate) lag: S,
    /// Ticks between a sample and the start of its force.
    pub(crate) delay: u8,
    /// Time from a sample to the middle of the tick in which its force begins \[t₀\].
    pub(crate) delay_time: S,
    /// Mean time from a sample to the delivered force that answers it \[t₀\].
    pub(crate) horizon: S,
    /// μ, and a hair less than 1/√(1 + μ²).
    pub(crate) friction: S,
    pub(crate) tilt: S,
    /// e.
    pub(crate) restitution: S,
    /// Backward speed that all impacts to come will add, per normal speed of the next one:
    /// μ(1 + e)(1 + e + e² + …) = μ(1 + e)/(1 − e).
    pub(crate) bounce_gain: S,
    /// By how much the rotor swings on a wall that gives way until a force has come, as cosine and sine, and how fast \[1/t₀\];
    /// nothing where an impact is half over by then.
    pub(crate) contact_ahead: Option<[S; 3]>,
    /// Touching begins above this radius …
    pub(crate) touch_radius: S,
    /// … and ends below this one.
    pub(crate) leave_radius: S,
    /// Filter step of the contact share, 1/ticks of the whirl time.
    pub(crate) contact_share_step: S,
    /// Share of the cap that holds a rotor which has just come to rest on the wall.
    pub(crate) hold_share: S,
    /// Force per speed of the damping law.
    pub(crate) damper: S,
    /// Most force per way of the restoring law in flight \[caps per clearance\].
    pub(crate) restoring: S,
    /// Most force inwards in an impact or a whirl \[caps\].
    pub(crate) pressing: S,
    pub(crate) whirl_ticks: u32,
    pub(crate) dwell_ticks: u32,
    /// For which a controller that comes no nearer to being ready is waited for.
    pub(crate) patience_ticks: u32,
    /// Weight of the levitation controller gained per tick of hand-over.
    pub(crate) blend_step: S,
    /// Force lost per tick of a fault of the sensor \[caps\].
    pub(crate) fault_step: S,
    /// Cap of each axis \[caps\], at most 1.
    pub(crate) axis_cap: S,
    /// A hair less than the longest change of the command in a tick \[caps\], so that rounding keeps it.
    pub(crate) slew_step: S,
    /// 1 over the highest backward speed that the cap arrests.
    pub(crate) per_whirl_limit: S,
    pub(crate) coast_down_ticks: u32,
    pub(crate) severity_limit: f32,
    /// Share of the severity limit per square of speed.
    pub(crate) index_rate: RateOf<S>,
    /// Ticks of a window of [`crate::decide::trust`], less one.
    pub(crate) window_ticks: u16,
    /// Configured bending modes that can be kept apart.
    pub(crate) bending: Option<Modes<S>>,
    /// Whether it acts from the approach on, and not on evident backward whirl alone.
    pub(crate) acts_in_flight: bool,
    /// Square of a speed that is no approach.
    pub(crate) ease_square: S,
    pub(crate) guard: GuardCoeffs<S>,
    pub(crate) observer: ObserverCoeffs<S>,
    pub(crate) budget: BudgetCoeffs<S>,
}

/// Shortest way \[clearances\] that the estimate is sure of: a rotor at rest before a sensor without noise may seem to go round
/// so far by an unbalance that was learned elsewhere.
const LEAST_WAY: f32 = 2e-3;

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

/// Takes coefficients over into `S`, and remembers the first that does not fit.
struct Taken {
    lost: Option<NotRepresentable>,
}

impl Taken {
    #[inline(never)]
    fn rate<S: Scalar>(&mut self, name: &'static str, x: f32) -> RateOf<S> {
        if self.lost.is_none() && !S::Accumulator::holds(x) {
            self.lost = Some(NotRepresentable {
                coefficient: name,
                value: x,
            });
        }
        S::Accumulator::rate(x)
    }

    // One copy: forty coefficients come through here once.
    #[inline(never)]
    fn of<S: Scalar>(&mut self, name: &'static str, x: f32) -> S {
        if self.lost.is_none() && !S::represents(x) {
            self.lost = Some(NotRepresentable {
                coefficient: name,
                value: x,
            });
        }
        S::from_f32(x)
    }
}

/// Of a controller that comes no nearer to being ready \[t₀\].
const PATIENCE: f32 = 40.0;

/// A rotor within this radius, and the axis within this of it, may be at ease.
pub(crate) const INSIDE: f32 = 0.49;
pub(crate) const BESIDE: f32 = 0.25;

/// Square of the speed that a quarter of the cap stops before the wall from [`INSIDE`] on, with the axis [`BESIDE`] it, under
/// this pull of the magnets; a tenth less, for rounding.
fn ease_square(pull: f32, horizon: f32) -> f32 {
    let reach = min(1.0 - BESIDE, 0.25 / max(pull, 0.01));
    let room = max(reach - INSIDE, 0.0);
    // v² = 2·(room − v·τ)/4 − pull·room·(reach + r).
    let square = max(0.5 * room - pull * room * (reach + INSIDE), 0.0);
    let half = 0.25 * horizon;
    let speed = sqrt(half * half + square) - half;
    0.9 * speed * speed
}

/// Force per speed of the damping law, and per way of the restoring one.
fn gains(pull: f32, h: f32, horizon: f32) -> (f32, f32) {
    // A full force stops the speed of a full force within twice the reaction time, but that speed is
    // no smaller a share of the lift-off speed than this: below, noise would be all it damps.
    let damper = 1.0 / max(2.0 * (horizon + h), FULL_FORCE_FROM);
    let restoring = min(
        pull + max(damper / horizon - pull, 0.0) / 3.0,
        max(NEARLY_ALL, 1.5 * pull),
    );
    (damper, restoring)
}

/// Cosine and sine of the swing on a wall that gives way until a force has come, and its rate; `None` where the wall is too hard
/// for a force to come in time.
fn contact_ahead(config: &Config, horizon: f32) -> Option<[f32; 3]> {
    let force_n = config.magnet_plane_ratio * config.force_max_n;
    let rate = sqrt(config.contact_stiffness_n_m * config.clearance_m / force_n);
    let turn = rate * horizon;
    let Vec2 { x, y } = Vec2::<f32>::at_angle(turn);
    (rate < SOFT_CONTACT && turn < MOST_CONTACT_TURN).then_some([x, y, rate])
}

impl<S: Scalar> GuardCoeffs<S> {
    /// `h`: a tick \[t₀\].
    fn new(config: &Config, h: f32, taken: &mut Taken) -> Self {
        let (t, c) = (config.sample_period_s, config.clearance_m);
        let pole = config.observer_pole_flight;
        let free = 1.0 - pole;
        let sensor_steps = 3.0 * config.sensor_step_m * config.retainer_plane_ratio / c;
        // Mean length of the difference of two samples, each against where this observer expected it, per noise of a coordinate:
        // by the filter (1 − z⁻¹)⁴/(1 − ρ·z⁻¹)³ to within 8 %.
        let twice = 2.0 / (1.0 + pole);
        let per_noise = 1.77 * twice * twice * twice;
        let configured_noise = per_noise * sensor_steps / 3.0;
        let speed_noise = sqrt(
            free * free * free * (13.0 + 50.0 * pole + 49.0 * pole * pole) / 2.0 / (1.0 + pole),
        ) / (1.0 + pole)
            / (1.0 + pole);
        let quiet_noise = max(
            per_noise * QUIET_SPEED * h / speed_noise,
            2.5 * configured_noise,
        );
        let mut s = |name, x| taken.of::<S>(name, x);
        Self {
            position_limit: s("position limit", config.position_limit),
            fault_ticks: config.fault_ticks as u16,
            way_per_tick: s("largest speed", config.speed_max_m_s * t / c),
            sensor_speeds: s("sensor step", max(sensor_steps, LEAST_WAY) / h),
            configured_noise: s("sensor step", min(configured_noise, 0.5)),
            quiet_noise: s("sensor step", quiet_noise),
            never_doubted: s("tick", max(0.5 * SHOCK * h * h, LEAST_DOUBTED)),
        }
    }
}

impl<S: Scalar> ObserverCoeffs<S> {
    /// `h`: a tick \[t₀\].
    fn new(config: &Config, h: f32, taken: &mut Taken) -> Self {
        let (pole, touch_pole) = (config.observer_pole_flight, config.observer_pole_contact);
        let (free, touch_free) = (1.0 - pole, 1.0 - touch_pole);
        let mut s = |name, x| taken.of::<S>(name, x);
        Self {
            // Critically damped fading-memory filters of second and first order.
            flight_gains: [
                s("observer gain", 1.0 - pole * pole * pole),
                s("observer gain", 1.5 * free * free * (1.0 + pole)),
                s("observer gain", free * free * free),
            ],
            flight_lag: s("observer lag", 1.5 * pole / free + 0.5),
            contact_gains: [
                s("observer gain", 1.0 - touch_pole * touch_pole),
                s("observer gain", touch_free * touch_free),
            ],
            applied_weight: s(
                "lag",
                applied_weight(config.amplifier_lag_s / config.sample_period_s),
            ),
            blind_time: s("observer", h * (1.0 + touch_pole) / touch_free),
        }
    }
}

impl<S: Scalar> BudgetCoeffs<S> {
    fn new(config: &Config, taken: &mut Taken) -> Self {
        // From the cap on there is no budget.
        let continuous = min(config.continuous_force_n / config.force_max_n, 1.0);
        // Not so fast that the ticks of a gap together overshoot. Without a budget any will do.
        let rate = if continuous < 1.0 {
            min(config.sample_period_s / config.thermal_time_s, 0.25)
        } else {
            1.0
        };
        let thermal_rate = taken.rate::<S>("thermal time", rate);
        // What the fall of the cap is divided by has to be more than some last places.
        if continuous < 1.0 {
            let _: S = taken.of(
                "continuous force",
                1.0 / (64.0 * FALL * continuous * continuous),
            );
        }
        Self {
            continuous: (continuous < 1.0).then_some(taken.of("continuous force", continuous)),
            thermal_rate,
        }
    }
}

impl<S: Scalar> Coeffs<S> {
    /// From a valid configuration, with the first coefficient that `S` cannot hold. `f32` holds all.
    pub(crate) fn new(config: &Config) -> (Self, Option<NotRepresentable>) {
        let t = config.sample_period_s;
        let (c, f) = (config.clearance_m, config.force_max_n);
        let scaling = config.scaling();
        let unit_s = scaling.time_s;
        let h = t / unit_s;
        let lag = config.amplifier_lag_s / t;
        let lag_left = if lag > 0.0 { exp_neg(1.0 / lag) } else { 0.0 };
        // Whole ticks: the line of delayed commands knows no others.
        let delay = (config.delay_samples + 0.5) as u8;
        let delay_ticks = delay as f32 + 0.5;
        let horizon = (delay_ticks + lag) * h;
        let (mu, e) = (config.friction_coefficient, config.restitution);
        // Acceleration at the retainer bearing by one cap is 1 by the choice of units.
        let stiffness = config.stiffness_n_m * c / (config.magnet_plane_ratio * f);
        let damping = config.damping_n_s_m * unit_s / config.mass_kg;
        let pull = max(-stiffness, 0.0);
        let (damper, restoring) = gains(pull, h, horizon);
        // Divided by in every severity.
        let whirl_limit = max(whirl_limit_m_s(config) / scaling.speed_m_s(), 1e-6);
        let mut taken = Taken { lost: None };
        let budget = BudgetCoeffs::new(config, &mut taken);
        let index_rate = 1.0 / whirl_limit / whirl_limit / config.severity_limit;
        let index_rate = taken.rate::<S>("severity limit", index_rate);
        // More than twice the cap binds nothing; less than what has an inverse would bind for ever.
        let slew_step = min(config.force_slew_n_s * t / f, 4.0);
        let _: S = taken.of("slew limit", 1.0 / slew_step);
        let guard = GuardCoeffs::new(config, h, &mut taken);
        let observer = ObserverCoeffs::new(config, h, &mut taken);
        let mut s = |name, x| taken.of::<S>(name, x);
        let coeffs = Self {
            contact_ahead: contact_ahead(config, horizon)
                .map(|swing| swing.map(|x| s("contact stiffness", x))),
            scaling,
            tick: s("tick", h),
            per_tick: s("ticks per unit of time", 1.0 / h),
            stiffness: s("stiffness", stiffness),
            per_pull: s("stiffness", 1.0 / max(pull, 0.01)),
            stiffness_step: s("stiffness", stiffness * h),
            damping_step: s("damping", (damping + 0.5 * stiffness * h) * h),
            lag_left: s("lag", lag_left),
            lag_mean: s("lag", lag * (1.0 - lag_left)),
            lag: s("lag", lag * h),
            delay,
            delay_time: s("delay", delay_ticks * h),
            horizon: s("horizon", horizon),
            friction: s("friction", mu),
            tilt: s("friction", f32::JUST_BELOW_ONE / sqrt(1.0 + mu * mu)),
            restitution: s("restitution", e),
            bounce_gain: s("bounce gain", mu * (1.0 + e) / (1.0 - e)),
            touch_radius: s("contact band", 1.0 - config.contact_band),
            leave_radius: s("contact band", 1.0 - 1.5 * config.contact_band),
            contact_share_step: s("whirl time", per_tick(config.whirl_time_s, t)),
            hold_share: s("hold share", config.hold_share),
            damper: s("damper", damper),
            // A restoring force K·x that is τ late drives by K·τ·v what the damper takes D·v from: from |κ|, which it
            // has to overcome, a third of the way to where they are equal.
            restoring: s("restoring", restoring),
            // It goes on for a while after lift-off, towards the other side.
            pressing: s("pressing", min(config.hold_share, AFTER_LIFT_OFF / horizon)),
            whirl_ticks: (config.whirl_time_s / t) as u32,
            dwell_ticks: (config.handover_dwell_s / t) as u32,
            patience_ticks: (PATIENCE / h) as u32,
            blend_step: s("hand-over blend", per_tick(config.handover_blend_s, t)),
            fault_step: s("fault blend", per_tick(config.fault_blend_s, t)),
            axis_cap: s("axis cap", min(config.axis_force_max_n / f, 1.0)),
            slew_step: s("slew limit", slew_step) * S::JUST_BELOW_ONE,
            budget,
            guard,
            observer,
            per_whirl_limit: s("whirl limit", 1.0 / whirl_limit),
            coast_down_ticks: (config.coast_down_s / t) as u32,
            severity_limit: config.severity_limit,
            index_rate,
            window_ticks: min(max(WINDOW / h, LEAST_WINDOW), 60000.0) as u16,
            bending: Modes::new(config),
            acts_in_flight: config.acts_in_flight >= 0.5,
            ease_square: s("speed", ease_square(pull, horizon)),
        };
        (coeffs, taken.lost)
    }
}
