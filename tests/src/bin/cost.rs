//! Instructions that each combination of parts costs: `cost` prints the table, `cost --write` also puts
//! an excerpt into its page of the documentation and moves the golden bounds there.

use std::error::Error;
use system_tests::{cost, golden, root};

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    let write = match argument.as_deref() {
        // Under callgrind.
        Some("work") => {
            cost::work();
            return Ok(());
        }
        Some("--write") => true,
        None => false,
        Some(_) => return Err("usage: cost [--write]".into()),
    };
    if cfg!(debug_assertions) {
        return Err("counts are those of the release profile: cargo run --release".into());
    }
    let costs = cost::measure(&std::env::current_exe()?).map_err(|e| e.to_string())?;
    print!("{}", cost::table(&costs));
    for violation in cost::violations(&costs) {
        println!("{violation}");
    }
    if write {
        write_page(&cost::table(&cost::excerpt(&costs)))?;
        let rows = cost::golden_rows(&costs);
        let rows: Vec<_> = rows.iter().map(|(name, n)| (name.as_str(), *n)).collect();
        golden::rewrite("cost_of_parts", &rows, 0.03)?;
    }
    Ok(())
}

/// Replaces the table in the page, and the compiler's version above it.
fn write_page(table: &str) -> Result<(), Box<dyn Error>> {
    let path = root().join("docs/src/theory/cost-of-parts.md");
    let page = std::fs::read_to_string(&path)?;
    let toolchain = std::fs::read_to_string(root().join("rust-toolchain.toml"))?;
    let version = toolchain.split('"').nth(1).unwrap_or("unknown");
    let architecture = std::env::consts::ARCH;
    let (begin, end) = ("<!-- counted -->\n", "<!-- to here -->");
    let (before, rest) = page.split_once(begin).ok_or("no begin of the table")?;
    let (_, after) = rest.split_once(end).ok_or("no end of the table")?;
    let counted = format!("Counted with rustc {version} on {architecture}.\n\n{table}");
    std::fs::write(&path, format!("{before}{begin}{counted}{end}{after}"))?;
    Ok(())
}
