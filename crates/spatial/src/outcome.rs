//! What was found, with its deviations, what to know of it, and what speaks against it.

use nalgebra::DMatrix;

use crate::contradicted;
use crate::error::SpatialError;
use crate::estimate::Found;
use crate::fits::strongest;
use crate::identification::{Group, SpatialIdentification, Substructures};
use crate::lack;
use crate::level::{first, relative_rms, sizes};
use crate::lossy;
use crate::massive;
use crate::normal::squares_of_errors;
use crate::numbers::{Numbers, deviations};
use crate::odd::odd_channels;
use crate::problem::Level;
use crate::reasons;
use crate::richer::Richer;
use crate::shifted;
use crate::spread::Spread;
use crate::study::SpatialStudy;
use crate::uneven;

/// Residual in parts of the functions up to which single channels are told from the others.
pub(crate) const LARGEST_RESIDUAL: f64 = 0.15;

impl SpatialStudy {
    pub(crate) fn result(&self, found: &Found) -> Result<SpatialIdentification, SpatialError> {
        self.numbers(found).map_err(|error| match error {
            SpatialError::NotDetermined => undetermined(found.joint.has_converged, found.starts),
            other => other,
        })
    }

    fn numbers(&self, found: &Found) -> Result<SpatialIdentification, SpatialError> {
        let problem = &self.problem;
        let sought = problem.only()?;
        let model = sought.model;
        let count = problem.joint_count();
        let errors = problem.error_count();
        let Found {
            best,
            estimated,
            information,
            shown,
            joint: alone,
            starts,
            rivals,
            richer,
            further,
            of_values,
        } = found;
        let spread = Spread::of(estimated, information, alone.covariance.clone())
            .ok_or(SpatialError::NotDetermined)?;
        let Numbers {
            unknowns,
            matrices: [stiffness, damping],
            free,
            covariances,
            correlation,
            squares_from_free,
        } = Numbers::of(
            &sought,
            alone.unknowns.0.clone(),
            &spread.all,
            &spread.by_noise,
            alone.has_converged,
        )?;
        let group = |(name, added): &(String, DMatrix<f64>)| {
            let share = |n: usize| added[(n, n)] / spread.all[(n, n)];
            Group {
                name: name.clone(),
                deviations: deviations(model, added),
                largest_share: (0..count).map(share).fold(0.0, f64::max),
            }
        };
        let lines = alone.kept.len();
        let compared = shown.with_lines(&alone.kept);
        let freedom = (alone.numbers - count) as f64;
        // noise of the substructures hides what is left of fewer functions
        let of_all = alone.squares / freedom;
        let reduced = (alone.left_in_assembly).map_or(of_all, |left| left.max(of_all));
        let reduced_chi_squared = self.level.is_known().then_some(reduced);
        let left_out = problem.frequency_hz.len() - lines;
        let mut result = SpatialIdentification {
            unknowns,
            stiffness,
            damping,
            free,
            deviations: deviations(model, &spread.all),
            deviations_by_noise: deviations(model, &spread.by_noise),
            covariances,
            correlation,
            relative_rms: relative_rms(&compared, &alone.unknowns)?,
            functions: problem.observed.len(),
            lines,
            substructures: self.has_noise().then_some(Substructures {
                lines_left_out: left_out,
                moves: alone.moved,
            }),
            frequency_hz: problem.frequency_hz.clone(),
            fits: strongest(shown, &alone.unknowns, &alone.kept)?,
            reduced_chi_squared,
            budget_used: (errors > 0).then(|| {
                squares_of_errors(problem, &best.unknowns) / problem.open_error_count() as f64
            }),
            starts: *starts,
            groups: spread.groups.iter().map(group).collect(),
            errors: problem.found_errors(&best.unknowns, &spread.together),
            warnings: Vec::new(),
            reasons_against: Vec::new(),
        };
        // beside a joint that is another one, none goes with the others
        if result.relative_rms < LARGEST_RESIDUAL {
            result.warnings = odd_channels(&compared, &alone.unknowns, &self.noise_of_functions())?;
        }
        let mut of_rest = None;
        if best.has_converged && result.substructures.is_none() {
            match lack::told(&compared, &alone.unknowns)? {
                Some(lack::Told::Warning(text)) => result.warnings.push(text),
                Some(lack::Told::Reason(text)) => of_rest = Some(text),
                None => {}
            }
        }
        result.warnings.extend(uneven::told(*of_values));
        let of_budget = contradicted::warnings(problem, &result.errors);
        result.warnings.extend(of_budget);
        result.warnings.extend(richer.iter().map(Richer::warning));
        result.warnings.extend(lossy::warning(further));
        result.warnings.extend(massive::warning(further));
        result.reasons_against =
            result.reasons(self.level, best.has_converged && alone.has_converged);
        result.reasons_against.extend(of_rest);
        result.reasons_against.extend(reasons::of_rivals(*rivals));
        let of_energy = match lossy::is_lossy(further) {
            true => reasons::of_lossy_energy(squares_from_free, count),
            false => reasons::of_energy(squares_from_free, count),
        };
        result.reasons_against.extend(of_energy);
        if result.substructures.is_none() && !result.reasons_against.is_empty() {
            result.reasons_against.push(reasons::of_exact_parts());
        }
        if best.has_converged && errors > 0 {
            let of_places = shifted::reason(problem, &best.unknowns, &spread.together);
            result.reasons_against.extend(of_places);
        }
        if best.has_converged {
            let of_nothing = reasons::of_nothing(&result.unknowns);
            result.reasons_against.extend(of_nothing);
        }
        let found = [&result.stiffness, &result.damping];
        let of_model = richer
            .as_ref()
            .and_then(|richer| richer.reason(found, &result.deviations));
        result.reasons_against.extend(of_model);
        let of_mass = massive::reason(further, &result.unknowns);
        result.reasons_against.extend(of_mass);
        Ok(result)
    }
}

impl SpatialStudy {
    /// Deviation of the noise of each function, 0 where it is not stated.
    fn noise_of_functions(&self) -> Vec<f64> {
        let sizes = sizes(&self.problem);
        match self.level {
            Level::Relative(_) | Level::OfCoherence => first(&self.problem, self.level, &sizes),
            Level::OfResiduals => vec![0.0; sizes.len()],
        }
    }
}

/// Why there is no covariance: where a search has come to nothing that lies at what was found, and not at the functions.
pub(crate) fn undetermined(has_converged: bool, [tried, _]: [usize; 2]) -> SpatialError {
    match has_converged {
        true => SpatialError::NotDetermined,
        false => SpatialError::NothingFound { tried },
    }
}
