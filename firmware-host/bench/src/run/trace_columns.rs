//! Columns of traces: names, units, what they are, and how each is read off a row; the same in files, in memory and in
//! whatever else shows rows.

use crate::run::supervision::names;
use crate::run::trace::{AxisRow, SupervisorTrace, TraceRow};

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
    pub(super) about: Vec<(&'static str, String)>,
}

impl Columns<TraceRow> {
    pub fn of_plane() -> Self {
        let numbers = NUMBERS.iter().copied();
        let codes = CODES.iter().copied();
        Self {
            numbers: (numbers.chain(codes))
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

    /// The same for a file that says this of itself, beside the units.
    #[must_use]
    pub fn about(mut self, about: Vec<(&'static str, String)>) -> Self {
        self.about = about;
        self
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
        |r| trace(r, |s| s.levitation_n[0]),
    ),
    (
        "levitation_y_n",
        "N",
        "what the levitation controller asks for",
        |r| trace(r, |s| s.levitation_n[1]),
    ),
    (
        "stimulus_x_n",
        "N",
        "what of it the supervisor asks for, to check its configuration",
        |r| trace(r, |s| s.stimulus_n[0]),
    ),
    (
        "stimulus_y_n",
        "N",
        "what of it the supervisor asks for, to check its configuration",
        |r| trace(r, |s| s.stimulus_n[1]),
    ),
    (
        "supervisor_severity",
        "1",
        "severity of what is coming, as a share of what the cap can stop",
        |r| trace(r, |s| s.severity),
    ),
];

/// Behind the name of a column of names: the same as a number, for programs that draw nothing but numbers.
pub const CODE: &str = "_code";

/// Names as numbers.
const CODES: &[Plain<TraceRow>] = &[
    ("mode_code", "1", "number of the mode", |r| {
        f64::from(r.plant.mode as u8)
    }),
    (
        "supervisor_mode_code",
        "1",
        "number of the supervisor's mode; -1 without one",
        |r| {
            r.supervisor_mode()
                .map_or(-1.0, |mode| f64::from(mode as u8))
        },
    ),
    (
        "supervisor_limits_code",
        "1",
        "bits of what binds the command",
        |r| r.supervisor.map_or(0.0, |s| s.limits.bits().into()),
    ),
    (
        "supervisor_events_code",
        "1",
        "bits of what happened",
        |r| r.supervisor.map_or(0.0, |s| s.events.bits().into()),
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

/// A number of the supervisor's answer; 0 where there is none.
fn trace(row: &TraceRow, what: fn(&SupervisorTrace) -> f32) -> f64 {
    row.supervisor.map_or(0.0, |trace| f64::from(what(&trace)))
}
