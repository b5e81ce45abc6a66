//! `commission LOG`: the numbers of a machine from a recorded run in which its supervisor checked them.

use crate::cli::advise::Format;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::load;
use crate::cli::screen::tell;
use firmware_bench::commission::log::Log;
use firmware_bench::commission::{Commissioned, Found};
use firmware_bench::log_file::{LogError, Renamed};
use firmware_bench::report::lines::lined;
use std::path::{Path, PathBuf};
use supervisor::PARAMETERS;

/// Arguments of `commission`.
#[derive(Debug, Clone, clap::Args)]
pub struct CommissionArgs {
    /// Log of one plane, as CSV, Parquet, MAT or MCAP: t_s, measured_x_m, measured_y_m, commanded_x_n, commanded_y_n,
    /// stimulus_x_n, stimulus_y_n and perhaps spin_rad_s, a row a tick. A trace of run is one.
    pub log: PathBuf,
    /// A column of the log that has another name, and perhaps another unit, e.g. measured_x_m=x1_um*1e-6.
    #[arg(long, value_name = "NAME=COLUMN[*FACTOR]")]
    pub column: Vec<Renamed>,
    /// Log of a walk, the rotor slowly led along its retainer bearing all the way round: clearance and centre.
    #[arg(long, value_name = "LOG")]
    pub walk: Option<PathBuf>,
    /// Scene of the machine: what its supervisor is configured with is compared with what is found.
    #[arg(long, value_name = "SCENE")]
    pub machine: Option<PathBuf>,
    /// Plane of that scene, from 0 on.
    #[arg(long, default_value_t = 0, requires = "machine")]
    pub plane: usize,
    /// Print what is found of the configuration as it is written in firmware or a scene, in place of the tables.
    #[arg(long, value_enum, conflicts_with = "json")]
    pub format: Option<Format>,
    /// Print JSON instead of the tables.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command.
///
/// # Errors
/// [`CommandError`].
pub fn execute(args: &CommissionArgs) -> Result<(), CommandError> {
    let log = Log::read(&args.log, &args.column).map_err(|e| refused(&args.log, e))?;
    let mut commissioned = Commissioned::of(&log).map_err(|e| refused(&args.log, e))?;
    match &args.walk {
        Some(walk) => {
            let positions_m = Log::positions(walk, &args.column).map_err(|e| refused(walk, e))?;
            (commissioned.with_walk(&positions_m)).map_err(|e| refused(walk, e))?;
        }
        None => commissioned.without_walk(),
    }
    if let Some(machine) = &args.machine {
        commissioned.compare(&configured(machine, args.plane)?);
    }
    if args.json {
        return print(&(pretty(&commissioned, "formatting what was found")? + "\n"));
    }
    match args.format {
        Some(format) => print(&listing(&commissioned.parameters, format)),
        None => tables(&commissioned),
    }
}

fn refused(path: &Path, LogError { message, help }: LogError) -> CommandError {
    CommandError::Numbers {
        message: format!("{}: {message}", path.display()),
        help,
    }
}

/// What the supervisor of a plane is configured with, of what a log can tell.
fn configured(machine: &Path, plane: usize) -> Result<Vec<(&'static str, f64)>, CommandError> {
    let scene = load(machine)?;
    let config = scene.planes.get(plane).and_then(|plane| plane.supervisor);
    let config = config.ok_or_else(|| CommandError::Numbers {
        message: format!("{}: plane {plane} has no supervisor", machine.display()),
        help: "give a scene with a magnet in this plane".to_owned(),
    })?;
    let values = PARAMETERS.iter().zip(config.values());
    let mut known: Vec<(&'static str, f64)> = values
        .map(|(p, value)| (p.name, f64::from(value)))
        .collect();
    // Traces have the command in effect: what is left is the lag.
    known.push(("time_to_force_s", f64::from(config.amplifier_lag_s)));
    known.push(("axes_turned_rad", 0.0));
    known.push(("axes_handedness", 1.0));
    known.push(("spin_sense", 1.0));
    Ok(known)
}

fn listing(found: &[Found], format: Format) -> String {
    let of_config = found
        .iter()
        .filter(|f| PARAMETERS.iter().any(|p| p.name == f.name));
    let lines = of_config.map(
        |Found {
             name,
             unit,
             value,
             low,
             high,
             from,
         }| {
            let remark = format!("{unit}, {low:.4e} to {high:.4e}: {from}");
            match format {
                Format::Toml => format!("{name} = {value:.4e}  # {remark}\n"),
                Format::Rust => format!("    {name}: {value:.4e}, // {remark}\n"),
                Format::C => format!(
                    "config[AMB_P_{}] = {value:.4e}f; /* {remark} */\n",
                    name.to_uppercase()
                ),
            }
        },
    );
    let lines: String = lines.collect();
    match format {
        Format::Toml => format!("[supervisor]\n{lines}"),
        Format::Rust | Format::C => lines,
    }
}

fn tables(of: &Commissioned) -> Result<(), CommandError> {
    let number = |x: f64| format!("{x:.4e}");
    let columns = ["number", "unit", "value", "at least", "at most", "from"];
    let rows = of.parameters.iter().map(|f| {
        let cells = [f.value, f.low, f.high].map(number);
        let [value, low, high] = cells;
        vec![
            f.name.to_owned(),
            f.unit.to_owned(),
            value,
            low,
            high,
            f.from.clone(),
        ]
    });
    tell(&table(&columns, rows))?;
    if !of.contradictions.is_empty() {
        let columns = ["configured otherwise", "as", "at least", "at most"];
        let rows = of.contradictions.iter().map(|c| {
            let [configured, low, high] = [c.configured, c.low, c.high].map(number);
            vec![c.name.to_owned(), configured, low, high]
        });
        tell(&table(&columns, rows))?;
    }
    let rows = (of.not_found.iter()).map(|m| vec![m.name.to_owned(), m.reason.clone()]);
    tell(&table(&["not found", "why"], rows))
}

fn table(columns: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut lines = lined(columns);
    for row in rows {
        lines.add_row(row);
    }
    format!("{lines}\n")
}
