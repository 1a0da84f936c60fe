//! Natural cubic splines with knots at equal distances.

/// Second derivatives, in units of the knots' distance, of the natural spline that is one at the k-th of n knots.
pub(super) fn bends(n: usize, k: usize) -> Vec<f64> {
    let value = |i: usize| if i == k { 1.0 } else { 0.0 };
    // M_{i−1} + 4M_i + M_{i+1} = 6(y_{i−1} − 2y_i + y_{i+1}), M = 0 at the ends (Thomas's elimination).
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    for i in 1..n - 1 {
        let rest = 6.0 * (value(i - 1) - 2.0 * value(i) + value(i + 1));
        let pivot = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot;
        right[i] = (rest - right[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        right[i] -= upper[i] * right[i + 1];
    }
    right
}
