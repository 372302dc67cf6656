//! The FMU as importers and users meet it: its files, its interface, what it refuses.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod description;
mod terminals;
mod xml;
mod zip;

use std::fs;
use std::io::{Cursor, Read as _};
use std::path::{Path, PathBuf};

use ::zip::ZipArchive;
use bolted_joint::export::{
    ExportError, ExportOptions, Exported, FmiVersion, Interface, LibrarySource, Timestamp,
    fmu_bytes,
};
use bolted_joint::joint::JointFile;
use bolted_joint_interface::Interface as Declared;

type Failure = Box<dyn std::error::Error>;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/joint")
        .join(name)
}

fn options(interface: Interface) -> Result<ExportOptions, ExportError> {
    Ok(ExportOptions {
        interface,
        version: FmiVersion::V3,
        step_size_max_s: None,
        platforms: None,
        preload_n_m: None,
        allow_active: false,
        date: Timestamp::from_epoch_text("1260282802")?,
    })
}

fn export(name: &str, interface: Interface) -> Result<(Exported, String), Failure> {
    export_as(name, interface, FmiVersion::V3)
}

fn export_as(
    name: &str,
    interface: Interface,
    version: FmiVersion,
) -> Result<(Exported, String), Failure> {
    let (file, source) = JointFile::read_with_source(&data(name))?;
    let options = ExportOptions {
        version,
        ..options(interface)?
    };
    Ok((fmu_bytes(&file, &source, &options)?, source))
}

/// The joint file with one text replaced by another, read again.
fn changed(name: &str, from: &str, to: &str) -> Result<(JointFile, String), Failure> {
    let source = fs::read_to_string(data(name))?;
    assert!(source.contains(from), "{from}");
    let source = source.replace(from, to);
    Ok((JointFile::from_json(&source, name)?, source))
}

fn refusal(file: &JointFile, options: &ExportOptions) -> String {
    match fmu_bytes(file, "", options) {
        Ok(_) => "accepted".to_owned(),
        Err(refused) => refused.to_string(),
    }
}

/// Text of one file of an FMU.
fn text(fmu: &Exported, path: &str) -> Result<String, Failure> {
    Ok(String::from_utf8(bytes(fmu, path)?)?)
}

fn bytes(fmu: &Exported, path: &str) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    ZipArchive::new(Cursor::new(fmu.bytes()))?
        .by_name(path)?
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn declared(fmu: &Exported) -> Result<Declared, Failure> {
    let xml = text(fmu, "modelDescription.xml")?;
    Ok(Declared::from_xml("modelDescription.xml", &xml)?)
}

#[test]
fn the_fmu_has_the_files_of_the_standard() {
    let (fmu, source) = export("m10-aluminium.joint.json", Interface::Element).unwrap();
    let paths: Vec<&str> = fmu
        .entries
        .iter()
        .map(|entry| entry.path.as_str())
        .collect();
    let (library, others) = paths.split_last().unwrap();
    assert_eq!(
        others,
        [
            "modelDescription.xml",
            "resources/start.txt",
            "resources/joint.json",
            "documentation/index.html",
            "documentation/licenses/license.txt",
            "documentation/licenses/MIT.txt",
            "documentation/licenses/Apache-2.0.txt",
            "terminalsAndIcons/terminalsAndIcons.xml",
            "extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml",
            "extra/org.fmi-standard.fmi-ls-ref/reference-run.exp",
            "extra/org.fmi-standard.fmi-ls-ref/reference-run-in.csv",
            "extra/org.fmi-standard.fmi-ls-ref/reference-run-out.csv",
            "documentation/fmi-ls-ref.txt",
            "terminalsAndIcons/icon.png",
            "terminalsAndIcons/icon.svg",
            "terminalsAndIcons/flange_a.png",
            "terminalsAndIcons/flange_a.svg",
            "terminalsAndIcons/flange_b.png",
            "terminalsAndIcons/flange_b.svg",
            "documentation/diagram.png",
            "documentation/diagram.svg",
        ]
    );
    assert_eq!(fmu.libraries.len(), 1);
    assert_eq!(fmu.libraries[0].source, LibrarySource::Embedded);
    let folder = format!("binaries/{}/bolted_joint.", fmu.libraries[0].platform);
    assert!(library.starts_with(&folder), "{library}");
    assert_eq!(text(&fmu, "resources/joint.json").unwrap(), source);

    let mut archive = ZipArchive::new(Cursor::new(fmu.bytes())).unwrap();
    for i in 0..archive.len() {
        let file = archive.by_index(i).unwrap();
        assert_eq!(file.name().unwrap(), paths[i]);
        assert_eq!(file.size(), fmu.entries[i].size as u64);
        assert!(
            file.extra_data().is_none_or(|extra| extra.is_empty()),
            "{}",
            paths[i]
        );
        let mode = if paths[i] == *library {
            0o100_755
        } else {
            0o100_644
        };
        assert_eq!(file.unix_mode(), Some(mode), "{}", paths[i]);
        let date = file.last_modified().unwrap();
        assert_eq!(
            (
                date.year(),
                date.month(),
                date.day(),
                date.hour(),
                date.minute(),
                date.second()
            ),
            (2009, 12, 8, 14, 33, 22)
        );
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let (first, _) = export("pirdayr-ex03.joint.json", Interface::Lap).unwrap();
    let (second, _) = export("pirdayr-ex03.joint.json", Interface::Lap).unwrap();
    assert_eq!(first.bytes(), second.bytes());

    let (file, source) = JointFile::read_with_source(&data("pirdayr-ex03.joint.json")).unwrap();
    let later = ExportOptions {
        date: Timestamp::from_epoch_text("1260282902").unwrap(),
        ..options(Interface::Lap).unwrap()
    };
    let later = fmu_bytes(&file, &source, &later).unwrap();
    assert_ne!(first.bytes(), later.bytes());
    assert_eq!(
        first.token, later.token,
        "the date is no part of the interface"
    );
}

#[test]
fn the_token_follows_interface_and_values() {
    let (lap, _) = export("pirdayr-ex03.joint.json", Interface::Lap).unwrap();
    let (element, _) = export("pirdayr-ex03.joint.json", Interface::Element).unwrap();
    assert_ne!(lap.token, element.token);
    assert_eq!(lap.token.len(), 64);
    let (file, source) = changed("pirdayr-ex03.joint.json", "4560000.0", "4560000.5").unwrap();
    let other = fmu_bytes(&file, &source, &options(Interface::Lap).unwrap()).unwrap();
    assert_ne!(lap.token, other.token);
    for fmu in [&lap, &element, &other] {
        let xml = text(fmu, "modelDescription.xml").unwrap();
        assert!(xml.contains(&format!("instantiationToken=\"{}\"", fmu.token)));
        let start = text(fmu, "resources/start.txt").unwrap();
        assert!(start.contains(&format!("\ntoken {}\n", fmu.token)));
    }
}

#[test]
fn a_joint_with_rotation_keeps_every_variable_and_gets_its_values() {
    let (fmu, _) = export("m10-aluminium.joint.json", Interface::Element).unwrap();
    let declared = declared(&fmu).unwrap();
    let template = include_str!("../../modelDescription/element.xml");
    let template = Declared::from_xml("element.xml", template).unwrap();
    let names = |interface: &Declared| -> Vec<(String, u32)> {
        let variables = interface.variables.iter();
        variables
            .map(|variable| (variable.name.clone(), variable.reference))
            .collect()
    };
    assert_eq!(names(&declared), names(&template));
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
        assert_eq!(
            declared.variable(name).unwrap().start,
            Some(value),
            "{name}"
        );
    }
    assert_eq!(fmu.step, None);
    let xml = text(&fmu, "modelDescription.xml").unwrap();
    for fragment in [
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\" modelName=\"M10x16 A2-70 on 6 mm aluminium\"",
        "generationDateAndTime=\"2009-12-08T14:33:22Z\"",
        "generationTool=\"bolted-joint 0.1.0\"",
        // 1/(20 · 512 Hz) = 9.77e-5 s
        "<DefaultExperiment startTime=\"0\" stopTime=\"1\" stepSize=\"9.7e-5\"/>",
    ] {
        assert!(xml.contains(fragment), "{fragment}\n{xml}");
    }
    assert_eq!(
        text(&fmu, "resources/start.txt").unwrap(),
        format!(
            "bolted-joint-start/1\nmodel element\ndofs 2\ntoken {}\njoint.k_yy 573000.0\njoint.k_ytheta 5820.0\n\
             joint.k_thetatheta 1290.0\njoint.c_yy 10.83\njoint.c_ytheta -0.83\njoint.c_thetatheta 0.083\n\
             joint.k3_y 0.0\njoint.k3_theta 0.0\n",
            fmu.token
        )
    );
}

#[test]
fn a_joint_without_rotation_has_no_rotational_variable() {
    let (fmu, _) = export("pirdayr-ex03.joint.json", Interface::Lap).unwrap();
    let declared = declared(&fmu).unwrap();
    let names: Vec<&str> = declared
        .variables
        .iter()
        .map(|variable| variable.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "time",
            "a.y",
            "a.v",
            "b.y",
            "b.v",
            "a.F",
            "b.F",
            "joint.F",
            "energy.stored",
            "power.dissipated",
            "joint.k_yy",
            "joint.c_yy",
            "joint.k3_y",
            "a.m",
            "a.k_y",
            "a.c_y",
            "b.m",
            "b.k_y",
            "b.c_y",
            "step_size_max",
            "a.acceleration",
            "b.acceleration",
        ]
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
        assert_eq!(
            declared.variable(name).unwrap().start,
            Some(value),
            "{name}"
        );
    }
    let start = text(&fmu, "resources/start.txt").unwrap();
    assert_eq!(
        start.lines().skip(4).collect::<Vec<_>>(),
        [
            "joint.k_yy 4560000.0",
            "joint.c_yy 0.54",
            "joint.k3_y 1670.0",
            "a.m 2.35",
            "a.k_y 1056000.0",
            "a.c_y 1.39",
            "b.m 2.35",
            "b.k_y 1056000.0",
            "b.c_y 1.39",
            "step_size_max 3.1e-5",
        ]
    );
    assert!(start.starts_with("bolted-joint-start/1\nmodel lap\ndofs 1\ntoken "));
    assert_eq!(fmu.escape_amplitude, [None]);
}

#[test]
fn an_active_joint_is_refused_unless_the_user_insists() {
    // Tol Table 5.4: c_Mθ = 0 with c_Fθ = 1.20
    let (file, source) = changed(
        "m10-aluminium.joint.json",
        "[10.83, -0.83],\n      [-0.83, 0.083]",
        "[18.75, 1.2],\n      [1.2, 0.0]",
    )
    .unwrap();
    let mut options = options(Interface::Element).unwrap();
    let message = refusal(&file, &options);
    for fragment in [
        "joint.damping is active: smallest eigenvalue -7.6488e-2",
        "expected K and C positive semidefinite",
        "insist with --allow-active",
    ] {
        assert!(message.contains(fragment), "{message}");
    }
    assert!(!message.contains("joint.stiffness"), "{message}");
    options.allow_active = true;
    let fmu = fmu_bytes(&file, &source, &options).unwrap();
    assert!(!fmu.passivity.is_passive());
    let page = text(&fmu, "documentation/index.html").unwrap();
    assert!(page.contains("The joint is active"));
}

#[test]
fn what_cannot_be_exported_is_refused_with_a_reason() {
    let element = options(Interface::Element).unwrap();
    let lap = options(Interface::Lap).unwrap();
    let m10 = JointFile::read(&data("m10-aluminium.joint.json")).unwrap();
    let ex03 = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let over_preload = JointFile::read(&data("over-preload.joint.json")).unwrap();

    let message = refusal(&m10, &lap);
    assert!(
        message.starts_with("bodies: not found, expected the inertia"),
        "{message}"
    );
    let at = |preload_n_m| ExportOptions {
        preload_n_m: Some(preload_n_m),
        ..element.clone()
    };
    let message = refusal(&over_preload, &at(9.0));
    assert!(
        message.starts_with("preload: found 9.0 N·m, expected 10.0 to 25.0 N·m"),
        "{message}"
    );
    let message = refusal(&m10, &at(10.0));
    assert!(
        message.starts_with("preload: found 10.0 N·m for a joint that does not depend"),
        "{message}"
    );

    let with_step = |options: &ExportOptions, step_s| ExportOptions {
        step_size_max_s: Some(step_s),
        ..options.clone()
    };
    let message = refusal(&m10, &with_step(&element, 1e-5));
    assert!(
        message.starts_with("step size: found 1e-5 s for the element, expected none"),
        "{message}"
    );
    let message = refusal(&ex03, &with_step(&lap, 0.002));
    for fragment in [
        "step size: found 0.002 s, with which RK4 is unstable",
        "|λ| = 2.0809e3 1/s",
        "at most 0.00135 s",
    ] {
        assert!(message.contains(fragment), "{message}");
    }
    let message = refusal(&ex03, &with_step(&lap, -1.0));
    assert!(
        message.starts_with("step size: found -1.0 s, expected a finite number"),
        "{message}"
    );

    let mut broken = ex03.clone();
    broken.joint.stiffness[0][0] = f64::NAN;
    let message = refusal(&broken, &lap);
    assert!(
        message.contains("joint.stiffness[0][0]: found NaN"),
        "{message}"
    );
}

#[test]
fn a_given_stable_step_is_taken() {
    let file = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let options = ExportOptions {
        step_size_max_s: Some(2e-4),
        ..options(Interface::Lap).unwrap()
    };
    let fmu = fmu_bytes(&file, "", &options).unwrap();
    assert_eq!(
        declared(&fmu)
            .unwrap()
            .variable("step_size_max")
            .unwrap()
            .start,
        Some(2e-4)
    );
}

#[test]
fn a_softening_lap_tells_its_escape_amplitude() {
    let (file, source) = changed("pirdayr-ex03.joint.json", "1670.0", "-3e12").unwrap();
    let fmu = fmu_bytes(&file, &source, &options(Interface::Lap).unwrap()).unwrap();
    // √((k + 2 k12)/(−2 kN))
    let expected = ((10.56e5 + 2.0 * 4.56e6) / 6e12_f64).sqrt();
    assert!((fmu.escape_amplitude[0].unwrap() / expected - 1.0).abs() < 1e-12);
    let page = text(&fmu, "documentation/index.html").unwrap();
    // 0.00130231 m
    assert!(
        page.contains("The joint softens.") && page.contains("0.00130231 m"),
        "{page}"
    );
}

#[test]
fn libraries_of_other_platforms_go_into_the_same_fmu() {
    let folder = tempfile::tempdir().unwrap();
    let file = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let options = ExportOptions {
        platforms: Some(folder.path().to_path_buf()),
        ..options(Interface::Lap).unwrap()
    };
    let message = refusal(&file, &options);
    assert!(message.contains("found no platform's folder"), "{message}");
    let windows = folder.path().join("x86_64-windows");
    fs::create_dir(&windows).unwrap();
    let message = refusal(&file, &options);
    assert!(
        message.contains("bolted_joint.dll: not found, expected the FMU library"),
        "{message}"
    );
    fs::write(windows.join("bolted_joint.dll"), b"MZ not a real one").unwrap();
    let fmu = fmu_bytes(&file, "", &options).unwrap();
    assert_eq!(
        text(&fmu, "binaries/x86_64-windows/bolted_joint.dll").unwrap(),
        "MZ not a real one"
    );
    let platforms: Vec<&str> = fmu
        .libraries
        .iter()
        .map(|library| library.platform.as_str())
        .collect();
    assert!(platforms.contains(&"x86_64-windows"));
    assert!(platforms.len() == 2 || cfg!(all(windows, target_arch = "x86_64")));
}

#[test]
fn fmi_2_has_its_own_names_for_platforms() {
    let folder = tempfile::tempdir().unwrap();
    for (platform, file, magic) in [
        ("x86_64-windows", "bolted_joint.dll", b"MZ".as_slice()),
        ("x86_64-linux", "bolted_joint.so", b"\x7fELF"),
        ("x86_64-darwin", "bolted_joint.dylib", b"\xcf\xfa\xed\xfe"),
        ("aarch64-linux", "bolted_joint.so", b"\x7fELF"),
        ("aarch64-darwin", "bolted_joint.dylib", b"\xcf\xfa\xed\xfe"),
    ] {
        fs::create_dir(folder.path().join(platform)).unwrap();
        fs::write(folder.path().join(platform).join(file), magic).unwrap();
    }
    let file = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let options = ExportOptions {
        version: FmiVersion::V2,
        platforms: Some(folder.path().to_path_buf()),
        ..options(Interface::Lap).unwrap()
    };
    let fmu = fmu_bytes(&file, "", &options).unwrap();
    for path in [
        "binaries/win64/bolted_joint.dll",
        "binaries/linux64/bolted_joint.so",
        "binaries/darwin64/bolted_joint.dylib",
        "binaries/aarch64-linux/bolted_joint.so",
        "binaries/aarch64-darwin/bolted_joint.dylib",
    ] {
        bytes(&fmu, path).expect(path);
    }
}

#[test]
fn both_versions_read_the_same_start_values_with_tokens_of_their_own() {
    let [two, three] = [FmiVersion::V2, FmiVersion::V3].map(|version| {
        let (fmu, _) = export_as("pirdayr-ex03.joint.json", Interface::Lap, version).unwrap();
        assert_eq!(fmu.version, version);
        let attribute = match version {
            FmiVersion::V2 => "guid",
            FmiVersion::V3 => "instantiationToken",
        };
        let xml = text(&fmu, "modelDescription.xml").unwrap();
        assert!(xml.contains(&format!(" {attribute}=\"{}\"", fmu.token)));
        (text(&fmu, "resources/start.txt").unwrap(), fmu.token)
    });
    assert_ne!(two.1, three.1);
    assert_eq!(two.0.replace(&two.1, &three.1), three.0);
}

#[test]
fn user_text_stays_text() {
    let name = "M8 <script>alert('&')</script>";
    let (file, source) = changed(
        "m10-aluminium.joint.json",
        "M10x16 A2-70 on 6 mm aluminium",
        name,
    )
    .unwrap();
    let fmu = fmu_bytes(&file, &source, &options(Interface::Element).unwrap()).unwrap();
    assert_eq!(fmu.model_name, name);
    let page = text(&fmu, "documentation/index.html").unwrap();
    assert!(!page.contains("<script"));
    assert!(page.contains("M8 &lt;script&gt;alert(&#39;&amp;&#39;)&lt;/script&gt;"));
    let xml = text(&fmu, "modelDescription.xml").unwrap();
    assert!(xml.contains("modelName=\"M8 &lt;script&gt;alert(&apos;&amp;&apos;)&lt;/script&gt;\""));
}

#[test]
fn the_page_tells_what_the_joint_file_knows() {
    let (fmu, _) = export("m10-aluminium.joint.json", Interface::Element).unwrap();
    let page = text(&fmu, "documentation/index.html").unwrap();
    for fragment in [
        "573000 ± 1100 N/m",
        "5820 ± 95 N·m/m",
        "−0.83 ± 0.05 N·s/rad",
        "0.083 ± 0.009 N·m·s/rad",
        "from 5 to 512 Hz",
        "3.1 %",
        "1015 lines",
        "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
        "Tol, Table 5.3",
        "<svg ",
        "prefers-color-scheme: dark",
        "The joint is passive",
        &fmu.token,
    ] {
        assert!(page.contains(fragment), "{fragment}");
    }
    assert!(
        !page.contains("http:") && !page.contains("https:"),
        "the page needs no network"
    );
}

#[test]
fn the_fmu_is_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let (fmu, _) = export("pirdayr-ex03.joint.json", Interface::Lap).unwrap();
    let path = folder.path().join("ex03.fmu");
    fs::write(&path, "old").unwrap();
    fmu.write(&path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), fmu.bytes());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);

    let message = fmu
        .write(&folder.path().join("missing/ex03.fmu"))
        .unwrap_err()
        .to_string();
    assert!(message.contains("ex03.fmu: cannot be written"), "{message}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
