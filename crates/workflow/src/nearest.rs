//! What was probably meant.

/// The name nearest to a text by edit distance; `None` where fewer than a third of the letters agree.
pub(crate) fn nearest<'n>(text: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    // The distance takes time in proportion to both lengths: a text far beyond every name is near to none.
    const LONGEST: usize = 256;
    if text.len() > LONGEST {
        return None;
    }
    let lower = text.to_lowercase();
    names
        .filter(|name| name.len() <= LONGEST)
        .map(|name| (strsim::osa_distance(&lower, &name.to_lowercase()), name))
        .filter(|(distance, name)| 3 * distance <= 2 * name.chars().count().max(lower.chars().count()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_name_and_another_word_none() {
        let names = || ["matrix", "band_hz", "order"].into_iter();
        assert_eq!(nearest("odrer", names()), Some("order"));
        assert_eq!(nearest("Band", names()), Some("band_hz"));
        assert_eq!(nearest("zzz", names()), None);
        assert_eq!(nearest(&"order".repeat(100), names()), None);
    }
}
