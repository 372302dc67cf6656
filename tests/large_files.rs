//! Files larger than the memory they may take: `cargo test --release --test large_files -- --ignored --nocapture`.
//!
//! Each is written line by line, 1 GB or more, and read for three functions in a band; the process's peak of resident memory says
//! what that took. One test in a process of its own, so that nothing else counts.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]
#![cfg(target_os = "linux")]

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use bolted_joint::frf::{ReadOptions, Selection, read_frfs};

const LINES: usize = 20_000;
const STEP_HZ: f64 = 0.05;
/// What reading may add to the peak of resident memory.
const ALLOWED_MIB: f64 = 32.0;

fn value(function: usize, line: usize) -> (f64, f64) {
    let number = (function * LINES + line) as f64;
    (1e-6 + number, -2e-6 * number)
}

fn header(writer: &mut impl Write, function: usize, first: &str) {
    let node = function + 1;
    write!(writer, "    -1\n{first}\nNONE\nNONE\nNONE\nNONE\nNONE\n").unwrap();
    writeln!(
        writer,
        "    4         0    0         0 NONE      {node:>10}   2 NONE               1   2"
    )
    .unwrap();
    writeln!(
        writer,
        "         6{LINES:>10}         1  5.00000E-02  5.00000E-02  0.00000E+00"
    )
    .unwrap();
    for data_type in [18, 8, 13, 0] {
        writeln!(
            writer,
            "{data_type:>10}    0    0    0 NONE                 NONE"
        )
        .unwrap();
    }
}

fn binary(writer: &mut impl Write, functions: usize) {
    for function in 0..functions {
        let bytes = 16 * LINES;
        let first = format!(
            "    58b     1     2          11{bytes:>12}     0     0           0           0"
        );
        header(writer, function, &first);
        for line in 0..LINES {
            let (re, im) = value(function, line);
            writer.write_all(&re.to_le_bytes()).unwrap();
            writer.write_all(&im.to_le_bytes()).unwrap();
        }
        writer.write_all(b"    -1\n").unwrap();
    }
}

fn ascii(writer: &mut impl Write, functions: usize) {
    for function in 0..functions {
        header(writer, function, "    58");
        for line in (0..LINES).step_by(2) {
            for line in [line, line + 1] {
                let (re, im) = value(function, line);
                write!(writer, "{re:20.12e}{im:20.12e}").unwrap();
            }
            writeln!(writer).unwrap();
        }
        writer.write_all(b"    -1\n").unwrap();
    }
}

fn table(writer: &mut impl Write, functions: usize) {
    write!(writer, "frequency [Hz]").unwrap();
    for node in 1..=functions {
        write!(
            writer,
            ",{node}:+Y/1:+Y real [m/N],{node}:+Y/1:+Y imaginary [m/N]"
        )
        .unwrap();
    }
    for line in 0..LINES {
        write!(writer, "\n{}", STEP_HZ * (line + 1) as f64).unwrap();
        for function in 0..functions {
            let (re, im) = value(function, line);
            write!(writer, ",{re:e},{im:e}").unwrap();
        }
    }
    writeln!(writer).unwrap();
}

fn archive(writer: &mut BufWriter<File>, functions: usize) {
    let mut zip = zip::ZipWriter::new(writer);
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated)
        .compression_level(Some(1))
        .large_file(true);
    let mut array =
        |name: &str, descr: &str, shape: String, write: &mut dyn FnMut(&mut dyn Write)| {
            zip.start_file(format!("{name}.npy"), options).unwrap();
            let text =
                format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n");
            zip.write_all(b"\x93NUMPY\x01\x00").unwrap();
            zip.write_all(&(text.len() as u16).to_le_bytes()).unwrap();
            zip.write_all(text.as_bytes()).unwrap();
            write(&mut BufWriter::with_capacity(1 << 16, &mut zip));
        };
    array("frequency", "<f8", format!("({LINES},)"), &mut |w| {
        for line in 0..LINES {
            w.write_all(&(STEP_HZ * (line + 1) as f64).to_le_bytes())
                .unwrap();
        }
    });
    array("frf", "<c16", format!("({LINES}, {functions})"), &mut |w| {
        for line in 0..LINES {
            for function in 0..functions {
                let (re, im) = value(function, line);
                w.write_all(&re.to_le_bytes()).unwrap();
                w.write_all(&im.to_le_bytes()).unwrap();
            }
        }
    });
    array("response", "|S8", format!("({functions},)"), &mut |w| {
        for node in 1..=functions {
            w.write_all(format!("{:\0<8}", format!("{node}:+Y")).as_bytes())
                .unwrap();
        }
    });
    array("reference", "|S4", "(1,)".to_owned(), &mut |w| {
        w.write_all(b"1:+Y").unwrap()
    });
    array("quantity", "|S10", "()".to_owned(), &mut |w| {
        w.write_all(b"receptance").unwrap()
    });
    zip.finish().unwrap();
}

/// Peak of resident memory so far, MiB.
fn peak_mib() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find(|line| line.starts_with("VmHWM:"))
        .unwrap();
    line.split_whitespace()
        .nth(1)
        .unwrap()
        .parse::<f64>()
        .unwrap()
        / 1024.0
}

fn written(
    name: &str,
    functions: usize,
    write: impl FnOnce(&mut BufWriter<File>, usize),
) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let mut writer = BufWriter::with_capacity(1 << 16, File::create(&path).unwrap());
    write(&mut writer, functions);
    writer.flush().unwrap();
    path
}

#[test]
#[ignore = "writes and reads 1 GB four times"]
fn three_functions_of_a_gigabyte_take_the_memory_of_three_functions() {
    type Case = (&'static str, usize, fn(&mut BufWriter<File>, usize));
    let cases: [Case; 4] = [
        ("large.58b.uff", 3200, binary),
        ("large.uff", 1300, ascii),
        ("large.csv", 1600, table),
        ("large.npz", 3200, archive),
    ];
    for (name, functions, write) in cases {
        let path = written(name, functions, write);
        let gigabytes = path.metadata().unwrap().len() as f64 / 1e9;
        let before = peak_mib();
        let started = Instant::now();
        let dofs = ["1:Y", "2:Y", "1000:Y"].map(|text| text.parse().unwrap());
        let options = ReadOptions {
            selection: Selection::between(dofs).within(100.0, 600.0),
            ..ReadOptions::default()
        };
        let reading = read_frfs(&path, &options).unwrap();
        let seconds = started.elapsed().as_secs_f64();
        let grown = peak_mib() - before;
        println!(
            "{name}: {gigabytes:.2} GB, {functions} functions, {seconds:.1} s, {grown:.1} MiB more than before ({before:.1} MiB)"
        );
        assert_eq!(reading.functions().len(), 3);
        assert_eq!(reading.not_selected.len(), functions - 3);
        let (re, im) = value(999, 1999);
        let last = &reading.functions()[2];
        assert!((last.frequency_hz()[0] - 100.0).abs() < 1e-9);
        assert!(
            (last.receptance()[0].re / re - 1.0).abs() < 1e-12
                && (last.receptance()[0].im / im - 1.0).abs() < 1e-12
        );
        std::fs::remove_file(&path).unwrap();
        assert!(grown < ALLOWED_MIB, "{name}: {grown} MiB");
    }
}
