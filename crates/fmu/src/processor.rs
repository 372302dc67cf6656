//! What the processor at hand can do beyond all others of its kind: a library for every importer is compiled for the oldest.

/// Takes the sums of assemblies four numbers at a time where the processor can. They are the same to the bit.
pub fn use_all_of_it() {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        avx2::PRODUCTS.are_taken();
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use bolted_joint_dynamics::assembly::products::{Column, Groups, LANES, Products, ROWS};

    /// Only for processors that have it.
    pub(super) const PRODUCTS: Products = Products {
        // SAFETY: they are taken where the processor has been asked.
        group_sums: |rows, x| unsafe { group_sums(rows, x) },
        // SAFETY: as above.
        add_rows: |terms, sum| unsafe { add_rows(terms, sum) },
        // SAFETY: as above.
        column_sums: |columns, x| unsafe { column_sums(columns, x) },
    };

    #[target_feature(enable = "avx2")]
    fn group_sums(rows: &[Groups<'_>; ROWS], x: Groups<'_>) -> [[f64; LANES]; ROWS] {
        bolted_joint_dynamics::assembly::products::group_sums(rows, x)
    }

    #[target_feature(enable = "avx2")]
    fn add_rows(terms: &[(f64, &[f64]); ROWS], sum: &mut [f64]) {
        bolted_joint_dynamics::assembly::products::add_rows(terms, sum);
    }

    #[target_feature(enable = "avx2")]
    fn column_sums(columns: &[Column], x: &[f64]) -> Column {
        bolted_joint_dynamics::assembly::products::sums_of_columns(columns, x)
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use bolted_joint_dynamics::assembly::products;

        /// 424 numbers without any order, between −1 and 1.
        fn row(seed: u32) -> Vec<f64> {
            let of = |i: u32| f64::from((i * 7919 + seed) % 65_537) / 32_768.5 - 1.0;
            (0..424).map(of).collect()
        }

        #[test]
        fn the_bits_are_those_of_any_processor() {
            if !std::arch::is_x86_feature_detected!("avx2") {
                return;
            }
            let rows: [Vec<f64>; ROWS] = std::array::from_fn(|i| row(31 * i as u32));
            let x = row(5);
            let groups = rows.each_ref().map(|row| row.as_chunks().0);
            let x_groups = x.as_chunks().0;
            let plain = products::group_sums(&groups, x_groups);
            let own = (PRODUCTS.group_sums)(&groups, x_groups);
            assert_eq!(
                plain.map(|row| row.map(f64::to_bits)),
                own.map(|row| row.map(f64::to_bits))
            );
            let factors = [0.3, -1.7, 2.9, 0.8];
            let terms = std::array::from_fn(|i| (factors[i], &rows[i][..]));
            let (mut plain, mut own) = (x.clone(), x);
            products::add_rows(&terms, &mut plain);
            (PRODUCTS.add_rows)(&terms, &mut own);
            let bits = |sum: &[f64]| sum.iter().map(|own| own.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&plain), bits(&own));
            let columns: Vec<Column> = plain.as_chunks().0.as_chunks().0.to_vec();
            let plain = products::sums_of_columns(&columns, &own);
            let own = (PRODUCTS.column_sums)(&columns, &own);
            assert_eq!(bits(plain.as_flattened()), bits(own.as_flattened()));
        }
    }
}
