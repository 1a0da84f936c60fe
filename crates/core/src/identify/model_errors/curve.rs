//! Unknowns over the band with few numbers: constants, laws, smooth curves.

use super::causality::Causality;
use super::natural_spline::bends;
use crate::c64;
use crate::identify::channel_coordinates::ChannelCoordinates;
use crate::identify::form::Form;
use crate::laws::LawKind;
use std::f64::consts::TAU;
use std::ops::Range;

/// p(ω; θ) of one unknown.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) enum Curve {
    /// A constant or a law.
    Form(Form),
    /// ln p as a natural cubic spline over ln ω.
    Spline(Spline),
}

/// All unknowns, θ one after the other, then scales and delays of channels.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct Curves {
    each: Vec<(Curve, Range<usize>)>,
    channels: ChannelCoordinates,
    /// [low, high] of coordinates that have bounds.
    limits: Vec<(usize, [f64; 2])>,
}

/// A natural cubic spline of ln E over ln ω by its values at knots: θ is ln|E| at the knots, then the phase at the knots unless E is real.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::identify) struct Spline {
    /// What each knot has at each line, `[line][knot]`.
    weights: Vec<Vec<f64>>,
    /// Distance of the knots in ln ω.
    step: f64,
    /// What ties the phase to ln|E|, unless E is real.
    causality: Option<Causality>,
}

/// Knots at most this far apart, in ln ω, and so many at least.
const MAX_KNOT_DISTANCE: f64 = 0.5;
const MIN_KNOTS: usize = 8;

/// Second differences of ln|E| and of the phase over knots that are `MAX_KNOT_DISTANCE` apart: a viscoelastic transition
/// changes its slope by that over half an octave.
const BEND_PRIOR_STD: [f64; 2] = [0.3, 0.15];

/// What is known of ln|E| and of the phase before anything is measured.
const LN_MODULUS_PRIOR_STD: [f64; 2] = [3.0, 1.0];

/// d ln|E|/d ln ω over arg E.
const BODE_SLOPE_OVER_PHASE: f64 = std::f64::consts::FRAC_2_PI;

/// A bound that is overstepped by so little is kept: roundoff.
const BOUND_RTOL: f64 = 1e-12;

/// What is known of the coordinates of constants, laws and channels, logarithms and logits, before anything is measured.
const FORM_PRIOR_STD: f64 = 10.0;

impl Spline {
    pub(in crate::identify) fn new(omegas: &[f64], real: bool) -> Self {
        let x: Vec<f64> = {
            let least = omegas.iter().copied().find(|&omega| omega > 0.0).unwrap_or(1.0);
            omegas.iter().map(|omega| omega.max(least).ln()).collect()
        };
        let (first, last) = (x[0], x[x.len() - 1].max(x[0] + 1e-6));
        let knots = (1 + ((last - first) / MAX_KNOT_DISTANCE).ceil() as usize).max(MIN_KNOTS);
        let step = (last - first) / (knots - 1) as f64;
        let bends = (0..knots).map(|k| bends(knots, k)).collect::<Vec<_>>();
        let at = |x: &f64| {
            let u = ((x - first) / step).clamp(0.0, (knots - 1) as f64);
            let j = (u as usize).min(knots - 2);
            let (b, a) = (u - j as f64, 1.0 - (u - j as f64));
            let value = |k: usize| {
                let on = |i: usize| if i == k { 1.0 } else { 0.0 };
                let bend = |i: usize| bends[k][i];
                a * on(j) + b * on(j + 1) + ((a * a * a - a) * bend(j) + (b * b * b - b) * bend(j + 1)) / 6.0
            };
            (0..knots).map(value).collect()
        };
        Self {
            weights: x.iter().map(at).collect(),
            step,
            causality: (!real).then(|| Causality::new(step, &bends)),
        }
    }

    fn knots(&self) -> usize {
        self.weights[0].len()
    }

    fn is_real(&self) -> bool {
        self.causality.is_none()
    }

    /// ln E at a line.
    fn log(&self, theta: &[f64], line: usize) -> c64 {
        let sum = |part: &[f64]| self.weights[line].iter().zip(part).map(|(w, t)| w * t).sum::<f64>();
        let n = self.knots();
        c64::new(sum(&theta[..n]), if self.is_real() { 0.0 } else { sum(&theta[n..]) })
    }
}

impl Curve {
    /// How many numbers.
    fn count(&self) -> usize {
        match self {
            Self::Form(form) => form.count(),
            Self::Spline(spline) => spline.knots() * if spline.is_real() { 1 } else { 2 },
        }
    }

    /// p at a line, and ∂p/∂θ; `None` where a number is not finite.
    fn value(&self, theta: &[f64], line: usize, omega: f64) -> Option<(c64, Vec<c64>)> {
        match self {
            Self::Form(form) => form.value(theta, omega),
            Self::Spline(spline) => {
                let value = spline.log(theta, line).exp();
                let of = |unit: c64| spline.weights[line].iter().map(move |&w| value * unit * w);
                let mut slopes: Vec<c64> = of(c64::new(1.0, 0.0)).collect();
                if !spline.is_real() {
                    slopes.extend(of(c64::I));
                }
                value.is_finite().then_some((value, slopes))
            }
        }
    }

    /// The precision of what is known beforehand, n × n, about a centre: of a smooth curve its size, its slope and, `bend` times what is usual, its bends.
    ///
    /// A causal modulus has the phase of its slope; where the loss is small so is the slope.
    fn precision(&self, centre: &[f64], bend: [f64; 2]) -> Vec<f64> {
        let mut precision = self.smoothness(bend);
        let Self::Spline(spline) = self else { return precision };
        let phase = || centre[spline.knots()];
        if let Some(own) = spline.causality.as_ref().and_then(|causality| causality.precision(phase())) {
            precision.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        }
        precision
    }

    /// The same of a modulus that need not be causal.
    fn smoothness(&self, bend: [f64; 2]) -> Vec<f64> {
        let n = self.count();
        let mut precision = vec![0.0; n * n];
        let Self::Spline(spline) = self else {
            (0..n).for_each(|i| precision[i * n + i] = FORM_PRIOR_STD.powi(-2));
            return precision;
        };
        let knots = spline.knots();
        for (part, bend) in bend.into_iter().enumerate().take(n / knots) {
            let first = part * knots;
            (first..first + knots)
                .for_each(|i| precision[i * n + i] += LN_MODULUS_PRIOR_STD[part].powi(-2) / knots as f64);
            precision.iter_mut().zip(self.bends(part)).for_each(|(sum, own)| *sum += own / (bend * bend));
        }
        precision
    }

    /// The precision of the bends of a part alone, n × n: an integrated Wiener process, whose second differences grow with the 3/2 power of the distance.
    fn bends(&self, part: usize) -> Vec<f64> {
        let n = self.count();
        let mut precision = vec![0.0; n * n];
        let Self::Spline(spline) = self else { return precision };
        let knots = spline.knots();
        let first = part * knots;
        if first >= n {
            return precision;
        }
        let scale = (spline.step / MAX_KNOT_DISTANCE).powf(1.5);
        for k in first + 1..first + knots - 1 {
            let bend = [(k - 1, 1.0), (k, -2.0), (k + 1, 1.0)];
            for (i, a) in bend {
                for (j, b) in bend {
                    precision[i * n + j] += a * b / (scale * BEND_PRIOR_STD[part]).powi(2);
                }
            }
        }
        precision
    }

    /// How many second differences a part has.
    fn bend_count(&self, part: usize) -> usize {
        match self {
            Self::Spline(spline) if part == 0 || !spline.is_real() => spline.knots() - 2,
            _ => 0,
        }
    }

    /// A straight line in ln ω through the middle of a curve, with the slope of its mean phase; constants and laws as they are.
    fn straight(&self, theta: &[f64]) -> Vec<f64> {
        let Self::Spline(spline) = self else { return theta.to_vec() };
        let knots = spline.knots();
        let mean = |part: &[f64]| part.iter().sum::<f64>() / knots as f64;
        let size = mean(&theta[..knots]);
        let phase = if spline.is_real() { 0.0 } else { mean(&theta[knots..]) };
        let at = |k: usize| {
            size + BODE_SLOPE_OVER_PHASE * phase * spline.step * (k as f64 - 0.5 * (knots - 1) as f64)
        };
        (0..knots).map(at).chain(theta[knots..].iter().map(|_| phase)).collect()
    }

    /// θ nearest to moduli with weights (inverse variances of ln E) at some lines; of a spline.
    fn through(&self, data: &[(usize, c64, f64)]) -> Option<Vec<f64>> {
        let Self::Spline(spline) = self else { return None };
        let n = self.count();
        let knots = spline.knots();
        let mut normal = [0, 1].map(|part| self.bends(part)).into_iter().reduce(|mut sum, other| {
            sum.iter_mut().zip(other).for_each(|(a, b)| *a += b);
            sum
        })?;
        let mut right = vec![0.0; n];
        // The prior is about the mean of the data, not about one.
        let total: f64 = data.iter().map(|(_, _, weight)| weight).sum();
        let mean: c64 = data.iter().map(|(_, modulus, weight)| modulus.ln() * *weight).sum::<c64>() / total;
        for &(line, modulus, weight) in data {
            let rest = modulus.ln() - mean;
            for (part, value) in [rest.re, rest.im].into_iter().enumerate().take(n / knots) {
                for (i, a) in spline.weights[line].iter().enumerate() {
                    right[part * knots + i] += weight * a * value;
                    for (j, b) in spline.weights[line].iter().enumerate() {
                        normal[(part * knots + i) * n + part * knots + j] += weight * a * b;
                    }
                }
            }
        }
        frfit_linalg::dense::Cholesky::new(n, &normal).ok()?.solve(&mut right);
        for (k, theta) in right.iter_mut().enumerate() {
            *theta += if k < knots { mean.re } else { mean.im };
        }
        right.iter().all(|theta| theta.is_finite()).then_some(right)
    }
}

/// Values of all unknowns at a line, and (unknown, ∂p/∂θ) for each coordinate of θ.
pub(super) type Values = (Vec<c64>, Vec<(usize, c64)>);

impl Curves {
    pub(in crate::identify) fn new(each: Vec<Curve>) -> Self {
        let mut first = 0;
        let place = |curve: Curve| {
            let range = first..first + curve.count();
            first = range.end;
            (curve, range)
        };
        Self {
            each: each.into_iter().map(place).collect(),
            channels: ChannelCoordinates::default(),
            limits: Vec::new(),
        }
    }

    /// With bounds of the coordinates of an unknown.
    pub(in crate::identify) fn within(mut self, unknown: usize, limits: &[[f64; 2]]) -> Self {
        self.limits.extend(self.range(unknown).zip(limits.iter().copied()));
        self
    }

    /// The coordinates that a step would move beyond a bound, and the step that ends there.
    pub(super) fn stopped(&self, theta: &[f64], step: &[f64]) -> Vec<(usize, f64)> {
        let stopped = |&(i, [low, high]): &(usize, [f64; 2])| {
            let there = theta[i] + step[i];
            let least = BOUND_RTOL * (1.0 + theta[i].abs());
            (there < low - least || there > high + least).then(|| (i, there.clamp(low, high) - theta[i]))
        };
        self.limits.iter().filter_map(stopped).collect()
    }

    /// Moves θ into its bounds.
    pub(super) fn keep_within_bounds(&self, theta: &mut [f64]) {
        self.limits.iter().for_each(|&(i, [low, high])| theta[i] = theta[i].clamp(low, high));
    }

    /// With scales and delays of channels.
    pub(in crate::identify) fn with_channels(self, channels: ChannelCoordinates) -> Self {
        let channels = channels.after(self.of_unknowns());
        Self { channels, ..self }
    }

    /// How many numbers.
    pub(in crate::identify) fn count(&self) -> usize {
        self.of_unknowns() + self.channels.count()
    }

    /// How many of them are those of the unknowns.
    pub(in crate::identify) fn of_unknowns(&self) -> usize {
        self.each.last().map_or(0, |(_, range)| range.end)
    }

    /// Scales and delays of channels.
    pub(in crate::identify) fn channels(&self) -> &ChannelCoordinates {
        &self.channels
    }

    /// The coordinates of an unknown.
    pub(in crate::identify) fn range(&self, unknown: usize) -> Range<usize> {
        self.each[unknown].1.clone()
    }

    /// The unknowns that are smooth curves: a frequency may have a value of its own of them.
    pub(super) fn smooth(&self) -> Vec<usize> {
        (0..self.each.len()).filter(|&j| matches!(self.each[j].0, Curve::Spline(_))).collect()
    }

    /// Whether an unknown is the same at all frequencies.
    pub(super) fn is_constant(&self, unknown: usize) -> bool {
        match &self.each[unknown].0 {
            Curve::Form(form) => form.kind().is_none_or(|kind| kind == LawKind::Constant),
            Curve::Spline(_) => false,
        }
    }

    /// Whether a smooth curve stands beside other unknowns.
    pub(super) fn is_beside_others(&self) -> bool {
        self.each.len() > 1 && !self.smooth().is_empty()
    }

    /// Multiplies an unknown by exp(by).
    pub(super) fn scale(&self, theta: &mut [f64], unknown: usize, by: f64) {
        let (curve, range) = &self.each[unknown];
        let own = &mut theta[range.clone()];
        match curve {
            Curve::Spline(spline) => own.iter_mut().take(spline.knots()).for_each(|log| *log += by),
            Curve::Form(form) => own.copy_from_slice(&form.scaled(own, by)),
        }
    }

    /// Gives a smooth unknown or a constant the same loss factor all over the band.
    pub(super) fn set_loss_factor(&self, theta: &mut [f64], unknown: usize, loss_factor: f64) {
        match &self.each[unknown] {
            (Curve::Form(form), range) => {
                if let Some(own) = form.of_loss_factor() {
                    theta[range.start + own] = loss_factor;
                }
            }
            (Curve::Spline(_), _) => self.set_phase(theta, unknown, loss_factor.atan()),
        }
    }

    /// Gives a smooth unknown the same phase all over the band.
    pub(super) fn set_phase(&self, theta: &mut [f64], unknown: usize, phase: f64) {
        if let Some(phases) = self.phases(unknown) {
            theta[phases].fill(phase);
        }
    }

    /// The coordinates of the phase of a smooth unknown at its knots; `None` of a real one and of any other.
    pub(super) fn phases(&self, unknown: usize) -> Option<Range<usize>> {
        match &self.each[unknown] {
            (Curve::Spline(spline), range) if !spline.is_real() => {
                Some(range.start + spline.knots()..range.end)
            }
            _ => None,
        }
    }

    /// What θ or a step of it is of the phase of a smooth unknown at a line.
    pub(super) fn phase_at(&self, unknown: usize, theta: &[f64], line: usize) -> f64 {
        match &self.each[unknown] {
            (Curve::Spline(spline), range) => spline.log(&theta[range.clone()], line).im,
            _ => 0.0,
        }
    }

    /// Everything at a line; `None` where a number is not finite.
    pub(super) fn values(&self, theta: &[f64], line: usize, omega: f64) -> Option<Values> {
        let (mut values, mut slopes) = (Vec::with_capacity(self.each.len()), Vec::with_capacity(theta.len()));
        for (j, (curve, range)) in self.each.iter().enumerate() {
            let (value, of_theta) = curve.value(&theta[range.clone()], line, omega)?;
            values.push(value);
            slopes.extend(of_theta.into_iter().map(|slope| (j, slope)));
        }
        Some((values, slopes))
    }

    /// ∂p/∂θ of one unknown, by all coordinates.
    pub(super) fn slopes(&self, theta: &[f64], unknown: usize, line: usize, omega: f64) -> Option<Vec<c64>> {
        let (_, slopes) = self.values(theta, line, omega)?;
        let own = |(j, slope): (usize, c64)| if j == unknown { slope } else { c64::default() };
        Some(slopes.into_iter().map(own).collect())
    }

    /// The share of a response that each sensor shows at θ; none where all show all of it.
    pub(super) fn shares(&self, theta: &[f64], omega_rad_s: f64) -> Vec<c64> {
        self.channels.shares(theta, omega_rad_s / TAU)
    }

    /// What the sensors show of a response at θ.
    pub(super) fn shown(&self, theta: &[f64], omega_rad_s: f64, response: &[c64]) -> Vec<c64> {
        let shares = self.shares(theta, omega_rad_s);
        let one = |(m, x): (usize, &c64)| shares.get(m).map_or(*x, |share| share * x);
        response.iter().enumerate().map(one).collect()
    }

    /// The precision of what is known beforehand about a centre, n × n; see [`Curve::precision`].
    pub(super) fn precision(&self, centre: &[f64], bend: [f64; 2]) -> Vec<f64> {
        self.with_channels_known(self.blocks(|curve, range| curve.precision(&centre[range], bend)))
    }

    /// The same of unknowns that need not be causal.
    pub(super) fn smoothness(&self, bend: [f64; 2]) -> Vec<f64> {
        self.with_channels_known(self.blocks(|curve, _| curve.smoothness(bend)))
    }

    fn with_channels_known(&self, mut precision: Vec<f64>) -> Vec<f64> {
        let n = self.count();
        self.channels.range().for_each(|i| precision[i * n + i] = FORM_PRIOR_STD.powi(-2));
        precision
    }

    /// That of the bends of a part alone, and how many there are.
    pub(super) fn bends(&self, part: usize) -> (Vec<f64>, usize) {
        let count = self.each.iter().map(|(curve, _)| curve.bend_count(part)).sum();
        (self.blocks(|curve, _| curve.bends(part)), count)
    }

    fn blocks(&self, block: impl Fn(&Curve, Range<usize>) -> Vec<f64>) -> Vec<f64> {
        let n = self.count();
        let mut all = vec![0.0; n * n];
        for (curve, range) in &self.each {
            let own = block(curve, range.clone());
            for (i, row) in range.clone().zip(own.chunks_exact(range.len().max(1))) {
                all[i * n + range.start..i * n + range.end].copy_from_slice(row);
            }
        }
        all
    }

    /// Smooth curves without bends, as causal materials have them; constants and laws as they are.
    pub(super) fn straight(&self, theta: &[f64]) -> Vec<f64> {
        let of_unknowns = self.each.iter().flat_map(|(curve, range)| curve.straight(&theta[range.clone()]));
        of_unknowns.chain(theta[self.of_unknowns()..].iter().copied()).collect()
    }

    /// θ with given coordinates of constants, laws and channels, and smooth curves nearest to some values with weights (inverse variances
    /// of ln p) at some lines; `None` where one of them has none.
    pub(super) fn through(
        &self,
        given: &[f64],
        data: impl Fn(usize) -> Vec<(usize, c64, f64)>,
    ) -> Option<Vec<f64>> {
        let mut given = given.iter().copied();
        let mut theta = Vec::with_capacity(self.count());
        for (j, (curve, range)) in self.each.iter().enumerate() {
            match curve {
                Curve::Form(_) => theta.extend(given.by_ref().take(range.len())),
                Curve::Spline(_) => {
                    theta.extend(curve.through(&data(j)).filter(|own| own.len() == range.len())?)
                }
            }
        }
        theta.extend(given);
        Some(theta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Parametrization;

    /// Cubics with no bend at the ends are their own natural splines; slopes are those of finite differences.
    #[test]
    fn straight_lines_are_kept_and_slopes_are_right() {
        let omegas: Vec<f64> = (1..=200).map(|k| 10.0 * f64::from(k)).collect();
        let curve = Curve::Spline(Spline::new(&omegas, false));
        let data: Vec<(usize, c64, f64)> =
            (0..200).map(|k| (k, (c64::new(0.1, 0.2) * omegas[k].ln() + 3.0).exp(), 1e6)).collect();
        let theta = curve.through(&data).unwrap();
        for &(k, modulus, _) in &data {
            let (found, slopes) = curve.value(&theta, k, omegas[k]).unwrap();
            assert!((found / modulus - 1.0).norm() < 1e-4, "{k}: {found} {modulus}");
            for j in 0..theta.len() {
                let mut moved = theta.clone();
                moved[j] += 1e-6;
                let (there, _) = curve.value(&moved, k, omegas[k]).unwrap();
                assert!(((there - found) / 1e-6 - slopes[j]).norm() < 1e-4 * found.norm());
            }
        }
    }

    /// A constant and a smooth curve are multiplied, and have the loss factor that they are given.
    #[test]
    fn unknowns_are_scaled_and_have_a_loss_factor() {
        let omegas: Vec<f64> = (1..=20).map(|k| 10.0 * f64::from(k)).collect();
        let constant = Parametrization::about(LawKind::Constant, &omegas);
        let curves = Curves::new(vec![
            Curve::Form(Form::Law(constant)),
            Curve::Spline(Spline::new(&omegas, false)),
            Curve::Form(Form::Logarithm),
        ]);
        let mut theta = vec![0.0; curves.count()];
        for unknown in 0..3 {
            curves.scale(&mut theta, unknown, 2f64.ln());
            curves.set_loss_factor(&mut theta, unknown, 0.1);
        }
        let (values, _) = curves.values(&theta, 7, omegas[7]).unwrap();
        assert!((values[0] - c64::new(2.0, 0.2)).norm() < 1e-12, "{values:?}");
        assert!((values[1].norm() - 2.0).abs() < 1e-12 && (values[1].im / values[1].re - 0.1).abs() < 1e-12);
        assert!((values[2] - 2.0).norm() < 1e-12, "{values:?}");
    }
}
