//! Damages the project's own model descriptions, as they come from their frames, one way at a time: each damage must be refused
//! with the problem that names it.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

use std::sync::LazyLock;

use bolted_joint_interface::{
    DefinitionProblem, Expanded, Interface, InterfaceError, InterfaceProblem, Interfaces, Joints,
    Role, Rows,
};

static DESCRIPTIONS: LazyLock<[Expanded; 2]> = LazyLock::new(|| Expanded::present().unwrap());
static ELEMENT: LazyLock<&str> = LazyLock::new(|| &DESCRIPTIONS[0].xml);
static LAP: LazyLock<&str> = LazyLock::new(|| &DESCRIPTIONS[1].xml);

/// Problem that `xml` is refused with after replacing the first `from` by `to`.
fn problem(xml: &str, from: &str, to: &str) -> InterfaceProblem {
    assert!(
        xml.contains(from),
        "the description does not contain {from}"
    );
    match Interface::from_xml("damaged.xml", &xml.replacen(from, to, 1)) {
        Err(InterfaceError::Inconsistent { file, problem }) => {
            assert_eq!(file, "damaged.xml");
            problem
        }
        other => panic!("replacing {from} by {to} gave {other:?}"),
    }
}

/// Problem that a damaged lap.xml is refused with beside an intact element.xml.
fn disagreement(from: &str, to: &str) -> InterfaceProblem {
    assert!(LAP.contains(from), "lap.xml does not contain {from}");
    let element = Interface::from_xml("element.xml", &ELEMENT).unwrap();
    let lap = Interface::from_xml("lap.xml", &LAP.replace(from, to)).unwrap();
    match lap.check_against(&element) {
        Err(InterfaceError::Inconsistent { file, problem }) => {
            assert_eq!(file, "lap.xml");
            problem
        }
        other => panic!("replacing {from} by {to} gave {other:?}"),
    }
}

/// The element of lap.xml for the initial unknown with this value reference.
fn initial_unknown(reference: u32) -> String {
    let start = format!(r#"<InitialUnknown valueReference="{reference}" "#);
    let from = LAP.find(&start).unwrap();
    let length = LAP[from..].find("/>").unwrap() + 2;
    LAP[from..from + length].to_owned()
}

macro_rules! refused {
    ($name:ident: $xml:ident, $from:expr => $to:expr, $pattern:pat $(if $guard:expr)?) => {
        #[test]
        fn $name() {
            let problem = problem(&$xml, $from, $to);
            assert!(matches!(&problem, $pattern $(if $guard)?), "{problem}");
        }
    };
}

refused!(version: LAP, r#"fmiVersion="3.0""# => r#"fmiVersion="2.0""#, InterfaceProblem::Version { found } if found == "2.0");
#[test]
fn model_identifier() {
    let xml = LAP.replace("\"bolted_joint\"", "\"bolted-joint\"");
    let found = "bolted-joint".to_owned();
    assert_eq!(
        problem(&xml, "", ""),
        InterfaceProblem::ModelIdentifier { found }
    );
}
refused!(other_type: LAP, r#"<Float64 name="a.y" valueReference="1""# => r#"<Float32 name="x" valueReference="999"/><Float64 name="a.y" valueReference="1""#,
    InterfaceProblem::Definition(DefinitionProblem::NotFloat64 { variable }) if variable == "x");
refused!(array: LAP, r#"start="2e-5" description="Longest Runge-Kutta step, greater than zero; a communication step takes as many equal steps as needed"/>"#
    => r#"start="2e-5" description="d"><Dimension start="2"/></Float64>"#,
    InterfaceProblem::Definition(DefinitionProblem::NotScalar { variable }) if variable == "step_size_max");
refused!(intermediate_parameter: LAP, r#"<Float64 name="a.m""# => r#"<Float64 intermediateUpdate="true" name="a.m""#,
    InterfaceProblem::Definition(DefinitionProblem::IntermediateUpdate { variable }) if variable == "a.m");
refused!(illegal_name: LAP, r#"name="a.y""# => r#"name="a.2y""#, InterfaceProblem::Definition(DefinitionProblem::IllegalName { variable }) if variable == "a.2y");
refused!(illegal_character: LAP, r#"name="a.y""# => r#"name="a y""#, InterfaceProblem::Definition(DefinitionProblem::IllegalName { variable }) if variable == "a y");
refused!(duplicate_name: LAP, r#"name="a.theta""# => r#"name="a.y""#, InterfaceProblem::Definition(DefinitionProblem::DuplicateName { variable }) if variable == "a.y");
refused!(duplicate_reference: LAP, r#"name="a.theta" valueReference="2""# => r#"name="a.theta" valueReference="1""#,
    InterfaceProblem::Definition(DefinitionProblem::DuplicateReference { reference: 1, first, second }) if first == "a.y" && second == "a.theta");
refused!(no_description: LAP, r#"description="Displacement of body a""# => r#"description=" ""#,
    InterfaceProblem::Definition(DefinitionProblem::NoDescription { variable }) if variable == "a.y");
refused!(no_type: LAP, r#"declaredType="StepSize""# => "", InterfaceProblem::Definition(DefinitionProblem::NoType { variable }) if variable == "step_size_max");
refused!(undefined_type: LAP, r#"declaredType="StepSize""# => r#"declaredType="Step""#,
    InterfaceProblem::Definition(DefinitionProblem::UndefinedType { variable, declared_type }) if variable == "step_size_max" && declared_type == "Step");
refused!(duplicate_type: LAP, r#"<Float64Type name="Rotation""# => r#"<Float64Type name="Displacement""#,
    InterfaceProblem::DuplicateDefinition { list: "<TypeDefinitions>", name } if name == "Displacement");
refused!(duplicate_unit: LAP, r#"<Unit name="rad">"# => r#"<Unit name="m">"#,
    InterfaceProblem::DuplicateDefinition { list: "<UnitDefinitions>", name } if name == "m");
refused!(duplicate_display_unit: LAP, r#"<DisplayUnit name="um""# => r#"<DisplayUnit name="mm""#,
    InterfaceProblem::DuplicateDefinition { list: "<Unit>", name } if name == "mm");
refused!(duplicate_category: LAP, r#"<Category name="logStatusError""# => r#"<Category name="logEvents""#,
    InterfaceProblem::DuplicateDefinition { list: "<LogCategories>", name } if name == "logEvents");
refused!(no_unit: LAP, r#"quantity="Force" unit="N""# => r#"quantity="Force""#,
    InterfaceProblem::Definition(DefinitionProblem::NoUnit { declared_type }) if declared_type == "Force");
refused!(undefined_unit: LAP, r#"quantity="Force" unit="N""# => r#"quantity="Force" unit="lbf""#,
    InterfaceProblem::Definition(DefinitionProblem::UndefinedUnit { declared_type, unit }) if declared_type == "Force" && unit == "lbf");
refused!(undefined_display_unit: LAP, r#"displayUnit="kN""# => r#"displayUnit="MN""#,
    InterfaceProblem::Definition(DefinitionProblem::UndefinedDisplayUnit { declared_type, unit, display_unit })
        if declared_type == "Force" && unit == "N" && display_unit == "MN");
refused!(no_base_unit: LAP, r#"<BaseUnit s="1"/>"# => "", InterfaceProblem::Definition(DefinitionProblem::NoBaseUnit { unit }) if unit == "s");
refused!(factor_in_unit: LAP, r#"<BaseUnit s="1"/>"# => r#"<BaseUnit s="1" factor="60"/>"#, InterfaceProblem::Definition(DefinitionProblem::NotCoherent { unit }) if unit == "s");
refused!(offset_in_unit: LAP, r#"<BaseUnit s="1"/>"# => r#"<BaseUnit s="1" offset="1"/>"#, InterfaceProblem::Definition(DefinitionProblem::NotCoherent { unit }) if unit == "s");
refused!(display_factor: LAP, r#"name="mm" factor="1000""# => r#"name="mm" factor="0""#,
    InterfaceProblem::Definition(DefinitionProblem::DisplayFactor { unit, display_unit, factor: 0.0 }) if unit == "m" && display_unit == "mm");
refused!(nominal: LAP, r#"nominal="100""# => r#"nominal="-100""#,
    InterfaceProblem::Definition(DefinitionProblem::Nominal { declared_type, nominal: -100.0 }) if declared_type == "Force");
refused!(zero_nominal: LAP, r#"nominal="100""# => r#"nominal="0""#, InterfaceProblem::Definition(DefinitionProblem::Nominal { nominal: 0.0, .. }));
refused!(range: LAP, r#"min="2.2250738585072014e-308" nominal="1e-5""# => r#"min="1" max="0" nominal="1e-5""#,
    InterfaceProblem::Definition(DefinitionProblem::Range { declared_type, min: 1.0, max: 0.0 }) if declared_type == "StepSize");
refused!(combination: LAP, r#"causality="parameter" variability="tunable""# => r#"causality="parameter" variability="continuous""#,
    InterfaceProblem::Definition(DefinitionProblem::Combination { variable, .. }) if variable == "joint.k_yy");
refused!(fixed_input: LAP, r#"causality="input" variability="continuous""# => r#"causality="input" variability="fixed""#,
    InterfaceProblem::Definition(DefinitionProblem::Combination { variable, .. }) if variable == "a.F");
refused!(forbidden_initial: LAP, r#"causality="parameter" variability="tunable" initial="exact""# => r#"causality="parameter" variability="tunable" initial="approx""#,
    InterfaceProblem::Definition(DefinitionProblem::ForbiddenInitial { variable, .. }) if variable == "joint.k_yy");
refused!(initial_of_time: LAP, r#"causality="independent" variability="continuous""# => r#"causality="independent" variability="continuous" initial="exact""#,
    InterfaceProblem::Definition(DefinitionProblem::ForbiddenInitial { variable, .. }) if variable == "time");
refused!(unimplemented_parameter: LAP, r#"causality="parameter" variability="tunable""# => r#"causality="parameter" variability="fixed""#,
    InterfaceProblem::Definition(DefinitionProblem::NoRole { variable, .. }) if variable == "joint.k_yy");
refused!(guessed_state: LAP, r#"causality="output" variability="continuous" initial="exact""# => r#"causality="output" variability="continuous" initial="approx""#,
    InterfaceProblem::Definition(DefinitionProblem::NoRole { variable, .. }) if variable == "a.y");
refused!(no_start_of_state: LAP, r#"declaredType="Displacement" start="0""# => r#"declaredType="Displacement""#,
    InterfaceProblem::Definition(DefinitionProblem::NoStart { variable }) if variable == "a.y");
refused!(no_start_of_input: ELEMENT, r#"declaredType="Displacement" start="0""# => r#"declaredType="Displacement""#,
    InterfaceProblem::Definition(DefinitionProblem::NoStart { variable }) if variable == "a.y");
refused!(no_start_of_parameter: LAP, r#" start="1.41""# => "", InterfaceProblem::Definition(DefinitionProblem::NoStart { variable }) if variable == "a.m");
refused!(start_of_output: LAP, r#"declaredType="Energy""# => r#"declaredType="Energy" start="0""#,
    InterfaceProblem::Definition(DefinitionProblem::UnwantedStart { variable }) if variable == "energy.stored");
refused!(start_of_time: LAP, r#"declaredType="Time""# => r#"declaredType="Time" start="0""#,
    InterfaceProblem::Definition(DefinitionProblem::UnwantedStart { variable }) if variable == "time");
refused!(several_starts: LAP, r#"start="1.41""# => r#"start="1.41 1.42""#,
    InterfaceProblem::Definition(DefinitionProblem::IllegalStart { variable, found }) if variable == "a.m" && *found == [1.41, 1.42]);
refused!(infinite_start: LAP, r#"start="1.41""# => r#"start="inf""#, InterfaceProblem::Definition(DefinitionProblem::IllegalStart { variable, .. }) if variable == "a.m");
refused!(start_out_of_range: LAP, r#"start="1.41""# => r#"start="-1.41""#,
    InterfaceProblem::Definition(DefinitionProblem::StartOutOfRange { variable, start: -1.41, min: f64::MIN_POSITIVE, .. }) if variable == "a.m");
refused!(no_independent: LAP, r#"causality="independent" variability="continuous" declaredType="Time""# => r#"causality="input" variability="continuous" declaredType="Time" start="0""#,
    InterfaceProblem::Definition(DefinitionProblem::Independent { found }) if found.is_empty());
refused!(independent_name: LAP, r#"name="time""# => r#"name="t""#, InterfaceProblem::Definition(DefinitionProblem::Independent { found }) if found[0].0 == "t");
refused!(derivative_of_nothing: LAP, r#"derivative="1""# => r#"derivative="977""#,
    InterfaceProblem::Definition(DefinitionProblem::UndefinedDerivative { variable, reference: 977 }) if variable == "a.v");
refused!(derivative_of_itself: LAP, r#"derivative="1""# => r#"derivative="3""#,
    InterfaceProblem::Definition(DefinitionProblem::UndefinedDerivative { variable, reference: 3 }) if variable == "a.v");
refused!(derivative_of_parameter: LAP, r#"derivative="1""# => r#"derivative="17""#,
    InterfaceProblem::Definition(DefinitionProblem::UndefinedDerivative { variable, reference: 17 }) if variable == "a.v");
refused!(derivative_of_another_unit: LAP, r#"derivative="1""# => r#"derivative="2""#,
    InterfaceProblem::Definition(DefinitionProblem::DerivativeUnit { variable, of, .. }) if variable == "a.v" && of == "a.theta");
refused!(output_of_nothing: LAP, r#"<Output valueReference="1" "# => r#"<Output valueReference="977" "#,
    InterfaceProblem::UndefinedReference { element: "Output", reference: 977 });
refused!(output_twice: LAP, r#"<Output valueReference="1" "# => r#"<Output valueReference="2" "#,
    InterfaceProblem::DuplicateUnknown { element: "Output", variable } if variable == "a.theta");
refused!(output_missing: LAP, r#"<Output valueReference="1" dependencies="1" dependenciesKind="constant"/>"# => "",
    InterfaceProblem::MissingUnknown { element: "Output", variable } if variable == "a.y");
refused!(output_is_input: LAP, r#"<Output valueReference="1" "# => r#"<Output valueReference="9" "#,
    InterfaceProblem::UnexpectedUnknown { element: "Output", variable } if variable == "a.F");
refused!(initial_unknown_missing: LAP, &initial_unknown(16) => "",
    InterfaceProblem::MissingUnknown { element: "InitialUnknown", variable } if variable == "power.dissipated");
refused!(initial_unknown_is_known: LAP, r#"<InitialUnknown valueReference="16" "# => r#"<InitialUnknown valueReference="1" "#,
    InterfaceProblem::UnexpectedUnknown { element: "InitialUnknown", variable } if variable == "a.y");
refused!(state_derivative_without_state: LAP, r#"<InitialUnknown valueReference="13""# => r#"<ContinuousStateDerivative valueReference="1"/><InitialUnknown valueReference="13""#,
    InterfaceProblem::UnexpectedUnknown { element: "ContinuousStateDerivative", variable } if variable == "a.y");
refused!(no_dependencies: LAP, r#"<Output valueReference="1" dependencies="1" dependenciesKind="constant"/>"# => r#"<Output valueReference="1"/>"#,
    InterfaceProblem::NoDependencies { element: "Output", variable } if variable == "a.y");
refused!(dependency_on_nothing: LAP, r#"<Output valueReference="1" dependencies="1" dependenciesKind="constant"/>"# => r#"<Output valueReference="1" dependencies="977"/>"#,
    InterfaceProblem::UndefinedReference { element: "Output", reference: 977 });
refused!(dependency_on_output: LAP, r#"<Output valueReference="1" dependencies="1" dependenciesKind="constant"/>"# => r#"<Output valueReference="1" dependencies="13"/>"#,
    InterfaceProblem::NotKnown { element: "Output", variable, dependency } if variable == "a.y" && dependency == "joint.F");
refused!(dependency_twice: LAP, r#"<Output valueReference="1" dependencies="1" dependenciesKind="constant"/>"# => r#"<Output valueReference="1" dependencies="9 9"/>"#,
    InterfaceProblem::DuplicateDependency { element: "Output", variable, dependency } if variable == "a.y" && dependency == "a.F");
refused!(kind_count: LAP, r#"dependenciesKind="constant""# => r#"dependenciesKind="constant constant""#,
    InterfaceProblem::KindCount { element: "Output", variable, dependencies: 1, kinds: 2 } if variable == "a.y");
refused!(kind_of_initial_unknown: LAP, &initial_unknown(16)
    => r#"<InitialUnknown valueReference="16" dependencies="3" dependenciesKind="tunable"/>"#,
    InterfaceProblem::InitialKind { variable } if variable == "power.dissipated");

refused!(state_derivative_missing: LAP, r#"<ContinuousStateDerivative valueReference="3" dependencies="3" dependenciesKind="constant"/>"# => "",
    InterfaceProblem::MissingUnknown { element: "ContinuousStateDerivative", variable } if variable == "a.v");
refused!(state_derivative_twice: LAP, r#"<ContinuousStateDerivative valueReference="3""# => r#"<ContinuousStateDerivative valueReference="4""#,
    InterfaceProblem::DuplicateUnknown { element: "ContinuousStateDerivative", variable } if variable == "a.omega");
refused!(state_derivative_of_output: LAP, r#"<ContinuousStateDerivative valueReference="3" dependencies="3""# => r#"<ContinuousStateDerivative valueReference="3" dependencies="13""#,
    InterfaceProblem::NotKnown { element: "ContinuousStateDerivative", variable, dependency } if variable == "a.v" && dependency == "joint.F");
refused!(local_that_is_no_derivative: LAP, r#"declaredType="Acceleration" derivative="3""# => r#"declaredType="Acceleration""#,
    InterfaceProblem::Definition(DefinitionProblem::NoRole { variable, .. }) if variable == "a.acceleration");
refused!(two_libraries: LAP, r#"<ModelExchange modelIdentifier="bolted_joint""# => r#"<ModelExchange modelIdentifier="lap""#,
    InterfaceProblem::TwoModelIdentifiers { model_exchange, co_simulation } if model_exchange == "lap" && co_simulation == "bolted_joint");

#[test]
fn an_interface_type_is_missing() {
    for (element, expected) in [
        ("<CoSimulation", InterfaceProblem::NoCoSimulation),
        ("<ModelExchange", InterfaceProblem::NoModelExchange),
    ] {
        let start = LAP.find(element).unwrap();
        let end = start + LAP[start..].find("/>").unwrap() + 2;
        assert_eq!(problem(&LAP, &LAP[start..end], ""), expected);
    }
}

#[test]
fn a_state_without_a_derivative() {
    // body a's acceleration goes, with all that is said about it
    let declaration = LAP.find(r#"<Float64 name="a.acceleration""#).unwrap();
    let mut xml = LAP.to_owned();
    xml.replace_range(
        declaration..declaration + LAP[declaration..].find("/>").unwrap() + 2,
        "",
    );
    for element in ["ContinuousStateDerivative", "InitialUnknown"] {
        let start = xml
            .find(&format!(r#"<{element} valueReference="38""#))
            .unwrap();
        let end = start + xml[start..].find("/>").unwrap() + 2;
        xml.replace_range(start..end, "");
    }
    assert_eq!(
        problem(&xml, "", ""),
        InterfaceProblem::NoDerivative {
            variable: "a.v".to_owned()
        }
    );
}

#[test]
fn unknown_attribute_is_malformed() {
    let xml = LAP.replacen("nominal=", "typical=", 1);
    let error = Interface::from_xml("lap.xml", &xml).unwrap_err();
    assert!(matches!(error, InterfaceError::Malformed { .. }), "{error}");
    assert!(error.to_string().starts_with("lap.xml: "), "{error}");
}

#[test]
fn shared_names_have_shared_references() {
    let problem = disagreement(
        r#"name="step_size_max" valueReference="37""#,
        r#"name="step_size_max" valueReference="702""#,
    );
    assert_eq!(problem, InterfaceProblem::Gap { reference: 37 });
    // swap two numbers that occur in declarations only
    let swapped = LAP
        .replace(
            r#"name="joint.k_yy" valueReference="17""#,
            r#"name="joint.k_yy" valueReference="24""#,
        )
        .replace(
            r#"name="joint.k3_theta" valueReference="24""#,
            r#"name="joint.k3_theta" valueReference="17""#,
        );
    let element = Interface::from_xml("element.xml", &ELEMENT).unwrap();
    let lap = Interface::from_xml("lap.xml", &swapped).unwrap();
    let error = lap.check_against(&element).unwrap_err().to_string();
    assert!(
        error.contains("\"joint.k3_theta\" has valueReference 17, but 24 in element.xml"),
        "{error}"
    );
}

#[test]
fn references_are_not_reused() {
    let problem = disagreement(r#"name="joint.k_yy""#, r#"name="joint.stiffness""#);
    assert!(
        matches!(&problem, InterfaceProblem::ReferenceReused { reference: 17, variable, other_variable, .. }
            if variable == "joint.stiffness" && other_variable == "joint.k_yy"),
        "{problem}"
    );
}

#[test]
fn shared_definitions_are_equal() {
    for (from, to, what) in [
        (
            r#"modelIdentifier="bolted_joint""#,
            r#"modelIdentifier="lap""#,
            "modelIdentifier",
        ),
        (
            r#"<Category name="logEvents""#,
            r#"<Category name="logAll""#,
            "list of log categories",
        ),
        (
            r#"name="mm" factor="1000""#,
            r#"name="mm" factor="999""#,
            "unit",
        ),
        (r#"nominal="100""#, r#"nominal="1000""#, "type"),
        (
            r#"<Float64 name="joint.k_yy" valueReference="17" causality="parameter" variability="tunable" initial="exact" declaredType="Stiffness""#,
            r#"<Float64 name="joint.k_yy" valueReference="17" causality="parameter" variability="tunable" initial="exact" declaredType="Damping""#,
            "unit of variable",
        ),
    ] {
        let problem = disagreement(from, to);
        assert!(
            matches!(&problem, InterfaceProblem::DefinitionDiffers { what: found, .. } if *found == what),
            "{problem}"
        );
    }
}

#[test]
fn intact_descriptions_are_accepted() {
    let interfaces = Interfaces::present().unwrap();
    assert_eq!(interfaces.element.variables.len(), 638);
    assert_eq!(interfaces.lap.variables.len(), 702);
    assert_eq!(interfaces.reference_count(), 702);
    let role = |interface: &Interface, name| interface.variable(name).map(|variable| variable.role);
    assert_eq!(role(&interfaces.element, "a.y"), Some(Role::Input));
    assert_eq!(role(&interfaces.lap, "a.y"), Some(Role::State));
    assert_eq!(role(&interfaces.lap, "joint.F"), Some(Role::Output));
    assert_eq!(
        role(&interfaces.lap, "joint.escape_amplitude_y"),
        Some(Role::CalculatedParameter)
    );
    assert_eq!(role(&interfaces.lap, "preload"), Some(Role::Input));
    assert_eq!(role(&interfaces.lap, "energy.supplied"), Some(Role::State));
    let inputs = interfaces.input_references();
    assert_eq!(inputs[..13], [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 52]);
    // in space, motion, rate and load of six DOFs on two sides; y is there already
    assert_eq!(inputs.len(), 13 + 2 * (3 * 6 - 1));
    assert_eq!(
        role(&interfaces.lap, "a.acceleration"),
        Some(Role::Derivative)
    );
    let states = |interface: &Interface| {
        let states = interface.continuous_states.iter();
        states
            .map(|state| (state.reference, state.derivative))
            .collect::<Vec<_>>()
    };
    // what laws have of states on each of the seven DOFs, y in plane and space being one
    let states_of_element = states(&interfaces.element);
    assert_eq!(states_of_element.len(), 4 * 7);
    let mut states_of_lap = states(&interfaces.lap);
    let of_laws = states_of_lap.split_off(states_of_lap.len() - 4 * 7);
    assert_eq!(of_laws, states_of_element);
    for (state, rate) in of_laws {
        let of = |reference| {
            let mut all = interfaces.lap.variables.iter();
            all.find(|variable| variable.reference == reference)
                .unwrap()
        };
        assert_eq!(of(state).role, Role::InnerState);
        assert_eq!(of(rate).role, Role::Derivative);
        assert_eq!(of(rate).derivative_of, Some(state));
    }
    for interface in [&interfaces.element, &interfaces.lap] {
        assert_eq!(interface.event_indicators.len(), 2 * 7);
    }
    assert_eq!(
        role(&interfaces.lap, "joint.turning_y"),
        Some(Role::Indicator)
    );
    let in_plane: Vec<_> = (states_of_lap.iter().copied())
        .filter(|&(state, derivative)| state < 116 && derivative < 116)
        .collect();
    // y is a state in a plane and in space, with another rate
    assert_eq!(states_of_lap.len(), in_plane.len() + 2 * 2 * 6);
    assert_eq!(
        in_plane,
        [
            (1, 3),
            (2, 4),
            (3, 38),
            (4, 39),
            (5, 7),
            (6, 8),
            (7, 40),
            (8, 41),
            (55, 54),
            (56, 16)
        ]
    );
    let of = |place: usize, rows: &[usize]| {
        let description = &DESCRIPTIONS[place];
        let interface = [&interfaces.element, &interfaces.lap][place];
        let is_there = |name| {
            let scope = description.scope(name).unwrap();
            let mut joints = [Joints::CONSTANT, Joints::OVER_PRELOAD, Joints::MEMORY].into_iter();
            joints.any(|joint| scope.includes(Rows::of(rows), joint))
        };
        let variables = interface.variables.iter();
        variables
            .filter(|variable| is_there(&variable.name))
            .count()
    };
    // θ brings θ, ω, M of both sides, M of the joint, k and c of its own and with y, the laws' parameters, what laws remember, the
    // rates of the states among that, the escape amplitude, two event indicators; J, k_θ, c_θ, α of both bodies
    let [sides, laws, bodies] = [6 + 1 + 1 + 2, 55 + 14 + 4, 6 + 2];
    for (place, bodies) in [(0, 0), (1, bodies)] {
        let alone = of(place, &[0]);
        let with_theta = alone + sides + 4 + laws + bodies;
        assert_eq!(of(place, &[0, 1]), with_theta);
        // likewise each of six, with 21 entries of K and of C in place of one
        let in_space = alone + 5 * (sides + laws + bodies) + 2 * 20;
        assert_eq!(of(place, &[2, 3, 4, 5, 6, 7]), in_space);
    }
}
