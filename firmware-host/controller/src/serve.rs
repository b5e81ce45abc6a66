//! The process of a shared library.

use crate::frame::{Answer, Question, Setup};
use crate::library::Controller;
use std::io::{self, Write};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::path::Path;

/// Serves the controller in a library to whoever is at the other end of standard input, until there is nobody.
///
/// # Errors
/// What the system says of the socket; of the controller itself the host gets a message.
pub fn serve(library: &Path) -> io::Result<()> {
    let mut host = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    let setup = Setup::read(&mut host)?;
    let mut controller = match Controller::new(library, &setup) {
        Ok(controller) => controller,
        Err(text) => return host.write_all(&Answer::Failed(text).bytes()),
    };
    host.write_all(&Answer::Forces(Vec::new()).bytes())?;
    while let Some(question) = Question::read(&mut host, setup.sensors)? {
        let answer = match controller.step(&question) {
            Ok(forces_n) => Answer::Forces(forces_n.to_vec()),
            Err(text) => Answer::Failed(text),
        };
        host.write_all(&answer.bytes())?;
    }
    controller.close();
    Ok(())
}
