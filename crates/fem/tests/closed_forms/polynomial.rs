//! Beam and plate elements hold the polynomials that they are made of, exactly.

use super::support::misfit;
use frfit_fem::{beam, plate};
use proptest::prelude::*;

/// Terms (coefficient, power of x, power of y).
type Polynomial = Vec<(f64, i32, i32)>;

fn polynomial(powers: &[(i32, i32)], coefficients: &[f64]) -> Polynomial {
    powers.iter().zip(coefficients).map(|(&(i, j), &c)| (c, i, j)).collect()
}

fn at(f: &Polynomial, x: f64, y: f64) -> f64 {
    f.iter().map(|(c, i, j)| c * x.powi(*i) * y.powi(*j)).sum()
}

fn by_x(f: &Polynomial) -> Polynomial {
    f.iter().filter(|(_, i, _)| *i > 0).map(|(c, i, j)| (c * f64::from(*i), i - 1, *j)).collect()
}

fn by_y(f: &Polynomial) -> Polynomial {
    f.iter().filter(|(_, _, j)| *j > 0).map(|(c, i, j)| (c * f64::from(*j), *i, j - 1)).collect()
}

/// ∫∫ f g over (0, a) × (0, b).
fn inner(f: &Polynomial, g: &Polynomial, [a, b]: [f64; 2]) -> f64 {
    let mut sum = 0.0;
    for (c, i, j) in f {
        for (d, k, l) in g {
            let (p, q) = (i + k + 1, j + l + 1);
            sum += c * d * a.powi(p) / f64::from(p) * b.powi(q) / f64::from(q);
        }
    }
    sum
}

const CUBIC: [(i32, i32); 4] = [(0, 0), (1, 0), (2, 0), (3, 0)];
const TWELVE: [(i32, i32); 12] =
    [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3), (3, 1), (1, 3)];

proptest! {
    /// K is I ∫ u″ v″ dx and M is A ∫ u v dx for any two cubics.
    #[test]
    fn beam_of_cubics(
        u in prop::array::uniform4(-1.0..1.0_f64), v in prop::array::uniform4(-1.0..1.0_f64),
        length in 0.3..3.0_f64, area in 0.1..10.0_f64, inertia in 0.1..10.0_f64,
    ) {
        let [u, v] = [u, v].map(|coefficients| polynomial(&CUBIC, &coefficients));
        let dofs = |f| [at(f, 0.0, 0.0), -at(&by_x(f), 0.0, 0.0), at(f, length, 0.0), -at(&by_x(f), length, 0.0)];
        let element = beam::element(area, inertia, length);
        let over = [length, 1.0];
        let bending = inertia * inner(&by_x(&by_x(&u)), &by_x(&by_x(&v)), over);
        prop_assert!(misfit(&element.stiffness, &dofs(&u), &dofs(&v), bending) < 1e-14);
        prop_assert!(misfit(&element.mass, &dofs(&u), &dofs(&v), area * inner(&u, &v, over)) < 1e-14);
    }

    /// K is D ∫ (Δu Δv − (1−ν)(u,xx v,yy + u,yy v,xx − 2 u,xy v,xy)) dA and M is h ∫ u v dA for any two
    /// polynomials of the twelve terms: all cubics, x³y and xy³.
    #[test]
    fn plate_of_twelve_terms(
        u in prop::array::uniform12(-1.0..1.0_f64), v in prop::array::uniform12(-1.0..1.0_f64),
        sides in prop::array::uniform2(0.3..3.0_f64), thickness in 0.1..1.0_f64, poisson in -0.9..0.49_f64,
    ) {
        let [u, v] = [u, v].map(|coefficients| polynomial(&TWELVE, &coefficients));
        let dofs = |f: &Polynomial| {
            let [a, b] = sides;
            let corners = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]];
            let at_corner = corners.map(|[x, y]| [at(f, x, y), at(&by_y(f), x, y), -at(&by_x(f), x, y)]);
            std::array::from_fn(|i| at_corner[i / 3][i % 3])
        };
        let second = |f: &Polynomial| [by_x(&by_x(f)), by_y(&by_y(f)), by_x(&by_y(f))];
        let ([uxx, uyy, uxy], [vxx, vyy, vxy]) = (second(&u), second(&v));
        let over = |f, g| inner(f, g, sides);
        let bending = over(&uxx, &vxx) + over(&uyy, &vyy) + poisson * (over(&uxx, &vyy) + over(&uyy, &vxx));
        let twisting = 2.0 * (1.0 - poisson) * over(&uxy, &vxy);
        let rigidity = thickness.powi(3) / (12.0 * (1.0 - poisson * poisson));
        let element = plate::element(sides, thickness, poisson);
        // Sixteen points and 144 entries of roundoff.
        prop_assert!(misfit(&element.stiffness, &dofs(&u), &dofs(&v), rigidity * (bending + twisting)) < 1e-13);
        prop_assert!(misfit(&element.mass, &dofs(&u), &dofs(&v), thickness * over(&u, &v)) < 1e-13);
    }
}
