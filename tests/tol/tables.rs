//! Published tables against what `reproduce` obtains.

use bolted_joint::reproduce::{Draws, PublishedTable, Reproduction, Row, reproduce};

fn reproduced(table: &str, samples: &[u32]) -> Reproduction {
    let draws = Draws {
        count: 4,
        seed: 1,
        samples: samples.to_vec(),
    };
    reproduce(table.parse().unwrap(), &draws).unwrap()
}

/// The rows of one case, in the order of the table.
fn case<'a>(found: &'a Reproduction, case: &str) -> Vec<&'a Row> {
    let rows: Vec<&Row> = found.rows.iter().filter(|row| row.case == case).collect();
    assert!(!rows.is_empty(), "{case}");
    rows
}

fn mean(row: &Row) -> f64 {
    row.obtained.unwrap().mean
}

/// Each obtained mean is within `tolerance` (a fraction) of the published value; `None` is not compared.
fn assert_published(rows: &[&Row], tolerances: &[Option<f64>]) {
    assert_eq!(rows.len(), tolerances.len());
    for (row, tolerance) in rows.iter().zip(tolerances) {
        let Some(tolerance) = tolerance else { continue };
        let published = row.published.unwrap();
        let error = (mean(row) - published).abs();
        assert!(
            error <= tolerance * published.abs(),
            "{} {}: obtained {}, published {published}",
            row.case,
            row.quantity,
            mean(row)
        );
    }
}

#[test]
fn the_lumped_chain_returns_its_joint_by_every_equation() {
    // Published k is within 1 % of the truth, so is the obtained one; c is one draw there, 17 % off.
    let found = reproduced("4.2", &[4096]);
    for equation in ["(3.18), mass 1", "(3.19), masses 1 and 4", "(3.21), mass 4"] {
        let rows = case(&found, &format!("{equation}, N = 4096"));
        assert_published(&rows, &[Some(0.02), None]);
        assert!((mean(rows[0]) / 2000.0 - 1.0).abs() < 0.01);
        assert!((mean(rows[1]) / 3.0 - 1.0).abs() < 0.10);
    }
    // "(3.19) and (3.20) are the same."
    let by_rs = case(&found, "(3.19), masses 1 and 4, N = 4096");
    let by_sr = case(&found, "(3.20), masses 4 and 1, N = 4096");
    for (rs, sr) in by_rs.iter().zip(by_sr) {
        assert!((mean(rs) / mean(sr) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn table_4_4_is_obtained_where_its_noise_hides_one_singular_value() {
    let found = reproduced("4.4", &[16_777_216]);
    let rows = case(&found, "(3.21), s, N = 16777216");
    assert_published(&rows, &[Some(0.04); 6]);
    let rows = case(&found, "(3.18), r, N = 16777216");
    assert_published(
        &rows,
        &[
            Some(0.03),
            Some(0.20),
            Some(0.25),
            Some(0.10),
            None,
            Some(0.05),
        ],
    );
}

#[test]
fn estimated_rotations_give_the_published_answer_at_any_number_of_samples() {
    let found = reproduced("4.5", &[4096, 16_777_216]);
    for samples in [4096, 16_777_216] {
        let rows = case(&found, &format!("2: estimated, N = {samples}"));
        // Couplings come out negative and count as zero, as published.
        assert_published(
            &rows,
            &[
                Some(0.02),
                Some(0.0),
                Some(0.25),
                Some(0.06),
                Some(0.0),
                Some(0.04),
            ],
        );
    }
}

#[test]
fn noise_turns_approaches_3_and_4_into_the_single_point() {
    let found = reproduced("4.6", &[16_777_216]);
    // Computed independently in NumPy at 1 Hz spacing: 9.386e4, 729.9, 5.048, 0.04557 without noise at 2s alone.
    let alone = case(&found, "no noise, 2s alone");
    for (row, reference) in alone.iter().zip([9.386e4, 729.9, 5.048, 0.04557]) {
        assert!((mean(row) / reference - 1.0).abs() < 0.01, "{row:?}");
    }
    for approach in ["3: y at 2s, 3s", "4: y at 1s, 2s, 3s"] {
        let rows = case(&found, &format!("{approach}, N = 16777216"));
        for (row, alone) in rows.iter().zip(&alone).take(2) {
            assert!((mean(row) / mean(alone) - 1.0).abs() < 0.03, "{row:?}");
        }
    }
    let frf = reproduced("4.7", &[]);
    for level in ["1 %", "3 %", "5 %", "10 %"] {
        // Published: within 2 % of the truth; here 6 % below, at every level.
        let rows = case(&frf, level);
        assert_published(&rows[..1], &[Some(0.07)]);
        assert!((mean(rows[0]) / mean(alone[0]) - 1.0).abs() < 0.05);
    }
    // As published, c_Mθ at 10 % is several times its true value, while c_Fy is not.
    let rows = case(&frf, "10 %");
    assert!(mean(rows[3]) > 2.0 * 0.05 && (mean(rows[2]) / 5.0 - 1.0).abs() < 0.5);
}

#[test]
fn table_5_2_is_what_one_point_returns() {
    let found = reproduced("5.2", &[]);
    for hz in ["112.5 Hz", "344 Hz"] {
        for how in ["no noise, 2s", "1 % noise, 1s–3s"] {
            let rows = case(&found, &format!("{hz}, {how}"));
            assert_published(&rows[..3], &[Some(0.06); 3]);
        }
    }
}

#[test]
fn the_initial_estimates_of_chapter_5_are_what_one_point_returns() {
    for (table, tolerances) in [
        ("m10x16", [0.03, 0.07, 0.03]),
        ("m8x16", [0.15, 0.21, 0.02]),
        ("m10x35", [0.03, 0.05, 0.04]),
        ("m8x35", [0.06, 0.10, 0.05]),
        ("m6x30", [0.05, 0.20, 0.03]),
    ] {
        let found = reproduced(table, &[]);
        let rows = case(&found, "initial, no noise, 2s");
        assert_published(&rows[..3], &tolerances.map(Some));
    }
}

#[test]
fn torques_change_what_the_thesis_says_they_change() {
    let found = reproduced("torques", &[]);
    for row in found.rows.iter().filter(|row| row.unit == "%") {
        assert!((mean(row) - row.published.unwrap()).abs() < 0.05, "{row:?}");
    }
    // Figure 5.36: natural frequencies rise, by little.
    let of = |torque: &str| -> f64 {
        case(&found, &format!("resonances, {torque}"))
            .iter()
            .map(|row| mean(row))
            .sum()
    };
    let (low, high) = (of("10 N·m"), of("25 N·m"));
    assert!(high > low && high < 1.01 * low, "{low} {high}");
}

#[test]
fn a_second_bolt_stiffens_and_a_rigid_connection_more_so() {
    let found = reproduced("two-m6x30", &[]);
    let names = ["one bolt", "two bolts", "two bolts, 1000 times as stiff"];
    let [one, two, rigid] = names.map(|name| case(&found, name));
    for mode in 0..3 {
        assert!(mean(one[mode]) < mean(two[mode]));
        assert!(mean(two[mode]) < mean(rigid[mode]));
    }
}

#[test]
fn every_table_has_a_key_of_its_own_and_unknown_ones_are_named() {
    for table in PublishedTable::ALL {
        assert_eq!(table.key().parse::<PublishedTable>().unwrap(), *table);
    }
    let message = "4.1".parse::<PublishedTable>().unwrap_err().to_string();
    assert!(
        message.contains("\"4.1\"") && message.contains("4.2"),
        "{message}"
    );
}
