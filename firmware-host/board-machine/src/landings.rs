//! The ledger of landings in memory that keeps what it holds: two copies, written in turn.

use crate::{CONFIG, RECORD};
use supervisor::{LEDGER_BYTES, Ledger, LedgerError, Record};

/// Words of a copy.
const WORDS: usize = LEDGER_BYTES / 4;
/// Words of both copies.
pub const RETAINED_WORDS: usize = 2 * WORDS;

/// What a board says where the ledger was blank, or one of its copies is not whole.
pub const MISSING: &[u8] = b"ledger of landings: landings may be missing in it\n";
/// What it says where there is none.
pub const NOT_COUNTED: &[u8] = b"ledger of landings: not whole, landings are not counted\n";

/// Memory of [`RETAINED_WORDS`] words that outlive a reset; a word is written whole or not at all.
pub trait RetainedMemory {
    /// What is there.
    fn word(&self, at: usize) -> u32;
    /// Something else from now on.
    fn set_word(&mut self, at: usize, word: u32);
}

/// What the retainer bearing has borne, and where that is kept.
pub struct Landings<K> {
    memory: K,
    ledger: Ledger,
}

impl<K: RetainedMemory> Landings<K> {
    /// At boot, once for each supervisor that is made; and what is to be reported of it. Where nothing was ever written a new bearing
    /// is taken to be there, which on a machine is for a service tool to say.
    ///
    /// # Errors
    /// What is wrong where neither copy is whole: what is left is not written over, and landings are not counted.
    pub fn at_boot(mut memory: K) -> Result<(Self, Option<LedgerError>), LedgerError> {
        let copies = [0, 1].map(|copy| read(&memory, copy));
        let [first, second] = &copies;
        let (ledger, reported) = match Ledger::newer([first, second]) {
            Ok(found) => found,
            Err(LedgerError::Blank) => {
                let fitted = Ledger::new(1, CONFIG.severity_limit);
                write(&mut memory, 0, &fitted);
                write(&mut memory, 1, &fitted);
                (fitted, Some(LedgerError::Blank))
            }
            Err(why) => return Err(why),
        };
        Ok((Self { memory, ledger }, reported))
    }

    /// Adds a record, before it is given back, and writes the older of both copies anew: where power fails meanwhile, the other one
    /// is whole.
    pub fn take_in(&mut self, record: &Record<'_, f32, RECORD>) {
        if self.ledger.take_in(record) {
            let copy = self.ledger.updates as usize & 1;
            write(&mut self.memory, copy, &self.ledger);
        }
    }

    /// As it stands.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }
}

fn read(memory: &impl RetainedMemory, copy: usize) -> [u8; LEDGER_BYTES] {
    let mut bytes = [0; LEDGER_BYTES];
    let (places, _) = bytes.as_chunks_mut::<4>();
    for (at, place) in (copy * WORDS..).zip(places) {
        *place = memory.word(at).to_le_bytes();
    }
    bytes
}

fn write(memory: &mut impl RetainedMemory, copy: usize, ledger: &Ledger) {
    let bytes = ledger.to_bytes();
    let (words, _) = bytes.as_chunks::<4>();
    for (at, word) in (copy * WORDS..).zip(words) {
        memory.set_word(at, u32::from_le_bytes(*word));
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{LEDGER_BYTES, Landings, RETAINED_WORDS, RetainedMemory, WORDS};
    use crate::{BEARING, CONFIG, RECORD};
    use std::boxed::Box;
    use std::cell::RefCell;
    use supervisor::{Ledger, LedgerError, Sample, Status, Supervisor};

    /// Registers that a test looks into, and that lose their power after so many writes.
    struct Registers {
        words: RefCell<[u32; RETAINED_WORDS]>,
        left: RefCell<usize>,
    }

    impl RetainedMemory for &Registers {
        fn word(&self, at: usize) -> u32 {
            self.words.borrow()[at]
        }
        fn set_word(&mut self, at: usize, word: u32) {
            let mut left = self.left.borrow_mut();
            if *left > 0 {
                *left -= 1;
                self.words.borrow_mut()[at] = word;
            }
        }
    }

    fn registers(fill: u32) -> Registers {
        Registers {
            words: RefCell::new([fill; RETAINED_WORDS]),
            left: RefCell::new(usize::MAX),
        }
    }

    /// Lands the rotor once, and gives the frozen record to a ledger.
    fn landed(into: &mut Landings<&Registers>) {
        let mut supervisor = Box::new(Supervisor::<RECORD>::new(&CONFIG).unwrap());
        for sequence in 0..20_000_u32 {
            let out_m: f32 = 3e-5 * sequence.saturating_sub(99) as f32;
            let back_m: f32 = 2e-6 * sequence.saturating_sub(150) as f32;
            let x_m =
                out_m.min(1.01 * BEARING.clearance_m) - back_m.min(1.01 * BEARING.clearance_m);
            supervisor.tick(&Sample {
                sequence,
                status: Status::BEARING_ON | Status::LEVITATED_BEFORE,
                position_m: [x_m, 4e-7 * (sequence % 3) as f32],
                ..Sample::default()
            });
            if let Some(record) = supervisor.record() {
                return into.take_in(&record);
            }
        }
        panic!("no record has frozen");
    }

    /// Over resets: what was written is read, and goes on being added to.
    #[test]
    fn landings_outlive_resets() {
        let registers = registers(0);
        for boot in 0..3_u32 {
            let (mut landings, reported) = Landings::at_boot(&registers).unwrap();
            assert_eq!(reported, (boot == 0).then_some(LedgerError::Blank));
            assert_eq!(landings.ledger().landings, boot);
            landed(&mut landings);
            assert_eq!(landings.ledger().landings, boot + 1);
            assert!(landings.ledger().severity_sum() > 0.0);
        }
    }

    /// Whatever the word at which power fails while a landing is written down, the one before is there.
    #[test]
    fn a_copy_that_is_half_written_costs_one_landing_at_most() {
        for cut in 0..=WORDS {
            let registers = registers(u32::MAX);
            let (mut landings, _) = Landings::at_boot(&registers).unwrap();
            landed(&mut landings);
            let (mut landings, reported) = Landings::at_boot(&registers).unwrap();
            assert_eq!(reported, None);
            *registers.left.borrow_mut() = cut;
            landed(&mut landings);
            let (landings, reported) = Landings::at_boot(&registers).unwrap();
            let whole = cut == WORDS;
            assert_eq!(
                landings.ledger().landings,
                if whole { 2 } else { 1 },
                "{cut}"
            );
            // Nothing written, or all of it, leaves both whole. The first word is the same in every ledger.
            let torn = !whole && reported.is_some();
            assert!(torn || reported.is_none(), "{cut}: {reported:?}");
        }
    }

    /// Two copies that are not whole are left as they are, for a person.
    #[test]
    fn what_is_damaged_is_not_written_over() {
        let registers = registers(7);
        let before = *registers.words.borrow();
        let error = Landings::at_boot(&registers).err();
        assert_eq!(error, Some(LedgerError::Letters));
        assert_eq!(*registers.words.borrow(), before);
        assert_eq!(Ledger::new(1, 1.0).to_bytes().len(), LEDGER_BYTES);
    }
}
