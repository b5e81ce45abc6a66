//! Controllers of the user's, by their filters.

use crate::device::biquads::{BiquadsParams, Section};
use crate::scene::arrays::Arrays;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::tables::BiquadsTable;

/// Numbers of a section.
const COLUMNS: usize = 6;
const MOST_SECTIONS: usize = 100;

/// The filters of each plane that has a magnet.
pub(crate) fn biquads(planes: &[PlaneSpec]) -> Result<Vec<Option<BiquadsParams>>, SceneError> {
    let of_plane = |plane: &PlaneSpec| {
        let text = &plane.text;
        let Some(magnet) = &plane.tables.magnet else {
            return Ok(None);
        };
        let written = plane.tables.biquads.as_ref().ok_or_else(|| {
            let key = text.plane.map(|i| format!("plane[{i}].biquads"));
            let give = "give [plane.biquads] to every plane with a magnet, or [biquads] for all";
            text.missing_at(&key.unwrap_or_default(), give.to_owned())
        })?;
        Ok(Some(BiquadsParams {
            gain_n_m: written.gain_n_m,
            sections: sections(written, text)?,
            force_max_n: magnet.force_max_n,
        }))
    };
    planes.iter().map(of_plane).collect()
}

fn sections(written: &BiquadsTable, text: &SceneText) -> Result<[Vec<Section>; 2], SceneError> {
    let (x, y) = ("biquads.sections", "biquads.sections_y");
    let Some(file) = &written.file else {
        let of_x = checked(x, &written.sections.0, text)?;
        let of_y = match written.sections_y.0.is_empty() {
            true => of_x.clone(),
            false => checked(y, &written.sections_y.0, text)?,
        };
        return Ok([of_x, of_y]);
    };
    let numbers = [
        (x, !written.sections.0.is_empty()),
        (y, !written.sections_y.0.is_empty()),
    ];
    let message = "stands in biquads.file already";
    text.none_given(&numbers, message, "remove one of them")?;
    let key = "biquads.file";
    let mut arrays = Arrays::load(text, (key, file), &["sos", "sos_y"])?;
    let row_by_row = |name: &str, matrix: nalgebra::DMatrix<f64>| {
        let (rows, columns) = matrix.shape();
        if columns != COLUMNS {
            let message =
                format!("{file}: {name} is {rows} × {columns}, expected {COLUMNS} columns");
            let help = "save sections as SciPy has them, a row each: b0, b1, b2, a0, a1, a2";
            return Err(text.error_at_key(key, message, Some(help.to_owned())));
        }
        let numbers: Vec<f64> = matrix.transpose().iter().copied().collect();
        checked(key, &numbers, text)
    };
    let of_x = row_by_row("sos", arrays.take("sos")?)?;
    let of_y = match arrays.take_if_there("sos_y")? {
        Some(matrix) => row_by_row("sos_y", matrix)?,
        None => of_x.clone(),
    };
    Ok([of_x, of_y])
}

/// Sections with a0 = 1 out of six numbers each.
fn checked(key: &str, numbers: &[f64], text: &SceneText) -> Result<Vec<Section>, SceneError> {
    let refused = |message: String| {
        let help = "six numbers a section: b0, b1, b2, a0, a1, a2".to_owned();
        Err(text.error_at_key(key, message, Some(help)))
    };
    let (rows, rest) = numbers.as_chunks::<COLUMNS>();
    if !rest.is_empty() {
        let count = numbers.len();
        return refused(format!("has {count} numbers, which is no multiple of six"));
    }
    if rows.len() > MOST_SECTIONS {
        let count = rows.len();
        return refused(format!("has {count} sections, at most {MOST_SECTIONS}"));
    }
    let mut sections = Vec::new();
    for (i, [b0, b1, b2, a0, a1, a2]) in rows.iter().enumerate() {
        let section = Section {
            b: [b0 / a0, b1 / a0, b2 / a0],
            a: [a1 / a0, a2 / a0],
        };
        if !section.b.iter().chain(&section.a).all(|x| x.is_finite()) {
            let message = format!("section {} over its a0 = {a0} is not finite", i + 1);
            return refused(message);
        }
        sections.push(section);
    }
    Ok(sections)
}
