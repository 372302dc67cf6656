//! Cards as other programs read them.

use bolted_joint::predict::virtual_material::{Card, VirtualMaterial};

const MATERIAL: VirtualMaterial = VirtualMaterial {
    youngs_modulus_pa: 0.352e9,
    shear_modulus_pa: 0.352e9 / 2.46,
    poissons_ratio: 0.23,
    density_kg_per_m3: 7340.0,
    thickness_m: 1e-3,
};

/// Numbers in the lines that are neither keywords nor comments.
fn numbers(text: &str, separator: char, skipped: usize) -> Vec<f64> {
    text.split(separator)
        .skip(skipped)
        .filter(|field| !field.trim().is_empty())
        .map(|field| field.trim().parse().unwrap())
        .collect()
}

#[test]
fn abaqus_reads_its_keywords() {
    let text = Card::Abaqus.text(&MATERIAL, "JOINT-LAYER").unwrap();
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("**"))
        .collect();
    assert_eq!(lines[0], "*MATERIAL, NAME=JOINT-LAYER");
    assert_eq!(lines[1], "*ELASTIC");
    assert_eq!(numbers(lines[2], ',', 0), [0.352e9, 0.23]);
    assert_eq!(lines[3], "*DENSITY");
    assert_eq!(numbers(lines[4], ',', 0), [7340.0]);
    assert_eq!(lines.len(), 5);
    // A number has 20 characters at most.
    let longest = lines
        .iter()
        .flat_map(|line| line.split(','))
        .map(|field| field.trim().len());
    assert!(longest.skip(2).all(|length| length <= 20));
}

#[test]
fn ansys_reads_its_commands() {
    let text = Card::Ansys(7).text(&MATERIAL, "layer").unwrap();
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('!')).collect();
    for (line, (label, value)) in
        lines
            .iter()
            .zip([("EX", 0.352e9), ("PRXY", 0.23), ("DENS", 7340.0)])
    {
        assert!(line.starts_with(&format!("MP,{label},7,")), "{line}");
        assert_eq!(numbers(line, ',', 3), [value]);
    }
    assert_eq!(lines.len(), 3);
}

#[test]
fn the_table_names_quantities_and_units() {
    let text = Card::Csv.text(&MATERIAL, "layer").unwrap();
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines[0], ["quantity", "value", "unit"]);
    let found: Vec<(&str, f64, &str)> = lines[1..]
        .iter()
        .map(|fields| (fields[0], fields[1].parse().unwrap(), fields[2]))
        .collect();
    let shear = (MATERIAL.shear_modulus_pa / 1e-4).round() * 1e-4;
    assert!((found[1].1 / shear - 1.0).abs() < 1e-12);
    assert_eq!(found[0], ("youngs_modulus", 0.352e9, "Pa"));
    assert_eq!(found[2], ("poissons_ratio", 0.23, "1"));
    assert_eq!(found[3], ("density", 7340.0, "kg/m^3"));
    assert_eq!(found[4], ("thickness", 1e-3, "m"));
}

#[test]
fn names_that_programs_do_not_take() {
    for name in ["", "1st", "two words", "a,b", "naïve", &"x".repeat(81)] {
        let error = Card::Abaqus.text(&MATERIAL, name).unwrap_err();
        assert_eq!(error.what, format!("material's name is \"{name}\""));
    }
    let error = Card::Ansys(0).text(&MATERIAL, "layer").unwrap_err();
    assert_eq!(error.what, "number of the material is 0");
}
