//! How many landings a retainer bearing may still bear, by its ledger or, without one, by what the record itself has counted.

use crate::record::narrative::{Event, percent};
use serde::Serialize;
use supervisor::{LEDGER_BYTES, Ledger, LedgerError};

/// Why the ledgers of a machine cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LedgersError {
    /// Another length than that of so many ledgers.
    #[error(
        "it has {bytes} bytes; a ledger has {LEDGER_BYTES}, and the record is of {planes} retainer bearings"
    )]
    Length {
        /// Bytes of the file.
        bytes: usize,
        /// Planes of the record.
        planes: usize,
    },
    /// One of them is not whole, or none.
    #[error("plane {plane}: {error}")]
    Ledger {
        plane: usize,
        /// What is wrong.
        error: LedgerError,
    },
}

/// The ledgers of a machine's planes, one after the other.
///
/// # Errors
/// [`LedgersError`]; then there are no figures.
pub fn ledgers(bytes: &[u8], planes: usize) -> Result<Vec<Ledger>, LedgersError> {
    if bytes.len() != planes * LEDGER_BYTES {
        let bytes = bytes.len();
        return Err(LedgersError::Length { bytes, planes });
    }
    let blocks = bytes.chunks(LEDGER_BYTES).enumerate();
    blocks
        .map(|(plane, block)| {
            Ledger::from_bytes(block).map_err(|error| LedgersError::Ledger { plane, error })
        })
        .collect()
}

/// Where the counts of a bearing come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Counted {
    /// Its ledger: since it was fitted.
    Ledger,
    /// The record: since the supervisor was made.
    Record,
}

/// A retainer bearing, and how many landings it may still bear.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Remaining {
    /// Plane of the machine.
    pub plane: u32,
    /// Where the counts come from.
    pub counted_by: Counted,
    /// The user's number of the bearing, from the ledger.
    pub bearing: Option<u32>,
    /// Landings, with the sum of their severities.
    pub landings: u32,
    /// See `landings`.
    pub severity_sum: f64,
    /// Severity that it may bear in all.
    pub severity_allowed: f64,
    /// Largest severity of a landing, from the ledger.
    pub worst_severity: Option<f64>,
    /// Fastest normal speed before an impact \[m/s\], from the ledger.
    pub hardest_impact_m_s: Option<f64>,
    /// Whether all of this event was seen: what happened while the position was unknown is in no count.
    pub seen: bool,
    /// Whether the last record in the ledger is this one.
    pub has_this_event: Option<bool>,
    /// Landings that it may still bear: such as this event, …
    pub left_like_this: Option<u32>,
    pub left_like_the_mean: Option<u32>,
    pub left_like_the_worst: Option<u32>,
}

impl Remaining {
    /// Of each plane of an event, as far as it is known; `ledgers`: none, or one for each plane of the machine; `allowed`: of each
    /// plane another severity that its bearing may bear in all than the ledger, or the configuration, has.
    pub fn of(event: &Event<'_>, ledgers: &[Ledger], allowed: &[Option<f32>]) -> Vec<Self> {
        let records = event.records.iter().zip(&event.unknown);
        let all = records.filter_map(|(record, unknown)| {
            let seen = !unknown.iter().any(|stretch| stretch.serious);
            let plane = record.head.plane;
            let kept = ledgers.get(plane as usize).copied();
            let summary = record.summary;
            let mut ledger = match kept {
                Some(kept) => kept,
                None => {
                    let mut ledger = Ledger::new(0, record.config?.severity_limit);
                    ledger.add(&summary?, record.head.closed_at);
                    ledger
                }
            };
            if let Some(allowed) = allowed.get(plane as usize).copied().flatten() {
                ledger.severity_allowed = allowed;
            }
            let mean = ledger.severity_sum() / ledger.landings as f32;
            Some(Self {
                plane,
                counted_by: match kept {
                    Some(_) => Counted::Ledger,
                    None => Counted::Record,
                },
                bearing: kept.map(|kept| kept.bearing),
                landings: ledger.landings,
                severity_sum: ledger.severity_sum().into(),
                severity_allowed: ledger.severity_allowed.into(),
                worst_severity: kept.map(|kept| kept.worst_severity.into()),
                hardest_impact_m_s: kept.map(|kept| kept.hardest_impact_m_s.into()),
                seen,
                has_this_event: kept
                    .map(|kept| kept.updates > 0 && kept.closed_at == record.head.closed_at),
                left_like_this: (summary.filter(|_| seen))
                    .and_then(|s| ledger.landings_left(s.severity)),
                left_like_the_mean: ledger.landings_left(mean),
                left_like_the_worst: kept.and_then(|_| ledger.landings_left(ledger.worst_severity)),
            })
        });
        all.collect()
    }

    /// Share of what the bearing may bear that is used up, by the rule of Palmgren and Miner.
    pub fn used(&self) -> f64 {
        match self.severity_sum {
            0.0 => 0.0,
            sum => sum / self.severity_allowed,
        }
    }

    /// In two sentences.
    pub fn sentences(&self) -> String {
        let landings = match self.landings {
            1 => "1 landing has".to_owned(),
            n => format!("{n} landings have"),
        };
        let sum = format!(
            "{landings} used {} of what it is allowed (severity {:.2} of {:.0}",
            percent(self.used()),
            self.severity_sum,
            self.severity_allowed
        );
        let mut text = match (self.bearing, self.worst_severity, self.hardest_impact_m_s) {
            (Some(bearing), Some(worst), Some(hardest)) => format!(
                "Retainer bearing {bearing}: {sum}, the worst {worst:.2}), hardest impact {hardest:.2} m/s; {}.",
                match self.has_this_event {
                    Some(true) => "this event is the last one in it",
                    _ => "its last event is another one than this",
                }
            ),
            _ => format!("Retainer bearing, since the supervisor was made: {sum})."),
        };
        let kinds = [
            (self.left_like_the_worst, "the worst"),
            (self.left_like_the_mean, "the mean"),
            (self.left_like_this, "this one"),
        ];
        let left: Vec<String> = (kinds.into_iter())
            .filter_map(|(left, kind)| Some(format!("{} like {kind}", left?)))
            .collect();
        if !left.is_empty() {
            text += &format!(" Room for landings: {}.", left.join(", "));
        }
        if !self.seen {
            text += " What happened while the position was unknown is not in these figures.";
        }
        text
    }
}
