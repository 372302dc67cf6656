//! How uneven the noise of the assembly's functions is over the lines.
//!
//! Noise in parts of each value is large at resonances and small between them, which nothing but residuals tells: with one level for
//! all lines the estimate would lean on the values that are known worst, and its deviations would not show it. Between both lies
//! σ²(ω) = σ² (1 − w + w |H(ω)|²/mean |H|²). Noise knows nothing of the next line, so w is that which makes what residuals differ by
//! from the mean of their neighbours most likely.
//!
//! Beside substructures that have noise, too, residuals are not of the assembly's noise alone. There the measured functions tell it
//! from line to line.

use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::identification::SpatialIdentification;
use crate::lack;
use crate::level::{root_mean_square, size};
use crate::misfits::Misfit;
use crate::odd::median;
use crate::parallel::over_lines;
use crate::part_noise::{of_assembly, percent};
use crate::problem::{Problem, Unknowns};
use crate::study::SpatialStudy;

/// By how much −2 ln L has to fall with w for one that is told. Neighbours share residuals, so that it tells up to three times as much
/// as it seems.
const CLEAR: f64 = 40.0;
/// Noise in parts of each value above which it is not told by them, and the floor in parts of the median, in those, that is minor.
const LARGE: f64 = 0.1;
const MINOR: f64 = 0.3;
/// χ² over its degrees of freedom of noise that explains what is left: with noise that is as large where values are small it would be
/// a hundred times that.
const EXPLAINED: f64 = 1.5;
/// Differences that are looked at, at most.
const MOST: usize = 100_000;
/// Largest ln(w/(1 − w)), with the opposite as the smallest, and how many are tried before the best is searched nearby.
const LARGEST: f64 = 14.0;
const TRIED: usize = 29;
/// Rounds in which the search halves its range, about.
const NEARER: usize = 16;

/// w of the residuals beside this joint, 0 where they show none; none where something else than noise is left.
pub(crate) fn of(problem: &Problem, unknowns: &Unknowns) -> Result<Option<f64>, SpatialError> {
    if lack::of(problem, unknowns)? > lack::LACKING {
        return Ok(None);
    }
    let computed = computed(problem, unknowns)?;
    let all = problem.observed.iter().zip(&computed);
    let all: Vec<Differences> = all
        .filter_map(|(one, computed)| Differences::of(&one.values, computed))
        .collect();
    let count: usize = all.iter().map(|own| own.squares.len()).sum();
    let every = count.div_ceil(MOST).max(1);
    let unlikely = |logit: f64| -> f64 {
        let part = part(logit);
        all.iter().map(|own| own.unlikely(part, every)).sum()
    };
    let logit = |n: usize| LARGEST * (2.0 * n as f64 / (TRIED - 1) as f64 - 1.0);
    let tried = (0..TRIED).map(|n| (unlikely(logit(n)), logit(n)));
    let best = tried.min_by(|(one, _), (other, _)| one.total_cmp(other));
    let Some((_, near)) = best else {
        return Ok(None);
    };
    let (mut at, mut reach) = (near, 2.0 * LARGEST / (TRIED - 1) as f64);
    let mut least = unlikely(at);
    for _ in 0..NEARER {
        let sides = [at - reach, at + reach].map(|side| (unlikely(side), side));
        match sides.into_iter().find(|(own, _)| *own < least) {
            Some((own, side)) => (least, at) = (own, side),
            None => reach *= 0.5,
        }
    }
    let of_none: f64 = all.iter().map(|own| own.unlikely(0.0, every)).sum();
    Ok(Some(match of_none - least > CLEAR {
        true => part(at),
        false => 0.0,
    }))
}

/// A test with noise that seems to go with the values of the assembly's functions.
#[derive(Clone, Debug)]
pub(crate) struct Uneven {
    problem: Problem,
    note: String,
    /// Mean of ln σ²(ω)/σ²: by so much a number's −2 ln L is above that with noise that is alike, at the same χ².
    above: f64,
}

impl Uneven {
    /// As functions show it from line to line; `None` of any other noise. A level that `is_stated` is that over all lines.
    pub(crate) fn shown(even: &Problem, is_stated: bool) -> Option<Self> {
        let shown = of_assembly(even).filter(|shown| shown.is_noise)?;
        // where noise is as large as values, these are not known well enough to tell it
        let is_of_values = shown.relative < LARGE && shown.floor < MINOR * shown.relative;
        let part = is_of_values.then_some(shown.relative)?;
        let mut problem = even.clone();
        let mut logarithms = 0.0;
        for one in &mut problem.observed {
            let sizes = one.values.iter().map(|value| value.norm());
            let floor = shown.floor * median(sizes.clone().collect())?;
            let noise: Vec<f64> = sizes.map(|size| (part * size).hypot(floor)).collect();
            let level = match is_stated {
                true => root_mean_square(noise.iter().map(|own| own * own)),
                false => shown.typical * size(&one.values),
            };
            one.uneven = noise.iter().map(|own| own / level).collect();
            logarithms += one.uneven.iter().map(|own| 2.0 * own.ln()).sum::<f64>();
        }
        let note = format!(
            "the noise of the assembly's functions is not the same at all lines: they show {} of each value, and each line counts as its \
             noise says",
            percent(part)
        );
        let above = logarithms / (0.5 * problem.numbers() as f64);
        above.is_finite().then_some(Self {
            problem,
            note,
            above,
        })
    }
}

impl SpatialStudy {
    /// The joint with that noise, or with noise that is the same at all lines, whichever is likelier: what fits from line to line miss
    /// where these are far apart goes with the values, too.
    pub(crate) fn identify_with(
        &self,
        uneven: &Uneven,
        misfits: &[Misfit],
    ) -> Result<SpatialIdentification, SpatialError> {
        let with = Self {
            problem: uneven.problem.clone(),
            ..self.clone()
        };
        let squares = |found: &SpatialIdentification| found.reduced_chi_squared.unwrap_or(1.0);
        let with = with.identify_alone(misfits);
        let of_with = with.as_ref().map_or(f64::INFINITY, squares);
        let found = match of_with < EXPLAINED {
            true => with,
            false => match self.identify_alone(misfits) {
                Ok(even) if squares(&even) <= of_with + uneven.above => return Ok(even),
                Err(error) if with.is_err() => return Err(error),
                _ => with,
            },
        };
        found.map(|mut found| {
            found.warnings.push(uneven.note.clone());
            found
        })
    }
}

/// What is said of noise that goes with this part of the values.
pub(crate) fn told(part: f64) -> Option<String> {
    (part > 0.0).then(|| {
        format!(
            "the noise of the assembly's functions is not the same at all lines: about {} of its square goes with their values, and \
             each line counts as its noise says",
            percent(part)
        )
    })
}

/// w of ln(w/(1 − w)).
fn part(logit: f64) -> f64 {
    1.0 / (1.0 + (-logit.clamp(-LARGEST, LARGEST)).exp())
}

impl Problem {
    /// With noise that goes with this part of the values of its functions, as the joint has them.
    pub(crate) fn with_uneven_noise(
        &self,
        part: f64,
        unknowns: &Unknowns,
    ) -> Result<Self, SpatialError> {
        let mut own = self.clone();
        if part == 0.0 {
            own.observed.iter_mut().for_each(|one| one.uneven.clear());
            return Ok(own);
        }
        for (one, computed) in own.observed.iter_mut().zip(computed(self, unknowns)?) {
            let mean = root_mean_square(computed.iter().map(Complex64::norm_sqr)).powi(2);
            let uneven = |value: &Complex64| share(part, value.norm_sqr() / mean).sqrt();
            one.uneven = match mean > 0.0 {
                true => computed.iter().map(uneven).collect(),
                false => Vec::new(),
            };
        }
        Ok(own)
    }
}

/// σ²(ω)/σ² where |H|²/mean |H|² is this.
fn share(part: f64, square: f64) -> f64 {
    1.0 - part + part * square
}

/// The observed functions as the joint has them, line by line.
fn computed(problem: &Problem, unknowns: &Unknowns) -> Result<Vec<Vec<Complex64>>, SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let lines = over_lines(problem.frequency_hz.len(), |lines| {
        let of = |line| Ok(assembled.line(line)?.functions);
        lines.map(of).collect::<Result<Vec<_>, SpatialError>>()
    })?
    .concat();
    let of_function = |n: usize| lines.iter().map(|line| line[n]).collect();
    Ok((0..problem.observed.len()).map(of_function).collect())
}

/// What residuals of a function differ by from the mean of their neighbours.
struct Differences {
    /// |d|²
    squares: Vec<f64>,
    /// |H|²/mean |H|², there and at both neighbours together.
    values: Vec<[f64; 2]>,
}

impl Differences {
    /// `None` where there are none.
    fn of(measured: &[Complex64], computed: &[Complex64]) -> Option<Self> {
        let left: Vec<Complex64> = measured.iter().zip(computed).map(|(m, c)| m - c).collect();
        let mean = root_mean_square(computed.iter().map(Complex64::norm_sqr)).powi(2);
        let squares = left.windows(3);
        let squares = squares.map(|own| (own[1] - (own[0] + own[2]) * 0.5).norm_sqr());
        let values = computed.windows(3);
        let values = values.map(|own| {
            let [before, at, behind] = [0, 1, 2].map(|n| own[n].norm_sqr() / mean);
            [at, before + behind]
        });
        let own = Self {
            squares: squares.collect(),
            values: values.collect(),
        };
        let sum: f64 = own.squares.iter().sum();
        (mean > 0.0 && sum > 0.0 && sum.is_finite()).then_some(own)
    }

    /// −2 ln L by every so many-th difference, at the most likely level of the function.
    fn unlikely(&self, part: f64, every: usize) -> f64 {
        let (mut count, mut squares, mut logarithms) = (0.0, 0.0, 0.0);
        let all = self.squares.iter().zip(&self.values).step_by(every);
        for (square, [at, beside]) in all {
            // var d = σ²(ω) + ¼ (σ²(ω₋) + σ²(ω₊))
            let variance = share(part, *at) + 0.25 * (2.0 * (1.0 - part) + part * beside);
            count += 1.0;
            squares += square / variance;
            logarithms += variance.ln();
        }
        // E|d|² = σ² var, and p(d) = e^(−|d|²/(σ² var))/(π σ² var)
        2.0 * (count * (squares / f64::max(count, 1.0)).ln() + logarithms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{number, problem, unknowns};

    /// Residuals of a resonance with both kinds of noise, a level for each function.
    fn told(noise: impl Fn(f64) -> f64) -> f64 {
        let mut seed = 7;
        let mut random = move || {
            let sum: f64 = (0..12).map(|_| number(&mut seed)).sum();
            Complex64::new(sum, (0..12).map(|_| number(&mut seed)).sum())
        };
        let all: Vec<Differences> = (0..20)
            .map(|n| {
                let computed: Vec<Complex64> = (0..200)
                    .map(|l| {
                        1.0 / Complex64::new(
                            1.0 - (f64::from(l) / (80.0 + f64::from(n))).powi(2),
                            0.03,
                        )
                    })
                    .collect();
                let measured: Vec<Complex64> = computed
                    .iter()
                    .map(|h| h + random() * f64::from(n + 1) * noise(h.norm()))
                    .collect();
                Differences::of(&measured, &computed).unwrap()
            })
            .collect();
        let unlikely = |part: f64| all.iter().map(|own| own.unlikely(part, 1)).sum::<f64>();
        let parts = (0..=1000).map(|n| f64::from(n) / 1000.0);
        let best = parts.min_by(|one, other| unlikely(*one).total_cmp(&unlikely(*other)));
        best.unwrap()
    }

    #[test]
    fn the_part_that_goes_with_the_values_is_found() {
        assert!(told(|_| 1e-3) < 0.02);
        assert!(told(|h| 1e-3 * h) > 0.99);
        // mean |H|² of these functions is about 26
        let half = told(|h| 1e-3 * (0.5 * (1.0 + h * h / 26.0)).sqrt());
        assert!((0.35..0.65).contains(&half), "{half}");
    }

    #[test]
    fn uneven_noise_is_as_large_over_all_lines() {
        let problem = problem();
        let uneven = problem.with_uneven_noise(0.7, &unknowns(&problem)).unwrap();
        for one in &uneven.observed {
            let squares = one.uneven.iter().map(|own| own * own);
            assert!((root_mean_square(squares) - 1.0).abs() < 1e-12);
        }
        let even = uneven.with_uneven_noise(0.0, &unknowns(&problem)).unwrap();
        assert!(even.observed.iter().all(|one| one.uneven.is_empty()));
    }
}
