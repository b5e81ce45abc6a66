//! A flight record as its reader gets it: the checksum over any entries is the CRC-32 of their bytes, one wrong bit
//! does not go unnoticed, what the recorder freezes it has summed up itself, and the host's decoder takes any bytes:
//! refused with a reason, or read so that every byte of them counts.

#![no_main]

use fuzz::flight_record::{FlightRecord, NotARecord, Units, entries};
use fuzz::{Bytes, plausible};
use libfuzzer_sys::fuzz_target;
use supervisor::{Entry, Sample, Status, Supervisor, crc_of};

/// CRC-32 (IEEE), bit by bit.
fn crc_by_bits(bytes: impl Iterator<Item = u8>) -> u32 {
    !bytes.fold(!0_u32, |crc, byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 }
        })
    })
}

fn bytes_of(e: &Entry) -> Vec<u8> {
    let mut bytes = e.sequence.to_le_bytes().to_vec();
    for number in e.position.iter().chain(&e.force) {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([e.mode, e.limits]);
    bytes.extend(e.events.to_le_bytes());
    bytes
}

fn entry_of(b: &[u8; 16]) -> Entry {
    let i16_at = |i: usize| i16::from_le_bytes([b[i], b[i + 1]]);
    Entry {
        sequence: u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        position: [i16_at(4), i16_at(6)],
        force: [i16_at(8), i16_at(10)],
        mode: b[12],
        limits: b[13],
        events: u16::from_le_bytes([b[14], b[15]]),
    }
}

fn any_entries(data: &[u8]) {
    let entries: Vec<Entry> = (data.as_chunks::<16>().0.iter()).map(entry_of).collect();
    let whole = &data[..16 * entries.len()];
    let crc = crc_of(entries.iter());
    assert_eq!(crc, crc_by_bits(whole.iter().copied()));
    if let Some(bit) = data
        .first()
        .map(|b| usize::from(*b) % (8 * whole.len().max(1)))
    {
        let mut wrong = whole.to_vec();
        if let Some(byte) = wrong.get_mut(bit / 8) {
            *byte ^= 1 << (bit % 8);
            assert_ne!(
                crc,
                crc_of(
                    wrong
                        .as_chunks::<16>()
                        .0
                        .iter()
                        .map(entry_of)
                        .collect::<Vec<_>>()
                        .iter()
                )
            );
        }
    }
}

/// Two records, with a call of `rearm` and of `next_event` where the input wants it.
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
        if let Some(record) = supervisor.record() {
            assert_eq!(record.entries().count(), 8);
            assert_eq!(record.crc, crc_of(record.entries()));
            assert_eq!(record.crc, crc_by_bits(record.entries().flat_map(bytes_of)));
            if what & 0x1C == 0 {
                supervisor.rearm();
            }
        }
    }
}

fn decoded(data: &[u8]) {
    let modes = data.as_chunks::<16>().0.iter().map(|b| b[12]);
    match entries(data) {
        Ok(entries) => {
            assert!(modes.into_iter().all(|mode| mode <= 6));
            assert_eq!(entries.iter().flat_map(bytes_of).collect::<Vec<_>>(), data);
            let record = FlightRecord::of(&entries, Units::default());
            assert_eq!(record.crc, crc_by_bits(data.iter().copied()));
            assert_eq!(record.empty + record.ticks.len(), entries.len());
            let in_stretches: usize = record.stretches.iter().map(|s| s.ticks).sum();
            assert_eq!(in_stretches, record.ticks.len());
            assert!(record.turning_points().count() >= record.stretches.len());
        }
        Err(NotARecord::Length(length)) => assert!(length == 0 || length % 16 != 0),
        Err(NotARecord::Mode { entry, mode }) => {
            assert!(mode > 6 && data[16 * entry + 12] == mode);
        }
    }
}

fuzz_target!(|data: &[u8]| {
    any_entries(data);
    decoded(data);
    // Mostly modes that there are, or hardly an input would be read to its end.
    let mut data_with_modes = data[..data.len() / 16 * 16].to_vec();
    for entry in data_with_modes.as_chunks_mut::<16>().0 {
        entry[12] %= 7;
    }
    decoded(&data_with_modes);
    what_is_recorded(data);
});
