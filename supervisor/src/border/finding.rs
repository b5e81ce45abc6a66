//! What the check of the configuration has found.

use core::sync::atomic::{AtomicU32, Ordering};

/// What the check has come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Finding {
    /// Nobody has asked for a check ([`crate::Config::check_first`]), or it is left out.
    #[default]
    Unchecked = 0,
    /// Not enough has been seen: the rotor has not levitated for long enough, or no stimulus came through. After an attempt the value
    /// is the standard error of the gain.
    NotYet = 1,
    /// Nothing contradicts: the supervisor may act.
    Passed = 2,
    /// x and y of the sensor, or of the force, are exchanged.
    AxesSwapped = 3,
    /// One axis of the sensor, or of the force, is inverted.
    AxisInverted = 4,
    /// Force and position have opposite signs.
    ForceInverted = 5,
    /// The axes of force and sensor are turned against each other, by [`Checked::value`] rad.
    AxesTurned = 6,
    /// The axes of force or sensor are not at right angles, or their gains differ; the value is their cosine, or the gains' ratio.
    AxesSkewed = 7,
    /// The rotor is moved the value times as much as configured: mass, unit or gain of force or position, period, or ratio of planes.
    Gain = 8,
    /// The force comes the value in ticks later than configured: delay or lag.
    Delay = 9,
    /// The rotor does not answer to the force; the value is the share of its motion that no force and stiffness explains.
    NoAnswer = 10,
    /// The orbit of the unbalance goes round against the spin; the value is backward over forward.
    SpinReversed = 11,
    /// The orbit goes round at the spin times 2π/60: revolutions a minute for rad/s.
    SpinUnit = 12,
    /// A rotor at rest without force lies at the value, in clearances, from the centre.
    Clearance = 13,
    /// Levitated, the rotor is read at the value, in clearances, and more from the centre.
    Position = 14,
}

impl Finding {
    const ALL: [Self; 15] = [
        Self::Unchecked,
        Self::NotYet,
        Self::Passed,
        Self::AxesSwapped,
        Self::AxisInverted,
        Self::ForceInverted,
        Self::AxesTurned,
        Self::AxesSkewed,
        Self::Gain,
        Self::Delay,
        Self::NoAnswer,
        Self::SpinReversed,
        Self::SpinUnit,
        Self::Clearance,
        Self::Position,
    ];

    /// Short name for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unchecked => "unchecked",
            Self::NotYet => "not yet",
            Self::Passed => "passed",
            Self::AxesSwapped => "axes swapped",
            Self::AxisInverted => "axis inverted",
            Self::ForceInverted => "force inverted",
            Self::AxesTurned => "axes turned",
            Self::AxesSkewed => "axes skewed",
            Self::Gain => "gain",
            Self::Delay => "delay",
            Self::NoAnswer => "no answer",
            Self::SpinReversed => "spin reversed",
            Self::SpinUnit => "unit of spin",
            Self::Clearance => "clearance",
            Self::Position => "position",
        }
    }

    /// Whether the machine contradicts its configuration.
    pub const fn is_contradiction(self) -> bool {
        self as u8 > Self::Passed as u8
    }
}

/// What the check has come to, and by how much.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Checked {
    /// What was found.
    pub finding: Finding,
    /// By how much, as the finding says; to three digits.
    pub value: f32,
}

/// The same in one word, for who reads it while it changes.
#[derive(Debug, Default)]
pub(crate) struct CheckedCell(AtomicU32);

/// Bits of the word that say what was found; the others are the upper ones of the value.
const FINDING_BITS: u32 = 0xFF;

impl CheckedCell {
    pub(crate) const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    pub(crate) fn store(&self, checked: Checked) {
        let word = (checked.value.to_bits() & !FINDING_BITS) | u32::from(checked.finding as u8);
        self.0.store(word, Ordering::Relaxed);
    }

    pub(crate) fn load(&self) -> Checked {
        let word = self.0.load(Ordering::Relaxed);
        let named = Finding::ALL.get((word & FINDING_BITS) as usize).copied();
        Checked {
            finding: named.unwrap_or_default(),
            value: f32::from_bits(word & !FINDING_BITS),
        }
    }
}

impl Clone for CheckedCell {
    fn clone(&self) -> Self {
        Self(AtomicU32::new(self.0.load(Ordering::Relaxed)))
    }
}
