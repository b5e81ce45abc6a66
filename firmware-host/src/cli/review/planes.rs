//! Both planes of a rotor beside each other, for a person.

use super::tables::NOT_KNOWN;
use firmware_bench::record::shapes::Shapes;
use firmware_bench::record::story::{Event, Told};
use firmware_bench::report::lines::{Cell, Lines, lined, right};
use firmware_bench::report::plot::text::figures;

/// Name and text of a figure.
type Row = (&'static str, fn(&Told) -> String);

const ROWS: [Row; 11] = [
    ("outcome", |told| told.outcome.to_owned()),
    ("position unknown [ms]", |told| {
        figures(1e3 * told.position_unknown_s)
    }),
    ("touches", |told| {
        (told.touches).map_or(NOT_KNOWN.to_owned(), |n| n.to_string())
    }),
    ("in contact [ms]", |told| known(told.contact_s, 1e3)),
    ("hardest impact [m/s]", |told| {
        known(told.hardest_impact_m_s, 1.0)
    }),
    ("backward whirl recognised", |told| {
        let word = match told.whirled {
            Some(true) => "yes",
            Some(false) => "no",
            None => NOT_KNOWN,
        };
        word.to_owned()
    }),
    ("fastest backward motion [Hz]", |told| {
        known(told.max_whirl_hz, 1.0)
    }),
    ("of what the force arrests [%]", |told| {
        known(told.whirl_share, 100.0)
    }),
    ("severity of the event", |told| known(told.severity, 1.0)),
    ("in all, of its limit", |told| {
        format!(
            "{} of {}",
            figures(told.severity_index),
            figures(told.severity_limit)
        )
    }),
    ("landings", |told| told.landings.to_string()),
];

/// So many times a figure, where a reading carried it.
fn known(value: Option<f64>, times: f64) -> String {
    value.map_or(NOT_KNOWN.to_owned(), |value| figures(times * value))
}

/// What came of the event in each plane of a rotor; `None` for a record of one plane.
pub(super) fn figures_of_planes(event: &Event<'_>) -> Option<Lines> {
    if event.records[0].head.planes < 2 {
        return None;
    }
    let mut header = vec![Cell::new("figure")];
    header.extend((event.records.iter()).map(|r| right(format!("plane {}", r.head.plane))));
    let mut table = lined(header);
    let told = event.told_of_planes();
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
