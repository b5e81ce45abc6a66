//! The text of a scene.

use super::shaft::Shaft;
use super::{Body, Machine};
use firmware_bench::device::levitation::LevitationParams;

/// The schema's file, beside the scene.
pub(super) const SCHEMA: &str = "scene.schema.json";

/// What is assumed where it is not given.
const SPIN_HZ: f64 = 200.0;
pub(super) const CONTACT_RADIUS_M: f64 = 0.05;

/// √(m·c/F) of a machine for which the overload of the scene lasts 50 ms \[s\].
const QUICK_S: f64 = 2e-3;

/// A scene in which an overload presses the rotor to the wall; without a controller for each plane no force at all.
pub(super) fn scene(machine: &Machine, levitation: &[LevitationParams]) -> String {
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
        ref bearings,
    } = *machine;
    let assumed = |given: Option<f64>| {
        if given.is_some() {
            ""
        } else {
            "   # assumed: put in your own"
        }
    };
    let carried_kg = if bearings.is_some() {
        0.5 * mass_kg
    } else {
        mass_kg
    };
    let slow = ((carried_kg * clearance_m / force_max_n).sqrt() / QUICK_S)
        .ceil()
        .clamp(1.0, 1e3);
    let policies = match levitation {
        [] => r#"["passive"]"#,
        _ => r#"["passive", "levitation", "supervisor"]"#,
    };
    let gains = |of: &LevitationParams| {
        format!(
            "proportional_n_m = {}\nderivative_n_s_m = {}\nderivative_filter_s = {}\nfeed_forward_weight = {}\n",
            number(of.proportional_n_m),
            number(of.derivative_n_s_m),
            number(of.derivative_filter_s),
            load_n > 0.0,
        )
    };
    const MADE_UP: &str =
        "# made up: proportional and derivative, with a peak sensitivity below 3; put in your own";
    let of_scene = match levitation {
        [only] => format!(
            "\n[levitation]                    {MADE_UP}\n{}",
            gains(only)
        ),
        _ => String::new(),
    };
    let bearings = bearings.as_ref();
    let (rotor, shaft) = match bearings.map(|of| &of.body) {
        None => (
            format!(
                "mass_kg = {}\nstiffness_n_m = {}               # of the shaft alone\n",
                number(mass_kg),
                number(stiffness_n_m.max(0.0))
            ),
            String::new(),
        ),
        Some(Body::Rigid {
            transverse_inertia_kg_m2,
            polar_inertia_kg_m2,
        }) => (
            format!(
                "mass_kg = {}\ntransverse_inertia_kg_m2 = {}\npolar_inertia_kg_m2 = {}\n",
                number(mass_kg),
                number(*transverse_inertia_kg_m2),
                number(*polar_inertia_kg_m2)
            ),
            String::new(),
        ),
        Some(Body::Shaft(shaft)) => (
            "bending_damping_ratio = 0.002   # assumed\n".to_owned(),
            tables(shaft),
        ),
    };
    let mut planes = String::new();
    for (i, name) in ["A", "B"].into_iter().enumerate() {
        let Some(of) = bearings else { break };
        let own = levitation.get(i).map_or_else(String::new, |of| {
            format!("[plane.levitation]              {MADE_UP}\n{}", gains(of))
        });
        // The scene's is that of the first one, or given.
        let radius_m = of
            .radius_m(i)
            .filter(|_| contact_radius_m == of.radius_m(0));
        let radius = radius_m.filter(|own| contact_radius_m != Some(*own));
        let radius = radius.map_or_else(String::new, |own| {
            format!("contact_radius_m = {}\n", number(own))
        });
        planes += &format!(
            "\n[[plane]]\nname = \"{name}\"\nposition_m = {}             # magnet, sensor and retainer bearing; each may have its own\n{radius}{own}",
            number(of.positions_m[i])
        );
    }
    let at_first = bearings.map_or_else(String::new, |of| {
        format!("position_m = {}\n", number(of.positions_m[0]))
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
{rotor}contact_radius_m = {radius}{radius_assumed}
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
{shaft}{of_scene}{planes}
[[disturbance]]
start_s = {start}
duration_s = {lasts}
force_n = [{overload}, 0.0]     # what else may happen: shocks, outages, sensor faults
{at_first}"#,
        duration = number(0.2 * slow),
        rate = number(sample_rate_hz),
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

/// Tables of a shaft with its discs.
fn tables(shaft: &Shaft) -> String {
    let mut tables = String::new();
    for (i, section) in shaft.sections.iter().enumerate() {
        let note = match i {
            0 => "                       # from the left end, where places count from",
            _ => "",
        };
        tables += &format!(
            "\n[[shaft]]{note}\nlength_m = {}\nouter_diameter_m = {}\n",
            number(section.length_m),
            number(section.outer_diameter_m)
        );
        for (key, value) in &section.others {
            tables += &format!("{key} = {}\n", number(*value));
        }
    }
    for disc in &shaft.discs {
        let note = match disc.assumed {
            true => "   # assumed, as the transverse one: put in your own",
            false => "",
        };
        tables += &format!(
            "\n[[disc]]\nposition_m = {}\nmass_kg = {}\ntransverse_inertia_kg_m2 = {}\npolar_inertia_kg_m2 = {}{note}\n",
            number(disc.position_m),
            number(disc.mass_kg),
            number(disc.transverse_inertia_kg_m2),
            number(disc.polar_inertia_kg_m2),
        );
    }
    tables
}

/// A float as TOML has it, short, and none that is minus zero.
fn number(x: f64) -> String {
    match x {
        0.0 => "0.0".to_owned(),
        x if (1e-3..1e6).contains(&x.abs()) => format!("{x:?}"),
        x => format!("{x:e}"),
    }
}
