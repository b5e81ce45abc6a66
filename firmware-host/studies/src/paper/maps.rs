//! Chapter "Stability maps" (Fig. 4 and beyond): the critical impact speed over every parameter, over
//! pairs of them, and the outcome over impact speed, with and without unbalance.

mod fringe;
mod outcomes;

use super::onset::fit;
use super::rotors::OnsetRig;
use super::{
    Axis, Chapter, Chart, Curve, Drawing, Extent, Figure, HeatMap, Kind, Mark, PaperError, Row,
};
use firmware_bench::report::plot::text::figures;
use plant_model::analysis::impact::{Criterion, Search, critical_speed_m_s};
use rayon::prelude::{IntoParallelIterator, ParallelIterator};

const FIG_4: &str = "Fig. 4";

/// Without unbalance the outcome changes once over the speed (rows of this chapter), so coarse steps
/// find the same change.
const SEARCH: Search = Search {
    step: 0.03,
    tolerance: 1e-4,
};

/// A parameter that is varied.
#[derive(Debug, Clone, Copy)]
struct Varied {
    file: &'static str,
    name: &'static str,
    axis: &'static str,
    /// As shown on the axis.
    range: (f64, f64),
    /// Sets it, from what the axis shows; the second is the inclination \[rad\].
    set: fn(&mut OnsetRig, &mut f64, f64),
    /// Points of the paper's measurements on the curves: (shown, speed).
    measured: &'static [(f64, f64)],
}

const FRICTION: Varied = Varied {
    file: "maps_friction",
    name: "μ",
    axis: "coefficient of friction μ",
    range: (0.05, 0.6),
    set: |rig, _, v| rig.friction = v,
    measured: &[(0.125, 0.093)],
};
const DAMPING: Varied = Varied {
    file: "maps_damping",
    name: "damping ratio",
    axis: "damping ratio [%]",
    range: (0.0, 10.0),
    set: |rig, _, v| rig.damping_ratio = 0.01 * v,
    measured: &[(0.3, 0.093), (3.5, 0.137)],
};
const NATURAL: Varied = Varied {
    file: "maps_eigenfrequency",
    name: "eigenfrequency",
    axis: "eigenfrequency [Hz]",
    range: (10.0, 150.0),
    set: |rig, _, v| rig.natural_hz = v,
    measured: &[(45.0, 0.093)],
};
const RESTITUTION: Varied = Varied {
    file: "maps_restitution",
    name: "restitution",
    axis: "restitution e",
    range: (0.1, 0.95),
    set: |rig, _, v| rig.restitution = v,
    measured: &[],
};
const CLEARANCE: Varied = Varied {
    file: "maps_clearance",
    name: "clearance",
    axis: "clearance c [mm]",
    range: (0.05, 1.0),
    set: |rig, _, v| rig.clearance_m = 1e-3 * v,
    measured: &[(0.2, 0.093)],
};
const INCLINATION: Varied = Varied {
    file: "maps_inclination",
    name: "inclination",
    axis: "inclination into the whirl direction [°]",
    range: (-20.0, 85.0),
    set: |_, inclination, v| *inclination = v.to_radians(),
    measured: &[(0.0, 0.093), (30.0, 0.064), (50.0, 0.056)],
};

/// v_r,crit of the rig with some parameters set; not a number where nothing whirls.
fn critical_m_s(rig: &OnsetRig, set: &[(Varied, f64)]) -> Result<f64, PaperError> {
    let (mut rig, mut inclination_rad) = (*rig, 0.0);
    for (varied, value) in set {
        (varied.set)(&mut rig, &mut inclination_rad, *value);
    }
    let at = (inclination_rad, OnsetRig::SPIN_RAD_S);
    let found = critical_speed_m_s(&rig.params()?, at, &SEARCH, &Criterion::default())?;
    Ok(found.unwrap_or(f64::NAN))
}

fn linear((from, to): (f64, f64), share: f64) -> f64 {
    from + share * (to - from)
}

/// The chapter.
///
/// # Errors
/// [`PaperError`].
pub fn chapter(extent: Extent) -> Result<Chapter, PaperError> {
    let rig = OnsetRig::solid_disc(fit()?.restitution);
    let points = if extent == Extent::Full { 81 } else { 21 };
    let cells = if extent == Extent::Full {
        (60, 40)
    } else {
        (16, 10)
    };
    let all = [
        FRICTION,
        DAMPING,
        NATURAL,
        RESTITUTION,
        CLEARANCE,
        INCLINATION,
    ];
    let mut drawn = Vec::new();
    for varied in all {
        drawn.push(curves(&rig, varied, points)?);
    }
    for (file, x, y) in [
        ("maps_friction_damping", FRICTION, DAMPING),
        ("maps_inclination_restitution", INCLINATION, RESTITUTION),
        ("maps_eigenfrequency_clearance", NATURAL, CLEARANCE),
    ] {
        drawn.push(map(&rig, file, (x, y), cells)?);
    }
    let mut rows = sensitivities(&rig)?;
    let (outcome_figures, row) = outcomes::balanced(&rig, extent)?;
    drawn.extend(outcome_figures);
    rows.push(row);
    let fringe = fringe::unbalanced(&rig, extent)?;
    drawn.extend(fringe.figures);
    rows.push(fringe.row);
    Ok(Chapter {
        title: "Stability maps",
        story: story(),
        rows,
        tables: vec![fringe.table],
        figures: drawn,
    })
}

fn story() -> Vec<String> {
    [
        "The critical impact speed as a function of the rotor is a stability map for the excitation that the \
         rotor bears. The rig is that of the chapter Onset with its fitted restitution; what a figure does not \
         vary stays at μ = 0.125, 0.3 %, 45 Hz, 0.2 mm, radial.",
        "Balanced, in a rigid concentric stator, everything is symmetric about the centre, and from bounce to \
         bounce only the normal and the tangential speed count. The outcome then changes once over the impact \
         speed: the limit is sharp, as the paper reports. Unbalance breaks the symmetry: its phase at the touch \
         counts, whirl and no whirl alternate in a fringe above the lowest speed that whirls, and that lowest \
         speed falls.",
    ]
    .map(str::to_owned)
    .to_vec()
}

fn curves(rig: &OnsetRig, varied: Varied, points: usize) -> Result<Figure, PaperError> {
    // What the other line has otherwise.
    let (other, light, heavy, names) = if varied.file == DAMPING.file {
        (FRICTION, 0.125, 0.3, ["μ = 0.125", "μ = 0.3"])
    } else {
        (
            DAMPING,
            0.3,
            3.5,
            ["damping ratio 0.3 %", "damping ratio 3.5 %"],
        )
    };
    let line = |value: f64| -> Result<Vec<(f64, f64)>, PaperError> {
        (0..points)
            .into_par_iter()
            .map(|i| {
                let x = linear(varied.range, i as f64 / (points - 1) as f64);
                Ok((x, critical_m_s(rig, &[(varied, x), (other, value)])?))
            })
            .collect()
    };
    let lines = [line(light)?, line(heavy)?];
    let top = (lines.iter().flatten().map(|p| p.1))
        .filter(|v| v.is_finite())
        .fold(0.0, f64::max);
    let mut curves: Vec<Curve> = (lines.into_iter().zip(names).enumerate())
        .map(|(colour, (points, name))| Curve {
            name: name.to_owned(),
            points,
            mark: Mark::Line,
            colour,
        })
        .collect();
    if !varied.measured.is_empty() {
        curves.push(Curve {
            name: "measured (paper)".to_owned(),
            points: varied.measured.to_vec(),
            mark: Mark::Crosses,
            colour: 3,
        });
    }
    Ok(Figure {
        file: varied.file,
        caption: format!("Critical impact speed over {}.", varied.name),
        drawing: Drawing::Chart(Chart {
            label: format!("Critical impact speed over {}", varied.name),
            x: axis(&varied),
            y: Axis {
                name: "v_r,crit [m/s]".to_owned(),
                range: (0.0, 1.05 * top),
                log: false,
            },
            curves,
        }),
    })
}

fn axis(varied: &Varied) -> Axis {
    Axis {
        name: varied.axis.to_owned(),
        range: varied.range,
        log: false,
    }
}

fn map(
    rig: &OnsetRig,
    file: &'static str,
    (x, y): (Varied, Varied),
    (columns, rows): (usize, usize),
) -> Result<Figure, PaperError> {
    let middle =
        |varied: &Varied, i: usize, n: usize| linear(varied.range, (i as f64 + 0.5) / n as f64);
    let cells: Vec<Vec<f64>> = (0..rows)
        .into_par_iter()
        .map(|j| {
            (0..columns)
                .map(|i| {
                    let set = [(x, middle(&x, i, columns)), (y, middle(&y, j, rows))];
                    critical_m_s(rig, &set)
                })
                .collect()
        })
        .collect::<Result<_, _>>()?;
    // A few cells with the highest speeds would take all the colours.
    let mut all: Vec<f64> = (cells.iter().flatten().copied())
        .filter(|v| v.is_finite())
        .collect();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| {
        all.get((share * (all.len() as f64 - 1.0)) as usize)
            .copied()
    };
    let (Some(low), Some(high)) = (at(0.0), at(0.95)) else {
        return Err(PaperError::Missing(format!("{file}: nothing whirls")));
    };
    Ok(Figure {
        file,
        caption: format!(
            "Critical impact speed over {} and {}; darker bears more. The highest twentieth has one colour.",
            x.name, y.name
        ),
        drawing: Drawing::Map(HeatMap {
            label: format!("Critical impact speed over {} and {}", x.name, y.name),
            x: axis(&x),
            y: axis(&y),
            names: Default::default(),
            cells,
            scale: (low, high, "v_r,crit [m/s]".to_owned()),
        }),
    })
}

/// How v_r,crit goes with each parameter: the exponent of a power law about the rig.
fn sensitivities(rig: &OnsetRig) -> Result<Vec<Row>, PaperError> {
    let at = [
        (FRICTION, rig.friction, "", "text: falls"),
        (DAMPING, 100.0 * rig.damping_ratio, " %", "text: rises"),
        (DAMPING, 3.5, " %", "text: rises"),
        (
            NATURAL,
            rig.natural_hz,
            " Hz",
            "text: rises with the shaft's stiffness",
        ),
        (
            RESTITUTION,
            rig.restitution,
            "",
            "text: counts, without a sense",
        ),
        (
            CLEARANCE,
            1e3 * rig.clearance_m,
            " mm",
            "text: recommends more of it",
        ),
    ];
    at.into_iter()
        .map(|(varied, value, unit, text)| {
            let of = |share: f64| critical_m_s(rig, &[(varied, share * value)]);
            let exponent = (of(1.05)? / of(0.95)?).ln() / (1.05_f64 / 0.95).ln();
            Ok(Row::new(
                (
                    format!(
                        "Exponent of v_r,crit in {} at {}{unit}",
                        varied.name,
                        figures(value)
                    ),
                    "",
                ),
                FIG_4,
                (None, Some(exponent)),
                Kind::Predicted,
                format!("{text}; no number"),
            ))
        })
        .collect()
}
