//! The configuration as it is written in a scene or in firmware.

use super::{Advice, Parameter};
use supervisor::{Config, DefaultRule, PARAMETERS, PlanePositions, Shaft};

/// What a simulated machine needs less than a real one.
const CHECK: &str = "check_first";

/// Where a configuration is written down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// The table of a scene.
    Toml,
    /// The struct of a firmware in Rust.
    Rust,
    /// The array of a firmware in C or C++.
    C,
}

/// The suggested configuration as a table for a scene, each value with its unit and how it was chosen.
pub fn table(parameters: &[Parameter]) -> String {
    let line = |p: &Parameter| {
        let own = p.replaced_by.map(decimal);
        let own = own.map_or(String::new(), |own| format!(" (this scene sets {own})"));
        Line {
            value: p.value,
            remark: format!("{}{own}", p.reason),
            ..Line::in_use(p)
        }
    };
    toml(parameters.iter().map(line))
}

/// The configuration that holds, with what the scene sets itself.
pub fn listing(parameters: &[Parameter], language: Language) -> String {
    let lines = parameters.iter().map(Line::in_firmware);
    match language {
        Language::Toml => toml(parameters.iter().map(Line::in_use)),
        Language::Rust => {
            let fields: String = lines.map(|line| line.rust_field()).collect();
            format!("static CONFIG: supervisor::Config = supervisor::Config {{\n{fields}}};\n")
        }
        Language::C => {
            let values: String = lines.map(|line| line.c_element(&line.c_index())).collect();
            format!(
                "static const float config[AMB_PARAMETERS] = {{\n{values}}};\n{}",
                order_in_c(parameters)
            )
        }
    }
}

/// C++ knows no designated elements, so that their order is compared instead.
fn order_in_c(parameters: &[Parameter]) -> String {
    let places: Vec<String> = (parameters.iter().enumerate())
        .map(|(i, p)| format!("{} == {i}", Line::in_use(p).c_index()))
        .collect();
    format!(
        "AMB_ASSERT(config_in_order,\n           {});\n",
        places.join(" &&\n           ")
    )
}

/// What `amb_rotor_init` takes: the shaft, and the configurations of both planes.
pub fn rotor_in_c(shaft: &Shaft, planes: [(&str, &[Parameter]); 2]) -> String {
    let pair = |of: fn(&PlanePositions) -> f32| {
        let [a, b] = shaft.places.each_ref().map(|place| c_number(of(place)));
        format!("{{{a}, {b}}}")
    };
    let values: String = (planes.iter().enumerate())
        .map(|(i, (name, parameters))| {
            let lines = parameters.iter().map(Line::in_firmware);
            let values: String = lines.map(|line| line.c_element(&line.c_index())).collect();
            format!("    /* plane {i}, {} */\n{values}", ascii(name))
        })
        .collect();
    format!(
        "static const amb_shaft shaft = {{\n    \
         {}, {}, {}, /* kg; kg m^2: transverse, polar */\n    \
         {}, {}, {}, /* m from the centre of mass: retainer bearings, sensors, magnets */\n}};\n\
         static const float config[2 * AMB_PARAMETERS] = {{\n{values}}};\n{}",
        c_number(shaft.mass_kg),
        c_number(shaft.transverse_inertia_kg_m2),
        c_number(shaft.polar_inertia_kg_m2),
        pair(|place| place.retainer_m),
        pair(|place| place.sensor_m),
        pair(|place| place.magnet_m),
        order_in_c(planes[0].1),
    )
}

/// The nine numbers of the bearing, and what of the configuration that holds does not follow from them. There is none for a scene,
/// whose other tables have the numbers.
pub fn short(advice: &Advice, language: Language) -> Option<String> {
    let bearing = advice.nominal.bearing();
    let follows = Config::for_bearing(&bearing).values();
    let rows = || (advice.parameters.iter().zip(PARAMETERS)).zip(follows);
    let given = rows().filter(|((_, p), _)| p.default == DefaultRule::Given);
    let given = given.map(|((row, _), value)| Line {
        value,
        remark: row.reason.clone(),
        ..Line::in_use(row)
    });
    let noise = Line {
        name: "sensor_noise_m",
        unit: "m",
        value: bearing.sensor_noise_m,
        remark: "noise (root mean square), with that of the converter's steps".to_owned(),
    };
    let given = given.chain([noise]);
    let otherwise: Vec<Line> = rows()
        .map(|((row, _), value)| (Line::in_firmware(row), value))
        .filter(|(line, value)| line.value != *value)
        .map(|(line, _)| line)
        .collect();
    Some(match language {
        Language::Toml => return None,
        Language::Rust => {
            let given: String = given.map(|line| line.rust_field()).collect();
            let follows = "supervisor::Config::for_bearing(&BEARING)";
            let config = match otherwise.as_slice() {
                [] => follows.to_owned(),
                lines => {
                    let fields: String = lines.iter().map(Line::rust_field).collect();
                    format!("supervisor::Config {{\n{fields}    ..{follows}\n}}")
                }
            };
            format!(
                "const BEARING: supervisor::Bearing = supervisor::Bearing {{\n{given}}};\n\
                 static CONFIG: supervisor::Config = {config};\n"
            )
        }
        Language::C => {
            let given: String = given.map(|line| line.c_element(line.name)).collect();
            let settings: String = otherwise.iter().map(Line::c_setting).collect();
            format!(
                "static const amb_bearing bearing = {{\n{given}}};\n\
                 /* The values for amb_init(). */\n\
                 static inline amb_code configure(float config[AMB_PARAMETERS]) {{\n\
                 \x20   const amb_code code = amb_config_for_bearing(&bearing, config, AMB_PARAMETERS);\n\
                 \x20   if (code != AMB_OK) return code;\n\
                 {settings}    return AMB_OK;\n}}\n"
            )
        }
    })
}

fn toml(lines: impl Iterator<Item = Line>) -> String {
    lines.fold("[supervisor]\n".to_owned(), |table, line| {
        let unit = if line.unit == "1" { "–" } else { line.unit };
        let setting = format!("{} = {}", line.name, decimal(line.value));
        table + &format!("{setting:<38}# {unit}; {}\n", line.remark)
    })
}

/// A value with its unit and a remark.
struct Line {
    name: &'static str,
    unit: &'static str,
    value: f32,
    remark: String,
}

impl Line {
    /// What holds on a machine, which has yet to confirm what it is said to be.
    fn in_firmware(p: &Parameter) -> Self {
        let rule = (PARAMETERS.iter().find(|rule| rule.name == p.name)).map(|rule| rule.default);
        match rule {
            Some(DefaultRule::Constant(value, why))
                if p.name == CHECK && p.replaced_by.is_none() =>
            {
                let remark = why.to_owned();
                Self {
                    value,
                    remark,
                    ..Self::in_use(p)
                }
            }
            _ => Self::in_use(p),
        }
    }

    /// What holds, suggested or set.
    fn in_use(p: &Parameter) -> Self {
        let (value, remark) = match p.replaced_by {
            None => (p.value, p.reason.clone()),
            Some(own) => {
                let suggested = decimal(p.value);
                (own, format!("set in the scene; suggested {suggested}"))
            }
        };
        Self {
            name: p.name,
            unit: p.unit,
            value,
            remark,
        }
    }

    /// Unit and remark for the compilers, which are not all told what a file is encoded in.
    fn comment(&self) -> String {
        ascii(&format!("{}; {}", self.unit, self.remark))
    }

    fn rust_field(&self) -> String {
        let field = format!("    {}: {},", self.name, with_point(self.value));
        format!("{field:<42}// {}\n", self.comment())
    }

    /// Name of its index in C.
    fn c_index(&self) -> String {
        format!("AMB_P_{}", self.name.to_uppercase())
    }

    /// An element of a list in C, under its name.
    fn c_element(&self, name: &str) -> String {
        let element = format!("    {},", c_number(self.value));
        format!("{element:<22}/* {name}: {} */\n", self.comment())
    }

    /// An assignment in C.
    fn c_setting(&self) -> String {
        let setting = format!("    config[{}] = {};", self.c_index(), c_number(self.value));
        format!("{setting:<56}/* {} */\n", self.comment())
    }
}

/// The text in ASCII, without what ends a comment.
fn ascii(text: &str) -> String {
    let written = |c: char| match c {
        '√' => "sqrt",
        '·' => "*",
        'π' => "pi",
        'ρ' => "rho",
        'µ' | 'μ' => "u",
        '²' => "^2",
        '³' => "^3",
        '×' => "x",
        '≤' => "<=",
        '≥' => ">=",
        '–' | '—' | '−' => "-",
        '…' => "...",
        _ => "?",
    };
    let mut written_text = String::with_capacity(text.len());
    for c in text.chars() {
        match c.is_ascii() {
            true => written_text.push(c),
            false => written_text.push_str(written(c)),
        }
    }
    written_text.replace("*/", "* /")
}

/// As Rust and C take it, to which one without a point is an integer.
fn with_point(value: f32) -> String {
    let number = decimal(value);
    match number.contains(['.', 'e']) {
        true => number,
        false => format!("{number}.0"),
    }
}

fn c_number(value: f32) -> String {
    with_point(value) + "f"
}

/// The shortest decimals that give the same value again.
fn decimal(value: f32) -> String {
    match value.abs() {
        0.0 | 1e-3..1e5 => value.to_string(),
        _ => format!("{value:e}"),
    }
}
