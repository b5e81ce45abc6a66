//! Golden results: readable text tables with a bound on both sides, so that a result that becomes
//! better than its bound also fails, and the bound moves with the code.

use std::fmt::Write;
use std::path::{Path, PathBuf};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("golden")
        .join(format!("{name}.txt"))
}

/// Puts bounds of `relative` on either side of the measured values into `tests/golden/<name>.txt`;
/// comments stay.
///
/// # Errors
/// Of reading and writing the file.
pub fn rewrite(name: &str, measured: &[(&str, f64)], relative: f64) -> std::io::Result<()> {
    let text = std::fs::read_to_string(path(name))?;
    let mut table: String = text
        .split_inclusive('\n')
        .filter(|l| l.starts_with('#'))
        .collect();
    for (quantity, value) in measured {
        let (low, high) = (value * (1.0 - relative), value * (1.0 + relative));
        let _ = writeln!(
            table,
            "{quantity:<34} {:>8} {:>8}",
            low.floor(),
            high.ceil()
        );
    }
    std::fs::write(path(name), table)
}

/// Compares measured values with the table `tests/golden/<name>.txt`.
///
/// A row is `quantity low high`, then free text. Lines that start with `#` are comments.
///
/// # Errors
/// The whole table with what was measured and what is wrong with it.
pub fn compare(name: &str, measured: &[(&str, f64)]) -> Result<(), String> {
    let path = path(name);
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut report = format!(
        "{}\n{:<34}{:>14}{:>14}{:>16}\n",
        path.display(),
        "quantity",
        "low",
        "high",
        "measured"
    );
    let mut wrong = 0;
    let mut seen = Vec::new();
    for line in text
        .lines()
        .filter(|l| !l.starts_with('#') && !l.trim().is_empty())
    {
        let mut words = line.split_whitespace();
        let (Some(quantity), Some(low), Some(high)) = (words.next(), words.next(), words.next())
        else {
            return Err(format!("{}: not a row: {line}", path.display()));
        };
        let bound = |word: &str| {
            word.parse::<f64>()
                .map_err(|e| format!("{}: {word}: {e}", path.display()))
        };
        let (low, high) = (bound(low)?, bound(high)?);
        let value = measured
            .iter()
            .find(|(n, _)| *n == quantity)
            .map(|(_, v)| *v);
        let fits = value.is_some_and(|v| v >= low && v <= high);
        wrong += usize::from(!fits);
        seen.push(quantity.to_owned());
        let value = value.map_or("missing".to_owned(), |v| format!("{v:.6e}"));
        let mark = if fits { "" } else { "  <-- outside" };
        let _ = writeln!(
            report,
            "{quantity:<34}{low:>14.6e}{high:>14.6e}{value:>16}{mark}"
        );
    }
    for (name, value) in measured {
        if !seen.iter().any(|s| s == name) {
            wrong += 1;
            let _ = writeln!(report, "{name}: {value:.6e} has no row in the table");
        }
    }
    if wrong == 0 { Ok(()) } else { Err(report) }
}
