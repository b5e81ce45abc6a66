//! The paper's two rotors as plant parameters, and where each constant comes from.

use super::data::*;
use plant_model::V2;
use plant_model::analysis::impact::ImpactError;
use plant_model::contact::damping_for_restitution;
use plant_model::params::{
    ContactParams, FrictionParams, LinearContact, RingParams, RotorParams, SlidingFriction,
    SpinParams, StatorParams,
};

/// What the paper leaves out of footnote 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// k_c \[N/m\].
    pub contact_stiffness_n_m: f64,
    /// d_c \[N s/m\].
    pub contact_damping_n_s_m: f64,
    /// J_r \[kg m²\].
    pub inertia_kg_m2: f64,
}

/// The set that is used unless another is named.
pub const USED: LeftOut = LeftOut {
    contact_stiffness_n_m: 1e9,
    contact_damping_n_s_m: 1.6e4,
    inertia_kg_m2: 0.05,
};

/// The rotor of footnote 4 in its two-mass stator.
///
/// | constant | value | source |
/// |---|---|---|
/// | m_r, k_r, d_r | 10 kg, 9.1e5 N/m, 20.5 N s/m | footnote 4 |
/// | m_s, k_s, d_s | 10 kg, 8.9e8 N/m, 28 300 N s/m | footnote 4 |
/// | m_z, k_z, d_z | 10 kg, 3.6e9 N/m, 18 970 N s/m | footnote 4 |
/// | c, μ, μ_r, ε_r | 0.2 mm, 0.15, 0.025, 0 | footnote 4 |
/// | R_r | 0.1 m | disc diameter 200 mm, test rig |
/// | k_c, d_c | 1e9 N/m, 1.6e4 N s/m | assumed |
/// | J_r | 0.05 kg m² | assumed: a solid disc of m_r and R_r |
/// | t_d | 0 | coupling released before the test, test rig |
pub fn footnote_4() -> PlantParams {
    footnote_4_with(&USED)
}

/// A ring that is the same along x and y.
pub(super) fn ring(mass_kg: f64, stiffness_n_m: f64, damping_n_s_m: f64) -> RingParams {
    RingParams {
        mass_kg,
        stiffness_n_m: V2::repeat(stiffness_n_m),
        damping_n_s_m: V2::repeat(damping_n_s_m),
    }
}

/// A linear contact.
fn contact(clearance_m: f64, stiffness_n_m: f64, damping_n_s_m: f64) -> ContactParams {
    let law = LinearContact {
        stiffness_n_m,
        damping_n_s_m,
    };
    ContactParams {
        clearance_m,
        law: law.into(),
    }
}

/// [`footnote_4`] with another contact stiffness \[N/m\], of the same damping ratio.
pub(super) fn footnote_4_at(contact_stiffness_n_m: f64) -> PlantParams {
    let share = contact_stiffness_n_m / USED.contact_stiffness_n_m;
    footnote_4_with(&LeftOut {
        contact_stiffness_n_m,
        contact_damping_n_s_m: USED.contact_damping_n_s_m * share.sqrt(),
        ..USED
    })
}

/// [`footnote_4`] with another choice of what the paper leaves out.
pub(crate) fn footnote_4_with(left_out: &LeftOut) -> PlantParams {
    PlantParams {
        rotor: RotorParams {
            mass_kg: 10.0,
            stiffness_n_m: 9.1e5,
            damping_n_s_m: 20.5,
            eccentricity_m: 0.0,
            contact_radius_m: 0.1,
        },
        spin: SpinParams::Free {
            inertia_kg_m2: left_out.inertia_kg_m2,
            drive_torque_n_m: 0.0,
        },
        stator: StatorParams::TwoMass {
            inner: ring(10.0, 8.9e8, 28_300.0),
            outer: ring(10.0, 3.6e9, 18_970.0),
        },
        contact: contact(
            2e-4,
            left_out.contact_stiffness_n_m,
            left_out.contact_damping_n_s_m,
        ),
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: 0.15 },
            rolling_coefficient: 0.025,
        },
        magnet: None,
        race: None,
    }
}

/// The onset rig: a balanced disc on its shaft in a rigid, concentric stator, spin held.
///
/// | constant | value | source |
/// |---|---|---|
/// | eigenfrequency | 45 Hz | test rig |
/// | damping ratio | 0.003 | test rig; 0.035 with the damping appliance |
/// | c | 0.2 mm | test rig |
/// | μ | 0.125 | footnote 4: μ − μ_r = 0.15 − 0.025, what drives backward whirl |
/// | m | 10 kg | footnote 4 (test rig: about 12 kg in all) |
/// | stator | rigid | modelling of the onset phase |
/// | R_r | 0.1 m | disc diameter 200 mm, test rig |
/// | spin | held at 40 Hz | assumed; without influence as long as the contact slides |
/// | e | – | fitted on the first configuration of Fig. 3 |
/// | k_c | 1e8 N/m | assumed |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnsetRig {
    /// Coefficient of friction that drives the whirl.
    pub friction: f64,
    /// Damping ratio of the shaft.
    pub damping_ratio: f64,
    /// Eigenfrequency of the shaft \[Hz\].
    pub natural_hz: f64,
    /// Restitution e.
    pub restitution: f64,
    /// Radial clearance \[m\].
    pub clearance_m: f64,
    /// Contact stiffness k_c \[N/m\].
    pub contact_stiffness_n_m: f64,
    /// Unbalance ε_r \[m\].
    pub eccentricity_m: f64,
}

impl OnsetRig {
    /// Spin \[rad/s\].
    pub(crate) const SPIN_RAD_S: f64 = 40.0 * TAU;

    /// The solid disc without the damping appliance.
    pub fn solid_disc(restitution: f64) -> Self {
        Self {
            friction: 0.125,
            damping_ratio: 0.003,
            natural_hz: 45.0,
            restitution,
            clearance_m: 2e-4,
            contact_stiffness_n_m: 1e8,
            eccentricity_m: 0.0,
        }
    }

    /// As plant parameters.
    ///
    /// # Errors
    /// A restitution outside (0, 1].
    pub fn params(&self) -> Result<PlantParams> {
        let (mass_kg, k_c) = (10.0, self.contact_stiffness_n_m);
        let natural_rad_s = TAU * self.natural_hz;
        let damping_n_s_m = damping_for_restitution(self.restitution, k_c, mass_kg)
            .or_missing(format!("no restitution: {}", self.restitution))?;
        let mut params = footnote_4();
        params.rotor.mass_kg = mass_kg;
        params.rotor.stiffness_n_m = mass_kg * natural_rad_s * natural_rad_s;
        params.rotor.damping_n_s_m = 2.0 * self.damping_ratio * mass_kg * natural_rad_s;
        params.rotor.eccentricity_m = self.eccentricity_m;
        params.spin = SpinParams::Held;
        params.stator = StatorParams::Rigid;
        params.contact = contact(self.clearance_m, k_c, damping_n_s_m);
        params.friction.sliding = SlidingFriction::Constant {
            coefficient: self.friction,
        };
        params.friction.rolling_coefficient = 0.0;
        Ok(params)
    }

    /// With a change.
    pub(super) fn with(mut self, change: impl Fn(&mut Self)) -> Self {
        change(&mut self);
        self
    }
}

impl From<ImpactError> for PaperError {
    fn from(e: ImpactError) -> Self {
        match e {
            ImpactError::Plant(e) => Self::Plant(e),
            other => Self::Missing(other.to_string()),
        }
    }
}
