//! The FMU's variables: which there are with and without rotation, and what they start with.

use bolted_joint::export::{ExportOptions, Interface, StepWish, fmu_bytes};
use bolted_joint::joint::JointFile;
use bolted_joint_interface::{Expanded, Interface as Declared, Joints, Rows};

use crate::{data, declared, export, options, text};

#[track_caller]
fn starts_at(declared: &Declared, name: &str, value: f64) {
    assert_eq!(
        declared.variable(name).unwrap().start,
        Some(value),
        "{name}"
    );
}

#[test]
fn a_joint_with_rotation_keeps_every_variable_and_gets_its_values() {
    let (fmu, _) = export("m10-aluminium.joint.json", Interface::Element).unwrap();
    let declared = declared(&fmu).unwrap();
    let [template, _] = Expanded::present().unwrap();
    let of_all_joints = Declared::from_xml("element.xml", &template.xml).unwrap();
    let names = |interface: &Declared| -> Vec<(String, u32)> {
        let variables = interface.variables.iter();
        // without those of a joint over the preload, or with memory
        variables
            .filter(|variable| {
                let scope = template.scope(&variable.name).unwrap();
                scope.includes(Rows::of(&[0, 1]), Joints::CONSTANT)
            })
            .map(|variable| (variable.name.clone(), variable.reference))
            .collect()
    };
    assert_eq!(names(&declared), names(&of_all_joints));
    for (name, value) in [
        ("joint.k_yy", 5.73e5),
        ("joint.k_ytheta", 5.82e3),
        ("joint.k_thetatheta", 1.29e3),
        ("joint.c_yy", 10.83),
        ("joint.c_ytheta", -0.83),
        ("joint.c_thetatheta", 0.083),
        ("joint.k3_y", 0.0),
        ("joint.k3_theta", 0.0),
        ("a.y", 0.0),
    ] {
        starts_at(&declared, name, value);
    }
    assert_eq!(fmu.step, None);
    let xml = text(&fmu, "modelDescription.xml").unwrap();
    for fragment in [
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\" modelName=\"M10x16 A2-70 on 6 mm aluminium\"",
        "generationDateAndTime=\"2009-12-08T14:33:22Z\"",
        "generationTool=\"bolted-joint 0.1.0\"",
        // 1/(20 · 512 Hz) = 9.77e-5 s, and below it what goes into 1 s: 12 500 times
        "<DefaultExperiment startTime=\"0\" stopTime=\"1\" stepSize=\"8e-5\"/>",
    ] {
        assert!(xml.contains(fragment), "{fragment}\n{xml}");
    }
    assert_eq!(
        text(&fmu, "resources/start.txt").unwrap(),
        format!(
            "bolted-joint-start/1\nmodel element\ndofs 2\ntoken {}\njoint.k_yy 573000.0\njoint.k_ytheta 5820.0\n\
             joint.k_thetatheta 1290.0\njoint.c_yy 10.83\njoint.c_ytheta -0.83\njoint.c_thetatheta 0.083\n\
             joint.k3_y 0.0\njoint.k3_theta 0.0\njoint.k5_y 0.0\njoint.k5_theta 0.0\njoint.k7_y 0.0\n\
             joint.k7_theta 0.0\njoint.c2_y 0.0\njoint.c2_theta 0.0\njoint.c4_y 0.0\njoint.c4_theta 0.0\n",
            fmu.token
        )
    );
}

#[test]
fn a_joint_without_rotation_has_no_rotational_variable() {
    let (fmu, _) = export("pirdayr-ex03.joint.json", Interface::Lap).unwrap();
    let declared = declared(&fmu).unwrap();
    let names: Vec<&str> = declared.variables.iter().map(|v| &*v.name).collect();
    assert_eq!(
        names.join(" "),
        "time a.y a.v b.y b.v a.F b.F joint.F energy.stored power.dissipated joint.k_yy joint.c_yy joint.k3_y \
         a.m a.k_y a.c_y b.m b.k_y b.c_y step_size_max a.acceleration b.acceleration \
         joint.k5_y joint.k7_y joint.c2_y joint.c4_y joint.escape_amplitude_y"
    );
    let xml = text(&fmu, "modelDescription.xml").unwrap();
    assert!(!xml.contains("theta") && !xml.contains("omega"));
    let step = fmu.step.unwrap();
    // |λ| of the out-of-phase mode: √((10.56e5 + 2·4.56e6)/2.35) = 2080.9 1/s; 0.066106/2080.9 = 3.177e-5 s
    assert!((step.largest_modulus - 2080.9).abs() < 0.1);
    assert_eq!(step.longest_s, 3.1e-5);
    for (name, value) in [
        ("joint.k_yy", 4.56e6),
        ("joint.c_yy", 0.54),
        ("joint.k3_y", 1670.0),
        ("a.m", 2.35),
        ("b.k_y", 1.056e6),
        ("b.c_y", 1.39),
        ("step_size_max", 3.1e-5),
    ] {
        starts_at(&declared, name, value);
    }
    let start = text(&fmu, "resources/start.txt").unwrap();
    assert_eq!(
        start,
        format!(
            "bolted-joint-start/1\nmodel lap\ndofs 1\ntoken {}\njoint.k_yy 4560000.0\njoint.c_yy 0.54\n\
             joint.k3_y 1670.0\njoint.k5_y 0.0\njoint.k7_y 0.0\njoint.c2_y 0.0\njoint.c4_y 0.0\n\
             a.m 2.35\na.k_y 1056000.0\na.c_y 1.39\nb.m 2.35\nb.k_y 1056000.0\nb.c_y 1.39\nstep_size_max 3.1e-5\n",
            fmu.token
        )
    );
    assert_eq!(fmu.escape_amplitude, [None]);
}

#[test]
fn a_given_stable_step_is_taken() {
    let file = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let options = ExportOptions {
        step: StepWish::AtMost(2e-4),
        ..options(Interface::Lap).unwrap()
    };
    let fmu = fmu_bytes(&file, "", &options).unwrap();
    starts_at(&declared(&fmu).unwrap(), "step_size_max", 2e-4);
}
