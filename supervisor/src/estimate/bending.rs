//! Configured bending: what swings in the reading at a natural frequency of the shaft is none of the rigid rotor's motion.
//!
//! The force damps what swings in the reading up to a frequency, and drives it above (5.12b). So the observer keeps that part apart
//! (5.7b), and what is decided is decided for the rest.

use crate::border::modes::{LEARNT, MODES, Modes};
use crate::border::parts::BENDING;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;
use crate::number::words::words_of_fields;

/// What swings: of each mode x and y as complex numbers whose real part is in the reading \[clearances\].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Bending<S> {
    swings: [[Vec2<S>; 2]; MODES],
}

words_of_fields!(Bending<S> { swings });

impl<S: Scalar> Bending<S> {
    /// Where it will be after a tick.
    #[inline]
    fn turned(&self, modes: &Modes<S>) -> Self {
        let mut next = *self;
        for (swing, mode) in next.swings.iter_mut().zip(&modes.0) {
            *swing = swing.map(|coordinate| coordinate.rotated(mode.turn));
        }
        next
    }

    /// Its part of the reading.
    #[inline]
    fn part(&self) -> Vec2<S> {
        (self.swings.iter()).fold(Vec2::ZERO, |sum, [x, y]| sum + Vec2::new(x.x, y.x))
    }

    /// Its part of the reading of the next tick.
    #[inline]
    pub(crate) fn ahead(&self, modes: &Option<Modes<S>>) -> Vec2<S> {
        match modes {
            Some(modes) if BENDING => self.turned(modes).part(),
            _ => Vec2::ZERO,
        }
    }

    /// A tick on; its part of the reading there.
    #[inline]
    pub(crate) fn carry(&mut self, modes: &Option<Modes<S>>) -> Vec2<S> {
        match modes {
            Some(modes) if BENDING => {
                *self = self.turned(modes);
                self.part()
            }
            _ => Vec2::ZERO,
        }
    }

    /// Learns from how far a reading in flight was off.
    #[inline]
    pub(crate) fn learn(&mut self, off: Vec2<S>, modes: &Option<Modes<S>>) {
        let Some(modes) = modes.as_ref().filter(|_| BENDING) else {
            return;
        };
        for ([x, y], mode) in self.swings.iter_mut().zip(&modes.0) {
            for (coordinate, off) in [(x, off.x), (y, off.y)] {
                let learnt = *coordinate + mode.gain * off;
                // No shaft bends so far, and no number is no swing.
                *coordinate = if learnt.exceeds(S::ONE) {
                    Vec2::ZERO
                } else {
                    learnt
                };
            }
        }
    }

    /// Forgets at the wall, whose impacts begin another swing, as fast as it learns.
    #[inline]
    pub(crate) fn fade(&mut self, modes: &Option<Modes<S>>) {
        if BENDING && modes.is_some() {
            *self = self.times(S::from_f32(1.0 - LEARNT));
        }
    }

    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }

    /// After a change of the unit of length.
    pub(crate) fn rescale(&mut self, length: S) {
        *self = self.times(length);
    }

    fn times(&self, factor: S) -> Self {
        Self {
            swings: self
                .swings
                .map(|swing| swing.map(|coordinate| coordinate * factor)),
        }
    }
}
