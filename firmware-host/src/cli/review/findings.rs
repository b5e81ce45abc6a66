//! What is found out from an event, for a person.

use firmware_bench::record::file::PlaneRecord;
use firmware_bench::record::identify::{Estimate, Findings, Identified};
use firmware_bench::report::lines::{Cell, Lines, lined, right};
use firmware_bench::report::table::or_dash;

/// Name, unit, how many of it one of SI is, digits.
type Row = (
    &'static str,
    &'static str,
    f64,
    usize,
    fn(&Identified) -> Option<Estimate>,
);

const ROWS: [Row; 6] = [
    ("coefficient of friction", "", 1.0, 3, |i| {
        i.friction_coefficient
    }),
    ("restitution", "", 1.0, 2, |i| i.restitution),
    ("load along x", "N", 1.0, 0, |i| i.load_x_n),
    ("load along y", "N", 1.0, 0, |i| i.load_y_n),
    ("eccentricity", "µm", 1e6, 2, |i| i.eccentricity_m),
    ("clearance", "µm", 1e6, 1, |i| i.clearance_m),
];

/// With so many digits after the point; a zero has no sign.
fn whole(x: f64, digits: usize) -> String {
    let text = format!("{x:.digits$}");
    match text.trim_start_matches('-').trim_matches(['0', '.']) {
        "" => text.trim_start_matches('-').to_owned(),
        _ => text,
    }
}

/// Contacts, and what they tell of the machine, with captions.
pub(super) fn tables(
    findings: &Findings,
    record: &PlaneRecord,
    period_s: f64,
) -> [(&'static str, Lines); 2] {
    let mut contacts = lined([
        "contact from [ms]",
        "to [ms]",
        "normal speed [m/s]",
        "restitution",
        "friction/normal impulse",
    ]);
    let offset = record.tick_of(findings.first) as f64;
    for contact in &findings.contacts {
        let ms = |tick: f64| format!("{:.3}", 1e3 * period_s * (tick + offset));
        let impulse = contact.impulse.as_ref();
        let restitution = impulse
            .filter(|i| i.single)
            .map(|i| i.normal_m_s[1] / i.normal_m_s[0]);
        let friction = impulse.map(|i| i.over_mass_m_s[1] / i.over_mass_m_s[0]);
        contacts.add_row([
            right(ms(contact.from_tick)),
            right(ms(contact.to_tick)),
            right(or_dash(contact.normal_m_s, 1.0, 3)),
            right(or_dash(restitution, 1.0, 2)),
            right(or_dash(friction, 1.0, 3)),
        ]);
    }
    let mut machine = lined(["the machine, by this event", "value", "from", "to"]);
    for (name, unit, factor, digits, of) in ROWS {
        let name = match unit {
            "" => name.to_owned(),
            unit => format!("{name} [{unit}]"),
        };
        let estimate = of(&findings.identified);
        let mut row = vec![Cell::new(name)];
        match estimate {
            Some(Estimate { value, low, high }) => {
                row.extend([value, low, high].map(|x| right(whole(x * factor, digits))));
            }
            None => row.push(Cell::new("not identifiable")),
        }
        machine.add_row(row);
    }
    [
        ("Contacts that were found", contacts),
        ("The machine, by this event", machine),
    ]
}
