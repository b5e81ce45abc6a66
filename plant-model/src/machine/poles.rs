//! Magnets as they are, eqs (6.7) and (6.8): poles that attract, currents that a drive sets.

use super::params::MachineMagnet;
use crate::V2;

/// How a magnet answers a command.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MagnetLaw {
    /// It delivers the command.
    Held,
    /// It follows the command with a rate; its state is the force.
    Lag(f64),
    /// It follows with a natural rate and a damping ratio; its state is the force and the force's rate.
    SecondOrder(f64, f64),
    /// Poles; its state is the control current.
    Poles(PoleLaw),
}

/// Poles without what moves between them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PoleLaw {
    /// k \[N m²/A²\].
    constant: f64,
    bias_a: f64,
    most_a: f64,
    gap_m: f64,
    /// k_i \[N/A\].
    per_ampere_n: f64,
    /// 1/τ.
    rate: f64,
    /// 1/L, R and U; none without a limit of voltage.
    coil: Option<(f64, f64, f64)>,
}

/// Gap below which a pole does not come, as a share of the air gap: long before, the rotor lies on its retainer bearing.
const NARROWEST: f64 = 0.02;

impl MagnetLaw {
    pub(crate) fn new(magnet: &MachineMagnet) -> Self {
        match &magnet.poles {
            None => match (magnet.lag_s > 0.0, magnet.lag_damping_ratio) {
                (true, Some(ratio)) => Self::SecondOrder(1.0 / magnet.lag_s, ratio),
                (true, None) => Self::Lag(1.0 / magnet.lag_s),
                (false, _) => Self::Held,
            },
            Some(poles) => {
                let (bias_a, gap_m) = (poles.bias_current_a, poles.air_gap_m);
                let per_ampere_n = magnet.force_max_n / poles.current_max_a;
                Self::Poles(PoleLaw {
                    constant: per_ampere_n * gap_m * gap_m / (4.0 * bias_a),
                    bias_a,
                    most_a: poles.current_max_a,
                    gap_m,
                    per_ampere_n,
                    rate: 1.0 / magnet.lag_s,
                    coil: (poles.coil)
                        .map(|c| (1.0 / c.inductance_h, c.resistance_ohm, c.voltage_max_v)),
                })
            }
        }
    }

    /// Rate of a lag.
    pub(crate) fn lag(&self) -> Option<f64> {
        match self {
            Self::Lag(rate) => Some(*rate),
            _ => None,
        }
    }

    /// Number of scalar states.
    pub(crate) fn states(&self) -> usize {
        match self {
            Self::Held => 0,
            Self::Lag(_) | Self::Poles(_) => 2,
            Self::SecondOrder(..) => 4,
        }
    }

    /// Whether its force is the command.
    pub(crate) fn is_held(&self) -> bool {
        matches!(self, Self::Held)
    }

    /// Time in which the rate of a force of second order moves the force \[s\]; 0 where there is none.
    pub(crate) fn per_slope_s(&self) -> f64 {
        match self {
            Self::SecondOrder(rate, _) => 1.0 / rate,
            _ => 0.0,
        }
    }

    /// Force by a newton of command, per unit of state.
    pub(crate) fn per_state_n(&self) -> f64 {
        match self {
            Self::Poles(poles) => poles.per_ampere_n,
            _ => 1.0,
        }
    }
}

impl PoleLaw {
    /// Force \[N\] for control currents \[A\] and the rotor's place \[m\].
    pub(crate) fn force_n(&self, current_a: V2, position_m: V2) -> V2 {
        current_a.zip_map(&position_m, |i, x| {
            let least = NARROWEST * self.gap_m;
            let pull = |current: f64, gap: f64| (current / gap.max(least)).powi(2);
            // Nothing pushes: a pole without current does nothing.
            let ahead = pull((self.bias_a + i).max(0.0), self.gap_m - x);
            let behind = pull((self.bias_a - i).max(0.0), self.gap_m + x);
            self.constant * (ahead - behind)
        })
    }

    /// Rate of the control currents \[A/s\], for a command \[N\] and the rotor's speed \[m/s\].
    pub(crate) fn current_rate(&self, current_a: V2, command_n: V2, velocity_m_s: V2) -> V2 {
        let wanted = (command_n / self.per_ampere_n).map(|i| i.clamp(-self.most_a, self.most_a));
        let Some((per_henry, ohm, most_v)) = self.coil else {
            return self.rate * (wanted - current_a);
        };
        let volts = (self.rate / per_henry * (wanted - current_a) + ohm * wanted)
            .map(|u| u.clamp(-most_v, most_v));
        per_henry * (volts - ohm * current_a - self.per_ampere_n * velocity_m_s)
    }
}
