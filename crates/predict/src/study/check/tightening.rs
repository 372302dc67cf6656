//! How tight the bolts of a study are, and at which torques.

use super::{Checked, Checker};
use crate::pressure::{ThreadFriction, coarse_pitch_m};
use crate::study::clamping::{BoltInput, Clamping, Tightness, Wrench};
use crate::study::tables::{BoltTable, ScatterWord, StudyFile, ThreadTable, TighteningTable};
use crate::uncertain::{Distribution, Spread};

impl Checker<'_> {
    pub(super) fn torques(
        &self,
        table: Option<&TighteningTable>,
    ) -> Checked<(Vec<f64>, Option<f64>)> {
        let Some(table) = table else {
            return Ok((Vec::new(), None));
        };
        let Some(torques) = &table.torques else {
            return match table.nominal {
                None => Ok((Vec::new(), None)),
                Some(nominal) => self.study.refuse(
                    "tightening.nominal",
                    nominal,
                    "a nominal torque only beside torques",
                ),
            };
        };
        let expected = "two torques or more in N·m, above zero and ascending";
        self.study
            .ascending("tightening.torques", torques, 2, expected)?;
        let nominal = table.nominal.or(torques.last().copied());
        match nominal {
            Some(nominal) if !torques.contains(&nominal) => {
                self.study
                    .refuse("tightening.nominal", nominal, format!("one of {torques:?}"))
            }
            nominal => Ok((torques.clone(), nominal)),
        }
    }

    pub(super) fn clamping(&mut self, file: &StudyFile, has_table: bool) -> Checked<Clamping> {
        let common = match file.tightening.as_ref() {
            Some(table) if table.scatter == Some(ScatterWord::Common) => self.wrench(table, "")?,
            _ => None,
        };
        let mut bolts = Vec::with_capacity(file.bolts.len());
        for (number, bolt) in (1..).zip(&file.bolts) {
            let tightness =
                self.tightness(number, bolt, file.tightening.as_ref(), &common, has_table)?;
            bolts.push(BoltInput {
                x_m: bolt.x,
                y_m: bolt.y,
                diameter_m: bolt.diameter,
                tightness,
            });
        }
        let expected = "[[bolts]], which the torques of [tightening] are for";
        self.study
            .ensure(!bolts.is_empty() || !has_table, "bolts", "none", expected)?;
        let moment = file.pressure.as_ref().and_then(|p| p.bending_moment);
        let moments = match moment {
            Some(_) if bolts.is_empty() => {
                return self.study.refuse(
                    "pressure.bending_moment",
                    "a moment without bolts",
                    "[[bolts]], whose preloads it changes",
                );
            }
            Some([about_x, about_y]) => {
                let mut add =
                    |name: &str, of| self.inputs.add(name, Distribution::new(Spread::Normal, of));
                Some([
                    add("bending moment about x", about_x),
                    add("bending moment about y", about_y),
                ])
            }
            None => None,
        };
        Ok(Clamping { bolts, moments })
    }

    fn tightness(
        &mut self,
        number: usize,
        bolt: &BoltTable,
        tightening: Option<&TighteningTable>,
        common: &Option<Wrench>,
        has_table: bool,
    ) -> Checked<Tightness> {
        let key = |name: &str| format!("bolts[{number}].{name}");
        match (bolt.preload, bolt.torque) {
            (Some(_), Some(_)) => {
                self.study
                    .refuse(key("preload"), "a torque beside it", "the one or the other")
            }
            (Some(preload), None) => match has_table {
                true => self.study.refuse(
                    key("preload"),
                    preload,
                    "no preload: it follows from the torques of [tightening]",
                ),
                false => Ok(Tightness::Preload(self.positive(
                    &key("preload"),
                    format!("preload of bolt {number}"),
                    preload,
                )?)),
            },
            (None, torque) => {
                let own = match (common, tightening) {
                    (Some(common), _) => Some(common.clone()),
                    (None, Some(table)) => self.wrench(table, &format!(" of bolt {number}"))?,
                    (None, None) => None,
                };
                match (torque, has_table, own) {
                    (Some(torque), true, _) => self.study.refuse(
                        key("torque"),
                        torque,
                        "no torque: that of each bolt is in tightening.torques",
                    ),
                    (_, _, None) if torque.is_some() || has_table => self.study.refuse(
                        "tightening.nut_factor",
                        "nothing",
                        "nut_factor, about 0.2 for dry steel, or thread = { friction = …, head_friction = …, head_diameter = …, hole_diameter = … }: \
                         without it no preload follows from a torque",
                    ),
                    (Some(torque), false, Some(wrench)) => Ok(Tightness::Torque(
                        self.positive(&key("torque"), format!("torque of bolt {number}"), torque)?,
                        wrench.with_diameter(bolt.diameter),
                    )),
                    (None, true, Some(wrench)) => {
                        Ok(Tightness::OfTable(wrench.with_diameter(bolt.diameter)))
                    }
                    (None, false, _) | (Some(_), false, None) | (None, true, None) => self.study.refuse(
                        key("preload"),
                        "nothing",
                        "a preload in N, or a torque in N·m with [tightening]",
                    ),
                }
            }
        }
    }

    /// What becomes of a torque; `suffix` tells whose inputs they are.
    fn wrench(&mut self, table: &TighteningTable, suffix: &str) -> Checked<Option<Wrench>> {
        match (table.nut_factor, &table.thread) {
            (Some(_), Some(_)) => self.study.refuse(
                "tightening.nut_factor",
                "thread beside it",
                "the one or the other",
            ),
            (Some(factor), None) => {
                let name = format!("nut factor{suffix}");
                let place = self.positive("tightening.nut_factor", name, factor)?;
                Ok(Some(Wrench::NutFactor(place)))
            }
            (None, Some(thread)) => self.thread(thread, suffix).map(Some),
            (None, None) => Ok(None),
        }
    }

    fn thread(&mut self, table: &ThreadTable, suffix: &str) -> Checked<Wrench> {
        let key = |name: &str| format!("tightening.thread.{name}");
        for (name, value) in [
            ("pitch", table.pitch.unwrap_or(1.0)),
            ("head_diameter", table.head_diameter),
            ("hole_diameter", table.hole_diameter),
        ] {
            self.study
                .positive(key(name), value, "a length in m above zero")?;
        }
        Ok(Wrench::Friction {
            thread: ThreadFriction {
                // of the bolt that it turns: Wrench::with_diameter
                diameter_m: f64::NAN,
                pitch_m: table.pitch.unwrap_or(f64::NAN),
                thread_coefficient: table.friction.value,
                head_coefficient: table.head_friction.value,
                bearing_outer_diameter_m: table.head_diameter,
                bearing_inner_diameter_m: table.hole_diameter,
            },
            thread_coefficient: self.positive(
                &key("friction"),
                format!("thread friction{suffix}"),
                table.friction,
            )?,
            head_coefficient: self.positive(
                &key("head_friction"),
                format!("head friction{suffix}"),
                table.head_friction,
            )?,
        })
    }
}

impl Wrench {
    /// For a bolt of this diameter, m.
    fn with_diameter(mut self, diameter: f64) -> Self {
        if let Self::Friction { thread, .. } = &mut self {
            thread.diameter_m = diameter;
            if thread.pitch_m.is_nan() {
                // an unknown one stays no number, which the preload is refused for
                thread.pitch_m = coarse_pitch_m(diameter).unwrap_or(f64::NAN);
            }
        }
        self
    }
}
