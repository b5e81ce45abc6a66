//! The comparison over the catalogue of overloads, as a study.

use super::counts::{Counts, Missed, compare};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use crate::machines::plants::{PlantCase, RATES_HZ, plants};
use crate::machines::tuned_gains::{TunedGains, stored};
use crate::overloads::case::Case;
use crate::overloads::catalogue::cases;
use crate::overloads::contenders::{Contender, Task};
use crate::overloads::plan::CatalogueError;
use firmware_bench::record::file::RecordFile;
use firmware_bench::run::closed_loop::{Keep, run_policy};
use std::collections::BTreeMap;

/// A scene of the catalogue with who is behind the supervisor.
struct Job<'a> {
    plant: &'a PlantCase,
    found: &'a TunedGains,
    case: &'a Case,
    contender: Contender,
}

/// Outcome of a run.
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
    // Where the event is the only one its outcome is the outcome of the run.
    let report = read_out.report;
    if let Some(narrative) = event.narrative()
        && report.landings + report.nuisance_engagements == 1
        && report.handed_back == 0
    {
        let levitated = narrative.outcome == supervisor::Mode::Levitated.name();
        // The summary has how it ended; that it whirled before is another of its figures.
        let same = levitated == figures.free_at_end;
        ran.counts.outcomes.count(same);
        ran.differs = (!same).then_some((narrative.outcome, figures.free_at_end));
    }
    Some(ran)
}

/// Groups of the catalogue in which the record is of inputs that are not so: the rotor was elsewhere, or another force acted.
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
    let mut groups: BTreeMap<&str, (usize, Counts)> = BTreeMap::new();
    let (mut missed, mut differing) = (Vec::new(), Vec::new());
    for (job, ran) in jobs.iter().zip(&all) {
        let Some(ran) = ran else { continue };
        let group = groups.entry(job.case.group).or_default();
        group.0 += usize::from(ran.recorded);
        group.1 += &ran.counts;
        let name = || {
            format!(
                "{}, {} Hz: {}",
                job.plant.name, job.plant.rate_hz, job.case.name
            )
        };
        missed.extend(ran.counts.missed.iter().map(|m| missed_cells(name(), m)));
        differing.extend(ran.differs.map(|(by_record, free)| {
            let by_plant = if free { "free" } else { "not free" };
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
    let without = |left_out: &[&str]| {
        let mut rest = Counts::default();
        let taken = groups.iter().filter(|(name, _)| !left_out.contains(name));
        taken.for_each(|(_, (_, counts))| rest += counts);
        rest
    };
    let sum = without(&[]);
    let records = groups.values().map(|(records, _)| records).sum();
    rows.push(cells("all", records, &sum));
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
    let differences = match differing.is_empty() {
        true => Block::text("None."),
        false => Block::table(["scene", "record", "plant"], differing),
    };
    Ok(Report {
        classes: Vec::new(),
        title: "What is found in records".to_owned(),
        claims,
        cases: jobs.len() as u64,
        chapters: vec![
            Chapter::new(
                "By kind of overload",
                vec![
                    Block::text(format!(
                        "{what}. Each record is that of the first event that was over before the run was. Friction and restitution count where they were identifiable; the outcome, levitated by the record and free at the end by the plant or neither, where the event is the only one of the run and nothing was handed back."
                    )),
                    Block::table(COLUMNS, rows),
                    Block::text(
                        "Impacts are looked for where a flight under a constant load and a known force ends. Where the sensor lies, reads nothing or is late, the record has the rotor elsewhere; where a drive does not obey, another force acts; a blade that is lost or a shock changes the load while the rotor flies, so that the flight is extended to the wall some ticks too early or too late.",
                    ),
                ],
            ),
            Chapter::folded(
                "Impacts that were not found",
                vec![Block::table(MISSED, missed)],
            ),
            Chapter::new("Outcomes that differ", vec![differences]),
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
