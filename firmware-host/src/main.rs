//! Command line of the host.

use clap::{CommandFactory, Parser, Subcommand};
use firmware_host::cli::{
    accuracy, advise, commission, completions, error, export, fmu, harm, init, map, modes, output,
    overloads, review, run, schema, screen, sensitivity, serve_controller, study, sweep, target,
    vectors,
};
use std::process::ExitCode;

/// Simulates AMB rotors on their retainer bearings with the supervisor in the loop.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write a commented scene of a machine from its numbers, to run and to change.
    Init(Box<init::InitArgs>),
    /// Run a scene under each of its policies; print a table, write traces and a report.
    Run(run::RunArgs),
    /// Run a scene again and again with keys that vary by a design, into one file with a row a run.
    Sweep(sweep::SweepArgs),
    /// Which impact a rotor bears without help, over two of its keys: a picture and a file.
    Map(map::MapArgs),
    /// Write a trace as CSV, or as MCAP for Foxglove; or the plant of a scene as matrices.
    Export(export::ExportArgs),
    /// Write plant, supervisor and closed loop of a scene as co-simulation units (FMI), for other simulation tools.
    Fmu(fmu::FmuArgs),
    /// Error against run time of a scene's plant, over tolerances and methods, and silently wrong runs.
    Accuracy(accuracy::AccuracyArgs),
    /// Run the catalogue of overloads under every policy, and hold the supervisor's promises against it.
    Overloads(overloads::OverloadsArgs),
    /// Compare the supervisor with levitation alone on machines drawn at random.
    Harm(harm::HarmArgs),
    /// Limits of a bearing in closed form, a suggested configuration of the supervisor, and what is weak.
    Advise(Box<advise::AdviseArgs>),
    /// Find the numbers of a machine in the log of a commissioning run, and compare them with what is configured.
    Commission(commission::CommissionArgs),
    /// Run a scene again and again with the supervisor told something wrong of its machine.
    Sensitivity(sensitivity::SensitivityArgs),
    /// Say what happened in a flight record that a supervisor has frozen on its machine, and replay it.
    Review(review::ReviewArgs),
    /// Print every key of scene files, as a JSON Schema for editors or as a table.
    Schema(schema::SchemaArgs),
    /// Natural frequencies of a rotor over its spin, critical speeds, response to its unbalance, coupling of its planes.
    Modes(modes::ModesArgs),
    /// Run one of the studies and hold its claims against what was measured; `study list` names them.
    Study(study::StudyArgs),
    /// Run the supervisor on emulated processors: bit for bit, instructions, sizes, closed loops.
    Target(target::TargetArgs),
    /// Print the script by which a shell completes commands and options.
    Completions(completions::CompletionsArgs),
    /// Serve the shared library of a scene's controller to the run that started this.
    #[command(hide = true)]
    ServeController(serve_controller::ServeArgs),
    /// Write samples with the commands that answer them as text, for a port to another language or processor.
    Vectors(vectors::VectorsArgs),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    serve_controller::by_this_program();
    screen::prepare();
    output::clean_up_on_interrupt();
    let result = match &cli.command {
        Command::Init(args) => init::execute(args),
        Command::Run(args) => run::execute(args),
        Command::Sweep(args) => sweep::execute(args),
        Command::Map(args) => map::execute(args),
        Command::Export(args) => export::execute(args),
        Command::Fmu(args) => fmu::execute(args),
        Command::Accuracy(args) => accuracy::execute(args),
        Command::Overloads(args) => overloads::execute(args),
        Command::Harm(args) => harm::execute(args),
        Command::Advise(args) => advise::execute(args),
        Command::Commission(args) => commission::execute(args),
        Command::Sensitivity(args) => sensitivity::execute(args),
        Command::Review(args) => review::execute(args),
        Command::Schema(args) => schema::execute(args),
        Command::Modes(args) => modes::execute(args),
        Command::Study(args) => study::execute(args),
        Command::Target(args) => target::execute(args),
        Command::Completions(args) => completions::execute(args, &Cli::command()),
        Command::ServeController(args) => serve_controller::execute(args),
        Command::Vectors(args) => vectors::execute(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let code = error.exit_code();
            error::explain(error);
            ExitCode::from(code)
        }
    }
}
