//! A whole assembly as a package in Modelica: its joints as packages of their own, its structures in modal form, and a model that
//! connects them.

use std::fmt::Write as _;

use bolted_joint_assembly::{AssemblyModel, Channel, NamedStructure, Place, PlacedJoint};
use bolted_joint_dynamics::Dof;
use bolted_joint_files::{TOOL, VERSION};
use nalgebra::RowDVector;

use crate::head::{ascii, comment, origin};
use crate::reserved;
use crate::{ConvertError, Converted, Options, Target, convert};

/// Adds a line; writing to a `String` cannot fail.
macro_rules! line {
    ($text:expr, $($words:tt)*) => {{
        let _ = writeln!($text, $($words)*);
    }};
}

/// The package of an assembly; a joint over the preload is taken at the preload of the assembly file.
///
/// # Errors
/// [`ConvertError`]: a name that Modelica cannot have, a joint that it cannot express.
pub fn convert_assembly(
    model: &AssemblyModel,
    options: &Options,
) -> Result<Converted, ConvertError> {
    let own_names = model.structures.iter().map(|own| &own.name);
    let names = own_names.chain(model.joints.iter().map(|own| &own.name));
    let channels = model
        .inputs
        .iter()
        .chain(&model.outputs)
        .map(|own| &own.name);
    for name in names.chain(channels) {
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return Err(ConvertError::Name {
                found: name.clone(),
            });
        }
        reserved::check(Target::Modelica, name)?;
    }
    reserved::check(Target::Modelica, &options.identifier)?;
    let mut text = String::new();
    let package = &options.identifier;
    let notes = vec![format!("the file has to be called {package}.mo")];
    line!(text, "// {}", ascii(&model.name));
    line!(
        text,
        "// Assembly for Modelica, written by {TOOL} {VERSION}"
    );
    line!(
        text,
        "// Units: N, m, rad, s, kg. Coordinates of structures have a mass of 1 kg each"
    );
    line!(text, "// {}", notes[0]);
    line!(
        text,
        "package {package} \"{}\"",
        ascii(&model.name).replace(['"', '\\'], "'")
    );
    for joint in &model.joints {
        let own = Options {
            identifier: format!("joint_{}", joint.name),
            ..options.clone()
        };
        let converted = convert(&joint.file, Target::Modelica, &own).map_err(|source| {
            ConvertError::OfJoint {
                joint: joint.name.clone(),
                source: Box::new(source),
            }
        })?;
        for note in origin(&joint.file) {
            text += &comment("  // ", &format!("{}: {note}", own.identifier));
        }
        let lines = converted
            .text
            .lines()
            .filter(|line| !line.starts_with("//"));
        for own in lines {
            line!(text, "  {own}");
        }
    }
    for (place, structure) in model.structures.iter().enumerate() {
        Structure::of(model, place, structure).write(&mut text);
    }
    whole(model, &mut text);
    line!(text, "end {package};");
    Ok(Converted { text, notes })
}

/// A structure, and what takes hold of it.
struct Structure<'m> {
    named: &'m NamedStructure,
    /// Sides of joints: the joint, the side, and the place of each of its degrees of freedom here.
    sides: Vec<(&'m PlacedJoint, &'static str, &'m [Place])>,
    inputs: Vec<&'m Channel>,
    outputs: Vec<&'m Channel>,
}

impl<'m> Structure<'m> {
    fn of(model: &'m AssemblyModel, place: usize, named: &'m NamedStructure) -> Self {
        let sides = model.joints.iter().flat_map(|joint| {
            let [a, b] = &joint.places;
            [(joint, "a", a.as_slice()), (joint, "b", b.as_slice())]
        });
        let is_here = |own: &&Place| own.structure == place;
        Self {
            named,
            sides: sides
                .filter(|(_, _, places)| places.first().as_ref().is_some_and(is_here))
                .collect(),
            inputs: model
                .inputs
                .iter()
                .filter(|own| own.place.structure == place)
                .collect(),
            outputs: model
                .outputs
                .iter()
                .filter(|own| own.place.structure == place)
                .collect(),
        }
    }

    fn write(&self, text: &mut String) {
        let form = &self.named.form;
        let size = form.size();
        let name = &self.named.name;
        line!(
            text,
            "  model structure_{name} \"in {size} coordinates, each with a mass of 1 kg\""
        );
        for (joint, side, _) in &self.sides {
            line!(
                text,
                "    joint_{0}.Flange {0}_{side} \"side {side} of joint {0}\";",
                joint.name
            );
        }
        let rows = self.rows();
        let (mut parameters, mut motions, mut loads) = (String::new(), String::new(), Vec::new());
        for (shape, place, row) in &rows {
            let values = form
                .row(place.dof)
                .unwrap_or_else(|| RowDVector::zeros(size));
            line!(
                parameters,
                "    parameter Real {shape}[{size}] = {};",
                array(values.iter().copied())
            );
            match row {
                Row::Joint { flange, dof } => {
                    line!(motions, "    {flange}.{} = {shape}*q;", dof.name);
                    loads.push(format!("{shape}[i]*{flange}.{}", dof.load));
                }
                Row::Input(variable) => loads.push(format!("{shape}[i]*{variable}")),
                Row::Output([motion, rate]) => {
                    line!(motions, "    {motion} = {shape}*q;");
                    line!(motions, "    {rate} = {shape}*v;");
                }
            }
        }
        for (_, _, row) in &rows {
            match row {
                Row::Joint { .. } => {}
                Row::Input(variable) => line!(text, "    input Real {variable};"),
                Row::Output([motion, rate]) => {
                    line!(text, "    output Real {motion};");
                    line!(text, "    output Real {rate};");
                }
            }
        }
        let omega = array(form.frequency_rad_per_s.iter().copied());
        line!(
            text,
            "    parameter Real omega[{size}](each unit=\"rad/s\") = {omega};"
        );
        let is_modal =
            (0..size).all(|i| (0..size).all(|j| i == j || form.damping_per_s[(i, j)] == 0.0));
        let damping = match is_modal {
            true => {
                let own = array((0..size).map(|i| form.damping_per_s[(i, i)]));
                line!(
                    text,
                    "    parameter Real damping[{size}](each unit=\"1/s\") = {own};"
                );
                "damping[i]*v[i]".to_owned()
            }
            false => {
                let rows = (0..size).map(|i| array((0..size).map(|j| form.damping_per_s[(i, j)])));
                let rows: Vec<String> = rows.collect();
                line!(
                    text,
                    "    parameter Real damping[{size},{size}](each unit=\"1/s\") = {{{}}};",
                    rows.join(", ")
                );
                format!("sum(damping[i,j]*v[j] for j in 1:{size})")
            }
        };
        *text += &parameters;
        line!(text, "    Real q[{size}](each start=0, each fixed=true);");
        line!(text, "    Real v[{size}](each start=0, each fixed=true);");
        line!(text, "  equation");
        let loads = match loads.is_empty() {
            true => String::new(),
            false => format!(" + {}", loads.join(" + ")),
        };
        line!(text, "    for i in 1:{size} loop");
        line!(text, "      der(q[i]) = v[i];");
        line!(
            text,
            "      der(v[i]) = -omega[i]^2*q[i] - {damping}{loads};"
        );
        line!(text, "    end for;");
        *text += &motions;
        line!(text, "  end structure_{name};");
    }

    /// The shapes that are needed: name, place, and what they are for.
    fn rows(&self) -> Vec<(String, &'m Place, Row)> {
        let mut rows = Vec::new();
        for &(joint, side, places) in &self.sides {
            for (dof, place) in joint.file.joint.dofs.rows().zip(places) {
                let flange = format!("{}_{side}", joint.name);
                rows.push((
                    format!("shape_{flange}_{}", dof.name),
                    place,
                    Row::Joint { flange, dof },
                ));
            }
        }
        for input in &self.inputs {
            let name = variable(input, input.letters().load);
            rows.push((format!("shape_to_{name}"), &input.place, Row::Input(name)));
        }
        for output in &self.outputs {
            let dof = output.letters();
            let names = [dof.name, dof.rate].map(|own| variable(output, own));
            rows.push((
                format!("shape_of_{}", names[0]),
                &output.place,
                Row::Output(names),
            ));
        }
        rows
    }
}

/// What a shape is for.
enum Row {
    Joint {
        flange: String,
        dof: &'static Dof,
    },
    Input(String),
    /// Motion and rate.
    Output([String; 2]),
}

/// The model of the whole.
fn whole(model: &AssemblyModel, text: &mut String) {
    line!(text, "  model Assembly \"loads in, motions out\"");
    let mut equations = String::new();
    for input in &model.inputs {
        let name = variable(input, input.letters().load);
        line!(
            text,
            "    input Real {name}(unit=\"{}\");",
            modelica_unit(input.letters().kind.load_unit())
        );
        line!(
            equations,
            "    {}.{name} = {name};",
            component(model, input)
        );
    }
    for output in &model.outputs {
        let dof = output.letters();
        let unit = dof.kind.displacement_unit();
        for (quantity, unit) in [(dof.name, unit.to_owned()), (dof.rate, format!("{unit}/s"))] {
            let name = variable(output, quantity);
            line!(text, "    output Real {name}(unit=\"{unit}\");");
            line!(
                equations,
                "    {name} = {}.{name};",
                component(model, output)
            );
        }
    }
    for structure in &model.structures {
        line!(text, "    structure_{0} s_{0};", structure.name);
    }
    for joint in &model.joints {
        line!(text, "    joint_{0}.Joint j_{0};", joint.name);
        for (side, places) in ["a", "b"].into_iter().zip(&joint.places) {
            let place = places
                .first()
                .and_then(|place| model.structures.get(place.structure));
            let Some(structure) = place else {
                continue;
            };
            line!(
                equations,
                "    connect(s_{}.{1}_{side}, j_{1}.{side});",
                structure.name,
                joint.name
            );
        }
    }
    line!(text, "  equation");
    *text += &equations;
    line!(text, "  end Assembly;");
}

fn component(model: &AssemblyModel, channel: &Channel) -> String {
    let structure = model.structures.get(channel.place.structure);
    format!("s_{}", structure.map_or("", |own| own.name.as_str()))
}

fn variable(channel: &Channel, quantity: &str) -> String {
    format!("{}_{quantity}", channel.name)
}

fn modelica_unit(unit: &str) -> String {
    unit.replace('·', ".")
}

/// Numbers in as few digits as read back to them.
fn array(numbers: impl Iterator<Item = f64>) -> String {
    let words: Vec<String> = numbers.map(|number| format!("{number:E}")).collect();
    format!("{{{}}}", words.join(", "))
}
