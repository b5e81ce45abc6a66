//! What a record says in plain words: the event, and what speaks for or against running on.

use crate::record::file::{PlaneRecord, RecordFile};
use crate::record::replay::{NoReplay, Replay, replay};
use firmware_image::wire::mode_of;
use serde::Serialize;
use std::f64::consts::TAU;
use supervisor::{Config, Mode, Summary};

/// What came of an event, of one plane or of all planes of a rotor together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Told {
    /// `levitated` where the levitation controller has the bearing again, else what the supervisor was doing when the record
    /// froze; `coast down` where it asked for that, `bearing off` where the bearing was switched off.
    pub outcome: &'static str,
    pub touches: u32,
    /// Time in contact \[s\].
    pub contact_s: f64,
    /// Fastest normal speed before an impact \[m/s\].
    pub hardest_impact_m_s: f64,
    /// Fastest backward motion in contact as turns round the clearance \[Hz\].
    pub max_whirl_hz: f64,
    /// The same over what the force can arrest.
    pub whirl_share: f64,
    /// Whether backward whirl was recognised.
    pub whirled: bool,
    /// By how much the severity index has risen, what it has come to, and what asks for coasting down.
    pub severity: f64,
    /// See `severity`.
    pub severity_index: f64,
    /// See `severity`.
    pub severity_limit: f64,
    /// Landings since the supervisor was made.
    pub landings: u32,
    /// Whether coasting down was asked for.
    pub coast_down: bool,
}

/// What speaks for or against running on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing against it.
    RunOn,
    /// Much of what the retainer bearing may bear is used up.
    Plan,
    /// The event was not over, or not by the supervisor's doing.
    Look,
    /// All of it is used up.
    Inspect,
}

impl Verdict {
    pub fn sentence(self) -> &'static str {
        match self {
            Self::RunOn => "Nothing speaks against running on.",
            Self::Plan => {
                "More than half of what the retainer bearing may bear is used up: plan its inspection."
            }
            Self::Look => "Look at the machine before it runs on.",
            Self::Inspect => {
                "The retainer bearing has borne what it is allowed: inspect it before the machine runs on."
            }
        }
    }
}

/// An event: the record of one plane, or those of both planes of a rotor.
#[derive(Debug)]
pub struct Event<'a> {
    pub records: Vec<&'a PlaneRecord>,
    /// What its ticks come to once more.
    pub replay: Result<Replay, NoReplay>,
}

impl RecordFile {
    /// Events in the order of the file.
    pub fn events(&self) -> Vec<Event<'_>> {
        let mut of: Vec<Vec<&PlaneRecord>> = Vec::new();
        for record in &self.records {
            let belongs = |event: &Vec<&PlaneRecord>| {
                let first = event[0];
                let of = |r: &PlaneRecord| (r.head.planes, r.head.closed_at, r.head.ticks);
                let apart = first.shaft.zip(record.shaft).is_some_and(|(a, b)| a != b);
                first.head.planes > 1
                    && of(first) == of(record)
                    && !apart
                    && event.iter().all(|r| r.head.plane != record.head.plane)
            };
            match of.iter_mut().find(|event| belongs(event)) {
                Some(event) => event.push(record),
                None => of.push(vec![record]),
            }
        }
        of.into_iter()
            .map(|mut records| {
                records.sort_by_key(|r| r.head.plane);
                let replay = replay(&records);
                Event { records, replay }
            })
            .collect()
    }
}

impl PlaneRecord {
    /// What came of the event here; `None` where that is not whole.
    pub fn told(&self) -> Option<Told> {
        let (summary, config) = (self.summary.as_ref()?, self.config.as_ref()?);
        let whirls = |modes: u16| modes & 1 << Mode::BackwardWhirl as u16 != 0;
        let whirled = self.track.iter().any(|stretch| whirls(stretch.modes))
            || (self.entries.values()).any(|entry| entry.mode == Mode::BackwardWhirl as u8);
        Some(Told::new(summary, config, whirled))
    }
}

impl Told {
    fn new(summary: &Summary, config: &Config, whirled: bool) -> Self {
        let wide = |x: f32| f64::from(x);
        let backward = wide(summary.backward_speed_max_m_s);
        Self {
            outcome: match u8::try_from(summary.mode).ok().and_then(mode_of) {
                _ if summary.coast_down => "coast down",
                _ if !summary.bearing_on => "bearing off",
                Some(mode) => mode.name(),
                None => "unknown",
            },
            touches: summary.touches,
            contact_s: f64::from(summary.contact_ticks) * wide(config.sample_period_s),
            hardest_impact_m_s: wide(summary.hardest_impact_m_s),
            max_whirl_hz: backward / (TAU * wide(config.clearance_m)),
            whirl_share: backward / wide(summary.whirl_limit_m_s),
            whirled,
            severity: wide(summary.severity),
            severity_index: wide(summary.severity_index),
            severity_limit: wide(config.severity_limit),
            landings: summary.landings,
            coast_down: summary.coast_down,
        }
    }

    /// Of two planes of one machine: what is worse of both.
    fn with(self, other: Self) -> Self {
        let worse = if self.outcome == Mode::Levitated.name() {
            other.outcome
        } else {
            self.outcome
        };
        let closer = self.severity_index / self.severity_limit
            >= other.severity_index / other.severity_limit;
        let (severity, severity_index, severity_limit) = if closer {
            (self.severity, self.severity_index, self.severity_limit)
        } else {
            (other.severity, other.severity_index, other.severity_limit)
        };
        Self {
            outcome: if self.coast_down || other.coast_down {
                "coast down"
            } else {
                worse
            },
            touches: self.touches + other.touches,
            contact_s: self.contact_s.max(other.contact_s),
            hardest_impact_m_s: self.hardest_impact_m_s.max(other.hardest_impact_m_s),
            max_whirl_hz: self.max_whirl_hz.max(other.max_whirl_hz),
            whirl_share: self.whirl_share.max(other.whirl_share),
            whirled: self.whirled || other.whirled,
            severity,
            severity_index,
            severity_limit,
            landings: self.landings.max(other.landings),
            coast_down: self.coast_down || other.coast_down,
        }
    }

    /// What speaks for or against running on. `used`: share of what the retainer bearing may bear that its ledger says is used up; 0
    /// without.
    pub fn verdict(&self, used: f64) -> Verdict {
        let used = used.max(self.severity_index / self.severity_limit);
        if self.coast_down || used >= 1.0 {
            Verdict::Inspect
        } else if self.outcome != "levitated" {
            Verdict::Look
        } else if used >= 0.5 {
            Verdict::Plan
        } else {
            Verdict::RunOn
        }
    }

    /// The event in a few sentences, the last of them the verdict.
    pub fn paragraph(&self, used: f64) -> String {
        format!("{} {}", self.sentences(), self.verdict(used).sentence())
    }

    /// What happened, without the verdict.
    pub fn sentences(&self) -> String {
        let touches = match self.touches {
            0 => "No touch".to_owned(),
            1 => "One touch".to_owned(),
            n => format!("{n} touches"),
        };
        let impacts = if self.touches > 0 {
            format!(
                ", hardest {:.2} m/s, {:.1} ms in contact",
                self.hardest_impact_m_s,
                1e3 * self.contact_s
            )
        } else {
            String::new()
        };
        let whirl = if self.whirled {
            format!(
                "backward whirl of up to {:.0} Hz, {:.0} % of what the force arrests",
                self.max_whirl_hz,
                100.0 * self.whirl_share
            )
        } else {
            format!(
                "no whirl (fastest backward motion {:.0} % of what the force arrests)",
                100.0 * self.whirl_share
            )
        };
        let end = match self.outcome {
            "levitated" => "the levitation controller has the bearing again".to_owned(),
            "coast down" => "the supervisor asked for coasting down".to_owned(),
            "handed back" => "the supervisor made no progress and gave the bearing back".to_owned(),
            "bearing off" => "the bearing was switched off".to_owned(),
            mode => format!("it was not over when the record was full ({mode})"),
        };
        format!(
            "{touches}{impacts}; {whirl}; {end}. Severity {:.2}; with earlier events {:.2} of the {:.0} at which coasting down is asked for.",
            self.severity, self.severity_index, self.severity_limit
        )
    }
}

impl Event<'_> {
    /// What came of it; `None` where that is not whole, or not there of all planes.
    pub fn told(&self) -> Option<Told> {
        if self.records.len() < self.records.first()?.head.planes as usize {
            return None;
        }
        let told = self.records.iter().map(|record| record.told());
        let all: Option<Vec<Told>> = told.collect();
        all?.into_iter().reduce(Told::with)
    }
}
