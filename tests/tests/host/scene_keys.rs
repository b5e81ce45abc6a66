//! The one table of scene keys: what is written from it, what it answers, and values by their paths.

use crate::refusals::all;
use firmware_bench::scene::Scene;
use firmware_bench::scene::keys::{Key, Kind};
use firmware_bench::scene::spec::Spec;
use firmware_bench::scene::tables::KEYS;
use serde_json::Value;
use system_tests::ran::{Folder, has, scene_text};
use system_tests::{root, scene, scene_names, scene_path};

fn printed(more: &str) -> String {
    Folder::fresh().ran(&format!("schema {more}")).good()
}

#[test]
fn the_page_and_the_schema_are_as_printed() {
    let page = std::fs::read_to_string(root().join("docs/src/host/keys.md")).unwrap();
    assert!(
        page.contains(&printed("--table")),
        "docs/src/host/keys.md: put what `schema --table` prints under Tables"
    );
    let schema = std::fs::read_to_string(root().join("firmware-host/scene.schema.json")).unwrap();
    assert!(
        schema == printed(""),
        "firmware-host/scene.schema.json: write what `schema` prints into it, or `cargo run --release -p system-tests --bin parameters -- --write`"
    );
}

/// What a schema of this kind says against a value; a word of it that is not known here panics.
fn against(schema: &Value, value: &toml::Value, path: &str) -> Option<String> {
    let number = value
        .as_float()
        .or_else(|| value.as_integer().map(|i| i as f64));
    let array = value.as_array();
    let bound = |bound: &Value| bound.as_f64().unwrap();
    let below =
        |schema: &Value, name: &str, value| against(schema, value, &format!("{path}.{name}"));
    let open = schema.get("exclusiveMinimum") == Some(&Value::Bool(true));
    for (word, rule) in schema.as_object().unwrap() {
        let holds = match word.as_str() {
            "$schema" | "title" | "description" | "default" | "exclusiveMinimum" => true,
            "type" => match rule.as_str().unwrap() {
                "object" => value.is_table(),
                "array" => value.is_array(),
                "string" => value.is_str(),
                "boolean" => value.is_bool(),
                "integer" => value.is_integer(),
                "number" => number.is_some(),
                other => panic!("type {other}"),
            },
            "properties" => {
                let wrong = value
                    .as_table()
                    .into_iter()
                    .flatten()
                    .find_map(|(name, value)| {
                        rule.get(name).and_then(|rule| below(rule, name, value))
                    });
                if wrong.is_some() {
                    return wrong;
                }
                true
            }
            "additionalProperties" => {
                assert_eq!(rule, &Value::Bool(false));
                let known = &schema["properties"];
                (value.as_table().into_iter().flatten()).all(|(name, _)| known.get(name).is_some())
            }
            "required" => (rule.as_array().unwrap().iter())
                .all(|name| value.get(name.as_str().unwrap()).is_some()),
            "items" => {
                let wrong = (array.into_iter().flatten()).find_map(|v| below(rule, "[]", v));
                if wrong.is_some() {
                    return wrong;
                }
                true
            }
            "minItems" => array.is_none_or(|a| a.len() as f64 >= bound(rule)),
            "maxItems" => array.is_none_or(|a| a.len() as f64 <= bound(rule)),
            "uniqueItems" => array.is_none_or(|a| (1..a.len()).all(|i| !a[..i].contains(&a[i]))),
            "minimum" => number.is_none_or(|x| x > bound(rule) || (!open && x == bound(rule))),
            "maximum" => number.is_none_or(|x| x <= bound(rule)),
            "enum" => rule
                .as_array()
                .unwrap()
                .iter()
                .any(|w| w.as_str() == value.as_str()),
            "anyOf" => rule
                .as_array()
                .unwrap()
                .iter()
                .any(|s| against(s, value, path).is_none()),
            other => panic!("{other} is not checked here"),
        };
        if !holds {
            return Some(format!("{path}: {word}"));
        }
    }
    None
}

/// Every scene agrees with the schema, and scenes with usual mistakes do not.
#[test]
fn the_schema_takes_every_scene_and_no_mistake() {
    let text = std::fs::read_to_string(root().join("firmware-host/scene.schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&text).unwrap();
    let check = |text: &str| against(&schema, &toml::from_str(text).unwrap(), "");
    let own = ["biquads", "pid_in_c", "pid_in_python", "state_space"];
    let own = own.map(|name| format!("controllers/{name}"));
    for name in scene_names().into_iter().chain(own) {
        assert_eq!(check(&scene_text(&name)), None, "{name}");
    }
    all(
        "scenes/schema",
        6,
        &scene_text("impact_at_40_hz"),
        |bad, _| format!("schema{}", check(bad).unwrap_or_default()),
    );
}

/// Paths of the values below keys that a scene has or takes by default.
fn paths(spec: &Spec, keys: &[Key], table: &str, all: &mut Vec<String>) {
    for key in keys {
        let path = match table {
            "" => key.name.to_owned(),
            table => format!("{table}.{}", key.name),
        };
        let Some(value) = spec.get(&path).unwrap() else {
            continue;
        };
        match (key.kind, value) {
            (Kind::Table(keys), _) => paths(spec, keys, &path, all),
            (Kind::Tables(keys), toml::Value::Array(array)) => {
                (0..array.len()).for_each(|i| paths(spec, keys, &format!("{path}[{i}]"), all));
            }
            (Kind::Pair, _) => all.extend([format!("{path}[0]"), format!("{path}[1]")]),
            _ => all.push(path),
        }
    }
}

/// Every value of every scene is found by its path, and put there again it is the same scene.
#[test]
fn values_are_read_and_set_by_their_paths() {
    let mut set = 0;
    for name in scene_names() {
        let mut spec = Spec::load(&scene_path(&name)).unwrap();
        let mut all = Vec::new();
        paths(&spec, KEYS, "", &mut all);
        for path in &all {
            let value = spec.get(path).unwrap().unwrap().clone();
            spec.set(path, value).unwrap();
        }
        assert_eq!(spec.resolve().unwrap(), scene(&name), "{name}");
        set += all.len();
    }
    assert!(set > 400, "{set}");
}

#[test]
fn a_value_that_is_set_counts() {
    let mut spec = Spec::load(&scene_path("impact_at_40_hz")).unwrap();
    spec.set("rotor.mass_kg", 11.5).unwrap();
    spec.set("start.velocity_m_s[0]", 0.25).unwrap();
    spec.set("magnet.delay_samples", 2.0).unwrap();
    spec.set("supervisor.hold_share", 0.6).unwrap();
    let scene = spec.resolve().unwrap();
    assert_eq!(scene.machine.rotor.rigid().mass_kg, 11.5);
    assert_eq!(scene.start.centre_velocity_m_s.x, 0.25);
    assert_eq!(scene.planes[0].amplifier.delay_samples, 2);
    assert_eq!(scene.planes[0].supervisor.unwrap().hold_share, 0.6);

    spec.set("rotor.mass_kg", -1.0).unwrap();
    let refused = spec.resolve().unwrap_err().to_string();
    has(&refused, &["rotor.mass_kg: is -1, expected"]);
    for (path, value, part) in [
        (
            "rotor.mass_g",
            1.0.into(),
            "rotor.mass_g: is no key of scenes",
        ),
        (
            "rotor.mass_kg",
            toml::Value::Boolean(true),
            "expected a number",
        ),
        ("disturbance[7].start_s", 0.0.into(), "disturbance[7]"),
    ] {
        has(&spec.set(path, value).unwrap_err().to_string(), &[part]);
    }
}

/// Words of other fields and units lead to the key that was meant.
#[test]
fn foreign_words_are_answered_with_the_key_that_was_meant() {
    let good = scene_text("impact_at_40_hz");
    let (head, _) = good.split_once("[rotor]").unwrap();
    for (table, word, meant) in [
        ("rotor", "speed_rpm", "spin.frequency_hz"),
        ("spin", "rpm", "frequency_hz"),
        ("rotor", "kp", "levitation.proportional_n_m"),
        ("levitation", "kp", "proportional_n_m"),
        ("levitation", "Kd", "derivative_n_s_m"),
        ("rotor", "PID", "[levitation]"),
        ("contact", "gap_mm", "clearance_m"),
        ("rotor", "mass_g", "mass_kg"),
        ("friction", "mu", "coefficient"),
    ] {
        let text = format!("{head}[{table}]\n{word} = 1.0\n");
        let error = Scene::parse("scene.toml", &text).unwrap_err();
        let help = miette::Diagnostic::help(&error).map(|h| h.to_string());
        let help = help.unwrap_or_default().replace('`', "");
        let meant = format!("did you mean {meant}");
        assert!(help.starts_with(&meant), "{table}.{word}: {help}");
    }
}
