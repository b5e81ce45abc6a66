//! Counts the instructions of every tick of a stream, and how much stack a tick needs.
//!
//! Reads `stream.bin`, writes `counts.bin`: for each tick a little-endian word, the instructions in its lower
//! 24 bits and the mode after the tick above them. Prints `ticks`, `stack_bytes` and `ram_bytes`. Between ticks the
//! background has its turn, so that a record is written again after one that froze.
//!
//! The emulator runs with `-icount shift=10`: an instruction takes 1024 ns of its time.

use super::{checked, exit, file, planted, report, stack};
use crate::under_test::Ticked;
use crate::wire::{self, SampleBits, TICK_BYTES};
use core::hint::black_box;
use core::mem::{MaybeUninit, transmute};
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// Ticks that are read and written at once.
const CHUNK: usize = 16;
/// SysTick counts 24 bits: a tick of more than 655 000 instructions could not be counted.
const SYSTICK_MASK: u32 = 0x00FF_FFFF;

/// Periods of SysTick in so many instructions of 1024 ns: at the 25 MHz of the MPS2 boards …
#[cfg(not(small_board))]
const PERIODS: u32 = 256;
#[cfg(not(small_board))]
const INSTRUCTIONS: u32 = 10;
/// … and at the 16 MHz of the microbit.
#[cfg(small_board)]
const PERIODS: u32 = 2048;
#[cfg(small_board)]
const INSTRUCTIONS: u32 = 125;

static TURNS: AtomicU32 = AtomicU32::new(1);

/// What is counted: a tick, or what takes the place of one and commands nothing.
type Work<U> = fn(&mut U, &<U as Ticked>::Sample) -> MaybeUninit<<U as Ticked>::Command>;

// A function of one instruction: what a compiler makes of an empty one has a frame, too.
core::arch::global_asm!(
    ".pushsection .text.counted_nothing",
    ".thumb_func",
    ".global counted_nothing",
    ".type counted_nothing, %function",
    "counted_nothing: bx lr",
    ".size counted_nothing, . - counted_nothing",
    ".popsection",
);
unsafe extern "Rust" {
    fn counted_nothing();
}

/// As a tick, but that it does nothing: one instruction, the return.
fn nothing<U: Ticked>() -> Work<U> {
    // SAFETY: it returns at once: it looks at no argument and writes no command, which the caller does not expect either.
    black_box(unsafe { transmute::<unsafe extern "Rust" fn(), Work<U>>(counted_nothing) })
}

/// A tick with the recorder's part.
fn tick<U: Ticked>() -> Work<U> {
    type Tick<U> = fn(&mut U, &<U as Ticked>::Sample) -> <U as Ticked>::Command;
    // SAFETY: `MaybeUninit` is transparent, so that a function which returns it is called like one that returns what is in it.
    black_box(unsafe { transmute::<Tick<U>, Work<U>>(U::TICK) })
}

/// Two instructions a turn, and a few around them.
#[inline(never)]
fn turns<U: Ticked>(_: &mut U, _: &U::Sample) -> MaybeUninit<U::Command> {
    let turns = TURNS.load(Ordering::Relaxed);
    // SAFETY: the loop touches one register, which is declared, and the flags; the number is not zero.
    unsafe {
        core::arch::asm!(
            "2:",
            "subs {turns}, {turns}, #1",
            "bne 2b",
            turns = inout(reg) turns => _,
            options(nomem, nostack)
        );
    }
    MaybeUninit::uninit()
}

/// Whether the clock counts instructions: a loop of 3000 turns has 4000 more than one of 1000.
fn clock_is_right<U: Ticked>(supervisor: &mut U) -> bool {
    let work: Work<U> = black_box(turns);
    let sample = U::sample(&SampleBits::default());
    let mut count = |turns| {
        TURNS.store(turns, Ordering::Relaxed);
        between(work, supervisor, &sample).1
    };
    let short = count(1000);
    count(3000).wrapping_sub(short) == 4000
}

/// Instructions between two looks at SysTick with a call between them.
#[inline(never)]
fn between<U: Ticked>(
    work: Work<U>,
    supervisor: &mut U,
    sample: &U::Sample,
) -> (MaybeUninit<U::Command>, u32) {
    let before = SYST::get_current();
    let result = work(supervisor, sample);
    let after = SYST::get_current();
    // SysTick counts down.
    let periods = before.wrapping_sub(after) & SYSTICK_MASK;
    (result, (periods * INSTRUCTIONS + PERIODS / 2) / PERIODS)
}

/// The whole image.
pub fn run<U: Ticked>() -> ! {
    planted();
    let Some(mut peripherals) = cortex_m::Peripherals::take() else {
        exit::failure()
    };
    peripherals.SYST.set_clock_source(SystClkSource::Core);
    peripherals.SYST.set_reload(SYSTICK_MASK);
    peripherals.SYST.clear_current();
    peripherals.SYST.enable_counter();

    let Some(mut stream) = file::File::read(c"stream.bin") else {
        report::failed("stream.bin cannot be read")
    };
    let Some(mut counts) = file::File::create(c"counts.bin") else {
        report::failed("counts.bin cannot be written")
    };
    let Some(header) = stream.next_bytes().and_then(|b| wire::header_of(&b)) else {
        report::failed("stream.bin is no stream of this version")
    };
    let (mut ticks, mut stack_bytes) = (0_u32, 0_u32);
    for _ in 0..header.segments {
        let Some(segment) = stream.next_bytes().and_then(|b| wire::segment_of(&b)) else {
            report::failed("stream.bin ends before its last segment")
        };
        let Some(mut supervisor) = U::new(&segment.config) else {
            report::failed("a configuration is not valid")
        };
        checked(&mut supervisor);
        if !clock_is_right(&mut supervisor) {
            report::failed("SysTick does not count instructions; it does with -icount shift=10")
        }
        let mut left = segment.ticks as usize;
        while left > 0 {
            let mut chunk = [[0; TICK_BYTES]; CHUNK];
            let mut words = [[0; 4]; CHUNK];
            let now = left.min(CHUNK);
            let whole = chunk.as_flattened_mut();
            if !whole
                .get_mut(..now * TICK_BYTES)
                .is_some_and(|bytes| stream.fill(bytes))
            {
                report::failed("stream.bin ends within a segment")
            }
            for (bytes, word) in chunk.iter().zip(&mut words).take(now) {
                let Some((sample, _)) = bytes.split_first_chunk() else {
                    break;
                };
                let sample = U::sample(&wire::sample_of(sample));
                supervisor.prepare(&sample);
                let (_, empty) = between(nothing(), &mut supervisor, &sample);
                let painted = stack::paint();
                let (command, full) = between(tick(), &mut supervisor, &sample);
                // SAFETY: a tick has returned it.
                let command = unsafe { command.assume_init() };
                stack_bytes = stack_bytes.max(painted.used_bytes());
                // The empty call's return is one; a tick has its own.
                let instructions = full.wrapping_sub(empty).wrapping_add(1);
                *word = (instructions | ((U::mode_of(&command) as u32) << 24)).to_le_bytes();
                supervisor.background();
                ticks += 1;
            }
            let written = words.as_flattened().get(..4 * now);
            if !written.is_some_and(|bytes| counts.append(bytes)) {
                report::failed("counts.bin cannot be written")
            }
            left -= now;
        }
    }
    report::number("ticks", ticks);
    report::number("stack_bytes", stack_bytes);
    report::number("ram_bytes", U::RAM_BYTES as u32);
    exit::success()
}
