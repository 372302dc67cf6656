//! A study and its lines as an experiment with systematic errors.

use bolted_joint_systematic::{
    Assembly, Computed, Entry, Experiment, JointShape, Measured, MeasuredFunctions, Places, Side,
    Structure,
};
use num_complex::Complex64;

use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::Section;

use super::super::assemble::{BeamAnew, masses_at, measured_labels};
use super::super::group;
use super::super::layout::Layout;
use super::super::lines::Lines;
use super::super::noise::{Floor, Levels, Of, Size};
use super::super::receptances::{MeasuredSubstructure, Receptances};
use super::super::study::{Study, Substructure};

/// The assemblies of `all`, which have both structures and the lines in common, with the number of each one's joint. `None` where
/// a structure's labels are not known.
pub(super) fn of<'a>(
    study: &'a Study,
    all: &'a [Lines],
    joints: &[usize],
    layout: &Layout,
    levels: Levels,
) -> Option<Experiment<'a>> {
    let lines = all.first()?;
    let entries = layout
        .places()
        .iter()
        .map(|place| place.all().collect())
        .collect();
    let dofs = lines.joint_dofs();
    let joint = JointShape {
        dofs,
        dofs_of_a_bolt: dofs / study.bolts.count(),
        entries,
    };
    let structures = [
        structure(study, Side::A, lines, levels, &joint)?,
        structure(study, Side::B, lines, levels, &joint)?,
    ];
    let of_a = known_masses(study, Side::A, lines).into_iter();
    let of_b = known_masses(study, Side::B, lines).into_iter();
    let of_b = of_b.map(|(dof, mass)| (dofs + dof, mass));
    let known_masses = of_a.chain(of_b).collect();
    let assemblies = all.iter().zip(joints);
    let assemblies = assemblies.map(|(lines, &joint)| Assembly {
        functions: assembly(study, lines, levels.assembly),
        joint,
    });
    let mut experiment = Experiment::new(angular(lines), joint, structures, assemblies.collect());
    experiment.known_masses = known_masses;
    experiment.points_on_a = study.points_on_a;
    Some(experiment)
}

/// The known masses at the joint's DOFs of a structure whose receptances here are without them.
fn known_masses(study: &Study, side: Side, lines: &Lines) -> Vec<(usize, f64)> {
    let [a, b] = lines.structures();
    let (substructure, receptances) = match side {
        Side::A => (&study.a, a),
        Side::B => (&study.b, b),
    };
    let is_computed_anew = matches!(substructure, Substructure::Beam { .. });
    match receptances {
        Receptances::Exact(_) if !is_computed_anew => Vec::new(),
        _ => masses_at(substructure.masses(), study.dofs_of_a_bolt()),
    }
}

/// The measured functions of the assembly, each on its own: reciprocity speaks for the channels' gains.
fn assembly(study: &Study, lines: &Lines, level: Size) -> MeasuredFunctions {
    let repeats = lines.repeats.as_ref().map_or(1, |repeats| repeats.count);
    let entry = |place: (usize, usize)| {
        let values: Vec<Complex64> = lines.assembly.iter().map(|matrix| matrix[place]).collect();
        let known = lines.relative_variance.as_ref().and_then(|known| {
            let index = lines
                .measured
                .iter()
                .position(|&measured| measured == place)?;
            known.get(index)
        });
        let own = || lines.floor(place) * f64::from(repeats).sqrt();
        let rotations = [place.0, place.1].map(|p| lines.points[p].direction().is_rotation());
        let floor = study.noise.floor(Of::Assembly, rotations, own);
        Entry {
            place,
            measurements: vec![place],
            variance: variances(&values, known.map(Vec::as_slice), (level, floor), repeats),
            values,
        }
    };
    MeasuredFunctions {
        is_translation: translations(&lines.points),
        positions_m: {
            let (of_b, of_a) = study.points_by_side();
            [positions_m(&study.b, of_b), positions_m(&study.a, of_a)].concat()
        },
        entries: lines.independent().into_iter().map(entry).collect(),
    }
}

/// Positions of points of a measured structure that all move across it; what moves along it tells no slope.
fn positions_m(structure: &Substructure, points: &[Dof]) -> Vec<Option<f64>> {
    let none = vec![None; points.len()];
    let (Substructure::Measured { positions_m, .. }, [first, _, ..]) = (structure, points) else {
        return none;
    };
    let is_alike = |point: &Dof| {
        let is_same = point.direction() == first.direction() && point.sign() == first.sign();
        is_same && point.direction().is_translation()
    };
    let positions = points.iter().map(|point| positions_m.get(point).copied());
    let positions: Vec<Option<f64>> = positions.collect();
    let is_distinct = (1..positions.len()).all(|i| !positions[..i].contains(&positions[i]));
    if is_distinct && points.iter().all(is_alike) && !positions.contains(&None) {
        positions
    } else {
        none
    }
}

fn variances(
    values: &[Complex64],
    known: Option<&[f64]>,
    (level, floor): (Size, Floor),
    count: u32,
) -> Vec<f64> {
    let of = |(line, value): (usize, &Complex64)| {
        let power = value.norm_sqr();
        let one = known.map_or_else(|| level.variance(power, floor), |known| known[line] * power);
        one / f64::from(count)
    };
    values.iter().enumerate().map(of).collect()
}

fn translations(labels: &[Dof]) -> Vec<bool> {
    labels
        .iter()
        .map(|label| !label.direction().is_rotation())
        .collect()
}

/// Labels of a measured structure in the order of its functions.
pub(super) fn labels(study: &Study, side: Side) -> Vec<Dof> {
    let (substructure, points) = of_side(study, side);
    measured_labels(substructure, study.dofs_of_a_bolt(), points)
}

/// A structure and the assembly's points on it.
fn of_side(study: &Study, side: Side) -> (&Substructure, &[Dof]) {
    let (of_b, of_a) = study.points_by_side();
    match side {
        Side::A => (&study.a, of_a),
        Side::B => (&study.b, of_b),
    }
}

fn structure<'a>(
    study: &'a Study,
    side: Side,
    lines: &'a Lines,
    levels: Levels,
    joint: &JointShape,
) -> Option<Structure<'a>> {
    let [a, b] = lines.structures();
    let (receptances, of) = match side {
        Side::A => (a, group::Side::A),
        Side::B => (b, group::Side::B),
    };
    let (substructure, points) = of_side(study, side);
    match (substructure, receptances) {
        (Substructure::Beam { .. }, _) => {
            let dofs = study.dofs_of_a_bolt();
            let compute = BeamAnew::new(substructure, dofs, points, &lines.frequency_hz)?;
            Some(Structure::Computed(Computed {
                compute: Box::new(compute),
            }))
        }
        (_, Receptances::Exact(matrices)) => Some(Structure::Exact(matrices.clone())),
        (_, Receptances::Measured(measured)) => Some(Structure::Measured(Box::new(
            Measured::new(
                functions(
                    measured.as_measured(),
                    &labels(study, side),
                    &|rotations, own| {
                        let of = Of::Substructure(of);
                        (levels.of(of), study.noise.floor(of, rotations, || own))
                    },
                )?,
                measured.transformation().clone(),
                substructure.rotation_lost(study.dofs_of_a_bolt()),
                substructure.section().map(Section::bending_stiffness_n_m2),
                joint,
            )
            .with_places(
                Places {
                    bolts_m: substructure.bolts_m(),
                    bolts_among_points_m: bolts_among_points(study, side, measured, joint),
                    points_m: positions_m(substructure, points),
                },
                &angular(lines),
                joint,
            ),
        ))),
    }
}

/// Lines, rad/s.
fn angular(lines: &Lines) -> Vec<f64> {
    let hz = lines.frequency_hz.iter();
    hz.map(|hz| std::f64::consts::TAU * hz).collect()
}

/// Positions of the bolts whose translations are along those of the points on this structure.
fn bolts_among_points(
    study: &Study,
    side: Side,
    measured: &MeasuredSubstructure,
    joint: &JointShape,
) -> Vec<Option<f64>> {
    let (substructure, points) = of_side(study, side);
    let labels = labels(study, side);
    let Some(point) = points.first() else {
        return Vec::new();
    };
    let transformation = measured.transformation();
    let is_along = |bolt: usize| {
        let row = transformation.row(bolt * joint.dofs_of_a_bolt);
        let mut its = labels
            .iter()
            .zip(row.iter())
            .filter(|(_, weight)| **weight != 0.0);
        its.all(|(label, _)| label.direction() == point.direction() && label.sign() == point.sign())
    };
    let bolts = substructure.bolts_m().into_iter().enumerate();
    bolts
        .map(|(bolt, x_m)| x_m.filter(|_| is_along(bolt)))
        .collect()
}

/// The upper triangle of U, reciprocals averaged.
fn functions(
    measured: &MeasuredSubstructure,
    labels: &[Dof],
    noise: &dyn Fn([bool; 2], f64) -> (Size, Floor),
) -> Option<MeasuredFunctions> {
    let count = measured.transformation().ncols();
    if labels.len() != count {
        return None;
    }
    let places = (0..count).flat_map(|column| (0..=column).map(move |row| (row, column)));
    let entry = |place: (usize, usize)| {
        let values = measured.function(place.0, place.1).as_ref().clone();
        let own: Vec<usize> = (0..measured.measured().len())
            .filter(|&index| {
                let (p, q) = measured.measured()[index];
                (p.min(q), p.max(q)) == place
            })
            .collect();
        let known: Option<Vec<f64>> = measured.relative_variance().map(|known| {
            let mean = |line: usize| {
                own.iter().map(|&index| known[index][line]).sum::<f64>() / own.len() as f64
            };
            (0..values.len()).map(mean).collect()
        });
        let known = known.filter(|_| !own.is_empty());
        let count = own.len().max(1) as u32;
        let level = noise(
            [place.0, place.1].map(|label| measured.is_rotation(label)),
            measured.floor(place.0, place.1) * f64::from(count).sqrt(),
        );
        Entry {
            place,
            measurements: own
                .iter()
                .map(|&index| measured.measured()[index])
                .collect(),
            variance: variances(&values, known.as_deref(), level, count),
            values,
        }
    };
    Some(MeasuredFunctions {
        is_translation: translations(labels),
        positions_m: Vec::new(),
        entries: places.map(entry).collect(),
    })
}
