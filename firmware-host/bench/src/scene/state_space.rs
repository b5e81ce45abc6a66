//! Controllers of the user's, by their matrices.

use crate::device::state_space::StateSpaceParams;
use crate::scene::arrays::Arrays;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::tables::SceneTables;
use nalgebra::DMatrix;

const MOST_STATES: usize = 500;
/// Products of such numbers are finite still; eigenvalues of a matrix in which they are not are sought without end.
const LARGEST: f64 = 1e30;

/// The controller of `[state_space]` for stations with a cap each, where they have a magnet.
pub(crate) fn state_space(
    tables: &SceneTables,
    text: &SceneText,
    caps_n: Vec<Option<f64>>,
) -> Result<Option<StateSpaceParams>, SceneError> {
    let Some(written) = &tables.state_space else {
        return Ok(None);
    };
    let readings = 2 * caps_n.len();
    let forces = 2 * caps_n.iter().flatten().count();
    let key = "state_space";
    let wrong = |key: &str, message: String| {
        let help = format!(
            "{readings} readings, x and y of each plane; {forces} forces, x and y of each plane with a magnet"
        );
        text.error_at_key(key, message, Some(help))
    };
    let [a, b, c, d] = match &written.file {
        Some(file) => {
            let of_numbers = [
                ("state_space.a", !written.a.0.is_empty()),
                ("state_space.b", !written.b.0.is_empty()),
                ("state_space.c", !written.c.0.is_empty()),
                ("state_space.d", !written.d.0.is_empty()),
            ];
            let message = "stands in state_space.file already";
            text.none_given(&of_numbers, message, "remove one of them")?;
            let known = ["A", "B", "C", "D"];
            let mut arrays = Arrays::load(text, ("state_space.file", file), &known)?;
            match (arrays.take_if_there("A")?, arrays.take_if_there("D")?) {
                // Without state.
                (None, Some(d)) => [
                    DMatrix::zeros(0, 0),
                    DMatrix::zeros(0, readings),
                    DMatrix::zeros(forces, 0),
                    d,
                ],
                (a, d) => [
                    a.map_or_else(|| arrays.take("A"), Ok)?,
                    arrays.take("B")?,
                    arrays.take("C")?,
                    d.unwrap_or_else(|| DMatrix::zeros(forces, readings)),
                ],
            }
        }
        None => {
            let count = written.a.0.len();
            let states = (count as f64).sqrt().round() as usize;
            if states * states != count {
                let message = format!("has {count} numbers, no square of a number of states");
                return Err(wrong("state_space.a", message));
            }
            let part = |name: &str, numbers: &[f64], rows: usize, columns: usize| {
                let (count, wanted) = (numbers.len(), rows * columns);
                if count != wanted {
                    let message =
                        format!("has {count} numbers, expected {rows} × {columns} = {wanted}");
                    return Err(wrong(&format!("{key}.{name}"), message));
                }
                Ok(DMatrix::from_row_slice(rows, columns, numbers))
            };
            let d = match written.d.0.is_empty() && states > 0 {
                true => DMatrix::zeros(forces, readings),
                false => part("d", &written.d.0, forces, readings)?,
            };
            [
                part("a", &written.a.0, states, states)?,
                part("b", &written.b.0, states, readings)?,
                part("c", &written.c.0, forces, states)?,
                d,
            ]
        }
    };
    let states = a.nrows();
    if states > MOST_STATES {
        return Err(wrong(
            key,
            format!("has {states} states, at most {MOST_STATES}"),
        ));
    }
    let sizes = [
        ("A", &a, (states, states)),
        ("B", &b, (states, readings)),
        ("C", &c, (forces, states)),
        ("D", &d, (forces, readings)),
    ];
    for (name, matrix, (rows, columns)) in sizes {
        if matrix.shape() != (rows, columns) {
            let (found, wide) = matrix.shape();
            let message = format!("{name} is {found} × {wide}, expected {rows} × {columns}");
            return Err(wrong(key, message));
        }
        if let Some(x) = matrix.iter().find(|x| !x.is_finite() || x.abs() > LARGEST) {
            let key = match &written.file {
                Some(_) => "state_space.file".to_owned(),
                None => format!("{key}.{}", name.to_lowercase()),
            };
            let message = format!("{name} has {x:e}, expected numbers from -1e30 to 1e30");
            return Err(wrong(&key, message));
        }
    }
    Ok(Some(StateSpaceParams { a, b, c, d, caps_n }))
}
