//! What the supervisor did in a run, in figures.

use crate::run::columns::{Cell, Column, Columnar, below, columnar, columns_of};
use crate::run::trace::{ReadOut, Recorder, SupervisorTrace, Trace, TraceRow};
use serde::Serialize;
use supervisor::{Events, Mode};

/// What the supervisor did, from its answers to every sample.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Supervision {
    /// Times that it took over from the levitation controller.
    pub engagements: u64,
    /// When it did so first \[s\].
    pub first_engaged_s: Option<f64>,
    /// Time in which it had the bearing, alone or in part \[s\].
    pub engaged_s: f64,
    /// The longest without a break \[s\].
    pub longest_engagement_s: f64,
    /// Times that it gave the bearing back to the levitation controller, as it made no progress.
    pub handed_back: u64,
    pub sensor_faults: u64,
    /// Highest severity that it expected, a share of what the cap can stop.
    pub expected_severity_max: f64,
    /// Its own account, where it could be asked for one.
    #[serde(flatten)]
    pub account: Option<Account>,
}

/// The supervisor's own account: what it has seen and estimated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Account {
    /// Engagements in which the rotor touched.
    pub landings: u32,
    /// Engagements in which it did not.
    pub nuisance_engagements: u32,
    /// Fastest normal speed before an impact \[m/s\].
    pub impact_speed_max_m_s: f64,
    /// Fastest backward speed in contact \[m/s\].
    pub backward_speed_max_m_s: f64,
    /// Highest backward speed that the cap can arrest \[m/s\].
    pub whirl_limit_m_s: f64,
    /// Energy of all impacts and of friction on the whirl over the energy at that limit.
    pub severity_index: f64,
    /// Whether it asks for coasting down at the end.
    pub coast_down: bool,
    /// Outcome of the check of its configuration.
    pub checked: &'static str,
    /// Checksum of all bytes of the flight record, where one was frozen.
    pub flight_record_crc: Option<u32>,
}

columnar!(Supervision {
    engagements, first_engaged_s, engaged_s, longest_engagement_s, handed_back, sensor_faults, expected_severity_max;
    .. account
});
columnar!(Account {
    landings,
    nuisance_engagements,
    impact_speed_max_m_s,
    backward_speed_max_m_s,
    whirl_limit_m_s,
    severity_index,
    coast_down,
    checked,
    flight_record_crc
});

/// Counts what the supervisor does while a run goes on.
#[derive(Debug, Clone, Default)]
pub struct SupervisionCount {
    /// The last sample and the mode after it.
    last: Option<(f64, Mode)>,
    /// Since when it has had the bearing, or the last sample without it.
    since_s: Option<f64>,
    engagements: u64,
    first_engaged_s: Option<f64>,
    engaged_s: f64,
    longest_engagement_s: f64,
    handed_back: u64,
    sensor_faults: u64,
    expected_severity_max: f32,
}

impl Recorder for SupervisionCount {
    fn row(&mut self, row: &TraceRow) {
        let Some((t_s, supervisor)) = supervisor_row(row).filter(|_| !row.mode_change) else {
            return;
        };
        if let Some((before_s, mode)) = self.last.replace((t_s, supervisor.mode))
            && mode.is_engaged()
        {
            self.engaged_s += t_s - before_s;
        }
        let began_s = *self.since_s.get_or_insert(t_s);
        self.longest_engagement_s = self.longest_engagement_s.max(t_s - began_s);
        if !supervisor.mode.is_engaged() {
            self.since_s = None;
        }
        let count = |event: Events| u64::from(supervisor.events.contains(event));
        self.engagements += count(Events::ENGAGED);
        self.handed_back += count(Events::HANDED_BACK);
        self.sensor_faults += count(Events::SENSOR_FAULT);
        if supervisor.events.contains(Events::ENGAGED) {
            self.first_engaged_s.get_or_insert(t_s);
        }
        self.expected_severity_max = self.expected_severity_max.max(supervisor.severity);
    }
}

impl SupervisionCount {
    /// At the end of the run; `None` without a supervisor.
    pub fn ended(&self, read_out: Option<&ReadOut>) -> Option<Supervision> {
        self.last?;
        Some(Supervision {
            engagements: self.engagements,
            first_engaged_s: self.first_engaged_s,
            engaged_s: self.engaged_s,
            longest_engagement_s: self.longest_engagement_s,
            handed_back: self.handed_back,
            sensor_faults: self.sensor_faults,
            expected_severity_max: widened(self.expected_severity_max),
            account: read_out.map(Account::of),
        })
    }
}

impl Supervision {
    /// Of a run that is kept; `None` without a supervisor.
    pub fn of(trace: &Trace) -> Option<Self> {
        let mut count = SupervisionCount::default();
        trace.rows.iter().for_each(|row| count.row(row));
        count.ended(trace.read_out.as_ref())
    }
}

impl Account {
    fn of(read_out: &ReadOut) -> Self {
        let report = &read_out.report;
        Self {
            landings: report.landings,
            nuisance_engagements: report.nuisance_engagements,
            impact_speed_max_m_s: widened(report.impact_speed_max_m_s),
            backward_speed_max_m_s: widened(report.backward_speed_max_m_s),
            whirl_limit_m_s: widened(report.whirl_limit_m_s),
            severity_index: widened(report.severity_index),
            coast_down: report.coast_down,
            checked: report.checked.finding.name(),
            flight_record_crc: read_out.flight_record.as_deref().map(supervisor::crc_of),
        }
    }
}

/// The number that reads the same.
fn widened(x: f32) -> f64 {
    x.to_string().parse().unwrap_or(f64::from(x))
}

/// A sample at which something happened, or the mode changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Happening {
    /// When \[s\].
    pub t_s: f64,
    /// The supervisor's answer.
    pub supervisor: SupervisorTrace,
    /// Touches since the one before, this sample not counted, that changed nothing.
    pub touches_before: u64,
}

/// What happened in a run: changes of mode, and every event but touches and lift-offs that change nothing; of those the touches
/// are counted.
#[derive(Debug, Clone, PartialEq)]
pub struct Happenings {
    /// In time order, the first [`Happenings::MOST`].
    pub all: Vec<Happening>,
    /// How many came after these.
    pub more: u64,
    /// Touches after the last of all that changed nothing.
    pub touches_after: u64,
    mode: Mode,
}

impl Default for Happenings {
    fn default() -> Self {
        Self {
            all: Vec::new(),
            more: 0,
            touches_after: 0,
            mode: Mode::Levitated,
        }
    }
}

/// Touching and leaving: too many to be listed one by one.
const EVERYDAY: Events = Events::TOUCHED.union(Events::LIFTED_OFF);

impl Happenings {
    /// So many are listed; what comes after them is in the trace.
    pub const MOST: usize = 100;
}

impl Recorder for Happenings {
    fn row(&mut self, row: &TraceRow) {
        let Some((t_s, supervisor)) = supervisor_row(row) else {
            return;
        };
        let other = !(supervisor.events - EVERYDAY).is_empty();
        let changed = std::mem::replace(&mut self.mode, supervisor.mode) != supervisor.mode;
        if other || changed {
            let touches_before = std::mem::take(&mut self.touches_after);
            let happening = Happening {
                t_s,
                supervisor,
                touches_before,
            };
            match self.all.len() < Self::MOST {
                true => self.all.push(happening),
                false => self.more += 1,
            }
        } else if supervisor.events.contains(Events::TOUCHED) {
            self.touches_after += 1;
        }
    }
}

fn supervisor_row(row: &TraceRow) -> Option<(f64, SupervisorTrace)> {
    Some((row.plant.t_s, row.supervisor?))
}

/// Names of flags, in one string.
pub fn names<F>(flags: impl Iterator<Item = (&'static str, F)>) -> String {
    flags.map(|(name, _)| name).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;
    use supervisor::Limits;

    fn row(tick: usize, mode: Mode, events: Events) -> TraceRow {
        TraceRow {
            supervisor: Some(SupervisorTrace {
                mode,
                limits: Limits::empty(),
                events,
                severity: 0.25 * tick as f32,
                levitation_n: [0.0; 2],
                stimulus_n: [0.0; 2],
            }),
            ..fixture::row(tick as f64, false)
        }
    }

    fn trace(answers: &[(Mode, Events)]) -> Trace {
        let rows = answers.iter().enumerate();
        Trace {
            rows: rows
                .map(|(tick, (mode, events))| row(tick, *mode, *events))
                .collect(),
            read_out: None,
        }
    }

    #[test]
    fn every_touch_is_told_or_counted() {
        use Events as E;
        let trace = trace(&[
            (Mode::Levitated, E::empty()),
            (Mode::Bounce, E::ENGAGED | E::TOUCHED),
            (Mode::Bounce, E::LIFTED_OFF),
            (Mode::Bounce, E::TOUCHED),
            (Mode::Bounce, E::TOUCHED),
            (Mode::Pinned, E::TOUCHED | E::PINNED),
            (Mode::Pinned, E::LATE),
            (Mode::Bounce, E::LIFTED_OFF),
            (Mode::Bounce, E::TOUCHED),
        ]);
        let mut happenings = Happenings::default();
        trace.rows.iter().for_each(|row| happenings.row(row));
        let listed: Vec<(f64, u64)> = (happenings.all.iter())
            .map(|h| (h.t_s, h.touches_before))
            .collect();
        assert_eq!(listed, [(1.0, 0), (5.0, 2), (6.0, 0), (7.0, 0)]);
        assert_eq!(happenings.touches_after, 1);
    }

    #[test]
    fn figures_are_of_samples() {
        let mut trace = trace(&[
            (Mode::Levitated, Events::empty()),
            (Mode::Approach, Events::ENGAGED),
            (Mode::Handover, Events::HANDOVER),
            (Mode::Levitated, Events::LEVITATED),
            (Mode::Approach, Events::ENGAGED),
        ]);
        let between = TraceRow {
            mode_change: true,
            ..trace.rows[1]
        };
        trace.rows.insert(2, between);
        let s = Supervision::of(&trace).unwrap();
        // Nothing follows the last row, and a row between samples is none.
        assert_eq!((s.engagements, s.engaged_s), (2, 2.0));
        assert_eq!(
            (s.first_engaged_s, s.expected_severity_max),
            (Some(1.0), 1.0)
        );
        assert!(s.account.is_none());
        assert!(Supervision::of(&Trace::default()).is_none());
        let never = Supervision::of(&self::trace(&[(Mode::Levitated, Events::empty())])).unwrap();
        assert!(never.engaged_s.is_sign_positive());
    }
}
