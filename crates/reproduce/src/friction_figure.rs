//! The loops of chapter 2.2 of Tol's thesis, one panel for each law, and signum friction over the velocity as figure 2.1 has it.

use super::{ChapterLaw, FrictionLoop, FrictionReproduction};
use bolted_joint_figures::{ResponseCurve, ResponseFigure, ResponsePanel, Scale};

/// The figure of `reproduce 2.2`.
#[derive(Debug, Clone, Copy)]
pub struct FrictionFigure<'a> {
    /// What was computed.
    pub found: &'a FrictionReproduction,
}

impl FrictionFigure<'_> {
    /// The figure as an SVG document; `None` if there is nothing to draw.
    #[must_use]
    pub fn to_svg(&self) -> Option<String> {
        let laws = ChapterLaw::ALL.into_iter();
        let loops = laws.map(|law| {
            let title = match law {
                // figure 2.1 has the velocity alone
                ChapterLaw::Signum => format!("{} as a loop", law.title()),
                _ => format!("{}: {}", law.title(), law.figures()),
            };
            self.panel(law, title, "displacement, mm", displacements)
        });
        let velocities = self.panel(
            ChapterLaw::Signum,
            format!(
                "{} over the velocity: {}",
                ChapterLaw::Signum.title(),
                ChapterLaw::Signum.figures()
            ),
            "velocity, mm/s",
            velocities,
        );
        ResponseFigure {
            title: "Joint laws of Tol's chapter 2.2, drawn anew",
            note: None,
            panels: std::iter::once(velocities).chain(loops).collect(),
        }
        .to_svg()
    }

    fn panel(
        &self,
        law: ChapterLaw,
        title: String,
        across: &str,
        points: fn(&FrictionLoop) -> Vec<(f64, f64)>,
    ) -> ResponsePanel {
        let loops = self.found.loops.iter().filter(|of| of.law == law);
        let is_single = loops.clone().count() == 1;
        let curves = loops.map(|of| ResponseCurve {
            name: if is_single {
                String::new()
            } else {
                of.case.clone()
            },
            points: points(of),
            is_dashed: Vec::new(),
        });
        ResponsePanel {
            title,
            across: (across.to_owned(), Scale::Roomy),
            up: ("force, N".to_owned(), Scale::Roomy),
            curves: curves.collect(),
        }
    }
}

/// mm, N
fn displacements(of: &FrictionLoop) -> Vec<(f64, f64)> {
    let points = of.points.iter();
    points
        .map(|point| (1e3 * point.displacement, point.load))
        .collect()
}

/// mm/s, N; where the force turns over, it does so at rest.
fn velocities(of: &FrictionLoop) -> Vec<(f64, f64)> {
    let mut points = Vec::new();
    for pair in of.points.windows(2) {
        let [one, next] = pair else { continue };
        points.push((1e3 * one.velocity, one.load));
        if one.load * next.load < 0.0 {
            points.push((0.0, one.load));
            points.push((0.0, next.load));
        }
    }
    points
}
