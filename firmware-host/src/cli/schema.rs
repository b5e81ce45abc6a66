//! `schema`: the keys of scene files, for editors and for people.

use crate::cli::error::{CommandError, pretty, print};
use firmware_bench::scene::schema::{json_schema, markdown_table};

/// Arguments of `schema`.
#[derive(Debug, Clone, clap::Args)]
pub struct SchemaArgs {
    /// Print a table in Markdown instead of the JSON Schema.
    #[arg(long)]
    pub table: bool,
}

/// Prints every key of scene files with type, unit, range, default and meaning.
///
/// # Errors
/// [`CommandError`] if nothing can be printed.
pub fn execute(args: &SchemaArgs) -> Result<(), CommandError> {
    print(&match args.table {
        true => markdown_table(),
        false => pretty(&json_schema(), "formatting the schema")? + "\n",
    })
}
