//! A shaft of sections, also from a file: a row for each step of a drawing.

use super::{NOT_NEGATIVE, POSITIVE, rounded};
use crate::cli::error::CommandError;
use std::f64::consts::PI;
use std::path::Path;

/// What a scene assumes of a shaft.
const STEEL_KG_M3: f64 = 7850.0;
/// Finding the modes takes the third power of them.
const MOST_SECTIONS: usize = 200;

/// A section, with the keys of a scene beside length and diameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Section {
    pub(super) length_m: f64,
    pub(super) outer_diameter_m: f64,
    pub(super) others: Vec<(&'static str, f64)>,
}

impl Section {
    fn mass_kg(&self) -> f64 {
        let other = |key: &str, or: f64| {
            let found = self.others.iter().find(|(name, _)| *name == key);
            found.map_or(or, |(_, value)| *value)
        };
        let hollow = other("inner_diameter_m", 0.0);
        let area_m2 = 0.25 * PI * (self.outer_diameter_m.powi(2) - hollow.powi(2));
        other("density_kg_m3", STEEL_KG_M3) * area_m2 * self.length_m
    }
}

/// A disc on it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Disc {
    pub(super) position_m: f64,
    pub(super) mass_kg: f64,
    pub(super) transverse_inertia_kg_m2: f64,
    pub(super) polar_inertia_kg_m2: f64,
    /// Its inertias are made up.
    pub(super) assumed: bool,
}

/// A shaft with its discs, from its left end.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Shaft {
    pub(super) sections: Vec<Section>,
    pub(super) discs: Vec<Disc>,
}

impl Shaft {
    /// Of one diameter, of steel.
    pub(super) fn uniform(length_m: f64, outer_diameter_m: f64) -> Self {
        let only = Section {
            length_m,
            outer_diameter_m,
            others: Vec::new(),
        };
        Self {
            sections: vec![only],
            discs: Vec::new(),
        }
    }

    pub(super) fn length_m(&self) -> f64 {
        rounded(self.sections.iter().map(|s| s.length_m).sum(), 9)
    }

    pub(super) fn mass_kg(&self) -> f64 {
        let sections = self.sections.iter().map(Section::mass_kg);
        sections
            .chain(self.discs.iter().map(|disc| disc.mass_kg))
            .sum()
    }

    /// Its radius at a place; where two sections meet, that of the left one.
    pub(super) fn radius_at_m(&self, position_m: f64) -> Option<f64> {
        let mut end_m = 0.0;
        let at = self.sections.iter().find(|section| {
            end_m += section.length_m;
            position_m <= end_m
        });
        (at.or(self.sections.last())).map(|section| 0.5 * section.outer_diameter_m)
    }

    /// Reads a file of CSV whose first line names the columns.
    ///
    /// # Errors
    /// [`CommandError::Numbers`]: file, line and column of what is wrong.
    pub(super) fn read(path: &Path) -> Result<Self, CommandError> {
        read(path).map_err(|(message, help)| CommandError::Numbers {
            message: format!("--shaft-file {}: {message}", path.display()),
            help,
        })
    }
}

type Refused = (String, String);
type Rule = (fn(f64) -> bool, &'static str);

/// Columns by the names that a scene has for them. Those of the disc stand for one in the middle of its section.
const COLUMNS: [(&str, Rule); 9] = [
    ("length_m", POSITIVE),
    ("outer_diameter_m", POSITIVE),
    ("inner_diameter_m", NOT_NEGATIVE),
    ("density_kg_m3", POSITIVE),
    ("youngs_modulus_n_m2", POSITIVE),
    (
        "poisson_ratio",
        (|x| (0.0..=0.5).contains(&x), "a number from 0 to 0.5"),
    ),
    ("disc_mass_kg", POSITIVE),
    ("disc_transverse_inertia_kg_m2", NOT_NEGATIVE),
    ("disc_polar_inertia_kg_m2", NOT_NEGATIVE),
];
/// Of a section; the first two are needed.
const OF_A_SECTION: usize = 6;

fn read(path: &Path) -> Result<Shaft, Refused> {
    let names = COLUMNS.map(|(name, _)| name).join(",");
    let unreadable = |reason: String| {
        (
            reason,
            format!("give CSV with the columns {names}; all but the first two may be left out"),
        )
    };
    let bytes = std::fs::read(path).map_err(|e| unreadable(e.to_string()))?;
    // As spreadsheets begin a file.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let head = (text.split(|byte| *byte == b'\n')).find(|line| !line.starts_with(b"#"));
    let head = head.unwrap_or_default();
    let between = [b',', b';', b'\t']
        .into_iter()
        .find(|mark| head.contains(mark));
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(between.unwrap_or(b','))
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text);
    let head = reader.headers().map_err(|e| unreadable(e.to_string()))?;
    let mut columns = Vec::new();
    for name in head {
        let known = COLUMNS.iter().position(|(known, _)| *known == name);
        let known =
            known.ok_or_else(|| unreadable(format!("{name:?} is no column that it may have")))?;
        if columns.contains(&known) {
            return Err(unreadable(format!("two columns {name}")));
        }
        columns.push(known);
    }
    if let Some(lacking) = (0..2).find(|needed| !columns.contains(needed)) {
        return Err(unreadable(format!("no column {}", COLUMNS[lacking].0)));
    }
    let mut shaft = Shaft::default();
    for cells in reader.records() {
        let cells = cells.map_err(|e| unreadable(e.to_string()))?;
        let line = cells.position().map_or(0, csv::Position::line);
        let mut row = [None; COLUMNS.len()];
        for (&column, cell) in columns.iter().zip(&cells) {
            let (name, (may_be, expected)) = COLUMNS[column];
            row[column] = match cell {
                "" => None,
                cell => Some(cell.parse().ok().filter(|x| may_be(*x)).ok_or_else(|| {
                    let help = format!("give {expected}, with a point for decimals");
                    (
                        format!("line {line}: {name} is {cell:?}, expected {expected}"),
                        help,
                    )
                })?),
            };
        }
        let end_m = shaft.length_m();
        let (section, disc) = of_row(row, end_m)
            .map_err(|(message, help)| (format!("line {line}: {message}"), help))?;
        shaft.sections.push(section);
        shaft.discs.extend(disc);
        if shaft.sections.len() > MOST_SECTIONS {
            let message = format!("more than {MOST_SECTIONS} sections");
            return Err((
                message,
                "put sections of nearly the same diameter together".to_owned(),
            ));
        }
    }
    if shaft.sections.is_empty() {
        return Err(unreadable("no section".to_owned()));
    }
    Ok(shaft)
}

/// A section and its disc, from a row and where it begins.
fn of_row(
    row: [Option<f64>; COLUMNS.len()],
    begin_m: f64,
) -> Result<(Section, Option<Disc>), Refused> {
    let needed = |column: usize| {
        let (name, (_, expected)) = COLUMNS[column];
        row[column].ok_or_else(|| (format!("{name} is missing"), format!("give {expected}")))
    };
    let (length_m, outer_diameter_m) = (needed(0)?, needed(1)?);
    let others = COLUMNS.iter().zip(row).take(OF_A_SECTION).skip(2);
    let section = Section {
        length_m,
        outer_diameter_m,
        others: others
            .filter_map(|((name, _), value)| Some((*name, value?)))
            .collect(),
    };
    if let Some(inner) = row[2].filter(|inner| *inner >= outer_diameter_m) {
        let message = format!(
            "inner_diameter_m is {inner}, expected less than the outer one, {outer_diameter_m}"
        );
        return Err((message, "give diameters, both in m".to_owned()));
    }
    let disc = match (row[6], row[7], row[8]) {
        (None, None, None) => None,
        (Some(mass_kg), Some(transverse_inertia_kg_m2), Some(polar_inertia_kg_m2)) => Some(Disc {
            // Sums of decimal lengths are none themselves.
            position_m: rounded(begin_m + 0.5 * length_m, 9),
            mass_kg,
            transverse_inertia_kg_m2,
            polar_inertia_kg_m2,
            assumed: false,
        }),
        _ => {
            let message = "a disc without mass or one of its inertias".to_owned();
            let help = "give disc_mass_kg, disc_transverse_inertia_kg_m2 and disc_polar_inertia_kg_m2, or none of them; an inertia may be 0";
            return Err((message, help.to_owned()));
        }
    };
    Ok((section, disc))
}
