//! A function: header, abscissa, ordinates.

use num_complex::Complex64 as c64;

use super::data_type::DataType;
use super::function_header::{FunctionHeader, Spacing};

/// The ordinates of a function.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// One number a point.
    Real(Vec<f64>),
    /// Real and imaginary part a point.
    Complex(Vec<c64>),
}

impl Values {
    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Complex(values) => values.len(),
        }
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A dataset 58 or 58b: values over an abscissa, and what they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    /// What the function is.
    pub header: FunctionHeader,
    /// The abscissa of each point; for even spacing computed as minimum + k·increment.
    pub abscissa: Vec<f64>,
    /// The ordinate of each point.
    pub values: Values,
}

impl Function {
    /// A function with these points, its header agreeing with them: the number of points is that of the
    /// values, and the data type is real or complex as they are (the precision stays).
    #[must_use]
    pub fn new(mut header: FunctionHeader, abscissa: Vec<f64>, values: Values) -> Self {
        header.points = values.len();
        header.data_type = match (&values, header.data_type.is_double()) {
            (Values::Real(_), false) => DataType::RealSingle,
            (Values::Real(_), true) => DataType::RealDouble,
            (Values::Complex(_), false) => DataType::ComplexSingle,
            (Values::Complex(_), true) => DataType::ComplexDouble,
        };
        Self { header, abscissa, values }
    }

    /// Points that the header promises and the file does not hold: 0 unless it was cut short.
    #[must_use]
    pub fn missing_points(&self) -> usize {
        self.header.points.saturating_sub(self.values.len())
    }

    /// The function whose numbers, in the order of the file, are these. Numbers after the last whole point
    /// and after the last promised point are dropped.
    pub(super) fn from_numbers(header: FunctionHeader, mut numbers: Vec<f64>) -> Self {
        let per_point = header.numbers_per_point();
        let points = header.points.min(numbers.len() / per_point);
        numbers.truncate(points * per_point);
        let abscissa = match header.spacing {
            Spacing::Even { minimum, increment } => {
                (0..points).map(|k| minimum + k as f64 * increment).collect()
            }
            Spacing::Uneven => numbers.iter().step_by(per_point).copied().collect(),
        };
        let values = match (header.data_type.is_complex(), header.spacing) {
            (false, Spacing::Even { .. }) => Values::Real(numbers),
            (false, Spacing::Uneven) => Values::Real(numbers.iter().skip(1).step_by(2).copied().collect()),
            (true, _) => {
                Values::Complex(numbers.chunks_exact(per_point).filter_map(last_as_complex).collect())
            }
        };
        Self { header, abscissa, values }
    }
}

/// Real and imaginary part are the last two numbers of a complex point.
fn last_as_complex(point: &[f64]) -> Option<c64> {
    point.last_chunk().map(|&[re, im]| c64::new(re, im))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(data_type: DataType, spacing: Spacing, points: usize) -> FunctionHeader {
        FunctionHeader { data_type, spacing, points, ..FunctionHeader::default() }
    }

    #[test]
    fn the_order_in_the_file_is_abscissa_real_imaginary() {
        let uneven = header(DataType::ComplexSingle, Spacing::Uneven, 2);
        let function = Function::from_numbers(uneven, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(function.abscissa, [1.0, 4.0]);
        assert_eq!(function.values, Values::Complex(vec![c64::new(2.0, 3.0), c64::new(5.0, 6.0)]));
    }

    #[test]
    fn padding_is_dropped_and_a_cut_is_counted() {
        let spacing = Spacing::Even { minimum: 2.0, increment: 0.5 };
        let padded = Function::from_numbers(header(DataType::RealSingle, spacing, 2), vec![7.0, 8.0, 0.0]);
        assert_eq!(padded.values, Values::Real(vec![7.0, 8.0]));
        assert_eq!(padded.abscissa, [2.0, 2.5]);
        let cut = Function::from_numbers(header(DataType::ComplexSingle, spacing, 9), vec![7.0, 8.0, 0.0]);
        assert_eq!((cut.values.len(), cut.missing_points()), (1, 8));
    }
}
