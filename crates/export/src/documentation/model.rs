//! What the FMU computes: a drawing and its equations.

use super::super::{Interface, assets};
use super::Page;
use bolted_joint_dynamics::DofKind;
use bolted_joint_joint::DofSet;

pub(super) fn section(page: &Page<'_>) -> String {
    let dofs = page.file.joint.dofs;
    let motion = motion(dofs);
    format!(
        "<h2>Model</h2>\n<figure>\n{}<figcaption>The arrows point the way that counts as positive, for loads as for \
         motions.</figcaption>\n</figure>\n<p>{motion}. All quantities are in SI units.</p>\n{}",
        assets::inline_diagram(page.interface, dofs),
        equations(page.interface),
    )
}

/// The motions that the joint resists.
fn motion(dofs: DofSet) -> String {
    let symbols: Vec<String> = dofs
        .rows()
        .map(|dof| format!("<i>{}</i>", dof.symbol))
        .collect();
    if let [symbol] = symbols.as_slice() {
        let motion = dofs.row(0).kind.motion();
        return format!("<i>x</i> = {symbol}: the joint resists one {motion}");
    }
    let of = |kind: DofKind| match dofs.rows().filter(|dof| dof.kind == kind).count() {
        0 => None,
        1 => Some(format!("a {}", kind.motion())),
        count => Some(format!("{count} {}s", kind.motion())),
    };
    let motions = [DofKind::Translation, DofKind::Rotation].into_iter();
    let motions: Vec<String> = motions.filter_map(of).collect();
    format!(
        "<i>x</i> = [{}]<sup>T</sup>: the joint resists {}, and couples them",
        symbols.join(", "),
        motions.join(" and ")
    )
}

fn equations(interface: Interface) -> String {
    let law = "<p class=\"equation\"><i>F</i> = <i>K r</i> + <i>C ṙ</i> + <i>k</i><sub>3</sub> <i>r</i><sup>3</sup>, \
               &emsp;<i>r</i> = <i>x</i><sub>a</sub> − <i>x</i><sub>b</sub></p>\n\
               <p>is the load that the joint puts on side b, with the cube taken of each entry of <i>r</i>; side a takes \
               the opposite.</p>\n";
    let energy = "<p class=\"equation\">stored energy ½ <i>r</i><sup>T</sup><i>K r</i> + ¼ Σ <i>k</i><sub>3</sub> \
                  <i>r</i><sup>4</sup>, &emsp;dissipated power <i>ṙ</i><sup>T</sup><i>C ṙ</i></p>\n";
    match interface {
        Interface::Element => format!(
            "{law}{energy}<p>The element has no states: its outputs follow its inputs at once. A spring and damper \
             between two structures that compute their motion needs no iteration. Give velocities as well as \
             displacements: the element does not differentiate.</p>\n"
        ),
        Interface::Lap => {
            let body = |side: &str, other: &str, sign: &str| {
                format!(
                    "<p class=\"equation\"><i>m</i><sub>{side}</sub> <i>ẍ</i><sub>{side}</sub> + \
                     <i>c</i><sub>{side}</sub> <i>ẋ</i><sub>{side}</sub> + <i>k</i><sub>{side}</sub> \
                     <i>x</i><sub>{side}</sub> = <i>F</i><sub>{side}</sub> {sign} <i>F</i>{other}</p>\n"
                )
            };
            format!(
                "{}{}<p>with the external loads <i>F</i><sub>a</sub>, <i>F</i><sub>b</sub> and the load in the \
                 joint</p>\n{law}{energy}<p>to which the bodies add their kinetic energy and that of their supports. \
                 The classical Runge–Kutta method of fourth order integrates these equations.</p>\n",
                body("a", "", "−"),
                body("b", "", "+"),
            )
        }
    }
}
