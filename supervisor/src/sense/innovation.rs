//! How well a sample agrees with where the observer expected it, in flight: doubt about a single one, and the noise that all
//! of them show.

use crate::border::coeffs::Coeffs;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;

/// Where the next sample is expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Expected<S> {
    pub(crate) position: Vec2<S>,
    /// In flight, with a motion that is known and the wall out of reach: a rotor is there, or nearly.
    pub(crate) sure: bool,
}

impl<S: Scalar> Expected<S> {
    /// How far a position is from it; nothing where that says nothing.
    #[inline]
    pub(crate) fn off(&self, position: Vec2<S>) -> Option<Vec2<S>> {
        self.sure.then(|| position - self.position)
    }
}

/// A sample that is off by so many times the level is doubted: noise alone is so far off, seven of its σ, once in 10¹⁰ samples.
const DOUBTED_FROM: f32 = 3.5;
/// Samples in a row that are doubted at most: what the third shows is so.
const DOUBTED_AT_MOST: u8 = 2;
/// Most noise that is one \[clearances\]: what jumps about more is no position.
const MOST_LEVEL: f32 = 0.5;
/// Share of what is new in the noise that has been seen.
const LEARNT: f32 = 1.0 / 32.0;

/// Memory of what was off.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Innovation<S> {
    /// Mean difference of two samples in a row, each against where it was expected; at least that of the noise that was
    /// told. A push makes samples be off to the same side, noise does not.
    level: S,
    last: Vec2<S>,
    /// The sample before could be expected, too.
    known: bool,
    /// Samples in a row that were doubted.
    doubted: u8,
}

words_of_fields!(Innovation<S> { level, last, known, doubted });

impl<S: Scalar> Innovation<S> {
    /// Whether a sample this far off agrees with what was expected, or with the one before it. The first after what cannot
    /// be expected has nothing to be compared with.
    #[inline]
    pub(crate) fn fits(&self, off: Vec2<S>, coeffs: &Coeffs<S>) -> bool {
        let most = (self.level * S::from_f32(DOUBTED_FROM)).max(coeffs.guard.never_doubted);
        off.about_length() <= most || !self.known || (off - self.last).about_length() <= most
    }

    /// A sample that nobody could expect.
    #[inline]
    pub(crate) fn skip(&mut self) {
        self.known = false;
    }

    /// Learns from it, the little that one counts.
    #[inline]
    pub(crate) fn learn(&mut self, off: Vec2<S>, coeffs: &Coeffs<S>) {
        let before = core::mem::replace(&mut self.last, off);
        let counts = if core::mem::replace(&mut self.known, true) {
            (off - before).about_length().min(self.level + self.level)
        } else {
            self.level
        };
        self.level = (self.level + (counts - self.level) * S::from_f32(LEARNT))
            .clamp(coeffs.guard.configured_noise, S::from_f32(MOST_LEVEL));
    }

    /// Samples in a row up to the last one that were doubted.
    pub(crate) fn doubted(&self) -> u8 {
        self.doubted
    }

    /// Whether one that does not agree is refused.
    pub(crate) fn doubts(&mut self, off: Vec2<S>, coeffs: &Coeffs<S>) -> bool {
        let fits = self.fits(off, coeffs);
        self.learn(off, coeffs);
        self.doubted = if fits || self.doubted >= DOUBTED_AT_MOST {
            0
        } else {
            self.doubted + 1
        };
        self.doubted > 0
    }

    /// How much farther than was configured noise may take a sample.
    pub(crate) fn excess_noise(&self, coeffs: &Coeffs<S>) -> S {
        (self.level - coeffs.guard.configured_noise).max(S::ZERO) * S::from_f32(DOUBTED_FROM)
    }

    /// Whether the noise leaves a speed by which an approach can be detected.
    #[inline]
    pub(crate) fn is_quiet(&self, coeffs: &Coeffs<S>) -> bool {
        self.level <= coeffs.guard.quiet_noise
    }

    /// After a change of the unit of length.
    pub(crate) fn rescale(&mut self, length: S) {
        self.level = self.level * length;
        self.last = self.last * length;
    }
}
