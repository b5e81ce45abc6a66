//! Supervisors in memory of the caller's, each in two halves, one for the calls that change what the tick works with and one for
//! those that read: calls of one side never find the other's in their way.

use crate::code::Code;
use crate::layout::defined;
use crate::pointer::Argument;
use crate::storage::{Content, Lease, Making, Slot};
use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicUsize, Ordering};
use supervisor::{
    Config, ConfigError, HalfTick, Published, Reader, RotorCore, RotorReader, RotorTicker, Shaft,
    ShaftError, Supervisor, Ticker,
};

/// Entries of the flight record.
pub const RECORD: usize = 512;

/// Memory of the caller's for a supervisor `T` and its halves, which point to it: it stays where it was made.
#[repr(C)]
pub struct Halves<T: Split> {
    ticker: Slot<T::Ticker>,
    reader: Slot<T::Reader>,
    /// Address of it all when it was made.
    home: AtomicUsize,
    published: UnsafeCell<MaybeUninit<T::Published>>,
    whole: UnsafeCell<MaybeUninit<T>>,
}

/// What is in an `amb_supervisor`.
pub type Storage = Halves<Supervisor<RECORD>>;
/// What is in an `amb_rotor`.
pub type RotorStorage = Halves<RotorParts>;

/// A rotor in pieces, each made in its place.
#[derive(Debug)]
#[repr(C)]
pub struct RotorParts {
    machine: RotorCore,
    planes: [Supervisor<RECORD>; 2],
}

/// A supervisor that comes in halves.
pub trait Split: Sized + 'static {
    /// For the calls of the tick's priority.
    type Ticker: Content;
    /// For those of one lower priority.
    type Reader: Content;
    /// For all others.
    type Published: Copy;
    /// What the header promises to be enough, in bytes …
    const BYTES: usize;
    /// … and it was less.
    const TOO_SMALL: Code;
    /// Its halves, and what everybody may see.
    fn halves(&'static mut self) -> (Self::Ticker, Self::Reader, Self::Published);
    /// Name of the argument that points to it.
    const ARGUMENT: Argument;
}

type Seen = Published<'static, f32, RECORD>;

impl Split for Supervisor<RECORD> {
    type Ticker = Ticker<'static, RECORD>;
    type Reader = Reader<'static, f32, RECORD>;
    type Published = Seen;
    const BYTES: usize = defined("AMB_SUPERVISOR_BYTES");
    const TOO_SMALL: Code = Code::ERROR_SUPERVISOR_TOO_SMALL;
    const ARGUMENT: Argument = Argument::Supervisor;

    fn halves(&'static mut self) -> (Self::Ticker, Self::Reader, Seen) {
        let (ticker, reader) = self.split();
        let published = reader.published();
        (ticker, reader, published)
    }
}

/// The half of a rotor that ticks, and what a first half of a tick has left for the second.
#[derive(Debug)]
pub struct RotorTicks {
    pub(crate) ticker: RotorTicker<'static, RECORD>,
    pub(crate) first: Option<HalfTick>,
}

impl Split for RotorParts {
    type Ticker = RotorTicks;
    type Reader = RotorReader<'static, RECORD>;
    type Published = [Seen; 2];
    const BYTES: usize = defined("AMB_ROTOR_BYTES");
    const TOO_SMALL: Code = Code::ERROR_ROTOR_TOO_SMALL;
    const ARGUMENT: Argument = Argument::Rotor;

    fn halves(&'static mut self) -> (Self::Ticker, Self::Reader, [Seen; 2]) {
        let [first, second] = &mut self.planes;
        let (ticker, reader) = self.machine.join([first, second]);
        let published = [0, 1].map(|end| reader.published(end));
        let ticks = RotorTicks {
            ticker,
            first: None,
        };
        (ticks, reader, published)
    }
}

impl Content for Ticker<'static, RECORD> {
    const READY: u32 = 0xA3B1_5AFE;
    const BUSY: u32 = 0xA3B1_B5E1;
    const NOT_MADE: Code = Code::ERROR_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_BUSY;
}

impl Content for Reader<'static, f32, RECORD> {
    const READY: u32 = 0xA3B1_4EAD;
    const BUSY: u32 = 0xA3B1_B54E;
    const NOT_MADE: Code = Code::ERROR_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_BUSY;
}

impl Content for RotorTicks {
    const READY: u32 = 0xA3B1_2070;
    const BUSY: u32 = 0xA3B1_20B5;
    const NOT_MADE: Code = Code::ERROR_ROTOR_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_ROTOR_BUSY;
}

impl Content for RotorReader<'static, RECORD> {
    const READY: u32 = 0xA3B1_204E;
    const BUSY: u32 = 0xA3B1_2B54;
    const NOT_MADE: Code = Code::ERROR_ROTOR_NOT_INITIALISED;
    const IN_USE: Code = Code::ERROR_ROTOR_BUSY;
}

/// Alignment that the header promises, which may be stricter than a target needs, so that it holds on all of them.
const ALIGN: usize = defined("AMB_SUPERVISOR_ALIGN");

/// The header promises enough, and no more than so many bytes too many.
const fn fits<T: Split>(spare: usize) -> bool {
    let size = size_of::<Halves<T>>();
    size <= T::BYTES
        && T::BYTES <= size + spare
        && align_of::<Halves<T>>() <= ALIGN
        && T::BYTES.is_multiple_of(ALIGN)
        && ALIGN.is_power_of_two()
}

const _: () = {
    // Room for the pointers and the alignment of any target, and to grow a little.
    assert!(fits::<Supervisor<RECORD>>(2048) && fits::<RotorParts>(4096));
    assert!(defined("AMB_RECORD_ENTRIES") == RECORD);
};

impl<T: Split> Halves<T> {
    /// # Safety
    /// Where `halves` is neither null nor misaligned it points to as many bytes as [`Split`] says, which
    /// have been written to (static memory has), and are used through this crate alone as long as any call is in progress.
    unsafe fn at<'a>(halves: *const Self) -> Result<&'a Self, Code> {
        T::ARGUMENT.check(halves)?;
        if halves.addr() & (ALIGN - 1) != 0 {
            return Err(T::ARGUMENT.misaligned());
        }
        // SAFETY: not null, aligned and large enough; any bytes are valid, because its words are integers
        // and the rest may be uninitialised.
        Ok(unsafe { &*halves })
    }

    /// The same where a supervisor was made in this very place.
    ///
    /// # Safety
    /// As for [`Self::at`].
    unsafe fn made<'a>(halves: *const Self) -> Result<&'a Self, Code> {
        // SAFETY: the caller's promise.
        let this = unsafe { Self::at(halves) }?;
        let at_home = this.home.load(Ordering::Relaxed) == halves.addr();
        // What was never made has zero there, or what was there before it is made for the first time.
        if at_home || !this.ticker.is_made() {
            Ok(this)
        } else {
            Err(T::Ticker::NOT_MADE)
        }
    }
}

/// The half that ticks, for one call.
///
/// # Safety
/// As for [`Halves::at`].
pub(crate) unsafe fn ticker<'a, T: Split>(
    halves: *mut Halves<T>,
) -> Result<Lease<'a, T::Ticker>, Code> {
    // SAFETY: the caller's promise.
    Lease::new(&unsafe { Halves::made(halves) }?.ticker)
}

/// The half that reads, for one call.
///
/// # Safety
/// As for [`Halves::at`].
pub(crate) unsafe fn reader<'a, T: Split>(
    halves: *mut Halves<T>,
) -> Result<Lease<'a, T::Reader>, Code> {
    // SAFETY: the caller's promise.
    Lease::new(&unsafe { Halves::made(halves) }?.reader)
}

/// What everybody may see.
///
/// # Safety
/// As for [`Halves::at`].
pub(crate) unsafe fn published<T: Split>(halves: *const Halves<T>) -> Result<T::Published, Code> {
    // SAFETY: the caller's promise.
    let this = unsafe { Halves::made(halves) }?;
    if !this.ticker.is_made() {
        return Err(T::Ticker::NOT_MADE);
    }
    // SAFETY: written before the ticker was first there, and never while it is.
    Ok(unsafe { (*this.published.get()).assume_init() })
}

/// Makes a supervisor by what initialises it in its place; after an error the storage is as it was.
///
/// # Safety
/// As for [`Halves::at`], with `bytes` bytes; and they stay where they are, in use by this crate alone, as long as there is a
/// supervisor in them.
unsafe fn make<T: Split>(
    halves: *mut Halves<T>,
    bytes: usize,
    init: impl FnOnce(&mut MaybeUninit<T>) -> Result<(), Code>,
) -> Result<(), Code> {
    T::ARGUMENT.check(halves.cast_const())?;
    if halves.addr() & (ALIGN - 1) != 0 {
        return Err(T::ARGUMENT.misaligned());
    }
    if bytes < T::BYTES {
        return Err(T::TOO_SMALL);
    }
    // SAFETY: large enough now, the rest is the caller's promise.
    let this = unsafe { Halves::at(halves) }?;
    let (ticker, reader) = (Making::new(&this.ticker)?, Making::new(&this.reader)?);
    // SAFETY: neither half is in use nor can be, and what they were is forgotten below: this is the only access. It lives as long
    // as its halves by the caller's promise.
    let whole: &'static mut MaybeUninit<T> = unsafe { &mut *this.whole.get() };
    init(whole)?;
    // SAFETY: initialised.
    let (ticks, reads, published) = unsafe { whole.assume_init_mut() }.halves();
    // SAFETY: nobody reads it before the ticker is made.
    unsafe { &mut *this.published.get() }.write(published);
    this.home.store(halves.addr(), Ordering::Relaxed);
    reader.finish(reads);
    ticker.finish(ticks);
    Ok(())
}

/// Makes a supervisor of one plane.
///
/// # Safety
/// As for [`make`].
pub(crate) unsafe fn make_supervisor(
    storage: *mut Storage,
    bytes: usize,
    config: &Config,
) -> Result<(), Code> {
    let init = |place: &mut _| init(place, config).map_err(|error| code_of(&error));
    // SAFETY: the caller's promise.
    unsafe { make(storage, bytes, init) }
}

/// Makes a supervisor of a rotor.
///
/// # Safety
/// As for [`make`].
pub(crate) unsafe fn make_rotor(
    storage: *mut RotorStorage,
    bytes: usize,
    (shaft, configs): (&Shaft, &[Config; 2]),
) -> Result<(), Code> {
    let init =
        |place: &mut _| init_rotor(place, shaft, configs).map_err(|error| code_of_shaft(&error));
    // SAFETY: the caller's promise.
    unsafe { make(storage, bytes, init) }
}

/// Piece by piece: the compiler makes a whole one on the stack first.
#[inline(never)]
fn init_rotor(
    place: &mut MaybeUninit<RotorParts>,
    shaft: &Shaft,
    configs: &[Config; 2],
) -> Result<(), ShaftError> {
    let (machine, [first, second]) = RotorCore::new(shaft, configs)?;
    let place = place.as_mut_ptr();
    // SAFETY: fields of the place, which is writable and used by nobody else; what is uninitialised is not read.
    let (machine_place, planes) = unsafe {
        let machine = &mut *(&raw mut (*place).machine).cast::<MaybeUninit<RotorCore>>();
        type Planes = [MaybeUninit<Supervisor<RECORD>>; 2];
        let planes = &mut *(&raw mut (*place).planes).cast::<Planes>();
        (machine, planes)
    };
    machine_place.write(machine);
    let [at_first, at_second] = planes;
    // Both were checked with the machine.
    init_plane(at_first, &first, 0)?;
    init_plane(at_second, &second, 1)
}

/// In a function of its own: then the compiler makes the supervisor in its place.
/// Otherwise it is on the stack first, which takes 28 kilobytes; the test `capi` looks.
#[inline(never)]
fn init(place: &mut MaybeUninit<Supervisor<RECORD>>, config: &Config) -> Result<(), ConfigError> {
    config.validate()?;
    match Supervisor::new(config) {
        Ok(supervisor) => {
            place.write(supervisor);
            Ok(())
        }
        Err(error) => Err(error),
    }
}

/// The same for a plane of a rotor.
#[inline(never)]
fn init_plane(
    place: &mut MaybeUninit<Supervisor<RECORD>>,
    config: &Config,
    end: u8,
) -> Result<(), ShaftError> {
    match Supervisor::of_rotor(config, end) {
        Ok(supervisor) => {
            place.write(supervisor);
            Ok(())
        }
        Err(error) => Err(ShaftError::Plane(usize::from(end), error)),
    }
}

/// What is wrong with a shaft or the configuration of one of its planes.
pub(crate) fn code_of_shaft(error: &ShaftError) -> Code {
    match error {
        ShaftError::Inertia => Code::ERROR_SHAFT_INERTIA,
        ShaftError::Places => Code::ERROR_SHAFT_PLACES,
        ShaftError::Plane(plane, error) => code_of(error).of_plane(*plane),
    }
}

/// Code of the parameter that was refused, or of the rule that it breaks.
pub(crate) fn code_of(refused: &ConfigError) -> Code {
    match refused.contradiction {
        Some(broken) => Code::rule(broken.rule),
        None => Code::parameter(refused.index),
    }
}
