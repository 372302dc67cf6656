//! The interface of a study, how the pressure is spread over it, and which of its motions become the joint.

use super::{Checked, Checker, ELEMENTS};
use crate::patch::Motions;
use crate::pressure::{Cone, PressureField, Rectangle, ThicknessRatio, Zone};
use crate::study::clamping::Clamping;
use crate::study::geometry::Geometry;
use crate::study::tables::{
    BoltTable, InterfaceTable, JointTable, PressureModel, PressureTable, StudyFile,
};
use bolted_joint_joint::DofSet;
use bolted_joint_study::{StudyError, input_file};
use std::path::Path;

/// What the cone's half angle is.
const HALF_ANGLE: &str = "the cone's half angle in degrees, about 30 for steel";

/// Half angles below this one, in degrees, are no cones under a head; in radians they are.
const LEAST_HALF_ANGLE_DEG: f64 = 1.0;

/// What a study can say of the pressure.
const MODELS: &str = "\"uniform\", \"kavi\" or \"cone\"";

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
            return self.study.refuse(
                "interface",
                "neither field nor both of x and y",
                "x = [from, to] and y = [from, to] in m with [pressure] and [[bolts]], or field = \"field.csv\"",
            );
        };
        if let Some(area) = table.area {
            let expected = "an area only beside a field, which it is compared with";
            return self.study.refuse("interface.area", area, expected);
        }
        let pressure = self
            .study
            .needed("pressure.model", file.pressure.as_ref(), MODELS)?;
        let expected = "[[bolts]], which press the parts together";
        self.study
            .ensure(!bolts.is_empty(), "bolts", "none", expected)?;
        let outline = self.model("interface", Rectangle::new(x_m, y_m))?;
        let cells = table.elements.unwrap_or(ELEMENTS);
        let clearance_m = pressure.clearance.unwrap_or(0.0);
        let geometry = match self.zone(pressure, &file.bolts)? {
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
        self.study.ensure(
            table.x.or(table.y).is_none() && table.elements.is_none(),
            "interface.field",
            "x, y or elements beside it",
            "the one or the other: the field has its own elements",
        )?;
        if let Some(pressure) = pressure {
            self.study.ensure(
                pressure.model.is_none(),
                "pressure.model",
                "a model beside interface.field",
                "the one or the other: the field has its own pressures",
            )?;
            self.study.ensure(
                pressure.bending_moment.is_none(),
                "pressure.bending_moment",
                "a moment beside interface.field",
                "a field that was computed with the moment",
            )?;
        }
        let path = self.study.resolved(path);
        if let Some(area_m2) = table.area {
            self.study
                .positive("interface.area", area_m2, "m² above zero")?;
        }
        let record = input_file("pressure field", &path, self.study.folder(), |_, _| {})?;
        let field = PressureField::read(&path, table.area).map_err(StudyError::of_file)?;
        self.files.push(record);
        self.model("interface.field", Geometry::given(&field, preload_n))
    }

    /// `None` for an even pressure.
    fn zone(&self, table: &PressureTable, bolts: &[BoltTable]) -> Checked<Option<Zone>> {
        match table.model {
            None => self.study.refuse("pressure.model", "nothing", MODELS),
            Some(PressureModel::Uniform) => Ok(None),
            Some(PressureModel::Kavi) => {
                let expected = "[a, b], the thicknesses of both parts in m: the polynomial depends on their ratio";
                let key = "pressure.thickness";
                let [a_m, b_m] = self.study.needed(key, table.thickness, expected)?;
                let ratio = self.model("pressure.thickness", ThicknessRatio::of(a_m, b_m))?;
                Ok(Some(Zone::Polynomial {
                    thickness_ratio: ratio,
                    reach: table.reach.unwrap_or_default(),
                    force: table.force.unwrap_or_default(),
                }))
            }
            Some(PressureModel::Cone) => {
                let given = |key: &str, value: Option<f64>, what: &str| {
                    self.study
                        .needed(format_args!("pressure.{key}"), value, what)
                };
                let half_angle_deg = given("half_angle", table.half_angle, HALF_ANGLE)?;
                // 0 is a cylinder
                let in_radians = half_angle_deg > 0.0 && half_angle_deg < LEAST_HALF_ANGLE_DEG;
                self.study.ensure(
                    !in_radians,
                    "pressure.half_angle",
                    half_angle_deg,
                    format_args!("{HALF_ANGLE} (is it in radians?)"),
                )?;
                let what = "the diameter in m of the head or washer";
                let head_diameter_m = given("head_diameter", table.head_diameter, what)?;
                for (place, bolt) in bolts.iter().enumerate() {
                    self.study.ensure(
                        head_diameter_m > bolt.diameter,
                        "pressure.head_diameter",
                        head_diameter_m,
                        format_args!(
                            "{what}, above the {} of bolts[{place}].diameter (is it a radius, or that of another bolt?)",
                            bolt.diameter
                        ),
                    )?;
                }
                Ok(Some(Zone::Cone(Cone {
                    half_angle_rad: half_angle_deg.to_radians(),
                    head_diameter_m,
                    depth_m: given(
                        "depth",
                        table.depth,
                        "the thickness in m between head and interface",
                    )?,
                    distribution: table.distribution.unwrap_or_default(),
                })))
            }
        }
    }

    /// The interface's own motions that the joint file has.
    fn in_space(&self, names: &[String]) -> Checked<Motions> {
        match DofSet::try_from(names.to_vec()) {
            Ok(dofs) if dofs.is_in_space() => Ok(Motions::in_space(dofs)),
            _ => self
                .study
                .refuse("joint.dofs", format!("{names:?}"), MOTIONS),
        }
    }

    pub(super) fn joint(
        &self,
        table: &JointTable,
        geometry: &Geometry,
    ) -> Checked<(Motions, [f64; 3])> {
        let motions = match (&table.dofs, table.translation) {
            (Some(dofs), None) if table.rotation.is_none() => self.in_space(dofs)?,
            (None, Some(translation)) => self.model(
                "joint.rotation",
                Motions::in_plane(translation, table.rotation),
            )?,
            (None, None) => {
                let found = "neither joint.translation nor joint.dofs";
                return self.study.refuse("joint", found, MOTIONS);
            }
            _ => {
                let found = "joint.dofs beside joint.translation or joint.rotation";
                return self.study.refuse("joint.dofs", found, MOTIONS);
            }
        };
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
                return self.study.refuse(
                    "joint.reference",
                    format!("{other:?}"),
                    "[x, y] or [x, y, z] in m, z along the normal from the interface",
                );
            }
        };
        let good = reference_m.iter().all(|length| length.is_finite());
        let found = format!("{reference_m:?}");
        self.study
            .ensure(good, "joint.reference", found, "finite lengths in m")?;
        Ok((motions, reference_m))
    }
}

const MOTIONS: &str = "translation = \"z\", and rotation = \"-y\" if there is one, for a joint in a plane; or for one in space dofs, some \
                       of [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"] in this order";

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
