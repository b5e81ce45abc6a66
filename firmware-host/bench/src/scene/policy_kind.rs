//! The policies by name.

/// A policy by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolicyKind {
    /// No force.
    Passive,
    /// The whole capacity inwards outside a band.
    Radial,
    /// Force against the speed only.
    Damping,
    /// The saturated levitation controller alone.
    Levitation,
    /// The supervisor with that levitation controller behind it.
    Supervisor,
}

impl PolicyKind {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Passive,
        Self::Radial,
        Self::Damping,
        Self::Levitation,
        Self::Supervisor,
    ];

    /// Name in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passive => "passive",
            Self::Radial => "radial",
            Self::Damping => "damping",
            Self::Levitation => "levitation",
            Self::Supervisor => "supervisor",
        }
    }

    /// The policy of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|p| p.name() == name)
    }

    /// Whether it needs a levitation controller.
    pub fn levitates(self) -> bool {
        matches!(self, Self::Levitation | Self::Supervisor)
    }
}
