//! What a retainer bearing has borne since it was fitted: a small block for memory that keeps it without power. In the
//! background: the tick knows nothing of it.
//!
//! The rule is that of Palmgren and Miner, linear in energy: landings of severities sᵢ have used up Σ sᵢ/A of a bearing that may
//! bear A in all.

use crate::number::scalar::Scalar;
use crate::number::words::crc_of_word;
use crate::record::sections::{Record, Summary};
use core::fmt;

/// Version of what is written.
pub const LEDGER_VERSION: u16 = 1;
/// Bytes of a ledger.
pub const LEDGER_BYTES: usize = 4 * WORDS;
/// With the checksum.
const WORDS: usize = 12;
/// First word.
const LETTERS: u32 = u32::from_le_bytes(*b"AMBL");
/// Severity is added up in these, as integers: a sum of `f32` loses light landings once it is large.
const PER_SEVERITY: f32 = 1e6;

/// Landings of one retainer bearing. Sums and counts of landings end at the largest number there is.
///
/// ```
/// use supervisor::{Ledger, LedgerError, Summary};
///
/// let fitted = Ledger::new(7, 20.0); // once, when bearing 7 is fitted
/// let mut ledger = Ledger::from_bytes(&fitted.to_bytes())?; // at each boot, from what was kept
///
/// // In the background, of each frozen record: `ledger.take_in(&record)`, which is
/// let landing = Summary { landings: 1, severity_index: 0.5, hardest_impact_m_s: 0.3, ..Summary::default() };
/// if ledger.add(&landing, 4711) {
///     let _to_be_kept = ledger.to_bytes();
/// }
/// assert_eq!((ledger.landings, ledger.landings_left(0.5)), (1, Some(39)));
///
/// assert_eq!(Ledger::from_bytes(&[0xFF; 48]), Err(LedgerError::Blank)); // lost, or never made
/// # Ok::<(), LedgerError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ledger {
    /// The user's number of the bearing: another one for each that is fitted.
    pub bearing: u32,
    /// How often it has been added to. The lowest bit says in which of two places the next copy goes.
    pub updates: u32,
    /// Severity that the bearing may bear in all.
    pub severity_allowed: f32,
    /// Landings.
    pub landings: u32,
    /// Sum of their severities, in millionths.
    pub severity_millionths: u64,
    /// Largest severity of what was added at once: a landing, with those before it that are in no record.
    pub worst_severity: f32,
    /// Fastest normal speed before an impact \[m/s\], of those in records.
    pub hardest_impact_m_s: f32,
    /// [`crate::Head::closed_at`] of the record that was added last.
    pub closed_at: u32,
    /// What the supervisor has counted since it was made, as far as it is in here already: not written down.
    pub run_landings: u32,
    /// See `run_landings`; in millionths.
    pub run_severity_millionths: u64,
}

/// Why bytes are no ledger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LedgerError {
    /// They are not [`LEDGER_BYTES`].
    Length,
    /// Nothing was ever written there: all bits are 0, or all are 1. A ledger without landings is not blank: it was lost, or
    /// never made.
    Blank,
    /// The first word is not that of a ledger.
    Letters,
    /// The checksum is not that of what is there.
    Damaged,
    /// They are whole, and of another version.
    Version,
    /// Two copies are of two bearings.
    Bearings,
}

impl fmt::Display for LedgerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "a ledger has 48 bytes",
            Self::Blank => "nothing was ever written there: the ledger is lost, or was never made",
            Self::Letters => "no ledger begins there",
            Self::Damaged => "the ledger is damaged: its checksum is another one",
            Self::Version => "the ledger is of another version",
            Self::Bearings => "the copies are of two bearings",
        })
    }
}

impl core::error::Error for LedgerError {}

impl Ledger {
    /// That of a bearing without landings, when it is fitted. An allowance that is no number or below 0 is none at all.
    pub fn new(bearing: u32, severity_allowed: f32) -> Self {
        Self {
            bearing,
            updates: 0,
            severity_allowed: if is_amount(severity_allowed) {
                severity_allowed
            } else {
                0.0
            },
            landings: 0,
            severity_millionths: 0,
            worst_severity: 0.0,
            hardest_impact_m_s: 0.0,
            closed_at: 0,
            run_landings: 0,
            run_severity_millionths: 0,
        }
    }

    /// Adds a frozen record, and the landings before it that are in none. Whether anything is new: then it is to be written down.
    /// The same record once more adds nothing.
    pub fn take_in<S: Scalar, const N: usize>(&mut self, record: &Record<'_, S, N>) -> bool {
        self.add(&record.summary(), record.closed_at())
    }

    /// The same by what the record says: its summary, and the sequence number at which it froze.
    #[inline(never)]
    pub fn add(&mut self, summary: &Summary, closed_at: u32) -> bool {
        let severity = millionths(summary.severity_index);
        // Fewer than before: the supervisor is another one. The index may fall by its last bits where units change.
        let fell = self.run_severity_millionths.saturating_sub(severity);
        if summary.landings < self.run_landings || fell > 2 + severity / 1024 {
            self.begin_run();
        }
        let landings = summary.landings.saturating_sub(self.run_landings);
        let risen = severity.saturating_sub(self.run_severity_millionths);
        if landings == 0 && risen == 0 {
            return false;
        }
        self.run_landings = summary.landings;
        self.run_severity_millionths = severity.max(self.run_severity_millionths);
        self.landings = self.landings.saturating_add(landings);
        self.severity_millionths = self.severity_millionths.saturating_add(risen);
        let risen = risen as f32 / PER_SEVERITY;
        if risen > self.worst_severity {
            self.worst_severity = risen;
        }
        let hardest = summary.hardest_impact_m_s;
        if is_amount(hardest) && hardest > self.hardest_impact_m_s {
            self.hardest_impact_m_s = hardest;
        }
        self.closed_at = closed_at;
        self.updates = self.updates.wrapping_add(1);
        true
    }

    /// A supervisor has been made anew: what it counts begins with nothing. Not needed after [`Self::from_bytes`].
    pub fn begin_run(&mut self) {
        (self.run_landings, self.run_severity_millionths) = (0, 0);
    }

    /// Sum of the severities of all landings.
    pub fn severity_sum(&self) -> f32 {
        self.severity_millionths as f32 / PER_SEVERITY
    }

    /// What is left of what the bearing may bear, at least 0. Where that is above 0 it may be a supervisor's
    /// [`crate::Config::severity_limit`] from boot on, which then asks for coasting down when the bearing's share is used up.
    pub fn severity_left(&self) -> f32 {
        self.left() as f32 / PER_SEVERITY
    }

    /// How many landings of this severity the bearing may still bear. `None` where the severity is not above 0.
    pub fn landings_left(&self, severity: f32) -> Option<u32> {
        let left = self.left().checked_div(millionths(severity))?;
        Some(u32::try_from(left).unwrap_or(u32::MAX))
    }

    fn left(&self) -> u64 {
        millionths(self.severity_allowed).saturating_sub(self.severity_millionths)
    }

    fn words(&self) -> [u32; WORDS] {
        let mut words = [
            LETTERS,
            u32::from(LEDGER_VERSION),
            self.updates,
            self.bearing,
            self.severity_allowed.to_bits(),
            self.landings,
            self.severity_millionths as u32,
            (self.severity_millionths >> 32) as u32,
            self.worst_severity.to_bits(),
            self.hardest_impact_m_s.to_bits(),
            self.closed_at,
            0,
        ];
        let crc = crc(&words);
        if let Some(last) = words.last_mut() {
            *last = crc;
        }
        words
    }

    /// As it is to be written down.
    pub fn to_bytes(&self) -> [u8; LEDGER_BYTES] {
        let mut bytes = [0; LEDGER_BYTES];
        let (places, _) = bytes.as_chunks_mut::<4>();
        (places.iter_mut().zip(self.words())).for_each(|(place, word)| *place = word.to_le_bytes());
        bytes
    }

    /// From what was written down. Once for each supervisor that is made: all that this has counted will be added.
    ///
    /// # Errors
    /// What is wrong with it: then there are no figures.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, LedgerError> {
        let bytes = <&[u8; LEDGER_BYTES]>::try_from(bytes).map_err(|_| LedgerError::Length)?;
        let mut words = [0; WORDS];
        let (read, _) = bytes.as_chunks::<4>();
        (words.iter_mut().zip(read)).for_each(|(word, four)| *word = u32::from_le_bytes(*four));
        if words == [0; WORDS] || words == [u32::MAX; WORDS] {
            return Err(LedgerError::Blank);
        }
        let [
            letters,
            version,
            updates,
            bearing,
            severity_allowed,
            landings,
            low,
            high,
            worst_severity,
            hardest_impact_m_s,
            closed_at,
            checksum,
        ] = words;
        if letters != LETTERS {
            return Err(LedgerError::Letters);
        }
        if checksum != crc(&words) {
            return Err(LedgerError::Damaged);
        }
        if version != u32::from(LEDGER_VERSION) {
            return Err(LedgerError::Version);
        }
        let amounts = [severity_allowed, worst_severity, hardest_impact_m_s].map(f32::from_bits);
        if !amounts.into_iter().all(is_amount) {
            return Err(LedgerError::Damaged);
        }
        let [severity_allowed, worst_severity, hardest_impact_m_s] = amounts;
        Ok(Self {
            updates,
            landings,
            severity_millionths: u64::from(low) | u64::from(high) << 32,
            worst_severity,
            hardest_impact_m_s,
            closed_at,
            ..Self::new(bearing, severity_allowed)
        })
    }

    /// The newer of two copies, which are written in turn ([`Self::updates`]) so that one of them is whole whenever the power
    /// fails; and what is wrong with the other one, if anything is: then the last landing may be missing.
    ///
    /// # Errors
    /// What is wrong with the first where neither is whole; [`LedgerError::Bearings`].
    pub fn newer(copies: [&[u8]; 2]) -> Result<(Self, Option<LedgerError>), LedgerError> {
        match copies.map(Self::from_bytes) {
            [Ok(first), Ok(second)] if first.bearing != second.bearing => {
                Err(LedgerError::Bearings)
            }
            [Ok(first), Ok(second)] => {
                let ahead = first.updates.wrapping_sub(second.updates);
                let newer = if ahead <= u32::MAX / 2 { first } else { second };
                Ok((newer, None))
            }
            [Ok(whole), Err(error)] | [Err(error), Ok(whole)] => Ok((whole, Some(error))),
            [Err(error), Err(_)] => Err(error),
        }
    }
}

/// Neither below 0 nor infinite, and a number.
fn is_amount(x: f32) -> bool {
    (0.0..=f32::MAX).contains(&x)
}

/// The nearest; of what is no number, 0.
fn millionths(severity: f32) -> u64 {
    (severity * PER_SEVERITY + 0.5) as u64
}

/// Of all words but the last.
fn crc(words: &[u32; WORDS]) -> u32 {
    !(words.iter().take(WORDS - 1)).fold(!0, |crc, word| crc_of_word(crc, *word))
}
