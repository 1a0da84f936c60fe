//! Multi-indices α = (α_1 … α_J) up to a total order, in one row.

/// All α with |α| = α_1 + … + α_J ≤ n, by total order, and within one order with the largest α_1 first, then α_2, and so on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MultiIndices {
    parameters: usize,
    order: usize,
}

impl MultiIndices {
    /// Those of J parameters up to total order n.
    ///
    /// # Panics
    /// Where J is zero.
    pub fn new(parameters: usize, order: usize) -> Self {
        assert!(parameters > 0, "a multi-index of at least one parameter");
        Self { parameters, order }
    }

    /// J.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// n.
    pub fn order(&self) -> usize {
        self.order
    }

    /// How many there are, C(n + J, J).
    pub fn count(&self) -> usize {
        Self::up_to(self.parameters, self.order)
    }

    /// C(k + J, J): how many there are with |α| ≤ k.
    pub(super) fn up_to(parameters: usize, order: usize) -> usize {
        // Each quotient is a binomial itself, hence whole.
        (1..=parameters).fold(1, |count, i| count * (order + i) / i)
    }

    /// All of total order k ≤ n, in their order.
    pub(super) fn of_order(&self, k: usize) -> Vec<Vec<usize>> {
        let mut all = Vec::new();
        compositions(k, self.parameters, &mut Vec::new(), &mut all);
        all
    }

    /// All of them, in their order.
    pub fn all(&self) -> Vec<Vec<usize>> {
        (0..=self.order).flat_map(|k| self.of_order(k)).collect()
    }

    /// Where α is in the row; `None` for |α| > n.
    ///
    /// # Panics
    /// Where α has not one entry for each parameter.
    pub fn position(&self, alpha: &[usize]) -> Option<usize> {
        assert_eq!(alpha.len(), self.parameters, "one entry for each parameter");
        let total: usize = alpha.iter().sum();
        if total > self.order {
            return None;
        }
        let below = total.checked_sub(1).map_or(0, |lower| Self::up_to(self.parameters, lower));
        Some(below + self.within_order(alpha))
    }

    /// Where α is among those of its own total order.
    pub(super) fn within_order(&self, alpha: &[usize]) -> usize {
        let mut left: usize = alpha.iter().sum();
        let mut before = 0;
        // Before α are those that agree up to entry i and have more there: the rest, less by one at least, over what follows, at most all of it.
        for (i, &entry) in alpha.iter().enumerate() {
            let following = self.parameters - i - 1;
            if let (Some(fewer), 1..) = ((left - entry).checked_sub(1), following) {
                before += Self::up_to(following, fewer);
            }
            left -= entry;
        }
        before
    }
}

/// All ways to write `total` as `parts` more entries behind those that are there.
fn compositions(total: usize, parts: usize, there: &mut Vec<usize>, all: &mut Vec<Vec<usize>>) {
    if parts == 1 {
        all.push(there.iter().copied().chain([total]).collect());
        return;
    }
    for first in (0..=total).rev() {
        there.push(first);
        compositions(total - first, parts - 1, there, all);
        there.pop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_those_in_the_row() {
        for (parameters, order) in [(1, 7), (2, 5), (3, 6), (4, 4), (5, 0)] {
            let indices = MultiIndices::new(parameters, order);
            let all = indices.all();
            assert_eq!(all.len(), indices.count());
            for (position, alpha) in all.iter().enumerate() {
                assert_eq!(indices.position(alpha), Some(position), "{alpha:?}");
            }
            let mut beyond = vec![0; parameters];
            beyond[0] = order + 1;
            assert_eq!(indices.position(&beyond), None);
        }
        let two: Vec<Vec<usize>> = MultiIndices::new(2, 2).all();
        assert_eq!(two, [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]]);
        assert_eq!(MultiIndices::new(3, 6).count(), 84);
    }
}
