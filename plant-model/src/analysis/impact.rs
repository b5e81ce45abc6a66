//! What becomes of a single impact that is left to itself: backward whirl, or free vibration; and the
//! lowest speed that ends in whirl.
//!
//! *Whirl*: the backward tangential speed in contact reaches a multiple of v_t,crit of
//! [`super::onset`]. Above v_t,crit itself friction gains on damping as long as contact lasts, but the
//! rotor may still leave the wall; a multiple leaves no doubt, and which one hardly moves the result. Where the surfaces
//! roll below the multiple, it is whirl if v_t,crit is still passed, in contact, when the time is over.
//!
//! *Free*: the rotor can never touch again: the ellipse and the circle that it is on in flight (`free_flight`) end before the
//! nearest wall, c·(1 − ε) out of round, so that no run has to wait for vibrations to decay. Rings swing on after the touch and may come to meet the rotor: their
//! energy E only falls, so the inner one never goes farther than s = √(2E·Σ 1/k), the sum over the mountings between it
//! and the ground; that much is added. A ring that moves or is displaced without a spring may be anywhere.
//!
//! Without unbalance the whole is symmetric about the centre: from touch to touch only the normal and
//! the tangential speed count, not where on the wall. With unbalance its phase comes in as well.

mod many;

use super::onset::{critical_tangential_speed_m_s, driving_coefficient};
use crate::contact::restitution_of;
use crate::free_flight::FreeFlight;
use crate::params::{ContactLaw, PlantParams, RingParams, SpinParams, Start, StatorParams};
use crate::plant::build;
use crate::vector::Body;
use crate::{BuildError, Inputs, Options, PlantError, Snapshot, V2};
use std::f64::consts::{FRAC_PI_2, TAU};

pub use many::{Tried, critical_speeds_m_s, run_impacts};

/// An impact: the rotor at the wall, concentric stator at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Speed, all of it \[m/s\].
    pub speed_m_s: f64,
    /// From the outward normal into the direction of backward whirl \[rad\]; 0 is a radial impact.
    pub inclination_rad: f64,
    /// Spin Ω \[rad/s\].
    pub spin_rad_s: f64,
    /// Angle of the unbalance at the touch, from the outward normal \[rad\].
    pub spin_phase_rad: f64,
}

/// An impact whose speed is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// As of [`Impact`], between −π/2 and π/2.
    pub inclination_rad: f64,
    /// As of [`Impact`].
    pub spin_rad_s: f64,
    /// As of [`Impact`].
    pub spin_phase_rad: f64,
}

impl Aim {
    fn at(self, speed_m_s: f64) -> Impact {
        Impact {
            speed_m_s,
            inclination_rad: self.inclination_rad,
            spin_rad_s: self.spin_rad_s,
            spin_phase_rad: self.spin_phase_rad,
        }
    }
}

impl Impact {
    /// Sign of v_w in backward whirl.
    fn backward(&self) -> f64 {
        if self.spin_rad_s < 0.0 { 1.0 } else { -1.0 }
    }
}

/// When a run is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criterion {
    /// Whirl is a backward tangential speed in contact of so many times v_t,crit.
    pub whirl_multiple: f64,
    /// Time after which a run is given up as [`Outcome::Undecided`] \[s\] …
    pub limit_s: f64,
    /// … or after so many periods of the shaft where they last longer, up to 300 s.
    pub limit_periods: f64,
    /// Accuracy.
    pub options: Options,
}

/// Longest time that a run is given for periods that hardly end.
const LONGEST_S: f64 = 300.0;

impl Default for Criterion {
    /// Twice v_t,crit, 3 s or 30 periods, the tolerance of [`Options`].
    fn default() -> Self {
        Self {
            whirl_multiple: 2.0,
            limit_s: 3.0,
            limit_periods: 30.0,
            options: Options::default(),
        }
    }
}

impl Criterion {
    fn limit_s(&self, params: &PlantParams) -> f64 {
        let natural_rad_s = (params.rotor.stiffness_n_m / params.rotor.mass_kg).sqrt();
        // Without a shaft there is no period; it has the time as it is.
        let periods_s = if natural_rad_s > 0.0 {
            (self.limit_periods * TAU / natural_rad_s).min(LONGEST_S)
        } else {
            0.0
        };
        self.limit_s.max(periods_s)
    }
}

/// What an impact ended in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Backward whirl.
    Whirl,
    /// Free vibration that never touches again, whatever rings do.
    Free,
    /// Neither within the time allowed.
    Undecided,
}

/// An impact and what followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactOutcome {
    /// What it ended in.
    pub outcome: Outcome,
    /// Touches until one at whose start or end the backward speed had passed v_t,crit, that one included; `None` if none had.
    pub impacts_to_threshold: Option<u32>,
}

/// Why nothing can be said of an impact.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImpactError {
    /// Friction drives nothing: no impact ends in whirl.
    #[error("friction drives nothing")]
    NoFriction,
    /// The stiffness is negative, so that friction drives the rotor from any speed.
    #[error("the rotor's stiffness is negative: friction drives it from any speed")]
    NotHeld,
    /// It does not come from inside.
    #[error("the inclination of an impact lies between -90 and 90 degrees")]
    Inclination,
    /// A run that cannot be trusted.
    #[error(transparent)]
    Plant(#[from] PlantError),
    /// Parameters out of range.
    #[error(transparent)]
    Build(#[from] BuildError),
}

/// How far a run goes between two looks at it \[s\]: a share of a contact or of a turn of the shaft.
const LOOK_S: f64 = 2e-3;

/// Runs an impact until it is decided.
///
/// # Errors
/// [`ImpactError`].
pub fn run_impact(
    params: &PlantParams,
    impact: &Impact,
    criterion: &Criterion,
) -> Result<ImpactOutcome, ImpactError> {
    let threshold = threshold_m_s(params)?;
    let limit_s = criterion.limit_s(params);
    let backward = impact.backward();
    let start = start_of(params, impact);
    let mut plant = build(params, &start, criterion.options)?;
    let (mut impacts, mut touching, mut to_threshold) = (0_u32, false, None);
    let mut follow = |now: &Snapshot| {
        impacts += u32::from(now.mode.in_contact() && !touching);
        touching = now.mode.in_contact();
        if to_threshold.is_none() && backward * now.contact_tangential_speed_m_s >= threshold {
            to_threshold = Some(impacts);
        }
    };
    let mut looks = 0_u32;
    let outcome = loop {
        looks += 1;
        let t_s = f64::from(looks) * LOOK_S;
        if t_s > limit_s {
            let now = plant.snapshot();
            let passed = backward * now.contact_tangential_speed_m_s >= threshold;
            break match now.mode.in_contact() && passed {
                true => Outcome::Whirl,
                false => Outcome::Undecided,
            };
        }
        plant.advance(t_s, &Inputs::default(), &mut follow)?;
        let now = plant.snapshot();
        if plant.meters().peak_backward_speed_m_s >= criterion.whirl_multiple * threshold {
            to_threshold = to_threshold.or(Some(impacts));
            break Outcome::Whirl;
        }
        if !now.mode.in_contact() && stays_free(params, &now, impact.spin_phase_rad) {
            break Outcome::Free;
        }
    };
    Ok(ImpactOutcome {
        outcome,
        impacts_to_threshold: to_threshold,
    })
}

/// v_t,crit \[m/s\].
fn threshold_m_s(params: &PlantParams) -> Result<f64, ImpactError> {
    critical_tangential_speed_m_s(params).ok_or(match driving_coefficient(params) > 0.0 {
        true => ImpactError::NotHeld,
        false => ImpactError::NoFriction,
    })
}

/// The start of an impact: at the wall along x.
fn start_of(params: &PlantParams, impact: &Impact) -> Start {
    let (sin, cos) = impact.inclination_rad.sin_cos();
    Start {
        position_m: V2::new(params.contact.clearance_m, 0.0),
        velocity_m_s: impact.speed_m_s * V2::new(cos, impact.backward() * sin),
        spin_rad_s: impact.spin_rad_s,
        spin_phase_rad: impact.spin_phase_rad,
    }
}

/// Whether a rotor in flight can never reach the wall again (module text). `false` also where that
/// cannot be decided: without a shaft, with overdamped flight, with unbalance at a spin that is not held, with rings
/// that nothing holds.
fn stays_free(params: &PlantParams, now: &Snapshot, spin_phase_rad: f64) -> bool {
    let rotor = &params.rotor;
    if rotor.eccentricity_m > 0.0 && params.spin != SpinParams::Held {
        return false;
    }
    let spin = now.spin_rad_s;
    let flight = FreeFlight {
        stiffness: rotor.stiffness_n_m / rotor.mass_kg,
        damping: rotor.damping_n_s_m / rotor.mass_kg,
        spin,
        unbalance: rotor.eccentricity_m * spin * spin,
    };
    let body = Body {
        position: now.position_m,
        velocity: now.velocity_m_s,
    };
    let (sin, cos) = (spin_phase_rad + spin * now.t_s).sin_cos();
    let farthest_m = flight.farthest_m(&body, V2::new(cos, sin));
    farthest_m.is_some_and(|farthest_m| {
        farthest_m + ring_reach_m(&params.stator, now) < nearest_wall_m(params)
    })
}

/// How near to the middle the wall of a stator at rest comes \[m\].
fn nearest_wall_m(params: &PlantParams) -> f64 {
    let c = params.contact.clearance_m;
    match &params.stator {
        StatorParams::RigidEllipse(ellipse) => c * (1.0 - ellipse.ellipticity),
        _ => c,
    }
}

/// Bound of how far the ring that the rotor touches goes from now on if it is left alone \[m\]: √(2E·Σ 1/k), the
/// mountings in series, each by its softer axis.
fn ring_reach_m(stator: &StatorParams, now: &Snapshot) -> f64 {
    let (inner, outer) = (&now.inner_ring, &now.outer_ring);
    let half_square = |weight: V2, v: V2| 0.5 * weight.dot(&v.component_mul(&v));
    let kinetic =
        |ring: &RingParams, body: &Body| 0.5 * ring.mass_kg * body.velocity.norm_squared();
    let (energy_j, compliance_m_n, displaced) = match stator {
        StatorParams::Rigid | StatorParams::RigidEllipse(_) => return 0.0,
        StatorParams::OneMass(ring) => (
            kinetic(ring, inner) + half_square(ring.stiffness_n_m, inner.position),
            1.0 / ring.stiffness_n_m.min(),
            inner.position != V2::zeros(),
        ),
        StatorParams::TwoMass { inner: i, outer: o } => (
            kinetic(i, inner)
                + kinetic(o, outer)
                + half_square(i.stiffness_n_m, inner.position - outer.position)
                + half_square(o.stiffness_n_m, outer.position),
            1.0 / i.stiffness_n_m.min() + 1.0 / o.stiffness_n_m.min(),
            inner.position != V2::zeros() || outer.position != V2::zeros(),
        ),
    };
    // Not touched yet; also without a spring, where the product would be no number.
    if energy_j == 0.0 && !displaced {
        return 0.0;
    }
    (2.0 * energy_j * compliance_m_n).sqrt()
}

/// How the lowest speed that ends in whirl is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Step upwards, as a share of the speed. A window of whirl narrower than that may be missed.
    pub step: f64,
    /// Width of the last bracket, as a share of the speed.
    pub tolerance: f64,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            step: 0.005,
            tolerance: 1e-5,
        }
    }
}

/// Critical impact speed \[m/s\]: the lowest that ends in whirl. Upwards until
/// the first whirl, then bisection of that change: above it the outcome need not be monotone.
///
/// The search begins at half of what all bounces together need if nothing is lost between them,
/// v_t,crit/(K·cos θ + sin θ) with K = μ·(1 + e)/(1 − e), and ends at twice what a single impact needs,
/// K = μ·(1 + e); `None` if nothing whirled up to there. Where unbalance makes whirl of less, it begins below that; 0 if even a
/// thousandth ends in whirl.
///
/// # Errors
/// [`ImpactError`].
pub fn critical_speed_m_s(
    params: &PlantParams,
    aim: Aim,
    search: &Search,
    criterion: &Criterion,
) -> Result<Option<f64>, ImpactError> {
    let mut hunt = Hunt::new(params, aim, search)?;
    loop {
        match hunt.next() {
            Next::Found(speed_m_s) => return Ok(speed_m_s),
            Next::Try(impact) => {
                let after = run_impact(params, &impact, criterion)?;
                hunt.answer(after.outcome == Outcome::Whirl);
            }
        }
    }
}

/// A search on its way: which impact is to be tried next.
#[derive(Debug, Clone)]
struct Hunt {
    search: Search,
    aim: Aim,
    /// Largest speed that did not whirl, and smallest that did after one that did not.
    low: f64,
    high: Option<f64>,
    /// Every trial whirled so far.
    descends: bool,
    least: f64,
    to: f64,
    trial: f64,
}

/// What a search wants.
enum Next {
    Try(Impact),
    Found(Option<f64>),
}

impl Hunt {
    fn new(params: &PlantParams, aim: Aim, search: &Search) -> Result<Self, ImpactError> {
        let (low, to) = search_range(params, aim.inclination_rad)?;
        Ok(Self {
            search: *search,
            aim,
            low,
            high: None,
            descends: true,
            least: 1e-3 * low,
            to,
            trial: low,
        })
    }

    fn next(&mut self) -> Next {
        let Self { low, search, .. } = *self;
        if low < self.least {
            return Next::Found(Some(0.0));
        }
        self.trial = match self.high {
            None => low * (1.0 + search.step),
            Some(high) => 0.5 * (low + high),
        };
        let over = match self.high {
            None => self.trial > self.to,
            Some(high) => {
                high - low <= search.tolerance * high || !(low < self.trial && self.trial < high)
            }
        };
        if over {
            return Next::Found(self.high);
        }
        Next::Try(self.impact())
    }

    /// The impact that is tried.
    fn impact(&self) -> Impact {
        self.aim.at(self.trial)
    }

    /// Takes in whether the impact that was tried whirls.
    fn answer(&mut self, whirls: bool) {
        if !whirls {
            self.low = self.trial;
            self.descends = false;
        } else if self.descends {
            self.low *= 0.5;
        } else {
            self.high = Some(self.trial);
        }
    }
}

/// From half the speed that suffices if nothing is lost between bounces to twice that which suffices
/// in one impact.
fn search_range(params: &PlantParams, inclination_rad: f64) -> Result<(f64, f64), ImpactError> {
    let threshold = threshold_m_s(params)?;
    if inclination_rad.is_nan() || inclination_rad.abs() >= FRAC_PI_2 {
        return Err(ImpactError::Inclination);
    }
    let mu = driving_coefficient(params);
    let e = match &params.contact.law {
        ContactLaw::Linear(law) => {
            let critical = 2.0 * (law.stiffness_n_m * params.contact_mass_kg()).sqrt();
            restitution_of(law.damping_n_s_m / critical)
        }
        // Slower impacts lose less: at a tenth of the speed that suffices in one elastic impact.
        ContactLaw::HuntCrossley(law) => law.restitution(0.05 * threshold / mu),
    }
    .min(0.99);
    let (sin, cos) = inclination_rad.sin_cos();
    let once = mu * (1.0 + e);
    let lowest = 0.5 * threshold / (once / (1.0 - e) * cos + sin.max(0.0));
    let highest = 2.0 * threshold / (once * cos + sin).max(0.1 * once);
    Ok((lowest, highest))
}

#[cfg(test)]
mod tests;
