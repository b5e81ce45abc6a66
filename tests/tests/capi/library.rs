//! Builds the static library as firmware authors do, and C against it.

use std::path::{Path, PathBuf};
use std::process::Command;
use system_tests::ran::{Folder, Ran, ran};
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
    let triple = target.triple().map_or_else(host_tuple, str::to_owned);
    let mut script = Command::new(capi().join("prebuilt/library"));
    script.arg(&triple);
    finished(script)?;
    Some(root().join("target-fw/prebuilt").join(triple).join("fw"))
}

/// What rustc calls this machine.
pub(crate) fn host_tuple() -> String {
    let said = ran(Command::new("rustc").args(["--print", "host-tuple"])).good();
    said.trim().to_owned()
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
    let ran = ran(&mut cargo);
    if ran.said.contains("target may not be installed") {
        assert!(std::env::var_os("CI").is_none(), "{}", ran.said);
        eprintln!("skipped: the target is not installed; tests/run installs it");
        return None;
    }
    ran.good();
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
pub(crate) fn host_program(sources: &[PathBuf], library: &Path, program: &Path) -> Option<Ran> {
    let mut cc = Target::Host.compiler()?;
    cc.args(STRICT).arg("-O1").args(includes(library));
    cc.args(sources).args(linked_with(library));
    Some(ran(cc.arg("-o").arg(program)))
}

/// The library, and those of the system that Rust's own needs.
pub(crate) fn linked_with(library: &Path) -> [String; 4] {
    let archive = library.join("libsupervisor_capi.a");
    [&archive.display().to_string(), "-lpthread", "-ldl", "-lm"].map(str::to_owned)
}

/// What a program says that a C file beside these tests and the rig make on the host; `None` where a tool is missing.
pub(crate) fn said_with_rig(source: &str) -> Option<String> {
    let folder = Folder::fresh();
    let program = folder.at("program");
    let sources = [beside(source), capi().join("examples/rig.c")];
    host_program(&sources, &built(Target::Host)?, &program)?.good();
    Some(ran(&mut Command::new(program)).good())
}

/// The C++ compiler, which is needed by nothing else: without it there is nothing to check.
pub(crate) fn cpp() -> Option<Command> {
    if Command::new("g++").arg("--version").output().is_err() {
        eprintln!("not checked as C++: g++ is missing");
        return None;
    }
    Some(Command::new("g++"))
}

/// A C file beside these tests.
pub(crate) fn beside(name: &str) -> PathBuf {
    root().join("tests/tests/capi").join(name)
}
