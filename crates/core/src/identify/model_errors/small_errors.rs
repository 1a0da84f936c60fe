//! Small errors of a model about a place where a right model explains a band: what they promise, by the slopes there.

use super::search::{FactorPrior, Fitting, NEGLIGIBLE_STD, Normal, Sizes};
use super::{Explained, Measured};
use frfit_linalg::dense::Cholesky;

/// Of the sizes before the data, at which usual errors are tried, and smaller ones.
const USUAL_SIZE_PARTS: [f64; 4] = [1.0, 0.3, 0.1, 0.03];
const SMALL_SIZE_PARTS: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// By how many nats errors of some size explain a band better than a right model does, by a linear model about that. It costs no search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SmallErrors {
    /// Errors of all kinds and of usual sizes.
    pub(super) usual_nats: f64,
    /// The same of all sizes, with the least ones that are assumed as much smaller, and of errors of natural frequencies alone: shapes and calibrations that
    /// agree with a right model say nothing of these.
    pub(super) small_nats: f64,
}

/// A size of errors, and of which ones.
#[derive(Clone, Copy)]
struct Tried {
    part: f64,
    /// Whether the least sizes that are assumed are as much smaller.
    with_least: bool,
    only_frequencies: bool,
}

/// Where a right model explains a band.
struct About<'t, 'a> {
    whole: &'t Fitting<'t, 'a>,
    right: &'t Explained,
    /// Coordinates that a right model has.
    of_right: &'t [usize],
    place: &'t [f64],
    normal: &'t Normal,
}

impl SmallErrors {
    /// About a right model some of whose known factors may be in error.
    pub(super) fn new(
        data: &Measured<'_, '_>,
        whole: &Fitting<'_, '_>,
        right: &Explained,
        given: &[FactorPrior],
    ) -> Option<Self> {
        let of_right = whole.coordinates_of(given);
        let mut place = whole.start(&right.found.place[..whole.curves.count()]);
        of_right.iter().zip(&right.found.place).for_each(|(&i, value)| place[i] = *value);
        let normal = whole.normal(&place, &data.sigma_at(whole.lines, right.level, 0.0))?;
        let about = About { whole, right, of_right: &of_right, place: &place, normal: &normal };
        let usual = USUAL_SIZE_PARTS.map(|part| Tried { part, with_least: false, only_frequencies: false });
        let small = [false, true].map(|only_frequencies| {
            SMALL_SIZE_PARTS.map(|part| Tried { part, with_least: true, only_frequencies })
        });
        let most = |tried: &[Tried]| tried.iter().filter_map(|&tried| about.nats(tried)).reduce(f64::max);
        Some(Self { usual_nats: most(&usual)?, small_nats: most(small.as_flattened())? })
    }
}

impl About<'_, '_> {
    fn nats(&self, tried: Tried) -> Option<f64> {
        let Self { whole, of_right, place, normal, .. } = *self;
        let n = whole.count();
        let precision = self.precision(tried);
        let sum = normal.with_prior(&precision);
        let off = |j: usize| place[j] - whole.expected(j);
        let pull = |i: usize| -> f64 { of_right.iter().map(|&j| precision[i * n + j] * off(j)).sum() };
        let slope: Vec<f64> = (0..n).map(|i| normal.gradient[i] - pull(i)).collect();
        let factor = Cholesky::new(n, &sum).ok()?;
        let mut step = slope.clone();
        factor.solve(&mut step);
        let gained: f64 = slope.iter().zip(&step).map(|(g, s)| g * s).sum();
        let all: Vec<usize> = (0..n).collect();
        let volume = |matrix: &[f64], of: &[usize]| -> Option<f64> {
            let row = |&i: &usize| of.iter().map(move |j| matrix[i * n + j]);
            let block: Vec<f64> = of.iter().flat_map(row).collect();
            Some(Cholesky::new(of.len(), &block).ok()?.log_determinant())
        };
        let of_errors = factor.log_determinant() - volume(&precision, &all)?;
        let of_curves = volume(&sum, of_right)? - volume(&precision, of_right)?;
        Some(0.5 * (gained - of_errors + of_curves))
    }

    /// The prior's precision, n × n.
    fn precision(&self, Tried { part, with_least, only_frequencies }: Tried) -> Vec<f64> {
        let Self { whole, right, of_right, .. } = *self;
        let usual = Sizes::prior(whole.known);
        let sizes = Sizes {
            frequency: part * usual.frequency,
            loss_factor: part * usual.loss_factor,
            common: part * usual.common,
            common_loss: part * usual.common_loss,
            shape: part * usual.shape,
            calibration: part * usual.calibration,
            bend: right.sizes.bend,
        };
        let known = if with_least { whole.known.smaller(part) } else { whole.known };
        let mut precision = Fitting { known, ..*whole }.precision(&sizes);
        if only_frequencies {
            let n = whole.count();
            let others = whole.beside_frequencies().filter(|i| !of_right.contains(i));
            others.for_each(|i| precision[i * n + i] = NEGLIGIBLE_STD.powi(-2));
        }
        precision
    }
}
