//! `paper`: the chapter on contact laws.

use firmware_studies::campaign::Extent;
use firmware_studies::paper::{CHAPTERS, Chapter};

fn chapter() -> Chapter {
    let (_, compute) = CHAPTERS.iter().find(|(n, _)| *n == "contact laws").unwrap();
    compute(Extent::Quick).unwrap()
}

#[test]
fn laws_differ_in_the_impact_and_agree_in_steady_whirl() {
    let started = std::time::Instant::now();
    let laws = chapter();
    println!("{} s", started.elapsed().as_secs_f64());
    for row in &laws.rows {
        println!(
            "{}: {:?} {} ({})",
            row.quantity, row.computed, row.unit, row.note
        );
    }
    for table in &laws.tables {
        println!("{}\n{:?}", table.caption, table.columns);
        for row in &table.rows {
            println!("{row:?}");
        }
    }
    let value = |quantity: &str| {
        let row = laws.rows.iter().find(|r| r.quantity == quantity);
        row.and_then(|r| r.computed)
            .unwrap_or_else(|| panic!("no {quantity}"))
    };
    // Black's limit, whatever the law; the force by the closed form.
    let whirl_hz = value("Whirl at held spin, Hunt and Crossley");
    assert!((whirl_hz / 734.6 - 1.0).abs() < 1e-4, "{whirl_hz}");
    let held = &laws.tables[2];
    for row in &held.rows {
        if row[2] == "slides" && row[4] != "–" {
            let [found, closed] = [3, 4].map(|i| row[i].parse::<f64>().unwrap());
            assert!((found / closed - 1.0).abs() < 1e-3, "{row:?}");
        }
    }
    let e = value("Restitution at a tenth of the speed");
    assert!(e > 0.95, "{e}");
    let again = chapter();
    assert_eq!((&laws.rows, &laws.tables), (&again.rows, &again.tables));
}
