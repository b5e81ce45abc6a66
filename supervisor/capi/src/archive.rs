//! The functions of the header on an archive: records of several events in memory of the caller's.

use crate::calls::ending;
use crate::code::Code;
use crate::halves::{self, RECORD, RotorStorage, Storage};
use crate::layout::defined;
use crate::pointer::{Argument, OutPtr};
use crate::storage::{Content, Lease, Making, Slot};
use crate::structs::{CSection, CStamp};
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicUsize, Ordering};
use supervisor::{ArchiveIn, ArchivePlace};

/// What is in an `amb_archive_place`.
pub type Shelf = MaybeUninit<ArchivePlace<RECORD>>;

/// What is in an `amb_archive`. It stays where it was made: two that know the same places would change what the other reads.
#[repr(C)]
pub struct ArchiveStorage {
    slot: Slot<ArchiveIn<'static, RECORD>>,
    /// Its address when it was made.
    home: AtomicUsize,
}

impl Content for ArchiveIn<'static, RECORD> {
    const READY: u32 = 0xA3B1_A2C4;
    const BUSY: u32 = 0xA3B1_A2B5;
    const NOT_MADE: Code = Code::ERROR_ARCHIVE_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_ARCHIVE_BUSY;
}

const ALIGN: usize = defined("AMB_SUPERVISOR_ALIGN");

const _: () = {
    let (bytes, place) = (
        defined("AMB_ARCHIVE_BYTES"),
        defined("AMB_ARCHIVE_PLACE_BYTES"),
    );
    assert!(size_of::<ArchiveStorage>() <= bytes && bytes <= size_of::<ArchiveStorage>() + 64);
    assert!(
        size_of::<Shelf>() == place && place.is_multiple_of(ALIGN),
        "an array of shelves is one of places: `cargo run --release -p system-tests --bin parameters -- --write` writes their size"
    );
    assert!(align_of::<ArchiveStorage>() <= ALIGN && align_of::<Shelf>() <= ALIGN);
};

/// # Safety
/// Where `archive` is neither null nor misaligned it points to an `amb_archive` that has been written to (static memory has) and
/// that only this library touches.
unsafe fn slot<'a>(archive: *mut ArchiveStorage) -> Result<&'a ArchiveStorage, Code> {
    Argument::Archive.check_to(ALIGN, archive.cast_const())?;
    // SAFETY: not null, aligned and large enough; any bytes are valid, because its words are integers and the rest may be
    // uninitialised.
    Ok(unsafe { &*archive })
}

/// An archive that was made in this very place, for one call.
///
/// # Safety
/// As for [`slot`].
unsafe fn lease<'a>(
    archive: *mut ArchiveStorage,
) -> Result<Lease<'a, ArchiveIn<'static, RECORD>>, Code> {
    // SAFETY: the caller's promise.
    let this = unsafe { slot(archive) }?;
    if this.home.load(Ordering::Relaxed) != archive.addr() {
        return Err(Code::ERROR_ARCHIVE_NOT_INITIALISED);
    }
    Lease::new(&this.slot)
}

/// Makes an archive without a record in storage of the caller's.
///
/// # Safety
/// `archive` is null, misaligned, or points to an `amb_archive` that has been written to; `places` is null, misaligned, or points to
/// `count` places. Only this library touches both from now on, and the places are those of no other archive.
// SAFETY: all names of this library begin with amb_, and none twice.
#[unsafe(export_name = concat!("amb_archive_init", ending!()))]
pub unsafe extern "C" fn amb_archive_init(
    archive: *mut ArchiveStorage,
    places: *mut Shelf,
    count: usize,
) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe { slot(archive) }.and_then(|this| {
        Argument::Places.check_to(ALIGN, places.cast_const())?;
        // More would not be an object.
        let most = isize::MAX.unsigned_abs() / size_of::<Shelf>();
        if count == 0 || count > most {
            return Err(Code::ERROR_PLACES_COUNT);
        }
        let making = Making::new(&this.slot)?;
        // In place: one that is made goes over the stack, which takes 24 kilobytes; the test `capi` looks.
        // SAFETY: these are the places that the caller promises, and aligned. The making keeps every other call away.
        unsafe { places.write_bytes(0, count) };
        // SAFETY: as before; all bits zero are a place, as its type says. They live and are this archive's alone by the caller's
        // promise.
        let places = unsafe { core::slice::from_raw_parts_mut(places.cast(), count) };
        this.home.store(archive.addr(), Ordering::Relaxed);
        making.finish(ArchiveIn::new(places));
        Ok(())
    });
    Code::from_result(done)
}

/// As something was there or not.
fn whether(there: bool) -> Result<(), Code> {
    match there {
        true => Ok(()),
        false => Err(Code::NOTHING),
    }
}

/// Copies the frozen record of a supervisor, and gives it back.
///
/// # Safety
/// `archive` is null, misaligned, or points to storage given to [`amb_archive_init`] or full of zeros; `supervisor` as for
/// [`crate::calls::amb_tick`].
// SAFETY: a name of its own, see `amb_archive_init`.
#[unsafe(export_name = concat!("amb_archive_take", ending!()))]
pub unsafe extern "C" fn amb_archive_take(
    archive: *mut ArchiveStorage,
    supervisor: *mut Storage,
) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe { lease(archive) }.and_then(|mut archive| {
        // SAFETY: the caller's promise.
        let mut reader = unsafe { halves::reader(supervisor) }?;
        whether(archive.content().take(reader.content()))
    });
    Code::from_result(done)
}

/// Copies the frozen records of both planes of a rotor, each to an archive of its own, and gives them back.
///
/// # Safety
/// `first` and `second` as for [`amb_archive_take`]; `rotor` as for [`crate::rotor::amb_rotor_tick`].
// SAFETY: a name of its own, see `amb_archive_init`.
#[unsafe(export_name = concat!("amb_archive_take_rotor", ending!()))]
pub unsafe extern "C" fn amb_archive_take_rotor(
    first: *mut ArchiveStorage,
    second: *mut ArchiveStorage,
    rotor: *mut RotorStorage,
) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe { lease(first) }.and_then(|mut first| {
        // SAFETY: the caller's promise. The first one once more is refused as in use.
        let mut second = unsafe { lease(second) }?;
        // SAFETY: the caller's promise.
        let mut reader = unsafe { halves::reader(rotor) }?;
        let planes = [first.content(), second.content()];
        whether(ArchiveIn::take_rotor(planes, reader.content()))
    });
    Code::from_result(done)
}

/// How many records are kept.
///
/// # Safety
/// `archive` as for [`amb_archive_take`]; `count` is null, misaligned, or points to memory for a number.
// SAFETY: a name of its own, see `amb_archive_init`.
#[unsafe(export_name = concat!("amb_archive_count", ending!()))]
pub unsafe extern "C" fn amb_archive_count(archive: *mut ArchiveStorage, count: *mut u32) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe { lease(archive) }.and_then(|mut archive| {
        // SAFETY: the caller's promise.
        let place = unsafe { OutPtr::new(Argument::Result, count) }?;
        place.write(u32::try_from(archive.content().count()).unwrap_or(u32::MAX));
        Ok(())
    });
    Code::from_result(done)
}

/// A section of the oldest record, 0 the first.
///
/// # Safety
/// `archive` as for [`amb_archive_take`]; `stamp` and `section` are null, misaligned, or point to their structs.
// SAFETY: a name of its own, see `amb_archive_init`.
#[unsafe(export_name = concat!("amb_archive_section", ending!()))]
pub unsafe extern "C" fn amb_archive_section(
    archive: *mut ArchiveStorage,
    index: u32,
    stamp: *const CStamp,
    section: *mut CSection,
) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe { lease(archive) }.and_then(|mut archive| {
        // SAFETY: the caller's promise.
        let stamp = unsafe { Argument::Stamp.read(stamp) }?.into();
        // SAFETY: the caller's promise.
        let place = unsafe { OutPtr::new(Argument::Result, section) }?;
        let record = archive.content().oldest();
        let made = record.and_then(|record| record.section(index, &stamp));
        place.write(CSection::new(made.ok_or(Code::NOTHING)?.seal()));
        Ok(())
    });
    Code::from_result(done)
}

/// Makes room where the oldest record was.
///
/// # Safety
/// `archive` as for [`amb_archive_take`].
// SAFETY: a name of its own, see `amb_archive_init`.
#[unsafe(export_name = concat!("amb_archive_discard", ending!()))]
pub unsafe extern "C" fn amb_archive_discard(archive: *mut ArchiveStorage) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe { lease(archive) }.and_then(|mut archive| {
        let there = archive.content().count() > 0;
        archive.content().discard();
        whether(there)
    });
    Code::from_result(done)
}
