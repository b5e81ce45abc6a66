//! Both ends of one rotor: a supervisor for each bearing plane, and what firmware joins of them.
//!
//! Neither knows of the other: what the other end does reaches it as a load, which its observer estimates. Of the
//! whole machine are who has engaged, the request to coast down, and the records of one event.

use supervisor::{Command, Config, ConfigError, Events, Record, Sample, Supervisor};

/// Two supervisors with flight records of `RECORD` ticks each.
#[derive(Debug, Clone)]
pub struct TwoPlanes<const RECORD: usize> {
    planes: [Supervisor<RECORD>; 2],
    /// Planes that have engaged since the records were read.
    engaged: [bool; 2],
    coast_down: bool,
}

/// What both commanded at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairCommand {
    /// For each plane its own.
    pub planes: [Command; 2],
    /// For each plane, whether the other one has engaged since the records were read: hold back what would disturb
    /// now (excitation, a set-down, a reconfiguration). Its supervisor needs no telling.
    pub other_engaged: [bool; 2],
    /// One plane has asked for the machine to be run down. Stays until [`TwoPlanes::new`].
    pub coast_down: bool,
}

impl<const RECORD: usize> TwoPlanes<RECORD> {
    /// Both start levitated.
    ///
    /// # Errors
    /// The first parameter that is outside its range, of the first plane that has one.
    pub fn new([drive, other]: &[Config; 2]) -> Result<Self, ConfigError> {
        Ok(Self {
            planes: [Supervisor::new(drive)?, Supervisor::new(other)?],
            engaged: [false; 2],
            coast_down: false,
        })
    }

    /// One tick of both, in the control interrupt. Both samples carry the number of one counter.
    pub fn tick(&mut self, [at_drive, at_other]: &[Sample; 2]) -> PairCommand {
        let [drive, other] = &mut self.planes;
        let planes = [drive.tick(at_drive), other.tick(at_other)];
        for (engaged, command) in self.engaged.iter_mut().zip(&planes) {
            *engaged |= command.events.contains(Events::ENGAGED);
            self.coast_down |= command.events.contains(Events::COAST_DOWN);
        }
        let [drive, other] = self.engaged;
        PairCommand {
            planes,
            other_engaged: [other, drive],
            coast_down: self.coast_down,
        }
    }

    /// The records of one event, in the background: once every plane that engaged has frozen its own, `write` gets
    /// what there is with the number of its plane, 0 or 1, and both wait for the next engagement.
    ///
    /// A plane that engages while the other's record waits delays the reading, and is then in it. The tick has to be
    /// kept out meanwhile; where writing takes too long for that, copy the entries of a frozen record in pieces and
    /// rearm at the end.
    pub fn collect(&mut self, mut write: impl FnMut(usize, &Record<'_, RECORD>)) {
        let mut planes = self.planes.iter().zip(self.engaged);
        let pending = planes.any(|(plane, engaged)| engaged && plane.record().is_none());
        if pending || !self.engaged.contains(&true) {
            return;
        }
        for (end, plane) in self.planes.iter().enumerate() {
            if let Some(record) = plane.record() {
                write(end, &record);
            }
        }
        self.planes.iter_mut().for_each(Supervisor::rearm);
        self.engaged = [false; 2];
    }

    /// Supervisor of a plane, for its report and events; 0 or 1, and for anything else the second.
    pub fn plane(&mut self, end: usize) -> &mut Supervisor<RECORD> {
        let [drive, other] = &mut self.planes;
        if end == 0 { drive } else { other }
    }
}
