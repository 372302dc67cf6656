//! Zhao's paper on contact under an uneven pressure: its contact under the pressures that it names, its loss factor along the
//! interface, and what its table of frequencies says once its errors are all relative to the measured ones.

use serde::Serialize;

use super::ReproduceError;
use bolted_joint_predict::fractal::{FractalContact, Friction, StoredEnergy};
use bolted_joint_predict::patch::LossFactor;
use bolted_joint_predict::surface::Roughness;
use bolted_joint_predict::{Material, Pair};

/// A load of Table 3: measured frequencies; computed ones (Hz) with their errors (%) as printed, by even and by uneven pressure.
type Load = (&'static str, [f64; 6], [[[f64; 6]; 2]; 2]);

/// Table 3.
#[rustfmt::skip]
const TABLE_3: [Load; 3] = [
    ("9 kN", [526.03, 666.09, 820.16, 897.98, 1334.41, 1373.73], [
        [[556.5, 613.21, 840.12, 830.64, 1250.63, 1441.49], [5.47, -8.62, 2.43, -8.1, -6.7, 4.7]],
        [[531.74, 640.83, 834.67, 863.05, 1299.8, 1408.7], [1.09, -3.79, 1.74, -3.88, -2.66, 2.48]],
    ]),
    ("15 kN", [550.83, 668.11, 871.12, 903.26, 1390.67, 1414.80], [
        [[588.61, 619.16, 835.20, 838.19, 1263.35, 1467.82], [6.42, -7.9, -4.3, -7.76, -10.07, 3.6]],
        [[555.26, 641.8, 854.63, 872.8, 1319.8, 1407.5], [0.8, -3.94, -1.89, -3.37, -5.1, -0.52]],
    ]),
    ("15 kN, 4500 N·m", [547.49, 667.59, 834.22, 900.36, 1355.13, 1380.96], [
        [[588.61, 619.16, 835.20, 838.19, 1263.35, 1467.82], [6.98, -7.82, 0.12, -7.42, -7.26, 5.92]],
        [[551.81, 637.53, 836.72, 878.42, 1308.1, 1416.8], [0.78, -4.5, 0.29, -2.44, -3.59, 2.53]],
    ]),
];
/// Errors by either denominator that are closer than this cannot be told apart from two printed decimals, %.
const ALIKE: f64 = 0.011;

/// Table 1 and section 2: D, G, E, ν and H.
const FRACTAL_DIMENSION: f64 = 1.42;
const ROUGHNESS_M: f64 = 1.21e-8;
const YOUNGS_MODULUS_PA: f64 = 1.5e11;
const POISSONS_RATIO: f64 = 0.28;
const HARDNESS_PA: f64 = 1.96e9;
/// Hardness over yield strength, section 1.1.
const HARDNESS_OVER_YIELD: f64 = 2.8;
/// Least and greatest pressure of Figure 8, at the first of the preloads.
const PRESSURES_PA: [f64; 2] = [0.62e6, 7.98e6];
const BOLTS: f64 = 8.0;
const PRELOADS_N: [f64; 2] = [9e3, 15e3];
/// The bending moment (N·m), and the preloads that stand for it: three, two and three bolts.
const MOMENT_N_M: f64 = 4500.0;
const UNDER_MOMENT_N: [(f64, f64); 3] = [(3.0, 20e3), (2.0, 15e3), (3.0, 10e3)];
/// Nominal area, which only Figure 4 has.
const AREA_M2: f64 = 0.06;
/// Shares of friction at which the loss factor along the interface is given.
const FRICTION_RATIOS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.9, 0.95];

/// The contact under a pressure.
#[derive(Clone, Debug, Serialize)]
pub struct ZhaoContact {
    /// Nominal area of the whole interface, m².
    pub area_m2: f64,
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// K_N/A₀, N/m³.
    pub normal_stiffness_n_per_m3: f64,
    /// K_T/A₀ without tangential load, N/m³.
    pub tangential_stiffness_n_per_m3: f64,
    /// A_r/A₀.
    pub real_area_fraction: f64,
    /// η_N = W_NP/W_NE as published.
    pub normal_energy_ratio: f64,
    /// The same over 2π.
    pub normal_loss_factor: f64,
}

/// The loss factor along the interface, (29).
#[derive(Clone, Debug, Serialize)]
pub struct ZhaoLoss {
    /// q = T/(μP).
    pub friction_ratio: f64,
    /// With the printed 5π/24.
    pub published: f64,
    /// With 5/24, as the energies have it.
    pub energy_ratio: f64,
    /// The same over 2π.
    pub loss_factor: f64,
}

/// What an error is relative to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Denominator {
    /// The measured frequency.
    Measured,
    /// The computed frequency.
    Computed,
    /// Both give what is printed.
    Either,
}

/// A computed frequency of Table 3.
#[derive(Clone, Debug, Serialize)]
pub struct ZhaoError {
    /// As printed, Hz.
    pub computed_hz: f64,
    /// The error as printed, %.
    pub published_percent: f64,
    /// The error relative to the measured frequency, %.
    pub percent: f64,
    /// What the printed one is relative to.
    pub relative_to: Denominator,
}

/// A frequency of Table 3.
#[derive(Clone, Debug, Serialize)]
pub struct ZhaoFrequency {
    /// Preload of each bolt, and the moment.
    pub load: &'static str,
    /// Number of the mode, from 1.
    pub mode: usize,
    /// As printed, Hz.
    pub measured_hz: f64,
    /// By even pressure.
    pub even: ZhaoError,
    /// By uneven pressure.
    pub uneven: ZhaoError,
}

/// What the paper gives.
#[derive(Clone, Debug, Serialize)]
pub struct ZhaoReproduction {
    /// Between these areas (m²) the mean pressure is between the named ones.
    pub area_bounds_m2: [f64; 2],
    /// The contact at the named pressures and under both preloads spread evenly, for three areas.
    pub contacts: Vec<ZhaoContact>,
    /// The loss factor along the interface.
    pub losses: Vec<ZhaoLoss>,
    /// Table 3.
    pub frequencies: Vec<ZhaoFrequency>,
    /// How many times as stiff each point is at the second preload as at the first.
    pub stiffness_gain: f64,
    /// What part of a mode's strain energy is in the joint by how far its frequency rises with that: measured, even, uneven.
    pub joint_shares: [[f64; 3]; 6],
    /// Distance of the rows of bolts that the moment and its preloads say, m.
    pub row_distance_m: f64,
    /// Normal stiffness of the unequal preloads over that of the equal ones.
    pub stiffness_under_moment: f64,
    /// μ below which the metal's shear strength is more than friction bears at every named pressure, and at the greatest.
    pub friction_needed: [f64; 2],
}

/// Computes what can be computed.
///
/// # Errors
/// None with the paper's numbers; [`ReproduceError`] should the contact be outside its model.
pub fn zhao() -> Result<ZhaoReproduction, ReproduceError> {
    let clamping_n = PRELOADS_N.map(|preload_n| BOLTS * preload_n);
    let [low, high] = PRESSURES_PA.map(|pressure_pa| clamping_n[0] / pressure_pa);
    let area_bounds_m2 = [high, low];
    let mut contacts = Vec::new();
    for area_m2 in [high, AREA_M2, low] {
        let contact = contact(area_m2, 0.0)?;
        let mut pressures_pa = [PRESSURES_PA, clamping_n.map(|force_n| force_n / area_m2)].concat();
        pressures_pa.sort_by(f64::total_cmp);
        // at the ends of the range a mean is a named pressure
        pressures_pa.dedup_by(|a, b| (*a / *b - 1.0).abs() < 1e-9);
        for pressure_pa in pressures_pa {
            let found = contact.at(pressure_pa)?;
            contacts.push(ZhaoContact {
                area_m2,
                pressure_pa,
                normal_stiffness_n_per_m3: found.normal_stiffness_n_per_m3,
                tangential_stiffness_n_per_m3: found.tangential_stiffness_n_per_m3,
                real_area_fraction: found.real_area_fraction,
                normal_energy_ratio: found.normal_loss_factor,
                normal_loss_factor: LossFactor::default().of(found.normal_loss_factor),
            });
        }
    }
    let losses = FRICTION_RATIOS.map(|friction_ratio| {
        let energy_ratio = StoredEnergy::OneLoading.loss_factor(friction_ratio)?;
        Ok(ZhaoLoss {
            friction_ratio,
            published: StoredEnergy::PiLoadings.loss_factor(friction_ratio)?,
            energy_ratio,
            loss_factor: LossFactor::default().of(energy_ratio),
        })
    });
    let contact = contact(AREA_M2, 0.0)?;
    let stiffness = |preload_n: f64| -> Result<f64, ReproduceError> {
        let found = contact.at(BOLTS * preload_n / AREA_M2)?;
        Ok(found.normal_stiffness_n_per_m3)
    };
    let stiffness_gain = stiffness(PRELOADS_N[1])? / stiffness(PRELOADS_N[0])?;
    let mut under_moment = 0.0;
    for (bolts, preload_n) in UNDER_MOMENT_N {
        under_moment += bolts / BOLTS * stiffness(preload_n)?;
    }
    // T = τ_b A_r with τ_b = Y/√3, Y = H/2.8, is μP at μ = τ_b A_r/(p A₀)
    let shear_strength_pa = HARDNESS_PA / HARDNESS_OVER_YIELD / 3.0_f64.sqrt();
    let needed = |pressure_pa: f64| -> Result<f64, ReproduceError> {
        Ok(shear_strength_pa * contact.at(pressure_pa)?.real_area_fraction / pressure_pa)
    };
    let [(at_a, high_n), _, (_, low_n)] = UNDER_MOMENT_N;
    Ok(ZhaoReproduction {
        area_bounds_m2,
        contacts,
        losses: losses.into_iter().collect::<Result<_, ReproduceError>>()?,
        frequencies: TABLE_3.iter().flat_map(frequencies).collect(),
        stiffness_gain,
        joint_shares: std::array::from_fn(|mode| {
            let [low, high] = [&TABLE_3[0], &TABLE_3[1]].map(|(_, measured, computed)| {
                [measured[mode], computed[0][0][mode], computed[1][0][mode]]
            });
            // Rayleigh: d ln ω² is the share of the strain energy times d ln K
            std::array::from_fn(|of| 2.0 * (high[of] / low[of]).ln() / stiffness_gain.ln())
        }),
        // M = (L_a/2)(F' − F'') N_b
        row_distance_m: 2.0 * MOMENT_N_M / ((high_n - low_n) * at_a),
        stiffness_under_moment: under_moment / stiffness(PRELOADS_N[1])?,
        friction_needed: [needed(PRESSURES_PA[0])?, needed(PRESSURES_PA[1])?],
    })
}

/// The paper's contact, with a shear stress over the coefficient of friction, Pa.
fn contact(area_m2: f64, slip_stress_pa: f64) -> Result<FractalContact, ReproduceError> {
    let iron = Material::new(YOUNGS_MODULUS_PA, POISSONS_RATIO)?;
    let friction = Friction {
        coefficient: 1.0,
        shear_strength_pa: slip_stress_pa,
    };
    let roughness = Roughness::new(FRACTAL_DIMENSION, ROUGHNESS_M)?;
    let pair = Pair { a: iron, b: iron };
    Ok(FractalContact::new(
        &pair,
        roughness,
        HARDNESS_PA,
        friction,
        area_m2,
    )?)
}

fn frequencies((load, measured, computed): &'static Load) -> impl Iterator<Item = ZhaoFrequency> {
    measured.iter().enumerate().map(|(place, &measured_hz)| {
        let [even, uneven] =
            computed.map(|[hz, errors]| error(measured_hz, hz[place], errors[place]));
        ZhaoFrequency {
            load,
            mode: place + 1,
            measured_hz,
            even,
            uneven,
        }
    })
}

fn error(measured_hz: f64, computed_hz: f64, published_percent: f64) -> ZhaoError {
    let percent = 100.0 * (computed_hz / measured_hz - 1.0);
    let of_computed = 100.0 * (1.0 - measured_hz / computed_hz);
    let [from_measured, from_computed] =
        [percent, of_computed].map(|error| (error - published_percent).abs());
    ZhaoError {
        computed_hz,
        published_percent,
        percent,
        relative_to: if (percent - of_computed).abs() < ALIKE {
            Denominator::Either
        } else if from_measured < from_computed {
            Denominator::Measured
        } else {
            Denominator::Computed
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definitions of both errors: which denominator a printed error has, and what it is by the measured frequency.
    #[test]
    fn denominators_are_mixed() {
        let found = zhao().unwrap();
        let of = |load: &str, mode: usize| {
            let mut rows = found.frequencies.iter();
            let row = rows.find(|row| row.load == load && row.mode == mode);
            row.unwrap().even.clone()
        };
        for (load, mode, percent) in [("9 kN", 1, 5.79), ("15 kN", 5, -9.16)] {
            let even = of(load, mode);
            assert!((even.percent - percent).abs() < 0.005, "{even:?}");
            assert_eq!(even.relative_to, Denominator::Computed);
        }
        // every printed error is one of the two, but for a last decimal that was cut off or lost
        for row in &found.frequencies {
            for of in [&row.even, &row.uneven] {
                let by_computed = 100.0 * (1.0 - row.measured_hz / of.computed_hz);
                let by_printed = match of.relative_to {
                    Denominator::Measured => of.percent,
                    Denominator::Computed | Denominator::Either => by_computed,
                };
                let away = (by_printed - of.published_percent).abs();
                assert!(away < 0.0125, "{row:?}");
            }
        }
    }

    /// Closed forms of the paper evaluated in NumPy with 2.0 MPa (15 kN) and 1.2 MPa (9 kN) on 0.06 m².
    #[test]
    fn the_contact_is_that_of_the_closed_forms() {
        let found = zhao().unwrap();
        let at = |area_m2: f64, pressure_pa: f64| {
            let mut contacts = found.contacts.iter();
            let is_it = |of: &&ZhaoContact| {
                (of.area_m2 / area_m2 - 1.0).abs() < 1e-3
                    && (of.pressure_pa / pressure_pa - 1.0).abs() < 1e-9
            };
            contacts.find(is_it).unwrap().clone()
        };
        #[rustfmt::skip]
        let references = [
            (0.06, 0.62e6, 2.181e11, 1.005e11, 0.05167),
            (0.06, 1.2e6, 3.933e11, 1.813e11, 0.03817),
            (0.06, 2.0e6, 6.200e11, 2.858e11, 0.03022),
            (0.06, 7.98e6, 2.119e12, 9.770e11, 0.01607),
            (0.00902, 7.98e6, 2.616e12, 1.206e12, 0.03818),
            (0.1161, 0.62e6, 2.033e11, 9.370e10, 0.03819),
        ];
        for (area_m2, pressure_pa, normal, tangential, ratio) in references {
            let found = at(area_m2, pressure_pa);
            for (found, expected) in [
                (found.normal_stiffness_n_per_m3, normal),
                (found.tangential_stiffness_n_per_m3, tangential),
                (found.normal_energy_ratio, ratio),
                (found.normal_loss_factor * std::f64::consts::TAU, ratio),
            ] {
                assert!((found / expected - 1.0).abs() < 6e-4, "{found} {expected}");
            }
        }
        assert!((found.stiffness_gain - 1.5762).abs() < 1e-4);
        assert!((found.stiffness_under_moment - 0.99569).abs() < 1e-5);
        assert!((found.row_distance_m - 0.3).abs() < 1e-12);
        let [least, most] = found.friction_needed;
        assert!((least - 0.329).abs() < 1e-3 && (most - 0.545).abs() < 1e-3);
    }

    /// Each point gets stiffer with the preload, even where nine tenths of the friction are used: no frequency may fall.
    #[test]
    fn frequencies_that_fall_with_the_preload_are_not_the_models() {
        let low = |slip_stress_pa: f64, place: usize| {
            let contact = contact(AREA_M2, slip_stress_pa).unwrap();
            contact.at(BOLTS * PRELOADS_N[place] / AREA_M2).unwrap()
        };
        let unit = low(1.0, 1).friction_ratio;
        let [before, after] = [0, 1].map(|place| low(0.9 / unit, place));
        assert!((after.friction_ratio - 0.9).abs() < 1e-9);
        assert!(after.tangential_stiffness_n_per_m3 > before.tangential_stiffness_n_per_m3);
        let falling = |of: usize| {
            let shares = zhao().unwrap().joint_shares;
            let modes = (0..6).filter(|mode| shares[*mode][of] < 0.0);
            modes.map(|mode| mode + 1).collect::<Vec<_>>()
        };
        assert_eq!([0, 1, 2].map(falling), [vec![], vec![3], vec![6]]);
    }
}
