//! A straight uniform beam by finite elements: the substructure that is computed instead of measured.

use nalgebra::DMatrix;
use num_complex::Complex64;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::spatial::{Modes, SpatialModel};

/// Elements over the length of a beam. A frequency with root λ = βL is then too high by (λ/60)⁴/1440 of itself:
/// 8·10⁻⁷ for the third bending mode of a free beam, 6·10⁻⁵ for the tenth.
const ELEMENTS: f64 = 60.0;

/// Points closer to a node than this part of the length get no node of their own: an element so short (l⁻⁴ in the
/// eigenvalues) would drown the low modes in rounding. Within it the deflection is the element's own cubic.
const SHORTEST_ELEMENT: f64 = 1e-4;

/// Why a beam cannot be built.
#[derive(Debug, Error, PartialEq)]
pub enum BeamError {
    /// A dimension, modulus or density is not a positive number.
    #[error("beam.{key}: found {found}, expected a positive number in SI units")]
    NotPositive {
        /// Key of the study.
        key: &'static str,
        /// Value found.
        found: f64,
    },
    /// A damping ratio or loss factor is negative or not finite.
    #[error("beam.{key}: found {found}, expected a finite number that is not negative")]
    Damping {
        /// Key of the study.
        key: &'static str,
        /// Value found.
        found: f64,
    },
    /// An empty list of damping ratios.
    #[error(
        "beam.damping_ratio: found an empty list, expected one number or a number for each mode"
    )]
    NoDampingRatio,
    /// A point that is not on the beam.
    #[error("point at {position_m} m: expected a position on the beam, from 0 to {length_m} m")]
    OffTheBeam {
        /// Position, m.
        position_m: f64,
        /// Length of the beam, m.
        length_m: f64,
    },
    /// The receptance has no value: an undamped resonance, or 0 Hz where a body is free.
    #[error(
        "the beam has no finite receptance at {frequency_hz} Hz, {reason}; leave that line out{advice}"
    )]
    Resonance {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Why.
        reason: &'static str,
        /// What else helps.
        advice: &'static str,
    },
    /// The finite-element matrices have no modes.
    #[error("the beam has no modes ({0}); check its dimensions")]
    Modes(#[from] super::SpatialError),
}

/// How the two ends of a beam are held; the first word is the end at x = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Boundary {
    /// Both ends free.
    FreeFree,
    /// Fixed at x = 0, free at the other end.
    FixedFree,
    /// Free at x = 0, fixed at the other end.
    FreeFixed,
    /// Both ends fixed.
    FixedFixed,
    /// Both ends pinned.
    PinnedPinned,
    /// Fixed at x = 0, pinned at the other end.
    FixedPinned,
}

/// Damping of the beam's elastic modes.
#[derive(Clone, Debug, PartialEq)]
pub enum Damping {
    /// ζ of each mode in ascending order, rigid-body modes included; the last one holds for all higher modes.
    Ratios(Vec<f64>),
    /// Structural loss factor η: K (1 + jη).
    LossFactor(f64),
}

/// A uniform beam of rectangular cross-section that bends about its width.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Length, m.
    pub length_m: f64,
    /// Width of the cross-section, m.
    pub width_m: f64,
    /// Height of the cross-section in the direction of bending, m.
    pub height_m: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus_pa: f64,
    /// Density, kg/m³.
    pub density_kg_per_m3: f64,
    /// How the ends are held.
    pub boundary: Boundary,
    /// Damping.
    pub damping: Damping,
}

/// Which motion of a point on the beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Displacement w, m (and force, N).
    Translation,
    /// Slope ∂w/∂x, rad (and moment, N·m).
    Rotation,
}

/// One degree of freedom of the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamPoint {
    /// Distance from the beam's first end, m.
    pub position_m: f64,
    /// Which motion there.
    pub motion: Motion,
}

impl Beam {
    /// Receptances between all `points`, one matrix (points×points) for each frequency: every mode of the
    /// finite-element model is summed. All points are nodes of the mesh, save those within 1e-4 of the length
    /// of another.
    ///
    /// # Errors
    /// [`BeamError`] if the beam is not physical, a point is not on it or a frequency is that of an undamped mode.
    pub fn receptances(
        &self,
        points: &[BeamPoint],
        frequency_hz: &[f64],
    ) -> Result<Vec<DMatrix<Complex64>>, BeamError> {
        let nodes = self.mesh(points)?;
        let modes = self.modes_on(&nodes)?;
        let free = self.free_dofs(nodes.len());
        // φ_r at each point: one row a point, one column a mode.
        let mut amplitudes = DMatrix::zeros(points.len(), modes.angular_frequency.len());
        for (p, point) in points.iter().enumerate() {
            for (dof, weight) in interpolation(&nodes, point) {
                if let Some(row) = free.iter().position(|&kept| kept == dof) {
                    let mut amplitude = amplitudes.row_mut(p);
                    amplitude += modes.shapes.row(row) * weight;
                }
            }
        }
        let rigid = self.rigid_body_modes();
        let receptances = frequency_hz.iter().map(|frequency_hz| {
            let omega = std::f64::consts::TAU * frequency_hz;
            let mut receptance = DMatrix::zeros(points.len(), points.len());
            for mode in 0..modes.angular_frequency.len() {
                let natural = if mode < rigid {
                    0.0
                } else {
                    modes.angular_frequency[mode]
                };
                // H_pq = Σ_r φ_pr φ_qr / (ω_r² − ω² + j d_r),  d_r = 2 ζ_r ω_r ω  or  η ω_r²
                let denominator = Complex64::new(
                    natural * natural - omega * omega,
                    match &self.damping {
                        Damping::Ratios(ratios) => {
                            let ratio = ratios.get(mode).or(ratios.last()).copied();
                            2.0 * ratio.unwrap_or(0.0) * natural * omega
                        }
                        Damping::LossFactor(eta) => eta * natural * natural,
                    },
                );
                if denominator == Complex64::default() {
                    return Err(self.resonance(*frequency_hz));
                }
                for p in 0..points.len() {
                    let scaled = amplitudes[(p, mode)] / denominator;
                    for q in 0..points.len() {
                        receptance[(p, q)] += scaled * amplitudes[(q, mode)];
                    }
                }
            }
            Ok(receptance)
        });
        receptances.collect()
    }

    /// Natural frequencies in Hz, ascending, rigid-body modes (as zeros) included.
    ///
    /// # Errors
    /// [`BeamError`] if the beam is not physical.
    pub fn natural_frequencies_hz(&self) -> Result<Vec<f64>, BeamError> {
        let nodes = self.mesh(&[])?;
        let mut frequencies = self.modes_on(&nodes)?.frequency_hz();
        frequencies[..self.rigid_body_modes()].fill(0.0);
        Ok(frequencies)
    }

    fn resonance(&self, frequency_hz: f64) -> BeamError {
        let (reason, advice) = if frequency_hz == 0.0 {
            ("where a beam with free ends is not held", "")
        } else {
            (
                "the frequency of an undamped mode",
                ", or give the beam damping",
            )
        };
        BeamError::Resonance {
            frequency_hz,
            reason,
            advice,
        }
    }

    fn check(&self) -> Result<(), BeamError> {
        for (key, found) in [
            ("length", self.length_m),
            ("width", self.width_m),
            ("height", self.height_m),
            ("youngs_modulus", self.youngs_modulus_pa),
            ("density", self.density_kg_per_m3),
        ] {
            if !(found.is_finite() && found > 0.0) {
                return Err(BeamError::NotPositive { key, found });
            }
        }
        let (key, values) = match &self.damping {
            Damping::Ratios(ratios) => ("damping_ratio", ratios.as_slice()),
            Damping::LossFactor(eta) => ("loss_factor", std::slice::from_ref(eta)),
        };
        if values.is_empty() {
            return Err(BeamError::NoDampingRatio);
        }
        match values
            .iter()
            .find(|ratio| !ratio.is_finite() || **ratio < 0.0)
        {
            Some(&found) => Err(BeamError::Damping { key, found }),
            None => Ok(()),
        }
    }

    /// Node positions: both ends, every point that is not too close to another, and equal elements between them.
    fn mesh(&self, points: &[BeamPoint]) -> Result<Vec<f64>, BeamError> {
        self.check()?;
        let rounding = 1e-9 * self.length_m;
        let mut marks = vec![0.0, self.length_m];
        for point in points {
            let position_m = point.position_m;
            if !(position_m >= -rounding && position_m <= self.length_m + rounding) {
                return Err(BeamError::OffTheBeam {
                    position_m,
                    length_m: self.length_m,
                });
            }
            marks.push(position_m.clamp(0.0, self.length_m));
        }
        marks.sort_by(f64::total_cmp);
        let shortest = SHORTEST_ELEMENT * self.length_m;
        marks.dedup_by(|later, earlier| *later - *earlier < shortest);
        // The end stays a node, rather than a point just before it.
        if let [.., last] = marks.as_mut_slice() {
            *last = self.length_m;
        }
        let mut nodes = vec![0.0];
        for pair in marks.windows(2) {
            let span = pair[1] - pair[0];
            let count = (ELEMENTS * span / self.length_m - 1e-9).ceil().max(1.0);
            for step in 1..=count as usize {
                nodes.push(pair[0] + span * step as f64 / count);
            }
        }
        Ok(nodes)
    }

    fn modes_on(&self, nodes: &[f64]) -> Result<Modes, BeamError> {
        let size = 2 * nodes.len();
        let mut mass = DMatrix::zeros(size, size);
        let mut stiffness = DMatrix::zeros(size, size);
        let mass_per_length = self.density_kg_per_m3 * self.width_m * self.height_m;
        let bending = self.youngs_modulus_pa * self.width_m * self.height_m.powi(3) / 12.0;
        for (element, ends) in nodes.windows(2).enumerate() {
            let l = ends[1] - ends[0];
            // [m_e] = (m l/420) [156 22l 54 −13l; …]   (Tol 4.3, Kavi 4.11)
            let m = mass_per_length * l / 420.0;
            let element_mass = [
                [156.0, 22.0 * l, 54.0, -13.0 * l],
                [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
                [54.0, 13.0 * l, 156.0, -22.0 * l],
                [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
            ];
            // [k_e] = (EI/l³) [12 6l −12 6l; …]   (Tol 4.4, Kavi 4.10)
            let k = bending / l.powi(3);
            let element_stiffness = [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
            ];
            for i in 0..4 {
                for j in 0..4 {
                    let place = (2 * element + i, 2 * element + j);
                    mass[place] += m * element_mass[i][j];
                    stiffness[place] += k * element_stiffness[i][j];
                }
            }
        }
        let free = self.free_dofs(nodes.len());
        let mass = mass.select_rows(&free).select_columns(&free);
        let stiffness = stiffness.select_rows(&free).select_columns(&free);
        let damping = DMatrix::zeros(free.len(), free.len());
        Ok(SpatialModel::new(mass, damping, stiffness)?.modes()?)
    }

    /// Degrees of freedom (2 a node: w, ∂w/∂x) that the supports leave free.
    fn free_dofs(&self, node_count: usize) -> Vec<usize> {
        let last = 2 * (node_count - 1);
        let held: &[usize] = match self.boundary {
            Boundary::FreeFree => &[],
            Boundary::FixedFree => &[0, 1],
            Boundary::FreeFixed => &[last, last + 1],
            Boundary::FixedFixed => &[0, 1, last, last + 1],
            Boundary::PinnedPinned => &[0, last],
            Boundary::FixedPinned => &[0, 1, last],
        };
        (0..2 * node_count)
            .filter(|dof| !held.contains(dof))
            .collect()
    }

    fn rigid_body_modes(&self) -> usize {
        match self.boundary {
            Boundary::FreeFree => 2,
            _ => 0,
        }
    }
}

/// The element's DOFs (2 a node: w, ∂w/∂x) and their weights in the motion of a point: a node's own, or cubic Hermite.
fn interpolation(nodes: &[f64], point: &BeamPoint) -> [(usize, f64); 4] {
    let after = nodes.partition_point(|&node| node <= point.position_m);
    let right = after.clamp(1, nodes.len() - 1);
    let l = nodes[right] - nodes[right - 1];
    let x = ((point.position_m - nodes[right - 1]) / l).clamp(0.0, 1.0);
    let weights = match point.motion {
        // w = (1 − 3x² + 2x³) w₁ + l(x − 2x² + x³) θ₁ + (3x² − 2x³) w₂ + l(x³ − x²) θ₂
        Motion::Translation => [
            1.0 - 3.0 * x * x + 2.0 * x.powi(3),
            l * (x - 2.0 * x * x + x.powi(3)),
            3.0 * x * x - 2.0 * x.powi(3),
            l * (x.powi(3) - x * x),
        ],
        // its derivative by the position
        Motion::Rotation => [
            (6.0 * x * x - 6.0 * x) / l,
            1.0 - 4.0 * x + 3.0 * x * x,
            (6.0 * x - 6.0 * x * x) / l,
            3.0 * x * x - 2.0 * x,
        ],
    };
    std::array::from_fn(|i| (2 * (right - 1) + i, weights[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn aluminium(boundary: Boundary) -> Beam {
        Beam {
            length_m: 0.221,
            width_m: 0.025,
            height_m: 0.006,
            youngs_modulus_pa: 70e9,
            density_kg_per_m3: 2700.0,
            boundary,
            damping: Damping::Ratios(vec![0.0]),
        }
    }

    #[test]
    fn frequencies_are_the_roots_of_the_frequency_equations() {
        // Roots λ = βL of the frequency equations (Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1).
        let clamped = [
            4.730_040_744_862_704,
            7.853_204_624_095_838,
            10.995_607_838_001_67,
        ];
        let cantilever = [
            1.875_104_068_711_961,
            4.694_091_132_974_175,
            7.854_757_438_237_613,
        ];
        let propped = [
            3.926_602_312_047_919,
            7.068_582_745_628_732,
            10.210_176_122_813_03,
        ];
        let pi = std::f64::consts::PI;
        for (boundary, roots) in [
            (Boundary::FreeFree, clamped),
            (Boundary::FixedFixed, clamped),
            (Boundary::FixedFree, cantilever),
            (Boundary::FreeFixed, cantilever),
            (Boundary::FixedPinned, propped),
            (Boundary::PinnedPinned, [pi, 2.0 * pi, 3.0 * pi]),
        ] {
            let beam = aluminium(boundary);
            let found = beam.natural_frequencies_hz().unwrap();
            let skipped = beam.rigid_body_modes();
            // f = (λ/L)² √(EI/ρA) / 2π
            let speed = (70e9_f64 / 2700.0 / 12.0).sqrt() * 0.006;
            for (found, root) in found[skipped..].iter().zip(roots) {
                let exact = (root / 0.221_f64).powi(2) * speed / std::f64::consts::TAU;
                let error = found / exact - 1.0;
                let discretisation = (root / ELEMENTS).powi(4) / 1440.0;
                assert!(
                    (error - discretisation).abs() < 0.1 * discretisation + 1e-7,
                    "{boundary:?}: {error} {discretisation}"
                );
            }
        }
    }

    #[test]
    fn substructure_a_of_case_4_2_2_resonates_where_the_thesis_says() {
        // EI = 67e9 · 4.5e-10 N·m², m = 0.405 kg/m: 25 mm × 6 mm of density 2700.
        let beam = Beam {
            length_m: 0.3,
            youngs_modulus_pa: 67e9,
            damping: Damping::Ratios(vec![0.01]),
            ..aluminium(Boundary::FixedFree)
        };
        let found = beam.natural_frequencies_hz().unwrap();
        assert!((found[1] - 336.25).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn static_deflection_of_a_cantilever() {
        let beam = aluminium(Boundary::FixedFree);
        let tip = |motion| BeamPoint {
            position_m: 0.221,
            motion,
        };
        let points = [tip(Motion::Translation), tip(Motion::Rotation)];
        let found = &beam.receptances(&points, &[0.0]).unwrap()[0];
        // w = L³/3EI, L²/2EI; θ = L²/2EI, L/EI
        let (l, ei): (f64, f64) = (0.221, 70e9 * 0.025 * 0.006_f64.powi(3) / 12.0);
        let expected = [[l.powi(3) / 3.0, l * l / 2.0], [l * l / 2.0, l]];
        for p in 0..2 {
            for q in 0..2 {
                let exact = expected[p][q] / ei;
                assert!((found[(p, q)].re / exact - 1.0).abs() < 1e-6);
                assert_eq!(found[(p, q)].im, 0.0);
            }
        }
    }

    #[test]
    fn a_free_beam_moves_like_a_rigid_body_at_low_frequency() {
        let beam = aluminium(Boundary::FreeFree);
        let end = BeamPoint {
            position_m: 0.0,
            motion: Motion::Translation,
        };
        let found = beam.receptances(&[end], &[0.1]).unwrap()[0][(0, 0)];
        // H = −(1/m + (L/2)²/J)/ω² = −4/(m ω²)
        let mass = 2700.0 * 0.221 * 0.025 * 0.006;
        let omega = std::f64::consts::TAU * 0.1;
        assert!((found.re * mass * omega * omega / -4.0 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn structural_damping_limits_the_resonance() {
        let beam = Beam {
            damping: Damping::LossFactor(0.05),
            ..aluminium(Boundary::PinnedPinned)
        };
        let middle = BeamPoint {
            position_m: 0.1105,
            motion: Motion::Translation,
        };
        let resonance = beam.natural_frequencies_hz().unwrap()[0];
        let found = beam.receptances(&[middle], &[resonance]).unwrap()[0][(0, 0)];
        // φ² at mid-span is 2/(ρAL): H ≈ 2/(ρAL · jη ω²)
        let omega = std::f64::consts::TAU * resonance;
        let exact = 2.0 / (2700.0 * 0.025 * 0.006 * 0.221 * 0.05 * omega * omega);
        assert!((-found.im / exact - 1.0).abs() < 1e-3, "{found} {exact}");
    }

    #[test]
    fn points_that_all_but_coincide_leave_the_modes_alone() {
        // Exact frequencies do not depend on where the points are; a node of its own for each would.
        let beam = aluminium(Boundary::FixedFree);
        let at = |position_m, motion| BeamPoint { position_m, motion };
        let alone = [
            at(0.1, Motion::Translation),
            at(0.1, Motion::Rotation),
            at(0.221, Motion::Translation),
        ];
        let frequency_hz = [0.0, 60.0, 250.0, 900.0];
        let reference = beam.receptances(&alone, &frequency_hz).unwrap();
        for gap in [1e-11, 1e-7, 1e-6, 1e-5] {
            let mut points = alone.to_vec();
            points.push(at(0.1 + gap, Motion::Translation));
            points.push(at(0.1 + gap, Motion::Rotation));
            points.push(at(0.221 - gap, Motion::Translation));
            let found = beam.receptances(&points, &frequency_hz).unwrap();
            for (found, reference) in found.iter().zip(&reference) {
                for p in 0..3 {
                    for q in 0..3 {
                        let exact = reference[(p, q)];
                        let same = (found[(p, q)] - exact).norm() / exact.norm();
                        assert!(same < 1e-8, "gap {gap}, ({p}, {q}): {same}");
                    }
                }
                // w(x + gap) = w(x) + gap θ(x) + …
                let taylor = reference[(0, 2)] + gap * reference[(1, 2)];
                let error = (found[(3, 2)] - taylor).norm() / taylor.norm();
                assert!(
                    error < 1e-8 + 100.0 * gap * gap / 0.01,
                    "gap {gap}: {error}"
                );
            }
        }
    }

    #[test]
    fn a_receptance_without_a_value_is_an_error() {
        let end = [BeamPoint {
            position_m: 0.0,
            motion: Motion::Translation,
        }];
        let free = aluminium(Boundary::FreeFree);
        let message = free.receptances(&end, &[5.0, 0.0]).unwrap_err().to_string();
        assert!(
            message.contains("0 Hz") && message.contains("free ends"),
            "{message}"
        );
        assert!(
            aluminium(Boundary::FreeFixed)
                .receptances(&end, &[0.0])
                .is_ok()
        );
    }

    #[test]
    fn impossible_beams_are_refused() {
        let thin = Beam {
            height_m: 0.0,
            ..aluminium(Boundary::FreeFree)
        };
        assert_eq!(
            thin.natural_frequencies_hz(),
            Err(BeamError::NotPositive {
                key: "height",
                found: 0.0
            })
        );
        let point = BeamPoint {
            position_m: 0.3,
            motion: Motion::Translation,
        };
        assert!(matches!(
            aluminium(Boundary::FreeFree).receptances(&[point], &[1.0]),
            Err(BeamError::OffTheBeam { .. })
        ));
        let undamped = Beam {
            damping: Damping::Ratios(Vec::new()),
            ..aluminium(Boundary::FreeFree)
        };
        assert_eq!(
            undamped.natural_frequencies_hz(),
            Err(BeamError::NoDampingRatio)
        );
    }
}
