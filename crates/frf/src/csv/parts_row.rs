//! A second row of names, below those of the functions: `real` and `imaginary`, as spreadsheets and other programs have them.

use super::column::{Part, said, split_unit};
use super::header::Names;
use crate::TableProblem;
use bolted_joint_files::misspelt::did_you_mean;
use bolted_joint_files::text_table::Cells;

impl Names {
    /// Whether this row, which is the next below the names, says what the columns hold: some name does not, and one of its cells does.
    pub(super) fn are_parts(&self, row: &str) -> bool {
        let lacks = self.columns.iter().any(|column| column.part.is_none());
        let mut cells = Cells::separated_by(self.separator);
        let names = cells.names(row);
        let part = |cell: &&str| said(split_unit(cell).0).is_some_and(|(part, _)| part.is_some());
        lacks && names.iter().skip(1).any(part)
    }

    /// Takes in that row. A function's name over its first column alone holds for those behind it as well.
    pub(super) fn take_parts(&mut self, row: &str) -> Result<(), TableProblem> {
        let mut cells = Cells::separated_by(self.separator);
        let cells = cells.names(row);
        while self.columns.len() + 1 < cells.len()
            && let Some(last) = self.columns.last()
        {
            self.columns.push(last.clone());
        }
        for (place, column) in self.columns.iter_mut().enumerate() {
            let cell = cells.get(place + 1).copied().unwrap_or_default();
            let (text, unit) = split_unit(cell);
            let refused = |expected: &str| {
                TableProblem::at(
                    format_args!("column {}", place + 2),
                    format_args!(
                        "\"{}\" below the name \"{}\"",
                        crate::shown(cell),
                        column.name
                    ),
                    expected,
                )
            };
            let (part, quantity) = said(text).ok_or_else(|| {
                let meant = did_you_mean(text, &Part::WORDS);
                refused(&format!("one of {}{meant}", Part::WORDS.join(", ")))
            })?;
            match (column.part, part) {
                (None, Some(part)) => column.part = Some(part),
                (None, None) => {
                    return Err(refused(&format!(
                        "one of {}, as the columns beside it have",
                        Part::WORDS.join(", ")
                    )));
                }
                (Some(_), Some(_)) => {
                    return Err(refused("it in the name or below it, not in both"));
                }
                (Some(_), None) => {}
            }
            if let (Some(unit), Some(above)) = (unit, &column.unit)
                && unit != above
            {
                return Err(refused("the same unit in both, or one of them alone"));
            }
            column.unit = unit.map(str::to_owned).or(column.unit.take());
            column.quantity = quantity.or(column.quantity);
        }
        Ok(())
    }
}
