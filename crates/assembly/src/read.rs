//! Reading an assembly file: names become structures, joints and places, or are refused with those that there are.

use std::collections::BTreeMap;

use bolted_joint_frf::Dof;
use bolted_joint_joint::{About, JointFile};
use bolted_joint_study::{StudyError, StudyText, TextKind, schema};

use crate::error::AssemblyError;
use crate::freedom::Freedom;
use crate::model::{AssemblyModel, NamedStructure, PlacedJoint};
use crate::place::{Channel, Place};
use crate::response::Response;
use crate::structure::structure;
use crate::tables::{AssemblyTables, JointTable};

impl AssemblyModel {
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<AssemblyTables>()
    }

    /// Whether a text is an assembly file, be it with mistakes in it.
    #[must_use]
    pub fn is_one(text: &StudyText) -> bool {
        text.kind() == Some(TextKind::Assembly)
    }

    /// An assembly from its text, with the files that it names.
    ///
    /// # Errors
    /// [`AssemblyError`] that names the file and the key.
    pub fn of(text: &StudyText) -> Result<Self, AssemblyError> {
        let tables: AssemblyTables = text.tables()?;
        text.check_name("name", &tables.name)?;
        for (key, found) in tables.about.iter().flat_map(About::texts) {
            text.check_name(&format!("about.{key}"), found)?;
        }
        let (mut warnings, mut notes) = (Vec::new(), Vec::new());
        let mut structures = Vec::new();
        for (name, table) in tables.structures {
            let key = format!("structures.{name}");
            text.check_name(&key, &name)?;
            text.ensure(
                !name.contains('/'),
                key,
                "a name with a slash",
                "a name without: a slash stands between structure and point",
            )?;
            let (form, told) = structure(text, &name, table)?;
            warnings.extend(told.warnings);
            notes.extend(told.notes);
            structures.push(NamedStructure { name, form });
        }
        text.ensure(
            !structures.is_empty(),
            "structures",
            "none",
            "a table for each structure, such as [structures.a]",
        )?;
        let reader = Reader { text, structures };
        let joints = tables.joints.into_iter().enumerate();
        let joints = joints.map(|(place, table)| reader.joint(place, table));
        let joints: Vec<PlacedJoint> = joints.collect::<Result<_, _>>()?;
        for (place, joint) in joints.iter().enumerate() {
            let before = joints.iter().take(place);
            text.ensure(
                before.clone().all(|other| other.name != joint.name),
                format_args!("joints.{place}.name"),
                format_args!("{:?} a second time", joint.name),
                "a `name` of its own for each joint",
            )?;
        }
        let inputs = reader.channels("inputs", tables.inputs)?;
        let outputs = reader.channels("outputs", tables.outputs)?;
        let response = tables
            .response
            .map(|table| Response::of(text, table, &inputs, &outputs));
        let mut model = Self {
            path: text.path().to_owned(),
            name: tables.name,
            about: tables.about,
            response: response.transpose()?,
            structures: reader.structures,
            joints,
            inputs,
            outputs,
            warnings,
            notes,
        };
        let freedom = Freedom::of(&model)?;
        if let Some((joint, mechanism)) = freedom.mechanisms.first()
            && !tables.mechanisms
        {
            let expected = "a joint that holds it, or `mechanisms = true` in the first lines of the file if the parts are meant to move so";
            return Err(text
                .refusal(format_args!("joints.{joint}"), mechanism, expected)
                .into());
        }
        let told = freedom
            .mechanisms
            .iter()
            .map(|(joint, mechanism)| format!("joint {}: {mechanism}", model.joints[*joint].name));
        let told: Vec<String> = told.collect();
        model.warnings.extend(told);
        model.notes.extend(freedom.notes);
        Ok(model)
    }
}

/// Points that are listed in a message at most.
const LISTED: usize = 12;

/// Those of the points whose nodes have the nearest numbers, in the order of the file.
fn nearest_points(points: &[Dof], wanted: Option<Dof>) -> Vec<Dof> {
    let mut places: Vec<usize> = (0..points.len()).collect();
    if let Some(wanted) = wanted {
        places.sort_by_key(|&place| points[place].node().abs_diff(wanted.node()));
    }
    places.truncate(LISTED);
    places.sort_unstable();
    places.into_iter().map(|place| points[place]).collect()
}

struct Reader<'t> {
    text: &'t StudyText,
    structures: Vec<NamedStructure>,
}

impl Reader<'_> {
    fn joint(&self, place: usize, table: JointTable) -> Result<PlacedJoint, AssemblyError> {
        let text = self.text;
        let key = format!("joints.{place}");
        let path = text.resolved(&table.file);
        let whole = JointFile::read(&path)?;
        let over_preload =
            (whole.joint.over_preload.is_some() && table.preload.is_none()).then(|| whole.clone());
        let file = whole;
        let file = match (&file.joint.over_preload, table.preload) {
            (None, None) => file,
            _ => file
                .at_preload(table.preload)
                .map_err(|source| AssemblyError::Law {
                    path: path.display().to_string(),
                    source: Box::new(source),
                })?,
        };
        let name = table.name.unwrap_or_else(|| format!("joint{}", place + 1));
        text.check_name(&format!("{key}.name"), &name)?;
        let dofs = file.joint.dofs;
        let side = |side: &str, mut own: BTreeMap<String, String>| {
            let key = format!("{key}.{side}");
            let structure = text.needed(
                format_args!("{key}.structure"),
                own.remove("structure"),
                format_args!("one of {}", self.names()),
            )?;
            let structure = self.structure(&format!("{key}.structure"), &structure)?;
            let places = dofs.rows().map(|dof| {
                let key = format!("{key}.{}", dof.name);
                let point = text.needed(
                    &key,
                    own.remove(dof.name),
                    "a point of the structure such as \"2:+Y\": the joint has this degree of freedom",
                )?;
                let place = self.place(&key, structure, &point)?;
                let is_rotation = dof.kind == bolted_joint_dynamics::DofKind::Rotation;
                text.ensure(
                    place.dof.direction().is_rotation() == is_rotation,
                    &key,
                    format_args!("{point}"),
                    if is_rotation { "a rotation, such as \"2:+RZ\"" } else { "a translation, such as \"2:+Y\"" },
                )?;
                Ok(place)
            });
            let places = places.collect::<Result<Vec<_>, StudyError>>()?;
            if let Some((other, _)) = own.first_key_value() {
                let names: Vec<&str> = dofs.rows().map(|dof| dof.name).collect();
                return text.refuse(
                    format_args!("{key}.{other}"),
                    "it",
                    format_args!(
                        "`structure` and the joint's degrees of freedom: {}",
                        names.join(", ")
                    ),
                );
            }
            Ok((structure, places))
        };
        let ((on_a, a), (on_b, b)) = (side("a", table.a)?, side("b", table.b)?);
        text.ensure(
            on_a != on_b || a != b,
            &key,
            "a joint between a place and itself",
            "different places on sides a and b",
        )?;
        Ok(PlacedJoint {
            name,
            path,
            file,
            over_preload,
            places: [a, b],
        })
    }

    fn channels(
        &self,
        table: &str,
        channels: BTreeMap<String, String>,
    ) -> Result<Vec<Channel>, StudyError> {
        let channel = |(name, place): (String, String)| {
            let key = format!("{table}.{name}");
            self.text.check_name(&key, &name)?;
            let Some((structure, point)) = place.split_once('/') else {
                let expected = self.with_slash(&place);
                return self.text.refuse(&key, format!("{place:?}"), expected);
            };
            let structure = self.structure(&key, structure)?;
            let place = self.place(&key, structure, point)?;
            Ok(Channel { name, place })
        };
        channels.into_iter().map(channel).collect()
    }

    /// What is expected in place of a name without a slash.
    fn with_slash(&self, name: &str) -> String {
        let meant = self.structures.iter().find_map(|own| {
            let point = name.strip_prefix(&own.name)?;
            let point = point.trim_start_matches(|c: char| !c.is_alphanumeric());
            let dof: Dof = point.parse().ok()?;
            own.form.row(dof)?;
            Some(format!("; did you mean \"{}/{point}\"?", own.name))
        });
        format!(
            "a structure, a slash and a point, such as \"b/12:+Y\"{}",
            meant.unwrap_or_default()
        )
    }

    fn structure(&self, key: &str, name: &str) -> Result<usize, StudyError> {
        let place = self.structures.iter().position(|own| own.name == name);
        place.ok_or_else(|| {
            let expected = format!("one of the structures: {}", self.names());
            self.text.refusal(key, format_args!("{name:?}"), expected)
        })
    }

    fn place(&self, key: &str, structure: usize, point: &str) -> Result<Place, StudyError> {
        let own = &self.structures[structure];
        let there = |wanted: Option<Dof>| {
            let points = nearest_points(&own.form.points, wanted);
            let more = own.form.points.len() - points.len();
            let more = match more {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            let points: Vec<String> = points.iter().map(Dof::to_string).collect();
            format!(
                "a point of structure {}: {}{more}",
                own.name,
                points.join(", ")
            )
        };
        let dof: Dof = point.parse().map_err(|_| {
            self.text
                .refusal(key, format_args!("{point:?}"), there(None))
        })?;
        if own.form.row(dof).is_none() {
            return self.text.refuse(key, point, there(Some(dof)));
        }
        Ok(Place { structure, dof })
    }

    fn names(&self) -> String {
        let names: Vec<&str> = self
            .structures
            .iter()
            .map(|own| own.name.as_str())
            .collect();
        names.join(", ")
    }
}
