//! What the report says of a file: its format, by whose word it is read, and what its coherence is worth.

use bolted_joint::frf::{ByteOrder, ReadOptions, read_frfs, write_uff58b};

use super::bench;
use super::measurement::{archive, silent_assembly, table, universal_file};

/// Cells of the row of `file` among the measured files.
fn row(page: &str, file: &str) -> Vec<String> {
    let (_, rest) = page.split_once("<h3>Measured files</h3>").unwrap();
    let (table, _) = rest.split_once("</table>").unwrap();
    let row = table.split("<tr>").find(|row| row.contains(file)).unwrap();
    let cells = row.split("<td>").skip(1);
    cells
        .map(|cell| cell.split("</td>").next().unwrap().to_owned())
        .collect()
}

const COHERENT: &str = "of the assembly: from coherence, line by line";

#[test]
fn every_format_is_named_with_what_the_file_states() {
    // γ² = 0.9 of 42 averages: √(0.1/(42·0.9)) = 5.14 %
    let functions = silent_assembly();
    #[rustfmt::skip]
    let cases = [
        ("measured.uff", universal_file(&functions).into_bytes(), "averages = 42\n",
         ["universal file, 58 (ASCII)", "9", "receptance (file)", "SI (assumed: nobody states them)", "9 functions; 42 averages (study); <i>σ</i>/|<i>H</i>| from 5.14 % to 5.14 %, median 5.14 %"]),
        ("measured.csv", table(&functions).into_bytes(), "",
         ["table (CSV)", "9", "receptance (file)", "m/N (file)", "9 functions; 42 averages (file); <i>σ</i>/|<i>H</i>| from 5.14 % to 5.14 %, median 5.14 %"]),
        ("measured.npz", archive(&functions), "",
         ["NumPy archive (npz)", "9", "receptance (file)", "m/N (file)", "9 functions; 42 averages (file); <i>σ</i>/|<i>H</i>| from 5.14 % to 5.14 %, median 5.14 %"]),
    ];
    for (name, bytes, more, expected) in cases {
        let bench = bench(name, more);
        bench.write(name, bytes);
        let page = bench.report();
        assert_eq!(row(&page, name)[1..], expected, "{name}");
        assert!(page.contains(COHERENT) && page.contains("of A: stated to be exact"));
        assert!(page.contains("with the noise that coherence tells"));
        // B's file has functions from the points to each other and to the joint.
        assert_eq!(row(&page, "b.uff")[2], "25");
    }
}

#[test]
fn the_study_s_word_is_told_from_the_file_s() {
    let functions = silent_assembly();
    let bench = bench(
        "measured.uff",
        "quantity = \"receptance\"\nunits = { length = \"mm\", force = \"kN\" }\n",
    );
    bench.write("text.uff", universal_file(&functions));
    let set = read_frfs(bench.path("text.uff"), &ReadOptions::default()).unwrap();
    let set = set.into_set().unwrap();
    for (order, words) in [
        (ByteOrder::Little, "little endian"),
        (ByteOrder::Big, "big endian"),
    ] {
        write_uff58b(&set, bench.path("measured.uff"), "binary", order).unwrap();
        // The data are in m and N: what comes of the study's word is no joint, but the word stands.
        let page = bench.report_not_to_be_relied_on("% off the model");
        let cells = row(&page, "measured.uff");
        assert_eq!(cells[1], format!("universal file, 58b (binary, {words})"));
        assert_eq!(
            cells[2..],
            ["9", "receptance (study)", "mm, kN (study)", "none"]
        );
    }
    let units = "units = { length = \"mm\", force = \"kN\" }\n";
    bench.edit("study.toml", units, "");
    let cells = row(&bench.report(), "measured.uff");
    assert_eq!(cells[4], "m, N (file, data set 164)");
}

#[test]
fn coherence_without_averages_is_told_to_be_unused() {
    let bench = bench("measured.uff", "");
    bench.write("measured.uff", universal_file(&silent_assembly()));
    let page = bench.report();
    let unused = "9 functions, not used: nobody states the averages";
    assert_eq!(row(&page, "measured.uff")[5], unused);
    assert!(!page.contains(COHERENT) && page.contains("estimated from the residual"));
}
