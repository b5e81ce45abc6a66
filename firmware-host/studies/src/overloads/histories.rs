//! How near the reference is to the best possible: force histories laid down beforehand with the whole run
//! known, searched at speeds that the reference does not recover from.
//!
//! A history holds a force vector within the cap for each of [`PIECES`] stretches of time, as long together
//! as the arrest of a whirl takes twice; amplifier and plant are the same as for everybody. After it the
//! reference's law takes over: by then the impact is decided, and an AMB without feedback falls on its bearing.

use super::case::aimed;
use super::contenders::clairvoyant;
use super::cross_entropy::{Effort, maximise};
use super::impact::FIRST_M_S;
use super::plan::CatalogueError;
use super::sweeps::TIMED_SHARE;
use super::takeover::{ARRESTED, arrest_of};
use crate::machines::plants::plants;
use crate::machines::tuned_gains::stored;
use firmware_bench::run::clairvoyant::Clairvoyant;
use firmware_bench::run::closed_loop::{Keep, RunError, run_policy};
use firmware_bench::run::controller::Controller;
use firmware_bench::run::figures::Figures;
use firmware_bench::run::history::History;
use firmware_bench::run::outcome::Outcome;
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use plant_model::V2;
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering};

/// Stretches of a history.
pub const PIECES: usize = 50;
/// Speeds grow by this factor: a quarter of the catalogue's step.
const FINE: f64 = 1.0125;
/// A speed is given up after so many searches with different seeds.
const TRIES: u64 = 2;
/// What is left to come back in after the history \[s\].
const AFTER_S: f64 = 0.12;

const EFFORT: Effort = Effort {
    candidates: 480,
    best: 48,
    generations: 80,
    spread: 0.3,
    least_spread: 0.03,
};

/// Control rate of the experiment \[Hz\].
const RATE_HZ: f64 = 20_000.0;
/// Plants and angles to the normal of the wall \[°\].
pub const CASES: [(&str, f64); 4] = [
    ("P2", 0.0),
    ("P2", 30.0),
    ("P1 150 N", 0.0),
    ("P1 150 N", 30.0),
];

/// Where a search begins and what it varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
    /// Forces, from none at all.
    FromNothing,
    /// Forces, from what the reference asked for at the hardest impact that it recovers from.
    FromReference,
    /// Forces on top of the reference's, from none.
    OnTopOfReference,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 3] = [
        Self::FromNothing,
        Self::FromReference,
        Self::OnTopOfReference,
    ];
}

/// What one way found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Searched {
    /// Which.
    pub way: Way,
    /// Hardest impact with a history that recovers \[m/s\]; 0 if there was none.
    pub impact_m_s: f64,
    /// Runs that it took.
    pub runs: u64,
    /// The force of each sample of that history \[N\], within the cap.
    pub samples_n: Vec<[f64; 2]>,
}

/// One plant and angle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HistoryRow {
    /// Plant.
    pub plant: String,
    /// Control rate \[Hz\].
    pub rate_hz: f64,
    /// Angle to the normal of the wall \[°\].
    pub angle_deg: f64,
    /// Hardest impact that the reference recovers from, all slower ones of the grid too \[m/s\].
    pub clairvoyant_m_s: f64,
    /// What the searches found.
    pub searched: Vec<Searched>,
}

impl HistoryRow {
    /// The hardest impact that any history recovers from, over the reference's.
    pub fn best_over_clairvoyant(&self) -> f64 {
        let best = (self.searched.iter()).map(|s| s.impact_m_s);
        best.fold(self.clairvoyant_m_s, f64::max) / self.clairvoyant_m_s
    }
}

/// A history that was found: shares of the cap that the search varied, and the force of each sample \[N\].
type Laid = (Vec<f64>, Vec<V2>);

/// One impact that a history is searched for.
struct Impact<'a> {
    scene: &'a Scene,
    angle_deg: f64,
    law: Clairvoyant,
    cap_n: f64,
    /// Samples of each piece.
    held: usize,
}

impl Impact<'_> {
    fn held_s(&self) -> f64 {
        self.held as f64 / self.scene.sample_rate_hz
    }

    fn end_s(&self) -> f64 {
        self.held_s() * PIECES as f64
    }

    fn run(
        &self,
        speed_m_s: f64,
        controller: Box<dyn Controller>,
    ) -> Result<(Figures, Trace), RunError> {
        let scene = Scene {
            start: aimed(self.scene, speed_m_s, self.angle_deg),
            duration_s: self.end_s() + AFTER_S,
            ..self.scene.clone()
        };
        let acting = (controller, "history");
        run_policy(&scene, acting, Keep::TraceToDecision, &mut |_| {})
    }

    /// A history from shares of the cap, x and y in turn.
    fn history(&self, way: Way, shares: &[f64]) -> Box<dyn Controller> {
        let forces_n = (shares.chunks_exact(2)).map(|f| self.cap_n * V2::new(f[0], f[1]));
        let (held_s, law) = (self.held_s(), self.law.clone());
        let history = History::new(forces_n.collect(), held_s, law, self.cap_n);
        Box::new(match way {
            Way::OnTopOfReference => history.on_top(),
            _ => history,
        })
    }

    /// Forces that were asked for at the samples of the history \[N\].
    fn samples_n(&self, trace: &Trace) -> Vec<V2> {
        let samples = trace.rows.iter().filter(|row| !row.mode_change);
        let forces_n = samples.map(|row| row.commanded_n);
        forces_n.take(self.held * PIECES).collect()
    }

    /// What orders histories: one that recovers comes before one that does not, and has the smaller largest
    /// backward speed; then those without whirl, the slower the better where the history ends; then those
    /// that come to whirl, the later the better.
    fn score(&self, (verdict, trace): &(Figures, Trace)) -> f64 {
        let samples = trace.rows.iter().filter(|row| !row.mode_change);
        let (mut end_s, mut speed_m_s) = (0.0, 0.0);
        for row in samples {
            end_s = row.plant.t_s;
            if end_s <= self.end_s() {
                speed_m_s = row.plant.velocity_m_s.norm();
            }
        }
        match verdict.outcome {
            Outcome::Whirl => end_s - 1e3,
            _ if verdict.recovered => 1.0 / (1.0 + verdict.peak_backward_speed_m_s),
            _ => -speed_m_s,
        }
    }

    /// Hardest impact that the reference recovers from, all slower ones too \[m/s\], and its run.
    fn of_reference(&self) -> Result<(f64, Trace), RunError> {
        let mut last = (0.0, Trace::default());
        let mut speed = FIRST_M_S;
        loop {
            let policy = Box::new(self.law.clone());
            let (verdict, trace) = self.run(speed, policy)?;
            if !verdict.recovered {
                return Ok(last);
            }
            last = (speed, trace);
            speed *= FINE;
        }
    }

    /// Searches one way, upwards from a speed, until nothing is found at one.
    fn search(&self, way: Way, from_m_s: f64, mut start: Vec<f64>) -> Result<Searched, RunError> {
        let mut searched = Searched {
            way,
            impact_m_s: 0.0,
            runs: 0,
            samples_n: Vec::new(),
        };
        let mut speed = from_m_s;
        loop {
            let (found, runs) = self.search_at(speed, way, &start)?;
            searched.runs += runs;
            let Some((shares, samples_n)) = found else {
                return Ok(searched);
            };
            searched.impact_m_s = speed;
            searched.samples_n = samples_n.iter().map(|f| [f.x, f.y]).collect();
            start = shares;
            speed *= FINE;
        }
    }

    /// Searches at one speed: shares of the cap and forces of the samples \[N\] of a history that recovers, if
    /// one was found, and how many runs that took.
    fn search_at(
        &self,
        speed_m_s: f64,
        way: Way,
        start: &[f64],
    ) -> Result<(Option<Laid>, u64), RunError> {
        let runs = AtomicU64::new(0);
        for seed in 0..TRIES {
            let score = |shares: &[f64]| -> Result<f64, RunError> {
                runs.fetch_add(1, Ordering::Relaxed);
                Ok(self.score(&self.run(speed_m_s, self.history(way, shares))?))
            };
            // Many that recover: a start that is well inside for the next speed.
            let enough = |scores: &[f64]| scores[EFFORT.best - 1] > 0.0;
            let (score, shares) = maximise(start, (EFFORT, seed), &score, &enough)?;
            if score <= 0.0 {
                continue;
            }
            let (_, trace) = self.run(speed_m_s, self.history(way, &shares))?;
            let samples_n = self.samples_n(&trace);
            // What counts is the history alone, without the law on top of which it may have been found.
            let period_s = 1.0 / self.scene.sample_rate_hz;
            let alone = History::new(samples_n.clone(), period_s, self.law.clone(), self.cap_n);
            let (replayed, _) = self.run(speed_m_s, Box::new(alone))?;
            if replayed.recovered {
                return Ok((Some((shares, samples_n)), runs.into_inner()));
            }
        }
        Ok((None, runs.into_inner()))
    }

    /// Shares of the cap that the samples of a history come to, on average over each piece.
    fn shares(&self, samples_n: &[V2]) -> Vec<f64> {
        let mut shares = Vec::with_capacity(2 * PIECES);
        for piece in 0..PIECES {
            let from = (piece * self.held).min(samples_n.len());
            let to = ((piece + 1) * self.held).min(samples_n.len());
            let sum: V2 = samples_n[from..to].iter().sum();
            let mean = sum / ((to - from).max(1) as f64 * self.cap_n);
            shares.extend([mean.x, mean.y]);
        }
        shares
    }
}

/// Runs the experiment. `on_done` is called after each search.
///
/// # Errors
/// [`CatalogueError`].
pub fn compare(on_done: &dyn Fn(u64)) -> Result<Vec<HistoryRow>, CatalogueError> {
    let all = plants(RATE_HZ)?;
    let mut rows = Vec::new();
    for (name, angle_deg) in CASES {
        let missing = || CatalogueError::NotFound {
            plant: name.to_owned(),
            rate_hz: RATE_HZ,
        };
        let plant = all.iter().find(|p| p.name == name).ok_or_else(missing)?;
        let found = stored(name, RATE_HZ).ok_or_else(missing)?;
        let scene = &plant.scene;
        let arrest = arrest_of(scene, 0).ok_or_else(missing)?;
        let from_m_s = TIMED_SHARE * arrest.limit_m_s;
        let window_s = 2.0 * arrest.time_s(from_m_s, ARRESTED);
        let impact = Impact {
            scene,
            angle_deg,
            law: clairvoyant(found.impact_law, scene),
            cap_n: scene.force_max_n(0),
            held: (window_s * RATE_HZ / PIECES as f64).round().max(1.0) as usize,
        };
        let failed = |reason| CatalogueError::Run {
            plant: name.to_owned(),
            policy: "history",
            reason,
        };
        let (clairvoyant_m_s, trace) = impact.of_reference().map_err(failed)?;
        let mut searched = Vec::new();
        for way in Way::ALL {
            let (from_m_s, start) = match way {
                Way::FromNothing => (0.8 * clairvoyant_m_s, vec![0.0; 2 * PIECES]),
                Way::FromReference => (clairvoyant_m_s, impact.shares(&impact.samples_n(&trace))),
                Way::OnTopOfReference => (clairvoyant_m_s, vec![0.0; 2 * PIECES]),
            };
            searched.push(impact.search(way, from_m_s, start).map_err(failed)?);
            on_done(1);
        }
        rows.push(HistoryRow {
            plant: name.to_owned(),
            rate_hz: RATE_HZ,
            angle_deg,
            clairvoyant_m_s,
            searched,
        });
    }
    Ok(rows)
}
