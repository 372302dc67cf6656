//! Fractal dimension and roughness: spectra against SciPy, known surfaces back within their intervals, bad profiles refused.

use bolted_joint_testing::{begins, has};
use std::fs;

use bolted_joint::predict::surface::{
    Detrend, FitSettings, FitWarning, Profile, ProfileFit, Roughness, SurfaceError, Synthetic,
    Welch, Window,
};
use proptest::prelude::*;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use tempfile::TempDir;

fn surface(dimension: f64, roughness_m: f64) -> Synthetic {
    Synthetic {
        roughness: Roughness::new(dimension, roughness_m).unwrap(),
        points: 4000,
        step_m: 1e-6,
        gamma: 1.5,
    }
}

/// Measurements of three profiles each, with different seeds.
const MEASUREMENTS: u64 = 500;

#[derive(Debug)]
struct Trials {
    /// Part of the intervals that hold D, and G.
    covered: [f64; 2],
    /// Mean of D less the true one, and of ln G, in standard errors of that mean.
    bias: [f64; 2],
    /// Standard deviation stated over that found, of D and ln G.
    stated: [f64; 2],
    inflated: f64,
}

fn trials(
    synthetic: &Synthetic,
    settings: &FitSettings,
    make: impl Fn(&Synthetic, u64) -> Profile + Sync,
) -> Trials {
    let fits: Vec<ProfileFit> = (0..MEASUREMENTS)
        .into_par_iter()
        .map(|number| {
            let profiles: Vec<Profile> = (0..3)
                .map(|profile| make(synthetic, 3 * number + profile))
                .collect();
            ProfileFit::new(&profiles, settings).unwrap()
        })
        .collect();
    let count = MEASUREMENTS as f64;
    let truth = [
        synthetic.roughness.fractal_dimension(),
        synthetic.roughness.roughness_m().ln(),
    ];
    let quantities = |fit: &ProfileFit| {
        let [low, high] = fit.roughness_interval_m;
        [
            (
                fit.roughness.fractal_dimension(),
                fit.dimension_interval,
                fit.dimension_standard_deviation(),
            ),
            (
                fit.roughness.roughness_m().ln(),
                [low.ln(), high.ln()],
                fit.log_roughness_standard_deviation(),
            ),
        ]
    };
    let mut found = Trials {
        covered: [0.0; 2],
        bias: [0.0; 2],
        stated: [0.0; 2],
        inflated: fits.iter().filter(|fit| fit.is_inflated).count() as f64 / count,
    };
    for quantity in 0..2 {
        let values: Vec<_> = fits.iter().map(|fit| quantities(fit)[quantity]).collect();
        let mean = values.iter().map(|v| v.0).sum::<f64>() / count;
        let variance = values.iter().map(|v| (v.0 - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let stated = values.iter().map(|v| v.2).sum::<f64>() / count;
        let holds =
            |(_, [low, high], _): &&(f64, [f64; 2], f64)| (*low..=*high).contains(&truth[quantity]);
        found.covered[quantity] = values.iter().filter(holds).count() as f64 / count;
        found.bias[quantity] = (mean - truth[quantity]) / (variance / count).sqrt();
        found.stated[quantity] = stated / variance.sqrt();
    }
    found
}

/// D and G from smooth to rough.
const SURFACES: [(f64, f64); 3] = [(1.2, 1e-11), (1.42, 1.21e-8), (1.75, 1e-7)];

#[test]
fn intervals_of_gaussian_surfaces_hold_the_truth_as_often_as_they_say() {
    for (dimension, roughness_m) in SURFACES {
        let synthetic = surface(dimension, roughness_m);
        let found = trials(&synthetic, &FitSettings::default(), |s, seed| {
            s.gaussian(seed).unwrap()
        });
        println!("D {dimension}: {found:?}");
        for quantity in 0..2 {
            assert!((0.92..=0.975).contains(&found.covered[quantity]));
            assert!((0.95..=1.1).contains(&found.stated[quantity]));
        }
        assert!(found.bias[0].abs() < 3.5);
        // Where the line is true, χ² beyond its 95 % is one in twenty.
        assert!((0.03..=0.08).contains(&found.inflated));
    }
}

/// The function's waves have fixed amplitudes; phases alone are random. So its spectrum hardly scatters, and intervals for a
/// random surface are too wide for it, not too narrow.
#[test]
fn intervals_of_weierstrass_mandelbrot_surfaces_hold_the_truth() {
    for (dimension, roughness_m) in SURFACES {
        // The waves lie elsewhere in the bands with another step.
        for step_m in [1e-6, 1.11e-6, 1.27e-6, 1.4e-6] {
            let synthetic = Synthetic {
                step_m,
                ..surface(dimension, roughness_m)
            };
            let profiles: Vec<Profile> = (0..300)
                .map(|seed| synthetic.weierstrass_mandelbrot(seed).unwrap())
                .collect();
            for three in profiles.chunks(3) {
                let fit = ProfileFit::new(three, &FitSettings::default()).unwrap();
                let [low, high] = fit.dimension_interval;
                assert!((low..=high).contains(&dimension));
                let [low, high] = fit.roughness_interval_m;
                assert!((low..=high).contains(&roughness_m));
            }
            // All together: bias without scatter.
            let fit = ProfileFit::new(&profiles, &FitSettings::default()).unwrap();
            let off = fit.roughness.fractal_dimension() - dimension;
            println!(
                "D {dimension} step {step_m}: {off:+.4}, G {:.4}",
                fit.roughness.roughness_m() / roughness_m
            );
            assert!(off.abs() < 0.006, "{off}");
        }
    }
}

#[test]
fn spectra_are_those_of_scipy() {
    let cases = [
        (Window::Hann, 256, 128, Detrend::Mean),
        (Window::Hann, 255, 100, Detrend::Line),
        (Window::Blackman, 300, 0, Detrend::Nothing),
        (Window::Hann, 1000, 500, Detrend::Line),
    ];
    let heights: Vec<f64> = (0..1000_u32)
        .map(|i| {
            let x = f64::from(i);
            let order = f64::from(i * 7919 % 1013) / 1013.0;
            1e-6 * ((0.37 * x).sin() + 0.3 * (1.91 * x + 0.2).cos() + 0.01 * x + order)
        })
        .collect();
    let reference = include_str!("data/welch.csv");
    for (number, (window, segment, overlap, detrend)) in cases.into_iter().enumerate() {
        let welch = Welch {
            window,
            segment,
            overlap,
            detrend,
        };
        let spectrum = welch.spectrum(&heights, 5e-7).unwrap();
        let start = format!("{number},");
        let expected: Vec<(f64, f64)> = reference
            .lines()
            .filter_map(|line| line.strip_prefix(&start)?.split_once(','))
            .map(|(f, s)| (f.parse().unwrap(), s.parse().unwrap()))
            .collect();
        assert_eq!(expected.len(), spectrum.density_m3.len());
        let largest = expected.iter().map(|(_, s)| *s).fold(0.0, f64::max);
        let found = spectrum.frequency_per_m.iter().zip(spectrum.density_m3);
        for ((f, s), (frequency, density)) in found.zip(expected) {
            assert!((f - frequency).abs() <= 1e-12 * frequency);
            // What a mean or a line leaves at zero is rounding.
            let most = 1e-10 * density + 1e-20 * largest;
            assert!((s - density).abs() <= most, "{number}: {f}");
        }
    }
}

#[test]
fn the_density_is_one_sided_and_over_cycles_per_metre() {
    // Its integral is the mean square height: A²/2 of a wave, all of it at 1/λ, not at 2π/λ.
    let (amplitude, wavelength_m) = (2e-6_f64, 25e-6);
    let heights: Vec<f64> = (0..2000)
        .map(|i| amplitude * (std::f64::consts::TAU * 1e-6 * f64::from(i) / wavelength_m).cos())
        .collect();
    let welch = Welch {
        window: Window::Hann,
        segment: 500,
        overlap: 250,
        detrend: Detrend::Nothing,
    };
    let spectrum = welch.spectrum(&heights, 1e-6).unwrap();
    let spacing = spectrum.frequency_per_m[1];
    let power: f64 = spectrum.density_m3.iter().sum::<f64>() * spacing;
    assert!((power / (0.5 * amplitude.powi(2)) - 1.0).abs() < 1e-12);
    let densities = spectrum.density_m3.iter().enumerate();
    let peak = densities.max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
    assert!((spectrum.frequency_per_m[peak.0] * wavelength_m - 1.0).abs() < 1e-12);
}

/// ω counts cycles per metre, and the density is one-sided: only so does the published line give the D and G that made the surface.
#[test]
fn line_and_intercept_are_those_of_the_published_equations() {
    let synthetic = surface(1.42, 1.21e-8);
    let profiles: Vec<Profile> = (10_000..11_000)
        .map(|seed| synthetic.gaussian(seed).unwrap())
        .collect();
    let fit = ProfileFit::new(&profiles, &FitSettings::default()).unwrap();
    let roughness = fit.roughness;
    let (d, g) = (roughness.fractal_dimension(), roughness.roughness_m());
    // (31) with its own D and G is an identity; D and G themselves within three standard deviations.
    assert!((fit.slope - (2.0 * d - 5.0)).abs() < 1e-12);
    let intercept = 2.0 * (d - 1.0) * g.log10() - (2.0 * 1.5_f64.ln()).log10();
    assert!((fit.intercept() - intercept).abs() < 1e-10);
    assert!((d - 1.42).abs() < 3.0 * fit.dimension_standard_deviation());
    assert!((g / 1.21e-8).ln().abs() < 3.0 * fit.log_roughness_standard_deviation());
    assert!(fit.dimension_standard_deviation() < 0.002);
    // ω in radians per metre would be S(ω) = S(f)/2π with f = ω/2π: a G larger by (2π)^((2−D)/(D−1)), far outside.
    let factor = std::f64::consts::TAU.powf(0.58 / 0.42);
    assert!(factor.ln() > 20.0 * fit.log_roughness_standard_deviation());
    // The points of the figure are the line and its scatter.
    for band in &fit.bands {
        let off = (band.density_m3 / fit.density_m3(band.frequency_per_m)).ln();
        assert!(off.abs() < 4.0 * band.log_standard_deviation);
    }
    // D and ln G are almost one quantity, and their covariance has their standard deviations.
    assert!((0.99..1.0).contains(&fit.correlation()));
    let [low, high] = fit.roughness_interval_m;
    let to_first_order = 2.0 * 1.959_964 * fit.log_roughness_standard_deviation();
    assert!(((high / low).ln() / to_first_order - 1.0).abs() < 0.01);
}

#[test]
fn a_form_that_is_taken_off_does_not_matter() {
    let profile = surface(1.42, 1.21e-8).gaussian(5).unwrap();
    let bent: Vec<f64> = profile
        .distance_m()
        .zip(profile.height_m())
        .map(|(x, z)| z + 2e-6 + 1e-2 * x - 3.0 * x * x)
        .collect();
    let bent = Profile::new(profile.step_m(), bent).unwrap();
    let settings = FitSettings {
        form: Detrend::Parabola,
        ..FitSettings::default()
    };
    let dimension = |profile: Profile| {
        let fit = ProfileFit::new(&[profile], &settings).unwrap();
        fit.roughness.fractal_dimension()
    };
    assert!((dimension(profile) - dimension(bent)).abs() < 1e-9);
}

#[test]
fn a_surface_that_is_no_fractal_has_wider_intervals_and_a_warning() {
    // A wave of feed marks on top of a fractal.
    let synthetic = surface(1.42, 1.21e-8);
    let with_marks = |seed| {
        let profile = synthetic.gaussian(seed).unwrap();
        let marks = |(x, z): (f64, &f64)| z + 1e-6 * (x * std::f64::consts::TAU / 4e-5).cos();
        let heights = profile.distance_m().zip(profile.height_m()).map(marks);
        Profile::new(profile.step_m(), heights.collect()).unwrap()
    };
    let plain: Vec<Profile> = (0..3).map(|s| synthetic.gaussian(s).unwrap()).collect();
    let marked: Vec<Profile> = (0..3).map(with_marks).collect();
    let settings = FitSettings::default();
    let [plain, marked] =
        [plain, marked].map(|profiles| ProfileFit::new(&profiles, &settings).unwrap());
    assert!(!plain.is_inflated && plain.warnings.is_empty());
    assert!(marked.is_inflated);
    assert!(marked.dimension_standard_deviation() > 2.0 * plain.dimension_standard_deviation());
    let warned = |w: &FitWarning| matches!(w, FitWarning::NotStraight { .. });
    assert!(marked.warnings.iter().any(warned));
    has(&marked.warnings[0].to_string(), &["no straight line"]);
}

#[test]
fn bands_beyond_what_was_measured_are_warned_of_or_refused() {
    let profiles = [surface(1.42, 1.21e-8).gaussian(1).unwrap()];
    let fit = |band| {
        let settings = FitSettings {
            wavelength_band_m: Some(band),
            ..FitSettings::default()
        };
        ProfileFit::new(&profiles, &settings)
    };
    let warnings = fit([2e-6, 5e-4]).unwrap().warnings;
    assert!(
        matches!(warnings[0], FitWarning::NearSampling { steps } if (steps - 2.0).abs() < 1e-9)
    );
    assert!(matches!(warnings[1], FitWarning::NearSegment { waves } if waves < 4.0));
    for band in [[1.9e-6, 1e-4], [1e-5, 1.1e-3], [1e-5, 1.4e-5], [1e-4, 1e-5]] {
        let error = fit(band).unwrap_err();
        assert!(matches!(error, SurfaceError::Band { .. }));
        assert!(error.to_string().contains("expected at least 3"), "{error}");
    }
}

#[test]
fn slopes_of_no_fractal_are_refused() {
    let fit = |profiles: &[Profile]| ProfileFit::new(profiles, &FitSettings::default());
    // Noise: D = 2.5. A smooth surface: the sum twice over of noise falls as f⁻⁴, D = 0.5.
    let noise: Vec<f64> = (0..4000_u64)
        .map(|i| ((i * 7919 % 10_007) as f64 * 0.618_034 * 97.0).fract() * 1e-7)
        .collect();
    let error = fit(&[Profile::new(1e-6, noise.clone()).unwrap()]).unwrap_err();
    assert!(error.to_string().contains("like noise"), "{error}");
    let mean = noise.iter().sum::<f64>() / 4000.0;
    let sum = |values: Vec<f64>| -> Vec<f64> {
        let mut sum = 0.0;
        let add = |value: f64| {
            sum += value;
            sum
        };
        values.into_iter().map(add).collect()
    };
    let smooth = sum(sum(noise.iter().map(|z| z - mean).collect()));
    let error = fit(&[Profile::new(1e-6, smooth).unwrap()]).unwrap_err();
    has(&error.to_string(), &["smoother than a fractal"]);
    assert!(matches!(error, SurfaceError::Dimension { dimension, .. } if dimension < 1.0));
    // Flat, none, unlike steps.
    let flat = Profile::new(1e-6, vec![0.0; 1000]).unwrap();
    assert!(matches!(fit(&[flat]), Err(SurfaceError::Flat { .. })));
    assert!(matches!(fit(&[]), Err(SurfaceError::NoProfiles)));
    let one = surface(1.4, 1e-9);
    let other = Synthetic {
        step_m: 2e-6,
        ..surface(1.4, 1e-9)
    };
    let error = fit(&[one.gaussian(1).unwrap(), other.gaussian(2).unwrap()]).unwrap_err();
    begins(&error.to_string(), "profile 2 has the step");
    // Too short a measurement: D near 1 says nothing of G.
    let short = Synthetic {
        points: 1000,
        ..surface(1.03, 1e-30)
    };
    let refused = (0..20).any(|seed| {
        let fit = fit(&[short.gaussian(seed).unwrap()]);
        matches!(fit, Err(SurfaceError::Undetermined { .. }))
    });
    assert!(refused);
}

fn in_file(text: &str) -> Result<Profile, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("profile.csv");
    fs::write(&path, text).unwrap();
    Profile::read(&path).map_err(|error| {
        let text = error.to_string();
        assert!(text.contains("profile.csv"), "{text}");
        text
    })
}

#[test]
fn profiles_from_files() {
    let profile = in_file("# part 7\ndistance_mm,height_um\n1,0.5\n1.5,-0.25\n2,0\n").unwrap();
    assert!((profile.step_m() - 5e-4).abs() < 1e-18);
    assert_eq!(profile.height_m()[1], -0.25e-6);
    assert!((profile.length_m() - 1e-3).abs() < 1e-18);
    let same =
        in_file("height [nm];distance [m]\r\n500;0,001\r\n-250;0,0015\r\n0;0,002\r\n").unwrap();
    for (a, b) in profile.distance_m().zip(same.distance_m()) {
        assert!((a - b).abs() < 1e-15);
    }
    let written = surface(1.42, 1.21e-8).gaussian(9).unwrap();
    let again = in_file(&written.to_csv("two\nlines")).unwrap();
    assert!((again.step_m() / written.step_m() - 1.0).abs() < 1e-9);
    for (a, b) in written.height_m().iter().zip(again.height_m()) {
        assert!((a - b).abs() < 1e-12);
    }
}

#[test]
fn bad_profiles_are_refused_with_their_line() {
    let refused = |rows: &str| in_file(&format!("distance_mm,height_um\n{rows}")).unwrap_err();
    let few = refused("0,1\n1,2\n");
    has(&few, &["found 2 points", "at least 3"]);
    let uneven = refused("0,0\n1,0\n2,0\n3.2,0\n4,0\n");
    has(&uneven, &["line 5", "even spacing"]);
    let back = refused("0,0\n1,0\n0.5,0\n");
    has(&back, &["line 4", "growing"]);
    let word = refused("0,0\n1,nan\n2,0\n");
    has(&word, &["line 3", "\"nan\""]);
    let unit = in_file("distance_mm,height\n0,0\n").unwrap_err();
    has(&unit, &["line 1", "height_mm", "nm"]);
    assert!(in_file("\n").unwrap_err().contains("empty"));
    assert!(in_file("# only\n").unwrap_err().contains("column names"));
    // Uneven steps on purpose: straight lines between the points.
    let even = Profile::resampled(&[0.0, 1.0, 1.5, 4.0], &[0.0, 2.0, 3.0, 8.0]).unwrap();
    for (x, z) in even.distance_m().zip(even.height_m()) {
        assert!((z - 2.0 * x).abs() < 1e-12);
    }
    let no_step = Profile::new(0.0, vec![0.0; 9]).unwrap_err().to_string();
    assert!(no_step.starts_with("the step is 0 m"), "{no_step}");
    for dimension in [1.0, 2.0, 0.5, f64::NAN] {
        assert!(Roughness::new(dimension, 1e-9).is_err());
    }
    assert!(Roughness::new(1.5, 0.0).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Damaged tables are read or refused, never a panic; what is read can be fitted or is refused.
    #[test]
    fn damaged_tables_do_no_harm(
        place in 0.0..1.0_f64,
        token in prop::sample::select(vec![
            "", "-", ",", ";", "\n", "1e308", "-1e308", "1e-320", "nan", "[", "_", "\"", "µ", "#", "\t", "\u{feff}",
        ]),
        removed in 0_usize..8,
    ) {
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("table.csv");
        let rows = (0..40).map(|k| format!("{k},{},1,2\n", k * 7 % 11));
        for header in ["distance_um,height_nm,a,b\n", "x_mm,y_mm,area_mm2,pressure_MPa\n"] {
            let mut text: Vec<char> = header.chars().chain(rows.clone().collect::<String>().chars()).collect();
            let at = (place * text.len() as f64) as usize;
            let end = (at + removed).min(text.len());
            text.splice(at..end, token.chars());
            fs::write(&path, text.into_iter().collect::<String>()).unwrap();
            let profiles = [Profile::read(&path), Profile::read_resampled(&path)];
            for profile in profiles.into_iter().flatten() {
                let _ = ProfileFit::new(&[profile], &FitSettings::default());
            }
            let _ = bolted_joint::predict::pressure::PressureField::read(&path, None);
        }
    }
}
