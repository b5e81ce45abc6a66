//! What happens.

pub use super::point_events::Point;
pub(crate) use super::written_events::BEGIN_S;
pub use super::written_events::Written;

/// An event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// Of a point mass.
    Point(Point),
    /// Of any machine.
    Written(Written),
}

impl Event {
    /// Name in tables.
    pub fn name(self) -> String {
        match self {
            Self::Point(event) => event.name().to_owned(),
            Self::Written(event) => event.name(),
        }
    }
}

/// What any machine meets beside blows and loads: starts, set-downs, unbalance, long loads, power that dips.
pub(crate) const OF_ANY_MACHINE: [Written; 15] = [
    Written::Restart,
    Written::RestartThenBlow,
    set_down(false, true),
    set_down(false, false),
    set_down(true, true),
    set_down(true, false),
    Written::LiftOff,
    Written::BladeLoss,
    Written::Rub { conical: false },
    Written::Rub { conical: true },
    Written::WindUp,
    Written::LongLoad { turns: false },
    Written::LongLoad { turns: true },
    Written::PowerDip { measured: false },
    Written::PowerDip { measured: true },
];

const fn set_down(spins: bool, announced: bool) -> Written {
    Written::SetDown { spins, announced }
}

/// Blows at and loads on a rotor, power that fails, and nothing.
pub(crate) const OF_ROTORS: [Written; 10] = [
    Written::CentreBlow(70),
    Written::CentreBlow(130),
    Written::ConicalBlow(70),
    Written::ConicalBlow(130),
    Written::OneEndBlow(70),
    Written::OneEndBlow(130),
    Written::LoadInTheMiddle(260),
    Written::LoadAtOneEnd(160),
    Written::Outage(30),
    Written::Idle,
];
