//! The whole machine under its levitation controller as one linear system at samples: rotor with gyroscopics and bending, magnets
//! with their stiffness and lag, the age of commands and readings, the controller as it runs.
//!
//! Between samples it is exact, the commands being held. Caps, slew, jitter, the converter's step and faults are no part of it, and
//! no wall is touched.

mod controllers;
mod design_plant;
mod discrete;
mod margins;
mod sensitivity;

use self::discrete::Discrete;
use crate::device::actuator::MOST_DELAY;
use crate::device::whole_levitation::WholeLevitationParams;
use crate::scene::{PlaneScene, Scene};
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{DMatrix, DVector, Rotation2};
use plant_model::machine::linear::{
    C, Direction, MachineMode, eigenvalues, eigenvector, half_axis, modes_of, shape_of,
};
use plant_model::machine::linear_plant::LinearPlant;
use plant_model::machine::params::MachineParams;
use plant_model::params::ParamError;
use serde::Serialize;
use std::f64::consts::TAU;

pub use design_plant::{DesignPlant, PlantNames};
pub use margins::SpeedMargin;
pub(crate) use margins::speed_margins;
pub use sensitivity::{Sensitivity, Zone};

/// Why there is no linear loop.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoLoop {
    /// A value is out of range.
    #[error(transparent)]
    Machine(#[from] ParamError),
    /// No plane has a magnet and a controller.
    #[error("no magnet has a levitation controller")]
    NoController,
    /// A program of the user's.
    #[error("the levitation controller is a program, whose equations are not known")]
    External,
    /// The search for eigenvalues does not end.
    #[error(
        "its rates lie too far apart to find its modes; keep fewer of them (rotor.bending_to_hz), or make supports softer"
    )]
    NoEigenvalues,
}

/// The closed loop at a spin.
#[derive(Debug, Clone)]
pub struct LinearLoop {
    plant: LinearPlant,
    /// What each state of the matrices below is multiplied by for that of the machine and its controller.
    scale: DVector<f64>,
    /// From sample to sample; what is added to the readings does to that; and the readings.
    a: DMatrix<f64>,
    b: DMatrix<f64>,
    c: DMatrix<f64>,
    /// From the plant's states to where the sensors are \[m\]; from there to what is read, but for its age, and that of each
    /// reading \[samples\].
    sensors: DMatrix<f64>,
    read: DMatrix<f64>,
    read_delays: Vec<usize>,
    /// Where the states of the plant begin.
    plant_at: usize,
    period_s: f64,
    /// Name of each reading.
    axes: Vec<String>,
}

/// A mode of the loop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopMode {
    /// Damped frequency \[Hz\].
    pub frequency_hz: f64,
    /// Below 0 it grows.
    pub damping_ratio: f64,
    /// `forward`, `backward` or `planar`.
    pub whirl: &'static str,
    /// Rate of growth \[1/s\].
    pub growth_1_s: f64,
}

/// Faster than this a motion grows, and not by rounding alone \[1/s\].
pub(crate) const GROWS_1_S: f64 = 1e-3;
/// What is gone within a sample to this share is no mode.
const GONE: f64 = 1e-9;

/// Planes that a controller knows of.
fn known(scene: &Scene) -> impl Iterator<Item = (usize, &PlaneScene)> {
    let planes = scene.planes.iter().enumerate();
    planes.filter(|(_, plane)| !plane.seal)
}

/// Those with a magnet, and which it is.
fn driven(scene: &Scene) -> impl Iterator<Item = (&PlaneScene, usize)> {
    known(scene).filter_map(|(_, plane)| Some((plane, plane.magnet?)))
}

/// Names of x and y of planes, as `drive end x`.
fn axes(scene: &Scene, of: impl Fn(&PlaneScene) -> bool) -> Vec<String> {
    let name = |plane: &PlaneScene, axis: &str| match plane.name.as_str() {
        "" => axis.to_owned(),
        name => format!("{name} {axis}"),
    };
    known(scene)
        .filter(|(_, plane)| of(plane))
        .flat_map(|(_, plane)| ["x", "y"].map(|axis| name(plane, axis)))
        .collect()
}

/// x and y of each axis pair turned from the scene's axes to those at an angle.
fn turned(angle_rad: f64) -> DMatrix<f64> {
    let turn = Rotation2::new(-angle_rad);
    DMatrix::from_fn(2, 2, |i, j| turn.matrix()[(i, j)])
}

fn diagonal(blocks: impl Iterator<Item = DMatrix<f64>>) -> DMatrix<f64> {
    let start = Discrete::gain(DMatrix::zeros(0, 0));
    blocks
        .fold(start, |all, block| all.beside(&Discrete::gain(block)))
        .d
}

/// The controller of the scene, from all readings to all magnets' commands.
fn controller(scene: &Scene, spin_rad_s: f64) -> Result<Discrete, NoLoop> {
    let period_s = 1.0 / scene.sample_rate_hz;
    let by_plane = |of: &dyn Fn(usize, &PlaneScene) -> Option<Discrete>| {
        let start = Discrete::gain(DMatrix::zeros(0, 0));
        let mut any = false;
        let all = known(scene)
            .enumerate()
            .fold(start, |all, (i, (_, plane))| {
                let own = plane.magnet.and_then(|_| of(i, plane));
                any |= own.is_some();
                let forces = if plane.magnet.is_some() { 2 } else { 0 };
                all.beside(&own.unwrap_or_else(|| Discrete::gain(DMatrix::zeros(forces, 2))))
            });
        any.then_some(all).ok_or(NoLoop::NoController)
    };
    match &scene.levitation {
        None => by_plane(&|_, plane| Some(controllers::pid(&plane.levitation?, 0.0, period_s))),
        Some(WholeLevitationParams::Biquads(planes)) => {
            by_plane(&|i, _| Some(controllers::biquads(planes.get(i)?.as_ref()?)))
        }
        Some(WholeLevitationParams::Modal(params)) => {
            let reported_rad_s = scene.spin_sensor.gain * spin_rad_s;
            Ok(controllers::modal(params, reported_rad_s, period_s))
        }
        Some(WholeLevitationParams::StateSpace(params)) => Ok(controllers::state_space(params)),
        Some(WholeLevitationParams::External(_)) => Err(NoLoop::External),
    }
}

/// What the controller has before it, at a spin.
struct OpenLoop {
    plant: LinearPlant,
    /// From commands along the axes of magnets to the states, in continuous time and over a period.
    inputs: DMatrix<f64>,
    /// From what is commanded to what is read, sample by sample.
    sampled: Discrete,
    sensors: DMatrix<f64>,
    read: DMatrix<f64>,
    read_delays: Vec<usize>,
    plant_at: usize,
}

impl OpenLoop {
    fn new(scene: &Scene, spin_rad_s: f64) -> Result<Self, NoLoop> {
        let plant = LinearPlant::new(&scene.machine, spin_rad_s)?;
        let (a, b) = plant.sampled(1.0 / scene.sample_rate_hz);
        // A command along the axes of its magnet.
        let along_axes = |b: &DMatrix<f64>| {
            let mut inputs = DMatrix::zeros(b.nrows(), 2 * driven(scene).count());
            for (i, (plane, magnet)) in driven(scene).enumerate() {
                let along = b.columns(2 * magnet, 2) * turned(plane.axes_rad[1]).transpose();
                inputs.columns_mut(2 * i, 2).copy_from(&along);
            }
            inputs
        };
        let mut sensors = DMatrix::zeros(2 * known(scene).count(), b.nrows());
        for (i, (plane, _)) in known(scene).enumerate() {
            let of = plant.probes.rows(2 * plane, 2);
            sensors.rows_mut(2 * i, 2).copy_from(&of);
        }
        let read = diagonal(known(scene).map(|(_, plane)| {
            let sensor = &plane.sensor;
            let mut seen = turned(plane.axes_rad[0]);
            if sensor.swapped {
                seen.swap_rows(0, 1);
            }
            DMatrix::from_diagonal(&DVector::from_column_slice(sensor.gain.as_slice())) * seen
        }));
        let command_delays: Vec<usize> = driven(scene)
            .flat_map(|(plane, _)| [plane.amplifier.delay_samples.clamp(1, MOST_DELAY); 2])
            .collect();
        let read_delays: Vec<usize> = known(scene)
            .flat_map(|(_, plane)| [plane.sensor.delay_samples; 2])
            .collect();
        let machine = Discrete {
            a,
            b: along_axes(&b),
            c: sensors.clone(),
            d: DMatrix::zeros(sensors.nrows(), command_delays.len()),
        };
        Ok(Self {
            inputs: along_axes(&plant.b),
            sampled: Discrete::delays(&command_delays)
                .then(&machine)
                .then(&Discrete::gain(read.clone()))
                .then(&Discrete::delays(&read_delays)),
            plant,
            sensors,
            read,
            read_delays,
            plant_at: command_delays.iter().sum(),
        })
    }
}

impl LinearLoop {
    /// Of a scene at a spin \[rad/s\].
    ///
    /// # Errors
    /// [`NoLoop`].
    pub fn new(scene: &Scene, spin_rad_s: f64) -> Result<Self, NoLoop> {
        let controller = controller(scene, spin_rad_s)?;
        let open = OpenLoop::new(scene, spin_rad_s)?;
        let (mut a, mut b) = open.sampled.closed_over(&controller);
        let mut c = DMatrix::zeros(open.read.nrows(), a.ncols());
        c.columns_mut(0, open.sampled.c.ncols())
            .copy_from(&open.sampled.c);
        if a.iter().any(|x| !x.is_finite()) {
            return Err(NoLoop::NoEigenvalues);
        }
        // States of a controller may be of any size: without this, digits are lost.
        let scale = balance_parlett_reinsch(&mut a);
        for (i, scale) in scale.iter().enumerate() {
            b.row_mut(i).scale_mut(1.0 / scale);
            c.column_mut(i).scale_mut(*scale);
        }
        Ok(Self {
            plant: open.plant,
            scale,
            a,
            b,
            c,
            sensors: open.sensors,
            read: open.read,
            read_delays: open.read_delays,
            plant_at: open.plant_at,
            period_s: 1.0 / scene.sample_rate_hz,
            axes: axes(scene, |_| true),
        })
    }

    /// The machine's part of a state.
    fn machine_state(&self, state: &DVector<C>) -> DVector<C> {
        let of = |i: usize| state[i] * self.scale[i];
        DVector::from_fn(self.plant.a.nrows(), |i, _| of(self.plant_at + i))
    }

    /// Modes, slowest first; those that do not turn are among them.
    ///
    /// # Errors
    /// [`NoLoop::NoEigenvalues`].
    pub fn modes(&self) -> Result<Vec<MachineMode>, NoLoop> {
        let values = eigenvalues(&self.a).ok_or(NoLoop::NoEigenvalues)?;
        let complex = self.a.map(|x| C::new(x, 0.0));
        let upper = (values.iter()).filter(|value| value.im >= 0.0 && value.norm() > GONE);
        let modes = upper.map(|value| self.mode(&complex, *value));
        Ok(modes_of(modes, 1.0 / self.period_s))
    }

    /// Continuous rate and direction of an eigenvalue.
    fn mode(&self, a: &DMatrix<C>, value: C) -> (C, Direction) {
        let rate = value.ln() / self.period_s;
        let still = value.im == 0.0 && value.re > 0.0;
        let vector = match still {
            true => None,
            false => eigenvector(a, value, value.norm()),
        };
        let Some(mut vector) = vector else {
            return (rate, Direction::Planar);
        };
        // A mode above half the rate looks like a slower one at samples; its velocities tell which it is.
        let turning_rad_s = self
            .plant
            .turning_rad_s(self.machine_state(&vector).as_slice());
        let rate_rad_s = TAU / self.period_s;
        let folds = turning_rad_s.map_or(0.0, |turning| ((turning - rate.im) / rate_rad_s).round());
        let mut unfolded = C::new(rate.re, rate.im + folds * rate_rad_s);
        if unfolded.im < 0.0 {
            unfolded = unfolded.conj();
            vector = vector.map(|z| z.conj());
        }
        let state = self.machine_state(&vector);
        let places = [&self.plant.planes, &self.sensors].into_iter();
        let motions = places.flat_map(|rows| motions(rows, &state));
        (unfolded, Direction::of(motions))
    }

    /// Shapes of modes at places along the axis, from the centre of mass \[m\]: as of [`shape_of`]; without those that are not found.
    ///
    /// # Errors
    /// [`NoLoop::Machine`].
    pub fn shapes(
        &self,
        modes: &[MachineMode],
        machine: &MachineParams,
        places_m: &[f64],
    ) -> Result<Vec<(MachineMode, Vec<C>)>, NoLoop> {
        let along_the_axis = MachineParams {
            probes_m: places_m.to_vec(),
            ..machine.clone()
        };
        let rows = LinearPlant::new(&along_the_axis, 0.0)?.probes;
        let a = self.a.map(|x| C::new(x, 0.0));
        let shape = |mode: &MachineMode| {
            let value = (C::new(mode.growth_s, mode.frequency_rad_s) * self.period_s).exp();
            let vector = eigenvector(&a, value, value.norm())?;
            Some((
                *mode,
                shape_of(&motions(&rows, &self.machine_state(&vector))),
            ))
        };
        Ok(modes.iter().filter_map(shape).collect())
    }

    /// Response to the unbalance at a spin that is that of the loop \[rad/s\], at samples: largest distance from the middle in each
    /// plane, and at each sensor \[m\]. `None` where an undamped mode is hit.
    pub fn unbalance_response_m(&self, spin_rad_s: f64) -> Option<[Vec<f64>; 2]> {
        let plant = &self.plant;
        let n = plant.a.nrows();
        let complex = |m: &DMatrix<f64>| m.map(|x| C::new(x, 0.0));
        // As without the controller …
        let free =
            DMatrix::from_diagonal_element(n, n, C::new(0.0, spin_rad_s)) - complex(&plant.a);
        let force = &plant.unbalance * C::new(spin_rad_s * spin_rad_s, 0.0);
        let free = free.lu().solve(&force)?;
        // … and what it adds, which sees that.
        let z = C::new(0.0, spin_rad_s * self.period_s).exp();
        let mut seen = complex(&self.read) * (complex(&self.sensors) * &free);
        for (signal, delay) in seen.iter_mut().zip(&self.read_delays) {
            *signal *= z.powi(-(*delay as i32));
        }
        let size = self.a.nrows();
        let closed = DMatrix::from_diagonal_element(size, size, z) - complex(&self.a);
        let answer = closed.lu().solve(&(complex(&self.b) * seen))?;
        let state = free + self.machine_state(&answer);
        Some(
            [&plant.planes, &self.sensors]
                .map(|rows| motions(rows, &state).into_iter().map(half_axis).collect()),
        )
    }
}

/// x and y of places at a state, by the rows of x and y of each.
fn motions(rows: &DMatrix<f64>, state: &DVector<C>) -> Vec<[C; 2]> {
    let moved = rows.map(|x| C::new(x, 0.0)) * state;
    (moved.as_slice().chunks_exact(2))
        .map(|motion| [motion[0], motion[1]])
        .collect()
}

/// Whether no mode grows.
pub fn is_stable(modes: &[MachineMode]) -> bool {
    modes.iter().all(|mode| mode.growth_s <= GROWS_1_S)
}

/// Of what decays so fast against its turning that it is no swing, as much of a controller, rounding may say that it turns.
const SWINGS: f64 = 0.05;

/// Whether a mode turns or swings, and does not just decay.
pub fn swings(mode: &MachineMode) -> bool {
    mode.frequency_rad_s > SWINGS * mode.growth_s.abs().max(1e-3)
}

/// Those that turn or swing.
pub(crate) fn oscillating(modes: &[MachineMode]) -> Vec<LoopMode> {
    let turning = modes.iter().filter(|mode| swings(mode));
    turning
        .map(|mode| LoopMode {
            frequency_hz: mode.frequency_rad_s / TAU,
            damping_ratio: mode.damping_ratio,
            whirl: mode.direction.name(),
            growth_1_s: mode.growth_s,
        })
        .collect()
}
