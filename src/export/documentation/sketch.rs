//! A drawing of the model: sides or bodies, and the springs and dampers between them.

use std::fmt::Write as _;

use super::super::Interface;
use crate::joint::DofSet;

/// Heights of the spring, of the damper and of the labels, in the drawing's units.
const SPRING: i32 = 58;
const DAMPER: i32 = 102;
const BOX: [i32; 2] = [36, 124];

/// The drawing as inline SVG; it takes the text's colour.
pub(super) fn svg(interface: Interface, dofs: DofSet) -> String {
    let mut drawing = String::new();
    let title = match interface {
        Interface::Element => {
            for (left, label, arrow) in [(60, "a", 100), (480, "b", 520)] {
                solid(&mut drawing, left, 80, label);
                motion(&mut drawing, arrow, label, dofs);
            }
            connection(&mut drawing, 140, 480, "K, k<tspan>3</tspan>", "C");
            "Sides a and b, joined by springs K, k3 and dampers C"
        }
        Interface::Lap => {
            ground(&mut drawing, 14, -1);
            ground(&mut drawing, 606, 1);
            for (left, label) in [(110, "a"), (430, "b")] {
                solid(&mut drawing, left, 80, label);
                motion(&mut drawing, left + 40, label, dofs);
            }
            connection(
                &mut drawing,
                14,
                110,
                "k<tspan>a</tspan>",
                "c<tspan>a</tspan>",
            );
            connection(&mut drawing, 190, 430, "K, k<tspan>3</tspan>", "C");
            connection(
                &mut drawing,
                510,
                606,
                "k<tspan>b</tspan>",
                "c<tspan>b</tspan>",
            );
            "Bodies a and b on their supports, joined by springs K, k3 and dampers C"
        }
    };
    let drawing = drawing.replace("<tspan>", "<tspan dy=\"4\" font-size=\"10\">");
    format!(
        "<svg viewBox=\"0 0 620 150\" role=\"img\" aria-label=\"{title}\" fill=\"none\" stroke=\"currentColor\" \
         stroke-width=\"1.6\" stroke-linejoin=\"round\">\n{drawing}</svg>\n"
    )
}

// Writing to a String cannot fail, so the results of write! are dropped below.

fn solid(drawing: &mut String, left: i32, width: i32, label: &str) {
    let [top, bottom] = BOX;
    let height = bottom - top;
    let _ = writeln!(
        drawing,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" rx=\"3\" fill=\"currentColor\" \
         fill-opacity=\".08\"/>"
    );
    text(drawing, left + width / 2, (top + bottom) / 2 + 6, 18, label);
}

fn text(drawing: &mut String, x: i32, y: i32, size: i32, content: &str) {
    let _ = writeln!(
        drawing,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"middle\" font-style=\"italic\" \
         font-family=\"Georgia, serif\" fill=\"currentColor\" stroke=\"none\">{content}</text>"
    );
}

/// Arrows for the positive motions above a body.
fn motion(drawing: &mut String, x: i32, side: &str, dofs: DofSet) {
    let _ = writeln!(
        drawing,
        "<path d=\"M{x} 30v-14h28m-6 -4l6 4l-6 4\" stroke-width=\"1.2\"/>"
    );
    text(drawing, x + 40, 20, 14, &format!("y<tspan>{side}</tspan>"));
    if dofs == DofSet::TranslationRotation {
        let (from, to) = (x - 34, x - 12);
        let _ = writeln!(
            drawing,
            "<path d=\"M{to} 28a13 13 0 1 0 -22 0m-1 -7l1 7l7 -1\" stroke-width=\"1.2\"/>"
        );
        text(
            drawing,
            from - 10,
            20,
            14,
            &format!("θ<tspan>{side}</tspan>"),
        );
    }
}

/// A spring above a damper, from one abscissa to another.
fn connection(drawing: &mut String, from: i32, to: i32, spring: &str, damper: &str) {
    let (length, middle) = (to - from, (from + to) / 2);
    let coil = if length > 150 { 12 } else { 7 };
    let lead = (length - 6 * coil) / 2;
    let half = coil / 2;
    let zigzag = format!("l{half} -9")
        + &format!("l{coil} 18l{coil} -18").repeat(2)
        + &format!("l{coil} 18l{half} -9");
    let rest = length - lead - 5 * coil - 2 * half;
    let _ = writeln!(
        drawing,
        "<path d=\"M{from} {SPRING}h{lead}{zigzag}h{rest}\"/>"
    );
    let _ = writeln!(
        drawing,
        "<path d=\"M{from} {DAMPER}H{}M{} {}h-16v20h16M{} {}v12M{} {DAMPER}H{to}\"/>",
        middle - 8,
        middle + 8,
        DAMPER - 10,
        middle + 2,
        DAMPER - 6,
        middle + 2,
    );
    text(drawing, middle, SPRING - 14, 14, spring);
    text(drawing, middle, DAMPER + 28, 14, damper);
}

/// A wall with hatching on the side that `outwards` points to.
fn ground(drawing: &mut String, x: i32, outwards: i32) {
    let [top, bottom] = BOX;
    let _ = write!(drawing, "<path d=\"M{x} {top}V{bottom}");
    for y in (top..bottom).step_by(11) {
        let _ = write!(drawing, "M{x} {y}l{} 9", 8 * outwards);
    }
    let _ = writeln!(drawing, "\" stroke-width=\"1.2\"/>");
}
