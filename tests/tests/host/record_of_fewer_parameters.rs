//! A record of version 3 by firmware whose configuration had fewer parameters: what came later reads as not told.

use firmware_bench::record::file::{Damage, RecordFile};
use firmware_bench::run::controller::written;
use supervisor::{PARAMETERS, Part, Stamp, Supervisor, crc_of};
use system_tests::rig::{config, sample};

/// Words of a section before those of its part.
const HEAD_WORDS: usize = 3;

/// The bytes with so many values in the section of the configuration.
fn with_values(bytes: &[u8], values: usize) -> Vec<u8> {
    let (words, _) = bytes.as_chunks::<4>();
    let word = |i: usize| u32::from_le_bytes(words[i]);
    let (mut all, mut at) = (Vec::new(), 0);
    while at < words.len() {
        let count = (word(at + 2) >> 16) as usize;
        let end = at + HEAD_WORDS + count + 1;
        if word(at) == Part::Config as u32 {
            let mut section = words[at..at + HEAD_WORDS + count.min(values)].to_vec();
            section.resize(HEAD_WORDS + values, [0; 4]);
            section[2] = ((values as u32) << 16 | word(at + 2) & 0xFFFF).to_le_bytes();
            let section = section.concat();
            all.extend_from_slice(&section);
            all.extend(crc_of(&section).to_le_bytes());
        } else {
            all.extend_from_slice(&words[at..end].concat());
        }
        at = end;
    }
    all
}

#[test]
fn parameters_that_came_later_read_as_not_told() {
    let told = supervisor::Config {
        bending_first_hz: 1234.0,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&told).unwrap();
    for i in 0..900_u32 {
        let outwards = (3e-5 * i.saturating_sub(99) as f32).min(2.02e-4);
        let back = (2e-6 * i.saturating_sub(250) as f32).min(outwards);
        // The last digits of a sensor.
        let noise = 4e-7 * (i % 3) as f32;
        supervisor.tick(&sample(i, [outwards - back + noise, noise]));
    }
    let bytes = written(&supervisor.record().unwrap(), &Stamp::default());
    let read = |bytes: &[u8]| {
        let mut file = RecordFile::of(bytes);
        (file.records.remove(0).config, file.damage)
    };
    assert_eq!(read(&bytes), (Some(told), vec![]));
    // Of the first firmware with this format.
    assert_eq!(read(&with_values(&bytes, 31)), (Some(config()), vec![]));
    // One fewer is of no firmware: that value had no other meaning to be left out with. One more is of a later one.
    for values in [30, PARAMETERS.len() + 1] {
        let (config, damage) = read(&with_values(&bytes, values));
        assert_eq!(config, None, "{values}");
        assert!(matches!(
            damage[..],
            [Damage::Missing {
                what: "configurations",
                ..
            }]
        ));
    }
}
