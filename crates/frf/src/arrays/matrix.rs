//! The matrix of a file of arrays, made into functions; only those and only the lines that are asked for are kept.

use std::collections::BTreeSet;
use std::path::Path;

use num_complex::Complex64;

use super::axes::Over;
use super::{Array, Element};
use crate::gathered::Gathered;
use crate::statement::{Stated, Statement};
use crate::summary::Statements;
use crate::{Coherence, Dof, FileFormat, FrfReading, Quantity, ReadOptions, TableProblem};

/// How the elements of a matrix lie.
pub(super) struct Place {
    pub(super) order: Vec<Over>,
    pub(super) shape: Vec<usize>,
    pub(super) fortran_order: bool,
}

impl Place {
    /// Response, reference and line of the element at each place, in the order of the file.
    fn each(&self) -> impl Iterator<Item = [usize; 3]> {
        let axes = self.shape.len();
        let mut at = vec![0; axes];
        let count: usize = self.shape.iter().product();
        (0..count).map(move |_| {
            let mut indices = [0; 3];
            for (&over, &index) in self.order.iter().zip(&at) {
                indices[match over {
                    Over::Response => 0,
                    Over::Reference => 1,
                    Over::Frequency => 2,
                }] = index;
            }
            for step in 0..axes {
                let axis = if self.fortran_order {
                    step
                } else {
                    axes - 1 - step
                };
                at[axis] += 1;
                if at[axis] < self.shape[axis] {
                    break;
                }
                at[axis] = 0;
            }
            indices
        })
    }
}

/// The functions that the names of a file of arrays make.
pub(super) struct Functions<'options> {
    pub(super) pairs: Vec<(Dof, Dof)>,
    pub(super) references: usize,
    pub(super) frequency_hz: Vec<f64>,
    pub(super) options: &'options ReadOptions,
}

impl Functions<'_> {
    fn wants(&self, (response, reference): (Dof, Dof)) -> bool {
        self.options.selection.wants(response, reference)
    }

    /// What each function is, if it is asked for; there is one unit for all, or one for each, or none.
    pub(super) fn stated(
        &self,
        quantity: Option<Quantity>,
        units: &[String],
    ) -> Result<Vec<Option<Stated>>, TableProblem> {
        self.pairs
            .iter()
            .enumerate()
            .map(|(place, &(response, reference))| {
                let unit = match units {
                    [one] => Some(one),
                    all => all.get(place),
                };
                let statement = Statement {
                    response,
                    reference,
                    quantity,
                    unit: unit.map(String::as_str),
                };
                self.wants((response, reference))
                    .then(|| statement.decide(self.options))
                    .transpose()
            })
            .collect()
    }

    /// The wanted lines of each wanted function, nothing of the others.
    pub(super) fn gather(
        &self,
        array: impl Array,
        place: &Place,
    ) -> Result<Vec<Vec<Complex64>>, TableProblem> {
        let first = self
            .frequency_hz
            .partition_point(|&hz| self.before_band(hz));
        let last = self
            .frequency_hz
            .partition_point(|&hz| self.before_band(hz) || self.in_band(hz));
        let mut lines: Vec<Vec<Complex64>> = self
            .pairs
            .iter()
            .map(|&pair| match self.wants(pair) {
                true => vec![Complex64::default(); last - first],
                false => Vec::new(),
            })
            .collect();
        let mut places = place.each();
        array.each(|element| {
            if let (Element::Number(value), Some([response, reference, line])) =
                (element, places.next())
            {
                let function = &mut lines[response * self.references + reference];
                if let Some(kept) = line
                    .checked_sub(first)
                    .and_then(|line| function.get_mut(line))
                {
                    *kept = value;
                }
            }
            Ok(())
        })?;
        Ok(lines)
    }

    fn in_band(&self, hz: f64) -> bool {
        self.options.selection.wants_line(hz)
    }

    fn before_band(&self, hz: f64) -> bool {
        self.options
            .selection
            .band_hz()
            .is_some_and(|[from, _]| hz < from)
    }

    pub(super) fn reading(
        self,
        format: FileFormat,
        path: &Path,
        stated: &[Option<Stated>],
        lines: Vec<Vec<Complex64>>,
        coherence: Option<Vec<Vec<Complex64>>>,
        averages: Option<f64>,
    ) -> Result<FrfReading, TableProblem> {
        let function = |source| TableProblem::Function(Box::new(source));
        let kept_hz: Vec<f64> = self
            .frequency_hz
            .iter()
            .copied()
            .filter(|&hz| self.in_band(hz))
            .collect();
        let mut reading = FrfReading {
            path: path.to_owned(),
            functions: Vec::new(),
            coherences: Vec::new(),
            averages: self.options.averages_or(averages),
            not_selected: BTreeSet::new(),
            skipped_functions: Vec::new(),
            skipped_datasets: Vec::new(),
            statements: Statements::default(),
            coherence_files: Vec::new(),
            taken: Vec::new(),
        };
        if stated.is_empty() {
            reading.statements.add_coherence(format);
        }
        for ((&pair, stated), values) in self.pairs.iter().zip(stated).zip(lines) {
            let Some(stated) = stated else {
                reading.not_selected.insert(pair);
                continue;
            };
            let gathered = Gathered::of_band(kept_hz.clone(), values, &self.frequency_hz);
            let selection = &self.options.selection;
            let frf = gathered.into_frf(pair, stated.quantity.0, stated.to_si, selection);
            reading.functions.push(frf.map_err(function)?);
            let units = stated.units.clone();
            reading.statements.add(format, stated.quantity, units);
        }
        for (&pair, values) in self.pairs.iter().zip(coherence.unwrap_or_default()) {
            if self.wants(pair) {
                let gamma_squared = values.iter().map(|value| value.re).collect();
                let coherence = Coherence::new(pair.0, pair.1, kept_hz.clone(), gamma_squared);
                reading.coherences.push(coherence.map_err(function)?);
            }
        }
        Ok(reading)
    }
}
