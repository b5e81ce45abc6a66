//! A controller that is a co-simulation unit: the file of Python that runs it in a scene, with a PID as a unit of both versions.

use super::{CHECKS, checked, text};
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use system_tests::ran::{Folder, has, ran};
use system_tests::{python, root, scene_path};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Name, causality, whether it is Boolean; the value reference is the place.
const VARIABLES: [(&str, &str, bool); 10] = [
    ("k_p", "parameter", false),
    ("k_i", "parameter", false),
    ("k_d", "parameter", false),
    ("filter_s", "parameter", false),
    ("cap_n", "parameter", false),
    ("x_m", "input", false),
    ("y_m", "input", false),
    ("hold", "input", true),
    ("fx_n", "output", false),
    ("fy_n", "output", false),
];

fn description(version: &str) -> String {
    let two = version == "2.0";
    let token = if two { "guid" } else { "instantiationToken" };
    let mut xml = format!(
        "<fmiModelDescription fmiVersion=\"{version}\" modelName=\"pid\" {token}=\"pid\">\
         <CoSimulation modelIdentifier=\"pid\"/><ModelVariables>"
    );
    for (reference, (name, causality, boolean)) in VARIABLES.iter().enumerate() {
        let varies = match (*causality, boolean) {
            ("parameter", _) => "fixed",
            (_, true) => "discrete",
            _ => "continuous",
        };
        let start = match (*causality, boolean) {
            ("output", _) => "",
            (_, true) => " start=\"false\"",
            _ => " start=\"0.0\"",
        };
        let about = format!(
            "name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\" variability=\"{varies}\""
        );
        xml += &match (two, boolean) {
            (true, false) => format!("<ScalarVariable {about}><Real{start}/></ScalarVariable>"),
            (true, true) => format!("<ScalarVariable {about}><Boolean{start}/></ScalarVariable>"),
            (false, false) => format!("<Float64 {about}{start}/>"),
            (false, true) => format!("<Boolean {about}{start}/>"),
        };
    }
    if !two {
        xml += "<Float64 name=\"time\" valueReference=\"10\" causality=\"independent\" variability=\"continuous\"/>";
    }
    let structure = match two {
        true => {
            "<Outputs><Unknown index=\"9\"/><Unknown index=\"10\"/></Outputs>\
             <InitialUnknowns><Unknown index=\"9\"/><Unknown index=\"10\"/></InitialUnknowns>"
        }
        false => {
            "<Output valueReference=\"8\"/><Output valueReference=\"9\"/>\
             <InitialUnknown valueReference=\"8\"/><InitialUnknown valueReference=\"9\"/>"
        }
    };
    format!(
        "{xml}</ModelVariables><ModelStructure>{structure}</ModelStructure></fmiModelDescription>"
    )
}

fn archive(path: &Path, version: &str, library: &[u8]) {
    let mut archive = ZipWriter::new(fs::File::create(path).unwrap());
    let platform = match version {
        "2.0" => "linux64",
        _ => "x86_64-linux",
    };
    let binary = format!("binaries/{platform}/pid.so");
    let files = [
        ("modelDescription.xml", description(version).into_bytes()),
        (binary.as_str(), library.to_vec()),
    ];
    for (name, bytes) in files {
        archive
            .start_file(name, SimpleFileOptions::default())
            .unwrap();
        archive.write_all(&bytes).unwrap();
    }
    archive.finish().unwrap();
}

fn traces(python: &Path, folder: &Folder, scene: &str, out: &str) -> [String; 2] {
    let path = std::env::var("PATH").unwrap();
    let venv = python.parent().unwrap().display();
    let mut run = folder.command(&format!("run {scene} --out {out}"));
    ran(run.env("PATH", format!("{venv}:{path}"))).good();
    ["levitation", "supervisor"]
        .map(|policy| text(&folder.at(&format!("{out}/trace_{policy}.parquet"))))
}

/// The PID as a unit of either version is the PID in Python, bit for bit, integrators that stand included.
#[test]
fn a_controller_may_be_a_unit() {
    let Some(python) = python() else { return };
    let folder = Folder::fresh();
    let mut cc = Command::new("cc");
    cc.args("-std=c99 -Wall -Wextra -Wpedantic -Werror -O2 -shared -fPIC -o".split(' '));
    let source = root().join("tests/tests/host/fmu/pid.c");
    ran(cc.arg(folder.at("pid.so")).arg(source).arg("-lm")).good();
    let library = folder.bytes("pid.so");

    let in_python = "controllers/pid_in_python";
    let expected = traces(&python, &folder, &format!("@{in_python}"), "expected");
    let importer = scene_path(in_python).with_file_name("fmu.py");
    fs::copy(importer, folder.at("fmu.py")).unwrap();
    let other = [("python = \"pid.py\"", "python = \"fmu.py\"")];
    folder.scene("own.toml", in_python, &other);
    for version in ["2.0", "3.0"] {
        archive(&folder.at("controller.fmu"), version, &library);
        let computed = traces(&python, &folder, "own.toml", version);
        for (one, other) in expected.iter().zip(&computed) {
            let said = checked(&python, CHECKS, &["traces", one, other]);
            has(&said, &["rows the same"]);
        }
    }
}
