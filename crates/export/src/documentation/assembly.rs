//! The page of an assembly: what it is made of, how it is integrated, and its variables.

use bolted_joint_assembly::AssemblyModel;
use bolted_joint_figures::html::{cell, escaped, number, number_cell, quantity, table};
use bolted_joint_interface::Interface as Declared;

use super::{licences, running, variables, whole};
use crate::{FmiVersion, Timestamp};

/// What the page tells.
pub(crate) struct AssemblyPage<'a> {
    pub(crate) model: &'a AssemblyModel,
    pub(crate) summary: &'a str,
    pub(crate) version: FmiVersion,
    pub(crate) declared: &'a Declared,
    /// Communication step that is suggested, s.
    pub(crate) suggested_step_s: f64,
    /// How closely the reference run is to be met; `None` if there is none.
    pub(crate) reference_tolerance: Option<f64>,
    pub(crate) token: &'a str,
    pub(crate) date: Timestamp,
}

/// The page `documentation/index.html`.
pub(crate) fn html(page: &AssemblyPage<'_>) -> String {
    let sections = [
        model(page),
        running(page),
        variables::section(page.declared),
        licences::section(),
    ]
    .concat();
    let about = (page.version, page.token, page.date);
    whole(&page.model.name, page.summary, &sections, about)
}

fn model(page: &AssemblyPage<'_>) -> String {
    let structures = page.model.structures.iter().map(|own| {
        let form = &own.form;
        let numbers = [form.modes, form.rigid(), form.cut, form.size() - form.modes];
        let numbers = numbers
            .map(|count| number_cell(&count.to_string()))
            .concat();
        cell(&escaped(&own.name)) + &numbers
    });
    let structures: Vec<String> = structures.collect();
    let headings = [
        "Structure",
        "Modes",
        "Free motions",
        "Modes cut",
        "Residual vectors",
    ];
    let joints = page.model.joints.iter().map(|own| {
        let dofs = own.file.joint.dofs.names().join(", ");
        [&own.name, &own.file.name, &dofs]
            .map(|text| cell(&escaped(text)))
            .concat()
    });
    let joints: Vec<String> = joints.collect();
    format!(
        "<h2>Model</h2>\n<p class=\"equation\"><i>q̈</i> + <i>C q̇</i> + <i>Ω</i><sup>2</sup> <i>q</i> = <i>B u</i> − \
         <i>S</i><sup>T</sup> <i>F</i>(<i>r</i>, <i>ṙ</i>), &emsp;<i>r</i> = <i>S q</i> = <i>x</i><sub>a</sub> − \
         <i>x</i><sub>b</sub></p>\n<p>with the coordinates <i>q</i> of all structures, each of 1 kg, the loads <i>u</i> and the \
         loads <i>F</i> that the joints put on their sides b. All quantities are in SI units.</p>\n{}{}",
        table(&headings, &structures),
        table(&["Joint", "Its name", "Degrees of freedom"], &joints),
    )
}

fn running(page: &AssemblyPage<'_>) -> String {
    format!(
        "<h2>Running it</h2>\n<p>The linear part is propagated exactly, so that a communication step may be as long as the loads \
         allow: they are held over it unless the importer says how they go on. Joints that are not linear take a fourth-order \
         exponential Runge–Kutta scheme, in as many parts of the step as their own stiffness asks for, up to 4096; their error is \
         {} of the motion over a period of their own. {} is suggested. The first step of a length takes longer, because it is \
         prepared.</p>\n{}",
        number(bolted_joint_dynamics::assembly::TOLERANCE),
        quantity(page.suggested_step_s, "s"),
        page.reference_tolerance
            .map(running::reference_run)
            .unwrap_or_default(),
    )
}
