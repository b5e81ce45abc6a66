//! How far the critical speeds of the levitated rotor are from the spin, as API 617 asks.

use super::{LinearLoop, NoLoop};
use crate::scene::Scene;
use plant_model::machine::linear::{Direction, MachineMode};
use serde::Serialize;
use std::f64::consts::FRAC_1_SQRT_2;

/// A critical speed of the levitated rotor: a spin at which a mode that an unbalance excites turns as fast as the rotor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SpeedMargin {
    /// \[rad/s\].
    pub spin_rad_s: f64,
    /// `forward` or `planar`.
    pub whirl: &'static str,
    /// Amplification factor, 1/(2·damping ratio).
    pub amplification: f64,
    /// Distance from the spin of the scene, as a share of that.
    pub separation: f64,
    /// What API 617 asks for; 0 below an amplification of 2.5.
    pub separation_asked: f64,
}

/// Halvings of the stretch in which a critical speed lies.
const HALVINGS: u32 = 30;

/// 17·(1 − 1/(AF − 1.5)) per cent below the spin, ten more above it.
fn asked(amplification: f64, above: bool) -> f64 {
    if amplification < 2.5 {
        return 0.0;
    }
    let share = 0.17 * (1.0 - 1.0 / (amplification - 1.5));
    if above { share + 0.1 } else { share }
}

/// Whether an unbalance excites a mode so that its response has a peak.
fn excited(mode: &&MachineMode) -> bool {
    mode.direction != Direction::Backward && mode.damping_ratio < FRAC_1_SQRT_2
}

/// Critical speeds between spins, slowest first; `modes` are those at each of them.
///
/// # Errors
/// [`NoLoop`].
pub(crate) fn speed_margins(
    scene: &Scene,
    spins_rad_s: &[f64],
    modes: &[Vec<MachineMode>],
) -> Result<Vec<SpeedMargin>, NoLoop> {
    let slower = |modes: &[MachineMode], spin: f64| {
        let excited = modes.iter().filter(excited);
        excited.filter(|mode| mode.frequency_rad_s < spin).count()
    };
    let counts: Vec<usize> = (spins_rad_s.iter().zip(modes))
        .map(|(spin, modes)| slower(modes, *spin))
        .collect();
    let spin_rad_s = scene.start.spin_rad_s.abs();
    let mut margins = Vec::new();
    for (i, pair) in counts.windows(2).enumerate() {
        for count in pair[0]..pair[1] {
            let (mut low, mut high) = (spins_rad_s[i], spins_rad_s[i + 1]);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                let modes = LinearLoop::new(scene, middle)?.modes()?;
                match slower(&modes, middle) > count {
                    true => high = middle,
                    false => low = middle,
                }
            }
            let modes = LinearLoop::new(scene, high)?.modes()?;
            let off = |mode: &&MachineMode| (mode.frequency_rad_s - high).abs();
            let met = (modes.iter().filter(excited)).min_by(|a, b| off(a).total_cmp(&off(b)));
            margins.extend(met.map(|mode| {
                let amplification = 0.5 / mode.damping_ratio.max(1e-9);
                SpeedMargin {
                    spin_rad_s: high,
                    whirl: mode.direction.name(),
                    amplification,
                    separation: (high - spin_rad_s).abs() / spin_rad_s,
                    separation_asked: asked(amplification, high > spin_rad_s),
                }
            }));
        }
    }
    margins.sort_by(|a, b| a.spin_rad_s.total_cmp(&b.spin_rad_s));
    Ok(margins)
}
