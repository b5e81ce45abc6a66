//! Where the rotor is against the ring, and how it moves there: eqs (2.8), (2.9) and the sliding speed.

use super::{StateOf, System};
use crate::V2;
use crate::ellipse::ClosestPoint;
use crate::magnet::Amplifier;
use crate::plane::{Bore, Raceway};
use crate::spin::Spin;
use crate::stator::{Rings, Stator};
use crate::vector::perp;

/// Geometry of the rotor against the ring: no forces yet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Geometry {
    /// Distance ρ of the centres \[m\]; out of round that of the rotor's from the centre of curvature.
    pub(crate) distance_m: f64,
    /// r̂ from ring to rotor.
    pub(crate) normal: V2,
    /// t̂, counter-clockwise.
    pub(crate) tangent: V2,
    /// A of eq. (2.8) \[m\]; negative inside the clearance.
    pub(crate) penetration_m: f64,
    /// B of eq. (2.9) \[m/s\].
    pub(crate) normal_speed_m_s: f64,
    /// v_w, tangential speed of the rotor against the ring \[m/s\].
    pub(crate) whirl_speed_m_s: f64,
    /// v_rel = v_w + Ω·R_r − Ω_i·R_i \[m/s\].
    pub(crate) sliding_speed_m_s: f64,
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    #[inline]
    pub(crate) fn geometry(&self, y: &StateOf<S, W, M, R>) -> Geometry {
        let ring = y.stator.inner();
        let u = y.rotor.position - ring.position;
        let w = y.rotor.velocity - ring.velocity;
        if let Some(ellipse) = self.plane.bore.ellipse() {
            return self.geometry_out_of_round(&ellipse.closest_point(u), w, y);
        }
        let distance_m = u.norm();
        // Concentric: every direction is as good; contact needs a clearance, so none is felt.
        let normal = if distance_m > 0.0 {
            u / distance_m
        } else {
            V2::x()
        };
        let tangent = perp(normal);
        let whirl_speed_m_s = w.dot(&tangent);
        let surface = self.surface_m_s(y);
        Geometry {
            distance_m,
            normal,
            tangent,
            penetration_m: distance_m - self.plane.contact.clearance_m,
            normal_speed_m_s: w.dot(&normal),
            whirl_speed_m_s,
            sliding_speed_m_s: whirl_speed_m_s + surface,
        }
    }

    /// The same against an ellipse, at the point of it that is nearest.
    fn geometry_out_of_round(
        &self,
        closest: &ClosestPoint,
        w: V2,
        y: &StateOf<S, W, M, R>,
    ) -> Geometry {
        let normal = closest.normal;
        let tangent = perp(normal);
        let whirl_speed_m_s = w.dot(&tangent);
        Geometry {
            distance_m: closest.radius_m + closest.depth_m,
            normal,
            tangent,
            penetration_m: closest.depth_m,
            normal_speed_m_s: w.dot(&normal),
            whirl_speed_m_s,
            sliding_speed_m_s: whirl_speed_m_s + self.surface_m_s(y),
        }
    }

    /// Speed of the rotor's surface by its spin, against that of a race \[m/s\].
    #[inline]
    pub(crate) fn surface_m_s(&self, y: &StateOf<S, W, M, R>) -> f64 {
        let own = self.spin.spin_rad_s(&y.spin) * self.plane.radius_m;
        match self.plane.race.race() {
            Some(race) => own - race.radius_m * R::spin_rad_s(&y.race),
            None => own,
        }
    }
}
