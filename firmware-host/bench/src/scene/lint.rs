//! What a scene may say and hardly means: a slip of a unit, a table pasted from another machine.

use crate::device::sensor_fault::Samples;
use crate::scene::Scene;
use crate::scene::diagnostic::SceneText;
use crate::scene::linear_loop::{LinearLoop, NoLoop, Zone, is_stable};
use crate::scene::nominal::Override;
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::suggest::{Nominal, SUPERVISED_RATES_HZ, suggested};
use crate::scene::tables::{PlaneTable, SceneTables};
use plant_model::V2;
use plant_model::params::PlantParams;
use std::f64::consts::TAU;
use supervisor::{Config, PARAMETERS};

/// A start farther from the centre than this, or one that would press the rotor deeper into the wall \[clearances\].
const DEEP: f64 = 10.0;
/// No rotor on retainer bearings turns faster \[Hz\], or is wider \[m\].
const FASTEST_HZ: f64 = 5000.0;
const WIDEST_M: f64 = 5.0;
/// No machine is accelerated so much for good \[m/s²\].
const HEAVIEST_M_S2: f64 = 200.0;
/// Share by which a parameter may differ from the scene's own data.
const OTHER: f32 = 0.05;

/// Parameters of the supervisor that a data sheet has, and the scene as well. Not the damping: none is on the safe side.
const GIVEN: [&str; 9] = [
    "sample_period_s",
    "mass_kg",
    "stiffness_n_m",
    "clearance_m",
    "force_max_n",
    "amplifier_lag_s",
    "delay_samples",
    "friction_coefficient",
    "contact_stiffness_n_m",
];

/// What of the plant is configured for a supervisor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setup<'a> {
    /// The plant's own data.
    pub(crate) nominal: &'a Nominal,
    /// What the scene puts in their place.
    pub(crate) overrides: &'a [Override],
    /// What comes of both where a supervisor runs.
    pub(crate) config: Option<&'a Config>,
}

/// Warnings with file and line.
pub(crate) fn warnings(spec: &PlaneSpec, plant: &PlantParams, setup: Setup<'_>) -> Vec<String> {
    let (file, text, nominal) = (&spec.tables, &spec.text, setup.nominal);
    let warning = |key: &str, message| text.warning(key, message);
    let clearance_m = plant.contact.clearance_m;
    let mut warnings = Vec::new();
    let away = file.start.position_m.length() / clearance_m;
    if away > DEEP {
        let message = format!("is {away:.0} clearances from the centre; positions are in metres");
        warnings.push(warning("start.position_m", message));
    }
    // A rotor of this speed presses a linear wall so far.
    let deep = file.start.velocity_m_s.length() / (plant.contact_rate_rad_s() * clearance_m);
    if deep > DEEP {
        let message = format!(
            "would press the rotor some {deep:.0} clearances deep into the wall; speeds are in m/s"
        );
        warnings.push(warning("start.velocity_m_s", message));
    }
    warnings.extend(slips(spec));
    let sliding = plant.friction.sliding.coefficient(0.0);
    let rolling = plant.friction.rolling_coefficient;
    if sliding > 0.0 && rolling >= sliding {
        let message = format!(
            "is {rolling}, no less than that of sliding: a rotor that rolls is held as by a brake, and nothing whirls"
        );
        warnings.push(warning("friction.rolling_coefficient", message));
    }
    let cap_n = nominal.force_everywhere_n();
    if let Some(magnet) = &file.magnet
        && nominal.load_n >= cap_n
    {
        let axis = magnet.axis_force_max_n.is_some_and(|axis| axis == cap_n);
        let key = match axis {
            true => "magnet.axis_force_max_n",
            false => "magnet.force_max_n",
        };
        let message = format!(
            "is {cap_n}, and the rotor weighs {:.4} N: the magnet cannot hold it in the middle",
            nominal.load_n
        );
        warnings.push(warning(key, message));
    }
    if !setup.overrides.is_empty() {
        warnings.extend(of_another_machine(
            text,
            setup,
            left_by_the_weight(file, nominal),
        ));
    }
    let Some(config) = setup.config else {
        return warnings;
    };
    let rate = file.run.sample_rate_hz;
    if !SUPERVISED_RATES_HZ.contains(&rate) {
        let message = format!("is {rate}; the supervisor is made for 10 to 50 kHz");
        warnings.push(warning("run.sample_rate_hz", message));
    }
    if let Some(needed) = nominal.contact_band_needed()
        && needed > f64::from(config.contact_band)
    {
        let message = format!(
            "is so far that the supervisor may not see a touch: its contact_band is {}, and should be {needed:.2}",
            config.contact_band
        );
        warnings.push(warning("retainer.centre_offset_m", message));
    }
    warnings
}

/// A levitation loop that is not stable or is badly damped at the spin of the start.
pub(crate) fn of_the_loop(scene: &Scene, tables: &SceneTables, text: &SceneText) -> Option<String> {
    let message = match judged(scene, scene.start.spin_rad_s) {
        Ok(judged) => judged?,
        // A machine that is out of range is refused elsewhere.
        Err(NoLoop::NoController | NoLoop::External | NoLoop::Machine(_)) => return None,
        Err(error @ NoLoop::NoEigenvalues) => format!("cannot be judged: {error}"),
    };
    let of_plane = || {
        let own = |i: usize, plane: &PlaneTable| {
            let tables = [
                ("levitation", plane.levitation.is_some()),
                ("biquads", plane.biquads.is_some()),
            ];
            let given = tables.into_iter().find(|(_, given)| *given)?;
            Some(format!("plane[{i}].{}", given.0))
        };
        let mut planes = tables.plane.iter().enumerate();
        planes.find_map(|(i, plane)| own(i, plane))
    };
    let whole = tables.own_of_the_whole().next().map(str::to_owned);
    let of_scene = [
        ("levitation", tables.levitation.is_some()),
        ("biquads", tables.biquads.is_some()),
    ];
    let of_scene = of_scene.into_iter().find(|(_, given)| *given);
    let key = (whole.or_else(of_plane)).or_else(|| Some(of_scene?.0.to_owned()))?;
    Some(text.warning(&key, message))
}

/// What is wrong with the loop, where something is.
fn judged(scene: &Scene, spin_rad_s: f64) -> Result<Option<String>, NoLoop> {
    let closed = LinearLoop::new(scene, spin_rad_s)?;
    let modes = closed.modes()?;
    if is_stable(&modes) {
        let peaks = closed.sensitivity_peaks(&modes);
        let worst = (peaks.into_iter()).max_by(|a, b| a.peak.total_cmp(&b.peak));
        return Ok(worst.filter(|worst| worst.zone >= Zone::C).map(|worst| {
            format!(
                "makes a badly damped loop: the sensitivity of {} peaks with {:.1} at {:.1} Hz, zone {} of ISO 14839-3, which has new machines below 3",
                worst.axis, worst.peak, worst.frequency_hz, worst.zone.name()
            )
        }));
    }
    let fastest = (modes.iter()).max_by(|a, b| a.growth_s.total_cmp(&b.growth_s));
    Ok(fastest.map(|mode| match mode.frequency_rad_s > 0.0 {
        true => format!(
            "makes a loop that is not stable: a {} mode of {:.4} Hz grows by {:.3} 1/s; see it with modes --levitated",
            mode.direction.name(),
            mode.frequency_rad_s / TAU,
            mode.growth_s
        ),
        false => format!(
            "does not hold the rotor in the middle: it runs away by {:.3} 1/s, as where gains are below the stiffness with which magnets pull",
            mode.growth_s
        ),
    }))
}

/// Values that one look at them makes doubtful: also of a scene that is refused, for that may be why.
pub(crate) fn slips(spec: &PlaneSpec) -> Vec<String> {
    let file = &spec.tables;
    let warning = |key: &str, message| spec.text.warning(key, message);
    let clearance_m = spec.contact.clearance_m;
    let mut warnings = Vec::new();
    if file.rotor.eccentricity_m > clearance_m {
        let message = "is larger than the clearance; lengths are in metres".to_owned();
        warnings.push(warning("rotor.eccentricity_m", message));
    }
    if clearance_m > spec.contact_radius_m {
        let message = "is larger than the rotor's radius there; lengths are in metres".to_owned();
        warnings.push(warning("contact.clearance_m", message));
    }
    for (key, size) in [
        ("sensor.noise_rms_m", file.sensor.noise_rms_m),
        ("sensor.quantum_m", file.sensor.quantum_m),
    ] {
        if size > clearance_m {
            let message = "is larger than the clearance; lengths are in metres".to_owned();
            warnings.push(warning(key, message));
        }
    }
    let hz = file.spin.frequency_hz.abs();
    if hz > FASTEST_HZ {
        let message = format!("is {hz:e} turns a second; a speed in turns a minute?");
        warnings.push(warning("spin.frequency_hz", message));
    }
    if spec.contact_radius_m > WIDEST_M {
        let message = format!("is wider than {WIDEST_M} m; lengths are in metres");
        warnings.push(warning("rotor.contact_radius_m", message));
    }
    let gravity_m_s2 = file.rotor.gravity_m_s2.length();
    if gravity_m_s2 > HEAVIEST_M_S2 {
        let g = gravity_m_s2 / 9.81;
        let message = format!("is {g:.0} times that of the earth; accelerations are in m/s²");
        warnings.push(warning("rotor.gravity_m_s2", message));
    }
    let magnet_deg = file.magnet.as_ref().map_or(0.0, |m| m.axes_deg);
    if (magnet_deg - file.sensor.axes_deg).to_radians().cos() <= 0.0 {
        let what = "is a right angle or more from that of the magnet: the controller pushes away from the middle";
        warnings.push(warning("sensor.axes_deg", what.to_owned()));
    }
    let gain = V2::from(file.sensor.gain);
    if gain.iter().any(|gain| *gain <= 0.0) {
        let what = match gain.iter().any(|gain| *gain == 0.0) {
            true => "is 0: the sensor reads nothing of the position",
            false => "is negative: every controller pushes the rotor away",
        };
        warnings.push(warning("sensor.gain", what.to_owned()));
    }
    if let Some(range_m) = file.sensor.range_m
        && range_m < clearance_m
    {
        let message = "is smaller than the clearance: no policy can see a contact".to_owned();
        warnings.push(warning("sensor.range_m", message));
    }
    warnings
}

/// What falls between samples, or behind the last: nobody sees it, or it does not happen at all.
pub(crate) fn unseen(spec: &PlaneSpec) -> Vec<String> {
    let (file, text) = (&spec.tables, &spec.text);
    let samples = Samples::new(file.run.duration_s, file.run.sample_rate_hz);
    let unseen = |start_s: f64, duration_s: f64| !samples.any_within(start_s, start_s + duration_s);
    let mut warnings = Vec::new();
    for (i, f) in file.fault.iter().enumerate() {
        if unseen(f.start_s, f.duration_s) {
            let message = "falls between samples: none of them reads it".to_owned();
            warnings.push(text.warning(&format!("fault[{i}].start_s"), message));
        }
    }
    for (i, o) in file.outage.iter().enumerate() {
        if unseen(o.start_s, o.duration_s) {
            let message = "falls between samples: the firmware sees nothing of it".to_owned();
            warnings.push(text.warning(&format!("outage[{i}].start_s"), message));
        }
    }
    for (i, c) in file.change.iter().enumerate() {
        let key = format!("change[{i}].at_s");
        if c.at_s >= samples.end_s() {
            let message = "comes after the last sample's period, and does not happen".to_owned();
            warnings.push(text.warning(&key, message));
            continue;
        }
        // Until the same is changed again.
        let until_s = (file.change.iter())
            .filter(|other| other.at_s > c.at_s && c.keys_of_both(other).next().is_some())
            .map(|other| other.at_s)
            .fold(f64::INFINITY, f64::min);
        if until_s.is_finite() && unseen(c.at_s, until_s - c.at_s) {
            let message = "falls between samples: the same is changed again before the next";
            warnings.push(text.warning(&key, message.to_owned()));
        }
    }
    warnings
}

/// Force that a weight that is fed forward leaves in every direction \[N\], which is what `advise` says to give the
/// supervisor then.
fn left_by_the_weight(file: &SceneTables, nominal: &Nominal) -> Option<f64> {
    (file.feeds_weight_forward()).then_some(nominal.force_everywhere_n() - nominal.load_n)
}

/// What the scene tells the supervisor otherwise than it is.
fn of_another_machine(text: &SceneText, setup: Setup<'_>, left_n: Option<f64>) -> Vec<String> {
    let suggested = suggested(setup.nominal).config.values();
    let warning = |&(index, given): &Override| {
        let (name, value) = (PARAMETERS[index].name, suggested[index]);
        // The table of `advise` holds every bit; what is rounded by hand is meant.
        let differs = |value: f32| (given - value).abs() > OTHER * given.abs().max(value.abs());
        let left = left_n.filter(|_| name == "force_max_n");
        let other = differs(value) && left.is_none_or(|left_n| differs(left_n as f32));
        (GIVEN.contains(&name) && other).then(|| {
            let message = format!(
                "is {given}, and the scene's own data say {value}; a table from another scene?"
            );
            let key = format!("supervisor.{name}");
            text.warning(&key, message)
        })
    };
    (setup.overrides.iter()).filter_map(warning).collect()
}
