//! The directions of a degree of freedom and their names.

/// What direction ±1…±6 is called: `+X` to `-Z` for ±1…±3, `+RX` to `-RZ` for ±4…±6, nothing for a scalar
/// (0), `None` for every other number.
#[must_use]
pub fn direction_name(direction: i32) -> Option<&'static str> {
    const POSITIVE: [&str; 7] = ["", "+X", "+Y", "+Z", "+RX", "+RY", "+RZ"];
    const NEGATIVE: [&str; 7] = ["", "-X", "-Y", "-Z", "-RX", "-RY", "-RZ"];
    let names = if direction < 0 { NEGATIVE } else { POSITIVE };
    names.get(usize::try_from(direction.unsigned_abs()).ok()?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn translations_and_rotations_have_signs_and_letters() {
        assert_eq!(direction_name(3), Some("+Z"));
        assert_eq!(direction_name(-6), Some("-RZ"));
        assert_eq!(direction_name(4), Some("+RX"));
        assert_eq!(direction_name(0), Some(""));
        assert_eq!(direction_name(7), None);
        assert_eq!(direction_name(i32::MIN), None);
    }
}
