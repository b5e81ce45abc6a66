//! What ends a mode of a plane, as polynomials over a step.

use super::series::PlaneSeries;
use super::system::PlaneData;
use crate::integrate::driver::ON_WALL;
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

    /// Fills `out` with it over a step up to θ; says whether there is anything to ask.
    pub(crate) fn fill(
        self,
        out: &mut Scalar,
        (plane, data, phase): (&PlaneSeries, &PlaneData, Phase),
        (theta, order): (f64, usize),
    ) -> bool {
        let (slide, whirl) = match phase {
            Phase::Contact(slide, whirl) => (slide, whirl),
            _ => (Slide::Rolling, Whirl::Ignored),
        };
        // a·x + b·y, and there is something to ask.
        let mut ask = |x: (f64, &Scalar), y: (f64, &Scalar)| {
            out.combine(x, y, order);
            true
        };
        let (force, none) = (&plane.force, (0.0, &plane.force));
        match self {
            Self::Gap => {
                let reach = plane.gap.0[1..=order]
                    .iter()
                    .rev()
                    .fold(crate::V2::zeros(), |sum, c| (sum + c.abs()) * theta);
                let start = plane.gap.0[0].abs();
                if start.x + reach.x + start.y + reach.y < data.clearance_m {
                    return false;
                }
                let per = 1.0 / data.clearance_m;
                for k in 0..=order {
                    out.0[k] = -per * plane.gap.dot_coefficient(&plane.gap, k);
                }
                out.0[0] += data.clearance_m;
                true
            }
            Self::Beyond => {
                ask((1.0, &plane.distance), none);
                out.0[0] -= data.clearance_m;
                true
            }
            Self::NoForce => ask((-1.0, plane.lift(data)), none),
            Self::Normal => ask((1.0, plane.lift(data)), none),
            Self::Slide if slide == Slide::Rolling => {
                ask((data.sliding, force), (-1.0, &plane.sliding))
            }
            Self::SlideLow => ask((data.sliding, force), (1.0, &plane.sliding)),
            // Without friction the direction of slip changes nothing.
            Self::Slide if data.sliding == 0.0 => false,
            Self::Slide => ask((slide.sign(), &plane.slip), none),
            Self::Whirl if whirl == Whirl::Still => {
                ask((data.rolling, force), (-1.0, &plane.rolling))
            }
            Self::WhirlLow => ask((data.rolling, force), (1.0, &plane.rolling)),
            Self::Whirl => ask((whirl.sign(), &plane.whirl_speed), none),
        }
    }
}
