//! What the supervisor did in a run, in figures.

use crate::trace::{Said, Trace, TraceRow};
use serde::Serialize;
use supervisor::{Events, Mode};

/// What the supervisor did, from what it said at every sample and from its own report. Speeds are its estimates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Supervision {
    /// Times that it took over from the levitation controller.
    pub engagements: u64,
    /// When it did so first \[s\].
    pub first_engaged_s: Option<f64>,
    /// Time in which it had the bearing, alone or in part \[s\].
    pub engaged_time_s: f64,
    /// Sensor faults.
    pub sensor_faults: u64,
    /// Highest severity that it expected before a contact, a share of what the cap can stop.
    pub expected_severity_max: f64,
    /// Engagements in which the rotor touched; `None`, as below, where the supervisor could not be asked.
    pub landings: Option<u32>,
    /// Fastest normal speed before an impact \[m/s\].
    pub impact_speed_max_m_s: Option<f32>,
    /// Fastest backward speed in contact \[m/s\].
    pub backward_speed_max_m_s: Option<f32>,
    /// Highest backward speed that the cap can arrest \[m/s\].
    pub whirl_limit_m_s: Option<f32>,
    /// Energy of all impacts and of friction on the whirl over the energy at that limit.
    pub severity_index: Option<f32>,
    /// Whether it asks for coasting down at the end.
    pub coast_down: Option<bool>,
}

/// A sample at which something happened, or the mode changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Happening {
    /// When \[s\].
    pub t_s: f64,
    /// What it said.
    pub said: Said,
    /// Touches since the one before, this one included.
    pub touches: u64,
}

impl Happening {
    /// Names of its limits.
    pub fn limits(&self) -> String {
        names(self.said.limits.iter_names())
    }

    /// Names of its events, with the number of touches where there was more than one.
    pub fn events(&self) -> String {
        let events = names(self.said.events.iter_names());
        match self.touches {
            0 | 1 => events,
            touches => format!("{events} ({touches} touches)"),
        }
    }
}

impl Supervision {
    /// Of a run; `None` without a supervisor.
    pub fn of(trace: &Trace) -> Option<Self> {
        let samples = trace.rows.iter().filter(|row| !row.mode_change);
        let said: Vec<(f64, Said)> = samples
            .filter_map(|row| Some((row.plant.t_s, row.supervisor?)))
            .collect();
        if said.is_empty() {
            return None;
        }
        let count = |event: Events| {
            let having = said.iter().filter(|(_, s)| s.events.contains(event));
            having.count() as u64
        };
        let engaged = |(_, s): &&(f64, Said)| s.events.contains(Events::ENGAGED);
        // The last row is none: nothing follows it.
        let spans = said.windows(2).filter(|w| w[0].1.mode != Mode::Levitated);
        let severities = said.iter().map(|(_, s)| f64::from(s.severity));
        let report = trace.read_out.as_ref().map(|r| r.report);
        Some(Self {
            engagements: count(Events::ENGAGED),
            first_engaged_s: said.iter().find(engaged).map(|(t_s, _)| *t_s),
            engaged_time_s: spans.map(|w| w[1].0 - w[0].0).sum(),
            sensor_faults: count(Events::SENSOR_FAULT),
            expected_severity_max: severities.fold(0.0, f64::max),
            landings: report.map(|r| r.landings),
            impact_speed_max_m_s: report.map(|r| r.impact_speed_max_m_s),
            backward_speed_max_m_s: report.map(|r| r.backward_speed_max_m_s),
            whirl_limit_m_s: report.map(|r| r.whirl_limit_m_s),
            severity_index: report.map(|r| r.severity_index),
            coast_down: report.map(|r| r.coast_down),
        })
    }
}

/// Names of flags, in one string.
pub(crate) fn names<F>(flags: impl Iterator<Item = (&'static str, F)>) -> String {
    flags.map(|(name, _)| name).collect::<Vec<_>>().join(" ")
}

/// Touching and leaving: too many to be told one by one.
const EVERYDAY: Events = Events::TOUCHED.union(Events::LIFTED_OFF);

/// What happened in a run, in time order: changes of mode, and every event but touches and lift-offs that change
/// nothing, which are counted.
pub fn happenings(trace: &Trace) -> Vec<Happening> {
    let mut before: Option<Mode> = None;
    let mut touches = 0;
    let mut happenings = Vec::new();
    let told = |row: &TraceRow| Some((row.plant.t_s, row.supervisor?));
    for (t_s, said) in trace.rows.iter().filter_map(told) {
        touches += u64::from(said.events.contains(Events::TOUCHED));
        let other = !(said.events - EVERYDAY).is_empty();
        let changed = before.replace(said.mode) != Some(said.mode);
        if other || changed {
            let touches = std::mem::take(&mut touches);
            happenings.push(Happening { t_s, said, touches });
        }
    }
    happenings
}
