//! Instructions of ticks, as the image `count` has written them.

use firmware_image::wire::mode_of;
use serde::Serialize;

/// Least, middle and most of some counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Spread {
    pub ticks: usize,
    /// Least instructions of a tick.
    pub min_instructions: u32,
    /// As many ticks have more as have fewer.
    pub median_instructions: u32,
    /// Most instructions of a tick.
    pub worst_instructions: u32,
}

impl Spread {
    /// `None` without any.
    fn of(mut counts: Vec<u32>) -> Option<Self> {
        counts.sort_unstable();
        Some(Self {
            ticks: counts.len(),
            min_instructions: *counts.first()?,
            median_instructions: counts[counts.len() / 2],
            worst_instructions: *counts.last()?,
        })
    }
}

/// The same for the ticks that ended in a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct OfMode {
    pub mode: &'static str,
    /// Its ticks.
    #[serde(flatten)]
    pub spread: Spread,
}

/// All ticks and those of each mode.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// All ticks.
    #[serde(flatten)]
    pub all: Spread,
    /// Of each mode that occurs.
    pub modes: Vec<OfMode>,
}

/// Instructions and mode of each tick, of the image's file.
pub(crate) fn ticks_of(bytes: &[u8]) -> impl Iterator<Item = (u32, u8)> {
    let (words, _) = bytes.as_chunks::<4>();
    words.iter().map(|[low, middle, high, mode]| {
        let instructions = u32::from_le_bytes([*low, *middle, *high, 0]);
        (instructions, *mode)
    })
}

/// Reads the image's file; `None` if it is not one.
pub(crate) fn counts_of(bytes: &[u8]) -> Option<Counts> {
    if !bytes.len().is_multiple_of(4) {
        return None;
    }
    let mut by_mode: Vec<(u8, Vec<u32>)> = Vec::new();
    let mut all = Vec::with_capacity(bytes.len() / 4);
    for (instructions, mode) in ticks_of(bytes) {
        all.push(instructions);
        match by_mode.iter_mut().find(|(m, _)| *m == mode) {
            Some((_, counts)) => counts.push(instructions),
            None => by_mode.push((mode, vec![instructions])),
        }
    }
    by_mode.sort_unstable_by_key(|(mode, _)| *mode);
    let of_mode = |(mode, counts)| {
        Some(OfMode {
            mode: mode_of(mode)?.name(),
            spread: Spread::of(counts)?,
        })
    };
    Some(Counts {
        all: Spread::of(all)?,
        modes: by_mode.into_iter().map(of_mode).collect::<Option<_>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_sorted_by_mode() {
        let bytes: Vec<u8> = [0x0200_0005_u32, 7, 0x0200_0009, 3, 4]
            .into_iter()
            .flat_map(u32::to_le_bytes)
            .collect();
        let counts = counts_of(&bytes).unwrap();
        assert_eq!(
            (counts.all.min_instructions, counts.all.worst_instructions),
            (3, 9)
        );
        assert_eq!(counts.all.median_instructions, 5);
        let names: Vec<_> = counts
            .modes
            .iter()
            .map(|m| (m.mode, m.spread.ticks))
            .collect();
        assert_eq!(names, [("levitated", 3), ("bounce", 2)]);
        assert_eq!(counts_of(&bytes[1..]), None);
        assert_eq!(counts_of(&[0, 0, 0, 99]), None, "no such mode");
    }
}
