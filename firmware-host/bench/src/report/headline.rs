//! The conclusion of a page in a sentence or two, before any number.

use super::plot::text::figures;
use crate::record::narrative::percent;
use crate::run::figures::Figures;
use crate::run::outcome::Outcome;
use crate::run::supervision::Supervision;
use crate::run::verdict::PolicyRun;

/// A run as far as its conclusion goes.
pub(super) struct Concluded<'a> {
    run: &'a PolicyRun,
    /// What its supervisor did, of a rotor in each plane, with the severity index that asks for coasting down; empty where
    /// none ran.
    supervised: Vec<(&'a Supervision, Option<f32>)>,
}

impl<'a> Concluded<'a> {
    /// A run, with the outcome of each of its planes, and the severity limit of its supervisor.
    pub(super) fn of(
        run: &'a PolicyRun,
        planes: impl Iterator<Item = (&'a PolicyRun, Option<f32>)>,
    ) -> Self {
        let supervised =
            planes.filter_map(|(plane, limit)| Some((plane.supervision.as_ref()?, limit)));
        Self {
            run,
            supervised: supervised.collect(),
        }
    }

    /// Whether a supervisor ran.
    pub(super) fn is_supervised(&self) -> bool {
        !self.supervised.is_empty()
    }
}

/// Of runs of one scene: the outcome of the supervisor, of what it has seen, and of the others.
pub(super) fn headline(runs: &[Concluded<'_>]) -> String {
    let others: Vec<&PolicyRun> = (runs.iter())
        .filter(|of| !of.is_supervised())
        .map(|of| of.run)
        .collect();
    let Some(supervised) = runs.iter().find(|of| of.is_supervised()) else {
        return match others.is_empty() {
            true => "No policy has a run that can be trusted.".to_owned(),
            false => format!("Without a supervisor {}.", ends(&others)),
        };
    };
    let figures_of = &supervised.run.verdict.figures;
    let mut text = format!("With the supervisor {}", sentence(figures_of));
    let accounts =
        (supervised.supervised.iter()).filter_map(|(s, limit)| Some((s.account.as_ref()?, *limit)));
    let landed: Vec<_> = accounts
        .filter(|(account, _)| account.landings > 0)
        .collect();
    let used =
        (landed.iter()).filter_map(|(a, limit)| Some(a.severity_index / f64::from((*limit)?)));
    // Of planes the worst.
    if let Some(used) = used.reduce(f64::max) {
        let coast_down = match landed.iter().any(|(account, _)| account.coast_down) {
            true => "it asks for coasting down",
            false => "it does not ask for coasting down",
        };
        text += &format!(
            " It has used {} of what the retainer bearing is allowed; {coast_down}.",
            percent(used)
        );
    }
    if !others.is_empty() {
        text += &format!(" Without it {}.", ends(&others));
    }
    text
}

fn sentence(all: &Figures) -> String {
    let contact = match (all.impacts, all.first_contact_s) {
        (0, None) => " without contact".to_owned(),
        (impacts, _) => {
            let impulse = figures(all.contact_impulse_n_s);
            let word = if impacts == 1 { "impact" } else { "impacts" };
            format!(" after {impacts} {word} with a contact impulse of {impulse} N s")
        }
    };
    let back = all.relevitation_time_s.map_or(String::new(), |s| {
        format!(", {} ms after the last event", figures(1e3 * s))
    });
    format!("the rotor {}{contact}{back}.", end(all.outcome))
}

/// How each of the others ends with which contact impulse, those that end alike together, in their order.
fn ends(runs: &[&PolicyRun]) -> String {
    let mut alike: Vec<(Outcome, Vec<String>)> = Vec::new();
    for run in runs {
        let of = &run.verdict.figures;
        let name = match of.contact_impulse_n_s {
            impulse if impulse > 0.0 => format!("{}: {} N s", run.name, figures(impulse)),
            _ => run.name.clone(),
        };
        match alike.iter_mut().find(|(known, _)| *known == of.outcome) {
            Some((_, names)) => names.push(name),
            None => alike.push((of.outcome, vec![name])),
        }
    }
    let parts = alike
        .iter()
        .map(|(outcome, names)| format!("{} ({})", end(*outcome), names.join(", ")));
    format!("the rotor {}", parts.collect::<Vec<_>>().join(", "))
}

/// What the rotor does at the end.
fn end(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Recovered => "is back in the middle",
        Outcome::Decayed => "is free of the wall",
        Outcome::Diverging => "is free, but swings wider each time",
        Outcome::Resting => "rests on the retainer bearing",
        Outcome::Pinned => "is held against the retainer bearing by a load",
        Outcome::Rubbing => "rubs along the retainer bearing",
        Outcome::Bouncing => "is still bouncing",
        Outcome::Whirl => "whirls backward",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture::run;
    use crate::run::supervision::Account;

    #[test]
    fn the_conclusion_comes_first_and_names_all() {
        let mut supervised = run("supervisor", Outcome::Recovered, &[]);
        supervised.verdict.figures.contact_impulse_n_s = 13.1;
        supervised.verdict.figures.relevitation_time_s = Some(0.0243);
        supervised.supervision = Some(Supervision {
            engagements: 1,
            first_engaged_s: None,
            engaged_s: 0.0,
            longest_engagement_s: 0.0,
            handed_back: 0,
            sensor_faults: 0,
            expected_severity_max: 0.0,
            account: Some(Account {
                landings: 1,
                nuisance_engagements: 0,
                impact_speed_max_m_s: 0.0,
                backward_speed_max_m_s: 0.0,
                whirl_limit_m_s: 0.0,
                severity_index: 2.469,
                coast_down: false,
                checked: "unchecked",
                flight_record_crc: None,
            }),
        });
        let mut others = [
            run("passive", Outcome::Whirl, &[]),
            run("levitation", Outcome::Decayed, &[]),
            run("radial", Outcome::Whirl, &[]),
        ];
        others[1].verdict.figures.contact_impulse_n_s = 31.2;
        let runs = std::iter::once(&supervised).chain(&others);
        let limit = Some(20.0);
        let alone = |run| Concluded::of(run, std::iter::once((run, limit)));
        let all: Vec<Concluded<'_>> = runs.map(alone).collect();
        assert_eq!(
            headline(&all),
            "With the supervisor the rotor is back in the middle after 1 impact with a contact impulse of 13.1 N s, \
             24.3 ms after the last event. It has used 12 % of what the retainer bearing is allowed; it does not ask for \
             coasting down. Without it the rotor whirls backward (passive, radial), is free of the wall (levitation: 31.2 N s)."
        );
        assert!(
            headline(&all[1..])
                .starts_with("Without a supervisor the rotor whirls backward (passive, radial)")
        );
        assert!(headline(&[]).contains("No policy"));
        // Of a rotor the planes have the supervisors.
        let whole = run("supervisor", Outcome::Recovered, &[]);
        let planes = [supervised.clone(), supervised];
        let planes = planes.iter().zip([Some(10.0), limit]);
        let rotor = Concluded::of(&whole, planes);
        assert!(headline(&[rotor]).contains("It has used 25 % of what"));
    }
}
