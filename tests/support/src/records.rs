//! Records as they are written down.

use supervisor::{Head, QueuedEvent, Reader, Record, Scalar, Stamp};

/// All sections of a record, sealed.
pub fn written<S: Scalar, const N: usize>(record: &Record<'_, S, N>) -> Vec<u8> {
    let sections = (0..).map_while(|i| record.section(i, &Stamp::default()));
    sections
        .flat_map(|mut section| section.seal().to_vec())
        .collect()
}

/// What its first section says it is.
pub fn head<S: Scalar, const N: usize>(record: &Record<'_, S, N>) -> Head {
    let bytes = written(record);
    let (words, _) = bytes.as_chunks::<4>();
    // Its part, which record, and the counts are before it.
    let words: Vec<u32> = (words.iter().skip(3))
        .map(|w| u32::from_le_bytes(*w))
        .collect();
    Head::from_words(&words)
}

/// Takes everything there is from a reader; the record is armed again.
///
/// # Panics
/// If the record is still there then.
pub fn taken<S: Scalar, const N: usize>(
    reader: &mut Reader<'_, S, N>,
    events: &mut Vec<QueuedEvent>,
    records: &mut Vec<Vec<u8>>,
) {
    while let Some(event) = reader.next_event() {
        events.push(event);
    }
    let record = reader.record().map(|record| written(&record));
    if let Some(record) = record {
        records.push(record);
        reader.rearm();
        assert!(reader.record().is_none());
    }
}
