//! Both planes of a rotor beside each other, for a person.

use firmware_bench::record::shapes::Shapes;
use firmware_bench::record::story::{Event, Told};
use firmware_bench::report::lines::{Cell, Lines, lined, right};
use firmware_bench::report::plot::text::figures;

/// Name and text of a figure.
type Row = (&'static str, fn(&Told) -> String);

const ROWS: [Row; 10] = [
    ("outcome", |told| told.outcome.to_owned()),
    ("touches", |told| told.touches.to_string()),
    ("in contact [ms]", |told| figures(1e3 * told.contact_s)),
    ("hardest impact [m/s]", |told| {
        figures(told.hardest_impact_m_s)
    }),
    ("backward whirl recognised", |told| {
        let word = if told.whirled { "yes" } else { "no" };
        word.to_owned()
    }),
    ("fastest backward motion [Hz]", |told| {
        figures(told.max_whirl_hz)
    }),
    ("of what the force arrests [%]", |told| {
        figures(100.0 * told.whirl_share)
    }),
    ("severity of the event", |told| figures(told.severity)),
    ("in all, of its limit", |told| {
        format!(
            "{} of {}",
            figures(told.severity_index),
            figures(told.severity_limit)
        )
    }),
    ("landings", |told| told.landings.to_string()),
];

/// What came of the event in each plane of a rotor; `None` for a record of one plane.
pub(super) fn figures_of_planes(event: &Event<'_>) -> Option<Lines> {
    if event.records[0].head.planes < 2 {
        return None;
    }
    let mut header = vec![Cell::new("figure")];
    header.extend((event.records.iter()).map(|r| right(format!("plane {}", r.head.plane))));
    let mut table = lined(header);
    let told: Vec<Option<Told>> = event.records.iter().map(|record| record.told()).collect();
    for (name, text) in ROWS {
        let cells = told
            .iter()
            .map(|told| told.as_ref().map_or("–".to_owned(), text));
        table.add_row([Cell::new(name)].into_iter().chain(cells.map(right)));
    }
    Some(table)
}

/// How both moved while one of them bounced or whirled.
pub(super) fn shapes(shapes: &Shapes) -> Lines {
    let mut table = lined([
        Cell::new("both planes in contact"),
        right("rms [µm]"),
        right("whirl, ccw [Hz]"),
    ]);
    let both = [
        ("together (cylindrical)", shapes.together),
        ("opposed (conical)", shapes.opposed),
    ];
    for (name, shape) in both {
        table.add_row([
            Cell::new(name),
            right(figures(1e6 * shape.rms_m)),
            right(figures(shape.whirl_hz)),
        ]);
    }
    table
}
