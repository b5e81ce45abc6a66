//! What was found, for a terminal and as a configuration.

use crate::cli::advise::Format;
use crate::cli::error::CommandError;
use crate::cli::screen::print_wrapped;
use firmware_bench::commission::{Commissioned, Found};
use firmware_bench::report::commission;
use firmware_bench::report::lines::lined;
use std::collections::BTreeSet;
use supervisor::PARAMETERS;

/// Numbers of a rotor that a scene and a shaft have, beside those of planes.
const OF_ROTOR: [&str; 3] = ["mass_kg", "transverse_inertia_kg_m2", "polar_inertia_kg_m2"];

/// What is found of the configuration, as it is written there.
pub(super) fn listing(found: &[Found], format: Format) -> String {
    let planes: BTreeSet<&str> = (found.iter())
        .filter_map(|f| Some(f.name.rsplit_once('.')?.0))
        .collect();
    if planes.is_empty() {
        let is_own = |name: &str| PARAMETERS.iter().any(|p| p.name == name);
        let lines: String = (found.iter())
            .filter(|f| is_own(&f.name))
            .map(|f| line(&f.name, f, format))
            .collect();
        return match format {
            Format::Toml => format!("[supervisor]\n{lines}"),
            Format::Rust | Format::C => lines,
        };
    }
    let opened = match format {
        Format::Toml => "[rotor]\n",
        Format::Rust => "// Of the shaft.\n",
        Format::C => "/* Of the shaft. */\n",
    };
    let rotor = (found.iter()).filter(|f| OF_ROTOR.contains(&&*f.name));
    let mut out = opened.to_owned();
    out.extend(rotor.map(|f| match format {
        Format::C => format!("shaft.{} = {:.4e}f; /* {} */\n", f.name, f.value, remark(f)),
        _ => line(&f.name, f, format),
    }));
    // Masses and ratios of planes follow from the shaft.
    for plane in planes
        .into_iter()
        .filter(|_| matches!(format, Format::Toml))
    {
        let name = format!("{plane}.magnet_stiffness_n_m");
        let Some(f) = found.iter().find(|f| f.name == name) else {
            continue;
        };
        let pull = Found {
            value: -f.value,
            low: -f.high,
            high: -f.low,
            ..f.clone()
        };
        out += &format!("[[plane]]\nname = {plane:?}\n[plane.magnet]\n");
        out += &line("negative_stiffness_n_m", &pull, format);
    }
    out
}

fn remark(f: &Found) -> String {
    format!("{}, {:.4e} to {:.4e}: {}", f.unit, f.low, f.high, f.from)
}

fn line(name: &str, f: &Found, format: Format) -> String {
    let (value, remark) = (f.value, remark(f));
    match format {
        Format::Toml => format!("{name} = {value:.4e}  # {remark}\n"),
        Format::Rust => format!("    {name}: {value:.4e}, // {remark}\n"),
        Format::C => format!(
            "config[AMB_P_{}] = {value:.4e}f; /* {remark} */\n",
            name.to_uppercase()
        ),
    }
}

/// Tables of what is found, what is configured otherwise, and what is not found.
pub(super) fn tables(of: &Commissioned) -> Result<(), CommandError> {
    let columns = ["number", "unit", "value", "at least", "at most", "from"];
    print_wrapped(&table(&columns, commission::number_rows(of)))?;
    if !of.contradictions.is_empty() {
        let columns = ["configured otherwise", "as", "at least", "at most", "costs"];
        print_wrapped(&table(&columns, commission::difference_rows(of)))?;
    }
    print_wrapped(&table(&["not found", "why"], commission::missing_rows(of)))
}

fn table(columns: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut lines = lined(columns);
    for row in rows {
        lines.add_row(row);
    }
    format!("{lines}\n")
}
