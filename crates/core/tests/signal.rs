//! Hammer tests with known answers: impacts of a half-sine on a structure whose impulse response is known sample by sample.

use crate::noise::Noise as Draws;
use frfit::c64;
use frfit::signal::{
    Channel, Estimator, Fault, Measured, Options, Recording, SignalError, Windows, added_loss_factor,
    estimate_frf, relative_variance, variances,
};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const STEP_S: f64 = 1e-3;
const SAMPLES: usize = 1000;

/// Of the response 1e-8 is left at the end of a record, and H is at its smallest a thousandth of its largest.
const LEFT: f64 = 1e-5;

/// Impulse response of a causal filter with two decaying modes: after 900 samples 1e-8 of it is left.
fn impulse_response(k: usize) -> f64 {
    let t = k as f64;
    (-t / 48.0).exp() * (0.9 * t).sin() + 0.5 * (-t / 45.0).exp() * (0.31 * t + 0.4).sin()
}

/// Its transfer function at z = e^{(iω + β)Δ}.
fn transfer(frequency_hz: f64, decay_per_s: f64) -> c64 {
    let z = (-c64::new(decay_per_s, TAU * frequency_hz) * STEP_S).exp();
    let (mut power, mut sum) = (c64::new(1.0, 0.0), c64::new(0.0, 0.0));
    for k in 0..SAMPLES {
        sum += impulse_response(k) * power;
        power *= z;
    }
    sum
}

/// A contact of six samples from sample 100 on. Its spectrum has no zero on a line, as that of a pulse of a whole number of
/// samples has.
fn half_sine(peak: f64) -> Vec<f64> {
    let inside = 100..106;
    let value =
        |k: usize| if inside.contains(&k) { peak * (PI * (k as f64 - 99.63) / 5.77).sin() } else { 0.0 };
    (0..SAMPLES).map(value).collect()
}

fn response(force: &[f64]) -> Vec<f64> {
    let mut response = vec![0.0; force.len()];
    for (k, f) in force.iter().enumerate().filter(|(_, f)| **f != 0.0) {
        for (x, j) in response[k..].iter_mut().zip(0..) {
            *x += f * impulse_response(j);
        }
    }
    response
}

fn impact(peak: f64) -> Recording {
    let force = half_sine(peak);
    Recording { step_s: STEP_S, responses: vec![response(&force)], force }
}

/// Numbers between −1 and 1 that look like noise, the same each time.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        // Splitmix64: S. Vigna, public domain.
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn add_to(&mut self, samples: &mut [f64], size: f64) {
        samples.iter_mut().for_each(|x| *x += size * self.next());
    }
}

fn largest_error(measured: &Measured, decay_per_s: f64) -> f64 {
    let error = |(&f, h): (&f64, &c64)| {
        let truth = transfer(f, decay_per_s);
        (h - truth).norm() / truth.norm()
    };
    measured.frequency_hz.iter().zip(&measured.frfs[0].response).map(error).fold(0.0, f64::max)
}

#[test]
fn every_estimator_finds_the_transfer_function_of_clean_records() {
    for estimator in Estimator::ALL {
        let options = Options::default().with_estimator(estimator);
        let measured = estimate_frf(&[impact(100.0), impact(80.0)], &options).unwrap();
        assert_eq!((measured.samples, measured.averages()), (SAMPLES, 2));
        // 1 Hz apart, without 0 Hz and the Nyquist frequency.
        assert_eq!((measured.frequency_hz[0], measured.frequency_hz.len()), (1.0, 499));
        assert!(largest_error(&measured, 0.0) < LEFT, "{estimator}: {:e}", largest_error(&measured, 0.0));
        let frf = &measured.frfs[0];
        assert!(frf.coherence.as_ref().unwrap().iter().all(|c| (1.0 - c).abs() < 1e-12));
        assert!(measured.impacts.iter().all(|impact| impact.undecayed(0).is_none() && impact.onset == 100));
    }
}

#[test]
fn one_hit_has_no_coherence() {
    let measured = estimate_frf(&[impact(100.0)], &Options::default()).unwrap();
    assert_eq!((&measured.frfs[0].coherence, &measured.frfs[0].variance), (&None, &None));
}

#[test]
fn the_exponential_window_shifts_the_line_on_which_the_frf_is_taken() {
    let tau_s = 0.1;
    let windows = Windows::default().with_exponential_s(Some(tau_s));
    let options = Options::default().with_windows(windows);
    let measured = estimate_frf(&[impact(100.0)], &options).unwrap();
    assert_eq!(measured.added_decay_per_s, Some(10.0));
    // Exact, as the response has decayed: see the clean records.
    assert!(largest_error(&measured, 10.0) < LEFT);
    assert!(largest_error(&measured, 0.0) > 0.1);
    // Twice the damping ratio β/ω.
    assert!((added_loss_factor(10.0, 50.0) - 2.0 * 10.0 / (TAU * 50.0)).abs() < 1e-15);
}

#[test]
fn the_force_window_silences_what_comes_after_the_contact() {
    let mut noisy = impact(100.0);
    Noise(1).add_to(&mut noisy.force[120..], 2.0);
    // The noise would be taken for further contacts: the window is for what is below that.
    let windows = Windows::default().with_force_s(Some(0.008));
    let error = |windows| {
        let options = Options::default().with_windows(windows);
        largest_error(&estimate_frf(std::slice::from_ref(&noisy), &options).unwrap(), 0.0)
    };
    assert!(error(windows) < LEFT, "{:e}", error(windows));
    assert!(error(Windows::default()) > 1e-2);
}

/// 400 impacts in fours, noise in the response alone: B-6 gives the standard deviation of H₁.
#[test]
fn the_variance_is_that_of_either_part() {
    let mut noise = Noise(7);
    // 64 averages: the bias of the coherence, 1/n, is 1.6 %.
    let (groups, averages) = (25, 64);
    let (mut ratio, mut lines) = (0.0, 0.0);
    let mut bias = c64::new(0.0, 0.0);
    for _ in 0..groups {
        let impacts: Vec<Recording> = (0..averages)
            .map(|_| {
                let mut impact = impact(100.0);
                noise.add_to(&mut impact.responses[0], 3.0);
                impact
            })
            .collect();
        let measured = estimate_frf(&impacts, &Options::default()).unwrap();
        assert_eq!(measured.averages(), averages);
        let frf = &measured.frfs[0];
        for (k, &f) in measured.frequency_hz.iter().enumerate().filter(|(_, f)| **f < 100.0) {
            let off = frf.response[k] - transfer(f, 0.0);
            let variance = frf.variance.as_ref().unwrap()[k];
            ratio += off.norm_sqr() / (2.0 * variance);
            bias += off / variance.sqrt();
            lines += 1.0;
        }
    }
    // The mean of 2475 exponentially distributed numbers: standard deviation 2 %, beside the bias.
    assert!((ratio / lines - 1.0).abs() < 0.08, "{}", ratio / lines);
    // Of as many circular ones, of standard deviation 1 in either part: 0.03.
    assert!((bias / lines).norm() < 0.1, "{}", bias / lines);
}

/// A response with sharp resonances, and one line with hum: the error of the mean of some averages, that mean, and its coherence.
fn averaged(
    averages: usize,
    [same, proportional]: [f64; 2],
    lines: usize,
    seed: u64,
) -> (Vec<c64>, Vec<c64>, Vec<f64>) {
    const HUM: usize = 100;
    let mut draws = Draws::new(seed);
    let mut normal = || draws.complex() / 2f64.sqrt();
    let truth = |k: usize| {
        let f = k as f64 / 80.0;
        (0..lines / 80)
            .map(|mode| {
                let own = 0.5 + mode as f64;
                1.0 / (own * own * c64::new(1.0, 0.01) - f * f)
            })
            .sum::<c64>()
    };
    let (mut off, mut response, mut coherence) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..lines {
        let exact = truth(k);
        let std = (same + proportional * exact.norm_sqr()).sqrt() * if k == HUM { 20.0 } else { 1.0 };
        let all: Vec<c64> = (0..averages).map(|_| exact + std * normal()).collect();
        let mean = all.iter().sum::<c64>() / averages as f64;
        let square = all.iter().map(|one| one.norm_sqr()).sum::<f64>() / averages as f64;
        off.push(mean - exact);
        response.push(mean);
        coherence.push(mean.norm_sqr() / square);
    }
    (off, response, coherence)
}

/// The square of the true error over the variance has a mean of one, whatever the noise and however few the averages; with the variance of each line by itself it is far larger.
#[test]
fn few_averages_have_a_variance_that_is_right_on_average() {
    let lines = 1600;
    for noise in [[1e-2, 0.0], [0.0, 1e-4], [1e-3, 1e-5]] {
        for averages in [2, 3, 5, 10, 40] {
            let (off, response, coherence) = averaged(averages, noise, lines, 3);
            let found = variances(&response, &coherence, averages);
            let ratio = |variances: &[f64]| {
                let each = off.iter().zip(variances).map(|(off, variance)| off.norm_sqr() / (2.0 * variance));
                each.sum::<f64>() / lines as f64
            };
            // 1600 exponentially distributed numbers: 2.5 %; near resonances noise of n averages takes part in |H|.
            assert!((ratio(&found) - 1.0).abs() < 0.1, "{noise:?} {averages}: {}", ratio(&found));
            let own = |(h, c): (&c64, &f64)| relative_variance(*h, *c) / (averages as f64 - 1.0);
            let own: Vec<f64> = response.iter().zip(&coherence).map(own).collect();
            assert!(averages > 3 || ratio(&own) > 1.5, "{noise:?} {averages}: {}", ratio(&own));
        }
    }
}

#[test]
fn h1_is_too_small_where_the_force_is_noisy_and_h2_too_large_where_the_response_is() {
    let mut noise = Noise(3);
    let impacts = |of_force: f64, of_response: f64, noise: &mut Noise| -> Vec<Recording> {
        (0..60)
            .map(|_| {
                let mut impact = impact(100.0);
                noise.add_to(&mut impact.force, of_force);
                noise.add_to(&mut impact.responses[0], of_response);
                impact
            })
            .collect()
    };
    // The mean of |H| over its truth at low frequencies.
    let gain = |impacts: &[Recording], estimator| {
        let options = Options::default().with_estimator(estimator);
        let measured = estimate_frf(impacts, &options).unwrap();
        let pairs = measured.frequency_hz.iter().zip(&measured.frfs[0].response).take(100);
        pairs.map(|(&f, h)| h.norm() / transfer(f, 0.0).norm()).sum::<f64>() / 100.0
    };
    let force = impacts(2.0, 0.0, &mut noise);
    assert!(gain(&force, Estimator::H1) < 0.99 && (gain(&force, Estimator::H2) - 1.0).abs() < 0.01);
    let response = impacts(0.0, 10.0, &mut noise);
    assert!(gain(&response, Estimator::H2) > 1.01 && (gain(&response, Estimator::H1) - 1.0).abs() < 0.01);
    let between = gain(&response, Estimator::Hv);
    assert!(between > gain(&response, Estimator::H1) && between < gain(&response, Estimator::H2));
}

/// Impacts one after the other in one recording, with silence behind the last.
fn in_one(peaks_and_lengths: &[(f64, usize)]) -> Recording {
    let mut force: Vec<f64> = Vec::new();
    for &(peak, length) in peaks_and_lengths {
        let mut part = half_sine(peak);
        part.resize(length, 0.0);
        force.extend(part);
    }
    Recording { step_s: STEP_S, responses: vec![response(&force)], force }
}

#[test]
fn hits_of_a_long_recording_are_cut_out() {
    let recording = in_one(&[(100.0, 1200), (70.0, 1100), (120.0, 900), (90.0, 1300)]);
    let measured = estimate_frf(std::slice::from_ref(&recording), &Options::default()).unwrap();
    let onsets: Vec<usize> = measured.impacts.iter().map(|impact| impact.onset).collect();
    assert_eq!((onsets, measured.averages()), (vec![100, 1300, 2400, 3300], 3));
    // The third is followed too soon; the others have room for about as many samples.
    assert_eq!(measured.samples, 1100);
    assert_eq!(measured.impacts[2].faults, [Fault::Incomplete { samples: 900, of: 1100 }]);
    assert!(largest_error(&measured, 0.0) < LEFT);
    let options = Options::default().with_length_s(Some(0.9)).with_pre_trigger_s(Some(0.02));
    let measured = estimate_frf(&[recording], &options).unwrap();
    assert_eq!((measured.samples, measured.averages()), (900, 4));
    assert_eq!(measured.impacts[1].range, 1280..2180);
    assert!(largest_error(&measured, 0.0) < LEFT);
}

#[test]
fn a_rebound_in_a_long_recording_is_no_hit_of_its_own() {
    let mut recording = in_one(&[(100.0, 1200), (100.0, 1200), (100.0, 1200)]);
    for (k, x) in half_sine(30.0)[100..106].iter().enumerate() {
        recording.force[1340 + k] = *x;
    }
    recording.responses = vec![response(&recording.force)];
    let measured = estimate_frf(&[recording], &Options::default()).unwrap();
    assert_eq!((measured.impacts.len(), measured.averages()), (3, 2));
    let [Fault::DoubleImpact { after_s, share }] = measured.impacts[1].faults[..] else {
        panic!("{:?}", measured.impacts[1])
    };
    assert!((after_s - 0.04).abs() < 1e-12 && (share - 0.3).abs() < 1e-9);
}

/// The faults of one bad impact among two good ones.
fn faults_of(bad: Recording) -> Vec<Fault> {
    let measured = estimate_frf(&[impact(100.0), bad, impact(90.0)], &Options::default()).unwrap();
    assert_eq!(measured.averages(), 2);
    assert!(largest_error(&measured, 0.0) < LEFT, "the bad impact is left out");
    measured.impacts[1].faults.clone()
}

#[test]
fn bad_hits_are_left_out_and_their_faults_named() {
    let changed = |change: &dyn Fn(&mut Recording)| {
        let mut bad = impact(100.0);
        change(&mut bad);
        faults_of(bad)
    };
    let second = Channel::Response(0);
    assert_eq!(changed(&|bad| bad.force.clear()), [Fault::Missing { channel: Channel::Force }]);
    assert_eq!(changed(&|bad| bad.force.fill(0.3)), [Fault::Missing { channel: Channel::Force }]);
    assert_eq!(changed(&|bad| bad.responses[0].clear()), [Fault::Missing { channel: second }]);
    assert_eq!(changed(&|bad| bad.responses[0].fill(-1.0)), [Fault::Missing { channel: second }]);
    let silent = changed(&|bad| {
        bad.force.fill(0.0);
        Noise(5).add_to(&mut bad.force, 1.0);
    });
    assert_eq!(silent, [Fault::Silent]);
    let cut = changed(&|bad| {
        bad.force.truncate(700);
        bad.responses[0].truncate(700);
    });
    assert_eq!(cut, [Fault::Incomplete { samples: 700, of: 1000 }]);
    let clipped = changed(&|bad| bad.responses[0].iter_mut().for_each(|x| *x = x.clamp(-150.0, 150.0)));
    assert!(
        matches!(clipped[..], [Fault::Clipped { channel, level: 150.0 | -150.0, .. }] if channel == second),
        "{clipped:?}"
    );
    let spike = changed(&|bad| bad.responses[0][500] += 3000.0);
    assert!(
        matches!(spike[..], [Fault::Spike { channel, samples: 1, .. }] if channel == second),
        "{spike:?}"
    );
    let spike = changed(&|bad| bad.force[102..104].fill(2000.0));
    assert_eq!(spike, [Fault::Spike { channel: Channel::Force, samples: 2, height: 2000.0 }]);
    let spike = changed(&|bad| bad.force[600] = 40.0);
    assert_eq!(spike, [Fault::Spike { channel: Channel::Force, samples: 1, height: 40.0 }]);
    let drift =
        changed(&|bad| bad.responses[0].iter_mut().zip(0..).for_each(|(x, k)| *x += 0.1 * f64::from(k)));
    assert!(matches!(drift[..], [Fault::Drift { channel, .. }] if channel == second), "{drift:?}");
    let double = changed(&|bad| {
        (0..6).for_each(|k| bad.force[150 + k] = 0.2 * bad.force[100 + k]);
        bad.responses[0] = response(&bad.force);
    });
    assert!(matches!(double[..], [Fault::DoubleImpact { .. }]), "{double:?}");
    // What is said of it names the channel.
    assert_eq!(silent[0].to_string(), "force shows no impact, only noise");
    assert_eq!(double[0].to_string(), "double impact, 20.0 % again after 50.00 ms");
}

#[test]
fn a_bad_hit_can_be_kept_and_none_is_an_answer_of_its_own() {
    let mut bad = impact(100.0);
    bad.force[102..104].fill(2000.0);
    let Err(SignalError::NoImpact(impacts)) = estimate_frf(std::slice::from_ref(&bad), &Options::default())
    else {
        panic!("a spike is no impact")
    };
    assert_eq!(impacts.len(), 1);
    let keep = |keep: Vec<usize>| Options::default().with_keep(keep);
    let kept = estimate_frf(&[bad.clone(), impact(1.0)], &keep(vec![1])).unwrap();
    assert!(kept.averages() == 2 && kept.impacts[0].kept_anyway && kept.impacts[0].faults.len() == 1);
    assert_eq!(estimate_frf(&[bad], &keep(vec![2])), Err(SignalError::NoSuchImpact(2, 1)));
    assert_eq!(estimate_frf(&[], &Options::default()), Err(SignalError::NoImpact(Vec::new())));
}

#[test]
fn a_response_that_has_not_decayed_is_told() {
    let mut short = impact(100.0);
    short.force.truncate(250);
    short.responses[0].truncate(250);
    let measured = estimate_frf(&[short], &Options::default()).unwrap();
    assert!(measured.impacts[0].undecayed(0).unwrap() > 0.01);
    assert!(largest_error(&measured, 0.0) > 1e-3);
}

#[test]
fn recordings_that_do_not_fit_together_and_options_that_cannot_be_are_refused() {
    let refused = |change: &dyn Fn(&mut Recording)| {
        let mut other = impact(100.0);
        change(&mut other);
        estimate_frf(&[impact(100.0), other], &Options::default()).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&|r| r.step_s = 2e-3),
        "recording 2: expected the sampling interval of the first recording, found 0.002 s"
    );
    assert_eq!(refused(&|r| r.step_s = f64::NAN).split(',').count(), 2);
    assert_eq!(
        refused(&|r| r.responses.clear()),
        "recording 2: expected as many sensors as the first recording has, found 0"
    );
    assert_eq!(
        refused(&|r| r.responses[0][3] = f64::INFINITY),
        "recording 2: expected finite samples, found others in channel response 1"
    );
    let options = Options::default().with_length_s(Some(-1.0));
    let error = estimate_frf(&[impact(1.0)], &options).unwrap_err();
    assert_eq!(error.to_string(), "length: expected a positive number, found -1");
}

proptest! {
    // Each takes 500 sums of 1000 terms.
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Offsets, the sensor's polarity and the size of the impact change nothing in the FRF but its sign.
    #[test]
    fn the_frf_does_not_depend_on_offsets_polarity_and_size(
        size in 1e-3..1e6_f64, scale in prop_oneof![Just(1.0), Just(-1.0)], offset in -0.02..0.02_f64, start in 0..80_usize,
    ) {
        let mut changed = impact(100.0);
        changed.force.iter_mut().for_each(|f| *f = scale * size * (*f / 100.0 + offset));
        changed.responses[0].iter_mut().for_each(|x| *x = size * (*x / 100.0 - offset));
        // The record begins later: the same impact nearer to its beginning.
        changed.force.drain(..start);
        changed.responses[0].drain(..start);
        let measured = estimate_frf(&[changed], &Options::default().with_drift(1.0)).unwrap();
        for (&f, h) in measured.frequency_hz.iter().zip(&measured.frfs[0].response) {
            let truth = transfer(f, 0.0);
            // Roundoff of the offset, and 1e-8 of the response left at the end.
            prop_assert!((scale * h - truth).norm() < 1e-5 * truth.norm(), "{f} Hz");
        }
    }

    /// Whatever is recorded, the answer is finite or a reason is given.
    #[test]
    fn no_record_leads_to_numbers_that_are_none(
        force in proptest::collection::vec(-1e3..1e3_f64, 0..60),
        response in proptest::collection::vec(-1e3..1e3_f64, 0..60),
        count in 1..4_usize, length in proptest::option::of(1e-3..0.1_f64), before in proptest::option::of(0.0..0.1_f64),
    ) {
        let recording = Recording { step_s: STEP_S, force, responses: vec![response] };
        let options = Options::default().with_length_s(length).with_pre_trigger_s(before).with_keep(vec![1]);
        if let Ok(measured) = estimate_frf(&vec![recording; count], &options) {
            let frf = &measured.frfs[0];
            prop_assert!(frf.response.iter().all(|h| h.is_finite()));
            prop_assert!(frf.coherence.iter().flatten().all(|c| (0.0..=1.0).contains(c)));
            prop_assert!(measured.impacts.iter().all(|impact| impact.residual.iter().all(|r| r.is_finite())));
        }
    }
}
