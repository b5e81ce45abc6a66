//! Words that two priorities see at once: the tick writes them and the background reads, or the other way round. Plain loads and
//! stores on every target; who may write when is up to those who share them, and whoever breaks that gets old words or new ones,
//! never half of one.

use core::sync::atomic::{AtomicU32, Ordering};

/// Some of them.
#[derive(Debug)]
pub(crate) struct Cells<const N: usize>([AtomicU32; N]);

impl<const N: usize> Cells<N> {
    /// All zero.
    #[inline(always)]
    pub(crate) const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; N])
    }

    /// Some words.
    pub(crate) fn of(words: [u32; N]) -> Self {
        Self(words.map(AtomicU32::new))
    }

    /// To be written to, or read one by one.
    #[inline]
    pub(crate) fn all(&self) -> &[AtomicU32; N] {
        &self.0
    }

    /// What is in them.
    #[inline]
    pub(crate) fn words(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|cell| cell.load(Ordering::Relaxed))
    }

    /// Takes over what is in others.
    pub(crate) fn become_copy_of(&self, other: &Self) {
        let pairs = self.0.iter().zip(other.words());
        pairs.for_each(|(cell, word)| cell.store(word, Ordering::Relaxed));
    }
}

impl<const N: usize> Clone for Cells<N> {
    fn clone(&self) -> Self {
        let copy = Self::new();
        copy.become_copy_of(self);
        copy
    }
}

/// Writes into one of some cells, where there are so many.
#[inline]
pub(crate) fn set(cells: &[AtomicU32], at: usize, word: u32) {
    if let Some(cell) = cells.get(at) {
        cell.store(word, Ordering::Relaxed);
    }
}
