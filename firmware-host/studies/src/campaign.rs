//! What every study is made of: cases that are run, claims about what came out, and a page that shows it.
//!
//! A study is a [`Study`]: a name and a function that runs its cases and returns a [`Report`]. How that is shown, as a table
//! for the terminal, JSON, HTML or Markdown for the documentation, is the same for all.
//!
//! ```
//! use firmware_studies::campaign::{
//!     Block, Chapter, Claim, Extent, Progress, Report, Study, StudyError, run_all,
//! };
//! use plant_model::contact::{damping_for_restitution, restitution_of};
//!
//! /// Damping and back, for three restitutions; with these, damping is the damping ratio.
//! fn there_and_back(_: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
//!     let cases = [0.3, 0.6, 0.9];
//!     let back = run_all(&cases, progress, |e| {
//!         damping_for_restitution(*e, 0.25, 1.0).map_or(f64::NAN, restitution_of)
//!     });
//!     let rows = cases.iter().zip(&back).map(|(e, back)| [e.to_string(), back.to_string()]);
//!     let off = cases.iter().zip(&back).map(|(e, back)| (e - back).abs());
//!     Ok(Report {
//!         title: "There and back".to_owned(),
//!         claims: vec![Claim::at_most("restitution, off", 1e-9, off.fold(0.0, f64::max))],
//!         cases: cases.len() as u64,
//!         classes: Vec::new(),
//!         chapters: vec![Chapter::new("All", vec![Block::table(["e", "back"], rows)])],
//!     })
//! }
//!
//! let study = Study {
//!     name: "there-and-back",
//!     about: "whether the damping ratio of a restitution has that restitution",
//!     run: there_and_back,
//!     drawn: None,
//!     on_record: None,
//! };
//! let report = (study.run)(Extent::Quick, &()).unwrap();
//! assert!(report.claims[0].holds && report.cases == 3);
//! ```
//!
//! Files, each importing only from those above it: `claim`, `chapter`, `html`, `markdown`.

mod chapter;
mod claim;
mod html;
mod markdown;

pub use self::chapter::{Block, Chapter, Drawing, Figure, Page, Table};
pub use self::claim::{CLAIM_COLUMNS, Claim, Side};
pub use self::html::html;
pub use self::markdown::digest;
use rayon::prelude::{IntoParallelIterator, ParallelIterator};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// How much is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Fewer cases or coarser grids: seconds to a minute.
    Quick,
    /// Everything: what the documentation shows.
    Full,
}

impl Extent {
    /// Quick where asked for.
    pub fn new(quick: bool) -> Self {
        if quick { Self::Quick } else { Self::Full }
    }

    /// One of two values.
    pub(crate) fn pick<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// Who is told how far a study is.
pub trait Progress: Sync {
    /// So many pieces of work begin.
    fn begin(&self, pieces: u64, what: &str);
    /// So many more are done.
    fn add(&self, pieces: u64);
}

/// Nobody is told.
impl Progress for () {
    fn begin(&self, _: u64, _: &str) {}
    fn add(&self, _: u64) {}
}

/// Why a study has no result.
pub type StudyError = Box<dyn std::error::Error + Send + Sync>;

/// Machines drawn at random; `None`: as the study has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Machines {
    /// Seed of the draw.
    pub seed: Option<u64>,
    /// Machines of each class.
    pub number: Option<u64>,
}

/// A study.
#[derive(Debug)]
pub struct Study {
    /// Its name, a word of the command line.
    pub name: &'static str,
    /// What it measures, in a line.
    pub about: &'static str,
    /// Runs it on the threads of the pool that it is called in.
    pub run: fn(Extent, &dyn Progress) -> Result<Report, StudyError>,
    /// The same on other machines, where they are drawn at random.
    pub drawn: Option<OnMachines>,
    /// The same on a record that was measured, where it compares with one; [`Self::run`] then says what it needs.
    pub on_record: Option<OnRecord>,
}

/// Runs a study on machines drawn at random.
pub(crate) type OnMachines = fn(Machines, Extent, &dyn Progress) -> Result<Report, StudyError>;

/// Runs a study on the record in a file.
pub type OnRecord = fn(&Path, Extent, &dyn Progress) -> Result<Report, StudyError>;

/// What came out of a study.
#[derive(Debug, Clone)]
pub struct Report {
    /// Title of its page.
    pub title: String,
    /// What is claimed, with what was measured.
    pub claims: Vec<Claim>,
    /// Runs or problems behind it.
    pub cases: u64,
    /// Rows behind the claims, of classes of runs or of quantities, as programs read them; a study may have none.
    pub classes: Vec<serde_json::Value>,
    /// What is shown beside the claims.
    pub chapters: Vec<Chapter>,
}

impl Report {
    /// As a page, the claims first. `command` is what repeats it.
    pub fn page(&self, command: &str) -> Page {
        let repeat = Block::text(format!("Written by `cargo run --release -- {command}`."));
        let kept = self.claims.iter().filter(|claim| claim.holds).count();
        let kept = format!(
            "{kept} of {} claims hold; {} cases.",
            self.claims.len(),
            self.cases
        );
        let claims = Chapter::new(
            "Claims",
            vec![Block::text(kept), claim::table(&self.claims)],
        );
        Page {
            title: self.title.clone(),
            headline: claim::conclusion(&self.claims, self.cases),
            lead: vec![repeat],
            chapters: [claims]
                .into_iter()
                .chain(self.chapters.iter().cloned())
                .collect(),
        }
    }
}

/// Runs every case on the threads of the pool that it is called in; results are in the order of the cases and do not
/// depend on how many threads there are.
pub fn run_all<C: Sync, R: Send>(
    cases: &[C],
    progress: &dyn Progress,
    run: impl Fn(&C) -> R + Sync,
) -> Vec<R> {
    progress.begin(cases.len() as u64, "runs");
    each(cases, |case| {
        let result = run(case);
        progress.add(1);
        result
    })
}

/// [`run_all`] without a word of its progress.
pub fn each<C: Sync, R: Send>(cases: &[C], run: impl Fn(&C) -> R + Sync) -> Vec<R> {
    let results: Vec<Mutex<Option<R>>> = cases.iter().map(|_| Mutex::new(None)).collect();
    on_threads(cases.len(), &|i| {
        *results[i].lock().unwrap_or_else(PoisonError::into_inner) = Some(run(&cases[i]));
    });
    let result = |cell: Mutex<Option<R>>| cell.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.into_iter().filter_map(result).collect()
}

/// Not generic: parallel iterators of their own for fifty kinds of cases were a quarter of what was compiled.
fn on_threads(count: usize, run: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(run);
}
