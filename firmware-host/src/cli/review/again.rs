//! `review --scene`: the event once more, on a scene's machine.

use crate::cli::error::CommandError;
use firmware_bench::record::file::PlaneRecord;
use firmware_bench::record::identify::Findings;
use firmware_bench::record::narrative::Event;
use firmware_bench::run::again::scene_of_event;
use firmware_bench::run::recording::recorded;
use firmware_bench::run::verdict::{FailedRun, Results};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::{Setting, Spec};
use std::fs::File;
use std::path::Path;
use supervisor::PARAMETERS;

/// The scene that was run, and its outcome.
pub(super) struct Again {
    pub(super) scene: Scene,
    pub(super) results: Results,
    /// Parameters of the supervisor that the scene gives other values than the record has.
    pub(super) differing: Vec<&'static str>,
}

/// Simulates the event with every policy, and where something is set with the supervisor on the scene so changed.
pub(super) fn simulate(
    (path, spec): (&Path, &Spec),
    settings: &[Setting],
    (event, findings): (&Event<'_>, &Findings),
) -> Result<Again, CommandError> {
    let of = (event.records[0], findings);
    let scene = scene_of_event(spec.clone(), of, &[])?;
    let differing = differing(of.0, &scene);
    if differing.contains(&"sample_period_s") {
        return Err(CommandError::Numbers {
            message: format!(
                "{}: run.sample_rate_hz is not the rate of the record",
                path.display()
            ),
            help: "give the scene of the machine that the record is of".to_owned(),
        });
    }
    let mut results = Results::default();
    for kind in &scene.policies {
        keep(&mut results, kind.name(), &scene, *kind);
    }
    if !settings.is_empty() {
        let other = scene_of_event(spec.clone(), of, settings)?;
        let texts: Vec<String> = settings.iter().map(Setting::to_string).collect();
        let name = format!("supervisor, {}", texts.join(", "));
        keep(&mut results, &name, &other, PolicyKind::Supervisor);
    }
    Ok(Again {
        scene,
        results,
        differing,
    })
}

/// What the scene has its retainer bearings bear in all, of each plane.
pub(super) fn allowances(
    spec: &Spec,
    settings: &[Setting],
) -> Result<Vec<Option<f32>>, CommandError> {
    let mut spec = spec.clone();
    let set = (settings.iter()).map(|setting| (setting.path.as_str(), setting.value.clone()));
    spec.set_all(&set.collect::<Vec<_>>())?;
    let scene = spec.resolve()?;
    // A seal has no ledger.
    Ok((scene.planes.iter().filter(|plane| !plane.seal))
        .map(|plane| plane.severity_allowed.map(|allowed| allowed as f32))
        .collect())
}

/// Names of parameters of which record and scene have values more than a hundredth apart.
fn differing(record: &PlaneRecord, scene: &Scene) -> Vec<&'static str> {
    let (Some(recorded), Some(derived)) = (record.config, scene.planes[0].supervisor) else {
        return Vec::new();
    };
    let values = recorded.values().into_iter().zip(derived.values());
    let apart = |(a, b): (f32, f32)| (a - b).abs() > 0.01 * a.abs().max(b.abs());
    let named = PARAMETERS.iter().zip(values);
    named
        .filter(|(_, pair)| apart(*pair))
        .map(|(p, _)| p.name)
        .collect()
}

fn keep(results: &mut Results, name: &str, scene: &Scene, kind: PolicyKind) {
    let name = name.to_owned();
    match recorded::<File>(scene, kind, &[], None, &mut |_| {}) {
        Ok(mut run) => {
            for run in run.planes.iter_mut().chain([&mut run.whole]) {
                run.name.clone_from(&name);
            }
            results.push(run);
        }
        Err(error) => results.failed.push(FailedRun {
            name,
            error: error.to_string(),
        }),
    }
}
