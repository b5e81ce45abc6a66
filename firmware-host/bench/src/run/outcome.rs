//! How a run may end.

use serde::Serialize;

/// How a run ended, the better the earlier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(test, derive(Default))]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Back in the middle (r < 0.3 c, held) and not touching again.
    Recovered,
    /// Free vibration without contact.
    #[cfg_attr(test, default)]
    Decayed,
    /// Free, and farther from the middle with every swing: it would touch soon.
    Diverging,
    /// Touching still, without whirl and without speed.
    Resting,
    /// Held on the stator by a load that is still on.
    Pinned,
    /// In unbroken contact for longer than a rotor takes to settle, moving, without whirl.
    Rubbing,
    /// Still hitting the stator when the run ended, without whirl.
    Bouncing,
    /// Backward whirl: the contact speed passed the scene's limit.
    Whirl,
}

impl Outcome {
    /// All of them, the better the earlier.
    pub const ALL: [Self; 8] = [
        Self::Recovered,
        Self::Decayed,
        Self::Diverging,
        Self::Resting,
        Self::Pinned,
        Self::Rubbing,
        Self::Bouncing,
        Self::Whirl,
    ];

    /// That of a word.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|outcome| outcome.name() == name)
    }

    /// The word for it, as in `verdict.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Recovered => "recovered",
            Self::Decayed => "decayed",
            Self::Diverging => "diverging",
            Self::Resting => "resting",
            Self::Pinned => "pinned",
            Self::Rubbing => "rubbing",
            Self::Bouncing => "bouncing",
            Self::Whirl => "whirl",
        }
    }

    /// What it means, for a person.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Recovered => "back within 0.3 of the clearance and held there, no touch since",
            Self::Decayed => {
                "free of the wall to the end, but not held in the middle: nothing holds it there, or it hangs beside the centre \
                 under a steady load because the levitation controller has no integrator"
            }
            Self::Diverging => "free, but swinging wider each time: it would touch soon",
            Self::Resting => "lying on the retainer bearing",
            Self::Pinned => "held against the retainer bearing by a load that is still on",
            Self::Rubbing => "in unbroken contact, moving, without whirl",
            Self::Bouncing => "still hitting the retainer bearing when the run ended",
            Self::Whirl => "dry friction backward whirl, above the limit of contact speed",
        }
    }

    /// Whether the rotor is free again, and stays so as far as the run shows.
    pub fn recovered(self) -> bool {
        matches!(self, Self::Recovered | Self::Decayed)
    }
}
