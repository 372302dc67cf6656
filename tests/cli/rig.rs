//! Two rigid bodies on springs, joined by a known joint: every receptance follows from a small matrix of dynamic stiffness.
//!
//! Nothing of the program under test computes here: the assembly is solved as one structure, not coupled from two, and the
//! universal files are written by this module.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nalgebra::{DMatrix, Matrix2, Matrix4, RowVector2, matrix, vector};
use num_complex::Complex64;

use crate::bench::Bench;

/// Distance between the points of A, m.
const SPACING: f64 = 0.03;
/// Lines at 2, 5, … 200 Hz.
pub(crate) const FIRST_HZ: f64 = 2.0;
pub(crate) const STEP_HZ: f64 = 3.0;
pub(crate) const LINES: usize = 67;

/// The even axis of these lines as record 7 states it.
pub(crate) const AXIS: &str = "    2.00000e0    3.00000e0";

/// K and C of the joint on y and θ.
#[derive(Clone, Copy)]
pub(crate) struct Joint {
    pub(crate) stiffness: Matrix2<f64>,
    pub(crate) damping: Matrix2<f64>,
}

/// A joint with every entry.
pub(crate) const FULL: Joint = Joint {
    stiffness: matrix![8e4, 600.0; 600.0, 120.0],
    damping: matrix![6.0, 0.05; 0.05, 0.02],
};
/// Active, as Tol's Table 5.4 is: coupling in the damping without damping of the rotation.
pub(crate) const ACTIVE: Joint = Joint {
    stiffness: FULL.stiffness,
    damping: matrix![6.0, 0.3; 0.3, 0.005],
};
/// Without coupling of y and θ.
pub(crate) const DIAGONAL: Joint = Joint {
    stiffness: matrix![8e4, 0.0; 0.0, 120.0],
    damping: matrix![6.0, 0.0; 0.0, 0.02],
};
/// With a hinge in place of the rotational stiffness.
pub(crate) const TRANSLATION: Joint = Joint {
    stiffness: matrix![8e4, 0.0; 0.0, 0.0],
    damping: matrix![6.0, 0.0; 0.0, 0.0],
};

impl Joint {
    /// The same joint with everything multiplied.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self {
            stiffness: self.stiffness * factor,
            damping: self.damping * factor,
        }
    }

    /// The largest error of `stiffness` and `damping` in a file, each entry relative to √(m_ii m_jj) of its matrix.
    pub(crate) fn error_of(&self, found: &serde_json::Value) -> f64 {
        let mut largest: f64 = 0.0;
        for (key, exact) in [("stiffness", self.stiffness), ("damping", self.damping)] {
            let found = square(&found[key]);
            for (i, j) in (0..4).map(|place| (place / 2, place % 2)) {
                if let Some(found) = found.get((i, j)) {
                    let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
                    largest = largest.max((found - exact[(i, j)]).abs() / scale);
                }
            }
        }
        largest
    }

    /// The joint file of the bench has this joint.
    #[track_caller]
    pub(crate) fn is_in(&self, bench: &Bench) {
        let error = self.error_of(&bench.json("o.joint.json")["joint"]);
        assert!(error < 1e-6, "{error}");
    }
}

/// A rigid body on a support at its centre, by the coordinates y and θ of that centre.
struct Body {
    inertia: [f64; 2],
    stiffness: [f64; 2],
    damping: [f64; 2],
}

const A: Body = Body {
    inertia: [1.2, 8e-3],
    stiffness: [4e4, 300.0],
    damping: [3.0, 0.01],
};
const B: Body = Body {
    inertia: [0.5, 3e-3],
    stiffness: [500.0, 5.0],
    damping: [0.5, 2e-3],
};

impl Body {
    fn dynamic_stiffness(&self, omega: f64) -> Matrix2<Complex64> {
        // Z = k − ω² m + jωc
        let z = |i: usize| {
            Complex64::new(
                self.stiffness[i] - omega * omega * self.inertia[i],
                omega * self.damping[i],
            )
        };
        Matrix2::from_diagonal(&vector![z(0), z(1)])
    }
}

/// What a function is measured as, with the data type of the standard.
#[derive(Clone, Copy)]
pub(crate) enum Quantity {
    Receptance,
    Mobility,
    Accelerance,
}

impl Quantity {
    fn data_type(self) -> u8 {
        match self {
            Self::Receptance => 8,
            Self::Mobility => 11,
            Self::Accelerance => 12,
        }
    }

    fn of_receptance(self, receptance: Complex64, omega: f64) -> Complex64 {
        let s = Complex64::new(0.0, omega);
        match self {
            Self::Receptance => receptance,
            Self::Mobility => s * receptance,
            Self::Accelerance => s * s * receptance,
        }
    }
}

/// A measured degree of freedom: its node, and its motion by those of the body's centre.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    pub(crate) node: u32,
    rotation: bool,
    row: RowVector2<f64>,
}

/// Translation at a distance (m) from the centre: y + xθ.
fn translation(node: u32, x_m: f64) -> Point {
    Point {
        node,
        rotation: false,
        row: RowVector2::new(1.0, x_m),
    }
}

/// Points one spacing apart, three for one bolt and five for two: the first is at point 2, the second at 4.
pub(crate) fn points_of_a() -> Vec<Point> {
    (0..5)
        .map(|step| translation(step + 1, SPACING * (1.0 - f64::from(step))))
        .collect()
}

/// A bolt: its joint, and where it holds A and B, m from their centres.
#[derive(Clone, Copy)]
pub(crate) struct Bolt {
    pub(crate) joint: Joint,
    on_a_m: f64,
    on_b_m: f64,
}

/// The bolt at point 2 of A and 20 of B.
pub(crate) fn first_bolt(joint: Joint) -> Bolt {
    Bolt {
        joint,
        on_a_m: 0.0,
        on_b_m: JOINT_ON_B_M,
    }
}

/// The bolt at point 4 of A and 30 of B.
pub(crate) fn second_bolt(joint: Joint) -> Bolt {
    Bolt {
        joint,
        on_a_m: -2.0 * SPACING,
        on_b_m: JOINT_ON_B_M - 2.0 * SPACING,
    }
}

/// Where the joint holds B.
const JOINT_ON_B_M: f64 = -0.1;

/// Translation and rotation where the bolts hold B.
fn joints_of_b() -> Vec<Point> {
    let at = |node, x_m| {
        let theta = Point {
            node,
            rotation: true,
            row: RowVector2::new(0.0, 1.0),
        };
        [translation(node, x_m), theta]
    };
    [at(20, JOINT_ON_B_M), at(30, JOINT_ON_B_M - 2.0 * SPACING)].concat()
}

pub(crate) fn points_of_b() -> Vec<Point> {
    vec![
        translation(21, 0.02),
        translation(22, 0.06),
        translation(23, 0.1),
    ]
}

/// Receptances between `points` of a body that moves by H (2×2) about its centre.
pub(crate) fn receptance(h: &Matrix2<Complex64>, response: Point, reference: Point) -> Complex64 {
    let (left, right) = (
        response.row.map(Complex64::from),
        reference.row.map(Complex64::from),
    );
    (left * h * right.transpose())[(0, 0)]
}

/// H of B's centre in the assembly: each joint's load acts on both bodies.
pub(crate) fn assembled(bolts: &[Bolt], omega: f64) -> Matrix2<Complex64> {
    let mut z = Matrix4::zeros();
    z.fixed_view_mut::<2, 2>(0, 0)
        .copy_from(&A.dynamic_stiffness(omega));
    z.fixed_view_mut::<2, 2>(2, 2)
        .copy_from(&B.dynamic_stiffness(omega));
    for bolt in bolts {
        let joint = &bolt.joint;
        let k = joint
            .stiffness
            .zip_map(&joint.damping, |k, c| Complex64::new(k, omega * c));
        // Relative motion of the joint: x_a − x_b = G (y_A, θ_A, y_B, θ_B)
        let g =
            matrix![1.0, bolt.on_a_m, -1.0, -bolt.on_b_m; 0.0, 1.0, 0.0, -1.0].map(Complex64::from);
        z += g.transpose() * k * g;
    }
    let h = z.try_inverse().unwrap();
    h.fixed_view::<2, 2>(2, 2).into_owned()
}

/// A universal file of all pairs of `points`.
fn universal_file(
    points: &[Point],
    quantity: Quantity,
    h: impl Fn(f64) -> Matrix2<Complex64>,
) -> String {
    let omegas: Vec<f64> = (0..LINES)
        .map(|line| TAU * (FIRST_HZ + STEP_HZ * line as f64))
        .collect();
    let motions: Vec<Matrix2<Complex64>> = omegas.iter().map(|&omega| h(omega)).collect();
    let mut text = String::new();
    for &response in points {
        for &reference in points {
            let values: Vec<Complex64> = omegas
                .iter()
                .zip(&motions)
                .map(|(&omega, h)| {
                    quantity.of_receptance(receptance(h, response, reference), omega)
                })
                .collect();
            text += &function(response, reference, quantity, &values);
        }
    }
    text
}

/// One data set 58: complex values in double precision, even abscissa.
pub(crate) fn function(
    response: Point,
    reference: Point,
    quantity: Quantity,
    values: &[Complex64],
) -> String {
    let direction = |point: Point| if point.rotation { 6 } else { 2 };
    let mut text = "    -1\n    58\nNONE\nNONE\nNONE\nNONE\nNONE\n".to_owned();
    let _ = write!(text, "{:>5}{:>10}{:>5}{:>10}", 4, 0, 0, 0);
    for point in [response, reference] {
        let _ = write!(
            text,
            " {:<10}{:>10}{:>4}",
            "NONE",
            point.node,
            direction(point)
        );
    }
    let _ = writeln!(
        text,
        "\n{:>10}{:>10}{:>10}{AXIS}{:>13.5e}",
        6,
        values.len(),
        1,
        0.0
    );
    for data_type in [18, quantity.data_type(), 13, 0] {
        let _ = writeln!(
            text,
            "{data_type:>10}{:>5}{:>5}{:>5} {:<20} {:<20}",
            0, 0, 0, "NONE", "NONE"
        );
    }
    for pair in values.chunks(2) {
        for value in pair {
            let _ = write!(text, "{:>20.12e}{:>20.12e}", value.re, value.im);
        }
        text.push('\n');
    }
    text + "    -1\n"
}

/// H of A's centre.
pub(crate) fn motion_of_a(omega: f64) -> Matrix2<Complex64> {
    A.dynamic_stiffness(omega).try_inverse().unwrap()
}

/// Writes `a.uff`, `b.uff` and `c.uff`: what is measured on A, on B and on the assembly with one bolt.
pub(crate) fn measure(bench: &Bench, joint: &Joint, quantities: [Quantity; 3]) {
    measure_bolted(bench, &[first_bolt(*joint)], quantities);
}

/// The same with these bolts.
pub(crate) fn measure_bolted(bench: &Bench, bolts: &[Bolt], quantities: [Quantity; 3]) {
    let [a, b, c] = quantities;
    let of_body = |body: &'static Body| {
        move |omega: f64| body.dynamic_stiffness(omega).try_inverse().unwrap()
    };
    let (mut on_a, mut joints_of_b) = (points_of_a(), joints_of_b());
    if bolts.len() == 1 {
        on_a.truncate(3);
        joints_of_b.truncate(2);
    }
    bench.write("a.uff", universal_file(&on_a, a, of_body(&A)));
    let on_b = [joints_of_b, points_of_b()].concat();
    bench.write("b.uff", universal_file(&on_b, b, of_body(&B)));
    let assembly = |omega: f64| assembled(bolts, omega);
    bench.write("c.uff", universal_file(&points_of_b(), c, assembly));
}

/// The study of these measurements with a joint model and points of the assembly.
pub(crate) fn study(model: &str, points: &[u32]) -> String {
    let points: Vec<String> = points.iter().map(|node| format!("\"{node}:+Y\"")).collect();
    format!(
        r#"method = "frf-decoupling"
budget = "none"
name = "two bodies"

[a]
frf = "a.uff"
joint = {{ y = "2:+Y", theta = {{ points = ["3:+Y", "2:+Y", "1:+Y"], spacing = {SPACING} }} }}

[b]
frf = "b.uff"
joint = {{ y = "20:+Y", theta = "20:+RZ" }}

[assembly]
frf = "c.uff"
points = [{}]

[joint]
model = "{model}"

[frequency]
from = 2
to = 200
"#,
        points.join(", ")
    )
}

/// A bench with everything for an identification of `joint`: files of receptances, and `study.toml`.
pub(crate) fn of(joint: &Joint, model: &str) -> Bench {
    let bench = Bench::new();
    measure(&bench, joint, [Quantity::Receptance; 3]);
    bench.write("study.toml", study(model, &[21, 22, 23]));
    bench
}

/// The bench of `FULL`.
pub(crate) fn ready() -> Bench {
    of(&FULL, "full")
}

/// Of a universal file the functions for whose place `keep` holds.
pub(crate) fn functions_of(text: &str, keep: impl Fn(usize) -> bool) -> String {
    let begin = "    -1\n    58\n";
    let functions = text.split(begin).skip(1).enumerate();
    functions
        .filter(|(place, _)| keep(*place))
        .map(|(_, function)| format!("{begin}{function}"))
        .collect()
}

/// Modes of A at points 1, 2 and 3: it moves in y and turns, each on its own. The shapes are multiplied.
pub(crate) fn modes_of_a(factor: f64) -> String {
    let mut text = "points = [\"1:+Y\", \"2:+Y\", \"3:+Y\"]\n".to_owned();
    for motion in 0..2 {
        let (inertia, stiffness) = (A.inertia[motion], A.stiffness[motion]);
        let natural = (stiffness / inertia).sqrt();
        let ratio = A.damping[motion] / (2.0 * (stiffness * inertia).sqrt());
        let shape = points_of_a()
            .iter()
            .take(3)
            .map(|point| format!("[{}, 0.0]", factor * point.row[motion] / inertia.sqrt()))
            .collect::<Vec<_>>()
            .join(", ");
        let _ = write!(
            text,
            "[[mode]]\nfrequency_hz = {}\ndamping_ratio = {ratio}\nshape = [{shape}]\n",
            natural / TAU
        );
    }
    text
}

/// The matrix at `key` of a joint file.
pub(crate) fn matrix_of(joint_file: &serde_json::Value, key: &str) -> DMatrix<f64> {
    square(&joint_file["joint"][key])
}

fn square(rows: &serde_json::Value) -> DMatrix<f64> {
    let size = rows.as_array().unwrap().len();
    DMatrix::from_fn(size, size, |i, j| rows[i][j].as_f64().unwrap())
}
