//! Builds the static library as firmware authors do, and C against it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use system_tests::root;
use system_tests::target::at_level;

/// Where a static library can be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Target {
    Host,
    /// With FPU.
    CortexM4F,
    /// Without FPU, and without exchange of a word in memory.
    CortexM0,
}

impl Target {
    fn triple(self) -> Option<&'static str> {
        match self {
            Self::Host => None,
            Self::CortexM4F => Some("thumbv7em-none-eabihf"),
            Self::CortexM0 => Some("thumbv6m-none-eabi"),
        }
    }

    /// Machine of the emulator that runs its programs. There is none with a Cortex-M0 and this memory;
    /// a Cortex-M3 has all its instructions.
    pub(crate) fn machine(self) -> &'static str {
        match self {
            Self::Host => "none",
            Self::CortexM4F => "mps2-an386",
            Self::CortexM0 => "mps2-an385",
        }
    }

    /// Its C compiler with what that always needs, or `None` (in CI: a failure) where there is none.
    pub(crate) fn compiler(self) -> Option<Command> {
        let (name, arguments) = match self {
            Self::Host => return tool("cc"),
            Self::CortexM4F => ("cortex-m4", "-mfpu=fpv4-sp-d16 -mfloat-abi=hard"),
            Self::CortexM0 => ("cortex-m0", "-mfloat-abi=soft"),
        };
        let mut gcc = tool("arm-none-eabi-gcc")?;
        let newlib = Command::new("arm-none-eabi-gcc")
            .arg("-print-file-name=rdimon.specs")
            .output();
        // The name alone comes back where there is no such file.
        if !newlib.is_ok_and(|output| output.stdout.contains(&b'/')) {
            return missing("newlib for arm-none-eabi-gcc");
        }
        gcc.arg("-mthumb").arg(format!("-mcpu={name}"));
        gcc.args(arguments.split(' '));
        Some(gcc)
    }
}

/// A command that is installed, or `None`; in CI a missing one fails the test.
pub(crate) fn tool(name: &str) -> Option<Command> {
    if Command::new(name).arg("--version").output().is_ok() {
        return Some(Command::new(name));
    }
    missing(name)
}

fn missing(name: &str) -> Option<Command> {
    assert!(
        std::env::var_os("CI").is_none(),
        "{name} is missing; tests/run installs it"
    );
    eprintln!("skipped: {name} is missing; tests/run installs it");
    None
}

/// Root of the C interface.
pub(crate) fn capi() -> PathBuf {
    root().join("supervisor/capi")
}

/// Folder with the library for a target and its version, freshly built, the one that is handed out; `None` where the target
/// is not installed (in CI: a failure).
pub(crate) fn built(target: Target) -> Option<PathBuf> {
    let triple = match target.triple() {
        Some(triple) => triple.to_owned(),
        None => {
            let rustc = Command::new("rustc")
                .args(["--print", "host-tuple"])
                .output();
            good(&rustc.unwrap()).trim().to_owned()
        }
    };
    let mut script = Command::new(capi().join("prebuilt/library"));
    script.arg(&triple);
    finished(script)?;
    Some(root().join("target-fw/prebuilt").join(triple).join("fw"))
}

/// The same at a level of optimisation other than 3, with a call that can panic, which nobody has to make. What it uses is shared
/// with the images.
pub(crate) fn built_at(target: Target, level: &str) -> Option<PathBuf> {
    let mut cargo = build(target);
    at_level(&mut cargo, level, ["amb-supervisor", "supervisor-capi"]);
    cargo.args(["--features", "planted-panic"]);
    finished(cargo)?;
    // The build writes the version where builds share what is compiled.
    let version = "amb_supervisor_abi.h";
    let built = folder(&format!("target-fw/{level}"), target);
    let shared = folder("target-fw", target).join(version);
    std::fs::copy(shared, built.join(version)).unwrap();
    Some(built)
}

fn build(target: Target) -> Command {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let mut command = Command::new(cargo);
    command.current_dir(root());
    command.args(["rustc", "-p", "supervisor-capi", "--lib"]);
    command.args(["--crate-type", "staticlib", "--profile", "fw"]);
    command.args(target.triple().map(|triple| format!("--target={triple}")));
    command
}

/// Runs a build; `None` where its target is not installed (in CI: a failure).
pub(crate) fn finished(mut cargo: Command) -> Option<()> {
    let output = cargo.output().expect("cargo starts");
    let error = String::from_utf8_lossy(&output.stderr);
    if error.contains("target may not be installed") {
        assert!(std::env::var_os("CI").is_none(), "{error}");
        eprintln!("skipped: the target is not installed; tests/run installs it");
        return None;
    }
    assert!(output.status.success(), "{error}");
    Some(())
}

fn folder(target_dir: &str, target: Target) -> PathBuf {
    let folder = root().join(target_dir);
    folder.join(target.triple().unwrap_or("")).join("fw")
}

/// Arguments with which firmware finds the header, its version and the example's parts.
pub(crate) fn includes(library: &Path) -> Vec<String> {
    [
        &capi().join("include"),
        &capi().join("examples"),
        &library.to_path_buf(),
    ]
    .map(|folder| format!("-I{}", folder.display()))
    .to_vec()
}

/// All warnings, as errors.
pub(crate) const STRICT: [&str; 5] = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];

/// Builds a program for the host from C files, and says what the compiler said.
pub(crate) fn host_program(sources: &[PathBuf], library: &Path, program: &Path) -> Option<Output> {
    let mut cc = Target::Host.compiler()?;
    cc.args(STRICT).arg("-O1").args(includes(library));
    cc.args(sources).arg(library.join("libsupervisor_capi.a"));
    // Libraries of the system that Rust's own needs.
    cc.args(["-lpthread", "-ldl", "-lm", "-o"]).arg(program);
    Some(cc.output().expect("the compiler starts"))
}

/// What a program says that a C file beside these tests and the rig make on the host; `None` where a tool is missing.
pub(crate) fn output_with_rig(source: &str) -> Option<String> {
    let library = built(Target::Host)?;
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("program");
    let sources = [beside(source), capi().join("examples/rig.c")];
    good(&host_program(&sources, &library, &program)?);
    Some(good(&Command::new(program).output().unwrap()))
}

/// A C file beside these tests.
pub(crate) fn beside(name: &str) -> PathBuf {
    root().join("tests/tests/capi").join(name)
}

/// What a command wrote, if it went well.
///
/// # Panics
/// If it did not, with what it wrote.
pub(crate) fn good(output: &Output) -> String {
    let out = String::from_utf8_lossy(&output.stdout).into_owned();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{out}\n{error}");
    out
}
