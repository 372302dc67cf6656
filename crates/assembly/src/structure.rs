//! From what the file says of a structure to its modal form.

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{
    Beam, BeamPoint, Damping, ModalModel, Motion, NamedMatrices, StructureError, Theory,
};
use bolted_joint_study::{BeamNumber, StudyError, StudyText};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::num::NonZeroU16;

use crate::error::AssemblyError;
use crate::modal_form::ModalForm;
use crate::residual::AllModes;
use crate::tables::{BeamTable, StructureTable, TheoryName};

/// Modes that are kept where nothing is said.
const MODES: usize = 20;
/// Elements of a computed beam.
const ELEMENTS: NonZeroU16 = NonZeroU16::MIN.saturating_add(95);
/// ω² below this part of the highest is rounding of a free motion.
const FREE: f64 = 1e-13;
/// … and below zero by more than this part of it is no rounding.
const INDEFINITE: f64 = 1e-9;
/// ω² of the fastest mode, 1/s², below which no structure with bolts is.
const SLOWEST: f64 = 1.0;
/// Imaginary part of a mode shape, in parts of its largest entry, up to which it is taken as a real one.
const COMPLEX: f64 = 0.05;
/// Frequency of what stands for residuals of measured modes, in parts of the highest measured one.
const OF_RESIDUALS: f64 = 3.0;

/// What should be known of how a structure was read: what may well be as it is meant are notes.
#[derive(Default)]
pub(crate) struct Told {
    pub(crate) warnings: Vec<String>,
    pub(crate) notes: Vec<String>,
}

/// A structure, and what should be known of how it was read.
pub(crate) fn structure(
    study: &StudyText,
    name: &str,
    table: StructureTable,
) -> Result<(ModalForm, Told), AssemblyError> {
    let key = format!("structures.{name}");
    if let Some(modes) = table.modes {
        study.within(
            format_args!("{key}.modes"),
            modes,
            1..=10_000,
            "the number of modes that are kept",
        )?;
    }
    let kept = table.modes.unwrap_or(MODES);
    let failed = |source: StructureError| AssemblyError::Structure {
        file: study.path().display().to_string(),
        name: name.to_owned(),
        source: Box::new(source),
    };
    let points_beside = |given: &str| {
        study.ensure(
            table.points.is_empty(),
            format_args!("{key}.points"),
            "positions",
            format_args!("them beside `beam` only: {given} has its own points"),
        )
    };
    let form = match (table.matrices, table.modal, table.beam) {
        (Some(path), None, None) => {
            points_beside("a file of matrices")?;
            let matrices = NamedMatrices::read(&study.resolved(&path)).map_err(failed)?;
            let all = of_matrices(study, &key, &matrices, failed)?;
            let told = undamped(&key, &all, "the file has no array C, or a C of zeros");
            (cut(study, &key, all, kept)?, told)
        }
        (None, Some(path), None) => {
            points_beside("a file of modes")?;
            let model = ModalModel::read(&study.resolved(&path)).map_err(failed)?;
            let (form, warnings) = of_modes(study, &key, &model, kept)?;
            let told = Told {
                warnings,
                ..Told::default()
            };
            (form, told)
        }
        (None, None, Some(beam)) => {
            let beam = computed(study, &key, beam)?;
            let points: Vec<(Dof, f64)> = table.points.into_iter().collect();
            ensure_in_a_plane(study, &key, &points)?;
            study.ensure(
                !points.is_empty(),
                format_args!("{key}.points"),
                "nothing",
                "the positions of its points along the beam in m, such as { \"1:+Y\" = 0.0, \"1:+RZ\" = 0.0 }",
            )?;
            let all = of_beam(&beam, &points).map_err(failed)?;
            let told = undamped(&key, &all, "beam.damping_ratio is not stated, or 0");
            (cut(study, &key, all, kept)?, told)
        }
        _ => {
            return Err(study
                .refusal(
                    key,
                    "no source, or several",
                    "one of `matrices`, `modal` and `beam`",
                )
                .into());
        }
    };
    Ok(form)
}

/// A word where nothing damps a structure, and why.
fn undamped(key: &str, all: &AllModes, why: &str) -> Told {
    let is_undamped = all.damping_per_s.iter().all(|own| *own == 0.0);
    let note = is_undamped.then(|| format!("{key} is undamped: {why}"));
    Told {
        notes: note.into_iter().collect(),
        ..Told::default()
    }
}

/// A beam bends in one plane: all deflections are along one axis, all slopes about another one, and a node is in one place.
fn ensure_in_a_plane(
    study: &StudyText,
    key: &str,
    points: &[(Dof, f64)],
) -> Result<(), StudyError> {
    for (place, &(point, position_m)) in points.iter().enumerate() {
        let key = format!("{key}.points.{point}");
        for &(other, other_m) in &points[..place] {
            let (one, two) = (point.direction(), other.direction());
            study.ensure(
                one.is_rotation() != two.is_rotation() || one == two,
                &key,
                format_args!("{one} beside {other}"),
                "one direction of all deflections and one of all slopes: a beam bends in one plane",
            )?;
            study.ensure(
                point.node() != other.node() || position_m == other_m,
                &key,
                format_args!("{position_m} m, and {other_m} m for {other}"),
                "one place for a node",
            )?;
        }
    }
    Ok(())
}

/// The structure with so many modes, which have to be enough for its free motions.
fn cut(study: &StudyText, key: &str, all: AllModes, kept: usize) -> Result<ModalForm, StudyError> {
    let rigid = all.rigid();
    study.ensure(
        kept >= rigid,
        format_args!("{key}.modes"),
        kept,
        format_args!("{rigid} or more: the structure moves freely in so many ways"),
    )?;
    Ok(all.cut_to(kept))
}

fn computed(study: &StudyText, key: &str, table: BeamTable) -> Result<Beam, StudyError> {
    let key = format!("{key}.beam");
    for (number, found) in [
        (BeamNumber::Length, table.length),
        (BeamNumber::Width, table.width),
        (BeamNumber::Height, table.height),
        (BeamNumber::YoungsModulus, table.youngs_modulus),
        (BeamNumber::Density, table.density),
    ] {
        study.plausible_in_beam(&key, number, found)?;
    }
    let theory = match (table.theory, table.poissons_ratio) {
        (TheoryName::Timoshenko, None) => Theory::default(),
        (TheoryName::Timoshenko, Some(poissons_ratio)) => Theory::Timoshenko { poissons_ratio },
        (TheoryName::EulerBernoulli, None) => Theory::EulerBernoulli,
        (TheoryName::EulerBernoulli, Some(ratio)) => {
            let expected = "none: without shear it has no effect";
            return study.refuse(format_args!("{key}.poissons_ratio"), ratio, expected);
        }
    };
    let ratios = table
        .damping_ratio
        .map_or(vec![0.0], |ratios| ratios.list());
    Ok(Beam {
        length_m: table.length,
        width_m: table.width,
        height_m: table.height,
        youngs_modulus_pa: table.youngs_modulus,
        density_kg_per_m3: table.density,
        theory,
        boundary: table.boundary,
        damping: Damping::Ratios(ratios),
    })
}

fn of_beam(beam: &Beam, points: &[(Dof, f64)]) -> Result<AllModes, StructureError> {
    let on_beam: Vec<BeamPoint> = points
        .iter()
        .map(|&(dof, position_m)| BeamPoint {
            position_m,
            motion: match dof.direction().is_rotation() {
                true => Motion::Rotation,
                false => Motion::Translation,
            },
        })
        .collect();
    let modes = beam.modes_at(&on_beam, ELEMENTS)?;
    let ratios: &[f64] = match &beam.damping {
        Damping::Ratios(ratios) => ratios,
        Damping::LossFactor(_) => &[],
    };
    let damping = DVector::from_fn(modes.angular_frequency.len(), |r, _| {
        let ratio = ratios.get(r).or(ratios.last()).copied().unwrap_or(0.0);
        2.0 * ratio * modes.angular_frequency[r]
    });
    let sign = |dof: Dof| dof.sign().factor();
    Ok(AllModes {
        points: points.iter().map(|&(dof, _)| dof).collect(),
        shapes: DMatrix::from_fn(points.len(), modes.amplitudes.ncols(), |p, r| {
            sign(points[p].0) * modes.amplitudes[(p, r)]
        }),
        frequency_rad_per_s: modes.angular_frequency,
        damping_per_s: DMatrix::from_diagonal(&damping),
    })
}

fn of_matrices(
    study: &StudyText,
    key: &str,
    matrices: &NamedMatrices,
    failed: impl Fn(StructureError) -> AssemblyError,
) -> Result<AllModes, AssemblyError> {
    let modes = matrices.spatial.modes().map_err(failed)?;
    let squares = matrices.spatial.modal_stiffness(&modes);
    let highest = squares.max();
    let lowest = squares.min();
    study.ensure(
        lowest >= -INDEFINITE * highest,
        format_args!("{key}.matrices"),
        format_args!("a mode with ω² = {lowest:e} 1/s²"),
        "a stiffness that is not negative in any motion; check K, and constraints of the reduction",
    )?;
    study.ensure(
        highest <= 0.0 || highest >= SLOWEST,
        format_args!("{key}.matrices"),
        format_args!(
            "no natural frequency above {:.2e} Hz",
            highest.sqrt() / std::f64::consts::TAU
        ),
        "the masses as M and the stiffnesses as K, in kg and N/m; have they been exchanged?",
    )?;
    let damping = matrices.spatial.modal_damping(&modes);
    let least = SymmetricEigen::new(damping.clone()).eigenvalues.min();
    study.ensure(
        least >= -INDEFINITE * damping.amax().max(f64::MIN_POSITIVE),
        format_args!("{key}.matrices"),
        format_args!("damping that feeds a motion ({least:e} 1/s)"),
        "a C that is positive semidefinite",
    )?;
    let named: Vec<usize> = (0..matrices.points.len())
        .filter(|&i| matrices.points[i].is_some())
        .collect();
    Ok(AllModes {
        points: matrices.points.iter().copied().flatten().collect(),
        frequency_rad_per_s: squares.map(|square| match square <= FREE * highest {
            true => 0.0,
            false => square.sqrt(),
        }),
        damping_per_s: damping,
        shapes: modes.shapes.select_rows(&named),
    })
}

/// Measured modes, with residuals as modes far above them and, of masses, as free ones.
fn of_modes(
    study: &StudyText,
    key: &str,
    model: &ModalModel,
    kept: usize,
) -> Result<(ModalForm, Vec<String>), AssemblyError> {
    let points = model.points().to_vec();
    let mut all: Vec<_> = model.modes().iter().collect();
    all.sort_by(|one, other| one.frequency_hz.total_cmp(&other.frequency_hz));
    let mut warnings = model.warnings().to_vec();
    for mode in &all {
        let size = |part: usize| mode.shape.iter().map(|u| u[part].abs()).fold(0.0, f64::max);
        if size(1) > COMPLEX * size(0) {
            return Err(study
                .refusal(
                    format_args!("{key}.modal"),
                    format_args!(
                        "a mode at {} Hz whose shape is complex (imaginary part {:.0} % of the real one)",
                        mode.frequency_hz,
                        100.0 * size(1) / size(0)
                    ),
                    "real shapes: in time a structure has them where damping is small; fit real modes",
                )
                .into());
        }
    }
    let missing = all.len().saturating_sub(kept);
    all.truncate(kept);
    let count = points.len();
    let residual = |part: fn((f64, f64)) -> f64| {
        let mut matrix = DMatrix::zeros(count, count);
        for p in 0..count {
            for q in 0..count {
                matrix[(p, q)] = part(model.residual(p, q)?);
            }
        }
        Some(matrix)
    };
    let highest = all.last().map_or(0.0, |mode| mode.frequency_hz) * std::f64::consts::TAU;
    let mut frequencies: Vec<f64> = Vec::new();
    let mut columns: Vec<DVector<f64>> = Vec::new();
    let mut ratios: Vec<f64> = Vec::new();
    let (upper, lower) = (residual(|(upper, _)| upper), residual(|(_, lower)| lower));
    if upper.is_none() && model.residual(0, 0).is_some() {
        warnings.push(format!(
            "{key}: residuals are there for some pairs of points and not for all; they are left out, so that the joints see the structure too stiff"
        ));
    }
    if upper.is_none() && model.residual(0, 0).is_none() {
        warnings.push(format!(
            "{key}: the modes end at {:.4} Hz and have no residuals: joints and loads see the structure too stiff, the more so the nearer \
             a frequency is to that",
            highest / std::f64::consts::TAU
        ));
    }
    // −LA/ω² is that of a free body: φφᵀ = LA
    for (matrix, frequency) in [(lower, 0.0), (upper, OF_RESIDUALS * highest)] {
        for (value, vector) in matrix.iter().flat_map(positive_parts) {
            frequencies.push(frequency);
            // UA = φφᵀ/ω²
            let scale = if frequency > 0.0 { frequency } else { 1.0 };
            columns.push(vector * (value.sqrt() * scale));
            ratios.push(0.0);
        }
        if frequency == 0.0 {
            for mode in &all {
                frequencies.push(std::f64::consts::TAU * mode.frequency_hz);
                columns.push(DVector::from_fn(count, |p, _| mode.shape[p][0]));
                ratios.push(mode.damping_ratio);
            }
        }
    }
    let size = frequencies.len();
    let form = ModalForm {
        points,
        damping_per_s: DMatrix::from_fn(size, size, |i, j| match i == j {
            true => 2.0 * ratios[i] * frequencies[i],
            false => 0.0,
        }),
        frequency_rad_per_s: DVector::from_vec(frequencies),
        shapes: DMatrix::from_columns(&columns),
        modes: all.len(),
        cut: missing,
    };
    Ok((form, warnings))
}

/// Eigenvalues above zero of a symmetric matrix, with their vectors.
fn positive_parts(matrix: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
    let symmetric = (matrix + matrix.transpose()) * 0.5;
    let eigen = SymmetricEigen::new(symmetric);
    let largest = eigen.eigenvalues.amax();
    (0..eigen.eigenvalues.len())
        .filter(|&i| eigen.eigenvalues[i] > 1e-12 * largest)
        .map(|i| {
            (
                eigen.eigenvalues[i],
                eigen.eigenvectors.column(i).into_owned(),
            )
        })
        .collect()
}
