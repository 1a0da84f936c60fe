//! The numbers that hold for the whole band, as coordinates θ of a search.

use crate::c64;
use crate::identify::channel::ChannelUnknowns;
use crate::identify::channel_coordinates::ChannelCoordinates;
use crate::identify::form::Form;
use crate::identify::unknown::{Unknown, Variation};
use crate::laws::{LawKind, Parametrization};

/// One unknown that holds for the band.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Own {
    /// Which.
    pub(super) unknowns: usize,
    /// Its coordinates.
    pub(super) range: std::ops::Range<usize>,
    pub(super) form: Form,
}

/// All of them, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coordinates {
    pub(super) each: Vec<Own>,
    /// Those of the channels come after those of the unknowns.
    pub(super) channels: ChannelCoordinates,
    pub(super) count: usize,
    /// [low, high] of each coordinate: the bounds of constants. Those of a law are on its modulus, not on its coordinates.
    pub(super) limits: Vec<[f64; 2]>,
}

/// A coordinate without bounds.
const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// ln of positive bounds, rounded so that e^θ lies within them.
fn log_limits(bound: Option<[f64; 2]>) -> [f64; 2] {
    let [low, high] = bound.unwrap_or([0.0, f64::INFINITY]).map(|value| value.max(0.0));
    let (mut from, mut to) = (low.ln(), high.ln());
    while from.exp() < low {
        from = from.next_up();
    }
    while to.exp() > high {
        to = to.next_down();
    }
    [from, to]
}

impl Coordinates {
    /// Of the unknowns as they vary; `nominal` are values somewhere in the band.
    pub(super) fn new(
        unknowns: &[Unknown],
        vary: impl Fn(&Unknown) -> Variation,
        nominal: &[c64],
        (omegas, decay_per_s): (&[f64], f64),
    ) -> Self {
        let law = |kind| Form::Law(Parametrization::about(kind, omegas).through_window(decay_per_s));
        let (mut each, mut count, mut limits) = (Vec::new(), 0, Vec::new());
        for (j, one) in unknowns.iter().enumerate() {
            let form = match (&vary(one), one.real) {
                (Variation::PerFrequency | Variation::Smooth, _) => continue,
                (Variation::Constant, true) => {
                    let [low, high] = one.range(nominal[j]);
                    match low > 0.0 && nominal[j].re > 0.0 {
                        true => Form::Logarithm,
                        false => Form::Scaled(nominal[j].norm().max(low.abs()).max(high.abs())),
                    }
                }
                (Variation::Constant, false) => law(LawKind::Constant),
                (Variation::Law(kinds), _) => law(kinds[0]),
            };
            let own = form.count();
            match &form {
                Form::Logarithm => limits.push(log_limits(one.bounds.storage)),
                Form::Scaled(scale) => {
                    limits.push(one.bounds.storage.unwrap_or(UNBOUNDED).map(|bound| bound / scale))
                }
                Form::Law(law) if law.kind == LawKind::Constant => {
                    limits.extend([
                        log_limits(one.bounds.storage),
                        one.bounds.loss_factor.unwrap_or(UNBOUNDED),
                    ]);
                }
                Form::Law(law) => limits.extend(vec![UNBOUNDED; law.kind.count()]),
            }
            each.push(Own { unknowns: j, range: count..count + own, form });
            count += own;
        }
        Self { each, channels: ChannelCoordinates::default(), count, limits }
    }

    /// The same with the scales and delays of channels.
    pub(super) fn with_channels(mut self, channels: &[ChannelUnknowns], omegas: &[f64]) -> Self {
        self.channels = ChannelCoordinates::new(channels, self.count, omegas);
        self.count += self.channels.count();
        self.limits.resize(self.count, UNBOUNDED);
        self
    }

    /// θ with every coordinate within its bounds.
    pub(super) fn within_bounds(&self, theta: &[f64]) -> Vec<f64> {
        theta.iter().zip(&self.limits).map(|(t, [low, high])| t.clamp(*low, *high)).collect()
    }

    /// The coordinates at a bound beyond which the misfit, whose gradient is given, would be less.
    pub(super) fn binding(&self, theta: &[f64], gradient: &[f64]) -> Vec<usize> {
        let is_binding = |&c: &usize| {
            let [low, high] = self.limits[c];
            (theta[c] <= low && gradient[c] > 0.0) || (theta[c] >= high && gradient[c] < 0.0)
        };
        (0..self.count).filter(is_binding).collect()
    }

    /// θ of constants with these values, and of calibrated channels; for laws `law` says where to begin.
    pub(super) fn of(&self, values: &[c64], law: impl Fn(&Parametrization, usize) -> Vec<f64>) -> Vec<f64> {
        let of = |own: &Own| match &own.form {
            Form::Logarithm => vec![values[own.unknowns].re.ln()],
            Form::Scaled(scale) => vec![values[own.unknowns].re / scale],
            Form::Law(parametrization) if parametrization.kind == LawKind::Constant => {
                let value = values[own.unknowns];
                parametrization.coordinates(&[value.re, crate::material::loss_factor(value)])
            }
            Form::Law(parametrization) => law(parametrization, own.unknowns),
        };
        let calibrated = std::iter::repeat_n(0.0, self.channels.count());
        self.each.iter().flat_map(of).chain(calibrated).collect()
    }
}

impl Own {
    /// p at ω, and ∂p/∂θ of its own coordinates.
    pub(super) fn value(&self, theta: &[f64], omega_rad_s: f64) -> Option<(c64, Vec<c64>)> {
        self.form.value(&theta[self.range.clone()], omega_rad_s)
    }

    /// The numbers that its coordinates stand for, with ∂(number)/∂θ, row by row.
    pub(super) fn numbers(&self, theta: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        self.form.numbers(&theta[self.range.clone()])
    }

    /// A gradient by all coordinates from that by its own.
    pub(super) fn gradient(&self, own: impl IntoIterator<Item = f64>, count: usize) -> Vec<f64> {
        let mut gradient = vec![0.0; count];
        gradient[self.range.clone()].iter_mut().zip(own).for_each(|(all, own)| *all = own);
        gradient
    }

    /// Its law, where it has one: a complex constant is one too.
    pub(super) fn kind(&self) -> Option<LawKind> {
        self.form.kind()
    }
}
