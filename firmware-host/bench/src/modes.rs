//! A whole rotor as a linear system: modes over the spin and their shapes, critical speeds, response to the unbalance, whirl that
//! friction can hold, coupling of the planes.

use crate::scene::Scene;
use plant_model::V2;
use plant_model::machine::linear::{LinearMachine, MachineMode, Walls};
use plant_model::machine::params::{MachineError, MachineParams, Support};
use serde::Serialize;
use std::f64::consts::TAU;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Range {
    /// Highest spin \[Hz\].
    pub to_hz: f64,
    /// At how many spins from 0.
    pub points: usize,
    /// Whether contact springs and dampers of all planes hold the rotor.
    pub contact: bool,
    /// Whether the gains of the levitation controllers do, at the magnets.
    pub levitated: bool,
}

/// A mode at a spin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeAtSpin {
    /// Spin \[rad/s\].
    pub spin_rad_s: f64,
    /// Damped frequency \[Hz\].
    pub frequency_hz: f64,
    /// `forward`, `backward` or `planar`.
    pub whirl: &'static str,
    /// Below 0 it grows.
    pub damping_ratio: f64,
}

/// A critical speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CriticalSpeed {
    /// Without damping \[rad/s\].
    pub spin_rad_s: f64,
    /// `forward`, `backward` or `planar`.
    pub whirl: &'static str,
}

/// Response to the unbalance at a spin.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Response {
    /// Spin \[rad/s\].
    pub spin_rad_s: f64,
    /// Largest distance of the rotor from the middle in each plane \[m\]; null where an undamped mode is hit.
    pub planes_m: Option<Vec<f64>>,
    /// The same at their sensors \[m\].
    pub sensors_m: Option<Vec<f64>>,
}

/// Shape of a mode at the spin of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeShape {
    /// Damped frequency \[Hz\].
    pub frequency_hz: f64,
    /// `forward`, `backward` or `planar`.
    pub whirl: &'static str,
    /// Motion at each of the positions, along and across that at the place that moves most, which is 1.
    pub along: Vec<f64>,
    /// See `along`.
    pub across: Vec<f64>,
}

/// Backward whirl in some planes at once that friction can hold, at the spin of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeldWhirl {
    /// Names of the planes.
    pub planes: Vec<String>,
    /// Slowest and fastest \[rad/s\], backward positive: Black's limits.
    pub rates_rad_s: [f64; 2],
    /// At both ends, the second plane against the first \[rad\]: 0 cylindrical, ±π conical.
    pub phases_rad: [f64; 2],
}

/// How the planes of a rotor feel each other, with bending.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coupling {
    /// Names of the planes.
    pub planes: Vec<String>,
    /// Mass that each feels in an impact \[kg\].
    pub effective_mass_kg: Vec<f64>,
    /// Mobility between them, row by row \[1/kg\].
    pub mobility_1_kg: Vec<Vec<f64>>,
}

impl Coupling {
    /// Of the rotor of a scene.
    ///
    /// # Errors
    /// The first value that is out of range.
    pub fn new(scene: &Scene) -> Result<Self, MachineError> {
        Ok(Self::of(
            scene,
            &LinearMachine::new(&scene.machine, Walls::Off)?,
        ))
    }

    /// Neither supports nor walls have a share in it.
    fn of(scene: &Scene, machine: &LinearMachine) -> Self {
        let mobility = machine.mobility();
        let names = scene.planes.iter().map(|plane| plane.shown().to_owned());
        Self {
            planes: names.collect(),
            effective_mass_kg: (0..mobility.len()).map(|p| 1.0 / mobility[p][p]).collect(),
            mobility_1_kg: mobility,
        }
    }
}

/// A rotor as a linear system.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Analysis {
    /// Title of the scene.
    pub scene: String,
    /// What was looked at.
    pub range: Range,
    /// Coupling of the planes.
    #[serde(flatten)]
    pub coupling: Coupling,
    /// Modes that turn or swing, spin by spin, slowest first.
    pub modes: Vec<ModeAtSpin>,
    /// Critical speeds, slowest first, also above the range.
    pub critical_speeds: Vec<CriticalSpeed>,
    pub unbalance_response: Vec<Response>,
    /// Rates at which unstable motions grow at the highest spin \[1/s\].
    pub growth_1_s: Vec<f64>,
    /// Spin of the scene \[rad/s\], at which shapes and whirl are told.
    pub spin_rad_s: f64,
    /// Places of the shapes, from the centre of mass \[m\].
    pub shape_positions_m: Vec<f64>,
    /// Shapes of the modes that turn or swing, slowest first.
    pub mode_shapes: Vec<ModeShape>,
    /// Whirl that friction can hold; null where mountings differ along x and y, or walls are closed.
    pub held_whirl: Option<Vec<HeldWhirl>>,
}

/// Of an eigenvalue that turns by less than this share of its size, or than this \[rad/s\], it is rounding that turns.
const STANDS: f64 = 1e-6;

/// Why there is no analysis.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// A value is out of range.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The search for eigenvalues does not end.
    #[error(
        "its rates lie too far apart to find its modes; keep fewer of them (rotor.bending_to_hz), or make supports softer"
    )]
    NoEigenvalues,
}

impl Analysis {
    /// Of the machine of a scene.
    ///
    /// # Errors
    /// [`AnalysisError`].
    pub fn new(scene: &Scene, range: Range) -> Result<Self, AnalysisError> {
        let none = || AnalysisError::NoEigenvalues;
        let params = held(scene, range);
        let walls = match range.contact {
            true => Walls::Closed,
            false => Walls::Off,
        };
        let machine = LinearMachine::new(&params, walls)?;
        let last = (range.points - 1) as f64;
        let spins: Vec<f64> = (0..range.points)
            .map(|i| TAU * range.to_hz * i as f64 / last)
            .collect();
        let turns = |mode: &MachineMode| {
            let size = mode.frequency_rad_s.hypot(mode.growth_s);
            mode.frequency_rad_s > STANDS * size.max(1.0)
        };
        let (mut modes, mut growing) = (Vec::new(), Vec::new());
        for spin_rad_s in &spins {
            let at_spin = machine.modes(*spin_rad_s).ok_or_else(none)?;
            // The last is the highest.
            growing = at_spin.iter().map(|mode| mode.growth_s).collect();
            modes.extend(at_spin.into_iter().filter(turns).map(|mode| ModeAtSpin {
                spin_rad_s: *spin_rad_s,
                frequency_hz: mode.frequency_rad_s / TAU,
                whirl: mode.direction.name(),
                damping_ratio: mode.damping_ratio,
            }));
        }
        let spin_rad_s = scene.start.spin_rad_s;
        let shape_positions_m = places(&params);
        let along_the_axis = MachineParams {
            probes_m: shape_positions_m.clone(),
            ..params.clone()
        };
        let shapes = LinearMachine::new(&along_the_axis, walls)?.shapes(spin_rad_s);
        let shapes = (shapes.ok_or_else(none)?.into_iter()).filter(|(mode, _)| turns(mode));
        let name = |plane: &usize| scene.planes[*plane].shown().to_owned();
        let held_whirl = machine.whirl_ranges(spin_rad_s).map(|ranges| {
            (ranges.into_iter())
                .map(|range| HeldWhirl {
                    planes: range.planes.iter().map(name).collect(),
                    rates_rad_s: range.rates_rad_s,
                    phases_rad: range.phases_rad,
                })
                .collect()
        });
        let critical_speeds = machine.critical_speeds().ok_or_else(none)?;
        let planes = scene.planes.len();
        let response = |spin_rad_s: f64| {
            let all = machine.unbalance_response_m(spin_rad_s);
            let part = |sensors: bool| {
                let (of_planes, of_sensors) = all.as_ref()?.split_at(planes);
                Some(if sensors { of_sensors } else { of_planes }.to_vec())
            };
            Response {
                spin_rad_s,
                planes_m: part(false),
                sensors_m: part(true),
            }
        };
        growing.retain(|rate| *rate > GROWS_1_S);
        Ok(Self {
            scene: scene.title.clone(),
            range,
            coupling: Coupling::of(scene, &machine),
            modes,
            critical_speeds: (critical_speeds.into_iter())
                .map(|speed| CriticalSpeed {
                    spin_rad_s: speed.spin_rad_s,
                    whirl: speed.direction.name(),
                })
                .collect(),
            unbalance_response: spins.iter().map(|spin| response(*spin)).collect(),
            growth_1_s: growing,
            spin_rad_s,
            shape_positions_m,
            mode_shapes: shapes
                .map(|(mode, shape)| ModeShape {
                    frequency_hz: mode.frequency_rad_s / TAU,
                    whirl: mode.direction.name(),
                    along: shape.iter().map(|z| z.re).collect(),
                    across: shape.iter().map(|z| z.im).collect(),
                })
                .collect(),
            held_whirl,
        })
    }
}

/// Faster than this a motion grows, and not by rounding alone \[1/s\].
const GROWS_1_S: f64 = 1e-3;

/// The machine, with the gains of its planes' controllers as supports where that is asked for.
fn held(scene: &Scene, range: Range) -> MachineParams {
    let mut params = scene.machine.linear_magnets();
    if range.levitated {
        let held = (scene.planes.iter())
            .filter_map(|plane| Some((plane.magnet?, plane.levitation?, plane.axes_rad)));
        params
            .supports
            .extend(held.map(|(magnet, gains, [sensor_rad, magnet_rad])| {
                // A force along other axes than those along which is read pushes across as well.
                let (across, along) = (magnet_rad - sensor_rad).sin_cos();
                let of = |gain: f64| {
                    (
                        V2::repeat(gain * along),
                        V2::new(-gain * across, gain * across),
                    )
                };
                let (stiffness_n_m, cross_stiffness_n_m) = of(gains.proportional_n_m);
                let (damping_n_s_m, cross_damping_n_s_m) = of(gains.derivative_n_s_m);
                Support {
                    position_m: scene.machine.magnets[magnet].position_m,
                    stiffness_n_m,
                    damping_n_s_m,
                    cross_stiffness_n_m,
                    cross_damping_n_s_m,
                }
            }));
    }
    params
}

/// All places at which something acts or is read, or a shape is told, from left to right.
fn places(params: &MachineParams) -> Vec<f64> {
    let bending = params.rotor.bending().iter();
    let mut all: Vec<f64> = bending
        .flat_map(|mode| &mode.shape)
        .map(|(z, _)| *z)
        .collect();
    all.extend(params.planes.iter().map(|plane| plane.position_m));
    all.extend(params.magnets.iter().map(|magnet| magnet.position_m));
    all.extend(params.supports.iter().map(|support| support.position_m));
    all.extend(&params.probes_m);
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
