//! The critical impact speed of a scene's rotor over two of its keys; percentiles of it where others are known within limits only.

use crate::campaign::{Block, Chapter, Drawing, Figure, Page, Progress, each};
use crate::impacts::{Grid, critical_speeds_m_s};
use firmware_bench::report::plot::chart::{Axis, HeatMap};
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::spec::Spec;
use firmware_bench::sweep::design::Points;
use plant_model::V2;
use plant_model::analysis::impact::{
    Aim, Criterion, ImpactError, Search, Tried, critical_speed_m_s,
};
use plant_model::params::{PlantParams, SpinParams};

/// Steps of the search upwards, and width of its last bracket.
const SEARCH: Search = Search {
    step: 0.03,
    tolerance: 1e-4,
};
/// Searches that are run one by one, too.
const CHECKED: usize = 100;
/// Cells at most, each as often as it is drawn.
pub const MOST_CELLS: usize = 1_000_000;
/// Percentiles of a map with a spread: of a hundred machines so many bear less.
pub const PERCENTILES: [usize; 3] = [5, 50, 95];

/// The inclination of the impact into the direction of backward whirl \[°\], which is no key of a scene.
const INCLINATION: &str = "impact.inclination_deg";

/// A key that varies, as `friction.coefficient=0.05..0.6`.
#[derive(Debug, Clone, PartialEq)]
pub struct Varied {
    pub key: String,
    pub from: f64,
    pub to: f64,
}

/// Text that is no key with a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("expected KEY=FROM..TO with two numbers, FROM below TO, as friction.coefficient=0.05..0.6")]
pub struct NoRange;

impl std::str::FromStr for Varied {
    type Err = NoRange;

    fn from_str(text: &str) -> Result<Self, NoRange> {
        let (key, range) = text.split_once('=').ok_or(NoRange)?;
        let (from, to) = range.split_once("..").ok_or(NoRange)?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        let (from, to) = number(from).zip(number(to)).ok_or(NoRange)?;
        let key = key.trim().to_owned();
        (from < to).then_some(Self { key, from, to }).ok_or(NoRange)
    }
}

impl Varied {
    /// What lies so far along the range, from 0 to 1.
    fn at(&self, share: f64) -> f64 {
        self.from + (self.to - self.from) * share
    }
}

/// Keys that are known within limits only, every value between them as likely.
#[derive(Debug, Clone)]
pub struct Spread {
    pub keys: Vec<Varied>,
    /// Draws of each cell; all cells have the same, points of a Sobol sequence.
    pub draws: usize,
    /// Which of [`PERCENTILES`] the picture shows.
    pub shown: usize,
}

/// What a map is of.
#[derive(Debug, Clone)]
pub struct MapPlan {
    pub x: Varied,
    pub y: Varied,
    /// Cells along x and along y.
    pub cells: [usize; 2],
    pub spread: Option<Spread>,
    /// The spin is held at its start, whatever the scene says.
    pub held_spin: bool,
}

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub struct MapCell {
    pub x: f64,
    pub y: f64,
    /// Lowest impact speed that ends in backward whirl, or its [`PERCENTILES`] \[m/s\]; none where nothing up to twice what a single
    /// impact needs does, or no speed is critical.
    pub critical_m_s: Vec<Option<f64>>,
}

/// A map that has been run.
#[derive(Debug, Clone)]
pub struct Map {
    pub plan: MapPlan,
    /// Rows from the bottom, cells from left to right.
    pub cells: Vec<MapCell>,
    pub tried: Tried,
    /// What of the scene is not in an impact that is left to itself.
    pub left_out: Vec<&'static str>,
    /// Searches that were run one by one, too, and those of them that came to the same speed.
    pub checked: [usize; 2],
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// A cell is no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A key is given two values.
    #[error("{0} varies twice")]
    Twice(String),
    /// An impact does not come from inside.
    #[error("impact.inclination_deg lies between -90 and 90")]
    Inclination,
    /// A key changes nothing.
    #[error("{0} changes nothing of an impact that is left to itself")]
    Idle(String),
    /// The scene is of more than a point mass in one plane.
    #[error("a map is of a point mass in one plane, and this scene has {0}")]
    NotOfOnePlane(&'static str),
    /// A run that cannot be trusted.
    #[error("at x = {x}, y = {y}: {reason}")]
    Run { x: f64, y: f64, reason: ImpactError },
}

type Case = (PlantParams, Aim);

impl MapPlan {
    /// Columns of critical speeds.
    pub fn columns(&self) -> Vec<String> {
        match &self.spread {
            None => vec!["v_crit_m_s".to_owned()],
            Some(_) => PERCENTILES.map(|p| format!("v_crit_p{p}_m_s")).into(),
        }
    }

    /// Runs all cells, on the threads of the pool that it is called in.
    ///
    /// # Errors
    /// [`MapError`] of the first cell that has one.
    pub fn run(self, spec: &Spec, progress: &dyn Progress) -> Result<Map, MapError> {
        let keys: Vec<&Varied> = self.keys().collect();
        for (i, varied) in keys.iter().enumerate() {
            if keys[..i].iter().any(|other| other.key == varied.key) {
                return Err(MapError::Twice(varied.key.clone()));
            }
        }
        let quiet = spec.clone().without_warnings();
        if let Some(varied) = self.idle(&quiet)? {
            return Err(MapError::Idle(varied.key.clone()));
        }
        let left_out = left_out(&quiet)?;
        let places = self.places();
        let draws = self.draws();
        progress.begin((places.len() * draws.len()) as u64, "critical speeds");
        let drawn: Vec<_> = places
            .iter()
            .flat_map(|place| draws.iter().map(|draw| (*place, draw)))
            .collect();
        let cases = each(&drawn, |((x, y), draw)| {
            self.case(&quiet, &[&[*x, *y], draw.as_slice()].concat())
        });
        let cases = cases.into_iter().collect::<Result<Vec<Case>, MapError>>()?;
        let criterion = Criterion::default();
        let (found, tried) =
            critical_speeds_m_s(&cases, &SEARCH, &criterion, |n| progress.add(n as u64));
        let mut speeds = Vec::with_capacity(cases.len());
        for (((x, y), _), found) in drawn.iter().zip(found) {
            let (x, y) = (*x, *y);
            speeds.push(critical(found).map_err(|reason| match reason {
                ImpactError::Inclination => MapError::Inclination,
                reason => MapError::Run { x, y, reason },
            })?);
        }
        let step = cases.len().div_ceil(CHECKED);
        let sample: Vec<usize> = (0..cases.len()).step_by(step).collect();
        let alike = each(&sample, |i| {
            let (params, at) = &cases[*i];
            critical(critical_speed_m_s(params, *at, &SEARCH, &criterion)) == Ok(speeds[*i])
        });
        let checked = [sample.len(), alike.iter().filter(|alike| **alike).count()];
        let of_cells = places.iter().zip(speeds.chunks(draws.len()));
        let cells = of_cells.map(|(&(x, y), speeds)| MapCell {
            x,
            y,
            critical_m_s: if self.spread.is_some() {
                percentiles(speeds)
            } else {
                speeds.to_vec()
            },
        });
        Ok(Map {
            cells: cells.collect(),
            plan: self,
            tried,
            checked,
            left_out,
        })
    }

    fn spread_keys(&self) -> &[Varied] {
        self.spread.as_ref().map_or(&[], |spread| &spread.keys)
    }

    /// Of everything that varies: along x, along y, and what is spread.
    fn keys(&self) -> impl Iterator<Item = &Varied> {
        [&self.x, &self.y].into_iter().chain(self.spread_keys())
    }

    /// Middles of the cells, rows from the bottom.
    fn places(&self) -> Vec<(f64, f64)> {
        let [columns, rows] = self.cells;
        let shares = Grid { columns, rows }.places();
        let at = |(across, up)| (self.x.at(across), self.y.at(up));
        shares.into_iter().map(at).collect()
    }

    /// Values of the keys that are spread; one draw of nothing where none is.
    fn draws(&self) -> Vec<Vec<f64>> {
        let keys = self.spread_keys();
        let points = Points::sobol(
            self.spread.as_ref().map_or(1, |s| s.draws as u64),
            keys.len(),
            0,
        );
        (0..points.runs())
            .map(|run| {
                let shares = points.at(run).shares;
                keys.iter()
                    .zip(shares)
                    .map(|(key, share)| key.at(share))
                    .collect()
            })
            .collect()
    }

    /// The rotor with these values along x, along y, and of what is spread.
    fn case(&self, spec: &Spec, values: &[f64]) -> Result<Case, MapError> {
        let mut spec = spec.clone();
        let mut inclination_deg = 0.0;
        for (varied, value) in self.keys().zip(values) {
            match varied.key.as_str() {
                INCLINATION => inclination_deg = *value,
                key => spec.set(key, *value)?,
            }
        }
        let scene = spec.resolve()?;
        if scene.planes.len() != 1 {
            return Err(MapError::NotOfOnePlane("several"));
        }
        if scene.has_axis() {
            return Err(MapError::NotOfOnePlane("a rotor that tilts or bends"));
        }
        let mut params = scene.plant(0);
        // Its command is zero.
        params.magnet = None;
        if self.held_spin {
            params.spin = SpinParams::Held;
        }
        let aim = Aim {
            inclination_rad: inclination_deg.to_radians(),
            spin_rad_s: scene.start.spin_rad_s,
            spin_phase_rad: scene.start.spin_phase_rad,
        };
        Ok((params, aim))
    }

    /// A key that changes nothing of an impact that is left to itself: cells along it would say what is not so.
    fn idle(&self, spec: &Spec) -> Result<Option<&Varied>, MapError> {
        let keys: Vec<&Varied> = self.keys().collect();
        for (i, varied) in keys.iter().enumerate() {
            // The ends themselves need make no scene.
            let case = |share: f64| {
                let shares = keys
                    .iter()
                    .enumerate()
                    .map(|(j, _)| if i == j { share } else { 0.5 });
                let values: Vec<f64> = keys
                    .iter()
                    .zip(shares)
                    .map(|(key, share)| key.at(share))
                    .collect();
                self.case(spec, &values)
            };
            if case(0.3)? == case(0.7)? {
                return Ok(Some(varied));
            }
        }
        Ok(None)
    }
}

/// What of a scene is not in an impact that is left to itself.
fn left_out(spec: &Spec) -> Result<Vec<&'static str>, SceneError> {
    let scene = spec.resolve()?;
    let mut centres = scene.machine.planes.iter().map(|plane| plane.centre_m);
    let all = [
        (
            "weight",
            scene
                .planes
                .iter()
                .any(|plane| plane.weight_n != V2::zeros()),
        ),
        ("loads", scene.loads().next().is_some()),
        ("changes in the run", !scene.changes.is_empty()),
        (
            "the offset of the retainer",
            centres.any(|centre_m| centre_m != V2::zeros()),
        ),
    ];
    Ok(all
        .into_iter()
        .filter(|(_, is_there)| *is_there)
        .map(|(what, _)| what)
        .collect())
}

/// A rotor that nothing drives into whirl has no critical speed; of one that is driven from any speed it is zero.
fn critical(found: Result<Option<f64>, ImpactError>) -> Result<Option<f64>, ImpactError> {
    match found {
        Err(ImpactError::NoFriction) => Ok(None),
        Err(ImpactError::NotHeld) => Ok(Some(0.0)),
        found => found,
    }
}

/// Of speeds drawn; a rotor that nothing drives into whirl bears more than any other.
fn percentiles(speeds: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut ascending: Vec<f64> = speeds
        .iter()
        .map(|speed| speed.unwrap_or(f64::INFINITY))
        .collect();
    ascending.sort_by(f64::total_cmp);
    let of = |percentile: usize| {
        let rank = (percentile * ascending.len()).div_ceil(100).max(1);
        ascending
            .get(rank - 1)
            .copied()
            .filter(|speed| speed.is_finite())
    };
    PERCENTILES.map(of).into()
}

impl Map {
    /// What the picture shows of a cell.
    fn shown_m_s(&self, cell: &MapCell) -> Option<f64> {
        let column = self.plan.spread.as_ref().map_or(0, |spread| spread.shown);
        cell.critical_m_s.get(column).copied().flatten()
    }

    /// Lowest and highest critical speed that the picture shows \[m/s\].
    pub fn range_m_s(&self) -> Option<(f64, f64)> {
        let speeds = self.cells.iter().filter_map(|cell| self.shown_m_s(cell));
        speeds.fold(None, |range, v| {
            let (low, high) = range.unwrap_or((v, v));
            Some((f64::min(low, v), f64::max(high, v)))
        })
    }

    /// What the rotor bears, in a sentence.
    pub fn headline(&self) -> String {
        match (self.range_m_s(), self.percentile()) {
            (Some((low, high)), None) => {
                format!("The rotor bears impacts of {low:.4} to {high:.4} m/s.")
            }
            (Some((low, high)), Some(p)) => {
                format!("All but {p} of 100 such rotors bear impacts of {low:.4} to {high:.4} m/s.")
            }
            (None, None) => {
                "No impact of up to twice the speed that needs no bounce ends in backward whirl."
                    .to_owned()
            }
            (None, Some(p)) => format!(
                "Of 100 such rotors fewer than {p} can be driven into backward whirl by an impact."
            ),
        }
    }

    /// The percentile that the picture shows.
    fn percentile(&self) -> Option<usize> {
        self.plan
            .spread
            .as_ref()
            .map(|spread| PERCENTILES[spread.shown])
    }

    /// The map as a page.
    pub fn page(&self, scene: &str) -> Page {
        let plan = &self.plan;
        let (low, high) = self.range_m_s().unwrap_or((0.0, 1.0));
        // A few cells with the highest speeds would take all the colours.
        let mut all: Vec<f64> = self
            .cells
            .iter()
            .filter_map(|c| self.shown_m_s(c))
            .collect();
        all.sort_by(f64::total_cmp);
        let top = all.get((0.95 * all.len() as f64) as usize).copied();
        let axis = |varied: &Varied| Axis::linear(&varied.key, (varied.from, varied.to));
        let rows = self.cells.chunks(plan.cells[0]);
        let cells = rows.map(|row| {
            let speed = |cell: &MapCell| self.shown_m_s(cell).unwrap_or(f64::NAN);
            row.iter().map(speed).collect()
        });
        let label = match self.percentile() {
            None => "Critical impact speed".to_owned(),
            Some(percentile) => format!("Percentile {percentile} of the critical impact speed"),
        };
        let label = format!("{label} over {} and {}", plan.x.key, plan.y.key);
        let figure = Figure {
            file: "map".into(),
            caption: format!(
                "{label}; darker bears more. The highest twentieth has one colour; white: no impact of up to twice the speed that needs no bounce ends in whirl."
            ),
            drawing: Drawing::Map(HeatMap {
                label: label.clone(),
                x: axis(&plan.x),
                y: axis(&plan.y),
                names: Default::default(),
                scale: (
                    low,
                    top.unwrap_or(high).max(low + 1e-12),
                    "v_r,crit [m/s]".to_owned(),
                ),
                cells: cells.collect(),
            }),
        };
        let of = format!(
            "The lowest impact speed, left to itself, that ends in backward whirl: steps of 3 % upwards, then halving to 1e-4. {} cells of {scene}, {} impacts.",
            self.cells.len(),
            self.tried.impacts
        );
        Page {
            title: label,
            headline: self.headline(),
            lead: [Some(of), self.spread_text(), self.doubts()]
                .into_iter()
                .flatten()
                .map(Block::text)
                .collect(),
            chapters: vec![Chapter::new("Map", vec![Block::Figures(vec![figure])])],
        }
    }

    /// What is not in it, and what is not certain.
    pub fn doubts(&self) -> Option<String> {
        let left_out = (!self.left_out.is_empty()).then(|| {
            format!("Left out: {}. The rotor meets a wall around its middle with no force but those of shaft, wall and unbalance.", self.left_out.join(", "))
        });
        let undecided = (self.tried.undecided > 0).then(|| {
            format!(
                "{} impacts were not decided in the time they had and count as borne.",
                self.tried.undecided
            )
        });
        let all: Vec<String> = [left_out, undecided].into_iter().flatten().collect();
        (!all.is_empty()).then(|| all.join(" "))
    }

    /// What is known within limits only.
    fn spread_text(&self) -> Option<String> {
        let spread = self.plan.spread.as_ref()?;
        let range = |key: &Varied| format!("{} from {} to {}", key.key, key.from, key.to);
        Some(format!(
            "Each cell is drawn {} times, with {}, every value as likely.",
            spread.draws,
            spread.keys.iter().map(range).collect::<Vec<_>>().join(", ")
        ))
    }
}
