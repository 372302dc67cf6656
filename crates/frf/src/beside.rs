//! Functions with coherences that stand in files of their own, and what is told of these: the same for every method that reads them.

use std::path::PathBuf;

use super::{Dof, FrfError, FrfReading, FrfSet};

/// A file of coherences, and the functions that they belong to.
struct OfFile {
    path: PathBuf,
    pairs: Vec<(Dof, Dof)>,
}

impl FrfReading {
    /// The functions as one set, with the coherences of these other files as well, and what had to be assumed of both or is not used.
    ///
    /// # Errors
    /// Those of [`FrfReading::with_coherences_of`] and of [`FrfReading::into_set`].
    pub fn into_set_beside(self, coherences: Vec<Self>) -> Result<(FrfSet, Vec<String>), FrfError> {
        let functions = self.path.clone();
        let mut reading = self;
        let mut files = Vec::new();
        for own in coherences {
            let pairs = own.coherences.iter();
            files.push(OfFile {
                pairs: pairs.map(|one| (one.response, one.reference)).collect(),
                path: own.path.clone(),
            });
            reading = reading.with_coherences_of(own)?;
        }
        let assumed = [reading.units_warning(), reading.phase_warning()];
        let mut told: Vec<String> = assumed.into_iter().flatten().collect();
        if !reading.coherences.is_empty() && reading.averages().is_none() {
            let path = files.first().map_or(&functions, |own| &own.path);
            told.push(format!(
                "{}: coherence is not used, since the number of averages is not known; state averages beside frf",
                path.display()
            ));
        }
        let left_out = reading.not_selected.clone();
        let set = reading.into_set()?;
        let of_file = |remark| format!("{}: {remark}", functions.display());
        told.extend(set.tells_too_little().map(of_file));
        for own in files {
            let belongs = |&(response, reference): &(Dof, Dof)| {
                let read = set.functions().map(|own| (own.0, own.1));
                read.chain(left_out.iter().copied()).any(|(p, q)| {
                    [p, p.flipped()].contains(&response) && [q, q.flipped()].contains(&reference)
                })
            };
            if !own.pairs.iter().any(belongs) {
                told.push(format!(
                    "{}: none of its coherences belongs to a function of {}; correct the degrees of freedom in one of the two",
                    own.path.display(),
                    functions.display()
                ));
            }
        }
        Ok((set, told))
    }
}
