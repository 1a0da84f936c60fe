//! Points that fill a box evenly, one after the other.

/// A base for each dimension; they repeat beyond.
const PRIMES: [usize; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// The k-th point, counted from 1, of the unit box of any number of dimensions, coordinate after coordinate.
///
/// # Source
/// J. H. Halton, Numer. Math. 2 (1960) 84–90.
pub(crate) fn point(k: usize) -> impl Iterator<Item = f64> {
    PRIMES.iter().cycle().map(move |&base| radical_inverse(k, base))
}

/// The digits of k in a base, mirrored at the point.
fn radical_inverse(mut k: usize, base: usize) -> f64 {
    let (mut value, mut place) = (0.0, 1.0 / base as f64);
    while k > 0 {
        value += (k % base) as f64 * place;
        k /= base;
        place /= base as f64;
    }
    value
}
