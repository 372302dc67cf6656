//! Which lines of measured functions a study uses: one band or several, every line or every so many.

use super::{FrequencyTable, StudyError, StudyText};

/// Fewer lines than every hundred-thousandth are none.
const LARGEST_STEP: u64 = 100_000;

/// The lines that a study uses.
#[derive(Clone, Debug, PartialEq)]
pub struct LineChoice {
    /// Lowest and highest frequency of all, Hz.
    pub range_hz: [f64; 2],
    /// Bands within it, Hz, ascending; none where the whole range is used.
    pub bands_hz: Vec<[f64; 2]>,
    /// Of these lines the first is used, and then every so many.
    pub every: usize,
}

impl StudyText {
    /// The lines that `[frequency]` asks for; where an end is left out, everything there is.
    ///
    /// # Errors
    /// [`StudyError::Value`] for a key of `frequency` that cannot be used.
    pub fn line_choice(&self, table: &FrequencyTable) -> Result<LineChoice, StudyError> {
        let expected = "a whole number from 1, such as 4 for every fourth line";
        let every = table.every.unwrap_or(1);
        self.within("frequency.every", every, 1..=LARGEST_STEP, expected)?;
        let (range_hz, bands_hz) = match &table.bands {
            None => {
                let band = FrequencyTable {
                    every: None,
                    ..table.clone()
                };
                (self.frequency_range_hz(&band)?, Vec::new())
            }
            Some(bands) => {
                let is_alone = table.from.is_none() && table.to.is_none();
                let expected = "the ends in `bands` alone, such as bands = [[5, 100], [150, 500]]";
                self.ensure(is_alone, "frequency", "bands beside from or to", expected)?;
                let ends: Vec<f64> = bands.iter().flatten().copied().collect();
                let expected = "bands [from, to] in Hz, from above 0, ascending and apart";
                self.ascending("frequency.bands", &ends, 2, expected)?;
                ([ends[0], ends[ends.len() - 1]], bands.clone())
            }
        };
        Ok(LineChoice {
            range_hz,
            bands_hz,
            every: usize::try_from(every).unwrap_or(usize::MAX),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn of(text: &str) -> Result<LineChoice, String> {
        let study = StudyText::new(text, Path::new("s.toml"));
        let table: FrequencyTable = study.tables().unwrap();
        study.line_choice(&table).map_err(|e| e.to_string())
    }

    #[test]
    fn bands_and_thinning_are_read_and_refused() {
        let choice = of("bands = [[5, 100], [150.5, 500]]\nevery = 4").unwrap();
        assert_eq!(choice.range_hz, [5.0, 500.0]);
        assert_eq!((choice.bands_hz.len(), choice.every), (2, 4));
        assert_eq!(of("from = 5\nto = 9").unwrap().range_hz, [5.0, 9.0]);
        assert_eq!(of("").unwrap().every, 1);
        for (text, said) in [
            (
                "every = 0",
                "`frequency.every`: found 0, expected a whole number",
            ),
            ("bands = []", "`frequency.bands`: found []"),
            ("bands = [[5, 4]]", "ascending and apart"),
            ("bands = [[5, 10], [9, 12]]", "ascending and apart"),
            ("bands = [[-5, 10]]", "from above 0"),
            ("bands = [[5, inf]]", "ascending"),
            ("bands = [[5, 10]]\nto = 3", "found bands beside from or to"),
        ] {
            let refused = of(text).unwrap_err();
            assert!(refused.contains(said), "{text}: {refused}");
        }
        let study = StudyText::new("every = 2", Path::new("s.toml"));
        let table: FrequencyTable = study.tables().unwrap();
        let refused = study.frequency_range_hz(&table).unwrap_err().to_string();
        assert!(refused.contains("`from` and `to` only"), "{refused}");
    }
}
