//! Keys that a scene cannot do without, and what to give where one is missing.

use crate::scene::policy_kind::PolicyKind;

/// Table, key, what to give.
type Needed = (&'static str, &'static str, &'static str);

const NEEDED: &[Needed] = &[
    ("run", "duration_s", "a number of seconds, as 0.2"),
    ("run", "sample_rate_hz", "the control rate in Hz, as 20000"),
    ("run", "policies", ""),
    ("rotor", "mass_kg", "a number in kg"),
    (
        "rotor",
        "contact_radius_m",
        "the rotor's radius in the retainer bearing in m",
    ),
    ("spin", "frequency_hz", "turns a second in Hz, as 200.0"),
    ("stator.inner", "mass_kg", "a number in kg"),
    (
        "stator.inner",
        "stiffness_n_m",
        "a number in N/m, or one for each axis, [x, y]",
    ),
    (
        "stator.inner",
        "damping_n_s_m",
        "a number in N s/m, or one for each axis, [x, y]",
    ),
    ("stator.outer", "mass_kg", "a number in kg"),
    (
        "stator.outer",
        "stiffness_n_m",
        "a number in N/m, or one for each axis, [x, y]",
    ),
    (
        "stator.outer",
        "damping_n_s_m",
        "a number in N s/m, or one for each axis, [x, y]",
    ),
    (
        "contact",
        "clearance_m",
        "the radial clearance in m, as 2e-4",
    ),
    (
        "friction",
        "coefficient",
        "the coefficient of sliding friction, as 0.15",
    ),
    ("race", "inertia_kg_m2", "a number in kg m²"),
    ("magnet", "force_max_n", "the force cap in N"),
    ("levitation", "proportional_n_m", "a number in N/m"),
    ("levitation", "derivative_n_s_m", "a number in N s/m"),
    ("disturbance", "start_s", "a time in s"),
    ("disturbance", "duration_s", "a time in s"),
    ("disturbance", "force_n", "two numbers in N, [x, y]"),
    ("base_motion", "start_s", "a time in s"),
    ("base_motion", "duration_s", "a time in s"),
    (
        "base_motion",
        "acceleration_m_s2",
        "two numbers in m/s², [x, y]",
    ),
    ("outage", "start_s", "a time in s"),
    ("outage", "duration_s", "a time in s"),
    ("fault", "start_s", "a time in s"),
    ("fault", "duration_s", "a time in s"),
    (
        "fault",
        "kind",
        "one of nan, infinity, zero, rail, stuck, offset, gain, inverted, swapped, noise, spikes, dropout, \
      delay, bits, oscillation",
    ),
    ("change", "at_s", "a time in s"),
];

/// A key that is missing: its table with its place, as `disturbance[1]`, and what to give.
pub(crate) struct Missing {
    pub(crate) table: String,
    pub(crate) help: String,
}

/// Where a key of this name is missing first, given what finds the first table of a name that has not the key.
pub(crate) fn missing(
    name: &str,
    first_without: impl Fn(&str, &str) -> Option<String>,
) -> Option<Missing> {
    (NEEDED.iter().filter(|(_, key, _)| *key == name)).find_map(|(table, key, what)| {
        let path = first_without(table, key)?;
        let what = match *key {
            "policies" => {
                let names = PolicyKind::ALL.map(PolicyKind::name).join(", ");
                format!("a list of policies, [\"passive\"]; there are {names}")
            }
            _ => (*what).to_owned(),
        };
        Some(Missing {
            table: path,
            help: format!("give {what}"),
        })
    })
}
