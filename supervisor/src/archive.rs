//! Records of several events, in memory of the background's: it copies what has frozen and gives it back at once, so that the
//! recorder waits for the next event while nobody has written the last one down yet. The tick knows nothing of it.

use crate::number::scalar::Scalar;
use crate::record::buffer::RecordBuffer;
use crate::record::sections::Record;
use crate::rotor::two_planes::RotorReader;
use crate::supervisor::Reader;
use core::marker::PhantomData;

/// Room for the record of an event of one plane: the record, and of a rotor its shaft. It consists of words alone, and with all
/// bits zero it is one without a record.
#[derive(Debug)]
// An array of places is one of places in C, whose alignment this is.
#[repr(align(8))]
pub struct ArchivePlace<const RECORD: usize = 512> {
    buffer: RecordBuffer<RECORD>,
    of_rotor: bool,
    shaft: [f32; 9],
}

impl<const RECORD: usize> ArchivePlace<RECORD> {
    /// Without a record.
    #[inline(always)]
    pub const fn new() -> Self {
        Self {
            buffer: RecordBuffer::blank(),
            of_rotor: false,
            shaft: [0.0; 9],
        }
    }
}

impl<const RECORD: usize> Default for ArchivePlace<RECORD> {
    fn default() -> Self {
        Self::new()
    }
}

/// Which of some places are taken.
#[derive(Debug)]
struct Order {
    /// Place of the oldest.
    oldest: usize,
    count: usize,
    /// Events that have gone since the last record was discarded, with those that these knew of.
    gone: u32,
}

impl Order {
    #[inline(always)]
    const fn new() -> Self {
        Self {
            oldest: 0,
            count: 0,
            gone: 0,
        }
    }

    /// Copies a buffer that has frozen to the next place.
    fn copy<const RECORD: usize>(
        &mut self,
        places: &mut [ArchivePlace<RECORD>],
        buffer: &RecordBuffer<RECORD>,
        shaft: Option<[f32; 9]>,
    ) -> bool {
        if places.is_empty() || !buffer.is_frozen() {
            return false;
        }
        if self.count >= places.len() {
            let oldest = self.record::<f32, RECORD>(places);
            let knew = oldest.map_or(0, |mut record| *record.dropped());
            self.remove(places.len());
            self.gone = knew.saturating_add(1);
        }
        let free = self.oldest + self.count;
        let free = if free < places.len() {
            free
        } else {
            free - places.len()
        };
        if let Some(place) = places.get_mut(free) {
            place.buffer.become_copy_of(buffer);
            place.of_rotor = shaft.is_some();
            place.shaft = shaft.unwrap_or_default();
            self.count += 1;
        }
        true
    }

    /// The oldest record.
    fn record<'a, S: Scalar, const RECORD: usize>(
        &self,
        places: &'a [ArchivePlace<RECORD>],
    ) -> Option<Record<'a, S, RECORD>> {
        if self.count == 0 {
            return None;
        }
        let kept = places.get(self.oldest)?;
        let mut record = Record::new(&kept.buffer)?;
        record.shaft = kept.of_rotor.then_some(kept.shaft);
        let dropped = record.dropped();
        *dropped = dropped.saturating_add(self.gone);
        Some(record)
    }

    fn discard(&mut self, places: usize) {
        if self.count > 0 {
            self.remove(places);
            self.gone = 0;
        }
    }

    fn remove(&mut self, places: usize) {
        self.count -= 1;
        let next = self.oldest + 1;
        self.oldest = if next < places { next } else { 0 };
    }
}

/// Room for the records of `EVENTS` events of one plane. Where one more comes the oldest goes, and is counted: the next that is
/// written down says how many are in no file ([`crate::Head::dropped`]).
///
/// ```
/// use supervisor::{Archive, Config, Sample, Stamp, Supervisor};
///
/// let mut archive = Archive::<f32, 64, 4>::new(); // in a `static`
/// let mut supervisor = Supervisor::<64>::new(&Config::example())?;
/// let (mut ticker, mut reader) = supervisor.split();
///
/// ticker.tick(&Sample::default()); // in the control interrupt
///
/// archive.take(&mut reader); // in the background, as often as it comes round
/// if let Some(record) = archive.oldest() {
///     // When there is time for it.
///     let sections = (0..).map_while(|index| record.section(index, &Stamp::default()));
///     sections.for_each(|mut section| drop(section.seal()));
///     archive.discard();
/// }
/// # Ok::<(), supervisor::ConfigError>(())
/// ```
#[derive(Debug)]
pub struct Archive<S: Scalar = f32, const RECORD: usize = 512, const EVENTS: usize = 4> {
    places: [ArchivePlace<RECORD>; EVENTS],
    order: Order,
    number: PhantomData<S>,
}

impl<S: Scalar, const RECORD: usize, const EVENTS: usize> Archive<S, RECORD, EVENTS> {
    /// Without a record.
    #[inline(always)]
    pub const fn new() -> Self {
        const { assert!(EVENTS > 0, "an archive has room for an event") };
        Self {
            places: [const { ArchivePlace::new() }; EVENTS],
            order: Order::new(),
            number: PhantomData,
        }
    }

    /// Copies a frozen record, if there is one, and gives it back: the next tick waits for an engagement again. Whether there was
    /// one.
    pub fn take(&mut self, reader: &mut Reader<'_, S, RECORD>) -> bool {
        let took = self.copy(&reader.shared().buffer, None);
        reader.rearm();
        took
    }

    fn copy(&mut self, buffer: &RecordBuffer<RECORD>, shaft: Option<[f32; 9]>) -> bool {
        self.order.copy(&mut self.places, buffer, shaft)
    }

    /// How many records are kept.
    pub fn count(&self) -> usize {
        self.order.count
    }

    /// The oldest record. It stays as it is until [`Self::discard`], or until its place is needed.
    pub fn oldest(&self) -> Option<Record<'_, S, RECORD>> {
        self.order.record(&self.places)
    }

    /// Makes room where the oldest record was, if there was one.
    pub fn discard(&mut self) {
        self.order.discard(EVENTS);
    }
}

impl<S: Scalar, const RECORD: usize, const EVENTS: usize> Default for Archive<S, RECORD, EVENTS> {
    fn default() -> Self {
        Self::new()
    }
}

/// Room for the records of `EVENTS` events of a rotor, of both planes each; as [`Archive`].
#[derive(Debug, Default)]
pub struct RotorArchive<const RECORD: usize = 512, const EVENTS: usize = 4> {
    planes: [Archive<f32, RECORD, EVENTS>; 2],
}

impl<const RECORD: usize, const EVENTS: usize> RotorArchive<RECORD, EVENTS> {
    /// Without a record.
    #[inline(always)]
    pub const fn new() -> Self {
        Self {
            planes: [const { Archive::new() }; 2],
        }
    }

    /// As [`Archive::take`], of both planes, which freeze at once.
    pub fn take(&mut self, reader: &mut RotorReader<'_, RECORD>) -> bool {
        let Some(shaft) = reader.record(0).and_then(|record| record.shaft) else {
            return false;
        };
        let planes = self.planes.iter_mut().zip(reader.tapes());
        let took = planes.fold(true, |all, (archive, buffer)| {
            archive.copy(buffer, Some(shaft)) && all
        });
        reader.rearm();
        took
    }

    /// How many events are kept.
    pub fn count(&self) -> usize {
        let [first, _] = &self.planes;
        first.count()
    }

    /// The record of a plane of the oldest event, 0 or 1 (anything else is the second).
    pub fn oldest(&self, end: usize) -> Option<Record<'_, f32, RECORD>> {
        let [first, second] = &self.planes;
        if end == 0 { first } else { second }.oldest()
    }

    /// Makes room where the oldest event was, if there was one.
    pub fn discard(&mut self) {
        self.planes.iter_mut().for_each(Archive::discard);
    }
}

/// An [`Archive`] of one plane in places that are borrowed, for as many events as there are. Without a place it keeps none.
#[derive(Debug)]
pub struct ArchiveIn<'a, const RECORD: usize = 512> {
    places: &'a mut [ArchivePlace<RECORD>],
    order: Order,
}

impl<'a, const RECORD: usize> ArchiveIn<'a, RECORD> {
    /// Without a record; what was in the places is forgotten.
    pub fn new(places: &'a mut [ArchivePlace<RECORD>]) -> Self {
        Self {
            places,
            order: Order::new(),
        }
    }

    /// As [`Archive::take`].
    pub fn take(&mut self, reader: &mut Reader<'_, f32, RECORD>) -> bool {
        let took = (self.order).copy(self.places, &reader.shared().buffer, None);
        reader.rearm();
        took
    }

    /// As [`RotorArchive::take`], with an archive for each plane.
    pub fn take_rotor(planes: [&mut Self; 2], reader: &mut RotorReader<'_, RECORD>) -> bool {
        let Some(shaft) = reader.record(0).and_then(|record| record.shaft) else {
            return false;
        };
        let planes = planes.into_iter().zip(reader.tapes());
        let took = planes.fold(true, |all, (archive, buffer)| {
            (archive.order).copy(archive.places, buffer, Some(shaft)) && all
        });
        reader.rearm();
        took
    }

    /// As [`Archive::count`].
    pub fn count(&self) -> usize {
        self.order.count
    }

    /// As [`Archive::oldest`].
    pub fn oldest(&self) -> Option<Record<'_, f32, RECORD>> {
        self.order.record(self.places)
    }

    /// As [`Archive::discard`].
    pub fn discard(&mut self) {
        self.order.discard(self.places.len());
    }
}
