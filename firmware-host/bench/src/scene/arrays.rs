//! Matrices from files of NumPy, as a scene names them, and to such files.

use crate::scene::diagnostic::{SceneError, SceneText};
use nalgebra::DMatrix;
use npyz::{NpyFile, Order, WriterBuilder as _};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

/// Most numbers of an array.
const MOST_NUMBERS: u64 = 4_000_000;

/// The arrays of an `.npz` file; one of a single dimension is a column.
pub(crate) struct Arrays<'a> {
    text: &'a SceneText,
    key: &'a str,
    file: &'a str,
    /// Each, or why it is no matrix.
    all: BTreeMap<String, Result<DMatrix<f64>, String>>,
}

impl<'a> Arrays<'a> {
    /// Reads a file that a key names, with no other arrays than these; a relative path counts from the scene's folder.
    pub(crate) fn load(
        text: &'a SceneText,
        (key, file): (&'a str, &'a str),
        known: &[&str],
    ) -> Result<Self, SceneError> {
        let folder = text.path.parent().unwrap_or(std::path::Path::new(""));
        let refused = |reason: String| {
            let message = format!("{file}: {reason}");
            let help =
                "give an .npz file, as numpy.savez writes it, by its path from the scene file";
            text.error_at_key(key, message, Some(help.to_owned()))
        };
        let opened = File::open(folder.join(file)).map_err(|e| refused(e.to_string()))?;
        let mut archive =
            ZipArchive::new(BufReader::new(opened)).map_err(|e| refused(e.to_string()))?;
        let mut all = BTreeMap::new();
        for i in 0..archive.len() {
            let entry = archive.by_index(i).map_err(|e| refused(e.to_string()))?;
            let name = entry
                .name()
                .map_err(|e| refused(e.to_string()))?
                .into_owned();
            let Some(name) = name.strip_suffix(".npy").map(str::to_owned) else {
                continue;
            };
            let read = |reader| matrix(NpyFile::new(reader).map_err(|e| e.to_string())?);
            if !known.contains(&name.as_str()) {
                let message = format!("{file}: no array {name} is expected");
                let help = format!("it may have {}", known.join(", "));
                return Err(text.error_at_key(key, message, Some(help)));
            }
            all.insert(name, read(entry));
        }
        Ok(Self {
            text,
            key,
            file,
            all,
        })
    }

    /// The array of a name.
    pub(crate) fn take(&mut self, name: &str) -> Result<DMatrix<f64>, SceneError> {
        self.take_if_there(name)?.ok_or_else(|| {
            let message = format!("{} has no array {name}", self.file);
            let names: Vec<&str> = self.all.keys().map(String::as_str).collect();
            let help = match names.is_empty() {
                true => format!("save it with an array {name}"),
                false => format!("save it with {name} beside {}", names.join(", ")),
            };
            (self.text).error_at_key(self.key, message, Some(help))
        })
    }

    /// The array of a name, where the file has one.
    pub(crate) fn take_if_there(&mut self, name: &str) -> Result<Option<DMatrix<f64>>, SceneError> {
        self.all.remove(name).transpose().map_err(|reason| {
            let message = format!("{}: {name}: {reason}", self.file);
            let help = "save it as a matrix of real numbers".to_owned();
            (self.text).error_at_key(self.key, message, Some(help))
        })
    }
}

/// An `.npz` file with these arrays, and with texts under their names.
pub(crate) fn npz<'n, 'a>(
    arrays: impl Iterator<Item = (&'n str, &'a DMatrix<f64>)>,
    texts: &[(&str, &str)],
) -> io::Result<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, array) in arrays {
        archive.start_file(format!("{name}.npy"), SimpleFileOptions::default())?;
        let shape = [array.nrows() as u64, array.ncols() as u64];
        let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
        let mut rows = options.order(Order::C).writer(&mut archive).begin_nd()?;
        for row in array.row_iter() {
            rows.extend(row.iter().copied())?;
        }
        rows.finish()?;
    }
    for (name, text) in texts {
        archive.start_file(*name, SimpleFileOptions::default())?;
        archive.write_all(text.as_bytes())?;
    }
    Ok(archive.finish()?.into_inner())
}

fn matrix<R: std::io::Read>(array: NpyFile<R>) -> Result<DMatrix<f64>, String> {
    let (rows, columns) = match *array.shape() {
        [] => (1, 1),
        [rows] => (rows, 1),
        [rows, columns] => (rows, columns),
        _ => {
            return Err(format!(
                "has {} dimensions, at most two",
                array.shape().len()
            ));
        }
    };
    if rows.saturating_mul(columns) > MOST_NUMBERS {
        return Err(format!(
            "is {rows} × {columns}, at most {MOST_NUMBERS} numbers"
        ));
    }
    let order = array.order();
    let kind = array.dtype().descr();
    let numbers: Vec<f64> = match array.try_data::<f64>() {
        Ok(data) => collected(data, |x| x)?,
        Err(array) => match array.try_data::<f32>() {
            Ok(data) => collected(data, f64::from)?,
            Err(array) => match array.try_data::<i64>() {
                Ok(data) => collected(data, |x| x as f64)?,
                Err(_) => return Err(format!("holds {kind}, expected real numbers (float64)")),
            },
        },
    };
    let (rows, columns) = (rows as usize, columns as usize);
    if numbers.len() != rows * columns {
        return Err(format!(
            "has {} numbers for {rows} × {columns}",
            numbers.len()
        ));
    }
    Ok(match order {
        Order::C => DMatrix::from_row_slice(rows, columns, &numbers),
        Order::Fortran => DMatrix::from_column_slice(rows, columns, &numbers),
    })
}

fn collected<T>(
    data: impl Iterator<Item = std::io::Result<T>>,
    number: impl Fn(T) -> f64,
) -> Result<Vec<f64>, String> {
    let all: std::io::Result<Vec<f64>> = data.map(|x| x.map(&number)).collect();
    all.map_err(|error| error.to_string())
}
