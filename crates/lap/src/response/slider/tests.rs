//! Laws that slip against differences, quadrature of their loops, and Segalman's formula.

use bolted_joint_harmonic::masing_fundamental;

use super::*;

fn all() -> [SliderValues; 3] {
    let a = 3e-4;
    [
        SliderValues::jenkins(2e5, 20.0, a),
        SliderValues::iwan(Slider::MicroSlip, 3e4, -0.4, [1.0, 1.0], a),
        SliderValues::iwan(Slider::Iwan, 3e4, -0.4, [0.7, 0.3], a),
    ]
}

#[test]
fn derivatives_are_those_of_differences() {
    for values in all() {
        let amplitude = 2.6e-4;
        let found = values.closed_loops().at(amplitude);
        let step = 1e-6;
        let size = found.value.norm();
        let by_log = (values.closed_loops().at(amplitude * f64::exp(step)).value
            - values.closed_loops().at(amplitude * f64::exp(-step)).value)
            / (2.0 * step);
        assert!(
            (by_log - found.by_log_amplitude).norm() < 1e-6 * size,
            "{values:?}"
        );
        for i in 0..values.slider.parameters().len() {
            let moved = |by: f64| {
                let mut moved = values;
                moved.logs[i] += by;
                moved
            };
            let (above, below) = (moved(step), moved(-step));
            let by = (above.closed_loops().at(amplitude).value
                - below.closed_loops().at(amplitude).value)
                / (2.0 * step);
            assert!(
                (by - found.by_unknown[i]).norm() < 1e-6 * size,
                "{values:?} {i}"
            );
            for (n, (value, change)) in values.parameters().into_iter().enumerate() {
                let [above, below] = [above, below].map(|of| of.parameters()[n].0);
                let by = (above - below) / (2.0 * step);
                assert!(
                    (by - change[i]).abs() < 1e-6 * value.abs(),
                    "{values:?} {n} {i}"
                );
            }
        }
    }
}

#[test]
fn first_loading_is_that_of_the_law() {
    for values in all() {
        for u in [0.0, 1e-6, 9e-5, 2.0e-4, 2.2e-4, 5e-4] {
            let expected = match values.law(values.logs) {
                Valued::Jenkins(law) => law.load(&[0.0], u, 0.0),
                Valued::Iwan(law) => law.load::<f64>(&[], u, 0.0),
            };
            let found = values.first_loading().at(u);
            assert!(
                (found - expected).abs() < 1e-12 * (1.0 + expected),
                "{values:?} {u}"
            );
        }
    }
}

/// D = 4 R U^(χ+3)/((χ+2)(χ+3)) (Segalman), which is π U² Im z.
#[test]
fn small_motion_has_its_power_of_heat() {
    let values = all()[1];
    let parameters = values.parameters();
    let (density, exponent) = (parameters[0].0, parameters[1].0);
    for amplitude in [1e-6_f64, 1e-5, 1e-4, 3e-4] {
        let heat =
            std::f64::consts::PI * amplitude.powi(2) * values.closed_loops().at(amplitude).value.im;
        let expected =
            4.0 * density * amplitude.powf(exponent + 3.0) / ((exponent + 2.0) * (exponent + 3.0));
        assert!((heat / expected - 1.0).abs() < 1e-9, "{heat} {expected}");
    }
}

#[test]
fn the_stiffness_follows_its_parameters() {
    for values in all() {
        let step = 1e-6;
        for i in 0..values.slider.parameters().len() {
            let moved = |by: f64| {
                let mut moved = values;
                moved.logs[i] += by;
                moved
            };
            let difference = moved(step).stiffness() - moved(-step).stiffness();
            let by_parameters = values.stiffness_by_parameters();
            let parts = by_parameters.iter().zip(values.parameters());
            let expected: f64 = parts.map(|(by, (_, change))| by * change[i]).sum();
            let error = (difference / (2.0 * step) - expected).abs();
            assert!(error < 1e-6 * values.stiffness(), "{values:?} {i}: {error}");
        }
    }
}

/// Loops past the end of the density, for exponents and amplitudes that a search may come to.
#[test]
fn sliders_that_slip_through_have_the_loop_of_quadrature() {
    let a = 3e-4;
    for exponent in [-0.97, -0.5, 0.0, 0.6, 3.0, 20.0] {
        for ratio in [1e-3, 0.3, 40.0] {
            for part in [0.01, 0.2, 0.3, 0.45, 0.7, 0.9, 0.999, 1.0 - 1e-9] {
                let span = 0.7;
                let values = SliderValues::iwan(Slider::Iwan, 3e4, exponent, [span, ratio], a);
                let Valued::Iwan(law) = values.law(values.logs) else {
                    panic!("{values:?}");
                };
                let amplitude = span * a / part;
                let knee = law.nonlinear_amplitude(0.0, 0.0);
                let found = values.closed_loops().at(amplitude);
                let of_loop = masing_fundamental(|u| law.load::<f64>(&[], u, 0.0), knee, amplitude);
                let real = of_loop.in_phase / amplitude - law.stiffness;
                let expected = Complex64::new(real, -of_loop.quadrature / amplitude);
                let error = (found.value - expected).norm() / law.stiffness;
                assert!(error < 1e-12, "{exponent} {ratio} {part}: {error}");
                let size = law.stiffness;
                for i in 0..MOST {
                    let moved = |by: f64| {
                        let mut moved = values;
                        moved.logs[i] += by;
                        moved.closed_loops().at(amplitude).value
                    };
                    // the corner is too near for differences
                    if part > 0.99 {
                        continue;
                    }
                    let by = (moved(3e-6) - moved(-3e-6)) / 6e-6;
                    let error = (by - found.by_unknown[i]).norm() / size;
                    assert!(error < 1e-7, "{exponent} {ratio} {part} {i}: {error}");
                }
            }
        }
    }
}

/// The closed forms beside the quadrature over a loop of the law itself.
#[test]
fn closed_forms_are_those_of_the_loop() {
    for values in all() {
        for amplitude in [3e-5, 9e-5, 1.9e-4, 2.1e-4, 4e-4] {
            let found = values.closed_loops().at(amplitude).value;
            let of_loop = match values.law(values.logs) {
                Valued::Jenkins(law) => {
                    let knee = law.slip_force / law.stiffness;
                    masing_fundamental(|u| law.load(&[0.0], u, 0.0), knee, amplitude)
                }
                Valued::Iwan(law) => {
                    let span = law.nonlinear_amplitude(0.0, 0.0);
                    masing_fundamental(|u| law.load::<f64>(&[], u, 0.0), span, amplitude)
                }
            };
            let real = of_loop.in_phase / amplitude - values.stiffness();
            let expected = Complex64::new(real, -of_loop.quadrature / amplitude);
            let error = (found - expected).norm();
            assert!(
                error < 1e-11 * values.stiffness(),
                "{values:?} {amplitude}: {found} {expected}"
            );
        }
    }
}

/// About a larger amplitude the law is the same; that of small motion has its density and exponent, and ends farther out.
#[test]
fn a_law_is_the_same_about_another_amplitude() {
    for slider in [Slider::MicroSlip, Slider::Iwan] {
        let own = SliderValues::iwan(slider, 3e4, -0.4, [0.8, 0.3], 2e-4);
        let other = own.about(3e-4);
        assert_eq!(other.reference_m, 3e-4);
        for (one, other) in own.parameters().iter().zip(other.parameters()) {
            assert!((other.0 / one.0 - 1.0).abs() < 1e-12, "{slider:?}");
        }
        if slider == Slider::MicroSlip {
            assert!((other.corner_m() / own.corner_m() - 1.5).abs() < 1e-12);
        }
        assert_eq!(own.about(1e-4), own);
    }
}

/// Steps of a search may ask for any numbers; those of the law stay finite and above zero.
#[test]
fn no_step_leads_to_numbers_that_are_none() {
    for far in [-1e3, 1e3, f64::INFINITY, f64::NAN] {
        for slider in Slider::ALL {
            let mut own = SliderValues::iwan(slider, 3e4, -0.4, [0.8, 0.3], 2e-4);
            own.logs = [far; MOST];
            own.keep_in_range();
            for (value, by) in own.parameters() {
                assert!(value.is_finite(), "{slider:?} {far}");
                assert!(by.iter().all(|by| by.is_finite()), "{slider:?} {far}");
            }
            let (_, of_file) = own.in_file();
            assert!(of_file.iter().all(|value| value.is_finite()));
            assert!(own.corner_m() > 0.0 && own.stiffness() > 0.0);
        }
    }
}
