//! The critical impact speed of a scene's rotor over two of its keys.

use crate::campaign::{Block, Chapter, Drawing, Figure, Page, Progress};
use firmware_bench::report::plot::chart::{Axis, HeatMap};
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::spec::Spec;
use plant_model::analysis::impact::{
    Criterion, ImpactError, Search, Tried, critical_speed_m_s, critical_speeds_m_s,
};
use plant_model::params::{PlantParams, SpinParams};
use rayon::prelude::{IntoParallelRefIterator, ParallelIterator, ParallelSlice};

/// Steps of the search upwards, and width of its last bracket.
const SEARCH: Search = Search {
    step: 0.03,
    tolerance: 1e-4,
};
/// Cells that one thread takes together.
const CHUNK: usize = 200;
/// Cells that are run one by one, too.
const CHECKED: usize = 100;
/// Cells at most.
pub const MOST_CELLS: usize = 1_000_000;

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
    /// The middle of a cell.
    fn middle(&self, cell: usize, of: usize) -> f64 {
        self.from + (self.to - self.from) * (cell as f64 + 0.5) / of as f64
    }
}

/// What a map is of.
#[derive(Debug, Clone)]
pub struct MapPlan {
    pub x: Varied,
    pub y: Varied,
    /// Cells along x and along y.
    pub cells: [usize; 2],
    /// The spin is held at its start, whatever the scene says.
    pub held_spin: bool,
}

/// A cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapCell {
    pub x: f64,
    pub y: f64,
    /// Lowest impact speed that ends in backward whirl \[m/s\]; none where nothing up to twice what a single impact needs does, or
    /// no speed is critical.
    pub critical_m_s: Option<f64>,
}

/// A map that has been run.
#[derive(Debug, Clone)]
pub struct Map {
    pub plan: MapPlan,
    /// Rows from the bottom, cells from left to right.
    pub cells: Vec<MapCell>,
    pub tried: Tried,
    /// Cells that were run one by one, too, and those of them that came to the same speed.
    pub checked: [usize; 2],
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// A cell is no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene is of more than a point mass in one plane.
    #[error("a map is of a point mass in one plane, and this scene has {0}")]
    NotOfOnePlane(&'static str),
    /// A run that cannot be trusted.
    #[error("at x = {x}, y = {y}: {reason}")]
    Run { x: f64, y: f64, reason: ImpactError },
}

type Case = (PlantParams, (f64, f64));

impl MapPlan {
    /// Runs all cells, on the threads of the pool that it is called in.
    ///
    /// # Errors
    /// [`MapError`] of the first cell that has one.
    pub fn run(self, spec: &Spec, progress: &dyn Progress) -> Result<Map, MapError> {
        let [columns, rows] = self.cells;
        let places: Vec<(f64, f64)> = (0..rows)
            .flat_map(|j| (0..columns).map(move |i| (i, j)))
            .map(|(i, j)| (self.x.middle(i, columns), self.y.middle(j, rows)))
            .collect();
        progress.begin(places.len() as u64, "cells");
        let quiet = spec.clone().without_warnings();
        let cases = (places.par_iter())
            .map(|place| self.case(&quiet, *place))
            .collect::<Result<Vec<Case>, MapError>>()?;
        let criterion = Criterion::default();
        let chunks = cases.par_chunks(CHUNK).map(|chunk| {
            let done = critical_speeds_m_s(chunk, &SEARCH, &criterion);
            progress.add(chunk.len() as u64);
            done
        });
        let chunks: Vec<_> = chunks.collect();
        let mut tried = Tried::default();
        let mut cells = Vec::with_capacity(places.len());
        let found = chunks.into_iter().flat_map(|(found, of_chunk)| {
            tried.impacts += of_chunk.impacts;
            tried.by_lanes += of_chunk.by_lanes;
            found
        });
        for ((x, y), found) in places.into_iter().zip(found) {
            let critical_m_s = critical(found).map_err(|reason| MapError::Run { x, y, reason })?;
            cells.push(MapCell { x, y, critical_m_s });
        }
        let step = cells.len().div_ceil(CHECKED);
        let sample: Vec<usize> = (0..cells.len()).step_by(step).collect();
        let alike = sample.par_iter().filter(|i| {
            let (params, at) = &cases[**i];
            let alone = critical(critical_speed_m_s(params, *at, &SEARCH, &criterion));
            alone == Ok(cells[**i].critical_m_s)
        });
        let checked = [sample.len(), alike.count()];
        Ok(Map {
            plan: self,
            cells,
            tried,
            checked,
        })
    }

    fn case(&self, spec: &Spec, (x, y): (f64, f64)) -> Result<Case, MapError> {
        let mut spec = spec.clone();
        let mut inclination_deg = 0.0;
        for (varied, value) in [(&self.x, x), (&self.y, y)] {
            match varied.key.as_str() {
                INCLINATION => inclination_deg = value,
                key => spec.set(key, value)?,
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
        Ok((
            params,
            (inclination_deg.to_radians(), scene.start.spin_rad_s),
        ))
    }
}

/// A rotor that no speed drives into whirl has no critical one.
fn critical(found: Result<Option<f64>, ImpactError>) -> Result<Option<f64>, ImpactError> {
    match found {
        Err(ImpactError::NoThreshold) => Ok(None),
        found => found,
    }
}

impl Map {
    /// Lowest and highest critical speed \[m/s\].
    pub fn range_m_s(&self) -> Option<(f64, f64)> {
        let speeds = self.cells.iter().filter_map(|cell| cell.critical_m_s);
        speeds.fold(None, |range, v| {
            let (low, high) = range.unwrap_or((v, v));
            Some((f64::min(low, v), f64::max(high, v)))
        })
    }

    /// The map as a page.
    pub fn page(&self, scene: &str) -> Page {
        let plan = &self.plan;
        let (low, high) = self.range_m_s().unwrap_or((0.0, 1.0));
        // A few cells with the highest speeds would take all the colours.
        let mut all: Vec<f64> = self.cells.iter().filter_map(|c| c.critical_m_s).collect();
        all.sort_by(f64::total_cmp);
        let top = all.get((0.95 * all.len() as f64) as usize).copied();
        let axis = |varied: &Varied| Axis::linear(&varied.key, (varied.from, varied.to));
        let rows = self.cells.chunks(plan.cells[0]);
        let cells = rows.map(|row| {
            let speed = |cell: &MapCell| cell.critical_m_s.unwrap_or(f64::NAN);
            row.iter().map(speed).collect()
        });
        let label = format!(
            "Critical impact speed over {} and {}",
            plan.x.key, plan.y.key
        );
        let figure = Figure {
            file: "map",
            caption: format!(
                "{label}; darker bears more. The highest twentieth has one colour; white: no impact ends in whirl."
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
        let headline = match self.range_m_s() {
            Some((low, high)) => format!("The rotor bears impacts of {low:.4} to {high:.4} m/s."),
            None => "No impact ends in backward whirl.".to_owned(),
        };
        let of = format!(
            "The lowest impact speed, left to itself, that ends in backward whirl: steps of 3 % upwards, then halving to 1e-4. {} cells of {scene}, {} impacts.",
            self.cells.len(),
            self.tried.impacts
        );
        Page {
            title: label,
            headline,
            lead: vec![Block::text(of)],
            chapters: vec![Chapter::new("Map", vec![Block::Figures(vec![figure])])],
        }
    }
}
