//! The figures of a run, a row each: its key in JSON and in code, where it comes from, how tables head it and show it.
//! A new figure is a new row here; verdict, JSON, terminal, report and studies take it from there.

use crate::run::columns::{Cell, Column, Columnar, below, columnar, columns_of};
use crate::run::judge::Judge;
use crate::run::outcome::Outcome;
use crate::run::rig::Rig;
use plant_model::{Meters, Method, Snapshot};
use serde::Serialize;
use std::f64::consts::TAU;
use std::time::Duration;

/// With how many digits a number is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// Three that count.
    Significant,
    /// So many after the point.
    Fixed(usize),
    /// Two, and a power of ten.
    Power,
}

/// In which tables a figure stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableLevel {
    /// Also in those that have room for few.
    Everywhere,
    /// In those of all figures.
    Full,
}

/// A figure's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// In SI units; `None` where there is none.
    Number(Option<f64>),
    /// A name.
    Word(&'static str),
    /// How a run ended.
    Outcome(Outcome),
}

/// A figure as tables show it.
#[derive(Debug, Clone, Copy)]
pub struct Figure<T> {
    /// Key in JSON.
    pub key: &'static str,
    /// What it is called.
    pub heading: &'static str,
    /// Unit in which it is shown.
    pub unit: &'static str,
    /// How many of that unit one of the SI unit is.
    pub per_si: f64,
    /// With how many digits.
    pub digits: Digits,
    /// In which tables.
    pub place: TableLevel,
    /// Reads it.
    pub value: fn(&T) -> Value,
}

/// A struct of figures, a row a field: `key: type = where it comes from => heading, unit, per SI unit, digits, place`. What has
/// nothing behind the arrow is in JSON and in code alone.
macro_rules! figures {
    ($(#[$about:meta])* pub struct $name:ident from $source:ty;
     $($(#[$doc:meta])* $key:ident: $ty:ty = $from:expr
       $(=> $heading:literal, $unit:literal, $per_si:expr, $digits:expr, $place:expr)?;)*) => {
        $(#[$about])*
        #[derive(Debug, Clone, PartialEq, Serialize)]
        #[cfg_attr(test, derive(Default))]
        pub struct $name { $($(#[$doc])* pub $key: $ty,)* }

        impl $name {
            /// What tables show, in their order.
            pub const ALL: &[Figure<Self>] = &[$($(Figure {
                key: stringify!($key),
                heading: $heading,
                unit: $unit,
                per_si: $per_si,
                digits: $digits,
                place: $place,
                value: |figures| figures.$key.into(),
            },)?)*];

            pub(crate) fn new(source: &$source) -> Self {
                Self { $($key: { let from: fn(&$source) -> $ty = $from; from(source) },)* }
            }
        }

        columnar!($name { $($key),* });
    };
}

use Digits::{Fixed, Power, Significant};
use TableLevel::{Everywhere, Full};

figures! {
    /// Outcome of a run, in SI units. The same scene gives the same, on every machine.
    pub struct Figures from Ended<'_>;

    /// How it ended.
    outcome: Outcome = |run| run.outcome
        => "outcome", "", 1.0, Fixed(0), Everywhere;
    /// True for recovered or decayed.
    recovered: bool = |run| run.outcome.recovered();
    /// True where the rotor was free at the end and would have stayed so, whether it had whirled before or not.
    free_at_end: bool = |run| run.free_at_end;
    /// Number of touches.
    impacts: u64 = |run| run.meters.impacts
        => "impacts", "", 1.0, Fixed(0), Everywhere;
    /// Time in contact \[s\].
    contact_time_s: f64 = |run| run.meters.contact_time_s
        => "contact time", "ms", 1e3, Significant, Full;
    /// Impulse of the normal force, ∫ f_n dt \[N s\].
    contact_impulse_n_s: f64 = |run| run.normal_impulse_n_s
        => "contact impulse", "N s", 1.0, Significant, Everywhere;
    /// Number of touches with a normal speed above 20 mm/s.
    contacts_over_20_mm_s: u64 = |run| run.meters.hard_impacts
        => "contacts over 20 mm/s", "", 1.0, Fixed(0), Full;
    /// When it touched first \[s\]; `None` if never.
    first_contact_s: Option<f64> = |run| run.judge.first_contact_s()
        => "first contact", "ms", 1e3, Fixed(2), Full;
    /// Largest penetration of the clearance circle by the contact \[m\].
    peak_penetration_m: f64 = |run| run.meters.peak_penetration_m
        => "peak penetration", "µm", 1e6, Significant, Full;
    /// Largest normal force \[N\].
    peak_contact_force_n: f64 = |run| run.meters.peak_contact_force_n
        => "peak contact force", "N", 1.0, Significant, Everywhere;
    /// Largest friction torque on the spin \[N m\].
    peak_friction_torque_n_m: f64 = |run| run.meters.peak_friction_torque_n_m
        => "peak friction torque", "N m", 1.0, Significant, Full;
    /// Spin lost from start to end \[Hz\].
    spin_lost_hz: f64 = |run| run.judge.spin_lost_rad_s(run.last.spin_rad_s) / TAU
        => "spin lost", "Hz", 1.0, Fixed(2), Full;
    /// Largest backward tangential speed in contact \[m/s\].
    peak_backward_speed_m_s: f64 = |run| run.meters.peak_backward_speed_m_s
        => "peak backward speed", "m/s", 1.0, Significant, Full;
    /// Largest backward whirl frequency over 1 ms of continuous contact \[Hz\]; `None` without such a contact.
    max_backward_whirl_hz: Option<f64> = |run| run.judge.backward_whirl_hz()
        => "max backward whirl", "Hz", 1.0, Fixed(1), Full;
    /// From the end of the disturbance to the beginning of the stay in the middle \[s\]; `None` if never.
    relevitation_time_s: Option<f64> = |run| run.judge.relevitation_time_s(run.outcome)
        => "re-levitated after last event", "ms", 1e3, Fixed(2), Everywhere;
    /// Energy-audit residual: energy from nowhere over energy turned over.
    energy_residual: f64 = |run| run.energy_residual
        => "energy-audit residual", "", 1.0, Power, Full;
    /// How warm the bearing is, of a plane that has `retainer.heat`.
    #[serde(skip_serializing_if = "Option::is_none")]
    bearing: Option<BearingFigures> = |run| run.bearing;
    /// Method that integrated contact: `series` or `collocation`.
    method: &'static str = |run| run.method.name()
        => "method", "", 1.0, Fixed(0), Full;
}

figures! {
    /// How long a run took on this machine.
    pub struct Timing from Took;

    /// Wall-clock time of the run \[s\].
    run_time_s: f64 = |took| took.elapsed.as_secs_f64()
        => "run time", "ms", 1e3, Fixed(1), Full;
    /// Simulated time over wall-clock time.
    real_time_ratio: f64 = |took| took.simulated_s / took.elapsed.as_secs_f64()
        => "ratio to real time", "", 1.0, Fixed(0), Full;
}

/// How warm a bearing is at the end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BearingFigures {
    /// What it has lost by friction, damping and drag \[J\].
    pub heat_j: f64,
    /// Rise of its temperature over the surroundings \[K\].
    pub temperature_rise_k: f64,
    /// Its clearance \[m\].
    pub clearance_m: f64,
}

columnar!(BearingFigures {
    heat_j,
    temperature_rise_k,
    clearance_m
});

/// A run at its end.
pub(crate) struct Ended<'a> {
    outcome: Outcome,
    free_at_end: bool,
    meters: Meters,
    normal_impulse_n_s: f64,
    energy_residual: f64,
    judge: &'a Judge,
    last: Snapshot,
    bearing: Option<BearingFigures>,
    method: Method,
}

impl<'a> Ended<'a> {
    /// A plane of a rig at its end, `last` of it.
    pub(crate) fn new(judge: &'a Judge, rig: &Rig<'_>, (plane, last): (usize, &Snapshot)) -> Self {
        let meters = rig.meters(plane);
        let backward_m_s = meters.peak_backward_speed_m_s;
        Self {
            outcome: judge.outcome(last, backward_m_s),
            free_at_end: judge.at_end(last).recovered(),
            meters,
            normal_impulse_n_s: rig.normal_impulse_n_s(plane),
            energy_residual: rig.audit().residual(),
            judge,
            last: *last,
            bearing: rig.warmth(plane).map(|warmth| BearingFigures {
                heat_j: warmth.heat_j,
                temperature_rise_k: warmth.rise_k,
                clearance_m: warmth.clearance_m,
            }),
            method: rig.method(),
        }
    }
}

impl Figures {
    /// Of a machine, from those of its planes; `None` without one. How it ended is how the worst ended.
    pub fn of_machine(planes: &[Self]) -> Option<Self> {
        let first = match planes {
            [only] => return Some(only.clone()),
            planes => planes.first()?,
        };
        let sum = |of: fn(&Self) -> f64| planes.iter().map(of).sum::<f64>();
        let count = |of: fn(&Self) -> u64| planes.iter().map(of).sum::<u64>();
        let most = |of: fn(&Self) -> f64| planes.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let outcome = (planes.iter().map(|f| f.outcome)).fold(first.outcome, Outcome::max);
        Some(Self {
            outcome,
            recovered: outcome.recovered(),
            free_at_end: planes.iter().all(|f| f.free_at_end),
            impacts: count(|f| f.impacts),
            contact_time_s: sum(|f| f.contact_time_s),
            contact_impulse_n_s: sum(|f| f.contact_impulse_n_s),
            contacts_over_20_mm_s: count(|f| f.contacts_over_20_mm_s),
            first_contact_s: (planes.iter().filter_map(|f| f.first_contact_s)).reduce(f64::min),
            peak_penetration_m: most(|f| f.peak_penetration_m),
            peak_contact_force_n: most(|f| f.peak_contact_force_n),
            peak_friction_torque_n_m: most(|f| f.peak_friction_torque_n_m),
            spin_lost_hz: first.spin_lost_hz,
            peak_backward_speed_m_s: most(|f| f.peak_backward_speed_m_s),
            max_backward_whirl_hz: (planes.iter().filter_map(|f| f.max_backward_whirl_hz))
                .reduce(f64::max),
            // Only of a machine that is back in all its planes, and then of the last.
            relevitation_time_s: match outcome {
                Outcome::Recovered => {
                    (planes.iter().filter_map(|f| f.relevitation_time_s)).reduce(f64::max)
                }
                _ => None,
            },
            energy_residual: first.energy_residual,
            // Each has its own.
            bearing: None,
            method: first.method,
        })
    }
}

/// What a run took.
pub(crate) struct Took {
    pub(crate) simulated_s: f64,
    pub(crate) elapsed: Duration,
}

impl<T> Figure<T> {
    /// Heading and unit in one.
    pub fn title(&self) -> String {
        match self.unit {
            "" => self.heading.to_owned(),
            unit => format!("{} [{unit}]", self.heading),
        }
    }
}

impl From<f64> for Value {
    fn from(x: f64) -> Self {
        Self::Number(Some(x))
    }
}

impl From<u64> for Value {
    fn from(count: u64) -> Self {
        Self::Number(Some(count as f64))
    }
}

impl From<Option<f64>> for Value {
    fn from(x: Option<f64>) -> Self {
        Self::Number(x)
    }
}

impl From<&'static str> for Value {
    fn from(word: &'static str) -> Self {
        Self::Word(word)
    }
}

impl From<Outcome> for Value {
    fn from(outcome: Outcome) -> Self {
        Self::Outcome(outcome)
    }
}
