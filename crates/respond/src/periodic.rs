//! Responses in the frequency domain: receptances, curves by harmonic balance, backbones.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{DofKind, JointLaw, Lap, Linear, law::Parameter};

use bolted_joint_harmonic::{
    CurveOptions, CurvePoint, Derivative, HarmonicBalance, HarmonicError, HarmonicLoads, Harmonics,
    Observed, Side, Target,
};
use bolted_joint_joint::DofSet;

use super::answer::Answer;
use super::study::{LoadPlace, Span};
use super::table::{Column, Role};

/// The load of amplitude one at a place.
pub(super) fn unit_load<const D: usize>(place: LoadPlace) -> HarmonicLoads<D> {
    let mut loads = HarmonicLoads::NONE;
    match place.body {
        Some(Side::A) => loads.a[place.dof] = 1.0.into(),
        Some(Side::B) => loads.b[place.dof] = 1.0.into(),
        None => {
            loads.a[place.dof] = 1.0.into();
            loads.b[place.dof] = (-1.0).into();
        }
    }
    loads
}

pub(super) fn name(dofs: DofSet, observed: Observed) -> String {
    let dof = dofs.row(observed.dof()).name;
    match observed {
        Observed::Relative(_) => format!("relative.{dof}"),
        Observed::Body(Side::A, _) => format!("a.{dof}"),
        Observed::Body(Side::B, _) => format!("b.{dof}"),
    }
}

pub(super) fn unit(dofs: DofSet, observed: Observed, quantity: Derivative) -> &'static str {
    match (dofs.row(observed.dof()).kind, quantity) {
        (kind, Derivative::Displacement) => kind.displacement_unit(),
        (DofKind::Translation, Derivative::Velocity) => "m/s",
        (DofKind::Translation, Derivative::Acceleration) => "m/s²",
        (DofKind::Rotation, Derivative::Velocity) => "rad/s",
        (DofKind::Rotation, Derivative::Acceleration) => "rad/s²",
    }
}

pub(super) fn load_unit(dofs: DofSet, place: LoadPlace) -> &'static str {
    match dofs.row(place.dof).kind {
        DofKind::Translation => "N",
        DofKind::Rotation => "N·m",
    }
}

pub(super) fn column(name: impl Into<String>, unit: &'static str, role: Role) -> Column {
    Column {
        name: name.into(),
        unit,
        role,
    }
}

/// Columns of a curve over frequency or of one over amplitude.
pub(super) fn curve_columns(
    dofs: DofSet,
    motions: &[Observed],
    quantity: Derivative,
    is_over_frequency: bool,
) -> Vec<Column> {
    let frequency = if is_over_frequency {
        Role::Across
    } else {
        Role::Up
    };
    let mut columns = vec![column("frequency", "Hz", frequency)];
    for (n, &observed) in motions.iter().enumerate() {
        let (name, unit) = (name(dofs, observed), unit(dofs, observed, quantity));
        let role = match (is_over_frequency, n) {
            (true, _) => Role::Up,
            (false, 0) => Role::Across,
            (false, _) => Role::Aside,
        };
        columns.push(column(format!("{name} amplitude"), unit, role));
        let phase = if is_over_frequency {
            Role::Phase
        } else {
            Role::Aside
        };
        columns.push(column(format!("{name} phase"), "°", phase));
        columns.push(column(format!("{name} third harmonic"), unit, Role::Aside));
        columns.push(column(
            format!("{name} peak displacement"),
            self::unit(dofs, observed, Derivative::Displacement),
            Role::Aside,
        ));
    }
    columns
}

/// Amplitude of the fundamental, its phase, that of the third harmonic, and the peak, of each motion.
fn measured<const D: usize>(
    balance: &HarmonicBalance<D>,
    point: &CurvePoint<D>,
    motions: &[Observed],
    quantity: Derivative,
) -> Vec<f64> {
    let solution = &point.solution;
    let omega = solution.omega_rad_s();
    let mut row = vec![solution.frequency_hz()];
    for &observed in motions {
        let amplitude = |order: usize| {
            let rate = order as f64 * omega;
            let turns = num_complex::Complex64::new(0.0, rate).powi(quantity.order());
            turns * balance.amplitude_of(solution, observed, order)
        };
        let fundamental = amplitude(1);
        row.push(fundamental.norm());
        row.push(fundamental.arg().to_degrees());
        row.push(amplitude(3).norm());
        row.push(balance.peak_of(solution, observed));
    }
    row
}

/// Amplitude of the load, of that of the curve's loads.
fn load_factor<const D: usize>(point: &CurvePoint<D>) -> [f64; 1] {
    [point.solution.load_factor().abs()]
}

fn flag(is_so: bool) -> f64 {
    if is_so { 1.0 } else { 0.0 }
}

/// The lap of small motion about rest, in which what may slip sticks.
fn of_small_motion<const D: usize>(lap: &Lap<D>) -> Lap<D> {
    Lap {
        joint: lap.joint.linearised_about(&[0.0; D]),
        ..*lap
    }
}

/// So many frequencies of a span, Hz.
pub(super) fn frequencies(span: Span, lines: usize) -> impl Iterator<Item = f64> {
    let [from, to] = span.ends_hz;
    (0..lines).map(move |line| {
        let share = line as f64 / (lines - 1) as f64;
        (1.0 - share) * from + share * to
    })
}

/// Frequency, then of each motion over the load modulus, real and imaginary part.
pub(super) fn receptances<const D: usize>(
    lap: &Lap<D>,
    frequencies_hz: impl Iterator<Item = f64>,
    place: LoadPlace,
    motions: &[Observed],
    quantity: Derivative,
) -> Result<Vec<Vec<f64>>, HarmonicError> {
    let balance = HarmonicBalance::new(&of_small_motion(lap), Harmonics::odd(1)?)?;
    let load = unit_load(place);
    frequencies_hz
        .map(|frequency_hz| {
            let omega = TAU * frequency_hz;
            let solution = balance.forced(omega, &load, None)?;
            let turns = num_complex::Complex64::new(0.0, omega).powi(quantity.order());
            let mut row = vec![frequency_hz];
            for &observed in motions {
                let value = turns * balance.amplitude_of(&solution, observed, 1);
                row.extend([value.norm(), value.re, value.im]);
            }
            Ok(row)
        })
        .collect()
}

/// What one series of a curve is computed from.
pub(super) struct Curve<'a> {
    pub(super) harmonics: &'a Harmonics,
    pub(super) motions: &'a [Observed],
    pub(super) quantity: Derivative,
}

impl Curve<'_> {
    /// Measured columns, amplitude of the load, whether it persists and whether the frequency turns.
    pub(super) fn forced<const D: usize>(
        &self,
        lap: &Lap<D>,
        span: Span,
        place: LoadPlace,
        level: f64,
    ) -> Result<Answer<D>, HarmonicError> {
        let balance = HarmonicBalance::new(lap, self.harmonics.clone())?;
        let loads = unit_load(place).scaled(level);
        let options = CurveOptions {
            with_stability: true,
            ..CurveOptions::default()
        };
        let curve = balance.forced_curve(span.ends_hz.map(|hz| TAU * hz), &loads, &options)?;
        Ok(self.rows(&balance, &curve, |point| {
            let stable = point.stability.as_ref().map(|s| flag(s.is_stable()));
            [stable.unwrap_or(f64::NAN), flag(point.is_fold)]
        }))
    }

    /// Measured columns and the amplitude of the load.
    pub(super) fn controlled<const D: usize>(
        &self,
        lap: &Lap<D>,
        span: Span,
        place: LoadPlace,
        target: Target,
    ) -> Result<Answer<D>, HarmonicError> {
        let balance = HarmonicBalance::new(lap, self.harmonics.clone())?;
        let ends = span.ends_hz.map(|hz| TAU * hz);
        let options = CurveOptions::default();
        let curve = balance.controlled_curve(ends, &unit_load(place), target, &options)?;
        Ok(self.rows(&balance, &curve, load_factor))
    }

    /// Measured columns and the amplitude of the load.
    pub(super) fn resonance<const D: usize>(
        &self,
        lap: &Lap<D>,
        amplitudes: [f64; 2],
        place: LoadPlace,
        target: Target,
    ) -> Result<Answer<D>, HarmonicError> {
        let balance = HarmonicBalance::new(lap, self.harmonics.clone())?;
        let options = CurveOptions::default();
        let curve = balance.resonance_curve(amplitudes, &unit_load(place), target, &options)?;
        Ok(self.rows(&balance, &curve, load_factor))
    }

    /// Measured columns and the damping ratio.
    pub(super) fn backbone<const D: usize>(
        &self,
        lap: &Lap<D>,
        amplitudes: [f64; 2],
        target: Target,
        is_undamped: bool,
    ) -> Result<Answer<D>, HarmonicError> {
        let lap = if is_undamped { undamped(lap) } else { *lap };
        let balance = HarmonicBalance::new(&lap, self.harmonics.clone())?;
        let curve = balance.backbone(amplitudes, target, &CurveOptions::default())?;
        Ok(self.rows(&balance, &curve, |point| [point.solution.damping_ratio()]))
    }

    /// Measured columns of each point, and what else is told of it.
    fn rows<const D: usize, const MORE: usize>(
        &self,
        balance: &HarmonicBalance<D>,
        curve: &[CurvePoint<D>],
        more: impl Fn(&CurvePoint<D>) -> [f64; MORE],
    ) -> Answer<D> {
        let row = |point: &CurvePoint<D>| {
            let mut row = measured(balance, point, self.motions, self.quantity);
            row.extend(more(point));
            row
        };
        let largest = |dof: usize| {
            let peaks = curve.iter();
            let peaks =
                peaks.map(|point| balance.peak_of(&point.solution, Observed::Relative(dof)));
            peaks.fold(0.0, f64::max)
        };
        Answer {
            rows: curve.iter().map(row).collect(),
            largest: std::array::from_fn(largest),
        }
    }
}

fn is_spring(parameter: &Parameter) -> bool {
    parameter.acts_on.stored_energy
}

/// The lap without dampers.
fn undamped<const D: usize>(lap: &Lap<D>) -> Lap<D> {
    let mut lap = *lap;
    lap.joint = JointLaw {
        linear: Linear {
            damping: [[0.0; D]; D],
            ..lap.joint.linear
        },
        on: lap.joint.on.map(|laws| laws.with_only(is_spring)),
    };
    lap.a.damping = [0.0; D];
    lap.b.damping = [0.0; D];
    lap
}
