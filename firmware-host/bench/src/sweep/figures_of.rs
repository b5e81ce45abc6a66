//! A run's figures as cells of a row.

use crate::run::closed_loop::{Accuracy, PlaneEnded, Recorders, RunError, record};
use crate::run::columns::{Cell, Column, Columnar};
use crate::run::figures::Figures;
use crate::run::supervision::{Supervision, SupervisionCount};
use crate::scene::policy_kind::PolicyKind;
use crate::scene::{PlaneScene, Scene};

/// Columns of all figures of a scene: those that `run` prints, but for what a run took, which is never twice the same. Of
/// several planes those of each follow, with the plane's name before a point.
pub fn columns(scene: &Scene) -> Vec<Column> {
    let mut columns = Vec::new();
    Figures::columns("", &mut columns);
    match &scene.planes[..] {
        [_] => Supervision::columns("", &mut columns),
        planes => {
            for name in planes.iter().map(PlaneScene::name_in_files) {
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
pub fn cells(scene: &Scene, kind: PolicyKind) -> Result<Vec<Cell>, RunError> {
    let mut cells = Vec::new();
    // Nobody listens where no supervisor speaks.
    let mut counts = match kind == PolicyKind::Supervisor {
        true => vec![SupervisionCount::default(); scene.planes.len()],
        false => Vec::new(),
    };
    let recorders = Recorders::of_planes(&mut counts);
    let ended = record(scene, kind, recorders, Accuracy::default(), &mut |_| {})?;
    if let [only] = &ended[..] {
        plane_cells(only, counts.first(), &mut cells);
        return Ok(cells);
    }
    let figures: Vec<Figures> = ended.iter().map(|(figures, _)| figures.clone()).collect();
    Figures::cells(Figures::of_machine(&figures).as_ref(), &mut cells);
    for (i, ended) in ended.iter().enumerate() {
        plane_cells(ended, counts.get(i), &mut cells);
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
