//! MATLAB files.

use std::fs;
use std::io::Cursor;

use bolted_joint::frf::{FrfError, ReadOptions, Selection, read_frfs, read_mat_from};
use bolted_joint_testing::has;

use super::{FACTORS, dof, has_variance, is_oscillator, message, own_file, set};

fn refusal(bytes: &[u8]) -> String {
    let refused: Result<_, FrfError> =
        read_mat_from(Cursor::new(bytes), "x.mat", &ReadOptions::default());
    refused.unwrap_err().to_string()
}

#[test]
fn every_order_precision_and_form_of_names_gives_the_oscillator() {
    is_oscillator(&set("cells.mat"), &FACTORS, 1e-14);
    is_oscillator(&set("beside.mat"), &FACTORS, 1e-14);
    is_oscillator(&set("big_endian.mat"), &FACTORS[..4], 1e-14);
    let single = set("single.mat");
    is_oscillator(&single, &FACTORS, 1e-6);
    has_variance(&single, 1e-7);
    assert_eq!(single.averages(), Some(10.0));
}

#[test]
fn the_functions_are_those_of_the_archive_with_the_same_arrays() {
    let options = ReadOptions {
        selection: Selection::between([dof("13:-RZ"), dof("2:Y")]).within(7.5, 10.0),
        ..ReadOptions::default()
    };
    let [matlab, numpy] =
        ["cells.mat", "stored.npz"].map(|name| read_frfs(own_file(name), &options).unwrap());
    assert_eq!(matlab.functions(), numpy.functions());
    assert_eq!(matlab.not_selected, numpy.not_selected);
    assert_eq!(matlab.summary().formats[0].to_string(), "MATLAB file (mat)");
}

#[test]
fn what_is_no_file_of_functions_is_refused_by_name() {
    has(
        &message("structure.mat"),
        &[
            "structure.mat: array frf: found a structure",
            "expected numbers",
        ],
    );
    let good = fs::read(own_file("cells.mat")).unwrap();
    let newer = [
        &b"MATLAB 7.3 MAT-file".map(|byte| byte)[..],
        &[b' '; 105],
        b"\0\x02IM\x89HDF",
    ]
    .concat();
    for (bytes, parts) in [
        (newer.as_slice(), ["HDF5", "'-v7'"]),
        (&good[..100], ["level 5", "'-v7'"]),
        (&good[..128], ["of no name at all", "frequency (Hz)"]),
        (
            &good[..good.len() - 9],
            ["array quantity: found incomplete", "save it again"],
        ),
        (&good[..190], ["damaged", "save or copy it again"]),
    ] {
        has(&refusal(bytes), &parts);
    }
}

/// A few bytes that stand for four thousand million rows without a character, or with one that is not there.
#[test]
fn texts_that_take_no_room_are_refused_before_room_is_made_for_them() {
    let good = fs::read(own_file("cells.mat")).unwrap();
    for columns in [0_u32, 1] {
        let element = |number: u32, data: &[u8]| {
            let tag = [number, data.len() as u32].map(u32::to_le_bytes).concat();
            let filling = vec![0; data.len().next_multiple_of(8) - data.len()];
            [tag, data.to_vec(), filling].concat()
        };
        let words = |words: [u32; 2]| words.map(u32::to_le_bytes).concat();
        let names = [
            element(6, &words([4, 0])),
            element(5, &words([u32::MAX, columns])),
            element(1, b"unit"),
            element(4, &[]),
        ];
        let bytes = [good.clone(), element(14, &names.concat())].concat();
        has(&refusal(&bytes), &["found an array of [4294967295"]);
    }
}
