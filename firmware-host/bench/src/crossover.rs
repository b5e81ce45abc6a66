//! Where the supervisor's damping ends: its force on a reading that vibrates.
//!
//! A runout, a shaft that bends, a second mode or noise moves what is read, and the force does not change that motion. For
//! small signals in flight the supervisor is then a linear sampled system with the reading y as its input. With the state
//! x = (p, v, l), per unit, and what is behind by a tick as 1/z, z = e^(jωT):
//!
//! ```text
//! f = −N·x,                 N = (R, D, (1 − R/0.95)/h)           the law: (5.5), (5.10c), (5.10e)
//! x⁻ = A·x/z + B·f̄         A, B: (5.6), a tick of the model under the mean force f̄
//! x = x⁻ + G·(y − p⁻)       G = (α, β/h, γ/h): (5.7)
//! f̄ = M·f                   M = z^(−n−1)·(1 − λ + λ·(1 − q)/(z − q)),   q = e^(−T/τ),  λ = (τ/T)·(1 − q): (5.6a)
//! ```
//!
//! Of what swings at a configured frequency the observer takes its own part Q·ν out of the reading, ν being what is left:
//!
//! ```text
//! ν = (y − p⁻)/(1 + Σ Q),   Q = ½·(w·g/(z − w) + w̄·ḡ/(z − w̄)),   w = e^(jω_bT):  (5.7b);   G/(1 + Σ Q) in the place of G
//! ```
//!
//! With E = (1, 0, 0) that is (1 − (1 − G·E)·(A/z − M·B·N))·x = G·y. What comes back to the rotor is the command n ticks
//! late, held for a tick, and behind the amplifier. Of what a hold makes at other frequencies nothing works against this one:
//!
//! ```text
//! f(jω) = −N·x·z^(−n)·(1 − 1/z)/(jωT)/(1 + jωτ)
//! c_eq = −Re(f(jω)/(jω·y))                                       its mean power is −c_eq·(speed of the vibration)²/2
//! ```

use crate::bisection::by_logarithm;
use nalgebra::{Complex, Matrix3, RowVector3, Vector3};
use std::f64::consts::TAU;
use supervisor::Config;

type C = Complex<f64>;

/// As in (5.5): the speed from which damping spends the whole force is no smaller share of the lift-off speed.
const FULL_FORCE_FROM: f64 = 0.4;
/// As in (5.10c) and (5.10e): the restoring share where forces come soon.
const NEARLY_ALL: f64 = 0.95;

/// As in (5.7b).
const LEARNT: f64 = 1.0 / 8.0;
const CENTRE: f64 = 0.97;

/// Frequencies that are looked at, evenly by their logarithm, up to half the rate of the loop and down to this share of it.
const FREQUENCIES: u32 = 1500;
const LOWEST_SHARE: f64 = 1e-4;

/// The supervisor in flight, for small signals.
#[derive(Debug, Clone, Copy)]
pub struct SmallSignals {
    /// A, B, N, G of the module.
    model: Matrix3<f64>,
    input: Vector3<f64>,
    law: RowVector3<f64>,
    gains: Vector3<f64>,
    /// w and g of the configured bending modes that are kept apart.
    kept_apart: [Option<[C; 2]>; 2],
    period_s: f64,
    lag_s: f64,
    delay: u32,
    /// A cap per clearance of the reading \[N/m\].
    unit_n_m: f64,
}

/// Where damping ends, and how much is beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossover {
    /// Lowest frequency above which the force drives \[Hz\]; 0 where it damps at none.
    pub frequency_hz: f64,
    /// The most that it drives with above that, as a negative damping turned round \[N s/m\] …
    pub driving_n_s_m: f64,
    /// … and where \[Hz\].
    pub driving_hz: f64,
}

impl SmallSignals {
    /// For a valid configuration, without a known spin.
    pub fn new(config: &Config) -> Self {
        let of = f64::from;
        let (c, cap_n) = (of(config.clearance_m), of(config.force_max_n));
        let levered_n = of(config.magnet_plane_ratio) * cap_n;
        let unit_s = (of(config.mass_kg) * c / levered_n).sqrt();
        let (period_s, lag_s) = (of(config.sample_period_s), of(config.amplifier_lag_s));
        let h = period_s / unit_s;
        let delay = config.delay_samples.round();
        let horizon = (of(delay) + 0.5) * h + lag_s / unit_s;

        let stiffness = of(config.stiffness_n_m) * c / levered_n;
        let damping = of(config.damping_n_s_m) * unit_s / of(config.mass_kg);
        let pull = (-stiffness).max(0.0);
        let damper = 1.0 / (2.0 * (horizon + h)).max(FULL_FORCE_FROM);
        let restoring =
            (pull + (damper / horizon - pull).max(0.0) / 3.0).min(NEARLY_ALL.max(1.5 * pull));
        let carrying = (1.0 - restoring / NEARLY_ALL).max(0.0);

        // What position, velocity and load add to the velocity in a tick.
        let adds = RowVector3::new(-stiffness * h, -(damping + stiffness * h / 2.0) * h, 1.0);
        let mut model = Matrix3::identity();
        model[(0, 1)] = h;
        model.set_row(0, &(model.row(0) + adds * (h / 2.0)));
        model.set_row(1, &(model.row(1) + adds));

        let pole = of(config.observer_pole_flight);
        let free = 1.0 - pole;
        Self {
            model,
            input: Vector3::new(h * h / 2.0, h, 0.0),
            law: RowVector3::new(restoring, damper, carrying / h),
            gains: Vector3::new(
                1.0 - pole.powi(3),
                1.5 * free * free * (1.0 + pole) / h,
                free.powi(3) / h,
            ),
            kept_apart: [config.bending_first_hz, config.bending_second_hz].map(|hz| {
                let turn = C::from_polar(1.0, TAU * CENTRE * of(hz) * period_s);
                let left = (1.0 - turn.conj()) / (1.0 - pole * turn.conj());
                (config.keeps_apart(hz)).then(|| [turn, LEARNT / left.powu(3)])
            }),
            period_s,
            lag_s,
            delay: delay as u32,
            unit_n_m: cap_n * of(config.retainer_plane_ratio) / c,
        }
    }

    /// Half the rate of the loop \[Hz\]: faster vibrations look like slower ones.
    pub fn nyquist_hz(&self) -> f64 {
        0.5 / self.period_s
    }

    /// c_eq: the damping that a small vibration of the reading feels \[N s/m\]; negative where the force drives it. None at a
    /// frequency at which the observer and its own force oscillate by themselves.
    pub fn damping_n_s_m(&self, frequency_hz: f64) -> Option<f64> {
        let one = C::from(1.0);
        // jω and 1/z.
        let rate = C::new(0.0, TAU * frequency_hz);
        let back = (-rate * self.period_s).exp();
        let left = match self.lag_s > 0.0 {
            true => (-self.period_s / self.lag_s).exp(),
            false => 0.0,
        };
        let mean_left = self.lag_s / self.period_s * (1.0 - left);
        let late = back.powu(self.delay);
        let follows = back * (1.0 - left) / (one - back * left);
        let mean = late * back * (follows * mean_left + (1.0 - mean_left));

        let swings = |[turn, gain]: [C; 2]| {
            let part = |w: C, g: C| w * g * back / (one - w * back);
            (part(turn, gain) + part(turn.conj(), gain.conj())) * 0.5
        };
        let apart: C = self.kept_apart.into_iter().flatten().map(swings).sum();
        let gains = self.gains.map(C::from) / (one + apart);
        let mut kept = Matrix3::<C>::identity();
        kept.set_column(0, &(kept.column(0) - gains));
        let own_force = (self.input * self.law).map(C::from) * mean;
        let tick = self.model.map(C::from) * back - own_force;
        let matrix = Matrix3::identity() - kept * tick;
        let state = matrix.lu().solve(&gains)?;
        let command = -(self.law.map(C::from) * state)[0];
        let held = (one - back) / (rate * self.period_s);
        let delivered = command * late * held / (rate * self.lag_s + 1.0);
        Some(-(delivered / rate).re * self.unit_n_m)
    }

    /// `None` where every vibration up to half the rate of the loop is damped.
    pub fn crossover(&self) -> Option<Crossover> {
        let damps = |hz: f64| self.damping_n_s_m(hz).is_none_or(|damping| damping >= 0.0);
        let step = |i: u32| {
            let share = f64::from(i) / f64::from(FREQUENCIES);
            self.nyquist_hz() * LOWEST_SHARE.powf(1.0 - share)
        };
        // Where forces come late, a slow vibration may be driven, too.
        let damped = (0..=FREQUENCIES).find(|i| damps(step(*i)));
        let from = damped.unwrap_or(0);
        let first = (from..=FREQUENCIES).find(|i| !damps(step(*i)))?;
        let frequency_hz = match damped {
            Some(_) => by_logarithm((step(first - 1), step(first)), 1e-9, damps).1,
            None => 0.0,
        };
        let most = (first..=FREQUENCIES)
            .filter_map(|i| Some((-self.damping_n_s_m(step(i))?, step(i))))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Crossover {
            frequency_hz,
            driving_n_s_m: most.0,
            driving_hz: most.1,
        })
    }
}
