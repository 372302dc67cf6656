//! Decays whose numbers are known: linear ones in closed form.

use super::*;

fn lines_of(
    samples: &[(f64, f64)],
    band_hz: Option<[f64; 2]>,
    order: i32,
    share: f64,
) -> Result<Vec<BackboneLine>, DecayProblem> {
    backbone_of(samples, band_hz, order, share, [0.0; 2]).map(|read| read.lines)
}

/// x = e^(−ζω₀t) cos ω_d t, sampled; amplitude, ζ, frequency in Hz.
fn decaying(modes: &[(f64, f64, f64)], count: u32, interval_s: f64) -> Vec<(f64, f64)> {
    let value = |t: f64| -> f64 {
        let of_mode = |&(amplitude, ratio, hz): &(f64, f64, f64)| {
            let omega = TAU * hz;
            let damped = omega * f64::sqrt(1.0 - ratio * ratio);
            amplitude * (-ratio * omega * t).exp() * (damped * t).cos()
        };
        modes.iter().map(of_mode).sum()
    };
    let times = (0..count).map(|n| f64::from(n) * interval_s);
    times.map(|t| (t, value(t))).collect()
}

#[test]
fn a_linear_decay_has_its_frequency_and_damping() {
    let samples = decaying(&[(2e-4, 0.004, 81.2)], 20_000, 1e-4);
    let lines = lines_of(&samples, None, 0, 1.0).unwrap();
    assert!(lines.len() > 20, "{}", lines.len());
    for line in &lines {
        assert!(
            (line.omega / (TAU * 81.2) - 1.0).abs() < 1e-6,
            "{}",
            line.omega
        );
        let ratio = line.damping_ratio.unwrap();
        assert!((ratio / 0.004 - 1.0).abs() < 1e-3, "{ratio}");
    }
    // A falls by e^(−ζωT) over five periods T
    for pair in lines.windows(2) {
        let fall = pair[1].amplitude_m / pair[0].amplitude_m;
        assert!(
            (fall / (-0.004 * TAU * 5.0_f64).exp() - 1.0).abs() < 1e-4,
            "{fall}"
        );
    }
}

#[test]
fn amplitudes_are_those_of_the_displacement_whatever_was_measured() {
    let samples = decaying(&[(3.0, 0.002, 50.0)], 40_000, 1e-4);
    let lines = lines_of(&samples, None, 2, 0.5).unwrap();
    let first = lines[0];
    // back to time zero: the first stretch is in the middle of ten half-periods behind the window
    let omega = TAU * 50.0;
    let sigma_s = (-2.0 * AT_THE_EDGE.ln()).sqrt() / (TAU * 25.0);
    let at_s = WINDOW * sigma_s + 4.5 * 0.01;
    let expected = 3.0 * (-0.002 * omega * at_s).exp() / omega.powi(2) / 0.5;
    assert!(
        (first.amplitude_m / expected - 1.0).abs() < 2e-3,
        "{first:?} {expected}"
    );
}

#[test]
fn two_modes_are_told_and_a_band_takes_one_of_them() {
    let modes = [(2e-4, 0.004, 81.2), (5e-5, 0.003, 204.0)];
    let samples = decaying(&modes, 20_000, 1e-4);
    let Err(DecayProblem::Several(found)) = lines_of(&samples, None, 0, 1.0) else {
        panic!("two modes pass for one");
    };
    assert!(
        (found[0] - 81.2).abs() < 0.5 && (found[1] - 204.0).abs() < 0.5,
        "{found:?}"
    );
    for ((_, ratio, hz), band) in modes.into_iter().zip([[50.0, 112.0], [150.0, 260.0]]) {
        for line in lines_of(&samples, Some(band), 0, 1.0).unwrap() {
            assert!(
                (line.omega / (TAU * hz) - 1.0).abs() < 2e-4,
                "{}",
                line.omega / TAU
            );
            let found = line.damping_ratio.unwrap();
            assert!((found / ratio - 1.0).abs() < 0.02, "{found}");
        }
    }
    // both in the band, or neither
    let both = lines_of(&samples, Some([50.0, 300.0]), 0, 1.0);
    assert!(matches!(both, Err(DecayProblem::Several(_))));
    let samples = decaying(&modes[..1], 20_000, 1e-4);
    let none = lines_of(&samples, Some([300.0, 400.0]), 0, 1.0);
    assert!(none.is_err());
}

/// Beside a mode whose frequency rises by 3 % while it decays, with white noise.
#[test]
fn the_other_modes_of_a_band_are_known() {
    let others = [(1.5e-4, 0.004, 61.0), (9e-5, 0.006, 233.0)];
    let mut samples = decaying(&others, 12_000, 1e-4);
    let (mut phase, mut seed) = (0.0, 7_u64);
    for (time_s, value) in &mut samples {
        let amplitude = (-3.0 * *time_s).exp();
        phase += TAU * 110.0 * (1.03 - 0.03 * amplitude) * 1e-4;
        let mut noise = 0.0;
        for _ in 0..12 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            noise += (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        }
        *value += 3e-4 * (amplitude * phase.cos() + 0.002 * noise);
    }
    let read = backbone_of(&samples, Some([85.0, 150.0]), 0, 1.0, [0.0; 2]).unwrap();
    let alone = read.recorded.alone().unwrap();
    assert_eq!(read.recorded.beside_count(), 8);
    // the beginning is not read, and is free of them as well
    let own = alone
        .values
        .iter()
        .zip(&samples)
        .zip(decaying(&others, 12_000, 1e-4));
    let off = own.map(|((alone, (_, value)), (_, others))| (alone - (value - others)).abs());
    assert!(off.fold(0.0, f64::max) < 3e-4 * 0.01);
}

/// A second mode that fades early is hardly in the spectrum of the whole record: it makes beats, or stays beside the signal.
#[test]
fn a_second_mode_is_told_however_it_fades() {
    #[rustfmt::skip]
    let others = [
        (1e-4, 0.01, 90.0), (5e-5, 0.001, 81.5), (5e-5, 0.001, 300.0), (5e-5, 0.005, 300.0),
        (5e-5, 0.001, 120.0), (5e-5, 0.01, 120.0), (5e-5, 0.001, 160.0), (5e-5, 0.005, 160.0), (1e-4, 0.005, 30.0),
    ];
    for other in others {
        let samples = decaying(&[(1e-4, 0.001, 80.0), other], 10_000, 2e-4);
        let found = lines_of(&samples, None, 0, 1.0);
        let is_refused = match found {
            Err(DecayProblem::Several(modes)) => modes.iter().any(|hz| (hz - other.2).abs() < 1.0),
            Err(DecayProblem::Rises { apart_hz, .. }) => {
                (apart_hz / (other.2 - 80.0) - 1.0).abs() < 0.3
            }
            Err(DecayProblem::Leaves { other_hz, .. }) => (other_hz - other.2).abs() < 2.0,
            _ => false,
        };
        assert!(is_refused, "{other:?}");
    }
}

/// What a joint makes of its own motion: a third harmonic that fades three times as fast, more of it in the acceleration.
#[test]
fn a_harmonic_is_no_second_mode() {
    let modes = [(1e-4, 0.004, 80.0), (2e-6, 0.004, 240.0)];
    let samples = decaying(&modes, 10_000, 2e-4);
    assert!(lines_of(&samples, None, 0, 1.0).is_ok());
    let modes = [(1.0, 0.004, 80.0), (0.2, 0.004, 240.0)];
    let samples = decaying(&modes, 10_000, 2e-4);
    assert!(lines_of(&samples, None, 2, 1.0).is_ok());
    assert!(lines_of(&samples, None, 0, 1.0).is_err());
}

/// A record that begins before the impact, or has a second one.
#[test]
fn a_second_impact_is_told() {
    let mut samples = decaying(&[(1e-4, 0.004, 80.0)], 10_000, 2e-4);
    let first = samples.clone();
    for (own, other) in samples[4000..].iter_mut().zip(&first) {
        own.1 += other.1;
    }
    let found = lines_of(&samples, None, 0, 1.0);
    assert!(
        matches!(found, Err(DecayProblem::Rises { at_s, .. }) if (at_s - 0.8).abs() < 0.1),
        "{found:?}"
    );
}

#[test]
fn what_is_no_decay_is_refused() {
    let samples = decaying(&[(2e-4, 0.004, 81.2)], 20_000, 1e-4);
    let short = lines_of(&samples[..500], None, 0, 1.0);
    assert!(matches!(short, Err(DecayProblem::TooShort(_))), "{short:?}");
    let mut uneven = samples;
    uneven[7].0 += 3e-5;
    assert_eq!(lines_of(&uneven, None, 0, 1.0), Err(DecayProblem::Uneven));
}
