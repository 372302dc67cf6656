//! Studies of predictions that cannot be meant.

use super::{PREDICT, STUDY, bench, over_torque};
use crate::bench::replaced;

/// What the program says of the study with `old` replaced by `new`.
fn refused(old: &str, new: &str, fragments: &[&str]) {
    bench(&replaced(STUDY, old, new)).refused(PREDICT, fragments);
}

#[test]
#[rustfmt::skip]
fn unknown_keys_and_methods_are_told_with_their_line() {
    refused("hardness =", "hardnes =", &["study.toml", "line 17", "hardnes"]);
    refused("\"fractal-contact\"", "\"fractals\"", &["line 1", "fractals", "layered-beam"]);
    refused("[damping]\n", "[dampening]\n", &["dampening"]);
    refused("method = \"fractal-contact\"\n", "", &["`method`: found nothing, expected one of"]);
}

#[test]
#[rustfmt::skip]
fn materials_that_cannot_be_are_refused() {
    refused("poissons_ratio = 0.28\n[materials.b]", "poissons_ratio = 0.5\n[materials.b]",
        &["`materials.a.poissons_ratio`", "0.5", "less than 0.5"]);
    refused("[materials.b]\nyoungs_modulus = 1.5e11", "[materials.b]\nyoungs_modulus = -1.5e11",
        &["`materials.b.youngs_modulus`", "-150000000000", "above zero"]);
}

#[test]
#[rustfmt::skip]
fn values_in_another_unit_are_refused_with_their_key() {
    refused("poissons_ratio = 0.28\n[materials.b]\nyoungs_modulus = 1.5e11", "poissons_ratio = 0.28\n[materials.b]\nyoungs_modulus = 150",
        &["`materials.b.youngs_modulus`: found 150", "Pa", "GPa or MPa"]);
    let cone = |half_angle: &str, head_diameter: &str| {
        let cone = format!("model = \"cone\"\nhalf_angle = {half_angle}\nhead_diameter = {head_diameter}\ndepth = 0.006");
        bench(&replaced(&replaced(STUDY, "model = \"kavi\"", &cone), "thickness = [0.01, 0.01]\n", ""))
    };
    cone("30", "0.013").done(PREDICT);
    // 30° in radians
    cone("0.524", "0.013").refused(PREDICT, &["`pressure.half_angle`: found 0.524", "degrees", "radians"]);
    cone("30", "0.0065").refused(PREDICT, &["`pressure.head_diameter`: found 0.0065", "the 0.008 of bolts[0].diameter", "radius"]);
}

#[test]
#[rustfmt::skip]
fn surfaces_that_cannot_be_are_refused() {
    for dimension in ["1", "2", "2.42"] {
        let expected = ["`surface.fractal_dimension`", dimension, "less than 2"];
        refused("= 1.42", &format!("= {dimension}"), &expected);
    }
    refused("= 1.21e-8", "= 0", &["`surface.roughness`", "above zero"]);
    refused("roughness = 1.21e-8\n", "roughness = 1.21e-8\ncorrelation = -1.5\n", &["`surface.correlation`", "-1.5", "between −1 and 1"]);
    refused("roughness = 1.21e-8\n", "", &["`surface`", "profiles", "fractal_dimension and roughness"]);
    refused("roughness = 1.21e-8\n", "roughness = 1.21e-8\n[surface.a]\nfractal_dimension = 1.4\nroughness = 1e-9\n",
        &["`surface`", "one of [surface.a] and [surface.b]", "both"]);
    let bench = bench(STUDY);
    bench.edit("study.toml", "fractal_dimension = 1.42\nroughness = 1.21e-8\n", "profiles = [\"p.csv\"]\n");
    bench.refused(PREDICT, &["`surface.profiles`: found \"p.csv\", which is not there"]);
    bench.write("p.csv", "distance_um,height_um\n0,0.1\n1,0.2\n");
    bench.refused(PREDICT, &["p.csv", "2 points", "at least 3"]);
}

#[test]
#[rustfmt::skip]
fn contacts_outside_the_model_are_refused_with_the_reason() {
    // q = T/(μP) of 0.976
    refused("shear_strength = 1e8", "shear_strength = 2e8", &["`contact`", "q = T/(μP)", "lower"]);
    refused("hardness = 1.96e9", "hardness = 3e7", &["`contact`", "element 188", "q = T/(μP)"]);
    bench(&replaced(&replaced(STUDY, "1.96e9", "3e7"), "= 1e8", "= 0"))
        .refused(PREDICT, &["`contact`", "element", "3", "Pa", "the parts flow as a whole"]);
    refused("friction = 0.3", "friction = 0", &["`contact.friction`", "above zero"]);
}

#[test]
#[rustfmt::skip]
fn bolts_that_cannot_be_are_refused() {
    refused("nut_factor = 0.2\n", "", &["`tightening.nut_factor`", "nothing", "no preload follows"]);
    refused("torque = 20\n\n[tightening]", "\n[tightening]", &["`bolts[4].preload`", "nothing", "a preload in N, or a torque"]);
    refused("torque = 20\n\n[tightening]", "torque = 20\npreload = 9000\n\n[tightening]", &["`bolts[4].preload`", "a torque beside it"]);
    refused("nut_factor = 0.2\n",
        "nut_factor = 0.2\nthread = { friction = 0.1, head_friction = 0.1, head_diameter = 0.013, hole_diameter = 0.009 }\n",
        &["`tightening.nut_factor`", "thread beside it"]);
    refused("x = 0.04\ny = 0.02", "x = 0.06\ny = 0.02", &["bolt 4", "goes beyond the edge"]);
    refused("thickness = [0.01, 0.01]", "thickness = [0.01, 0.013]", &["`pressure.thickness`", "a ratio of 1, 1.5 or 2"]);
    refused("thickness = [0.01, 0.01]\n", "thickness = [0.01, 0.01]\nbending_moment = [0, 3000]\n",
        &["bolt", "raise the preload or lower the moment"]);
    refused("model = \"kavi\"\n", "", &["`pressure.model`", "uniform"]);
}

#[test]
#[rustfmt::skip]
fn tables_of_torques_that_cannot_be_are_refused() {
    let refused = |old: &str, new: &str, fragments: &[&str]| {
        bench(&replaced(&over_torque(), old, new)).refused(PREDICT, fragments);
    };
    for torques in ["[20]", "[20, 10]", "[0, 10]", "[10, 10]"] {
        refused("[5, 10, 15, 20, 25]", torques, &["`tightening.torques`", "ascending"]);
    }
    refused("nominal = 20", "nominal = 12", &["`tightening.nominal`", "12", "one of"]);
    refused("x = 0.04\ny = 0.02\n", "x = 0.04\ny = 0.02\ntorque = 3\n", &["`bolts[4].torque`", "tightening.torques"]);
}

#[test]
#[rustfmt::skip]
fn joints_and_damping_that_cannot_be_are_refused() {
    refused("rotation = \"-y\"", "rotation = \"z\"", &["`joint.rotation`", "the axis of the translation"]);
    refused("rotation = \"-y\"", "rotation = \"w\"", &["\"w\"", "\"x\", \"y\" or \"z\""]);
    refused("rotation = \"-y\"", "rotation = \"-y\"\nreference = [0.1]", &["`joint.reference`", "[x, y]"]);
    refused("frequency = 300", "frequency = 0", &["`damping.frequency`", "above zero"]);
    refused("frequency = 300", "frequency = 300\nnormal = \"viscous\"", &["`damping.mass`", "nothing", "√(M K_N)"]);
    refused("frequency = 300", "frequency = 300\nmass = 3", &["`damping.mass`", "viscous"]);
    refused("frequency = 300\n", "frequency = 300\n[uncertainty]\ndraws = 1000\n",
        &["`uncertainty`", "no value with a standard deviation"]);
    let uncertain = replaced(STUDY, "= 1.42", "= \"1.42 ± 0.02\"");
    let none = uncertain.clone() + "[uncertainty]\ndraws = 1\n";
    bench(&none).refused(PREDICT, &["`uncertainty.draws`", "from 2 to 1000000"]);
    bench(&replaced(&uncertain, "± 0.02", "± -0.02"))
        .refused(PREDICT, &["line", "standard deviation -0.02"]);
}

/// The study with a field from a file, without bolts.
fn with_field(more: &str) -> String {
    let bolts = STUDY.find("[[bolts]]").unwrap();
    let joint = STUDY.find("[joint]").unwrap();
    let study = format!("{}{}", &STUDY[..bolts], &STUDY[joint..]);
    let interface = study.find("[interface]").unwrap();
    let joint = study.find("[joint]").unwrap();
    format!(
        "{}[interface]\nfield = \"field.csv\"\n{more}\n{}",
        &study[..interface],
        &study[joint..]
    )
}

#[test]
#[rustfmt::skip]
fn fields_that_cannot_be_are_refused() {
    const FIELD: &str = "x_mm,y_mm,area_mm2,pressure_MPa\n0,0,100,2\n10,0,100,3\n20,0,100,1\n";
    let refused = |more: &str, field: &str, fragments: &[&str]| {
        let bench = bench(&with_field(more));
        bench.write("field.csv", field);
        bench.refused(PREDICT, fragments);
    };
    refused("", &FIELD.replace(",3\n", ",-3\n"), &["field.csv", "-3", "pressure"]);
    refused("", &FIELD.replace("10,0,100", "10,0,0"), &["field.csv", "area"]);
    refused("area = 0.06", FIELD, &["field.csv", "0.0003", "0.06"]);
    refused("elements = [3, 1]", FIELD, &["`interface.field`", "elements"]);
    refused("\n[pressure]\nmodel = \"uniform\"", FIELD, &["`pressure.model`", "its own pressures"]);
    let bench = bench(&with_field("area = 0.0003"));
    bench.write("field.csv", FIELD);
    bench.done(PREDICT);
}

#[test]
fn outputs_are_written_all_or_none() {
    let bench = bench(STUDY);
    for (option, wrong, expected) in [
        ("--report", "r.txt", "ends in .html"),
        ("--matrix27", "m.txt", "ends in .mac"),
        ("--matrix-csv", "m.txt", "ends in .csv"),
        ("--field-csv", "study.toml", "ends in .csv"),
        ("--report", "missing/r.html", "cannot be written"),
        ("--damping-csv", "d.csv", "layered-beam"),
        ("--material-card", "c.inp", "virtual-material"),
    ] {
        bench.refused(&format!("{PREDICT} {option} {wrong}"), &[expected]);
    }
    let twice = format!("{PREDICT} --matrix-csv a.csv --field-csv a.csv");
    bench.refused(&twice, &["same file as a.csv"]);
}

#[test]
#[rustfmt::skip]
fn keys_of_the_other_method_are_refused() {
    refused("shear_strength = 1e8\n", "shear_strength = 1e8\nfriction_ratio = 0.1\n", &["`contact.friction_ratio`", "fractal-contact"]);
    refused("friction = 0.3\n", "", &["`contact.friction`", "nothing"]);
    refused("[interface]\n", "[layer]\nthickness = [0.001, 0.001]\n[interface]\n", &["`layer`", "virtual-material"]);
    let layer = |table: &str| {
        let method = replaced(STUDY, "\"fractal-contact\"", "\"virtual-material\"");
        replaced(&method, "friction = 0.3\nshear_strength = 1e8\n", table)
    };
    let thickness = "[layer]\nthickness = [0.001, 0.001]\n";
    bench(&layer("")).refused(PREDICT, &["`layer.thickness`", "nothing"]);
    for key in ["loss_factor = \"energy-ratio\"", "stored_energy = \"one-loading\""] {
        let study = replaced(&layer(thickness), "frequency = 300", &format!("frequency = 300\n{key}"));
        bench(&study).refused(PREDICT, &["`damping.", "layer.loss_factor"]);
    }
    refused("frequency = 300", "frequency = 300\nstored_energy = \"two\"", &["one-loading", "pi-loadings"]);
    bench(&layer(thickness)).refused(PREDICT, &["`materials.a.density`", "nothing"]);
    bench(&layer(&format!("friction = 0.3\n{thickness}")))
        .refused(PREDICT, &["`contact.friction`", "contact.friction_ratio"]);
}
