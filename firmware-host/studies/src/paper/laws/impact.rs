//! One impact by both laws: force over penetration, and restitution over speed.

use super::onset::{linear_restitution, rig};
use super::{linear_of, matched_at_impact, with_law};
use crate::paper::{Axis, Chart, Curve, Drawing, Extent, Figure, Kind, Mark, PaperError, Row};
use plant_model::params::{PlantParams, SlidingFriction, Start};
use plant_model::{Inputs, Options, V2, build};

/// Impact speed, about v_r,crit of the solid disc \[m/s\].
const SPEED_M_S: f64 = 0.09;

/// What an impact leaves behind.
struct Loop {
    /// Penetration \[µm\] and force \[kN\].
    points: Vec<(f64, f64)>,
    penetration_m: f64,
    force_n: f64,
    duration_s: f64,
}

/// A frictionless impact from the wall, read `samples` times over `longest_s`.
fn impact(params: &PlantParams, longest_s: f64, samples: u32) -> Result<Loop, PaperError> {
    let mut params = *params;
    params.friction.sliding = SlidingFriction::Constant { coefficient: 0.0 };
    let start = Start {
        position_m: V2::new(params.contact.clearance_m, 0.0),
        velocity_m_s: V2::new(SPEED_M_S, 0.0),
        spin_rad_s: 0.0,
        spin_phase_rad: 0.0,
    };
    let mut plant = build(&params, &start, Options::default())?;
    let mut points = Vec::new();
    for i in 0..samples {
        let t_s = longest_s * f64::from(i + 1) / f64::from(samples);
        plant.advance(t_s, &Inputs::default(), &mut |_| {})?;
        let now = plant.snapshot();
        if now.mode.in_contact() {
            points.push((1e6 * now.penetration_m, 1e-3 * now.normal_force_n));
        }
    }
    let meters = plant.meters();
    Ok(Loop {
        points,
        penetration_m: meters.peak_penetration_m,
        force_n: meters.peak_contact_force_n,
        duration_s: meters.contact_time_s,
    })
}

/// Rows and figures of the impact.
pub(super) fn compare(extent: Extent) -> Result<(Vec<Row>, Vec<Figure>), PaperError> {
    let params = rig(0.003)?;
    let linear = linear_of(&params)?;
    let law = matched_at_impact(&params, SPEED_M_S)?;
    let mass_kg = params.contact_mass_kg();
    let samples = if extent == Extent::Quick { 300 } else { 1500 };
    let longest_s = 2.0 * law.undamped_contact_s(SPEED_M_S, mass_kg);
    let a = impact(&params, longest_s, samples)?;
    let b = impact(&with_law(&params, law), longest_s, samples)?;
    let slow = 0.1 * SPEED_M_S;
    let e = linear_restitution(&params)?;
    let row = |quantity: &str, unit, computed: f64, note: String| {
        Row::new(
            (quantity, unit),
            "footnote 2",
            (None, Some(computed)),
            Kind::Assumed,
            note,
        )
    };
    let rows = vec![
        row(
            "Force at the touch, 0.09 m/s",
            "kN",
            0.0,
            format!(
                "linear: a step to d_c·v = {:.3} kN",
                1e-3 * linear.damping_n_s_m * SPEED_M_S
            ),
        ),
        row(
            "Largest force of the impact",
            "kN",
            1e-3 * b.force_n,
            format!(
                "linear: {:.3} kN; closed form, without the shaft, {:.3} kN",
                1e-3 * a.force_n,
                1e-3 * law.peak_force_n(SPEED_M_S, mass_kg)
            ),
        ),
        row(
            "Largest penetration of the impact",
            "µm",
            1e6 * b.penetration_m,
            format!(
                "linear: {:.3} µm; matched to it, but for the force of the shaft",
                1e6 * a.penetration_m
            ),
        ),
        row(
            "Duration of the impact",
            "ms",
            1e3 * b.duration_s,
            format!("linear: {:.3} ms, with a dent left", 1e3 * a.duration_s),
        ),
        row(
            "Restitution at a tenth of the speed",
            "",
            law.restitution(slow),
            format!("linear: {e:.3} at every speed; both the same at 0.09 m/s"),
        ),
    ];
    let curve = |name: &str, points, colour| Curve {
        name: name.to_owned(),
        points,
        mark: Mark::Line,
        colour,
    };
    let top = 1.1e-3 * a.force_n.max(b.force_n);
    let far = 1.1e6 * a.penetration_m.max(b.penetration_m);
    let speeds = (0..=60).map(|i| 1e-3 * 10_f64.powf(0.05 * f64::from(i)));
    let restitution: Vec<_> = speeds.map(|v| (v, law.restitution(v))).collect();
    let figures = vec![
        Figure {
            file: "laws-loop",
            caption: format!(
                "Force over penetration in an impact at {SPEED_M_S} m/s, same restitution and depth. The linear one starts with a step and leaves a dent; what either loop encloses is lost."
            ),
            drawing: Drawing::Chart(Chart {
                label: "Force over penetration by contact law".to_owned(),
                x: Axis {
                    name: "Penetration [µm]".to_owned(),
                    range: (0.0, far),
                    log: false,
                },
                y: Axis {
                    name: "Normal force [kN]".to_owned(),
                    range: (0.0, top),
                    log: false,
                },
                curves: vec![
                    curve("linear", a.points, 0),
                    curve("Hunt and Crossley", b.points, 1),
                ],
            }),
        },
        Figure {
            file: "laws-restitution",
            caption: "Restitution over impact speed, closed forms.".to_owned(),
            drawing: Drawing::Chart(Chart {
                label: "Restitution over impact speed by contact law".to_owned(),
                x: Axis {
                    name: "Impact speed [m/s]".to_owned(),
                    range: (1e-3, 1.0),
                    log: true,
                },
                y: Axis {
                    name: "Restitution".to_owned(),
                    range: (0.0, 1.0),
                    log: false,
                },
                curves: vec![
                    curve("linear", vec![(1e-3, e), (1.0, e)], 0),
                    curve("Hunt and Crossley", restitution, 1),
                ],
            }),
        },
    ];
    Ok((rows, figures))
}
