//! Beams of section 4.2.2 measured at every point that the joint needs, with noise on the assembly or on everything, and
//! the Cramér–Rao bound of such data.
//!
//! The bound is computed here from finite differences of the coupled receptances; no derivative of the program is used.

use std::sync::Arc;

use bolted_joint::identify::{
    JointMatrices, JointModel, Lines, MeasuredSubstructure, NoiseLevel, Receptances,
};
use bolted_joint::structure::{Beam, Boundary, ComplexMatrix, Partition, couple};
use nalgebra::{DMatrix, DVector, dmatrix};
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::beams::{beam, names, pairs, translations};

/// A test rig: what is measured without noise, and the joint in it.
pub(crate) struct Rig {
    pub(crate) name: &'static str,
    pub(crate) joint: JointMatrices,
    pub(crate) model: JointModel,
    frequency_hz: Vec<f64>,
    /// A's receptances at three points, B's at three points and where the assembly is measured.
    a: Vec<ComplexMatrix>,
    b: Vec<ComplexMatrix>,
    a_transformation: DMatrix<f64>,
    b_transformation: DMatrix<f64>,
}

/// How the beams are measured.
pub(crate) struct Setup {
    /// Distance of the three points about the joint, m.
    pub(crate) spacing_m: f64,
    /// Of every mode of both beams.
    pub(crate) damping_ratio: f64,
    pub(crate) frequency_hz: Vec<f64>,
}

/// Points and damping of section 4.2.2.
pub(crate) fn thesis(frequency_hz: Vec<f64>) -> Setup {
    Setup {
        spacing_m: 0.015,
        damping_ratio: 0.01,
        frequency_hz,
    }
}

/// Stiff and soft joints with light and heavy damping, on 500 lines up to 1,500 Hz and with points 80 mm apart. With the
/// thesis's 15 mm and 500 Hz, errors on everything leave bounds of a hundred per cent and more for the stiff joints.
pub(crate) fn stiff_and_soft() -> Vec<Rig> {
    [
        ("stiff joint, light damping", 5.0, 5.0, 0.002),
        ("stiff joint, heavy damping", 5.0, 50.0, 0.03),
        ("soft joint, light damping", 0.1, 0.3, 0.002),
        ("soft joint, heavy damping", 0.1, 1.0, 0.03),
    ]
    .into_iter()
    .map(|(name, factor, damping, damping_ratio)| {
        let setup = Setup {
            spacing_m: 0.08,
            damping_ratio,
            frequency_hz: (1..=500).map(|line| 3.0 * f64::from(line)).collect(),
        };
        Rig::new(name, joint(factor, damping), setup)
    })
    .collect()
}

/// What carries noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Noisy {
    Assembly,
    /// B is computed, as in the thesis.
    AssemblyAndA,
    Everything,
}

impl Rig {
    pub(crate) fn new(name: &'static str, joint: JointMatrices, setup: Setup) -> Self {
        let Setup {
            spacing_m,
            damping_ratio,
            frequency_hz,
        } = setup;
        let receptances = |beam: Beam, positions: &[f64]| {
            let points = translations(positions);
            beam.receptances(&points, &frequency_hz).unwrap()
        };
        let slope = 0.5 / spacing_m;
        let difference = dmatrix![0.0, 1.0, 0.0; -slope, 0.0, slope];
        let a = receptances(
            beam(0.3, Boundary::FixedFree, damping_ratio),
            &[0.3 - 2.0 * spacing_m, 0.3 - spacing_m, 0.3],
        );
        let b = receptances(
            beam(0.225, Boundary::FreeFree, damping_ratio),
            &[0.0, spacing_m, 2.0 * spacing_m, 0.195, 0.21, 0.225],
        );
        let mut whole = DMatrix::zeros(5, 6);
        whole.view_mut((0, 0), (2, 3)).copy_from(&difference);
        whole.view_mut((2, 3), (3, 3)).fill_with_identity();
        let model = if joint.stiffness[(0, 1)] == 0.0 && joint.damping[(0, 1)] == 0.0 {
            JointModel::Diagonal
        } else {
            JointModel::Full
        };
        Self {
            name,
            joint,
            model,
            frequency_hz,
            a,
            b,
            a_transformation: difference,
            b_transformation: whole,
        }
    }

    pub(crate) fn truth(&self) -> Vec<f64> {
        unknowns(self.model, &self.joint)
    }

    /// Lines with multiplicative noise of this level, everything measured by all pairs.
    pub(crate) fn lines(&self, noisy: Noisy, level: NoiseLevel, seed: u64) -> Lines {
        let joints = std::slice::from_ref(&self.joint);
        self.assemblies(joints, noisy, level, seed).remove(0)
    }

    /// The same of one assembly for each of `joints`; the substructures were measured once.
    pub(crate) fn assemblies(
        &self,
        joints: &[JointMatrices],
        noisy: Noisy,
        level: NoiseLevel,
        seed: u64,
    ) -> Vec<Lines> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut polluted = |matrix: &ComplexMatrix| {
            matrix.map(|value| {
                let sigma = (level.relative * level.relative * value.norm_sqr()
                    + level.floor * level.floor)
                    .sqrt();
                let part = sigma * std::f64::consts::FRAC_1_SQRT_2;
                let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
                value + Complex64::new(part * normal(), part * normal())
            })
        };
        let (mut a, mut b) = (self.a.clone(), self.b.clone());
        let of = |joint: &JointMatrices| -> Vec<ComplexMatrix> {
            (0..self.frequency_hz.len())
                .map(|line| self.assembly_at(joint, line, &a[line], &b[line]))
                .collect()
        };
        let mut assemblies: Vec<Vec<ComplexMatrix>> = joints.iter().map(of).collect();
        for matrix in assemblies.iter_mut().flatten() {
            *matrix = polluted(matrix);
        }
        let of_b = if noisy == Noisy::Everything {
            &mut b[..]
        } else {
            &mut []
        };
        if noisy != Noisy::Assembly {
            for matrix in a.iter_mut().chain(of_b) {
                let noisy = polluted(matrix);
                *matrix = (&noisy + noisy.transpose()) * Complex64::from(0.5);
            }
        }
        let receptances = |w: &DMatrix<f64>, u: &[ComplexMatrix], is_noisy: bool| {
            if !is_noisy {
                return Receptances::Exact(formed(u, w));
            }
            let count = w.ncols();
            let triangle = (0..count).flat_map(|q| (0..=q).map(move |p| (p, q)));
            let functions = triangle.map(|place| u.iter().map(|u| u[place]).collect());
            let functions = functions.collect();
            let measured = MeasuredSubstructure::new(w.clone(), functions, pairs(count), None);
            Receptances::Measured(Arc::new(measured))
        };
        let first = Lines {
            frequency_hz: self.frequency_hz.clone(),
            a: receptances(&self.a_transformation, &a, noisy != Noisy::Assembly),
            b: receptances(&self.b_transformation, &b, noisy == Noisy::Everything),
            assembly: Vec::new(),
            points: names(3),
            measured: pairs(3),
            relative_variance: None,
            repeats: None,
            shown: Default::default(),
            apart: None,
        };
        let with = |assembly| Lines {
            assembly,
            ..first.clone()
        };
        assemblies.into_iter().map(with).collect()
    }

    fn assembly_at(
        &self,
        joint: &JointMatrices,
        line: usize,
        a: &ComplexMatrix,
        b: &ComplexMatrix,
    ) -> ComplexMatrix {
        let of = |u: &ComplexMatrix, w: &DMatrix<f64>| {
            let w = w.map(Complex64::from);
            Partition::of(&(&w * u * w.transpose()), 2)
        };
        let (a, b) = (of(a, &self.a_transformation), of(b, &self.b_transformation));
        let stiffness = joint.complex_stiffness(self.frequency_hz[line]);
        couple(&a, &b, &stiffness).unwrap().ss
    }

    /// The smallest standard deviation that an unbiased estimate of each unknown can have.
    pub(crate) fn bound(&self, noisy: Noisy, level: NoiseLevel) -> Vec<f64> {
        let covariance = self.bound_of_all(std::slice::from_ref(&self.joint), noisy, level);
        covariance.diagonal().iter().map(|v| v.sqrt()).collect()
    }

    /// The smallest covariance that an unbiased estimate of the unknowns of one joint after the other can have, from one
    /// assembly for each of `joints` and substructures that were measured once.
    pub(crate) fn bound_of_all(
        &self,
        joints: &[JointMatrices],
        noisy: Noisy,
        level: NoiseLevel,
    ) -> DMatrix<f64> {
        let own = self.truth().len();
        let size = joints.len() * own;
        let mut information = DMatrix::zeros(size, size);
        for line in 0..self.frequency_hz.len() {
            let (a, b) = (&self.a[line], &self.b[line]);
            // The upper triangles of all assemblies, one after the other.
            let stacked = |of: &dyn Fn(usize) -> ComplexMatrix| -> DVector<Complex64> {
                let entries = (0..joints.len()).flat_map(|number| {
                    let matrix = of(number);
                    let upper = (0..3).flat_map(|i| (i..3).map(move |j| (i, j)));
                    upper.map(move |place| matrix[place])
                });
                DVector::from_iterator(6 * joints.len(), entries)
            };
            let at = |joint: &JointMatrices| self.assembly_at(joint, line, a, b);
            let derivatives: Vec<DVector<Complex64>> = (0..size)
                .map(|index| {
                    let truth = unknowns(self.model, &joints[index / own]);
                    let scale = if truth[index % own] == 0.0 {
                        truth[0].abs() * 1e-3
                    } else {
                        truth[index % own].abs()
                    };
                    let step = 1e-5 * scale;
                    let moved = |step: f64| {
                        stacked(&|number| {
                            let mut values = unknowns(self.model, &joints[number]);
                            if number == index / own {
                                values[index % own] += step;
                            }
                            at(&matrices(self.model, &values))
                        })
                    };
                    (moved(step) - moved(-step)) / Complex64::from(2.0 * step)
                })
                .collect();
            let variance = |value: Complex64| {
                level.relative * level.relative * value.norm_sqr() + level.floor * level.floor
            };
            // Off the diagonal two measurements of one number.
            let counts = [1.0, 2.0, 2.0, 1.0, 2.0, 1.0];
            let whole = stacked(&|number| at(&joints[number]));
            let variances = whole.iter().enumerate();
            let variances = variances.map(|(e, &h)| Complex64::from(variance(h) / counts[e % 6]));
            let mut covariance =
                DMatrix::from_diagonal(&DVector::from_iterator(whole.len(), variances));
            let sides: &[&ComplexMatrix] = match noisy {
                Noisy::Assembly => &[],
                Noisy::AssemblyAndA => &[a],
                Noisy::Everything => &[a, b],
            };
            for (side, &u) in sides.iter().enumerate() {
                for p in 0..u.nrows() {
                    for q in p..u.ncols() {
                        let step = 1e-6 * u[(p, q)].norm();
                        let moved = |step: f64| {
                            let mut moved = u.clone();
                            moved[(p, q)] += step;
                            if p != q {
                                moved[(q, p)] += step;
                            }
                            let (a, b) = if side == 0 { (&moved, b) } else { (a, &moved) };
                            stacked(&|number| self.assembly_at(&joints[number], line, a, b))
                        };
                        let j = (moved(step) - moved(-step)) / Complex64::from(2.0 * step);
                        let count = if p == q { 1.0 } else { 2.0 };
                        let s = variance(u[(p, q)]) / count;
                        covariance += &j * j.adjoint() * Complex64::from(s);
                    }
                }
            }
            // Fisher information of complex circular errors: 2 Re Jᴴ Σ⁻¹ J.
            let inverse = covariance.try_inverse().unwrap();
            for i in 0..size {
                for j in 0..size {
                    let product = derivatives[i].adjoint() * &inverse * &derivatives[j];
                    information[(i, j)] += 2.0 * product[(0, 0)].re;
                }
            }
        }
        let scale = information
            .diagonal()
            .map(|value: f64| value.sqrt().recip());
        let scaled = DMatrix::from_fn(size, size, |i, j| scale[i] * information[(i, j)] * scale[j]);
        let inverse = scaled.try_inverse().unwrap();
        DMatrix::from_fn(size, size, |i, j| scale[i] * inverse[(i, j)] * scale[j])
    }
}

fn formed(u: &[ComplexMatrix], w: &DMatrix<f64>) -> Vec<ComplexMatrix> {
    let w = w.map(Complex64::from);
    u.iter().map(|u| &w * u * w.transpose()).collect()
}

fn places(model: JointModel) -> &'static [(usize, usize)] {
    match model {
        JointModel::Translation => &[(0, 0)],
        JointModel::Diagonal => &[(0, 0), (1, 1)],
        JointModel::Full => &[(0, 0), (0, 1), (1, 1)],
    }
}

/// Stiffness of each entry, then damping.
pub(crate) fn unknowns(model: JointModel, joint: &JointMatrices) -> Vec<f64> {
    [&joint.stiffness, &joint.damping]
        .into_iter()
        .flat_map(|matrix| places(model).iter().map(|&place| matrix[place]))
        .collect()
}

pub(crate) fn matrices(model: JointModel, unknowns: &[f64]) -> JointMatrices {
    let (k, c) = unknowns.split_at(places(model).len());
    let matrix = |values: &[f64]| {
        let mut matrix = DMatrix::zeros(2, 2);
        for (&(i, j), &value) in places(model).iter().zip(values) {
            matrix[(i, j)] = value;
            matrix[(j, i)] = value;
        }
        matrix
    };
    JointMatrices {
        stiffness: matrix(k),
        damping: matrix(c),
    }
}

/// The joint of section 4.2.2 with coupling, `factor` times as stiff and `damping` times as damped.
pub(crate) fn joint(factor: f64, damping: f64) -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![1e5, 2e3; 2e3, 1e3] * factor,
        damping: dmatrix![5.0, -0.1; -0.1, 0.05] * damping,
    }
}
