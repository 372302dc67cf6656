//! Tables.

use bolted_joint::frf::{
    FrfError, FrfReading, Quantity, ReadOptions, Selection, TableProblem, UnitSystem, read_csv_from,
};
use num_complex::Complex64;

use super::{FACTORS, dof, has_variance, is_oscillator, set};

fn read(text: impl AsRef<[u8]>) -> Result<FrfReading, FrfError> {
    read_csv_from(text.as_ref(), "memory.csv", &ReadOptions::default())
}

/// The line and the problem of a table that is not usable.
fn problem_of(text: impl AsRef<[u8]>) -> (usize, TableProblem) {
    match read(text).unwrap_err() {
        FrfError::Csv { line, problem, .. } => (line, *problem),
        other => panic!("{other}"),
    }
}

#[test]
fn a_table_of_numpy_gives_the_oscillator() {
    let set = set("table.csv");
    is_oscillator(&set, &FACTORS, 1e-13);
    has_variance(&set, 1e-12);
}

const SMALL: &str = "# measured on the bench
# quantity = receptance
frequency [Hz],11:+Y/2:+Y real,11:+Y/2:+Y imaginary
1,0.5,-1.5
2.5,1e-3,2E+4
";

#[test]
fn a_small_table_is_good_in_every_dress() {
    let expected = [Complex64::new(0.5, -1.5), Complex64::new(1e-3, 2e4)];
    let semicolons = SMALL.replace(',', ";");
    for dress in [
        SMALL.to_owned(),
        SMALL.replace('\n', "\r\n"),
        format!("\u{feff}{SMALL}"),
        SMALL.trim_end().to_owned(),
        semicolons.clone(),
        semicolons
            .replace("0.5", "0,5")
            .replace("1.5", "1,5")
            .replace("2.5", "2,5"),
        SMALL.replace(',', "\t"),
        SMALL
            .replace("# quantity = receptance\n", "")
            .replace(" real", " receptance real"),
        SMALL
            .replace("# quantity = receptance\n", "")
            .replace(" real", " real [m/N]"),
        SMALL.replace("# quantity = receptance", "# unit: m/N"),
        SMALL.replace("11:+Y/2:+Y real", " \"11:Y/2:Y RE\" "),
        format!("{SMALL}\n# the end\n"),
    ] {
        let reading = read(&dress).unwrap_or_else(|error| panic!("{dress}: {error}"));
        let [function] = reading.functions() else {
            panic!()
        };
        assert_eq!(
            (function.response(), function.reference()),
            (dof("11:Y"), dof("2:Y"))
        );
        assert_eq!(function.receptance(), expected, "{dress}");
        assert_eq!(function.frequency_hz(), [1.0, 2.5]);
    }
    let latin_1: Vec<u8> = SMALL
        .replace("bench", "pr\u{fc}fstand")
        .chars()
        .map(|c| c as u8)
        .collect();
    assert_eq!(read(latin_1).unwrap().functions()[0].receptance(), expected);
}

#[test]
fn degrees_and_radians_are_told_apart() {
    for (unit, quarter) in [
        ("deg", 90.0),
        ("rad", std::f64::consts::FRAC_PI_2),
        ("°", 90.0),
    ] {
        let text = format!("f,1:Y/2:Y magnitude [mm/N],1:Y/2:Y phase [{unit}]\n1,2,{quarter}\n");
        let value = read(text).unwrap().functions()[0].receptance()[0];
        assert!(
            (value - Complex64::new(0.0, 2e-3)).norm() < 1e-18,
            "{value}"
        );
    }
}

#[test]
fn complex_columns_decibels_and_a_row_of_units_are_the_same_numbers() {
    let plain = "f,1:Y/2:Y real [mm/s^2/N],1:Y/2:Y imaginary\n1,3,-4\n2,0.5,2\n";
    let expected = read(plain).unwrap();
    let db = |x: f64, y: f64| (20.0 * x.hypot(y).log10(), y.atan2(x).to_degrees());
    let [(one, first), (two, second)] = [db(3.0, -4.0), db(0.5, 2.0)];
    for dress in [
        "f,1:Y/2:Y complex [mm/s^2/N]\n1,3-4j\n2,(0.5+2e0j)\n".to_owned(),
        "f;1:Y/2:Y complex [mm/s^2/N]\n1;3-4i\n2;0,5+2i\n".to_owned(),
        "f,1:Y/2:Y real,1:Y/2:Y imaginary\nHz,mm/s^2/N,mm/s^2/N\n1,3,-4\n2,0.5,2\n".to_owned(),
        "Frequency (Hz),1:Y/2:Y real (mm/s^2/N),1:Y/2:Y imaginary\n1,3,-4\n2,0.5,2\n".to_owned(),
        "freq_Hz;1:Y/2:Y real [mm/s^2/N];1:Y/2:Y imaginary\n1;3;-4\n2;0,5;2\n".to_owned(),
        "f,1:Y/2:Y [mm/s^2/N],1:Y/2:Y\nHz,real,imag\n1,3,-4\n2,0.5,2\n".to_owned(),
        "f;1:Y/2:Y accelerance;\n;re [mm/s^2/N];im\n1;3;-4\n2;0,5;2\n".to_owned(),
        "f,1:Y/2:Y,1:Y/2:Y\n,real accelerance,imaginary\nHz,mm/s^2/N,\n1,3,-4\n2,0.5,2\n"
            .to_owned(),
        "f\t1:Y/2:Y real\t1:Y/2:Y imaginary\n[Hz]\t[mm/s^2/N]\t-\n1\t3\t-4\n2\t0.5\t2\n".to_owned(),
        format!(
            "f,1:Y/2:Y magnitude [dB re 1 mm/s^2/N],1:Y/2:Y phase [deg]\n1,{one},{first}\n2,{two},{second}\n"
        ),
        format!(
            "f,1:Y/2:Y magnitude,1:Y/2:Y phase\nHz,dB re 1e-3 m/s^2/N,deg\n\n# now numbers\n1,{one},{first}\n2,{two},{second}\n"
        ),
        format!(
            "# unit = dB (re 1e-6 m/s^2/N)\nf,1:Y/2:Y magnitude,1:Y/2:Y phase [deg]\n1,{},{first}\n2,{},{second}\n",
            one + 60.0,
            two + 60.0
        ),
    ] {
        let found = read(&dress).unwrap_or_else(|error| panic!("{dress}: {error}"));
        let pairs = found.functions()[0]
            .receptance()
            .iter()
            .zip(expected.functions()[0].receptance());
        for (found, expected) in pairs {
            assert!(
                (found - expected).norm() < 1e-13 * expected.norm(),
                "{dress}: {found} {expected}"
            );
        }
    }
}

#[test]
fn coherences_may_be_in_a_table_of_their_own() {
    let functions = "f,1:Y/2:Y complex [m/N],3:Y/2:Y complex [m/N]\n1,3-4j,1j\n2,1+j,2\n";
    let coherences =
        "# averages = 10\nf,3:Y/2:Y coherence,1:Y/2:Y coherence\nHz,,-\n1,0.9,0.5\n2,0.8,1\n";
    let alone = read(coherences).unwrap();
    assert!(alone.functions().is_empty());
    let refused = alone.clone().into_set().unwrap_err().to_string();
    assert!(refused.contains("found coherences alone"), "{refused}");
    let both = read(functions).unwrap().with_coherences_of(alone).unwrap();
    let set = both.into_set().unwrap();
    assert_eq!(
        set.coherence(dof("1:Y"), dof("2:Y")),
        Some([0.5, 1.0].as_slice())
    );
    // |H|² (1 − γ²)/(n γ²) is 0.1/9 and 4·0.2/8; both lines together times n/(2 (n − 1) − 1)
    let variance = set.relative_variance(dof("3:Y"), dof("2:Y")).unwrap()[0];
    let expected = (0.1 / 9.0 + 0.1) * 10.0 / 17.0;
    assert!((variance / expected - 1.0).abs() < 1e-14, "{variance}");
    let no_coherence = read(functions).unwrap();
    let refused = read(functions)
        .unwrap()
        .with_coherences_of(no_coherence)
        .unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("memory.csv: found no coherence"),
        "{refused}"
    );
    let other = read("# averages = 5\n".to_owned() + functions).unwrap();
    let refused = other
        .with_coherences_of(read(coherences).unwrap())
        .unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("states 10 averages, and the file before it 5"),
        "{refused}"
    );
}

#[test]
fn files_with_a_reference_each_make_one_set() {
    let of = |reference: &str, lines: &str| {
        read(format!("f,1:Y/{reference} complex [m/N]\n{lines}")).unwrap()
    };
    let [first, second] = [of("2:Y", "1,1j\n2,2j\n"), of("3:Y", "1,3j\n2,4j\n")];
    let set = FrfReading::joined(vec![first.clone(), second])
        .unwrap()
        .into_set()
        .unwrap();
    assert_eq!(set.functions().len(), 2);
    assert_eq!(set.receptance(dof("1:Y"), dof("3:Y")).unwrap()[1].im, 4.0);
    for (other, said) in [
        (
            first.clone(),
            "has the function 1:+Y / 2:+Y, which memory.csv has as well",
        ),
        (of("3:Y", "1,3j\n2.5,4j\n"), "have different frequencies"),
        (of("3:Y", "1,3j\n"), "have different frequencies"),
    ] {
        let refused = FrfReading::joined(vec![first.clone(), other])
            .unwrap_err()
            .to_string();
        assert!(refused.contains(said), "{refused}");
    }
}

#[test]
fn every_fault_is_located_and_named() {
    let header = |columns: &str| format!("frequency [Hz],{columns}\n1,2,3\n");
    #[rustfmt::skip]
    let cases = [
        ("".to_owned(), 1, "no header row"),
        ("# only a comment\n".to_owned(), 2, "no header row"),
        ("1,2,3\n".to_owned(), 1, "column 1: found \"1\""),
        ("frequency [kHz],1:Y/2:Y real,1:Y/2:Y imaginary\n".to_owned(), 1, "frequency [kHz]"),
        ("omega,1:Y/2:Y real,1:Y/2:Y imaginary\n".to_owned(), 1, "omega"),
        (header("1:Y real,1:Y imaginary"), 1, "column 2: found the name \"1:Y real\""),
        (header("1:Y/2:W real,1:Y/2:W imaginary"), 1, "direction \"W\""),
        (header("1:Y/2:Y [m/N],1:Y/2:Y imaginary"), 1, "column 2"),
        (header("1:Y/2:Y real part,1:Y/2:Y imaginary"), 1, "column 2"),
        (header("1:Y/2:Y real [m/N],1:Y/3:Y imaginary"), 1, "found real part, expected"),
        (header("1:Y/2:Y real [m/N],1:Y/2:Y phase [deg]"), 1, "real part and phase"),
        (header("1:Y/2:Y magnitude [m/N],1:Y/2:Y phase"), 1, "column 3: found a phase in \"no unit\""),
        (header("1:Y/2:Y real [m/N],1:Y/2:Y real [m/N]"), 1, "a second real part"),
        (header("1:Y/2:Y complex [m/N],1:Y/2:Y real"), 1, "found real part and complex value"),
        (header("1:Y/2:Y magnitude [dB],1:Y/2:Y phase [deg]"), 1, "the unit \"dB\", expected decibels with what 0 dB is"),
        (header("1:Y/2:Y magnitude [dB re 1],1:Y/2:Y phase [deg]"), 1, "what 0 dB is"),
        (header("1:Y/2:Y magnitude [dB re 1 V/N],1:Y/2:Y phase [deg]"), 1, "the unit \"V/N\""),
        (header("1:Y/2:Y real [dB re 1 m/N],1:Y/2:Y imaginary"), 1, "real and imaginary parts in \"dB re 1 m/N\""),
        (header("1:Y/2:Y coherence,3:Y/2:Y real [m/N]"), 1, "found a coherence alone"),
        ("f,1:Y/2:Y real,1:Y/2:Y imaginary\nkHz,m/N,m/N\n1,2,3\n".to_owned(), 2, "the unit \"kHz\", expected Hz"),
        ("f,1:Y/2:Y real,1:Y/2:Y imaginary\nHz,m/N\n1,2,3\n".to_owned(), 2, "a row of 2 units, expected 3"),
        ("f,1:Y/2:Y real [m/N],1:Y/2:Y imaginary\nHz,mm/N,mm/N\n1,2,3\n".to_owned(), 2, "column 2: found the unit \"mm/N\" below a name with the unit \"m/N\""),
        ("f,1:Y/2:Y real,1:Y/2:Y imaginary\nHz,m/N,mm/N\n1,2,3\n".to_owned(), 1, "\"m/N\" in one column and \"mm/N\""),
        ("f,1:Y/2:Y real,1:Y/2:Y imaginary\nHz,furlong/N,\n1,2,3\n".to_owned(), 1, "the unit \"furlong/N\""),
        ("f,1:Y/2:Y real,1:Y/2:Y imaginary\nHz,m/N,m/N\nHz,m/N,m/N\n".to_owned(), 3, "column 1: found \"Hz\""),
        ("f,1:Y/2:Y,1:Y/2:Y\nHz,real,imga\n1,2,3\n".to_owned(), 2, "column 3: found \"imga\" below the name \"1:Y/2:Y\", expected one of real, imaginary"),
        ("f,1:Y/2:Y,1:Y/2:Y\nHz,real,\n1,2,3\n".to_owned(), 2, "column 3: found \"\" below the name \"1:Y/2:Y\""),
        ("f,1:Y/2:Y real,1:Y/2:Y\nHz,real,imag\n1,2,3\n".to_owned(), 2, "column 2: found \"real\" below the name \"1:Y/2:Y real\", expected it in the name or below it"),
        ("f,1:Y/2:Y [m/N],1:Y/2:Y\nHz,real [mm/N],imag\n1,2,3\n".to_owned(), 2, "column 2: found \"real [mm/N]\" below the name \"1:Y/2:Y [m/N]\", expected the same unit"),
        ("f,1:Y/2:Y,1:Y/2:Y\n1,2,3\n".to_owned(), 1, "column 2: found the name \"1:Y/2:Y\""),
        ("f,1:Y/2:Y complex [m/N]\n1,1+2\n".to_owned(), 2, "column 2: found \"1+2\", expected a number such as 1.2+3.4j"),
        ("f,1:Y/2:Y complex [m/N]\n1,\n".to_owned(), 2, "column 2: found \"\""),
        ("f;1:Y/2:Y complex [m/N]\n1;1,5+2.5j\n".to_owned(), 2, "commas and points"),
        ("f,1:Y/2:Y complex [m/N]\n1,nan+2j\n".to_owned(), 2, ": found value "),
        ("f,1:Y/2:Y magnitude [dB re 1 m/N],1:Y/2:Y phase [deg]\n1,1e5,0\n".to_owned(), 2, ": found value "),
        (header("1:Y/2:Y real [m/N],1:Y/2:Y imaginary [mm/N]"), 1, "\"m/N\" in one column and \"mm/N\""),
        (header("1:Y/2:Y real,1:Y/2:Y imaginary"), 1, "neither a quantity nor a unit"),
        (header("1:Y/2:Y real mobility [m/N],1:Y/2:Y imaginary"), 1, "means receptance"),
        (header("1:Y/2:Y real [dB],1:Y/2:Y imaginary"), 1, "the unit \"dB\""),
        (header("1:Y/2:Y real [N/m],1:Y/2:Y imaginary"), 1, "the unit \"N/m\""),
        (header("1:RZ/2:Y real [m/N],1:RZ/2:Y imaginary"), 1, "directions"),
        (SMALL.replace("receptance", "stiffness"), 2, "quantity = \"stiffness\""),
        (SMALL.replace("quantity = receptance", "averages = 0"), 2, "averages = \"0\""),
        (SMALL.replace("0.5,-1.5", "0,5,-1,5"), 4, "found 5 fields, expected 3"),
        (SMALL.replace("0.5,-1.5", "0.5"), 4, "found 2 fields"),
        (SMALL.replace("-1.5", "-1.5x"), 4, "column 3: found \"-1.5x\""),
        (SMALL.replace("-1.5", ""), 4, "column 3: found \"\""),
        (SMALL.replace(',', ";").replace("0.5", "0,5"), 4, "commas and points"),
        (SMALL.replace(',', ";").replace("2E+4", "2.000,5"), 5, "separators of thousands"),
        (SMALL.replace("-1.5", "NaN"), 4, ": found value "),
        (SMALL.replace("2.5,1e", "1,1e"), 5, "column 1: found frequency 1 Hz after 1 Hz"),
        (SMALL.lines().take(3).collect::<Vec<_>>().join("\n"), 3, "no usable line"),
        ("f,1:Y/2:Y magnitude [m/N],1:Y/2:Y phase [deg]\n1,-2,0\n".to_owned(), 2, "magnitude -2"),
        ("f,1:Y/2:Y real [m/N],1:Y/2:Y imaginary,1:Y/2:Y coherence\n1,2,3,98\n".to_owned(), 1, "found 98, expected a number from 0 to 1"),
    ];
    for (text, line, named) in cases {
        let (found_line, problem) = problem_of(&text);
        let message = problem.to_string();
        assert!(message.contains(named), "{text}: {message}");
        assert_eq!(found_line, line, "{text}: {message}");
    }
    for (bytes, named) in [
        (b"\xFF\xFEf\0".to_vec(), "UTF-16"),
        (vec![b'x'; 2 << 20], "a line of more than"),
    ] {
        let (line, problem) = problem_of(bytes);
        assert!(problem.to_string().contains(named), "{problem}");
        assert_eq!(line, 1);
    }
}

#[test]
fn the_callers_word_settles_what_contradicts_itself() {
    let text = "f,1:Y/2:Y mobility real [mm/N],1:Y/2:Y imaginary\n1,2,3\n";
    let options = ReadOptions {
        quantity: Some(Quantity::Receptance),
        ..ReadOptions::default()
    };
    let value = |options: &ReadOptions| {
        read_csv_from(text.as_bytes(), "m", options)
            .unwrap()
            .functions()[0]
            .receptance()[0]
    };
    assert!((value(&options) - Complex64::new(2e-3, 3e-3)).norm() < 1e-18);
    let units = ReadOptions {
        units: UnitSystem::named("m", "kN"),
        ..options
    };
    assert!((value(&units) - Complex64::new(2e-3, 3e-3)).norm() < 1e-18);
}

#[test]
fn only_what_is_asked_for_is_kept() {
    let options = ReadOptions {
        selection: Selection::between([dof("1:Y"), dof("2:Y")]).within(2.0, 3.0),
        ..ReadOptions::default()
    };
    // What is not asked for need not be usable.
    let text = "f,1:Y/2:Y real [m/N],1:Y/2:Y imaginary,9:Y/2:Y real,9:Y/2:Y imaginary\n1,1,1,x,y\n2,2,2,,\n4,4,4,,\n";
    let reading = read_csv_from(text.as_bytes(), "memory.csv", &options).unwrap();
    let [function] = reading.functions() else {
        panic!()
    };
    assert_eq!(function.frequency_hz(), [2.0]);
    assert_eq!(
        reading.not_selected.first(),
        Some(&(dof("9:Y"), dof("2:Y")))
    );
}
