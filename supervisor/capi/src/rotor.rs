//! The functions of the header on the supervisor of a rotor in two bearing planes.

use crate::calls::{configurations, ending, with_published, with_reader, write_section};
use crate::code::Code;
use crate::halves::{self, RotorStorage, RotorTicks};
use crate::pointer::{Argument, OutPtr};
use crate::structs::{CCommand, CEvent, CReport, CRotorCommand, CSample, CSection, CShaft, CStamp};
use supervisor::Sample;

const NO_FORCES: CRotorCommand = CRotorCommand {
    planes: [CCommand::NO_FORCE; 2],
    other_engaged: [0; 2],
    coast_down: 0,
};

/// Makes a supervisor of a rotor in storage of the caller's. After an error the storage is as it was.
///
/// # Safety
/// `rotor` is null, misaligned, or points to `bytes` bytes that have been written to, and that only this library
/// touches from now on; `shaft` is null, misaligned, or points to its struct; `values` is null, misaligned, or points to
/// `count` floats.
// SAFETY: all names of this library begin with amb_, and none twice.
#[unsafe(export_name = concat!("amb_rotor_init", ending!()))]
pub unsafe extern "C" fn amb_rotor_init(
    rotor: *mut RotorStorage,
    bytes: usize,
    shaft: *const CShaft,
    values: *const f32,
    count: usize,
) -> Code {
    if let Err(code) = Argument::Rotor.check(rotor.cast_const()) {
        return code;
    }
    // SAFETY: the caller's promise.
    let shaft = match unsafe { Argument::Shaft.read(shaft) } {
        Ok(shaft) => shaft.into(),
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    let configs = match unsafe { configurations(values, count) } {
        Ok(configs) => configs,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    Code::from_result(unsafe { halves::make_rotor(rotor, bytes, (&shaft, &configs)) })
}

/// As [`crate::calls::amb_self_test`], by the ticks of both planes.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`].
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_self_test", ending!()))]
pub unsafe extern "C" fn amb_rotor_self_test(rotor: *mut RotorStorage) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::ticker(rotor) };
    Code::of_test(lease.map(|mut lease| lease.content().ticker.self_test()))
}

/// Another shaft and other configurations, from the next tick on. After an error nothing has changed.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`]; the others as for [`amb_rotor_init`].
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_reconfigure", ending!()))]
pub unsafe extern "C" fn amb_rotor_reconfigure(
    rotor: *mut RotorStorage,
    shaft: *const CShaft,
    values: *const f32,
    count: usize,
) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::ticker(rotor) };
    let done = lease.and_then(|mut lease| {
        // SAFETY: the caller's promise.
        let shaft = unsafe { Argument::Shaft.read(shaft) }?;
        // SAFETY: the caller's promise.
        let configs = unsafe { configurations(values, count) }?;
        let done = (lease.content().ticker).reconfigure(&shaft.into(), &configs);
        done.map_err(|error| halves::code_of_shaft(&error))
    });
    Code::from_result(done)
}

/// One tick of both planes. An error gives commands of no force, so that no old ones stay in use.
///
/// # Safety
/// `rotor` is null, misaligned, or points to storage given to [`amb_rotor_init`] or full of zeros; `samples` is null,
/// misaligned, or points to two of them; `command` is null, misaligned, or points to its struct.
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_tick", ending!()))]
pub unsafe extern "C" fn amb_rotor_tick(
    rotor: *mut RotorStorage,
    samples: *const CSample,
    command: *mut CRotorCommand,
) -> Code {
    // SAFETY: the caller's promise.
    let place = match unsafe { OutPtr::new(Argument::Command, command) } {
        Ok(place) => place,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise; an array is aligned as its elements. Read before the command is written: both may be
    // the same memory.
    let samples = unsafe { Argument::Sample.read(samples.cast::<[CSample; 2]>()) };
    let done = samples.and_then(|samples| {
        // SAFETY: the caller's promise.
        let mut lease = unsafe { halves::ticker(rotor) }?;
        place.write(
            (lease.content().ticker)
                .tick(&samples.map(Into::into))
                .into(),
        );
        Ok(())
    });
    if done.is_err() {
        place.write(NO_FORCES);
    }
    Code::from_result(done)
}

/// The first plane's half of a tick. An error gives a command of no force.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`]; `sample` and `command` are null, misaligned, or point to their structs.
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_tick_first", ending!()))]
pub unsafe extern "C" fn amb_rotor_tick_first(
    rotor: *mut RotorStorage,
    sample: *const CSample,
    command: *mut CCommand,
) -> Code {
    // SAFETY: the caller's promise.
    unsafe {
        half(
            rotor,
            sample,
            command,
            CCommand::NO_FORCE,
            |ticks, sample| {
                let first = ticks.ticker.tick_first(&sample);
                ticks.first = Some(first);
                Ok(first.command.into())
            },
        )
    }
}

/// The second plane's half. An error gives commands of no force.
///
/// # Safety
/// As for [`amb_rotor_tick_first`].
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_tick_second", ending!()))]
pub unsafe extern "C" fn amb_rotor_tick_second(
    rotor: *mut RotorStorage,
    sample: *const CSample,
    command: *mut CRotorCommand,
) -> Code {
    // SAFETY: the caller's promise.
    unsafe {
        half(rotor, sample, command, NO_FORCES, |ticks, sample| {
            let first = ticks.first.take().ok_or(Code::ERROR_ROTOR_HALF)?;
            Ok(ticks.ticker.tick_second(&first, &sample).into())
        })
    }
}

/// Half a tick: what comes of a sample, or no force.
///
/// # Safety
/// As for [`amb_rotor_tick_first`].
unsafe fn half<C: Copy>(
    rotor: *mut RotorStorage,
    sample: *const CSample,
    command: *mut C,
    no_force: C,
    tick: impl FnOnce(&mut RotorTicks, Sample) -> Result<C, Code>,
) -> Code {
    // SAFETY: the caller's promise.
    let place = match unsafe { OutPtr::new(Argument::Command, command) } {
        Ok(place) => place,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise. Read before the command is written, see `amb_rotor_tick`.
    let sample = unsafe { Argument::Sample.read(sample) };
    let done = sample.and_then(|sample| {
        // SAFETY: the caller's promise.
        let mut lease = unsafe { halves::ticker(rotor) }?;
        tick(lease.content(), sample.into())
    });
    let (answer, code) = match done {
        Ok(answer) => (answer, Code::OK),
        Err(code) => (no_force, code),
    };
    place.write(answer);
    code
}

/// What to add to the forces of the next tick.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`]; `stimulus_n` is null, misaligned, or points to four floats.
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_stimulus", ending!()))]
pub unsafe extern "C" fn amb_rotor_stimulus(
    rotor: *mut RotorStorage,
    stimulus_n: *mut f32,
) -> Code {
    // SAFETY: the caller's promise; an array is aligned as its elements.
    let place = unsafe { OutPtr::new(Argument::Result, stimulus_n.cast::<[[f32; 2]; 2]>()) };
    let done = place.and_then(|place| {
        // SAFETY: the caller's promise.
        let mut lease = unsafe { halves::ticker(rotor) }?;
        place.write(lease.content().ticker.stimulus_n());
        Ok(())
    });
    Code::from_result(done)
}

/// A plane that there is.
pub(crate) fn plane(number: u32) -> Result<usize, Code> {
    match number {
        0 => Ok(0),
        1 => Ok(1),
        _ => Err(Code::ERROR_PLANE),
    }
}

/// What has happened to a plane since the supervisor was made.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`]; `report` is null, misaligned, or points to memory for its struct.
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_report_now", ending!()))]
pub unsafe extern "C" fn amb_rotor_report_now(
    rotor: *const RotorStorage,
    plane: u32,
    report: *mut CReport,
) -> Code {
    // SAFETY: the caller's promise.
    unsafe {
        with_published(rotor, report, |[first, second]| {
            let published = if self::plane(plane)? == 0 {
                first
            } else {
                second
            };
            let report = published.report().map(Into::into);
            report.ok_or(Code::ERROR_ROTOR_BUSY)
        })
    }
}

/// Takes the oldest event of a plane out of its queue.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`]; `event` is null, misaligned, or points to memory for its struct.
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_next_event", ending!()))]
pub unsafe extern "C" fn amb_rotor_next_event(
    rotor: *mut RotorStorage,
    plane: u32,
    event: *mut CEvent,
) -> Code {
    // SAFETY: the caller's promise.
    unsafe {
        with_reader(rotor, event, |reader| {
            let event = reader.next_event(self::plane(plane)?);
            event.map(Into::into).ok_or(Code::NOTHING)
        })
    }
}

/// A section of the frozen record of a plane, 0 the first.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`]; `stamp` and `section` are null, misaligned, or point to their structs.
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_record_section", ending!()))]
pub unsafe extern "C" fn amb_rotor_record_section(
    rotor: *mut RotorStorage,
    plane: u32,
    index: u32,
    stamp: *const CStamp,
    section: *mut CSection,
) -> Code {
    let end = match self::plane(plane) {
        Ok(end) => end,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    let done = unsafe {
        write_section(rotor, stamp, section, |reader, stamp| {
            reader.record(end)?.section(index, stamp)
        })
    };
    Code::from_result(done)
}

/// Discards frozen records; both planes wait for the next engagement.
///
/// # Safety
/// `rotor` as for [`amb_rotor_tick`].
// SAFETY: a name of its own, see `amb_rotor_init`.
#[unsafe(export_name = concat!("amb_rotor_rearm", ending!()))]
pub unsafe extern "C" fn amb_rotor_rearm(rotor: *mut RotorStorage) -> Code {
    // SAFETY: the caller's promise.
    let lease = unsafe { halves::reader(rotor) };
    Code::from_result(lease.map(|mut lease| lease.content().rearm()))
}
