//! How much two responses, or two sets of shapes, have in common.
//!
//! # Source
//! R. J. Allemang, D. L. Brown, Proc. IMAC 1 (1982) 110–116 (MAC); N. A. J. Lieven, D. J. Ewins, Proc. IMAC 6 (1988) 690–695 (COMAC);
//! W. Heylen, S. Lammens, Proc. Int. Conf. on Identification in Engineering Systems, Swansea 1996 (FRAC); H. Grafe, thesis, Imperial College London 1998 (CSAC and CSF).

use crate::c64;
use frfit_linalg::vector::dot;

/// |xᴴy|²/(xᴴx · yᴴy): the modal assurance criterion of two shapes, FRAC of two responses over frequency, CSAC of the sensors at one frequency.
/// One where they are proportional; `None` where one of them is zero.
pub fn assurance(x: &[c64], y: &[c64]) -> Option<f64> {
    let size = dot(x, x).re * dot(y, y).re;
    (size > 0.0).then(|| dot(x, y).norm_sqr() / size)
}

/// 2|xᴴy|/(xᴴx + yᴴy), the cross signature scale factor: one only where the sizes agree too. `None` where both are zero.
pub fn scale_assurance(x: &[c64], y: &[c64]) -> Option<f64> {
    let size = dot(x, x).re + dot(y, y).re;
    (size > 0.0).then(|| 2.0 * dot(x, y).norm() / size)
}

/// (Σ_r |x_r y_r|)²/(Σ|x_r|² Σ|y_r|²) of one sensor over all paired modes, the coordinate assurance: small where a sensor is wrong.
/// Shapes are to be of one size in both sets. `None` where one has a node there in all modes.
pub fn coordinate_assurance(x: &[c64], y: &[c64]) -> Option<f64> {
    let of = |values: &[c64]| values.iter().map(|v| v.norm_sqr()).sum::<f64>();
    let both: f64 = x.iter().zip(y).map(|(x, y)| x.norm() * y.norm()).sum();
    let size = of(x) * of(y);
    (size > 0.0).then(|| both * both / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_proportional_has_everything_in_common() {
        let x = [c64::new(1.0, 2.0), c64::new(-0.5, 0.1)];
        let twice: Vec<c64> = x.iter().map(|x| x * c64::new(0.0, 2.0)).collect();
        assert!((assurance(&x, &twice).unwrap() - 1.0).abs() < 1e-15);
        assert!((scale_assurance(&x, &twice).unwrap() - 0.8).abs() < 1e-15);
        assert!((coordinate_assurance(&x, &twice).unwrap() - 1.0).abs() < 1e-15);
        let other = [x[1].conj(), -x[0].conj()];
        assert!(assurance(&x, &other).unwrap() < 1e-30);
        assert_eq!(assurance(&x, &[c64::default(); 2]), None);
    }
}
