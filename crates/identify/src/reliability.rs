//! Whether an estimate may be relied on at all: whether the search came to an end, whether the data determine the stiffness, and
//! whether the model has anything to do with the measurement.

use bolted_joint_frf::structure::ComplexMatrix;

use super::identification::AssemblyFit;
use super::layout::Bolts;
use super::lines_estimate::LinesEstimate;

/// Relative difference that half of the measured values must stay below. A joint model that is too simple leaves a few tens of per
/// cent around the resonances; beyond this the computed structure is another one than the measured one.
const MISFIT: f64 = 0.5;

/// What speaks against the estimate, a line each; empty if nothing does.
pub(super) fn reasons_against(
    estimate: &LinesEstimate,
    bolts: &Bolts,
    fitted: &[AssemblyFit],
) -> Vec<String> {
    let mut reasons = Vec::new();
    if !estimate.converged {
        reasons.push("the search for the estimate has not converged".to_owned());
    }
    let names = bolts.with_own_joint();
    for joint in &estimate.joints {
        let covariance = &joint.covariance;
        let unknowns = covariance.unknowns.iter().zip(&covariance.identified);
        let open: Vec<String> = unknowns
            .filter(|(unknown, identified)| unknown.is_direct_stiffness() && !**identified)
            .map(|(unknown, _)| unknown.label(names))
            .collect();
        if !open.is_empty() {
            let torque = joint.torque_n_m.map(|torque| format!(" at {torque} N·m"));
            reasons.push(format!(
                "the data do not determine {}{}",
                open.join(" and "),
                torque.unwrap_or_default()
            ));
        }
    }
    if let Some(off) = median_difference(fitted).filter(|off| *off > MISFIT) {
        reasons.push(format!(
            "half of the measured values are more than {:.0} % off the model: substructures and assembly do not belong together \
             as the study says (lengths in mm, moduli in GPa, points, directions, units?)",
            100.0 * off
        ));
    }
    reasons
}

/// Median of |measured − computed|/max(|measured|, |computed|) over all values.
fn median_difference(fitted: &[AssemblyFit]) -> Option<f64> {
    let mut differences: Vec<f64> = fitted
        .iter()
        .flat_map(|assembly| {
            let lines = assembly.lines.assembly.iter().zip(&assembly.regenerated);
            lines.flat_map(|(measured, computed)| of_line(assembly, measured, computed))
        })
        .collect();
    if differences.is_empty() {
        return None;
    }
    let middle = differences.len() / 2;
    Some(*differences.select_nth_unstable_by(middle, f64::total_cmp).1)
}

fn of_line<'a>(
    assembly: &'a AssemblyFit,
    measured: &'a ComplexMatrix,
    computed: &'a ComplexMatrix,
) -> impl Iterator<Item = f64> {
    assembly.fits.iter().map(move |fit| {
        let (measured, computed) = (measured[fit.place], computed[fit.place]);
        let size = measured.norm().max(computed.norm());
        match size > 0.0 {
            true => (measured - computed).norm() / size,
            false => 0.0,
        }
    })
}
