//! What a plant is made of: plain SI data, checked once by [`PlantParams::validate`].

use crate::V2;

/// A value that is out of range, or that contradicts another.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value}: expected {expected}")]
pub struct ParamError {
    /// Which one: of a point mass as a scene file has it, `contact.clearance_m`; of a machine with the index of its list,
    /// `planes[1].contact.clearance_m`.
    pub field: String,
    /// The value that was refused.
    pub value: f64,
    /// The range or the rule that was expected.
    pub expected: &'static str,
}

/// Jeffcott rotor, eqs (2.1), (2.2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorParams {
    /// Mass m_r \[kg\], > 0.
    pub mass_kg: f64,
    /// Shaft stiffness k_r plus any negative stiffness of a magnet \[N/m\], either sign.
    pub stiffness_n_m: f64,
    /// Viscous damping d_r \[N s/m\], ≥ 0.
    pub damping_n_s_m: f64,
    /// Unbalance: eccentricity ε_r of the mass centre \[m\], ≥ 0.
    pub eccentricity_m: f64,
    /// Radius R_r at the contact \[m\], > 0.
    pub contact_radius_m: f64,
}

/// How the rotor spins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpinParams {
    /// A drive holds the speed whatever the friction; no state.
    Held,
    /// Eq. (2.7): friction and the drive torque change the speed; one state (two with unbalance).
    Free {
        /// Polar moment of inertia J_r \[kg m²\], > 0.
        inertia_kg_m2: f64,
        /// Drive torque t_d \[N m\], positive drives the spin up.
        drive_torque_n_m: f64,
    },
}

/// One ring of the stator with its mounting, per axis (x, y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingParams {
    /// Mass \[kg\], > 0.
    pub mass_kg: f64,
    /// Stiffness of the mounting along x and y \[N/m\], ≥ 0.
    pub stiffness_n_m: V2,
    /// Damping of the mounting along x and y \[N s/m\], ≥ 0.
    pub damping_n_s_m: V2,
}

/// A bore out of round: the centre of the rotor may go as far as an ellipse about the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipseParams {
    /// ε from 0 to 0.2: the semi-axes are c·(1 + ε) and c·(1 − ε), c the clearance.
    pub ellipticity: f64,
    /// Direction of the longer axis \[rad\].
    pub long_axis_rad: f64,
}

/// How far the stator is modelled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatorParams {
    /// The stator does not move; no state.
    Rigid,
    /// The same with a bore that is out of round.
    RigidEllipse(EllipseParams),
    /// One ring on a mounting to ground; four states.
    OneMass(RingParams),
    /// The paper's two nested rings, eqs (2.3)–(2.6); eight states.
    TwoMass {
        /// Ring that the rotor touches (m_s, k_s, d_s), mounted in the outer ring.
        inner: RingParams,
        /// Outer ring (m_z, k_z, d_z), mounted to ground.
        outer: RingParams,
    },
}

/// The contact: how far apart, and what force a penetration A and its rate B give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactParams {
    /// Radial clearance c \[m\], > 0.
    pub clearance_m: f64,
    /// Normal force.
    pub law: ContactLaw,
}

/// Normal force over penetration A and its rate B. A wall does not pull: contact ends where it would.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactLaw {
    /// The paper's, eq. (2.8).
    Linear(LinearContact),
    /// Hertz's stiffness with a damper that grows with the depth.
    HuntCrossley(HuntCrossley),
}

/// Linear visco-elastic contact, f_n = k_c·A + d_c·B while positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearContact {
    /// Contact stiffness k_c \[N/m\], > 0.
    pub stiffness_n_m: f64,
    /// Contact damping d_c \[N s/m\], ≥ 0; see [`crate::contact::damping_for_restitution`].
    pub damping_n_s_m: f64,
}

/// Hunt and Crossley's contact, f_n = k_h·Aⁿ·(1 + λ·B) while A > 0 and 1 + λ·B > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HuntCrossley {
    /// k_h \[N/mⁿ\], > 0.
    pub stiffness_n_mn: f64,
    /// n, from 1 to 3; 3/2 for Hertz's contact of spheres.
    pub exponent: f64,
    /// λ \[s/m\], ≥ 0; see [`crate::contact::hunt_crossley::damping_for_restitution`].
    pub damping_s_m: f64,
}

impl From<LinearContact> for ContactLaw {
    fn from(law: LinearContact) -> Self {
        Self::Linear(law)
    }
}

impl From<HuntCrossley> for ContactLaw {
    fn from(law: HuntCrossley) -> Self {
        Self::HuntCrossley(law)
    }
}

/// Coefficient of sliding friction μ as a function of the sliding speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlidingFriction {
    /// The same at every speed.
    Constant {
        /// μ, ≥ 0.
        coefficient: f64,
    },
    /// μ(v) = μ_∞ + (μ_0 − μ_∞)·exp(−|v|/v_0).
    Falling {
        /// μ_0 at rest, ≥ μ_∞.
        at_rest: f64,
        /// μ_∞ at high sliding speed, ≥ 0.
        at_speed: f64,
        /// v_0 \[m/s\], > 0.
        speed_scale_m_s: f64,
    },
}

/// Friction between rotor and stator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionParams {
    /// Sliding friction, against the sliding speed at the contact.
    pub sliding: SlidingFriction,
    /// Coefficient of rolling friction μ_r, ≥ 0, against the whirl.
    pub rolling_coefficient: f64,
}

/// Magnet: what turns a commanded force into a delivered one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MagnetParams {
    /// Largest force, as the length of the vector \[N\], > 0.
    pub force_max_n: f64,
    /// Time constant of the amplifier's first-order lag \[s\], ≥ 0; 0 means no lag and no state.
    pub lag_s: f64,
}

/// Inner race of a retainer ball bearing: the ring's surface turns, by friction and against a drag.
/// Its bore is the contact radius and the clearance, R_i = R_r + c. Without a race the ring is a bushing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaceParams {
    /// Polar moment of inertia J_i, with the share of balls and cage \[kg m²\], > 0.
    pub inertia_kg_m2: f64,
    /// Viscous drag of the bearing per spin \[N m s\], ≥ 0.
    pub drag_n_m_s: f64,
    /// Spin Ω_i at the start \[rad/s\], counter-clockwise positive.
    pub start_spin_rad_s: f64,
}

/// Everything that does not change during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantParams {
    /// The rotor.
    pub rotor: RotorParams,
    /// How it spins.
    pub spin: SpinParams,
    /// The stator.
    pub stator: StatorParams,
    /// The contact between them.
    pub contact: ContactParams,
    /// Friction in the contact.
    pub friction: FrictionParams,
    /// The magnet, if there is one.
    pub magnet: Option<MagnetParams>,
    /// The race that the rotor touches; none for a bushing.
    pub race: Option<RaceParams>,
}

/// Where a run starts; the stator starts at rest in the centre, the magnet without force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Rotor position \[m\].
    pub position_m: V2,
    /// Rotor velocity \[m/s\].
    pub velocity_m_s: V2,
    /// Spin Ω \[rad/s\], counter-clockwise positive.
    pub spin_rad_s: f64,
    /// Angle σ of the unbalance at t = 0 \[rad\].
    pub spin_phase_rad: f64,
}

pub(crate) const POSITIVE: &str = "a finite number greater than 0";
pub(crate) const NOT_NEGATIVE: &str = "a finite number, 0 or greater";
pub(crate) const FINITE: &str = "a finite number";

pub(crate) fn check(
    ok: bool,
    field: impl Into<String>,
    value: f64,
    expected: &'static str,
) -> Result<(), ParamError> {
    if ok && value.is_finite() {
        return Ok(());
    }
    Err(ParamError {
        field: field.into(),
        value,
        expected,
    })
}

impl PlantParams {
    /// Whether its contact has a power series: a linear law in a round bore.
    pub fn has_series(&self) -> bool {
        let round = !matches!(self.stator, StatorParams::RigidEllipse(_));
        round && self.contact.law.linear().is_some()
    }

    /// Natural frequency of the shaft √(k/m) \[rad/s\]; `None` without a restoring stiffness.
    pub fn natural_frequency_rad_s(&self) -> Option<f64> {
        (self.rotor.stiffness_n_m > 0.0)
            .then(|| (self.rotor.stiffness_n_m / self.rotor.mass_kg).sqrt())
    }

    /// Radius R_i of the bore that the rotor touches \[m\].
    pub fn bore_radius_m(&self) -> f64 {
        self.rotor.contact_radius_m + self.contact.clearance_m
    }

    /// Reduced mass of the contact: rotor against the ring it touches \[kg\].
    pub fn contact_mass_kg(&self) -> f64 {
        let ring = match &self.stator {
            StatorParams::Rigid | StatorParams::RigidEllipse(_) => return self.rotor.mass_kg,
            StatorParams::OneMass(ring) => ring.mass_kg,
            StatorParams::TwoMass { inner, .. } => inner.mass_kg,
        };
        1.0 / (1.0 / self.rotor.mass_kg + 1.0 / ring)
    }
}

impl PlantParams {
    /// Angular frequency of the reduced mass on the undamped contact \[rad/s\]: √(k_c/m), or with a
    /// stiffness that grows with depth its value at a depth of one clearance.
    pub fn contact_rate_rad_s(&self) -> f64 {
        (self.contact.stiffness_n_m() / self.contact_mass_kg()).sqrt()
    }
}

impl Start {
    /// Checks that every value is finite.
    ///
    /// # Errors
    /// The first field that is not.
    pub fn validate(&self) -> Result<(), ParamError> {
        for axis in [0, 1] {
            check(true, "start.position_m", self.position_m[axis], FINITE)?;
            check(true, "start.velocity_m_s", self.velocity_m_s[axis], FINITE)?;
        }
        check(true, "start.spin_rad_s", self.spin_rad_s, FINITE)?;
        check(true, "start.spin_phase_rad", self.spin_phase_rad, FINITE)
    }
}
