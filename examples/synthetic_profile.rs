//! Makes a surface profile of known fractal dimension and roughness: `synthetic_profile D G_M POINTS STEP_M SEED [gaussian|wm] OUT`.
//!
//! To see, before a surface is measured, how many profiles of which length and step its D and G need.
#![forbid(unsafe_code)]

use std::error::Error;
use std::fs;

use bolted_joint::predict::surface::{FitSettings, ProfileFit, Roughness, Synthetic};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [dimension, roughness_m, points, step_m, seed, kind, output] = arguments.as_slice() else {
        return Err("expected synthetic_profile D G_M POINTS STEP_M SEED gaussian|wm OUT".into());
    };
    let synthetic = Synthetic {
        roughness: Roughness::new(dimension.parse()?, roughness_m.parse()?)?,
        points: points.parse()?,
        step_m: step_m.parse()?,
        gamma: 1.5,
    };
    let seed: u64 = seed.parse()?;
    let profile = match kind.as_str() {
        "gaussian" => synthetic.gaussian(seed)?,
        "wm" => synthetic.weierstrass_mandelbrot(seed)?,
        other => return Err(format!("found \"{other}\", expected gaussian or wm").into()),
    };
    let comment = format!(
        "synthetic profile ({kind}), not a measurement: D = {dimension}, G = {roughness_m} m, gamma = 1.5, seed {seed}"
    );
    fs::write(output, profile.to_csv(&comment))?;
    let fit = ProfileFit::new(&[profile], &FitSettings::default())?;
    println!(
        "fit of this profile alone: D = {:.3} ± {:.3}, G = {:.2e} m, 95 % from {:.1e} to {:.1e} m",
        fit.roughness.fractal_dimension(),
        fit.dimension_standard_deviation(),
        fit.roughness.roughness_m(),
        fit.roughness_interval_m[0],
        fit.roughness_interval_m[1],
    );
    Ok(())
}
