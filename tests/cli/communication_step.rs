//! `check` says how long a communication step may be: what is asked for, and what is refused.

use crate::bench::Bench;
use crate::joint_file::JOINT;
use bolted_joint_testing::has;

#[test]
fn bounds_are_given_for_joint_files_and_fmus_alike() {
    let bench = Bench::new();
    bench.write("j.joint.json", JOINT);
    bench.done("export j.joint.json -o element.fmu");
    let neighbours = "--neighbour-mass 1.2,fixed --neighbour-inertia 8e-3,3e-3";
    let step = |file: &str| {
        let outcome = bench.done(&format!("check {file} --json {neighbours}"));
        outcome.json()["communication_step"].clone()
    };
    let (of_joint, of_fmu) = (step("j.joint.json"), step("element.fmu"));
    for master in ["held", "late", "semi_implicit"] {
        assert_eq!(of_joint[master], of_fmu[master]);
        assert!(of_fmu[master].as_f64().unwrap() > 0.0);
    }
    assert!(of_fmu["suggested"].is_number());
    let outcome = bench.done(&format!("check element.fmu {neighbours}"));
    let advice = "directional derivatives, or export the joint as lap";
    has(&outcome.stdout, &["stable below", advice]);
    // what does not move has no bound
    let fixed = "--neighbour-mass fixed,fixed --neighbour-inertia fixed,fixed";
    let report = bench
        .done(&format!("check element.fmu --json {fixed}"))
        .json();
    assert!(report["communication_step"]["held"].is_null());
    // nobody asked
    let report = bench.done("check element.fmu --json").json();
    assert!(report.get("communication_step").is_none());
}

#[test]
fn what_does_not_fit_is_refused() {
    let bench = Bench::new();
    bench.write("j.joint.json", JOINT);
    bench.done("export j.joint.json -o element.fmu");
    bench.done("export j.joint.json -o lap.fmu --as lap");
    #[rustfmt::skip]
    let cases = [
        ("element.fmu --neighbour-mass 1,2", ["--neighbour-inertia: found none", "`fixed,fixed`"]),
        ("element.fmu --neighbour-stiffness 1e5,0", ["found an element, which takes motion", "--neighbour-mass"]),
        ("lap.fmu --neighbour-mass 1,2", ["found a lap", "add rigidly attached masses to `bodies`"]),
        ("element.fmu --amplitude 1e-5,1e-4", ["--amplitude: found no neighbour", "--neighbour-mass"]),
        ("lap.fmu --neighbour-stiffness 1e5,0 --amplitude 1e-5", ["found 1 values", "2 degrees of freedom"]),
    ];
    for (arguments, fragments) in cases {
        bench.refused(&format!("check {arguments}"), &fragments);
    }
    for wrong in [
        "mass 1",
        "mass 1,0",
        "mass -1,2",
        "mass nan,2",
        "stiffness -1,0",
    ] {
        let outcome = bench.run(&format!("check element.fmu --neighbour-{wrong}"));
        assert_eq!(outcome.code, Some(2), "{wrong}");
    }
}
