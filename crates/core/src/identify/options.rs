//! How to identify.

use super::choice::{Method, Reduction, Selection, UnknownChoice};
use super::unknown::{NEAR_BOX_RATIO, Unknown};
use crate::c64;
use crate::model::DynamicStiffness;
use crate::with_fields::with_fields;
use std::fmt;
use std::str::FromStr;

/// The whole of the bounds, but no farther than this factor to either side: a box without end has no grid.
const WHOLE_BOX_RATIO: f64 = 1e6;

/// Options of an identification; all have defaults.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Rational (default), series or Nelder–Mead.
    pub method: Method,
    /// Order n of the series, upper bound of it for the rational response, or iterations of Nelder–Mead. Default 30, the paper's.
    pub order: usize,
    /// Joint (default) or smallest |c|. The series and Nelder–Mead know only the latter.
    pub selection: Selection,
    /// What answers at a frequency. Default automatic.
    pub reduction: Reduction,
    /// Whether the factor is searched in all of the bounds, as for a nominal that is no more than their middle. Default false: in a factor of four to either side
    /// of the nominal first.
    pub whole_box: bool,
    /// Whether a joint selection leaves out a sensor of three or more that contradicts all others. Default true: it is named in any case.
    pub reject_outliers: bool,
    /// What is known of the errors of the model. Default: they are estimated.
    pub model_errors: ModelErrors,
    /// Whether a joint selection on the subspace looks for all solutions at every frequency, however many there are. Default false: at some hundred of a dense
    /// band, and follows them in between.
    pub everywhere: bool,
    /// The factor on the nominal value about which answers are searched.
    pub(super) about: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::default(),
            order: 30,
            selection: Selection::default(),
            reduction: Reduction::default(),
            whole_box: false,
            reject_outliers: true,
            everywhere: false,
            model_errors: ModelErrors::default(),
            about: 1.0,
        }
    }
}

with_fields!(Options {
    with_method: method as Method,
    with_order: order as usize,
    with_selection: selection as Selection,
    with_reduction: reduction as Reduction,
    with_whole_box: whole_box as bool,
    with_reject_outliers: reject_outliers as bool,
    with_model_errors: model_errors as ModelErrors,
    with_everywhere: everywhere as bool,
});

/// What is known of the errors of the model: of its natural frequencies, mode shapes and known factors (B-11).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ModelErrors {
    /// Nothing: whether there are any, and how large they are, is estimated from the band.
    #[default]
    Estimated,
    /// There are some, as large as this: they are in every error bar, however well a right model explains the band.
    Given(ErrorSizes),
    /// No errors of the model count: error bars hold the noise of the measurement alone.
    None,
}

/// How large errors of the model are: standard deviations, relative. `None` where that is to be estimated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct ErrorSizes {
    /// Of natural frequencies.
    pub frequency: Option<f64>,
    /// Of mode shapes at the sensors.
    pub shape: Option<f64>,
    /// Of the calibrations of force and sensors.
    pub calibration: Option<f64>,
}

with_fields!(ErrorSizes {
    with_frequency: frequency as Option<f64>,
    with_shape: shape as Option<f64>,
    with_calibration: calibration as Option<f64>,
});

/// The largest error that a model may have and be a model of the structure.
const MAX_ERROR_SIZE: f64 = 0.5;

impl ErrorSizes {
    /// Whether one is given.
    pub fn any(self) -> bool {
        self.frequency.or(self.shape).or(self.calibration).is_some()
    }

    fn validate(self) -> Result<(), OptionsError> {
        let all = [("frequency", self.frequency), ("shape", self.shape), ("calibration", self.calibration)];
        for (name, size) in all {
            if let Some(size) = size.filter(|size| !(*size > 0.0 && *size <= MAX_ERROR_SIZE)) {
                return Err(OptionsError::ErrorSize(name, size));
            }
        }
        Ok(())
    }
}

impl ModelErrors {
    /// What is given of their sizes.
    pub(super) fn sizes(self) -> ErrorSizes {
        match self {
            Self::Given(sizes) => sizes,
            Self::Estimated | Self::None => ErrorSizes::default(),
        }
    }

    /// Whether a model counts as exact: without errors, and with no factor whose accuracy is given.
    pub(super) fn is_exact(self, model: &DynamicStiffness) -> bool {
        self == Self::None && !model.has_factor_std()
    }
}

impl FromStr for ModelErrors {
    type Err = UnknownChoice;

    fn from_str(name: &str) -> Result<Self, UnknownChoice> {
        match name {
            "estimated" => Ok(Self::Estimated),
            "none" => Ok(Self::None),
            _ => Err(UnknownChoice { found: name.to_owned(), expected: "\"estimated\" or \"none\"" }),
        }
    }
}

/// The largest order: beyond it double precision has no digit left to add.
pub const MAX_ORDER: usize = 200;

/// What is wrong with options.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum OptionsError {
    /// Order 0, or above [`MAX_ORDER`].
    Order(usize),
    /// A standard deviation of errors of the model, by its name, that is not positive or is too large.
    ErrorSize(&'static str, f64),
    /// A joint selection with a method that offers nothing to select from.
    Selection(Method),
}

impl fmt::Display for OptionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Order(order) => write!(f, "order: expected 1 to {MAX_ORDER}, found {order}"),
            Self::ErrorSize(name, size) => {
                write!(
                    f,
                    "model_error.{name}: expected a number above 0 up to {MAX_ERROR_SIZE}, found {size}"
                )
            }
            Self::Selection(method) => {
                let method = method.name();
                write!(f, "selection: expected \"smallest\" with method {method:?}, found \"joint\"")
            }
        }
    }
}

impl std::error::Error for OptionsError {}

impl Options {
    /// The paper's way: series, smallest |c|.
    pub fn paper() -> Self {
        Self { method: Method::Series, selection: Selection::Smallest, ..Self::default() }
    }

    /// Checks what types cannot.
    ///
    /// # Errors
    /// [`OptionsError`] with the option's name, what was expected, and what was found.
    pub fn validate(&self) -> Result<(), OptionsError> {
        if !(1..=MAX_ORDER).contains(&self.order) {
            return Err(OptionsError::Order(self.order));
        }
        self.model_errors.sizes().validate()?;
        if self.selection == Selection::Joint && self.method != Method::Rational {
            return Err(OptionsError::Selection(self.method));
        }
        Ok(())
    }

    /// [low, high] of the real part in which answers are searched; `None` where nothing bounds it.
    pub(crate) fn search_box(&self, unknown: &Unknown, nominal: c64) -> Option<[f64; 2]> {
        unknown.box_about(self.about * nominal, if self.whole_box { WHOLE_BOX_RATIO } else { NEAR_BOX_RATIO })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_the_paper_is_two_words_away() {
        let options = Options::default();
        assert_eq!((options.method, options.selection), (Method::Rational, Selection::Joint));
        assert_eq!(options.validate(), Ok(()));
        assert_eq!(Options::paper().validate(), Ok(()));
        let mixed = Options { method: Method::Series, ..options };
        assert_eq!(
            mixed.validate().unwrap_err().to_string(),
            "selection: expected \"smallest\" with method \"series\", found \"joint\""
        );
    }

    #[test]
    fn invalid_options_name_themselves() {
        let order = Options { order: 0, ..Options::default() };
        assert_eq!(order.validate().unwrap_err().to_string(), "order: expected 1 to 200, found 0");
        let sizes = ErrorSizes::default().with_frequency(Some(0.0));
        let model_errors = ModelErrors::Given(sizes);
        assert_eq!(
            Options { model_errors, ..Options::default() }.validate().unwrap_err().to_string(),
            "model_error.frequency: expected a number above 0 up to 0.5, found 0"
        );
    }
}
