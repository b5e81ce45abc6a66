//! Chapter "Onset": the critical tangential speed, and the critical radial impact speed of the five
//! configurations of Fig. 3.

mod variants;

use super::data::*;
use super::rotors::OnsetRig;
use plant_model::analysis::impact::{
    Aim, Criterion, Impact, ImpactError, Search, critical_speeds_m_s, run_impacts,
};
use plant_model::analysis::onset::critical_tangential_speed_m_s;
use plant_model::params::Start;
use plant_model::{Inputs, Options, V2, build};

const RESULTS: &str = "Results, onset phase; Fig. 3";

/// One configuration of Fig. 3.
#[derive(Debug, Clone, Copy)]
pub(super) struct Configuration {
    pub(super) name: &'static str,
    pub(super) rig: OnsetRig,
    /// Inclination of the impact into the whirl direction \[rad\].
    pub(super) inclination_rad: f64,
    /// Critical speed as measured \[m/s\].
    pub(super) measured_m_s: f64,
    /// How the computed value comes about.
    kind: Kind,
}

/// The two constants that are fitted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    /// Restitution, on the solid disc at a damping ratio of 0.3 %.
    pub(super) restitution: f64,
    /// Coefficient of friction of the seal elements, on their configuration.
    pub(super) seal_friction: f64,
}

/// The five configurations of Fig. 3 in the order of this chapter: two fitted, the three between them
/// predicted.
pub(super) fn configurations(fit: &Fit) -> [Configuration; 5] {
    let disc = OnsetRig::solid_disc(fit.restitution);
    let damped = disc.with(|rig| rig.damping_ratio = 0.035);
    let seals = disc.with(|rig| rig.friction = fit.seal_friction);
    let of = |name, rig, inclination_deg: f64, measured_m_s, kind| Configuration {
        name,
        rig,
        inclination_rad: inclination_deg.to_radians(),
        measured_m_s,
        kind,
    };
    [
        of("solid disc, 0.3 %", disc, 0.0, 0.093, Fitted),
        of("solid disc, 3.5 %", damped, 0.0, 0.137, Predicted),
        of("inclined 30°", disc, 30.0, 0.064, Predicted),
        of("inclined 50°", disc, 50.0, 0.056, Predicted),
        of("seal elements", seals, 0.0, 0.043, Fitted),
    ]
}

/// An impact at the spin of the rig, whose speed is looked for.
pub(super) fn aim(inclination_rad: f64) -> Aim {
    Aim {
        inclination_rad,
        spin_rad_s: OnsetRig::SPIN_RAD_S,
        spin_phase_rad: 0.0,
    }
}

/// An impact at the spin of the rig.
pub(super) fn impact(speed_m_s: f64, inclination_rad: f64) -> Impact {
    Impact {
        speed_m_s,
        inclination_rad,
        spin_rad_s: OnsetRig::SPIN_RAD_S,
        spin_phase_rad: 0.0,
    }
}

/// Critical impact speed \[m/s\] of a plant at an inclination.
pub(super) fn critical_m_s(params: &PlantParams, inclination_rad: f64) -> Result<f64> {
    let speeds_m_s = critical_speeds(
        &[(*params, aim(inclination_rad))],
        &Search::default(),
        &Criterion::default(),
    )?;
    Ok(speeds_m_s[0])
}

/// Critical impact speeds \[m/s\] of plants.
fn critical_speeds(
    cases: &[(PlantParams, Aim)],
    search: &Search,
    criterion: &Criterion,
) -> Result<Vec<f64>> {
    let (found, _) = critical_speeds_m_s(cases, search, criterion);
    let speed = |found: std::result::Result<Option<f64>, ImpactError>| {
        found?.or_missing("no impact speed that ends in whirl")
    };
    found.into_iter().map(speed).collect()
}

/// A constant between two others with which the critical speed of a radial impact, which falls with it, is as measured.
fn fitted(
    (low, high): (f64, f64),
    measured_m_s: f64,
    rig: impl Fn(f64) -> OnsetRig,
) -> Result<f64> {
    let above = |constant: f64| Ok(critical_m_s(&rig(constant).params()?, 0.0)? > measured_m_s);
    if !above(low)? || above(high)? {
        return missing(format!(
            "{measured_m_s} is not met between {low} and {high}"
        ));
    }
    let (low, high) = halved((low, high), |high| 1e-5 * high, above)?;
    Ok(0.5 * (low + high))
}

/// Fits the restitution on the first configuration at a contact stiffness.
fn fit_restitution(contact_stiffness_n_m: f64) -> Result<f64> {
    fitted((0.5, 0.9), 0.093, |restitution| {
        OnsetRig::solid_disc(restitution)
            .with(|rig| rig.contact_stiffness_n_m = contact_stiffness_n_m)
    })
}

/// Fits restitution and friction of the seals, each on its own configuration.
pub(super) fn fit() -> Result<Fit> {
    let restitution = fit_restitution(OnsetRig::solid_disc(1.0).contact_stiffness_n_m)?;
    let disc = OnsetRig::solid_disc(restitution);
    let with = |friction| disc.with(|rig| rig.friction = friction);
    let seal_friction = fitted((0.15, 0.9), 0.043, with)?;
    Ok(Fit {
        restitution,
        seal_friction,
    })
}

/// Whether whirl grows from a start in contact on the circle that balances the normal force at a speed \[m/s\].
fn grows(params: &PlantParams, speed: f64, threshold_m_s: f64) -> Result<bool> {
    let (m, k) = (params.rotor.mass_kg, params.rotor.stiffness_n_m);
    let (c, k_c) = (params.contact.clearance_m, params.contact.stiffness_n_m());
    let radius = c + (m * speed * speed / c - k * c).max(0.0) / k_c;
    let start = Start {
        position_m: V2::new(radius, 0.0),
        velocity_m_s: V2::new(0.0, -speed * radius / c),
        spin_rad_s: OnsetRig::SPIN_RAD_S,
        spin_phase_rad: 0.0,
    };
    let mut plant = build(params, &start, Options::default())?;
    for tenth in 1..=20 {
        let t_s = 0.1 * f64::from(tenth);
        plant.advance(t_s, &Inputs::default(), &mut |_| {})?;
        if !plant.mode().in_contact() {
            return Ok(false);
        }
        if plant.meters().peak_backward_speed_m_s > 1.2 * threshold_m_s {
            return Ok(true);
        }
    }
    missing("whirl neither grew nor died")
}

/// v_t,crit \[m/s\]: by its closed form, and simulated, bisected between 0.99 and 1.01 of that.
fn thresholds_m_s(rig: &OnsetRig) -> Result<[f64; 2]> {
    let params = rig.params()?;
    let closed = critical_tangential_speed_m_s(&params);
    let closed = closed.or_missing("no critical tangential speed")?;
    let below = |speed: f64| Ok(!grows(&params, speed, closed)?);
    let (low, high) = (0.99 * closed, 1.01 * closed);
    if !below(low)? || below(high)? {
        return missing("threshold farther than 1 % from its closed form");
    }
    let (_, simulated) = halved((low, high), |high| 1e-6 * high, below)?;
    Ok([closed, simulated])
}

/// How far above v_r,crit impacts are counted.
const SHARES: [f64; 6] = [1.0, 1.02, 1.05, 1.1, 1.2, 1.5];

/// A configuration with its critical speed \[m/s\] by μ as it is, 25 % lower and 25 % higher as in Fig. 3.
struct Solved {
    of: Configuration,
    value_m_s: f64,
    slippery_m_s: f64,
    rough_m_s: f64,
    /// Impacts until the backward speed passes v_t,crit, for each of [`SHARES`].
    impacts: [Option<u32>; 6],
}

impl Solved {
    fn new(of: &Configuration) -> Result<Self> {
        let aim = aim(of.inclination_rad);
        let with = |share: f64| of.rig.with(|rig| rig.friction *= share).params();
        let cases = [(with(1.0)?, aim), (with(0.75)?, aim), (with(1.25)?, aim)];
        let speeds_m_s = critical_speeds(&cases, &Search::default(), &Criterion::default())?;
        let value_m_s = speeds_m_s[0];
        let after = SHARES.map(|share| (cases[0].0, impact(share * value_m_s, of.inclination_rad)));
        let mut impacts = [None; 6];
        for (count, after) in (impacts.iter_mut()).zip(run_impacts(&after, &Criterion::default())) {
            *count = after?.impacts_to_threshold;
        }
        Ok(Self {
            of: *of,
            value_m_s,
            slippery_m_s: speeds_m_s[1],
            rough_m_s: speeds_m_s[2],
            impacts,
        })
    }
}

/// Root mean square of ln(computed/measured) over the three predictions.
fn rms_log_error(configurations: &[Configuration; 5], computed_m_s: &[f64]) -> f64 {
    let squares = (configurations.iter().zip(computed_m_s))
        .filter(|(c, _)| c.kind == Predicted)
        .map(|(c, v)| (v / c.measured_m_s).ln().powi(2));
    (squares.sum::<f64>() / 3.0).sqrt()
}

/// The chapter.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let fit = fit()?;
    let five = configurations(&fit);
    let all = each(&five, Solved::new)?;
    let speeds: Vec<f64> = all.iter().map(|solved| solved.value_m_s).collect();
    let mut rows = threshold_rows(&five)?;
    rows.extend(rows! {
        "Restitution e", "", "not in the paper", Silent => fit.restitution, Fitted, "fitted on the solid disc at 0.3 % alone";
        "μ of the seal elements", "", "Results, onset phase", Silent => fit.seal_friction, Fitted, "fitted on the seal elements alone; the paper says very high";
    });
    for solved in &all {
        rows.extend(critical_row(solved)?);
    }
    rows.extend(rows! {
        "rms log error of the three predictions", "", RESULTS, Silent => rms_log_error(&five, &speeds), Predicted, "3.5 %, 30° and 50°";
    });
    rows.extend(impact_rows(&all));
    Ok(Chapter {
        title: "Onset",
        story: vec![
            "A rotor at the wall, moving tangentially against its spin, whirls faster if friction outweighs damping: above v_t,crit. Thrown against the wall radially, it gains tangential speed at every bounce; v_r,crit is the lowest impact speed from which that ends in whirl.".to_owned(),
            "Model: rigid concentric stator, balanced disc, 10 kg, 45 Hz, c = 0.2 mm, μ = 0.125 (0.15 − 0.025), spin held. The paper leaves out how elastic an impact is: one restitution is fitted on the first configuration, one μ for the seals on the last. The three between them are predictions. k_c = 1e8 N/m is assumed; the table of variants says what it does. Inclined impacts start at the wall with the total speed named.".to_owned(),
            "Whirl is a backward tangential speed in contact of 2 v_t,crit. Not whirl is a free vibration whose ellipse can no longer reach the wall. The search goes upwards in steps of 0.5 % to the first whirl and bisects that change to 1e-5.".to_owned(),
        ],
        rows,
        tables: vec![impact_table(&all), variants::table(&fit, extent)?],
        figures: vec![figure(&all)],
    })
}

fn threshold_rows(five: &[Configuration; 5]) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    // The seals' μ was fitted, to another row.
    for (configuration, kind) in [
        (five[0], Predicted),
        (five[1], Predicted),
        (five[4], Assumed),
    ] {
        let name = configuration.name;
        let [closed, simulated] = thresholds_m_s(&configuration.rig)?;
        rows.extend(rows! {
            "v_t,crit, {name}", "m/s", "Modelling, onset phase", Silent => closed, kind,
                "closed form; simulated {simulated:.5} ({:+.3} %)", 100.0 * (simulated / closed - 1.0);
        });
    }
    let rig = &five[0].rig;
    let speed_m_s = critical_tangential_speed_m_s(&rig.params()?);
    let lowest_hz = speed_m_s.map(|v| v / (TAU * rig.clearance_m));
    rows.extend(rows! {
        "Whirl frequency at v_t,crit", "Hz", "Results, test at 40 Hz", AtMost(55.0) => lowest_hz, Predicted,
            "the lowest at which whirl can begin, so a lower bound; the paper reads 55 Hz off a whirl that has begun";
    });
    Ok(rows)
}

fn critical_row(solved: &Solved) -> Result<Vec<Row>> {
    let of = &solved.of;
    let (name, kind, measured_m_s) = (of.name, of.kind, of.measured_m_s);
    let (rough, slippery) = (solved.rough_m_s, solved.slippery_m_s);
    let inside = match (rough..=slippery).contains(&measured_m_s) {
        true => "inside",
        false => "outside",
    };
    let mut remedy = String::new();
    if of.rig.damping_ratio > 0.01 {
        let ratio = 100.0 * damping_that_meets(of)?;
        remedy = format!(
            "; too high, {ratio:.1} % would meet it: modal damping is taken as linear and the same in every direction"
        );
    }
    Ok(rows! {
        "v_r,crit, {name}", "m/s", RESULTS, measured_m_s => solved.value_m_s, kind, "μ ± 25 %: {rough:.3} to {slippery:.3}, measured {inside}{remedy}";
    })
}

/// The damping ratio at which the model gives the speed measured.
fn damping_that_meets(configuration: &Configuration) -> Result<f64> {
    let below = |damping_ratio: f64| {
        let rig = (configuration.rig).with(|rig| rig.damping_ratio = damping_ratio);
        let critical_m_s = critical_m_s(&rig.params()?, configuration.inclination_rad)?;
        Ok(critical_m_s < configuration.measured_m_s)
    };
    let ends = (0.003, configuration.rig.damping_ratio);
    Ok(halved(ends, |high| 1e-4 * high, below)?.1)
}

fn impact_rows(all: &[Solved]) -> Vec<Row> {
    const SOURCE: &str = "Results, onset phase";
    let at = |share: usize| all.iter().filter_map(move |s| s.impacts[share]);
    let most = |share: usize| at(share).max().map(f64::from);
    let fewest = |share: usize| at(share).min().map_or("–".to_owned(), |n| n.to_string());
    rows! {
        "Impacts until v_t,crit, 0 % above v_r,crit: most", "", SOURCE, Between(1.0, 5.0) => most(0), Predicted,
            "of the five configurations; fewest {}; exactly at v_r,crit the last bounces are ever smaller, which no test resolves", fewest(0);
        "Impacts until v_t,crit, 10 % above v_r,crit: most", "", SOURCE, Between(1.0, 5.0) => most(3), Predicted,
            "of the five configurations; fewest {}; as far above as a test series with finite steps ends", fewest(3);
    }
}

fn impact_table(all: &[Solved]) -> Table {
    let cell = |count: Option<u32>| count.map_or("–".to_owned(), |n| n.to_string());
    table! {
        "Impacts until the backward speed passes v_t,crit, the first included";
        for solved in all;
        "Configuration" => "{}", solved.of.name;
        "1 v_r,crit" => "{}", cell(solved.impacts[0]);
        "1.02 v_r,crit" => "{}", cell(solved.impacts[1]);
        "1.05 v_r,crit" => "{}", cell(solved.impacts[2]);
        "1.1 v_r,crit" => "{}", cell(solved.impacts[3]);
        "1.2 v_r,crit" => "{}", cell(solved.impacts[4]);
        "1.5 v_r,crit" => "{}", cell(solved.impacts[5]);
    }
}

/// The chart of the five configurations, as Fig. 3.
fn figure(all: &[Solved]) -> Figure {
    let places = || all.iter().zip((1..).map(f64::from));
    let top = all.iter().map(|s| s.slippery_m_s).fold(0.0, f64::max);
    let names: Vec<String> = places()
        .map(|(s, x)| format!("{x} {}", s.of.name))
        .collect();
    let names = names.join(", ");
    let label =
        |(s, x): (&Solved, f64)| curve(s.of.name.to_owned(), Mark::Name, 5, vec![(x, 1.04 * top)]);
    let interval = |(s, x): (&Solved, f64)| {
        let x = x + 0.08;
        [(x, s.rough_m_s), (x, s.slippery_m_s), (f64::NAN, f64::NAN)]
    };
    let mut curves: Vec<Curve> = places().map(label).collect();
    curves.extend(curves! {
        "μ ± 25 %", Line, 0 => places().flat_map(interval).collect();
        "measured (paper)", Crosses, 1 => places().map(|(s, x)| (x - 0.08, s.of.measured_m_s)).collect();
        "computed", Dots, 0 => places().map(|(s, x)| (x + 0.08, s.value_m_s)).collect();
    });
    chart! {
        "onset_configurations", "Critical radial impact speed, measured and computed",
        "Critical impact speed of the five configurations, as in Fig. 3: {names}. Intervals from μ ± 25 %. Fitted: 1 (restitution) and 5 (μ).";
        Axis::linear("Configuration", (0.5, 5.5)), Axis::linear("v_r,crit [m/s]", (0.0, 1.1 * top));
        curves
    }
}
