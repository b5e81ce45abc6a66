//! A rigid rotor in two planes, from a log of both: mass, inertias, and each plane's axes, stiffness and time to the force.
//!
//! Sensor i reads x_i = c + s_i·θ of the centre c and the slope θ. With a_j the place of magnet j, h_ij = 1 + s_i·a_j·m/I_t and z_j the
//! rotor there, ẍ_i = Σ_j h_ij·(B_j·f_j − κ_j·z_j) + s_i·(I_p/I_t)·Ω·(−θ̇_y, θ̇_x), τ_j·ḟ_j + f_j = u_j: B_j force factor and axes over mass, κ_j
//! stiffness over mass. Places are those of the scene. Of gains and places only products show.

use crate::commission::fit::{
    Fit, Model, Problem, UNEXPLAINED, hidden, unexplained, without_outliers,
};
use crate::commission::one_plane::{MOST_DELAY, determinant, of_axes};
use crate::commission::spectrum::{Complex64, Line};
use crate::commission::{Commissioned, Found, Missing};
use crate::log_file::LogError;
use supervisor::PlanePositions;

/// A rotor in two planes, as far as a log of it does not tell.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoPlanes {
    /// Names of the planes, as they stand before the names of their numbers.
    pub names: [String; 2],
    /// What stands where, from the centre of mass.
    pub places: [PlanePositions; 2],
    /// Mass as the scene has it \[kg\].
    pub mass_kg: f64,
}

/// Windows of each plane that intervals need, and that the fit takes up in all.
pub(super) const LEAST_WINDOWS: usize = 6;
const OF_FIT: f64 = 8.0;
/// The widest interval of mass and inertias that is one, either way as a share; of the centre as a share of the way between the planes.
const WIDEST: f64 = 0.25;
const WIDEST_CENTRE: f64 = 0.05;
/// Radii of gyration that are tried, over the way between the sensors, and delays \[ticks\].
const RADII: [f64; 12] = [
    0.07, 0.12, 0.18, 0.25, 0.32, 0.4, 0.5, 0.62, 0.78, 1.0, 1.4, 2.0,
];
const DELAYS: [f64; 7] = [0.0, 1.0, 2.0, 3.0, 5.0, 8.0, MOST_DELAY];
/// A spin below this share of the slowest line shows no gyroscopic moment \[rad/s over rad/s\].
const LEAST_SPIN: f64 = 0.02;

/// Places of the numbers: both matrices by rows, m/I_t, I_p/I_t, stiffness over mass and delay of each, how far the centre of mass lies from
/// where it is known, and by how much the second sensor is turned against the first.
const MATRICES: [usize; 2] = [0, 4];
const RATIO: usize = 8;
const POLAR: usize = 9;
const STIFFNESS: [usize; 2] = [10, 11];
const TAU_S: [usize; 2] = [12, 13];
const CENTRE_M: usize = 14;
const TURNED_RAD: usize = 15;
const NUMBERS: usize = 16;

/// The model.
pub(super) struct Rigid {
    sensors_m: [f64; 2],
    magnets_m: [f64; 2],
}

impl Rigid {
    fn new(of: &TwoPlanes) -> Self {
        Self {
            sensors_m: of.places.map(|place| place.sensor_m.into()),
            magnets_m: of.places.map(|place| place.magnet_m.into()),
        }
    }
}

impl Model for Rigid {
    fn residuals_m(&self, line: &Line, v: &[f64]) -> Vec<Complex64> {
        let [first, second] = self.sensors_m.map(|place| place - v[CENTRE_M]);
        let magnets = self.magnets_m.map(|place| place - v[CENTRE_M]);
        let (sin, cos) = v[TURNED_RAD].sin_cos();
        let back = |[x, y]: [Complex64; 2]| [x * cos + y * sin, y * cos - x * sin];
        let read = [line.position_m[0], back(line.position_m[1])];
        let rates = [line.rate_m_s[0], back(line.rate_m_s[1])];
        let felt = [line.acceleration_m_s2[0], back(line.acceleration_m_s2[1])];
        let apart_m = second - first;
        let slope = [0, 1].map(|axis| (read[1][axis] - read[0][axis]) / apart_m);
        let tilts = [0, 1].map(|axis| (rates[1][axis] - rates[0][axis]) / apart_m);
        // What each magnet does to a unit mass.
        let pushes = [0, 1].map(|j| {
            let [ux, uy] = line.force_n(j, v[TAU_S[j]]);
            let row = MATRICES[j];
            let kappa = v[STIFFNESS[j]];
            let there = [0, 1].map(|axis| read[0][axis] + slope[axis] * (magnets[j] - first));
            [
                ux * v[row] + uy * v[row + 1] - there[0] * kappa,
                ux * v[row + 2] + uy * v[row + 3] - there[1] * kappa,
            ]
        });
        let spin_rad_s = v[POLAR] * line.spin_rad_s;
        let gyroscopic = [-tilts[1] * spin_rad_s, tilts[0] * spin_rad_s];
        let square = line.omega_rad_s.powi(2);
        let mut left = Vec::with_capacity(4);
        for (i, place) in [first, second].into_iter().enumerate() {
            for axis in 0..2 {
                let pushed: Complex64 = (0..2)
                    .map(|j| pushes[j][axis] * (1.0 + place * magnets[j] * v[RATIO]))
                    .sum();
                left.push((felt[i][axis] - pushed - gyroscopic[axis] * place) / square);
            }
        }
        left
    }

    fn step(&self, number: usize, v: &[f64]) -> f64 {
        let least = match number {
            0..8 => 1e-9,
            RATIO => 1e-4,
            POLAR => 1e-6,
            10 | 11 => 1e-3,
            12 | 13 => 1e-9,
            _ => 1e-7,
        };
        (v[number].abs() * 1e-6).max(least)
    }
}

/// Which numbers a log can tell: the polar inertia at speed alone.
fn free(lines: &[Line], more: &[usize]) -> Vec<usize> {
    let turns = |line: &Line| line.spin_rad_s.abs() > LEAST_SPIN * line.omega_rad_s;
    let polar = lines.iter().any(turns).then_some(POLAR);
    let always = (0..=RATIO).chain(polar).chain(STIFFNESS).chain(TAU_S);
    always.chain(more.iter().copied()).collect()
}

/// What is found of a rotor by its lines.
pub(super) struct Fitted {
    pub(super) fit: Fit,
    /// The same with the centre of mass and the turn between the sensors free.
    more: Option<Fit>,
    pub(super) lines: Vec<Line>,
    pub(super) model: Rigid,
    polar: bool,
}

/// The fit, without windows in which something else moves the rotor.
pub(super) fn fitted(lines: &[Line], period_s: f64, of: &TwoPlanes) -> Result<Fitted, LogError> {
    let model = Rigid::new(of);
    let first = least(&model, lines, period_s)?;
    let lines = without_outliers(&model, lines, &first, 2 * LEAST_WINDOWS);
    let own = free(&lines, &[]);
    let problem = Problem {
        model: &model,
        lines: &lines,
        free: &own,
    };
    let values = problem.least(first).ok_or_else(unclear)?;
    if values[RATIO] <= 0.0 {
        return Err(LogError::new(
            "a force at one end tilts the rotor the wrong way, as if its transverse inertia were negative",
            "give the logs in the order of the scene's planes; check position_m of sensors and magnets in the scene",
        ));
    }
    let fit = problem.known(values, OF_FIT).ok_or_else(unclear)?;
    let narrow = [mass_kg, transverse_kg_m2].iter().all(|of| {
        let found = fit.found("", "", of);
        found.high - found.low <= 2.0 * WIDEST * found.value.abs()
    });
    if !narrow || unexplained(&model, &lines, &fit.values) > UNEXPLAINED {
        let LogError { message, help } = hidden();
        let order = "give the logs in the order of the scene's planes";
        return Err(LogError::new(message, format!("{order}; {help}")));
    }
    let wider = free(&lines, &[CENTRE_M, TURNED_RAD]);
    let wide = Problem {
        free: &wider,
        ..problem
    };
    let more = (wide.least(fit.values.clone())).and_then(|values| wide.known(values, OF_FIT));
    let polar = own.contains(&POLAR);
    Ok(Fitted {
        fit,
        more,
        polar,
        lines,
        model,
    })
}

fn unclear() -> LogError {
    LogError::new(
        "the rotor does not answer to the stimulus in a way that a rigid body in two planes explains",
        "let both axes of both planes be excited, at four frequencies at least; check names of planes and columns",
    )
}

/// For radii of gyration and delays what is linear; then all from where it is best. Ends that are exchanged look like a negative inertia.
fn least(model: &Rigid, lines: &[Line], period_s: f64) -> Result<Vec<f64>, LogError> {
    let own: Vec<Line> = (lines.iter())
        .filter(|line| line.weight > 0.0)
        .cloned()
        .collect();
    let all = free(lines, &[]);
    let linear: Vec<usize> = (all.iter().copied())
        .filter(|i| *i != RATIO && !TAU_S.contains(i))
        .collect();
    let coarse = Problem {
        model,
        lines: &own,
        free: &linear,
    };
    let [first, second] = model.sensors_m;
    let mut best: Option<(f64, Vec<f64>)> = None;
    for radius in RADII {
        for sign in [1.0, -1.0] {
            for delay in DELAYS {
                let mut start = vec![0.0; NUMBERS];
                start[RATIO] = sign / (radius * (second - first)).powi(2);
                for tau in TAU_S {
                    start[tau] = delay * period_s;
                }
                let Some(values) = coarse.stepped(&start, 0.0) else {
                    continue;
                };
                let cost = coarse.cost(&values);
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    best = Some((cost, values));
                }
            }
        }
    }
    let (_, start) = best.ok_or_else(unclear)?;
    let problem = Problem {
        model,
        lines,
        free: &all,
    };
    problem.least(start).ok_or_else(unclear)
}

/// Of one plane, of forces in newtons.
fn by_plane_kg(v: &[f64], plane: usize) -> f64 {
    let first = MATRICES[plane];
    1.0 / determinant(&v[first..first + 4]).abs().sqrt()
}

fn mass_kg(v: &[f64]) -> f64 {
    (by_plane_kg(v, 0) * by_plane_kg(v, 1)).sqrt()
}

fn transverse_kg_m2(v: &[f64]) -> f64 {
    mass_kg(v) / v[RATIO]
}

impl Fitted {
    /// What the fit says.
    pub(super) fn say(&self, of: &TwoPlanes, found: &mut Commissioned) {
        let fit = &self.fit;
        let mut put = |mut one: Found, why: &str| {
            one.from += why;
            found.parameters.push(one);
        };
        put(
            fit.found("mass_kg", "kg", mass_kg),
            ", if forces of both planes are in newtons",
        );
        put(
            fit.found("transverse_inertia_kg_m2", "kg m²", transverse_kg_m2),
            ", with places as in the scene",
        );
        if self.polar {
            let polar = |v: &[f64]| v[POLAR] * transverse_kg_m2(v);
            put(
                fit.found("polar_inertia_kg_m2", "kg m²", polar),
                ", at the spin of the log; negative where its sign is wrong",
            );
        }
        let ratio = |v: &[f64]| by_plane_kg(v, 0) / by_plane_kg(v, 1);
        put(
            fit.found("force_factor_ratio", "1", ratio),
            &format!(", {} over {}", of.names[1], of.names[0]),
        );
        for plane in [0, 1] {
            for one in self.of_plane(of, plane) {
                found.parameters.push(one);
            }
        }
        self.say_more(of, found);
        self.say_missing(of, found);
    }

    fn of_plane(&self, of: &TwoPlanes, plane: usize) -> Vec<Found> {
        let fit = &self.fit;
        let name = |name: &str| format!("{}.{name}", of.names[plane]);
        let place = of.places[plane];
        let moved = move |v: &[f64], at_m: f32, of_m: f32| {
            let (at_m, of_m) = (f64::from(at_m), f64::from(of_m));
            (1.0 + at_m * of_m * v[RATIO]) / mass_kg(v)
        };
        // As the supervisor has them of a shaft, in double precision.
        let own = move |v: &[f64]| moved(v, place.retainer_m, place.retainer_m);
        let mut all = vec![
            fit.found(name("mass_kg"), "kg", move |v| 1.0 / own(v)),
            fit.found(name("retainer_plane_ratio"), "1", move |v| {
                own(v) / moved(v, place.sensor_m, place.retainer_m)
            }),
            fit.found(name("magnet_plane_ratio"), "1", move |v| {
                moved(v, place.magnet_m, place.retainer_m) / own(v)
            }),
            fit.found(name("force_factor"), "1", |v| {
                of.mass_kg / by_plane_kg(v, plane)
            }),
            fit.found(name("magnet_stiffness_n_m"), "N/m", |v| {
                v[STIFFNESS[plane]] * mass_kg(v)
            }),
            fit.found(name("time_to_force_s"), "s", |v| v[TAU_S[plane]]),
        ];
        let [.., factor, _, late] = &mut all[..] else {
            return all;
        };
        factor.from += ", if the mass is the scene's: force for each newton that is commanded";
        late.from += "; from a command in the log to its force, as a lag: delay and lag together";
        all.extend(of_axes(fit, &name(""), MATRICES[plane]));
        all
    }

    /// Where the centre of mass lies and how the second sensor is turned, where both are known closely enough.
    fn say_more(&self, of: &TwoPlanes, found: &mut Commissioned) {
        let [first, second] = self.model.sensors_m;
        let centre = |v: &[f64]| v[CENTRE_M];
        let own = (self.more.as_ref()).map(|fit| fit.found("centre_of_mass_m", "m", centre));
        let close = |f: &Found| f.high - f.low <= 2.0 * WIDEST_CENTRE * (second - first).abs();
        match own.filter(close) {
            Some(mut own) => {
                own.from += ", from where the scene has it, places else as there";
                found.parameters.push(own);
            }
            None => found.not_found.push(Missing {
                name: "centre_of_mass_m".to_owned(),
                reason: "hidden by noise: record more windows of the stimulus in both planes"
                    .to_owned(),
            }),
        }
        if let Some(fit) = &self.more {
            let mut turned = fit.found("sensors_turned_rad", "rad", |v| v[TURNED_RAD]);
            turned.from += &format!(", axes of {} against those of {}", of.names[1], of.names[0]);
            found.parameters.push(turned);
        }
    }

    fn say_missing(&self, of: &TwoPlanes, found: &mut Commissioned) {
        let mut miss = |name: &str, reason: &str| {
            found.not_found.push(Missing {
                name: name.to_owned(),
                reason: reason.to_owned(),
            });
        };
        if !self.polar {
            miss(
                "polar_inertia_kg_m2",
                "shows by the gyroscopic moment alone: record it at speed, with spin_rad_s",
            );
        }
        miss(
            "amplifier_lag_s, delay_samples",
            "only their sum shows: take one from the drive's data",
        );
        miss(
            "force factors apart from the mass",
            "only the products show: weigh the rotor, or hang a known weight on it and log the commands before and after",
        );
        miss(
            "sensor_m and magnet_m of each plane",
            "a place shows as a gain or an inertia: measure them, or add a known disc at a known place and log again",
        );
        for plane in &of.names {
            let name = format!("{plane}.clearance_m, retainer centre");
            miss(
                &name,
                "shows at the wall alone: give the log of this plane by itself, with its walk as --walk",
            );
        }
    }
}
