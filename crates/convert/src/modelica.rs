//! A package in Modelica that needs no library: flanges with the joint's motions and loads, the joint, a ground, a body and a load.

use std::fmt::Write as _;

use bolted_joint_dynamics::Dof;
use bolted_joint_dynamics::law::{DAMPING, Parameter, STIFFNESS, Term};
use bolted_joint_files::number;
use bolted_joint_joint::{Friction, JointFile, unit};

use crate::head::{Head, ascii};
use crate::linear::{laws, matrices};
use crate::{ConvertError, Converted, Options, Target};

/// The laws of friction that the package has.
const LAWS: [&str; 5] = ["jenkins", "dahl", "bouc-wen", "lugre", "valanis"];
/// Digits of a deviation.
const DIGITS: usize = 2;

pub(crate) fn package(
    file: &JointFile,
    options: &Options,
    mut head: Head,
) -> Result<Converted, ConvertError> {
    let is_strange = file.joint.friction.iter().any(|own| !is_equation(own));
    if is_strange && !options.at_rest {
        return Err(ConvertError::NotExpressible {
            found: laws(file),
            tool: Target::Modelica.name(),
            instead: "more than springs, dampers, their terms of higher order, Jenkins elements, and the laws of Dahl, Bouc and Wen, LuGre and Valanis (with κ below 1)",
        });
    }
    let name = &options.identifier;
    head.note(format!("the file has to be called {name}.mo"));
    head.note(
        "Joint.b carries minus the load on side b: a flow into a flange acts on the component",
    );
    let mut joint = Joint::default();
    joint.linear(file, options)?;
    if !options.at_rest {
        joint.terms(file);
        joint.friction(file);
    }
    let dofs: Vec<&Dof> = file.joint.dofs.rows().collect();
    let each =
        |line: &dyn Fn(&Dof) -> String| -> String { dofs.iter().map(|dof| line(dof)).collect() };
    let si = |unit: &str| unit.to_owned();
    let flange = each(&|dof| {
        let (motion, load) = (dof.kind.displacement(), dof.kind.load());
        format!(
            "    Real {}(unit=\"{}\") \"{motion}\";\n    flow Real {}(unit=\"{}\") \"{load}\";\n",
            dof.name,
            dof.kind.displacement_unit(),
            dof.load,
            si(dof.kind.load_unit())
        )
    });
    let relative = each(&|dof| {
        let unit = dof.kind.displacement_unit();
        format!(
            "    Real r_{0}(unit=\"{unit}\") \"a relative to b\";\n    Real v_{0}(unit=\"{unit}/s\") \"its rate\";\n",
            dof.name
        )
    });
    let motions = each(&|dof| {
        format!(
            "    r_{0} = a.{0} - b.{0};\n    v_{0} = der(r_{0});\n",
            dof.name
        )
    });
    let balance = each(&|dof| format!("    b.{0} = -a.{0};\n", dof.load));
    let held = each(&|dof| format!("    flange.{} = 0;\n", dof.name));
    let body_parameters = each(&|dof| {
        format!(
            "    parameter Real {}(unit=\"{}\") \"{}\";\n    Real {}(unit=\"{}\", start=0, fixed=true);\n    Real {}(unit=\"{}/s\", start=0, fixed=true);\n",
            dof.inertia,
            si(dof.kind.inertia_unit()),
            dof.kind.inertia(),
            dof.name,
            dof.kind.displacement_unit(),
            dof.rate,
            dof.kind.displacement_unit()
        )
    });
    let body = each(&|dof| {
        format!(
            "    {0} = flange.{0};\n    der({0}) = {1};\n    {2}*der({1}) = flange.{3};\n",
            dof.name, dof.rate, dof.inertia, dof.load
        )
    });
    let load_inputs = each(&|dof| {
        format!(
            "    input Real {}(unit=\"{}\") \"{} on what is connected\";\n",
            dof.load,
            si(dof.kind.load_unit()),
            dof.kind.load()
        )
    });
    let loads = each(&|dof| format!("    flange.{0} = -{0};\n", dof.load));
    let motion_inputs = each(&|dof| {
        format!(
            "    input Real {}(unit=\"{}\") \"{}\";\n",
            dof.name,
            dof.kind.displacement_unit(),
            dof.kind.displacement()
        )
    });
    let moved = each(&|dof| format!("    flange.{0} = {0};\n", dof.name));
    let text = format!(
        "{comments}package {name} \"{title}\"\n  \
         connector Flange \"a side: its motions, and the loads that act on what has the flange\"\n{flange}  end Flange;\n\n  \
         model Joint \"the joint between sides a and b, without mass\"\n    Flange a \"side a\";\n    Flange b \"side b\";\n\
         {parameters}{relative}{variables}  equation\n{motions}{equations}{balance}  end Joint;\n\n  \
         model Ground \"does not move\"\n    Flange flange;\n  equation\n{held}  end Ground;\n\n  \
         model Body \"rigid, small motions\"\n    Flange flange;\n{body_parameters}  equation\n{body}  end Body;\n\n  \
         model Load \"loads from outside\"\n    Flange flange;\n{load_inputs}  equation\n{loads}  end Load;\n\n  \
         model Motion \"motions from outside\"\n    Flange flange;\n{motion_inputs}  equation\n{moved}  end Motion;\n\
         end {name};\n",
        comments = head.comments("// "),
        title = ascii(&file.name).replace(['"', '\\'], "'"),
        parameters = joint.parameters,
        variables = joint.variables,
        equations = joint.equations(&dofs),
    );
    Ok(Converted {
        text,
        notes: head.notes,
    })
}

/// Parameters and equations of the joint.
#[derive(Default)]
struct Joint {
    parameters: String,
    variables: String,
    /// Equations of inner states.
    inner: String,
    /// Parts of the load on each DOF, by its name: the load that side a takes.
    loads: Vec<(&'static str, String)>,
}

impl Joint {
    fn parameter(&mut self, name: &str, unit: &str, value: f64, words: &str) {
        // writing to a String cannot fail
        let _ = writeln!(
            self.parameters,
            "    parameter Real {name}(unit=\"{unit}\") = {value:E} \"{words}\";"
        );
    }

    fn linear(&mut self, file: &JointFile, options: &Options) -> Result<(), ConvertError> {
        let dofs = file.joint.dofs;
        let [stiffness, damping] = matrices(file, options.at_rest)?;
        let deviation = file.uncertainty.as_ref().map(|own| &own.standard_deviation);
        let kinds: [(&Parameter, _, _, &str, &str); 2] = [
            (
                STIFFNESS,
                &stiffness,
                deviation.map(|own| &own.stiffness),
                "r",
                "stiffness",
            ),
            (
                DAMPING,
                &damping,
                deviation.map(|own| &own.damping),
                "v",
                "damping",
            ),
        ];
        for (parameter, matrix, deviation, of, words) in kinds {
            for [i, j] in dofs.entries() {
                let at = |own: &Vec<Vec<f64>>| own.get(i).and_then(|row| row.get(j)).copied();
                let value = at(matrix).unwrap_or(0.0);
                let spread = deviation.and_then(at).filter(|own| *own > 0.0);
                if value == 0.0 && spread.is_none() && i != j {
                    continue;
                }
                let (row, column) = (dofs.row(i), dofs.row(j));
                let name = format!("{}_{}{}", parameter.symbol, row.name, column.name);
                let unit = fmi_unit(&dofs.unit(parameter.unit, [i, j]));
                let words = spread.map_or_else(
                    || words.to_owned(),
                    |own| format!("{words}, standard deviation {}", number(own, DIGITS)),
                );
                self.parameter(&name, &unit, value, &words);
                self.loads
                    .push((row.name, format!("{name}*{of}_{}", column.name)));
                if i != j {
                    self.loads
                        .push((column.name, format!("{name}*{of}_{}", row.name)));
                }
            }
        }
        Ok(())
    }

    fn terms(&mut self, file: &JointFile) {
        for term in Term::ALL {
            for (dof, &value) in file.joint.dofs.rows().zip(file.joint.term(term)) {
                if value == 0.0 {
                    continue;
                }
                let name = format!("{}_{}", term.row().symbol, dof.name);
                let unit = fmi_unit(&unit(term.row().unit, dof.kind, dof.kind));
                self.parameter(&name, &unit, value, "term of higher order");
                let [of_r, of_rate] = term.powers();
                let rate = if of_rate == 1 {
                    format!("*v_{}", dof.name)
                } else {
                    String::new()
                };
                self.loads
                    .push((dof.name, format!("{name}*r_{}^{of_r}{rate}", dof.name)));
            }
        }
    }

    fn friction(&mut self, file: &JointFile) {
        for (place, own) in file.joint.friction.iter().enumerate() {
            let dof = own.dof;
            let name = format!("{}{}", own.law.name.replace('-', "_"), place + 1);
            let mut names = Vec::new();
            for (parameter, value) in own.law.parameters.iter().zip(&own.parameters) {
                let name = format!("{name}_{}_{}", parameter.symbol, dof.name);
                let unit = fmi_unit(&unit(parameter.unit, dof.kind, dof.kind));
                self.parameter(&name, &unit, *value, own.law.name);
                names.push(name);
            }
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let (r, v) = (format!("r_{}", dof.name), format!("v_{}", dof.name));
            let load = match (own.law.name, names.as_slice()) {
                ("jenkins", &[k, h]) => self.slider(dof, &name, [k, h, &r, &v]),
                ("dahl", &[k, h]) => {
                    // dF/dt = k (v - |v| F/h)
                    self.inner_load(dof, &name, &format!("{k}*({v} - abs({v})*{name}_f/{h})"));
                    format!("{name}_f")
                }
                ("bouc-wen", &[k, h, n, beta, gamma]) => {
                    // F = F_y w, dw/dx = 1 - (beta s sgn w + gamma) |w|^n, x = k u/F_y
                    let rate = format!(
                        "{k}*({v} - ({beta}*abs({v})*sign({name}_f) + {gamma}*{v})*abs({name}_f/{h})^{n})"
                    );
                    self.inner_load(dof, &name, &rate);
                    format!("{name}_f")
                }
                ("lugre", &[s0, s1, s2, fc, fs, vs]) => {
                    // dz/dt = v - s0 |v| z/g, F = s0 z + s1 dz/dt + s2 v, g = F_c + (F_s - F_c) e^(-(v/v_s)^2)
                    let displacement = dof.kind.displacement_unit();
                    let _ = write!(
                        self.variables,
                        "    Real {name}_z(unit=\"{displacement}\", start=0, fixed=true) \"deflection of the bristles\";\n    \
                         Real {name}_zdot(unit=\"{displacement}/s\") \"its rate\";\n"
                    );
                    let _ = write!(
                        self.inner,
                        "    {name}_zdot = {v} - {s0}*abs({v})*{name}_z/({fc} + ({fs} - {fc})*exp(-({v}/{vs})^2));\n    \
                         der({name}_z) = {name}_zdot;\n"
                    );
                    format!("{s0}*{name}_z + {s1}*{name}_zdot + {s2}*{v}")
                }
                ("valanis", &[e0, et, s0, kappa]) => {
                    // p = F - E_t x: dp/dx = E_0 (1 - s a)/(1 - kappa s a) - E_t, a = p/(s_0 (1 - kappa E_t/E_0))
                    let a = format!("{name}_f/({s0}*(1 - {kappa}*{et}/{e0}))*sign({v})");
                    let rate = format!("{v}*({e0}*(1 - {a})/(1 - {kappa}*{a}) - {et})");
                    self.inner_load(dof, &name, &rate);
                    format!("{et}*{r} + {name}_f")
                }
                _ => continue,
            };
            self.loads.push((dof.name, load));
        }
    }

    /// A load that follows a differential equation.
    fn inner_load(&mut self, dof: &Dof, name: &str, rate: &str) {
        let load = fmi_unit(dof.kind.load_unit());
        let _ = writeln!(
            self.variables,
            "    Real {name}_f(unit=\"{load}\", start=0, fixed=true) \"load of the law\";"
        );
        let _ = writeln!(self.inner, "    der({name}_f) = {rate};");
    }

    /// A spring and a slider in series; its load.
    fn slider(&mut self, dof: &Dof, name: &str, [k, h, r, v]: [&str; 4]) -> String {
        let (displacement, load) = (dof.kind.displacement_unit(), fmi_unit(dof.kind.load_unit()));
        // a slider that slips does so until the motion turns: its load, which rounding moves about h, has no part in that
        let _ = write!(
            self.variables,
            "    Real {name}_s(unit=\"{displacement}\", start=0, fixed=true) \"place of the slider\";\n    \
             Real {name}_f(unit=\"{load}\") \"load of the slider\";\n    \
             Integer {name}_slips(start=0, fixed=true) \"0 sticks, 1 and -1 slips that way\";\n"
        );
        let _ = write!(
            self.inner,
            "    {name}_f = {k}*({r} - {name}_s);\n    \
             {name}_slips = if pre({name}_slips) == 0 then (if {name}_f > {h} and {v} > 0 then 1 \
             else if {name}_f < -{h} and {v} < 0 then -1 else 0)\n      \
             else if pre({name}_slips) == 1 then (if {v} < 0 then 0 else 1) else (if {v} > 0 then 0 else -1);\n    \
             der({name}_s) = if {name}_slips == 0 then 0 else {v};\n"
        );
        format!("{name}_f")
    }

    fn equations(&self, dofs: &[&Dof]) -> String {
        let loads = dofs.iter().map(|dof| {
            let parts = self.loads.iter().filter(|own| own.0 == dof.name);
            let parts: Vec<&str> = parts.map(|own| own.1.as_str()).collect();
            format!(
                "    a.{} = {};\n",
                dof.load,
                if parts.is_empty() {
                    "0".to_owned()
                } else {
                    parts.join(" + ")
                }
            )
        });
        self.inner.clone() + &loads.collect::<String>()
    }
}

/// Whether a law is a differential equation, or a slider between events.
fn is_equation(own: &Friction) -> bool {
    match (own.law.name, own.parameters.as_slice()) {
        // with κ = 1 it is a Jenkins element beside a spring, whose rate is no function of its load
        ("valanis", &[.., kappa]) => kappa < 1.0,
        (name, _) => LAWS.contains(&name),
    }
}

/// A unit as Modelica writes it: `N·m·s/rad³` becomes `N.m.s/rad3`.
fn fmi_unit(unit: &str) -> String {
    let raised = unit.chars().map(|c| match c {
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁷' => '7',
        '·' => '.',
        other => other,
    });
    raised.collect()
}
