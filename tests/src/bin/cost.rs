//! Instructions that each combination of parts costs: `cost` prints the table, `cost --write` also moves the golden bounds there.

use std::error::Error;
use system_tests::{cost, golden};

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
        let rows = cost::golden_rows(&costs);
        let rows: Vec<_> = rows.iter().map(|(name, n)| (name.as_str(), *n)).collect();
        golden::rewrite("cost_of_parts", &rows, 0.03)?;
    }
    Ok(())
}
