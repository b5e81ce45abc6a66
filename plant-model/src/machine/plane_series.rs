//! Series of what happens in one plane.

use super::system::{MachineSystem, PlaneData};
use crate::V2;
use crate::params::ContactLaw;
use crate::series::{INVERSE, Scalar, Series};
use crate::vector::perp;

/// What a plane does over a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum State {
    #[default]
    Inside,
    Beyond,
    Touched,
}

/// How friction acts in a plane over a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Grip {
    /// Sliding and rolling part over the normal force, where they are in proportion to it.
    pub(crate) sliding: f64,
    pub(crate) rolling: f64,
    /// Whether some part holds a speed, and whether the sliding part does.
    pub(super) holds: bool,
    pub(super) rolls: bool,
    /// Whether the surfaces' speeds change.
    pub(crate) turns: bool,
}

impl Grip {
    /// Of a plane without friction in proportion to the normal force, and none that holds.
    pub(crate) fn none(system: &MachineSystem, plane: usize) -> Self {
        Self {
            turns: system.turns(plane),
            ..Self::default()
        }
    }
}

/// Sliding friction that falls with speed, in one direction of slip: M = −σ·(μ_∞ + (μ_0 − μ_∞)·e^(−σ·v/v_0)) over the normal force.
#[derive(Debug, Clone, Default)]
pub(super) struct Falling {
    /// σ.
    pub(super) sign: f64,
    pub(super) at_speed: f64,
    pub(super) fall: f64,
    pub(super) per_speed_s_m: f64,
    /// Speed of the whirl, and that of sliding.
    along: Scalar,
    speed: Scalar,
    exponential: Scalar,
    share: Scalar,
}

/// Series of one plane.
#[derive(Debug, Clone, Default)]
pub(crate) struct PlaneSeries {
    pub(super) state: State,
    pub(crate) grip: Grip,
    /// u, rotor against ring, and its rate w. In contact with a bore that is out of round u counts from the centre of curvature.
    pub(crate) gap: Series,
    pub(crate) gap_rate: Series,
    /// ρ.
    pub(crate) distance: Scalar,
    /// A, of a bore that is out of round alone.
    pub(crate) depth: Scalar,
    /// f_n, and κ.
    pub(crate) force: Scalar,
    pub(crate) normal_n_m: Scalar,
    /// What falls through zero where contact of a law that is not linear ends; of collocation alone.
    pub(crate) normal_guard: Scalar,
    /// Parts of τ, and the sum of those that hold.
    pub(crate) sliding_n_m: Scalar,
    pub(crate) rolling_n_m: Scalar,
    pub(super) held_n_m: Scalar,
    /// The same as forces, where the grip has them not in proportion to f_n.
    pub(crate) sliding_n: Scalar,
    pub(crate) rolling_n: Scalar,
    /// Ω_i.
    pub(crate) race: Scalar,
    /// Where friction falls with speed; the grip has no sliding part then.
    pub(super) falling: Option<Box<Falling>>,
    /// Of the order at hand: force on the rotor, and sliding friction.
    pub(super) reaction: V2,
    pub(super) torque_n: f64,
    /// 1/ρ at the start, and ρ on the wall there: the clearance, or the radius of curvature.
    pub(super) per_m: f64,
    pub(super) wall_m: f64,
    /// Slopes of the contact law; of one that is not linear those a moment from now, and what is between them and the force.
    pub(super) by_depth_n_m: f64,
    pub(super) by_rate_n_s_m: f64,
    pub(super) offset_n: f64,
}

impl PlaneSeries {
    /// Coefficients k of sliding friction that falls with speed, and what it adds to the force on the rotor. Those of the speed's
    /// whirl, u × w, and of the surfaces' speed come from outside.
    pub(super) fn extend_falling(&mut self, k: usize, whirl: f64, surface_m_s: f64) {
        let Some(f) = &mut self.falling else { return };
        let mut below = 0.0;
        for i in 0..k {
            below += f.along.0[i] * self.distance.0[k - i];
        }
        f.along.0[k] = (whirl - below) * self.per_m;
        f.speed.0[k] = f.along.0[k] + surface_m_s;
        let rate = -f.sign * f.per_speed_s_m;
        f.exponential.0[k] = match k {
            0 => (rate * f.speed.0[0]).exp(),
            _ => {
                let terms = (1..=k).map(|i| i as f64 * f.speed.0[i] * f.exponential.0[k - i]);
                rate * INVERSE[k] * terms.sum::<f64>()
            }
        };
        let steady = if k == 0 { f.at_speed } else { 0.0 };
        f.share.0[k] = -f.sign * (steady + f.fall * f.exponential.0[k]);
        self.sliding_n_m.0[k] = f.share.product_coefficient(&self.normal_n_m, k);
        self.torque_n = f.share.product_coefficient(&self.force, k);
        self.reaction += perp(self.gap.times_coefficient(&self.sliding_n_m, k));
    }

    /// Friction that is not in proportion to the normal force, once all orders are there. By the coefficients of the product: these
    /// fall where those of its parts do not, for a force per distance has a pole where the distance is none.
    pub(super) fn finish(&mut self, order: usize, (slides, whirls): (bool, bool)) {
        let product = |into: &mut Scalar, per_distance: &Scalar| {
            for (k, force) in into.0[..=order].iter_mut().enumerate() {
                *force = per_distance.product_coefficient(&self.distance, k);
            }
        };
        if slides && self.grip.sliding == 0.0 {
            product(&mut self.sliding_n, &self.sliding_n_m);
        }
        if whirls && self.grip.rolling == 0.0 {
            product(&mut self.rolling_n, &self.rolling_n_m);
        }
    }

    /// What is positive while contact lasts.
    pub(crate) fn normal_guard(&self, data: &PlaneData) -> &Scalar {
        match data.law {
            ContactLaw::Linear(_) => &self.force,
            ContactLaw::HuntCrossley(_) => &self.normal_guard,
        }
    }
}
