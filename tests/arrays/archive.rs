//! NumPy archives.

use bolted_joint_testing::has;
use std::io::{Cursor, Write as _};

use bolted_joint::frf::{
    ReadOptions, Selection, UnitSystem, read_frfs, read_npz_from, structure::NamedMatrices,
};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::{FACTORS, dof, has_variance, is_oscillator, message, own_file, set};

#[test]
fn every_order_precision_and_compression_gives_the_oscillator() {
    is_oscillator(&set("stored.npz"), &FACTORS, 1e-14);
    is_oscillator(&set("fortran_big_endian.npz"), &FACTORS[..4], 1e-14);
    let first = set("frequency_first.npz");
    is_oscillator(&first, &FACTORS, 1e-6);
    has_variance(&first, 1e-7);
    assert_eq!(first.averages(), Some(10.0));
    let column = [FACTORS[0], FACTORS[2], FACTORS[4]];
    is_oscillator(&set("column.npz"), &column, 1e-14);
}

#[test]
fn a_square_matrix_needs_its_axes_named() {
    let found = message("square.npz");
    has(
        &found,
        &[
            "square.npz: array frf: found shape [7, 2, 2]",
            "(frequency,response,reference) or (frequency,reference,response)",
            "axes=\"frequency,response,reference\"",
        ],
    );
    // Stated to be transposed: element (i, j) of the matrix is reference i and response j.
    let pairs = [
        ("2:+Y", "2:+Y", 1.0),
        ("3:+Y", "2:+Y", 0.5),
        ("2:+Y", "3:+Y", -2.0),
        ("3:+Y", "3:+Y", 3.0),
    ];
    is_oscillator(&set("square_with_axes.npz"), &pairs, 1e-14);
}

#[test]
fn what_is_no_archive_of_functions_is_refused_by_name() {
    assert!(message("single.npy").contains("expected an archive (.npz)"));
    let found = message("pickled.npz");
    has(&found, &["array response: found type \"|O\""]);
    let unstated = read_frfs(own_file("stored.npz"), &ReadOptions::default()).unwrap();
    assert!(!unstated.units_are_stated());
}

#[test]
fn only_what_is_asked_for_is_kept_and_units_can_be_stated() {
    let options = ReadOptions {
        units: UnitSystem::named("mm", "kN"),
        selection: Selection::between([dof("13:-RZ"), dof("2:Y")]).within(7.5, 10.0),
        ..ReadOptions::default()
    };
    for name in ["stored.npz", "frequency_first.npz"] {
        let reading = read_frfs(own_file(name), &options).unwrap();
        assert!(reading.units_are_stated());
        assert_eq!(reading.not_selected.len(), 5);
        let [function] = reading.functions() else {
            panic!()
        };
        assert_eq!(function.frequency_hz(), [7.5, 10.0]);
        // rad/kN = 1e-3 rad/N
        let expected = 0.25e-3 * super::oscillator(7.5);
        assert!((function.receptance()[0] - expected).norm() <= 1e-6 * expected.norm());
    }
}

/// An archive with arrays of these names, each of one number.
fn archive_of(names: &[&str]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for name in names {
        zip.start_file(format!("{name}.npy"), SimpleFileOptions::default())
            .unwrap();
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), }\n";
        zip.write_all(b"\x93NUMPY\x01\x00").unwrap();
        zip.write_all(&(header.len() as u16).to_le_bytes()).unwrap();
        zip.write_all(header.as_bytes()).unwrap();
        zip.write_all(&1.0_f64.to_le_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// What is missing is told with the arrays of its own kind: matrices have no frequencies, functions no points.
#[test]
fn functions_and_matrices_are_told_apart_where_arrays_are_missing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.npz");
    let matrices = archive_of(&["M", "K", "C"]);
    std::fs::write(&path, &matrices).unwrap();
    let refused = NamedMatrices::read(&path).unwrap_err().to_string();
    has(
        &refused,
        &[
            "found the arrays M, K, C, expected points",
            "numpy.savez(file, M=…, K=…, C=…, points=[…])",
        ],
    );
    assert!(!refused.contains("frf"), "{refused}");
    let read = |bytes: Vec<u8>| {
        let refused = read_npz_from(Cursor::new(bytes), "b.npz", &ReadOptions::default());
        refused.unwrap_err().to_string()
    };
    let refused = read(matrices);
    has(&refused, &["matrices of a structure", "the key `matrices`"]);
    assert!(!refused.contains("numpy.savez"), "{refused}");
    let refused = read(archive_of(&["frf"]));
    has(
        &refused,
        &[
            "expected frequency (Hz)",
            "numpy.savez(file, frequency=…, frf=…, response=…, reference=…)",
        ],
    );
}

/// A small file in which a deflated matrix of zeros stands for more functions than there is memory for.
#[test]
fn a_swollen_matrix_is_refused_before_its_functions_are_made() {
    const NAMES: usize = 1100;
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut array = |name: &str, descr: &str, shape: String, bytes: &[u8]| {
        let options = SimpleFileOptions::default();
        zip.start_file(format!("{name}.npy"), options).unwrap();
        let header =
            format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n");
        zip.write_all(b"\x93NUMPY\x01\x00").unwrap();
        zip.write_all(&(header.len() as u16).to_le_bytes()).unwrap();
        zip.write_all(header.as_bytes()).unwrap();
        zip.write_all(bytes).unwrap();
    };
    let names: String = (1..=NAMES).map(|node| format!("{node:04}:Y")).collect();
    array("f", "<f8", "(1,)".to_owned(), &1.0_f64.to_le_bytes());
    array("response", "|S6", format!("({NAMES},)"), names.as_bytes());
    array("reference", "|S6", format!("({NAMES},)"), names.as_bytes());
    let zeros = vec![0; NAMES * NAMES];
    array("mobility", "|u1", format!("(1, {NAMES}, {NAMES})"), &zeros);
    array(
        "axes",
        "|S28",
        "()".to_owned(),
        b"frequency,response,reference",
    );
    let bytes = zip.finish().unwrap().into_inner();
    assert!(bytes.len() < 20_000, "{}", bytes.len());
    let refused = read_npz_from(Cursor::new(bytes), "swollen.npz", &ReadOptions::default());
    assert_eq!(
        refused.unwrap_err().to_string(),
        "swollen.npz: found the names of 1100 responses and 1100 references, expected at most 1048576 functions between them; \
         save only those that are needed"
    );
}
