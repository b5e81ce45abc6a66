//! What a wrongly configured number costs, as the study `sensitivity` measured it on 1815 blows of 31 machines
//! (docs/src/measured/sensitivity.md): so contradictions stand in the order in which they matter.

/// A number that is configured so many times as large as it is: blows that levitation alone recovers from and the supervisor then
/// does not, of 1467, and the 95th percentile of the contact force over that of the supervisor configured right.
struct Row {
    times: f64,
    lost: f64,
    force: f64,
}

const BLOWS: f64 = 1467.0;

const fn row(times: f64, lost: f64, force: f64) -> Row {
    Row { times, lost, force }
}

/// By the end of the name; in the order of `times`. Of what the study gives a loss alone the force is left as it is.
const MEASURED: &[(&str, &[Row])] = &[
    (
        "mass_kg",
        &[
            row(0.64, 0.0, 1.19),
            row(0.8, 0.0, 1.09),
            row(1.0, 0.0, 1.0),
            row(1.25, 0.0, 1.02),
            row(1.56, 0.0, 1.02),
        ],
    ),
    (
        "stiffness_n_m",
        &[
            row(0.51, 0.0, 1.01),
            row(1.0, 0.0, 1.0),
            row(1.96, 0.0, 1.01),
        ],
    ),
    (
        "clearance_m",
        &[
            row(0.826, 0.0, 1.08),
            row(0.909, 0.0, 1.05),
            row(1.0, 0.0, 1.0),
            row(1.1, 0.0, 1.14),
            row(1.21, 2.0, 1.45),
        ],
    ),
    // A cap is configured too small where a force is more than configured.
    (
        "force_factor",
        &[
            row(0.64, 28.0, 25.07),
            row(0.8, 8.0, 1.96),
            row(1.0, 0.0, 1.0),
            row(1.25, 0.0, 1.10),
            row(1.56, 0.0, 1.19),
        ],
    ),
    (
        "time_to_force_s",
        &[row(1.0, 0.0, 1.0), row(2.0, 0.0, 1.0), row(4.0, 10.0, 1.0)],
    ),
    (
        "sensor_noise_m",
        &[row(1.0, 0.0, 1.0), row(3.0, 0.0, 1.0), row(9.0, 3.0, 1.0)],
    ),
    (
        "inertia_kg_m2",
        &[row(0.8, 0.0, 1.0), row(1.0, 0.0, 1.0), row(1.25, 0.0, 1.0)],
    ),
];

/// Signs that are wrong: the force acts against the motion that it should stop, and every rotor is lost.
const OF_SIGN: [&str; 2] = ["axes_handedness", "spin_sense"];
/// Beyond this angle a force pushes away from where it should \[rad\].
const TURNED_AWAY_RAD: f64 = std::f64::consts::FRAC_PI_2;

/// What it costs: runs that are lost, as a share, and contact force over that of a supervisor configured right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cost {
    pub(super) lost: f64,
    pub(super) force: f64,
}

impl Cost {
    /// Of a number that is configured as one and is another; `None` of what nobody has measured.
    pub(super) fn of(name: &str, configured: f64, is: f64) -> Option<Self> {
        let all = Self {
            lost: 1.0,
            force: 1.0,
        };
        if OF_SIGN.iter().any(|of| name.ends_with(of)) {
            return Some(all);
        }
        if name.ends_with("axes_turned_rad") {
            return ((configured - is).abs() > TURNED_AWAY_RAD).then_some(all);
        }
        let (_, rows) = MEASURED.iter().find(|(of, _)| name.ends_with(of))?;
        let times = configured / is;
        if times <= 0.0 || !times.is_finite() {
            return None;
        }
        let lost = (interpolated(rows, times, |row| row.lost) / BLOWS).clamp(0.0, 1.0);
        let force = interpolated(rows, times, |row| row.force).max(1.0);
        Some(Self { lost, force })
    }

    /// For people.
    pub(super) fn text(of: Option<Self>) -> String {
        match of {
            None => "not measured".to_owned(),
            Some(Self { lost, .. }) if lost >= 1.0 => "the rotor".to_owned(),
            Some(Self { lost, force }) if lost * BLOWS >= 0.5 => {
                format!(
                    "{:.1} % of blows lost, contact force × {force:.2}",
                    100.0 * lost
                )
            }
            Some(Self { force, .. }) => format!("no blow lost, contact force × {force:.2}"),
        }
    }

    /// What costs more comes first; what nobody has measured behind what loses rotors.
    pub(super) fn order(of: Option<Self>) -> (f64, f64) {
        of.map_or((0.5 / BLOWS, 1.0), |cost| (cost.lost, cost.force))
    }
}

/// Between rows by the logarithm of how often; beyond them as between the last two.
fn interpolated(rows: &[Row], times: f64, of: impl Fn(&Row) -> f64) -> f64 {
    let at = times.ln();
    let above = rows.iter().position(|row| row.times >= times);
    let above = above.unwrap_or(rows.len() - 1).max(1);
    let (low, high) = (&rows[above - 1], &rows[above]);
    let share = (at - low.times.ln()) / (high.times.ln() - low.times.ln());
    // What is measured on one side alone costs nothing on the other.
    if times < rows[0].times && rows[0].times == 1.0 {
        return of(&rows[0]);
    }
    of(low) + share * (of(high) - of(low))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_loses_rotors_comes_first() {
        let order = |name: &str, configured: f64| Cost::order(Cost::of(name, configured, 1.0));
        let signs = order("A.axes_handedness", -1.0);
        let force = order("B.force_factor", 0.64);
        let lag = order("time_to_force_s", 4.0);
        let unknown = order("gain_of_y_over_x", 2.0);
        let mass = order("mass_kg", 2.0);
        assert!(signs > force && force > lag && lag > unknown && unknown > mass);
        // On rows as they are, between them, beyond them, and of one-sided ones.
        let close = |name: &str, times: f64, lost: f64| {
            let cost = Cost::of(name, times, 1.0).unwrap();
            assert!(
                (cost.lost * BLOWS - lost).abs() < 1e-9,
                "{name} {times}: {cost:?}"
            );
        };
        close("force_factor", 0.64, 28.0);
        close("force_factor", 1.0, 0.0);
        close("time_to_force_s", 0.2, 0.0);
        close("time_to_force_s", 8.0, 20.0);
        assert!(Cost::of("mass_kg", -1.0, 1.0).is_none());
    }
}
