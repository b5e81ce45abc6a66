//! Outputs of a plane: the columns of its traces, and what firmware sees there.

use crate::quantities::{CONTACT, contact_number, of_plane};
use crate::supervisor_outputs::TRACE;
use crate::variable::{Kind, Output, Role, Value, Variable};
use firmware_bench::run::closed_loop::stepwise::Stepwise;
use firmware_bench::run::controller::Seen;
use firmware_bench::run::trace::{SupervisorTrace, TraceRow};
use firmware_bench::run::trace_columns::{CODE, Columns, Number};

/// Which of the columns an output is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Of {
    /// The plant and its instruments.
    Plant,
    ClosedLoop,
}

/// What firmware sees at a sample, beside the position.
const SEEN: &[Output<Seen>] = &[
    (
        "sequence",
        "",
        "number of the reading; one that did not come repeats the last",
        Kind::UInt32,
        |seen| Value::UInt32(seen.reading.sequence),
    ),
    (
        "status",
        "",
        "bits of what is valid and ready: 1 spin, 2 bearing on, 4 applied force, 8 x lost, 16 y lost, 32 late, 64 shadow",
        Kind::UInt32,
        |seen| Value::UInt32(seen.status.bits()),
    ),
    (
        "spin_reported_rad_s",
        "rad/s",
        "spin as the firmware measures it",
        Kind::Float64,
        |seen| Value::Float64(seen.spin_rad_s),
    ),
    (
        "applied_x_n",
        "N",
        "force that is measured, less what is fed forward; counts with bit 4 of status",
        Kind::Float64,
        |seen| Value::Float64(seen.applied_n.x),
    ),
    ("applied_y_n", "N", "the same along y", Kind::Float64, |s| {
        Value::Float64(s.applied_n.y)
    }),
];

fn is_for(of: Of, name: &str) -> bool {
    let of_loop = name.starts_with("levitation_") || name.starts_with("supervisor_");
    // A unit has enumerations and bits.
    let coded = name.ends_with(CODE);
    name != "t_s" && !coded && (of == Of::ClosedLoop || !of_loop)
}

/// Outputs of all planes.
pub(crate) struct Rows {
    of: Of,
    columns: Vec<Number<TraceRow>>,
}

impl Rows {
    pub(crate) fn new(of: Of) -> Self {
        let columns = Columns::of_plane().into_numbers();
        let columns = columns.into_iter().filter(|c| is_for(of, &c.name));
        Self {
            of,
            columns: columns.collect(),
        }
    }

    /// Variables of so many planes.
    pub(crate) fn variables(&self, planes: usize) -> Vec<Variable> {
        let mut all = Vec::new();
        for plane in 0..planes {
            let signal = |name: &str, about: &str, unit, kind| {
                let name = of_plane(planes, plane, name);
                Variable::signal(Role::Output, name, about, unit, kind)
            };
            let column = |c: &Number<TraceRow>| signal(&c.name, c.about, c.unit, Kind::Float64);
            all.extend(self.columns.iter().map(column));
            let about = CONTACT.about;
            all.push(signal("mode", about, "", Kind::Enumeration(&CONTACT)));
            match self.of {
                Of::Plant => all.extend(SEEN.iter().map(|(n, u, a, k, _)| signal(n, a, u, *k))),
                Of::ClosedLoop => {
                    all.extend(TRACE.iter().map(|(n, u, a, k, _)| signal(n, a, u, *k)));
                }
            }
        }
        let about = "energy from nowhere over energy turned over, so far";
        let name = "energy_residual".to_owned();
        all.push(Variable::signal(
            Role::Output,
            name,
            about,
            "1",
            Kind::Float64,
        ));
        all
    }

    /// Their values.
    pub(crate) fn values(&self, stepwise: &Stepwise, into: &mut Vec<Value>) {
        for (row, seen) in (0..stepwise.planes()).filter_map(|plane| stepwise.at(plane)) {
            let row = match self.of {
                // As a controller in its place has it: along the sensor's axes.
                Of::Plant => TraceRow {
                    measured_m: seen.reading.position_m,
                    ..row
                },
                Of::ClosedLoop => row,
            };
            let column = |c: &Number<TraceRow>| Value::Float64((c.value)(&row));
            into.extend(self.columns.iter().map(column));
            into.push(Value::Int64(contact_number(row.plant.mode)));
            match self.of {
                Of::Plant => into.extend(SEEN.iter().map(|(.., value)| value(&seen))),
                Of::ClosedLoop => {
                    let value = |(.., kind, value): &Output<SupervisorTrace>| {
                        row.supervisor.map_or(kind.zero(), |trace| value(&trace))
                    };
                    into.extend(TRACE.iter().map(value));
                }
            }
        }
        into.push(Value::Float64(stepwise.energy_residual()));
    }
}
