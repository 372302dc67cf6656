//! The reference run of an element: motions of both sides, held at levels, and the loads in the middle of each level.

use bolted_joint_dynamics::Motion;

use super::{Laws, Names, ReferenceRun, entry, stimulus, table};

/// Communication step (s) where nothing says what frequencies matter.
const STEP_S: f64 = 1e-4;

/// Communication steps at each level, an even number, so that there is a communication point in its middle.
const STEPS_A_LEVEL: usize = 4;

const LEVELS: usize = 50;

/// What the last digit of the files leaves open, and nothing else: the element has no steps of its own.
const TOLERANCE: f64 = 1e-11;

pub(super) fn run<const D: usize>(
    laws: &Laws<D>,
    step_s: Option<f64>,
    names: Names,
) -> ReferenceRun {
    let step_s = step_s.unwrap_or(STEP_S);
    let amplitude = stimulus::relative_motion(laws.nominal());
    let time = |step: usize| step as f64 * step_s;
    let level_s = STEPS_A_LEVEL as f64 * step_s;
    let motion = |on_b: bool, level: usize| {
        // Half of the largest relative motion on each side.
        let shape = |i| stimulus::shape(i, on_b, (level + 1) as f64);
        Motion {
            displacement: std::array::from_fn(|i| {
                stimulus::rounded(0.5 * amplitude[i] * shape(i).0)
            }),
            velocity: std::array::from_fn(|i| {
                stimulus::rounded(0.5 * amplitude[i] * shape(i).1 / level_s)
            }),
        }
    };
    let sides: Vec<[Motion<D>; 2]> = (0..LEVELS)
        .map(|level| [motion(false, level), motion(true, level)])
        .collect();
    let input = |[a, b]: &[Motion<D>; 2], name: &str| {
        [("a", a), ("b", b)]
            .iter()
            .find_map(|(side, motion)| {
                let quantities = [
                    ("y", "theta", &motion.displacement),
                    ("v", "omega", &motion.velocity),
                ];
                entry(name, side, quantities)
            })
            .unwrap_or_default()
    };
    let inputs = sides.iter().enumerate().flat_map(|(level, sides)| {
        // Constant from one level's beginning to the next.
        [level, level + 1].map(move |edge| {
            (time(STEPS_A_LEVEL * edge), move |name: &str| match name {
                "preload" => laws.preload_n_m(level),
                _ => input(sides, name),
            })
        })
    });
    let outputs = sides.iter().enumerate().map(|(level, sides)| {
        let middle = time(STEPS_A_LEVEL * level + STEPS_A_LEVEL / 2);
        let relative = sides[0].relative_to(&sides[1]);
        let law = laws.at(level);
        let on_b = law.load_on_b(&relative);
        let on_a = on_b.map(|load| -load);
        (middle, move |name: &str| match name {
            "energy.stored" => law.stored_energy(&relative.displacement),
            "power.dissipated" => law.dissipated_power(&relative),
            // the preload is held
            "power.preload" => 0.0,
            _ => [("a", &on_a), ("b", &on_b), ("joint", &on_b)]
                .iter()
                .find_map(|(side, load)| entry(name, side, [("F", "M", load), ("F", "M", load)]))
                .unwrap_or_default(),
        })
    });
    ReferenceRun {
        step_s,
        steps: STEPS_A_LEVEL * LEVELS,
        inputs: table(names.inputs, inputs),
        outputs: table(names.outputs, outputs),
        tolerance: TOLERANCE,
    }
}
