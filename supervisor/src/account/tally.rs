//! What a report is made of, per unit: what has happened so far, and in which units. Copied where a report is not wanted yet: it
//! costs some conversions, which are left to whoever reads it.

use crate::act::limit::derated;
use crate::border::coeffs::Coeffs;
use crate::border::finding::Checked;
use crate::border::signal::{Mode, RejectReason, Report};
use crate::number::scalar::Scalar;
use crate::number::words::words_of_fields;

/// Largest severity index that is reported.
pub(crate) const MOST_INDEX: f32 = 1e9;

/// What has happened since the supervisor was made; fields as those of [`Report`].
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tally<S> {
    pub(crate) mode: Mode,
    pub(crate) landings: u32,
    pub(crate) nuisances: u32,
    pub(crate) handed_back: u16,
    pub(crate) impacts: u32,
    pub(crate) contact_ticks: u32,
    pub(crate) missed_ticks: u32,
    pub(crate) repeated_ticks: u32,
    pub(crate) late_ticks: u32,
    pub(crate) refusal: RejectReason,
    pub(crate) fault: RejectReason,
    pub(crate) coast_down: bool,
    /// Fastest speeds.
    pub(crate) impact: S,
    pub(crate) backward: S,
    /// Severity index over its limit.
    pub(crate) index: S,
    /// Thermal state.
    pub(crate) thermal: S,
}

words_of_fields!(Tally<S> {
    mode,
    landings,
    nuisances,
    handed_back,
    impacts,
    contact_ticks,
    missed_ticks,
    repeated_ticks,
    late_ticks,
    refusal,
    fault,
    coast_down,
    impact,
    backward,
    index,
    thermal,
});

/// What turns a tally into a report.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Units<S> {
    speed: [f32; 2],
    force_n: f32,
    severity_limit: f32,
    per_whirl_limit: S,
    /// Continuous force, where there is a budget.
    continuous: S,
    budgeted: bool,
}

words_of_fields!(Units<S> {
    speed,
    force_n,
    severity_limit,
    per_whirl_limit,
    continuous,
    budgeted,
});

impl<S: Scalar> Units<S> {
    #[inline]
    pub(crate) fn of(coeffs: &Coeffs<S>) -> Self {
        let scaling = &coeffs.scaling;
        Self {
            speed: [scaling.length_m, scaling.time_s],
            force_n: scaling.force_n,
            severity_limit: coeffs.severity_limit,
            per_whirl_limit: coeffs.per_whirl_limit,
            continuous: coeffs.budget.continuous.unwrap_or_default(),
            budgeted: coeffs.budget.continuous.is_some(),
        }
    }
}

impl<S: Scalar> Tally<S> {
    /// In SI.
    pub(crate) fn report(&self, units: &Units<S>, checked: Checked) -> Report {
        let [length_m, time_s] = units.speed;
        let speed_m_s = length_m / time_s;
        let (mut thermal_state, mut cap) = (0.0, S::ONE);
        if units.budgeted {
            let square = units.continuous * units.continuous;
            thermal_state = self.thermal.to_f32() / square.to_f32();
            cap = derated(self.thermal, units.continuous);
        }
        let index = self.index.to_f32() * units.severity_limit;
        Report {
            landings: self.landings,
            nuisance_engagements: self.nuisances,
            handed_back: u32::from(self.handed_back),
            impacts: self.impacts,
            contact_ticks: self.contact_ticks,
            impact_speed_max_m_s: self.impact.to_f32() * speed_m_s,
            backward_speed_max_m_s: self.backward.to_f32() * speed_m_s,
            whirl_limit_m_s: speed_m_s / units.per_whirl_limit.to_f32(),
            severity_index: Scalar::min(index, MOST_INDEX),
            coast_down: self.coast_down,
            thermal_state,
            force_cap_n: cap.to_f32() * units.force_n,
            missed_ticks: self.missed_ticks,
            repeated_ticks: self.repeated_ticks,
            late_ticks: self.late_ticks,
            refusal: self.refusal,
            fault: self.fault,
            checked,
        }
    }
}
