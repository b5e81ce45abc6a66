//! What a record says in plain words: the event, and what speaks for or against running on.

use crate::record::file::{PlaneRecord, RecordFile};
use crate::record::replay::{NoReplay, Replay, with_refusals};
use crate::record::unknown::{Reason, Refusals, Unknown, has_mode, is_unseen};
use firmware_image::wire::mode_of;
use serde::Serialize;
use std::f64::consts::TAU;
use supervisor::{Config, Entry, Events, Mode, Summary};

/// Outcome of an event, of one plane or of all planes of a rotor together, as far as readings show it that the supervisor
/// believed: what no such reading carries is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Narrative {
    /// `levitated` where the levitation controller has the bearing again, else what the supervisor was doing when the record
    /// froze; `coast down` where it asked for that, `bearing off` where the bearing was switched off, `log ends` where a log does.
    pub outcome: &'static str,
    /// Touches that were seen.
    pub touches: Option<u32>,
    /// Time in contact that was seen \[s\].
    pub contact_s: Option<f64>,
    /// Fastest normal speed before an impact \[m/s\].
    pub hardest_impact_m_s: Option<f64>,
    /// Fastest backward motion in contact as turns round the clearance \[Hz\].
    pub max_whirl_hz: Option<f64>,
    /// The same over what the force can arrest.
    pub whirl_share: Option<f64>,
    /// Whether backward whirl was recognised.
    pub whirled: Option<bool>,
    /// By how much the severity index has risen, as far as it was counted.
    pub severity: Option<f64>,
    /// Its value after the event, and what asks for coasting down.
    pub severity_index: f64,
    /// See `severity_index`.
    pub severity_limit: f64,
    /// Landings since the supervisor was made.
    pub landings: u32,
    /// Whether coasting down was asked for.
    pub coast_down: bool,
    /// For how long the position is unknown, in the plane in which that is longest \[s\].
    pub position_unknown_s: f64,
    /// Why no speed can be given.
    pub speeds_unknown: Option<Doubt>,
    /// The planes in which the position is unknown for some time.
    #[serde(skip)]
    unseen: Vec<Unseen>,
    /// Whether the file has all ticks and the whole slow track.
    #[serde(skip)]
    whole: bool,
}

/// Why readings that the supervisor believed do not give a speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Doubt {
    /// How far out they go \[clearances\], which no retainer bearing allows.
    BeyondClearance(f64),
    /// Their noise \[m\], which is more than was configured.
    NoiseM(f64),
    /// A few between them did not fit the motion of the rotor, as an impact makes some.
    Misfit,
    /// More of them did not.
    Misfits,
}

impl Doubt {
    fn message(self) -> String {
        match self {
            Self::BeyondClearance(radius) => format!(
                "Readings go to {radius:.2} clearances, farther than the retainer bearing lets the rotor go: sensor or clearance is \
                 not as configured, counts are not certain, and speeds are not known"
            ),
            Self::NoiseM(noise_m) => format!(
                "Readings have a noise of {:.1} µm, more than was configured: counts are not certain, and speeds are not known",
                1e6 * noise_m
            ),
            Self::Misfit => {
                "A reading did not fit the motion of the rotor: speeds are not known".to_owned()
            }
            Self::Misfits => "Readings did not fit the motion of the rotor: sensor or model is wrong, counts are not certain, and \
                              speeds are not known"
                .to_owned(),
        }
    }
}

/// Where the position of a plane is unknown.
#[derive(Debug, Clone, PartialEq)]
struct Unseen {
    /// Which, where there are several.
    plane: Option<u32>,
    stretches: Vec<Unknown>,
    throughout: bool,
}

/// What speaks for or against running on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing against it.
    RunOn,
    /// Much of what the retainer bearing may bear is used up.
    Plan,
    /// The event was not over, or not by the supervisor's doing; or where the rotor was is not known throughout.
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
    /// Where the position is unknown, of each record.
    pub unknown: Vec<Vec<Unknown>>,
    /// Whether it is of a log that ends within it, as by a bearing that is off.
    pub log_ends: bool,
}

/// The outcome of an event that its log cuts off.
const LOG_ENDS: &str = "log ends";

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
                let replayed = with_refusals(&records);
                let none = Refusals::new();
                let refusals = |i: usize| replayed.as_ref().ok().and_then(|(_, all)| all.get(i));
                let unknown = (records.iter().enumerate())
                    .map(|(i, record)| record.unknown(refusals(i).unwrap_or(&none)));
                Event {
                    unknown: unknown.collect(),
                    replay: replayed.map(|(replay, _)| replay),
                    records,
                    log_ends: false,
                }
            })
            .collect()
    }
}

impl PlaneRecord {
    /// Its outcome in this plane; `None` where that is not whole. `unknown`: where the position is.
    fn narrative(&self, unknown: &[Unknown]) -> Option<Narrative> {
        let (summary, config) = (self.summary.as_ref()?, self.config.as_ref()?);
        let whirled = (self.track.iter()).any(|stretch| has_mode(stretch, Mode::BackwardWhirl))
            || (self.entries.values()).any(|entry| entry.mode == Mode::BackwardWhirl as u8);
        let unseen = Unseen {
            plane: (self.head.planes > 1).then_some(self.head.plane),
            stretches: unknown.to_vec(),
            throughout: self.is_unseen_throughout(unknown),
        };
        let misfits = || unknown.iter().filter(|stretch| stretch.reason.is_misfit());
        // A sensor with steps repeats a reading by chance now and then.
        let loose = misfits().filter(|s| s.serious || s.reason != Reason::DidNotChange);
        let misfit = match loose.map(|s| s.ticks[1] - s.ticks[0]).sum() {
            _ if self.jumps(summary, config) => Some(Doubt::Misfits),
            0 => None,
            1..=BY_CHANCE if misfits().all(|s| !s.serious) => Some(Doubt::Misfit),
            _ => Some(Doubt::Misfits),
        };
        let doubt = (self
            .beyond_clearance(summary, config)
            .map(Doubt::BeyondClearance))
        .or(self.noise_m(config).map(Doubt::NoiseM))
        .or(misfit);
        let seen = Seen {
            whirled,
            impact: self.impact_was_seen(summary),
            others: self.touches_left_alone(summary),
            unseen,
            doubt,
            whole: self.is_whole(),
        };
        Some(Narrative::new(summary, config, seen))
    }

    /// How far out readings go that the supervisor believed \[clearances\], where no retainer bearing lets the rotor go so far.
    fn beyond_clearance(&self, summary: &Summary, config: &Config) -> Option<f64> {
        let wide = |x: f32| f64::from(x);
        let (mass_kg, clearance_m) = (wide(config.mass_kg), wide(config.clearance_m));
        let backward_m_s = wide(summary.backward_speed_max_m_s);
        // Twice as deep as the hardest impact, the whirl and the whole force press it in.
        let pressed_n = wide(config.force_max_n) + mass_kg * backward_m_s.powi(2) / clearance_m;
        let stiffness_n_m = wide(config.contact_stiffness_n_m);
        let impact_m = wide(summary.hardest_impact_m_s) * (mass_kg / stiffness_n_m).sqrt();
        let depth_m = 2.0 * (impact_m + pressed_n / stiffness_n_m);
        let most = 1.0 + CLEARANCE_ERROR + depth_m / clearance_m;
        let read = self.believed().map(|(_, [x, y])| x.hypot(y));
        let estimated = (self.track.iter().filter(|stretch| !is_unseen(stretch)))
            .map(|stretch| self.number(stretch.radius_square).sqrt());
        read.chain(estimated).filter(|r| *r > most).reduce(f64::max)
    }

    /// Entries whose reading was believed \[clearances\].
    fn believed(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let unbelieved = self.unbelieved();
        (self.entries.iter())
            .filter(move |(number, _)| !unbelieved.contains(number))
            .map(|(number, entry)| (*number, entry.position.map(|bits| self.number(bits))))
    }

    /// Whether readings that the supervisor believed jump much farther than by the speeds that it found.
    fn jumps(&self, summary: &Summary, config: &Config) -> bool {
        let fastest = summary
            .hardest_impact_m_s
            .max(summary.backward_speed_max_m_s);
        let way = f64::from(fastest * config.sample_period_s / config.clearance_m);
        let believed: Vec<_> = self.believed().collect();
        let mut pairs = believed
            .windows(2)
            .filter(|pair| pair[1].0 == pair[0].0 + 1);
        pairs.any(|pair| {
            let ([x, y], [next_x, next_y]) = (pair[0].1, pair[1].1);
            (next_x - x).hypot(next_y - y) > JUMP.max(3.0 * way)
        })
    }

    /// Noise of the readings that the supervisor believed \[m\], where it is much more than was configured: by what four in a row
    /// are off a parabola, in the part of the record in which that is most. An impact makes few such rows.
    fn noise_m(&self, config: &Config) -> Option<f64> {
        let believed: Vec<_> = self.believed().collect();
        let noise = |part: &[(usize, [f64; 2])]| {
            let rows = part.windows(4).filter(|row| row[3].0 == row[0].0 + 3);
            let off = |row: &[(usize, [f64; 2])], axis: usize| {
                let [a, b, c, d] = [0, 1, 2, 3].map(|i| row[i].1[axis]);
                (d - a - 3.0 * (c - b)).abs()
            };
            let mut off: Vec<f64> = rows
                .flat_map(|row| [0, 1].map(|axis| off(row, axis)))
                .collect();
            off.sort_by(f64::total_cmp);
            // Of normal noise three times its size is the median.
            off.get(off.len() / 2).map(|median| median / 3.0)
        };
        let noise = (believed.chunks(NOISE_TICKS).filter_map(noise)).reduce(f64::max)?;
        let clearance_m = f64::from(config.clearance_m);
        let most = NOISE * f64::from(config.sensor_step_m) / clearance_m;
        (noise > most.max(LEAST_NOISE)).then_some(noise * clearance_m)
    }

    /// Touches of an event in which the supervisor has counted none, as it left them to the levitation controller.
    fn touches_left_alone(&self, summary: &Summary) -> u32 {
        if summary.touches > 0 || summary.contact_ticks > 0 {
            return 0;
        }
        let touched = |entry: &&Entry| u32::from(entry.events) & Events::TOUCHED.bits() != 0;
        let recorded = self.entries.values().filter(touched).count() as u32;
        let in_all = self
            .track
            .iter()
            .map(|stretch| u32::from(stretch.touches))
            .sum();
        recorded.max(in_all)
    }

    /// Whether a touch came after a reading that was believed, so that a speed before it was measured.
    fn impact_was_seen(&self, summary: &Summary) -> bool {
        let unbelieved = self.unbelieved();
        let touched = |entry: &Entry| u32::from(entry.events) & Events::TOUCHED.bits() != 0;
        let touches = || self.entries.iter().filter(|(_, entry)| touched(entry));
        let seen = |number: usize| number > 0 && !unbelieved.contains(&(number - 1));
        touches().any(|(number, _)| seen(*number)) || summary.touches as usize > touches().count()
    }
}

/// What was seen of an event.
#[derive(Debug)]
struct Seen {
    whirled: bool,
    impact: bool,
    /// Touches that the supervisor left to the levitation controller.
    others: u32,
    unseen: Unseen,
    doubt: Option<Doubt>,
    whole: bool,
}

/// So many times the configured noise, and so many clearances, are more than was configured.
const NOISE: f64 = 4.0;
const LEAST_NOISE: f64 = 0.02;
/// In one of the parts of so many ticks.
const NOISE_TICKS: usize = 64;

/// A shorter step \[clearances\] is no jump.
const JUMP: f64 = 0.3;

/// So many readings that do not fit say nothing against the sensor: an impact makes some.
const BY_CHANCE: i64 = 3;

/// Clearance and sensor may be wrong by so much without a remark.
const CLEARANCE_ERROR: f64 = 0.15;

impl Narrative {
    fn new(summary: &Summary, config: &Config, of: Seen) -> Self {
        let wide = |x: f32| f64::from(x);
        let backward = wide(summary.backward_speed_max_m_s);
        let period_s = wide(config.sample_period_s);
        let (unseen, whirled) = (of.unseen, of.whirled);
        let seen = !unseen.throughout || summary.touches > 0 || summary.contact_ticks > 0;
        // A speed is as wrong as the places that it is the rate of.
        let measured = of.doubt.is_none();
        let in_contact = |x: f64| (summary.contact_ticks > 0 && measured).then_some(x);
        let unknown_ticks = unseen.stretches.iter().map(|s| s.ticks[1] - s.ticks[0]);
        Self {
            outcome: match u8::try_from(summary.mode).ok().and_then(mode_of) {
                _ if summary.coast_down => "coast down",
                _ if !summary.bearing_on => "bearing off",
                Some(mode) => mode.name(),
                None => "unknown",
            },
            touches: (seen || of.others > 0).then_some(summary.touches + of.others),
            // Of touches that were left alone no time is counted.
            contact_s: (seen && of.others == 0)
                .then_some(f64::from(summary.contact_ticks) * period_s),
            hardest_impact_m_s: (summary.touches > 0 && of.impact && measured)
                .then_some(wide(summary.hardest_impact_m_s)),
            max_whirl_hz: in_contact(backward / (TAU * wide(config.clearance_m))),
            whirl_share: in_contact(backward / wide(summary.whirl_limit_m_s)),
            // What was taken for one by such readings may be none.
            whirled: (seen && (measured || !whirled)).then_some(whirled),
            severity: seen.then_some(wide(summary.severity)),
            severity_index: wide(summary.severity_index),
            severity_limit: wide(config.severity_limit),
            landings: summary.landings,
            coast_down: summary.coast_down,
            position_unknown_s: unknown_ticks.sum::<i64>() as f64 * period_s,
            speeds_unknown: of.doubt,
            unseen: if unseen.stretches.is_empty() {
                Vec::new()
            } else {
                vec![unseen]
            },
            whole: of.whole,
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
        // Of what is known of one plane alone, that.
        let most = |a: Option<f64>, b: Option<f64>| a.into_iter().chain(b).reduce(f64::max);
        // The other plane's may be faster.
        let known = self.speeds_unknown.is_none() && other.speeds_unknown.is_none();
        let fastest = |a, b| most(a, b).filter(|_| known);
        let touches = self.touches.into_iter().chain(other.touches);
        let whirled = self.whirled.into_iter().chain(other.whirled);
        let mut unseen = self.unseen;
        unseen.extend(other.unseen);
        Self {
            outcome: if self.coast_down || other.coast_down {
                "coast down"
            } else {
                worse
            },
            touches: touches.reduce(|a, b| a + b),
            contact_s: most(self.contact_s, other.contact_s),
            hardest_impact_m_s: fastest(self.hardest_impact_m_s, other.hardest_impact_m_s),
            max_whirl_hz: fastest(self.max_whirl_hz, other.max_whirl_hz),
            whirl_share: fastest(self.whirl_share, other.whirl_share),
            whirled: whirled.reduce(|a, b| a || b),
            severity,
            severity_index,
            severity_limit,
            landings: self.landings.max(other.landings),
            coast_down: self.coast_down || other.coast_down,
            position_unknown_s: self.position_unknown_s.max(other.position_unknown_s),
            speeds_unknown: self.speeds_unknown.or(other.speeds_unknown),
            unseen,
            whole: self.whole && other.whole,
        }
    }

    /// Whether nothing that happened can have gone unseen.
    fn is_seen(&self) -> bool {
        let mut stretches = self.unseen.iter().flat_map(|unseen| &unseen.stretches);
        let fits = matches!(self.speeds_unknown, None | Some(Doubt::Misfit));
        self.whole && fits && !stretches.any(|stretch| stretch.serious)
    }

    /// What speaks for or against running on. `used`: share of what the retainer bearing may bear that its ledger says is used up; 0
    /// without.
    pub fn verdict(&self, used: f64) -> Verdict {
        let used = used.max(self.severity_index / self.severity_limit);
        if self.coast_down || used >= 1.0 {
            Verdict::Inspect
        } else if self.outcome != "levitated" || !self.is_seen() {
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
        let mut sentences: Vec<String> = self.unseen.iter().map(Unseen::message).collect();
        sentences.push(self.happened());
        sentences.extend(self.speeds_unknown.map(Doubt::message));
        sentences.push(self.counted());
        sentences.join(". ") + "."
    }

    /// What was seen, and how it ended.
    fn happened(&self) -> String {
        let end = match self.outcome {
            "levitated" => "the levitation controller has the bearing again".to_owned(),
            "coast down" => "the supervisor asked for coasting down".to_owned(),
            "handed back" => "the supervisor made no progress and gave the bearing back".to_owned(),
            "bearing off" => "the bearing was switched off".to_owned(),
            LOG_ENDS => "the log ends before it was over".to_owned(),
            mode => format!("it was not over when the record was full ({mode})"),
        };
        let least = self.least();
        let otherwise = if self.unseen.is_empty() {
            ""
        } else {
            " otherwise"
        };
        let contact = self.contact_s.filter(|contact_s| *contact_s > 0.0);
        let contact = contact.map(|s| format!("{least}{:.1} ms in contact", 1e3 * s));
        let hardest = self.hardest_impact_m_s;
        let hardest = hardest.map(|speed| format!("hardest {least}{speed:.2} m/s"));
        let touches = self.touches.map(|touches| {
            let count = match (touches, &contact) {
                (0, None) => format!("no touch seen{otherwise}"),
                (0, Some(_)) => "the rotor was on its retainer bearing".to_owned(),
                (1, _) => format!("{least}one touch"),
                (n, _) => format!("{least}{n} touches"),
            };
            let all = [Some(count), hardest, contact].into_iter().flatten();
            all.collect::<Vec<_>>().join(", ")
        });
        let of_force = |share: f64| format!("{:.0} % of what the force arrests", 100.0 * share);
        let speed = self.max_whirl_hz.zip(self.whirl_share);
        let whirl = match (self.whirled, speed) {
            (Some(true), Some((hz, share))) => Some(format!(
                "backward whirl of up to {hz:.0} Hz, {}",
                of_force(share)
            )),
            (Some(true), None) => Some("backward whirl, how fast is not known".to_owned()),
            (Some(false), Some((_, share))) => Some(format!(
                "no whirl seen{otherwise} (fastest backward motion {})",
                of_force(share)
            )),
            (Some(false), None) => Some(format!("no whirl seen{otherwise}")),
            (None, _) if self.speeds_unknown.is_some() && self.touches.is_some() => Some(
                "the supervisor took it for backward whirl, whether it was is not known".to_owned(),
            ),
            (None, _) => None,
        };
        let parts: Vec<String> = touches.into_iter().chain(whirl).chain([end]).collect();
        capital(&parts.join("; "))
    }

    /// Of counts that are too low where the position was unknown. Readings that are wrong make some too high.
    fn least(&self) -> &'static str {
        match (self.speeds_unknown, &self.unseen[..]) {
            (Some(_), _) | (None, []) => "",
            (None, _) => "at least ",
        }
    }

    /// What is counted of it.
    fn counted(&self) -> String {
        let least = self.least();
        let (sum, limit) = (self.severity_index, self.severity_limit);
        let used = match self.severity {
            Some(severity) => format!("It used {least}{}", percent(severity / limit)),
            None => "It used an unknown share".to_owned(),
        };
        format!(
            "{used} of what the retainer bearing is allowed before coasting down is asked for; with earlier events \
             {least}{} (severity {sum:.2} of {limit:.0})",
            percent(sum / limit)
        )
    }
}

/// A share in percent, to two figures; a very small one by what it is under.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent > 0.0 && percent < 0.005 {
        return "under 0.01 %".to_owned();
    }
    let decimals = match percent.abs() {
        9.95.. | 0.0 => 0,
        0.995.. => 1,
        _ => 2,
    };
    format!("{percent:.decimals$} %")
}

/// With a capital at its beginning.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}

impl Unseen {
    /// When and why, and what is therefore not known.
    fn message(&self) -> String {
        let position = match self.plane {
            Some(plane) => format!("Position of plane {plane}"),
            None => "Position".to_owned(),
        };
        let length = |s: &Unknown| s.ticks[1] - s.ticks[0];
        let longest = self
            .stretches
            .iter()
            .rev()
            .max_by_key(|s| (length(s), s.reason.is_specific()));
        let because = longest.map_or("", |s| s.reason.because());
        let ms = |s: &Unknown| {
            let [from, to] = [s.from_s, s.to_s].map(|s| 1e3 * s.unwrap_or_default());
            format!("from {from:.2} ms to {to:.2} ms")
        };
        let when = match (&self.stretches[..], longest) {
            _ if self.throughout => "throughout the event".to_owned(),
            ([only], _) => ms(only),
            (all, longest) => {
                let sum_s: f64 = (all.iter()).filter_map(|s| Some(s.to_s? - s.from_s?)).sum();
                format!(
                    "in {} stretches, {:.2} ms in all, the longest {}",
                    all.len(),
                    1e3 * sum_s,
                    longest.map_or(String::new(), ms)
                )
            }
        };
        let then = if self.throughout { "" } else { " then" };
        format!(
            "{position} unknown {when}, because {because}; whether it touched or whirled{then} is not known"
        )
    }
}

impl Event<'_> {
    /// Its outcome; `None` where that is not whole, or not there of all planes.
    pub fn narrative(&self) -> Option<Narrative> {
        if self.records.len() < self.records.first()?.head.planes as usize {
            return None;
        }
        let all: Option<Vec<Narrative>> = self.narratives().into_iter().collect();
        let narrative = all?.into_iter().reduce(Narrative::with)?;
        Some(match self.log_ends && narrative.outcome == "bearing off" {
            true => Narrative {
                outcome: LOG_ENDS,
                ..narrative
            },
            false => narrative,
        })
    }

    /// Its outcome in each plane that is there.
    pub fn narratives(&self) -> Vec<Option<Narrative>> {
        let planes = self.records.iter().zip(&self.unknown);
        planes
            .map(|(record, unknown)| record.narrative(unknown))
            .collect()
    }
}
