//! The stator as no mass, one ring or two nested rings, eqs (2.3)–(2.6).
//!
//! Balance of forces on the outer ring needs the stiffness k_z + k_s, as its damping term already
//! has; the paper's eqs (2.5), (2.6) print k_z alone. The balanced form is used here.

use crate::V2;
use crate::params::RingParams;
use crate::part::{Body, Part};
use crate::quadrature::Nodes;
use crate::series::{INVERSE, Series};

/// What moves of a stator.
pub(crate) trait Rings: Part {
    /// The ring that the rotor touches.
    fn inner(&self) -> Body;
    /// The outer ring, if there is one.
    fn outer(&self) -> Option<Body> {
        None
    }
}

impl Rings for () {
    #[inline]
    fn inner(&self) -> Body {
        Body::default()
    }
}

impl Rings for Body {
    #[inline]
    fn inner(&self) -> Body {
        *self
    }
}

impl Rings for (Body, Body) {
    #[inline]
    fn inner(&self) -> Body {
        self.0
    }
    fn outer(&self) -> Option<Body> {
        Some(self.1)
    }
}

/// A model of the stator. In flight nothing drives it; in contact the contact force does.
pub(crate) trait Stator: Copy + Send + 'static {
    /// What changes in time.
    type State: Rings;
    /// The same over one step of flight.
    type Series: Copy + Default + Send + std::fmt::Debug;
    /// Changes the velocity of the ring that the rotor touches \[m/s\].
    fn kick(state: &mut Self::State, change_m_s: V2);
    /// 1/m of the ring that the rotor touches \[1/kg\]; 0 for a rigid stator.
    fn inverse_mass(&self) -> f64;
    /// Time derivative under a force on the inner ring \[N\].
    fn rates(&self, state: &Self::State, force_n: V2) -> Self::State;
    /// Kinetic and elastic energy \[J\].
    fn stored_j(&self, state: &Self::State) -> f64;
    /// Power lost in the mountings' dampers \[W\].
    fn damping_w(&self, state: &Self::State) -> f64;
    /// Upper bound of the fastest rate of the free stator without its dampers \[rad/s\].
    fn undamped_rate_rad_s(&self) -> f64;
    /// Upper bound of the fastest rate of the free stator \[rad/s\].
    fn fastest_rate_rad_s(&self) -> f64;
    /// Sets coefficient 0 to the state.
    fn start_series(series: &mut Self::Series, state: &Self::State);
    /// Position coefficients k + 1 from velocity coefficients k; `next_s` is step / (k + 1).
    fn extend_position(&self, series: &mut Self::Series, k: usize, next_s: f64);
    /// Velocity coefficients k + 1 under coefficient k of a force on the inner ring \[N\].
    fn extend_velocity(&self, series: &mut Self::Series, k: usize, next_s: f64, force_n: V2);
    /// Coefficient k of the inner ring's acceleration under that force.
    fn inner_acceleration(&self, series: &Self::Series, k: usize, force_n: V2) -> V2;
    /// Coefficient k of everything.
    fn coefficient(series: &Self::Series, k: usize) -> Self::State;
    /// Coefficients k of the inner ring's position and velocity.
    #[inline]
    fn inner_coefficient(series: &Self::Series, k: usize) -> (V2, V2) {
        let ring = Self::coefficient(series, k).inner();
        (ring.position, ring.velocity)
    }
    /// Fills `series` with free motion over `step_s`.
    fn series(&self, series: &mut Self::Series, state: &Self::State, step_s: f64, order: usize) {
        Self::start_series(series, state);
        for k in 0..order {
            let next_s = step_s * INVERSE[k + 1];
            self.extend_position(series, k, next_s);
            self.extend_velocity(series, k, next_s, V2::zeros());
        }
    }
    /// Position series of the inner ring, if it moves.
    fn inner_series(series: &Self::Series) -> Option<&Series>;
    /// ∫ of the power lost in the mountings' dampers over θ \[W\].
    fn damping_integral_w<const N: usize>(
        &self,
        series: &Self::Series,
        nodes: &Nodes<N>,
        order: usize,
    ) -> f64 {
        let speeds = Self::damper_speeds(series, nodes, order);
        let [inner, outer] = self.damper_constants();
        nodes
            .integral(|j| weighed_square(inner, speeds[0][j]) + weighed_square(outer, speeds[1][j]))
    }
    /// Speeds across the dampers of the inner and the outer mounting at the nodes \[m/s\]; zero where
    /// there is none.
    fn damper_speeds<const N: usize>(
        series: &Self::Series,
        nodes: &Nodes<N>,
        order: usize,
    ) -> [[V2; N]; 2];
    /// Constants of these dampers \[N s/m\].
    fn damper_constants(&self) -> [V2; 2];
    /// Whether mountings have dampers.
    fn is_damped(&self) -> bool {
        // By numbers: a comparison of arrays is a call where the compiler does not inline it.
        let [inner, outer] = self.damper_constants();
        inner.x != 0.0 || inner.y != 0.0 || outer.x != 0.0 || outer.y != 0.0
    }
    /// State at θ.
    fn at(series: &Self::Series, theta: f64, order: usize) -> Self::State;
}

/// A stator that does not move: part of no size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rigid;

impl Stator for Rigid {
    type State = ();
    type Series = ();
    fn kick(_state: &mut (), _change_m_s: V2) {}
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
    fn undamped_rate_rad_s(&self) -> f64 {
        0.0
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        0.0
    }
    #[inline]
    fn start_series(_series: &mut (), _state: &()) {}
    #[inline]
    fn extend_position(&self, _series: &mut (), _k: usize, _next_s: f64) {}
    #[inline]
    fn extend_velocity(&self, _series: &mut (), _k: usize, _next_s: f64, _force_n: V2) {}
    #[inline]
    fn inner_acceleration(&self, _series: &(), _k: usize, _force_n: V2) -> V2 {
        V2::zeros()
    }
    #[inline]
    fn coefficient(_series: &(), _k: usize) {}
    #[inline]
    fn damper_speeds<const N: usize>(_: &(), _: &Nodes<N>, _: usize) -> [[V2; N]; 2] {
        [[V2::zeros(); N]; 2]
    }
    fn damper_constants(&self) -> [V2; 2] {
        [V2::zeros(); 2]
    }
    #[inline]
    fn inner_series(_series: &()) -> Option<&Series> {
        None
    }
    #[inline]
    fn at(_series: &(), _theta: f64, _order: usize) {}
}

/// Position and velocity series of one ring.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BodySeries {
    position: Series,
    velocity: Series,
}

impl BodySeries {
    fn start(&mut self, body: &Body) {
        self.position.0[0] = body.position;
        self.velocity.0[0] = body.velocity;
    }

    #[inline]
    fn coefficient(&self, k: usize) -> Body {
        Body {
            position: self.position.0[k],
            velocity: self.velocity.0[k],
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
    fn kick(state: &mut Body, change_m_s: V2) {
        state.velocity += change_m_s;
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
    fn undamped_rate_rad_s(&self) -> f64 {
        (self.0.stiffness_n_m.max() / self.0.mass_kg).sqrt()
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        self.undamped_rate_rad_s() + self.0.damping_n_s_m.max() / self.0.mass_kg
    }
    fn start_series(series: &mut BodySeries, state: &Body) {
        series.start(state);
    }
    #[inline]
    fn extend_position(&self, s: &mut BodySeries, k: usize, next_s: f64) {
        s.position.0[k + 1] = next_s * s.velocity.0[k];
    }
    #[inline]
    fn extend_velocity(&self, s: &mut BodySeries, k: usize, next_s: f64, force_n: V2) {
        s.velocity.0[k + 1] = next_s * self.inner_acceleration(s, k, force_n);
    }
    #[inline]
    fn inner_acceleration(&self, s: &BodySeries, k: usize, force_n: V2) -> V2 {
        let mounting = mounting_force(&self.0, s.position.0[k], s.velocity.0[k]);
        (force_n + mounting) / self.0.mass_kg
    }
    #[inline]
    fn coefficient(series: &BodySeries, k: usize) -> Body {
        series.coefficient(k)
    }
    #[inline]
    fn damper_speeds<const N: usize>(
        series: &BodySeries,
        nodes: &Nodes<N>,
        order: usize,
    ) -> [[V2; N]; 2] {
        let speed = series.velocity.at_all(&nodes.theta, order);
        [speed, [V2::zeros(); N]]
    }
    fn damper_constants(&self) -> [V2; 2] {
        [self.0.damping_n_s_m, V2::zeros()]
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

impl TwoMass {
    /// Coefficient k of the inner mounting's force on the inner ring.
    #[inline]
    fn between(&self, (s, z): &(BodySeries, BodySeries), k: usize) -> V2 {
        mounting_force(
            &self.inner,
            s.position.0[k] - z.position.0[k],
            s.velocity.0[k] - z.velocity.0[k],
        )
    }
}

impl Stator for TwoMass {
    type State = (Body, Body);
    type Series = (BodySeries, BodySeries);
    fn kick(state: &mut Self::State, change_m_s: V2) {
        state.0.velocity += change_m_s;
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
    fn undamped_rate_rad_s(&self) -> f64 {
        let mass = self.inner.mass_kg.min(self.outer.mass_kg);
        let stiffness = self.inner.stiffness_n_m.max() * 2.0 + self.outer.stiffness_n_m.max();
        (stiffness / mass).sqrt()
    }
    fn fastest_rate_rad_s(&self) -> f64 {
        let mass = self.inner.mass_kg.min(self.outer.mass_kg);
        let damping = self.inner.damping_n_s_m.max() * 2.0 + self.outer.damping_n_s_m.max();
        self.undamped_rate_rad_s() + damping / mass
    }
    fn start_series(series: &mut Self::Series, (s, z): &Self::State) {
        series.0.start(s);
        series.1.start(z);
    }
    #[inline]
    fn extend_position(&self, (s, z): &mut Self::Series, k: usize, next_s: f64) {
        s.position.0[k + 1] = next_s * s.velocity.0[k];
        z.position.0[k + 1] = next_s * z.velocity.0[k];
    }
    #[inline]
    fn extend_velocity(&self, series: &mut Self::Series, k: usize, next_s: f64, force_n: V2) {
        let between = self.between(series, k);
        let (s, z) = series;
        let ground = mounting_force(&self.outer, z.position.0[k], z.velocity.0[k]);
        s.velocity.0[k + 1] = next_s / self.inner.mass_kg * (force_n + between);
        z.velocity.0[k + 1] = next_s / self.outer.mass_kg * (ground - between);
    }
    #[inline]
    fn inner_acceleration(&self, series: &Self::Series, k: usize, force_n: V2) -> V2 {
        (force_n + self.between(series, k)) / self.inner.mass_kg
    }
    #[inline]
    fn coefficient((s, z): &Self::Series, k: usize) -> Self::State {
        (s.coefficient(k), z.coefficient(k))
    }
    #[inline]
    fn damper_speeds<const N: usize>(
        (s, z): &Self::Series,
        nodes: &Nodes<N>,
        order: usize,
    ) -> [[V2; N]; 2] {
        let mut inner = s.velocity.at_all(&nodes.theta, order);
        let outer = z.velocity.at_all(&nodes.theta, order);
        for (a, b) in inner.iter_mut().zip(&outer) {
            *a -= b;
        }
        [inner, outer]
    }
    fn damper_constants(&self) -> [V2; 2] {
        [self.inner.damping_n_s_m, self.outer.damping_n_s_m]
    }
    #[inline]
    fn inner_series(series: &Self::Series) -> Option<&Series> {
        Some(&series.0.position)
    }
    fn at((s, z): &Self::Series, theta: f64, order: usize) -> Self::State {
        (s.at(theta, order), z.at(theta, order))
    }
}
