//! The catalogue as chapters of a page, and as a study.

use super::contenders::Contender;
use super::plan::{Catalogue, Plan};
use super::promises::{Harm, force_ratios, lost_beyond_chance, percentile};
use super::results::ResultRow;
use super::sweeps::{SweepRow, median, median_of};
use crate::campaign::{Block, Chapter, Extent, Progress, Report, StudyError};
use firmware_bench::report::plot::text::figures;
use firmware_bench::run::figures::Figures;
use std::collections::BTreeMap;

/// The catalogue as a study.
///
/// # Errors
/// [`CatalogueError`](super::plan::CatalogueError).
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let run = || Plan::new(extent, Vec::new())?.run(progress);
    Ok(report(&run()?, extent))
}

/// Promises, the user's own scenes, sweeps, what differs from levitation alone, and a folded chapter for every scene.
/// Deterministic.
pub fn report(catalogue: &Catalogue, extent: Extent) -> Report {
    let how = extent.pick(
        "A quick run: 20 kHz, three seeds, one cap for P1",
        "10 and 20 kHz, twenty seeds",
    );
    let story = format!(
        "Every scene under every policy. {how}, 1 µm of sensor noise. Plants P1 to P4 are `firmware-host/scenes/plants`; who takes part and how the scenes are sized is said in `docs/src/measured/overloads.md`, and why some claims do not hold."
    );
    let mut chapters = vec![Chapter::new("What was run", vec![Block::text(story)])];
    chapters.extend(own_scenes(catalogue));
    let sweeps = "Radial impact from the middle that is recovered from, on a grid of 5 %, all slower ones too [m/s]; whirl at take-over as a share of v_lim; time to arrest 0.85 v_lim down to a quarter [ms]. Medians over the seeds, with the lowest in brackets where it differs.";
    chapters.push(Chapter::new(
        "Hardest impact, fastest whirl",
        vec![
            Block::text(sweeps.to_owned()),
            Block::table(SWEEP_COLUMNS, catalogue.sweeps.iter().map(sweep_row)),
        ],
    ));
    chapters.push(Chapter::new(
        "Against levitation alone",
        against_alone(&catalogue.against_levitation),
    ));
    chapters.extend(
        (by_scene(catalogue.results.iter()).into_iter())
            .map(|(name, rows)| Chapter::folded(name, vec![scene(&rows)])),
    );
    Report {
        classes: Vec::new(),
        title: "Catalogue of overloads".to_owned(),
        claims: catalogue.promises.clone(),
        cases: catalogue.results.len() as u64,
        chapters,
    }
}

/// All of them in one line for each group of scenes, and those that differ one by one.
fn against_alone(harms: &[Harm]) -> Vec<Block> {
    let (differing, same): (Vec<&Harm>, Vec<&Harm>) =
        harms.iter().partition(|h| is_worth_telling(h));
    let groups_are = "Largest contact force of the supervisor over that of its own inner loop alone, seed by seed; 1 where neither touches. Each place and scene has the median over its seeds; here are the median and the 95th percentile of these in each group, and in how many the supervisor recovers from fewer seeds, beyond chance, and from more.";
    let differing_are = format!(
        "Recovered: seeds with and without the supervisor. Of {} places and scenes these are the ones where the supervisor recovers from more or fewer, or where the force is more than 2 % higher; in the other {} it recovers from as many and the force is the same or lower. All of them are in `overloads.json`.",
        harms.len(),
        same.len()
    );
    let line = |harm: &Harm| {
        [
            harm.place.clone(),
            format!("{:.2}", harm.force_ratio),
            format!("{:.2}", harm.force_ratio_95),
            format!("{} of {}", harm.recovered, harm.seeds),
            harm.recovered_alone.to_string(),
        ]
    };
    vec![
        Block::text(groups_are.to_owned()),
        Block::table(GROUP_COLUMNS, groups(harms).iter().map(Group::cells)),
        Block::text(differing_are),
        Block::table(
            ["plant, rate: scene", "median", "95 %", "recovered", "alone"],
            differing.into_iter().map(line),
        ),
    ]
}

/// Of [`Group::cells`].
const GROUP_COLUMNS: [&str; 8] = [
    "group",
    "scenes and places",
    "median",
    "95 %",
    "above 1.1",
    "fewer recovered",
    "beyond chance",
    "more",
];

/// A group of scenes and places against levitation alone.
#[derive(Debug, Clone)]
struct Group<'a> {
    name: &'a str,
    ratios: Vec<f64>,
    fewer: usize,
    lost: usize,
    more: usize,
}

impl Group<'_> {
    fn above(&self) -> usize {
        self.ratios.iter().filter(|r| **r > 1.1).count()
    }

    /// Whether the supervisor does harm somewhere in it.
    fn is_harmed(&self) -> bool {
        self.above() + self.lost > 0
    }

    /// As text.
    fn cells(&self) -> [String; GROUP_COLUMNS.len()] {
        [
            self.name.to_owned(),
            self.ratios.len().to_string(),
            format!("{:.3}", percentile(&self.ratios, 0.5)),
            format!("{:.3}", percentile(&self.ratios, 0.95)),
            self.above().to_string(),
            self.fewer.to_string(),
            self.lost.to_string(),
            self.more.to_string(),
        ]
    }
}

/// The groups by their names, and all of them.
fn groups(harms: &[Harm]) -> Vec<Group<'_>> {
    let mut groups: BTreeMap<&str, Vec<&Harm>> = BTreeMap::new();
    for harm in harms {
        groups.entry(harm.group).or_default().push(harm);
    }
    let all = ("all", harms.iter().collect());
    let group = |(name, harms): (_, Vec<&Harm>)| {
        let count = |is: fn(&Harm) -> bool| harms.iter().filter(|h| is(h)).count();
        Group {
            name,
            ratios: force_ratios(harms.iter().copied()),
            fewer: count(|h| h.recovered < h.recovered_alone),
            lost: count(lost_beyond_chance),
            more: count(|h| h.recovered > h.recovered_alone),
        }
    };
    groups.into_iter().chain([all]).map(group).collect()
}

fn is_worth_telling(harm: &Harm) -> bool {
    harm.recovered != harm.recovered_alone || harm.force_ratio > 1.02 || harm.force_ratio_95 > 1.10
}

const SWEEP_COLUMNS: [&str; 8] = [
    "plant",
    "rate [kHz]",
    "policy",
    "impact",
    "10 % off the centre",
    "whirl",
    "arrest",
    "closed form",
];

fn sweep_row(row: &SweepRow) -> [String; SWEEP_COLUMNS.len()] {
    let cell = |values: &[f64], factor: f64, digits: usize| match values.first() {
        None => "–".to_owned(),
        Some(lowest) => {
            let (middle, lowest) = (factor * median(values), factor * lowest);
            let (middle, lowest) = (format!("{middle:.digits$}"), format!("{lowest:.digits$}"));
            if middle == lowest {
                middle
            } else {
                format!("{middle} ({lowest})")
            }
        }
    };
    // A time counts where every seed arrests it.
    let arrest = if row.arrest_s.len() == row.whirl_share.len() {
        cell(&row.arrest_s, 1e3, 2)
    } else {
        "–".to_owned()
    };
    [
        row.plant.clone(),
        format!("{:.0}", 1e-3 * row.rate_hz),
        row.policy.to_owned(),
        cell(&row.impact_m_s, 1.0, 3),
        cell(&row.offset_impact_m_s, 1.0, 3),
        cell(&row.whirl_share, 1.0, 2),
        arrest,
        format!("{:.2}", 1e3 * row.closed_form_s),
    ]
}

fn by_scene<'a>(
    rows: impl Iterator<Item = &'a ResultRow>,
) -> BTreeMap<&'a str, Vec<&'a ResultRow>> {
    let mut scenes: BTreeMap<&str, Vec<&ResultRow>> = BTreeMap::new();
    for row in rows {
        scenes.entry(&row.scene).or_default().push(row);
    }
    scenes
}

/// A chapter for each scene of the user's own.
fn own_scenes(catalogue: &Catalogue) -> Vec<Chapter> {
    let own = by_scene(catalogue.results.iter().filter(|row| row.is_own()));
    (own.into_iter())
        .map(|(name, rows)| Chapter::new(format!("Own scene: {name}"), vec![scene(&rows)]))
        .collect()
}

/// Where the supervisor does harm, and the user's own scenes.
pub fn in_brief(catalogue: &Catalogue) -> Vec<Chapter> {
    let groups = groups(&catalogue.against_levitation);
    let harmed: Vec<&Group<'_>> = groups.iter().filter(|group| group.is_harmed()).collect();
    let mut chapters = Vec::new();
    if !harmed.is_empty() {
        chapters.push(Chapter::new(
            "Largest contact force over levitation alone, by groups with a median above 1.1 or recoveries lost beyond chance",
            vec![
                Block::table(GROUP_COLUMNS, harmed.into_iter().map(Group::cells)),
                Block::text("why: docs/src/measured/overloads.md"),
            ],
        ));
    }
    chapters.extend(own_scenes(catalogue));
    chapters
}

/// A scene in figures, medians over the seeds.
fn scene(results: &[&ResultRow]) -> Block {
    Block::table(SCENE_COLUMNS, scene_rows(results))
}

/// Columns of the table of a scene.
const SCENE_COLUMNS: [&str; 12] = [
    "plant",
    "rate [kHz]",
    "policy",
    "recovered",
    "outcomes",
    "touches",
    "over 20 mm/s",
    "peak force [N]",
    "impulse [N s]",
    "contact [ms]",
    "backward [m/s]",
    "back after [ms]",
];

/// A scene in figures, medians over the seeds: a row for each plant, rate and policy.
fn scene_rows(results: &[&ResultRow]) -> Vec<[String; SCENE_COLUMNS.len()]> {
    let mut groups: BTreeMap<(&str, u64, usize), Vec<&ResultRow>> = BTreeMap::new();
    for row in results {
        // The supervisor comes first. Policies of a scene of one's own that have no contender come last: there is one,
        // `levitation`.
        let order = (Contender::ALL.iter()).position(|s| s.name() == row.policy);
        let order = match row.policy == Contender::Supervisor.name() {
            true => 0,
            false => 1 + order.unwrap_or(Contender::ALL.len()),
        };
        let key = (row.plant.as_str(), row.rate_hz as u64, order);
        groups.entry(key).or_default().push(row);
    }
    (groups.into_iter())
        .map(|((plant, rate, _), rows)| scene_row(plant, rate, &rows))
        .collect()
}

fn scene_row(plant: &str, rate_hz: u64, rows: &[&ResultRow]) -> [String; SCENE_COLUMNS.len()] {
    let of = |value: &dyn Fn(&Figures) -> f64| {
        let values = rows.iter().filter_map(|r| r.metrics.as_ref().map(value));
        median_of(values.filter(|x| !x.is_nan()))
    };
    let mut outcomes: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows {
        let outcome = match (&row.metrics, &row.error) {
            (Some(m), _) => m.outcome.name().to_owned(),
            (None, Some(error)) => error.clone(),
            (None, None) => String::new(),
        };
        *outcomes.entry(outcome).or_default() += 1;
    }
    let outcomes: Vec<String> = outcomes
        .into_iter()
        .map(|(outcome, n)| format!("{outcome} {n}"))
        .collect();
    let recovered = rows.iter().filter(|r| r.recovered()).count();
    let back = of(&|m| m.relevitation_time_s.unwrap_or(f64::NAN));
    [
        plant.to_owned(),
        (1e-3 * rate_hz as f64).to_string(),
        rows.first().map_or("", |r| r.policy).to_owned(),
        format!("{recovered} of {}", rows.len()),
        outcomes.join(", "),
        // Dashes where no run of these can be trusted.
        figures(of(&|m| m.impacts as f64)),
        figures(of(&|m| m.contacts_over_20_mm_s as f64)),
        figures(of(&|m| m.peak_contact_force_n)),
        figures(of(&|m| m.contact_impulse_n_s)),
        figures(1e3 * of(&|m| m.contact_time_s)),
        figures(of(&|m| m.peak_backward_speed_m_s)),
        figures(1e3 * back),
    ]
}
