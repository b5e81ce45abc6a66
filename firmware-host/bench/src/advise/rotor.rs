//! What a supervisor of both planes meets beyond the point mass: nutation and bending.

use crate::report::lines::{width, wrapped};
use crate::report::plot::text::figures;
use crate::scene::Scene;
use crate::scene::role::{ModeAtRisk, Role};
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::Write;
use supervisor::Config;

/// A turn of the nutation by the time a force acts beyond which the supervisor leaves the rotor to levitation, but for
/// backward whirl \[rad\].
pub(crate) const MOST_TURN_RAD: f64 = 1.25;

/// Of a rotor with a supervisor; keys are stable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RotorAdvice {
    /// Frequency with which a free tilt turns at the scene's spin, (I_p/I_t)·Ω \[Hz\]; its sign is that of the spin.
    pub nutation_hz: f64,
    /// By how much that turns from a sample to its force, the later plane's \[rad\].
    pub nutation_turn_rad: f64,
    /// The spin at which that is `MOST_TURN_RAD` \[Hz\]; none of a rotor without polar inertia.
    pub spin_of_most_turn_hz: Option<f64>,
    /// Bending modes below half the control rate, in the order of their frequencies.
    pub modes: Vec<ModeAtRisk>,
    /// Bending between each retainer bearing and the straight line through both sensors, under the caps of both magnets, over
    /// the clearance there: the larger of both planes; none where both sensors are at one place.
    pub bending_over_clearance: Option<f64>,
    /// What the supervisor does with these configurations.
    pub role: Role,
}

impl RotorAdvice {
    /// With these configurations of its planes; `None` of a rotor that has no supervisor for both.
    pub fn new(scene: &Scene, configs: &[Config]) -> Option<Self> {
        let shaft = scene.shaft()?;
        let [first, second] = configs else {
            return None;
        };
        let inertias =
            f64::from(shaft.polar_inertia_kg_m2) / f64::from(shaft.transverse_inertia_kg_m2);
        let late_s = |config: &Config| {
            let period_s = f64::from(config.sample_period_s);
            (f64::from(config.delay_samples.round()) + 0.5) * period_s
                + f64::from(config.amplifier_lag_s)
        };
        let later_s = late_s(first).max(late_s(second));
        let nutation_hz = inertias * scene.start.spin_rad_s / TAU;
        let both = [*first, *second];
        Some(Self {
            nutation_hz,
            nutation_turn_rad: (TAU * nutation_hz * later_s).abs(),
            spin_of_most_turn_hz: (inertias > 0.0)
                .then(|| MOST_TURN_RAD / (TAU * inertias * later_s)),
            modes: scene.modes_at_risk(&both),
            bending_over_clearance: scene.bending_over_clearance(&both),
            role: scene.role(&both),
        })
    }

    /// For people.
    pub fn text(&self) -> String {
        let mut text = format!(
            "Nutation\n  {} Hz, which turns by {:.2} rad until a force acts",
            figures(self.nutation_hz),
            self.nutation_turn_rad
        );
        if let Some(spin_hz) = self.spin_of_most_turn_hz {
            let _ = write!(
                text,
                "; {MOST_TURN_RAD} rad, beyond which it acts on backward whirl alone, at a spin of {} Hz",
                figures(spin_hz)
            );
        }
        text.push('\n');
        if !self.modes.is_empty() {
            text.push_str("\nBending modes under the supervisor's force\n");
        }
        for mode in &self.modes {
            let verdict = match (mode.grows(), mode.added_damping_ratio < 0.0) {
                (true, _) if self.role.name == "full" => "it would grow",
                (true, _) => "it would grow if it acted in flight",
                (_, true) => "driven, less than it is damped",
                _ => "damped",
            };
            let percent = |x: f64| format!("{:.2} %", 100.0 * x);
            let _ = writeln!(
                text,
                "  {} Hz: damping ratio {} and {} by the force: {verdict}",
                figures(mode.frequency_hz),
                percent(mode.damping_ratio),
                percent(mode.added_damping_ratio)
            );
            if !mode.grows() || self.role.name != "full" {
                continue;
            }
            let better = (mode.told_damping_ratio).filter(|with| *with > mode.added_damping_ratio);
            let _ = match better {
                Some(with) => writeln!(
                    text,
                    "    do: set bending_first_hz = {} (or bending_second_hz) in [supervisor]; then the force adds {}",
                    figures(mode.frequency_hz),
                    percent(with)
                ),
                None => writeln!(
                    text,
                    "    do: move sensor and magnet to the same side of the node, or raise observer_pole_flight"
                ),
            };
        }
        if let Some(bends) = self.bending_over_clearance.filter(|bends| *bends > 0.0) {
            let _ = writeln!(
                text,
                "  under both caps the shaft bends by {:.1} % of the clearance between a retainer bearing and the line through both sensors",
                100.0 * bends
            );
        }
        let Role { name, reason } = &self.role;
        let _ = write!(text, "\nRole of the supervisor\n  {name}: {reason}\n");
        let lines = text
            .lines()
            .map(|line| wrapped(line, "    ", width()) + "\n");
        lines.collect()
    }
}
