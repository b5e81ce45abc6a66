//! `harm`: the supervisor against levitation alone, on machines drawn at random.

use crate::cli::chapters;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::print_wrapped;
use firmware_studies::campaign::Block;
use firmware_studies::paired::harm::classes;
use firmware_studies::paired::plan::{Class, Plan, rows};
use firmware_studies::paired::row::{ClassName, lists, table};

/// Arguments of `harm`.
#[derive(Debug, Clone, clap::Args)]
pub struct HarmArgs {
    /// Machines of each class.
    #[arg(long, default_value_t = 40, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub machines: u64,
    /// Seed of the draw: machines of another one nobody has seen.
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    pub seed: u64,
    /// Only machines whose class contains this.
    #[arg(long, default_value = "", value_name = "TEXT")]
    pub class: String,
    /// Only events whose name contains this.
    #[arg(long, default_value = "", value_name = "TEXT")]
    pub event: String,
    /// Only sensors whose name contains this.
    #[arg(long, default_value = "", value_name = "TEXT")]
    pub sensors: String,
    /// Only configurations whose name contains this.
    #[arg(long, default_value = "", value_name = "TEXT")]
    pub configuration: String,
    /// Print JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// A word of the name of a class.
type NameOf = fn(ClassName) -> String;

/// Classes of which a name contains a text.
fn named(
    classes: Vec<Class>,
    (option, text): (&str, &str),
    of: NameOf,
) -> Result<Vec<Class>, CommandError> {
    let mut names: Vec<String> = Vec::new();
    let mut left = Vec::new();
    for class in classes {
        let name = of(class.name());
        if name.contains(text) {
            left.push(class);
        }
        if !names.contains(&name) {
            names.push(name);
        }
    }
    if left.is_empty() {
        return Err(CommandError::Numbers {
            message: format!("--{option} {text}: no name contains this"),
            help: format!("names are: {}", names.join("; ")),
        });
    }
    Ok(left)
}

/// Runs every class and prints a row of each.
///
/// # Errors
/// [`CommandError`] where nothing is left to run.
pub fn execute(args: &HarmArgs) -> Result<(), CommandError> {
    let mut classes = classes();
    let filters: [(&str, &str, NameOf); 4] = [
        ("class", &args.class, |name| name.machine),
        ("event", &args.event, |name| name.event),
        ("sensors", &args.sensors, |name| name.sensors),
        ("configuration", &args.configuration, |name| {
            name.configuration
        }),
    ];
    for (option, text, of) in filters {
        classes = named(classes, (option, text), of)?;
    }
    let plan = Plan {
        seed: args.seed,
        machines: args.machines,
        classes,
    };
    let progress = LateProgress::default();
    let cases = (args.threads.pool()?).install(|| plan.run(&progress));
    progress.finish();
    let rows = rows(&cases);
    if !args.json {
        let blocks = [table(&rows), Block::List(lists(&rows))];
        return print_wrapped(&chapters::of_blocks(&blocks));
    }
    let value = serde_json::json!({
        "seed": args.seed,
        "machines": args.machines,
        "rows": rows,
    });
    print(&(pretty(&value, "formatting the rows")? + "\n"))
}
