//! What the project's files say of the supervisor's parameters: `parameters` names those that say something else than the table,
//! `parameters --write` writes them.

use std::error::Error;
use system_tests::parameters::{FILES, now_and_wanted};
use system_tests::root;

fn main() -> Result<(), Box<dyn Error>> {
    let write = match std::env::args().nth(1).as_deref() {
        Some("--write") => true,
        None => false,
        Some(_) => return Err("usage: parameters [--write]".into()),
    };
    for (file, maker) in FILES {
        let [now, wanted] = now_and_wanted(file, maker)?;
        if now != wanted {
            println!("{file}");
            if write {
                std::fs::write(root().join(file), wanted)?;
            }
        }
    }
    Ok(())
}
