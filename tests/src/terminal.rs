//! How wide what a command prints is.

use unicode_width::UnicodeWidthStr;

/// No line takes more columns than there are. Sentences are left out, which a terminal may break anywhere, and commands, which are
/// to be copied: rows of tables are indented, and ruled lines have nothing else in them.
///
/// # Panics
/// With the lines that do.
pub fn assert_fits(printed: &str, columns: usize) {
    let rows = printed.lines().filter(|line| line.starts_with([' ', '─']));
    let wide: Vec<(usize, &str)> = rows
        .filter(|line| !line.contains("firmware-host "))
        .map(|line| (line.width(), line))
        .filter(|(width, _)| *width > columns)
        .collect();
    assert!(wide.is_empty(), "over {columns} columns: {wide:#?}");
}

/// How many tables there are: of each the line below its headings.
pub fn tables(printed: &str) -> usize {
    printed.lines().filter(|line| line.starts_with('─')).count()
}
