//! Data as they would have been measured with other errors of the set-up and other noise: what a parametric bootstrap repeats an
//! estimate on.
//!
//! What was measured of a structure in its own test stays; what follows from it in the assembly moves with the causes. So a draw
//! needs no structure whose sensors are elsewhere.

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

/// Puts functions into `experiment` that an experiment at `origin` could have brought, and says which values the causes have in it:
/// drawn from their priors, but for those that the data contradict, which stay as they were found. `normal` draws from the
/// standard normal distribution. `None` where the assembly is singular or a structure cannot be computed.
#[must_use]
pub fn draw(
    experiment: &mut Experiment<'_>,
    origin: &Origin<'_>,
    normal: &mut dyn FnMut() -> f64,
) -> Option<Vec<(Cause, f64)>> {
    let priors: Vec<Prior> = origin.causes.iter().map(|cause| cause.prior).collect();
    let found: Vec<f64> = origin.causes.iter().map(|cause| cause.value).collect();
    let mut value_of_cause = |cause: &CauseEstimate| match cause.contradicted {
        Some(_) => cause.value,
        None => cause.prior.standard_deviation * normal(),
    };
    let drawn: Vec<f64> = origin.causes.iter().map(&mut value_of_cause).collect();
    let task = Task::new(experiment, &priors);
    let [found, drawn] = [found, drawn].map(|causes| Point {
        unknowns: origin.unknowns.to_vec(),
        causes,
    });
    let sets = Sets::of(&task, &found, &drawn)?;
    let causes = priors.iter().map(|prior| prior.cause);
    let causes = causes.zip(drawn.causes).collect();
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
    Some(causes)
}

/// Everything that is measured, without noise.
struct Sets {
    of: [Values; 2],
    assemblies: Vec<Values>,
}

impl Sets {
    fn of(task: &Task<'_>, found: &Point, drawn: &Point) -> Option<Self> {
        let experiment = task.experiment;
        let recomputed = Recomputations::values(experiment, task.priors, &drawn.causes)?;
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
            let own = task.in_its_own_test(line, found);
            for side in [Side::A, Side::B] {
                if let Structure::Measured(measured) = experiment.side(side) {
                    let truth = measured.functions.matrix(&own[side as usize]);
                    let at = task.at_structure(side, &measured.functions, &truth, line);
                    add(&mut of[side as usize], task.measured(&at, drawn));
                }
            }
            let moved = task.in_the_assembly(line, drawn, &own);
            let receptances = task.assembled(line, drawn, &moved, &recomputed)?;
            for (number, receptance) in receptances.iter().enumerate() {
                let at = task.at_assembly(number, receptance, experiment.omega[line]);
                add(&mut assemblies[number], task.measured(&at, drawn));
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
        let entries = at.functions.entries.iter().zip(beside);
        entries
            .map(|(entry, beside)| {
                let factor = at.factor(entry, self.priors, &point.causes);
                factor * (at.truth[entry.place] + beside)
            })
            .collect()
    }

    /// Receptances of the labels as they were in the structures' own tests, without noise where a fit gives them.
    fn in_its_own_test(&self, line: usize, point: &Point) -> Labelled {
        let smooth = self.smooth(line, point, &as_measured(self, line, point));
        self.by_frequency(line, point, &smooth, |value, ratio| value / ratio)
    }

    /// The same in the assembly.
    fn in_the_assembly(&self, line: usize, point: &Point, own: &Labelled) -> Labelled {
        self.by_frequency(line, point, own, |value, ratio| value * ratio)
    }

    fn by_frequency(
        &self,
        line: usize,
        point: &Point,
        labelled: &Labelled,
        change: impl Fn(Complex64, Complex64) -> Complex64,
    ) -> Labelled {
        [Side::A, Side::B].map(|side| {
            let epsilon = value_of(Cause::Frequency(side), self.priors, &point.causes);
            let Structure::Measured(measured) = self.experiment.side(side) else {
                return Vec::new();
            };
            let entries = measured.functions.entries.iter();
            let values = entries.zip(&labelled[side as usize]).enumerate();
            values
                .map(|(number, (entry, &value))| {
                    if epsilon == 0.0 || entry.measurements.is_empty() {
                        value
                    } else {
                        change(value, self.ratio(side, line, number, epsilon))
                    }
                })
                .collect()
        })
    }
}
