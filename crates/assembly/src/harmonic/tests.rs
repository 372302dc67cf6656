//! Periodic motions of a small assembly with friction, beside shooting by SciPy, its own steps in time, and differences.

use std::path::PathBuf;

use bolted_joint_joint::JointFile;

use super::*;
use crate::modal_form::ModalForm;
use crate::model::{NamedStructure, PlacedJoint};
use crate::place::{Channel, Place};
use crate::response::LoadCourse;
use follow::Curve;

const LOAD: f64 = 30.0;

/// One mode of 800 rad/s with 2 % of damping and the shape 1.2, and a rigid body of 0.5 kg, as in tests/assembly/small.py.
fn small(beside: &str) -> AssemblyModel {
    let dof: bolted_joint_frf::Dof = "1:+Y".parse().unwrap();
    let structure = |name: &str, frequency: f64, damping: f64, shape: f64| NamedStructure {
        name: name.to_owned(),
        form: ModalForm {
            points: vec![dof],
            frequency_rad_per_s: DVector::from_element(1, frequency),
            damping_per_s: DMatrix::from_element(1, 1, damping),
            shapes: DMatrix::from_element(1, 1, shape),
            modes: 1,
            cut: 0,
        },
    };
    let place = |structure: usize| Place { structure, dof };
    let channel = |name: &str, structure: usize| Channel {
        name: name.to_owned(),
        place: place(structure),
    };
    let text = format!(
        r#"{{"format": "bolted-joint/1", "name": "lap",
            "joint": {{"dofs": ["y"], "stiffness": [[4e5]], "damping": [[20]], {beside}}}}}"#
    );
    AssemblyModel {
        path: PathBuf::new(),
        name: "small".to_owned(),
        about: None,
        structures: vec![
            structure("a", 800.0, 32.0, 1.2),
            structure("b", 0.0, 0.0, 2.0_f64.sqrt()),
        ],
        joints: vec![PlacedJoint {
            name: "lap".to_owned(),
            path: PathBuf::new(),
            file: JointFile::from_json(&text, "lap").unwrap(),
            over_preload: None,
            places: [vec![place(0)], vec![place(1)]],
        }],
        inputs: vec![channel("push", 1)],
        outputs: vec![channel("tip", 1), channel("root", 0)],
        response: None,
        warnings: Vec::new(),
        notes: Vec::new(),
    }
}

fn bouc_wen([exponent, beta, gamma]: [f64; 3]) -> AssemblyModel {
    small(&format!(
        r#""friction": [{{"dof": "y", "law": "bouc-wen", "stiffness": 2e6, "slip_force": 60,
            "exponent": {exponent}, "beta": {beta}, "gamma": {gamma}}}]"#
    ))
}

/// A polynomial, and laws of which one has a loop after Masing, one relaxes, and one begins to slip at once.
fn side_by_side() -> AssemblyModel {
    small(
        r#""cubic": [1e13], "friction": [
            {"dof": "y", "law": "iwan", "stiffness": 8e5, "slip_force": 40, "exponent": -0.4, "ratio": 0.6},
            {"dof": "y", "law": "dahl", "stiffness": 6e5, "slip_force": 20},
            {"dof": "y", "law": "jenkins", "stiffness": 5e5, "slip_force": 15}]"#,
    )
}

fn forced(model: &AssemblyModel, hertz: f64, harmonics: usize, load: Complex64) -> ForcedPoint {
    let ends = [hertz, hertz + 0.1];
    let found = model.forced_response(&[load], ends, harmonics, &|_| ());
    let (mut points, _) = found.unwrap();
    points.swap_remove(0)
}

/// Law, frequency in Hz, fundamentals of tip and root and the tip's largest displacement in m: tests/assembly/bouc_wen.py.
type Shot = ([f64; 3], f64, [Complex64; 2], f64);

#[rustfmt::skip]
const SHOT: [Shot; 6] = {
    const ONE: [f64; 3] = [1.6, 0.7, 0.3];
    const OTHER: [f64; 3] = [2.0, 0.6, -0.4];
    const fn at(tip: [f64; 2], root: [f64; 2]) -> [Complex64; 2] {
        [Complex64::new(tip[0], tip[1]), Complex64::new(root[0], root[1])]
    }
    [
        (ONE, 75.0, at([2.052453609666e-4, -1.908817316486e-5], [1.813860419202e-4, -1.384716360302e-5]), 2.066787328971e-4),
        (ONE, 90.0, at([-1.861298921628e-4, -7.806203465326e-4], [-3.053869092969e-5, -5.595317573832e-4]), 8.156529610566e-4),
        (ONE, 105.0, at([-3.472659835519e-4, -5.826862705027e-5], [-3.262445788326e-4, -5.554415426101e-5]), 3.525346192777e-4),
        (OTHER, 75.0, at([2.007933069199e-4, -1.414366260078e-5], [1.797532118261e-4, -1.189664372453e-5]), 2.012085084879e-4),
        (OTHER, 90.0, at([5.982667529106e-4, -2.458536787329e-4], [5.532967633248e-4, -2.080323270891e-4]), 6.485135789087e-4),
        (OTHER, 105.0, at([-3.512408025699e-4, -5.739082264165e-5], [-3.321271485873e-4, -5.359409281510e-5]), 3.557809759613e-4),
    ]
};

#[test]
fn a_bouc_wen_joint_moves_as_shooting_finds() {
    for (law, hertz, expected, largest) in SHOT {
        let found = forced(&bouc_wen(law), hertz, 41, Complex64::from(LOAD));
        assert!((found.frequency_hz / hertz - 1.0).abs() < 1e-12);
        for (found, expected) in found.fundamental.iter().zip(expected) {
            let error = (found - expected).norm() / expected.norm();
            assert!(
                error < 1e-6,
                "{law:?} {hertz} Hz: {found} {expected} {error:.1e}"
            );
        }
        let error = (found.largest[0] / largest - 1.0).abs();
        assert!(error < 1e-5, "{law:?} {hertz} Hz: {error:.1e}");
    }
}

/// Under loads that are straight between the rows.
#[test]
fn laws_side_by_side_move_as_in_time() {
    const ROWS: usize = 1000;
    const PERIODS: usize = 150;
    let model = side_by_side();
    for hertz in [80.0, 95.0] {
        let step = 1.0 / (hertz * ROWS as f64);
        let load = LoadCourse {
            amplitude: LOAD,
            frequency_hz: Some(hertz),
            until_s: f64::INFINITY,
        };
        let duration = PERIODS as f64 / hertz;
        let (rows, _) = model
            .history(duration, step, &[Some(load)], &|_| ())
            .unwrap();
        // of the straight pieces of the sine: (sin x/x)² with x = π/N
        let x = std::f64::consts::PI / ROWS as f64;
        let of_pieces = (x.sin() / x).powi(2);
        // a sine is cos(ωt − π/2)
        let found = forced(&model, hertz, 31, Complex64::new(0.0, -LOAD * of_pieces));
        for (output, found) in found.fundamental.iter().enumerate() {
            let last = rows[rows.len() - ROWS..].iter();
            let terms = last.map(|row| {
                // columns: time, load, and of each output displacement and velocity
                Complex64::from_polar(row[2 + 2 * output], -TAU * hertz * row[0])
            });
            let expected: Complex64 = terms.sum::<Complex64>() * (2.0 / ROWS as f64);
            let error = (found - expected).norm() / expected.norm();
            assert!(error < 1e-5, "{hertz} Hz: {found} {expected} {error:.1e}");
        }
    }
}

/// Of the equations whose unknowns are these, each changed by a part of its scale.
fn assert_derivatives(curve: &dyn Curve, unknowns: &DVector<f64>) {
    const PART: f64 = 1e-5;
    let (residual, derivatives) = curve.at(unknowns).unwrap();
    let scale = curve.scale(unknowns);
    for column in 0..unknowns.len() {
        let at = |times: f64| {
            let mut own = unknowns.clone();
            own[column] += times * PART * scale[column];
            curve.at(&own).unwrap().0
        };
        let change = (at(-2.0) - at(-1.0) * 8.0 + at(1.0) * 8.0 - at(2.0)) / (12.0 * PART);
        for row in 0..residual.len() {
            let found = derivatives[(row, column)] * scale[column];
            // beside the row's largest change
            let sizes = (0..unknowns.len()).map(|own| (derivatives[(row, own)] * scale[own]).abs());
            let size = sizes.fold(0.0, f64::max);
            let error = (found - change[row]).abs() / size;
            assert!(
                error < 2e-6,
                "{row} {column}: {found} {} {error:.1e}",
                change[row]
            );
        }
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    for model in [bouc_wen([1.6, 0.7, 0.3]), side_by_side()] {
        let problem = Problem::of(&model, 5).unwrap();
        let size = problem.size();
        let motion = [7e-5, 2e-5, 4e-6, -6e-6, 2e-6, 1e-6];
        let mut unknowns = DVector::zeros(size + 1);
        unknowns.rows_mut(0, size).copy_from_slice(&motion);
        unknowns[size] = 560.0;
        let forced = Forced {
            problem: &problem,
            loads: DVector::from_element(1, Complex64::new(20.0, 7.0)),
        };
        assert_derivatives(&forced, &unknowns);
        unknowns[size] = 0.4;
        assert_derivatives(&Grown::new(&forced, 560.0), &unknowns);
        let free = Free {
            problem: &problem,
            output: 0,
        };
        let mut unknowns = DVector::zeros(size + 3);
        unknowns.rows_mut(0, size).copy_from_slice(&motion);
        unknowns[size] = 560.0;
        unknowns[size + 1] = 0.03;
        unknowns[size + 2] = 2e-4_f64.ln();
        assert_derivatives(&free, &unknowns);
    }
}

#[test]
fn harmonics_that_are_none_are_refused() {
    let found = side_by_side().forced_response(&[Complex64::ONE], [80.0, 81.0], 0, &|_| ());
    assert!(matches!(found, Err(AssemblyError::Harmonics(_))));
}
