//! What the two planes of a rigid rotor do to each other.

use crate::border::coeffs::Scaling;
use crate::border::config::Config;
use crate::border::shaft::{PlanePositions, Shaft, ShaftError};
use crate::border::signal::{CoreSample, Status};
use crate::estimate::neighbour::{PlaneState, RotorCoupling};
use crate::number::vec2::Vec2;

/// Couplings beyond this are of no rotor, and would leave the numbers.
const MOST_COUPLED: f32 = 1e3;
/// I_p/I_t beyond which the unbalance of a tilt does not show enough to be known.
const MOST_NUTATION: f32 = 0.85;

/// What couples a plane to the other, per unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coupling {
    /// Acceleration here per cap of the other magnet.
    per_cap: f32,
    /// z over the distance of the planes, times metres a second per unit of each plane's speed, here per unit.
    arm: [f32; 2],
    /// I_p/I_t.
    nutation: f32,
    /// Of the unbalance of the tilt, what a plane does not see over what it does.
    unseen: f32,
    /// A radian in a tick \[1/t₀\]: nothing that is sampled nutates faster.
    fastest: f32,
}

impl Coupling {
    /// Both, once everything is known to be in its range.
    pub(crate) fn of_checked(
        shaft: &Shaft,
        [first, second]: &[Config; 2],
    ) -> Result<[Self; 2], ShaftError> {
        shaft.check()?;
        for (end, config) in [(0, first), (1, second)] {
            config
                .validate()
                .map_err(|error| ShaftError::Plane(end, error))?;
        }
        let [a, b] = shaft.places;
        let period_s = first.sample_period_s;
        let (first, second) = (first.scaling(), second.scaling());
        let gap_m = b.retainer_m - a.retainer_m;
        let nutation = shaft.polar_inertia_kg_m2 / shaft.transverse_inertia_kg_m2;
        let unseen = if nutation <= MOST_NUTATION {
            nutation / (1.0 - nutation)
        } else {
            0.0
        };
        let of = |here: PlanePositions, there: PlanePositions, own: &Scaling, other: &Scaling| {
            let share = here.retainer_m / gap_m / own.speed_m_s();
            let acceleration = shaft.mobility(here.retainer_m, there.magnet_m) * other.force_n;
            Self {
                per_cap: acceleration * own.time_s * own.time_s / own.length_m,
                arm: [-share * first.speed_m_s(), share * second.speed_m_s()],
                nutation,
                unseen,
                fastest: own.time_s / period_s,
            }
        };
        let both = [of(a, b, &first, &second), of(b, a, &second, &first)];
        let held = |x: f32| x.abs() <= MOST_COUPLED;
        let usable = |c: &Self| held(c.per_cap) && c.arm.iter().all(|arm| held(*arm));
        if both.iter().all(usable) {
            Ok(both)
        } else {
            Err(ShaftError::Places)
        }
    }

    /// What the plane knows of the rest: from both ends, and from the force at the other.
    pub(crate) fn coupling(
        &self,
        [first, second]: &[PlaneState<f32>; 2],
        other: &PlaneState<f32>,
        spin: f32,
    ) -> RotorCoupling<f32> {
        let rate = self.nutation * spin;
        let too_fast = rate.abs() > self.fastest;
        let tilt = |first: Vec2<f32>, second: Vec2<f32>| first * self.arm[0] + second * self.arm[1];
        // Where one end's velocity is not known nothing is known of the tilt.
        let known = first.velocity.zip(second.velocity);
        let (v1, v2) = known.unwrap_or_default();
        RotorCoupling {
            known: other.force * self.per_cap,
            velocity: tilt(v1, v2),
            unbalance: tilt(first.unbalance, second.unbalance) * self.unseen,
            unsettled: first.unsettled || second.unsettled,
            rate: if too_fast { 0.0 } else { rate },
            too_fast,
        }
    }
}

/// The spin where it is known \[1/t₀\], else 0: then nothing is known to turn the tilt.
pub(crate) fn spin(sample: &CoreSample<f32>) -> f32 {
    let known = sample.status.contains(Status::SPIN_VALID) && sample.spin.is_finite();
    if known { sample.spin } else { 0.0 }
}
