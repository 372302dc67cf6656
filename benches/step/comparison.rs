//! The same communication steps by several ways, and the time that each takes.

use std::{
    error::Error,
    f64::consts::TAU,
    hint::black_box,
    num::NonZeroU32,
    time::{Duration, Instant},
};

use bolted_joint_dynamics::{
    DOF_AT_REST, JointLaw, Lap, LapIntegrator, LapLoads, LapState, Motion,
};
use criterion::Criterion;

use crate::{
    STEP_SIZE_MAX_S,
    fmu::{Fmu, Library},
    reference::{Compiler, Inertias, Reference},
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

/// The ways, in the order in which they are shown.
const WAYS: [&str; 4] = ["FMU", "plain Rust", "C reciprocals", "C divisions"];

/// Several ways to take the same steps: the FMU, a plain Rust loop and, for the lap and where there is a compiler, C.
pub(crate) struct Comparison<'a> {
    name: &'static str,
    is_linear: bool,
    /// In the order of [`WAYS`], of which the last may be missing.
    ways: Vec<Run<'a>>,
}

impl<'a> Comparison<'a> {
    /// Lap FMU against its integrator and against C: loads in, motion out.
    pub(crate) fn of_lap<const D: usize>(
        name: &'static str,
        library: &'a Library,
        compiler: Option<&Compiler>,
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
        let mut in_c: Vec<Run<'a>> = Vec::new();
        if let Some(compiler) = compiler {
            for inertias in [Inertias::Reciprocals, Inertias::Divided] {
                let loads = inputs.concat();
                let mut reference =
                    Reference::new(compiler, inertias, lap, loads, interval_s, substeps)?;
                in_c.push(Box::new(move |steps| reference.take(steps)));
            }
        }
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
            ways: [fmu, Box::new(plain)].into_iter().chain(in_c).collect(),
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
        let mut memory = [DOF_AT_REST; D];
        let plain = move |steps| {
            let mut sum = 0.0;
            for _ in 0..steps {
                let [a, b] = black_box(&motions[next]);
                next = (next + 1) % PERIOD;
                let relative = a.relative_to(b);
                if law.has_memory() {
                    black_box(law.commit(&mut memory, &relative));
                }
                let on_b = law.load_on_b_after(&memory, &relative);
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
            ways: vec![fmu, Box::new(plain)],
        })
    }

    /// Refuses to measure ways that do not compute the same: FMU and Rust bit for bit, or, where the FMU takes one
    /// product for all Runge–Kutta steps, to rounding; C to rounding.
    pub(crate) fn check(&mut self) -> Result<(), String> {
        let sums: Vec<f64> = self.ways.iter_mut().map(|run| run(1001)).collect();
        for (way, (&sum, name)) in sums.iter().zip(WAYS).enumerate() {
            let rounding = if way < 2 && !self.is_linear {
                0.0
            } else {
                1e-9
            };
            let agrees = (sum - sums[0]).abs() <= rounding * sums[0].abs();
            if !agrees {
                let (case, fmu) = (self.name, sums[0]);
                return Err(format!("{case}: {name} gives {sum:e}, the FMU {fmu:e}"));
            }
        }
        Ok(())
    }

    /// Criterion's report of all ways.
    pub(crate) fn bench(&mut self, criterion: &mut Criterion) {
        let mut group = criterion.benchmark_group(self.name);
        for (way, run) in WAYS.into_iter().zip(&mut self.ways) {
            group.bench_function(way, |bencher| {
                bencher.iter_custom(|steps| time(run, steps));
            });
        }
        group.finish();
    }

    /// Median time of one step in ns by each way, all measured in turns.
    fn medians_ns(&mut self) -> Vec<f64> {
        const ROUNDS: usize = 1001;
        const ROUND_S: f64 = 2e-4;
        let trial = 1000;
        let steps: Vec<u64> = self
            .ways
            .iter_mut()
            .map(|run| (ROUND_S * trial as f64 / time(run, trial).as_secs_f64()).ceil() as u64)
            .collect();
        let mut samples = vec![Vec::with_capacity(ROUNDS); self.ways.len()];
        for _ in 0..ROUNDS {
            for ((run, &steps), samples) in self.ways.iter_mut().zip(&steps).zip(&mut samples) {
                samples.push(1e9 * time(run, steps).as_secs_f64() / steps as f64);
            }
        }
        samples
            .into_iter()
            .map(|mut samples| {
                samples.sort_by(f64::total_cmp);
                samples[ROUNDS / 2]
            })
            .collect()
    }
}

/// Prints the times of one communication step, and those of the FMU in proportion to the others.
pub(crate) fn print_ratios(comparisons: &mut [Comparison<'_>]) {
    print!("\n{:<32}", "one communication step, ns");
    for way in WAYS {
        print!("{way:>15}");
    }
    print!("   |");
    for way in &WAYS[1..] {
        print!("{:>17}", format!("/ {way}"));
    }
    println!();
    for comparison in comparisons {
        let medians = comparison.medians_ns();
        print!("{:<32}", comparison.name);
        for way in 0..WAYS.len() {
            print!("{:>15}", cell(medians.get(way), 1));
        }
        print!("   |");
        for way in 1..WAYS.len() {
            let ratio = medians.get(way).map(|median| medians[0] / median);
            print!("{:>17}", cell(ratio.as_ref(), 3));
        }
        println!();
    }
}

/// A number, or a dash where there is none.
fn cell(number: Option<&f64>, decimals: usize) -> String {
    number.map_or("-".into(), |number| format!("{number:.decimals$}"))
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
