//! Receptances of a substructure, computed or measured.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;

use bolted_joint_frf::structure::ComplexMatrix;

use super::lines::chosen;
use super::parallel;
use super::roughness::{Roughness, ShownNoise};

/// Receptances of a substructure between the joint's DOFs, bolt by bolt, and then its points, at each line.
#[derive(Clone, Debug)]
pub enum Receptances {
    /// Computed, or taken for exact.
    Exact(Vec<ComplexMatrix>),
    /// Formed from what was measured line by line. Assemblies may share it.
    Measured(Arc<MeasuredSubstructure>),
}

impl Receptances {
    /// H at a line.
    #[must_use]
    pub fn at(&self, line: usize) -> Cow<'_, ComplexMatrix> {
        match self {
            Self::Exact(matrices) => Cow::Borrowed(&matrices[line]),
            Self::Measured(measured) => Cow::Owned(measured.formed(line)),
        }
    }

    /// An entry of the symmetric H over all lines.
    pub(super) fn function(&self, i: usize, j: usize) -> Function<'_> {
        match self {
            Self::Exact(matrices) => Function::Exact {
                matrices,
                places: [i + j * self.size(), j + i * self.size()],
            },
            Self::Measured(measured) => measured.formed_function(i, j),
        }
    }

    /// At these lines.
    pub(super) fn at_lines(&self, lines: &[usize]) -> Self {
        match self {
            Self::Exact(matrices) => Self::Exact(chosen(matrices, lines)),
            Self::Measured(measured) => Self::Measured(Arc::new(measured.at_lines(lines))),
        }
    }

    /// What they were formed from, if measured.
    #[must_use]
    pub fn measured(&self) -> Option<&Arc<MeasuredSubstructure>> {
        match self {
            Self::Exact(_) => None,
            Self::Measured(measured) => Some(measured),
        }
    }

    /// Rows and columns of each matrix; 0 without lines.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::Exact(matrices) => matrices.first().map_or(0, |matrix| matrix.nrows()),
            Self::Measured(measured) => measured.transformation.nrows(),
        }
    }
}

/// One entry of the symmetric H of a substructure over all lines.
pub(super) enum Function<'r> {
    /// The mean of an entry and its transpose.
    Exact {
        matrices: &'r [ComplexMatrix],
        /// Their places in a matrix as it is stored, column by column.
        places: [usize; 2],
    },
    /// Σ share·U_pq, and what is lost.
    Formed {
        terms: Vec<(f64, &'r [Complex64])>,
        lost: f64,
    },
}

impl Function<'_> {
    /// At these lines, one after the other.
    pub(super) fn over(&self, lines: &[usize]) -> Vec<Complex64> {
        let Self::Formed { terms, lost } = self else {
            return lines.iter().map(|&line| self.at(line)).collect();
        };
        let mut sums = vec![Complex64::ZERO; lines.len()];
        for (share, values) in terms {
            for (sum, &line) in sums.iter_mut().zip(lines) {
                *sum += values[line] * share;
            }
        }
        if *lost != 0.0 {
            sums.iter_mut().for_each(|sum| *sum += lost);
        }
        sums
    }

    #[inline]
    pub(super) fn at(&self, line: usize) -> Complex64 {
        match self {
            Self::Exact { matrices, places } => {
                let values = matrices[line].as_slice();
                (values[places[0]] + values[places[1]]) * 0.5
            }
            Self::Formed { terms, lost } => {
                let of_term = |(share, values): &(f64, &[Complex64])| values[line] * share;
                terms.iter().map(of_term).sum::<Complex64>() + lost
            }
        }
    }
}

/// Receptances with what is lost at the joint's DOFs, which come first.
pub(super) fn with_lost(mut formed: ComplexMatrix, lost: Option<&DMatrix<f64>>) -> ComplexMatrix {
    if let Some(lost) = lost {
        for i in 0..lost.nrows() {
            for j in 0..lost.ncols() {
                formed[(i, j)] += lost[(i, j)];
            }
        }
    }
    formed
}

/// Where an entry is in the upper triangle, column by column.
fn place(row: usize, column: usize) -> usize {
    let (row, column) = (row.min(column), row.max(column));
    column * (column + 1) / 2 + row
}

/// Measured receptances from which those of a substructure are formed.
#[derive(Clone, Debug)]
pub struct MeasuredSubstructure {
    transformation: DMatrix<f64>,
    /// W as complex numbers.
    complex: ComplexMatrix,
    /// The upper triangle of U column by column, each entry over all lines.
    functions: Vec<Arc<Vec<Complex64>>>,
    measured: Vec<(usize, usize)>,
    relative_variance: Option<Vec<Vec<f64>>>,
    /// What is added at the joint's DOFs: what rotations by differences lose.
    lost: Option<DMatrix<f64>>,
    /// Which of the measured DOFs are rotations; none, if nothing is said.
    rotations: Vec<bool>,
    frequency_hz: Vec<f64>,
    /// What each of `functions` shows of its noise.
    shown: ShownNoise,
    /// The same as it was measured, where `functions` are those with a mass that is known.
    before: Option<Arc<MeasuredSubstructure>>,
}

impl MeasuredSubstructure {
    /// From W, the motion of the joint's DOFs, then of the points, by that of the measured DOFs; the upper triangle of the
    /// symmetric U, column by column, each entry over all lines; the entries (row, column) of U that were `measured`, each
    /// independently of the others; and the variance of each of these at each line as a fraction of |U|², where it is known.
    ///
    /// # Panics
    /// If there are not as many `functions` as the triangle has entries.
    #[must_use]
    pub fn new(
        transformation: DMatrix<f64>,
        functions: Vec<Vec<Complex64>>,
        measured: Vec<(usize, usize)>,
        relative_variance: Option<Vec<Vec<f64>>>,
    ) -> Self {
        let labels = transformation.ncols();
        assert_eq!(functions.len(), labels * (labels + 1) / 2);
        Self {
            complex: transformation.map(Complex64::from),
            transformation,
            functions: functions.into_iter().map(Arc::new).collect(),
            measured,
            relative_variance,
            lost: None,
            rotations: Vec::new(),
            frequency_hz: Vec::new(),
            shown: ShownNoise::default(),
            before: None,
        }
    }

    /// With other functions, `change` of U at each line, such as those with a mass that is known. `None` where one has no value.
    pub(super) fn changed(
        self,
        change: impl Fn(usize, ComplexMatrix) -> Option<ComplexMatrix>,
    ) -> Option<Self> {
        let lines = self.functions.first().map_or(0, |function| function.len());
        let matrices: Option<Vec<ComplexMatrix>> = (0..lines)
            .map(|line| change(line, self.receptance(line)))
            .collect();
        let matrices = matrices?;
        let columns = 0..self.transformation.ncols();
        let places = columns.flat_map(|column| (0..=column).map(move |row| (row, column)));
        let of = |place| Arc::new(matrices.iter().map(|matrix| matrix[place]).collect());
        Some(Self {
            functions: places.map(of).collect(),
            shown: ShownNoise::default(),
            before: Some(Arc::new(self.clone())),
            ..self
        })
    }

    /// As it was measured, without a mass that is known.
    pub(super) fn as_measured(&self) -> &Self {
        self.before.as_deref().unwrap_or(self)
    }

    /// With what rotations by differences lose at the joint's DOFs, rad/(N·m).
    #[must_use]
    pub fn with_lost(self, lost: Option<DMatrix<f64>>) -> Self {
        Self { lost, ..self }
    }

    /// What is added at the joint's DOFs.
    pub(super) fn lost(&self) -> Option<&DMatrix<f64>> {
        self.lost.as_ref()
    }

    /// With the frequency of each line, and which of the measured DOFs are rotations. Without them lines are taken for evenly
    /// spaced, and DOFs for translations.
    #[must_use]
    pub fn with_axis(self, frequency_hz: &[f64], rotations: Vec<bool>) -> Self {
        Self {
            frequency_hz: frequency_hz.to_vec(),
            rotations,
            ..self
        }
    }

    /// Whether a measured DOF is a rotation.
    pub(super) fn is_rotation(&self, label: usize) -> bool {
        self.rotations.get(label) == Some(&true)
    }

    /// Lines that were measured.
    pub(super) fn lines(&self) -> usize {
        self.functions.first().map_or(0, |function| function.len())
    }

    /// Noise of each of `functions`, as it shows by itself.
    fn roughness(&self) -> &[Roughness] {
        self.shown.functions(|| self.find_roughness())
    }

    fn find_roughness(&self) -> Vec<Roughness> {
        let even: Vec<f64> = (0..self.lines()).map(|line| line as f64).collect();
        let axis = match self.frequency_hz.is_empty() {
            true => &even,
            false => &self.frequency_hz,
        };
        parallel::map(&self.functions, |function| {
            Roughness::of(axis, function, None)
        })
    }

    /// The same of those that were measured, by row and column.
    pub(super) fn measured_functions(&self) -> Vec<((usize, usize), &Roughness)> {
        let columns = 0..self.transformation.ncols();
        let places = columns.flat_map(|column| (0..=column).map(move |row| (row, column)));
        let is_measured = |&((row, column), _): &((usize, usize), &Roughness)| {
            self.measured.contains(&(row, column)) || self.measured.contains(&(column, row))
        };
        places.zip(self.roughness()).filter(is_measured).collect()
    }

    /// Floor of the noise of an entry of U, in its unit.
    pub(super) fn floor(&self, row: usize, column: usize) -> f64 {
        self.shown.floors(|| self.find_roughness())[place(row, column)]
    }

    /// At these lines. The noise is as all lines show it.
    fn at_lines(&self, lines: &[usize]) -> Self {
        let functions = self.functions.iter();
        let known = self.relative_variance.as_ref();
        let axis = &self.frequency_hz;
        Self {
            shown: self.shown.of_fewer_lines(|| self.find_roughness()),
            functions: functions
                .map(|function| Arc::new(chosen(function, lines)))
                .collect(),
            relative_variance: known
                .map(|known| known.iter().map(|known| chosen(known, lines)).collect()),
            before: self
                .before
                .as_ref()
                .map(|before| Arc::new(before.at_lines(lines))),
            frequency_hz: match axis.is_empty() {
                true => lines.iter().map(|&line| line as f64).collect(),
                false => chosen(axis, lines),
            },
            ..self.clone()
        }
    }

    /// With other values: each line's times a factor.
    pub(super) fn multiplied(&self, factors: &[Complex64]) -> Self {
        let multiplied = |function: &Arc<Vec<Complex64>>| {
            let pairs = function.iter().zip(factors);
            Arc::new(pairs.map(|(value, factor)| value * factor).collect())
        };
        Self {
            functions: self.functions.iter().map(multiplied).collect(),
            shown: ShownNoise::default(),
            ..self.clone()
        }
    }

    /// With some of the motions reversed.
    pub(super) fn with_reversed(&self, motions: impl Iterator<Item = usize>) -> Self {
        let mut reversed = self.clone();
        for motion in motions {
            reversed.transformation.row_mut(motion).neg_mut();
            reversed.complex.row_mut(motion).neg_mut();
        }
        reversed
    }

    /// W: motion of the joint's DOFs, then of the points, by that of the measured DOFs: H = W U Wᵀ.
    #[must_use]
    pub fn transformation(&self) -> &DMatrix<f64> {
        &self.transformation
    }

    /// Entries (row, column) of U that were measured.
    #[must_use]
    pub fn measured(&self) -> &[(usize, usize)] {
        &self.measured
    }

    /// Variance of each of the measured entries at each line as a fraction of |U|², where it is known line by line.
    #[must_use]
    pub fn relative_variance(&self) -> Option<&[Vec<f64>]> {
        self.relative_variance.as_deref()
    }

    /// An entry of U over all lines.
    #[must_use]
    pub fn function(&self, row: usize, column: usize) -> &Arc<Vec<Complex64>> {
        &self.functions[place(row, column)]
    }

    /// U at a line.
    #[must_use]
    pub fn receptance(&self, line: usize) -> ComplexMatrix {
        let labels = self.transformation.ncols();
        ComplexMatrix::from_fn(labels, labels, |row, column| {
            self.function(row, column)[line]
        })
    }

    /// What a symmetric change of the entry (p, q) of U changes of the entry (i, j) of H.
    pub(super) fn share(&self, (i, j): (usize, usize), (p, q): (usize, usize)) -> f64 {
        let w = &self.transformation;
        let once = w[(i, p)] * w[(j, q)];
        if p == q {
            once
        } else {
            once + w[(i, q)] * w[(j, p)]
        }
    }

    /// An entry of H = W U Wᵀ   (Tol 3.54).
    fn formed_function(&self, i: usize, j: usize) -> Function<'_> {
        let columns = 0..self.transformation.ncols();
        let places = columns.flat_map(|q| (0..=q).map(move |p| (p, q)));
        let terms = places.zip(&self.functions).map(|(place, function)| {
            let share = self.share((i, j), place);
            (share, function.as_slice())
        });
        let lost = self.lost.as_ref().map_or(0.0, |lost| {
            let of = |place: (usize, usize)| lost.get(place).map_or(0.0, |lost: &f64| *lost);
            0.5 * (of((i, j)) + of((j, i)))
        });
        Function::Formed {
            terms: terms.filter(|(share, _)| *share != 0.0).collect(),
            lost,
        }
    }

    /// H at a line.
    fn formed(&self, line: usize) -> ComplexMatrix {
        let formed = &self.complex * self.receptance(line) * self.complex.transpose();
        with_lost(formed, self.lost.as_ref())
    }
}
