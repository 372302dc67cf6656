//! The same communication steps by two ways, and the time that each takes.

use std::{
    error::Error,
    f64::consts::TAU,
    hint::black_box,
    num::NonZeroU32,
    time::{Duration, Instant},
};

use bolted_joint_dynamics::{JointLaw, Lap, LapIntegrator, LapLoads, LapState, Motion};
use criterion::Criterion;

use crate::{
    STEP_SIZE_MAX_S,
    fmu::{Fmu, Library},
    start_file,
};

/// Inputs repeat after as many steps.
const PERIOD: usize = 64;

/// Value references of `a.y a.theta a.v a.omega`; those of side b follow by 4.
const MOTION_OF_A: [u32; 4] = [1, 2, 3, 4];
/// Value references of `a.F a.M`; those of side b follow by 2.
const LOAD_ON_A: [u32; 2] = [9, 10];

/// Takes a number of communication steps and gives the sum of all outputs on the way.
type Run<'a> = Box<dyn FnMut(u64) -> f64 + 'a>;

/// Two ways to take the same steps.
pub(crate) struct Comparison<'a> {
    name: &'static str,
    is_linear: bool,
    fmu: Run<'a>,
    plain: Run<'a>,
}

impl<'a> Comparison<'a> {
    /// Lap FMU against its integrator: loads in, motion out.
    pub(crate) fn of_lap<const D: usize>(
        name: &'static str,
        library: &'a Library,
        lap: &Lap<D>,
        substeps: u32,
    ) -> Result<Self, Box<dyn Error>> {
        let interval_s = f64::from(substeps) * STEP_SIZE_MAX_S;
        let count = NonZeroU32::new(substeps).ok_or("a step needs at least one substep")?;
        let loads: [LapLoads<D>; PERIOD] = std::array::from_fn(|n| {
            let phase = TAU * n as f64 / PERIOD as f64;
            let load =
                |amplitude: f64| std::array::from_fn(|dof| amplitude * 0.01_f64.powi(dof as i32));
            LapLoads {
                a: load(100.0 * phase.sin()),
                b: load(50.0 * phase.cos()),
            }
        });

        let inputs = loads.map(|loads| [loads.a, loads.b].concat());
        let start = start_file::lap(lap, STEP_SIZE_MAX_S);
        let fmu = through_fmi(
            Fmu::start(library, &start)?,
            interval_s,
            inputs,
            two_sides(&LOAD_ON_A[..D], 2),
            two_sides(&motion_of_a::<D>(), 4),
        );

        let integrator = LapIntegrator::new(lap);
        let mut state = LapState {
            a: Motion::REST,
            b: Motion::REST,
        };
        let mut next = 0;
        let plain = move |steps| {
            let mut sum = 0.0;
            for _ in 0..steps {
                let loads = black_box(&loads[next]);
                next = (next + 1) % PERIOD;
                state = integrator.advance(&state, loads, interval_s, count);
                for motion in [&state.a, &state.b] {
                    for value in motion.displacement.iter().chain(&motion.velocity) {
                        sum += value;
                    }
                }
            }
            sum
        };
        Ok(Self {
            name,
            is_linear: integrator.is_linear(),
            fmu,
            plain: Box::new(plain),
        })
    }

    /// Element FMU against the joint's law: motion in, loads on both sides out.
    pub(crate) fn of_element<const D: usize>(
        name: &'static str,
        library: &'a Library,
        law: &JointLaw<D>,
    ) -> Result<Self, Box<dyn Error>> {
        let motions: [[Motion<D>; 2]; PERIOD] = std::array::from_fn(|n| {
            let (sin, cos) = (TAU * n as f64 / PERIOD as f64).sin_cos();
            [(1e-4 * sin, 0.1 * cos), (2e-5 * cos, -0.02 * sin)].map(|(x, v)| Motion {
                displacement: [x; D],
                velocity: [v; D],
            })
        });

        let inputs =
            motions.map(|[a, b]| [a.displacement, a.velocity, b.displacement, b.velocity].concat());
        let fmu = through_fmi(
            Fmu::start(library, &start_file::element(law))?,
            STEP_SIZE_MAX_S,
            inputs,
            two_sides(&motion_of_a::<D>(), 4),
            two_sides(&LOAD_ON_A[..D], 2),
        );

        let law = *law;
        let mut next = 0;
        let plain = move |steps| {
            let mut sum = 0.0;
            for _ in 0..steps {
                let [a, b] = black_box(&motions[next]);
                next = (next + 1) % PERIOD;
                let on_b = law.load_on_b(&a.relative_to(b));
                for load in on_b {
                    sum -= load;
                }
                for load in on_b {
                    sum += load;
                }
            }
            sum
        };
        Ok(Self {
            name,
            is_linear: false,
            fmu,
            plain: Box::new(plain),
        })
    }

    /// Refuses to measure two ways that do not compute the same: bit for bit, or, where the FMU takes one product for
    /// all Runge–Kutta steps, to rounding.
    pub(crate) fn check(&mut self) -> Result<(), String> {
        let (fmu, plain) = ((self.fmu)(1001), (self.plain)(1001));
        let rounding = if self.is_linear { 1e-9 } else { 0.0 };
        if (fmu - plain).abs() <= rounding * plain.abs() {
            Ok(())
        } else {
            let name = self.name;
            Err(format!(
                "{name}: the FMU gives {fmu:e}, the plain loop {plain:e}"
            ))
        }
    }

    /// Criterion's report of both ways.
    pub(crate) fn bench(&mut self, criterion: &mut Criterion) {
        let mut group = criterion.benchmark_group(self.name);
        for (way, run) in [("FMI", &mut self.fmu), ("plain loop", &mut self.plain)] {
            group.bench_function(way, |bencher| {
                bencher.iter_custom(|steps| time(run, steps));
            });
        }
        group.finish();
    }

    /// Median times of one step in ns, FMI and plain, both ways measured in turns.
    fn medians_ns(&mut self) -> [f64; 2] {
        const ROUNDS: usize = 1001;
        const ROUND_S: f64 = 2e-4;
        let trial = 1000;
        let steps =
            (ROUND_S * trial as f64 / time(&mut self.plain, trial).as_secs_f64()).ceil() as u64;
        let mut samples = [Vec::with_capacity(ROUNDS), Vec::with_capacity(ROUNDS)];
        for _ in 0..ROUNDS {
            for (run, samples) in [&mut self.fmu, &mut self.plain]
                .into_iter()
                .zip(&mut samples)
            {
                samples.push(1e9 * time(run, steps).as_secs_f64() / steps as f64);
            }
        }
        samples.map(|mut samples| {
            samples.sort_by(f64::total_cmp);
            samples[ROUNDS / 2]
        })
    }
}

/// Prints the table of times, and a line with the ratios alone.
pub(crate) fn print_ratios(comparisons: &mut [Comparison<'_>]) {
    println!(
        "{:<34}{:>10}{:>16}{:>16}{:>8}",
        "communication step", "FMI, ns", "plain loop, ns", "difference, ns", "ratio"
    );
    let mut ratios = Vec::new();
    for comparison in comparisons {
        let [fmi, plain] = comparison.medians_ns();
        let (name, ratio) = (comparison.name, fmi / plain);
        println!(
            "{name:<34}{fmi:>10.1}{plain:>16.1}{:>16.1}{ratio:>8.3}",
            fmi - plain
        );
        ratios.push(format!("{name}: {ratio:.3}"));
    }
    println!("FMI / plain loop: {}", ratios.join("; "));
}

fn time(run: &mut Run<'_>, steps: u64) -> Duration {
    let start = Instant::now();
    black_box(run(steps));
    start.elapsed()
}

/// Steps through FMI: sets all inputs, takes the step, reads the outputs.
fn through_fmi<'a>(
    mut fmu: Fmu<'a>,
    interval_s: f64,
    inputs: [Vec<f64>; PERIOD],
    input_references: Vec<u32>,
    output_references: Vec<u32>,
) -> Run<'a> {
    let mut outputs = vec![0.0; output_references.len()];
    let mut next = 0;
    Box::new(move |steps| {
        let mut sum = 0.0;
        for _ in 0..steps {
            let inputs = black_box(&inputs[next]);
            next = (next + 1) % PERIOD;
            fmu.set(&input_references, inputs);
            fmu.step(interval_s);
            fmu.get(&output_references, &mut outputs);
            for value in &outputs {
                sum += value;
            }
        }
        // a step that was refused must not count as a quick one
        if fmu.has_failed() { f64::NAN } else { sum }
    })
}

fn motion_of_a<const D: usize>() -> Vec<u32> {
    let [displacement, velocity] = [&MOTION_OF_A[..2], &MOTION_OF_A[2..]];
    [&displacement[..D], &velocity[..D]].concat()
}

/// Value references of side a, and of side b as far behind.
fn two_sides(of_a: &[u32], distance: u32) -> Vec<u32> {
    let of_b = of_a.iter().map(|reference| reference + distance);
    of_a.iter().copied().chain(of_b).collect()
}
