//! How sure an identified factor is: B-6 carried through the least squares of B-5.

use crate::c64;
use crate::material::loss_factor;

/// Error bars of an identified factor, linear in the noise of the measurement.
///
/// x(c) is holomorphic and the noise circular, so the correction's error is circular too and one number is its covariance:
/// $$ \sigma_c^2 = \mathrm E |\delta c|^2 = \Big( \sum_m \frac{|\partial x_m/\partial c|^2}{\sigma_m^2} \Big)^{-1}, \qquad \sigma_m^2 = \mathrm E|\delta u_m|^2, $$
/// real and imaginary part each having σ_c²/2, uncorrelated. E′ = Re p and η = Im p/Re p then have
/// $$ \sigma_{E'}^2 = \frac{\sigma_c^2}{2}, \quad \sigma_\eta^2 = \frac{1 + \eta^2}{E'^2} \frac{\sigma_c^2}{2}, \quad
///    \rho = -\frac{\eta}{\sqrt{1 + \eta^2}}. $$
///
/// # Limits
/// What noise does, nothing else: not an error of the model, nor of the measurement that is the same in every record. Where
/// [`Self::nonlinearity`] is not small the bars are too short or too long.
///
/// # Source
/// P. J. Schreier, L. L. Scharf, *Statistical Signal Processing of Complex-Valued Data*, Cambridge 2010, section 2.2, for circularity;
/// D. M. Bates, D. G. Watts, J. R. Stat. Soc. B 42 (1980) 1–25, for the curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uncertainty {
    /// √E|δc|² of the complex correction; of a real one √E δc².
    pub correction_std: f64,
    /// Standard deviation of E′.
    pub storage_std: f64,
    /// Standard deviation of η; `None` for a real factor, or where E′ is zero.
    pub loss_factor_std: Option<f64>,
    /// Correlation of E′ and η; `None` where there is no standard deviation of η.
    pub correlation: Option<f64>,
    /// What the standard deviation of E′ consists of.
    pub contributions: Contributions,
    /// ½ ‖∂²x/∂c²‖ σ_c / ‖∂x/∂c‖, weighed by the sensors' standard deviations: what is quadratic in the error bar over what is linear.
    pub nonlinearity: f64,
}

/// What the standard deviation of E′ consists of: standard deviations, whose squares add up to its square.
///
/// What known factors and errors of the model contribute is by how much the variance falls when they are held (B-11), first the known factors, then all errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contributions {
    /// Noise of the measurement, with that of unknown scales and delays.
    pub noise: f64,
    /// Errors of the model's natural frequencies, damping, mode shapes and masses, and of the matrix of the unknown itself.
    pub model: f64,
    /// Errors of the factors of known matrices.
    pub known_factors: f64,
}

impl Contributions {
    /// The standard deviation that they add up to.
    pub fn whole(&self) -> f64 {
        self.noise.hypot(self.model).hypot(self.known_factors)
    }

    /// Noise alone.
    pub(crate) fn of_noise(noise: f64) -> Self {
        Self { noise, model: 0.0, known_factors: 0.0 }
    }

    /// A standard deviation in the ratio of some variances.
    pub(crate) fn in_ratio(std: f64, [noise, model, known_factors]: [f64; 3]) -> Self {
        let whole = noise + model + known_factors;
        let part = |variance: f64| std * (variance / whole).max(0.0).sqrt();
        match whole > 0.0 {
            true => Self { noise: part(noise), model: part(model), known_factors: part(known_factors) },
            false => Self::of_noise(std),
        }
    }
}

/// Beyond this share of the quadratic term the linear error bar is not valid. For one sensor the mean of an error is off by √2 times
/// this share in standard deviations of a part: at a quarter by a third of a standard deviation, which leaves 93 of 100 truths within two standard deviations, not 95.
const MAX_NONLINEARITY: f64 = 0.25;

/// A number is known when its standard deviation is below this part of it: it is then three standard deviations away from nothing, and better
/// known than by a glance at a table of materials …
pub(super) const KNOWN_RELATIVE_STD: f64 = 0.3;

/// … also if it is as many standard deviations smaller as the error bar allows: of many numbers that are not known, those that noise has made large would else pass.
const KNOWN_LOWER_END_STD: f64 = 2.0;

/// A vibration test cannot distinguish a loss factor below this from zero: supports, air and cables take more.
pub(super) const MIN_KNOWN_LOSS_FACTOR: f64 = 1e-4;

impl Uncertainty {
    /// From the standard deviation `part_std` of the correction's real part, as much of its imaginary part, and ‖∂²x/∂c²‖ weighed by
    /// the standard deviations of the parts of the measured values, where noise is `level` times what `part_std` and the weights say.
    pub(crate) fn new(factor: c64, real: bool, part_std: f64, second: f64, level: f64) -> Self {
        let part = level * part_std;
        let correction_std = if real { part } else { 2f64.sqrt() * part };
        let eta = loss_factor(factor);
        let loss_factor_std =
            Some((1.0 + eta * eta).sqrt() * part / factor.re.abs()).filter(|std| !real && std.is_finite());
        Self {
            correction_std,
            storage_std: part,
            loss_factor_std,
            correlation: loss_factor_std.map(|_| -eta / (1.0 + eta * eta).sqrt()),
            contributions: Contributions::of_noise(part),
            // ‖∂x/∂c‖ = 1/part_std, in the same weights.
            nonlinearity: 0.5 * second * part_std * correction_std,
        }
    }

    /// Noise is larger by a factor.
    pub(crate) fn lengthen(&mut self, by: f64) {
        self.correction_std *= by;
        self.storage_std *= by;
        let Contributions { noise, model, known_factors } = &mut self.contributions;
        [noise, model, known_factors].into_iter().for_each(|part| *part *= by);
        self.loss_factor_std = self.loss_factor_std.map(|std| by * std);
        self.nonlinearity *= by;
    }

    /// Adds an error of the factor that is independent of the noise: variances of its real and imaginary part, and their covariance. It counts as noise until
    /// [`Self::divide`] says otherwise.
    pub(crate) fn widen(&mut self, factor: c64, [real, imaginary, both]: [f64; 3]) {
        let eta = loss_factor(factor);
        let before = *self;
        self.correction_std = (before.correction_std.powi(2) + real + imaginary).max(0.0).sqrt();
        self.storage_std = (before.storage_std.powi(2) + real).max(0.0).sqrt();
        self.contributions.noise = self.contributions.noise.hypot(real.max(0.0).sqrt());
        if let (Some(std), Some(correlation)) = (before.loss_factor_std, before.correlation) {
            let of_loss = (imaginary - 2.0 * eta * both + eta * eta * real) / factor.re.powi(2);
            let wider = (std * std + of_loss).max(0.0).sqrt();
            let common = correlation * before.storage_std * std + (both - eta * real) / factor.re;
            self.loss_factor_std = Some(wider);
            self.correlation = Some(common / (self.storage_std * wider)).filter(|c| c.is_finite());
        }
    }

    /// Divides the standard deviation of E′ in the ratio of variances by noise, errors of the model, and known factors.
    pub(crate) fn divide(&mut self, variances: [f64; 3]) {
        self.contributions = Contributions::in_ratio(self.storage_std, variances);
    }

    /// Whether the linear error bar is valid.
    pub fn is_linear(&self) -> bool {
        // False for NaN too.
        self.nonlinearity <= MAX_NONLINEARITY
    }

    /// Whether the factor is identifiable from the measurement: its modulus, and its loss factor where it may have one.
    pub fn is_known(&self, factor: c64) -> bool {
        let loss = |std: f64| is_within(loss_factor(factor).abs(), std, MIN_KNOWN_LOSS_FACTOR);
        self.is_modulus_known(factor) && self.loss_factor_std.is_none_or(loss)
    }

    /// Whether its modulus is, whatever is known of its loss factor.
    pub(super) fn is_modulus_known(&self, factor: c64) -> bool {
        is_within(factor.norm(), self.correction_std, 0.0)
    }
}

/// Whether a standard deviation is small enough beside a value, or beside the least that counts.
fn is_within(value: f64, std: f64, least: f64) -> bool {
    std <= KNOWN_RELATIVE_STD * (value - KNOWN_LOWER_END_STD * std).max(least)
}
