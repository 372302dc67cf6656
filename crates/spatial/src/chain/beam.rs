//! Beams of a study, to be computed.

use bolted_joint_frf::structure::{SpaceBeam, SpacePoint, Theory};
use bolted_joint_study::StudyError;

use crate::study::Reader;
use crate::tables::{BeamPointTable, BeamTable, TheoryName};

pub(super) fn computed(table: &BeamTable) -> SpaceBeam {
    let point = |own: &BeamPointTable| SpacePoint {
        node: own.node,
        position_m: own.position,
    };
    SpaceBeam {
        points: table.points.iter().map(point).collect(),
        width_m: table.width,
        height_m: table.height,
        height_along: table.height_along,
        youngs_modulus_pa: table.youngs_modulus,
        density_kg_per_m3: table.density,
        poissons_ratio: (table.poissons_ratio).unwrap_or(Theory::USUAL_POISSONS_RATIO),
        has_shear: matches!(table.theory, TheoryName::Timoshenko),
        held: table.held.clone(),
        damping_ratio: table.damping_ratio.list(),
    }
}

impl Reader<'_> {
    /// Refuses numbers that no joint's test has, and names the slip that they look like. What is no number at all is left to the
    /// beam's own check.
    pub(super) fn plausible(&self, name: &str, table: &BeamTable) -> Result<(), StudyError> {
        let places = table.points.iter().flat_map(|point| point.position);
        let farthest = places.map(f64::abs).fold(0.0, f64::max);
        for (key, found, [least, most], expected) in [
            (
                "points",
                farthest,
                [0.0, 20.0],
                "places in m, at most 20 m from the interface (are they in millimetres?)",
            ),
            (
                "width",
                table.width,
                [1e-4, 2.0],
                "a width in m, from 0.0001 to 2 (is it in millimetres?)",
            ),
            (
                "height",
                table.height,
                [1e-4, 2.0],
                "a height in m, from 0.0001 to 2 (is it in millimetres?)",
            ),
            (
                "youngs_modulus",
                table.youngs_modulus,
                [1e8, 2e12],
                "Young's modulus in Pa, from 1e8 to 2e12 (is it in GPa or MPa?)",
            ),
            (
                "density",
                table.density,
                [50.0, 30e3],
                "a density in kg/m³, from 50 to 30000 (is it in g/cm³ or t/mm³?)",
            ),
        ] {
            let is_plausible =
                (least..=most).contains(&found) || !found.is_finite() || found <= 0.0;
            self.study.ensure(
                is_plausible,
                format_args!("{name}.beam.{key}"),
                found,
                expected,
            )?;
        }
        Ok(())
    }
}
