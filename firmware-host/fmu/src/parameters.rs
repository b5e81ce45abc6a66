//! Parameters that come from the keys of a scene.

use crate::model::Set;
use crate::variable::{Kind, Role, Value, Variable};
use firmware_bench::scene::Scene;
use firmware_bench::scene::spec::{NumberAt, Spec};
use plant_model::Change;
use supervisor::{Config, PARAMETERS};

/// What no parameter may be: the time of a run is the importer's affair, and the rate is that of the unit's steps.
const NONE: [&str; 2] = ["run.duration_s", "run.sample_rate_hz"];

/// Numbers of a scene as parameters.
pub(crate) fn of_scene(spec: &Spec) -> Vec<Variable> {
    let numbers = spec.numbers();
    // What is changed is the friction of all planes.
    let own_friction = |number: &NumberAt| number.path.ends_with("].friction.coefficient");
    let own_friction = numbers.iter().any(own_friction);
    let numbers = numbers.into_iter();
    let numbers = numbers.filter(|number| !NONE.contains(&number.path.as_str()));
    let parameter = |number: NumberAt| {
        let whole = number.value.as_integer().map(Value::Int64);
        let start = match number.key.kind {
            firmware_bench::scene::keys::Kind::Whole => whole?,
            _ => {
                let float = number.value.as_float();
                Value::Float64(float.or(number.value.as_integer().map(|x| x as f64))?)
            }
        };
        let tunable = change(&number.path, 0.0)
            .is_some_and(|change| change.friction_coefficient.is_none() || !own_friction);
        Some(Variable {
            about: plain(number.key.help),
            unit: number.key.unit,
            kind: match start {
                Value::Int64(_) => Kind::Int64,
                _ => Kind::Float64,
            },
            role: match tunable {
                true => Role::Tunable,
                false => Role::Fixed,
            },
            name: number.path,
            start,
        })
    };
    numbers.filter_map(parameter).collect()
}

/// Parameters of a supervisor, under names that begin so.
pub(crate) fn of_supervisor(config: &Config, prefix: &str) -> Vec<Variable> {
    let values = PARAMETERS.iter().zip(config.values());
    let parameter = |(parameter, value): (&supervisor::Parameter, f32)| Variable {
        name: format!("{prefix}{}", parameter.name),
        about: plain(parameter.text),
        unit: parameter.unit,
        kind: Kind::Float64,
        role: Role::Fixed,
        start: Value::Float64(f64::from(value)),
    };
    values.map(parameter).collect()
}

/// The scene with parameters as they are set.
pub(crate) fn scene(spec: &Spec, set: &[Set<'_>]) -> Result<Scene, String> {
    let mut spec = spec.clone().without_warnings();
    let value = |value: Value| match value {
        Value::Int64(x) => toml::Value::Integer(x),
        other => toml::Value::Float(other.number()),
    };
    let all: Vec<(&str, toml::Value)> = set.iter().map(|s| (s.name, value(s.value))).collect();
    spec.set_all(&all).map_err(|error| error.to_string())?;
    spec.resolve().map_err(|error| error.to_string())
}

/// What a tunable parameter changes of a plant; `None` of another.
pub(crate) fn change(name: &str, value: f64) -> Option<Change> {
    let mut change = Change::default();
    match name {
        "rotor.eccentricity_m" => change.eccentricity_m = Some(value),
        "friction.coefficient" => change.friction_coefficient = Some(value),
        "spin.drive_torque_n_m" => change.drive_torque_n_m = Some(value),
        _ => return None,
    }
    Some(change)
}

/// Help without its Markdown: code marks go, of links the text stays.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut rest = markdown;
    while let Some((before, link)) = rest.split_once('[') {
        text += before;
        let parts = link.split_once("](");
        let parts = parts.and_then(|(name, to)| Some((name, to.split_once(')')?.1)));
        match parts {
            Some((name, behind)) if !name.contains(']') => {
                text += name;
                rest = behind;
            }
            _ => {
                text.push('[');
                rest = link;
            }
        }
    }
    text += rest;
    text.replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_loses_its_markdown_alone() {
        let link = "k_h of [Hunt's (2.1)](../a.md#b), which `exponent` needs (n)";
        assert_eq!(plain(link), "k_h of Hunt's (2.1), which exponent needs (n)");
        let pair = "one for each axis, [x, y], of a `[[plane]]`";
        assert_eq!(plain(pair), "one for each axis, [x, y], of a [[plane]]");
    }
}
