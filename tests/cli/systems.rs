//! `check` of a system of FMUs: what fits is said to be sound, and every part that does not fit another is found.

use bolted_joint_testing::has;

use crate::bench::Bench;
use crate::check::repacked;

const JOINT: &str = r#"{
  "format": "bolted-joint/1", "name": "lap",
  "joint": { "dofs": ["y", "theta"], "stiffness": [[5.73e5, 5.82e3], [5.82e3, 1.29e3]], "damping": [[10.83, 0.0], [0.0, 0.083]] },
  "uncertainty": { "standard_deviation": { "stiffness": [[1e3, 10.0], [10.0, 1.0]], "damping": [[0.1, 0.001], [0.001, 0.001]] },
    "basis": "made up" } }"#;

const BEAMS: &str = r#"
name = "two beams"
[structures.a]
modes = 4
points = { "1:+Y" = 0.3, "1:+RZ" = 0.3 }
beam = { length = 0.3, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = "fixed-free", damping_ratio = 0.005 }
[structures.b]
modes = 4
points = { "2:+Y" = 0.0, "2:+RZ" = 0.0, "3:+Y" = 0.3 }
beam = { length = 0.3, width = 0.03, height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = "free-free", damping_ratio = 0.005 }
[[joints]]
name = "lap"
file = "j.joint.json"
a = { structure = "a", y = "1:+Y", theta = "1:+RZ" }
b = { structure = "b", y = "2:+Y", theta = "2:+RZ" }
[inputs]
push = "b/3:+Y"
[outputs]
tip = "b/3:+Y"
"#;

/// A bench with a system and two draws of its parameters.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("j.joint.json", JOINT);
    bench.write("beams.toml", BEAMS);
    bench.done("export beams.toml -o beams.ssp --draws 2");
    bench
}

/// Makes `edited.ssp` with another text of one entry.
fn with_entry(bench: &Bench, entry: &str, from: &str, to: &str) {
    repacked(bench, "beams.ssp", "edited.ssp", |name, bytes| {
        if name != entry {
            return Some(bytes);
        }
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains(from), "{from}");
        Some(text.replacen(from, to, 1).into())
    });
}

#[test]
fn a_sound_system_is_said_to_be_sound() {
    let bench = bench();
    bench.done("export beams.toml -o ecos.ssp --ssp-for ecos");
    bench.done("export beams.toml -o three.ssp --fmi 3");
    for system in ["beams.ssp", "ecos.ssp", "three.ssp"] {
        let outcome = bench.done(&format!("check {system}"));
        let expected = [
            "system of FMUs (SSP)",
            "components: a (resources/a.fmu), b (resources/b.fmu), lap (resources/lap.fmu)",
            "a: run: ",
            "lap: run: loads: those of resources/joint.json",
            "`check` of the assembly file",
            "no problem found",
        ];
        has(&outcome.stdout, &expected);
    }
    let json = bench.done("check beams.ssp --no-run --json").json();
    assert_eq!(json["sound"], true);
    assert!(json["components"]["lap"]["platforms"].is_array(), "{json}");
    let says = ["--neighbour-mass: found a system of FMUs"];
    bench.refused("check beams.ssp --neighbour-mass 1,1", &says);
}

#[test]
fn what_does_not_fit_is_found() {
    let bench = bench();
    let ssd = "SystemStructure.ssd";
    #[rustfmt::skip]
    let cases = [
        (ssd, "startConnector=\"lap_a.y\"", "startConnector=\"lap_a.x\"", "connection from a.lap_a.x to lap.a.y: found no connector a.lap_a.x, expected one of those of component a"),
        (ssd, "endElement=\"lap\"", "endElement=\"lup\"", "found no connector lup.a.y, expected one of those of a component: a, b, lap"),
        (ssd, "endConnector=\"a.y\"", "endConnector=\"a.F\"", "found lap.a.F as output, expected it as input"),
        (ssd, "endConnector=\"a.y\"", "endConnector=\"a.v\"", "found m at its start and m/s at its end, expected the same unit"),
        (ssd, "endConnector=\"a.y\"", "endConnector=\"a.v\"", "found another one from a.lap_a.y to the same place, expected one at most"),
        (ssd, "endConnector=\"a.y\"", "endConnector=\"a.v\"", "inputs without a connection, which keep their start values: lap.a.y"),
        (ssd, "Connector name=\"lap_a.y\" kind=\"output\"", "Connector name=\"lap_a.q\" kind=\"output\"", "connector lap_a.q of a: resources/a.fmu has no variable of that name"),
        (ssd, "Connector name=\"lap_a.y\" kind=\"output\"", "Connector name=\"lap_a.y\" kind=\"input\"", "found kind input, expected output as resources/a.fmu has it"),
        (ssd, "unit=\"m\"", "unit=\"mm\"", "connection from b.tip.y to tip.y: found m at its start and mm at its end"),
        (ssd, "\n            <ssc:Real unit=\"m\"", "<ssc:Real unit=\"mm\"", "found unit mm, expected m as resources/a.fmu has it"),
        (ssd, "name=\"b\" type", "name=\"a\" type", "found component a twice"),
        (ssd, "resources/a.fmu", "resources/x.fmu", "component a: resources/x.fmu not found, expected it in the archive"),
        (ssd, "resources/nominal.ssv", "resources/usual.ssv", "resources/usual.ssv: not found"),
        ("resources/nominal.ssv", "lap.joint.k_yy", "lap.joint.k_zz", "found parameter lap.joint.k_zz, expected a variable of component lap"),
        ("resources/draw-2.ssv", "\"lap.joint", "\"lup.joint", "resources/draw-2.ssv: found parameter lup.joint.k_yy, expected the name of a component before it"),
        ("resources/draw-1.ssv", "<ssv:Real value=\"", "<ssv:Real value=\"e", "expected a finite number"),
        ("resources/nominal.ssv", "ssv:ParameterSet ", "ssv:Parameters ", "resources/nominal.ssv: "),
    ];
    for (entry, from, to, fragment) in cases {
        with_entry(&bench, entry, from, to);
        let outcome = bench.run("check edited.ssp --no-run");
        assert_eq!(outcome.code, Some(1), "{to}");
        has(&(outcome.stdout + &outcome.stderr), &[fragment]);
    }
    with_entry(&bench, ssd, "SystemStructureDescription", "Other");
    bench.refused(
        "check edited.ssp",
        &["`SystemStructure.ssd` is missing or cannot be read"],
    );
}

#[test]
fn what_is_wrong_with_an_fmu_is_found_within_its_system() {
    let bench = bench();
    repacked(
        &bench,
        "beams.ssp",
        "edited.ssp",
        |name, bytes| match name {
            "resources/b.fmu" => Some(b"no archive".to_vec()),
            _ => Some(bytes),
        },
    );
    let outcome = bench.run("check edited.ssp --no-run");
    has(
        &outcome.stderr,
        &["b: resources/b.fmu: found no readable zip archive"],
    );
    // a damaged archive is told as such, and nothing of what is whole in it is blamed
    let mut bytes = std::fs::read(bench.path("beams.ssp")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x55;
    bench.write("damaged.ssp", bytes);
    let outcome = bench.run("check damaged.ssp --no-run");
    has(&outcome.stderr, &["found it damaged", "copy or export"]);
    assert!(
        !outcome.stderr.contains("cannot be read"),
        "{}",
        outcome.stderr
    );
    // the file of another component stands in
    with_entry(
        &bench,
        "SystemStructure.ssd",
        "resources/b.fmu",
        "resources/a.fmu",
    );
    let outcome = bench.run("check edited.ssp --no-run");
    has(
        &outcome.stderr,
        &["connector push.F of b: resources/a.fmu has no variable of that name"],
    );
}

/// With what other tools write: systems within systems, empty elements, start values of the system's own connectors.
#[test]
fn a_system_of_another_tool_is_read() {
    let bench = bench();
    let text = r#"<s:SystemStructureDescription xmlns:s="http://ssp-standard.org/SSP1/SystemStructureDescription" version="1.0" name="other">
  <s:System name="root"><s:Connectors><s:Connector name="C1" kind="input"/><s:Connector name="C3" kind="parameter"/></s:Connectors>
    <s:ParameterBindings><s:ParameterBinding source="./resources/nominal.ssv"/><s:ParameterBinding source="own.ssv" sourceBase="component"/>
    </s:ParameterBindings>
    <s:Elements><s:System name="inner"><s:Connectors><s:Connector name="u" kind="input"/><s:Connector name="k" kind="parameter"/>
    </s:Connectors></s:System></s:Elements>
    <s:Connections><s:Connection startElement="" startConnector="C1" endElement="inner" endConnector="u"/>
      <s:Connection startConnector="C3" endElement="inner" endConnector="k"/></s:Connections></s:System></s:SystemStructureDescription>"#;
    let values = r#"<v:ParameterSet xmlns:v="http://ssp-standard.org/SSP1/SystemStructureParameterValues" version="1.0" name="own">
  <v:Parameters><v:Parameter name="C1"><v:Real value="20"/></v:Parameter></v:Parameters></v:ParameterSet>"#;
    for (start_values, finding) in [
        (Some(values), None),
        (None, Some("resources/nominal.ssv: not found")),
    ] {
        repacked(&bench, "beams.ssp", "edited.ssp", |name, _| match name {
            "SystemStructure.ssd" => Some(text.into()),
            "resources/nominal.ssv" => start_values.map(Into::into),
            _ => None,
        });
        match finding {
            Some(finding) => {
                bench.fails("check edited.ssp", &[finding]);
            }
            None => {
                let outcome = bench.done("check edited.ssp");
                has(
                    &outcome.stdout,
                    &["components: inner", "inputs: C1", "no problem found"],
                );
                assert!(
                    !outcome.stdout.contains("assembly file"),
                    "{}",
                    outcome.stdout
                );
            }
        }
    }
}
