//! Averages of the decoupled stiffness over bands: the classical estimate, and the start of the refined one.

use bolted_joint_frf::structure::ComplexMatrix;
use bolted_joint_statistics::median;
use nalgebra::DMatrix;

use super::model::{JointMatrices, JointModel};

/// Frequency bands, from and to in Hz, over which each entry of the joint's matrices is averaged.
///
/// An entry without bands is the median over all lines: without a choice of bands some lines are far off, because the
/// receptances do not depend on the joint there, and a mean would follow them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bands {
    /// Bands for k_Fy and c_Fy.
    pub yy: Vec<[f64; 2]>,
    /// Bands for k_Fθ and c_Fθ.
    pub ytheta: Vec<[f64; 2]>,
    /// Bands for k_Mθ and c_Mθ.
    pub thetatheta: Vec<[f64; 2]>,
}

/// How the lines are found over which an entry is averaged.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum BandChoice {
    /// Bands by sensitivity and distance to the substructures' resonances, at the estimate.
    #[default]
    Automatic,
    /// The median over all lines.
    Median,
    /// These bands, Hz.
    Given(Vec<[f64; 2]>),
}

/// The choice for each entry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandChoices {
    /// For k_Fy and c_Fy.
    pub yy: BandChoice,
    /// For k_Fθ and c_Fθ.
    pub ytheta: BandChoice,
    /// For k_Mθ and c_Mθ.
    pub thetatheta: BandChoice,
}

/// The bands that are given; medians elsewhere.
impl From<Bands> for BandChoices {
    fn from(bands: Bands) -> Self {
        let choice = |bands: Vec<[f64; 2]>| match bands.as_slice() {
            [] => BandChoice::Median,
            _ => BandChoice::Given(bands),
        };
        Self {
            yy: choice(bands.yy),
            ytheta: choice(bands.ytheta),
            thetatheta: choice(bands.thetatheta),
        }
    }
}

impl BandChoices {
    /// The same choice for every entry.
    #[must_use]
    pub fn all(choice: BandChoice) -> Self {
        Self {
            yy: choice.clone(),
            ytheta: choice.clone(),
            thetatheta: choice,
        }
    }

    /// The choice for the entry at this row and column of the joint's matrices.
    #[must_use]
    pub fn of_entry(&self, entry: (usize, usize)) -> &BandChoice {
        match entry {
            (0, 0) => &self.yy,
            (1, 1) => &self.thetatheta,
            _ => &self.ytheta,
        }
    }

    pub(super) fn any_is_automatic(&self) -> bool {
        let all = [&self.yy, &self.ytheta, &self.thetatheta];
        all.contains(&&BandChoice::Automatic)
    }

    /// The bands that are given.
    #[must_use]
    pub fn given(&self) -> Bands {
        let given = |choice: &BandChoice| match choice {
            BandChoice::Given(bands) => bands.clone(),
            BandChoice::Automatic | BandChoice::Median => Vec::new(),
        };
        Bands {
            yy: given(&self.yy),
            ytheta: given(&self.ytheta),
            thetatheta: given(&self.thetatheta),
        }
    }
}

/// Where the lines of an average come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BandOrigin {
    /// The study gives the bands.
    Given,
    /// The bands are chosen.
    Automatic,
    /// All lines, because no band qualifies.
    NoneQualifies,
    /// All lines, as asked for.
    Median,
}

/// The bands that one entry was averaged over; empty for the median over all lines.
#[derive(Clone, Debug, PartialEq)]
pub struct UsedBands {
    /// Name of the entry in a study: `yy`, `ytheta` or `thetatheta`.
    pub name: &'static str,
    /// From and to, Hz.
    pub bands: Vec<[f64; 2]>,
    /// Where they come from.
    pub origin: BandOrigin,
}

impl Bands {
    /// The bands of the entry at this row and column of the joint's matrices.
    pub(super) fn of_entry_mut(&mut self, entry: (usize, usize)) -> &mut Vec<[f64; 2]> {
        match entry {
            (0, 0) => &mut self.yy,
            (1, 1) => &mut self.thetatheta,
            _ => &mut self.ytheta,
        }
    }

    /// Those of one joint.
    pub(super) fn of_used(used: &[UsedBands]) -> Self {
        let of = |name: &str| {
            let found = used.iter().find(|used| used.name == name);
            found.map_or_else(Vec::new, |used| used.bands.clone())
        };
        Self {
            yy: of("yy"),
            ytheta: of("ytheta"),
            thetatheta: of("thetatheta"),
        }
    }

    /// The bands of the entry at this row and column of the joint's matrices.
    pub(super) fn of_entry(&self, entry: (usize, usize)) -> &[[f64; 2]] {
        match entry {
            (0, 0) => &self.yy,
            (1, 1) => &self.thetatheta,
            _ => &self.ytheta,
        }
    }
}

/// K and C of `model` from the decoupled K* of each line; `None` if an entry has no line to average.
#[must_use]
pub fn band_average(
    model: JointModel,
    frequency_hz: &[f64],
    decoupled: &[Option<ComplexMatrix>],
    bands: &Bands,
) -> Option<JointMatrices> {
    let bolt = [(frequency_hz, decoupled)];
    average_of_blocks(model, &bolt, &[0], bands)
}

/// The same of the blocks that begin on one of `starts` on the diagonals, of the lines of several assemblies.
pub(super) fn average_of_blocks(
    model: JointModel,
    all: &[(&[f64], &[Option<ComplexMatrix>])],
    starts: &[usize],
    bands: &Bands,
) -> Option<JointMatrices> {
    let size = model.dofs();
    let mut average = JointMatrices {
        stiffness: DMatrix::zeros(size, size),
        damping: DMatrix::zeros(size, size),
    };
    for &(row, column) in model.entries() {
        let bands = bands.of_entry((row, column));
        let within =
            |hz: f64| bands.is_empty() || bands.iter().any(|b| (b[0]..=b[1]).contains(&hz));
        let (mut stiffness, mut damping) = (Vec::new(), Vec::new());
        for &start in starts {
            let (row, column) = (start + row, start + column);
            for (frequency_hz, decoupled) in all {
                let lines = frequency_hz.iter().zip(*decoupled);
                for (&hz, whole) in lines.filter(|&(&hz, _)| within(hz)) {
                    let Some(whole) = whole else { continue };
                    // k = Re K*, c = Im K*/ω; the two off-diagonal entries of a symmetric joint are one number.
                    let entry = 0.5 * (whole[(row, column)] + whole[(column, row)]);
                    stiffness.push(entry.re);
                    damping.push(entry.im / (std::f64::consts::TAU * hz));
                }
            }
        }
        let summary = if bands.is_empty() { median } else { mean };
        let (k, c) = (summary(stiffness)?, summary(damping)?);
        for place in [(row, column), (column, row)] {
            average.stiffness[place] = k;
            average.damping[place] = c;
        }
    }
    Some(average)
}

/// What a study calls the entry at this row and column.
pub(super) fn name(entry: (usize, usize)) -> &'static str {
    match entry {
        (0, 0) => "yy",
        (1, 1) => "thetatheta",
        _ => "ytheta",
    }
}

fn mean(values: Vec<f64>) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use num_complex::Complex64;

    use super::*;

    #[test]
    fn bands_choose_the_lines_and_no_band_takes_the_median() {
        let frequency_hz = [1.0, 2.0, 3.0];
        let line = |k: f64, hz: f64| {
            let imaginary = std::f64::consts::TAU * hz * 10.0 * k;
            Some(ComplexMatrix::from_element(
                1,
                1,
                Complex64::new(k, imaginary),
            ))
        };
        let decoupled = [line(1.0, 1.0), line(5.0, 2.0), line(100.0, 3.0)];
        let entry = |bands: &Bands| {
            let average =
                band_average(JointModel::Translation, &frequency_hz, &decoupled, bands).unwrap();
            (average.stiffness[(0, 0)], average.damping[(0, 0)])
        };
        let (k, c) = entry(&Bands::default());
        assert!((k - 5.0).abs() < 1e-12 && (c - 50.0).abs() < 1e-12);
        let low = Bands {
            yy: vec![[0.5, 2.5]],
            ..Bands::default()
        };
        let (k, c) = entry(&low);
        assert!((k - 3.0).abs() < 1e-12 && (c - 30.0).abs() < 1e-12);
        let nowhere = Bands {
            yy: vec![[7.0, 8.0]],
            ..Bands::default()
        };
        assert!(
            band_average(JointModel::Translation, &frequency_hz, &decoupled, &nowhere).is_none()
        );
    }
}
