//! Chapter "Onset": the critical tangential speed, and the critical radial impact speed of the five
//! configurations of Fig. 3.

mod figure;
mod impacts;
mod variants;

use super::rotors::OnsetRig;
use super::{Chapter, Extent, Kind, PaperError, Row, Stated};
use plant_model::analysis::impact::{Criterion, Search, critical_speed_m_s};
use plant_model::analysis::onset::critical_tangential_speed_m_s;
use plant_model::params::Start;
use plant_model::{Inputs, Options, V2, build};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator};
use std::f64::consts::TAU;

const RESULTS: &str = "Results, onset phase; Fig. 3";
/// Share by which μ is varied for the intervals, as in Fig. 3.
const FRICTION_SPREAD: f64 = 0.25;

/// One configuration of Fig. 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Configuration {
    /// Its name.
    pub name: &'static str,
    /// The rotor.
    pub rig: OnsetRig,
    /// Inclination of the impact into the whirl direction \[rad\].
    pub inclination_rad: f64,
    /// Critical speed as measured \[m/s\].
    pub measured_m_s: f64,
    /// How the computed value comes about.
    pub kind: Kind,
}

/// The two constants that are fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Restitution, on the solid disc at a damping ratio of 0.3 %.
    pub restitution: f64,
    /// Coefficient of friction of the seal elements, on their configuration.
    pub seal_friction: f64,
}

/// Critical impact speed \[m/s\] of a rig at an inclination.
///
/// # Errors
/// No whirl at any speed searched, or a run that failed.
pub fn critical_m_s(rig: &OnsetRig, inclination_rad: f64) -> Result<f64, PaperError> {
    let at = (inclination_rad, OnsetRig::SPIN_RAD_S);
    critical_speed_m_s(
        &rig.params()?,
        at,
        &Search::default(),
        &Criterion::default(),
    )?
    .ok_or_else(|| PaperError::Missing("no impact speed that ends in whirl".to_owned()))
}

/// Bisection of a falling function for a value.
fn bisect(
    (mut low, mut high): (f64, f64),
    value: f64,
    of: impl Fn(f64) -> Result<f64, PaperError>,
) -> Result<f64, PaperError> {
    if !(of(low)? > value && of(high)? < value) {
        return Err(PaperError::Missing(format!(
            "{value} is not met between {low} and {high}"
        )));
    }
    while high - low > 1e-5 * high {
        let middle = 0.5 * (low + high);
        if of(middle)? > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(0.5 * (low + high))
}

/// Fits the restitution on the first configuration at a contact stiffness.
pub(super) fn fit_restitution(contact_stiffness_n_m: f64) -> Result<f64, PaperError> {
    bisect((0.5, 0.9), configurations(&NO_FIT)[0].measured_m_s, |e| {
        let rig = OnsetRig {
            contact_stiffness_n_m,
            ..OnsetRig::solid_disc(e)
        };
        critical_m_s(&rig, 0.0)
    })
}

const NO_FIT: Fit = Fit {
    restitution: 1.0,
    seal_friction: 1.0,
};

/// Fits restitution and friction of the seals, each on its own configuration.
///
/// # Errors
/// A value measured that no constant in range gives.
pub fn fit() -> Result<Fit, PaperError> {
    let restitution = fit_restitution(OnsetRig::solid_disc(1.0).contact_stiffness_n_m)?;
    let seals = configurations(&NO_FIT)[4].measured_m_s;
    let seal_friction = bisect((0.15, 0.9), seals, |friction| {
        let rig = OnsetRig {
            friction,
            ..OnsetRig::solid_disc(restitution)
        };
        critical_m_s(&rig, 0.0)
    })?;
    Ok(Fit {
        restitution,
        seal_friction,
    })
}

/// The five configurations of Fig. 3 in the order of this chapter: two fitted, the three between them
/// predicted.
pub fn configurations(fit: &Fit) -> [Configuration; 5] {
    let rig = OnsetRig::solid_disc(fit.restitution);
    let first = Configuration {
        name: "solid disc, 0.3 %",
        rig,
        inclination_rad: 0.0,
        measured_m_s: 0.093,
        kind: Kind::Fitted,
    };
    let predicted = Configuration {
        kind: Kind::Predicted,
        ..first
    };
    let damped = OnsetRig {
        damping_ratio: 0.035,
        ..rig
    };
    let seals = OnsetRig {
        friction: fit.seal_friction,
        ..rig
    };
    [
        first,
        Configuration {
            name: "solid disc, 3.5 %",
            rig: damped,
            measured_m_s: 0.137,
            ..predicted
        },
        Configuration {
            name: "inclined 30°",
            inclination_rad: 30_f64.to_radians(),
            measured_m_s: 0.064,
            ..predicted
        },
        Configuration {
            name: "inclined 50°",
            inclination_rad: 50_f64.to_radians(),
            measured_m_s: 0.056,
            ..predicted
        },
        Configuration {
            name: "seal elements",
            rig: seals,
            measured_m_s: 0.043,
            ..first
        },
    ]
}

/// Simulated v_t,crit \[m/s\]: lowest speed of a start in contact, on the circle that balances the
/// normal force, from which the whirl grows. Bisected between 0.99 and 1.01 of the closed form.
///
/// # Errors
/// A run that failed, or a threshold outside that bracket.
pub fn simulated_threshold_m_s(rig: &OnsetRig) -> Result<f64, PaperError> {
    let params = rig.params()?;
    let closed = critical_tangential_speed_m_s(&params)
        .ok_or_else(|| PaperError::Missing("no critical tangential speed".to_owned()))?;
    let (m, k) = (params.rotor.mass_kg, params.rotor.stiffness_n_m);
    let (c, k_c) = (params.contact.clearance_m, params.contact.stiffness_n_m());
    let grows = |speed: f64| -> Result<bool, PaperError> {
        let normal_n = (m * speed * speed / c - k * c).max(0.0);
        let radius = c + normal_n / k_c;
        let start = Start {
            position_m: V2::new(radius, 0.0),
            velocity_m_s: V2::new(0.0, -speed * radius / c),
            spin_rad_s: OnsetRig::SPIN_RAD_S,
            spin_phase_rad: 0.0,
        };
        let mut plant = build(&params, &start, Options::default())?;
        for tenth in 1..=20 {
            let t_s = 0.1 * f64::from(tenth);
            plant.advance(t_s, &Inputs::default(), &mut |_| {})?;
            if !plant.mode().in_contact() {
                return Ok(false);
            }
            if plant.meters().peak_backward_speed_m_s > 1.2 * closed {
                return Ok(true);
            }
        }
        Err(PaperError::Missing(
            "whirl neither grew nor died".to_owned(),
        ))
    };
    let (mut low, mut high) = (0.99 * closed, 1.01 * closed);
    if grows(low)? || !grows(high)? {
        return Err(PaperError::Missing(
            "threshold farther than 1 % from its closed form".to_owned(),
        ));
    }
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        if grows(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(high)
}

/// Critical speed of a configuration with μ as it is, 25 % lower and 25 % higher.
fn with_interval(configuration: &Configuration) -> Result<[f64; 3], PaperError> {
    let of = |share: f64| {
        let friction = share * configuration.rig.friction;
        let rig = OnsetRig {
            friction,
            ..configuration.rig
        };
        critical_m_s(&rig, configuration.inclination_rad)
    };
    Ok([
        of(1.0)?,
        of(1.0 - FRICTION_SPREAD)?,
        of(1.0 + FRICTION_SPREAD)?,
    ])
}

/// Root of the mean square of ln(computed/measured) over the three predictions.
pub fn rms_log_error(configurations: &[Configuration; 5], computed: &[f64]) -> f64 {
    let squares = (configurations.iter().zip(computed))
        .filter(|(c, _)| c.kind == Kind::Predicted)
        .map(|(c, v)| (v / c.measured_m_s).ln().powi(2));
    let (count, sum) = squares.fold((0, 0.0), |(n, sum), s| (n + 1, sum + s));
    (sum / f64::from(count)).sqrt()
}

/// The chapter.
///
/// # Errors
/// [`PaperError`].
pub fn chapter(extent: Extent) -> Result<Chapter, PaperError> {
    let fit = fit()?;
    let five = configurations(&fit);
    let values: Vec<[f64; 3]> = (five.par_iter())
        .map(with_interval)
        .collect::<Result<_, _>>()?;
    let central: Vec<f64> = values.iter().map(|v| v[0]).collect();
    let rms = rms_log_error(&five, &central);
    let mut rows = threshold_rows(&five)?;
    rows.push(Row::new(
        ("Restitution e", ""),
        "not in the paper",
        (None, Some(fit.restitution)),
        Kind::Fitted,
        "fitted on the solid disc at 0.3 % alone",
    ));
    rows.push(Row::new(
        ("μ of the seal elements", ""),
        "Results, onset phase",
        (None, Some(fit.seal_friction)),
        Kind::Fitted,
        "fitted on the seal elements alone; the paper says very high",
    ));
    for (configuration, [value, slow, fast]) in five.iter().zip(&values) {
        let inside = (*fast..=*slow).contains(&configuration.measured_m_s);
        let mut note = format!(
            "μ ± 25 %: {fast:.3} to {slow:.3}, measured {}",
            if inside { "inside" } else { "outside" }
        );
        if configuration.rig.damping_ratio > 0.01 {
            let ratio = damping_that_meets(configuration)?;
            note += &format!(
                "; too high, {:.1} % would meet it: modal damping is taken as linear and the same in \
                 every direction",
                100.0 * ratio
            );
        }
        rows.push(Row::new(
            (format!("v_r,crit, {}", configuration.name), "m/s"),
            RESULTS,
            (Some(configuration.measured_m_s), Some(*value)),
            configuration.kind,
            note,
        ));
    }
    rows.push(Row::new(
        ("rms log error of the three predictions", ""),
        RESULTS,
        (None, Some(rms)),
        Kind::Predicted,
        "3.5 %, 30° and 50°",
    ));
    let (impact_rows, impact_table) = impacts::until_whirl(&five, &central)?;
    rows.extend(impact_rows);
    Ok(Chapter {
        title: "Onset",
        story: story(),
        rows,
        tables: vec![impact_table, variants::table(&fit, extent)?],
        figures: vec![figure::figure(&five, &values)],
    })
}

fn story() -> Vec<String> {
    [
        "A rotor at the wall, moving tangentially against its spin, whirls faster if friction outweighs \
         damping: above v_t,crit. Thrown against the wall radially, it gains tangential speed at every \
         bounce; v_r,crit is the lowest impact speed from which that ends in whirl.",
        "Model: rigid concentric stator, balanced disc, 10 kg, 45 Hz, c = 0.2 mm, μ = 0.125 (0.15 − 0.025), \
         spin held. The paper leaves out how elastic an impact is: one restitution is fitted on the first \
         configuration, one μ for the seals on the last. The three between them are predictions. k_c = 1e8 N/m is \
         assumed; the table of variants says what it does. Inclined impacts start at the wall with the total \
         speed named.",
        "Whirl is a backward tangential speed in contact of 2 v_t,crit. Not whirl is a free vibration whose \
         ellipse can no longer reach the wall. The search goes upwards in steps of 0.5 % to the first whirl and \
         bisects that change to 1e-5.",
    ]
    .map(str::to_owned)
    .to_vec()
}

fn threshold_rows(five: &[Configuration; 5]) -> Result<Vec<Row>, PaperError> {
    let mut rows = Vec::new();
    for (configuration, kind) in [
        (&five[0], Kind::Predicted),
        (&five[1], Kind::Predicted),
        // Its μ was fitted, to another row.
        (&five[4], Kind::Assumed),
    ] {
        let closed = critical_tangential_speed_m_s(&configuration.rig.params()?);
        let simulated = simulated_threshold_m_s(&configuration.rig)?;
        let off = closed.map_or(f64::NAN, |c| simulated / c - 1.0);
        rows.push(Row::new(
            (format!("v_t,crit, {}", configuration.name), "m/s"),
            "Modelling, onset phase",
            (None, closed),
            kind,
            format!(
                "closed form; simulated {simulated:.5} ({:+.3} %)",
                100.0 * off
            ),
        ));
    }
    let rig = &five[0].rig;
    rows.push(Row::new(
        ("Whirl frequency at v_t,crit", "Hz"),
        "Results, test at 40 Hz",
        (
            Some(55.0),
            critical_tangential_speed_m_s(&rig.params()?).map(|v| v / (TAU * rig.clearance_m)),
        ),
        Kind::Predicted,
        "the lowest at which whirl can begin, so a lower bound; the paper reads 55 Hz off a whirl that has begun",
    ).stated(Stated::AtMost(55.0)));
    Ok(rows)
}

/// The damping ratio at which the model gives the speed measured.
fn damping_that_meets(configuration: &Configuration) -> Result<f64, PaperError> {
    // v_r,crit rises with the damping ratio, so it falls with its negative.
    let of = |negative: f64| {
        let rig = OnsetRig {
            damping_ratio: -negative,
            ..configuration.rig
        };
        critical_m_s(&rig, configuration.inclination_rad)
    };
    let (mut low, mut high) = (0.003, configuration.rig.damping_ratio);
    while high - low > 1e-4 * high {
        let middle = 0.5 * (low + high);
        if of(-middle)? < configuration.measured_m_s {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(high)
}
