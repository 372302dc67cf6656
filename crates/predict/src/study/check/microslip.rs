//! Whether the interface slips under the joint's motion.

use super::{Checked, Checker};
use crate::microslip::Amplitudes;
use crate::patch::Motions;
use crate::study::slip::{Microslip, slipping};
use crate::study::tables::StudyFile;
use bolted_joint_study::Method;

impl Checker<'_> {
    /// What `[microslip]` asks for, of a joint that can slip.
    pub(super) fn microslip(
        &self,
        file: &StudyFile,
        motions: Motions,
        reference_m: [f64; 3],
    ) -> Checked<Option<Microslip>> {
        let Some(table) = &file.microslip else {
            return Ok(None);
        };
        let study = self.study;
        let expected = "method \"fractal-contact\", whose contacts slip bit by bit";
        let good = file.method == Method::FractalContact;
        study.ensure(good, "microslip", "a table", expected)?;
        let slips = slipping(motions, reference_m).next().is_some();
        let expected = "\"x\" or \"y\", along the interface, or a rotation about \"z\": along the normal nothing slips";
        study.ensure(slips, "joint.translation", "\"z\"", expected)?;
        let amplitudes = match table.amplitudes {
            None => None,
            Some(given) => {
                let found = format!("from {} to {}", given.from, given.to);
                let good = given.from > 0.0 && given.to > given.from && given.to.is_finite();
                let expected = "amplitudes in m above zero, from a smaller to a larger one";
                study.ensure(good, "microslip.amplitudes", found, expected)?;
                Some(Amplitudes {
                    from: given.from,
                    to: given.to,
                })
            }
        };
        Ok(Some(Microslip { amplitudes }))
    }
}
