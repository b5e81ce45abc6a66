//! What the supervisor did in a run, in figures.

use crate::run::trace::{ReadOut, Said, Trace, TraceRow};
use serde::Serialize;
use supervisor::{Events, Mode};

/// What the supervisor did, from what it said at every sample.
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
    /// Times that it gave the bearing back to the levitation controller, as it came no farther.
    pub handed_back: u64,
    /// Sensor faults.
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
    /// Checksum of the flight record, where one was frozen.
    pub flight_record_crc: Option<u32>,
}

impl Supervision {
    /// Of a run; `None` without a supervisor.
    pub fn of(trace: &Trace) -> Option<Self> {
        let samples = trace.rows.iter().filter(|row| !row.mode_change);
        let said: Vec<(f64, Said)> = samples.filter_map(told).collect();
        if said.is_empty() {
            return None;
        }
        let count = |event: Events| {
            let having = said.iter().filter(|(_, s)| s.events.contains(event));
            having.count() as u64
        };
        let engaged = |(_, s): &&(f64, Said)| s.events.contains(Events::ENGAGED);
        // The last row is none: nothing follows it.
        let spans = said.windows(2).filter(|w| acts(w[0].1.mode));
        let mut longest_s = 0.0_f64;
        let mut since_s = None;
        for (t_s, said) in &said {
            let began_s = *since_s.get_or_insert(*t_s);
            longest_s = longest_s.max(t_s - began_s);
            if !acts(said.mode) {
                since_s = None;
            }
        }
        let severities = said.iter().map(|(_, s)| widened(s.severity));
        Some(Self {
            engagements: count(Events::ENGAGED),
            first_engaged_s: said.iter().find(engaged).map(|(t_s, _)| *t_s),
            // A sum of nothing is −0.
            engaged_s: spans.map(|w| w[1].0 - w[0].0).fold(0.0, |a, b| a + b),
            longest_engagement_s: longest_s,
            handed_back: count(Events::HANDED_BACK),
            sensor_faults: count(Events::SENSOR_FAULT),
            expected_severity_max: severities.fold(0.0, f64::max),
            account: trace.read_out.as_ref().map(Account::of),
        })
    }
}

/// Whether the supervisor has the bearing in a mode, alone or in part.
pub fn acts(mode: Mode) -> bool {
    !matches!(mode, Mode::Levitated | Mode::HandedBack)
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
            flight_record_crc: read_out.flight_record.as_ref().map(|record| record.crc),
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
    /// What it said.
    pub said: Said,
    /// Touches since the one before, this sample not counted, that changed nothing.
    pub touches_before: u64,
}

/// What happened in a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Happenings {
    /// In time order.
    pub all: Vec<Happening>,
    /// Touches after the last of them that changed nothing.
    pub touches_after: u64,
}

/// Touching and leaving: too many to be told one by one.
const EVERYDAY: Events = Events::TOUCHED.union(Events::LIFTED_OFF);

impl Happenings {
    /// Changes of mode, and every event but touches and lift-offs that change nothing; of those the touches are counted.
    pub fn of(trace: &Trace) -> Self {
        let mut before = Mode::Levitated;
        let mut happenings = Self::default();
        for (t_s, said) in trace.rows.iter().filter_map(told) {
            let touches = &mut happenings.touches_after;
            let other = !(said.events - EVERYDAY).is_empty();
            let changed = std::mem::replace(&mut before, said.mode) != said.mode;
            if other || changed {
                let touches_before = std::mem::take(touches);
                happenings.all.push(Happening {
                    t_s,
                    said,
                    touches_before,
                });
            } else if said.events.contains(Events::TOUCHED) {
                *touches += 1;
            }
        }
        happenings
    }
}

fn told(row: &TraceRow) -> Option<(f64, Said)> {
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
            supervisor: Some(Said {
                mode,
                limits: Limits::empty(),
                events,
                severity: 0.25 * tick as f32,
                levitation_n: [0.0; 2],
            }),
            ..fixture::row(tick as f64, false)
        }
    }

    fn trace(said: &[(Mode, Events)]) -> Trace {
        let rows = said.iter().enumerate();
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
        let happenings = Happenings::of(&trace);
        let told: Vec<(f64, u64)> = (happenings.all.iter())
            .map(|h| (h.t_s, h.touches_before))
            .collect();
        assert_eq!(told, [(1.0, 0), (5.0, 2), (6.0, 0), (7.0, 0)]);
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
