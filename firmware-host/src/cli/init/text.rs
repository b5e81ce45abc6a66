//! The text of a scene.

use super::Machine;
use firmware_bench::device::levitation::LevitationParams;

/// The schema's file, beside the scene.
pub(super) const SCHEMA: &str = "scene.schema.json";

/// What is assumed where it is not given.
const SPIN_HZ: f64 = 200.0;
const CONTACT_RADIUS_M: f64 = 0.05;

/// √(m·c/F) of a machine for which the overload of the scene lasts 50 ms \[s\].
const QUICK_S: f64 = 2e-3;

/// A scene in which an overload presses the rotor to the wall; without controller no force at all.
pub(super) fn scene(machine: &Machine, levitation: Option<&LevitationParams>) -> String {
    let Machine {
        sample_rate_hz,
        mass_kg,
        stiffness_n_m,
        clearance_m,
        contact_stiffness_n_m,
        force_max_n,
        lag_s,
        friction,
        noise_rms_m,
        load_n,
        spin_hz,
        contact_radius_m,
    } = *machine;
    let assumed = |given: Option<f64>| {
        if given.is_some() {
            ""
        } else {
            "   # assumed: put in your own"
        }
    };
    let slow = ((mass_kg * clearance_m / force_max_n).sqrt() / QUICK_S)
        .ceil()
        .clamp(1.0, 1e3);
    let policies = match levitation {
        Some(_) => r#"["passive", "levitation", "supervisor"]"#,
        None => r#"["passive"]"#,
    };
    let levitation = levitation.map_or_else(String::new, |of| {
        format!(
            r#"
[levitation]                    # made up: proportional and derivative, with a peak sensitivity below 3; put in your own
proportional_n_m = {}
derivative_n_s_m = {}
derivative_filter_s = {}
feed_forward_weight = {}
"#,
            number(of.proportional_n_m),
            number(of.derivative_n_s_m),
            number(of.derivative_filter_s),
            load_n > 0.0,
        )
    });
    format!(
        r#"#:schema ./{SCHEMA}
# Every key, its unit, range and default: firmware-host schema --table.
title = "An overload of half more than the magnets hold"
story = """
Written by `firmware-host init`. A force of one and a half times the cap sets in and presses the rotor to its retainer bearing;
then it goes. What counts is how the rotor touches, how it lies there, and how soon it is back in the middle.
"""

[run]
duration_s = {duration}
sample_rate_hz = {rate}
seed = 1                        # of the sensor noise
policies = {policies}

[rotor]
mass_kg = {mass}
stiffness_n_m = {shaft}               # of the shaft alone
contact_radius_m = {radius}{radius_assumed}
gravity_m_s2 = [0.0, {gravity}]        # vertical rotor: none

[spin]
frequency_hz = {spin}{spin_assumed}
# inertia_kg_m2 = 0.02          # where friction may brake the spin; without it a drive holds it

[contact]
clearance_m = {clearance}
stiffness_n_m = {contact}
restitution = 0.7               # assumed: steel on steel

[friction]
coefficient = {friction}

[magnet]
force_max_n = {force}
lag_s = {lag}
negative_stiffness_n_m = {negative}

[sensor]
noise_rms_m = {noise}
{levitation}
[[disturbance]]
start_s = {start}
duration_s = {lasts}
force_n = [{overload}, 0.0]     # what else may happen: shocks, outages, sensor faults
"#,
        duration = number(0.2 * slow),
        rate = number(sample_rate_hz),
        mass = number(mass_kg),
        shaft = number(stiffness_n_m.max(0.0)),
        radius = number(contact_radius_m.unwrap_or(CONTACT_RADIUS_M)),
        radius_assumed = assumed(contact_radius_m),
        gravity = number(-load_n / mass_kg),
        spin = number(spin_hz.unwrap_or(SPIN_HZ)),
        spin_assumed = assumed(spin_hz),
        clearance = number(clearance_m),
        contact = number(contact_stiffness_n_m),
        friction = number(friction),
        force = number(force_max_n),
        lag = number(lag_s),
        negative = number((-stiffness_n_m).max(0.0)),
        noise = number(noise_rms_m),
        start = number(0.02 * slow),
        lasts = number(0.05 * slow),
        overload = number(1.5 * force_max_n),
    )
}

/// A float as TOML has it, short, and none that is minus zero.
fn number(x: f64) -> String {
    match x {
        0.0 => "0.0".to_owned(),
        x if (1e-3..1e6).contains(&x.abs()) => format!("{x:?}"),
        x => format!("{x:e}"),
    }
}
