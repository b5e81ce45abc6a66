//! What ends a mode of a plane, as polynomials over a step.

use super::plane_series::PlaneSeries;
use super::system::{ON_WALL, PlaneData};
use crate::mode::{Phase, Slide, Whirl};
use crate::series::Scalar;

/// A condition that holds while a plane stays in its phase: positive until it ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Guard {
    /// Off the wall: clearance left.
    Gap,
    /// Beyond the wall without force: still beyond.
    Beyond,
    /// The same: force does not return.
    NoForce,
    /// Contact: normal force.
    Normal,
    /// Slip: speed in its direction. Roll: room to the upper edge of the cone.
    Slide,
    /// Roll: room to the lower edge.
    SlideLow,
    /// Whirl: speed in its direction. Still: room to the upper edge.
    Whirl,
    /// Still: room to the lower edge.
    WhirlLow,
}

impl Guard {
    /// Those of a phase.
    pub(crate) fn of(phase: Phase) -> &'static [Self] {
        match phase {
            Phase::Inside => &[Self::Gap],
            Phase::Beyond => &[Self::Beyond, Self::NoForce],
            Phase::Contact(slide, whirl) => match (slide == Slide::Rolling, whirl) {
                (false, Whirl::Ignored) => &[Self::Normal, Self::Slide],
                (true, Whirl::Ignored) => &[Self::Normal, Self::Slide, Self::SlideLow],
                (false, Whirl::Still) => &[Self::Normal, Self::Slide, Self::Whirl, Self::WhirlLow],
                (true, Whirl::Still) => &[
                    Self::Normal,
                    Self::Slide,
                    Self::SlideLow,
                    Self::Whirl,
                    Self::WhirlLow,
                ],
                (false, _) => &[Self::Normal, Self::Slide, Self::Whirl],
                (true, _) => &[Self::Normal, Self::Slide, Self::SlideLow, Self::Whirl],
            },
        }
    }

    /// Its bit in a set.
    pub(crate) fn bit(self) -> u8 {
        1 << self as u8
    }

    /// What it may be off by as a difference of larger numbers.
    pub(crate) fn rounding(self, data: &PlaneData) -> f64 {
        match self {
            Self::Gap | Self::Beyond => ON_WALL * data.clearance_m,
            _ => 0.0,
        }
    }

    /// It over a step of a plane up to θ, in `out` where it is not there already; `None` where it cannot fall.
    pub(crate) fn over<'a>(
        self,
        out: &'a mut Scalar,
        (plane, spin): (&'a PlaneSeries, &Scalar),
        (data, phase): (&PlaneData, Phase),
        (theta, order): (f64, usize),
    ) -> Option<&'a Scalar> {
        let (slide, whirl) = match phase {
            Phase::Contact(slide, whirl) => (slide, whirl),
            _ => (Slide::Rolling, Whirl::Ignored),
        };
        // Room to an edge of a cone, per distance as friction is.
        let room = |out: &mut Scalar, mu: f64, sign: f64, friction_n_m: &Scalar| {
            out.combine((mu, &plane.normal_n_m), (sign, friction_n_m), order);
        };
        match self {
            Self::Gap => {
                let start = plane.gap.0[0].abs().sum();
                if start + plane.gap.reach(theta, order) < data.nearest_m() {
                    return None;
                }
                let per = 1.0 / data.clearance_m;
                let squeezed = data.bore.map(|bore| {
                    let mut gap = plane.gap;
                    for c in &mut gap.0[..=order] {
                        *c = bore.to_circle(*c, data.clearance_m);
                    }
                    gap
                });
                let gap = squeezed.as_ref().unwrap_or(&plane.gap);
                for k in 0..=order {
                    out.0[k] = -per * gap.dot_coefficient(gap, k);
                }
                out.0[0] += data.clearance_m;
            }
            Self::Beyond if data.bore.is_some() => return Some(&plane.depth),
            Self::Beyond => {
                out.0[..=order].copy_from_slice(&plane.distance.0[..=order]);
                out.0[0] -= data.clearance_m;
            }
            Self::NoForce => {
                let normal_guard = plane.normal_guard(data);
                out.combine((-1.0, normal_guard), (0.0, normal_guard), order);
            }
            Self::Normal => return Some(plane.normal_guard(data)),
            Self::Slide if slide == Slide::Rolling => {
                room(out, data.sliding, -1.0, &plane.sliding_n_m);
            }
            Self::SlideLow => room(out, data.sliding, 1.0, &plane.sliding_n_m),
            // Without friction the direction of slip changes nothing.
            Self::Slide if data.sliding == 0.0 => return None,
            Self::Slide => {
                if plane.slips_on((data, spin), slide.sign(), (theta, order)) {
                    return None;
                }
                plane.whirl_of(out, order);
                plane.add_surface(out, (data, spin), order);
                out.0[..=order].iter_mut().for_each(|c| *c *= slide.sign());
            }
            Self::Whirl if whirl == Whirl::Still => {
                room(out, data.rolling, -1.0, &plane.rolling_n_m);
            }
            Self::WhirlLow => room(out, data.rolling, 1.0, &plane.rolling_n_m),
            Self::Whirl => {
                plane.whirl_of(out, order);
                out.0[..=order].iter_mut().for_each(|c| *c *= whirl.sign());
            }
        }
        Some(out)
    }
}

impl PlaneSeries {
    /// Whether the sliding speed keeps its sign up to θ, by how far its parts can move.
    fn slips_on(
        &self,
        (data, spin): (&PlaneData, &Scalar),
        sign: f64,
        (theta, order): (f64, usize),
    ) -> bool {
        let (gap, rate) = (self.gap.0[0], self.gap_rate.0[0]);
        let surface = data.radius_m * spin.0[0] - data.race_radius_m() * self.race.0[0];
        let start = sign * (gap.perp(&rate) + surface * self.distance.0[0]);
        let (far, fast) = (
            self.gap.reach(theta, order),
            self.gap_rate.reach(theta, order),
        );
        let mut moved = gap.abs().sum() * fast + (rate.abs().sum() + fast) * far;
        moved += surface.abs() * far;
        if self.grip.turns {
            let spun = data.radius_m * spin.reach(theta, order)
                + data.race_radius_m() * self.race.reach(theta, order);
            moved += spun * (self.distance.0[0] + far);
        }
        start > moved
    }
}
