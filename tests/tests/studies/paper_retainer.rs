//! `paper`: retainer bearing.

use firmware_studies::campaign::Extent;
use firmware_studies::paper::{CHAPTERS, Chapter};

fn chapter() -> Chapter {
    let (_, compute) = (CHAPTERS
        .iter()
        .find(|(name, _)| *name == "retainer bearing"))
    .unwrap();
    compute(Extent::Quick).unwrap()
}

fn value(chapter: &Chapter, quantity: &str) -> f64 {
    let row = chapter.rows.iter().find(|r| r.quantity == quantity);
    row.and_then(|r| r.computed)
        .unwrap_or_else(|| panic!("no {quantity}"))
}

#[test]
fn retainer_bearing() {
    let chapter = chapter();
    let near = |quantity: &str, expected: f64, share: f64| {
        let found = value(&chapter, quantity);
        assert!(
            (found / expected - 1.0).abs() < share,
            "{quantity}: {found}"
        );
    };
    near("Fastest whirl in a bushing", 711.5, 1e-3);
    // A light race is held to its bound, and spares the stator; a heavy one is almost a bushing.
    near(
        "Race of 1e-3 kg m²: fastest whirl over the bound κ·ΩR/(κ + m·(R²/J_r + R_i²/J_i))",
        0.974,
        0.01,
    );
    near(
        "Race of 1e-3 kg m² over bushing: largest normal force in whirl",
        0.0363,
        0.02,
    );
    near(
        "Race of 1e-2 kg m² over bushing: fastest whirl",
        0.768,
        0.01,
    );
    assert!(value(&chapter, "Race of 1e-1 kg m² over bushing: fastest whirl") > 0.9);
    // Whether whirl starts at all: the bound for a hard contact; a race of usual weight changes nothing.
    near("The same with k_c = 1e11 N/m", 4.65e-4, 0.05);
    near(
        "Onset rig, race of 1e-3 kg m² over bushing: critical radial impact",
        1.0,
        1e-3,
    );
    // Drag that keeps a rolling whirl alive, from closed form, between two runs.
    let drags = &chapter.tables[1].rows;
    assert_ne!(drags[1][3], "lives on");
    assert_eq!(drags[2][3], "lives on");
    for row in &drags[2..] {
        let [found, closed] = [4, 5].map(|i: usize| row[i].parse::<f64>().unwrap());
        assert!((found / closed - 1.0).abs() < 0.01, "{row:?}");
    }
    assert!(
        value(
            &chapter,
            "No shaft stiffness, race of 1e-3 kg m²: whirl left after 0.5 s"
        ) > 1.0
    );
    // The first table has a row for the bushing and one for each race; every figure has its curves.
    assert_eq!(chapter.tables[0].rows.len(), 6);
    assert_eq!(chapter.figures.len(), 4);
}
