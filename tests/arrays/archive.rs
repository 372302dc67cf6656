//! NumPy archives.

use bolted_joint::frf::{ReadOptions, Selection, UnitSystem, read_frfs};

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
    for part in [
        "square.npz: array frf: found shape [7, 2, 2]",
        "(frequency,response,reference) or (frequency,reference,response)",
        "axes=\"frequency,response,reference\"",
    ] {
        assert!(found.contains(part), "{found}");
    }
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
    assert!(
        found.contains("array response: found type \"|O\""),
        "{found}"
    );
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
        assert_eq!(reading.not_selected().len(), 5);
        let [function] = reading.functions() else {
            panic!()
        };
        assert_eq!(function.frequency_hz(), [7.5, 10.0]);
        // rad/kN = 1e-3 rad/N
        let expected = 0.25e-3 * super::oscillator(7.5);
        assert!((function.receptance()[0] - expected).norm() <= 1e-6 * expected.norm());
    }
}
