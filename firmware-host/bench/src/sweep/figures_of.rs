//! A run's figures as cells of a row.

use crate::run::closed_loop::{
    Keep, MachineRecorders, PlaneEnded, Rigour, RunError, record, record_machine, run,
};
use crate::run::columns::{Cell, Column, InColumns};
use crate::run::figures::Figures;
use crate::run::supervision::{Supervision, SupervisionCount};
use crate::run::trace::Recorder;
use crate::scene::machine::{AnyScene, in_file_names};
use crate::scene::policy_kind::PolicyKind;

/// Columns of all figures of a scene: those that `run` prints, but for what a run took, which is never twice the same. Of a
/// whole rotor those of each plane follow, with the plane's name before a point.
pub fn columns(scene: &AnyScene) -> Vec<Column> {
    let mut columns = Vec::new();
    Figures::columns("", &mut columns);
    match scene {
        AnyScene::Plane(_) => Supervision::columns("", &mut columns),
        AnyScene::Machine(scene) => {
            for plane in &scene.planes {
                let name = in_file_names(&plane.name);
                Figures::columns(&name, &mut columns);
                Supervision::columns(&name, &mut columns);
            }
        }
    }
    columns
}

/// Runs a policy of a scene to its end; the cells of those columns.
///
/// # Errors
/// [`RunError`] of a run that cannot be trusted.
pub fn cells(scene: &AnyScene, kind: PolicyKind) -> Result<Vec<Cell>, RunError> {
    let mut cells = Vec::new();
    // Nobody listens where no supervisor speaks.
    let supervised = kind == PolicyKind::Supervisor;
    match scene {
        AnyScene::Plane(scene) if !supervised => {
            let (figures, _) = run(scene, kind, Keep::Verdict, &mut |_| {})?;
            Figures::cells(Some(&figures), &mut cells);
            Supervision::cells(None, &mut cells);
        }
        AnyScene::Plane(scene) => {
            let mut count = SupervisionCount::default();
            let ended = record(scene, kind, &mut count, Rigour::default(), &mut |_| {})?;
            plane_cells(&ended, Some(&count), &mut cells);
        }
        AnyScene::Machine(scene) => {
            let mut counts = match supervised {
                true => vec![SupervisionCount::default(); scene.planes.len()],
                false => Vec::new(),
            };
            let recorders = MachineRecorders {
                planes: counts
                    .iter_mut()
                    .map(|count| count as &mut dyn Recorder)
                    .collect(),
                axis: None,
            };
            let ended = record_machine(scene, kind, recorders, Rigour::default(), &mut |_| {})?;
            let figures: Vec<Figures> = ended.iter().map(|(figures, _)| figures.clone()).collect();
            Figures::cells(Figures::of_machine(&figures).as_ref(), &mut cells);
            for (i, ended) in ended.iter().enumerate() {
                plane_cells(ended, counts.get(i), &mut cells);
            }
        }
    }
    Ok(cells)
}

fn plane_cells(
    (figures, read_out): &PlaneEnded,
    count: Option<&SupervisionCount>,
    cells: &mut Vec<Cell>,
) {
    Figures::cells(Some(figures), cells);
    let supervision = count.and_then(|count| count.ended(read_out.as_ref()));
    Supervision::cells(supervision.as_ref(), cells);
}
