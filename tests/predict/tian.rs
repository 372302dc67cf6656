//! Tian's table as the equations allow it.

use bolted_joint::reproduce::tian;

use crate::fractal::relative;

/// The quality of the three fits, as the equations allow it.
#[test]
fn how_well_the_table_is_met() {
    let found = tian().unwrap();
    let [stated, areas, free] = &found.fits[..] else {
        panic!("{found:?}");
    };
    assert!(stated.is_at_bound && stated.log_residual > 4.0);
    assert!(!free.is_at_bound && (free.log_residual - 0.0709).abs() < 5e-4);
    for layer in &areas.layers {
        let young = relative(layer.youngs_modulus_pa, layer.published_youngs_modulus_pa);
        assert!(young < 1e-9, "{young:e}");
        assert!(layer.area_ratio > 1.0 && layer.area_ratio < 1.01);
        assert!(layer.poissons_ratio > 0.87 && layer.poissons_ratio < 0.89);
    }
    assert!(found.load_ratio_of_areas < 1.01);
    // E' and G' of cast iron on cast iron
    let modulus = 1.1e11 / (2.0 * (1.0 - 0.26_f64.powi(2)));
    let shear = 1.1e11 / (4.0 * 1.26 * 1.74);
    let limit = modulus * modulus / (24.0 * std::f64::consts::PI * shear * 1.5);
    assert!(relative(found.least_hardness_pa, limit) < 1e-14);
}
