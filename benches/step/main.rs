//! What a communication step costs through FMI, beside the same equations in a plain Rust loop and in plain C.
//!
//! The FMU's side is what an importer does: `fmi3SetFloat64`, `fmi3DoStep`, `fmi3GetFloat64`, in the very library that
//! the executable embeds, loaded at run time. The C side is `reference.c`, compiled with `-O3` when the benchmark
//! starts; it has no interface to cross. Criterion reports all ways; after that, all are timed once more in turns, so
//! that they share whatever else the machine does, and the FMU's time is printed in proportion to the others. What it
//! takes to make an instance is reported too.

mod comparison;
mod fmu;
mod reference;
mod start_file;

use std::{error::Error, time::Duration};

use bolted_joint_dynamics::{
    Body, JointLaw, Lap, Linear, Polynomial,
    law::{DofLaws, Iwan},
};
use criterion::Criterion;

use crate::{
    comparison::Comparison,
    fmu::{Fmu, Library, Resources},
    reference::Compiler,
};

/// Longest Runge–Kutta step, s.
const STEP_SIZE_MAX_S: f64 = 1e-5;

fn main() -> Result<(), Box<dyn Error>> {
    let library = Library::load()?;
    let compiler = Compiler::find()
        .map_err(|missing| eprintln!("no comparison with C: {missing}"))
        .ok();
    let cc = compiler.as_ref();
    let (translation, rotation) = (translational_lap(), rotational_lap());
    let (linear_1, linear_2) = (without_cubic(&translation), without_cubic(&rotation));
    let mut comparisons = [
        Comparison::of_lap("lap, 1 DOF, 1 substep", &library, cc, &translation, 1)?,
        Comparison::of_lap("lap, 1 DOF, 50 substeps", &library, cc, &translation, 50)?,
        Comparison::of_lap("lap, 2 DOF, 1 substep", &library, cc, &rotation, 1)?,
        Comparison::of_lap("lap, 2 DOF, 50 substeps", &library, cc, &rotation, 50)?,
        Comparison::of_lap("linear lap, 1 DOF, 1 substep", &library, cc, &linear_1, 1)?,
        Comparison::of_lap(
            "linear lap, 1 DOF, 50 substeps",
            &library,
            cc,
            &linear_1,
            50,
        )?,
        Comparison::of_lap("linear lap, 2 DOF, 1 substep", &library, cc, &linear_2, 1)?,
        Comparison::of_lap(
            "linear lap, 2 DOF, 50 substeps",
            &library,
            cc,
            &linear_2,
            50,
        )?,
        Comparison::of_element("element, 2 DOF", &library, &rotation.joint)?,
        Comparison::of_element("element, 1 DOF", &library, &translation.joint)?,
        Comparison::of_element(
            "element with Iwan, 1 DOF",
            &library,
            &slipping(&translation),
        )?,
    ];
    for comparison in &mut comparisons {
        comparison.check()?;
    }

    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .sample_size(50)
        .configure_from_args();
    for comparison in &mut comparisons {
        comparison.bench(&mut criterion);
    }
    bench_instantiation(
        &mut criterion,
        &library,
        &start_file::lap(&rotation, STEP_SIZE_MAX_S),
    )?;
    criterion.final_summary();

    // Cargo tells in this way that it is to measure, the user that it is only to try or to list
    let is_given = |option: &str| std::env::args().any(|argument| argument == option);
    if is_given("--bench") && !is_given("--test") && !is_given("--list") {
        comparison::print_ratios(&mut comparisons);
    }
    Ok(())
}

/// Criterion's report of making an instance and freeing it, its start-value file in the page cache.
fn bench_instantiation(
    criterion: &mut Criterion,
    library: &Library,
    start_file: &str,
) -> Result<(), Box<dyn Error>> {
    let resources = Resources::with(start_file)?;
    Fmu::instantiate(library, &resources)?;
    criterion.bench_function("instantiate and free, lap, 2 DOF", |bencher| {
        bencher.iter(|| Fmu::instantiate(library, &resources).is_ok());
    });
    Ok(())
}

/// Two equal masses with a hardening joint.
fn translational_lap() -> Lap<1> {
    let body = Body {
        inertia: [2.35],
        stiffness: [10.56e5],
        damping: [31.5],
    };
    Lap {
        joint: Linear {
            stiffness: [[4.56e6]],
            damping: [[10.0]],
        }
        .beside([Polynomial::cubic(5e12)]),
        a: body,
        b: body,
    }
}

/// The same with rotation, coupled through the joint.
fn rotational_lap() -> Lap<2> {
    let body = Body {
        inertia: [1.41, 1e-3],
        stiffness: [8.24e5, 1e3],
        damping: [20.0, 0.05],
    };
    Lap {
        joint: Linear {
            stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
            damping: [[10.83, -0.83], [-0.83, 0.083]],
        }
        .beside([5e12, 1e6].map(Polynomial::cubic)),
        a: body,
        b: body,
    }
}

/// Its joint with Iwan's law beside, which slips in part under the motions here.
fn slipping(lap: &Lap<1>) -> JointLaw<1> {
    let mut joint = lap.joint;
    let mut parameters = *joint.on[0].parameters();
    let iwan = DofLaws::from(Iwan {
        slip_force: 400.0,
        stiffness: 2e6,
        exponent: -0.4,
        ratio: 0.5,
    });
    for (parameter, own) in parameters.iter_mut().zip(iwan.parameters()) {
        *parameter += own;
    }
    joint.on[0] = DofLaws::new(parameters);
    joint
}

/// The same without its cubic springs: the FMU then takes one product for all Runge–Kutta steps of a communication step.
fn without_cubic<const D: usize>(lap: &Lap<D>) -> Lap<D> {
    Lap {
        joint: lap.joint.linear.into(),
        ..*lap
    }
}
