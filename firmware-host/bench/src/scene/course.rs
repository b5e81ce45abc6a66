//! The course of a load or of a base motion, by a shape or from a file.

use crate::device::loads::{Course, Shape};
use crate::log_file::{LogError, LogFile};
use crate::scene::diagnostic::SceneError;
use crate::scene::keys::Range;
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::tables::{BaseMotionTable, DisturbanceTable};
use crate::scene::values::{Pair, ShapeName};
use plant_model::V2;
use std::path::Path;
use std::sync::Arc;

/// What both tables have of a course.
pub(super) struct Written<'a> {
    start_s: Option<f64>,
    duration_s: Option<f64>,
    /// Its key, and what is given.
    amplitude: (&'static str, Option<Pair>),
    shape: ShapeName,
    frequency_hz: Option<f64>,
    phase_rad: Option<f64>,
    file: Option<&'a str>,
    time_column: Option<&'a str>,
    /// For x and y; and what they are called where none is given.
    columns: [Option<&'a str>; 2],
    usual: [&'static str; 2],
}

macro_rules! written {
    ($table:ty, $amplitude:ident, $usual:expr) => {
        impl $table {
            pub(super) fn written(&self) -> Written<'_> {
                Written {
                    start_s: self.start_s,
                    duration_s: self.duration_s,
                    amplitude: (stringify!($amplitude), self.$amplitude),
                    shape: self.shape,
                    frequency_hz: self.frequency_hz,
                    phase_rad: self.phase_rad,
                    file: self.file.as_deref(),
                    time_column: self.time_column.as_deref(),
                    columns: [self.x_column.as_deref(), self.y_column.as_deref()],
                    usual: $usual,
                }
            }
        }
    };
}
written!(DisturbanceTable, force_n, ["force_x_n", "force_y_n"]);
written!(
    BaseMotionTable,
    acceleration_m_s2,
    ["acceleration_x_m_s2", "acceleration_y_m_s2"]
);

/// A course, checked.
pub(super) struct Checked {
    pub(super) start_s: f64,
    pub(super) duration_s: f64,
    pub(super) amplitude: V2,
    pub(super) shape: Shape,
}

/// Reads what happens in a scene.
pub(super) struct Reader<'a> {
    pub(super) spec: &'a PlaneSpec,
}

impl Reader<'_> {
    pub(super) fn error(&self, key: &str, message: &str, help: &str) -> SceneError {
        let (message, help) = (message.to_owned(), Some(help.to_owned()));
        self.spec.text.error_at_key(key, message, help)
    }

    pub(super) fn starts(&self, path: &str, key: &str, start_s: f64) -> Result<(), SceneError> {
        let end_s = self.spec.tables.run.duration_s;
        if start_s < end_s {
            return Ok(());
        }
        let message = format!("is {start_s}, not before the end of the run at {end_s}");
        let help = "start it earlier, or lengthen run.duration_s";
        Err(self.error(&format!("{path}.{key}"), &message, help))
    }

    /// Rates that a sampled loop could be asked about \[Hz\].
    pub(super) fn rates_hz(&self) -> Range {
        Range::Within(0.0, self.spec.tables.run.sample_rate_hz)
    }

    /// A key that this kind or shape cannot do without.
    pub(super) fn needed(
        &self,
        path: &str,
        key: &str,
        value: Option<f64>,
        range: Range,
    ) -> Result<f64, SceneError> {
        let key = format!("{path}.{key}");
        let expected = range.expected();
        match value {
            None => Err(self.error(&key, "is missing", &format!("give {expected}"))),
            Some(value) if range.contains(value) => Ok(value),
            Some(value) => Err((self.spec.text).refused(&key, value, &expected)),
        }
    }

    pub(super) fn course(&self, path: &str, w: &Written<'_>) -> Result<Checked, SceneError> {
        let at = |key: &str| format!("{path}.{key}");
        let (amplitude_key, amplitude) = w.amplitude;
        let shape = match w.file {
            Some(file) => Shape::Recorded(Arc::new(self.recorded(path, file, w)?)),
            None => {
                let of_file = [
                    ("time_column", w.time_column),
                    ("x_column", w.columns[0]),
                    ("y_column", w.columns[1]),
                ];
                if let Some((key, _)) = of_file.iter().find(|(_, given)| given.is_some()) {
                    let message = "has a meaning with `file` only";
                    return Err(self.error(&at(key), message, "remove it, or name the file"));
                }
                self.shape(path, w)?
            }
        };
        let given = |key: &str, value: Option<f64>, of_file: f64| match &shape {
            Shape::Recorded(_) => Ok(value.unwrap_or(of_file)),
            _ => self.needed(path, key, value, Range::NotNegative),
        };
        let end_s = match &shape {
            Shape::Recorded(course) => course.end_s(),
            _ => 0.0,
        };
        let start_s = given("start_s", w.start_s, 0.0)?;
        let duration_s = given("duration_s", w.duration_s, end_s)?;
        self.starts(path, "start_s", start_s)?;
        let amplitude = match (amplitude, &shape) {
            (Some(amplitude), _) => amplitude.into(),
            (None, Shape::Recorded(_)) => V2::repeat(1.0),
            (None, _) => {
                let help = "give two numbers, [x, y], or a file";
                return Err(self.error(&at(amplitude_key), "is missing", help));
            }
        };
        Ok(Checked {
            start_s,
            duration_s,
            amplitude,
            shape,
        })
    }

    fn shape(&self, path: &str, w: &Written<'_>) -> Result<Shape, SceneError> {
        if w.shape != ShapeName::Sine {
            let given = [
                ("frequency_hz", w.frequency_hz.is_some()),
                ("phase_rad", w.phase_rad.is_some()),
            ];
            if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
                let key = format!("{path}.{key}");
                let message = "has a meaning with shape = \"sine\" only";
                return Err(self.error(&key, message, "remove it, or choose that shape"));
            }
        }
        Ok(match w.shape {
            ShapeName::Constant => Shape::Constant,
            ShapeName::HalfSine => Shape::HalfSine,
            ShapeName::Sine => Shape::Sine {
                // Faster ones are no load that a sampled loop could be asked about.
                frequency_hz: self.needed(path, "frequency_hz", w.frequency_hz, self.rates_hz())?,
                phase_rad: w.phase_rad.unwrap_or(0.0),
            },
        })
    }

    fn recorded(&self, path: &str, file: &str, w: &Written<'_>) -> Result<Course, SceneError> {
        let key = format!("{path}.file");
        let shaped = [
            ("shape", w.shape != ShapeName::Constant),
            ("frequency_hz", w.frequency_hz.is_some()),
            ("phase_rad", w.phase_rad.is_some()),
        ];
        if let Some((key, _)) = shaped.iter().find(|(_, given)| *given) {
            let message = "the course is that of the file";
            return Err(self.error(&format!("{path}.{key}"), message, "remove it, or the file"));
        }
        let folder = self.spec.text.path.parent().unwrap_or(Path::new(""));
        let refused =
            |LogError { message, help }| self.error(&key, &format!("{file}: {message}"), &help);
        let log = LogFile::read(&folder.join(file), &[])
            .map_err(|e| self.error(&key, &e.message, &e.help))?;
        let time = w.time_column.unwrap_or("t_s");
        let times = log.column(time).map_err(refused)?;
        let none = vec![0.0; times.len()];
        let [x, y] = match w.columns {
            [None, None] => w.usual.map(Some),
            named => named,
        }
        .map(|name| name.map_or(Ok(none.as_slice()), |name| log.beside(time, name)));
        let (x, y) = (x.map_err(refused)?, y.map_err(refused)?);
        let points = times.iter().zip(x).zip(y);
        let points: Vec<(f64, V2)> = points.map(|((t, x), y)| (*t, V2::new(*x, *y))).collect();
        Course::new(file.to_owned(), points).ok_or_else(|| {
            let message = format!(
                "{file}: needs two rows or more, with a number in each and times that rise"
            );
            self.error(
                &key,
                &message,
                "leave out rows without numbers, and rows that stand twice",
            )
        })
    }
}
