//! How a whole assembly answers: its receptances, its modes, its motion under loads, or its periodic motions, as a table and a
//! picture.

use bolted_joint_assembly::{
    AssemblyError, AssemblyMode, AssemblyModel, Channel, ForcedPoint, FreePoint, Reached, Response,
};
use bolted_joint_dynamics::DofKind;
use bolted_joint_figures::{Drawn, ResponseCurve, ResponseFigure, ResponsePanel, Scale};

use super::run::beyond_observed;
use super::table::{Column, Role, csv};

/// What was computed.
#[derive(Clone, Debug)]
pub struct AssemblyAnswer {
    /// Columns of the rows.
    pub columns: Vec<Column>,
    /// Numbers, one for each column.
    pub rows: Vec<Vec<f64>>,
    /// Modes of the linear assembly, of small motion about rest.
    pub modes: Vec<AssemblyMode>,
    reached: Reached,
    panels: Vec<Panel>,
}

/// What is drawn together: columns with names, or pairs of real and imaginary parts by their modulus.
#[derive(Clone, Debug)]
struct Panel {
    up: String,
    is_complex: bool,
    curves: Vec<(String, usize)>,
}

impl AssemblyAnswer {
    /// Computes what the assembly file asks for. `progress` is told again and again which part of the work is done.
    ///
    /// # Errors
    /// [`AssemblyError`] that names the frequency, the time or the joint.
    pub fn of(
        model: &AssemblyModel,
        response: &Response,
        progress: &dyn Fn(f64),
    ) -> Result<Self, AssemblyError> {
        let modes = model.modes()?;
        match response {
            Response::Modes => Ok(Self::of_modes(modes)),
            Response::HarmonicBalance {
                ends_hz,
                loads,
                harmonics,
            } => {
                let (points, reached) =
                    model.forced_response(loads, *ends_hz, *harmonics, progress)?;
                Ok(Self {
                    reached,
                    ..Self::of_forced(model, modes, &points)
                })
            }
            Response::Backbone {
                mode,
                output,
                ends,
                harmonics,
            } => {
                let (points, reached) =
                    model.nonlinear_mode(*mode, *output, *ends, *harmonics, progress)?;
                Ok(Self {
                    reached,
                    ..Self::of_backbone(&model.outputs[*output], modes, &points)
                })
            }
            Response::Linear(span) => {
                let frequency_hz = span.frequency_hz();
                let receptances = model.receptances(&frequency_hz)?;
                let rows = frequency_hz.iter().zip(&receptances);
                let rows = rows.map(|(&hz, receptance)| {
                    // row by row: all inputs of an output
                    let parts = receptance.transpose();
                    let parts = parts.iter().flat_map(|value| [value.re, value.im]);
                    std::iter::once(hz).chain(parts).collect()
                });
                let (columns, panels) = Self::functions(model);
                Ok(Self {
                    columns,
                    rows: rows.collect(),
                    modes,
                    reached: Reached::default(),
                    panels,
                })
            }
            Response::History {
                duration_s,
                step_s,
                loads,
            } => {
                let (rows, reached) = model.history(*duration_s, *step_s, loads, progress)?;
                let (columns, panels) = Self::motions(model);
                Ok(Self {
                    columns,
                    rows,
                    modes,
                    reached,
                    panels,
                })
            }
        }
    }

    fn of_forced(model: &AssemblyModel, modes: Vec<AssemblyMode>, points: &[ForcedPoint]) -> Self {
        let row = |point: &ForcedPoint| {
            let outputs = point.fundamental.iter().zip(&point.largest);
            let all = outputs.flat_map(|(y, largest)| [y.re, y.im, *largest]);
            std::iter::once(point.frequency_hz).chain(all).collect()
        };
        let mut columns = vec![column("frequency", "Hz", Role::Across)];
        let mut panels = Vec::new();
        for output in &model.outputs {
            let unit = displacement_unit(output);
            for (part, role) in [
                ("real", Role::Aside),
                ("imaginary", Role::Aside),
                ("largest", Role::Up),
            ] {
                columns.push(column(format!("{} {part}", output.name), unit, role));
            }
            panels.push(Panel {
                up: format!("largest displacement of {}, {unit}", output.name),
                is_complex: false,
                curves: vec![(String::new(), columns.len() - 1)],
            });
        }
        Self {
            columns,
            rows: points.iter().map(row).collect(),
            modes,
            reached: Reached::default(),
            panels,
        }
    }

    fn of_backbone(output: &Channel, modes: Vec<AssemblyMode>, points: &[FreePoint]) -> Self {
        let row =
            |point: &FreePoint| vec![point.amplitude, point.frequency_hz, point.damping_ratio];
        let name = format!("amplitude of {}", output.name);
        let panel = |up: &str, place: usize| Panel {
            up: up.to_owned(),
            is_complex: false,
            curves: vec![(String::new(), place)],
        };
        Self {
            columns: vec![
                column(name, displacement_unit(output), Role::Across),
                column("frequency", "Hz", Role::Up),
                column("damping ratio", "", Role::Up),
            ],
            rows: points.iter().map(row).collect(),
            modes,
            reached: Reached::default(),
            panels: vec![panel("frequency, Hz", 1), panel("damping ratio", 2)],
        }
    }

    fn of_modes(modes: Vec<AssemblyMode>) -> Self {
        let row = |mode: &AssemblyMode| vec![mode.frequency_hz, mode.damping_ratio];
        Self {
            columns: vec![
                column("frequency", "Hz", Role::Across),
                column("damping ratio", "", Role::Up),
            ],
            rows: modes.iter().map(row).collect(),
            modes,
            reached: Reached::default(),
            panels: Vec::new(),
        }
    }

    fn functions(model: &AssemblyModel) -> (Vec<Column>, Vec<Panel>) {
        let mut columns = vec![column("frequency", "Hz", Role::Across)];
        let mut panels = Vec::new();
        for output in &model.outputs {
            let mut curves = Vec::new();
            for input in &model.inputs {
                let unit = receptance_unit(output, input);
                curves.push((input.name.clone(), columns.len()));
                for part in ["real", "imaginary"] {
                    let name = format!("{}/{} receptance {part}", output.name, input.name);
                    columns.push(column(name, unit, Role::Up));
                }
            }
            panels.push(Panel {
                up: format!("receptance of {}", output.name),
                is_complex: true,
                curves,
            });
        }
        (columns, panels)
    }

    fn motions(model: &AssemblyModel) -> (Vec<Column>, Vec<Panel>) {
        let mut columns = vec![column("time", "s", Role::Across)];
        for input in &model.inputs {
            let unit = match input.kind() {
                DofKind::Translation => "N",
                DofKind::Rotation => "N·m",
            };
            columns.push(column(&input.name, unit, Role::Aside));
        }
        let mut panels = Vec::new();
        for output in &model.outputs {
            let [displacement, velocity] = match output.kind() {
                DofKind::Translation => ["m", "m/s"],
                DofKind::Rotation => ["rad", "rad/s"],
            };
            panels.push(Panel {
                up: format!("{}, {displacement}", output.name),
                is_complex: false,
                curves: vec![(String::new(), columns.len())],
            });
            columns.push(column(&output.name, displacement, Role::Up));
            columns.push(column(
                format!("{} rate", output.name),
                velocity,
                Role::Aside,
            ));
        }
        for name in ["energy stored", "energy supplied", "energy dissipated"] {
            columns.push(column(name, "J", Role::Aside));
        }
        (columns, panels)
    }

    /// What the user should know: of the assembly, and where joints move further than they were observed at.
    #[must_use]
    pub fn warnings(&self, model: &AssemblyModel) -> Vec<String> {
        let beyond = model.beyond_observed(&self.reached).into_iter().map(|own| {
            let motion = format!("{}: {}", own.joint, own.dof);
            beyond_observed(&motion, own.unit, [own.largest, own.observed])
        });
        model.warnings.iter().cloned().chain(beyond).collect()
    }

    /// As CSV.
    #[must_use]
    pub fn to_csv(&self) -> String {
        csv(&self.columns, &self.rows)
    }

    /// As a picture, and the same for a page; `None` if there is nothing that can be drawn.
    #[must_use]
    pub fn figure(&self, title: &str) -> Option<Drawn> {
        let across = self.columns.first()?;
        let phase = |panel: &Panel| ResponsePanel {
            title: String::new(),
            across: (format!("{}, {}", across.name, across.unit), Scale::Linear),
            up: ("phase, °".to_owned(), Scale::Phase),
            curves: panel
                .curves
                .iter()
                .map(|(name, place)| ResponseCurve {
                    name: name.clone(),
                    points: self
                        .rows
                        .iter()
                        .map(|row| (row[0], row[place + 1].atan2(row[*place]).to_degrees()))
                        .collect(),
                    is_dashed: Vec::new(),
                })
                .collect(),
        };
        let panel = |panel: &Panel| ResponsePanel {
            title: String::new(),
            across: (format!("{}, {}", across.name, across.unit), Scale::Linear),
            up: (
                panel.up.clone(),
                if panel.is_complex {
                    Scale::Logarithmic
                } else {
                    Scale::Linear
                },
            ),
            curves: panel
                .curves
                .iter()
                .map(|(name, place)| ResponseCurve {
                    name: name.clone(),
                    points: self
                        .rows
                        .iter()
                        .map(|row| {
                            let up = match panel.is_complex {
                                true => row[*place].hypot(row[place + 1]),
                                false => row[*place],
                            };
                            (row[0], up)
                        })
                        .collect(),
                    is_dashed: Vec::new(),
                })
                .collect(),
        };
        ResponseFigure {
            title,
            note: None,
            panels: self
                .panels
                .iter()
                .flat_map(|each| {
                    let below = each.is_complex.then(|| phase(each));
                    std::iter::once(panel(each)).chain(below)
                })
                .collect(),
        }
        .drawn()
    }
}

fn receptance_unit(output: &Channel, input: &Channel) -> &'static str {
    match (output.kind(), input.kind()) {
        (DofKind::Translation, DofKind::Translation) => "m/N",
        (DofKind::Translation, DofKind::Rotation) => "m/(N·m)",
        (DofKind::Rotation, DofKind::Translation) => "rad/N",
        (DofKind::Rotation, DofKind::Rotation) => "rad/(N·m)",
    }
}

fn displacement_unit(output: &Channel) -> &'static str {
    match output.kind() {
        DofKind::Translation => "m",
        DofKind::Rotation => "rad",
    }
}

fn column(name: impl Into<String>, unit: &'static str, role: Role) -> Column {
    Column {
        name: name.into(),
        unit,
        role,
    }
}
