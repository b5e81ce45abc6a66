//! What is found out from flight records, against what the plant did; as a study over the catalogue of overloads.

use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use crate::machines::plants::{PlantCase, RATES_HZ, plants};
use crate::machines::tuned_gains::{TunedGains, stored};
use crate::overloads::case::Case;
use crate::overloads::catalogue::cases;
use crate::overloads::contenders::{Contender, Task};
use crate::overloads::plan::CatalogueError;
use firmware_bench::record::file::RecordFile;
use firmware_bench::record::identify::{Estimate, Findings};
use firmware_bench::run::clairvoyant::restitution;
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_bench::scene::Scene;
use plant_model::Mode;
use std::collections::BTreeMap;
use std::ops::AddAssign;

/// Normal speed from which an impact is to be found \[m/s\], and by how much its time may be off \[ticks\].
pub const IMPACT_M_S: f64 = 0.005;
/// See [`IMPACT_M_S`].
pub const OFF_TICKS: f64 = 2.0;

/// Of how many things how many are right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Share {
    /// How many are.
    pub right: usize,
    /// Of how many.
    pub of: usize,
}

impl Share {
    /// One more.
    pub fn count(&mut self, right: bool) {
        self.right += usize::from(right);
        self.of += 1;
    }

    /// As a share; 1 of none.
    pub fn share(self) -> f64 {
        match self.of {
            0 => 1.0,
            of => self.right as f64 / of as f64,
        }
    }

    fn text(self) -> String {
        format!("{} of {}", self.right, self.of)
    }

    fn of_estimate(&mut self, estimate: Option<Estimate>, truth: f64, off: f64) {
        if let Some(estimate) = estimate {
            self.count((estimate.value - truth).abs() <= off);
        }
    }
}

impl AddAssign for Share {
    fn add_assign(&mut self, other: Self) {
        self.right += other.right;
        self.of += other.of;
    }
}

/// An impact of the plant that no contact of the findings is at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Missed {
    /// Normal speed \[m/s\].
    pub speed_m_s: f64,
    /// Time off the wall before it, and until the next touch after it \[ticks\].
    pub flight_ticks: [f64; 2],
    /// From the last and to the next contact that was found \[ticks\].
    pub nearest_ticks: f64,
}

/// What was found, and how much of it is right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Counts {
    /// Impacts of the plant that were found.
    pub impacts: Share,
    /// Contacts found that are the plant's.
    pub contacts: Share,
    /// Coefficients of friction within a tenth, of those that were identifiable.
    pub friction: Share,
    /// Restitutions within 0.1.
    pub restitution: Share,
    /// Outcomes that are the plant's.
    pub outcomes: Share,
    /// Impacts that were not found.
    pub missed: Vec<Missed>,
}

impl AddAssign<&Self> for Counts {
    fn add_assign(&mut self, other: &Self) {
        self.impacts += other.impacts;
        self.contacts += other.contacts;
        self.friction += other.friction;
        self.restitution += other.restitution;
        self.outcomes += other.outcomes;
        self.missed.extend(&other.missed);
    }
}

/// What the plant did in the ticks of a record.
struct Truth {
    /// Times at which the rotor came to the wall \[ticks since the first\], with its normal speed \[m/s\].
    impacts: Vec<(f64, f64)>,
    /// Times at which it was there.
    touching: Vec<f64>,
}

impl Truth {
    fn new(scene: &Scene, trace: &Trace, (first, last): (u32, u32)) -> Self {
        let tick = |row: &TraceRow| row.plant.t_s * scene.sample_rate_hz - f64::from(first);
        let within = 0.0..=f64::from(last.wrapping_sub(first));
        let (mut impacts, mut touching) = (Vec::new(), Vec::new());
        for pair in trace.rows.windows(2) {
            let (plant, at) = (&pair[1].plant, tick(&pair[1]));
            if !within.contains(&at) || plant.mode == Mode::Flight {
                continue;
            }
            touching.push(at);
            if pair[0].plant.mode == Mode::Flight {
                let n = plant.position_m.normalize();
                impacts.push((at, plant.velocity_m_s.dot(&n)));
            }
        }
        Self { impacts, touching }
    }

    /// Time off the wall before and after an impact, as far as the record shows it.
    fn flights(&self, at: f64) -> [f64; 2] {
        let before = self.touching.iter().rev().find(|t| **t < at);
        let after = self.impacts.iter().find(|(t, _)| *t > at);
        [
            before.map_or(f64::INFINITY, |t| at - t),
            after.map_or(f64::INFINITY, |(t, _)| t - at),
        ]
    }
}

/// Compares impacts and contacts of the findings with those of the plant; `last`: sequence number of the record's last entry.
pub fn contacts(scene: &Scene, trace: &Trace, last: u32, found: &Findings) -> Counts {
    let truth = Truth::new(scene, trace, (found.first, last));
    let mut counts = Counts::default();
    let hard = |(_, speed): &&(f64, f64)| *speed > IMPACT_M_S;
    for (tick, speed_m_s) in truth.impacts.iter().filter(hard) {
        let away = |(from, to): (f64, f64)| (from - tick).max(tick - to).max(0.0);
        let all = found
            .contacts
            .iter()
            .map(|c| away((c.from_tick, c.to_tick)));
        let nearest_ticks = all.fold(f64::INFINITY, f64::min);
        counts.impacts.count(nearest_ticks <= OFF_TICKS);
        if nearest_ticks > OFF_TICKS {
            counts.missed.push(Missed {
                speed_m_s: *speed_m_s,
                flight_ticks: truth.flights(*tick),
                nearest_ticks,
            });
        }
    }
    for contact in &found.contacts {
        let at = contact.from_tick - OFF_TICKS..=contact.to_tick + OFF_TICKS;
        let is_real = truth.touching.iter().any(|tick| at.contains(tick));
        counts.contacts.count(is_real);
    }
    counts
}

/// Compares friction, where it is the same throughout, and restitution as well.
pub fn compare(scene: &Scene, trace: &Trace, last: u32, found: &Findings) -> Counts {
    let mut counts = contacts(scene, trace, last, found);
    let plant = &scene.plant;
    let mut changed = (scene.changes.iter())
        .filter_map(|change| Some((change.at_s, change.change.friction_coefficient?)));
    let mu = match changed.next_back() {
        None => Some(plant.friction.sliding.coefficient(0.0)),
        Some((0.0, mu)) => Some(mu),
        Some(_) => None,
    };
    let told = &found.identified;
    if let Some(mu) = mu {
        (counts.friction).of_estimate(told.friction_coefficient, mu, 0.1 * mu);
    }
    (counts.restitution).of_estimate(told.restitution, restitution(&scene.plant), 0.1);
    counts
}

/// A scene of the catalogue with who is behind the supervisor.
struct Job<'a> {
    plant: &'a PlantCase,
    found: &'a TunedGains,
    case: &'a Case,
    contender: Contender,
}

/// What came of it.
struct Ran {
    recorded: bool,
    counts: Counts,
    /// Outcomes, levitated or not, by the record and by the plant, where they differ.
    differs: Option<(&'static str, bool)>,
}

fn ran(job: &Job<'_>) -> Option<Ran> {
    let scene = &job.case.scene;
    let policy = job.contender.controller(Task::Impact, job.found, scene)?;
    let acting = (policy, job.contender.name());
    let (figures, trace) = run_policy(scene, acting, Keep::Trace, &mut |_| {}).ok()?;
    let mut ran = Ran {
        recorded: false,
        counts: Counts::default(),
        differs: None,
    };
    let Some(read_out) = trace.read_out.as_ref() else {
        return Some(ran);
    };
    let Some(bytes) = read_out.flight_record.as_ref() else {
        return Some(ran);
    };
    ran.recorded = true;
    let file = RecordFile::of(bytes);
    let events = file.events();
    let (Some(record), Some(event)) = (file.records.first(), events.first()) else {
        return Some(ran);
    };
    let last = record.entries.values().last()?.sequence;
    if let Some(found) = event.findings() {
        ran.counts = compare(scene, &trace, last, &found);
    }
    // Where the event is the only one what came of it is what came of the run.
    let report = read_out.report;
    if let Some(told) = event.told()
        && report.landings + report.nuisance_engagements == 1
        && report.handed_back == 0
    {
        let levitated = told.outcome == supervisor::Mode::Levitated.name();
        let same = levitated == figures.recovered;
        ran.counts.outcomes.count(same);
        ran.differs = (!same).then_some((told.outcome, figures.recovered));
    }
    Some(ran)
}

/// Groups of the catalogue in which the record is told what is not so: the rotor was elsewhere, or another force acted.
const FAULTS: [&str; 2] = ["sensor faults", "drive faults"];
/// Groups in which a load changes while the rotor flies.
const VARYING: [&str; 2] = ["blade loss", "shock"];

const COLUMNS: [&str; 7] = [
    "group",
    "records",
    "impacts found",
    "contacts that are real",
    "friction",
    "restitution",
    "outcomes",
];

/// Records of the catalogue's overloads.
///
/// # Errors
/// [`CatalogueError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let mut places = Vec::new();
    for rate_hz in RATES_HZ {
        let all = plants(rate_hz)?.into_iter();
        for plant in all.filter(|p| extent == Extent::Full || p.rate_hz == RATES_HZ[1]) {
            let found = stored(&plant.name, rate_hz).ok_or_else(|| CatalogueError::NotFound {
                plant: plant.name.clone(),
                rate_hz,
            })?;
            let cases = cases(&plant, found.tuned);
            places.push((plant, found, cases));
        }
    }
    let supervised = [Contender::Supervisor, Contender::SupervisorOnStiff];
    let takes = extent.pick(&supervised[..1], &supervised[..]);
    let every = extent.pick(4, 1);
    let mut jobs = Vec::new();
    for (plant, found, cases) in &places {
        let some = cases.iter().step_by(every);
        jobs.extend(some.flat_map(|case| {
            takes.iter().map(move |contender| Job {
                plant,
                found,
                case,
                contender: *contender,
            })
        }));
    }
    let all = run_all(&jobs, progress, ran);
    let mut sum = Counts::default();
    let mut groups: BTreeMap<&str, (usize, Counts)> = BTreeMap::new();
    let (mut records, mut differing) = (0, Vec::new());
    let mut missed = Vec::new();
    for (job, ran) in jobs.iter().zip(&all) {
        let Some(ran) = ran else { continue };
        let group = groups.entry(job.case.group).or_default();
        group.0 += usize::from(ran.recorded);
        group.1 += &ran.counts;
        records += usize::from(ran.recorded);
        sum += &ran.counts;
        let name = || {
            format!(
                "{}, {} Hz: {}",
                job.plant.name, job.plant.rate_hz, job.case.name
            )
        };
        missed.extend(ran.counts.missed.iter().map(|m| missed_cells(name(), m)));
        differing.extend(ran.differs.map(|(by_record, recovered)| {
            let by_plant = if recovered {
                "recovered"
            } else {
                "not recovered"
            };
            [name(), by_record.to_owned(), by_plant.to_owned()]
        }));
    }
    let cells = |name: &str, records: usize, counts: &Counts| {
        [
            name.to_owned(),
            records.to_string(),
            counts.impacts.text(),
            counts.contacts.text(),
            counts.friction.text(),
            counts.restitution.text(),
            counts.outcomes.text(),
        ]
    };
    let mut rows: Vec<[String; 7]> = (groups.iter())
        .map(|(name, (records, counts))| cells(name, *records, counts))
        .collect();
    rows.push(cells("all", records, &sum));
    let without = |left_out: &[&str]| {
        let mut rest = Counts::default();
        let taken = groups.iter().filter(|(name, _)| !left_out.contains(name));
        taken.for_each(|(_, (_, counts))| rest += counts);
        rest
    };
    let honest = without(&FAULTS);
    let steady = without(&[&FAULTS[..], &VARYING[..]].concat());
    let claims = vec![
        Claim::at_least(
            "impacts above 5 mm/s: found within two ticks",
            1.0,
            sum.impacts.share(),
        ),
        Claim::at_least(
            "the same where sensor and drive do as they say",
            1.0,
            honest.impacts.share(),
        ),
        Claim::at_least(
            "the same where loads are constant in flight as well",
            1.0,
            steady.impacts.share(),
        ),
        Claim::at_least("contacts found: the plant's", 1.0, sum.contacts.share()),
        Claim::at_least(
            "the same where sensor and drive do as they say",
            1.0,
            honest.contacts.share(),
        ),
        Claim::at_least(
            "friction, where identifiable: within a tenth",
            1.0,
            sum.friction.share(),
        ),
        Claim::at_least(
            "restitution, where identifiable: within 0.1",
            1.0,
            sum.restitution.share(),
        ),
        Claim::at_least(
            "outcome of the summary: the plant's",
            0.99,
            sum.outcomes.share(),
        ),
    ];
    let what = extent.pick(
        "Every fourth scene at 20 kHz, before the tuned loop",
        "Every scene at 10 and 20 kHz, before the tuned and the ordinary loop",
    );
    Ok(Report {
        title: "What is found in records".to_owned(),
        claims,
        cases: jobs.len() as u64,
        chapters: vec![
            Chapter::new(
                "By kind of overload",
                vec![
                    Block::text(format!(
                        "{what}. Each record is that of the first event that was over before the run was. Friction and restitution count where they were identifiable; the outcome, levitated or not, where the event is the only one of the run and nothing was handed back."
                    )),
                    Block::table(COLUMNS, rows),
                    Block::text(
                        "Impacts are looked for where a flight under a constant load and a known force ends. Where the sensor lies, reads nothing or is late, the record has the rotor elsewhere; where a drive does not do as it is told, another force acts; a blade that is lost or a shock changes the load while the rotor flies, so that the flight is extended to the wall some ticks too early or too late.",
                    ),
                ],
            ),
            Chapter {
                folded: true,
                ..Chapter::new(
                    "Impacts that were not found",
                    vec![Block::table(MISSED, missed)],
                )
            },
            Chapter::new(
                "Outcomes that differ",
                vec![Block::table(["scene", "record", "plant"], differing)],
            ),
        ],
    })
}

const MISSED: [&str; 5] = [
    "scene",
    "normal speed, mm/s",
    "off the wall before, ticks",
    "until the next touch, ticks",
    "to the nearest contact found, ticks",
];

fn missed_cells(scene: String, missed: &Missed) -> [String; 5] {
    let [before, after] = missed.flight_ticks.map(|t| format!("{t:.1}"));
    [
        scene,
        format!("{:.1}", 1e3 * missed.speed_m_s),
        before,
        after,
        format!("{:.1}", missed.nearest_ticks),
    ]
}
