//! Small tables of numbers for the terminal.

use std::fmt::Write as _;

pub(super) use bolted_joint_files::number;

/// Rows of text under a header, columns aligned: the first to the left, the others to the right.
pub(super) struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn new(header: &[&str]) -> Self {
        Self {
            rows: vec![header.iter().map(|&title| title.to_owned()).collect()],
        }
    }

    pub(super) fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// The table, each line indented by two spaces.
    pub(super) fn render(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns)
            .map(|column| {
                let cells = self.rows.iter().filter_map(|row| row.get(column));
                cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
            })
            .collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for (column, cell) in row.iter().enumerate() {
                let padding = " ".repeat(widths[column] - cell.chars().count());
                if column == 0 {
                    line += &format!("  {cell}{padding}");
                } else {
                    line += &format!("  {padding}{cell}");
                }
            }
            let _ = writeln!(text, "{}", line.trim_end());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_by_characters() {
        let mut table = Table::new(&["", "value"]);
        table.row(vec!["k_yy".into(), "5".into()]);
        table.row(vec!["N·m".into(), "±1234".into()]);
        assert_eq!(
            table.render(),
            "        value\n  k_yy      5\n  N·m   ±1234\n"
        );
    }
}
