//! Everything a dataset 58 says before its data.

use super::data_type::DataType;
use super::direction::direction_name;
use super::function_type::FunctionType;
use super::quantity::Quantity;

/// One end of a function: where and in which direction it was measured or excited.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Dof {
    /// Entity name (10 characters); empty where the file says `NONE` or nothing.
    pub entity: String,
    /// Node label.
    pub node: i64,
    /// ±1, ±2, ±3: translation along ±x, ±y, ±z; ±4, ±5, ±6: rotation about them; 0: scalar.
    pub direction: i32,
}

impl Dof {
    /// Node and direction in one word: `34+Z`, `34-RX`, `34` for a scalar.
    #[must_use]
    pub fn label(&self) -> String {
        match direction_name(self.direction) {
            Some(direction) => format!("{}{direction}", self.node),
            None => format!("{}({})", self.node, self.direction),
        }
    }
}

/// How the abscissa is given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// xₖ = minimum + k·increment, k from 0: not stored with the data.
    Even {
        /// x₀, in the unit of the abscissa.
        minimum: f64,
        /// Step, in the unit of the abscissa.
        increment: f64,
    },
    /// Every abscissa value is stored before its ordinate.
    Uneven,
}

/// What one axis of a function shows, and in which unit.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Axis {
    /// Specific data type.
    pub quantity: Quantity,
    /// Exponent of the length unit; it counts for [`Quantity::General`].
    pub length_exponent: i32,
    /// Exponent of the force unit; it counts for [`Quantity::General`].
    pub force_exponent: i32,
    /// Exponent of the temperature unit; it counts for [`Quantity::General`].
    pub temperature_exponent: i32,
    /// Axis label (20 characters); empty where the file says `NONE` or nothing.
    pub label: String,
    /// Unit label (20 characters); empty where the file says `NONE` or nothing.
    pub unit: String,
}

/// The eleven records before the data of a dataset 58.
///
/// A field that the file leaves blank is 0 or empty; `NONE`, with which the format fills unused texts, is
/// read as empty and written again.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionHeader {
    /// ID lines 1–5 (80 characters each): usually the description, then the run, date and time, load case.
    pub id: [String; 5],
    /// What kind of function it is.
    pub function_type: FunctionType,
    /// Function identification number.
    pub function_id: i64,
    /// Version or sequence number.
    pub version: i32,
    /// Load case identification number; 0: excitation at a single point.
    pub load_case: i64,
    /// Where the response was taken.
    pub response: Dof,
    /// Where the reference (for an FRF the force) was taken.
    pub reference: Dof,
    /// Real or complex, single or double precision.
    pub data_type: DataType,
    /// Number of points that the file promises. A file cut short holds fewer
    /// ([`Function::missing_points`](super::Function::missing_points)).
    pub points: usize,
    /// Even or uneven abscissa.
    pub spacing: Spacing,
    /// Value of the third axis.
    pub z_value: f64,
    /// Record 8.
    pub abscissa: Axis,
    /// Record 9: the ordinate, or the numerator of it (for an FRF the response).
    pub ordinate: Axis,
    /// Record 10: the denominator of the ordinate (for an FRF the force).
    pub denominator: Axis,
    /// Record 11: the third axis.
    pub z_axis: Axis,
}

impl Default for FunctionHeader {
    /// An FRF of unknown quantities over frequency, complex in double precision, without points.
    fn default() -> Self {
        Self {
            id: Default::default(),
            function_type: FunctionType::FrequencyResponse,
            function_id: 0,
            version: 0,
            load_case: 0,
            response: Dof::default(),
            reference: Dof::default(),
            data_type: DataType::ComplexDouble,
            points: 0,
            spacing: Spacing::Uneven,
            z_value: 0.0,
            abscissa: Axis { quantity: Quantity::Frequency, ..Axis::default() },
            ordinate: Axis::default(),
            denominator: Axis::default(),
            z_axis: Axis::default(),
        }
    }
}

impl FunctionHeader {
    /// Numbers stored for one point: the abscissa where it is uneven, then the parts of the ordinate.
    pub(super) fn numbers_per_point(&self) -> usize {
        usize::from(self.spacing == Spacing::Uneven) + self.data_type.parts()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dof_reads_like_node_and_direction() {
        let dof = |node, direction| Dof { node, direction, ..Dof::default() }.label();
        assert_eq!(dof(34, 3), "34+Z");
        assert_eq!(dof(7, -4), "7-RX");
        assert_eq!(dof(7, 0), "7");
        assert_eq!(dof(7, 9), "7(9)");
    }
}
