//! A rotor of one point mass in one plane, as its users see it: built once from [`PlantParams`], carried from sample to sample.
//!
//! It is a [`Machine`] with one pair of coordinates; what stands here turns its data and its readings into those of one plane.

use crate::V2;
use crate::energy::Audit;
use crate::integrate::{Method, Options, PlantError};
use crate::machine::params::{
    Change, MachineMagnet, MachineParams, MachinePlane, MachineStart, RigidRotor, Rotor, Support,
};
use crate::machine::{Machine, MachineInputs, MachineSnapshot};
use crate::mode::ContactMode;
use crate::params::{ParamError, PlantParams, Start};
use crate::readout::{Meters, Snapshot, Work};

/// Why a plant could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// A parameter is out of range.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// The power series is asked for with a contact that has none.
    #[error(
        "run.method = series: Hunt and Crossley's contact and a bearing out of round have no power series; take auto or collocation"
    )]
    NoSeries,
}

/// What acts on the plant from outside, held until the next call.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// Commanded magnet force \[N\]; limited to the magnet's cap, ignored without a magnet.
    pub command_n: V2,
    /// External force on the rotor, weight included \[N\].
    pub external_n: V2,
}

/// A plant that is being run. Deterministic: the same calls give the same bits.
#[derive(Debug, Clone)]
pub struct Plant {
    machine: Machine,
    inputs: MachineInputs,
}

/// Builds the plant of `params`.
///
/// # Errors
/// [`BuildError::Param`] for the first value out of range, [`BuildError::NoSeries`].
pub fn build(params: &PlantParams, start: &Start, options: Options) -> Result<Plant, BuildError> {
    start.validate()?;
    options.validate()?;
    if options.method == Method::Series && !params.has_series() {
        return Err(BuildError::NoSeries);
    }
    let start = MachineStart {
        centre_m: start.position_m,
        centre_velocity_m_s: start.velocity_m_s,
        spin_rad_s: start.spin_rad_s,
        spin_phase_rad: start.spin_phase_rad,
        ..MachineStart::default()
    };
    let machine = Machine::new(&params.machine(), &start, options).map_err(of_a_point_mass)?;
    let magnets = usize::from(params.magnet.is_some());
    Ok(Plant {
        machine,
        inputs: MachineInputs {
            commands_n: vec![V2::zeros(); magnets],
            loads_n: vec![V2::zeros()],
        },
    })
}

/// A machine's value under the name that it has here.
fn of_a_point_mass(error: ParamError) -> ParamError {
    let mut field = error.field;
    for (of_a_machine, own) in [
        ("planes[0].radius_m", "rotor.contact_radius_m"),
        ("planes[0].stator.ellipticity", "retainer.ellipticity"),
        ("planes[0].stator.long_axis_rad", "retainer.long_axis_deg"),
        ("planes[0].", ""),
        ("supports[0].", "rotor."),
        ("magnets[0].", "magnet."),
    ] {
        if let Some(rest) = field.strip_prefix(of_a_machine) {
            field = format!("{own}{rest}");
        }
    }
    ParamError { field, ..error }
}

impl PlantParams {
    /// Checks every field against its range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.machine().validate().map_err(of_a_point_mass)
    }

    /// The same as a rotor that does not tilt, with everything in one plane.
    pub fn machine(&self) -> MachineParams {
        let rotor = &self.rotor;
        MachineParams {
            rotor: Rotor::Rigid(RigidRotor::point(rotor.mass_kg)),
            supports: vec![Support {
                stiffness_n_m: V2::repeat(rotor.stiffness_n_m),
                damping_n_s_m: V2::repeat(rotor.damping_n_s_m),
                ..Support::default()
            }],
            spin: self.spin,
            unbalances: Vec::new(),
            eccentricity_m: rotor.eccentricity_m,
            magnets: (self.magnet.iter())
                .map(|magnet| MachineMagnet {
                    position_m: 0.0,
                    force_max_n: magnet.force_max_n,
                    lag_s: magnet.lag_s,
                    lag_damping_ratio: None,
                    poles: None,
                })
                .collect(),
            loads_m: vec![0.0],
            probes_m: vec![0.0],
            gravity_m_s2: V2::zeros(),
            planes: vec![MachinePlane {
                position_m: 0.0,
                centre_m: V2::zeros(),
                radius_m: rotor.contact_radius_m,
                contact: self.contact,
                friction: self.friction,
                stator: self.stator,
                race: self.race,
                load_drag: None,
                heat: None,
            }],
        }
    }
}

impl Plant {
    /// Carries the plant to `t_end_s` with `inputs` held. `on_change` is called right after each
    /// change of mode with what can be read off there.
    ///
    /// # Errors
    /// [`PlantError`]: the run cannot be trusted any further and must end.
    pub fn advance(
        &mut self,
        t_end_s: f64,
        inputs: &Inputs,
        on_change: &mut dyn FnMut(&Snapshot),
    ) -> Result<(), PlantError> {
        self.inputs.commands_n.fill(inputs.command_n);
        self.inputs.loads_n.fill(inputs.external_n);
        let mut on_change = |_plane: usize, now: &MachineSnapshot| {
            if let Some(now) = Snapshot::of(now) {
                on_change(&now);
            }
        };
        self.machine.advance(t_end_s, &self.inputs, &mut on_change)
    }

    /// Gives parameters other values from now on. Position, speeds and stored energy stay: none of these
    /// parameters has a share in the stored energy, and what they do from here on is booked as before.
    ///
    /// # Errors
    /// A value that is out of range, or that this plant has no part for. Then nothing has changed.
    pub fn change(&mut self, change: &Change) -> Result<(), ParamError> {
        self.machine.change(change)
    }

    /// What can be read off now.
    pub fn snapshot(&mut self) -> Snapshot {
        let now = self.machine.snapshot();
        Snapshot::of(&now).unwrap_or_default()
    }

    /// Mode now.
    pub fn mode(&self) -> ContactMode {
        self.machine.mode(0).unwrap_or_default()
    }

    /// Extremes and sums so far.
    pub fn meters(&self) -> Meters {
        self.machine.meters().first().copied().unwrap_or_default()
    }

    /// The energy audit so far.
    pub fn audit(&self) -> Audit {
        self.machine.audit()
    }

    /// Work done so far.
    pub fn work(&self) -> Work {
        self.machine.work()
    }

    /// Method that integrates contact; never [`Method::Auto`].
    pub fn method(&self) -> Method {
        self.machine.method()
    }

    /// Number of scalar states that this plant integrates in contact.
    pub fn states(&self) -> usize {
        self.machine.states()
    }
}

impl Snapshot {
    /// Of the one plane of a machine.
    fn of(now: &MachineSnapshot) -> Option<Self> {
        let plane = now.planes().next()?;
        Some(Self {
            t_s: now.t_s,
            position_m: plane.rotor.position,
            velocity_m_s: plane.rotor.velocity,
            inner_ring: plane.ring,
            outer_ring: plane.outer_ring,
            spin_rad_s: now.spin_rad_s,
            race_spin_rad_s: plane.race_spin_rad_s,
            mode: plane.mode,
            penetration_m: plane.penetration_m,
            normal_force_n: plane.normal_force_n,
            sliding_force_n: plane.sliding_force_n,
            rolling_force_n: plane.rolling_force_n,
            contact_tangential_speed_m_s: plane.whirl_speed_m_s,
            sliding_speed_m_s: plane.sliding_speed_m_s,
            delivered_n: now.delivered_n().next().unwrap_or_default(),
            whirl_angle_rad: plane.whirl_angle_rad,
        })
    }
}
