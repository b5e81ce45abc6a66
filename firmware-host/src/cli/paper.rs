//! `paper`: every number and figure of the paper, computed.

use crate::cli::error::{CommandError, pretty, print};
use crate::cli::output::{self, Staging};
use crate::cli::progress::{LateProgress, Threads};
use crate::cli::screen::tell;
use firmware_studies::campaign::{Extent, html};
use firmware_studies::paper::{Chapter, chapters, json, page, text};
use std::path::PathBuf;

/// Arguments of `paper`.
#[derive(Debug, Clone, clap::Args)]
pub struct PaperArgs {
    /// Folder for paper.html and paper.json.
    #[arg(long, default_value = "runs/paper")]
    pub out: PathBuf,
    /// Print the rows as JSON instead of tables.
    #[arg(long)]
    pub json: bool,
    /// Coarser curves and maps.
    #[arg(long)]
    pub quick: bool,
    /// How many threads it may use.
    #[command(flatten)]
    pub threads: Threads,
}

/// Computes every chapter and writes the page.
///
/// # Errors
/// [`CommandError`]; nothing is left behind then.
pub fn execute(args: &PaperArgs) -> Result<(), CommandError> {
    output::probe(&args.out)?;
    let bar = LateProgress::default();
    let chapters = (args
        .threads
        .pool()?
        .install(|| chapters(Extent::new(args.quick), &bar)))
    .map_err(|e| CommandError::other(e.name, e.reason))?;
    bar.finish();
    let said = written(args, &chapters)?;
    if args.json {
        return print(&said);
    }
    tell(&said)
}

/// Writes page and rows; what is printed.
fn written(args: &PaperArgs, chapters: &[Chapter]) -> Result<String, CommandError> {
    let rows = pretty(&json(chapters), "formatting paper.json")? + "\n";
    let page = html(&page(chapters)).map_err(|e| CommandError::other("drawing paper.html", e))?;
    let staging = Staging::for_folder(&args.out)?;
    for (name, content) in [("paper.json", &rows), ("paper.html", &page)] {
        staging.write(name, content)?;
    }
    let out = staging.publish()?;
    if args.json {
        return Ok(rows);
    }
    let page = out.join("paper.html");
    Ok(format!("{}\npage: {}\n", text(chapters), page.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use firmware_studies::paper::CHAPTERS;

    /// Of one chapter.
    #[test]
    fn json_is_printed_as_it_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let args = PaperArgs {
            out: folder.path().join("out"),
            json: true,
            quick: true,
            threads: Threads { threads: None },
        };
        let (_, limits) = CHAPTERS.iter().find(|(name, _)| *name == "limits").unwrap();
        let chapter = limits(Extent::Quick).unwrap();
        let said = written(&args, &[chapter]).unwrap();
        let file = std::fs::read_to_string(args.out.join("paper.json")).unwrap();
        assert!(said == file && said.contains("Upper whirl limit"), "{said}");
    }
}
