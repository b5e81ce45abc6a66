//! What is recorded of a run: a row at every control sample and at every change of mode.

use plant_model::machine::AxisMotion;
use plant_model::{Body, Snapshot, V2};
use supervisor::{Command, Events, Limits, Report};

/// One row, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraceRow {
    /// The plant as it was.
    pub plant: Snapshot,
    /// Position as the sensor last reported it, along the axes of the scene \[m\].
    pub measured_m: V2,
    /// Force commanded by the policy, in effect at this instant \[N\].
    pub commanded_n: V2,
    /// The supervisor's answer to the last sample, where one runs.
    pub supervisor: Option<SupervisorTrace>,
    /// Whether the row stands at a change of mode between two samples.
    pub mode_change: bool,
}

/// What a supervisor answers beside its force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupervisorTrace {
    /// Mode after the tick.
    pub mode: supervisor::Mode,
    /// What bound the command.
    pub limits: Limits,
    /// What happened at the tick; nothing in rows that stand between two samples.
    pub events: Events,
    /// Severity of what is coming, as a share of what the cap can stop.
    pub severity: f32,
    /// Force that the levitation controller asked for, with the stimulus \[N\].
    pub levitation_n: [f32; 2],
    /// What of it the supervisor had asked for, to check its configuration \[N\].
    pub stimulus_n: [f32; 2],
}

impl SupervisorTrace {
    /// Of the command to a sample.
    pub fn new(command: &Command, levitation_n: [f32; 2]) -> Self {
        Self {
            mode: command.mode,
            limits: command.limits,
            events: command.events,
            severity: command.severity,
            levitation_n,
            stimulus_n: [0.0; 2],
        }
    }
}

/// What firmware can read out of a supervisor after a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadOut {
    /// Its own account.
    pub report: Report,
    /// The bytes of the flight record, where one was frozen.
    pub flight_record: Option<Vec<u8>>,
}

/// A run, in time order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    pub rows: Vec<TraceRow>,
    /// What the supervisor leaves behind, where one runs that can be asked.
    pub read_out: Option<ReadOut>,
}

/// Who is given the rows of a run, one by one.
pub trait Recorder<R = TraceRow> {
    /// The next row.
    fn row(&mut self, row: &R);
}

/// The axis of a whole rotor at a control sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AxisRow {
    /// When \[s\].
    pub t_s: f64,
    /// Centre of mass, slope, bending energy.
    pub axis: AxisMotion,
    /// Amplitudes of the bending modes \[m\] and their rates \[m/s\].
    pub bending: Vec<Body>,
}

impl Recorder for Trace {
    fn row(&mut self, row: &TraceRow) {
        self.rows.push(*row);
    }
}

impl TraceRow {
    /// Mode of the supervisor, where one runs.
    pub fn supervisor_mode(&self) -> Option<supervisor::Mode> {
        self.supervisor.map(|trace| trace.mode)
    }
}
