//! Tables of the chapter on limits.

use super::{HELD_SPIN_HZ, HIGHEST_HZ, PaperError, Runs, Table, soft_along_tangent, whirl};
use plant_model::analysis::black::{Circle, SteadyWhirl};
use std::f64::consts::TAU;

fn cells<const N: usize>(row: [String; N]) -> Vec<String> {
    row.to_vec()
}

fn headings<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).to_vec()
}

fn stiffness(k: f64) -> String {
    if k.is_finite() {
        format!("{k:e}")
    } else {
        "∞".to_owned()
    }
}

fn stability(circle: &Circle) -> String {
    match circle.growth_rate_s {
        _ if !circle.exists() => "needs a pull".to_owned(),
        rate if rate < 0.0 => format!("stable, {rate:.0}"),
        rate => format!("unstable, {rate:+.0}"),
    }
}

/// All roots for each contact stiffness.
pub(super) fn roots() -> Result<Table, PaperError> {
    let mut rows = Vec::new();
    for k in [f64::INFINITY, 1e10, 1e9, 5e8, 3e8] {
        for root in whirl(k)?.sliding(1.0, HIGHEST_HZ) {
            rows.push(cells([
                stiffness(k),
                format!("{:.1}", root.frequency_hz()),
                if root.exists() {
                    format!("{:.4}", root.normal_force_n / 1e3)
                } else {
                    "–".to_owned()
                },
                if root.attracts { "below" } else { "above" }.to_owned(),
                stability(&root),
            ]));
        }
    }
    Ok(Table {
        caption: "Steady sliding whirl, 1 to 5000 Hz; growth rate of small disturbances (constant μ; k_c = ∞ as 1e12 N/m with a contact damping ratio of 0.08)".to_owned(),
        columns: headings(["k_c [N/m]", "Whirl [Hz]", "N [kN]", "Friction drives", "Growth rate [1/s]"]),
        rows,
    })
}

/// Held spin against the closed forms.
pub(super) fn held(all: &[Runs]) -> Result<Table, PaperError> {
    let mut rows = Vec::new();
    for run in all {
        let whirl = whirl(run.stiffness_n_m)?;
        let target = match whirl.upper_limit(HIGHEST_HZ) {
            Some(limit) => Some(limit),
            // No sliding limit: the rolling circle of this spin.
            None => (whirl.rolling(HELD_SPIN_HZ * TAU, 0.1, (1.0, HIGHEST_HZ)))
                .into_iter()
                .find(|c| c.growth_rate_s < 0.0),
        };
        let state = if run.held.rolls { "rolls" } else { "slides" };
        let mut row = vec![
            stiffness(run.stiffness_n_m),
            format!("{:.3}", run.held.whirl_hz),
            format!("{:.2}", run.held.normal_force_n / 1e3),
            state.to_owned(),
        ];
        row.extend(match target {
            Some(circle) => [
                format!("{:.3}", circle.frequency_hz()),
                format!("{:.2}", circle.normal_force_n / 1e3),
                format!(
                    "{:.1e}",
                    (run.held.whirl_hz / circle.frequency_hz() - 1.0).abs()
                ),
            ],
            None => ["–".to_owned(), "–".to_owned(), "–".to_owned()],
        });
        rows.push(row);
    }
    Ok(Table {
        caption: format!(
            "Run to steady state at {HELD_SPIN_HZ} Hz held spin, against the closed form (sliding limit, or rolling circle where that needs a pull; at 3e8 N/m the circle is centimetres wide, a solution of the equations and of no machine)"
        ),
        columns: headings([
            "k_c [N/m]",
            "Whirl, run [Hz]",
            "N, run [kN]",
            "State",
            "Whirl, closed form [Hz]",
            "N, closed form [kN]",
            "Relative difference",
        ]),
        rows,
    })
}

/// Spin-down against both limits.
pub(super) fn spin_down(all: &[Runs]) -> Result<Table, PaperError> {
    let over = |value: f64, limit: Option<f64>| {
        limit.map_or("–".to_owned(), |l| {
            format!("{:+.2} %", 100.0 * (value / l - 1.0))
        })
    };
    let mut rows = Vec::new();
    for run in all {
        let limit = (whirl(run.stiffness_n_m)?.upper_limit(HIGHEST_HZ)).map(|c| c.frequency_hz());
        let soft = (soft_along_tangent(run.stiffness_n_m)?.upper_limit(HIGHEST_HZ))
            .map(|c| c.frequency_hz());
        let hz = |v: Option<f64>| v.map_or("needs a pull".to_owned(), |v| format!("{v:.1}"));
        rows.push(cells([
            stiffness(run.stiffness_n_m),
            format!("{:.1}", run.fastest_hz[0]),
            format!("{:.1}", run.fastest_hz[1]),
            hz(limit),
            over(run.fastest_hz[1], limit),
            hz(soft),
            over(run.fastest_hz[1], soft),
        ]));
    }
    Ok(Table {
        caption: "Spin-down: fastest whirl (1 ms mean) against the limit, and against that of a contact as soft along the tangent, which the equations do not have".to_owned(),
        columns: headings([
            "k_c [N/m]",
            "From 40 Hz [Hz]",
            "From 166 Hz [Hz]",
            "Limit [Hz]",
            "166 Hz over it",
            "Limit, soft along tangent [Hz]",
            "166 Hz over it",
        ]),
        rows,
    })
}

/// Rolling whirl in kinematic contact.
pub(super) fn rolling(hard: &SteadyWhirl) -> Table {
    let mu_r = 0.025;
    let cone = (-(hard.driving_friction + 2.0 * mu_r), hard.driving_friction);
    let rows = [
        45.0, 50.0, 100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 734.0, 740.0, 900.0, 1000.0,
        1500.0, 2000.0, 2500.0,
    ]
    .map(|hz: f64| {
        let (circle, spin) = hard.rolling_at(hz * TAU, 0.1);
        let held = circle.driving_share > cone.0 && circle.driving_share < cone.1;
        cells([
            format!("{hz:.0}"),
            format!("{:.3}", spin / TAU),
            format!("{:.4}", circle.normal_force_n / 1e3),
            format!("{:.4}", circle.driving_share),
            match (circle.exists(), held) {
                (false, _) => "no: needs a pull",
                (true, false) => "no: slides",
                (true, true) => "yes",
            }
            .to_owned(),
            stability(&circle),
        ])
    })
    .to_vec();
    Table {
        caption: "Whirl in kinematic contact (footnote 1): rolling without slip at c, ω = Ω·R_r/c. The bands in which the cone of friction holds it end at the sliding roots. Its disturbances decay wherever it presses, since the constraint leaves rotor and stator a damped linear system".to_owned(),
        columns: headings([
            "Whirl [Hz]",
            "Spin [Hz]",
            "N [kN]",
            "Tangential force/N",
            "Exists",
            "Growth rate [1/s]",
        ]),
        rows,
    }
}

/// Existence and limit over driving friction.
pub(super) fn existence() -> Result<Table, PaperError> {
    let mut rows = Vec::new();
    for mu in [0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.125, 0.2, 0.3, 0.5] {
        let mut whirl = whirl(f64::INFINITY)?;
        whirl.driving_friction = mu;
        let hz =
            |c: Option<Circle>| c.map_or("–".to_owned(), |c| format!("{:.1}", c.frequency_hz()));
        rows.push(cells([
            mu.to_string(),
            hz(whirl.onset(HIGHEST_HZ)),
            hz(whirl.upper_limit(HIGHEST_HZ)),
        ]));
    }
    Ok(Table {
        caption: "Onset and upper limit over μ − μ_r, k_c = ∞".to_owned(),
        columns: headings(["μ − μ_r", "Onset [Hz]", "Upper limit [Hz]"]),
        rows,
    })
}
