//! The lap model under loads that an importer computes from its motion and holds over the step.

use bolted_joint_dynamics::{
    Body, Lap, LapIntegrator, LapLoads, LapPropagator, LapState, substeps,
};
use nalgebra::DMatrix;

use super::element::{CouplingError, places};
use super::stability::{Search, StepBound};
use bolted_joint_joint::{JointFile, LawError};

/// What an importer attaches to a body of the lap, in each DOF: a load −k x − c ẋ.
#[derive(Debug, Clone, PartialEq)]
pub struct Restraint {
    /// N/m, N·m/rad.
    pub stiffness: Vec<f64>,
    /// N·s/m, N·m·s/rad.
    pub damping: Vec<f64>,
}

/// How long the communication step of a lap FMU may be when springs and dampers outside of it are coupled to bodies a and b
/// by loads that are held over the step.
///
/// The lap is stepped as the FMU does it, by Runge–Kutta steps of at most `step_size_max_s` (s). Loads that do not depend
/// on its motion need no bound. For `amplitude` see [`super::element_bound`].
///
/// ```
/// use std::path::Path;
///
/// use bolted_joint_cosimulation::{Restraint, StepBound, lap_bound};
/// use bolted_joint_joint::JointFile;
///
/// let file = JointFile::read(Path::new("../../examples/pirdayr/ex01.joint.json"))?;
/// let free = Restraint { stiffness: vec![0.0], damping: vec![0.0] };
/// assert_eq!(lap_bound::<1>(&file, [&free, &free], 1e-5, None)?, StepBound::Nothing);
/// let spring = Restraint { stiffness: vec![1e6], ..free.clone() };
/// assert!(lap_bound::<1>(&file, [&spring, &free], 1e-5, None)?.seconds() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`CouplingError`].
pub fn lap_bound<const D: usize>(
    file: &JointFile,
    restraints: [&Restraint; 2],
    step_size_max_s: f64,
    amplitude: Option<&[f64]>,
) -> Result<StepBound, CouplingError> {
    for restraint in restraints {
        for list in [&restraint.stiffness, &restraint.damping] {
            super::element::check_count(list.len(), D)?;
            if let Some(&found) = list
                .iter()
                .find(|entry| !(entry.is_finite() && **entry >= 0.0))
            {
                let expected = "a stiffness or damping of zero or more";
                return Err(CouplingError::Value { found, expected });
            }
        }
    }
    if restraints.iter().all(|restraint| {
        restraint
            .stiffness
            .iter()
            .chain(&restraint.damping)
            .all(|&e| e == 0.0)
    }) {
        return Ok(StepBound::Nothing);
    }
    let lap = file.lap::<D>()?;
    let mut bound = StepBound::Nothing;
    for at in places(&lap.joint, amplitude)? {
        let tangent = Lap {
            joint: lap.joint.linearised_about(&at),
            ..lap
        };
        bound = bound.min(tangent_bound(&tangent, restraints, step_size_max_s)?);
    }
    Ok(bound)
}

fn tangent_bound<const D: usize>(
    lap: &Lap<D>,
    restraints: [&Restraint; 2],
    step_size_max_s: f64,
) -> Result<StepBound, CouplingError> {
    let rate = restrained(lap, restraints)
        .spectrum()
        .map_or(0.0, |spectrum| spectrum.largest_modulus());
    if rate == 0.0 {
        return Err(LawError::NoBodies.into());
    }
    let search = Search {
        rate,
        range: [1e-5, 1e4],
        // the rigid motions of a free lap are double eigenvalues at 1, which rounding moves off it by its root
        slack: |step| 8.0 * f64::EPSILON.sqrt() + 1e-14 / step,
    };
    let integrator = LapIntegrator::new(lap);
    Ok(search.bound(|step_s| {
        generator(lap, &integrator, restraints, rate, step_size_max_s, step_s)
            // not finite, so not stable
            .unwrap_or_else(|| DMatrix::from_element(1, 1, f64::NAN))
    }))
}

/// The lap with the restraints as supports of its own, as they would be without a communication step.
fn restrained<const D: usize>(lap: &Lap<D>, restraints: [&Restraint; 2]) -> Lap<D> {
    let with = |body: &Body<D>, restraint: &Restraint| Body {
        inertia: body.inertia,
        stiffness: std::array::from_fn(|i| body.stiffness[i] + restraint.stiffness[i]),
        damping: std::array::from_fn(|i| body.damping[i] + restraint.damping[i]),
    };
    Lap {
        joint: lap.joint,
        a: with(&lap.a, restraints[0]),
        b: with(&lap.b, restraints[1]),
    }
}

/// G of x ← x + H G x over one communication step, in coordinates (ρ√m x, √m ẋ).
fn generator<const D: usize>(
    lap: &Lap<D>,
    integrator: &LapIntegrator<D>,
    restraints: [&Restraint; 2],
    rate: f64,
    step_size_max_s: f64,
    step_s: f64,
) -> Option<DMatrix<f64>> {
    let count = substeps(step_s, step_size_max_s)?;
    let propagator = LapPropagator::new(integrator, step_s, count)?;
    let scale: Vec<f64> = [&lap.a, &lap.b]
        .iter()
        .flat_map(|body| {
            let root = body.inertia.map(f64::sqrt);
            root.map(|root| rate * root).into_iter().chain(root)
        })
        .collect();
    let size = 4 * D;
    let mut g = DMatrix::zeros(size, size);
    for column in 0..size {
        let mut unit = vec![0.0; size];
        unit[column] = 1.0;
        let state = of_list::<D>(&unit);
        let loads = LapLoads {
            a: load(restraints[0], &state.a.displacement, &state.a.velocity),
            b: load(restraints[1], &state.b.displacement, &state.b.velocity),
        };
        let after = list(&propagator.advance(&state, &loads));
        for row in 0..size {
            g[(row, column)] = (after[row] - unit[row]) / step_s * scale[row] / scale[column];
        }
    }
    Some(g)
}

/// F = −k x − c ẋ
fn load<const D: usize>(restraint: &Restraint, x: &[f64; D], v: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| -restraint.stiffness[i] * x[i] - restraint.damping[i] * v[i])
}

fn of_list<const D: usize>(list: &[f64]) -> LapState<D> {
    let part = |which: usize| std::array::from_fn(|i| list[which * D + i]);
    let mut state = LapState::REST;
    state.a.displacement = part(0);
    state.a.velocity = part(1);
    state.b.displacement = part(2);
    state.b.velocity = part(3);
    state
}

fn list<const D: usize>(state: &LapState<D>) -> Vec<f64> {
    [
        state.a.displacement,
        state.a.velocity,
        state.b.displacement,
        state.b.velocity,
    ]
    .concat()
}
