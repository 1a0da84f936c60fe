//! Where a reduced model was trained: a range of frequencies, and of the factor of every term.

use super::Point;
use crate::c64;
use crate::model::DynamicStiffness;

/// The frequencies and factors of the points of a training.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TrainedBox {
    pub(super) frequency_hz: Range,
    /// Of each term the real and the imaginary part of its factor.
    pub(super) factors: Vec<[Range; 2]>,
}

/// Smallest and largest value; nothing where they are infinite.
pub(super) type Range = [f64; 2];

const NOTHING: Range = [f64::INFINITY, f64::NEG_INFINITY];

/// Factors are read from weights of matrices, and come back with roundoff.
const RTOL: f64 = 1e-9;

impl TrainedBox {
    pub(super) fn of(model: &DynamicStiffness, points: &[Point<'_>]) -> Self {
        let terms = model.terms().len();
        let mut trained = Self { frequency_hz: NOTHING, factors: vec![[NOTHING; 2]; terms] };
        for point in points {
            let frequency_hz = point.at.frequency_hz;
            extend(&mut trained.frequency_hz, frequency_hz);
            for (term, weight) in weights(point, terms).into_iter().enumerate() {
                let factor = weight / model.weight(model.terms()[term].role, frequency_hz);
                // At 0 Hz a mass has no weight.
                if factor.is_finite() {
                    let [re, im] = &mut trained.factors[term];
                    extend(re, factor.re);
                    extend(im, factor.im);
                }
            }
        }
        trained
    }

    /// Whether all of another box is in this one.
    pub(super) fn contains(&self, other: &Self) -> bool {
        let within = |[low, high]: Range, other: Range, size: f64| {
            other == NOTHING || (low - RTOL * size <= other[0] && other[1] <= high + RTOL * size)
        };
        let size =
            |[re, im]: [Range; 2]| re.into_iter().chain(im).fold(0.0, |size: f64, v| size.max(v.abs()));
        let mut factors = self.factors.iter().zip(&other.factors);
        within(self.frequency_hz, other.frequency_hz, other.frequency_hz[1])
            && factors.all(|(own, other)| (0..2).all(|part| within(own[part], other[part], size(*other))))
    }
}

fn extend([low, high]: &mut Range, value: f64) {
    (*low, *high) = (low.min(value), high.max(value));
}

/// What multiplies the matrix of each term at a point.
fn weights(point: &Point<'_>, terms: usize) -> Vec<c64> {
    let mut weights = vec![c64::default(); terms];
    let mut power = c64::new(1.0, 0.0);
    let coefficients = point.at.parameters.first().map_or(&[][..], |parameter| &parameter.coefficients);
    for combination in std::iter::once(&point.at.nominal).chain(coefficients) {
        combination.parts.iter().for_each(|part| weights[part.term] += power * part.weight);
        power *= point.correction;
    }
    weights
}
