//! The joint's matrices line by line, as decoupling gives them, beside the estimate.

use nalgebra::DMatrix;

use super::super::chart::{Chart, ChartStrip, Curve, Level};
use super::super::chart_data::scaled_unit;
use super::IdentificationReport;
use super::figure::figure;
use super::parameters::interval;
use bolted_joint_figures::html::{beside, percent, quantity};
use bolted_joint_figures::{Axis, Look};
use bolted_joint_frf::structure::ComplexMatrix;
use bolted_joint_identify::{JointMatrices, Unknown};

const HEIGHT: f64 = 170.0;
const STIFFNESS: Look = Look::dots("#0072b2", 2.2);
const DAMPING: Look = Look::dots("#d55e00", 2.2);
/// Parts of the values that may lie off the axis at either end: near resonances of the substructures they are far off.
const OFF_AXIS: f64 = 0.1;
/// Room at either end of the axis, as a part of what it shows.
const MARGIN: f64 = 0.25;

pub(super) fn section(report: &IdentificationReport<'_>) -> String {
    let found = report.found;
    let mut html = "<h2>Stiffness and damping line by line</h2>\n".to_owned();
    if decoupled(report, 0).1.is_empty() {
        return html
            + "<p>There is no decoupling: it needs every pair of points measured and as many points as the joint has DOFs. The \
               estimate does not need it.</p>\n";
    }
    html += "<p>Each dot is the value that decoupling gives on one line (Tol, equation 3.21). The bands of the average are shaded; the \
             line across is the estimate, with its 95 % interval. Where the receptances say little about the joint the dots \
             scatter, and because noise is inverted with them they are drawn away from the joint's values, not only \
             spread about them.</p>\n";
    if let Some(torque) = found.estimate.joints[0].torque_n_m {
        html += &format!(
            "<p>At {}, the torque of the first assembly.</p>\n",
            quantity(torque, "N·m")
        );
    }
    let unknowns = &found.estimate.covariance().unknowns;
    let entries = unknowns.len() / 2;
    for entry in 0..entries {
        let (frequency_hz, joints) = decoupled(report, unknowns[entry].joint);
        let strips = [(entry, STIFFNESS), (entries + entry, DAMPING)];
        let strips =
            strips.map(|(index, look)| strip(report, index, &unknowns[index], look, &joints));
        let caption = format!(
            "<b>{} and {}</b> {}",
            report.symbol(&unknowns[entry]),
            report.symbol(&unknowns[entries + entry]),
            caption(report, entry, unknowns, &strips, joints.len())
        );
        let chart = Chart {
            id: format!("decoupled-{}", entry + 1),
            title: format!(
                "{} and {} of each line",
                unknowns[entry].label(found.bolts.with_own_joint()),
                unknowns[entries + entry].label(found.bolts.with_own_joint())
            ),
            frequency_hz: &frequency_hz,
            strips: strips.into(),
            resonating: None,
        };
        html += &figure(&chart, &caption);
    }
    html
}

/// Frequency and matrices of one bolt's joint at each line that can be decoupled of every assembly with the first one's joint, in
/// ascending order; bolt after bolt where several have the joint.
fn decoupled(report: &IdentificationReport<'_>, joint: usize) -> (Vec<f64>, Vec<JointMatrices>) {
    let assemblies = report.assemblies();
    let estimate = &report.found.estimate;
    let mut lines: Vec<(f64, JointMatrices)> = Vec::new();
    for bolt in estimate.decoupled_of(joint) {
        let own = assemblies.iter().zip(&bolt).enumerate();
        for (_, (assembly, decoupled)) in
            own.filter(|&(number, _)| estimate.has_first_joint(number))
        {
            let pairs = assembly.lines.frequency_hz.iter().zip(decoupled);
            lines.extend(
                pairs.filter_map(|(&hz, stiffness)| Some((hz, matrices(hz, stiffness.as_ref()?)))),
            );
        }
    }
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    lines.into_iter().unzip()
}

/// K = Re K*, C = Im K*/ω; the two off-diagonal entries of a symmetric joint are one number.
fn matrices(hz: f64, stiffness: &ComplexMatrix) -> JointMatrices {
    let omega = std::f64::consts::TAU * hz;
    let (rows, columns) = stiffness.shape();
    let entry = |i: usize, j: usize| 0.5 * (stiffness[(i, j)] + stiffness[(j, i)]);
    JointMatrices {
        stiffness: DMatrix::from_fn(rows, columns, |i, j| entry(i, j).re),
        damping: DMatrix::from_fn(rows, columns, |i, j| entry(i, j).im / omega),
    }
}

fn strip(
    report: &IdentificationReport<'_>,
    index: usize,
    unknown: &Unknown,
    look: Look,
    joints: &[JointMatrices],
) -> ChartStrip {
    let found = report.found;
    let covariance = found.estimate.covariance();
    let estimate = report.value(unknown);
    let interval = found.estimate.joints[0].intervals()[index];
    let values: Vec<f64> = joints.iter().map(|joint| unknown.value(joint)).collect();
    let identified = covariance.identified[index];
    let mut shown: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    shown.sort_by(f64::total_cmp);
    let beyond = (OFF_AXIS * shown.len() as f64) as usize;
    shown = shown[beyond..shown.len() - beyond].to_vec();
    if identified {
        shown.push(estimate);
    }
    let low = shown.iter().copied().fold(f64::INFINITY, f64::min);
    let high = shown.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (factor, unit) = scaled_unit(low.abs().max(high.abs()), unknown.unit);
    let margin = match MARGIN * (high - low) {
        margin if margin > 0.0 => margin,
        _ => (0.05 * high.abs()).max(f64::MIN_POSITIVE.sqrt()),
    };
    ChartStrip {
        name: report.label(unknown),
        unit,
        height: HEIGHT,
        axis: (high >= low).then_some(Axis::Linear {
            low: (low - margin) / factor,
            high: (high + margin) / factor,
        }),
        curves: vec![Curve {
            name: report.label(unknown),
            look,
            values: values.iter().map(|value| value / factor).collect(),
        }],
        bands: bands(report, index).to_vec(),
        level: identified.then(|| Level {
            value: estimate / factor,
            interval: interval.map(|end| end / factor),
        }),
    }
}

fn bands<'a>(report: &'a IdentificationReport<'_>, index: usize) -> &'a [[f64; 2]] {
    let found = report.found;
    let unknown = &found.estimate.covariance().unknowns[index];
    let entries = found.model.entries().len();
    &found.estimate.bands()[unknown.joint][index % entries].bands
}

/// Estimate and interval of stiffness and damping in words, and how much lies off the axes.
fn caption(
    report: &IdentificationReport<'_>,
    entry: usize,
    unknowns: &[Unknown],
    strips: &[ChartStrip; 2],
    lines: usize,
) -> String {
    let found = report.found;
    let covariance = found.estimate.covariance();
    let intervals = found.estimate.joints[0].intervals();
    let deviations = covariance.standard_deviation();
    let entries = unknowns.len() / 2;
    let sentences = [entry, entries + entry].map(|index| {
        let unknown = &unknowns[index];
        if !covariance.identified[index] {
            return format!("{} is not identified.", report.symbol(unknown));
        }
        let deviation = deviations[index];
        format!(
            "{} = {} {unit} ({}).",
            report.symbol(unknown),
            beside(report.value(unknown), deviation),
            interval(intervals[index], deviation),
            unit = unknown.unit
        )
    });
    let off = strips
        .iter()
        .map(|strip| percent(strip.off_axis() as f64 / lines as f64));
    let off: Vec<String> = off.collect();
    let bands = if bands(report, entry).is_empty() {
        " The average is the median over all lines."
    } else {
        ""
    };
    format!(
        "{} Off the axes: {}.{bands}",
        sentences.join(" "),
        off.join(" and ")
    )
}
