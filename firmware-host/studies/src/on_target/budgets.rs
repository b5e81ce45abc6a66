//! Budgets of figures: ceilings that are required, and bounds on both sides of what the code needs now.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Why the budgets cannot be used.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum BudgetError {
    /// Not there, or not readable.
    #[error("{}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: std::io::Error,
    },
    /// Not what it should be.
    #[error("{}: {reason}", path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// What is wrong, with its place.
        reason: Box<toml::de::Error>,
    },
    /// Not writable.
    #[error("{}: {reason}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: std::io::Error,
    },
    /// Nothing for a target.
    #[error("{} has no table [budget.{name}.{number}]", path.display())]
    #[diagnostic(help("`firmware-host target --renew` adds it"))]
    None {
        /// The file.
        path: PathBuf,
        /// Processor.
        name: &'static str,
        number: &'static str,
    },
}

/// The figures that have budgets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figures {
    /// Most instructions of a tick.
    pub worst_instructions: u64,
    /// Half of the ticks have more.
    pub median_instructions: u64,
    /// Flash.
    pub text_bytes: u64,
    /// State without the recorder.
    pub ram_bytes: u64,
    /// Deepest stack of a tick.
    pub stack_bytes: u64,
}

impl Figures {
    fn named(&self) -> [(&'static str, u64); 5] {
        [
            ("worst_instructions", self.worst_instructions),
            ("median_instructions", self.median_instructions),
            ("text_bytes", self.text_bytes),
            ("ram_bytes", self.ram_bytes),
            ("stack_bytes", self.stack_bytes),
        ]
    }
}

/// Ceilings by the names of figures.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Required {
    #[serde(default)]
    worst_instructions: Option<u64>,
    #[serde(default)]
    median_instructions: Option<u64>,
    #[serde(default)]
    text_bytes: Option<u64>,
    #[serde(default)]
    ram_bytes: Option<u64>,
    #[serde(default)]
    stack_bytes: Option<u64>,
    /// Figures that are known to be above their ceilings.
    #[serde(default)]
    not_met: Vec<String>,
}

impl Required {
    fn of(&self, figure: &str) -> Option<u64> {
        match figure {
            "worst_instructions" => self.worst_instructions,
            "median_instructions" => self.median_instructions,
            "text_bytes" => self.text_bytes,
            "ram_bytes" => self.ram_bytes,
            "stack_bytes" => self.stack_bytes,
            _ => None,
        }
    }
}

/// By processor, then by number.
type Tables<T> = BTreeMap<String, BTreeMap<String, T>>;

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    least_share: f64,
    #[serde(default)]
    required: Tables<Required>,
    budget: Tables<Figures>,
}

/// The budgets of all targets.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Budgets {
    path: PathBuf,
    file: File,
}

/// A figure against its budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Verdict {
    pub figure: &'static str,
    /// What was measured.
    pub measured: u64,
    /// Least that passes: below, the budget is to be lowered.
    pub least: u64,
    /// Most that passes.
    pub budget: u64,
    /// Ceiling of the requirement, if there is one.
    pub required: Option<u64>,
    /// Whether the file says that the ceiling is not met.
    pub known_not_met: bool,
}

impl Verdict {
    /// Whether the ceiling holds, if there is one.
    pub fn met(&self) -> Option<bool> {
        self.required.map(|ceiling| self.measured <= ceiling)
    }

    /// What is wrong.
    pub fn failure(&self) -> Option<String> {
        let Self {
            figure,
            measured,
            least,
            budget,
            ..
        } = self;
        if measured > budget {
            return Some(format!(
                "{figure} is {measured}, above its budget of {budget}"
            ));
        }
        if measured < least {
            return Some(format!(
                "{figure} is {measured}, far below its budget of {budget}: lower that in budgets.toml"
            ));
        }
        match (self.met(), self.known_not_met) {
            (Some(false), false) => Some(format!(
                "{figure} is {measured}, above the {} that are required",
                self.required.unwrap_or_default()
            )),
            (Some(true) | None, true) => Some(format!(
                "{figure} meets its requirement: remove it from not_met in budgets.toml"
            )),
            _ => None,
        }
    }
}

impl Budgets {
    /// Reads the file.
    ///
    /// # Errors
    /// [`BudgetError`].
    pub(crate) fn load(path: &Path) -> Result<Self, BudgetError> {
        let text = std::fs::read_to_string(path).map_err(|reason| BudgetError::Read {
            path: path.to_owned(),
            reason,
        })?;
        Self::parse(path, &text)
    }

    fn parse(path: &Path, text: &str) -> Result<Self, BudgetError> {
        let path = path.to_owned();
        match toml::from_str(text) {
            Ok(file) => Ok(Self { path, file }),
            Err(reason) => Err(BudgetError::Parse {
                path,
                reason: Box::new(reason),
            }),
        }
    }

    /// Figures of a target against their budgets.
    ///
    /// # Errors
    /// [`BudgetError::None`].
    pub(crate) fn judge(
        &self,
        name: &'static str,
        number: &'static str,
        measured: &Figures,
    ) -> Result<Vec<Verdict>, BudgetError> {
        let budget = self.file.budget.get(name).and_then(|t| t.get(number));
        let budget = budget.ok_or_else(|| BudgetError::None {
            path: self.path.clone(),
            name,
            number,
        })?;
        let required = self.file.required.get(name).and_then(|t| t.get(number));
        let pairs = measured.named().into_iter().zip(budget.named());
        Ok(pairs
            .map(|((figure, measured), (_, budget))| Verdict {
                figure,
                measured,
                least: (budget as f64 * self.file.least_share).ceil() as u64,
                budget,
                required: required.and_then(|r| r.of(figure)),
                known_not_met: required.is_some_and(|r| r.not_met.iter().any(|n| n == figure)),
            })
            .collect())
    }
}

/// The text of the file with other figures in the `[budget.*]` tables of these targets; comments, ceilings and
/// everything else stay. A table that is missing comes to the end.
fn renewed(text: &str, targets: &[(&str, &str, Figures)]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (name, number, figures) in targets {
        let header = format!("[budget.{name}.{number}]");
        let Some(at) = lines.iter().position(|l| l.trim() == header) else {
            lines.extend([String::new(), header]);
            let values = figures
                .named()
                .map(|(key, value)| format!("{key} = {value}"));
            lines.extend(values);
            continue;
        };
        let table = (lines.iter_mut().skip(at + 1)).take_while(|l| !l.starts_with('['));
        for line in table {
            let (assignment, comment) = match line.split_once('#') {
                Some((assignment, comment)) => (assignment, format!(" #{comment}")),
                None => (line.as_str(), String::new()),
            };
            let key = assignment.split('=').next().unwrap_or_default().trim();
            if let Some((key, value)) = figures.named().into_iter().find(|(k, _)| *k == key) {
                *line = format!("{key} = {value}{comment}");
            }
        }
    }
    lines.join("\n") + "\n"
}

/// Puts measured figures into the file.
///
/// # Errors
/// [`BudgetError`].
pub fn renew(path: &Path, targets: &[(&str, &str, Figures)]) -> Result<(), BudgetError> {
    let read = |reason| BudgetError::Read {
        path: path.to_owned(),
        reason,
    };
    let text = std::fs::read_to_string(path).map_err(read)?;
    std::fs::write(path, renewed(&text, targets)).map_err(|reason| BudgetError::Write {
        path: path.to_owned(),
        reason,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "
        least_share = 0.9
        [required.M4F.f32]
        worst_instructions = 600
        stack_bytes = 512
        not_met = ['stack_bytes']
        [budget.M4F.f32]
        worst_instructions = 500
        median_instructions = 300
        text_bytes = 10000
        ram_bytes = 400
        stack_bytes = 1000
    ";

    fn failures(file: &str, edit: impl Fn(&mut Figures)) -> Vec<String> {
        let budgets = Budgets::parse(Path::new("budgets.toml"), file).unwrap();
        let mut measured = budgets.file.budget["M4F"]["f32"];
        edit(&mut measured);
        let verdicts = budgets.judge("M4F", "f32", &measured).unwrap();
        verdicts.iter().filter_map(Verdict::failure).collect()
    }

    #[test]
    fn a_budget_binds_on_both_sides() {
        assert_eq!(failures(FILE, |_| ()), [""; 0]);
        let [above] = &failures(FILE, |f| f.median_instructions = 301)[..] else {
            panic!()
        };
        assert!(above.contains("above its budget of 300"), "{above}");
        assert_eq!(failures(FILE, |f| f.median_instructions = 270), [""; 0]);
        let [below] = &failures(FILE, |f| f.median_instructions = 269)[..] else {
            panic!()
        };
        assert!(below.contains("lower that"), "{below}");
    }

    #[test]
    fn a_requirement_that_is_not_met_must_be_known_and_no_more_than_that() {
        let unknown = FILE.replace("['stack_bytes']", "[]");
        let [why] = &failures(&unknown, |_| ())[..] else {
            panic!()
        };
        assert!(why.contains("above the 512 that are required"), "{why}");
        let met = FILE.replace("stack_bytes = 1000", "stack_bytes = 500");
        let [why] = &failures(&met, |_| ())[..] else {
            panic!()
        };
        assert!(why.contains("remove it from not_met"), "{why}");
    }

    #[test]
    fn renewing_changes_figures_and_nothing_else() {
        let text = "# why\n[required.M4F.f32]\nstack_bytes = 512\n\n[budget.M4F.f32]\n# big\nworst_instructions = 500 # of many\nstack_bytes = 7\n\n[budget.M7.f32]\nstack_bytes = 8\n";
        let figures = Figures {
            worst_instructions: 400,
            median_instructions: 300,
            text_bytes: 200,
            ram_bytes: 100,
            stack_bytes: 50,
        };
        let new = renewed(text, &[("M4F", "f32", figures)]);
        let expected = text
            .replace("500 #", "400 #")
            .replace("stack_bytes = 7", "stack_bytes = 50");
        assert_eq!(new, expected);
        assert_eq!(renewed(&new, &[("M4F", "f32", figures)]), new);
        let more = renewed(text, &[("M0", "Q", figures)]);
        let table = more.strip_prefix(text).unwrap();
        assert!(
            table.starts_with("\n[budget.M0.Q]\nworst_instructions = 400\n"),
            "{table}"
        );
    }

    #[test]
    fn a_target_without_budgets_is_an_error() {
        let budgets = Budgets::parse(Path::new("budgets.toml"), FILE).unwrap();
        let figures = budgets.file.budget["M4F"]["f32"];
        assert!(budgets.judge("M3", "f32", &figures).is_err());
    }
}
