//! The FMU as importers and users meet it: its files, its interface, what it refuses.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod description;
mod files;
mod terminals;
mod variables;
mod xml;
mod zip;

use bolted_joint_testing::{begins, close, has};
use std::fs;
use std::io::{Cursor, Read as _};
use std::path::{Path, PathBuf};

use ::zip::ZipArchive;
use bolted_joint::export::{
    ExportError, ExportOptions, Exported, FmiVersion, Interface, StepWish, Timestamp, fmu_bytes,
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
        model_identifier: None,
        step: StepWish::Accurate,
        platforms: None,
        preload_n_m: None,
        extrapolate: false,
        allow_active: false,
        allow_unusable: false,
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
fn an_active_joint_is_refused_unless_the_user_insists() {
    // Tol Table 5.4: c_Mθ = 0 with c_Fθ = 1.20
    let passive = "[10.83, -0.83],\n      [-0.83, 0.083]";
    let active = "[18.75, 1.2],\n      [1.2, 0.0]";
    let (file, source) = changed("m10-aluminium.joint.json", passive, active).unwrap();
    let mut options = options(Interface::Element).unwrap();
    let message = refusal(&file, &options);
    let found = "joint.damping is active: smallest eigenvalue -7.6488e-2";
    has(&message, &[found, "expected K and C positive semidefinite"]);
    has(&message, &["insist with --allow-active"]);
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
    begins(&message, "bodies: not found, expected the inertia");
    let at = |preload_n_m| ExportOptions {
        preload_n_m: Some(preload_n_m),
        ..element.clone()
    };
    let expected = "preload: found 9.0 N·m, expected 10.0 to 25.0 N·m";
    begins(&refusal(&over_preload, &at(9.0)), expected);
    let expected = "preload: found 10.0 N·m for a joint that does not depend";
    begins(&refusal(&m10, &at(10.0)), expected);

    let with_step = |options: &ExportOptions, step_s| ExportOptions {
        step: StepWish::AtMost(step_s),
        ..options.clone()
    };
    let message = refusal(&m10, &with_step(&element, 1e-5));
    begins(
        &message,
        "step size: found 1e-5 s for the element, expected none",
    );
    let message = refusal(&ex03, &with_step(&lap, 0.002));
    let unstable = "step size: found 0.002 s, with which RK4 is unstable";
    has(
        &message,
        &[unstable, "|λ| = 2.0809e3 1/s", "at most 0.00135 s"],
    );
    let message = refusal(&ex03, &with_step(&lap, -1.0));
    begins(
        &message,
        "step size: found -1.0 s, expected a finite number",
    );

    let mut broken = ex03.clone();
    broken.joint.stiffness[0][0] = f64::NAN;
    let message = refusal(&broken, &lap);
    has(&message, &["joint.stiffness[0][0]: found NaN"]);
}

#[test]
fn a_softening_lap_tells_its_escape_amplitude() {
    let (file, source) = changed("pirdayr-ex03.joint.json", "1670.0", "-3e12").unwrap();
    let fmu = fmu_bytes(&file, &source, &options(Interface::Lap).unwrap()).unwrap();
    // √((k + 2 k12)/(−2 kN))
    let expected = ((10.56e5 + 2.0 * 4.56e6) / 6e12_f64).sqrt();
    close(fmu.escape_amplitude[0].unwrap(), expected, 1e-12);
    let page = text(&fmu, "documentation/index.html").unwrap();
    // 0.00130231 m
    has(&page, &["The joint softens.", "0.00130231 m"]);
}

#[test]
fn user_text_stays_text() {
    let name = "M8 <script>alert('&')</script>";
    let old = "M10x16 A2-70 on 6 mm aluminium";
    let (file, source) = changed("m10-aluminium.joint.json", old, name).unwrap();
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
    has(&page, &["573000 ± 1100 N/m", "5820 ± 95 N·m/m"]);
    has(&page, &["−0.83 ± 0.05 N·s/rad", "0.083 ± 0.009 N·m·s/rad"]);
    has(&page, &["from 5 to 512 Hz", "3.1 %", "1015 lines"]);
    let hash = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
    has(&page, &[hash, "Tol, Table 5.3", &fmu.token]);
    has(&page, &["<svg ", "prefers-color-scheme: dark"]);
    has(&page, &["The joint is passive"]);
    let needs_network = page.contains("http:") || page.contains("https:");
    assert!(!needs_network);
}
