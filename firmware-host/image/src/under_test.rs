//! The supervisors that the images run, one for each kind of number.

use crate::wire::{self, CommandBits, Hash, SampleBits};
use supervisor::{
    Command, Config, Core, CoreCommand, CoreSample, Mode, Prepared, Q, Sample, Supervisor,
    self_test,
};

/// Ticks of the flight record in floats. Host and image must agree: the tick at which a record freezes is part of
/// a command.
pub const RECORD: usize = 512;
/// The same in fixed point, for a processor with 16 KiB of RAM.
pub const SHORT_RECORD: usize = 64;

/// Floats in SI.
pub type Float = Supervisor<RECORD>;
/// Fixed point per unit: the core alone, behind whatever converts there.
pub type Fixed = Core<Q, SHORT_RECORD>;

/// A supervisor under test.
pub trait UnderTest: Sized {
    /// Name of its numbers.
    const NUMBER: &'static str;
    /// Bytes of its state without the recorder.
    const RAM_BYTES: usize;
    /// What it is told.
    type Sample;
    /// What it commands.
    type Command: Default;

    /// Whether this processor computes in its numbers as it should.
    fn self_test() -> bool;
    /// A new one; `None` for a configuration that is not valid or does not fit.
    fn new(config: &Config) -> Option<Self>;
    /// One tick with the recorder's part.
    fn step(&mut self, sample: &Self::Sample) -> Self::Command;
    /// The sample of these bits.
    fn sample(bits: &SampleBits) -> Self::Sample;
    /// The bits of a command.
    fn bits(command: &Self::Command) -> CommandBits;
    /// Mode after a tick.
    fn mode_of(command: &Self::Command) -> Mode;
    /// Takes what it leaves behind into a hash: its report, the events in its queue, its frozen record.
    fn read_out(&mut self, hash: &mut Hash);
    /// Everything else that firmware calls, so that it is linked.
    fn everything_else(&mut self);
}

/// One tick. A function of its own, so that there is one place to count in.
#[inline(never)]
pub fn tick<U: UnderTest>(supervisor: &mut U, sample: &U::Sample, command: &mut U::Command) {
    *command = supervisor.step(sample);
}

// The methods have the same names but belong to different types.
macro_rules! asked {
    () => {
        fn read_out(&mut self, hash: &mut Hash) {
            wire::add_report(hash, &Self::report(self));
            while let Some(event) = Self::next_event(self) {
                wire::add_event(hash, &event);
            }
            if let Some(record) = Self::record(self) {
                hash.add(&record.crc.to_le_bytes());
                for entry in record.entries() {
                    hash.add(&entry.to_bytes());
                }
            }
        }
        fn everything_else(&mut self) {
            use core::hint::black_box;
            black_box(Self::mode(self));
            black_box(Self::report(self));
            if let Some(event) = Self::next_event(self) {
                black_box(event);
            }
            if let Some(record) = Self::record(self) {
                black_box(record.crc);
                for entry in record.entries() {
                    black_box(entry);
                }
                black_box(supervisor::crc_of(record.entries()));
            }
            Self::rearm(self);
        }
    };
}

impl UnderTest for Float {
    const NUMBER: &'static str = "f32";
    const RAM_BYTES: usize = size_of::<Self>() - Core::<f32, RECORD>::RECORDER_BYTES;
    type Sample = Sample;
    type Command = Command;

    fn self_test() -> bool {
        self_test::<f32>()
    }
    fn new(config: &Config) -> Option<Self> {
        Supervisor::new(config).ok()
    }
    #[inline(always)]
    fn step(&mut self, sample: &Sample) -> Command {
        self.tick(sample)
    }
    fn sample(bits: &SampleBits) -> Sample {
        wire::sample_of_bits(bits)
    }
    fn bits(command: &Command) -> CommandBits {
        wire::command_bits(command)
    }
    fn mode_of(command: &Command) -> Mode {
        command.mode
    }
    asked!();
}

impl UnderTest for Fixed {
    const NUMBER: &'static str = "Q";
    const RAM_BYTES: usize = size_of::<Self>() - Self::RECORDER_BYTES;
    type Sample = CoreSample<Q>;
    type Command = CoreCommand<Q>;

    fn self_test() -> bool {
        self_test::<Q>()
    }
    fn new(config: &Config) -> Option<Self> {
        let prepared = Prepared::new(config).ok()?;
        Some(Core::new(&prepared))
    }
    #[inline(always)]
    fn step(&mut self, sample: &CoreSample<Q>) -> CoreCommand<Q> {
        self.tick(sample)
    }
    fn sample(bits: &SampleBits) -> CoreSample<Q> {
        wire::core_sample_of_bits(bits)
    }
    fn bits(command: &CoreCommand<Q>) -> CommandBits {
        wire::core_command_bits(command)
    }
    fn mode_of(command: &CoreCommand<Q>) -> Mode {
        command.mode
    }
    asked!();
}
