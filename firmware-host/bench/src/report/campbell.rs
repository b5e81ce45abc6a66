//! A whole rotor as a linear system, for people and programs: modes over the spin, critical speeds, response to the unbalance,
//! coupling of the planes.

use super::plot::PlotError;
use super::plot::chart::{Axis, Chart, Curve, Mark, chart};
use super::plot::text::figures;
use super::table::{lined, right};
use super::{begun, push, push_story};
use crate::scene::machine::MachineScene;
use comfy_table::Cell;
use plant_model::V2;
use plant_model::machine::linear::{Direction, LinearMachine, MachineMode, Walls};
use plant_model::machine::params::{MachineError, MachineParams, Support};
use serde::Serialize;
use std::f64::consts::TAU;
use std::fmt::Write as _;

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
    pub fn new(scene: &MachineScene) -> Result<Self, MachineError> {
        Ok(Self::of(
            scene,
            &LinearMachine::new(&scene.machine, Walls::Off)?,
        ))
    }

    /// Neither supports nor walls have a share in it.
    fn of(scene: &MachineScene, machine: &LinearMachine) -> Self {
        let mobility = machine.mobility();
        let names = scene.planes.iter().map(|plane| plane.name.clone());
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
    /// Response to the unbalance.
    pub unbalance_response: Vec<Response>,
    /// Rates at which unstable motions grow at the highest spin \[1/s\].
    pub growth_1_s: Vec<f64>,
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
    pub fn new(scene: &MachineScene, range: Range) -> Result<Self, AnalysisError> {
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
            scene: scene.common().title.clone(),
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
        })
    }
}

/// Faster than this a motion grows, and not by rounding alone \[1/s\].
const GROWS_1_S: f64 = 1e-3;

/// The machine, with the gains of its planes' controllers as supports where that is asked for.
fn held(scene: &MachineScene, range: Range) -> MachineParams {
    let mut params = scene.machine.clone();
    if range.levitated {
        let magnets = (scene.planes.iter())
            .filter_map(|plane| Some((plane.magnet?, plane.scene.levitation?)));
        params
            .supports
            .extend(magnets.map(|(magnet, gains)| Support {
                position_m: scene.machine.magnets[magnet].position_m,
                stiffness_n_m: V2::repeat(gains.proportional_n_m),
                damping_n_s_m: V2::repeat(gains.derivative_n_s_m),
            }));
    }
    params
}

/// Tables of it: modes at standstill, at the spin nearest to that of the scene and at the highest, critical speeds, coupling.
pub fn text(scene: &MachineScene, analysis: &Analysis) -> String {
    let mut text = format!("{}\n", analysis.scene);
    let last = (analysis.range.points - 1) as f64;
    let nearest = (scene.start.spin_rad_s.abs() / TAU / analysis.range.to_hz * last).round();
    let mut shown = vec![0.0, nearest.min(last), last];
    shown.dedup();
    let mut table = lined(["spin [Hz]", "frequency [Hz]", "whirl", "damping ratio"]);
    for at in shown {
        let spin_rad_s = TAU * analysis.range.to_hz * at / last;
        let modes = analysis
            .modes
            .iter()
            .filter(|mode| mode.spin_rad_s == spin_rad_s);
        for mode in modes {
            table.add_row([
                right(figures(spin_rad_s / TAU)),
                right(figures(mode.frequency_hz)),
                Cell::new(mode.whirl),
                right(figures(mode.damping_ratio)),
            ]);
        }
    }
    let _ = write!(text, "{table}\n\n");
    let mut table = lined(["critical speed [Hz]", "whirl"]);
    for speed in &analysis.critical_speeds {
        let spin_hz = figures(speed.spin_rad_s / TAU);
        table.add_row([right(spin_hz), Cell::new(speed.whirl)]);
    }
    let _ = write!(text, "{table}\n\n{}", coupling(&analysis.coupling));
    for rate in &analysis.growth_1_s {
        let _ = write!(
            text,
            "\nunstable at {} Hz: a motion grows by {} 1/s",
            figures(analysis.range.to_hz),
            figures(*rate)
        );
    }
    text + "\n"
}

/// Mass of each plane, and how far each other one moves when it is struck.
pub fn coupling(coupling: &Coupling) -> String {
    let mut header = vec!["plane".to_owned(), "effective mass [kg]".to_owned()];
    header.extend(coupling.planes.iter().map(|name| format!("{name} moves")));
    let mut table = lined(header);
    for (i, name) in coupling.planes.iter().enumerate() {
        let row = &coupling.mobility_1_kg[i];
        // Without the sign of a rounded zero.
        let moves = row
            .iter()
            .map(|m| right(format!("{:.3}", (1e3 * m / row[i]).round() / 1e3 + 0.0)));
        let mass = right(figures(coupling.effective_mass_kg[i]));
        table.add_row(
            [Cell::new(format!("{name} struck")), mass]
                .into_iter()
                .chain(moves),
        );
    }
    table.to_string()
}

/// A page with the Campbell diagram and the response to the unbalance.
///
/// # Errors
/// [`PlotError`] if the drawing backend refuses.
pub fn html(scene: &MachineScene, analysis: &Analysis) -> Result<String, PlotError> {
    let mut page = begun(&analysis.scene);
    push_story(&mut page, &scene.common().story);
    page.push_str("</header>\n<main>\n<section><h2>Campbell diagram</h2>\n");
    push(
        &mut page,
        format_args!("<figure>{}</figure>\n", chart(&diagram(analysis))?),
    );
    page.push_str("</section>\n<section><h2>Response to the unbalance</h2>\n");
    push(
        &mut page,
        format_args!("<figure>{}</figure>\n", chart(&responses(analysis))?),
    );
    page.push_str("</section>\n<section><pre>");
    page.push_str(&super::plot::text::escape(&text(scene, analysis)));
    page.push_str("</pre></section>\n</main>\n</body>\n</html>\n");
    Ok(page)
}

fn diagram(analysis: &Analysis) -> Chart {
    let to_hz = analysis.range.to_hz;
    let highest = (analysis.modes.iter())
        .map(|m| m.frequency_hz)
        .fold(to_hz, f64::max);
    let of = |direction: Direction, colour: usize| {
        let modes = analysis
            .modes
            .iter()
            .filter(|mode| mode.whirl == direction.name());
        Curve {
            name: direction.name().to_owned(),
            points: modes
                .map(|mode| (mode.spin_rad_s / TAU, mode.frequency_hz))
                .collect(),
            mark: Mark::Dots,
            colour,
        }
    };
    let once = Curve {
        name: "once a turn".to_owned(),
        points: vec![(0.0, 0.0), (to_hz, to_hz)],
        mark: Mark::Dashed,
        colour: 5,
    };
    let mut curves = vec![once];
    curves.extend(
        [
            (Direction::Forward, 0),
            (Direction::Backward, 1),
            (Direction::Planar, 2),
        ]
        .map(|(d, c)| of(d, c)),
    );
    curves.retain(|curve| !curve.points.is_empty());
    Chart {
        label: "Natural frequencies over the spin".to_owned(),
        x: axis("spin / Hz", (0.0, to_hz), false),
        y: axis("frequency / Hz", (0.0, 1.05 * highest), false),
        curves,
    }
}

fn responses(analysis: &Analysis) -> Chart {
    let of = |(plane, name): (usize, &String)| Curve {
        name: name.clone(),
        points: (analysis.unbalance_response.iter())
            .filter_map(|at| Some((at.spin_rad_s / TAU, 1e6 * at.planes_m.as_ref()?[plane])))
            .filter(|point| point.1 > 0.0)
            .collect(),
        mark: Mark::Line,
        colour: plane,
    };
    let curves: Vec<Curve> = analysis
        .coupling
        .planes
        .iter()
        .enumerate()
        .map(of)
        .collect();
    let values = || {
        curves
            .iter()
            .flat_map(|curve| &curve.points)
            .map(|point| point.1)
    };
    let (low, high) = (
        values().fold(f64::INFINITY, f64::min),
        values().fold(0.0, f64::max),
    );
    let range = match high > low {
        true => (low.max(1e-4 * high), high),
        false => (0.1, 1.0),
    };
    Chart {
        label: "Distance from the middle over the spin".to_owned(),
        x: axis("spin / Hz", (0.0, analysis.range.to_hz), false),
        y: axis("amplitude / µm", range, true),
        curves,
    }
}

fn axis(name: &str, range: (f64, f64), log: bool) -> Axis {
    Axis {
        name: name.to_owned(),
        range,
        log,
    }
}
