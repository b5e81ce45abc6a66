//! `vectors`: samples and the commands that answer them, as text for a port that has no Rust.

use crate::cli::error::{CommandError, print};
use crate::cli::output::{Staging, probe};
use firmware_studies::on_target::coverage::ways;
use firmware_studies::on_target::numbers::Number;
use firmware_studies::on_target::record::{Length, Stream};
use std::path::PathBuf;

/// Arguments of `vectors`.
#[derive(Debug, Clone, clap::Args)]
pub struct VectorsArgs {
    /// Where the files go.
    #[arg(long, value_name = "FOLDER", default_value = "runs/vectors")]
    pub out: PathBuf,
}

/// Records the short stream of `target` in both kinds of numbers, and writes it as tables of bits.
///
/// # Errors
/// [`CommandError`], with nothing written.
pub fn execute(args: &VectorsArgs) -> Result<(), CommandError> {
    probe(&args.out)?;
    let staging = Staging::for_folder(&args.out)?;
    let mut text = String::new();
    for number in [Number::Float, Number::Fixed] {
        let stream = Stream::record(number, Length::QUICK)
            .map_err(|e| CommandError::other("recording the streams", e))?;
        let name = number.name().to_lowercase();
        let [configurations, ticks] =
            ["configurations", "ticks"].map(|what| format!("{what}_{name}.csv"));
        staging.write_by(&configurations, |file| stream.write_configurations(file))?;
        staging.write_by(&ticks, |file| stream.write_ticks(file))?;
        text += &format!(
            "{configurations}, {ticks}: {} ticks in {} pieces, {} of {} ways from mode to mode\n",
            stream.ticks(),
            stream.pieces.len(),
            ways().count() - stream.coverage().missing_ways().len(),
            ways().count()
        );
    }
    let folder = staging.publish()?;
    print(&format!("{text}in {}\n", folder.display()))
}
