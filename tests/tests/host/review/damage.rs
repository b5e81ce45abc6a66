//! Flight records that are not whole: what is given back was written so, and what is missing is named.

use super::{finds_sound_figures, landings};
use firmware_bench::record::file::{Damage, PlaneRecord, RecordFile};
use firmware_bench::record::replay::replay;
use supervisor::{Entry, Part, crc_of};
use system_tests::storm::Chance;

/// Sections of these bytes.
pub(super) fn sections(bytes: &[u8]) -> Vec<&[u8]> {
    let mut sections = Vec::new();
    let mut rest = bytes;
    while !rest.is_empty() {
        let words = u16::from_le_bytes([rest[10], rest[11]]);
        let (section, more) = rest.split_at(4 * (usize::from(words) + 4));
        sections.push(section);
        rest = more;
    }
    sections
}

/// Bytes with something wrong with them.
fn damaged(of: &[Vec<u8>; 3], chance: &mut Chance) -> Vec<u8> {
    let below = |n: usize, chance: &mut Chance| (chance.bits() % n as u64) as usize;
    let one = &of[below(3, chance)];
    let other = &of[below(3, chance)];
    let mut bytes = one.clone();
    match chance.bits() % 7 {
        // Flipped bits.
        0 => {
            for _ in 0..=below(8, chance) {
                let at = below(bytes.len(), chance);
                bytes[at] ^= 1 << below(8, chance);
            }
        }
        // Cut off, at either end.
        1 => bytes.truncate(below(one.len(), chance)),
        2 => _ = bytes.drain(..below(one.len(), chance)),
        // Bytes that are missing, or there twice.
        3 => {
            let from = below(one.len(), chance);
            let to = (from + below(600, chance)).min(one.len());
            bytes.drain(from..to);
        }
        4 => {
            let from = below(one.len(), chance);
            let to = (from + below(600, chance)).min(one.len());
            bytes.splice(from..from, one[from..to].iter().copied());
        }
        // Sections in another order, or of another record.
        5 => {
            let mut all = sections(one);
            for _ in 0..=below(5, chance) {
                let (a, b) = (below(all.len(), chance), below(all.len(), chance));
                all.swap(a, b);
            }
            let others = sections(other);
            let at = below(all.len(), chance);
            all[at] = others[below(others.len(), chance)];
            bytes = all.concat();
        }
        // Joined, and then cut.
        _ => {
            bytes.extend(other);
            bytes.truncate(below(bytes.len(), chance));
        }
    }
    bytes
}

/// Ten thousand damaged files: what is given back was written so, and what is missing is named.
#[test]
fn no_damage_makes_a_wrong_figure() {
    let whole = landings();
    let originals: Vec<PlaneRecord> = (whole.iter())
        .flat_map(|bytes| RecordFile::of(bytes).records)
        .collect();
    let mut chance = Chance::new(35);
    let mut parts = 0;
    for number in 0..10_000 {
        let bytes = damaged(&whole, &mut chance);
        let file = RecordFile::of(&bytes);
        for record in &file.records {
            let original = (originals.iter()).find(|o| o.head == record.head);
            let original =
                original.unwrap_or_else(|| panic!("{number}: a head that was not written"));
            let same = |of: bool, what: &str| assert!(of, "{number}: {what} that was not written");
            same(
                record.summary.is_none() || record.summary == original.summary,
                "a summary",
            );
            same(
                record.config.is_none() || record.config == original.config,
                "a configuration",
            );
            same(
                record.shaft.is_none() || record.shaft == original.shaft,
                "a shaft",
            );
            same(
                record.state.is_none() || record.state == original.state,
                "a state",
            );
            same(
                record.track.iter().all(|s| original.track.contains(s)),
                "a stretch",
            );
            for (at, entry) in &record.entries {
                same(original.entries.get(at) == Some(entry), "a tick");
            }
            parts += record.entries.len();
            if file.is_intact() {
                assert_eq!(record, original, "{number}");
            }
        }
        if number % 50 == 0 {
            finds_sound_figures(&file, &number.to_string());
        }
        if let Ok(replay) = replay(&file.records.iter().collect::<Vec<_>>()) {
            assert_eq!(replay.differing, 0, "{number}");
        }
        let known = whole.contains(&bytes);
        assert!(
            known || !file.is_intact() || !file.records.is_empty(),
            "{number}"
        );
    }
    assert!(parts > 300_000, "{parts} ticks");
}

/// Cut at any byte it gives every tick of the sections before.
#[test]
fn what_is_before_a_cut_is_there() {
    let [bytes, ..] = landings();
    let all = sections(&bytes);
    for cut in 1..bytes.len() {
        let file = RecordFile::of(&bytes[..cut]);
        assert!(!file.is_intact());
        let mut left = cut;
        let whole = all.iter().take_while(|section| {
            let fits = section.len() <= left;
            left = left.saturating_sub(section.len());
            fits
        });
        let ticks = whole
            .filter(|section| section.starts_with(&(Part::Ticks as u32).to_le_bytes()))
            .map(|section| (section.len() - 16) / size_of::<Entry>());
        let found = file
            .records
            .first()
            .map_or(0, |record| record.entries.len());
        assert_eq!(found, ticks.sum::<usize>(), "{cut}");
    }
}

/// A head of another version is named.
#[test]
fn another_version_is_named() {
    let [mut bytes, ..] = landings();
    let length = sections(&bytes)[0].len();
    let (head, _) = bytes.split_at_mut(length);
    let end = head.len() - 4;
    head[12] = 9;
    let crc = crc_of(&head[..end]).to_le_bytes();
    head[end..].copy_from_slice(&crc);
    let file = RecordFile::of(&bytes);
    assert!(
        file.damage.contains(&Damage::Version(9)),
        "{:?}",
        file.damage
    );
    assert_eq!(file.records, []);
}
