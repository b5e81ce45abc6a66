//! Controllers of the user's, by a program.

use crate::device::external::{Caller, ExternalParams, Language, Program};
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::tables::ControllerTable;
use std::path::{Path, absolute};

/// The controller of `[controller]` for planes with a cap each, where they have a magnet. That its file is there is all that is
/// looked at: nothing of it runs before the run.
pub(crate) fn external(
    written: &ControllerTable,
    text: &SceneText,
    period_s: f64,
    caps_n: Vec<Option<f64>>,
) -> Result<ExternalParams, SceneError> {
    let refused = |key: &str, message: String, help: &str| {
        text.error_at_key(key, message, Some(help.to_owned()))
    };
    let (language, key, named) = match (&written.python, &written.library) {
        (Some(file), None) => (Language::Python, "controller.python", file),
        (None, Some(file)) => (Language::Library, "controller.library", file),
        (Some(_), Some(_)) => {
            let message = "given together with controller.library".to_owned();
            return Err(refused("controller.python", message, "remove one of them"));
        }
        (None, None) => {
            let message = "names no program".to_owned();
            let help = "give python = \"file.py\" or library = \"file.so\"";
            return Err(refused("controller", message, help));
        }
    };
    let folder = text.path.parent().unwrap_or(Path::new(""));
    let found = absolute(folder.join(named)).and_then(|path| {
        let is_file = path.metadata()?.is_file();
        Ok((path, is_file))
    });
    let help = match language {
        Language::Python => "give a file of Python by its path from the scene file",
        Language::Library => {
            "give a shared library by its path from the scene file; what is written in C is compiled first, with cc -O2 -shared -fPIC"
        }
    };
    let file = match found {
        Ok((path, true)) => path,
        Ok((_, false)) => return Err(refused(key, format!("{named}: is no file"), help)),
        Err(reason) => return Err(refused(key, format!("{named}: {reason}"), help)),
    };
    Ok(ExternalParams {
        program: Program::Process {
            language,
            file,
            timeout_s: written.timeout_s,
        },
        named: named.clone(),
        key: text
            .warning(key, String::new())
            .trim_end_matches(": ")
            .to_owned(),
        parameters: written.parameters.0.clone(),
        period_s,
        caps_n,
    })
}

/// The controller of whoever calls, in the place of the program that `[controller]` names.
pub(crate) fn of_caller(
    written: &ControllerTable,
    caller: &Caller,
    period_s: f64,
    caps_n: Vec<Option<f64>>,
) -> ExternalParams {
    ExternalParams {
        program: Program::Caller(caller.clone()),
        named: caller.name.clone(),
        key: "controller".to_owned(),
        parameters: written.parameters.0.clone(),
        period_s,
        caps_n,
    }
}
