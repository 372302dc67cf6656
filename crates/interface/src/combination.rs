//! FMI 3.0's tables of legal combinations of causality, variability and initial (section 2.4.7.4 and 2.4.7.5).

use fmi_schema::fmi3::{Causality, Initial, Variability};

/// Whether the table of causality and variability has an entry there.
pub(crate) fn is_allowed(causality: Causality, variability: Variability) -> bool {
    use Variability::{Constant, Continuous, Discrete, Fixed, Tunable};
    match causality {
        Causality::Parameter | Causality::CalculatedParameter | Causality::StructuralParameter => {
            matches!(variability, Fixed | Tunable)
        }
        Causality::Input => matches!(variability, Discrete | Continuous),
        Causality::Output => matches!(variability, Constant | Discrete | Continuous),
        Causality::Independent => matches!(variability, Continuous),
        Causality::Local => true,
        Causality::Dependent => false,
    }
}

/// `initial` with its default filled in, or the value that the table forbids there.
pub(crate) fn effective_initial(
    causality: Causality,
    variability: Variability,
    initial: Option<Initial>,
) -> Result<Option<Initial>, Initial> {
    use Initial::{Approx, Calculated, Exact};
    let (default, others): (Option<Initial>, &[Initial]) = match (causality, variability) {
        (Causality::Independent, _) => (None, &[]),
        (Causality::Parameter | Causality::StructuralParameter | Causality::Input, _)
        | (_, Variability::Constant) => (Some(Exact), &[]),
        (Causality::CalculatedParameter, _) | (_, Variability::Fixed | Variability::Tunable) => {
            (Some(Calculated), &[Approx])
        }
        _ => (Some(Calculated), &[Exact, Approx]),
    };
    match initial {
        None => Ok(default),
        Some(given) if default == Some(given) || others.contains(&given) => Ok(Some(given)),
        Some(given) => Err(given),
    }
}
