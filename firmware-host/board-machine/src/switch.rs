//! When outputs go on, and when the independent watchdog is fed.

use core::sync::atomic::{AtomicU32, Ordering};

use crate::TICK_HZ;

/// What the line of the machine that asks for the bearing has just done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Request {
    /// It went up: a person, or the machine's control, wants the bearing on.
    On,
    /// It is up or down as before.
    Nothing,
    /// It is down: outputs stay off.
    Off,
}

/// The request's line. Only an edge switches on: what has switched itself off, and a chip that comes out of a reset while the
/// line is up, stay off until somebody asks anew.
#[derive(Default)]
pub struct Switch {
    has_been_down: bool,
}

impl Switch {
    /// In each tick, with the level of the line.
    pub fn request(&mut self, up: bool) -> Request {
        let fresh = up && self.has_been_down;
        self.has_been_down = !up;
        match (up, fresh) {
            (_, true) => Request::On,
            (true, false) => Request::Nothing,
            (false, false) => Request::Off,
        }
    }
}

/// Ticks, counted by the control interrupt for the background.
pub struct Liveness(AtomicU32);

impl Liveness {
    /// Nobody has ticked yet.
    #[expect(
        clippy::new_without_default,
        reason = "for a static, which a default cannot make"
    )]
    pub const fn new() -> Self {
        Self(AtomicU32::new(0))
    }

    /// At the end of each tick; from one interrupt alone.
    pub fn ticked(&self) {
        let ticks = self.0.load(Ordering::Relaxed);
        self.0.store(ticks.wrapping_add(1), Ordering::Relaxed);
    }

    /// Asked by the background, which feeds the watchdog where this says so: whether as many ticks have come since it last did as
    /// belong into a fifth of the watchdog's time. Neither of the two feeds it without the other.
    pub fn may_feed(&self, fed_at: &mut u32) -> bool {
        const TICKS: u32 = TICK_HZ / 1000 * crate::WATCHDOG_MS / 5;
        let ticks = self.0.load(Ordering::Relaxed);
        let may = ticks.wrapping_sub(*fed_at) >= TICKS;
        if may {
            *fed_at = ticks;
        }
        may
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_edge_switches_on() {
        let mut switch = Switch::default();
        let levels = [true, true, false, false, true, true, false, true];
        use Request::{Nothing, Off, On};
        let wanted = [Nothing, Nothing, Off, Off, On, Nothing, Off, On];
        assert_eq!(levels.map(|level| switch.request(level)), wanted);
    }

    #[test]
    fn without_ticks_there_is_no_food() {
        let (liveness, mut fed_at) = (Liveness::new(), 0);
        assert!(!liveness.may_feed(&mut fed_at));
        let tick = |times: u32| (0..times).for_each(|_| liveness.ticked());
        tick(199);
        assert!(!liveness.may_feed(&mut fed_at));
        tick(1);
        assert!(liveness.may_feed(&mut fed_at) && !liveness.may_feed(&mut fed_at));
    }
}
