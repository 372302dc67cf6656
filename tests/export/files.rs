//! The archive: which files it has, that they depend on the input alone, and that they come whole or not at all.

use bolted_joint_testing::has;
use std::fs;
use std::io::Cursor;

use ::zip::ZipArchive;
use bolted_joint::export::{
    ExportOptions, FmiVersion, Interface, LibrarySource, Timestamp, fmu_bytes,
};
use bolted_joint::joint::JointFile;

use crate::{bytes, changed, data, export, export_as, options, refusal, text};

#[test]
fn the_fmu_has_the_files_of_the_standard() {
    let (fmu, source) = export("m10-aluminium.joint.json", Interface::Element).unwrap();
    let paths: Vec<&str> = fmu.entries().iter().map(|entry| &*entry.path).collect();
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
    assert_eq!(fmu.libraries().len(), 1);
    assert_eq!(fmu.libraries()[0].source, LibrarySource::Embedded);
    let platform = &fmu.libraries()[0].platform;
    let name = format!("binaries/{platform}/M10x16_A2_70_on_6_mm_aluminium_element.");
    assert!(library.starts_with(&name), "{library}");
    assert_eq!(text(&fmu, "resources/joint.json").unwrap(), source);

    let mut archive = ZipArchive::new(Cursor::new(fmu.bytes())).unwrap();
    for i in 0..archive.len() {
        let file = archive.by_index(i).unwrap();
        assert_eq!(file.name().unwrap(), paths[i]);
        assert_eq!(file.size(), fmu.entries()[i].size as u64);
        let extra = file.extra_data().unwrap_or_default();
        assert!(extra.is_empty(), "{}", paths[i]);
        let is_library = paths[i] == *library;
        let mode = if is_library { 0o100_755 } else { 0o100_644 };
        assert_eq!(file.unix_mode(), Some(mode), "{}", paths[i]);
        let date = file.last_modified().unwrap();
        assert_eq!(date.to_string(), "2009-12-08 14:33:22");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let [first, second] =
        [(); 2].map(|()| export("pirdayr-ex03.joint.json", Interface::Lap).unwrap().0);
    assert_eq!(first.bytes(), second.bytes());

    let (file, source) = JointFile::read_with_source(&data("pirdayr-ex03.joint.json")).unwrap();
    let later = ExportOptions {
        date: Timestamp::from_epoch_text("1260282902").unwrap(),
        ..options(Interface::Lap).unwrap()
    };
    let later = fmu_bytes(&file, &source, &later).unwrap();
    assert_ne!(first.bytes(), later.bytes());
    // The date is no part of the interface.
    assert_eq!(first.token, later.token);
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
fn libraries_of_other_platforms_go_into_the_same_fmu() {
    let folder = tempfile::tempdir().unwrap();
    let file = JointFile::read(&data("pirdayr-ex03.joint.json")).unwrap();
    let options = ExportOptions {
        platforms: Some(folder.path().to_path_buf()),
        model_identifier: Some("swing".to_owned()),
        ..options(Interface::Lap).unwrap()
    };
    has(&refusal(&file, &options), &["found no platform's folder"]);
    let windows = folder.path().join("x86_64-windows");
    fs::create_dir(&windows).unwrap();
    let absent = "bolted_joint.dll: not found, expected the FMU library";
    has(&refusal(&file, &options), &[absent]);
    fs::write(windows.join("bolted_joint.dll"), b"MZ not a real one").unwrap();
    let fmu = fmu_bytes(&file, "", &options).unwrap();
    let library = text(&fmu, "binaries/x86_64-windows/swing.dll").unwrap();
    assert_eq!(library, "MZ not a real one");
    let libraries = fmu.libraries().iter();
    let platforms: Vec<&str> = libraries.map(|library| &*library.platform).collect();
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
        model_identifier: Some("swing".to_owned()),
        ..options(Interface::Lap).unwrap()
    };
    let fmu = fmu_bytes(&file, "", &options).unwrap();
    for path in [
        "binaries/win64/swing.dll",
        "binaries/linux64/swing.so",
        "binaries/darwin64/swing.dylib",
        "binaries/aarch64-linux/swing.so",
        "binaries/aarch64-darwin/swing.dylib",
    ] {
        bytes(&fmu, path).expect(path);
    }
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

    let missing = folder.path().join("missing/ex03.fmu");
    let refused = fmu.write(&missing).unwrap_err().to_string();
    has(&refused, &["ex03.fmu: cannot be written"]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
