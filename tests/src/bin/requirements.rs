//! The requirements of the supervisor with their tests: `requirements` prints the table, `requirements --write` also puts it into
//! its page of the documentation.

use std::error::Error;
use system_tests::requirements::{all, listed, page, page_path, table, with_table};

fn main() -> Result<(), Box<dyn Error>> {
    let write = match std::env::args().nth(1).as_deref() {
        Some("--write") => true,
        None => false,
        Some(_) => return Err("usage: requirements [--write]".into()),
    };
    let page = page()?;
    let table = table(&listed(&page), &all()?);
    print!("{table}");
    if write {
        let page = with_table(&page, &table).ok_or("the page has no place for the table")?;
        std::fs::write(page_path(), page)?;
    }
    Ok(())
}
