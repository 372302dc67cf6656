//! `reproduce tian`, and its document.

use std::path::Path;
use std::process::Command;

use bolted_joint::reproduce::tian;
use serde_json::Value;

use crate::fractal::relative;

fn written(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_bolted-joint"))
        .args([&["reproduce", "tian"], arguments].concat())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_document_is_what_the_command_writes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/tian.md");
    let document = std::fs::read_to_string(path).unwrap();
    assert_eq!(document.trim_end(), written(&["--markdown"]).trim_end());
}

#[test]
fn json_has_published_and_obtained_values_side_by_side() {
    let value: Value = serde_json::from_str(&written(&["--json"])).unwrap();
    let fits = value["fits"].as_array().unwrap();
    assert_eq!(fits.len(), 3);
    for fit in fits {
        let layers = fit["layers"].as_array().unwrap();
        let printed: Vec<f64> = layers
            .iter()
            .map(|layer| layer["published_youngs_modulus_pa"].as_f64().unwrap())
            .collect();
        assert_eq!(printed, [0.352e9, 0.541e9, 0.885e9]);
        assert!(
            layers
                .iter()
                .all(|layer| layer["poissons_ratio"].is_number())
        );
    }
    assert!(written(&[]).contains("E obtained"));
}

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

#[test]
fn it_stands_alone() {
    let output = Command::new(env!("CARGO_BIN_EXE_bolted-joint"))
        .args(["reproduce", "tian", "4.2"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("1 tables beside it"));
}
