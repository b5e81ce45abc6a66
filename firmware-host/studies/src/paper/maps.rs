//! Chapter "Stability maps" (Fig. 4 and beyond): the critical impact speed over every parameter, over
//! pairs of them, and the outcome over impact speed, with and without unbalance.

mod outcomes;

use super::data::*;
use super::onset::{aim, fit};
use super::rotors::OnsetRig;
use crate::impacts::{Grid, critical_speeds_m_s};
use firmware_bench::report::plot::text::figures;
use plant_model::analysis::impact::{Criterion, Search};

/// Without unbalance the outcome changes once over the speed (rows of this chapter), so coarse steps
/// find the same change.
const SEARCH: Search = Search {
    step: 0.03,
    tolerance: 1e-4,
};

/// A parameter that is varied.
#[derive(Clone, Copy)]
struct Varied {
    file: &'static str,
    name: &'static str,
    axis: &'static str,
    /// As shown on the axis.
    range: (f64, f64),
    /// Sets it to what the axis shows.
    set: fn(&mut Case, f64),
    /// The paper's measurements on the curves: shown, speed \[m/s\].
    measured: &'static [(f64, f64)],
}

/// The parameters. A line: constant, short name of its figure, name, axis, range, what it sets, measurements.
macro_rules! varied {
    ($($constant:ident: $file:literal, $name:literal, $axis:literal, $range:expr, $set:expr, $measured:expr;)*) => {
        $(const $constant: Varied = Varied {
            file: $file,
            name: $name,
            axis: $axis,
            range: $range,
            set: $set,
            measured: &$measured,
        };)*
        const ALL: &[Varied] = &[$($constant),*];
    };
}

varied! {
    FRICTION: "maps_friction", "μ", "coefficient of friction μ", (0.05, 0.6), |c, v| c.rig.friction = v, [(0.125, 0.093)];
    DAMPING: "maps_damping", "damping ratio", "damping ratio [%]", (0.0, 10.0), |c, v| c.rig.damping_ratio = 0.01 * v, [(0.3, 0.093), (3.5, 0.137)];
    NATURAL: "maps_eigenfrequency", "eigenfrequency", "eigenfrequency [Hz]", (10.0, 150.0), |c, v| c.rig.natural_hz = v, [(45.0, 0.093)];
    RESTITUTION: "maps_restitution", "restitution", "restitution e", (0.1, 0.95), |c, v| c.rig.restitution = v, [];
    CLEARANCE: "maps_clearance", "clearance", "clearance c [mm]", (0.05, 1.0), |c, v| c.rig.clearance_m = 1e-3 * v, [(0.2, 0.093)];
    INCLINATION: "maps_inclination", "inclination", "inclination into the whirl direction [°]", (-20.0, 85.0), |c, v| c.inclination_rad = v.to_radians(), [(0.0, 0.093), (30.0, 0.064), (50.0, 0.056)];
}

impl Varied {
    fn axis(&self) -> Axis {
        Axis::linear(self.axis, self.range)
    }
}

/// A rig with the inclination of its impact.
#[derive(Clone, Copy)]
struct Case {
    rig: OnsetRig,
    inclination_rad: f64,
}

impl Case {
    fn with(mut self, varied: Varied, value: f64) -> Self {
        (varied.set)(&mut self, value);
        self
    }

    /// v_r,crit \[m/s\] of one.
    fn critical_m_s(self) -> Result<f64> {
        critical_m_s(&[self]).map(|speeds| speeds[0])
    }
}

/// v_r,crit \[m/s\] of each; not a number where nothing whirls.
fn critical_m_s(cases: &[Case]) -> Result<Vec<f64>> {
    let of = |case: &Case| Ok((case.rig.params()?, aim(case.inclination_rad)));
    let cases = cases.iter().map(of).collect::<Result<Vec<_>>>()?;
    let (found, _) = critical_speeds_m_s(&cases, &SEARCH, &Criterion::default(), |_| ());
    let speed = |found: std::result::Result<Option<f64>, _>| Ok(found?.unwrap_or(f64::NAN));
    found.into_iter().map(speed).collect()
}

fn linear((from, to): (f64, f64), share: f64) -> f64 {
    from + share * (to - from)
}

/// The chapter.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let rig = Case {
        rig: OnsetRig::solid_disc(fit()?.restitution),
        inclination_rad: 0.0,
    };
    let mut chapter = Chapter::new(
        "Stability maps",
        [
            "The critical impact speed as a function of the rotor is a stability map for the excitation that the rotor bears. The rig is that of the chapter Onset with its fitted restitution; what a figure does not vary stays at μ = 0.125, 0.3 %, 45 Hz, 0.2 mm, radial.",
            "Balanced, in a rigid concentric stator, everything is symmetric about the centre, and from bounce to bounce only the normal and the tangential speed count. The outcome then changes once over the impact speed: the limit is sharp, as the paper reports. Unbalance breaks the symmetry: its phase at the touch counts, whirl and no whirl alternate in a fringe above the lowest speed that whirls, and that lowest speed falls.",
        ],
    );
    for varied in ALL {
        let curves = curves(&rig, *varied, extent.pick(21, 81))?;
        chapter.figures.push(curves);
    }
    let (columns, rows) = extent.pick((16, 10), (60, 40));
    let map = |file, x, y| map(&rig, file, [x, y], Grid { columns, rows });
    chapter.figures.extend([
        map("maps_friction_damping", FRICTION, DAMPING)?,
        map("maps_inclination_restitution", INCLINATION, RESTITUTION)?,
        map("maps_eigenfrequency_clearance", NATURAL, CLEARANCE)?,
    ]);
    chapter.rows = sensitivities(&rig)?;
    outcomes::balanced(&mut chapter, &rig, extent)?;
    outcomes::unbalanced(&mut chapter, &rig.rig, extent)?;
    Ok(chapter)
}

/// v_r,crit over a parameter, for the rig and for one with more of another.
fn curves(rig: &Case, varied: Varied, points: u32) -> Result<Figure> {
    let shares: Vec<f64> = (0..points)
        .map(|i| f64::from(i) / f64::from(points - 1))
        .collect();
    let line = |other: Varied, value: f64| -> Result<Vec<(f64, f64)>> {
        let along: Vec<f64> = shares
            .iter()
            .map(|share| linear(varied.range, *share))
            .collect();
        let case = |x: &f64| rig.with(varied, *x).with(other, value);
        let speeds = critical_m_s(&along.iter().map(case).collect::<Vec<_>>())?;
        Ok(along.into_iter().zip(speeds).collect())
    };
    let mut curves: Vec<Curve> = match varied.file == DAMPING.file {
        true => curves! {
            "μ = 0.125", Line, 0 => line(FRICTION, 0.125)?;
            "μ = 0.3", Line, 1 => line(FRICTION, 0.3)?;
        },
        false => curves! {
            "damping ratio 0.3 %", Line, 0 => line(DAMPING, 0.3)?;
            "damping ratio 3.5 %", Line, 1 => line(DAMPING, 3.5)?;
        },
    };
    let top = 1.05 * highest(&curves);
    if !varied.measured.is_empty() {
        curves.extend(curves! { "measured (paper)", Crosses, 3 => varied.measured.to_vec(); });
    }
    let name = varied.name;
    Ok(chart! {
        varied.file, "Critical impact speed over {name}", "Critical impact speed over {name}.";
        varied.axis(), Axis::linear("v_r,crit [m/s]", (0.0, top));
        curves
    })
}

/// v_r,crit over two parameters.
fn map(rig: &Case, file: &'static str, [x, y]: [Varied; 2], grid: Grid) -> Result<Figure> {
    let case = |(across, up): (f64, f64)| {
        rig.with(x, linear(x.range, across))
            .with(y, linear(y.range, up))
    };
    let cases: Vec<Case> = grid.places().into_iter().map(case).collect();
    let cells = grid.rows(&critical_m_s(&cases)?);
    // A few cells with the highest speeds would take all the colours.
    let mut all: Vec<f64> = cells.iter().flatten().copied().collect();
    all.retain(|v| v.is_finite());
    all.sort_by(f64::total_cmp);
    let place = (0.95 * (all.len() as f64 - 1.0)) as usize;
    let (low, high) =
        (all.first().zip(all.get(place))).or_missing(format!("{file}: nothing whirls"))?;
    let label = format!("Critical impact speed over {} and {}", x.name, y.name);
    Ok(Figure {
        file: file.into(),
        caption: format!("{label}; darker bears more. The highest twentieth has one colour."),
        drawing: Drawing::Map(HeatMap {
            label,
            x: x.axis(),
            y: y.axis(),
            names: Default::default(),
            scale: (*low, *high, "v_r,crit [m/s]".to_owned()),
            cells,
        }),
    })
}

/// How v_r,crit goes with each parameter: the exponent of a power law about the rig.
fn sensitivities(case: &Case) -> Result<Vec<Row>> {
    const FIG_4: &str = "Fig. 4";
    let rig = &case.rig;
    let exponent = |varied: Varied, value: f64| -> Result<f64> {
        let of = |share: f64| case.with(varied, share * value).critical_m_s();
        Ok((of(1.05)? / of(0.95)?).ln() / (1.05_f64 / 0.95).ln())
    };
    let restitution = figures(rig.restitution);
    Ok(rows! {
        "Exponent of v_r,crit in μ at 0.125", "", FIG_4, Silent => exponent(FRICTION, rig.friction)?, Predicted, "text: falls; no number";
        "Exponent of v_r,crit in damping ratio at 0.3 %", "", FIG_4, Silent => exponent(DAMPING, 100.0 * rig.damping_ratio)?, Predicted, "text: rises; no number";
        "Exponent of v_r,crit in damping ratio at 3.5 %", "", FIG_4, Silent => exponent(DAMPING, 3.5)?, Predicted, "text: rises; no number";
        "Exponent of v_r,crit in eigenfrequency at 45 Hz", "", FIG_4, Silent => exponent(NATURAL, rig.natural_hz)?, Predicted, "text: rises with the shaft's stiffness; no number";
        "Exponent of v_r,crit in restitution at {restitution}", "", FIG_4, Silent => exponent(RESTITUTION, rig.restitution)?, Predicted, "text: counts, without a sense; no number";
        "Exponent of v_r,crit in clearance at 0.2 mm", "", FIG_4, Silent => exponent(CLEARANCE, 1e3 * rig.clearance_m)?, Predicted, "text: recommends more of it; no number";
    })
}
