//! The border to C, whatever the version: pointers of the importer become references here, faults a status and a line of its
//! log.

use crate::instance::{Fault, Instance, Level};
use crate::resources;
use crate::unit::Unit;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// What an instance is to its importer: a pointer that it passes back.
pub type Handle = *mut c_void;

/// Writes a line of the importer's log.
pub(crate) type Log = Box<dyn Fn(Level, &CStr)>;

/// Category of every line.
pub(crate) const CATEGORY: &CStr = c"logStatusError";

/// An instance and its importer.
pub(crate) struct Served {
    pub(crate) instance: Instance,
    log: Log,
}

/// A status as both versions number it.
pub(crate) fn status(level: Level) -> c_int {
    match level {
        Level::Ok => 0,
        Level::Warning => 1,
        Level::Discard => 2,
        Level::Error => 3,
        Level::Fatal => 4,
    }
}

fn say(log: &Log, level: Level, text: &str) {
    // C ends its texts with a zero.
    if let Ok(text) = CString::new(text.replace('\0', " ")) {
        log(level, &text);
    }
}

/// What a panic says.
fn panicked(what: &(dyn std::any::Any + Send)) -> Fault {
    let text = what.downcast_ref::<&str>().copied();
    let text = text.or_else(|| what.downcast_ref::<String>().map(String::as_str));
    Fault {
        level: Level::Fatal,
        text: format!("a fault of this program: {}", text.unwrap_or("unknown")),
    }
}

/// An instance of the unit that a token names, with the scene in a folder; null where there is none, with the reason in the
/// log.
pub(crate) fn instantiate(token: &str, folder: &Path, early: bool, log: Log) -> Handle {
    let made = catch_unwind(AssertUnwindSafe(|| instance(token, folder, early)));
    match made.unwrap_or_else(|panic| Err(panicked(&*panic).text)) {
        Ok(instance) => Box::into_raw(Box::new(Served { instance, log })).cast(),
        Err(text) => {
            say(&log, Level::Error, &text);
            std::ptr::null_mut()
        }
    }
}

fn instance(token: &str, folder: &Path, early: bool) -> Result<Instance, String> {
    let which = resources::model_of(token).ok_or("the token is of no unit of this library")?;
    let (spec, own) = resources::read(folder, which)?;
    if own != token {
        return Err(format!(
            "the token {token} is of another scene or version than this unit's, which has {own}"
        ));
    }
    let unit = Unit::new(which, spec.without_warnings()).map_err(|error| error.to_string())?;
    let unit = unit.ok_or("the scene has no supervisor")?;
    Ok(Instance::new(unit, early))
}

/// Ends an instance.
///
/// # Safety
/// The handle comes from [`instantiate`], is not used any more, and nothing else uses it meanwhile; null is allowed.
pub(crate) unsafe fn free(handle: Handle) {
    if handle.is_null() {
        return;
    }
    // SAFETY: by this function's own condition it is the box that `instantiate` has let go, once.
    let served = unsafe { Box::from_raw(handle.cast::<Served>()) };
    let _nobody_is_there_to_be_told = catch_unwind(AssertUnwindSafe(|| drop(served)));
}

/// Calls an instance; a fault is a status and a line of the log.
///
/// # Safety
/// The handle comes from [`instantiate`] and has not been freed, and nothing else uses it meanwhile; null is an error.
pub(crate) unsafe fn call(
    handle: Handle,
    what: impl FnOnce(&mut Instance) -> Result<(), Fault>,
) -> c_int {
    // SAFETY: by this function's own condition it is null, or the box that `instantiate` has let go and that nobody else uses.
    let Some(served) = (unsafe { handle.cast::<Served>().as_mut() }) else {
        return status(Level::Error);
    };
    let called = catch_unwind(AssertUnwindSafe(|| what(&mut served.instance)));
    let called = called.unwrap_or_else(|panic| {
        let fault = panicked(&*panic);
        let _reported_below = served.instance.fail(fault.text.clone());
        Err(fault)
    });
    match called {
        Ok(()) => status(Level::Ok),
        Err(fault) => {
            say(&served.log, fault.level, &fault.text);
            status(fault.level)
        }
    }
}

/// A text of the importer's; `None` of null.
///
/// # Safety
/// The pointer is null, or points to a text that ends with a zero.
pub(crate) unsafe fn text(pointer: *const c_char) -> Option<String> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not null, and by this function's own condition a text with an end.
    let text = unsafe { CStr::from_ptr(pointer) };
    Some(text.to_string_lossy().into_owned())
}

fn no_array() -> Fault {
    Fault::error("an array that is null")
}

/// An array of the importer's to read.
///
/// # Safety
/// The pointer is null, or points to so many values, which nobody changes for as long as they are used.
pub(crate) unsafe fn array<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], Fault> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(no_array()),
        // SAFETY: not null, and by this function's own condition so long.
        (count, false) => Ok(unsafe { std::slice::from_raw_parts(pointer, count) }),
    }
}

/// Writes a value to where the importer wants it; null is passed over.
///
/// # Safety
/// The pointer is null, or points to a place for a value.
pub(crate) unsafe fn write<T>(pointer: *mut T, value: T) {
    if !pointer.is_null() {
        // SAFETY: not null, and by this function's own condition a place for it.
        unsafe { pointer.write(value) };
    }
}

/// Has values of variables read, each written to its place.
///
/// # Safety
/// The arrays are null, or have `count` values.
pub(crate) unsafe fn get_all<T>(
    instance: &mut Instance,
    references: *const u32,
    count: usize,
    values: *mut T,
    read: impl Fn(&mut Instance, u32) -> Result<T, Fault>,
) -> Result<(), Fault> {
    // SAFETY: by this function's own condition.
    let references = unsafe { array(references, count) }?;
    if count > 0 && values.is_null() {
        return Err(no_array());
    }
    for (i, reference) in references.iter().enumerate() {
        let value = read(instance, *reference)?;
        // SAFETY: not null as there is a value, and by this function's own condition long enough.
        unsafe { values.add(i).write(value) };
    }
    Ok(())
}

/// Has variables set.
///
/// # Safety
/// As of [`get_all`].
pub(crate) unsafe fn set_all<T: Copy>(
    instance: &mut Instance,
    references: *const u32,
    count: usize,
    values: *const T,
    write: impl Fn(&mut Instance, u32, T) -> Result<(), Fault>,
) -> Result<(), Fault> {
    // SAFETY: by this function's own condition.
    let (references, values) = unsafe { (array(references, count)?, array(values, count)?) };
    for (reference, value) in references.iter().zip(values) {
        write(instance, *reference, *value)?;
    }
    Ok(())
}
