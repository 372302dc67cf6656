//! Damaged files of every format: an error, never a panic, and never more memory than the file accounts for.

use std::io::Cursor;
use std::path::Path;

use bolted_joint::frf::{
    ReadOptions, read_csv_from, read_mat_from, read_npz_from, read_uff58_from,
};
use bolted_joint::structure::ModalModel;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use super::own_file;

/// Tables in every dress, with what NumPy and analysers write.
const TABLES: [&str; 3] = [
    "f;1:+Y/2:+Y complex;3:+Y/2:+Y complex [m/N]\nHz;m/N;-\n1;(1,5e+00-2,5e-01j);3i\n2;1+j;2\n",
    "# unit = dB re 1e-6 m/s^2/N\nfrequency [Hz],1:+Y/2:+Y magnitude,1:+Y/2:+Y phase [deg]\n1,20.5,-90\n2,-3.25,180\n",
    "# averages = 10\nf,1:+Y/2:+Y coherence\n[Hz],\n1,0.5\n2,0.99\n",
];

fn read_all(bytes: &[u8]) {
    let options = ReadOptions::default();
    let name = Path::new("junk");
    let set = |reading: Result<bolted_joint::frf::FrfReading, _>| {
        reading.and_then(|reading| reading.into_set())
    };
    let _ = set(read_uff58_from(bytes, name, &options));
    let _ = set(read_csv_from(bytes, name, &options));
    let _ = set(read_npz_from(Cursor::new(bytes), name, &options));
    let _ = set(read_mat_from(Cursor::new(bytes), name, &options));
    let _ = ModalModel::from_universal(bytes, name).map(|modes| {
        let points = modes.points();
        modes.receptance(points[0], points[0], &[0.0, 10.0])
    });
}

/// Good files that the damage starts from.
fn seeds() -> Vec<Vec<u8>> {
    let uff = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/uff");
    let mut seeds: Vec<Vec<u8>> = [
        "stored.npz",
        "frequency_first.npz",
        "fortran_big_endian.npz",
        "cells.mat",
        "single.mat",
        "big_endian.mat",
        "table.csv",
    ]
    .iter()
    .map(|name| std::fs::read(own_file(name)).unwrap())
    .collect();
    for name in [
        "binary_double_big.uff",
        "binary_single_little.uff",
        "coherence.uff",
        "millimetres.uff",
    ] {
        seeds.push(std::fs::read(uff.join(name)).unwrap());
    }
    // twice, since they are small and their reader is young
    for name in ["modes.unv", "complex_modes.unv"].repeat(2) {
        seeds.push(std::fs::read(uff.join(name)).unwrap());
    }
    seeds.extend(
        TABLES
            .repeat(2)
            .iter()
            .map(|table| table.as_bytes().to_vec()),
    );
    seeds
}

#[derive(Debug, Clone)]
enum Damage {
    Set(usize, u8),
    Flip(usize, u8),
    Cut(usize, usize),
    Repeat(usize, usize),
    Insert(usize, &'static [u8]),
}

fn damage() -> impl Strategy<Value = Damage> {
    let tokens: &[&'static [u8]] = &[
        b"    -1\n",
        b"999999999999",
        b"-1",
        b"NaN",
        b"1e999",
        b"    58\n",
        b"    58b     1     2          11         100\n",
        b"\xff\xff\xff\xff",
        b"PK\x05\x06",
        b",",
        b";",
        b"'shape': (4611686018427387904,)",
        b"'descr': '|O'",
        b"\0\0\0\0",
        b"1:Y/2:Y real",
        b" complex",
        b"[dB re 1 m/N]",
        b"+1e5j",
        b"\nHz,m/N\n",
        b"    55\n",
        b"         2         6\n",
    ];
    prop_oneof![
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Damage::Set(at, byte)),
        (any::<usize>(), 0..8_u8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
        (any::<usize>(), 1..200_usize).prop_map(|(at, length)| Damage::Cut(at, length)),
        (any::<usize>(), 1..200_usize).prop_map(|(at, length)| Damage::Repeat(at, length)),
        (any::<usize>(), prop::sample::select(tokens))
            .prop_map(|(at, token)| Damage::Insert(at, token)),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    let length = bytes.len().max(1);
    let range = |at: usize, count: usize| {
        let from = at % length;
        from..(from + count).min(length)
    };
    if bytes.is_empty() {
        return;
    }
    match *damage {
        Damage::Set(at, byte) => bytes[at % length] = byte,
        Damage::Flip(at, bit) => bytes[at % length] ^= 1 << bit,
        Damage::Cut(at, count) => drop(bytes.drain(range(at, count))),
        Damage::Repeat(at, count) => {
            let piece = bytes[range(at, count)].to_vec();
            bytes.splice(at % length..at % length, piece);
        }
        Damage::Insert(at, token) => {
            drop(bytes.splice(at % length..at % length, token.iter().copied()))
        }
    }
}

#[test]
fn damaged_files_of_every_format_are_errors_and_no_panics() {
    let seeds = seeds();
    let config = ProptestConfig {
        // PROPTEST_CASES makes a longer run
        cases: ProptestConfig::default().cases.max(4000),
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let strategy = (0..seeds.len(), prop::collection::vec(damage(), 1..4));
    TestRunner::new(config)
        .run(&strategy, |(seed, damages)| {
            let mut bytes = seeds[seed].clone();
            damages.iter().for_each(|damage| apply(&mut bytes, damage));
            read_all(&bytes);
            Ok(())
        })
        .unwrap();
}

proptest! {
    #[test]
    fn no_junk_makes_a_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        read_all(&bytes);
        read_all(&[b"\x93NUMPY", bytes.as_slice()].concat());
        read_all(&[b"frequency,1:Y/2:Y real [m/N],1:Y/2:Y imaginary\n", bytes.as_slice()].concat());
    }
}
