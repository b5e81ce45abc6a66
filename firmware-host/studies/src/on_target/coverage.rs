//! Which modes and which ways from mode to mode a stream has.

use firmware_image::wire::MODES;
use supervisor::Mode;

/// The ways that the state machine has, apart from staying. There is none from a touch straight into approach or
/// hand-over, none from a fault into hand-over, none from bounce into approach, and none from levitation into hand-over.
const WAYS: [(Mode, &[Mode]); 8] = {
    use Mode::{
        Approach, BackwardWhirl, Bounce, HandedBack, Handover, Levitated, Pinned, SensorFault,
    };
    [
        (
            Levitated,
            &[Approach, Bounce, BackwardWhirl, Pinned, SensorFault],
        ),
        (
            Approach,
            &[
                Levitated,
                Bounce,
                BackwardWhirl,
                Pinned,
                Handover,
                SensorFault,
                HandedBack,
            ],
        ),
        (
            Bounce,
            &[
                Levitated,
                BackwardWhirl,
                Pinned,
                Handover,
                SensorFault,
                HandedBack,
            ],
        ),
        (
            BackwardWhirl,
            &[Levitated, Bounce, Pinned, Handover, SensorFault, HandedBack],
        ),
        (
            Pinned,
            &[
                Levitated,
                Bounce,
                BackwardWhirl,
                Handover,
                SensorFault,
                HandedBack,
            ],
        ),
        (
            Handover,
            &[
                Levitated,
                Approach,
                Bounce,
                BackwardWhirl,
                Pinned,
                SensorFault,
                HandedBack,
            ],
        ),
        (
            SensorFault,
            &[
                Levitated,
                Approach,
                Bounce,
                BackwardWhirl,
                Pinned,
                Handover,
                HandedBack,
            ],
        ),
        (HandedBack, &[Levitated]),
    ]
};

/// The ways from mode to mode that the state machine has, one by one.
pub fn ways() -> impl Iterator<Item = (Mode, Mode)> {
    (WAYS.iter()).flat_map(|(from, tos)| tos.iter().map(|to| (*from, *to)))
}

/// Counts of ticks by the mode before and after them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Coverage {
    ticks: [[u64; MODES.len()]; MODES.len()],
}

impl Coverage {
    /// Takes a tick in.
    pub fn add(&mut self, before: Mode, after: Mode) {
        self.ticks[before as usize][after as usize] += 1;
    }

    /// Adds what another has counted.
    pub fn merge(&mut self, other: &Self) {
        for (own, row) in self.ticks.iter_mut().zip(&other.ticks) {
            for (own, count) in own.iter_mut().zip(row) {
                *own += count;
            }
        }
    }

    /// Ticks that ended in a mode.
    pub(crate) fn of_mode(&self, mode: Mode) -> u64 {
        self.ticks.iter().map(|row| row[mode as usize]).sum()
    }

    /// Ticks from one mode to another.
    pub(crate) fn of_way(&self, from: Mode, to: Mode) -> u64 {
        self.ticks[from as usize][to as usize]
    }

    /// Ways of [`ways`] that have no tick.
    pub fn missing_ways(&self) -> Vec<(Mode, Mode)> {
        ways()
            .filter(|(from, to)| self.of_way(*from, *to) == 0)
            .collect()
    }

    /// Ways that were taken and are not among [`ways`].
    pub fn unknown_ways(&self) -> Vec<(Mode, Mode)> {
        let known = |from: Mode, to: Mode| from == to || ways().any(|way| way == (from, to));
        let pairs = MODES
            .into_iter()
            .flat_map(|from| MODES.map(|to| (from, to)));
        pairs
            .filter(|(from, to)| self.of_way(*from, *to) > 0 && !known(*from, *to))
            .collect()
    }
}
