//! The table of docs/platforms.md that says what each library needs.

use std::fs;

/// One row of the table.
pub(crate) struct Documented {
    /// Platform as FMI 3.0 names it.
    pub(crate) platform: String,
    /// What links it: `any` for the library that Cargo embeds with whatever linker there is.
    pub(crate) linker: String,
    /// Shared libraries that it needs, sorted.
    pub(crate) needed: Vec<String>,
    /// Newest version of the GNU C library's symbols that it asks for.
    pub(crate) newest_glibc: Option<(u32, u32)>,
}

impl Documented {
    /// The rows below the heading "What each library needs": platform, linker, newest symbol, shared libraries.
    pub(crate) fn read() -> Vec<Self> {
        let path = super::workspace().join("docs/platforms.md");
        let text = fs::read_to_string(path).unwrap();
        let (_, section) = text.split_once("## What each library needs\n").unwrap();
        let rows: Vec<Self> = section
            .lines()
            .take_while(|line| !line.starts_with("## "))
            .filter(|line| line.starts_with("| `"))
            .map(Self::of_row)
            .collect();
        assert!(rows.len() >= 5, "rows of the table in docs/platforms.md");
        rows
    }

    fn of_row(row: &str) -> Self {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let mut needed: Vec<String> = cells[3]
            .split('`')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect();
        needed.sort();
        Self {
            platform: cells[0].trim_matches('`').to_owned(),
            linker: cells[1].to_owned(),
            needed,
            newest_glibc: glibc_version(cells[2].trim_matches('`')),
        }
    }
}

/// The numbers of `GLIBC_2.17`; `None` for another name.
pub(crate) fn glibc_version(name: &str) -> Option<(u32, u32)> {
    let mut numbers = name.strip_prefix("GLIBC_")?.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}
