//! The catalogue as a page in Markdown, for people and for the documentation.

use super::plan::{Catalogue, Extent};
use super::promises::{Harm, Promise, force_ratios, lost_beyond_chance, percentile};
use super::results::{Metrics, ResultRow};
use super::seats::Seat;
use super::sweeps::{SweepRow, median, median_of};
use super::words::{argument, plain, slug};
use firmware_bench::report::plot::text::figures;
use firmware_bench::report::table::outcome;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The summary: promises, sweeps, and every scene in one line a plant, with the user's own scenes by their files.
/// Deterministic.
pub fn summary(catalogue: &Catalogue, extent: Extent, own: &[PathBuf]) -> String {
    let mut page = String::from("# Catalogue of overloads\n\n");
    let how = match extent {
        Extent::Quick => "a quick run: 20 kHz, three seeds, one cap for P1",
        Extent::Full => "10 and 20 kHz, twenty seeds, 1 µm of sensor noise",
    };
    line(
        &mut page,
        &format!(
            "Every scene under every policy, {how}. Plants P1 to P4 are `firmware-host/scenes/plants`; who takes part and how the scenes are sized is said in `docs/src/host/overloads-explained.md`, and why some promises do not hold. Repeat with\n\n```sh\ncargo run --release -- overloads{}{}\n```\n\n## Promises\n",
            if extent == Extent::Quick {
                " --quick"
            } else {
                ""
            },
            own.iter()
                .map(|file| format!(" --scene {}", argument(file)))
                .collect::<String>()
        ),
    );
    let kept = catalogue.promises.iter().filter(|p| p.holds).count();
    line(
        &mut page,
        &format!("{kept} of {} hold.\n", catalogue.promises.len()),
    );
    line(
        &mut page,
        "| promise | bound | measured | holds |\n| --- | --- | --- | --- |",
    );
    for promise in &catalogue.promises {
        line(&mut page, &promise_row(promise));
    }
    for (name, results) in own_scenes(catalogue) {
        line(&mut page, &format!("\n## Own scene: {}\n", plain(name)));
        push_scene(&mut page, &results);
    }
    line(&mut page, "\n## Hardest impact, fastest whirl\n");
    line(
        &mut page,
        "Radial impact from the middle that is recovered from, on a grid of 5 %, all slower ones too [m/s]; whirl at take-over as a share of v_lim; time to arrest 0.85 v_lim down to a quarter [ms]. Medians over the seeds, with the lowest in brackets where it differs.\n",
    );
    line(
        &mut page,
        "| plant | rate [kHz] | policy | impact | 10 % off the centre | whirl | arrest | closed form |\n| --- | --- | --- | --- | --- | --- | --- | --- |",
    );
    for row in &catalogue.sweeps {
        line(&mut page, &sweep_row(row));
    }
    line(&mut page, "\n## Against levitation alone\n");
    push_groups(&mut page, &catalogue.against_levitation);
    let (told, same): (Vec<&Harm>, Vec<&Harm>) =
        (catalogue.against_levitation.iter()).partition(|h| is_worth_telling(h));
    line(
        &mut page,
        &format!(
            "\nRecovered: seeds with and without the supervisor. Of {} places and scenes these are the ones where the supervisor recovers from more or fewer, or where the force is more than 2 % higher; in the other {} it recovers from as many and the force is the same or lower. All of them are in `overloads.json` and on the pages of the scenes.\n",
            told.len() + same.len(),
            same.len()
        ),
    );
    line(
        &mut page,
        "| plant, rate: scene | median | 95 % | recovered | alone |\n| --- | --- | --- | --- | --- |",
    );
    for harm in told {
        line(
            &mut page,
            &format!(
                "| {} | {:.2} | {:.2} | {} of {} | {} |",
                plain(&harm.place),
                harm.force_ratio,
                harm.force_ratio_95,
                harm.recovered,
                harm.seeds,
                harm.recovered_alone
            ),
        );
    }
    page
}

/// All of them in one line for each group of scenes.
fn push_groups(page: &mut String, harms: &[Harm]) {
    line(
        page,
        "Largest contact force of the supervisor over that of its own inner loop alone, seed by seed; 1 where neither touches. Each place and scene has the median over its seeds; here are the median and the 95th percentile of these in each group, and in how many the supervisor recovers from fewer seeds, beyond chance, and from more.\n",
    );
    line(page, &format!("| {} |", GROUP_COLUMNS.join(" | ")));
    line(page, &format!("{}|", "| --- ".repeat(GROUP_COLUMNS.len())));
    for group in groups(harms) {
        line(page, &format!("| {} |", group.cells().join(" | ")));
    }
}

/// Of [`Group::cells`].
pub const GROUP_COLUMNS: [&str; 8] = [
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
pub struct Group<'a> {
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
    pub fn is_harmed(&self) -> bool {
        self.above() + self.lost > 0
    }

    /// As text.
    pub fn cells(&self) -> [String; GROUP_COLUMNS.len()] {
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
pub fn groups(harms: &[Harm]) -> Vec<Group<'_>> {
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

fn line(page: &mut String, text: &str) {
    page.push_str(text);
    page.push('\n');
}

fn promise_row(p: &Promise) -> String {
    let holds = if p.holds { "yes" } else { "**no**" };
    format!(
        "| {} | {} | {:.3} | {holds} |",
        p.name,
        p.bound(),
        p.measured
    )
}

fn sweep_row(row: &SweepRow) -> String {
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
    format!(
        "| {} | {:.0} | {} | {} | {} | {} | {arrest} | {:.2} |",
        row.plant,
        1e-3 * row.rate_hz,
        row.policy,
        cell(&row.impact_m_s, 1.0, 3),
        cell(&row.offset_impact_m_s, 1.0, 3),
        cell(&row.whirl_share, 1.0, 2),
        1e3 * row.closed_form_s
    )
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

/// The user's own scenes: title and runs.
pub fn own_scenes(catalogue: &Catalogue) -> BTreeMap<&str, Vec<&ResultRow>> {
    by_scene(catalogue.results.iter().filter(|row| row.is_own()))
}

/// A page for each scene: file name and text.
pub fn scenes(catalogue: &Catalogue) -> Vec<(String, String)> {
    (by_scene(catalogue.results.iter()).into_iter())
        .map(|(name, rows)| (format!("{}.md", slug(name)), scene_page(name, &rows)))
        .collect()
}

/// Columns of the table of a scene.
pub const SCENE_COLUMNS: [&str; 12] = [
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
pub fn scene_rows(results: &[&ResultRow]) -> Vec<[String; SCENE_COLUMNS.len()]> {
    let mut groups: BTreeMap<(&str, u64, usize), Vec<&ResultRow>> = BTreeMap::new();
    for row in results {
        // Policies of a scene of one's own that have no seat come last: there is one, `levitation`.
        let order = (Seat::ALL.iter()).position(|s| s.name() == row.policy);
        let order = order.unwrap_or(Seat::ALL.len());
        let key = (row.plant.as_str(), row.rate_hz as u64, order);
        groups.entry(key).or_default().push(row);
    }
    (groups.into_iter())
        .map(|((plant, rate, _), rows)| scene_row(plant, rate, &rows))
        .collect()
}

fn scene_row(plant: &str, rate_hz: u64, rows: &[&ResultRow]) -> [String; SCENE_COLUMNS.len()] {
    let of = |value: &dyn Fn(&Metrics) -> f64| {
        let values = rows.iter().filter_map(|r| r.metrics.as_ref().map(value));
        median_of(values.filter(|x| !x.is_nan()))
    };
    let mut outcomes: BTreeMap<String, usize> = BTreeMap::new();
    for row in rows {
        let outcome = match (&row.metrics, &row.error) {
            (Some(m), _) => outcome(m.outcome).to_owned(),
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

fn push_scene(page: &mut String, results: &[&ResultRow]) {
    let of = |cells: &[String]| format!("| {} |", cells.join(" | "));
    line(page, &of(&SCENE_COLUMNS.map(str::to_owned)));
    line(page, &of(&SCENE_COLUMNS.map(|_| "---".to_owned())));
    for row in scene_rows(results) {
        line(page, &of(&row.map(|cell| plain(&cell))));
    }
}

fn scene_page(name: &str, results: &[&ResultRow]) -> String {
    let mut page = format!("# {}\n\nMedians over the seeds.\n\n", plain(name));
    push_scene(&mut page, results);
    page
}
