//! What the page's script needs of a chart to draw any part of it again: geometry, axes and the values themselves.

use super::chart::{Chart, ChartStrip, Curve, Level};
use bolted_joint_figures::{Axis, Drawn, Plot, PlotCurve, PlotLevel, PlotPanel, PlotPoints};
use bolted_joint_frf::resonances;

/// Lines of a chart that go into the page at most, about; of longer ones, the extremes of each stretch do.
const MOST_LINES: usize = 4096;

impl Chart<'_> {
    /// The picture, and the same for the page's script.
    pub(super) fn drawn(&self) -> Drawn {
        let kept = self.kept_lines(MOST_LINES);
        let pick = |values: &[f64]| -> Vec<f64> {
            let values = kept.iter().map(|&line| values.get(line).copied());
            values.map(|value| value.unwrap_or(f64::NAN)).collect()
        };
        let mut marks = self
            .resonating
            .map(|function| resonances(self.frequency_hz, function))
            .unwrap_or_default();
        marks.sort_by(|a, b| b.prominence_decades.total_cmp(&a.prominence_decades));
        let marks: Vec<f64> = marks.iter().map(|mark| mark.frequency_hz).collect();
        let frequency = Axis::linear(self.frequency_hz.iter().copied());
        let panels = self.strips.iter().enumerate().map(|(number, strip)| {
            let curves = strip.curves.iter().map(|drawn| PlotCurve {
                name: drawn.name.clone(),
                look: drawn.look,
                points: PlotPoints::Lines(pick(&drawn.values)),
            });
            let mut panel = PlotPanel::new(
                "",
                strip.height,
                ("frequency, Hz", frequency),
                (strip.label(), strip.axis),
                curves.collect(),
            );
            panel.is_below = number > 0;
            panel.bands.clone_from(&strip.bands);
            panel.level = strip.level.map(level);
            panel.marks.clone_from(&marks);
            panel
        });
        let plot = Plot {
            title: self.title.clone(),
            columns: 1,
            lines: pick(self.frequency_hz),
            panels: panels.collect(),
        };
        Drawn {
            svg: self.to_svg(),
            plot,
        }
    }

    /// How many lines the script gets, where those are not all.
    pub(super) fn thinned_to(&self) -> Option<usize> {
        let kept = self.kept_lines(MOST_LINES).len();
        (kept < self.frequency_hz.len()).then_some(kept)
    }

    /// All lines, or of each of equal stretches those at which a curve is highest or lowest.
    fn kept_lines(&self, most: usize) -> Vec<usize> {
        let count = self.frequency_hz.len();
        let curves: Vec<&Curve> = self.strips.iter().flat_map(|strip| &strip.curves).collect();
        if count <= most {
            return (0..count).collect();
        }
        let stretches = (most / (2 * curves.len()).max(1)).max(1);
        let mut kept = vec![0, count - 1];
        for stretch in 0..stretches {
            let lines = stretch * count / stretches..(stretch + 1) * count / stretches;
            for curve in &curves {
                let finite = || {
                    let lines = lines.clone();
                    lines.filter(|&line| curve.values.get(line).is_some_and(|v| v.is_finite()))
                };
                let by_value = |a: &usize, b: &usize| curve.values[*a].total_cmp(&curve.values[*b]);
                kept.extend(finite().min_by(by_value));
                kept.extend(finite().max_by(by_value));
            }
        }
        kept.sort_unstable();
        kept.dedup();
        kept
    }
}

fn level(level: Level) -> PlotLevel {
    PlotLevel {
        name: "estimate".to_owned(),
        look: Level::LOOK,
        value: level.value,
        interval: level.interval,
    }
}

/// The power of a thousand by which `size` is between 1 and 1000, and how it is written before a unit; one for sizes that
/// are easy to read as they are.
pub(super) fn scaled_unit(size: f64, unit: &str) -> (f64, String) {
    let size = size.abs();
    if !size.is_finite() || size == 0.0 || (1e-2..1e4).contains(&size) {
        return (1.0, unit.to_owned());
    }
    let power = 3.0 * (size.log10() / 3.0).floor();
    let exponent: String = format!("{power:.0}")
        .chars()
        .map(|digit| match digit {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' => '⁰',
            other => char::from_u32(0x2070 + u32::from(other) - u32::from('0')).unwrap_or(other),
        })
        .collect();
    (10_f64.powf(power), format!("10{exponent} {unit}"))
}

impl ChartStrip {
    /// How many values of its curves lie off its axis.
    pub(super) fn off_axis(&self) -> usize {
        let off = |value: &&f64| {
            let position = self.axis.and_then(|axis| axis.position(**value));
            position.is_some_and(|position| !(0.0..=1.0).contains(&position))
        };
        let values = self.curves.iter().flat_map(|curve| &curve.values);
        values.filter(off).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_figures::Look;

    #[test]
    fn units_are_scaled_by_powers_of_a_thousand() {
        for (size, factor, unit) in [
            (573_000.0, 1e3, "10³ N/m"),
            (-4.5e8, 1e6, "10⁶ N/m"),
            (0.083, 1.0, "N/m"),
            (0.0, 1.0, "N/m"),
            (2e-5, 1e-6, "10⁻⁶ N/m"),
        ] {
            assert_eq!(scaled_unit(size, "N/m"), (factor, unit.to_owned()));
        }
    }

    #[test]
    fn long_charts_keep_their_extremes() {
        let frequency_hz: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values: Vec<f64> = (0..100_000).map(|k| f64::from(k * 7919 % 97)).collect();
        values[12_345] = 1e3;
        values[54_321] = -1e3;
        let chart = Chart {
            id: String::new(),
            title: String::new(),
            frequency_hz: &frequency_hz,
            strips: vec![ChartStrip {
                name: String::new(),
                unit: String::new(),
                height: 100.0,
                axis: None,
                curves: vec![Curve {
                    name: String::new(),
                    look: Look::line("#000", 1.0),
                    values,
                }],
                bands: Vec::new(),
                level: None,
            }],
            resonating: None,
        };
        let kept = chart.kept_lines(1000);
        assert!(kept.len() <= 1002);
        for line in [0, 12_345, 54_321, 99_999] {
            assert!(kept.contains(&line));
        }
        assert_eq!(chart.kept_lines(100_000).len(), 100_000);
    }
}
