//! Counts the instructions of every tick of a stream, and how much stack a tick needs.
//!
//! Reads `stream.bin`, writes `counts.bin`: for each tick a little-endian word, the instructions in its lower
//! 24 bits and the mode after the tick above them. Prints `ticks` and `stack_bytes`.
//!
//! The emulator runs with `-icount shift=10`: an instruction takes 1024 ns of its time, 25.6 periods of
//! the 25 MHz on which SysTick counts.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod image {
    use core::hint::black_box;
    use cortex_m::peripheral::SYST;
    use cortex_m::peripheral::syst::SystClkSource;
    use firmware_image::under_test::Supervisor;
    use firmware_image::wire::{self, TICK_BYTES};
    use firmware_image::{exit, file, planted, report, stack, under_test};
    use supervisor::{Command, Sample};

    /// Ticks that are read and written at once.
    const CHUNK: usize = 32;
    /// SysTick counts 24 bits: a tick of more than 655 000 instructions could not be counted.
    const SYSTICK_MASK: u32 = 0x00FF_FFFF;

    type Work = fn(&mut Supervisor, &Sample, &mut Command);

    /// As [`under_test::tick`], doing nothing: one instruction, the return.
    #[inline(never)]
    fn nothing(_: &mut Supervisor, _: &Sample, _: &mut Command) {}

    /// Two instructions a turn, as many turns as the sample's number, and a few around them.
    #[inline(never)]
    fn turns(_: &mut Supervisor, sample: &Sample, _: &mut Command) {
        // SAFETY: the loop touches one register, which is told, and the flags; the number is not zero.
        unsafe {
            core::arch::asm!(
                "2:",
                "subs {turns}, {turns}, #1",
                "bne 2b",
                turns = inout(reg) sample.sequence => _,
                options(nomem, nostack)
            );
        }
    }

    /// Whether the clock counts instructions: a loop of 3000 turns has 4000 more than one of 1000.
    fn clock_is_right(supervisor: &mut Supervisor) -> bool {
        let work: Work = black_box(turns);
        let mut count = |sequence| {
            let sample = Sample {
                sequence,
                ..Sample::default()
            };
            between(work, supervisor, &sample, &mut Command::default())
        };
        let short = count(1000);
        count(3000).wrapping_sub(short) == 4000
    }

    /// Instructions between two looks at SysTick with a call between them.
    #[inline(never)]
    fn between(
        work: Work,
        supervisor: &mut Supervisor,
        sample: &Sample,
        command: &mut Command,
    ) -> u32 {
        let before = SYST::get_current();
        work(supervisor, sample, command);
        let after = SYST::get_current();
        // SysTick counts down; 25.6 of its periods are an instruction.
        let periods = before.wrapping_sub(after) & SYSTICK_MASK;
        (periods * 10 + 128) / 256
    }

    #[cortex_m_rt::entry]
    fn main() -> ! {
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
        let Some(header) = stream.take().and_then(|b| wire::header_of(&b)) else {
            report::failed("stream.bin is no stream of this version")
        };
        let (mut ticks, mut stack_bytes) = (0_u32, 0_u32);
        for _ in 0..header.segments {
            let Some(segment) = stream.take().and_then(|b| wire::segment_of(&b)) else {
                report::failed("stream.bin ends before its last segment")
            };
            let Some(mut supervisor) = under_test::new(&segment.config) else {
                report::failed("a configuration is not valid")
            };
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
                for (tick, word) in chunk.iter().zip(&mut words).take(now) {
                    let Some((sample, _)) = tick.split_first_chunk() else {
                        break;
                    };
                    let sample = wire::sample_of(sample);
                    let mut command = Command::default();
                    let work: Work = black_box(nothing);
                    let empty = between(work, &mut supervisor, &sample, &mut command);
                    let work: Work = black_box(under_test::tick);
                    let painted = stack::paint();
                    let full = between(work, &mut supervisor, &sample, &mut command);
                    stack_bytes = stack_bytes.max(painted.used_bytes());
                    // The empty call's return is one; a tick has its own.
                    let instructions = full.wrapping_sub(empty).wrapping_add(1);
                    *word = (instructions | ((command.mode as u32) << 24)).to_le_bytes();
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
        exit::success()
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    firmware_image::not_for_the_host();
}
