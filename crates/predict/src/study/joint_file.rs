//! The joint file of a prediction: the part of the interface, its intervals, and what it rests on.

use crate::patch::Motions;
use crate::uncertain::{Estimate, Outcome};
use bolted_joint_joint::{
    Correlation, DofSet, Format, Friction, Intervals, Joint, JointFile, OverPreload, Provenance,
    StandardDeviation, Uncertainty, UncertaintyAtPreload, UncertaintyOverPreload, Validity,
};

use bolted_joint_study::provenance;

use super::model::State;
use super::prediction::{CONTACT_ALONE, Prediction};
use super::results::{Unknown, at, unknowns};
use super::slip::{Slip, name};

impl Prediction<'_> {
    /// The joint file: one joint, or one over the torques of the table.
    #[must_use]
    pub fn joint_file(&self) -> JointFile {
        let nominal = self.nominal();
        let dofs = self.study.motions.dofs();
        let part = &nominal.part;
        let mut joint = Joint::linear(dofs, part.stiffness.clone(), part.damping.clone());
        joint.friction.extend(friction(nominal));
        JointFile {
            about: None,
            format: Format::V1,
            name: self.study.name.clone(),
            status: None,
            joint: match self.study.nominal_n_m {
                Some(nominal_n_m) => self.over_preload(joint, nominal_n_m),
                None => joint,
            },
            bodies: None,
            uncertainty: self
                .outcome
                .as_ref()
                .map(|outcome| self.uncertainty(outcome)),
            validity: Some(self.validity()),
            residual: None,
            provenance: Some(self.provenance()),
        }
    }

    fn over_preload(&self, constant: Joint, nominal_n_m: f64) -> Joint {
        let states = self.states.iter();
        Joint {
            stiffness: Vec::new(),
            damping: Vec::new(),
            friction: Vec::new(),
            over_preload: Some(OverPreload {
                preload: self.study.torques_n_m.clone(),
                nominal: nominal_n_m,
                stiffness: states
                    .clone()
                    .map(|state| state.part.stiffness.clone())
                    .collect(),
                damping: states
                    .clone()
                    .map(|state| state.part.damping.clone())
                    .collect(),
                cubic: Vec::new(),
                // not in proportion: the contacts' stiffness grows as well
                friction: match self.study.microslip {
                    Some(_) => states.map(|state| friction(state).collect()).collect(),
                    None => Vec::new(),
                },
            }),
            ..constant
        }
    }

    fn uncertainty(&self, outcome: &Outcome) -> Uncertainty {
        let dofs = self.study.motions.dofs();
        let nominal = self.nominal().torque_n_m;
        let refused = match outcome.of.draws - outcome.accepted {
            0 => String::new(),
            refused => format!(", {refused} of them refused"),
        };
        let names = unknowns(dofs).into_iter().map(|(name, ..)| name);
        let over = self.study.torques_n_m.iter().map(|&torque| Some(torque));
        let at_all: Vec<String> = over
            .clone()
            .flat_map(|torque| {
                let names = unknowns(dofs).into_iter();
                names.map(move |(name, ..)| at(&name, torque))
            })
            .collect();
        let at_nominal: Vec<String> = unknowns(dofs)
            .into_iter()
            .map(|(name, ..)| at(&name, nominal))
            .collect();
        Uncertainty {
            standard_deviation: deviation(outcome, dofs, self.nominal()),
            basis: format!(
                "Monte Carlo over {}: {} draws{refused}, seed {}; scatter of what was put into the model, not the model's own error",
                outcome.inputs.join(", "),
                outcome.of.draws,
                outcome.of.seed
            ),
            correlation: Some(Correlation {
                unknowns: names.collect(),
                matrix: correlation(outcome, &at_nominal),
            }),
            interval_95: Some(intervals(outcome, dofs, nominal)),
            over_preload: (!self.study.torques_n_m.is_empty()).then(|| UncertaintyOverPreload {
                at: self
                    .study
                    .torques_n_m
                    .iter()
                    .zip(&self.states)
                    .map(|(&torque, state)| UncertaintyAtPreload {
                        preload: torque,
                        standard_deviation: deviation(outcome, dofs, state),
                        interval_95: Some(intervals(outcome, dofs, Some(torque))),
                        ..UncertaintyAtPreload::default()
                    })
                    .collect(),
                // in space it would be longer than all the rest together
                correlation: (!dofs.is_in_space()).then(|| Correlation {
                    matrix: correlation(outcome, &at_all),
                    unknowns: at_all,
                }),
            }),
            ..Uncertainty::default()
        }
    }

    fn validity(&self) -> Validity {
        let frequency_hz = self.study.frequency_hz;
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold(
                [f64::INFINITY, f64::NEG_INFINITY],
                |[low, high]: [f64; 2], value| [low.min(value), high.max(value)],
            )
        };
        let [low_pa, high_pa] = ends(&mut self.states.iter().map(State::largest_pressure_pa));
        let total_n = |state: &State| state.bolts.iter().map(|bolt| bolt.preload_n).sum();
        let [low_n, high_n] = ends(&mut self.states.iter().map(total_n));
        let range = |low: f64, high: f64| match low == high {
            true => format!("{low:.4}"),
            false => format!("{low:.4} to {high:.4}"),
        };
        let preload = match high_n > 0.0 {
            true => format!(
                "bolts' preloads of {} kN together, ",
                range(1e-3 * low_n, 1e-3 * high_n)
            ),
            false => String::new(),
        };
        Validity {
            // an octave about the frequency at which hysteretic damping was converted: there it is right, at the ends it is
            // √2 too large or too small
            frequency_hz: [
                frequency_hz * std::f64::consts::FRAC_1_SQRT_2,
                frequency_hz * std::f64::consts::SQRT_2,
            ],
            torque_n_m: match self.study.torques_n_m.as_slice() {
                [first, .., last] => Some([*first, *last]),
                _ => None,
            },
            level: Some(format!(
                "{preload}pressures of up to {} MPa; motion small enough for the interface {}",
                range(1e-6 * low_pa, 1e-6 * high_pa),
                match self.study.microslip {
                    None => "neither to open nor to slide",
                    Some(_) => "not to open",
                }
            )),
        }
    }

    /// How the friction of a DOF came about, how close it is, and how well its numbers are known.
    fn slip_note(&self, slip: &Slip) -> String {
        let fitted = &slip.fitted;
        let length = slip.dof.kind.displacement_unit();
        let known = |unknown: Unknown| {
            let estimate = self.estimate(&unknown.name, self.nominal().torque_n_m)?;
            let deviation = estimate.standard_deviation;
            Some(format!(
                " {} = {:.4e} ± {deviation:.1e} {}.",
                unknown.name, unknown.value, unknown.unit
            ))
        };
        format!(
            "{} slips: {} patches follow Mindlin's contact and slip through at the friction of their pressure; one law stands for them, whose heat \
             in a cycle is within {:.0} % of theirs from {:.2e} to {:.2e} {length} ({:.0} % r.m.s.), its load within {:.1} %. Each motion slips by \
             itself.{}",
            slip.dof.name,
            slip.patches.count(),
            100.0 * fitted.worst_heat_error,
            fitted.amplitudes.from,
            fitted.amplitudes.to,
            100.0 * fitted.heat_error,
            100.0 * fitted.worst_load_error,
            slip.unknowns().filter_map(known).collect::<String>()
        )
    }

    fn provenance(&self) -> Provenance {
        let study = self.study;
        let [x, y, z] = study.reference_m;
        let mut notes = vec![
            format!(
                "Computed from surfaces, materials and bolts, not measured: {}.",
                study.pressure
            ),
            CONTACT_ALONE.to_owned(),
            format!(
                "Motions of the interface (normal z): {}, at x = {x} m, y = {y} m, z = {z} m{}.",
                study.motions.described(),
                others_are_held(study.motions)
            ),
            format!(
                "Hysteretic damping is viscous as at {} Hz.",
                study.frequency_hz
            ),
        ];
        notes.extend(self.nominal().slips.iter().map(|slip| self.slip_note(slip)));
        notes.extend(study.notes.iter().cloned());
        let model = match study.motions.dofs().count() {
            1 => "translation",
            _ => "full",
        };
        provenance(study.method, model, study.files.clone(), notes)
    }
}

/// The laws of what slips in a state.
fn friction(state: &State) -> impl Iterator<Item = Friction> {
    let slips = state.slips.iter();
    slips.filter_map(|slip| Friction::of(slip.dof, &slip.fitted.law))
}

/// What is said of the motions that the joint file leaves out, if it leaves out any.
fn others_are_held(motions: Motions) -> &'static str {
    match motions.dofs() == DofSet::SPACE {
        true => "",
        false => "; the other relative motions are held at zero",
    }
}

/// The estimate of an unknown; there is one of each.
fn estimate<'o>(outcome: &'o Outcome, name: &str, torque_n_m: Option<f64>) -> Option<&'o Estimate> {
    outcome.estimate(&at(name, torque_n_m))
}

/// A matrix of stiffness and one of damping, filled by what `of` makes of each unknown's estimate.
fn filled<T: Copy>(
    outcome: &Outcome,
    dofs: DofSet,
    torque_n_m: Option<f64>,
    empty: T,
    of: impl Fn(&Estimate) -> T,
) -> [Vec<Vec<T>>; 2] {
    let count = dofs.count();
    let mut matrices = [
        vec![vec![empty; count]; count],
        vec![vec![empty; count]; count],
    ];
    for (name, is_stiffness, [i, j]) in unknowns(dofs) {
        if let Some(found) = estimate(outcome, &name, torque_n_m) {
            let value = of(found);
            let matrix = &mut matrices[usize::from(!is_stiffness)];
            matrix[i][j] = value;
            matrix[j][i] = value;
        }
    }
    matrices
}

fn deviation(outcome: &Outcome, dofs: DofSet, state: &State) -> StandardDeviation {
    let torque_n_m = state.torque_n_m;
    let [stiffness, damping] = filled(outcome, dofs, torque_n_m, 0.0, |found| {
        found.standard_deviation
    });
    let of_law = |law: Friction| {
        let parameters = law.law.parameters.iter();
        let deviations = parameters.map(|parameter| {
            let found = estimate(outcome, &name(parameter, law.dof), torque_n_m);
            found.map_or(0.0, |found| found.standard_deviation)
        });
        Friction {
            parameters: deviations.collect(),
            ..law
        }
    };
    StandardDeviation {
        stiffness,
        damping,
        friction: friction(state).map(of_law).collect(),
    }
}

fn intervals(outcome: &Outcome, dofs: DofSet, torque_n_m: Option<f64>) -> Intervals {
    let [stiffness, damping] = filled(outcome, dofs, torque_n_m, [0.0; 2], |found| {
        found.interval_95
    });
    Intervals { stiffness, damping }
}

/// Correlation of the results of these names.
fn correlation(outcome: &Outcome, names: &[String]) -> Vec<Vec<f64>> {
    let place = |name: &String| {
        let mut estimates = outcome.estimates.iter();
        estimates.position(|estimate| estimate.name == *name)
    };
    let places: Vec<usize> = names.iter().filter_map(place).collect();
    let row = |&i: &usize| {
        let row = places.iter();
        row.map(|&j| outcome.correlation[i][j]).collect()
    };
    places.iter().map(row).collect()
}
