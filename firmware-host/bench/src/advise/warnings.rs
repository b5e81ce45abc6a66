//! Where a design is weak, and what to do.

use super::noise::TIME_TO_ACT_S;
use super::{Advice, USEFUL_LAG_DEG};
use crate::scene::suggest::{LEAST_LIMIT, RAIL_SHARE, SUPERVISED_RATES_HZ};
use serde::Serialize;
use supervisor::{Config, PARAMETERS, RULES};

/// A weakness.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Warning {
    /// Stable name.
    pub key: &'static str,
    /// What is weak.
    pub text: String,
    /// What to do.
    pub remedy: String,
}

/// In the order in which they are worth reading: what makes recovery impossible first.
pub(super) fn of(advice: &Advice, config: &Config) -> Vec<Warning> {
    let checks = [
        cap_below_load(advice),
        cap_below_stiffness(advice),
        load(advice, config),
        rate(advice),
        slow_reaction(advice),
        range(advice, config),
        noise(advice, config),
        lag_drives(advice),
        lag_useless(advice),
        lead_too_short(advice),
        slew(advice),
        clamped(advice, config),
        near_a_limit(config),
        centre_offset(advice, config),
        runout(advice),
        unchecked(advice),
    ];
    checks.into_iter().flatten().collect()
}

fn warning(key: &'static str, text: String, remedy: impl Into<String>) -> Option<Warning> {
    Some(Warning {
        key,
        text,
        remedy: remedy.into(),
    })
}

fn unchecked(advice: &Advice) -> Option<Warning> {
    let set = advice.parameters.iter().find(|p| p.name == "check_first")?;
    set.replaced_by.filter(|first| *first < 0.5)?;
    let text = "check_first = 0: the supervisor acts on numbers that the machine has not confirmed; an axis that is exchanged, a \
                force in amperes or a clearance that is a diameter shows when the rotor falls";
    let remedy =
        "leave check_first out of firmware's configuration, or check its numbers in another way";
    warning("unchecked", text.to_owned(), remedy)
}

fn cap_below_load(advice: &Advice) -> Option<Warning> {
    let (force, load) = (advice.limits.force_n, advice.nominal.load_n);
    if force > load {
        return None;
    }
    let text = format!("the cap of {force:.4} N does not carry the load of {load:.4} N");
    let remedy = format!("more than {load:.4} N in every direction, or less load on this plane");
    warning("cap_below_load", text, remedy)
}

fn cap_below_stiffness(advice: &Advice) -> Option<Warning> {
    let n = &advice.nominal;
    let pull = -n.stiffness_n_m * n.clearance_m;
    let force = advice.limits.force_n - n.load_n;
    if n.stiffness_n_m >= 0.0 || force <= 0.0 || force > pull {
        return None;
    }
    let text = format!(
        "at the wall the negative stiffness pulls with {pull:.4} N, and the cap leaves {force:.4} N: \
         the rotor cannot be lifted off"
    );
    let remedy = "a higher cap, a smaller clearance, or less bias";
    warning("cap_below_stiffness", text, remedy)
}

/// Whatever is said of the cap holds for what a load leaves of it.
fn load(advice: &Advice, config: &Config) -> Option<Warning> {
    let (force, load) = (advice.limits.force_n, advice.nominal.load_n);
    let share = load / force;
    // Who has given the supervisor what is left need not be told to; digits may be rounded.
    let done = f64::from(config.force_max_n) <= 1.01 * (force - load);
    if !(0.1..1.0).contains(&share) || done {
        return None;
    }
    let text = format!(
        "the load takes {:.0} % of the cap, and limits and force_max_n are those of the whole cap",
        100.0 * share
    );
    let remedy = format!(
        "where the load is carried beside the supervisor's command (bias, fed forward), give the {:.4} N that are left",
        force - load
    );
    warning("load", text, remedy)
}

fn rate(advice: &Advice) -> Option<Warning> {
    let rate = advice.nominal.sample_rate_hz;
    let (low, high) = (SUPERVISED_RATES_HZ.start(), SUPERVISED_RATES_HZ.end());
    if SUPERVISED_RATES_HZ.contains(&rate) {
        return None;
    }
    let text = format!(
        "the control rate is {:.4} kHz; the supervisor is made for 10 to 50 kHz",
        rate / 1e3
    );
    let remedy = match rate < *low {
        true => format!("sample and command at {:.0} kHz or more", low / 1e3),
        false => format!("call the supervisor at {:.0} kHz or less", high / 1e3),
    };
    warning("rate", text, remedy)
}

fn slow_reaction(advice: &Advice) -> Option<Warning> {
    let r = &advice.reaction;
    if r.detect_to_force_s <= TIME_TO_ACT_S {
        return None;
    }
    let text = format!(
        "a force comes {:.3} ms after its sample; whirl passes its threshold within about 1 ms",
        r.detect_to_force_s * 1e3
    );
    let largest = if r.lag_s > r.delay_s + r.hold_s {
        "a faster amplifier: its lag is the largest part"
    } else {
        "a higher rate or fewer samples of delay: they are the largest part"
    };
    warning("slow_reaction", text, largest)
}

fn noise(advice: &Advice, config: &Config) -> Option<Warning> {
    let (noise, n) = (&advice.noise, &advice.nominal);
    // What is slow without any noise, with any pole, is no matter of the sensor.
    let helpless = noise.sensor_noise_most_m.is_none() && noise.quiet_poles.is_none();
    if noise.tolerable || (n.sensor_noise_m() == 0.0 && helpless) {
        return None;
    }
    let text = format!(
        "the estimated speed has {:.3} mm/s of noise, {:.1} % of {:.4} m/s, by an observer of {:.2} ms",
        noise.flight_m_s.max(noise.contact_m_s) * 1e3,
        noise.share * 100.0,
        noise.reference_m_s,
        noise.observer_s * 1e3
    );
    let poles = noise.quiet_poles.map(|poles| other_poles(poles, config));
    let quieter = (noise.sensor_noise_most_m)
        .map(|m| format!("at most {} µm of sensor noise", rounded_down(m * 1e6)));
    // Not beyond what the supervisor is made for.
    let faster = (noise.sample_rate_least_hz)
        .filter(|hz| hz <= SUPERVISED_RATES_HZ.end())
        .map(|hz| format!("at least {:.1} kHz", hz / 1e3));
    let remedy: Vec<String> = [poles, quieter, faster].into_iter().flatten().collect();
    let remedy = match remedy.is_empty() {
        true => "shorten the reaction time: no sensor is good enough for it".to_owned(),
        false => remedy.join(", or "),
    };
    warning("noise", text, remedy)
}

/// Those of the poles that are others than the ones in use.
fn other_poles([flight, contact]: [f64; 2], config: &Config) -> String {
    let names = ["observer_pole_flight", "observer_pole_contact"];
    let used = [config.observer_pole_flight, config.observer_pole_contact];
    let offered = [flight, contact];
    let other = (0..2).filter(|i| offered[*i] as f32 != used[*i]);
    let settings: Vec<String> = other
        .map(|i| format!("{} = {:.2}", names[i], offered[i]))
        .collect();
    format!("set {}", settings.join(" and "))
}

/// Three figures, none of them too much.
fn rounded_down(x: f64) -> String {
    let unit = 10f64.powf(x.log10().floor() - 2.0);
    let decimals = (-unit.log10().round()).max(0.0) as usize;
    format!("{:.decimals$}", (x / unit).floor() * unit)
}

fn lag_drives(advice: &Advice) -> Option<Warning> {
    let lag = advice.lag.as_ref()?;
    if lag.angle_deg <= lag.friction_angle_deg {
        return None;
    }
    let text = format!(
        "in whirl at v_lim a force lags by {:.1}°, more than atan μ = {:.1}°: re-centring drives the whirl",
        lag.angle_deg, lag.friction_angle_deg
    );
    let remedy = "leave whirl to the supervisor, which turns its force ahead by the delay and lag that it is \
                  told: measure both, and do not let a stiff levitation loop act in contact";
    warning("lag_drives", text, remedy)
}

fn lag_useless(advice: &Advice) -> Option<Warning> {
    let lag = advice.lag.as_ref()?;
    if lag.angle_deg <= USEFUL_LAG_DEG {
        return None;
    }
    let text = format!(
        "in whirl at v_lim a force lags by {:.1}°, more than 75°: uncorrected even a tangential force hardly brakes",
        lag.angle_deg
    );
    let remedy = "a higher rate, fewer samples of delay, a faster amplifier; do not count on v_lim";
    warning("lag_useless", text, remedy)
}

fn lead_too_short(advice: &Advice) -> Option<Warning> {
    let lag = advice.lag.as_ref()?;
    if lag.delay_angle_rad <= 1.0 {
        return None;
    }
    let text = format!(
        "delay and hold turn the force by {:.2} rad in whirl at v_lim; the supervisor leads by 1 rad at most",
        lag.delay_angle_rad
    );
    warning(
        "lead_too_short",
        text,
        "a higher rate or fewer samples of delay",
    )
}

fn slew(advice: &Advice) -> Option<Warning> {
    let slew = advice.nominal.slew_n_s?;
    let rate_rad_s = advice.limits.whirl_limit_hz? * std::f64::consts::TAU;
    let needed = advice.limits.force_n * rate_rad_s;
    if slew >= needed {
        return None;
    }
    let text = format!(
        "a force that turns with the whirl at v_lim changes by {needed:.3e} N/s, the actuator by {slew:.3e} N/s"
    );
    let remedy = "more voltage, or count on less than the cap in fast whirl";
    warning("slew", text, remedy)
}

/// What the supervisor is configured with holds for the levitation controller's command as well.
fn clamped(advice: &Advice, config: &Config) -> Option<Warning> {
    let n = &advice.nominal;
    // What a load leaves that is carried beside the command.
    let left_n = n.force_everywhere_n() - n.load_n;
    let of = |name: &'static str, configured: f32, own: Option<f64>, unit: &'static str| {
        let own = own.filter(|own| f64::from(configured) < 0.99 * own)?;
        Some((name, configured, own, unit))
    };
    let cap = of("force_max_n", config.force_max_n, Some(n.force_max_n), "N")
        .filter(|_| (f64::from(config.force_max_n) - left_n).abs() > 0.01 * left_n.abs());
    let axis = of(
        "axis_force_max_n",
        config.axis_force_max_n,
        n.axis_force_max_n,
        "N",
    );
    let slew = of("force_slew_n_s", config.force_slew_n_s, n.slew_n_s, "N/s");
    let (name, configured, own, unit) = cap.or(axis).or(slew)?;
    let text = format!(
        "{name} = {configured} {unit} is configured, less than the {own} {unit} of the magnet: levitation is clamped to it"
    );
    let remedy = "configure what the magnet has, unless levitation is to have no more";
    warning("clamped", text, remedy)
}

/// Room that a rule between two values is to leave.
const LEAST_ROOM: f32 = 1.2;

fn near_a_limit(config: &Config) -> Option<Warning> {
    let (rule, _) = RULES.iter().zip(config.room()).find(|(rule, room)| {
        // Caps of the axes that just reach that of the vector are what a magnet has.
        PARAMETERS[rule.index].name != "axis_force_max_n" && *room < LEAST_ROOM
    })?;
    let [name, other] = [rule.index, rule.other].map(|index| PARAMETERS[index].name);
    let text = format!("{name} is near the limit that {other} sets it");
    warning("near_a_limit", text, rule.text)
}

/// Beyond its range a sensor says nothing of how deep the rotor is in the wall.
fn range(advice: &Advice, config: &Config) -> Option<Warning> {
    let n = &advice.nominal;
    let (range_m, wall_m) = (n.range_m?, n.clearance_m + n.centre_offset_m);
    let limit_m = f64::from(config.position_limit) * n.clearance_m;
    let text = if range_m <= wall_m {
        format!(
            "the sensor reads up to {:.4} mm, the wall is at {:.4} mm: a touch is not seen",
            range_m * 1e3,
            wall_m * 1e3
        )
    } else if limit_m > RAIL_SHARE * range_m * (1.0 + 1e-6) {
        format!(
            "the sensor reads up to {:.4} mm, and its rail counts as a position up to position_limit, {:.4} mm",
            range_m * 1e3,
            limit_m * 1e3
        )
    } else {
        return None;
    };
    let needed_m = (LEAST_LIMIT / RAIL_SHARE * n.clearance_m).max(wall_m);
    // A limit that fits the range there is in the parameter's own.
    let remedy = match RAIL_SHARE * range_m / n.clearance_m {
        fits if fits >= LEAST_LIMIT && range_m > wall_m => {
            format!("set position_limit = {}, or less", rounded_down(fits))
        }
        _ => format!(
            "a sensor that reads beyond {:.4} mm to either side",
            needed_m * 1e3
        ),
    };
    warning("range", text, remedy)
}

fn centre_offset(advice: &Advice, config: &Config) -> Option<Warning> {
    let n = &advice.nominal;
    let needed =
        (n.contact_band_needed()).filter(|needed| *needed > f64::from(config.contact_band))?;
    let text = format!(
        "the retainer bearing sits {:.1} µm off the sensors' centre, the contact band is {:.1} µm",
        n.centre_offset_m * 1e6,
        f64::from(config.contact_band) * n.clearance_m * 1e6
    );
    let remedy = match needed > 0.3 {
        true => "subtract the measured offset from the samples".to_owned(),
        false => format!(
            "subtract the measured offset from the samples, or set contact_band = {needed:.2}"
        ),
    };
    warning("centre_offset", text, remedy)
}

/// What turns with the shaft in the reading alone is a speed to the supervisor.
fn runout(advice: &Advice) -> Option<Warning> {
    let n = &advice.nominal;
    let (runout_m, hz) = (n.runout_m?, n.spin_hz?.abs());
    let limit_m = advice.vibration.runout_limit_m?;
    if runout_m <= limit_m {
        return None;
    }
    let text = format!(
        "a runout of {:.1} µm at {hz:.1} Hz reads as {:.4} m/s, and more than {:.1} µm hides an approach: the \
         supervisor leaves such a rotor to the levitation controller",
        runout_m * 1e6,
        runout_m * hz * std::f64::consts::TAU,
        limit_m * 1e6
    );
    let remedy = format!(
        "subtract from the samples what slow roll shows against the angle of the shaft, or work the track of the \
         sensor down to {} µm",
        rounded_down(limit_m * 1e6)
    );
    warning("runout", text, remedy)
}
