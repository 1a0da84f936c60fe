//! Real or complex, single or double precision.

/// Ordinate data type (dataset 58, record 7, field 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DataType {
    /// 2
    RealSingle,
    /// 4
    RealDouble,
    /// 5
    ComplexSingle,
    /// 6
    #[default]
    ComplexDouble,
}

impl DataType {
    /// The type with this number.
    #[must_use]
    pub fn from_number(number: i64) -> Option<Self> {
        match number {
            2 => Some(Self::RealSingle),
            4 => Some(Self::RealDouble),
            5 => Some(Self::ComplexSingle),
            6 => Some(Self::ComplexDouble),
            _ => None,
        }
    }

    /// The number that stands for it in a file.
    #[must_use]
    pub fn number(self) -> i64 {
        match self {
            Self::RealSingle => 2,
            Self::RealDouble => 4,
            Self::ComplexSingle => 5,
            Self::ComplexDouble => 6,
        }
    }

    /// Its name in plain words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RealSingle => "real, single precision",
            Self::RealDouble => "real, double precision",
            Self::ComplexSingle => "complex, single precision",
            Self::ComplexDouble => "complex, double precision",
        }
    }

    /// Whether an ordinate has an imaginary part.
    #[must_use]
    pub fn is_complex(self) -> bool {
        matches!(self, Self::ComplexSingle | Self::ComplexDouble)
    }

    /// Whether an ordinate is stored in double precision.
    #[must_use]
    pub fn is_double(self) -> bool {
        matches!(self, Self::RealDouble | Self::ComplexDouble)
    }

    /// Numbers of one ordinate: 1 or 2.
    pub(super) fn parts(self) -> usize {
        if self.is_complex() { 2 } else { 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_and_type_are_one_to_one() {
        let read: Vec<i64> = (0..9).filter_map(DataType::from_number).map(DataType::number).collect();
        assert_eq!(read, [2, 4, 5, 6]);
    }
}
