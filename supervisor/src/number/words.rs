//! Words that two priorities see at once: the tick writes them and the background reads, or the other way round. Plain loads and
//! stores on every target; who may write when is up to those who share them, and whoever breaks that gets old words or new ones,
//! never half of one.
//!
//! What a core remembers, as words of 32 bits that are the same on every target: a flight record keeps them, to be replayed
//! from.

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

/// Something that goes into words and comes back the same.
pub trait Words: Copy {
    /// Hands its words over, in an order that never changes.
    fn encode(&self, to: &mut dyn FnMut(u32));
    /// From words that [`Self::encode`] made; any others, or too few, make something as well.
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self;
    /// How many words it has: always as many.
    #[inline]
    fn word_count(&self) -> u32 {
        1
    }
    /// Lays its words into cells from `at` on, as far as there are any. Where the next ones come. Piece by piece: a routine that
    /// copies all at once takes a hundred bytes of stack.
    #[inline]
    fn write_cells(&self, cells: &[AtomicU32], at: usize) -> usize {
        let mut at = at;
        self.encode(&mut |word| {
            set(cells, at, word);
            at += 1;
        });
        at
    }
}

/// Words of a struct: those of its fields, all of which have to be named.
macro_rules! words_of_fields {
    ($name:ident $(<$s:ident>)? { $($field:ident),* $(,)? }) => {
        impl $(<$s: Scalar>)? crate::number::words::Words for $name $(<$s>)? {
            // Once, and not wherever a record is written.
            #[inline(never)]
            fn encode(&self, to: &mut dyn FnMut(u32)) {
                let Self { $($field),* } = self;
                $(crate::number::words::Words::encode($field, to);)*
            }
            fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
                Self { $($field: crate::number::words::Words::decode(from)),* }
            }
            #[inline]
            fn word_count(&self) -> u32 {
                0 $(+ crate::number::words::Words::word_count(&self.$field))*
            }
            #[inline]
            fn write_cells(&self, cells: &[core::sync::atomic::AtomicU32], at: usize) -> usize {
                $(let at = crate::number::words::Words::write_cells(&self.$field, cells, at);)*
                at
            }
        }
    };
}

pub(crate) use words_of_fields;

/// A word each.
macro_rules! words_of_integers {
    ($($type:ty),*) => {$(
        impl Words for $type {
            fn encode(&self, to: &mut dyn FnMut(u32)) {
                to(*self as u32);
            }
            fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
                from.next().unwrap_or_default() as $type
            }
        }
    )*};
}

words_of_integers!(u8, i8, u16, u32, i32);

impl Words for bool {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(u32::from(*self));
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        from.next() == Some(1)
    }
}

/// The lower half first.
impl Words for u64 {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(*self as u32);
        to((self >> 32) as u32);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        let [low, high] = [(); 2].map(|()| u64::from(u32::decode(from)));
        low | high << 32
    }
    fn word_count(&self) -> u32 {
        2
    }
}

impl Words for f32 {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        to(self.to_bits());
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        Self::from_bits(u32::decode(from))
    }
}

impl Words for f64 {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        self.to_bits().encode(to);
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        Self::from_bits(u64::decode(from))
    }
    fn word_count(&self) -> u32 {
        2
    }
}

impl<T: Words, const N: usize> Words for [T; N] {
    fn encode(&self, to: &mut dyn FnMut(u32)) {
        self.iter().for_each(|x| x.encode(to));
    }
    fn decode(from: &mut dyn Iterator<Item = u32>) -> Self {
        [(); N].map(|()| T::decode(from))
    }
    #[inline]
    fn word_count(&self) -> u32 {
        self.iter().map(T::word_count).sum()
    }
    #[inline]
    fn write_cells(&self, cells: &[AtomicU32], at: usize) -> usize {
        self.iter().fold(at, |at, x| x.write_cells(cells, at))
    }
}

/// Four bytes into a CRC-32 (IEEE, reflected), a nibble at a time: no table of a kilobyte.
pub(crate) fn crc_of_word(crc: u32, word: u32) -> u32 {
    #[rustfmt::skip]
    const NIBBLE: [u32; 16] = [
        0x0000_0000, 0x1DB7_1064, 0x3B6E_20C8, 0x26D9_30AC, 0x76DC_4190, 0x6B6B_51F4, 0x4DB2_6158, 0x5005_713C,
        0xEDB8_8320, 0xF00F_9344, 0xD6D6_A3E8, 0xCB61_B38C, 0x9B64_C2B0, 0x86D3_D2D4, 0xA00A_E278, 0xBDBD_F21C,
    ];
    let mut crc = crc ^ word;
    for _ in 0..8 {
        crc = (crc >> 4) ^ NIBBLE[(crc & 15) as usize];
    }
    crc
}
