//! Records of sensors that lie and of files that are damaged, against what the plant did: no sentence says more than it knows.

use super::damage::sections;
use firmware_bench::record::file::{PlaneRecord, RecordFile};
use firmware_bench::record::narrative::{Event, Narrative, Verdict};
use firmware_bench::record::ticks::Ticks;
use firmware_bench::record::unknown::{Reason, Unknown};
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use supervisor::{Limits, Mode, Part};
use system_tests::ran::{Folder, has, list};

const RATE_HZ: f64 = 20_000.0;
const CLEARANCE_M: f64 = 2e-4;
/// A rotor so near to the wall counts as in contact, by the band of the supervisor.
const NEAR: f64 = 0.95;

/// What happens to the machine: an overload, a backward whirl, nothing.
const MACHINE: &str = r#"
title = "a sensor that lies"
[run]
duration_s = 0.08
sample_rate_hz = 20000
seed = 1
policies = ["supervisor"]
[rotor]
mass_kg = 10.0
contact_radius_m = 0.05
[spin]
frequency_hz = 200.0
inertia_kg_m2 = 0.02
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e9
restitution = 0.7
[friction]
coefficient = 0.15
[magnet]
force_max_n = 1000.0
lag_s = 1.6e-4
negative_stiffness_n_m = 2e5
[sensor]
noise_rms_m = 1e-6
quantum_m = 1e-7
range_m = 4e-4
[levitation]
proportional_n_m = 5e5
derivative_n_s_m = 1500.0
derivative_filter_s = 1e-4
"#;

const OVERLOAD: &str =
    "[[disturbance]]\nstart_s = 0.005\nduration_s = 0.02\nforce_n = [1300.0, 750.0]\n";
const WHIRL: &str =
    "[start]\nposition_m = [2e-4, 0.0]\nvelocity_m_s = [0.0, -0.2]\nlevitated_before = true\n";

/// Each kind of fault, with its keys.
const FAULTS: [&str; 17] = [
    "kind = \"nan\"",
    "kind = \"nan\"\naxis = \"x\"",
    "kind = \"infinity\"",
    "kind = \"zero\"",
    "kind = \"rail\"",
    "kind = \"stuck\"",
    "kind = \"offset\"\nvalue_m = 5e-5",
    "kind = \"gain\"\nfactor = 2.0",
    "kind = \"gain\"\nfactor = 0.5",
    "kind = \"inverted\"",
    "kind = \"swapped\"",
    "kind = \"noise\"\nfactor = 30.0",
    "kind = \"spikes\"\nrate_hz = 400.0\nsize_m = 1e-4",
    "kind = \"dropout\"",
    "kind = \"delay\"\nsamples = 5",
    "kind = \"bits\"\nbits = 4",
    "kind = \"oscillation\"\nfrequency_hz = 300.0\namplitude_m = 5e-5",
];

/// From when on it lasts, and for how long \[s\]: over the first touch, amid the contact, briefly, and until the bearing is off.
const TIMES_S: [[f64; 2]; 4] = [
    [0.0045, 0.01],
    [0.008, 0.004],
    [0.0065, 0.0003],
    [0.0, 0.079],
];
/// The magnet is switched off and the firmware knows: what ends an event whose rotor nobody sees.
const SWITCHED_OFF: &str =
    "[[outage]]\nstart_s = 0.06\nduration_s = 0.019\ndelivers = \"nothing\"\nknown = true\n";

/// A run, and the record that it leaves.
struct Lied {
    name: String,
    fault: Option<(&'static str, [f64; 2])>,
    bytes: Vec<u8>,
    trace: Trace,
}

fn ran(machine: &str, event: &str, fault: Option<(&'static str, [f64; 2])>) -> Option<Lied> {
    let table = fault.map_or(String::new(), |(kind, [start_s, duration_s])| {
        format!("[[fault]]\nstart_s = {start_s}\nduration_s = {duration_s}\n{kind}\n")
    });
    let off = match fault {
        Some((_, [0.0, _])) => SWITCHED_OFF,
        _ => "",
    };
    let text = format!("{machine}{event}{off}{table}");
    let name = format!("{event}{table}").replace('\n', " ");
    let scene = Scene::parse("lies", &text).unwrap_or_else(|e| panic!("{name}: {e}"));
    let (_, trace) = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {}).unwrap();
    let bytes = trace.read_out.as_ref()?.flight_record.clone()?;
    Some(Lied {
        name,
        fault,
        bytes,
        trace,
    })
}

/// Every kind of fault at every time in every event, as far as a record comes of it.
fn all() -> Vec<Lied> {
    let events = [OVERLOAD, WHIRL, ""];
    let mut records = Vec::new();
    for event in events {
        records.extend(ran(MACHINE, event, None));
        let each = FAULTS
            .iter()
            .flat_map(|kind| TIMES_S.map(|times_s| (*kind, times_s)));
        records.extend(each.filter_map(|fault| ran(MACHINE, event, Some(fault))));
    }
    records
}

fn tick_of(row: &TraceRow) -> i64 {
    (row.plant.t_s * RATE_HZ).round() as i64
}

/// What the plant did in ticks of a run, and what the supervisor made of it.
struct Truth<'a> {
    rows: Vec<&'a TraceRow>,
}

impl<'a> Truth<'a> {
    fn between(trace: &'a Trace, from: i64, to: i64) -> Self {
        let rows = trace
            .rows
            .iter()
            .filter(|row| (from..to).contains(&tick_of(row)));
        Self {
            rows: rows.collect(),
        }
    }

    fn touched(&self) -> bool {
        self.rows.iter().any(|row| row.plant.mode.in_contact())
    }

    /// Whether the sensor showed a contact that there was.
    fn showed_contact(&self) -> bool {
        let shown = |row: &&TraceRow| row.measured_m.norm() >= CLEARANCE_M;
        self.rows
            .iter()
            .any(|row| row.plant.mode.in_contact() && shown(row))
    }

    fn touches(&self) -> usize {
        let contact = |row: &TraceRow| row.plant.mode.in_contact();
        let begins = |pair: &[&TraceRow]| !contact(pair[0]) && contact(pair[1]);
        usize::from(self.rows.first().is_some_and(|row| contact(row)))
            + self.rows.windows(2).filter(|pair| begins(pair)).count()
    }

    fn near(&self) -> impl Iterator<Item = &&'a TraceRow> {
        let near = |row: &&&TraceRow| row.plant.position_m.norm() >= NEAR * CLEARANCE_M;
        self.rows.iter().filter(near)
    }

    /// Fastest motion against the spin, near the wall, as turns round the clearance \[Hz\].
    fn backward_hz(&self) -> f64 {
        let speed = |row: &&TraceRow| {
            let (x, v) = (row.plant.position_m, row.plant.velocity_m_s);
            -x.perp(&v) / x.norm()
        };
        self.near().map(speed).fold(0.0, f64::max) / (TAU * CLEARANCE_M)
    }

    fn fastest_outwards_m_s(&self) -> f64 {
        let speed = |row: &&TraceRow| {
            row.plant
                .position_m
                .normalize()
                .dot(&row.plant.velocity_m_s)
        };
        self.rows.iter().map(speed).fold(0.0, f64::max)
    }
}

/// What is reviewed of a record, with its ticks counted as the run's.
struct Reviewed<'a> {
    record: &'a PlaneRecord,
    narrative: Narrative,
    text: String,
    verdict: Verdict,
    unknown: Vec<Unknown>,
    /// The first tick of the record, and the first after it.
    span: [i64; 2],
}

impl<'a> Reviewed<'a> {
    fn of(event: &Event<'a>) -> Option<Self> {
        let record = event.records[0];
        let narrative = event.narrative()?;
        let zero = zero(record);
        let in_run = |stretch: &Unknown| Unknown {
            ticks: stretch.ticks.map(|tick| tick + zero),
            ..*stretch
        };
        let first = record
            .entries
            .values()
            .next()
            .map_or(0, |e| i64::from(e.sequence));
        Some(Self {
            record,
            text: narrative.paragraph(0.0),
            verdict: narrative.verdict(0.0),
            narrative,
            unknown: event.unknown[0].iter().map(in_run).collect(),
            span: [first, zero + record.tick_of(record.head.closed_at) + 1],
        })
    }

    fn is_known(&self, tick: i64) -> bool {
        !self
            .unknown
            .iter()
            .any(|s| (s.ticks[0]..s.ticks[1]).contains(&tick))
    }
}

/// The tick of the run from which the times of a record count.
fn zero(record: &PlaneRecord) -> i64 {
    let first = Ticks::of(record)
        .ticks
        .first()
        .map_or((0, 0), |t| (t.sequence, t.tick));
    i64::from(first.0) - first.1
}

/// How many records showed what.
#[derive(Debug, Default)]
struct Shown {
    records: usize,
    /// The plant touched while the position was unknown, in all of the event.
    hidden: usize,
    throughout: usize,
    whirls: usize,
    honest: usize,
    doubted: usize,
}

/// A figure of speed may be so much above the plant's: a share, and what the noise makes of it.
const SHARE: f64 = 0.2;
const NOISE_HZ: f64 = 15.0;
const NOISE_M_S: f64 = 0.02;

/// Nothing that is said contradicts what the plant did.
fn holds(lied: &Lied, reviewed: &Reviewed<'_>, shown: &mut Shown) {
    let Reviewed {
        narrative,
        text,
        verdict,
        unknown,
        span: [from, to],
        ..
    } = reviewed;
    let name = format!("{}\n{text}\n{unknown:?}", lied.name);
    let truth = Truth::between(&lied.trace, *from, *to);
    shown.records += 1;

    // What happened unseen is not denied.
    let hides = |s: &&Unknown| Truth::between(&lied.trace, s.ticks[0], s.ticks[1]).touched();
    let hidden: Vec<&Unknown> = unknown.iter().filter(hides).collect();
    shown.hidden += usize::from(!hidden.is_empty());
    assert_eq!(
        unknown.is_empty(),
        !text.contains("is not known. "),
        "{name}"
    );
    assert!(
        unknown.is_empty() || text.starts_with("Position unknown "),
        "{name}"
    );
    let lower = text.to_lowercase();
    for denied in ["no touch seen", "no whirl seen"] {
        let otherwise = format!("{denied} otherwise");
        assert!(
            unknown.is_empty()
                || lower.matches(denied).count() == lower.matches(&otherwise).count(),
            "{name}"
        );
    }
    if unknown.iter().any(|s| s.serious) {
        assert!(!matches!(verdict, Verdict::RunOn | Verdict::Plan), "{name}");
    }

    // Of an event that was not seen there are no figures.
    if text.contains("unknown throughout") {
        shown.throughout += 1;
        let figures = [
            narrative.contact_s,
            narrative.hardest_impact_m_s,
            narrative.max_whirl_hz,
            narrative.whirl_share,
            narrative.severity,
        ];
        assert_eq!(figures, [None; 5], "{name}");
        assert_eq!(narrative.whirled, None, "{name}");
        // One before the engagement may have been seen.
        let before = Truth::between(&lied.trace, *from, unknown[0].ticks[0]);
        assert!(narrative.touches.is_none() || before.touched(), "{name}");
    }

    // What was seen is what was there, as far as the sensor showed it.
    let seen = Truth {
        rows: truth
            .rows
            .iter()
            .copied()
            .filter(|row| reviewed.is_known(tick_of(row)))
            .collect(),
    };
    if lower.contains("no touch seen") {
        assert!(!seen.showed_contact(), "{name}");
    }
    let honest = seen
        .rows
        .iter()
        .all(|row| (row.measured_m - row.plant.position_m).norm() < 1e-5);
    if honest && narrative.speeds_unknown.is_none() {
        shown.honest += 1;
        if let (Some(touches), Some(contact_s)) = (narrative.touches, narrative.contact_s) {
            assert!(
                touches as usize <= truth.touches(),
                "{} {name}",
                truth.touches()
            );
            let near_s = truth.near().filter(|row| !row.mode_change).count() as f64 / RATE_HZ;
            assert!(contact_s <= 1.1 * near_s + 3e-4, "{near_s} {name}");
        }
    }
    shown.doubted += usize::from(narrative.speeds_unknown.is_some());

    // A speed that is said is the plant's.
    if let Some(speed) = narrative.hardest_impact_m_s {
        let fastest = truth.fastest_outwards_m_s();
        assert!(
            speed <= (1.0 + SHARE) * fastest + NOISE_M_S,
            "{fastest} {name}"
        );
    }
    if let Some(hz) = narrative.max_whirl_hz {
        let fastest = truth.backward_hz();
        assert!(
            hz <= (1.0 + SHARE) * fastest + NOISE_HZ,
            "{hz} for {fastest} {name}"
        );
        if narrative.whirled == Some(true) {
            assert!(
                unknown.iter().any(|s| s.serious) || hz >= (1.0 - SHARE) * fastest,
                "{hz} for {fastest} {name}"
            );
            shown.whirls += 1;
        }
    }
}

/// Readings that the supervisor did not believe, tick by tick of the run.
fn refused(lied: &Lied) -> Vec<i64> {
    let bad = |row: &&TraceRow| {
        row.supervisor.is_some_and(|trace| {
            trace.limits.contains(Limits::SAMPLE_REFUSED) || trace.mode == Mode::SensorFault
        })
    };
    let rows = lied.trace.rows.iter().filter(|row| !row.mode_change);
    let mut ticks: Vec<i64> = rows.filter(bad).map(tick_of).collect();
    ticks.dedup();
    // The rows next to a change may be of the sample before.
    let amid =
        |at: i64| ticks.binary_search(&(at - 1)).is_ok() && ticks.binary_search(&(at + 1)).is_ok();
    ticks.iter().copied().filter(|at| amid(*at)).collect()
}

/// Whatever a sensor does, no sentence and no figure says more than the record knows.
#[test]
fn no_sentence_contradicts_the_plant() {
    let mut shown = Shown::default();
    let mut reasons = Vec::new();
    for lied in all() {
        let file = RecordFile::of(&lied.bytes);
        assert_eq!(file.damage, []);
        let event = &file.events()[0];
        let reviewed = Reviewed::of(event).unwrap();
        holds(&lied, &reviewed, &mut shown);
        let [from, to] = reviewed.span;
        for tick in refused(&lied)
            .into_iter()
            .filter(|tick| (from..to).contains(tick))
        {
            assert!(
                !reviewed.is_known(tick),
                "{tick}: {}\n{:?}",
                lied.name,
                reviewed.unknown
            );
        }
        if let Some((kind, [start_s, duration_s])) = lied.fault {
            let during = |s: &&Unknown| {
                s.ticks[1] as f64 / RATE_HZ >= start_s
                    && s.ticks[0] as f64 / RATE_HZ <= start_s + duration_s
            };
            let longest = reviewed
                .unknown
                .iter()
                .filter(during)
                .max_by_key(|s| s.ticks[1] - s.ticks[0]);
            reasons.extend(longest.map(|s| (kind, s.reason)));
        }
    }
    println!("{shown:?}");
    assert!(
        shown.records > 120 && shown.hidden > 45 && shown.throughout > 10,
        "{shown:?}"
    );
    assert!(
        shown.whirls > 15 && shown.honest > 45 && shown.doubted > 60,
        "{shown:?}"
    );
    let cases = [
        ("\"nan\"", Reason::NotANumber),
        ("\"infinity\"", Reason::NotANumber),
        ("\"rail\"", Reason::OutOfRange),
        ("\"stuck\"", Reason::DidNotChange),
        ("\"dropout\"", Reason::NoNewSample),
    ];
    for (kind, reason) in cases {
        let of: Vec<_> = reasons.iter().filter(|(k, _)| k.contains(kind)).collect();
        assert!(
            of.len() > 3 && of.iter().all(|(_, r)| *r == reason),
            "{of:?}"
        );
    }
}

/// A file damaged in each of several ways, by name.
fn damages(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let all = sections(bytes);
    let without = |left_out: &dyn Fn(usize, &[u8]) -> bool| {
        let left = all
            .iter()
            .enumerate()
            .filter(|(i, section)| !left_out(*i, section));
        left.flat_map(|(_, section)| section.to_vec())
            .collect::<Vec<u8>>()
    };
    let of = |part: Part| move |section: &[u8]| section.starts_with(&(part as u32).to_le_bytes());
    let mut damaged: Vec<(String, Vec<u8>)> = [
        Part::Summary,
        Part::Config,
        Part::Track,
        Part::State,
        Part::Ticks,
        Part::End,
    ]
    .into_iter()
    .map(|part| {
        (
            format!("without {part:?}"),
            without(&|_, section| of(part)(section)),
        )
    })
    .collect();
    let ticks: Vec<usize> = (0..all.len())
        .filter(|i| of(Part::Ticks)(all[*i]))
        .collect();
    for place in [0, ticks.len() / 3, ticks.len() / 2, ticks.len() - 1] {
        let name = format!("without part {place} of the ticks");
        damaged.push((name, without(&|i, _| i == ticks[place])));
    }
    for share in [0.4, 0.8] {
        let end = (share * bytes.len() as f64) as usize;
        damaged.push((format!("cut at {share}"), bytes[..end].to_vec()));
    }
    let mut flipped = bytes.to_vec();
    flipped[bytes.len() / 2] ^= 4;
    damaged.push(("flipped".to_owned(), flipped));
    damaged.push(("more behind it".to_owned(), [bytes, &[7; 33]].concat()));
    damaged
}

/// Of each entry the tick since the engagement.
fn ticks(record: &PlaneRecord) -> Vec<i64> {
    Ticks::of(record)
        .ticks
        .iter()
        .map(|tick| tick.tick)
        .collect()
}

/// Whatever is missing in a file, what was not seen stays unknown, and nothing is concluded from what is not there.
#[test]
fn damage_makes_nothing_known() {
    let kinds = [None, Some(FAULTS[0]), Some(FAULTS[5]), Some(FAULTS[13])];
    let (mut files, mut unseen, mut judged) = (0, 0, 0);
    for (event, kind) in [OVERLOAD, WHIRL]
        .iter()
        .flat_map(|event| kinds.map(|kind| (event, kind)))
    {
        let Some(lied) = ran(MACHINE, event, kind.map(|kind| (kind, TIMES_S[0]))) else {
            continue;
        };
        let whole = RecordFile::of(&lied.bytes);
        let entries = &whole.records[0].entries;
        let at: BTreeMap<usize, i64> = entries
            .keys()
            .copied()
            .zip(ticks(&whole.records[0]))
            .collect();
        for (name, bytes) in damages(&lied.bytes) {
            let name = format!("{name}: {}", lied.name);
            let file = RecordFile::of(&bytes);
            assert!(!file.is_intact(), "{name}");
            let events = file.events();
            let event = &events[0];
            let record = event.records[0];
            files += 1;
            // Ticks that are not there, and whatever the supervisor did not believe.
            let there: Vec<(usize, i64)> =
                record.entries.keys().copied().zip(ticks(record)).collect();
            let shift = there.first().map(|(number, tick)| tick - at[number]);
            for (number, entry) in entries {
                let gone = !record.entries.contains_key(number);
                if let Some(shift) = shift
                    && (gone || entry.mode == Mode::SensorFault as u8)
                {
                    let tick = at[number] + shift;
                    let mut stretches = event.unknown[0].iter();
                    let is_unknown = stretches.any(|s| (s.ticks[0]..s.ticks[1]).contains(&tick));
                    assert!(is_unknown, "{number}: {name} {:?}", event.unknown);
                    unseen += 1;
                }
            }
            let Some(reviewed) = Reviewed::of(event) else {
                continue;
            };
            judged += 1;
            let all = record.entries.len() == entries.len()
                && record.track.len() == whole.records[0].track.len();
            assert!(all || reviewed.verdict != Verdict::RunOn, "{name}");
            assert!(reviewed.record.summary.is_some() && reviewed.record.config.is_some());
        }
    }
    println!("{files} {unseen} {judged}");
    assert!(
        files > 80 && unseen > 5000 && judged > 60,
        "{files} {unseen} {judged}"
    );
}

/// The first sentence says it to a person, null to a program, and damage comes before all of it.
#[test]
fn a_person_and_a_program_read_what_is_not_known() {
    let folder = Folder::fresh();
    let lied = ran(MACHINE, OVERLOAD, Some((FAULTS[0], TIMES_S[3]))).unwrap();
    folder.put("never.bin", &lied.bytes);
    let text = folder.ran("review never.bin").printed;
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let first = "Position unknown throughout the event, because the reading was not a number; whether it touched or whirled is not known.";
    assert!(words.starts_with(first), "{text}");
    let (_, track) = words.split_once("to the end of the event:").unwrap();
    has(track, &["not known"]);
    let json = folder.ran("review never.bin --json").json();
    for name in [
        "touches",
        "contact_s",
        "hardest_impact_m_s",
        "max_whirl_hz",
        "whirl_share",
        "whirled",
        "severity",
    ] {
        assert!(json["summary"][name].is_null(), "{name}");
    }
    let [only] = list(&json["planes"][0]["unknown"]) else {
        panic!("{json}")
    };
    assert_eq!(only["reason"], "not_a_number");
    assert_eq!(only["from_s"], 0.0);
    assert!(only["to_s"].as_f64() > Some(0.055), "{only}");

    let [.., (_, flipped), _] = &damages(&lied.bytes)[..] else {
        panic!()
    };
    folder.put("never.bin", flipped);
    let shown = folder.ran("review never.bin");
    assert_eq!(shown.code, Some(2));
    assert!(shown.printed.starts_with("The file is damaged: "));
}
