//! Which modes of the planes are consistent, and speeds that they hold at zero.

use super::Machine;
use crate::V2;
use crate::machine::guards::Guard;
use crate::machine::params::MAX_PLANES;
use crate::machine::series::Step;
use crate::machine::system::{Channel, MAX_HELD};
use crate::mode::{Phase, Slide, Whirl};
use crate::series::Scalar;

/// Speeds of a plane that are known to be zero, or the only direction that they can take.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct AtZero {
    pub(crate) slide: bool,
    pub(crate) whirl: bool,
    pub(crate) only_slide: Option<Slide>,
    pub(crate) only_whirl: Option<Whirl>,
}

impl AtZero {
    /// What a phase holds at zero.
    pub(crate) fn held(phase: Phase) -> Self {
        match phase {
            Phase::Contact(slide, whirl) => Self {
                slide: slide == Slide::Rolling,
                whirl: whirl == Whirl::Still,
                ..Self::default()
            },
            _ => Self::default(),
        }
    }

    /// The same, and what the guard that ended the phase says.
    pub(crate) fn after(phase: Phase, guard: Guard) -> Self {
        let mut at_zero = Self::held(phase);
        match guard {
            // The force that a held speed needs is at an edge of its cone.
            Guard::Slide if at_zero.slide => at_zero.only_slide = Some(Slide::Negative),
            Guard::SlideLow => at_zero.only_slide = Some(Slide::Positive),
            Guard::Whirl if at_zero.whirl => at_zero.only_whirl = Some(Whirl::Negative),
            Guard::WhirlLow => at_zero.only_whirl = Some(Whirl::Positive),
            Guard::Slide => at_zero.slide = true,
            Guard::Whirl => at_zero.whirl = true,
            _ => {}
        }
        at_zero
    }
}

/// By how much a held speed may be off zero after a moment, which is rounding: share of the speeds of the surfaces, and of
/// the speed that the normal force gives in that time.
const MOVED: f64 = 1e-13;
const PUSHED: f64 = 1e-9;

const SLIDES: [Slide; 3] = [Slide::Rolling, Slide::Positive, Slide::Negative];
const WHIRLS: [Whirl; 3] = [Whirl::Still, Whirl::Positive, Whirl::Negative];

/// What a plane may do: at most three ways to slide and three to whirl.
#[derive(Debug, Clone, Copy)]
struct Choices {
    slides: [Slide; 3],
    slide_count: usize,
    whirls: [Whirl; 3],
    whirl_count: usize,
    /// Sliding speed and whirl speed are one.
    same: bool,
}

impl Machine {
    fn choices(&self, plane: usize, at_zero: AtZero) -> Choices {
        let data = &self.system.planes[plane];
        let motion = self.contact_motion(plane);
        let zero = 1e-13 * motion.speed_m_s;
        let mut whirl_zero = at_zero.whirl || motion.whirl_m_s.abs() <= zero;
        // Without friction the direction of slip changes nothing, and there is nothing to hold it.
        let mut slide_zero =
            data.sliding > 0.0 && (at_zero.slide || motion.sliding_m_s.abs() <= zero);
        let same = data.sliding > 0.0
            && self.system.inverse_inertia == 0.0
            && data.race.is_none()
            && self.y.spin_rad_s == 0.0;
        if same && (slide_zero || whirl_zero) {
            (slide_zero, whirl_zero) = (true, true);
        }
        let mut choices = Choices {
            slides: SLIDES,
            slide_count: 3,
            whirls: WHIRLS,
            whirl_count: 3,
            same,
        };
        let only_slide = at_zero
            .only_slide
            .or((!slide_zero).then(|| Slide::from_speed(motion.sliding_m_s)));
        if let Some(slide) = only_slide {
            (choices.slides[0], choices.slide_count) = (slide, 1);
        }
        let only_whirl = match data.rolling == 0.0 {
            true => Some(Whirl::Ignored),
            false => at_zero
                .only_whirl
                .or((!whirl_zero).then(|| Whirl::from_speed(motion.whirl_m_s))),
        };
        if let Some(whirl) = only_whirl {
            (choices.whirls[0], choices.whirl_count) = (whirl, 1);
        }
        // One edge of both cones, where both speeds are one.
        if same && at_zero.only_slide.is_some() && data.rolling > 0.0 {
            choices.whirls[0] = if choices.slides[0] == Slide::Negative {
                Whirl::Negative
            } else {
                Whirl::Positive
            };
            choices.whirl_count = 1;
        }
        if same && at_zero.only_whirl.is_some() && data.sliding > 0.0 {
            choices.slides[0] = if choices.whirls[0] == Whirl::Negative {
                Slide::Negative
            } else {
                Slide::Positive
            };
            choices.slide_count = 1;
        }
        choices
    }

    /// Puts the plane that has changed, and every other that touches, into modes that are consistent just after this instant.
    /// Forces are judged a moment later, because at a touch they all start from zero. All speeds at zero are tried
    /// together: held, positive, negative; those of the plane that has changed first, so that others stay as they are where
    /// that will do.
    pub(crate) fn settle(&mut self, changed: usize, at_zero: AtZero) {
        let planes = self.phases.len();
        self.trial.copy_from_slice(&self.phases);
        let mut choices = [None; MAX_PLANES];
        for (p, choice) in choices.iter_mut().enumerate().take(planes) {
            let phase = self.phases[p];
            if p == changed {
                *choice = Some(self.choices(p, at_zero));
            } else if let Phase::Contact(slide, whirl) = phase {
                // Elsewhere a direction stays; what is held may give way.
                let mut chosen = self.choices(p, AtZero::held(phase));
                if slide != Slide::Rolling {
                    (chosen.slides[0], chosen.slide_count) = (slide, 1);
                }
                if whirl != Whirl::Still {
                    (chosen.whirls[0], chosen.whirl_count) = (whirl, 1);
                }
                *choice = Some(chosen);
            }
        }
        let ways: usize = choices
            .iter()
            .flatten()
            .map(|c| c.slide_count * c.whirl_count)
            .product();
        let mut fallback = false;
        for way in 0..ways {
            let mut rest = way;
            let mut fits = true;
            for p in std::iter::once(changed).chain((0..planes).filter(|p| *p != changed)) {
                let Some(choice) = &choices[p] else { continue };
                let slide = choice.slides[rest % choice.slide_count];
                rest /= choice.slide_count;
                let whirl = choice.whirls[rest % choice.whirl_count];
                rest /= choice.whirl_count;
                fits &= !choice.same || whirl == Whirl::Ignored || slide.sign() == whirl.sign();
                self.trial[p] = Phase::Contact(slide, whirl);
            }
            if !fits {
                continue;
            }
            if ways == 1 || self.is_consistent(&choices) {
                self.phases.copy_from_slice(&self.trial);
                return;
            }
            if !fallback {
                fallback = true;
                self.fallback.copy_from_slice(&self.trial);
            }
        }
        if fallback {
            self.phases.copy_from_slice(&self.fallback);
        }
    }

    /// Whether held speeds stay at zero and need no more than their cones, and others at zero move as their mode says, a
    /// moment from now. Friction cannot hold each of three speeds of a rigid rotor whose normals are parallel there: two of
    /// them say what the third is.
    fn is_consistent(&mut self, choices: &[Option<Choices>]) -> bool {
        const ORDER: usize = 3;
        let moment_s = self.system.moment_s(&self.y);
        let step = Step {
            system: &self.system,
            phases: &self.trial,
            forces: &self.forces,
            commands_n: &self.inputs.commands_n,
            step_s: moment_s,
        };
        let series = &mut self.stepper.series;
        series.fill(&step, &self.y, ORDER, &mut |_, _, _| false);
        for (p, choice) in choices.iter().enumerate() {
            let (Some(choice), Phase::Contact(slide, whirl)) =
                (choice, self.trial.get(p).copied().unwrap_or(Phase::Inside))
            else {
                continue;
            };
            let (series, data) = (&self.stepper.series.parts.planes[p], &self.system.planes[p]);
            let (normal_n_m, distance_m) = (series.normal_n_m.at(1.0, ORDER), series.distance.0[0]);
            let mut along = Scalar::default();
            series.whirl_of(&mut along, ORDER);
            let mut slip = along;
            series.add_surface(&mut slip, (data, &self.stepper.series.parts.spin), ORDER);
            let surfaces = along.0[0].abs() + (slip.0[0] - along.0[0]).abs();
            let mobility = self.system.contact(p).mobility();
            let pushed = moment_s * mobility * normal_n_m * distance_m * distance_m;
            let still = MOVED * surfaces + PUSHED * pushed;
            let stays = |speed: &Scalar| (speed.at(1.0, ORDER) - speed.0[0]).abs() <= still;
            let slides = match slide {
                Slide::Rolling => {
                    series.sliding_n_m.at(1.0, ORDER).abs() <= data.sliding * normal_n_m
                        && stays(&slip)
                }
                _ => choice.slide_count == 1 || slide.sign() * slip.at(1.0, ORDER) >= 0.0,
            };
            let whirls = match whirl {
                Whirl::Still => {
                    series.rolling_n_m.at(1.0, ORDER).abs() <= data.rolling * normal_n_m
                        && stays(&along)
                }
                _ => choice.whirl_count == 1 || whirl.sign() * along.at(1.0, ORDER) >= 0.0,
            };
            if !(slides && whirls) {
                return false;
            }
        }
        true
    }

    /// Puts speeds that are zero up to the tolerance to zero, by the impulse that friction would give.
    pub(crate) fn zero_speeds(&mut self, changed: Option<(usize, AtZero)>) {
        let mut channels = [(0, Channel::Sliding); MAX_HELD];
        let mut count = 0;
        for (p, phase) in self.phases.iter().enumerate() {
            let at_zero = match changed {
                Some((changed, at_zero)) if changed == p => at_zero,
                _ => AtZero::held(*phase),
            };
            for (holds, channel) in [
                (at_zero.slide, Channel::Sliding),
                (at_zero.whirl, Channel::Rolling),
            ] {
                if holds && matches!(phase, Phase::Contact(..)) {
                    channels[count] = (p, channel);
                    count += 1;
                }
            }
        }
        if count == 0 {
            return;
        }
        let (sin, cos) = self.y.phase_rad.sin_cos();
        let normals = self.normals();
        let Self {
            system, y, holding, ..
        } = self;
        let channels = channels[..count].iter().copied();
        holding.set(system, channels, |p| normals[p], V2::new(cos, sin));
        let impulses = holding.against(|held| {
            let whirl = held
                .tangent
                .dot(&system.contact(held.plane).of(&y.velocity));
            let race = y.races_rad_s[held.plane];
            whirl + system.surface_of(held.plane, held.channel, y.spin_rad_s, race)
        });
        for (held, impulse) in holding.held().iter().zip(impulses) {
            for (v, a) in y.velocity.iter_mut().zip(&held.accelerations) {
                *v += impulse * a;
            }
            y.spin_rad_s += impulse * held.spin;
            y.races_rad_s[held.plane] += impulse * held.race;
        }
    }
}
