//! Rotors in two planes that confirm their configuration.

use super::{BEFORE_S, Change, WINDOW, WINDOWS};
use crate::campaign::{Progress, run_all};
use crate::machines::rotors::{Class, RotorCase};
use firmware_bench::run::closed_loop::{Accuracy, Recorders, record};
use firmware_bench::run::trace::{Recorder, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use supervisor::{Checked, Finding};

/// Lets the planes of a rotor confirm their configuration, with a mistake in it or without, for as long as that takes.
pub(super) fn confirms(scene: &mut Scene, change: Option<Change>) {
    let mut longest_s = WINDOW.0;
    for plane in &mut scene.planes {
        if let Some(config) = &mut plane.supervisor {
            longest_s = longest_s.max(WINDOW.1 * f64::from(config.scaling().time_s));
            config.check_first = 1.0;
            if let Some(change) = change {
                change(config);
            }
        }
    }
    scene.duration_s = BEFORE_S + 2.0 * WINDOWS * longest_s;
}

/// Two planes that confirm their configuration: the outcome of each.
fn rotor(
    seed: u64,
    class: Class,
    number: u64,
    change: Option<Change>,
) -> Result<[Checked; 2], String> {
    let case = RotorCase::new(seed, class, number);
    let mut scene = Scene::parse(&case.text(), &case.toml()).map_err(|error| error.to_string())?;
    confirms(&mut scene, change);
    let mut rows = [Unread, Unread];
    let recorders = Recorders::of_planes(&mut rows);
    let ended = record(
        &scene,
        PolicyKind::Supervisor,
        recorders,
        Accuracy::default(),
        &mut |_| {},
    );
    let ended = ended.map_err(|error| error.to_string())?;
    let mut checked = ended
        .iter()
        .filter_map(|(_, read_out)| Some(read_out.as_ref()?.report.checked));
    match (checked.next(), checked.next()) {
        (Some(first), Some(second)) => Ok([first, second]),
        _ => Err("no supervisor of both planes".to_owned()),
    }
}

/// Rows that nobody reads.
#[derive(Debug)]
struct Unread;

impl Recorder for Unread {
    fn row(&mut self, _row: &TraceRow) {}
}

const CLASSES: [Class; 5] = [
    Class::Rigid,
    Class::Gyroscopic,
    Class::Flexible,
    Class::Bent,
    Class::Sealed,
];
/// Mistakes of a rotor: nothing, and some that the shaft does not correct.
const OF_ROTOR: [(&str, Option<Change>); 3] = [
    ("none", None),
    ("period × 2", Some(|c| c.sample_period_s *= 2.0)),
    ("delay + 3 samples", Some(|c| c.delay_samples += 3.0)),
];

/// Rotors by class and mistake.
pub(super) fn rotors(
    seed: u64,
    number: u64,
    progress: &dyn Progress,
) -> (Vec<[String; 6]>, Vec<String>) {
    let mut jobs = Vec::new();
    for class in CLASSES {
        for (mistake, _) in OF_ROTOR.iter().enumerate() {
            jobs.extend((0..number).map(|number| (class, mistake, number)));
        }
    }
    let tried = run_all(&jobs, progress, |(class, mistake, number)| {
        rotor(seed, *class, *number, OF_ROTOR[*mistake].1)
    });
    let (mut rows, mut odd) = (Vec::new(), Vec::new());
    for class in CLASSES {
        for (mistake, (name, _)) in OF_ROTOR.iter().enumerate() {
            let own = || {
                jobs.iter()
                    .zip(&tried)
                    .filter(move |((c, m, _), _)| *c == class && *m == mistake)
            };
            let count = |is: &dyn Fn(&[Checked; 2]) -> bool| {
                own().filter(|(_, t)| t.as_ref().is_ok_and(is)).count()
            };
            let found = count(&|both| both.iter().any(|c| c.finding.is_contradiction()));
            let passed = count(&|both| both.iter().all(|c| c.finding == Finding::Passed));
            let no_run = own().filter(|(_, t)| t.is_err()).count();
            let all = own().count();
            let cells =
                [all, found, passed, all - found - passed - no_run, no_run].map(|n| n.to_string());
            let [all, found, passed, not_yet, no_run] = cells;
            rows.push([
                format!("{}, {name}", class.name()),
                all,
                found,
                passed,
                not_yet,
                no_run,
            ]);
            odd.extend(
                own()
                    .filter(|(_, t)| {
                        mistake == 0
                            && !t
                                .as_ref()
                                .is_ok_and(|both| both.iter().all(|c| c.finding == Finding::Passed))
                    })
                    .map(|((_, _, number), t)| {
                        format!(
                            "{name}: {t:?}: {}",
                            RotorCase::new(seed, class, *number).text()
                        )
                    }),
            );
        }
    }
    (rows, odd)
}
