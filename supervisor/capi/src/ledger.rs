//! The functions of the header on a ledger of landings.

use crate::calls::ending;
use crate::code::Code;
use crate::halves::{self, RECORD, RotorStorage, Storage};
use crate::pointer::{Argument, OutPtr};
use crate::rotor;
use crate::structs::{self, CLedger};
use supervisor::{LEDGER_BYTES, Ledger, LedgerError, Record};

impl From<LedgerError> for Code {
    fn from(error: LedgerError) -> Self {
        match error {
            LedgerError::Length => Self::ERROR_LEDGER_LENGTH,
            LedgerError::Blank => Self::ERROR_LEDGER_BLANK,
            LedgerError::Letters => Self::ERROR_LEDGER_LETTERS,
            LedgerError::Damaged => Self::ERROR_LEDGER_DAMAGED,
            LedgerError::Version => Self::ERROR_LEDGER_VERSION,
            LedgerError::Bearings => Self::ERROR_LEDGER_BEARINGS,
        }
    }
}

impl From<CLedger> for Ledger {
    fn from(c: CLedger) -> Self {
        let [sum, run] = [c.severity_millionths, c.run_severity_millionths];
        Self {
            bearing: c.bearing,
            updates: c.updates,
            severity_allowed: c.severity_allowed,
            landings: c.landings,
            severity_millionths: structs::whole(sum),
            worst_severity: c.worst_severity,
            hardest_impact_m_s: c.hardest_impact_m_s,
            closed_at: c.closed_at,
            run_landings: c.run_landings,
            run_severity_millionths: structs::whole(run),
        }
    }
}

impl From<Ledger> for CLedger {
    fn from(ledger: Ledger) -> Self {
        Self {
            bearing: ledger.bearing,
            updates: ledger.updates,
            severity_allowed: ledger.severity_allowed,
            landings: ledger.landings,
            severity_millionths: structs::halves(ledger.severity_millionths),
            worst_severity: ledger.worst_severity,
            hardest_impact_m_s: ledger.hardest_impact_m_s,
            closed_at: ledger.closed_at,
            run_landings: ledger.run_landings,
            run_severity_millionths: structs::halves(ledger.run_severity_millionths),
        }
    }
}

/// The bytes of a ledger, where there are so many.
///
/// # Safety
/// `bytes` is null or points to `count` bytes.
unsafe fn written(bytes: *const u8, count: usize) -> Result<[u8; LEDGER_BYTES], Code> {
    Argument::Bytes.check(bytes)?;
    if count != LEDGER_BYTES {
        return Err(Code::ERROR_LEDGER_LENGTH);
    }
    // SAFETY: not null, and as many as this array has; bytes have no alignment.
    Ok(unsafe { bytes.cast::<[u8; LEDGER_BYTES]>().read() })
}

/// That of a bearing without landings.
///
/// # Safety
/// `ledger` is null, misaligned, or points to memory for its struct.
// SAFETY: all names of this library begin with amb_, and none twice.
#[unsafe(export_name = concat!("amb_ledger_new", ending!()))]
pub unsafe extern "C" fn amb_ledger_new(
    bearing: u32,
    severity_allowed: f32,
    ledger: *mut CLedger,
) -> Code {
    // SAFETY: the caller's promise.
    let place = unsafe { OutPtr::new(Argument::Ledger, ledger) };
    Code::from_result(place.map(|place| place.write(Ledger::new(bearing, severity_allowed).into())))
}

/// From what was written down.
///
/// # Safety
/// `bytes` is null or points to `count` bytes; `ledger` is null, misaligned, or points to memory for its struct.
// SAFETY: a name of its own, see `amb_ledger_new`.
#[unsafe(export_name = concat!("amb_ledger_read", ending!()))]
pub unsafe extern "C" fn amb_ledger_read(
    bytes: *const u8,
    count: usize,
    ledger: *mut CLedger,
) -> Code {
    // SAFETY: the caller's promise.
    let bytes = unsafe { written(bytes, count) };
    let done = bytes.and_then(|bytes| {
        // SAFETY: the caller's promise.
        let place = unsafe { OutPtr::new(Argument::Ledger, ledger) }?;
        place.write(Ledger::from_bytes(&bytes)?.into());
        Ok(())
    });
    Code::from_result(done)
}

/// The newer of two copies.
///
/// # Safety
/// `first` and `second` are null or point to `count` bytes each; `ledger` is null, misaligned, or points to memory for its struct.
// SAFETY: a name of its own, see `amb_ledger_new`.
#[unsafe(export_name = concat!("amb_ledger_newer", ending!()))]
pub unsafe extern "C" fn amb_ledger_newer(
    first: *const u8,
    second: *const u8,
    count: usize,
    ledger: *mut CLedger,
) -> Code {
    // SAFETY: the caller's promise.
    let copies = unsafe { written(first, count).and_then(|a| Ok([a, written(second, count)?])) };
    let done = copies.and_then(|[first, second]| {
        // SAFETY: the caller's promise.
        let place = unsafe { OutPtr::new(Argument::Ledger, ledger) }?;
        let (newer, other) = Ledger::newer([&first, &second])?;
        place.write(newer.into());
        other.map_or(Ok(()), |_| Err(Code::ONE_COPY))
    });
    Code::from_result(done)
}

/// Adds a frozen record to a ledger.
///
/// # Safety
/// `ledger` is null, misaligned, or points to its struct.
unsafe fn take_in(
    ledger: *mut CLedger,
    record: Option<Record<'_, f32, RECORD>>,
) -> Result<(), Code> {
    // SAFETY: the caller's promise.
    let mut kept = Ledger::from(unsafe { Argument::Ledger.read(ledger) }?);
    // SAFETY: the caller's promise.
    let place = unsafe { OutPtr::new(Argument::Ledger, ledger) }?;
    match record.is_some_and(|record| kept.take_in(&record)) {
        true => {
            place.write(kept.into());
            Ok(())
        }
        false => Err(Code::NOTHING),
    }
}

/// Adds the frozen record of a supervisor, and the landings before it that are in none.
///
/// # Safety
/// `ledger` is null, misaligned, or points to its struct; `supervisor` as for [`crate::calls::amb_tick`].
// SAFETY: a name of its own, see `amb_ledger_new`.
#[unsafe(export_name = concat!("amb_ledger_take_in", ending!()))]
pub unsafe extern "C" fn amb_ledger_take_in(
    ledger: *mut CLedger,
    supervisor: *mut Storage,
) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::reader(supervisor) };
    let done = lease.and_then(|mut lease| {
        // SAFETY: the caller's promise.
        unsafe { take_in(ledger, lease.content().record()) }
    });
    Code::from_result(done)
}

/// The same of a plane of a rotor.
///
/// # Safety
/// `ledger` is null, misaligned, or points to its struct; `rotor` as for [`crate::rotor::amb_rotor_tick`].
// SAFETY: a name of its own, see `amb_ledger_new`.
#[unsafe(export_name = concat!("amb_ledger_take_in_plane", ending!()))]
pub unsafe extern "C" fn amb_ledger_take_in_plane(
    ledger: *mut CLedger,
    rotor: *mut RotorStorage,
    plane: u32,
) -> Code {
    let done = rotor::plane(plane).and_then(|end| {
        // SAFETY: the caller's promise.
        let mut lease = unsafe { halves::reader(rotor) }?;
        // SAFETY: the caller's promise.
        unsafe { take_in(ledger, lease.content().record(end)) }
    });
    Code::from_result(done)
}

/// Writes a ledger down.
///
/// # Safety
/// `ledger` is null, misaligned, or points to its struct; `bytes` is null or points to memory for `count` bytes.
// SAFETY: a name of its own, see `amb_ledger_new`.
#[unsafe(export_name = concat!("amb_ledger_write", ending!()))]
pub unsafe extern "C" fn amb_ledger_write(
    ledger: *const CLedger,
    bytes: *mut u8,
    count: usize,
) -> Code {
    // SAFETY: the caller's promise.
    let ledger = unsafe { Argument::Ledger.read(ledger) };
    let done = ledger.and_then(|ledger| {
        // SAFETY: the caller's promise; the count is looked at before anything is written.
        let place = unsafe { OutPtr::new(Argument::Bytes, bytes.cast::<[u8; LEDGER_BYTES]>()) }?;
        if count != LEDGER_BYTES {
            return Err(Code::ERROR_LEDGER_LENGTH);
        }
        place.write(Ledger::from(ledger).to_bytes());
        Ok(())
    });
    Code::from_result(done)
}

/// How many landings of a severity the bearing may still bear.
///
/// # Safety
/// `ledger` is null, misaligned, or points to its struct; `landings` is null, misaligned, or points to memory for a number.
// SAFETY: a name of its own, see `amb_ledger_new`.
#[unsafe(export_name = concat!("amb_ledger_landings_left", ending!()))]
pub unsafe extern "C" fn amb_ledger_landings_left(
    ledger: *const CLedger,
    severity: f32,
    landings: *mut u32,
) -> Code {
    // SAFETY: the caller's promise.
    let ledger = unsafe { Argument::Ledger.read(ledger) };
    let done = ledger.and_then(|ledger| {
        // SAFETY: the caller's promise.
        let place = unsafe { OutPtr::new(Argument::Result, landings) }?;
        let left = Ledger::from(ledger).landings_left(severity);
        place.write(left.ok_or(Code::NOTHING)?);
        Ok(())
    });
    Code::from_result(done)
}
