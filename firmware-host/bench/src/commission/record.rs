//! What a flight record tells of its machine. It is of a touch-down and has no stimulus: contact shows in it, and of the levitated
//! machine what the few ticks before show.

use crate::commission::log::Log;
use crate::commission::{Commissioned, Found};
use crate::record::file::{PlaneRecord, RecordFile};
use crate::record::identify::Estimate;
use supervisor::{Mode, PARAMETERS};

/// Levitated ticks that noise is found in.
const LEAST_TICKS: usize = 32;
/// Numbers that need a stimulus.
const OF_STIMULUS: [&str; 4] = ["mass_kg", "stiffness_n_m", "time_to_force_s", "axes"];
/// And those of a rotor in two planes.
const OF_ROTOR: [&str; 2] = ["transverse_inertia_kg_m2", "polar_inertia_kg_m2"];

/// What a file of records tells, and what its supervisor was configured with.
#[derive(Debug, Clone, PartialEq)]
pub struct OfRecord {
    pub found: Commissioned,
    pub configured: Vec<(String, f64)>,
}

impl OfRecord {
    /// Of the last event of a file; `None` where it has none.
    pub fn new(file: &RecordFile) -> Option<Self> {
        let events = file.events();
        let event = events.last()?;
        let planes = event.records.len();
        let mut found = Commissioned::default();
        let mut configured = Vec::new();
        match event.findings() {
            Some(findings) => {
                let identified = findings.identified;
                let unclear = "its contacts do not show it closely enough: give the record of a longer touch-down";
                for (name, unit, estimate) in [
                    ("friction_coefficient", "1", identified.friction_coefficient),
                    ("restitution", "1", identified.restitution),
                    ("clearance_m", "m", identified.clearance_m),
                    ("eccentricity_m", "m", identified.eccentricity_m),
                ] {
                    match estimate {
                        Some(estimate) => found.parameters.push(of_contacts(name, unit, estimate)),
                        None => found.miss(name, unclear),
                    }
                }
            }
            None => found.miss(
                "friction_coefficient, restitution, clearance_m",
                "no flight between contacts of one plane is in it: give the record of a touch-down, of a machine in one plane",
            ),
        }
        for (number, record) in event.records.iter().enumerate() {
            let prefix = match planes {
                1 => String::new(),
                _ => format!("{number}."),
            };
            of_levitation(record, &prefix, &mut found);
            if let Some(config) = record.config {
                let values = PARAMETERS.iter().zip(config.values());
                configured
                    .extend(values.map(|(p, value)| (format!("{prefix}{}", p.name), value.into())));
            }
        }
        configured.push(("spin_sense".to_owned(), 1.0));
        let without = "a record has no stimulus: give the log of a levitated run in which the supervisor asked for it";
        let of_rotor = OF_ROTOR.iter().filter(|_| planes > 1);
        for name in OF_STIMULUS.iter().chain(of_rotor) {
            found.miss(*name, without);
        }
        Some(Self { found, configured })
    }
}

fn of_contacts(name: &str, unit: &'static str, Estimate { value, low, high }: Estimate) -> Found {
    Found {
        name: name.to_owned(),
        unit,
        value,
        low,
        high,
        from: "flights and contacts of the event".to_owned(),
    }
}

/// Noise and sense of the spin, from the levitated ticks that follow each other before the event.
fn of_levitation(record: &PlaneRecord, prefix: &str, found: &mut Commissioned) {
    let Some(config) = record.config.filter(|c| c.validate().is_ok()) else {
        return found.miss(
            format!("{prefix}sensor_noise_m"),
            "the record has no configuration, and so no units",
        );
    };
    let time_s = f64::from(config.scaling().time_s);
    let clearance_m = f64::from(config.clearance_m);
    let mut log = Log {
        period_s: config.sample_period_s.into(),
        ..Log::default()
    };
    let mut spins = Vec::new();
    let mut before: Option<u32> = None;
    for entry in record.entries.values() {
        let follows = before.is_none_or(|b| entry.sequence == b.wrapping_add(1));
        let position = entry.position.map(|bits| record.number(bits));
        let known = position.iter().all(|x| x.is_finite());
        if entry.mode != Mode::Levitated as u8 || !follows || !known {
            break;
        }
        before = Some(entry.sequence);
        log.position_m.push(position.map(|x| clearance_m * x));
        spins.push(record.number(entry.spin) / time_s);
    }
    let ticks = log.position_m.len();
    if ticks < LEAST_TICKS {
        let why = format!("{ticks} levitated ticks are in it, {LEAST_TICKS} at least are needed");
        found.miss(format!("{prefix}sensor_noise_m"), why);
    } else {
        found.of_noise(prefix, &log.position_m);
    }
    // Of one machine once.
    if prefix.is_empty() || prefix == "0." {
        let known = spins.iter().all(|spin| spin.is_finite());
        log.spin_rad_s = known.then_some(spins);
        found.of_spin(&log, 0..ticks);
    }
}
