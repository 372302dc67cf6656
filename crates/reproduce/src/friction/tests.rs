//! The loops beside numbers that were computed elsewhere: closed forms by mpmath, the bristles at 20 Hz by SciPy's DOP853.

use super::{ChapterLaw, FrictionLoop, friction};

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error < tolerance, "{found} is {error:e} of {expected} off");
}

fn found(law: ChapterLaw) -> Vec<FrictionLoop> {
    let loops = friction().loops.into_iter();
    loops.filter(|of| of.law == law).collect()
}

#[test]
fn loops_have_the_heat_and_the_tip_of_independent_results() {
    // scaled by forces of 800 and lengths of 4/75: E_0 = 1000, E_t = 100, σ_0 = 5, U = 0.006
    let valanis = |tip: f64, heat: f64| (3.2e-4, 800.0 * tip, 800.0 * 4.0 / 75.0 * heat);
    // scaled by forces of 3000 and lengths of 20: σ_0 = 1e5, F_c = 2, U = 5e-5
    let slow = (
        1e-3,
        3000.0 * 1.973_228_596_302_9,
        6e4 * 2.421_417_122_957_7e-4,
    );
    let expected = [
        (ChapterLaw::Signum, 2e-5, vec![(6e-4, 4000.0, 9.6)]),
        (
            ChapterLaw::ElastoSlip,
            1e-11,
            vec![
                (4e-4, 6000.0, 2.133_333_333_333_3),
                (6e-4, 7000.0, 5.333_333_333_333_3),
            ],
        ),
        (
            ChapterLaw::Iwan,
            1e-9,
            vec![
                (2.193_548_387_095e-4, 2_496.035_862_4, 0.180_683_621_46),
                (6.580_645_161_285e-4, 4000.0, 4.683_763_055_5),
            ],
        ),
        (
            ChapterLaw::LuGre,
            1e-5,
            vec![slow, (1e-3, 4_400.358_784_715, 11.491_298_354_978)],
        ),
        (
            ChapterLaw::Valanis,
            1e-10,
            vec![
                valanis(4.351_445_731_554_7, 0.032_971_085_368_906),
                valanis(4.648_377_088_478_8, 0.027_032_458_230_425),
                valanis(5.071_259_284_97, 0.018_574_814_300_601),
                valanis(5.1, 0.018),
            ],
        ),
    ];
    for (law, tolerance, expected) in expected {
        let loops = found(law);
        assert_eq!(loops.len(), expected.len(), "{law:?}");
        for (of, (amplitude_m, tip_n, heat_j)) in loops.iter().zip(expected) {
            close(of.amplitude_m, amplitude_m, 1e-9);
            close(of.force_at_tip_n, tip_n, tolerance);
            close(of.heat_j, heat_j, tolerance);
            // and so has the reference beside it
            close(of.reference_force_at_tip_n, tip_n, 1e-9);
            close(of.reference_heat_j, heat_j, 1e-9);
        }
    }
}

#[test]
fn what_is_read_from_a_loop_is_what_the_slope_behind_its_reversal_makes_of_it() {
    let readings = friction().readings;
    let read = |symbol: &str| -> Vec<f64> {
        let of = readings.iter().filter(|of| of.symbol == symbol);
        of.map(|of| of.read).collect()
    };
    // dp/dx = E_1 (1 − s w)/(1 − c s w) behind and before the tip, at s = −1 and 1, with w and c of mpmath
    let tips = [
        (0.0, 0.833_654_607_012_16),
        (0.473_684_210_526, 0.899_639_352_995_28),
        (0.890_109_890_110, 0.993_613_174_437_77),
        (0.988_901_220_866, 1.0),
    ];
    let (slip, rest, limit) = (1.5e6, 1.35e7, 3600.0);
    for (place, (c, w)) in tips.into_iter().enumerate() {
        let sticking = slip + rest * (1.0 + w) / (1.0 + c * w);
        let slipping = slip + rest * (1.0 - w) / (1.0 - c * w);
        close(read("E_0")[place], sticking, 1e-3);
        close(read("E_t")[place], slipping, 1e-3);
        // where lines of these slopes through both tips meet
        let tip = slip * 3.2e-4 + limit * w;
        let force = sticking * (tip - slipping * 3.2e-4) / (sticking - slipping);
        close(read("σ_0")[place], force, 1e-3);
    }
    close(read("k_0 + k_1")[0], 2e7, 1e-6);
    // ρ near φ = 0 slips at once: K(Δu/2) of the first step, whose Δu is U (1 − cos 2π/512)
    let iwan = read("K_T");
    assert!(
        iwan.iter().all(|&of| of < 1.5e7 && of > 0.995 * 1.5e7),
        "{iwan:?}"
    );
}

#[test]
fn only_a_rounded_loop_costs_more_than_the_parallelogram() {
    let found = friction();
    // 4 · 3600 N (0.32 mm − 3600/1.35e7 m)
    close(found.heat_without_micro_slip_j, 0.768, 1e-12);
    let valanis = found
        .loops
        .iter()
        .filter(|of| of.law == ChapterLaw::Valanis);
    let heats: Vec<f64> = valanis.map(|of| of.heat_j).collect();
    assert!(heats.is_sorted_by(|one, next| one > next), "{heats:?}");
}
