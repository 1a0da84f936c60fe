//! The numbers that hold for the whole band, as coordinates θ of a search.

use super::unknown::{Unknown, Variation};
use crate::c64;
use crate::laws::{LawKind, Parametrization};

/// How one unknown hangs on its coordinates.
#[derive(Debug, Clone, PartialEq)]
enum Form {
    /// p = e^θ.
    Logarithm,
    /// p = s θ, with s of the size of what is expected.
    Scaled(f64),
    /// A complex constant or a law.
    Law(Parametrization),
}

/// One unknown that holds for the band.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Own {
    /// Which.
    pub(super) unknowns: usize,
    /// Its coordinates.
    pub(super) range: std::ops::Range<usize>,
    form: Form,
}

/// All of them, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Coordinates {
    pub(super) each: Vec<Own>,
    pub(super) count: usize,
}

impl Coordinates {
    /// Of the unknowns as they vary; `nominal` are values somewhere in the band.
    pub(super) fn new(
        unknowns: &[Unknown],
        vary: impl Fn(&Unknown) -> Variation,
        nominal: &[c64],
        omegas: &[f64],
    ) -> Self {
        let (mut each, mut count) = (Vec::new(), 0);
        for (j, one) in unknowns.iter().enumerate() {
            let form = match (vary(one), one.real) {
                (Variation::PerFrequency, _) => continue,
                (Variation::Constant, true) => {
                    let [low, high] = one.range(nominal[j]);
                    match low > 0.0 && nominal[j].re > 0.0 {
                        true => Form::Logarithm,
                        false => Form::Scaled(nominal[j].norm().max(low.abs()).max(high.abs())),
                    }
                }
                (Variation::Constant, false) => Form::Law(Parametrization::about(LawKind::Constant, omegas)),
                (Variation::Law(family), _) => Form::Law(Parametrization::about(family, omegas)),
            };
            let own = match &form {
                Form::Law(parametrization) => parametrization.family.count(),
                _ => 1,
            };
            each.push(Own { unknowns: j, range: count..count + own, form });
            count += own;
        }
        Self { each, count }
    }

    /// θ of constants with these values; for laws `law` says where to begin.
    pub(super) fn of(&self, values: &[c64], law: impl Fn(&Parametrization, usize) -> Vec<f64>) -> Vec<f64> {
        let of = |own: &Own| match &own.form {
            Form::Logarithm => vec![values[own.unknowns].re.ln()],
            Form::Scaled(scale) => vec![values[own.unknowns].re / scale],
            Form::Law(parametrization) if parametrization.family == LawKind::Constant => {
                let value = values[own.unknowns];
                parametrization.coordinates(&[value.re, crate::material::loss_factor(value)])
            }
            Form::Law(parametrization) => law(parametrization, own.unknowns),
        };
        self.each.iter().flat_map(of).collect()
    }
}

impl Own {
    /// p at ω, and ∂p/∂θ of its own coordinates.
    pub(super) fn value(&self, theta: &[f64], omega_rad_s: f64) -> Option<(c64, Vec<c64>)> {
        let own = &theta[self.range.clone()];
        let real = |value: f64, slope: f64| (c64::new(value, 0.0), vec![c64::new(slope, 0.0)]);
        let found = match &self.form {
            Form::Logarithm => real(own[0].exp(), own[0].exp()),
            Form::Scaled(scale) => real(own[0] * scale, *scale),
            Form::Law(parametrization) => return parametrization.modulus(own, omega_rad_s),
        };
        found.0.is_finite().then_some(found)
    }

    /// The numbers that its coordinates stand for, with ∂(number)/∂θ, row by row.
    pub(super) fn numbers(&self, theta: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let own = &theta[self.range.clone()];
        match &self.form {
            Form::Logarithm => (vec![own[0].exp()], vec![vec![own[0].exp()]]),
            Form::Scaled(scale) => (vec![own[0] * scale], vec![vec![*scale]]),
            Form::Law(parametrization) => parametrization.parameters(own),
        }
    }

    /// A gradient by all coordinates from that by its own.
    pub(super) fn gradient(&self, own: impl IntoIterator<Item = f64>, count: usize) -> Vec<f64> {
        let mut gradient = vec![0.0; count];
        gradient[self.range.clone()].iter_mut().zip(own).for_each(|(all, own)| *all = own);
        gradient
    }

    /// Its law, where it has one: a complex constant is one too.
    pub(super) fn family(&self) -> Option<LawKind> {
        match &self.form {
            Form::Law(parametrization) => Some(parametrization.family),
            _ => None,
        }
    }
}
