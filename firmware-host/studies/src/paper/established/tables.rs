//! Tables of the chapter.

use super::SpinDowns;
use super::falling::Law;
use crate::paper::Table;

/// Spin-downs from all speeds.
pub(super) fn violence(runs: &SpinDowns, limit_hz: f64) -> Table {
    let over = |hz: f64| 100.0 * (hz / limit_hz - 1.0);
    let pair = |a: f64, b: f64, digits: usize| format!("{a:.digits$} / {b:.digits$}");
    Table {
        caption: format!(
            "Spin-down to standstill at constant μ, isotropic / anisotropic stator; beside the whirl its distance from \
             Black's limit of the isotropic stator, {limit_hz:.1} Hz"
        ),
        columns: [
            "From [Hz]",
            "Whirl [Hz]",
            "Over the limit [%]",
            "Force [kN]",
            "Torque [N m]",
            "Rotor [mm]",
            "Inner ring [mm]",
            "Outer ring [mm]",
            "Spin at max [Hz]",
            "Standstill [ms]",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: (runs.isotropic.iter().zip(&runs.anisotropic))
            .map(|(a, b)| {
                let ring = |i: usize| pair(1e3 * a.displacement_m[i], 1e3 * b.displacement_m[i], 3);
                vec![
                    format!("{:.0}", a.spin_hz),
                    pair(a.whirl_hz, b.whirl_hz, 0),
                    pair(over(a.whirl_hz), over(b.whirl_hz), 1),
                    pair(1e-3 * a.force_n, 1e-3 * b.force_n, 1),
                    pair(a.torque_n_m, b.torque_n_m, 0),
                    ring(0),
                    ring(1),
                    ring(2),
                    pair(a.spin_at_middle_hz, b.spin_at_middle_hz, 1),
                    pair(1e3 * a.standstill_s, 1e3 * b.standstill_s, 1),
                ]
            })
            .collect(),
    }
}

/// Friction laws with what each predicts.
pub(super) fn laws(laws: &[Law], constant: [f64; 2]) -> Table {
    let impact = |v: f64| format!("{v:.3}");
    let mut rows: Vec<Vec<String>> = (laws.iter())
        .map(|law| {
            vec![
                format!("{}", law.speed_scale_m_s),
                format!("{:.4}", law.at_speed),
                format!("{:.3}", law.standstill_s[0]),
                format!("{:.1}", 1e3 * law.standstill_s[1]),
                format!("{:.0}", law.median_hz),
                format!("{:.0} to {:.0}", law.lowest_hz, law.largest_hz),
                impact(law.critical_m_s[0]),
                impact(law.critical_m_s[1]),
            ]
        })
        .collect();
    let dash = || "–".to_owned();
    rows.push(vec![
        "constant".to_owned(),
        "0.15".to_owned(),
        dash(),
        dash(),
        dash(),
        dash(),
        impact(constant[0]),
        impact(constant[1]),
    ]);
    Table {
        caption: "Friction that falls with sliding speed, μ_∞ fitted to 0.8 s from 166 Hz: what else follows \
                  (critical: lowest radial impact at the wall that ends in whirl)"
            .to_owned(),
        columns: [
            "v_0 [m/s]", "μ_∞", "Standstill from 166 Hz [s]", "from 40 Hz [ms]", "Whirl at 166 Hz, median [Hz]",
            "lowest to largest [Hz]", "Critical at 40 Hz [m/s]", "at 166 Hz [m/s]",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}
