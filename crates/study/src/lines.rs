//! Which lines of measured functions a study uses: one band or several, every line or every so many.

use std::fmt;

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

/// By how much of the lines' distance an end has to be farther off to be out of the data's reach: files round their frequencies.
const A_LINE: f64 = 1.001;

impl LineChoice {
    /// Every line of a range, Hz.
    #[must_use]
    pub fn every_line_of(range_hz: [f64; 2]) -> Self {
        Self {
            range_hz,
            bands_hz: Vec::new(),
            every: 1,
        }
    }

    /// That the data, `of_what`, do not reach as far as the range that is stated, so that less of it is used; `None` where they do
    /// to within a line. `used_hz` are the lines that are used, ascending, of each table that has lines of its own.
    #[must_use]
    pub fn cut_back<'l>(
        &self,
        used_hz: impl IntoIterator<Item = &'l [f64]>,
        of_what: impl fmt::Display,
    ) -> Option<String> {
        // each end with the distance to the line beside it
        let [mut first, mut last] = [[f64::INFINITY, 0.0], [0.0, 0.0]];
        for lines in used_hz {
            if let [begin, second, ..] = lines
                && *begin < first[0]
            {
                first = [*begin, second - begin];
            }
            if let [.., before, end] = lines
                && *end > last[0]
            {
                last = [*end, end - before];
            }
        }
        let stated_hz = self.stated_range_hz();
        let [from, to] = stated_hz;
        let is_any = first[0] <= last[0];
        let starts_late = from.is_some_and(|from| first[0] - from > A_LINE * first[1]);
        let ends_early = to.is_some_and(|to| to - last[0] > A_LINE * last[1]);
        let stated = match stated_hz {
            [Some(from), Some(to)] => format!("from {from} to {to} Hz"),
            [Some(from), None] => format!("from {from} Hz"),
            [None, Some(to)] => format!("to {to} Hz"),
            [None, None] => return None,
        };
        let key = match self.bands_hz.is_empty() {
            true => "frequency",
            false => "frequency.bands",
        };
        let [low, high] = [first[0], last[0]].map(|hz| (hz * 1e6).round() / 1e6);
        (is_any && (starts_late || ends_early)).then(|| {
            format!(
                "`{key}`: found {stated}, but the lines of {of_what} that are used go from {low} to {high} Hz only; state what was \
                 measured, or give data that reach farther"
            )
        })
    }

    /// The ends of the range that the study states, Hz.
    #[must_use]
    pub fn stated_range_hz(&self) -> [Option<f64>; 2] {
        let [from, to] = self.range_hz;
        [
            (from > f64::MIN_POSITIVE).then_some(from),
            (to < f64::MAX).then_some(to),
        ]
    }
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
    fn a_range_beyond_the_data_is_told_by_more_than_a_line() {
        let lines: Vec<f64> = (20..=400).map(|line| 0.5 * f64::from(line)).collect();
        #[rustfmt::skip]
        let cases = [
            ("from = 10\nto = 200", None),
            ("from = 9.6\nto = 200.4", None),
            ("from = 9.5\nto = 200.5", None),
            ("", None),
            ("from = 5", Some("`frequency`: found from 5 Hz")),
            ("from = 1\nto = 200", Some("`frequency`: found from 1 to 200 Hz, but the lines of t.uff that are used go from 10 to 200 Hz only")),
            ("to = 900", Some("`frequency`: found to 900 Hz")),
            ("bands = [[10, 50], [90, 900]]", Some("`frequency.bands`: found from 10 to 900 Hz")),
        ];
        for (text, said) in cases {
            let told = of(text).unwrap().cut_back([&lines[..]], "t.uff");
            match (told, said) {
                (told, None) => assert_eq!(told, None, "{text}"),
                (told, Some(said)) => assert!(
                    told.as_ref().is_some_and(|told| told.contains(said)),
                    "{text}: {told:?}"
                ),
            }
        }
        // of several tables the one that reaches farthest counts, with its own lines
        let choice = of("from = 10\nto = 400").unwrap();
        let other = [250.0, 300.0, 350.0];
        assert_eq!(choice.cut_back([&lines[..], &other], "both"), None);
        // every hundredth line: none is missing where the next one would be beyond
        let thin: Vec<f64> = lines.iter().copied().step_by(100).collect();
        assert_eq!(
            of("to = 200\nevery = 100")
                .unwrap()
                .cut_back([&thin[..]], "t"),
            None
        );
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
