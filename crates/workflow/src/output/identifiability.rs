//! Which combinations of the numbers that hold for the band are identifiable, in words.

use crate::load::IdentifyCase;
use frfit::identify::{BandCoordinate, Direction, Identification, NumberOf};

/// A direction whose standard deviation is larger is not identifiable.
const UNKNOWN: f64 = 0.3;

/// A weight below this part of the largest is left out of a sentence.
const SMALL: f64 = 0.05;

/// What a coordinate of correlation and directions stands for: `core`, `core loss_factor`, `skins e0`,
/// `scale of measurement 2`.
pub fn coordinate(identify: &IdentifyCase, found: &Identification, c: usize) -> String {
    let BandCoordinate { of, number } = &found.identifiability.coordinates[c];
    match *of {
        NumberOf::Unknown(j) if number == "value" => identify.unknowns[j].name.clone(),
        NumberOf::Unknown(j) => format!("{} {number}", identify.unknowns[j].name),
        NumberOf::Channel(m) => format!("{number} of measurement {}", m + 1),
    }
}

/// The combinations that are not identifiable from the measurements, in words.
pub fn not_identifiable(identify: &IdentifyCase, found: &Identification) -> Vec<String> {
    let sentence = |direction: &Direction| {
        let largest = direction.weights.first().map_or(1.0, |(_, weight)| weight.abs());
        let mut up = Vec::new();
        let mut down = Vec::new();
        for &(c, weight) in direction.weights.iter().filter(|(_, weight)| weight.abs() >= SMALL * largest) {
            let part = weight.abs() / largest;
            let name = coordinate(identify, found, c);
            let name =
                if (part - 1.0).abs() < 0.01 { name } else { format!("{name} (by {part:.2} of that)") };
            if weight > 0.0 { up.push(name) } else { down.push(name) }
        }
        let both = match (up.as_slice(), down.as_slice()) {
            ([one], []) | ([], [one]) => one.clone(),
            (up, []) => format!("{} all larger together", up.join(", ")),
            (up, down) => format!("{} larger with {} smaller", up.join(", "), down.join(", ")),
        };
        match direction.std.is_finite() && direction.std < 10.0 {
            true => format!("{both}: ±{:.0} %", 100.0 * direction.std),
            false => format!("{both}: not identifiable"),
        }
    };
    found
        .identifiability
        .directions
        .iter()
        .filter(|direction| direction.std > UNKNOWN)
        .map(sentence)
        .collect()
}
