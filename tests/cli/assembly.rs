//! `respond` with an assembly whose structures are chains of masses, in matrices of another program.

use std::io::{Cursor, Write as _};

use bolted_joint_testing::has;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::bench::Bench;

const JENKINS: &str = r#"{"format": "bolted-joint/1", "name": "j", "joint": {"dofs": ["y"], "stiffness": [[4e5]], "damping": [[30]],
"cubic": [5e13], "friction": [{"dof": "y", "law": "jenkins", "stiffness": 2e6, "slip_force": 10}]}}"#;

const ASSEMBLY: &str = "name = \"own\"\n[structures.a]\nmatrices = \"a.npz\"\n[structures.b]\nmatrices = \"b.npz\"\n\
[[joints]]\nname = \"j1\"\nfile = \"j.joint.json\"\na = { structure = \"a\", y = \"4:+Y\" }\nb = { structure = \"b\", y = \"1:+Y\" }\n\
[inputs]\npush = \"b/3:+Y\"\npull = \"a/2:+Y\"\n[outputs]\ntip = \"b/3:+Y\"\nmid = \"a/4:+Y\"\n[response]\n";

const LOADS: &str =
    "[response.loads.push]\namplitude = 30\nphase = 60\n[response.loads.pull]\namplitude = 10\n";

/// An array of NumPy: a header, padded so that the data begin at a multiple of 64, and the data.
fn npy(kind: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({shape}), }}");
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

/// Springs or dampers between neighbours, the first of them to the ground, as a matrix.
fn chain(between: &[f64]) -> Vec<f64> {
    let size = between.len();
    let mut matrix = vec![0.0; size * size];
    for (n, own) in between.iter().enumerate() {
        matrix[n * size + n] += own;
        if n > 0 {
            matrix[(n - 1) * size + n - 1] += own;
            matrix[(n - 1) * size + n] -= own;
            matrix[n * size + n - 1] -= own;
        }
    }
    matrix
}

fn archive(masses: &[f64], springs: &[f64], dampers: &[f64]) -> Vec<u8> {
    let size = masses.len();
    let mut mass = vec![0.0; size * size];
    for (n, own) in masses.iter().enumerate() {
        mass[n * size + n] = *own;
    }
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, matrix) in [("M", mass), ("K", chain(springs)), ("C", chain(dampers))] {
        let data: Vec<u8> = matrix.iter().flat_map(|own| own.to_le_bytes()).collect();
        zip.start_file(format!("{name}.npy"), SimpleFileOptions::default())
            .unwrap();
        zip.write_all(&npy("<f8", &format!("{size}, {size}"), &data))
            .unwrap();
    }
    let points: Vec<u8> = (1..=size)
        .flat_map(|n| format!("{n}:+Y").into_bytes())
        .collect();
    zip.start_file("points.npy", SimpleFileOptions::default())
        .unwrap();
    zip.write_all(&npy("|S4", &format!("{size},"), &points))
        .unwrap();
    zip.finish().unwrap().into_inner()
}

fn bench() -> Bench {
    let bench = Bench::new();
    let a = archive(
        &[1.0, 2.0, 1.5, 0.8],
        &[2e6, 3e6, 1e6, 2e6],
        &[20.0, 100.0, 5.0, 60.0],
    );
    bench.write("a.npz", a);
    let b = archive(&[0.7, 0.9, 1.1], &[0.0, 1.5e6, 2.5e6], &[0.0, 70.0, 3.0]);
    bench.write("b.npz", b);
    bench.write("j.joint.json", JENKINS);
    bench
}

/// At 35 Hz the joint slides far, and load by load Newton's method does not come there. The same curve passes it from 10 Hz on.
#[test]
fn harmonic_balance_begins_where_a_joint_slides_far() {
    let bench = bench();
    let study = |from: u32, to: u32| {
        let range =
            format!("kind = \"harmonic-balance\"\nfrom = {from}\nto = {to}\nharmonics = 3\n");
        format!("{ASSEMBLY}{range}{LOADS}")
    };
    bench.write("x.toml", study(35, 36));
    bench.done("respond x.toml -o o.csv");
    let begun = bench.text("o.csv");
    bench.write("x.toml", study(10, 36));
    bench.done("respond x.toml -o o.csv");
    let passed = bench.text("o.csv");
    // the last rows of both are at 36 Hz
    let last = |table: &str| -> Vec<f64> {
        let row = table.lines().next_back().unwrap();
        row.split(',').map(|cell| cell.parse().unwrap()).collect()
    };
    for (one, other) in last(&begun).iter().zip(last(&passed)) {
        assert!((one / other - 1.0).abs() < 1e-6, "{one} {other}");
    }
}

#[test]
fn modes_have_no_picture_and_that_is_said_at_once() {
    let bench = bench();
    bench.write("x.toml", format!("{ASSEMBLY}kind = \"modes\"\n"));
    bench.refused(
        "respond x.toml -o o.csv --report o.html",
        &["--report", "without a picture"],
    );
    bench.done("respond x.toml -o o.csv");
}

/// What the program writes it shows.
#[test]
fn tables_of_an_assembly_s_responses_are_shown() {
    let bench = bench();
    for (response, kind) in [
        ("kind = \"modes\"\n".to_owned(), "responses of an assembly"),
        (
            "kind = \"linear\"\nfrom = 20\nto = 40\nlines = 5\n".to_owned(),
            "responses of an assembly",
        ),
        (
            "kind = \"backbone\"\nmode = 1\nof = \"tip\"\namplitude = [1e-7, 1e-6]\n".to_owned(),
            "responses of an assembly",
        ),
        (
            format!("kind = \"harmonic-balance\"\nfrom = 10\nto = 11\nharmonics = 3\n{LOADS}"),
            "responses of an assembly",
        ),
        (
            "kind = \"history\"\nduration = 0.01\nstep = 0.001\n[response.loads.push]\namplitude = 6\nfrequency = 50\n".to_owned(),
            "table over time",
        ),
    ] {
        let joint = match response.contains("linear") {
            true => r#"{"format": "bolted-joint/1", "name": "j", "joint": {"dofs": ["y"], "stiffness": [[4e6]], "damping": [[150]]}}"#,
            false => JENKINS,
        };
        bench.write("j.joint.json", joint);
        bench.write("x.toml", format!("{ASSEMBLY}{response}"));
        bench.done("respond x.toml -o o.csv");
        has(&bench.done("show o.csv").stdout, &[kind, "rows"]);
    }
}

/// The joint lies between two outputs.
#[test]
fn it_is_said_where_a_joint_moves_further_than_it_was_observed_at() {
    let bench = bench();
    let joint = |observed: f64| {
        let higher = format!("\"higher\": {{\"amplitude\": [{observed:e}]}}, \"friction\"");
        JENKINS.replace("\"friction\"", &higher)
    };
    let between = ASSEMBLY.replace("tip = \"b/3:+Y\"", "foot = \"b/1:+Y\"");
    let said = |observed: f64, response: &str| {
        bench.write("j.joint.json", joint(observed));
        bench.write("x.toml", format!("{between}{response}"));
        let told = bench.done("respond x.toml -o o.csv").stderr;
        let (_, rest) = told.split_once("warning: j1: y reaches ")?;
        let (reached, rest) = rest.split_once(" m, beyond the ")?;
        has(rest, &["m that the joint was observed at"]);
        Some(reached.parse::<f64>().unwrap())
    };
    // of two columns, or of two pairs of columns
    let of_table = |columns: [[&str; 2]; 2]| -> f64 {
        let text = bench.text("o.csv");
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap().split(',').collect();
        let far = lines.map(|line| {
            let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let of = |name: &str| {
                let is_it = |own: &&str| own.starts_with(&format!("{name} ["));
                names.iter().position(is_it).map(|n| row[n])
            };
            let part = |[one, other]: [&str; 2]| of(one).unwrap_or(0.0) - of(other).unwrap_or(0.0);
            part(columns[0]).hypot(part(columns[1]))
        });
        far.fold(0.0, f64::max)
    };
    for (response, columns) in [
        (
            "kind = \"history\"\nduration = 0.1\nstep = 0.001\n[response.loads.push]\namplitude = 30\nfrequency = 30\n".to_owned(),
            [["mid", "foot"], ["none", "none"]],
        ),
        (
            // one harmonic moves round a circle
            format!("kind = \"harmonic-balance\"\nfrom = 10\nto = 36\nharmonics = 1\n{LOADS}"),
            [["mid real", "foot real"], ["mid imaginary", "foot imaginary"]],
        ),
    ] {
        let reached = said(1e-12, &response).unwrap();
        let expected = of_table(columns);
        assert!((reached / expected - 1.0).abs() < 1e-3, "{reached} {expected}");
        assert!(said(0.99 * expected, &response).is_some());
        assert!(said(1.01 * expected, &response).is_none());
    }
    let backbone = "kind = \"backbone\"\nmode = 1\nof = \"mid\"\namplitude = [1e-7, 1e-5]\n";
    assert!(said(1e-12, backbone).is_some());
    assert!(said(1e-2, backbone).is_none());
}

#[test]
fn a_matrix_market_file_is_told_from_an_archive() {
    let bench = bench();
    let market = "%%MatrixMarket matrix coordinate real general\n1 1 1\n1 1 2.0\n";
    bench.write("a.mtx", market);
    let study = format!("{ASSEMBLY}kind = \"modes\"\n");
    bench.write("x.toml", study.replace("a.npz", "a.mtx"));
    bench.refused(
        "respond x.toml -o o.csv",
        &["a.mtx", "a Matrix Market file", ".npz", ".mat"],
    );
}

#[test]
fn a_mass_where_stiffness_should_be_is_told() {
    let bench = bench();
    // one mass of 2 kg on 8 MN/m, and the other way round
    bench.write("a.npz", archive(&[8e6], &[2.0], &[0.0]));
    let study = "name = \"x\"\n[structures.a]\nmatrices = \"a.npz\"\n[outputs]\ny = \"a/1:+Y\"\n[response]\nkind = \"modes\"\n";
    bench.write("x.toml", study);
    // √(2/8e6)/2π Hz
    bench.refused(
        "respond x.toml -o o.csv",
        &[
            "structures.a.matrices",
            "no natural frequency above 7.96e-5 Hz",
            "exchanged",
        ],
    );
    bench.write("a.npz", archive(&[2.0], &[8e6], &[0.0]));
    bench.done("respond x.toml -o o.csv");
}
