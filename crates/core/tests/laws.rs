//! Laws fitted to moduli whose law is known.

use crate::noise;
use crate::tier::of_tier;

use frfit::c64;
use frfit::frequency::omega_rad_s;
use frfit::laws::{Datum, LawFit, LawKind, best, fit_modulus};
use frfit::material::{Branch, Law};
use noise::Noise;

fn frequencies(first: f64, last: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| first * (last / first).powf(k as f64 / (count - 1) as f64)).collect()
}

/// A law of each family, with its frequencies.
fn materials() -> Vec<(LawKind, Law, Vec<f64>)> {
    let maxwell = Law::Maxwell {
        e0: 1e6,
        branches: vec![
            Branch { modulus: 2e6, tau_s: 1e-4 },
            Branch { modulus: 8e6, tau_s: 3e-3 },
            Branch { modulus: 3e6, tau_s: 0.2 },
        ],
    };
    vec![
        (LawKind::Constant, Law::complex_modulus(2e11, 1e-3), frequencies(20.0, 4000.0, 60)),
        // The paper's polybutadiene.
        (
            LawKind::Fractional,
            Law::Fractional { e0: 8.14e5, e1: 7.31e4, alpha: 0.528 },
            frequencies(20.0, 2000.0, 60),
        ),
        // The core of the NLEVP sandwich: its time is far above the band's frequencies.
        (
            LawKind::FractionalZener,
            Law::FractionalZener { e0: 3.504e5, e_infinity: 3.062e9, tau_s: 8.23e-9, alpha: 0.675 },
            frequencies(1.0, 1e9, 80),
        ),
        (LawKind::Maxwell { branches: 3 }, maxwell, frequencies(0.1, 2e4, 80)),
    ]
}

/// The law's moduli, each with its own noise of a share of itself.
fn data(law: &Law, frequency_hz: &[f64], share: f64, noise: &mut Noise) -> Vec<Datum> {
    let datum = |&f: &f64| {
        let exact = law.at(f).unwrap();
        if share == 0.0 {
            return Datum::relative(omega_rad_s(f), exact);
        }
        // Real and imaginary part each.
        let std = share * exact.norm();
        Datum::circular(omega_rad_s(f), exact + std * noise.complex(), std)
    };
    frequency_hz.iter().map(datum).collect()
}

/// Values of a law's parameters in the order of its family's.
fn values(law: &Law) -> Vec<f64> {
    match law {
        Law::Constant(e) => vec![e.re, e.im / e.re],
        Law::Fractional { e0, e1, alpha } => vec![*e0, *e1, *alpha],
        Law::FractionalZener { e0, e_infinity, tau_s, alpha } => vec![*e0, *e_infinity, *tau_s, *alpha],
        Law::Maxwell { e0, branches } => {
            std::iter::once(*e0).chain(branches.iter().flat_map(|b| [b.modulus, b.tau_s])).collect()
        }
        Law::Table(_) => unreachable!(),
    }
}

#[test]
fn exact_data_give_their_law_and_all_starts_that_matter_agree() {
    for (family, law, f) in materials() {
        let fit = fit_modulus(&data(&law, &f, 0.0, &mut Noise::new(1)), family, false).unwrap();
        assert!(
            fit.converged && 2 * fit.agreeing >= fit.starts,
            "{family}: {} of {}",
            fit.agreeing,
            fit.starts
        );
        for (parameter, value) in fit.parameters.iter().zip(values(&law)) {
            // Roundoff of the data (1e-16) times the condition of the worst law, E₀ and α of the fractional one.
            assert!((parameter.value - value).abs() < 1e-9 * value.abs(), "{family}: {parameter:?} {value}");
        }
    }
}

/// (estimate − truth)/std of every parameter, and of E′ and η at three frequencies.
fn pulls(fit: &LawFit, law: &Law, f: &[f64]) -> Vec<f64> {
    let parameters = fit.parameters.iter().zip(values(law));
    let mut pulls: Vec<f64> = parameters.map(|(p, value)| (p.value - value) / p.std.unwrap()).collect();
    for &f in [f[0], f[f.len() / 2], f[f.len() - 1]].iter() {
        let (found, exact) = (fit.at(f).unwrap(), law.at(f).unwrap());
        pulls.push((found.modulus.re - exact.re) / found.storage_std.unwrap());
        pulls.push(
            (frfit::material::loss_factor(found.modulus) - frfit::material::loss_factor(exact))
                / found.loss_factor_std.unwrap(),
        );
    }
    pulls
}

/// Error bars cover: within two standard deviations 95.4 % of all, whether the noise is known or found from the rest.
#[test]
fn error_bars_cover_over_seeds() {
    for (family, law, f) in materials() {
        for sigma_known in [true, false] {
            let mut noise = Noise::new(7);
            let mut all = Vec::new();
            let seeds = of_tier(30, 60);
            for _ in 0..seeds {
                let fit = fit_modulus(&data(&law, &f, 0.01, &mut noise), family, sigma_known).unwrap();
                all.push(pulls(&fit, &law, &f));
            }
            for k in 0..all[0].len() {
                let inside = all.iter().filter(|pulls| pulls[k].abs() < 2.0).count();
                let mean_square = all.iter().map(|pulls| pulls[k] * pulls[k]).sum::<f64>() / seeds as f64;
                // Of 60 draws with 95.4 %, fewer than 51 are inside once in 5000, and of 30 fewer than 24; the mean square is
                // 1 ± 0.18 or 0.26, and four times that once in 15000. Curvature of the law adds a few percent.
                assert!(inside >= of_tier(24, 51), "{family} {sigma_known}: {inside} of {seeds}, number {k}");
                assert!(
                    of_tier(0.2..2.2, 0.4..1.8).contains(&mean_square),
                    "{family} {sigma_known}: {mean_square}, number {k}"
                );
            }
        }
    }
}

#[test]
fn the_least_bic_is_that_of_the_law_that_made_the_data() {
    for (truth, law, f) in materials() {
        for &sigma_known in of_tier(&[true][..], &[true, false]) {
            let (mut noise, mut right) = (Noise::new(3), 0);
            let draws = of_tier(2, 6);
            for _ in 0..draws {
                let data = data(&law, &f, 0.01, &mut noise);
                let fits: Vec<LawFit> = LawKind::ALL
                    .iter()
                    .filter_map(|&family| fit_modulus(&data, family, sigma_known))
                    .collect();
                assert_eq!(fits.len(), LawKind::ALL.len());
                right += usize::from(best(&fits).unwrap().kind == truth);
                let own = fits.iter().find(|fit| fit.kind == truth).unwrap();
                if sigma_known {
                    // χ²/ν of some 115 degrees of freedom is 1 ± 0.13; five times that never happens.
                    assert!((own.reduced_chi_squared().unwrap() - 1.0).abs() < 0.65);
                }
            }
            // A parameter too many gains more than ln 120 = 4.8 by chance in 3 % of all draws: two of six once in 80.
            assert!(right + 1 >= draws, "{truth} {sigma_known}: {right} of {draws}");
        }
    }
}

#[test]
fn what_the_data_do_not_tell_has_no_small_error_bar() {
    // Rubber far below its transition: of Zener's law of E∞ and τ only E∞τ^α is identifiable.
    let law = Law::FractionalZener { e0: 1e6, e_infinity: 1e9, tau_s: 1e-9, alpha: 0.5 };
    let f = frequencies(10.0, 1000.0, 40);
    let fit = fit_modulus(&data(&law, &f, 0.01, &mut Noise::new(5)), LawKind::FractionalZener, true).unwrap();
    for name in ["e_infinity", "tau"] {
        let parameter = fit.parameters.iter().find(|p| p.name == name).unwrap();
        assert!(parameter.std.is_none_or(|std| std > parameter.value), "{parameter:?}");
    }
    // The modulus over the band is known nevertheless.
    let middle = fit.at(100.0).unwrap();
    assert!(middle.storage_std.is_none_or(|std| std < 0.01 * middle.modulus.re), "{middle:?}");
    let exact = law.at(100.0).unwrap();
    assert!((middle.modulus - exact).norm() < 0.02 * exact.norm(), "{middle:?} {exact}");
}

#[test]
fn too_few_data_are_no_fit() {
    let one = [Datum::relative(1.0, c64::new(1e6, 1e5))];
    let constant = fit_modulus(&one, LawKind::Constant, false).unwrap();
    assert_eq!((constant.degrees_of_freedom(), constant.reduced_chi_squared()), (0, None));
    assert!(fit_modulus(&one, LawKind::Fractional, false).is_none());
    assert!(fit_modulus(&[], LawKind::Constant, false).is_none());
}

#[test]
fn a_negative_loss_factor_is_told_and_not_forced_away() {
    let conjugate = Law::complex_modulus(1e6, -0.1);
    let f = frequencies(10.0, 100.0, 10);
    let fit = fit_modulus(&data(&conjugate, &f, 0.01, &mut Noise::new(2)), LawKind::Constant, true).unwrap();
    let eta = &fit.parameters[1];
    assert!((eta.value + 0.1).abs() < 4.0 * eta.std.unwrap());
}
