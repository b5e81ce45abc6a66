//! A rotor in several planes, as data.

mod bearing;
mod change;
mod method;
mod validate;

pub use bearing::{BearingHeat, LoadDrag};
pub use change::Change;

use crate::V2;
use crate::params::{ContactParams, FrictionParams, RaceParams, SpinParams, StatorParams};

/// Most planes of a machine.
pub(crate) const MAX_PLANES: usize = 4;
/// Most magnets.
pub(crate) const MAX_MAGNETS: usize = 4;
/// Most motions in a direction: translation, tilt, bending modes and rings together.
pub(crate) const MAX_MOTIONS: usize = 64;

/// A rigid rotor with four lateral degrees of freedom. Positions along the axis count from its centre of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidRotor {
    /// Mass \[kg\], > 0.
    pub mass_kg: f64,
    /// Transverse moment of inertia I_t about the centre of mass \[kg m²\], > 0; infinite for a rotor that does not tilt.
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

impl BendingMode {
    /// Displacement at a place \[m\], straight between those of the shape and beyond them; 0 of a shape that has not two.
    pub fn displacement(&self, position_m: f64) -> f64 {
        shape_at(&self.shape, position_m)
    }
}

/// The same of a shape alone.
pub(crate) fn shape_at(shape: &[(f64, f64)], position_m: f64) -> f64 {
    let after = shape
        .partition_point(|(z, _)| *z <= position_m)
        .clamp(1, shape.len().max(2) - 1);
    match shape.get(after - 1..=after) {
        Some(&[(za, a), (zb, b)]) => a + (b - a) * (position_m - za) / (zb - za),
        _ => 0.0,
    }
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
        /// Damping beside that of the modes' ratios, over (translation, tilt, mode 1, mode 2 …), row by row, symmetric and such
        /// that no motion gains by it \[N s/m; of the tilt N m s/rad\]. Empty for none.
        damping_n_s_m: Vec<f64>,
    },
}

/// A spring with a damper from the rotor to ground, along x and y. A magnet's negative stiffness is one, and a seal:
///
/// ```text
/// f_x = −k_xx·x − k_xy·y − d_xx·ẋ − d_xy·ẏ
/// f_y = −k_yx·x − k_yy·y − d_yx·ẋ − d_yy·ẏ
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Support {
    /// Where \[m\].
    pub position_m: f64,
    /// Stiffness \[N/m\], either sign.
    pub stiffness_n_m: V2,
    /// Damping \[N s/m\], ≥ 0.
    pub damping_n_s_m: V2,
    /// k_xy and k_yx \[N/m\], either sign. What turns with the spin drives forward whirl: k_xy > 0 and k_yx < 0 at Ω > 0.
    pub cross_stiffness_n_m: V2,
    /// d_xy and d_yx \[N s/m\], such that no motion gains by damping.
    pub cross_damping_n_s_m: V2,
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

/// A magnet as it is: on each axis two poles that face each other, and a drive that sets their currents.
///
/// ```text
/// (6.7)  f = k·( (i_0 + i)²/(s_0 − x)² − (i_0 − i)²/(s_0 + x)² )
/// (6.8)  L·di/dt = u − R·i − k_i·ẋ        u = (L/τ)·(i_c − i) + R·i_c, at most U
/// ```
///
/// k is such that the largest current gives the magnet's cap in the middle, k_i = 4·k·i_0/s_0², and τ is the magnet's lag. A command
/// asks for the current i_c = F/k_i, at most the largest. Without an inductance the voltage has no limit, and i follows i_c with τ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Poles {
    /// Bias current i_0 \[A\], > 0.
    pub bias_current_a: f64,
    /// Largest control current \[A\], > 0 and at most i_0.
    pub current_max_a: f64,
    /// Air gap s_0 with the rotor in the middle \[m\], larger than the clearance that leaves it there.
    pub air_gap_m: f64,
    /// What drives the current.
    pub coil: Option<Coil>,
}

/// The electric side of a pair of poles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coil {
    /// L \[H\], > 0.
    pub inductance_h: f64,
    /// R \[Ω\], ≥ 0.
    pub resistance_ohm: f64,
    /// Largest voltage U \[V\], > 0.
    pub voltage_max_v: f64,
}

/// A radial magnet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineMagnet {
    /// Where \[m\].
    pub position_m: f64,
    /// Largest force, as the length of the vector \[N\], > 0.
    pub force_max_n: f64,
    /// Time constant of the amplifier's lag \[s\], ≥ 0; 0 means none, which poles do not take.
    pub lag_s: f64,
    /// Damping ratio ζ > 0 of an amplifier of second order, τ²·f̈ + 2ζτ·ḟ + f = command with τ the lag; without it the amplifier
    /// is of first order. Not with poles.
    pub lag_damping_ratio: Option<f64>,
    /// Poles; without them the force is what is commanded, within cap and lag, wherever the rotor is.
    pub poles: Option<Poles>,
}

impl MachineMagnet {
    /// Stiffness with which poles push the rotor out of the middle, −4·k·i_0²/s_0³ \[N/m\]; 0 without.
    pub fn stiffness_n_m(&self) -> f64 {
        self.poles.map_or(0.0, |poles| {
            let per_current = poles.bias_current_a / poles.current_max_a;
            -self.force_max_n * per_current / poles.air_gap_m
        })
    }
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
    /// Clearance and law.
    pub contact: ContactParams,
    /// Friction.
    pub friction: FrictionParams,
    /// What the bore is mounted on, or that it is out of round.
    pub stator: StatorParams,
    /// Race of a ball bearing; none for a bushing.
    pub race: Option<RaceParams>,
    /// Drag of the race that grows with the load; needs a race.
    pub load_drag: Option<LoadDrag>,
    /// What the bearing's losses do to it; none: nothing.
    pub heat: Option<BearingHeat>,
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
    /// Eccentricity of the centre of mass, at the angle of the spin \[m\]; one more unbalance.
    pub eccentricity_m: f64,
    /// Magnets, at most `MAX_MAGNETS`.
    pub magnets: Vec<MachineMagnet>,
    /// Where forces from outside act \[m\].
    pub loads_m: Vec<f64>,
    /// Where the motion is read: sensors \[m\].
    pub probes_m: Vec<f64>,
    /// Acceleration that acts on every mass of the rotor \[m/s²\].
    pub gravity_m_s2: V2,
    /// Planes of contact, at most `MAX_PLANES`.
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

impl RigidRotor {
    /// A point mass: a rotor that does not tilt.
    pub fn point(mass_kg: f64) -> Self {
        Self {
            mass_kg,
            transverse_inertia_kg_m2: f64::INFINITY,
            polar_inertia_kg_m2: 0.0,
        }
    }

    /// Whether it tilts.
    pub fn tilts(&self) -> bool {
        self.transverse_inertia_kg_m2.is_finite()
    }
}

impl MachineParams {
    /// The same with magnets that are linear about the middle: poles become the negative stiffness that they have there.
    pub fn linear_magnets(&self) -> Self {
        let mut linear = self.clone();
        for magnet in &mut linear.magnets {
            let stiffness_n_m = magnet.stiffness_n_m();
            if stiffness_n_m != 0.0 {
                linear.supports.push(Support {
                    position_m: magnet.position_m,
                    stiffness_n_m: V2::repeat(stiffness_n_m),
                    ..Support::default()
                });
            }
            magnet.poles = None;
        }
        linear
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

    /// Polar inertia on the slopes of motions i and j: the tilt is the first, the bending modes follow.
    pub(crate) fn polar_kg_m2(&self, i: usize, j: usize) -> f64 {
        match self {
            _ if (i, j) == (0, 0) => self.rigid().polar_inertia_kg_m2,
            Self::Modal {
                bending,
                polar_coupling_kg_m2: coupling,
                ..
            } => (coupling.get(i * (1 + bending.len()) + j)).map_or(0.0, |polar| *polar),
            Self::Rigid(_) => 0.0,
        }
    }

    /// Damping beside that of the modes' ratios, over (translation, tilt, bending modes), row by row; empty for none.
    pub(crate) fn damping_n_s_m(&self) -> &[f64] {
        match self {
            Self::Rigid(_) => &[],
            Self::Modal { damping_n_s_m, .. } => damping_n_s_m,
        }
    }
}
