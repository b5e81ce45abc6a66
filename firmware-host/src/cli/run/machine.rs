//! A scene of a whole rotor.

use super::{
    Ran, RunArgs, VERDICT, contradictions, each_policy, failed, record_name, undrawn, write_records,
};
use crate::cli::error::{CommandError, pretty};
use crate::cli::output::{OutputError, Staging};
use firmware_bench::report::{self, table};
use firmware_bench::run::recording::{MachineFiles, recorded_machine};
use firmware_bench::run::trace_columns::Columns;
use firmware_bench::run::verdict::MachineResults;
use firmware_bench::run::verify;
use firmware_bench::scene::machine::{MachineScene, in_file_names};
use std::fs::File;

pub(super) fn run(
    scene: &MachineScene,
    args: &RunArgs,
    staging: &Staging,
) -> Result<Ran, CommandError> {
    let results = run_all(scene, args, staging)?;
    let verdicts = pretty(&table::machine_json(scene, &results), VERDICT)? + "\n";
    staging.write("verdict.json", &verdicts)?;
    let mut contradicted = Vec::new();
    for (plane, runs) in scene.planes.iter().zip(&results.planes) {
        let name = in_file_names(&plane.name);
        write_records(staging, runs, |policy| {
            record_name(&format!("{policy}_{name}"))
        })?;
        for mut contradiction in contradictions(runs) {
            contradiction.policy = format!("{}, {}", contradiction.policy, plane.name);
            contradicted.push(contradiction);
        }
    }
    let html = report::machine::html(scene, &results).map_err(undrawn)?;
    staging.write("report.html", html)?;
    Ok(Ran {
        table: table::machine_text(scene, &results),
        verdicts,
        untrusted: (results.whole.untrusted().into_iter())
            .map(str::to_owned)
            .collect(),
        contradictions: contradicted,
    })
}

fn run_all(
    scene: &MachineScene,
    args: &RunArgs,
    staging: &Staging,
) -> Result<MachineResults, CommandError> {
    let common = scene.common();
    let checks = match args.verify {
        true => verify::check_machine_scenes(scene)
            .map_err(|error| CommandError::other("setting up the checks", error))?
            .to_vec(),
        false => Vec::new(),
    };
    let checking = args.verify.then_some(&checks[..]);
    let all = each_policy(common, args, checks.len(), |kind, on_tick| {
        let names = Names::new(scene, kind.name());
        let mut files = match args.no_trace {
            true => None,
            false => Some(names.begin(scene, (args, kind.name()), staging)?),
        };
        let ran = recorded_machine(scene, kind, checking, files.as_mut(), on_tick);
        match (&ran, files) {
            (Ok(_), Some(files)) => names.end(files, staging)?,
            (Err(_), Some(_)) => names.discard(staging)?,
            _ => {}
        }
        Ok(ran)
    })?;
    let mut results = MachineResults::default();
    for (kind, ran) in common.policies.iter().zip(all) {
        match ran {
            Ok(run) => results.push(run),
            Err(error) => results.whole.failed.push(failed(*kind, &error)),
        }
    }
    Ok(results)
}

/// Names of the trace files of a policy.
struct Names {
    planes: Vec<String>,
    axis: String,
}

impl Names {
    fn new(scene: &MachineScene, policy: &str) -> Self {
        let planes = scene.planes.iter().map(|plane| in_file_names(&plane.name));
        Self {
            planes: planes
                .map(|plane| super::trace_name(&format!("{policy}_{plane}")))
                .collect(),
            axis: format!("axis_{policy}.parquet"),
        }
    }

    fn begin(
        &self,
        scene: &MachineScene,
        (args, policy): (&RunArgs, &str),
        staging: &Staging,
    ) -> Result<MachineFiles<File>, OutputError> {
        let about = |plane| args.about(scene.common(), policy, plane);
        let planes = self.planes.iter().zip(&scene.planes).map(|(name, plane)| {
            let columns = Columns::of_plane().about(about(Some(&plane.name)));
            staging.trace(name, columns)
        });
        let modes = scene.machine.rotor.bending().len();
        Ok(MachineFiles {
            planes: planes.collect::<Result<_, _>>()?,
            axis: staging.trace(&self.axis, Columns::of_axis(modes).about(about(None)))?,
        })
    }

    fn end(&self, files: MachineFiles<File>, staging: &Staging) -> Result<(), OutputError> {
        for (name, file) in self.planes.iter().zip(files.planes) {
            staging.end_trace(name, file)?;
        }
        staging.end_trace(&self.axis, files.axis)
    }

    fn discard(&self, staging: &Staging) -> Result<(), OutputError> {
        for name in self.planes.iter().chain([&self.axis]) {
            staging.discard(name)?;
        }
        Ok(())
    }
}
