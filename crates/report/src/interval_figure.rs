//! Values with their intervals over a quantity of which there are a few: stiffness and damping over the torque.

use super::chart_data::scaled_unit;
use bolted_joint_figures::{
    Axis, Drawn, FONTS, LABELS_BELOW, Lettering, Look, Manner, PathData, Plot, PlotCurve,
    PlotPanel, PlotPoints, Point, Strip, Svg, VALUE_LABELS,
};

const WIDTH: f64 = 960.0;
const COLUMNS: usize = 2;
const STRIP_HEIGHT: f64 = 150.0;
const MARGIN: f64 = 12.0;
const TITLE: f64 = 24.0;
const TITLE_FONT: f64 = 13.0;
/// Room at either end of an axis, as a part of what it shows.
const ROOM: f64 = 0.08;
/// Half the length of the bar across the end of an interval.
const BAR: f64 = 5.0;
const DOT: f64 = 6.5;
const WHISKER: f64 = 1.6;
const JOIN: f64 = 1.2;

/// A value, where it holds, and its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Estimated {
    pub(super) at: f64,
    /// `None` where the data do not determine it.
    pub(super) value: Option<(f64, [f64; 2])>,
}

/// One quantity over the abscissa.
#[derive(Debug)]
pub(super) struct Panel {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) colour: &'static str,
    /// By abscissa.
    pub(super) values: Vec<Estimated>,
}

/// Panels in two columns, with an abscissa in common.
#[derive(Debug)]
pub(super) struct IntervalFigure<'a> {
    /// Read out to those who cannot see the picture.
    pub(super) title: &'a str,
    /// Name and unit of the abscissa.
    pub(super) across: &'a str,
    /// Whether the abscissa counts things, between which there is nothing.
    pub(super) is_counted: bool,
    /// Row by row.
    pub(super) panels: Vec<Panel>,
}

impl IntervalFigure<'_> {
    /// The picture, and the same for a page's script.
    pub(super) fn drawn(&self) -> Drawn {
        let across = self.across_axis();
        let panels = self.panels.iter().map(|panel| {
            let (factor, unit, up) = panel.scaled();
            let values = panel.values.iter().filter_map(|own| {
                let (value, ends) = own.value?;
                Some((own.at, value / factor, ends.map(|end| end / factor)))
            });
            let curve = PlotCurve {
                name: panel.name.clone(),
                look: Look::dots(panel.colour, DOT),
                points: PlotPoints::Intervals(values.collect(), !self.is_counted),
            };
            PlotPanel::new(
                panel.name.clone(),
                STRIP_HEIGHT,
                (self.across, across),
                (unit, Some(up)),
                vec![curve],
            )
        });
        let plot = Plot {
            title: self.title.to_owned(),
            columns: COLUMNS,
            lines: Vec::new(),
            panels: panels.collect(),
        };
        Drawn {
            svg: self.to_svg(),
            plot,
        }
    }

    fn across_axis(&self) -> Axis {
        let places = self.panels.iter().flat_map(|panel| &panel.values);
        match self.is_counted {
            true => Axis::Counted {
                count: places.map(|value| value.at as u32).max().unwrap_or(0),
            },
            false => roomy(places.map(|value| value.at)),
        }
    }

    pub(super) fn to_svg(&self) -> String {
        let rows = self.panels.len().div_ceil(COLUMNS);
        let row_height = TITLE + STRIP_HEIGHT + LABELS_BELOW;
        let height = MARGIN + rows as f64 * row_height;
        let column_width = (WIDTH - MARGIN) / COLUMNS as f64;
        let mut svg = Svg::new(WIDTH, height, self.title);
        svg.paper(WIDTH, height, Some(6.0), FONTS);
        let across = self.across_axis();
        for (number, panel) in self.panels.iter().enumerate() {
            let (row, column) = (number / COLUMNS, number % COLUMNS);
            let (factor, unit, up) = panel.scaled();
            let strip = Strip {
                // Half a pixel off, thin lines are sharp.
                left: MARGIN + column as f64 * column_width + VALUE_LABELS + 0.5,
                top: MARGIN + row as f64 * row_height + TITLE + 0.5,
                width: column_width - VALUE_LABELS - MARGIN,
                height: STRIP_HEIGHT,
                frequency: across,
                value: Some(up),
            };
            svg.text(
                (strip.left, strip.top - 8.0),
                Lettering::new(TITLE_FONT, Manner::Bold),
                &panel.name,
            );
            strip.draw_grid(&mut svg);
            panel.draw(&strip, factor, !self.is_counted, &mut svg);
            strip.draw_axes(self.across, &unit, &mut svg);
        }
        svg.finish()
    }
}

impl Panel {
    /// By what its values are divided, the unit that follows, and the axis.
    fn scaled(&self) -> (f64, String, Axis) {
        let values = self.values.iter().filter_map(|value| value.value);
        let ends = values.flat_map(|(value, [low, high])| [value, low, high]);
        let largest = ends
            .clone()
            .fold(0.0, |most, end| f64::max(most, end.abs()));
        let (factor, unit) = scaled_unit(largest, &self.unit);
        (factor, unit, roomy(ends.map(|end| end / factor)))
    }

    fn draw(&self, strip: &Strip, factor: f64, is_joined: bool, svg: &mut Svg) {
        let [mut join, mut whiskers, mut dots] = [(); 3].map(|()| PathData::default());
        let mut before: Option<Point> = None;
        for Estimated { at, value } in &self.values {
            let placed = value.and_then(|(value, [low, high])| {
                let place = |value: f64| strip.place((*at, value / factor));
                Some((place(value)?, place(low)?, place(high)?))
            });
            let Some((point, low, high)) = placed else {
                before = None;
                continue;
            };
            if let Some(before) = before.filter(|_| is_joined) {
                join.polyline(&[before, point]);
            }
            before = Some(point);
            whiskers.polyline(&[low, high]);
            for end in [low, high] {
                let across = [-BAR, BAR].map(|by| Point {
                    x: end.x + by,
                    ..end
                });
                whiskers.polyline(&across);
            }
            dots.move_to(point);
            dots.dot();
        }
        Look::dashed(self.colour, JOIN, "4 3").draw(&join, svg);
        Look::line(self.colour, WHISKER).draw(&whiskers, svg);
        Look::dots(self.colour, DOT).draw(&dots, svg);
    }
}

/// A linear axis with some room at both ends.
fn roomy(values: impl Iterator<Item = f64>) -> Axis {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return Axis::linear(std::iter::empty());
    }
    let room = match ROOM * (high - low) {
        room if room > 0.0 => room,
        _ => (0.05 * high.abs()).max(0.5),
    };
    Axis::Linear {
        low: low - room,
        high: high + room,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_intervals_and_gaps_are_where_they_belong() {
        let at = |at: f64, value: f64| Estimated {
            at,
            value: Some((value, [value - 1e5, value + 1e5])),
        };
        let open = Estimated {
            at: 20.0,
            value: None,
        };
        let svg = IntervalFigure {
            title: "a < b",
            across: "torque, N·m",
            is_counted: false,
            panels: vec![Panel {
                name: "k_yy".to_owned(),
                unit: "N/m".to_owned(),
                colour: "#0072b2",
                values: vec![at(10.0, 4e5), open, at(30.0, 6e5), at(40.0, 7e5)],
            }],
        }
        .to_svg();
        assert!(svg.contains("<title>a &lt; b</title>") && svg.contains(">torque, N·m</text>"));
        assert!(svg.contains(">10³ N/m</text>") && svg.contains(">k_yy</text>"));
        // One piece joins the two values without a gap between them: a third of the axis less its room, and a sixth of 500.
        let joined: Vec<&str> = svg.split("stroke-dasharray=\"4 3\"").collect();
        assert_eq!(joined.len(), 2);
        let path = joined[0].rsplit("d=\"m").next().expect("a path");
        let path = path.split('"').next().expect("its end");
        assert_eq!(path.matches('l').count(), 1, "{path}");
        let (_, step) = path.split_once('l').expect("a line");
        let (x, y) = step.split_at(step[1..].find(['-', ' ']).expect("two numbers") + 1);
        let width = (WIDTH - MARGIN) / 2.0 - VALUE_LABELS - MARGIN;
        let x: f64 = x.parse().expect("x");
        let y: f64 = y.trim().parse().expect("y");
        let shown = 1.0 + 2.0 * ROOM;
        assert!((x - width * (10.0 / 30.0) / shown).abs() < 0.02, "{x}");
        assert!((y + STRIP_HEIGHT * (1.0 / 5.0) / shown).abs() < 0.02, "{y}");
    }
}
