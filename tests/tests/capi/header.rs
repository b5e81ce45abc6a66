//! The header says what the library does: every number, every text, every place in every struct.

use crate::library::{STRICT, Target, built, cpp, includes, tool};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::process::Command;
use supervisor::{Events, Finding, IntegratorHint, Limits, Mode, PARAMETERS, RejectReason, Status};
use supervisor_capi::calls::mode_name;
use supervisor_capi::code::{CODES, FIRST_PARAMETER};
use supervisor_capi::layout::HEADER;
use supervisor_capi::structs::LAYOUTS;
use supervisor_capi::{Code, RECORD};
use system_tests::parameters;
use system_tests::ran::{Folder, has, lacks, ran};

const MODES: [(&str, Mode); 8] = [
    ("LEVITATED", Mode::Levitated),
    ("APPROACH", Mode::Approach),
    ("BOUNCE", Mode::Bounce),
    ("BACKWARD_WHIRL", Mode::BackwardWhirl),
    ("PINNED", Mode::Pinned),
    ("HANDOVER", Mode::Handover),
    ("SENSOR_FAULT", Mode::SensorFault),
    ("HANDED_BACK", Mode::HandedBack),
];

const REFUSALS: [(&str, RejectReason); 7] = [
    ("NONE", RejectReason::None),
    ("NOT_FINITE", RejectReason::NotFinite),
    ("RANGE", RejectReason::Range),
    ("SLEW", RejectReason::Slew),
    ("DROPOUT", RejectReason::Dropout),
    ("STUCK", RejectReason::Stuck),
    ("DOUBTED", RejectReason::Doubted),
];

const FINDINGS: [(&str, Finding); 15] = [
    ("UNCHECKED", Finding::Unchecked),
    ("NOT_YET", Finding::NotYet),
    ("PASSED", Finding::Passed),
    ("AXES_SWAPPED", Finding::AxesSwapped),
    ("AXIS_INVERTED", Finding::AxisInverted),
    ("FORCE_INVERTED", Finding::ForceInverted),
    ("AXES_TURNED", Finding::AxesTurned),
    ("AXES_SKEWED", Finding::AxesSkewed),
    ("GAIN", Finding::Gain),
    ("DELAY", Finding::Delay),
    ("NO_ANSWER", Finding::NoAnswer),
    ("SPIN_REVERSED", Finding::SpinReversed),
    ("SPIN_UNIT", Finding::SpinUnit),
    ("CLEARANCE", Finding::Clearance),
    ("POSITION", Finding::Position),
];

const HINTS: [(&str, IntegratorHint); 2] =
    [("RUN", IntegratorHint::Run), ("HOLD", IntegratorHint::Hold)];

/// Numbers that the header defines under names that begin so, without that beginning.
fn defined(prefix: &str) -> BTreeMap<String, i64> {
    let mut found = BTreeMap::new();
    for line in HEADER.lines() {
        let Some(rest) = line.strip_prefix(&format!("#define AMB_{prefix}")) else {
            continue;
        };
        let (name, value) = rest.split_once(' ').expect("a value");
        let value = value.split("/*").next().unwrap_or(value).trim();
        let value = value
            .trim_matches(['(', ')'])
            .trim_end_matches('u')
            .to_owned();
        let number = match value.strip_prefix("0x") {
            Some(hex) => i64::from_str_radix(hex, 16),
            None => value.parse(),
        };
        // What is no number is a macro.
        if let Ok(number) = number {
            assert!(
                found.insert(name.to_owned(), number).is_none(),
                "{name} twice"
            );
        }
    }
    found
}

fn same<'a>(prefix: &str, ours: impl Iterator<Item = (&'a str, i64)>) {
    let ours: BTreeMap<String, i64> = ours.map(|(name, n)| (name.to_owned(), n)).collect();
    assert_eq!(defined(prefix), ours, "AMB_{prefix}");
}

#[test]
fn numbers_are_the_same() {
    let bits = |bits: u32| i64::from(bits);
    let status = Status::all();
    same(
        "STATUS_",
        status.iter_names().map(|(n, b)| (n, bits(b.bits()))),
    );
    let limits = Limits::all();
    same(
        "LIMIT_",
        limits.iter_names().map(|(n, b)| (n, bits(b.bits()))),
    );
    let events = Events::all();
    same(
        "EVENT_",
        events.iter_names().map(|(n, b)| (n, bits(b.bits()))),
    );
    same("MODE_", MODES.iter().map(|(n, m)| (*n, *m as i64)));
    same("REFUSAL_", REFUSALS.iter().map(|(n, r)| (*n, *r as i64)));
    same("FINDING_", FINDINGS.iter().map(|(n, f)| (*n, *f as i64)));
    same("INTEGRATOR_", HINTS.iter().map(|(n, h)| (*n, *h as i64)));
    let errors = CODES.iter().filter_map(|row| {
        let name = row.name.strip_prefix("ERROR_")?;
        Some((name, i64::from(row.code.0)))
    });
    same("ERROR_", errors);
    assert_eq!(defined("OK").get(""), Some(&0));
    assert_eq!(defined("NOTHING").get(""), Some(&1));
    let first =
        format!("#define AMB_ERROR_PARAMETER(index) ({FIRST_PARAMETER} - (amb_code)(index))");
    has(HEADER, &[&first]);
    assert_eq!(defined("RECORD_").get("ENTRIES"), Some(&(RECORD as i64)));
}

#[test]
fn modes_have_the_names_of_the_supervisor() {
    for (_, mode) in MODES {
        assert_eq!(mode_name(mode as u32).to_str(), Ok(mode.name()));
    }
}

/// Lines of the header that say what the tables say. What is printed of a code is what to paste; parameters have a command.
#[test]
fn tables_are_the_same() {
    let mut wanted = Vec::new();
    for row in CODES {
        let number = row.code.0;
        let number = if number < 0 {
            format!("({number})")
        } else {
            number.to_string()
        };
        let said = row.text.to_str().unwrap();
        assert_eq!(row.code.text(), row.text);
        wanted.push(format!("#define AMB_{} {number} /**< {said} */", row.name));
    }
    for (index, parameter) in PARAMETERS.iter().enumerate() {
        let code = Code(FIRST_PARAMETER - index as i32);
        let said = code.text().to_str().unwrap();
        // "1" stands for no unit.
        let unit = match parameter.unit {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        let range = parameters::range(parameter);
        let [low, high] = [parameter.low, parameter.high].map(Ok);
        let (first, last) = range.split_once(" to ").unwrap();
        assert_eq!((first.parse(), last.parse()), (low, high), "{range}");
        assert_eq!(said, format!("{} is outside {range}{unit}", parameter.name));
    }
    parameters::check(parameters::HEADER);
    let missing: Vec<_> = (wanted.iter())
        .filter(|line| !HEADER.lines().any(|l| l == **line))
        .collect();
    assert!(missing.is_empty(), "the header lacks\n{missing:#?}");
    assert_eq!(defined("P_").len(), PARAMETERS.len());
}

/// C that does not compile if a field is elsewhere, has another size, or is missing.
fn layout_check() -> String {
    let mut c = String::from("#include \"amb_supervisor.h\"\n");
    for layout in LAYOUTS {
        let name = layout.name;
        let _ = writeln!(c, "AMB_ASSERT({name}_, sizeof({name}) == {});", layout.size);
        // The sum leaves no room for a field that Rust does not know.
        let sum: usize = layout.fields.iter().map(|(_, _, size)| size).sum();
        assert_eq!(sum, layout.size, "{name}");
        for (field, offset, size) in layout.fields {
            let _ = writeln!(
                c,
                "AMB_ASSERT({name}_{field}, offsetof({name}, {field}) == {offset} \
                 && sizeof((({name} *)0)->{field}) == {size});"
            );
        }
    }
    c
}

/// Compiles a text as a language, without a program.
fn compiles(mut compiler: Command, arguments: &[&str], source: &str, name: &str) {
    let library = built(Target::Host).unwrap();
    let folder = Folder::fresh();
    compiler.args(arguments).args(includes(&library));
    compiler.arg("-c").arg(folder.put(name, source));
    ran(compiler.arg("-o").arg(folder.at("check.o"))).good();
}

#[test]
fn structs_have_the_same_layout() {
    for target in [Target::Host, Target::CortexM4F, Target::CortexM0] {
        if let Some(compiler) = target.compiler() {
            compiles(compiler, &STRICT, &layout_check(), "check.c");
        }
    }
}

/// In every C that is in use, and in C++ where there is a compiler for it.
#[test]
fn the_header_is_clean() {
    let source = layout_check();
    let warnings = "-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wundef -Werror";
    for standard in ["c99", "c11", "c17", "c++98", "c++11", "c++17"] {
        let (compiler, name) = match standard.starts_with("c++") {
            true => (cpp(), "check.cpp"),
            false => (Target::Host.compiler(), "check.c"),
        };
        let Some(compiler) = compiler else {
            return;
        };
        let standard = format!("-std={standard}");
        let arguments: Vec<&str> = warnings.split(' ').chain([&standard[..]]).collect();
        compiles(compiler, &arguments, &source, name);
    }
}

/// All names that the library gives to the linker begin with `amb_` and, but for the version itself,
/// end with the version.
#[test]
fn names_carry_the_version() {
    let names = HEADER
        .lines()
        .filter_map(|l| l.strip_prefix("#define amb_")?.split(' ').next());
    let Some(library) = built(Target::CortexM4F) else {
        return;
    };
    let Some(mut nm) = tool("arm-none-eabi-nm") else {
        return;
    };
    nm.args(["-g", "--defined-only"]);
    let listed = ran(nm.arg(library.join("libsupervisor_capi.a"))).good();
    let mut found: Vec<&str> = (listed.split_whitespace())
        .filter_map(|word| word.strip_prefix("amb_"))
        .collect();
    let mut wanted: Vec<String> = names
        .map(|name| format!("{name}_abi{}", supervisor_capi::ABI))
        .collect();
    wanted.push("abi_version".to_owned());
    found.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(found, wanted);
    lacks(&listed, &["panicking"]);
}
