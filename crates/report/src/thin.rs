//! Fewer points for curves of many.

/// Rows that show what curves over them look like: all where they are few, else of each of many bins the rows where a curve is smallest and largest,
/// and the first row of each class that is in it. Never more than `most`, which is at least 2.
///
/// `curves` give a value for each row, `None` in a gap; `class` is below `classes`.
pub(crate) fn rows(
    count: usize,
    most: usize,
    curves: &[&dyn Fn(usize) -> Option<f64>],
    classes: usize,
    class: &dyn Fn(usize) -> usize,
) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    // First and last row, and of each bin two for each curve and one for each class, at most.
    let bins = ((most - 2) / (2 * curves.len() + classes).max(1)).max(1);
    let mut kept = Vec::with_capacity(most);
    for bin in 0..bins {
        let range = bin * count / bins..(bin + 1) * count / bins;
        for curve in curves {
            let values =
                || range.clone().filter_map(|row| Some((row, curve(row).filter(|v| v.is_finite())?)));
            kept.extend(values().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(row, _)| row));
            kept.extend(values().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(row, _)| row));
        }
        kept.extend((0..classes).filter_map(|wanted| range.clone().find(|&row| class(row) == wanted)));
    }
    kept.extend([0, count - 1]);
    kept.sort_unstable();
    kept.dedup();
    kept.truncate(most);
    kept
}

/// Every so manieth of `count`, so that there are `most` at most.
pub(crate) fn every(count: usize, most: usize) -> impl Iterator<Item = usize> {
    (0..count).step_by(count.div_ceil(most.max(1)).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn extremes_ends_and_classes_stay(
            values in proptest::collection::vec(proptest::option::of(-1e9..1e9_f64), 1..900),
            most in 30_usize..500,
        ) {
            let class = |row: usize| usize::from(row % 7 == 3);
            let kept = rows(values.len(), most, &[&|row| values[row]], 2, &class);
            prop_assert!(kept.len() <= most && kept.windows(2).all(|pair| pair[0] < pair[1]));
            prop_assert_eq!((kept[0], kept[kept.len() - 1]), (0, values.len() - 1));
            let extremes = |rows: &mut dyn Iterator<Item = usize>| {
                rows.filter_map(|row| values[row])
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
            };
            prop_assert_eq!(extremes(&mut kept.iter().copied()), extremes(&mut (0..values.len())));
            prop_assert_eq!(kept.iter().any(|&row| class(row) == 1), values.len() > 3);
        }

        #[test]
        fn every_so_manieth_is_never_too_many(count in 0_usize..5000, most in 1_usize..700) {
            let kept: Vec<usize> = every(count, most).collect();
            prop_assert!(kept.len() <= most && kept.len() >= count.min(most) / 2);
        }
    }
}
