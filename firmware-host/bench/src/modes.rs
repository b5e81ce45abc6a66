//! A whole rotor as a linear system: modes over the spin and their shapes, critical speeds, response to the unbalance, whirl that
//! friction can hold, coupling of the planes; levitated, also stability, sensitivity and margins of the loop.

use crate::scene::Scene;
use crate::scene::linear_loop::{
    self, LinearLoop, LoopMode, NoLoop, Sensitivity, SpeedMargin, speed_margins,
};
use plant_model::machine::linear::{C, LinearMachine, MachineMode, Walls};
use plant_model::machine::params::MachineParams;
use plant_model::params::ParamError;
use serde::Serialize;
use std::f64::consts::TAU;

/// What is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Range {
    /// Highest spin \[Hz\].
    pub to_hz: f64,
    /// At how many spins from 0.
    pub points: usize,
    /// What holds the rotor beside its supports.
    pub held: Held,
}

/// What holds a rotor beside its supports and the stiffness of its magnets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Held {
    /// Nothing.
    Free,
    /// Contact springs and dampers of all planes.
    Contact,
    /// The levitation controller, as sampled.
    Levitated,
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
    pub fn new(scene: &Scene) -> Result<Self, ParamError> {
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

/// Sensitivity over frequency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensitivityCourse {
    /// Up to half the rate of the loop.
    pub frequencies_hz: Vec<f64>,
    /// Of each axis, in the order of the peaks.
    pub axes_db: Vec<Vec<f64>>,
}

/// The loop of a levitated rotor at the spin of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoopAnalysis {
    /// Whether no motion grows.
    pub stable: bool,
    /// Modes that turn or swing, those of the controller among them, slowest first.
    pub loop_modes: Vec<LoopMode>,
    /// Peak of the sensitivity of each axis; empty of a loop that is not stable.
    pub sensitivity: Vec<Sensitivity>,
    /// Its course, of a loop that is stable.
    pub sensitivity_course: Option<SensitivityCourse>,
    /// The critical speeds of the range, with what API 617 says of them.
    pub speed_margins: Vec<SpeedMargin>,
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
    /// The loop, of a levitated rotor.
    #[serde(flatten)]
    pub levitation: Option<LoopAnalysis>,
    /// Modes that turn or swing, spin by spin, slowest first.
    pub modes: Vec<ModeAtSpin>,
    /// Critical speeds, slowest first: without damping and also above the range; of a levitated rotor those within it.
    pub critical_speeds: Vec<CriticalSpeed>,
    pub unbalance_response: Vec<Response>,
    /// Rates at which unstable motions grow at the highest spin \[1/s\].
    pub growth_1_s: Vec<f64>,
    /// Spin of the scene \[rad/s\], at which shapes, whirl and the loop are given.
    pub spin_rad_s: f64,
    /// Places of the shapes, from the centre of mass \[m\].
    pub shape_positions_m: Vec<f64>,
    /// Shapes of the modes that turn or swing, slowest first.
    pub mode_shapes: Vec<ModeShape>,
    /// Whirl that friction can hold, without levitation; null where mountings differ along x and y, or walls are closed.
    pub held_whirl: Option<Vec<HeldWhirl>>,
}

/// Of an eigenvalue that turns by less than this share of its size, or than this \[rad/s\], it is rounding that turns.
const STANDS: f64 = 1e-6;

/// Why there is no analysis.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// A value is out of range.
    #[error(transparent)]
    Machine(#[from] ParamError),
    /// Of the loop, or of the search for eigenvalues.
    #[error(transparent)]
    Loop(#[from] NoLoop),
}

/// What is reported of a rotor, however it is held.
struct Found {
    /// At each spin of the range.
    modes: Vec<Vec<MachineMode>>,
    critical_speeds: Vec<CriticalSpeed>,
    /// In each plane and at each sensor, at each spin.
    responses_m: Vec<Option<[Vec<f64>; 2]>>,
    shapes: Vec<(MachineMode, Vec<C>)>,
    levitation: Option<LoopAnalysis>,
}

impl Found {
    /// Of a rotor that the controller does not hold.
    fn without_levitation(
        scene: &Scene,
        (machine, along_the_axis): (&LinearMachine, &LinearMachine),
        spins: &[f64],
    ) -> Option<Self> {
        let planes = scene.planes.len();
        let response = |spin: &f64| {
            let all = machine.unbalance_response_m(*spin)?;
            let (of_planes, of_sensors) = all.split_at(planes);
            Some([of_planes.to_vec(), of_sensors.to_vec()])
        };
        let critical_speeds = machine.critical_speeds()?.into_iter();
        Some(Self {
            modes: (spins.iter())
                .map(|spin| machine.modes(*spin))
                .collect::<Option<_>>()?,
            critical_speeds: critical_speeds
                .map(|speed| CriticalSpeed {
                    spin_rad_s: speed.spin_rad_s,
                    whirl: speed.direction.name(),
                })
                .collect(),
            responses_m: spins.iter().map(response).collect(),
            shapes: along_the_axis.shapes(scene.start.spin_rad_s)?,
            levitation: None,
        })
    }

    /// Of a rotor under its controller.
    fn levitated(scene: &Scene, places_m: &[f64], spins: &[f64]) -> Result<Self, NoLoop> {
        let mut modes = Vec::with_capacity(spins.len());
        let mut responses_m = Vec::with_capacity(spins.len());
        for spin in spins {
            let closed = LinearLoop::new(scene, *spin)?;
            modes.push(closed.modes()?);
            responses_m.push(closed.unbalance_response_m(*spin));
        }
        let closed = LinearLoop::new(scene, scene.start.spin_rad_s)?;
        let at_spin = closed.modes()?;
        let stable = linear_loop::is_stable(&at_spin);
        let margins = speed_margins(scene, spins, &modes)?;
        let shapes = closed.shapes(&at_spin, &scene.machine, places_m)?;
        Ok(Self {
            modes,
            critical_speeds: (margins.iter())
                .map(|margin| CriticalSpeed {
                    spin_rad_s: margin.spin_rad_s,
                    whirl: margin.whirl,
                })
                .collect(),
            responses_m,
            shapes,
            levitation: Some(LoopAnalysis {
                stable,
                loop_modes: linear_loop::oscillating(&at_spin),
                sensitivity: match stable {
                    true => closed.sensitivity_peaks(&at_spin),
                    false => Vec::new(),
                },
                sensitivity_course: stable.then(|| course(scene, &closed)),
                speed_margins: margins,
            }),
        })
    }
}

/// Frequencies of a course, evenly by their logarithm over four decades up to half the rate.
const COURSE: u32 = 320;

fn course(scene: &Scene, closed: &LinearLoop) -> SensitivityCourse {
    let share = |i: u32| f64::from(i) / f64::from(COURSE) - 1.0;
    let frequencies_hz: Vec<f64> = (0..=COURSE)
        .map(|i| 0.5 * scene.sample_rate_hz * 10_f64.powf(4.0 * share(i)))
        .collect();
    let all = closed.sensitivities(&frequencies_hz);
    let axes = all.first().map_or(0, Vec::len);
    let of = |axis: usize| all.iter().map(|at| 20.0 * at[axis].log10()).collect();
    SensitivityCourse {
        axes_db: (0..axes).map(of).collect(),
        frequencies_hz,
    }
}

fn turns(mode: &MachineMode) -> bool {
    let size = mode.frequency_rad_s.hypot(mode.growth_s);
    mode.frequency_rad_s > STANDS * size.max(1.0)
}

impl Analysis {
    /// Of the machine of a scene.
    ///
    /// # Errors
    /// [`AnalysisError`].
    pub fn new(scene: &Scene, range: Range) -> Result<Self, AnalysisError> {
        let params = scene.machine.linear_magnets();
        let walls = match range.held {
            Held::Contact => Walls::Closed,
            Held::Free | Held::Levitated => Walls::Off,
        };
        let machine = LinearMachine::new(&params, walls)?;
        let last = (range.points - 1) as f64;
        let spins: Vec<f64> = (0..range.points)
            .map(|i| TAU * range.to_hz * i as f64 / last)
            .collect();
        let spin_rad_s = scene.start.spin_rad_s;
        let shape_positions_m = places(&params);
        let along_the_axis = MachineParams {
            probes_m: shape_positions_m.clone(),
            ..params
        };
        let found = match range.held {
            Held::Levitated => Found::levitated(scene, &shape_positions_m, &spins)?,
            Held::Free | Held::Contact => {
                let along_the_axis = LinearMachine::new(&along_the_axis, walls)?;
                Found::without_levitation(scene, (&machine, &along_the_axis), &spins)
                    .ok_or(NoLoop::NoEigenvalues)?
            }
        };
        let at_highest = found.modes.last().into_iter().flatten();
        let mut growth_1_s: Vec<f64> = at_highest.map(|mode| mode.growth_s).collect();
        growth_1_s.retain(|rate| *rate > linear_loop::GROWS_1_S);
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
        let shown = match range.held {
            Held::Levitated => linear_loop::swings,
            Held::Free | Held::Contact => turns,
        };
        let modes = spins.iter().zip(found.modes).flat_map(|(spin, modes)| {
            modes.into_iter().filter(shown).map(|mode| ModeAtSpin {
                spin_rad_s: *spin,
                frequency_hz: mode.frequency_rad_s / TAU,
                whirl: mode.direction.name(),
                damping_ratio: mode.damping_ratio,
            })
        });
        let shapes = found.shapes.iter().filter(|(mode, _)| shown(mode));
        Ok(Self {
            scene: scene.title.clone(),
            range,
            coupling: Coupling::of(scene, &machine),
            levitation: found.levitation,
            modes: modes.collect(),
            critical_speeds: found.critical_speeds,
            unbalance_response: (spins.iter().zip(found.responses_m))
                .map(|(spin, response)| {
                    let [planes_m, sensors_m] = match response {
                        Some(both) => both.map(Some),
                        None => [None, None],
                    };
                    Response {
                        spin_rad_s: *spin,
                        planes_m,
                        sensors_m,
                    }
                })
                .collect(),
            growth_1_s,
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

/// All places at which something acts or is read, or a shape is given, from left to right.
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
