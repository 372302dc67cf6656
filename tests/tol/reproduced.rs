//! Tables as `reproduce` obtains them, and how they are looked at.

use std::sync::LazyLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use bolted_joint::reproduce::{Draws, PublishedTable, Reproduction, Row, reproduce};

/// A table over a few draws.
pub(crate) fn reproduced(table: &str, samples: &[u32]) -> Reproduction {
    reproduced_over(4, table, samples)
}

/// A table over so many draws; the draws are counted.
pub(crate) fn reproduced_over(count: u32, table: &str, samples: &[u32]) -> Reproduction {
    let draws = Draws {
        count,
        seed: 1,
        samples: samples.to_vec(),
    };
    let table: PublishedTable = table.parse().unwrap();
    let done = AtomicUsize::new(0);
    let progress = || {
        done.fetch_add(1, Ordering::Relaxed);
    };
    let found = reproduce(table, &draws, &progress).unwrap();
    let expected = table.noisy_cases(samples.len()) * count as usize;
    assert_eq!(done.load(Ordering::Relaxed), expected, "{table}");
    found
}

/// The tables of chapter 5, computed once.
pub(crate) fn chapter_5(table: &str) -> &'static Reproduction {
    static FOUND: LazyLock<Vec<Reproduction>> = LazyLock::new(|| {
        let all = PublishedTable::ALL.iter();
        let tables = all.filter(|table| !table.key().starts_with('4'));
        tables.map(|table| reproduced(table.key(), &[])).collect()
    });
    let table = table.parse().unwrap();
    FOUND.iter().find(|found| found.table == table).unwrap()
}

/// The rows of one case, in the order of the table.
pub(crate) fn case<'a>(found: &'a Reproduction, case: &str) -> Vec<&'a Row> {
    let rows: Vec<&Row> = found.rows.iter().filter(|row| row.case == case).collect();
    assert!(!rows.is_empty(), "{case}");
    rows
}

pub(crate) fn mean(row: &Row) -> f64 {
    row.obtained.unwrap().mean
}

pub(crate) fn standard_deviation(row: &Row) -> f64 {
    row.obtained.unwrap().standard_deviation
}

/// Each obtained mean is within `tolerance` (a fraction) of the published value; `None` is not compared.
pub(crate) fn assert_published(rows: &[&Row], tolerances: &[Option<f64>]) {
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
