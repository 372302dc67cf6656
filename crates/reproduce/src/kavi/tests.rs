use super::*;

/// Powers of the varied quantity that follow from ζ = α′μ N (h₁ + h₂) Y/(π k w²) by hand.
#[test]
fn trends_are_the_powers_that_the_formula_has() {
    let claims = kavi().unwrap().claims;
    let obtained = |statement: &str| {
        let claim = claims.iter().find(|claim| claim.statement == statement);
        let claim = claim.unwrap_or_else(|| panic!("{statement}"));
        (claim.obtained.clone(), claim.verdict)
    };
    let close = |found: &[f64], expected: &[f64]| {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
    };
    let squared = |x: f64| (x / 370.0).powi(2);
    let (found, verdict) = obtained("damping grows with the length");
    close(&found, &[1.0, squared(430.0), squared(500.0)]);
    assert_eq!(verdict, Verdict::Follows);
    let (found, _) = obtained("damping falls with the amplitude");
    close(&found, &[1.0, 0.5, 1.0 / 3.0]);
    let (found, _) = obtained("damping grows with the diameter of the rivets");
    close(&found, &[1.0, 64.0 / 36.0, 100.0 / 36.0]);
    let (found, verdict) = obtained("damping is largest for layers of equal thickness");
    close(
        &found,
        &[
            1.0,
            1.133_830_353_454_546_1 / 0.895_201_290_841_568_8,
            1.278_656_030_590_129 / 0.895_201_290_841_568_8,
        ],
    );
    assert_eq!(verdict, Verdict::Opposite);
    let (found, _) = obtained("damping grows with the number of layers");
    close(&found, &[1.0, 4.0 / 3.0, 1.5]);
    let (found, _) = obtained("aluminium damps more than steel");
    close(&found, &[1.0, 196.0 / 67.6]);
    let (found, _) = obtained("damping falls with the thickness of the whole beam");
    close(&found, &[1.0, 0.25]);
    let (found, _) = obtained("the stiffer the jointed beam, the less damping");
    close(&found, &[1.0, 1.0 / 0.95, 1.0 / 0.90]);
}

#[test]
fn routes_agree_on_all_specimens() {
    let found = kavi().unwrap();
    assert_eq!(found.specimens.len(), 22);
    for specimen in &found.specimens {
        for at in &specimen.at {
            assert!(at.finite_element_deviation < 1e-5);
            assert!((at.finite_element_damping / at.damping - 1.0).abs() < 1e-4);
        }
    }
}
