//! A scene costs what it has: a part that is not there costs nothing, counted in instructions.

use std::path::Path;
use system_tests::cost::{self, Cost, CostError, Parts};
use system_tests::golden;

/// Without valgrind this is no failure on a user's machine; in CI it is.
fn counted() -> Option<Vec<Cost>> {
    if cfg!(debug_assertions) {
        eprintln!("skipped: counts are those of the release profile");
        return None;
    }
    match cost::measure(Path::new(env!("CARGO_BIN_EXE_cost"))) {
        Ok(costs) => Some(costs),
        Err(e @ CostError::NoValgrind) => {
            assert!(std::env::var_os("CI").is_none(), "{e}");
            eprintln!("skipped: {e}");
            None
        }
        Err(e) => panic!("{e}"),
    }
}

#[test]
fn a_part_that_is_missing_costs_nothing() {
    let Some(costs) = counted() else { return };
    assert_eq!(costs.len(), 36);
    let violations = cost::violations(&costs);
    assert!(
        violations.is_empty(),
        "{}\n{}",
        cost::table(&costs),
        violations.join("\n")
    );
    if cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        let rows = cost::golden_rows(&costs);
        let rows: Vec<_> = rows.iter().map(|(name, n)| (name.as_str(), *n)).collect();
        golden::compare("cost_of_parts", &rows).unwrap_or_else(|e| {
            panic!(
                "{e}\ncargo run --release -p system-tests --bin cost -- --write moves the bounds"
            )
        });
    }
}

/// The check finds a part that costs although it is missing.
#[test]
fn a_planted_cost_is_found() {
    let mut costs: Vec<Cost> = (Parts::every().into_iter())
        .map(|parts| Cost {
            parts,
            states: parts.states(),
            instructions: [100.0 + parts.0.map(f64::from).iter().sum::<f64>(); 3],
        })
        .collect();
    assert!(cost::violations(&costs).is_empty());
    // With nothing at all a series is dearer than with each one of four parts.
    costs[0].instructions[2] += 1.5;
    assert_eq!(cost::violations(&costs).len(), 4);
    // The same with and without: stator, spin, unbalance have terms, a magnet without lag has none.
    costs[0].instructions[2] -= 0.5;
    assert_eq!(cost::violations(&costs).len(), 3);
}
