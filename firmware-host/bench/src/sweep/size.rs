//! How many runs a sweep has, by what its file says.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::sweep::design::{Design, MOST_RUNS, Points};
use crate::sweep::sobol::{SOBOL_DIMENSIONS, SOBOL_POINTS};
use crate::sweep::values::Variation;

/// Keys of a sweep file that say how large its design is.
pub(super) struct Sizes {
    pub(super) runs: Option<u64>,
    pub(super) repeats: Option<u64>,
}

impl Sizes {
    /// A key, what it is, and the designs that it goes with.
    fn given(&self) -> [(&'static str, Option<u64>, &'static [Design]); 2] {
        use Design::{Grid, LatinHypercube, MonteCarlo, Sobol};
        [
            ("runs", self.runs, &[LatinHypercube, Sobol, MonteCarlo]),
            ("repeats", self.repeats, &[Grid]),
        ]
    }
}

/// What a design asks for instead of a key that it has not.
fn instead(design: Design) -> &'static str {
    match design {
        Design::Grid => {
            "remove it: a grid has as many runs as combinations; repeats = 10 runs each ten times"
        }
        Design::LatinHypercube | Design::Sobol | Design::MonteCarlo => {
            "remove it, and give runs = 1000"
        }
    }
}

/// The runs.
pub(super) fn points(
    (design, seed): (Design, u64),
    sizes: &Sizes,
    variations: &[Variation],
    text: &SceneText,
) -> Result<Points, SceneError> {
    let refused = |key: &str, message: String, help: &str| {
        text.error_at_key(key, message, Some(help.to_owned()))
    };
    if seed > i64::MAX.cast_unsigned() {
        let message = "is too large".to_owned();
        return Err(refused("seed", message, "give a whole number below 2^63"));
    }
    for (key, given, designs) in sizes.given() {
        if let (Some(given), false) = (given, designs.contains(&design)) {
            let names: Vec<&str> = designs.iter().map(|design| design.name()).collect();
            let message = format!(
                "is {given}, but goes with {}, and not with {}",
                names.join(", "),
                design.name()
            );
            return Err(refused(key, message, instead(design)));
        }
    }
    let keys = variations.len();
    let within = |key: &str, given: Option<u64>, most: u64, why: &str| match given {
        None => {
            let message = format!("{key} is missing");
            let help = format!("give {key} = 1000");
            Err(text.error_at(0..0, message, Some(help)))
        }
        Some(given) if (1..=most).contains(&given) => Ok(given),
        Some(given) => Err(text.error_at_key(
            key,
            format!("is {given}, expected a whole number from 1 to {most}{why}"),
            Some(format!("give another number of {key}")),
        )),
    };
    let dimensions = |dimensions: usize| match dimensions > SOBOL_DIMENSIONS {
        true => {
            let message = format!(
                "{keys} keys vary, which takes {dimensions} dimensions; a Sobol sequence has {SOBOL_DIMENSIONS}"
            );
            Err(refused(
                "vary",
                message,
                "take latin_hypercube or monte_carlo",
            ))
        }
        false => Ok(()),
    };
    let points = match design {
        Design::Grid => return grid(sizes, seed, variations, text),
        Design::LatinHypercube => {
            Points::latin_hypercube(within("runs", sizes.runs, MOST_RUNS, "")?, keys, seed)
        }
        Design::MonteCarlo => {
            Points::monte_carlo(within("runs", sizes.runs, MOST_RUNS, "")?, keys, seed)
        }
        Design::Sobol => {
            let more = "; a latin_hypercube or monte_carlo has more";
            let runs = within("runs", sizes.runs, SOBOL_POINTS, more)?;
            dimensions(keys)?;
            Points::sobol(runs, keys, seed)
        }
    };
    match points.runs() {
        runs if runs > MOST_RUNS => {
            let message = format!("comes to {runs} runs, at most {MOST_RUNS}");
            Err(refused(
                "design",
                message,
                "take less of it, or vary fewer keys",
            ))
        }
        _ => Ok(points),
    }
}

fn grid(
    sizes: &Sizes,
    seed: u64,
    variations: &[Variation],
    text: &SceneText,
) -> Result<Points, SceneError> {
    let refused = |key: &str, message: String, help: &str| {
        text.error_at_key(key, message, Some(help.to_owned()))
    };
    let mut levels = Vec::new();
    for variation in variations {
        match variation.values.levels() {
            Some(count) => levels.push(count),
            None => {
                let message = format!(
                    "is a distribution of {}, and a grid has none",
                    variation.key
                );
                return Err(refused(
                    &variation.written_at,
                    message,
                    "give values, linspace or logspace, or take another design",
                ));
            }
        }
    }
    let points = Points::grid(levels, sizes.repeats.unwrap_or(1), seed);
    match points.runs() {
        0 => Err(refused(
            "repeats",
            "is 0".to_owned(),
            "give a whole number from 1",
        )),
        runs if runs > MOST_RUNS => {
            let message = format!("grid of {runs} combinations, at most {MOST_RUNS}");
            Err(refused(
                "design",
                message,
                "take fewer values, or another design",
            ))
        }
        _ => Ok(points),
    }
}
