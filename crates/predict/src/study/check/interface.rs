//! The interface of a study, how the pressure is spread over it, and which of its motions become the joint.

use super::{Checked, Checker, ELEMENTS};
use crate::patch::Planar;
use crate::pressure::{
    Cone, ConePressure, PressureField, Reach, Rectangle, ThicknessRatio, Zone, ZoneForce,
};
use crate::study::clamping::Clamping;
use crate::study::geometry::Geometry;
use crate::study::origin;
use crate::study::tables::{
    DistributionWord, ForceWord, InterfaceTable, JointTable, PressureModel, PressureTable,
    ReachWord, StudyFile,
};
use std::path::Path;

impl Checker<'_> {
    pub(super) fn geometry(
        &mut self,
        file: &StudyFile,
        clamping: &Clamping,
        nominal_n_m: Option<f64>,
    ) -> Checked<Geometry> {
        let nominal = self.inputs.nominal();
        let bolts = clamping.bolts(&nominal, nominal_n_m);
        let bolts = self.model("bolts", bolts)?;
        let table = &file.interface;
        if let Some(field) = &table.field {
            let preload_n = bolts.iter().map(|bolt| bolt.preload_n).sum();
            return self.given(
                table,
                file.pressure.as_ref(),
                field,
                (!bolts.is_empty()).then_some(preload_n),
            );
        }
        let (Some(x_m), Some(y_m)) = (table.x, table.y) else {
            return self.refuse(
                "interface",
                "neither field nor both of x and y",
                "x = [from, to] and y = [from, to] in m with [pressure] and [[bolts]], or field = \"field.csv\"",
            );
        };
        if let Some(area) = table.area {
            return self.refuse(
                "interface.area",
                area,
                "an area only beside a field, which it is compared with",
            );
        }
        let Some(pressure) = &file.pressure else {
            return self.refuse(
                "pressure.model",
                "nothing",
                "\"uniform\", \"kavi\" or \"cone\"",
            );
        };
        if bolts.is_empty() {
            return self.refuse("bolts", "none", "[[bolts]], which press the parts together");
        }
        let outline = self.model("interface", Rectangle::new(x_m, y_m))?;
        let cells = table.elements.unwrap_or(ELEMENTS);
        let clearance_m = pressure.clearance.unwrap_or(0.0);
        let geometry = match self.zone(pressure)? {
            Some(zone) => Geometry::zones(outline, cells, &bolts, clearance_m, zone),
            None => Geometry::even(outline, cells, &bolts, clearance_m),
        };
        self.model("interface", geometry)
    }

    /// A field from elsewhere.
    fn given(
        &mut self,
        table: &InterfaceTable,
        pressure: Option<&PressureTable>,
        path: &Path,
        preload_n: Option<f64>,
    ) -> Checked<Geometry> {
        if table.x.is_some() || table.y.is_some() || table.elements.is_some() {
            return self.refuse(
                "interface.field",
                "x, y or elements beside it",
                "the one or the other: the field has its own elements",
            );
        }
        if let Some(pressure) = pressure {
            if pressure.model.is_some() {
                return self.refuse(
                    "pressure.model",
                    "a model beside interface.field",
                    "the one or the other: the field has its own pressures",
                );
            }
            if pressure.bending_moment.is_some() {
                return self.refuse(
                    "pressure.bending_moment",
                    "a moment beside interface.field",
                    "a field that was computed with the moment",
                );
            }
        }
        let path = origin::resolved(self.folder, path);
        if let Some(area_m2) = table.area
            && !(area_m2.is_finite() && area_m2 > 0.0)
        {
            return self.refuse("interface.area", area_m2, "m² above zero");
        }
        let record = origin::of_file(
            "pressure field",
            &path,
            self.folder,
            "a pressure field (CSV with the columns x, y, area, pressure)",
        )?;
        let field = PressureField::read(&path, table.area)?;
        self.files.push(record);
        self.model("interface.field", Geometry::given(&field, preload_n))
    }

    /// `None` for an even pressure.
    fn zone(&self, table: &PressureTable) -> Checked<Option<Zone>> {
        match table.model {
            None => self.refuse(
                "pressure.model",
                "nothing",
                "\"uniform\", \"kavi\" or \"cone\"",
            ),
            Some(PressureModel::Uniform) => Ok(None),
            Some(PressureModel::Kavi) => {
                let Some([a_m, b_m]) = table.thickness else {
                    return self.refuse(
                        "pressure.thickness",
                        "nothing",
                        "[a, b], the thicknesses of both parts in m: the polynomial depends on their ratio",
                    );
                };
                let ratio = self.model("pressure.thickness", ThicknessRatio::of(a_m, b_m))?;
                Ok(Some(Zone::Polynomial {
                    thickness_ratio: ratio,
                    reach: match table.reach {
                        Some(ReachWord::Rivets) => Reach::Rivets,
                        Some(ReachWord::Bolts) | None => Reach::Bolts,
                    },
                    force: match table.force {
                        Some(ForceWord::AsPublished) => ZoneForce::AsPublished,
                        Some(ForceWord::Preload) | None => ZoneForce::Preload,
                    },
                }))
            }
            Some(PressureModel::Cone) => {
                let given = |key: &str, value: Option<f64>, what: &str| match value {
                    Some(value) => Ok(value),
                    None => self.refuse(format!("pressure.{key}"), "nothing", what),
                };
                Ok(Some(Zone::Cone(Cone {
                    half_angle_rad: given(
                        "half_angle",
                        table.half_angle,
                        "the cone's half angle in degrees, about 30 for steel",
                    )?
                    .to_radians(),
                    head_diameter_m: given(
                        "head_diameter",
                        table.head_diameter,
                        "the diameter in m of the head or washer",
                    )?,
                    depth_m: given(
                        "depth",
                        table.depth,
                        "the thickness in m between head and interface",
                    )?,
                    distribution: match table.distribution {
                        Some(DistributionWord::Uniform) => ConePressure::Uniform,
                        Some(DistributionWord::Parabolic) | None => ConePressure::Parabolic,
                    },
                })))
            }
        }
    }

    pub(super) fn joint(
        &self,
        table: &JointTable,
        geometry: &Geometry,
    ) -> Checked<(Planar, [f64; 3])> {
        let planar = self.model(
            "joint.rotation",
            Planar::new(table.translation, table.rotation),
        )?;
        let reference_m = match table.reference.as_deref() {
            None => {
                let [x_m, y_m] = geometry.centroid_m();
                // a centroid at 1e-18 m is one at zero
                let size_m = geometry.area_m2().sqrt();
                let clean = |length: f64| match length.abs() < 1e-12 * size_m {
                    true => 0.0,
                    false => length,
                };
                [clean(x_m), clean(y_m), 0.0]
            }
            Some([x_m, y_m]) => [*x_m, *y_m, 0.0],
            Some([x_m, y_m, z_m]) => [*x_m, *y_m, *z_m],
            Some(other) => {
                return self.refuse(
                    "joint.reference",
                    format!("{other:?}"),
                    "[x, y] or [x, y, z] in m, z along the normal from the interface",
                );
            }
        };
        match reference_m.iter().all(|length| length.is_finite()) {
            true => Ok((planar, reference_m)),
            false => self.refuse(
                "joint.reference",
                format!("{reference_m:?}"),
                "finite lengths in m",
            ),
        }
    }
}

pub(super) fn pressure_in_words(file: &StudyFile) -> String {
    if let Some(field) = &file.interface.field {
        return format!("field of {}", field.display());
    }
    match file.pressure.as_ref().and_then(|table| table.model) {
        Some(PressureModel::Uniform) => "even pressure".to_owned(),
        Some(PressureModel::Kavi) => "polynomial zones around the bolts (Kavi)".to_owned(),
        Some(PressureModel::Cone) => "cones under the bolts' heads".to_owned(),
        None => String::new(),
    }
}
