//! A joint over the bolt's preload, taken at one preload.

use bolted_joint_dynamics::{Beyond, law::Term, with_dofs};

use super::{
    FreeEstimate, Friction, Intervals, Joint, JointFile, JointProblem, LawError, OverPreload,
    StandardDeviation, Uncertainty, UncertaintyAtPreload,
};

/// Where a preload lies in a table: between `lower` and the entry after it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    lower: usize,
    /// Share of the entry after it, from 0 to 1.
    share: f64,
}

impl Place {
    fn of(preload_n_m: f64, table: &OverPreload) -> Result<Self, LawError> {
        let preloads = &table.preload;
        let (Some(&first_n_m), Some(&last_n_m)) = (preloads.first(), preloads.last()) else {
            let found = preloads.len();
            return Err(LawError::Invalid {
                problems: vec![JointProblem::TooFewPreloads { found }],
            });
        };
        if !(first_n_m..=last_n_m).contains(&preload_n_m) {
            return Err(LawError::OutsideTable {
                found_n_m: preload_n_m,
                first_n_m,
                last_n_m,
            });
        }
        let above = preloads.partition_point(|&preload| preload <= preload_n_m);
        let lower = above
            .saturating_sub(1)
            .min(preloads.len().saturating_sub(2));
        let (low, high) = (preloads[lower], preloads[lower + 1]);
        Ok(Self {
            lower,
            share: (preload_n_m - low) / (high - low),
        })
    }

    /// Whether it is one of the table's own, and which.
    fn entry(self) -> Option<usize> {
        match self.share {
            0.0 => Some(self.lower),
            1.0 => Some(self.lower + 1),
            _ => None,
        }
    }

    fn between(self, low: f64, high: f64) -> f64 {
        (1.0 - self.share) * low + self.share * high
    }

    fn matrix(self, low: &[Vec<f64>], high: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let rows = low.iter().zip(high);
        let row = |(low, high): (&Vec<f64>, &Vec<f64>)| {
            let pairs = low.iter().zip(high);
            pairs.map(|(&low, &high)| self.between(low, high)).collect()
        };
        rows.map(row).collect()
    }

    fn laws(self, low: &[Friction], high: &[Friction]) -> Vec<Friction> {
        let law = |(low, high): (&Friction, &Friction)| {
            let parameters = low.parameters.iter().zip(&high.parameters);
            Friction {
                parameters: parameters
                    .map(|(&low, &high)| self.between(low, high))
                    .collect(),
                ..low.clone()
            }
        };
        low.iter().zip(high).map(law).collect()
    }

    fn ends(self, low: &[Vec<[f64; 2]>], high: &[Vec<[f64; 2]>]) -> Vec<Vec<[f64; 2]>> {
        let between = |(low, high): (&[f64; 2], &[f64; 2])| {
            [self.between(low[0], high[0]), self.between(low[1], high[1])]
        };
        let rows = low.iter().zip(high);
        let row = |(low, high): (&Vec<[f64; 2]>, &Vec<[f64; 2]>)| {
            low.iter().zip(high).map(between).collect()
        };
        rows.map(row).collect()
    }
}

impl JointFile {
    /// The file of this joint at one preload (N·m), its nominal one unless another is given: K, C and k₃ as
    /// [`bolted_joint_dynamics::JointOverPreload`] has them between the table's preloads, parameters of friction with a table
    /// of its own linearly. A joint that does not depend on the
    /// preload is as it was.
    ///
    /// Standard deviations are interpolated linearly. Name, validity and notes tell the preload.
    ///
    /// # Errors
    ///
    /// [`LawError`] where a preload is given that the joint does not have, or the file is not valid.
    pub fn at_preload(&self, preload_n_m: Option<f64>) -> Result<Self, LawError> {
        let Some(table) = &self.joint.over_preload else {
            return match preload_n_m {
                None => Ok(self.clone()),
                Some(found_n_m) => Err(LawError::ConstantJoint { found_n_m }),
            };
        };
        let problems = self.validate();
        if !problems.is_empty() {
            return Err(LawError::Invalid { problems });
        }
        let preload_n_m = preload_n_m.unwrap_or(table.nominal);
        let place = Place::of(preload_n_m, table)?;
        let mut file = self.clone();
        file.joint =
            with_dofs!(self.joint.dofs.size(), D => self.joint.constant::<D>(preload_n_m))?;
        if table.cubic.is_empty() {
            file.joint.cubic = Vec::new();
        }
        file.name = format!("{}, at {preload_n_m} N·m", self.name);
        file.uncertainty = self
            .uncertainty
            .as_ref()
            .and_then(|uncertainty| uncertainty.at(place, table, preload_n_m == table.nominal));
        let neighbours = match place.entry() {
            Some(entry) => [table.preload[entry]; 2],
            None => [table.preload[place.lower], table.preload[place.lower + 1]],
        };
        if let Some(validity) = &mut file.validity
            && validity.torque_n_m.is_some()
        {
            validity.torque_n_m = Some(neighbours);
        }
        if let Some(provenance) = &mut file.provenance {
            let [low, high] = neighbours;
            provenance.notes.push(match place.entry() {
                Some(_) => format!("The joint at a preload of {preload_n_m} N·m."),
                None => format!(
                    "The joint at a preload of {preload_n_m} N·m, interpolated between {low} and {high} N·m."
                ),
            });
        }
        Ok(file)
    }
}

/// Preloads in each gap of a table at which a joint is judged, beside those of the table.
const JUDGED_BETWEEN: u32 = 3;

impl JointFile {
    /// The joint at every preload of its table and at some between, each as a file of its own; a joint that does not depend
    /// on the preload alone.
    ///
    /// # Errors
    ///
    /// As [`JointFile::at_preload`].
    pub fn over_its_preloads(&self) -> Result<Vec<Self>, LawError> {
        if self.joint.over_preload.is_none() {
            return Ok(vec![self.clone()]);
        }
        let samples: Vec<f64> =
            with_dofs!(self.joint.dofs.size(), D => self.joint.samples_n_m::<D>())?;
        let taken = samples.into_iter();
        taken
            .map(|preload_n_m| self.at_preload(Some(preload_n_m)))
            .collect()
    }
}

impl Joint {
    fn samples_n_m<const D: usize>(&self) -> Result<Vec<f64>, LawError> {
        let table = self.springs_over_preload::<D>(Beyond::Refused)?;
        Ok(table.samples_n_m(JUDGED_BETWEEN).collect())
    }

    /// The joint at a preload (N·m) of its table.
    fn constant<const D: usize>(&self, preload_n_m: f64) -> Result<Self, LawError> {
        let law = self
            .springs_over_preload::<D>(Beyond::Refused)?
            .law(preload_n_m);
        let rows = |matrix: [[f64; D]; D]| matrix.map(|row| row.to_vec()).to_vec();
        let linear = &law.linear;
        let cubic = law
            .polynomials()
            .map(|terms| terms.coefficient(Term::CUBIC));
        Ok(Self {
            cubic: cubic.to_vec(),
            friction: self.friction_at(preload_n_m)?,
            ..Self::linear(self.dofs, rows(linear.stiffness), rows(linear.damping))
        })
    }

    /// The laws that remember at a preload (N·m) of the table.
    fn friction_at(&self, preload_n_m: f64) -> Result<Vec<Friction>, LawError> {
        let Some(table) = &self.over_preload else {
            return Ok(self.friction.clone());
        };
        if table.friction.is_empty() {
            let share = preload_n_m / table.nominal;
            let laws = self.friction.iter();
            return Ok(laws.map(|own| own.at_share_of_preload(share)).collect());
        }
        let place = Place::of(preload_n_m, table)?;
        let at = |entry: usize| table.friction.get(entry).map_or(&[][..], Vec::as_slice);
        Ok(place.laws(at(place.lower), at(place.lower + 1)))
    }
}

impl Uncertainty {
    /// At one place of the table; `None` where nothing is known of it.
    fn at(&self, place: Place, joint: &OverPreload, is_nominal: bool) -> Option<Self> {
        let Some(table) = &self.over_preload else {
            return is_nominal.then(|| self.clone());
        };
        if is_nominal && place.entry().is_some() {
            return Some(Self {
                over_preload: None,
                ..self.clone()
            });
        }
        if let Some(entry) = place.entry() {
            let own = table.at.get(entry)?;
            return Some(Self {
                standard_deviation: own.standard_deviation.clone(),
                basis: self.basis.clone(),
                interval_95: own.interval_95.clone(),
                inflation: self.inflation,
                not_identified: own.not_identified.clone(),
                free_estimate: own.free_estimate.clone(),
                budget: own.budget.clone(),
                bootstrap: own.bootstrap.clone(),
                ..Self::default()
            });
        }
        let (low, high) = (table.at.get(place.lower)?, table.at.get(place.lower + 1)?);
        Some(Self {
            standard_deviation: deviation(place, low, high),
            basis: format!(
                "{}; between {} and {} N·m interpolated linearly; the error of the interpolation of the joint itself is not in \
                 them",
                self.basis, low.preload, high.preload
            ),
            interval_95: low.interval_95.as_ref().zip(high.interval_95.as_ref()).map(
                |(low, high)| Intervals {
                    stiffness: place.ends(&low.stiffness, &high.stiffness),
                    damping: place.ends(&low.damping, &high.damping),
                },
            ),
            inflation: self.inflation,
            not_identified: either(&low.not_identified, &high.not_identified),
            free_estimate: (low.free_estimate.is_some() || high.free_estimate.is_some()).then(
                || {
                    let low = free(low, joint, place.lower);
                    let high = free(high, joint, place.lower + 1);
                    FreeEstimate {
                        stiffness: place.matrix(low.0, high.0),
                        damping: place.matrix(low.1, high.1),
                        ..FreeEstimate::default()
                    }
                },
            ),
            ..Self::default()
        })
    }
}

fn deviation(
    place: Place,
    low: &UncertaintyAtPreload,
    high: &UncertaintyAtPreload,
) -> StandardDeviation {
    let (low, high) = (&low.standard_deviation, &high.standard_deviation);
    StandardDeviation {
        stiffness: place.matrix(&low.stiffness, &high.stiffness),
        damping: place.matrix(&low.damping, &high.damping),
        friction: place.laws(&low.friction, &high.friction),
    }
}

/// K and C of the free estimate at one of the table's preloads: the joint's own where they are the same.
fn free<'f>(
    at: &'f UncertaintyAtPreload,
    joint: &'f OverPreload,
    entry: usize,
) -> (&'f [Vec<f64>], &'f [Vec<f64>]) {
    match &at.free_estimate {
        Some(free) => (&free.stiffness, &free.damping),
        None => (&joint.stiffness[entry], &joint.damping[entry]),
    }
}

/// Names that are in one of the lists.
fn either(one: &[String], other: &[String]) -> Vec<String> {
    let more = other.iter().filter(|name| !one.contains(name));
    one.iter().chain(more).cloned().collect()
}
