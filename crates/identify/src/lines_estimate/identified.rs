//! From lines to an estimate: decoupling, averages, the search, the passive estimate, and how sure all of it is.

use std::sync::Arc;

use bolted_joint_wanted::{Pieces, step};
use nalgebra::DVector;

use bolted_joint_frf::Dof;
use bolted_joint_joint::Drawn;

use super::super::averages::{Decoupled, band_averages, first_bands, own_resonances, used_bands};
use super::super::bootstrap::{self};
use super::super::choice::{self};
use super::super::error::IdentifyError;
use super::super::joint_estimate::{BootstrapResult, CovarianceOfAll, JointEstimate};
use super::super::layout::Layout;
use super::super::line_by_line::{Equations, decouple};
use super::super::lines::Lines;
use super::super::model::{JointMatrices, JointModel};
use super::super::noise::{Levels, Noise, NoiseLevel, Of};
use super::super::observed::{self};
use super::super::parallel;
use super::super::passive;
use super::super::reliability::{NOTABLE_UNREST, TOLERABLE_UNREST};
use super::super::search::Found;
use super::super::torque::{self, Assignment, Problem, TorqueDependence, Torques};

use super::{LinesEstimate, Options};

/// Identifies a joint from the lines of one or more assemblies that have it in common, or one joint for each torque to
/// which they are tightened.
///
/// # Errors
/// [`IdentifyError::NoEstimate`] if no start leads to an estimate, [`IdentifyError::Torques`] if each torque is to have its
/// joint and there are not several of them.
pub fn identify_lines(
    all: &[Lines],
    model: JointModel,
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    parallel::among_them(|| identified(all, model, options))
}

fn identified(
    all: &[Lines],
    model: JointModel,
    options: &Options<'_>,
) -> Result<LinesEstimate, IdentifyError> {
    let first = all.iter().find(|lines| !lines.frequency_hz.is_empty());
    let dofs = first.map_or(0, Lines::joint_dofs);
    let layout = Layout::new(model, &options.bolts, dofs);
    let is_empty = all.iter().any(|lines| lines.measured.is_empty());
    let Some(layout) = layout.filter(|_| !is_empty) else {
        return Err(no_estimate(all, 0));
    };
    let torques = Torques::of(&options.torques_n_m, all.len());
    let dependence = options.dependence;
    let separate = match (dependence, &torques) {
        (TorqueDependence::Common, _) => None,
        (TorqueDependence::Separate, Some(torques)) => Some(torques),
        (TorqueDependence::Separate, None) => {
            return Err(IdentifyError::Torques {
                assemblies: all.len(),
                found_n_m: options.torques_n_m.clone(),
            });
        }
    };
    let assignment = match separate {
        None => Assignment::common(all),
        Some(torques) => Assignment::separate(all, torques),
    };
    let (joint_of_assembly, count): (Vec<usize>, usize) = (
        assignment.all.iter().map(|&(_, joint)| joint).collect(),
        assignment.joints,
    );
    let noise = &options.noise;
    let on_a = options.points_on_a.iter().copied();
    let on_a = on_a.chain(std::iter::repeat(0));
    let equations: Vec<Option<Equations>> = all
        .iter()
        .zip(on_a)
        .map(|(lines, on_a)| Equations::of(lines, on_a))
        .collect();
    let decoupling = step("decoupling", Pieces::Unknown);
    let problem = Problem::new(assignment, noise).ok_or_else(|| no_estimate(all, 0))?;
    let each = all.iter().zip(&equations);
    let decoupled: Vec<_> = each
        .map(|(lines, equations)| decouple(lines, &layout, *equations))
        .collect();
    let decoupled_of = |joint: usize| -> Vec<Decoupled<'_>> {
        let own = all.iter().zip(&decoupled).zip(&joint_of_assembly);
        own.filter(|(_, own)| **own == joint)
            .map(|((lines, values), _)| Decoupled { lines, values })
            .collect()
    };
    let first_bands = first_bands(&layout, &options.bands);
    let first_averages: Vec<Option<Vec<JointMatrices>>> = (0..count)
        .map(|joint| band_averages(&decoupled_of(joint), &layout, &first_bands))
        .collect();
    let starts: Vec<Vec<DVector<f64>>> = first_averages
        .iter()
        .map(|averages| starts(&layout, options.start.as_ref(), averages.as_deref()))
        .collect();
    drop(decoupling);
    let (found, own_hz) = parallel::beside(
        || problem.best(&layout, &starts, options.effort(), None),
        || {
            let of = |joint: usize| own_resonances(&decoupled_of(joint), &options.bands);
            (0..count).map(of).collect::<Vec<_>>()
        },
    );
    let mut found = found.map_err(|starts| no_estimate(all, starts))?;
    let places = layout.places();
    let used = Arc::clone(&found.used);
    let objective = used.assemblies.objective(&places);
    let mut observed = None;
    if layout.joints() > 1 {
        (found.estimate, observed) = observed::observed(&objective, noise, found.estimate);
    }
    let estimate = &found.estimate;
    let names = options.bolts.with_own_joint();
    let covariance = CovarianceOfAll::of(&objective, noise, &found, observed.as_ref());
    let passive = {
        let _step = step("the passive joint", Pieces::Unknown);
        passive::passive(&objective, &layout, noise, estimate)
    };
    let draws = options.bootstrap.as_ref().and_then(|bootstrap| {
        let progress = options.progress.unwrap_or(&|| ());
        let draws = bootstrap::draws(&objective, &places, noise, estimate, bootstrap, progress)?;
        Some((bootstrap, draws))
    });
    let size = layout.unknowns();
    let of_torque = |joint: usize| {
        let own = joint * size..(joint + 1) * size;
        let (data, unknowns) = (
            decoupled_of(joint),
            &estimate.unknowns.as_slice()[own.clone()],
        );
        let at = (unknowns, own_hz[joint].as_deref());
        let bands = used_bands(&data, &layout, &options.bands, at);
        let matrices = |unknowns: &DVector<f64>| layout.matrices(&unknowns.as_slice()[own.clone()]);
        let free = matrices(&estimate.unknowns);
        let passive = passive.as_ref().map(|passive| matrices(&passive.unknowns));
        JointEstimate {
            torque_n_m: separate.map(|torques| torques.values_n_m[joint]),
            band_averages: if bands == first_bands {
                first_averages[joint].clone()
            } else {
                band_averages(&data, &layout, &bands)
            },
            bands,
            covariance: covariance.of_torque(&objective, &layout, names, &found, joint),
            bootstrap: draws.as_ref().map(|(bootstrap, draws)| {
                BootstrapResult::of(bootstrap, Drawn::Noise, draws, own.clone())
            }),
            whole: layout.whole(passive.as_ref().unwrap_or(&free)),
            layout: layout.clone(),
            free,
            passive,
        }
    };
    let joints: Vec<JointEstimate> = (0..count).map(of_torque).collect();
    drop(passive);
    let noise_level = (noise.is_stated() || estimate.degrees_of_freedom > 0)
        .then(|| NoiseLevel {
            relative: estimate.levels.assembly.relative,
            floor: floors_of_assembly(all, noise, estimate.levels),
        })
        .filter(|_| !found.assessment.noise_is_known);
    let levels = estimate.levels;
    let found = found.clone().without_corrections();
    let choice = options
        .compare_models
        .then(|| choice::compare(&problem, &layout, &found));
    drop(problem);
    let torque_choice = torques
        .filter(|_| options.compare_models)
        .and_then(|torques| torque::compare(all, &torques, noise, &layout, dependence, &found));
    let mut warnings = warnings(all, &equations, &layout, &found);
    let of_joints = joints.iter().flat_map(|joint| joint.warnings(names));
    let joint_warnings: Vec<String> = complaint(&found, &joints)
        .into_iter()
        .chain(of_joints)
        .collect();
    warnings.extend(joint_warnings.iter().cloned());
    warnings.extend(
        torque_choice
            .as_ref()
            .and_then(|choice| choice.complaint(dependence)),
    );
    Ok(LinesEstimate {
        decoupled,
        equations,
        noise_level,
        levels,
        joints,
        joint_of_assembly,
        layout,
        covariance_of_all: covariance.matrix,
        unrest: unrest(&found),
        observed,
        assessment: found.assessment,
        starts: (found.tried, found.agreeing),
        lines_used: (
            found.used.count(),
            all.iter().map(|lines| lines.frequency_hz.len()).sum(),
        ),
        draws: draws.map(|(_, draws)| draws),
        choice,
        torque_choice,
        warnings,
        joint_warnings,
    })
}

/// Root mean square of the floors of the assemblies' functions between translations, m/N.
fn floors_of_assembly(all: &[Lines], noise: &Noise, levels: Levels) -> f64 {
    let floors = all.iter().flat_map(|lines| {
        let is_rotation = |point: usize| lines.points[point].direction().is_rotation();
        let places = lines.measured.iter();
        places
            .filter(move |(p, q)| !is_rotation(*p) && !is_rotation(*q))
            .map(|&place| {
                let floor = noise.floor(Of::Assembly, [false; 2], || lines.floor(place));
                floor.variance(levels.assembly)
            })
    });
    let (sum, count) = floors.fold((0.0, 0), |(sum, count), floor| (sum + floor, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// By how many standard deviations an unknown still moved when the search ended. Exact data leave rounding alone, in which a
/// search cannot come to rest.
fn unrest(found: &Found) -> f64 {
    match found.estimate.converged || found.assessment.is_exact {
        true => 0.0,
        false => found.estimate.unrest,
    }
}

/// Starts from a `given` joint and from the `averages` at one torque.
fn starts(
    layout: &Layout,
    given: Option<&JointMatrices>,
    averages: Option<&[JointMatrices]>,
) -> Vec<DVector<f64>> {
    let given = given.map(std::slice::from_ref);
    [given, averages]
        .into_iter()
        .flatten()
        .filter_map(|joints| layout.unknowns_of(joints).map(DVector::from_vec))
        .filter(|start| start.iter().all(|value| value.is_finite()))
        .collect()
}

fn no_estimate(all: &[Lines], starts: usize) -> IdentifyError {
    let points = all.iter().flat_map(|lines| &lines.points);
    IdentifyError::NoEstimate {
        starts,
        points: points.map(Dof::to_string).collect::<Vec<_>>().join(", "),
    }
}

fn warnings(
    all: &[Lines],
    equations: &[Option<Equations>],
    layout: &Layout,
    found: &Found,
) -> Vec<String> {
    let dofs = layout.used_dofs().len();
    let mut warnings = Vec::new();
    if found.estimate.degrees_of_freedom == 0 {
        warnings.push(format!(
            "{} measured values for {} unknowns: the residual does not show how well they fit; use more lines",
            2 * found.estimate.measurements,
            found.estimate.unknowns.len()
        ));
    }
    let once = |warnings: &mut Vec<String>, warning: String| {
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    };
    for lines in all {
        if lines.points.len() < dofs {
            let warning = format!(
                "{} response point{} for a joint with {dofs} DOFs: H_ks (H_ss − H^C_ss)⁻¹ H_sk has rank {} on every line and does not \
                 determine the joint there, so the band averages are no estimate; the refined values rest on the lines together",
                lines.points.len(),
                if lines.points.len() == 1 { "" } else { "s" },
                lines.points.len()
            );
            once(&mut warnings, warning);
        }
    }
    for (lines, equations) in all.iter().zip(equations) {
        if equations.is_none() {
            let warning = format!(
                "{} of {} pairs of points were measured: without all of them there is no decoupling and no band average; the \
                 refined estimate does not need them",
                lines.independent().len(),
                lines.points.len() * lines.points.len()
            );
            once(&mut warnings, warning);
        }
    }
    let unrest = unrest(found);
    if (NOTABLE_UNREST..=TOLERABLE_UNREST).contains(&unrest) {
        warnings.push(format!(
            "the search ended while the values still moved by up to {unrest:.2} of their standard deviations"
        ));
    }
    warnings
}

/// What is said of a residual that is not noise.
fn complaint(found: &Found, joints: &[JointEstimate]) -> Option<String> {
    let complaint = found.assessment.complaint()?;
    let inflation = joints.iter().flat_map(|joint| &joint.covariance.inflation);
    let most = inflation.copied().fold(1.0, f64::max);
    let wider = match most {
        ..1.05 => String::new(),
        _ => format!("; the intervals are wider for it, by up to a factor of {most:.1}"),
    };
    Some(format!(
        "what the joint leaves of the measurement is not noise: {complaint}. Either the joint model or the substructures do not \
         fit, or every one of {} starts ended in a local minimum{wider}",
        found.tried
    ))
}
