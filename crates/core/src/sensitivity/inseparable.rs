//! Which parameters the sensors cannot separate.

use super::Resolved;

/// ln p is known where its standard deviation is below this: the measure by which identified factors are `not_identifiable`.
pub const KNOWN_LN_STD: f64 = 0.3;

/// Correlation in the unknown directions above which two variables belong together.
const GROUP_CORRELATION: f64 = 0.1;

/// Variables of which some combinations are not known, and none of which can be left out of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Inseparable {
    /// Which variables, ascending.
    pub variables: Vec<usize>,
    /// How many independent combinations of them are not known.
    pub unknown: usize,
    /// The one that is known least, as coefficients of ln p of [`Self::variables`], the largest ±1.
    pub direction: Vec<f64>,
    /// Its standard deviation; `None` where nothing is seen of it.
    pub std: Option<f64>,
}

/// Groups of variables that are not known each for itself, as the directions whose standard deviation is above [`KNOWN_LN_STD`] tie them together; a group of one is
/// a variable of which the sensors see too little.
///
/// With Q the projector on these directions, weighed by their variances, p and q are in one group where |Q_pq| is more than a tenth of √(Q_pp Q_qq).
pub fn inseparable(resolved: &Resolved) -> Vec<Inseparable> {
    let count = resolved.variables();
    // Nothing seen counts as a million standard deviations: it outweighs all else, and is finite.
    let weak: Vec<(&[f64], f64)> = resolved
        .combinations()
        .map(|(v, std)| (v, std.unwrap_or(f64::INFINITY)))
        .filter(|(_, std)| *std > KNOWN_LN_STD)
        .map(|(v, std)| (v, std.min(1e6)))
        .collect();
    let q = |a: usize, b: usize| weak.iter().map(|(v, std)| v[a] * v[b] * std * std).sum::<f64>();
    let involved: Vec<usize> = (0..count).filter(|&p| q(p, p).sqrt() > KNOWN_LN_STD).collect();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for &p in &involved {
        let tied = |group: &Vec<usize>| {
            group
                .iter()
                .any(|&other| q(p, other).abs() > GROUP_CORRELATION * (q(p, p) * q(other, other)).sqrt())
        };
        let (with, without): (Vec<_>, Vec<_>) = groups.into_iter().partition(tied);
        groups = without;
        groups.push(with.into_iter().flatten().chain([p]).collect());
    }
    let mut found: Vec<Inseparable> =
        groups.into_iter().map(|group| described(resolved, group, &weak)).collect();
    found.sort_by_key(|group| group.variables[0]);
    found
}

fn described(resolved: &Resolved, mut group: Vec<usize>, weak: &[(&[f64], f64)]) -> Inseparable {
    group.sort_unstable();
    let share = |v: &[f64]| group.iter().map(|&p| v[p] * v[p]).sum::<f64>();
    // Directions of several groups with equal standard deviations may come mixed: their shares add up to whole numbers.
    let unknown = (weak.iter().map(|(v, _)| share(v)).sum::<f64>().round() as usize).max(1);
    let mut direction = vec![0.0; group.len()];
    let own = weak.iter().filter(|(v, _)| share(v) > 0.5);
    if let Some((v, _)) = own.max_by(|a, b| a.1.total_cmp(&b.1)) {
        let largest =
            group.iter().map(|&p| v[p]).fold(0.0, |l: f64, x| if x.abs() > l.abs() { x } else { l });
        direction.iter_mut().zip(&group).for_each(|(d, &p)| *d = v[p] / largest);
    }
    let mut whole = vec![0.0; resolved.variables()];
    group.iter().zip(&direction).for_each(|(&p, d)| whole[p] = *d);
    Inseparable { std: resolved.std(&whole), variables: group, unknown, direction }
}
