//! The functions φ₀(z) = e^z, φ_{k+1} = (φ_k − 1/k!)/z of complex numbers: what forces that are powers of time add to a mode.

use crate::complex::Complex;

/// φ₀ to φ₉.
pub(super) const COUNT: usize = 10;
/// 1/k!
pub(super) const INVERSE_FACTORIALS: [f64; COUNT + 1] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
];
/// Modulus up to which the recurrence is taken downwards, from a series: z⁹/9! is below one, so that no digit is lost. Above it,
/// upwards, φ₉ loses one digit at most.
const SERIES: f64 = 4.0;
/// Terms of the series: the last one is below 10⁻¹⁸ of the first.
const TERMS: i32 = 30;

/// φ₀ to φ₉ of a number.
pub(super) fn phi(z: Complex) -> [Complex; COUNT] {
    let mut phi = [z.exponential(); COUNT];
    if z.modulus() > SERIES {
        let inverse = z.reciprocal();
        for k in 1..COUNT {
            let rest = phi[k - 1].minus(Complex::real(INVERSE_FACTORIALS[k - 1]));
            phi[k] = rest.times(inverse);
        }
        return phi;
    }
    // Σ zʲ 9!/(9 + j)!, Horner's way
    let last = COUNT as i32 - 1;
    let series = (1..TERMS).rev().fold(Complex::real(1.0), |sum, j| {
        Complex::real(1.0).plus(sum.times(z).scaled(f64::from(last + j).recip()))
    });
    phi[COUNT - 1] = series.scaled(INVERSE_FACTORIALS[COUNT - 1]);
    for k in (1..COUNT - 1).rev() {
        phi[k] = phi[k + 1]
            .times(z)
            .plus(Complex::real(INVERSE_FACTORIALS[k]));
    }
    phi
}

#[cfg(test)]
mod tests {
    use super::*;

    /// e^z, φ₁, φ₅ and φ₉ of some numbers; mpmath to 17 digits.
    const KNOWN: [([f64; 2], [[f64; 2]; 4]); 4] = [
        (
            [1e-6, -2e-3],
            [
                [0.999_998_999_999_166_6, -0.0020000006666666],
                [0.999_999_833_333_133_4, -0.0010000003333333611],
                [0.008_333_333_928_571_374, -2.7777783730159425e-6],
                [2.7557320977633503e-6, -5.511_464_679_867_535e-10],
            ],
        ),
        (
            [-0.5, 3.9],
            [
                [-0.44030019937322308, -0.417_151_262_257_879_7],
                [-0.058650700072388051, 0.376_827_063_951_132_6],
                [0.005_613_311_563_006_515, 0.003698955107909563],
                [2.316_170_197_468_081e-6, 8.844_527_360_448_79e-7],
            ],
        ),
        (
            [-0.5, 4.1],
            [
                [-0.348_648_347_509_443_1, -0.496_310_156_001_644_7],
                [-0.079_750_730_706_449_11, 0.33866432021040675],
                [0.005_439_247_706_066_417, 0.0037952023916024115],
                [2.286925259254463e-6, 9.198_425_214_536_116e-7],
            ],
        ),
        (
            [-3.0, 40.0],
            [
                [-0.033_204_890_872_611_82, 0.037_096_999_862_580_52],
                [0.002_848_660_451_908_674, 0.025616472737922145],
                [0.00017802286170742477, 0.0010129599508225509],
                [1.6049076134070633e-7, 5.785_017_309_869_45e-7],
            ],
        ),
    ];

    #[test]
    fn they_are_those_of_a_series_with_many_digits() {
        for ([re, im], known) in KNOWN {
            let found = phi(Complex { re, im });
            for (k, [re, im]) in [0, 1, 5, 9].into_iter().zip(known) {
                let expected = Complex { re, im };
                let error = found[k].minus(expected).modulus() / expected.modulus();
                assert!(error < 1e-14, "{k} of {expected:?}: {error}");
            }
        }
    }
}
