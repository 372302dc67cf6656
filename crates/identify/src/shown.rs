//! The noise that functions show by themselves, in place of what a study does not state.
//!
//! Whether a set-up is right can be asked beside a noise that somebody knows, and hardly beside one that follows from what the
//! set-up leaves.

use bolted_joint_statistics::median;

use super::lines::Lines;
use super::noise::{Noise, StatedFloor, StatedLevel};
use super::receptances::MeasuredSubstructure;
use super::roughness::Roughness;

/// Less noise than this part of the functions is that of computed ones.
const LEAST: f64 = 1e-3;

impl Noise {
    /// This noise, and where it states nothing what the functions show.
    pub(super) fn or_as_shown(&self, lines: &Lines) -> Self {
        let is_rotation = |point: usize| lines.points[point].direction().is_rotation();
        let of_assembly = lines.measured.iter().zip(lines.roughness());
        let of_assembly = of_assembly.map(|(&(p, q), rough)| ([p, q].map(is_rotation), rough));
        let of = |measured: &MeasuredSubstructure| {
            let functions = measured.measured_functions().into_iter();
            let kind = |place| measured.is_rotation(place);
            shown(functions.map(|((p, q), rough)| ([p, q].map(kind), rough)))
        };
        let assembly = self.assembly.or(shown(of_assembly));
        let [a, b] = [&lines.a, &lines.b].map(|own| own.measured().map(|own| of(own)));
        Self {
            assembly,
            a: self.a.or(a.unwrap_or_default()),
            b: self.b.or(b.unwrap_or_default()),
        }
    }
}

/// The level of functions, each with whether its response and its reference are rotations.
fn shown<'l>(functions: impl Iterator<Item = ([bool; 2], &'l Roughness)>) -> StatedLevel {
    let mut relative = Vec::new();
    // of translations, of both kinds, of rotations
    let mut floors: [Vec<f64>; 3] = Default::default();
    for (rotations, rough) in functions {
        let [part, floor] = rough.level();
        relative.push(part);
        let kind = rotations.into_iter().filter(|is_rotation| *is_rotation);
        floors[kind.count()].push(floor);
    }
    let [yy, ytheta, thetatheta] = floors.map(median);
    StatedLevel {
        relative: median(relative).map(|relative| relative.max(LEAST)),
        floor: StatedFloor {
            yy,
            ytheta,
            thetatheta,
        },
    }
}
