//! Checks that the records of a joint file agree with each other: sizes, symmetry, signs.

use bolted_joint_dynamics::law::Range;

use super::{
    About, Body, Correlation, DofSet, Friction, HigherTerms, Joint, JointFile, JointProblem,
    OverPreload, StandardDeviation, Status, UncertaintyOverPreload,
};

/// Whether a name is one line of text. It becomes an attribute in XML, which has no control characters and none of the two
/// noncharacters.
#[must_use]
pub fn is_one_line(name: &str) -> bool {
    let has_no_place = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    !name.trim().is_empty() && !name.chars().any(has_no_place)
}

impl JointFile {
    /// Everything that is wrong with the file's contents, in the order of the file; empty where all is well.
    ///
    /// Whether the joint is passive is not judged here: see [`JointFile::passivity`].
    #[must_use]
    pub fn validate(&self) -> Vec<JointProblem> {
        let mut check = Check {
            dofs: self.joint.dofs,
            problems: Vec::new(),
        };
        if !is_one_line(&self.name) {
            check.problems.push(JointProblem::Name {
                found: self.name.clone(),
            });
        }
        for (key, text) in self.about.iter().flat_map(About::texts) {
            if !is_one_line(text) {
                check.problems.push(JointProblem::About {
                    key,
                    found: text.to_owned(),
                });
            }
        }
        if let Some(status) = &self.status {
            check.status(status);
        }
        check.joint(&self.joint);
        if let Some(bodies) = &self.bodies {
            check.body("bodies.a", &bodies.a);
            check.body("bodies.b", &bodies.b);
        }
        if let Some(uncertainty) = &self.uncertainty {
            let deviation = &uncertainty.standard_deviation;
            check.deviation("uncertainty.standard_deviation", deviation);
            let at_nominal = self
                .joint
                .over_preload
                .as_ref()
                .and_then(|table| table.friction.first());
            let laws = match at_nominal {
                Some(laws) if self.joint.friction.is_empty() => laws,
                _ => &self.joint.friction,
            };
            check.friction_deviation(
                "uncertainty.standard_deviation.friction",
                &deviation.friction,
                laws,
            );
            if let Some(over_preload) = &uncertainty.over_preload {
                let table = self.joint.over_preload.as_ref();
                check.uncertainty_over_preload(over_preload, table);
            }
        }
        if let Some(uncertainty) = &self.uncertainty {
            if let Some(correlation) = &uncertainty.correlation {
                const OF: &str = "uncertainty.correlation.unknowns";
                check.correlation("uncertainty.correlation.matrix", correlation, OF);
            }
            if let Some(free) = &uncertainty.free_estimate {
                check.matrix("uncertainty.free_estimate.stiffness", &free.stiffness);
                check.matrix("uncertainty.free_estimate.damping", &free.damping);
            }
        }
        if let Some(validity) = &self.validity {
            check.band(&validity.frequency_hz);
        }
        if let Some(residual) = &self.residual {
            let what = "a root mean square";
            check.magnitude("residual.relative_rms", residual.relative_rms, what);
            for (i, function) in residual.functions.iter().enumerate() {
                let path = format!("residual.functions[{i}].relative_rms");
                check.magnitude(&path, function.relative_rms, what);
            }
        }
        if let Some(provenance) = &self.provenance {
            for (i, input) in provenance.inputs.iter().enumerate() {
                check.hash(&format!("provenance.inputs[{i}].sha256"), &input.sha256);
            }
        }
        check.problems
    }
}

/// Laws with their DOFs.
fn names(laws: &[Friction]) -> Vec<String> {
    let each = laws.iter();
    each.map(|own| format!("{} on {}", own.law.name, own.dof.name))
        .collect()
}

/// What the lists of a table over the preload are as long as.
const PRELOADS: &str = "joint.over_preload.preload";

/// The problems found so far, and the DOFs that sizes are compared with.
struct Check {
    dofs: DofSet,
    problems: Vec<JointProblem>,
}

impl Check {
    fn status(&mut self, status: &Status) {
        if status.usable != status.reasons.is_empty() {
            self.problems.push(JointProblem::Status {
                usable: status.usable,
                reasons: status.reasons.len(),
            });
        }
        if let Some(found) = status.reasons.iter().find(|reason| !is_one_line(reason)) {
            self.problems.push(JointProblem::Reason {
                found: found.clone(),
            });
        }
    }

    fn joint(&mut self, joint: &Joint) {
        let replaced = joint.over_preload.is_some();
        for (path, matrix) in [
            ("joint.stiffness", &joint.stiffness),
            ("joint.damping", &joint.damping),
        ] {
            if !matrix.is_empty() {
                self.matrix(path, matrix);
            } else if !replaced {
                self.problems.push(JointProblem::Missing {
                    path: path.to_owned(),
                    expected: "a symmetric matrix with a row for each of joint.dofs",
                });
            }
        }
        if !joint.cubic.is_empty() {
            self.list("joint.cubic", &joint.cubic);
        }
        if let Some(terms) = &joint.higher {
            self.higher(terms);
        }
        self.friction("joint.friction", &joint.friction);
        if let Some(table) = &joint.over_preload {
            if joint.higher.is_some() {
                self.beside_table("joint.higher", "terms of higher order");
            }
            self.friction_over_preload(&joint.friction, table);
            self.over_preload(table);
        }
    }

    fn beside_table(&mut self, path: &'static str, what: &'static str) {
        self.problems.push(JointProblem::BesideTable { path, what });
    }

    fn friction(&mut self, list: &str, laws: &[Friction]) {
        for (i, own) in laws.iter().enumerate() {
            let path = format!("{list}[{i}]");
            let (dof, law) = (own.dof.name, own.law.name);
            if self.dofs.position(dof).is_none() {
                self.problems.push(JointProblem::OtherDof {
                    path: format!("{path}.dof"),
                    found: dof,
                    dofs: self.dofs,
                });
            }
            let before = laws[..i].iter();
            let same = before.filter(|other| other.dof.name == dof && other.law == own.law);
            let (found, at_most) = (same.count() + 1, own.law.at_most);
            if found > at_most {
                self.problems.push(JointProblem::TooManyLaws {
                    path: format!("{path}.law"),
                    law,
                    dof,
                    found,
                    at_most,
                });
            }
            let before = self.problems.len();
            for (parameter, &found) in own.law.parameters.iter().zip(&own.parameters) {
                let path = format!("{path}.{}", parameter.key);
                match parameter.range {
                    Range::Any if found.is_finite() => {}
                    Range::Any => self.problems.push(JointProblem::NotFinite { path, found }),
                    Range::NotNegative => self.magnitude(&path, found, "a number"),
                }
            }
            if self.problems.len() == before
                && let Some(outside) = own.outside()
                && let Some(parameter) = own.law.parameters.get(outside.parameter)
            {
                self.problems.push(JointProblem::OutsideLaw {
                    path: format!("{path}.{}", parameter.key),
                    found: own.value(parameter).unwrap_or(f64::NAN),
                    expected: outside.expected,
                });
            }
        }
    }

    fn friction_over_preload(&mut self, laws: &[Friction], table: &OverPreload) {
        if !laws.is_empty() && table.nominal == 0.0 {
            self.problems.push(JointProblem::NothingPresses);
        }
        const PATH: &str = "joint.over_preload.friction";
        let Some(first) = table.friction.first() else {
            return;
        };
        if !laws.is_empty() {
            self.problems.push(JointProblem::FrictionTwice);
        }
        let preloads = table.preload.len();
        self.table_length(PATH, table.friction.len(), preloads, PRELOADS);
        for (i, own) in table.friction.iter().enumerate() {
            let path = format!("{PATH}[{i}]");
            self.friction(&path, own);
            let [found, expected] = [own, first].map(|laws| names(laws));
            if found != expected {
                self.problems.push(JointProblem::OtherLaws {
                    path,
                    found: found.join(", "),
                    expected: expected.join(", "),
                });
            }
        }
        if self.problems.is_empty() {
            self.friction_between(table);
        }
    }

    /// Between two preloads parameters are linear, and have to be in the law's range all the way.
    fn friction_between(&mut self, table: &OverPreload) {
        let gaps = table.friction.windows(2).zip(table.preload.windows(2));
        for (i, (laws, preloads)) in gaps.enumerate() {
            for (j, (own, next)) in laws[0].iter().zip(&laws[1]).enumerate() {
                let Some((share, outside)) = own.outside_towards(next) else {
                    continue;
                };
                let Some(parameter) = own.law.parameters.get(outside.parameter) else {
                    continue;
                };
                let (low, high) = (preloads[0], preloads[1]);
                self.problems.push(JointProblem::OutsideBetween {
                    path: format!("joint.over_preload.friction[{i}][{j}].{}", parameter.key),
                    law: own.law.name,
                    low,
                    high,
                    between: low + share * (high - low),
                    expected: outside.expected,
                });
            }
        }
    }

    fn higher(&mut self, terms: &HigherTerms) {
        for (key, entries) in terms.keyed() {
            if !entries.is_empty() {
                self.list(&format!("joint.higher.{key}"), entries);
            }
        }
        for (i, &found) in terms.amplitude.iter().enumerate() {
            if found <= 0.0 {
                let path = format!("joint.higher.amplitude[{i}]");
                self.problems.push(JointProblem::Amplitude { path, found });
            }
        }
    }

    fn over_preload(&mut self, table: &OverPreload) {
        const PATH: &str = "joint.over_preload";
        let path = format!("{PATH}.preload");
        let preloads = &table.preload;
        if preloads.len() < 2 {
            self.problems.push(JointProblem::TooFewPreloads {
                found: preloads.len(),
            });
        }
        self.finite_list(&path, preloads);
        self.not_negative(&path, preloads, "a preload");
        for (i, pair) in preloads.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                self.problems.push(JointProblem::PreloadNotIncreasing {
                    path: format!("{path}[{}]", i + 1),
                    found: pair[1],
                    previous: pair[0],
                });
            }
        }
        if let (Some(&first), Some(&last)) = (preloads.first(), preloads.last())
            && !(first..=last).contains(&table.nominal)
        {
            self.problems.push(JointProblem::NominalOutside {
                found: table.nominal,
                first,
                last,
            });
        }
        for (key, matrices) in [("stiffness", &table.stiffness), ("damping", &table.damping)] {
            let path = format!("{PATH}.{key}");
            self.table_length(&path, matrices.len(), preloads.len(), PRELOADS);
            for (i, matrix) in matrices.iter().enumerate() {
                self.matrix(&format!("{path}[{i}]"), matrix);
            }
        }
        if !table.cubic.is_empty() {
            let path = format!("{PATH}.cubic");
            self.table_length(&path, table.cubic.len(), preloads.len(), PRELOADS);
            for (i, cubic) in table.cubic.iter().enumerate() {
                self.list(&format!("{path}[{i}]"), cubic);
            }
        }
    }

    fn uncertainty_over_preload(
        &mut self,
        uncertainty: &UncertaintyOverPreload,
        table: Option<&OverPreload>,
    ) {
        const PATH: &str = "uncertainty.over_preload";
        let preloads = table.map_or(&[][..], |table| &table.preload);
        let path = format!("{PATH}.at");
        self.table_length(&path, uncertainty.at.len(), preloads.len(), PRELOADS);
        for (i, at) in uncertainty.at.iter().enumerate() {
            let path = format!("{path}[{i}]");
            if let Some(&expected) = preloads.get(i)
                && at.preload != expected
            {
                self.problems.push(JointProblem::OtherPreload {
                    path: format!("{path}.preload"),
                    found: at.preload,
                    expected,
                });
            }
            self.deviation(
                &format!("{path}.standard_deviation"),
                &at.standard_deviation,
            );
            let laws = table.and_then(|table| table.friction.get(i));
            self.friction_deviation(
                &format!("{path}.standard_deviation.friction"),
                &at.standard_deviation.friction,
                laws.map_or(&[], Vec::as_slice),
            );
            if let Some(free) = &at.free_estimate {
                let path = format!("{path}.free_estimate");
                self.matrix(&format!("{path}.stiffness"), &free.stiffness);
                self.matrix(&format!("{path}.damping"), &free.damping);
            }
        }
        if let Some(correlation) = &uncertainty.correlation {
            const OF: &str = "uncertainty.over_preload.correlation.unknowns";
            self.correlation(&format!("{PATH}.correlation.matrix"), correlation, OF);
        }
    }

    fn deviation(&mut self, path: &str, deviation: &StandardDeviation) {
        for (key, matrix) in [
            ("stiffness", &deviation.stiffness),
            ("damping", &deviation.damping),
        ] {
            let path = format!("{path}.{key}");
            self.matrix(&path, matrix);
            for (i, row) in matrix.iter().enumerate() {
                self.not_negative(&format!("{path}[{i}]"), row, "a standard deviation");
            }
        }
    }

    /// Deviations of the numbers of `laws`, if there are any.
    fn friction_deviation(&mut self, path: &str, deviations: &[Friction], laws: &[Friction]) {
        if deviations.is_empty() {
            return;
        }
        let [found, expected] = [deviations, laws].map(names);
        if found != expected {
            self.problems.push(JointProblem::DeviationsOfOtherLaws {
                path: path.to_owned(),
                found: found.join(", "),
                expected: expected.join(", "),
            });
            return;
        }
        for (i, own) in deviations.iter().enumerate() {
            for (key, found) in own.keyed() {
                self.magnitude(&format!("{path}[{i}].{key}"), found, "a standard deviation");
            }
        }
    }

    fn correlation(&mut self, path: &str, correlation: &Correlation, of: &'static str) {
        let size = correlation.unknowns.len();
        self.table_length(path, correlation.matrix.len(), size, of);
        for (i, row) in correlation.matrix.iter().enumerate() {
            let path = format!("{path}[{i}]");
            self.table_length(&path, row.len(), size, of);
            self.finite_list(&path, row);
        }
    }

    fn body(&mut self, path: &str, body: &Body) {
        let inertia = format!("{path}.inertia");
        self.list(&inertia, &body.inertia);
        for (i, &found) in body.inertia.iter().enumerate() {
            if found <= 0.0 {
                let path = format!("{inertia}[{i}]");
                self.problems.push(JointProblem::Inertia { path, found });
            }
        }
        for (key, list, what) in [
            ("stiffness", &body.stiffness, "a support stiffness"),
            ("damping", &body.damping, "a support damping"),
        ] {
            let path = format!("{path}.{key}");
            self.list(&path, list);
            self.not_negative(&path, list, what);
        }
    }

    /// A square matrix with a row for each DOF, finite and symmetric.
    fn matrix(&mut self, path: &str, matrix: &[Vec<f64>]) {
        if self.length(path, matrix.len()) {
            for (i, row) in matrix.iter().enumerate() {
                self.list(&format!("{path}[{i}]"), row);
            }
        }
        for (row, entries) in matrix.iter().enumerate() {
            for (column, &upper) in entries.iter().enumerate().skip(row + 1) {
                let Some(&lower) = matrix.get(column).and_then(|entries| entries.get(row)) else {
                    continue;
                };
                if upper != lower && upper.is_finite() && lower.is_finite() {
                    self.problems.push(JointProblem::Asymmetric {
                        path: path.to_owned(),
                        row,
                        column,
                        upper,
                        lower,
                    });
                }
            }
        }
    }

    /// A list with a finite entry for each DOF.
    fn list(&mut self, path: &str, entries: &[f64]) {
        self.length(path, entries.len());
        self.finite_list(path, entries);
    }

    fn length(&mut self, path: &str, found: usize) -> bool {
        let fits = found == self.dofs.count();
        if !fits {
            self.problems.push(JointProblem::Length {
                path: path.to_owned(),
                found,
                dofs: self.dofs,
            });
        }
        fits
    }

    fn table_length(&mut self, path: &str, found: usize, expected: usize, of: &'static str) {
        if found != expected {
            let path = path.to_owned();
            self.problems.push(JointProblem::TableLength {
                path,
                found,
                expected,
                of,
            });
        }
    }

    fn finite_list(&mut self, path: &str, entries: &[f64]) {
        for (i, &found) in entries.iter().enumerate() {
            if !found.is_finite() {
                let path = format!("{path}[{i}]");
                self.problems.push(JointProblem::NotFinite { path, found });
            }
        }
    }

    fn not_negative(&mut self, path: &str, entries: &[f64], what: &'static str) {
        for (i, &found) in entries.iter().enumerate() {
            if found < 0.0 {
                let path = format!("{path}[{i}]");
                self.problems
                    .push(JointProblem::Negative { path, found, what });
            }
        }
    }

    fn magnitude(&mut self, path: &str, found: f64, what: &'static str) {
        let path = path.to_owned();
        if !found.is_finite() {
            self.problems.push(JointProblem::NotFinite { path, found });
        } else if found < 0.0 {
            self.problems
                .push(JointProblem::Negative { path, found, what });
        }
    }

    fn band(&mut self, frequency_hz: &[f64; 2]) {
        self.finite_list("validity.frequency_hz", frequency_hz);
        self.not_negative("validity.frequency_hz", frequency_hz, "a frequency");
        let [from_hz, to_hz] = *frequency_hz;
        if from_hz > to_hz {
            self.problems.push(JointProblem::Band { from_hz, to_hz });
        }
    }

    fn hash(&mut self, path: &str, found: &str) {
        let is_digit = |c: char| c.is_ascii_digit() || ('a'..='f').contains(&c);
        if found.len() != 64 || !found.chars().all(is_digit) {
            self.problems.push(JointProblem::Hash {
                path: path.to_owned(),
                found: found.to_owned(),
            });
        }
    }
}
