//! Data as they would have been measured with other noise, and a set-up as it would have been read off with other errors: what a
//! parametric bootstrap repeats an estimate on.
//!
//! That a cause is zero within its limit is a measurement, too: somebody looked, and it was read off as 0 ± σ. So it is repeated
//! like all others: the causes stay what the estimate found, and what is read off, the prior's centre, is drawn around that. The
//! draws scatter as the estimate does at these data. Drawing the causes themselves and reading off zero each time is the same as
//! long as everything is linear. Where it is not, as with the limits of a careful laboratory, it leads to data whose errors are
//! other than those of the data at hand, and tells less or more of the joint than these do.

use num_complex::Complex64;

use super::budget::Prior;
use super::cause::{Cause, Side};
use super::effect::At;
use super::estimate::CauseEstimate;
use super::experiment::{Experiment, MeasuredFunctions, Structure};
use super::line::{Labelled, Point, Task};
use super::normal::as_measured;
use super::structures::{Recomputations, value_of};

/// Values of each entry of a set, line by line.
type Values = Vec<Vec<Complex64>>;

/// What an estimate found, to draw data from.
#[derive(Clone, Debug)]
pub struct Origin<'o> {
    /// The joint.
    pub unknowns: &'o [f64],
    /// The causes with their priors.
    pub causes: &'o [CauseEstimate],
    /// Factor of the variances of everything measured, which the experiment takes over.
    pub scale: f64,
}

/// Puts functions into `experiment` that an experiment at `origin` could have brought, and says what would be known of the causes
/// before: priors around values that are read off anew. `normal` draws from the standard normal distribution. `None` where the
/// assembly is singular or a structure cannot be computed.
#[must_use]
pub fn draw(
    experiment: &mut Experiment<'_>,
    origin: &Origin<'_>,
    normal: &mut dyn FnMut() -> f64,
) -> Option<Vec<Prior>> {
    let priors: Vec<Prior> = origin.causes.iter().map(|cause| cause.prior).collect();
    let read_off = origin.causes.iter().map(|cause| Prior {
        centre: cause.value + cause.prior.standard_deviation * normal(),
        ..cause.prior
    });
    let read_off: Vec<Prior> = read_off.collect();
    let task = Task::new(experiment, &priors);
    let found = Point {
        unknowns: origin.unknowns.to_vec(),
        causes: origin.causes.iter().map(|cause| cause.value).collect(),
    };
    let sets = Sets::of(&task, &found)?;
    let mut put = |functions: &mut MeasuredFunctions, values: Values| {
        for (entry, values) in functions.entries.iter_mut().zip(values) {
            if entry.measurements.is_empty() {
                continue;
            }
            for variance in &mut entry.variance {
                *variance *= origin.scale;
            }
            for (line, value) in values.into_iter().enumerate() {
                // half of the variance is that of each part
                let part = (0.5 * entry.variance[line]).sqrt();
                entry.values[line] = value + Complex64::new(part * normal(), part * normal());
            }
        }
    };
    let Sets { of, assemblies } = sets;
    for (structure, values) in [&mut experiment.a, &mut experiment.b].into_iter().zip(of) {
        if let Structure::Measured(measured) = structure {
            put(&mut measured.functions, values);
        }
    }
    for (assembly, values) in experiment.assemblies.iter_mut().zip(assemblies) {
        put(&mut assembly.functions, values);
    }
    experiment.forget_fits();
    Some(read_off)
}

/// Everything that is measured, without noise.
struct Sets {
    of: [Values; 2],
    assemblies: Vec<Values>,
}

impl Sets {
    fn of(task: &Task<'_>, found: &Point) -> Option<Self> {
        let experiment = task.experiment;
        let recomputed = Recomputations::values(experiment, task.priors, &found.causes)?;
        let empty = |functions: &MeasuredFunctions| -> Values {
            vec![Vec::with_capacity(task.lines()); functions.entries.len()]
        };
        let mut of = [Side::A, Side::B].map(|side| match experiment.side(side) {
            Structure::Measured(measured) => empty(&measured.functions),
            Structure::Computed(_) | Structure::Exact(_) => Values::new(),
        });
        let assemblies = experiment.assemblies.iter();
        let mut assemblies: Vec<Values> = assemblies.map(|of| empty(&of.functions)).collect();
        for line in 0..task.lines() {
            // without noise where a fit gives them
            let together = task.smooth(line, found, &as_measured(task, line, found));
            let own = task.in_its_own_test(line, found, &together);
            for side in [Side::A, Side::B] {
                if let Structure::Measured(measured) = experiment.side(side) {
                    let truth = measured.functions.matrix(&own[side as usize]);
                    let at = task.at_structure(side, &measured.functions, &truth, line);
                    add(&mut of[side as usize], task.measured(&at, found));
                }
            }
            let assembled = task.assembled(line, found, &together, &recomputed)?;
            for (number, coupled) in assembled.iter().enumerate() {
                let at = task.at_assembly(number, coupled, line);
                add(&mut assemblies[number], task.measured(&at, found));
            }
        }
        Some(Self { of, assemblies })
    }
}

fn add(values: &mut Values, of_line: Vec<Complex64>) {
    for (values, value) in values.iter_mut().zip(of_line) {
        values.push(value);
    }
}

impl Task<'_> {
    /// z = φ (h + a)
    fn measured(&self, at: &At<'_>, point: &Point) -> Vec<Complex64> {
        let beside = at.beside(self.priors, &point.causes);
        let factors = at.factors(self.priors, &point.causes);
        let entries = at.functions.entries.iter().zip(factors);
        let entries = entries.zip(beside);
        entries
            .map(|((entry, factor), beside)| factor * (at.truth[entry.place] + beside))
            .collect()
    }

    /// Receptances of the labels as they were in the structures' own tests, by those in the assembly.
    fn in_its_own_test(&self, line: usize, point: &Point, together: &Labelled) -> Labelled {
        [Side::A, Side::B].map(|side| {
            let epsilon = value_of(Cause::Frequency(side), self.priors, &point.causes);
            let Structure::Measured(measured) = self.experiment.side(side) else {
                return Vec::new();
            };
            let ratios = self.ratios(side, line, epsilon);
            let entries = measured.functions.entries.iter().zip(ratios);
            let values = entries.zip(&together[side as usize]);
            values
                .map(
                    |((entry, ratio), &value)| match entry.measurements.is_empty() {
                        true => value,
                        false => value / ratio,
                    },
                )
                .collect()
        })
    }
}
