//! A flight record as its reader gets it: what the recorder freezes is read and replayed to the bit, and the host's decoder takes
//! any bytes: it gives what is whole and names the rest.

#![no_main]

use fuzz::record::file::RecordFile;
use fuzz::record::replay::replay;
use fuzz::record::ticks::Ticks;
use fuzz::{Bytes, plausible};
use libfuzzer_sys::fuzz_target;
use supervisor::{Sample, Stamp, Status, Supervisor, crc_of};

/// CRC-32 (IEEE), bit by bit.
fn crc_by_bits(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 }
        })
    })
}

/// Records, with a call of `rearm` and of `next_event` where the input wants it; each with some bytes of the input in it.
fn what_is_recorded(data: &[u8]) {
    let mut bytes = Bytes::new(data);
    let mut supervisor = Supervisor::<8>::new(&plausible()).expect("in range");
    let mut sequence = 0_u32;
    while bytes.left() > 0 {
        let what = bytes.u8();
        sequence = sequence.wrapping_add(1 + u32::from(what & 1));
        supervisor.tick(&Sample {
            sequence,
            status: Status::from_bits_retain(2 | u32::from(what & 0x20)),
            position_m: [0; 2].map(|_| 2e-6 * f32::from(bytes.u8() as i8)),
            ..Sample::default()
        });
        if what & 2 != 0 {
            let _ = supervisor.next_event();
        }
        let Some(record) = supervisor.record() else {
            continue;
        };
        let sections = (0..).map_while(|i| record.section(i, &Stamp::default()));
        let mut written: Vec<u8> = (sections.flat_map(|mut s| s.seal().to_vec())).collect();
        let file = RecordFile::of(&written);
        assert!(file.is_intact());
        if let Ok(replay) = replay(&file.records.iter().collect::<Vec<_>>()) {
            assert_eq!(replay.differing, 0);
        }
        let at = usize::from(what) * written.len() / 256;
        written[at] ^= bytes.u8() | 1;
        let damaged = RecordFile::of(&written);
        assert!(!damaged.is_intact());
        for entry in damaged.records.iter().flat_map(|r| &r.entries) {
            assert_eq!(file.records[0].entries.get(entry.0), Some(entry.1));
        }
        if what & 0x1C == 0 {
            supervisor.rearm();
        }
    }
}

fn decoded(data: &[u8]) {
    for record in &RecordFile::of(data).records {
        let _ = Ticks::of(record);
    }
    assert_eq!(crc_of(&data[..data.len() / 4 * 4]), crc_by_bits(&data[..data.len() / 4 * 4]));
}

fuzz_target!(|data: &[u8]| {
    decoded(data);
    what_is_recorded(data);
});
