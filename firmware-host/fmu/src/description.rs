//! The description of a unit, `modelDescription.xml`.

use crate::base_units::{NAMES, base_units};
use crate::unit::{Unit, Version};
use crate::variable::{Enumeration, Kind, Role, Value, Variable};
use std::collections::BTreeSet;
use std::fmt::Write;

/// The text of the description. Version 2.0 has no whole numbers beyond 32 bits: a seed that is one is no parameter there.
pub(crate) fn description(unit: &Unit, version: Version, token: &str) -> String {
    let variables = unit.variables();
    let numbered: Vec<(usize, &Variable)> = (variables.iter().enumerate())
        .filter(|(_, v)| version == Version::Fmi3 || fits_32_bits(v))
        .collect();
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    head(&mut xml, unit, version, token);
    units(&mut xml, &numbered);
    types(&mut xml, &numbered, version);
    xml += "  <LogCategories>\n    <Category name=\"logStatusError\" description=\"why a call has failed\"/>\n  </LogCategories>\n";
    let scene = unit.scene();
    let (stop_s, period_s) = (scene.simulated_s(), unit.period_s());
    push(
        &mut xml,
        format_args!(
            "  <DefaultExperiment startTime=\"0.0\" stopTime=\"{stop_s:?}\" stepSize=\"{period_s:?}\"/>\n  <ModelVariables>\n"
        ),
    );
    for (reference, variable) in &numbered {
        match version {
            Version::Fmi3 => variable_3(&mut xml, *reference, variable),
            Version::Fmi2 => variable_2(&mut xml, *reference, variable),
        }
    }
    xml += "  </ModelVariables>\n";
    structure(&mut xml, &numbered, version);
    xml += "</fmiModelDescription>\n";
    xml
}

/// Writing to a string cannot fail.
fn push(xml: &mut String, text: std::fmt::Arguments<'_>) {
    let _never_fails = xml.write_fmt(text);
}

/// Whether a whole number is one of version 2.0's.
fn fits_32_bits(variable: &Variable) -> bool {
    match variable.start {
        Value::Int64(x) => i32::try_from(x).is_ok(),
        _ => true,
    }
}

fn head(xml: &mut String, unit: &Unit, version: Version, token: &str) {
    let which = unit.which();
    let scene = unit.scene();
    let (token_name, number) = match version {
        Version::Fmi3 => ("instantiationToken", "3.0"),
        Version::Fmi2 => ("guid", "2.0"),
    };
    let title = escaped(&scene.title);
    push(
        xml,
        format_args!(
            "<fmiModelDescription fmiVersion=\"{number}\" modelName=\"{title}: {name}\" {token_name}=\"{token}\" description=\"{about}\" \
             generationTool=\"firmware-host {program}\" license=\"MIT OR Apache-2.0\" variableNamingConvention=\"structured\">\n",
            name = which.name(),
            about = escaped(which.about()),
            program = env!("CARGO_PKG_VERSION"),
        ),
    );
    let several = unit.takes_several_samples();
    let fixed = match version {
        Version::Fmi3 => format!(" fixedInternalStepSize=\"{:?}\"", unit.period_s()),
        Version::Fmi2 => String::new(),
    };
    push(
        xml,
        format_args!(
            "  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"{several}\"{fixed}/>\n",
            which.name(),
        ),
    );
}

fn is_plain(unit: &str) -> bool {
    matches!(unit, "" | "1")
}

fn units(xml: &mut String, variables: &[(usize, &Variable)]) {
    let used = variables.iter().filter(|(_, v)| v.kind == Kind::Float64);
    let used: BTreeSet<&str> = used.map(|(_, v)| v.unit).filter(|u| !is_plain(u)).collect();
    *xml += "  <UnitDefinitions>\n";
    for unit in used {
        let Some(base) = base_units(unit) else {
            push(xml, format_args!("    <Unit name=\"{unit}\"/>\n"));
            continue;
        };
        push(xml, format_args!("    <Unit name=\"{unit}\"><BaseUnit"));
        for (name, exponent) in NAMES.iter().zip(base.exponents) {
            if exponent != 0 {
                push(xml, format_args!(" {name}=\"{exponent}\""));
            }
        }
        if base.factor != 1.0 {
            push(xml, format_args!(" factor=\"{:?}\"", base.factor));
        }
        *xml += "/></Unit>\n";
    }
    *xml += "  </UnitDefinitions>\n";
}

fn types(xml: &mut String, variables: &[(usize, &Variable)], version: Version) {
    let mut used: Vec<&Enumeration> = Vec::new();
    for (_, variable) in variables {
        match variable.kind {
            Kind::Enumeration(of) if !used.contains(&of) => used.push(of),
            _ => {}
        }
    }
    if used.is_empty() {
        return;
    }
    *xml += "  <TypeDefinitions>\n";
    for of in used {
        let (name, about) = (of.name, of.about);
        match version {
            Version::Fmi3 => push(
                xml,
                format_args!("    <EnumerationType name=\"{name}\" description=\"{about}\">\n"),
            ),
            Version::Fmi2 => push(
                xml,
                format_args!(
                    "    <SimpleType name=\"{name}\" description=\"{about}\"><Enumeration>\n"
                ),
            ),
        }
        for (value, item) in of.items.iter().enumerate() {
            push(
                xml,
                format_args!("      <Item name=\"{item}\" value=\"{value}\"/>\n"),
            );
        }
        *xml += match version {
            Version::Fmi3 => "    </EnumerationType>\n",
            Version::Fmi2 => "    </Enumeration></SimpleType>\n",
        };
    }
    *xml += "  </TypeDefinitions>\n";
}

/// Causality and variability.
fn causes(variable: &Variable) -> (&'static str, &'static str) {
    let varies = match variable.kind {
        Kind::Float64 => "continuous",
        _ => "discrete",
    };
    match variable.role {
        Role::Time => ("independent", "continuous"),
        Role::Fixed => ("parameter", "fixed"),
        Role::Tunable => ("parameter", "tunable"),
        Role::Input => ("input", varies),
        Role::Output => ("output", varies),
    }
}

fn start(variable: &Variable) -> Option<String> {
    if matches!(variable.role, Role::Time | Role::Output) {
        return None;
    }
    Some(match variable.start {
        Value::Float64(x) => format!("{x:?}"),
        Value::Int64(x) => x.to_string(),
        Value::UInt32(x) => x.to_string(),
        Value::Boolean(x) => x.to_string(),
    })
}

/// An attribute, where there is something to say.
fn attribute(name: &str, value: Option<&str>) -> String {
    value.map_or(String::new(), |value| {
        format!(" {name}=\"{}\"", escaped(value))
    })
}

fn unit_of(variable: &Variable) -> String {
    let is_number = variable.kind == Kind::Float64 && !is_plain(variable.unit);
    attribute("unit", is_number.then_some(variable.unit))
}

fn declared(variable: &Variable) -> String {
    match variable.kind {
        Kind::Enumeration(of) => attribute("declaredType", Some(of.name)),
        _ => String::new(),
    }
}

fn about(variable: &Variable) -> String {
    let about = variable.about.as_str();
    attribute("description", (!about.is_empty()).then_some(about))
}

fn variable_3(xml: &mut String, reference: usize, variable: &Variable) {
    let kind = match variable.kind {
        Kind::Float64 => "Float64",
        Kind::Int64 => "Int64",
        Kind::UInt32 => "UInt32",
        Kind::Boolean => "Boolean",
        Kind::Enumeration(_) => "Enumeration",
    };
    let (causality, variability) = causes(variable);
    push(
        xml,
        format_args!(
            "    <{kind} name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\" variability=\"{variability}\"{declared}{unit}{start}{about}/>\n",
            name = escaped(&variable.name),
            declared = declared(variable),
            unit = unit_of(variable),
            start = attribute("start", start(variable).as_deref()),
            about = about(variable),
        ),
    );
}

fn variable_2(xml: &mut String, reference: usize, variable: &Variable) {
    let kind = match variable.kind {
        Kind::Float64 => "Real",
        Kind::Int64 | Kind::UInt32 => "Integer",
        Kind::Boolean => "Boolean",
        Kind::Enumeration(_) => "Enumeration",
    };
    let (causality, variability) = causes(variable);
    push(
        xml,
        format_args!(
            "    <ScalarVariable name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\" variability=\"{variability}\"{about}><{kind}{declared}{unit}{start}/></ScalarVariable>\n",
            name = escaped(&variable.name),
            about = about(variable),
            declared = declared(variable),
            unit = unit_of(variable),
            start = attribute("start", start(variable).as_deref()),
        ),
    );
}

fn structure(xml: &mut String, variables: &[(usize, &Variable)], version: Version) {
    let outputs = variables.iter().enumerate();
    let outputs = outputs.filter(|(_, (_, v))| v.role == Role::Output);
    let outputs: Vec<(usize, usize)> = outputs
        .map(|(at, (reference, _))| (at + 1, *reference))
        .collect();
    *xml += "  <ModelStructure>\n";
    match version {
        Version::Fmi3 => {
            for element in ["Output", "InitialUnknown"] {
                for (_, reference) in &outputs {
                    push(
                        xml,
                        format_args!("    <{element} valueReference=\"{reference}\"/>\n"),
                    );
                }
            }
        }
        Version::Fmi2 => {
            for element in ["Outputs", "InitialUnknowns"] {
                push(xml, format_args!("    <{element}>\n"));
                for (at, _) in &outputs {
                    push(xml, format_args!("      <Unknown index=\"{at}\"/>\n"));
                }
                push(xml, format_args!("    </{element}>\n"));
            }
        }
    }
    *xml += "  </ModelStructure>\n";
}

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\n' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
