//! Channels and impacts of the assembly that do not go with what was found, where most others do: a gain, a direction or a plug that
//! is wrong in that test alone. What is wrong at A or B is told before the joint is sought ([`misfits`](crate::misfits)).

use bolted_joint_frf::Dof;
use bolted_joint_statistics::upper_median;
use bolted_joint_virtual_point::Role;
use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::level::size;
use crate::parallel::over_lines;
use crate::problem::{Observed, Problem, Unknowns};

/// Lines that are looked at.
const LINES: usize = 200;

/// What a channel leaves of its functions in parts of what the median channel does, from which on it is told.
const ODD: f64 = 3.0;

/// Channels and functions of each that are needed to tell what is usual, and the part of them that may be odd.
const FEWEST: usize = 4;
const MOST: f64 = 0.34;

/// Part of what is left that a gain or an exchange has to take away.
const EXPLAINS: f64 = 0.75;

/// What is left of a function, below which all is well whatever the others leave.
const LEAST: f64 = 1e-3;

/// A channel or an impact.
struct Odd {
    place: usize,
    dof: Dof,
    /// What it leaves over what is usual, or over its noise where that is more.
    ratio: f64,
}

/// Measured and computed values of each function.
struct Compared<'p> {
    problem: &'p Problem,
    /// Function by function, line by line.
    computed: Vec<Vec<Complex64>>,
    /// Deviation of the noise of each function, as far as it is known.
    noise: &'p [f64],
}

/// What does not fit, in words; nothing where the functions are too few to say. `noise` is the deviation of each function, 0 where it
/// is not known: beside a resonance that no line took part of, it is a large part of the others.
pub(crate) fn odd_channels(
    problem: &Problem,
    unknowns: &Unknowns,
    noise: &[f64],
) -> Result<Vec<String>, SpatialError> {
    let problem = &problem.thinned(LINES);
    let compared = Compared::of(problem, unknowns, noise)?;
    let [a, b] = &problem.sides;
    let dofs: [Vec<Dof>; 2] = [
        a.responses.iter().chain(&b.responses).copied().collect(),
        a.references.iter().chain(&b.references).copied().collect(),
    ];
    let [channels, impacts] = dofs;
    let mut told = compared.told(Role::Channel, &channels);
    told.extend(compared.told(Role::Impact, &impacts));
    Ok(told)
}

impl<'p> Compared<'p> {
    fn of(
        problem: &'p Problem,
        unknowns: &Unknowns,
        noise: &'p [f64],
    ) -> Result<Self, SpatialError> {
        let assembled = Assembled::new(problem, unknowns)?;
        let lines: Vec<Vec<Complex64>> = over_lines(problem.frequency_hz.len(), |lines| {
            lines
                .map(|line| Ok(assembled.line(line)?.functions))
                .collect::<Result<Vec<_>, SpatialError>>()
        })?
        .concat();
        let functions = 0..problem.observed.len();
        Ok(Self {
            problem,
            computed: functions
                .map(|n| lines.iter().map(|line| line[n]).collect())
                .collect(),
            noise,
        })
    }

    /// Functions of a channel or of an impact.
    fn functions(&self, role: Role, place: usize) -> impl Iterator<Item = usize> {
        let all = self.problem.observed.iter().enumerate();
        all.filter(move |(_, one)| place_of(one, role) == place)
            .map(|(n, _)| n)
    }

    /// ‖m − g c‖/‖c‖ of the measured values of one function and the computed ones of another.
    fn left(&self, measured: usize, computed: usize, gain: f64) -> f64 {
        let (m, c) = (
            &self.problem.observed[measured].values,
            &self.computed[computed],
        );
        let left: f64 = m
            .iter()
            .zip(c)
            .map(|(m, c)| (m - c * gain).norm_sqr())
            .sum();
        let size: f64 = c.iter().map(Complex64::norm_sqr).sum();
        (left / size.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// What a channel leaves in the median of its functions, with this gain.
    fn left_of(&self, role: Role, place: usize, gain: f64) -> Option<f64> {
        median(
            self.functions(role, place)
                .map(|n| self.left(n, n, gain))
                .collect(),
        )
    }

    /// What noise leaves in the median of its functions.
    fn noise_of(&self, role: Role, place: usize) -> f64 {
        let of = |n: usize| self.noise[n] / size(&self.computed[n]).max(f64::MIN_POSITIVE);
        median(self.functions(role, place).map(of).collect()).unwrap_or(0.0)
    }

    fn told(&self, role: Role, dofs: &[Dof]) -> Vec<String> {
        let all = dofs.iter().enumerate().filter_map(|(place, &dof)| {
            let is_enough = self.functions(role, place).nth(FEWEST - 1).is_some();
            let left = self.left_of(role, place, 1.0).filter(|_| is_enough)?;
            Some((place, dof, left))
        });
        let all: Vec<(usize, Dof, f64)> = all.collect();
        let usual = median(all.iter().map(|own| own.2).collect());
        let Some(usual) = usual.filter(|_| all.len() >= FEWEST) else {
            return Vec::new();
        };
        let usual = usual.max(LEAST / ODD);
        let odd: Vec<Odd> = all
            .iter()
            .map(|&(place, dof, left)| Odd {
                place,
                dof,
                ratio: left / usual.max(self.noise_of(role, place)),
            })
            .filter(|own| own.ratio > ODD)
            .collect();
        if odd.len() as f64 > MOST * all.len() as f64 {
            return Vec::new();
        }
        let tell = |own: &Odd| {
            let Odd { dof, ratio, .. } = own;
            format!(
                "the functions of the {role} {dof} of the assembly leave {ratio:.0} times what others leave: {}",
                self.advice(role, own, &odd)
            )
        };
        odd.iter().map(tell).collect()
    }

    /// What would make it fit.
    fn advice(&self, role: Role, own: &Odd, odd: &[Odd]) -> String {
        let left = self.left_of(role, own.place, 1.0).unwrap_or(0.0);
        let explains = |rest: Option<f64>| rest.is_some_and(|rest| rest < (1.0 - EXPLAINS) * left);
        let others = odd.iter().filter(|other| other.place != own.place);
        let mut exchanged = others.filter(|other| {
            let pairs = self.functions(role, own.place).filter_map(|n| {
                let across = |n: usize| place_of(&self.problem.observed[n], beyond(role));
                let mut beside = self.functions(role, other.place);
                let other = beside.find(|&k| across(k) == across(n))?;
                Some(self.left(n, other, 1.0))
            });
            explains(median(pairs.collect()))
        });
        if let Some(other) = exchanged.next() {
            return format!("they are those of {}: exchange the two", other.dof);
        }
        let gain = self.gain(role, own.place);
        if explains(self.left_of(role, own.place, gain)) {
            let sign = if gain < 0.0 {
                "turn its sign, and "
            } else {
                ""
            };
            return format!(
                "they are {gain:.3} times what they should be: {sign}check its calibration in that test"
            );
        }
        "check its direction, its place and its plug in that test".to_owned()
    }

    /// g of least ‖m − g c‖ over its functions, each by its own size; real.
    fn gain(&self, role: Role, place: usize) -> f64 {
        let of = |n: usize| {
            let (m, c) = (&self.problem.observed[n].values, &self.computed[n]);
            let size: f64 = c.iter().map(Complex64::norm_sqr).sum();
            let product: Complex64 = m.iter().zip(c).map(|(m, c)| c.conj() * m).sum();
            product.re / size.max(f64::MIN_POSITIVE)
        };
        let gains = self.functions(role, place).map(of).collect();
        median(gains).unwrap_or(1.0)
    }
}

/// The row of a function, or its column.
fn place_of(one: &Observed, role: Role) -> usize {
    let [row, column] = one.at;
    match role {
        Role::Channel => row,
        Role::Impact => column,
    }
}

/// What stands at the other end of a function.
fn beyond(role: Role) -> Role {
    match role {
        Role::Channel => Role::Impact,
        Role::Impact => Role::Channel,
    }
}

/// Of finite numbers; `None` of none.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.retain(|value| value.is_finite());
    upper_median(values)
}
