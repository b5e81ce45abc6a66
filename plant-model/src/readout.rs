//! What can be read off a run.

use crate::V2;
use crate::mode::ContactMode;
use crate::vector::Body;

/// What can be read off at an instant, SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Snapshot {
    /// Time \[s\].
    pub t_s: f64,
    /// Rotor position \[m\].
    pub position_m: V2,
    /// Rotor velocity \[m/s\].
    pub velocity_m_s: V2,
    /// Ring that the rotor touches; at rest in the centre for a rigid stator.
    pub inner_ring: Body,
    /// Outer ring; at rest in the centre where there is none.
    pub outer_ring: Body,
    /// Spin Ω \[rad/s\].
    pub spin_rad_s: f64,
    /// Spin Ω_i of the race \[rad/s\]; 0 for a bushing.
    pub race_spin_rad_s: f64,
    /// What the rotor does.
    pub mode: ContactMode,
    /// A of eq. (2.8) \[m\]; negative inside the clearance.
    pub penetration_m: f64,
    /// f_n \[N\]; 0 without contact.
    pub normal_force_n: f64,
    /// Sliding friction on the rotor along t̂ \[N\].
    pub sliding_force_n: f64,
    /// Rolling friction on the rotor along t̂ \[N\].
    pub rolling_force_n: f64,
    /// Tangential speed of the rotor against the ring about its centre \[m/s\].
    pub contact_tangential_speed_m_s: f64,
    /// v_rel, speed of the rotor's surface on the ring's, along t̂ \[m/s\].
    pub sliding_speed_m_s: f64,
    /// Force that the magnet delivers \[N\].
    pub delivered_n: V2,
    /// Angle of the contact point, summed over all contact so far \[rad\]; differences are meaningful
    /// within one contact.
    pub whirl_angle_rad: f64,
}

/// Normal speed above which a touch counts as a hard one \[m/s\].
pub(crate) const HARD_IMPACT_M_S: f64 = 0.02;

/// Extremes and sums over a run, taken at every step and not only at samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Meters {
    /// Number of touches.
    pub impacts: u64,
    /// Touches with a normal speed above `HARD_IMPACT_M_S`.
    pub hard_impacts: u64,
    /// Time in contact \[s\].
    pub contact_time_s: f64,
    /// Largest normal speed at a touch \[m/s\].
    pub peak_impact_speed_m_s: f64,
    /// Largest A of eq. (2.8) \[m\].
    pub peak_penetration_m: f64,
    /// Largest f_n \[N\].
    pub peak_contact_force_n: f64,
    /// Largest sliding-friction torque on the spin \[N m\].
    pub peak_friction_torque_n_m: f64,
    /// Largest tangential speed in contact against the spin at the start (taken as positive where it
    /// is zero) \[m/s\].
    pub peak_backward_speed_m_s: f64,
    /// Angle of the contact point summed over all contact \[rad\].
    pub whirl_angle_rad: f64,
}

/// Largest values over one step of contact.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Peaks {
    pub(crate) normal_n: f64,
    pub(crate) penetration_m: f64,
    /// Without its sign.
    pub(crate) sliding_n: f64,
    /// v_w against the spin.
    pub(crate) backward_m_s: f64,
}

impl Meters {
    /// Largest values of the steps so far, on a rotor of this radius.
    pub(crate) fn peaks(&self, radius_m: f64) -> Peaks {
        Peaks {
            normal_n: self.peak_contact_force_n,
            penetration_m: self.peak_penetration_m,
            sliding_n: self.peak_friction_torque_n_m / radius_m,
            backward_m_s: self.peak_backward_speed_m_s,
        }
    }

    /// Takes a step of contact in: its largest values, its length, how far the contact point turned.
    pub(crate) fn contact_step(
        &mut self,
        peaks: &Peaks,
        step_s: f64,
        turn_rad: f64,
        radius_m: f64,
    ) {
        self.contact_time_s += step_s;
        self.whirl_angle_rad += turn_rad;
        self.peak_contact_force_n = self.peak_contact_force_n.max(peaks.normal_n);
        self.peak_penetration_m = self.peak_penetration_m.max(peaks.penetration_m);
        let torque = peaks.sliding_n * radius_m;
        self.peak_friction_torque_n_m = self.peak_friction_torque_n_m.max(torque);
        self.peak_backward_speed_m_s = self.peak_backward_speed_m_s.max(peaks.backward_m_s);
    }
}

/// How much work integration did, flight between samples by one matrix apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Steps.
    pub steps: u64,
    /// Evaluations of the equations. A series counts as many as it has coefficients.
    pub evaluations: u64,
    /// Factorisations of collocation's matrices.
    pub factorisations: u64,
    /// Events found.
    pub events: u64,
}
