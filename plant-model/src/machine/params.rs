//! A rotor in several planes, as data.

use crate::V2;
use crate::params::{
    ContactLaw, ContactParams, FrictionParams, RaceParams, SlidingFriction, SpinParams,
    StatorParams,
};

/// A value that is out of range, or that contradicts another.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} = {value}: expected {expected}")]
pub struct MachineError {
    /// Which one, with the index of its list: `planes[1].contact.clearance_m`.
    pub field: String,
    /// The value that was refused.
    pub value: f64,
    /// The range or the rule that was expected.
    pub expected: &'static str,
}

/// Most planes of a machine.
pub const MAX_PLANES: usize = 4;

/// A rigid rotor with four lateral degrees of freedom. Positions along the axis count from its centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidRotor {
    /// Mass \[kg\], > 0.
    pub mass_kg: f64,
    /// Transverse moment of inertia I_t about the centre of mass \[kg m²\], > 0.
    pub transverse_inertia_kg_m2: f64,
    /// Polar moment of inertia I_p \[kg m²\], ≥ 0 and at most 2·I_t.
    pub polar_inertia_kg_m2: f64,
}

/// A bending mode of the free rotor, its shape given by displacement at places along the axis; straight in between.
#[derive(Debug, Clone, PartialEq)]
pub struct BendingMode {
    /// Natural frequency at standstill \[rad/s\], > 0.
    pub frequency_rad_s: f64,
    /// Damping ratio, ≥ 0.
    pub damping_ratio: f64,
    /// (place \[m\], displacement), places rising. Displacements are those of a modal mass that is the rotor's mass: 1 moves
    /// as easily as the rigid rotor does.
    pub shape: Vec<(f64, f64)>,
}

/// What turns and bends.
#[derive(Debug, Clone, PartialEq)]
pub enum Rotor {
    /// Rigid.
    Rigid(RigidRotor),
    /// Rigid modes and bending modes.
    Modal {
        /// The rigid modes.
        rigid: RigidRotor,
        /// Bending modes.
        bending: Vec<BendingMode>,
        /// Polar inertia coupling of the bending modes' slopes \[kg m²\], row by row, symmetric: ∫ I_p′·φ_i′·φ_j′ dz over
        /// (tilt, mode 1, mode 2 …), the tilt's own entry left out as I_p. Empty for none.
        polar_coupling_kg_m2: Vec<f64>,
    },
}

/// A spring with a damper from the rotor to ground, the same in every direction. A magnet's negative stiffness is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Where \[m\].
    pub position_m: f64,
    /// Stiffness \[N/m\], either sign.
    pub stiffness_n_m: f64,
    /// Damping \[N s/m\], ≥ 0.
    pub damping_n_s_m: f64,
}

/// An unbalance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalance {
    /// Where \[m\].
    pub position_m: f64,
    /// Mass times eccentricity \[kg m\], ≥ 0.
    pub moment_kg_m: f64,
    /// Its angle on the rotor, from that of the spin \[rad\].
    pub angle_rad: f64,
}

/// A radial magnet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineMagnet {
    /// Where \[m\].
    pub position_m: f64,
    /// Largest force, as the length of the vector \[N\], > 0.
    pub force_max_n: f64,
    /// Time constant of the amplifier's lag \[s\], ≥ 0; 0 means none.
    pub lag_s: f64,
}

/// A plane in which the rotor may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachinePlane {
    /// Where along the axis \[m\].
    pub position_m: f64,
    /// Centre of its bore \[m\]; two bearings need not be in line.
    pub centre_m: V2,
    /// Radius R_r of the rotor there \[m\], > 0.
    pub radius_m: f64,
    /// Clearance and law; the linear law only.
    pub contact: ContactParams,
    /// Friction; sliding friction that does not depend on speed.
    pub friction: FrictionParams,
    /// What the bore is mounted on; round only.
    pub stator: StatorParams,
    /// Race of a ball bearing; none for a bushing.
    pub race: Option<RaceParams>,
}

/// Everything that does not change during a run.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineParams {
    /// The rotor.
    pub rotor: Rotor,
    /// Springs and dampers to ground.
    pub supports: Vec<Support>,
    /// How it spins. The inertia of a free spin is that of everything that turns: at least the rotor's own I_p.
    pub spin: SpinParams,
    /// Unbalances.
    pub unbalances: Vec<Unbalance>,
    /// Magnets.
    pub magnets: Vec<MachineMagnet>,
    /// Where forces from outside act \[m\].
    pub loads_m: Vec<f64>,
    /// Where the motion is read: sensors \[m\].
    pub probes_m: Vec<f64>,
    /// Acceleration that acts on every mass of the rotor \[m/s²\].
    pub gravity_m_s2: V2,
    /// Planes of contact, at most [`MAX_PLANES`].
    pub planes: Vec<MachinePlane>,
}

/// Where a run starts; bending modes, stators and magnets start at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MachineStart {
    /// Position of the centre of mass \[m\].
    pub centre_m: V2,
    /// Velocity of the centre of mass \[m/s\].
    pub centre_velocity_m_s: V2,
    /// Slope of the axis, dx/dz and dy/dz \[rad\].
    pub tilt_rad: V2,
    /// Rate of the slope \[rad/s\].
    pub tilt_rate_rad_s: V2,
    /// Spin Ω \[rad/s\], counter-clockwise positive.
    pub spin_rad_s: f64,
    /// Angle σ of the spin at t = 0 \[rad\].
    pub spin_phase_rad: f64,
}

fn check(
    ok: bool,
    field: impl Into<String>,
    value: f64,
    expected: &'static str,
) -> Result<(), MachineError> {
    if ok && value.is_finite() {
        return Ok(());
    }
    Err(MachineError {
        field: field.into(),
        value,
        expected,
    })
}

const POSITIVE: &str = "a finite number greater than 0";
const NOT_NEGATIVE: &str = "a finite number, 0 or greater";
const FINITE: &str = "a finite number";

impl RigidRotor {
    fn validate(&self) -> Result<(), MachineError> {
        let (transverse, polar) = (self.transverse_inertia_kg_m2, self.polar_inertia_kg_m2);
        check(self.mass_kg > 0.0, "rotor.mass_kg", self.mass_kg, POSITIVE)?;
        check(
            transverse > 0.0,
            "rotor.transverse_inertia_kg_m2",
            transverse,
            POSITIVE,
        )?;
        let rule =
            "from 0 to twice transverse_inertia_kg_m2: no body has more, a thin disc has just that";
        check(
            (0.0..=2.0 * transverse).contains(&polar),
            "rotor.polar_inertia_kg_m2",
            polar,
            rule,
        )
    }
}

impl Rotor {
    /// Its rigid modes.
    pub fn rigid(&self) -> &RigidRotor {
        match self {
            Self::Rigid(rigid) | Self::Modal { rigid, .. } => rigid,
        }
    }

    /// Its bending modes.
    pub fn bending(&self) -> &[BendingMode] {
        match self {
            Self::Rigid(_) => &[],
            Self::Modal { bending, .. } => bending,
        }
    }

    fn validate(&self) -> Result<(), MachineError> {
        self.rigid().validate()?;
        for (i, mode) in self.bending().iter().enumerate() {
            let field = |name: &str| format!("rotor.bending[{i}].{name}");
            check(
                mode.frequency_rad_s > 0.0,
                field("frequency_rad_s"),
                mode.frequency_rad_s,
                POSITIVE,
            )?;
            check(
                mode.damping_ratio >= 0.0,
                field("damping_ratio"),
                mode.damping_ratio,
                NOT_NEGATIVE,
            )?;
            let places = mode.shape.len();
            check(
                places >= 2,
                field("shape"),
                places as f64,
                "at least two places",
            )?;
            for (j, (place, shape)) in mode.shape.iter().enumerate() {
                let rises = j == 0 || *place > mode.shape[j - 1].0;
                check(rises, field("shape"), *place, "finite places that rise")?;
                check(true, field("shape"), *shape, FINITE)?;
            }
        }
        if let Self::Modal {
            bending,
            polar_coupling_kg_m2,
            ..
        } = self
            && !polar_coupling_kg_m2.is_empty()
        {
            let size = bending.len() + 1;
            let (field, count) = ("rotor.polar_coupling_kg_m2", polar_coupling_kg_m2.len());
            check(
                count == size * size,
                field,
                count as f64,
                "(1 + bending modes)² numbers, or none",
            )?;
            for (i, value) in polar_coupling_kg_m2.iter().enumerate() {
                let mirrored = polar_coupling_kg_m2[(i % size) * size + i / size];
                check(
                    *value == mirrored,
                    field,
                    *value,
                    "a symmetric matrix of finite numbers",
                )?;
            }
        }
        Ok(())
    }

    /// Whether a place lies on the rotor, as far as its shapes say.
    fn reaches(&self, position_m: f64) -> bool {
        self.bending().iter().all(|mode| {
            let ends = (mode.shape.first(), mode.shape.last());
            matches!(ends, (Some(a), Some(b)) if (a.0..=b.0).contains(&position_m))
        })
    }
}

impl MachinePlane {
    fn validate(&self, i: usize) -> Result<(), MachineError> {
        let field = |name: &str| format!("planes[{i}].{name}");
        let finite = |name, value| check(true, field(name), value, FINITE);
        let positive = |name, value: f64| check(value > 0.0, field(name), value, POSITIVE);
        let not_negative = |name, value: f64| check(value >= 0.0, field(name), value, NOT_NEGATIVE);
        finite("centre_m", self.centre_m.x)?;
        finite("centre_m", self.centre_m.y)?;
        positive("radius_m", self.radius_m)?;
        positive("contact.clearance_m", self.contact.clearance_m)?;
        match self.contact.law {
            ContactLaw::Linear(law) => {
                positive("contact.stiffness_n_m", law.stiffness_n_m)?;
                not_negative("contact.damping_n_s_m", law.damping_n_s_m)?;
            }
            ContactLaw::HuntCrossley(law) => {
                let only = "a linear contact law: no other has a power series at the touch";
                check(false, field("contact.law"), law.exponent, only)?;
            }
        }
        match self.friction.sliding {
            SlidingFriction::Constant { coefficient } => {
                not_negative("friction.coefficient", coefficient)?;
            }
            SlidingFriction::Falling { at_speed, .. } => {
                let only = "sliding friction that is the same at every speed";
                check(
                    false,
                    field("friction.coefficient_at_speed"),
                    at_speed,
                    only,
                )?;
            }
        }
        not_negative(
            "friction.rolling_coefficient",
            self.friction.rolling_coefficient,
        )?;
        match &self.stator {
            StatorParams::Rigid => {}
            StatorParams::RigidEllipse(bore) => {
                check(
                    false,
                    field("stator.ellipticity"),
                    bore.ellipticity,
                    "a round bore",
                )?;
            }
            StatorParams::OneMass(ring) => ring.validate_as(&field, "stator.inner")?,
            StatorParams::TwoMass { inner, outer } => {
                inner.validate_as(&field, "stator.inner")?;
                outer.validate_as(&field, "stator.outer")?;
            }
        }
        let Some(race) = &self.race else {
            return Ok(());
        };
        positive("race.inertia_kg_m2", race.inertia_kg_m2)?;
        not_negative("race.drag_n_m_s", race.drag_n_m_s)?;
        finite("race.start_spin_rad_s", race.start_spin_rad_s)
    }
}

impl crate::params::RingParams {
    fn validate_as(&self, field: &impl Fn(&str) -> String, ring: &str) -> Result<(), MachineError> {
        let name = |key: &str| field(&format!("{ring}.{key}"));
        check(self.mass_kg > 0.0, name("mass_kg"), self.mass_kg, POSITIVE)?;
        for axis in [0, 1] {
            let (k, d) = (self.stiffness_n_m[axis], self.damping_n_s_m[axis]);
            check(k >= 0.0, name("stiffness_n_m"), k, NOT_NEGATIVE)?;
            check(d >= 0.0, name("damping_n_s_m"), d, NOT_NEGATIVE)?;
        }
        Ok(())
    }
}

impl MachineParams {
    /// Checks every value against its range, and against the others.
    ///
    /// # Errors
    /// The first that is out of range, by name.
    pub fn validate(&self) -> Result<(), MachineError> {
        self.rotor.validate()?;
        let polar = self.rotor.rigid().polar_inertia_kg_m2;
        if let SpinParams::Free {
            inertia_kg_m2,
            drive_torque_n_m,
        } = self.spin
        {
            let rule = "more than 0 and at least the rotor's polar inertia, which turns with it";
            check(
                inertia_kg_m2 > 0.0 && inertia_kg_m2 >= polar,
                "spin.inertia_kg_m2",
                inertia_kg_m2,
                rule,
            )?;
            check(true, "spin.drive_torque_n_m", drive_torque_n_m, FINITE)?;
        }
        let place = |list: &str, i: usize, position_m: f64| {
            let rule = "a place on the rotor: within the shape of every bending mode";
            check(
                self.rotor.reaches(position_m),
                format!("{list}[{i}].position_m"),
                position_m,
                rule,
            )
        };
        for (i, support) in self.supports.iter().enumerate() {
            place("supports", i, support.position_m)?;
            check(
                true,
                format!("supports[{i}].stiffness_n_m"),
                support.stiffness_n_m,
                FINITE,
            )?;
            let d = support.damping_n_s_m;
            check(
                d >= 0.0,
                format!("supports[{i}].damping_n_s_m"),
                d,
                NOT_NEGATIVE,
            )?;
        }
        for (i, unbalance) in self.unbalances.iter().enumerate() {
            place("unbalances", i, unbalance.position_m)?;
            let u = unbalance.moment_kg_m;
            check(
                u >= 0.0,
                format!("unbalances[{i}].moment_kg_m"),
                u,
                NOT_NEGATIVE,
            )?;
            check(
                true,
                format!("unbalances[{i}].angle_rad"),
                unbalance.angle_rad,
                FINITE,
            )?;
        }
        for (i, magnet) in self.magnets.iter().enumerate() {
            place("magnets", i, magnet.position_m)?;
            let (cap, lag) = (magnet.force_max_n, magnet.lag_s);
            check(
                cap > 0.0,
                format!("magnets[{i}].force_max_n"),
                cap,
                POSITIVE,
            )?;
            check(lag >= 0.0, format!("magnets[{i}].lag_s"), lag, NOT_NEGATIVE)?;
        }
        for (list, places) in [("loads", &self.loads_m), ("probes", &self.probes_m)] {
            for (i, position_m) in places.iter().enumerate() {
                place(list, i, *position_m)?;
            }
        }
        for axis in [0, 1] {
            check(true, "gravity_m_s2", self.gravity_m_s2[axis], FINITE)?;
        }
        let planes = self.planes.len();
        check(
            (1..=MAX_PLANES).contains(&planes),
            "planes",
            planes as f64,
            "one to four planes",
        )?;
        for (i, plane) in self.planes.iter().enumerate() {
            place("planes", i, plane.position_m)?;
            plane.validate(i)?;
        }
        Ok(())
    }
}

impl MachineStart {
    /// Checks that every value is finite.
    ///
    /// # Errors
    /// The first that is not.
    pub fn validate(&self) -> Result<(), MachineError> {
        let vectors = [
            ("start.centre_m", self.centre_m),
            ("start.centre_velocity_m_s", self.centre_velocity_m_s),
            ("start.tilt_rad", self.tilt_rad),
            ("start.tilt_rate_rad_s", self.tilt_rate_rad_s),
        ];
        for (field, v) in vectors {
            check(true, field, v.x, FINITE)?;
            check(true, field, v.y, FINITE)?;
        }
        check(true, "start.spin_rad_s", self.spin_rad_s, FINITE)?;
        check(true, "start.spin_phase_rad", self.spin_phase_rad, FINITE)
    }
}
