//! Beams of a study, to be computed.

use bolted_joint_frf::structure::{SpaceBeam, SpacePoint, Theory};
use bolted_joint_study::{BeamNumber, StudyError};

use crate::study::Reader;
use crate::tables::{BeamPointTable, BeamTable, TheoryName};

/// How far from the interface a point of a beam is along an axis at most, m.
const FARTHEST_POINT_M: f64 = 20.0;

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
    /// Refuses numbers that no joint's test has.
    pub(super) fn plausible(&self, name: &str, table: &BeamTable) -> Result<(), StudyError> {
        let key = format_args!("{name}.beam");
        for (number, found) in [
            (BeamNumber::Width, table.width),
            (BeamNumber::Height, table.height),
            (BeamNumber::YoungsModulus, table.youngs_modulus),
            (BeamNumber::Density, table.density),
        ] {
            self.study.plausible_in_beam(key, number, found)?;
        }
        let places = table.points.iter().flat_map(|point| point.position);
        let farthest = places.map(f64::abs).fold(0.0, f64::max);
        self.study.ensure(
            farthest <= FARTHEST_POINT_M,
            format_args!("{key}.points"),
            farthest,
            format_args!("places in m, at most {FARTHEST_POINT_M} m from the interface (are they in millimetres?)"),
        )
    }
}
