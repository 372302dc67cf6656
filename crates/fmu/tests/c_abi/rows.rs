//! Tables of cases as text, so that a case takes one line: its cells stand between bars.

/// The cells of each line that is not empty.
pub(crate) fn rows<const N: usize>(table: &str) -> impl Iterator<Item = [&str; N]> {
    let lines = table.lines().filter(|line| !line.trim().is_empty());
    lines.map(|line| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        cells.try_into().unwrap_or_else(|_| panic!("{line}"))
    })
}

/// Value reference of the variable with this name; a number stands for itself.
pub(crate) fn reference(name: &str) -> u32 {
    let names = include_str!("../../../../modelDescription/value-references.txt");
    let place = names.lines().position(|line| line == name);
    place.map_or_else(|| name.parse().unwrap(), |place| place as u32)
}

/// The number of a cell.
pub(crate) fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("{cell}"))
}
