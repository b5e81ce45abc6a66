//! From mode to mode within contact: which mode is consistent, and speeds that a mode holds at zero.

use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::part::Part;
use crate::plane::{Bore, Raceway};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Inputs, SLIDE, SLIDE_LOW, StateOf, System, WHIRL, WHIRL_LOW};

/// Speeds that are known to be zero at an instant.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct AtZero {
    /// v_rel.
    pub(crate) slide: bool,
    /// v_w.
    pub(crate) whirl: bool,
}

impl AtZero {
    /// What the mode holds at zero, and what the guard that ended it says.
    pub(crate) fn after((slide, whirl): (Slide, Whirl), guard: usize) -> Self {
        Self {
            slide: slide == Slide::Rolling || guard == SLIDE,
            whirl: whirl == Whirl::Still || guard == WHIRL,
        }
    }

    /// What a mode holds at zero.
    pub(crate) fn held((slide, whirl): (Slide, Whirl)) -> Self {
        Self {
            slide: slide == Slide::Rolling,
            whirl: whirl == Whirl::Still,
        }
    }
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    /// Puts speeds that are zero up to the tolerance to zero, by the impulse that friction would give:
    /// on rotor, ring and spin alike, so that the energy changes by the square of the drift only.
    pub(crate) fn zero_speeds(&self, y: &mut StateOf<S, W, M, R>, at_zero: AtZero) {
        let g = self.geometry(y);
        let inverse_m = 1.0 / self.rotor.mass_kg;
        let inverse_ring = self.stator.inverse_mass();
        let radius = self.plane.radius_m;
        let inverse_j = self.spin.inverse_inertia();
        let push = |y: &mut StateOf<S, W, M, R>, impulse: f64| {
            y.rotor.velocity += impulse * inverse_m * g.tangent;
            S::kick(&mut y.stator, -impulse * inverse_ring * g.tangent);
        };
        let mut whirl_speed = g.whirl_speed_m_s;
        if at_zero.whirl {
            push(y, -whirl_speed / (inverse_m + inverse_ring));
            whirl_speed = 0.0;
        }
        if !at_zero.slide {
            return;
        }
        if at_zero.whirl && self.plane.race.race().is_none() {
            // Both held: what is left can only be spin.
            self.spin.set_spin_rad_s(&mut y.spin, 0.0);
            return;
        }
        let spin = self.spin.spin_rad_s(&y.spin);
        let mut give = radius * radius * inverse_j;
        if let Some(race) = self.plane.race.race() {
            give += race.mobility();
        }
        // With both held the surfaces alone give way to each other.
        if !at_zero.whirl {
            give += inverse_m + inverse_ring;
        }
        let impulse = -(whirl_speed + self.surface_m_s(y)) / give;
        if !at_zero.whirl {
            push(y, impulse);
        }
        self.spin
            .set_spin_rad_s(&mut y.spin, spin + radius * inverse_j * impulse);
        if let Some(race) = self.plane.race.race() {
            let kicked = R::spin_rad_s(&y.race) - race.radius_m / race.inertia_kg_m2 * impulse;
            R::set_spin_rad_s(&mut y.race, kicked);
        }
    }

    /// The contact mode after a guard other than the normal force's has ended `pair`.
    pub(crate) fn next_in_contact(
        &self,
        (t_s, y): (f64, &StateOf<S, W, M, R>),
        inputs: &Inputs,
        pair: (Slide, Whirl),
        guard: usize,
    ) -> (Slide, Whirl) {
        let (slide, whirl) = pair;
        // Both cones open at once, and which guard says so first is up to rounding.
        let together = pair == (Slide::Rolling, Whirl::Still) && self.slip_is_whirl(y);
        match guard {
            SLIDE | WHIRL if together => (Slide::Negative, Whirl::Negative),
            SLIDE_LOW | WHIRL_LOW if together => (Slide::Positive, Whirl::Positive),
            // The force that rolling or standing still needs is at an edge of its cone.
            SLIDE if slide == Slide::Rolling => (Slide::Negative, whirl),
            SLIDE_LOW => (Slide::Positive, whirl),
            WHIRL if whirl == Whirl::Still => (slide, Whirl::Negative),
            WHIRL_LOW => (slide, Whirl::Positive),
            _ => self.settle((t_s, y), inputs, AtZero::after(pair, guard)),
        }
    }

    /// Whether v_rel is v_w: on a ring without a race under a rotor whose spin is held at zero. Only there do sliding and
    /// rolling friction share what holds the rotor, as μ : μ_r, see eq. (2.21).
    fn slip_is_whirl(&self, y: &StateOf<S, W, M, R>) -> bool {
        self.spin.inverse_inertia() == 0.0
            && self.plane.race.race().is_none()
            && self.spin.spin_rad_s(&y.spin) == 0.0
    }

    /// The contact mode that is consistent just after this instant, given which speeds are known to
    /// be zero. Forces are judged a moment later, because at a touch they all start from zero.
    pub(crate) fn settle(
        &self,
        (t_s, y): (f64, &StateOf<S, W, M, R>),
        inputs: &Inputs,
        at_zero: AtZero,
    ) -> (Slide, Whirl) {
        let g = self.geometry(y);
        let zero = 1e-13 * y.rotor.velocity.norm();
        // Without friction the direction of slip changes nothing, and there is nothing to hold it.
        let frictionless = self.plane.friction.sliding.coefficient(0.0) == 0.0;
        let slide_at_zero = !frictionless && (at_zero.slide || g.sliding_speed_m_s.abs() <= zero);
        let whirl_at_zero = at_zero.whirl || g.whirl_speed_m_s.abs() <= zero;
        // Where they are one speed, one direction says it all.
        let same = !frictionless && self.slip_is_whirl(y);
        let (slide_at_zero, whirl_at_zero) = match same && (slide_at_zero || whirl_at_zero) {
            true => (true, true),
            false => (slide_at_zero, whirl_at_zero),
        };
        let fits = |slide: Slide, whirl: Whirl| {
            !same || whirl == Whirl::Ignored || slide.sign() == whirl.sign()
        };
        let slides: &[Slide] = if slide_at_zero {
            &[Slide::Rolling, Slide::Positive, Slide::Negative]
        } else {
            &[Slide::from_speed(g.sliding_speed_m_s)]
        };
        let whirls: &[Whirl] = if self.plane.friction.rolling_coefficient == 0.0 {
            &[Whirl::Ignored]
        } else if whirl_at_zero {
            &[Whirl::Still, Whirl::Positive, Whirl::Negative]
        } else {
            &[Whirl::from_speed(g.whirl_speed_m_s)]
        };
        let moment_s = self.moment_s(y);
        for &slide in slides {
            for &whirl in whirls.iter().filter(|whirl| fits(slide, **whirl)) {
                let pair = (slide, whirl);
                let now = self.contact(t_s, y, inputs, pair);
                let mut later = *y;
                later.add_scaled(moment_s, &now.rates);
                let e = self.contact(t_s + moment_s, &later, inputs, pair);
                let slide_holds = match slide {
                    Slide::Rolling => e.guards[SLIDE].min(e.guards[SLIDE_LOW]) >= 0.0,
                    _ => !slide_at_zero || slide.sign() * e.touch.sliding_acceleration >= 0.0,
                };
                let whirl_holds = match whirl {
                    Whirl::Still => e.guards[WHIRL].min(e.guards[WHIRL_LOW]) >= 0.0,
                    _ => !whirl_at_zero || whirl.sign() * e.touch.whirl_acceleration >= 0.0,
                };
                if slide_holds && whirl_holds {
                    return pair;
                }
            }
        }
        (slides[0], whirls[0])
    }
}
