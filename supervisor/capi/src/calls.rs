//! The functions of the header, in its order; those on a rotor are in `rotor`, those on an output watch in `watch`. Their names in the library end with the version of the
//! interface, so that a program compiled against another one does not link.

use crate::code::Code;
use crate::halves::{self, Halves, Split, Storage};
use crate::pointer::{Argument, OutPtr};
use crate::structs::{CCommand, CEvent, CParameter, CReport, CSample, CSection, CStamp};
use crate::{parameters, version};
use core::ffi::{CStr, c_char};
use supervisor::{Config, PARAMETERS, Section, Stamp};

/// Ending of the names; [`version::ABI`] as text.
macro_rules! ending {
    () => {
        "_abi6"
    };
}

pub(crate) use ending;

const _: () = {
    assert!(ending!().len() == 5 && version::ABI < 10);
    assert!(ending!().as_bytes()[4] == b'0' + version::ABI as u8);
};

/// Version of the interface. The only name without it, for programs that load the library.
// SAFETY: all names of this library begin with amb_, and none twice.
#[unsafe(no_mangle)]
pub extern "C" fn amb_abi_version() -> u32 {
    version::ABI
}

/// What a code means, for people; never null.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_error_text", ending!()))]
pub extern "C" fn amb_error_text(code: Code) -> *const c_char {
    code.text().as_ptr()
}

/// Row of the table of parameters.
///
/// # Safety
/// `parameter` is null, misaligned, or points to memory for an [`CParameter`].
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_parameter_at", ending!()))]
pub unsafe extern "C" fn amb_parameter_at(index: u32, parameter: *mut CParameter) -> Code {
    // SAFETY: the caller's promise.
    let place = match unsafe { OutPtr::new(Argument::Result, parameter) } {
        Ok(place) => place,
        Err(code) => return code,
    };
    let index = index as usize;
    let (Some(row), Some(texts)) = (PARAMETERS.get(index), parameters::texts(index)) else {
        return Code::ERROR_INDEX;
    };
    place.write(CParameter {
        name: texts.name.as_ptr(),
        unit: texts.unit.as_ptr(),
        text: texts.text.as_ptr(),
        low: row.low,
        high: row.high,
    });
    Code::OK
}

/// Index of the parameter of this name.
///
/// # Safety
/// `name` is null or points to a text that ends with a zero byte, `index` is null, misaligned, or points
/// to memory for a number.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_parameter_index", ending!()))]
pub unsafe extern "C" fn amb_parameter_index(name: *const c_char, index: *mut u32) -> Code {
    if name.is_null() {
        return Code::ERROR_NAME_NULL;
    }
    // SAFETY: the caller's promise.
    let place = match unsafe { OutPtr::new(Argument::Result, index) } {
        Ok(place) => place,
        Err(code) => return code,
    };
    for (index, parameter) in (0..).zip(PARAMETERS) {
        // SAFETY: not null, and ended by a zero byte.
        if unsafe { is(name, parameter.name) } {
            place.write(index);
            return Code::OK;
        }
    }
    Code::ERROR_NAME_UNKNOWN
}

/// Whether a text of C's is this one. Reads no further than its end.
///
/// # Safety
/// `c` points to a text that ends with a zero byte.
unsafe fn is(c: *const c_char, text: &str) -> bool {
    let mut at = c.cast::<u8>();
    for byte in text.bytes() {
        // SAFETY: all bytes before this one were equal to those of `text`, which has no zero byte: the
        // end has not been passed.
        if unsafe { at.read() } != byte {
            return false;
        }
        at = at.wrapping_add(1);
    }
    // SAFETY: as above.
    unsafe { at.read() == 0 }
}

/// Makes a supervisor in storage of the caller's. After an error the storage is as it was.
///
/// # Safety
/// `supervisor` is null, misaligned, or points to `bytes` bytes that have been written to, and that only
/// this library touches from now on; `values` is null, misaligned, or points to `count` floats.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_init", ending!()))]
pub unsafe extern "C" fn amb_init(
    supervisor: *mut Storage,
    bytes: usize,
    values: *const f32,
    count: usize,
) -> Code {
    if let Err(code) = Argument::Supervisor.check(supervisor.cast_const()) {
        return code;
    }
    // SAFETY: the caller's promise.
    let [config] = match unsafe { configurations(values, count) } {
        Ok(configs) => configs,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    Code::from_result(unsafe { halves::make_supervisor(supervisor, bytes, &config) })
}

/// The configurations of so many planes that these values make, not yet compared with their ranges.
///
/// # Safety
/// `values` is null, misaligned, or points to `count` floats.
pub(crate) unsafe fn configurations<const PLANES: usize>(
    values: *const f32,
    count: usize,
) -> Result<[Config; PLANES], Code> {
    Argument::Values.check(values)?;
    if count != PLANES * PARAMETERS.len() {
        return Err(Code::ERROR_VALUES_COUNT);
    }
    // SAFETY: neither null nor misaligned, and as many as an array of this type has.
    let values = unsafe { values.cast::<[[f32; PARAMETERS.len()]; PLANES]>().read() };
    Ok(values.map(Config::from_values))
}

/// Whether this processor computes what it should, by the ticks of a supervisor that is as new afterwards.
///
/// # Safety
/// `supervisor` as for [`amb_tick`].
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_self_test", ending!()))]
pub unsafe extern "C" fn amb_self_test(supervisor: *mut Storage) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::ticker(supervisor) };
    Code::of_test(lease.map(|mut lease| lease.content().self_test()))
}

/// Another configuration for a supervisor that is there, from its next tick on. After an error nothing has
/// changed.
///
/// # Safety
/// `supervisor` as for [`amb_tick`]; `values` is null, misaligned, or points to `count` floats.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_reconfigure", ending!()))]
pub unsafe extern "C" fn amb_reconfigure(
    supervisor: *mut Storage,
    values: *const f32,
    count: usize,
) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::ticker(supervisor) };
    let done = lease.and_then(|mut lease| {
        // SAFETY: the caller's promise.
        let [config] = unsafe { configurations(values, count) }?;
        let done = lease.content().reconfigure(&config);
        done.map_err(|error| halves::code_of(&error))
    });
    Code::from_result(done)
}

/// One tick. An error gives a command of no force, so that no old one stays in use.
///
/// # Safety
/// `supervisor` is null, misaligned, or points to storage given to [`amb_init`] or full of zeros; `sample`
/// and `command` are null, misaligned, or point to their structs.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_tick", ending!()))]
pub unsafe extern "C" fn amb_tick(
    supervisor: *mut Storage,
    sample: *const CSample,
    command: *mut CCommand,
) -> Code {
    // SAFETY: the caller's promise.
    let place = match unsafe { OutPtr::new(Argument::Command, command) } {
        Ok(place) => place,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise. Read before the command is written: both may be the same memory.
    let sample = unsafe { Argument::Sample.read(sample) };
    let done = sample.and_then(|sample| {
        // SAFETY: the caller's promise.
        let mut lease = unsafe { halves::ticker(supervisor) }?;
        place.write(lease.content().tick(&sample.into()).into());
        Ok(())
    });
    if done.is_err() {
        place.write(CCommand::NO_FORCE);
    }
    Code::from_result(done)
}

/// What to add to the force of the next tick.
///
/// # Safety
/// `supervisor` as for [`amb_tick`]; `stimulus_n` is null, misaligned, or points to two floats.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_stimulus", ending!()))]
pub unsafe extern "C" fn amb_stimulus(supervisor: *mut Storage, stimulus_n: *mut f32) -> Code {
    // SAFETY: the caller's promise; an array is aligned as its elements.
    let place = unsafe { OutPtr::new(Argument::Result, stimulus_n.cast::<[f32; 2]>()) };
    let done = place.and_then(|place| {
        // SAFETY: the caller's promise.
        let mut lease = unsafe { halves::ticker(supervisor) }?;
        place.write(lease.content().stimulus_n());
        Ok(())
    });
    Code::from_result(done)
}

/// Gives `result` what is taken from the reading half of a supervisor, or that of a rotor.
///
/// # Safety
/// `asked` is null, misaligned, or points to storage in which one was made or that is full of zeros; `result` is null,
/// misaligned, or points to memory for a `T`.
pub(crate) unsafe fn with_reader<S: Split, T: Copy>(
    asked: *mut Halves<S>,
    result: *mut T,
    question: impl FnOnce(&mut S::Reader) -> Result<T, Code>,
) -> Code {
    // SAFETY: the caller's promise.
    let place = unsafe { OutPtr::new(Argument::Result, result) };
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::reader(asked) };
    let answer = lease.and_then(|mut lease| {
        // Asked only where the answer has a place: an event without one would be lost.
        let place = place?;
        place.write(question(lease.content())?);
        Ok(())
    });
    Code::from_result(answer)
}

/// Gives `result` what the last tick has published; at any time, to any number of callers.
///
/// # Safety
/// As for [`with_reader`].
pub(crate) unsafe fn with_published<S: Split, T: Copy>(
    asked: *const Halves<S>,
    result: *mut T,
    question: impl FnOnce(S::Published) -> Result<T, Code>,
) -> Code {
    // SAFETY: the caller's promise.
    let place = unsafe { OutPtr::new(Argument::Result, result) };
    // SAFETY: the caller's promise.
    let published = unsafe { halves::published(asked) };
    let answer = published.and_then(|published| {
        place?.write(question(published)?);
        Ok(())
    });
    Code::from_result(answer)
}

/// What the supervisor is doing.
///
/// # Safety
/// `supervisor` as for [`amb_tick`]; `mode` is null, misaligned, or points to memory for a number.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_mode", ending!()))]
pub unsafe extern "C" fn amb_mode(supervisor: *const Storage, mode: *mut u32) -> Code {
    // SAFETY: the caller's promise.
    unsafe { with_published(supervisor, mode, |s| Ok(s.mode() as u32)) }
}

/// Name of a mode, for people; never null.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_mode_name", ending!()))]
pub extern "C" fn amb_mode_name(mode: u32) -> *const c_char {
    mode_name(mode).as_ptr()
}

/// The same for Rust. Test `capi` compares these with the supervisor's own, which do not end as C wants it.
pub fn mode_name(mode: u32) -> &'static CStr {
    match mode {
        0 => c"levitated",
        1 => c"approach",
        2 => c"bounce",
        3 => c"backward whirl",
        4 => c"pinned",
        5 => c"handover",
        6 => c"sensor fault",
        7 => c"handed back",
        _ => c"unknown mode",
    }
}

/// What has happened since the supervisor was made.
///
/// # Safety
/// `supervisor` as for [`amb_tick`]; `report` is null, misaligned, or points to memory for its struct.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_report_now", ending!()))]
pub unsafe extern "C" fn amb_report_now(supervisor: *const Storage, report: *mut CReport) -> Code {
    // SAFETY: the caller's promise.
    unsafe {
        with_published(supervisor, report, |s| {
            s.report().map(Into::into).ok_or(Code::ERROR_BUSY)
        })
    }
}

/// Takes the oldest event out of the queue.
///
/// # Safety
/// `supervisor` as for [`amb_tick`]; `event` is null, misaligned, or points to memory for its struct.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_next_event", ending!()))]
pub unsafe extern "C" fn amb_next_event(supervisor: *mut Storage, event: *mut CEvent) -> Code {
    // SAFETY: the caller's promise.
    unsafe {
        with_reader(supervisor, event, |s| {
            s.next_event().map(Into::into).ok_or(Code::NOTHING)
        })
    }
}

/// A section of the frozen record, 0 the first.
///
/// # Safety
/// `supervisor` as for [`amb_tick`]; `stamp` and `section` are null, misaligned, or point to their structs.
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_record_section", ending!()))]
pub unsafe extern "C" fn amb_record_section(
    supervisor: *mut Storage,
    index: u32,
    stamp: *const CStamp,
    section: *mut CSection,
) -> Code {
    // SAFETY: the caller's promise.
    let done = unsafe {
        write_section(supervisor, stamp, section, |reader, stamp| {
            reader.record()?.section(index, stamp)
        })
    };
    Code::from_result(done)
}

/// Writes a section of a record down.
///
/// # Safety
/// `asked` as for [`with_reader`]; `stamp` and `section` are null, misaligned, or point to their structs.
pub(crate) unsafe fn write_section<S: Split>(
    asked: *mut Halves<S>,
    stamp: *const CStamp,
    section: *mut CSection,
    section_of: impl FnOnce(&S::Reader, &Stamp) -> Option<Section>,
) -> Result<(), Code> {
    // SAFETY: the caller's promise.
    let stamp = unsafe { Argument::Stamp.read(stamp) }?.into();
    // SAFETY: the caller's promise.
    let place = unsafe { OutPtr::new(Argument::Result, section) }?;
    // SAFETY: the caller's promise.
    let made = section_of(unsafe { halves::reader(asked) }?.content(), &stamp);
    let mut made = made.ok_or(Code::NOTHING)?;
    place.write(CSection::new(made.seal()));
    Ok(())
}

/// Discards a frozen record and waits for the next engagement.
///
/// # Safety
/// `supervisor` as for [`amb_tick`].
// SAFETY: a name of its own, see `amb_abi_version`.
#[unsafe(export_name = concat!("amb_rearm", ending!()))]
pub unsafe extern "C" fn amb_rearm(supervisor: *mut Storage) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::reader(supervisor) };
    Code::from_result(lease.map(|mut lease| lease.content().rearm()))
}
