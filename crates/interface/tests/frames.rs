//! Fills the project's own frames with DOFs and laws that do not exist, and damages the frames: what comes out must be valid, or
//! the problem named.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

use bolted_joint_dynamics::{
    Dof, DofKind,
    law::{
        ActsOn, Declaration, Parameter, Quantity, Range, Remembered, RememberedAs, Span, UnitRule,
    },
};
use bolted_joint_interface::{
    Expanded, Filling, Frames, Interface, InterfaceError, InterfaceProblem, Interfaces, Joints,
    Role, Rows,
};

/// A sum of spring and slider, with a spring of second order, which has a unit that nothing else has.
const SLIDER: Declaration = Declaration {
    name: "slider",
    summary: "A spring in series with a slider",
    parameters: &[
        Parameter {
            symbol: "slip_force",
            key: "slip_force",
            span: Span::Dof,
            unit: UnitRule::LoadPer {
                displacement: 0,
                seconds: 0,
            },
            range: Range::NotNegative,
            quantity: Quantity {
                name: "SlipLoad",
                nominal: [100.0, 10.0, 1.0],
                start: [0.0; 3],
            },
            description: "{load} at which the joint slips in {motion}",
            acts_on: ActsOn::SPRING,
            grows_with_preload: false,
        },
        Parameter {
            symbol: "q",
            key: "quadratic",
            span: Span::Matrix("between {motion} and {other_motion}"),
            unit: UnitRule::LoadPer {
                displacement: 2,
                seconds: 1,
            },
            range: Range::Any,
            quantity: Quantity {
                name: "Odd",
                nominal: [1e9, 1e5, 1e3],
                start: [1.0, 0.5, 0.25],
            },
            description: "of {motion}",
            acts_on: ActsOn::DAMPER,
            grows_with_preload: false,
        },
    ],
    memory: &[Remembered {
        symbol: "slip",
        quantity: RememberedAs::Displacement,
        description: "Where the slider stands in {motion}",
        rate: None,
    }],
    hidden_memory: 3,
    at_most: 1,
    number: 1,
};

/// The project's DOFs, another translation, and one with the displacement's name of the first but another rate and load.
fn dofs() -> Vec<Dof> {
    let mut dofs = Filling::PRESENT.dofs.to_vec();
    dofs.push(Dof {
        name: "w",
        symbol: "w",
        rate: "vw",
        acceleration: "aw",
        load: "Fw",
        inertia: "mw",
        kind: DofKind::Translation,
    });
    dofs.push(Dof {
        rate: "vs",
        acceleration: "as",
        load: "Fs",
        ..Filling::PRESENT.dofs[0]
    });
    dofs
}

/// Where the first and the second of these stand.
const W: usize = Filling::PRESENT.dofs.len();
const TWIN: usize = W + 1;

/// The project's sets of DOFs and another.
fn and_set(own: &'static [usize]) -> Vec<&'static [usize]> {
    let mut sets = Filling::PRESENT.dof_sets.to_vec();
    sets.push(own);
    sets
}

/// What the project has and the above, as far as `dofs` go.
fn with_more<T>(dofs: &[Dof], sets: &[&[usize]], test: impl FnOnce(&Filling<'_>) -> T) -> T {
    let mut laws = Filling::PRESENT.laws.to_vec();
    laws.push(SLIDER);
    test(&Filling {
        dofs,
        dof_sets: sets,
        laws: &laws,
    })
}

/// Whether the variable is of the row or of the law.
fn is_new(name: &str) -> bool {
    name.ends_with('w') || name.contains("slip") || name.contains(".q_")
}

fn names(interface: &Interface, expanded: &Expanded, rows: Rows, joint: Joints) -> Vec<String> {
    let variables = interface.variables.iter();
    variables
        .filter(|variable| {
            let scope = expanded.scope(&variable.name).unwrap();
            scope.includes(rows, joint)
        })
        .map(|variable| variable.name.clone())
        .collect()
}

#[test]
fn a_row_and_a_law_more_give_all_that_belongs_to_them() {
    with_more(&dofs()[..=W], &and_set(&[0, 1, W]), |filling| {
        let interfaces = Interfaces::new(&Frames::PRESENT, filling).unwrap();
        let [element, lap] = Expanded::new(&Frames::PRESENT, filling).unwrap();
        // what there was keeps its reference
        for (now, before) in [
            (&interfaces.lap, Interfaces::present().unwrap().lap),
            (&interfaces.element, Interfaces::present().unwrap().element),
        ] {
            for variable in &before.variables {
                let same = now.variable(&variable.name).unwrap();
                assert_eq!(same.reference, variable.reference, "{}", variable.name);
            }
        }
        // an element that has them
        let all = Rows::of(&[0, 1, W]);
        let law = filling.laws.len() - 1;
        let new: Vec<String> = names(
            &interfaces.element,
            &element,
            all,
            Joints::with_memory_of(law),
        )
        .into_iter()
        .filter(|name| is_new(name))
        .collect();
        let expected = "a.w a.vw b.w b.vw a.Fw b.Fw joint.Fw joint.k_yw joint.k_thetaw joint.k_ww joint.c_yw \
                        joint.c_thetaw joint.c_ww joint.k3_w joint.k5_w joint.k7_w joint.c2_w joint.c4_w \
                        joint.slip_force_y joint.slip_force_theta joint.slip_force_w joint.q_yy \
                        joint.q_ytheta joint.q_yw joint.q_thetatheta joint.q_thetaw joint.q_ww \
                        joint.escape_amplitude_w joint.slip_y joint.slip_theta joint.slip_w joint.turning_w \
                        joint.ahead_w";
        assert_eq!(new.join(" "), expected);
        // joints of other kinds have neither the law nor the row
        for (rows, joint) in [
            (Rows::of(&[0, 1]), Joints::CONSTANT),
            (Rows::of(&[0]), Joints::OVER_PRELOAD),
        ] {
            let names = names(&interfaces.lap, &lap, rows, joint);
            assert!(!names.iter().any(|name| is_new(name)), "{names:?}");
        }
        let slip = interfaces.lap.variable("joint.slip_theta").unwrap();
        assert_eq!(slip.role, Role::Output);
        assert_eq!(slip.unit, "rad");
        assert_eq!(slip.description, "Where the slider stands in rotation");
        for (name, unit, start) in [
            ("joint.slip_force_y", "N", 0.0),
            ("joint.slip_force_theta", "N.m", 0.0),
            ("joint.q_yy", "N.s/m2", 1.0),
            ("joint.q_ytheta", "N.s/rad2", 0.5),
            ("joint.q_thetaw", "N.s/rad2", 0.5),
            ("joint.q_thetatheta", "N.m.s/rad2", 0.25),
        ] {
            let variable = interfaces.element.variable(name).unwrap();
            assert_eq!((&*variable.unit, variable.start), (unit, Some(start)));
        }
        // defined once, with their exponents
        for text in [
            "<Unit name=\"N.s/m2\">\n      <BaseUnit kg=\"1\" m=\"-1\" s=\"-1\"/>\n    </Unit>",
            "<Unit name=\"N.m.s/rad2\">\n      <BaseUnit kg=\"1\" m=\"2\" s=\"-1\" rad=\"-2\"/>\n    </Unit>",
            "<Float64Type name=\"CouplingOdd\" quantity=\"CouplingOdd\" unit=\"N.s/rad2\" nominal=\"100000\"/>",
            "<Float64Type name=\"RotationalSlipLoad\" quantity=\"RotationalSlipLoad\" unit=\"N.m\" min=\"0\" nominal=\"1\"/>",
        ] {
            assert_eq!(element.xml.matches(text).count(), 1, "{text}");
        }
    });
}

#[test]
fn a_load_depends_on_its_own_entries_and_every_motion() {
    with_more(&dofs()[..=W], &and_set(&[0, 1, W]), |filling| {
        let interfaces = Interfaces::new(&Frames::PRESENT, filling).unwrap();
        let [element, _] = Expanded::new(&Frames::PRESENT, filling).unwrap();
        let reference = |name| interfaces.element.variable(name).unwrap().reference;
        let line = format!("<Output valueReference=\"{}\"", reference("joint.Fw"));
        let line = element.xml.lines().find(|text| text.contains(&line));
        let lists: Vec<&str> = line.unwrap().split('"').collect();
        let kinds: Vec<(u32, &str)> = lists[3]
            .split(' ')
            .map(|number| number.parse().unwrap())
            .zip(lists[5].split(' '))
            .collect();
        let kind = |name| {
            let reference = reference(name);
            let found = kinds.iter().find(|(number, _)| *number == reference);
            found.map(|(_, kind)| *kind)
        };
        for (name, expected) in [
            ("a.w", Some("dependent")),
            ("b.vw", Some("dependent")),
            ("a.y", Some("tunable")),
            ("b.omega", Some("tunable")),
            ("joint.k_ww", Some("dependent")),
            ("joint.k_thetaw", Some("dependent")),
            ("joint.c2_w", Some("dependent")),
            ("joint.slip_force_w", Some("dependent")),
            ("preload", Some("dependent")),
            ("joint.k_yy", None),
            ("joint.slip_force_y", None),
        ] {
            assert_eq!(kind(name), expected, "{name}");
        }
        assert!(kinds.is_sorted_by_key(|(number, _)| *number));
    });
}

#[test]
fn a_name_of_two_rows_is_one_variable_of_both() {
    with_more(&dofs(), &and_set(&[W, TWIN]), |filling| {
        let interfaces = Interfaces::new(&Frames::PRESENT, filling).unwrap();
        let [_, lap] = Expanded::new(&Frames::PRESENT, filling).unwrap();
        let scope = lap.scope("a.y").unwrap();
        for (rows, has) in [(&[0][..], true), (&[W, TWIN], true), (&[W], false)] {
            assert_eq!(scope.includes(Rows::of(rows), Joints::CONSTANT), has);
        }
        let joint = names(
            &interfaces.lap,
            &lap,
            Rows::of(&[W, TWIN]),
            Joints::OVER_PRELOAD,
        );
        assert!(joint.contains(&"a.vs".to_owned()) && !joint.contains(&"a.v".to_owned()));
        // no joint has them at the same time
        assert_eq!(lap.scope("joint.k_thetaw"), None);
    });
}

/// InterfaceProblem that the frames are refused with after replacing the first `from` of the lap's by `to`.
fn problem(from: &str, to: &str) -> InterfaceProblem {
    assert!(Frames::PRESENT.lap.contains(from), "{from}");
    let lap = Frames::PRESENT.lap.replacen(from, to, 1);
    let frames = Frames {
        lap: &lap,
        ..Frames::PRESENT
    };
    match Expanded::new(&frames, &Filling::PRESENT) {
        Err(InterfaceError::Inconsistent { file, problem }) => {
            assert_eq!(file, "lap.xml");
            problem
        }
        other => panic!("replacing {from} by {to} gave {other:?}"),
    }
}

macro_rules! refused {
    ($name:ident: $from:expr => $to:expr, $pattern:pat $(if $guard:expr)?) => {
        #[test]
        fn $name() {
            let problem = problem($from, $to);
            assert!(matches!(&problem, $pattern $(if $guard)?), "{problem}");
        }
    };
}

refused!(element_on_two_lines: r#"<Float64 name="time" "# => "<Float64 name=\"time\"\n", InterfaceProblem::NotALine { tag: "Float64", .. });
refused!(no_name: r#"<Float64 name="time" "# => "<Float64 ", InterfaceProblem::NoName { .. });
refused!(each_what: r#"each="memory""# => r#"each="law""#, InterfaceProblem::Word { attribute: "each", found, .. } if found == "law");
refused!(only_what: r#"only="over_preload""# => r#"only="preload""#, InterfaceProblem::Word { attribute: "only", found, .. } if found == "preload");
refused!(unknown_placeholder: "a.{rate}" => "a.{velocity}", InterfaceProblem::Placeholder { placeholder, .. } if placeholder == "velocity");
refused!(placeholder_of_no_dof: r#"each="dof" name="a.{rate}""# => r#"name="a.{rate}""#, InterfaceProblem::Placeholder { placeholder, .. } if placeholder == "rate");
refused!(placeholder_in_a_text: "{Rate} of body a" => "{Speed} of body a", InterfaceProblem::Placeholder { placeholder, .. } if placeholder == "Speed");
refused!(placeholder_left_open: "{Rate} of body a" => "{Rate of body a", InterfaceProblem::Placeholder { .. });
refused!(unknown_effect: "@dissipated_power" => "@heat", InterfaceProblem::Placeholder { placeholder, .. } if placeholder == "@heat");
refused!(load_of_no_dof: "@dissipated_power" => "@load", InterfaceProblem::Placeholder { placeholder, .. } if placeholder == "@load");
refused!(other_of_no_dof: "@dissipated_power" => "a.{rate:other}", InterfaceProblem::Placeholder { placeholder, .. } if placeholder == "rate:other");
refused!(depends_on_nothing_declared: r#"constant="energy.supplied""# => r#"constant="energy.taken""#, InterfaceProblem::UndefinedName { name, .. } if name == "energy.taken");
refused!(derivative_of_nothing_declared: r#"derivative="energy.supplied""# => r#"derivative="energy.taken""#, InterfaceProblem::UndefinedName { name, .. } if name == "energy.taken");
refused!(unknown_without_dependencies: r#" constant="energy.supplied""# => "", InterfaceProblem::NothingDependedOn { name, .. } if name == "energy.supplied");
refused!(type_of_another_unit: r#"quantity="CubicStiffness" unit="N/m3""# => r#"quantity="CubicStiffness" unit="N/m5""#,
    InterfaceProblem::TypeUnit { declared_type, unit, of_law } if declared_type == "CubicStiffness" && unit == "N/m5" && of_law == "N/m3");

#[test]
fn a_problem_tells_its_line() {
    let line = Frames::PRESENT
        .lap
        .lines()
        .position(|line| line.contains("{Rate} of body a"));
    let line = line.unwrap() + 1;
    let message = problem("{Rate} of body a", "{Speed} of body a").to_string();
    assert_eq!(
        message,
        format!("line {line}: {{Speed}} stands for nothing there; is the line one for each DOF?")
    );
}

#[test]
fn a_reference_twice_is_refused() {
    let value_references = format!("{}time\n", Frames::PRESENT.value_references);
    let frames = Frames {
        value_references: &value_references,
        ..Frames::PRESENT
    };
    let error = Expanded::new(&frames, &Filling::PRESENT).unwrap_err();
    assert_eq!(
        error.to_string(),
        "value-references.txt: \"time\" has two value references; keep the first"
    );
}
