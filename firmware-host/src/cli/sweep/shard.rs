//! Parts of a sweep that run by themselves.

use crate::cli::error::CommandError;
use firmware_bench::sweep::plan::Plan;

/// Which part is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shard {
    /// Of so many, one by its number from 1.
    Of(Part),
    /// By what Slurm says to a task of a job array.
    Slurm,
}

/// A part of so many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// From 0.
    index: u64,
    count: u64,
}

impl Default for Shard {
    fn default() -> Self {
        Self::Of(Part { index: 0, count: 1 })
    }
}

pub(super) fn parse(text: &str) -> Result<Shard, String> {
    if text == "slurm" {
        return Ok(Shard::Slurm);
    }
    let numbers = text.split_once('/');
    let numbers = numbers.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    (numbers.and_then(|(number, count)| Part::new(number, count)))
        .map(Shard::Of)
        .ok_or_else(|| "expected I/N with I from 1 to N, as 2/8, or slurm".to_owned())
}

impl Part {
    /// Number from 1 to `count`.
    fn new(number: u64, count: u64) -> Option<Self> {
        (1..=count).contains(&number).then(|| Self {
            index: number - 1,
            count,
        })
    }

    /// Whether a chunk is its own. Parts take turns: chunks that take long are seldom beside each other by chance.
    pub(super) fn has(self, chunk: u64) -> bool {
        chunk % self.count == self.index
    }

    /// Its chunks.
    pub(super) fn chunks(self, plan: &Plan) -> impl Iterator<Item = u64> {
        (0..plan.chunks()).filter(move |chunk| self.has(*chunk))
    }
}

impl Shard {
    /// The part, by what the environment says where that is asked for.
    ///
    /// # Errors
    /// [`CommandError::Numbers`] outside a job array, and in one whose tasks are not numbered evenly.
    pub(super) fn resolve(
        self,
        variable: impl Fn(&str) -> Option<String>,
    ) -> Result<Part, CommandError> {
        let Self::Of(part) = self else {
            return slurm(variable);
        };
        Ok(part)
    }
}

fn slurm(variable: impl Fn(&str) -> Option<String>) -> Result<Part, CommandError> {
    let number = |name: &str| {
        let text = variable(name);
        (text.as_deref().and_then(|text| text.parse::<u64>().ok())).ok_or_else(|| {
            CommandError::Numbers {
                message: match text {
                    Some(text) => {
                        format!("--shard slurm: {name} is {text}, expected a whole number")
                    }
                    None => format!("--shard slurm: {name} is not set"),
                },
                help: "start it in a job array, sbatch --array=1-8; or say which part, --shard 2/8"
                    .to_owned(),
            }
        })
    };
    let (task, first) = (
        number("SLURM_ARRAY_TASK_ID")?,
        number("SLURM_ARRAY_TASK_MIN")?,
    );
    let count = number("SLURM_ARRAY_TASK_COUNT")?;
    let step = match variable("SLURM_ARRAY_TASK_STEP") {
        Some(_) => number("SLURM_ARRAY_TASK_STEP")?,
        None => 1,
    };
    let place = task.checked_sub(first).filter(|_| step > 0);
    let place = place
        .filter(|from| from % step == 0)
        .map(|from| from / step + 1);
    (place.and_then(|number| Part::new(number, count))).ok_or_else(|| CommandError::Numbers {
        message: format!(
            "--shard slurm: task {task} is none of {count} from {first} in steps of {step}"
        ),
        help: "give the array without gaps, sbatch --array=1-8; or say which part, --shard \"$SLURM_ARRAY_TASK_ID/8\""
            .to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_slurm(variables: &[(&str, &str)]) -> Option<Part> {
        let value = |name: &str| {
            let found = variables
                .iter()
                .find(|(key, _)| name == format!("SLURM_ARRAY_TASK_{key}"));
            found.map(|(_, value)| (*value).to_owned())
        };
        Shard::Slurm.resolve(value).ok()
    }

    #[test]
    fn parts_are_numbered_from_one() {
        assert_eq!(parse("2/8"), Ok(Shard::Of(Part { index: 1, count: 8 })));
        assert_eq!(parse("slurm"), Ok(Shard::Slurm));
        for text in ["0/8", "9/8", "1/0", "8", "-1/8", "a/b", ""] {
            assert!(parse(text).unwrap_err().contains("I/N"), "{text}");
        }
        let all: Vec<u64> = (0..3)
            .map(|i| {
                (0..20)
                    .filter(|c| Part { index: i, count: 3 }.has(*c))
                    .count() as u64
            })
            .collect();
        assert_eq!(all, [7, 7, 6]);
    }

    #[test]
    fn a_task_of_an_array_is_a_part() {
        let part = |index, count| Some(Part { index, count });
        assert_eq!(
            of_slurm(&[("ID", "3"), ("MIN", "1"), ("COUNT", "8")]),
            part(2, 8)
        );
        assert_eq!(
            of_slurm(&[("ID", "0"), ("MIN", "0"), ("COUNT", "8"), ("STEP", "1")]),
            part(0, 8)
        );
        assert_eq!(
            of_slurm(&[("ID", "14"), ("MIN", "10"), ("COUNT", "4"), ("STEP", "2")]),
            part(2, 4)
        );
        assert_eq!(of_slurm(&[("ID", "7"), ("MIN", "1"), ("COUNT", "3")]), None);
        assert_eq!(of_slurm(&[("ID", "7"), ("MIN", "1")]), None);
    }
}
