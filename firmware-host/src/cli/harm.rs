//! `harm`: the supervisor against levitation alone, on machines drawn at random.

use crate::cli::chapters;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::tell;
use firmware_studies::campaign::Block;
use firmware_studies::harm::conditions::Condition;
use firmware_studies::harm::events::Event;
use firmware_studies::harm::page::{lists, rows, table};
use firmware_studies::harm::plan::Plan;

/// Arguments of `harm`.
#[derive(Debug, Clone, clap::Args)]
pub struct HarmArgs {
    /// Machines of each class.
    #[arg(long, default_value_t = 40, value_name = "NUMBER", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub machines: u64,
    /// Seed of the draw: machines of another one nobody has seen.
    #[arg(long, default_value_t = 1, value_name = "NUMBER")]
    pub seed: u64,
    /// Only events whose name contains this.
    #[arg(long, default_value = "", value_name = "TEXT")]
    pub event: String,
    /// Only sensors whose name contains this.
    #[arg(long, default_value = "", value_name = "TEXT")]
    pub sensors: String,
    /// Print JSON instead of the table.
    #[arg(long)]
    pub json: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// Runs every class and prints a row of each.
///
/// # Errors
/// [`CommandError`] where nothing is left to run.
pub fn execute(args: &HarmArgs) -> Result<(), CommandError> {
    let events: Vec<Event> = (Event::ALL.into_iter())
        .filter(|event| event.name().contains(&args.event))
        .collect();
    let conditions: Vec<Condition> = (Condition::ALL.into_iter())
        .filter(|condition| condition.name().contains(&args.sensors))
        .collect();
    let none = |option: &str, text: &str, names: Vec<String>| CommandError::Numbers {
        message: format!("--{option} {text}: no name contains this"),
        help: format!("names are: {}", names.join("; ")),
    };
    if events.is_empty() {
        let names = Event::ALL.map(|event| event.name().to_owned());
        return Err(none("event", &args.event, names.to_vec()));
    }
    if conditions.is_empty() {
        let names = Condition::ALL.map(Condition::name);
        return Err(none("sensors", &args.sensors, names.to_vec()));
    }
    let plan = Plan::new(args.seed, args.machines, &events, &conditions);
    let progress = LateProgress::default();
    let runs = (args.threads.pool()?).install(|| plan.run(&progress));
    progress.finish();
    let rows = rows(&runs);
    if !args.json {
        let blocks = [table(&rows), Block::List(lists(&rows))];
        return tell(&chapters::of_blocks(&blocks));
    }
    let value = serde_json::json!({
        "seed": args.seed,
        "machines": args.machines,
        "rows": rows,
    });
    print(&(pretty(&value, "formatting the rows")? + "\n"))
}
