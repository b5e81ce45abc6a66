//! Traces as Parquet: one column a quantity, SI units in the column names; written while the run goes on, a group of rows at
//! a time.

use crate::run::supervision::names;
use crate::run::trace::{AxisRow, Recorder, Said, TraceRow};
use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use std::io::{self, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A column of numbers.
pub struct Number<R> {
    /// Its name, with the unit behind it.
    pub name: String,
    /// The unit; "1" of a plain number.
    pub unit: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Reads it off a row.
    pub value: Box<dyn Fn(&R) -> f64 + Send>,
}

type Text<R> = (&'static str, fn(&R) -> String);
type Flag<R> = (&'static str, fn(&R) -> bool);

/// Columns of rows of some kind, in file order.
pub struct Columns<R: 'static> {
    pub(super) numbers: Vec<Number<R>>,
    pub(super) texts: &'static [Text<R>],
    pub(super) flags: &'static [Flag<R>],
    /// What the file says of itself: keys and values.
    about: Vec<(&'static str, String)>,
}

impl Columns<TraceRow> {
    /// Of a plane.
    pub fn of_plane() -> Self {
        let numbers = NUMBERS.iter().copied();
        Self {
            numbers: numbers
                .map(|(name, unit, about, value)| number(name, (unit, about), value))
                .collect(),
            texts: TEXTS,
            // Whether a row stands at a change of mode between two control samples.
            flags: &[("mode_change", |r| r.mode_change)],
            about: Vec::new(),
        }
    }
}

impl Columns<AxisRow> {
    /// Of a rotor's axis with so many bending modes.
    pub fn of_axis(modes: usize) -> Self {
        let axis = AXIS.iter().copied();
        let mut numbers: Vec<Number<AxisRow>> = axis
            .map(|(name, unit, about, value)| number(name, (unit, about), value))
            .collect();
        for mode in 0..modes {
            for (axis, name) in ["x", "y"].into_iter().enumerate() {
                let value = move |r: &AxisRow| r.bending[mode].position[axis];
                let about = ("m", "amplitude of a bending mode");
                numbers.push(number(
                    &format!("bending_{}_{name}_m", mode + 1),
                    about,
                    value,
                ));
            }
        }
        Self {
            numbers,
            texts: &[],
            flags: &[],
            about: Vec::new(),
        }
    }
}

impl<R> Columns<R> {
    /// Those of numbers, in file order.
    pub fn into_numbers(self) -> Vec<Number<R>> {
        self.numbers
    }

    /// The same for a file that says this of itself, beside the [units](UNITS).
    #[must_use]
    pub fn about(mut self, about: Vec<(&'static str, String)>) -> Self {
        self.about = about;
        self
    }

    /// Keys and values of the file.
    fn key_values(&self) -> Vec<KeyValue> {
        let units: serde_json::Map<String, serde_json::Value> = (self.numbers.iter())
            .map(|number| (number.name.clone(), number.unit.into()))
            .collect();
        let units = (UNITS, serde_json::Value::from(units).to_string());
        let about = self.about.iter().cloned().chain([units]);
        about
            .map(|(key, value)| KeyValue::new(key.to_owned(), value))
            .collect()
    }
}

fn number<R>(
    name: &str,
    (unit, about): (&'static str, &'static str),
    value: impl Fn(&R) -> f64 + Send + 'static,
) -> Number<R> {
    Number {
        name: name.to_owned(),
        unit,
        about,
        value: Box::new(value),
    }
}

/// Name, unit, what it is, value.
type Plain<R> = (&'static str, &'static str, &'static str, fn(&R) -> f64);

/// The axis of a whole rotor.
const AXIS: &[Plain<AxisRow>] = &[
    ("t_s", "s", "time", |r| r.t_s),
    ("centre_x_m", "m", "centre of mass", |r| {
        r.axis.centre.position.x
    }),
    ("centre_y_m", "m", "centre of mass", |r| {
        r.axis.centre.position.y
    }),
    ("centre_vx_m_s", "m/s", "its velocity", |r| {
        r.axis.centre.velocity.x
    }),
    ("centre_vy_m_s", "m/s", "its velocity", |r| {
        r.axis.centre.velocity.y
    }),
    ("tilt_x_rad", "rad", "slope of the axis, dx/dz", |r| {
        r.axis.tilt.position.x
    }),
    ("tilt_y_rad", "rad", "slope of the axis, dy/dz", |r| {
        r.axis.tilt.position.y
    }),
    ("tilt_rate_x_rad_s", "rad/s", "its rate", |r| {
        r.axis.tilt.velocity.x
    }),
    ("tilt_rate_y_rad_s", "rad/s", "its rate", |r| {
        r.axis.tilt.velocity.y
    }),
    ("bending_energy_j", "J", "energy of bending", |r| {
        r.axis.bending_j
    }),
];

/// Columns of numbers, in file order.
const NUMBERS: &[Plain<TraceRow>] = &[
    ("t_s", "s", "time", |r| r.plant.t_s),
    (
        "rotor_x_m",
        "m",
        "rotor, from the centre of the retainer bearing",
        |r| r.plant.position_m.x,
    ),
    (
        "rotor_y_m",
        "m",
        "rotor, from the centre of the retainer bearing",
        |r| r.plant.position_m.y,
    ),
    ("rotor_vx_m_s", "m/s", "velocity of the rotor", |r| {
        r.plant.velocity_m_s.x
    }),
    ("rotor_vy_m_s", "m/s", "velocity of the rotor", |r| {
        r.plant.velocity_m_s.y
    }),
    ("inner_ring_x_m", "m", "inner ring", |r| {
        r.plant.inner_ring.position.x
    }),
    ("inner_ring_y_m", "m", "inner ring", |r| {
        r.plant.inner_ring.position.y
    }),
    (
        "inner_ring_vx_m_s",
        "m/s",
        "velocity of the inner ring",
        |r| r.plant.inner_ring.velocity.x,
    ),
    (
        "inner_ring_vy_m_s",
        "m/s",
        "velocity of the inner ring",
        |r| r.plant.inner_ring.velocity.y,
    ),
    ("outer_ring_x_m", "m", "outer ring", |r| {
        r.plant.outer_ring.position.x
    }),
    ("outer_ring_y_m", "m", "outer ring", |r| {
        r.plant.outer_ring.position.y
    }),
    (
        "outer_ring_vx_m_s",
        "m/s",
        "velocity of the outer ring",
        |r| r.plant.outer_ring.velocity.x,
    ),
    (
        "outer_ring_vy_m_s",
        "m/s",
        "velocity of the outer ring",
        |r| r.plant.outer_ring.velocity.y,
    ),
    ("spin_rad_s", "rad/s", "spin of the rotor", |r| {
        r.plant.spin_rad_s
    }),
    (
        "race_spin_rad_s",
        "rad/s",
        "spin of the race that it touches",
        |r| r.plant.race_spin_rad_s,
    ),
    (
        "penetration_m",
        "m",
        "depth in the wall; negative inside the clearance",
        |r| r.plant.penetration_m,
    ),
    ("contact_force_n", "N", "normal force of the contact", |r| {
        r.plant.normal_force_n
    }),
    (
        "sliding_force_n",
        "N",
        "sliding friction on the rotor, counter-clockwise",
        |r| r.plant.sliding_force_n,
    ),
    (
        "rolling_force_n",
        "N",
        "rolling friction on the rotor, counter-clockwise",
        |r| r.plant.rolling_force_n,
    ),
    (
        "contact_tangential_speed_m_s",
        "m/s",
        "tangential speed of the rotor against the ring",
        |r| r.plant.contact_tangential_speed_m_s,
    ),
    (
        "whirl_angle_rad",
        "rad",
        "angle of the contact point, summed over all contact",
        |r| r.plant.whirl_angle_rad,
    ),
    (
        "measured_x_m",
        "m",
        "position as the sensor reads it",
        |r| r.measured_m.x,
    ),
    (
        "measured_y_m",
        "m",
        "position as the sensor reads it",
        |r| r.measured_m.y,
    ),
    ("commanded_x_n", "N", "command in effect", |r| {
        r.commanded_n.x
    }),
    ("commanded_y_n", "N", "command in effect", |r| {
        r.commanded_n.y
    }),
    ("delivered_x_n", "N", "force of the magnet", |r| {
        r.plant.delivered_n.x
    }),
    ("delivered_y_n", "N", "force of the magnet", |r| {
        r.plant.delivered_n.y
    }),
    (
        "levitation_x_n",
        "N",
        "what the levitation controller asks for",
        |r| said(r, |s| s.levitation_n[0]),
    ),
    (
        "levitation_y_n",
        "N",
        "what the levitation controller asks for",
        |r| said(r, |s| s.levitation_n[1]),
    ),
    (
        "supervisor_severity",
        "1",
        "severity of what is coming, as a share of what the cap can stop",
        |r| said(r, |s| s.severity),
    ),
];

/// Columns of names, after the numbers.
const TEXTS: &[Text<TraceRow>] = &[
    ("mode", |r| r.plant.mode.name().to_owned()),
    ("supervisor_mode", |r| {
        r.supervisor_mode()
            .map_or("", supervisor::Mode::name)
            .to_owned()
    }),
    ("supervisor_limits", |r| {
        r.supervisor
            .map_or(String::new(), |s| names(s.limits.iter_names()))
    }),
    ("supervisor_events", |r| {
        r.supervisor
            .map_or(String::new(), |s| names(s.events.iter_names()))
    }),
];

/// Something that the supervisor said; 0 where there is none.
fn said(row: &TraceRow, what: fn(&Said) -> f32) -> f64 {
    row.supervisor.map_or(0.0, |said| f64::from(what(&said)))
}

/// Key of a file under which the units of its columns of numbers stand, a JSON object; "1" of a plain number.
pub const UNITS: &str = "units";

/// Rows of a group; so many are in memory before they are written.
const GROUP_ROWS: usize = 1 << 16;

/// A trace file that is being written.
pub struct TraceFile<W: Write + Send, R: 'static> {
    file: SerializedFileWriter<W>,
    columns: Columns<R>,
    rows: Vec<R>,
    /// The first thing that went wrong; nothing is written after it.
    broken: Option<ParquetError>,
    took: Duration,
}

impl<W: Write + Send, R: Clone> TraceFile<W, R> {
    /// Begins a file.
    ///
    /// # Errors
    /// What the file system or the format refuses.
    pub fn new(sink: W, columns: Columns<R>) -> Result<Self, ParquetError> {
        let mut message = String::from("message trace {\n");
        for number in &columns.numbers {
            message += &format!("  required double {};\n", number.name);
        }
        for (name, _) in columns.texts {
            message += &format!("  required binary {name} (utf8);\n");
        }
        for (name, _) in columns.flags {
            message += &format!("  required boolean {name};\n");
        }
        message += "}";
        let schema = Arc::new(parse_message_type(&message)?);
        // Numbers hardly repeat: a dictionary of them is work for nothing, and larger than they are. Of names there are few.
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::None)
            .set_key_value_metadata(Some(columns.key_values()))
            .set_created_by("firmware-host".to_owned());
        for (name, _) in columns.texts {
            properties = properties.set_column_dictionary_enabled((*name).into(), true);
        }
        let properties = properties.build();
        Ok(Self {
            file: SerializedFileWriter::new(sink, schema, Arc::new(properties))?,
            columns,
            rows: Vec::new(),
            broken: None,
            took: Duration::ZERO,
        })
    }

    /// Time spent on writing so far.
    pub fn took(&self) -> Duration {
        self.took
    }

    /// Writes what is left and ends the file.
    ///
    /// # Errors
    /// What the file system or the format has refused.
    pub fn end(mut self) -> Result<(), ParquetError> {
        if self.broken.is_none() && !self.rows.is_empty() {
            self.write_group()?;
        }
        match self.broken {
            Some(error) => Err(error),
            None => self.file.close().map(drop),
        }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for number in &self.columns.numbers {
            let column: Vec<f64> = self.rows.iter().map(&number.value).collect();
            column_of(&mut group, |c| {
                c.typed::<DoubleType>().write_batch(&column, None, None)
            })?;
        }
        for (_, value) in self.columns.texts {
            let column: Vec<ByteArray> = (self.rows.iter())
                .map(|r| ByteArray::from(value(r).into_bytes()))
                .collect();
            column_of(&mut group, |c| {
                c.typed::<ByteArrayType>().write_batch(&column, None, None)
            })?;
        }
        for (_, value) in self.columns.flags {
            let column: Vec<bool> = self.rows.iter().map(value).collect();
            column_of(&mut group, |c| {
                c.typed::<BoolType>().write_batch(&column, None, None)
            })?;
        }
        group.close()?;
        self.rows.clear();
        Ok(())
    }
}

impl<W: Write + Send, R: Clone> Recorder<R> for TraceFile<W, R> {
    fn row(&mut self, row: &R) {
        if self.broken.is_some() {
            return;
        }
        self.rows.push(row.clone());
        if self.rows.len() == GROUP_ROWS {
            let started = Instant::now();
            self.broken = self.write_group().err();
            self.took += started.elapsed();
        }
    }
}

/// Why a trace could not be written, in the words of the system where it is the reason.
pub fn reason(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(reason) => *reason,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

type ColumnWriter<'a> = parquet::file::writer::SerializedColumnWriter<'a>;

/// Writes the next column of a group.
fn column_of<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    fill: impl FnOnce(&mut ColumnWriter<'_>) -> Result<usize, ParquetError>,
) -> Result<(), ParquetError> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General(
            "more columns than the schema has".to_owned(),
        ));
    };
    fill(&mut column)?;
    column.close()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    #[test]
    fn the_first_refusal_is_the_one_that_is_told() {
        /// A disk with room for the first bytes.
        struct Full;
        impl Write for Full {
            fn write(&mut self, _bytes: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let begun = TraceFile::new(Full, Columns::of_plane());
        let told = begun.and_then(|mut file| {
            (0..GROUP_ROWS).for_each(|i| file.row(&fixture::row(i as f64, false)));
            file.end()
        });
        assert_eq!(reason(told.unwrap_err()).kind(), io::ErrorKind::StorageFull);
    }
}
