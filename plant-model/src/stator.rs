//! The stator as no mass, one ring or two nested rings, eqs (2.3)–(2.6).
//!
//! Balance of forces on the outer ring needs the stiffness k_z + k_s, as its damping term already
//! has; the paper's eqs (2.5), (2.6) print k_z alone. The balanced form is used here.

use crate::V2;
use crate::params::RingParams;
use crate::part::{Body, Part};
use crate::series::Series;

/// A model of the stator. In flight nothing drives it; in contact the contact force does.
pub(crate) trait Stator: Copy {
    /// What changes in time.
    type State: Part;
    /// The same over one step of flight.
    type Series: Copy;
    /// The ring that the rotor touches.
    fn inner(state: &Self::State) -> Body;
    /// The outer ring, if there is one.
    fn outer(state: &Self::State) -> Option<Body>;
    /// 1/m of the ring that the rotor touches \[1/kg\]; 0 for a rigid stator.
    fn inverse_mass(&self) -> f64;
    /// Time derivative under a force on the inner ring \[N\].
    fn rates(&self, state: &Self::State, force_n: V2) -> Self::State;
    /// Kinetic and elastic energy \[J\].
    fn stored_j(&self, state: &Self::State) -> f64;
    /// Power lost in the mountings' dampers \[W\].
    fn damping_w(&self, state: &Self::State) -> f64;
    /// Upper bound of the fastest rate of the free stator \[rad/s\].
    fn fastest_rate_rad_s(&self) -> f64;
    /// Free motion over `step_s` as a power series.
    fn series(&self, state: &Self::State, step_s: f64, order: usize) -> Self::Series;
    /// Position series of the inner ring, if it moves.
    fn inner_series(series: &Self::Series) -> Option<&Series>;
    /// State at θ.
    fn at(series: &Self::Series, theta: f64, order: usize) -> Self::State;
}

/// A stator that does not move: part of no size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rigid;

impl Stator for Rigid {
    type State = ();
    type Series = ();
    #[inline]
    fn inner(_state: &()) -> Body {
        Body::default()
    }
    fn outer(_state: &()) -> Option<Body> {
        None
    }
    #[inline]
    fn inverse_mass(&self) -> f64 {
        0.0
    }
    #[inline]
    fn rates(&self, _state: &(), _force_n: V2) {}
    #[inline]
    fn stored_j(&self, _state: &()) -> f64 {
        0.0
    }
    #[inline]
    fn damping_w(&self, _state: &()) -> f64 {
        0.0
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        0.0
    }
    #[inline]
    fn series(&self, _state: &(), _step_s: f64, _order: usize) {}
    #[inline]
    fn inner_series(_series: &()) -> Option<&Series> {
        None
    }
    #[inline]
    fn at(_series: &(), _theta: f64, _order: usize) {}
}

/// Position and velocity series of one ring.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodySeries {
    position: Series,
    velocity: Series,
}

impl BodySeries {
    fn start(body: &Body) -> Self {
        Self {
            position: Series::start(body.position),
            velocity: Series::start(body.velocity),
        }
    }

    fn at(&self, theta: f64, order: usize) -> Body {
        Body {
            position: self.position.at(theta, order),
            velocity: self.velocity.at(theta, order),
        }
    }
}

/// Force of a mounting on the ring it carries, for a relative motion across it.
#[inline]
fn mounting_force(ring: &RingParams, position: V2, velocity: V2) -> V2 {
    -ring.stiffness_n_m.component_mul(&position) - ring.damping_n_s_m.component_mul(&velocity)
}

#[inline]
fn kinetic_j(mass_kg: f64, velocity: V2) -> f64 {
    0.5 * mass_kg * velocity.norm_squared()
}

#[inline]
fn weighed_square(weight: V2, v: V2) -> f64 {
    weight.dot(&v.component_mul(&v))
}

/// One ring on a mounting to ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OneMass(pub RingParams);

impl Stator for OneMass {
    type State = Body;
    type Series = BodySeries;
    #[inline]
    fn inner(state: &Body) -> Body {
        *state
    }
    fn outer(_state: &Body) -> Option<Body> {
        None
    }
    #[inline]
    fn inverse_mass(&self) -> f64 {
        1.0 / self.0.mass_kg
    }
    #[inline]
    fn rates(&self, state: &Body, force_n: V2) -> Body {
        let force = force_n + mounting_force(&self.0, state.position, state.velocity);
        Body {
            position: state.velocity,
            velocity: force / self.0.mass_kg,
        }
    }
    #[inline]
    fn stored_j(&self, state: &Body) -> f64 {
        kinetic_j(self.0.mass_kg, state.velocity)
            + 0.5 * weighed_square(self.0.stiffness_n_m, state.position)
    }
    #[inline]
    fn damping_w(&self, state: &Body) -> f64 {
        weighed_square(self.0.damping_n_s_m, state.velocity)
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        let ring = &self.0;
        (ring.stiffness_n_m.max() / ring.mass_kg).sqrt() + ring.damping_n_s_m.max() / ring.mass_kg
    }
    fn series(&self, state: &Body, step_s: f64, order: usize) -> BodySeries {
        let mut s = BodySeries::start(state);
        for k in 0..order {
            let scale = step_s / (k + 1) as f64;
            let force = mounting_force(&self.0, s.position.0[k], s.velocity.0[k]);
            s.position.0[k + 1] = scale * s.velocity.0[k];
            s.velocity.0[k + 1] = scale / self.0.mass_kg * force;
        }
        s
    }
    #[inline]
    fn inner_series(series: &BodySeries) -> Option<&Series> {
        Some(&series.position)
    }
    fn at(series: &BodySeries, theta: f64, order: usize) -> Body {
        series.at(theta, order)
    }
}

/// Two nested rings: the inner one mounted in the outer one, the outer one to ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TwoMass {
    /// Ring that the rotor touches.
    pub inner: RingParams,
    /// Ring on the ground.
    pub outer: RingParams,
}

impl Stator for TwoMass {
    type State = (Body, Body);
    type Series = (BodySeries, BodySeries);
    #[inline]
    fn inner(state: &Self::State) -> Body {
        state.0
    }
    fn outer(state: &Self::State) -> Option<Body> {
        Some(state.1)
    }
    #[inline]
    fn inverse_mass(&self) -> f64 {
        1.0 / self.inner.mass_kg
    }
    #[inline]
    fn rates(&self, (s, z): &Self::State, force_n: V2) -> Self::State {
        let between = mounting_force(
            &self.inner,
            s.position - z.position,
            s.velocity - z.velocity,
        );
        let ground = mounting_force(&self.outer, z.position, z.velocity);
        (
            Body {
                position: s.velocity,
                velocity: (force_n + between) / self.inner.mass_kg,
            },
            Body {
                position: z.velocity,
                velocity: (ground - between) / self.outer.mass_kg,
            },
        )
    }
    fn stored_j(&self, (s, z): &Self::State) -> f64 {
        kinetic_j(self.inner.mass_kg, s.velocity)
            + kinetic_j(self.outer.mass_kg, z.velocity)
            + 0.5 * weighed_square(self.inner.stiffness_n_m, s.position - z.position)
            + 0.5 * weighed_square(self.outer.stiffness_n_m, z.position)
    }
    #[inline]
    fn damping_w(&self, (s, z): &Self::State) -> f64 {
        weighed_square(self.inner.damping_n_s_m, s.velocity - z.velocity)
            + weighed_square(self.outer.damping_n_s_m, z.velocity)
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        let mass = self.inner.mass_kg.min(self.outer.mass_kg);
        let stiffness = self.inner.stiffness_n_m.max() * 2.0 + self.outer.stiffness_n_m.max();
        let damping = self.inner.damping_n_s_m.max() * 2.0 + self.outer.damping_n_s_m.max();
        (stiffness / mass).sqrt() + damping / mass
    }
    fn series(&self, (s, z): &Self::State, step_s: f64, order: usize) -> Self::Series {
        let (mut s, mut z) = (BodySeries::start(s), BodySeries::start(z));
        for k in 0..order {
            let scale = step_s / (k + 1) as f64;
            let between = mounting_force(
                &self.inner,
                s.position.0[k] - z.position.0[k],
                s.velocity.0[k] - z.velocity.0[k],
            );
            let ground = mounting_force(&self.outer, z.position.0[k], z.velocity.0[k]);
            s.position.0[k + 1] = scale * s.velocity.0[k];
            z.position.0[k + 1] = scale * z.velocity.0[k];
            s.velocity.0[k + 1] = scale / self.inner.mass_kg * between;
            z.velocity.0[k + 1] = scale / self.outer.mass_kg * (ground - between);
        }
        (s, z)
    }
    #[inline]
    fn inner_series(series: &Self::Series) -> Option<&Series> {
        Some(&series.0.position)
    }
    fn at((s, z): &Self::Series, theta: f64, order: usize) -> Self::State {
        (s.at(theta, order), z.at(theta, order))
    }
}
