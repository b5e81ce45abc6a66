//! `optimum`: what any force could do, and what the supervisor does of it.

use firmware_studies::campaign::Extent;
use firmware_studies::optimum::study;

#[test]
fn the_supervisor_takes_most_of_what_any_force_could() {
    let report = study(Extent::Quick, &()).unwrap();
    assert_eq!(report.claims.len(), 9);
    for claim in &report.claims {
        assert!(claim.holds, "{}: {}", claim.name, claim.measured);
    }
    // Nobody does more than any force could, but for the grid of 5 % that closed loops are on.
    for claim in report
        .claims
        .iter()
        .filter(|c| c.name.contains("supervisor"))
    {
        assert!(claim.measured < 1.05, "{}: {}", claim.name, claim.measured);
    }
}
