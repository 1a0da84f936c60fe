//! What an axis of a function measures.

/// Specific data type of an axis (dataset 58, records 8–11, field 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Quantity {
    /// 0
    #[default]
    Unknown,
    /// 1: the unit exponents of the axis say what it is.
    General,
    /// 2
    Stress,
    /// 3
    Strain,
    /// 5
    Temperature,
    /// 6
    HeatFlux,
    /// 8
    Displacement,
    /// 9
    ReactionForce,
    /// 11
    Velocity,
    /// 12
    Acceleration,
    /// 13
    ExcitationForce,
    /// 15
    Pressure,
    /// 16
    Mass,
    /// 17
    Time,
    /// 18
    Frequency,
    /// 19
    RotationalSpeed,
    /// 20
    Order,
    /// A number that the format document does not name. One that it names is read as its own variant.
    Other(i32),
}

const NAMED: [(i32, Quantity, &str); 17] = [
    (0, Quantity::Unknown, "unknown"),
    (1, Quantity::General, "general"),
    (2, Quantity::Stress, "stress"),
    (3, Quantity::Strain, "strain"),
    (5, Quantity::Temperature, "temperature"),
    (6, Quantity::HeatFlux, "heat flux"),
    (8, Quantity::Displacement, "displacement"),
    (9, Quantity::ReactionForce, "reaction force"),
    (11, Quantity::Velocity, "velocity"),
    (12, Quantity::Acceleration, "acceleration"),
    (13, Quantity::ExcitationForce, "excitation force"),
    (15, Quantity::Pressure, "pressure"),
    (16, Quantity::Mass, "mass"),
    (17, Quantity::Time, "time"),
    (18, Quantity::Frequency, "frequency"),
    (19, Quantity::RotationalSpeed, "rotational speed"),
    (20, Quantity::Order, "order"),
];

impl Quantity {
    /// The quantity with this number.
    #[must_use]
    pub fn from_number(number: i32) -> Self {
        let named = NAMED.iter().find(|(n, _, _)| *n == number);
        named.map_or(Self::Other(number), |(_, quantity, _)| *quantity)
    }

    /// The number that stands for it in a file.
    #[must_use]
    pub fn number(self) -> i32 {
        match self {
            Self::Other(number) => number,
            named => NAMED.iter().find(|(_, quantity, _)| *quantity == named).map_or(0, |(n, _, _)| *n),
        }
    }

    /// Its name in plain words.
    #[must_use]
    pub fn name(self) -> &'static str {
        NAMED
            .iter()
            .find(|(_, quantity, _)| *quantity == self)
            .map_or("unnamed quantity", |(_, _, name)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_and_quantity_are_one_to_one() {
        for number in -2..40 {
            assert_eq!(Quantity::from_number(number).number(), number);
        }
        assert_eq!(Quantity::from_number(12).name(), "acceleration");
        assert_eq!(Quantity::from_number(4), Quantity::Other(4));
    }
}
