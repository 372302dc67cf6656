//! `convert`: what is written for other tools, and what is refused. Tests in Python read it back in those tools.

use bolted_joint_testing::has;

use crate::bench::Bench;
use crate::joint_file::JOINT;

const OVER_PRELOAD: &str = include_str!("../data/joint/over-preload.joint.json");
const IWAN: &str = include_str!("../../examples/friction/iwan.joint.json");

const TOOLS: [&str; 6] = [
    "nastran", "abaqus", "calculix", "ansys", "matlab", "modelica",
];

const TWO_SLIDERS: &str = r#"{"format": "bolted-joint/1", "name": "two", "joint": {"dofs": ["y"], "stiffness": [[1e6]], "damping": [[1]],
"friction": [{"dof": "y", "law": "jenkins", "stiffness": 1e6, "slip_force": 1}, {"dof": "y", "law": "jenkins", "stiffness": 1e6,
"slip_force": 2}]}}"#;

#[test]
fn a_file_for_each_tool_says_units_and_signs() {
    let bench = Bench::new();
    bench.write("j.joint.json", JOINT);
    for tool in TOOLS {
        let nodes = match tool {
            "matlab" | "modelica" => "",
            _ => "--nodes 7,8",
        };
        let convert = format!("convert j.joint.json --to {tool} -o {tool}.txt {nodes}");
        let outcome = bench.done(&convert);
        has(&outcome.stdout, &[&format!("wrote {tool}.txt for")]);
        assert_eq!(outcome.stderr, "");
        let text = bench.text(&format!("{tool}.txt"));
        has(&text, &["Units: N, m, rad, s, kg", "Signs: load on side b"]);
    }
    has(&bench.text("nastran.txt"), &["DMIG,KBJ1001"]);
    has(
        &bench.text("modelica.txt"),
        &[
            "package modelica",
            "parameter Real k_ytheta(unit=\"N/rad\") = 6E2",
        ],
    );
    let json = bench
        .done("convert j.joint.json --to abaqus -o a.inp --json")
        .json();
    assert_eq!(
        (&json["to"], &json["name"]),
        (&"Abaqus".into(), &"a".into())
    );
    let notes = json["notes"].as_array().unwrap();
    for said in ["couples its motions", "two bodies"] {
        assert!(
            notes
                .iter()
                .any(|note| note.as_str().unwrap().contains(said))
        );
    }
}

#[test]
fn what_a_tool_cannot_express_is_refused_and_never_dropped() {
    let bench = Bench::new();
    bench.write("iwan.json", IWAN);
    bench.write("over.json", OVER_PRELOAD);
    bench.write("study.toml", "method = \"respond\"\n");
    bench.write("two.json", TWO_SLIDERS);
    bench.refused(
        "convert two.json --to nastran -o o.txt",
        &["found 2 times jenkins on y, which"],
    );
    for tool in TOOLS {
        let command = format!("convert iwan.json --to {tool} -o o.txt");
        bench.refused(&command, &["iwan.json: found iwan on y", "--at-rest"]);
        let outcome = bench.done(&format!("{command} --at-rest"));
        has(
            &outcome.stdout,
            &["taken at rest: of iwan on y only the stiffness and damping of small motion"],
        );
        has(&bench.text("o.txt"), &["taken at rest"]);
        bench.refused(
            &format!("convert over.json --to {tool} -o out.txt"),
            &[
                "over.json: found a joint over the preload",
                "--preload TORQUE",
            ],
        );
        bench.done(&format!(
            "convert over.json --to {tool} -o out.txt --preload 10"
        ));
    }
    #[rustfmt::skip]
    let cases = [
        ("convert over.json --to ansys -o out.txt --preload 1000", ["over.json", "1000"]),
        ("convert iwan.json --to ansys -o o.txt --preload 10", ["iwan.json", "preload"]),
        ("convert study.toml --to ansys -o o.txt", ["found a study of method", "expected a joint file"]),
        ("convert missing.json --to ansys -o o.txt", ["missing.json", "cannot be read"]),
        ("convert iwan.json --to ansys -o iwan.json", ["same file", "a name of its own"]),
        ("convert iwan.json --to ansys -o o.txt --nodes 3,3", ["--nodes: found 3,3", "two different numbers"]),
        ("convert iwan.json --to ansys -o o.txt --nodes 3", ["--nodes: found 3", "two different numbers"]),
        ("convert iwan.json --to ansys -o missing/o.txt", ["missing/o.txt: cannot be written", "give a path"]),
    ];
    for (arguments, fragments) in cases {
        bench.refused(arguments, &fragments);
    }
    for arguments in [
        "convert iwan.json -o o.txt",
        "convert iwan.json --to fortran -o o.txt",
        "convert iwan.json --to ansys -o o.txt --nodes 0,1",
    ] {
        assert_eq!(bench.run(arguments).code, Some(2), "{arguments}");
    }
    let status =
        "\"status\": { \"usable\": false, \"reasons\": [\"has not converged\"] }, \"name\"";
    bench.write("bad.json", JOINT.replacen("\"name\"", status, 1));
    bench.unusable(
        "convert bad.json --to nastran -o n.bdf",
        &["has not converged"],
    );
    has(
        &bench.text("n.bdf"),
        &["$ NOT TO BE RELIED ON: has not converged"],
    );
}

#[test]
fn units_that_a_tool_has_may_be_said() {
    let bench = Bench::new();
    bench.write("j.json", JOINT);
    for (tool, file) in [("matlab", "own.m"), ("modelica", "own.mo")] {
        bench.done(&format!("convert j.json --to {tool} --units si -o {file}"));
        bench.refused(
            &format!("convert j.json --to {tool} --units mm -o {file}"),
            &["--units: found mm, expected si"],
        );
    }
}

#[test]
fn a_function_of_matlab_has_the_name_of_its_file() {
    let bench = Bench::new();
    bench.write("j.json", JOINT);
    let outcome = bench.done("convert j.json --to matlab -o 2nd-joint.m");
    has(&outcome.stdout, &["wrote joint_2nd_joint.m for MATLAB"]);
    has(
        &outcome.stderr,
        &[
            "2nd-joint.m: no function of MATLAB can be called so",
            "are called joint_2nd_joint",
        ],
    );
    assert!(!bench.path("2nd-joint.m").exists());
    has(
        &bench.text("joint_2nd_joint.m"),
        &["= joint_2nd_joint(relative"],
    );
}
