//! Small models for the tests of this crate.
#![allow(dead_code, reason = "each test file uses its own part")]

use frfit::c64;
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Member, Parameter, Role, Sensor, Term};
use frfit::response::{FullModel, Response};
use frfit_linalg::sparse::{Pattern, SymmetricMatrix, Triplets, Values};
use std::sync::Arc;

pub(crate) fn c(re: f64, im: f64) -> c64 {
    c64::new(re, im)
}

pub(crate) fn term(name: &str, role: Role, matrix: SymmetricMatrix, factor: c64) -> Term {
    Term { name: name.to_owned(), role, matrix, factor: Law::Constant(factor) }
}

/// Clamped–free chain of n unit masses and unit springs: `stiffness` × K and `mass` × M.
pub(crate) fn chain(n: usize, stiffness: c64, mass: f64) -> DynamicStiffness {
    let (mut k, mut m) = (Triplets::new(n), Triplets::new(n));
    k.add(0, 0, 1.0);
    for i in 0..n {
        m.add(i, i, 1.0);
        if i + 1 < n {
            k.add_element(&[Some(i), Some(i + 1)], &[1.0, -1.0, -1.0, 1.0]);
        }
    }
    DynamicStiffness::new(vec![
        term("springs", Role::Stiffness, k.assemble(), stiffness),
        term("masses", Role::Mass, m.assemble(), c(mass, 0.0)),
    ])
    .unwrap()
}

/// Unit force on the last row, measured at the given rows.
pub(crate) fn tip_load(model: &DynamicStiffness, rows: &[usize]) -> Experiment {
    let sensor = |row| Sensor { row, sign: 1.0 };
    Experiment::driven_at(model.dim(), sensor(model.dim() - 1), rows.iter().copied().map(sensor).collect())
}

/// Full symmetric n × n matrix from the values of its lower triangle, repeated as needed.
pub(crate) fn full(n: usize, values: &[c64]) -> SymmetricMatrix {
    let pattern = Arc::new(Pattern::new(n, (0..n).flat_map(|i| (0..i).map(move |j| (i, j)))));
    let values = (0..pattern.stored()).map(|k| values[k % values.len()]).collect();
    SymmetricMatrix::new(pattern, Values::Complex(values))
}

/// All of one term's factor, to the given power.
pub(crate) fn unknown(term: usize, power: usize, nominal: c64) -> Parameter {
    Parameter { members: vec![Member { term, power }], nominal: Law::Constant(nominal) }
}

/// Taylor coefficients times r^k, k = 0 … `count` − 1, at sensor `m`: Cauchy's integral on the circle |c| = r, by direct
/// solves alone (J. N. Lyness, C. B. Moler, SIAM J. Numer. Anal. 4 (1967) 202–210).
pub(crate) fn taylor_on_circle(system: &FullModel<'_>, r: f64, count: usize, m: usize) -> Vec<c64> {
    // Aliasing falls like (r/R)^points; the callers take r well inside the radius R.
    let points = 128;
    let angle = |i: usize| std::f64::consts::TAU * (i % points) as f64 / points as f64;
    let values: Vec<c64> =
        (0..points).map(|i| system.solve_at(&[c64::from_polar(r, angle(i))]).unwrap()[m]).collect();
    (0..count)
        .map(|k| {
            let sum: c64 =
                values.iter().enumerate().map(|(i, x)| x * c64::from_polar(1.0, -angle(i * k))).sum();
            sum / points as f64
        })
        .collect()
}
