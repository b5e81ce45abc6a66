//! Modes of motion: inside one mode the equations are smooth, between modes they jump.

/// What the rotor does at an instant, as a reader sees it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum ContactMode {
    /// No contact.
    #[default]
    Flight,
    /// Contact, sliding speed v_rel > 0: friction drives the rotor clockwise.
    SlipPositive,
    /// Contact, sliding speed v_rel < 0.
    SlipNegative,
    /// Contact, rolling without slip.
    Roll,
    /// Contact, the whirl stands still: held by rolling friction.
    Seated,
}

impl ContactMode {
    /// Short name for tables and traces.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flight => "flight",
            Self::SlipPositive => "slip+",
            Self::SlipNegative => "slip-",
            Self::Roll => "roll",
            Self::Seated => "seated",
        }
    }

    /// Whether the rotor touches the stator.
    pub fn in_contact(self) -> bool {
        self != Self::Flight
    }
}

/// Sliding at the contact: direction of v_rel, or held at zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slide {
    Positive,
    Negative,
    Rolling,
}

/// Whirl of the contact point: direction of v_w, or held at zero. Without rolling friction it
/// changes nothing and is not followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Whirl {
    Positive,
    Negative,
    Still,
    Ignored,
}

impl Slide {
    pub(crate) fn from_speed(speed: f64) -> Self {
        if speed < 0.0 {
            Self::Negative
        } else {
            Self::Positive
        }
    }

    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
            Self::Rolling => 0.0,
        }
    }
}

impl Whirl {
    pub(crate) fn from_speed(speed: f64) -> Self {
        if speed < 0.0 {
            Self::Negative
        } else {
            Self::Positive
        }
    }

    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
            Self::Still | Self::Ignored => 0.0,
        }
    }
}

/// A mode as the integrator sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Inside the clearance; armed: gap closes.
    Inside,
    /// Force has fallen to zero but the wall is still dented (d_c > 0); armed: force returns,
    /// rotor comes back inside.
    Beyond,
    /// In contact; armed: force, sliding and whirl guards of this pair.
    Contact(Slide, Whirl),
}

impl Phase {
    pub(crate) fn mode(self) -> ContactMode {
        match self {
            Self::Inside | Self::Beyond => ContactMode::Flight,
            Self::Contact(_, Whirl::Still) => ContactMode::Seated,
            Self::Contact(Slide::Rolling, _) => ContactMode::Roll,
            Self::Contact(Slide::Positive, _) => ContactMode::SlipPositive,
            Self::Contact(Slide::Negative, _) => ContactMode::SlipNegative,
        }
    }
}
