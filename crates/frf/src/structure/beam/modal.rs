//! A beam by all modes of its finite-element model: receptances between any points on it, and of another material.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::inner::inner_compliance;
use super::mesh::interpolation;
use super::{Beam, BeamPoint, Damping};
use crate::structure::StructureError;
use crate::structure::spatial::Modes;

/// A beam with the modes of one mesh.
///
/// They serve other materials exactly, and other points nearly so: between two nodes the beam takes its static shape.
///
/// ```
/// use bolted_joint_frf::structure::{Beam, BeamPoint, Boundary, Damping, Motion, Theory};
///
/// let beam = Beam {
///     length_m: 0.4,
///     width_m: 0.04,
///     height_m: 0.01,
///     youngs_modulus_pa: 210e9,
///     density_kg_per_m3: 7850.0,
///     theory: Theory::default(),
///     boundary: Boundary::FixedFree,
///     damping: Damping::LossFactor(1e-3),
/// };
/// let tip = [BeamPoint { position_m: 0.4, motion: Motion::Translation }];
/// let softer = Beam { youngs_modulus_pa: 105e9, ..beam.clone() };
/// let anew = softer.receptances(&tip, &[30.0])?[0][(0, 0)];
/// let scaled = beam.modal(&tip)?.of_material(105e9, 7850.0).receptances(&tip, &[30.0])?[0][(0, 0)];
/// assert!((scaled / anew - 1.0).norm() < 1e-9);
/// # Ok::<(), bolted_joint_frf::structure::StructureError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ModalBeam {
    beam: Beam,
    /// Positions of the nodes, m.
    nodes: Vec<f64>,
    /// Row of the shapes for each DOF of the mesh; none where a support holds it.
    rows: Vec<Option<usize>>,
    modes: Modes,
}

impl ModalBeam {
    pub(super) fn new(
        beam: &Beam,
        nodes: &[BeamPoint],
        elements: f64,
    ) -> Result<Self, StructureError> {
        let nodes = beam.mesh(nodes, elements)?;
        let modes = beam.modes_on(&nodes)?;
        let mut rows = vec![None; 2 * nodes.len()];
        for (row, dof) in beam.free_dofs(nodes.len()).into_iter().enumerate() {
            rows[dof] = Some(row);
        }
        Ok(Self {
            beam: beam.clone(),
            nodes,
            rows,
            modes,
        })
    }

    /// The same beam of another Young's modulus (Pa) and density (kg/m³); Poisson's ratio stays.
    #[must_use]
    pub fn of_material(&self, youngs_modulus_pa: f64, density_kg_per_m3: f64) -> Self {
        let stiffer = youngs_modulus_pa / self.beam.youngs_modulus_pa;
        let heavier = density_kg_per_m3 / self.beam.density_kg_per_m3;
        // K scales with E and G = E/(2(1 + ν)), M with ρ: ω_r ~ √(E/ρ), φ_r ~ 1/√ρ
        Self {
            beam: Beam {
                youngs_modulus_pa,
                density_kg_per_m3,
                ..self.beam.clone()
            },
            modes: Modes {
                angular_frequency: &self.modes.angular_frequency * (stiffer / heavier).sqrt(),
                shapes: &self.modes.shapes / heavier.sqrt(),
            },
            ..self.clone()
        }
    }

    /// The same beam with another damping.
    #[must_use]
    pub fn with_damping(&self, damping: Damping) -> Self {
        Self {
            beam: Beam {
                damping,
                ..self.beam.clone()
            },
            ..self.clone()
        }
    }

    /// ω_r, rad/s, ascending; rounding may leave a small number of a rigid-body mode.
    pub(super) fn angular_frequency(&self) -> &DVector<f64> {
        &self.modes.angular_frequency
    }

    /// φ_r at each point (row) of each mode (column).
    pub(super) fn amplitudes(&self, points: &[BeamPoint]) -> Result<DMatrix<f64>, StructureError> {
        let mut amplitudes = DMatrix::zeros(points.len(), self.modes.angular_frequency.len());
        for (p, point) in points.iter().enumerate() {
            self.beam.check_is_on(point)?;
            for (dof, weight) in interpolation(&self.beam, &self.nodes, point) {
                if let Some(row) = self.rows[dof] {
                    let mut amplitude = amplitudes.row_mut(p);
                    amplitude += self.modes.shapes.row(row) * weight;
                }
            }
        }
        Ok(amplitudes)
    }

    /// Receptances between all `points`, one matrix (points×points) for each frequency.
    ///
    /// # Errors
    /// [`StructureError`] if the beam is not physical, a point is not on it or a frequency is that of an undamped mode.
    pub fn receptances(
        &self,
        points: &[BeamPoint],
        frequency_hz: &[f64],
    ) -> Result<Vec<DMatrix<Complex64>>, StructureError> {
        self.beam.check()?;
        let amplitudes = self.amplitudes(points)?;
        let pairs: Vec<(usize, usize)> = (0..points.len())
            .flat_map(|q| (0..=q).map(move |p| (p, q)))
            .collect();
        let products = DMatrix::from_fn(pairs.len(), amplitudes.ncols(), |pair, mode| {
            let (p, q) = pairs[pair];
            amplitudes[(p, mode)] * amplitudes[(q, mode)]
        });
        let [real, imaginary] = self.dynamic_compliances(frequency_hz)?;
        let inner = inner_compliance(&self.beam, &self.nodes, points);
        let loss = match self.beam.damping {
            Damping::LossFactor(eta) => Complex64::new(1.0, eta),
            Damping::Ratios(_) => Complex64::ONE,
        };
        // H_pq = Σ_r φ_pr φ_qr / (ω_r² − ω² + j d_r) + what its own element yields
        let [real, imaginary] = [&products * real, &products * imaginary];
        let receptances = (0..frequency_hz.len()).map(|line| {
            let mut receptance = DMatrix::zeros(points.len(), points.len());
            for (pair, &(p, q)) in pairs.iter().enumerate() {
                let through_nodes = Complex64::new(real[(pair, line)], imaginary[(pair, line)]);
                let value = through_nodes + inner[(p, q)] / loss;
                receptance[(p, q)] = value;
                receptance[(q, p)] = value;
            }
            receptance
        });
        Ok(receptances.collect())
    }

    /// Real and imaginary parts of 1/(ω_r² − ω² + j d_r), one row a mode, one column a frequency.
    fn dynamic_compliances(
        &self,
        frequency_hz: &[f64],
    ) -> Result<[DMatrix<f64>; 2], StructureError> {
        let modes = self.modes.angular_frequency.len();
        let rigid = self.beam.rigid_body_modes();
        let mut parts = [0, 1].map(|_| DMatrix::zeros(modes, frequency_hz.len()));
        for (line, &frequency_hz) in frequency_hz.iter().enumerate() {
            let omega = std::f64::consts::TAU * frequency_hz;
            for mode in 0..modes {
                let natural = if mode < rigid {
                    0.0
                } else {
                    self.modes.angular_frequency[mode]
                };
                // d_r = 2 ζ_r ω_r ω  or  η ω_r²
                let damping = match &self.beam.damping {
                    Damping::Ratios(ratios) => {
                        let ratio = ratios.get(mode).or(ratios.last()).copied();
                        2.0 * ratio.unwrap_or(0.0) * natural * omega
                    }
                    Damping::LossFactor(eta) => eta * natural * natural,
                };
                let denominator = Complex64::new(natural * natural - omega * omega, damping);
                if denominator == Complex64::default() {
                    return Err(resonance(frequency_hz));
                }
                let compliance = denominator.inv();
                parts[0][(mode, line)] = compliance.re;
                parts[1][(mode, line)] = compliance.im;
            }
        }
        Ok(parts)
    }
}

fn resonance(frequency_hz: f64) -> StructureError {
    let (reason, advice) = match frequency_hz == 0.0 {
        true => (
            "where a beam with free ends is not held",
            "leave that line out",
        ),
        false => (
            "the frequency of an undamped mode",
            "leave that line out, or give the beam damping",
        ),
    };
    StructureError::Resonance {
        what: "the beam has no finite receptance",
        frequency_hz,
        reason,
        advice,
    }
}
