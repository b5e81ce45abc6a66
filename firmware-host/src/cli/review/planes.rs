//! Both planes of a rotor beside each other, for a person.

use super::tables::NOT_KNOWN;
use firmware_bench::record::narrative::{Event, Narrative};
use firmware_bench::record::shapes::Shapes;
use firmware_bench::report::lines::{Cell, Lines, lined, right};
use firmware_bench::report::plot::text::figures;

/// Name and text of a figure.
type Row = (&'static str, fn(&Narrative) -> String);

const ROWS: [Row; 11] = [
    ("outcome", |plane| plane.outcome.to_owned()),
    ("position unknown [ms]", |plane| {
        figures(1e3 * plane.position_unknown_s)
    }),
    ("touches", |plane| {
        (plane.touches).map_or(NOT_KNOWN.to_owned(), |n| n.to_string())
    }),
    ("in contact [ms]", |plane| known(plane.contact_s, 1e3)),
    ("hardest impact [m/s]", |plane| {
        known(plane.hardest_impact_m_s, 1.0)
    }),
    ("backward whirl recognised", |plane| {
        let word = match plane.whirled {
            Some(true) => "yes",
            Some(false) => "no",
            None => NOT_KNOWN,
        };
        word.to_owned()
    }),
    ("fastest backward motion [Hz]", |plane| {
        known(plane.max_whirl_hz, 1.0)
    }),
    ("of what the force arrests [%]", |plane| {
        known(plane.whirl_share, 100.0)
    }),
    ("severity of the event", |plane| known(plane.severity, 1.0)),
    ("severity index, of its limit", |plane| {
        format!(
            "{} of {}",
            figures(plane.severity_index),
            figures(plane.severity_limit)
        )
    }),
    ("landings", |plane| plane.landings.to_string()),
];

/// So many times a figure, where a reading carried it.
fn known(value: Option<f64>, times: f64) -> String {
    value.map_or(NOT_KNOWN.to_owned(), |value| figures(times * value))
}

/// Outcome of the event in each plane of a rotor; `None` for a record of one plane.
pub(super) fn figures_of_planes(event: &Event<'_>) -> Option<Lines> {
    if event.records[0].head.planes < 2 {
        return None;
    }
    let mut header = vec![Cell::new("figure")];
    header.extend((event.records.iter()).map(|r| right(format!("plane {}", r.head.plane))));
    let mut table = lined(header);
    let narratives = event.narratives();
    for (name, text) in ROWS {
        let cells = narratives
            .iter()
            .map(|narrative| narrative.as_ref().map_or("–".to_owned(), text));
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
