//! Mixed derivatives in several parameters against Cramer's rule in exact arithmetic, one-parameter series and direct solves.

use crate::common;

use common::{c, chain, full, sandwich, term, tip_load, unknown};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::model::{DynamicStiffness, Experiment, Member, Parameter, Role, Sensor};
use frfit::response::{FullModel, Response, Work};
use frfit::series::{Along, MixedSeries, MultiIndices, NeumannSeries, convergence_radius};
use frfit::subspace::{Point, Subspace, TrainOptions};
use frfit_linalg::solve::Breakdown;
use num_bigint::BigInt;
use num_complex::Complex;
use num_rational::BigRational;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

type Exact = Complex<BigRational>;

/// A polynomial in three corrections over the complex rationals, cut off beyond total order [`ORDER`].
#[derive(Clone, Default)]
struct Polynomial(BTreeMap<[usize; 3], Exact>);

const ORDER: usize = 6;

fn exact(value: c64) -> Exact {
    let part = |x: f64| BigRational::from_float(x).unwrap();
    Exact::new(part(value.re), part(value.im))
}

fn zero() -> Exact {
    exact(c(0.0, 0.0))
}

fn rounded(value: &Exact) -> c64 {
    // Numerator and denominator have hundreds of digits: keep a few hundred bits of the quotient.
    let part = |x: &BigRational| {
        let scaled: BigInt = (x.numer() << 600u32) / x.denom();
        scaled.to_string().parse::<f64>().unwrap() / 2f64.powi(600)
    };
    c(part(&value.re), part(&value.im))
}

impl Polynomial {
    fn constant(value: c64) -> Self {
        Self(BTreeMap::from([([0; 3], exact(value))]))
    }

    /// nominal + c_j.
    fn factor(nominal: c64, j: usize) -> Self {
        let mut alpha = [0; 3];
        alpha[j] = 1;
        Self(BTreeMap::from([([0; 3], exact(nominal)), (alpha, exact(c(1.0, 0.0)))]))
    }

    fn add(&mut self, sign: f64, other: &Self) {
        for (alpha, value) in &other.0 {
            let sum = self.0.entry(*alpha).or_insert_with(zero);
            *sum = sum.clone() + value.clone() * exact(c(sign, 0.0));
        }
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::default();
        for (a, x) in &self.0 {
            for (b, y) in &other.0 {
                let sum: [usize; 3] = std::array::from_fn(|j| a[j] + b[j]);
                if sum.iter().sum::<usize>() <= ORDER {
                    let entry = product.0.entry(sum).or_insert_with(zero);
                    *entry = entry.clone() + x.clone() * y.clone();
                }
            }
        }
        product
    }

    /// The power series of this over another, whose constant term is not zero.
    fn over(&self, other: &Self) -> Self {
        let leading = other.0[&[0; 3]].clone();
        let mut quotient = Self::default();
        for alpha in MultiIndices::new(3, ORDER).all() {
            let alpha: [usize; 3] = alpha.try_into().unwrap();
            let mut rest = self.0.get(&alpha).cloned().unwrap_or_else(zero);
            for (beta, d) in other.0.iter().filter(|(beta, _)| **beta != [0; 3]) {
                let before: Option<Vec<usize>> = (0..3).map(|j| alpha[j].checked_sub(beta[j])).collect();
                if let Some(before) = before {
                    let before: [usize; 3] = before.try_into().unwrap();
                    rest -= d.clone() * quotient.0[&before].clone();
                }
            }
            quotient.0.insert(alpha, rest / leading.clone());
        }
        quotient
    }
}

/// By expansion along the first column: no division.
fn determinant(matrix: &[Vec<Polynomial>]) -> Polynomial {
    let [_, ..] = matrix else { return Polynomial::constant(c(1.0, 0.0)) };
    let mut sum = Polynomial::default();
    for (i, row) in matrix.iter().enumerate() {
        let others = matrix.iter().enumerate().filter(|&(k, _)| k != i);
        let minor: Vec<Vec<Polynomial>> = others.map(|(_, row)| row[1..].to_vec()).collect();
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        sum.add(sign, &row[0].times(&determinant(&minor)));
    }
    sum
}

/// Bending and membrane of a plate with a thickness of its own, a complex modulus, a support that is nominally absent.
fn three_parameters(n: usize) -> (DynamicStiffness, [Parameter; 3]) {
    let whole = |seed: usize, complex: bool| -> Vec<c64> {
        let part = |k: usize| (k % 11) as f64 - 5.0;
        let value = |k: usize| c(part(k * k + seed), if complex { part(k * 7 + 3 * seed) } else { 0.0 });
        (0..n * (n + 1) / 2).map(value).collect()
    };
    let one = c(1.0, 0.0);
    let mut fixed = whole(1, true);
    // The diagonal is what keeps the nominal system well posed.
    let mut at = 0;
    for row in (1..=n).rev() {
        fixed[at] += c(30.0, 9.0);
        at += row;
    }
    let model = DynamicStiffness::new(vec![
        term("fixed", Role::Stiffness, full(n, &fixed), one),
        term("bending", Role::Stiffness, full(n, &whole(3, false)), one),
        term("membrane", Role::Stiffness, full(n, &whole(5, false)), one),
        term("core", Role::Stiffness, full(n, &whole(2, true)), one),
        term("support", Role::Stiffness, full(n, &whole(8, false)), one),
    ])
    .unwrap();
    let thickness = Parameter {
        members: vec![Member { term: 1, power: 3 }, Member { term: 2, power: 1 }],
        ..unknown(1, 3, c(1.25, 0.0))
    };
    let parameters = [thickness, unknown(3, 1, c(0.5, 0.25)), unknown(4, 1, c(0.0, 0.0))];
    (model, parameters)
}

#[test]
fn mixed_derivatives_to_order_six_equal_cramers_rule_without_rounding() {
    let n = 4;
    let (model, parameters) = three_parameters(n);
    let experiment = tip_load(&model, &[0, 2, 3]);
    let system = FullModel::new(model.at(1.0, &parameters).unwrap(), &experiment).unwrap();
    let series = MixedSeries::new(&system, 3, ORDER).unwrap();
    // D(c) as it is written, each power by multiplication: neither binomials nor a recursion.
    let h = Polynomial::factor(c(1.25, 0.0), 0);
    let weights = [
        Polynomial::constant(c(1.0, 0.0)),
        h.times(&h).times(&h),
        h,
        Polynomial::factor(c(0.5, 0.25), 1),
        Polynomial::factor(c(0.0, 0.0), 2),
    ];
    let entry = |i: usize, j: usize| {
        let mut sum = Polynomial::default();
        for (term, weight) in model.terms().iter().zip(&weights) {
            sum.add(1.0, &weight.times(&Polynomial::constant(term.matrix.get(i, j))));
        }
        sum
    };
    let matrix: Vec<Vec<Polynomial>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    let denominator = determinant(&matrix);
    for (sensor, row) in [0usize, 2, 3].into_iter().enumerate() {
        let mut replaced = matrix.clone();
        for (i, entries) in replaced.iter_mut().enumerate() {
            entries[row] = Polynomial::constant(experiment.load[i]);
        }
        let solution = determinant(&replaced).over(&denominator);
        for alpha in MultiIndices::new(3, ORDER).all() {
            let key: [usize; 3] = alpha.clone().try_into().unwrap();
            let factorial: f64 = alpha.iter().flat_map(|&a| 1..=a).map(|i| i as f64).product();
            let expected = rounded(&solution.0[&key]) * factorial;
            let found = series.derivative(&alpha).unwrap()[sensor];
            // Seven solves in a row, each of condition below a hundred, leave some 1e-13; 1e-9 is what is asked for.
            let relative = (found - expected).norm() / expected.norm();
            assert!(relative < 1e-11, "{alpha:?} at {row}: {found} against {expected}, {relative:e}");
        }
    }
    assert_eq!(series.derivative(&[3, 3, 1]), None);
}

/// A system that counts its products.
struct Counting<'a> {
    system: FullModel<'a>,
    products: AtomicUsize,
}

impl Response for Counting<'_> {
    fn frequency_hz(&self) -> f64 {
        self.system.frequency_hz()
    }
    fn dim(&self) -> usize {
        self.system.dim()
    }
    fn sensors(&self) -> usize {
        self.system.sensors()
    }
    fn nominal(&self, parameter: usize) -> c64 {
        self.system.nominal(parameter)
    }
    fn degree(&self, parameter: usize) -> usize {
        self.system.degree(parameter)
    }
    fn load(&self) -> &[c64] {
        self.system.load()
    }
    fn solve_nominal(&self, x: &mut [c64]) -> Result<(), Breakdown> {
        self.system.solve_nominal(x)
    }
    fn solve_nominal_block(&self, block: &mut [c64]) -> Result<(), Breakdown> {
        self.system.solve_nominal_block(block)
    }
    fn multiply_add(&self, parameter: usize, power: usize, factor: c64, x: &[c64], out: &mut [c64]) {
        self.products.fetch_add(1, Ordering::Relaxed);
        self.system.multiply_add(parameter, power, factor, x, out);
    }
    fn observe(&self, x: &[c64]) -> Vec<c64> {
        self.system.observe(x)
    }
    fn solve_at(&self, corrections: &[c64]) -> Result<Vec<c64>, Breakdown> {
        self.system.solve_at(corrections)
    }
    fn work(&self) -> Work {
        self.system.work()
    }
}

#[test]
fn work_is_one_factorisation_one_solve_a_multi_index_and_each_product_once() {
    let (model, mut parameters) = three_parameters(5);
    // Nominally there, so that no solve is spent on its scale.
    parameters[2] = unknown(4, 1, c(0.1, 0.0));
    let experiment = tip_load(&model, &[0, 4]);
    let system = FullModel::new(model.at(1.0, &parameters).unwrap(), &experiment).unwrap();
    let counting = Counting { system, products: AtomicUsize::new(0) };
    MixedSeries::new(&counting, 3, 6).unwrap();
    // C(9, 3) = 84.
    assert_eq!(counting.work(), Work { factorisations: 1, solves: 84 });
    // Σ_j Σ_q C(6 − q + 3, 3): 56 + 35 + 20 of the thickness, 56 of each modulus.
    assert_eq!(counting.products.into_inner(), 56 + 35 + 20 + 56 + 56);
}

#[test]
fn one_parameter_is_the_neumann_series_to_the_last_bit() {
    let model = chain(60, c(1e4, 500.0), 1.0);
    let experiment = tip_load(&model, &[59, 3]);
    let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
    let system = FullModel::new(model.at(3.0, &[parameter]).unwrap(), &experiment).unwrap();
    let (one, mixed) =
        (NeumannSeries::new(&system, 0, 20).unwrap(), MixedSeries::new(&system, 1, 20).unwrap());
    let change = c(300.0, 70.0);
    for sensor in 0..2 {
        assert_eq!(one.coefficients(sensor), mixed.coefficients(sensor));
        assert_eq!(one.respond(change, 15)[sensor], mixed.respond(&[change], 15)[sensor]);
        assert_eq!(one.derivative(7).unwrap()[sensor], mixed.derivative(&[7]).unwrap()[sensor]);
    }
    // With a power too (B-8), and on the dense back-end.
    let (model, parameters) = three_parameters(5);
    let experiment = tip_load(&model, &[1]);
    let system = FullModel::new(model.at(1.0, &parameters[..1]).unwrap(), &experiment).unwrap();
    let (one, mixed) =
        (NeumannSeries::new(&system, 0, 12).unwrap(), MixedSeries::new(&system, 1, 12).unwrap());
    assert_eq!(one.coefficients(0), mixed.coefficients(0));
}

/// Skins, core and the core's density of a sandwich.
fn sandwich_parameters(model: &DynamicStiffness) -> [Parameter; 3] {
    ["core", "skins", "core-mass"].map(|name| Parameter::factor_of(model, &[name]).unwrap())
}

#[test]
fn full_and_reduced_model_agree_and_so_does_a_direct_solve() {
    let case = sandwich(8, 2);
    let parameters = sandwich_parameters(&case.model);
    let frequency_hz = 330.0;
    let at = case.model.at(frequency_hz, &parameters).unwrap();
    let system = FullModel::new(at.clone(), &case.experiment).unwrap();
    let nominal: Vec<c64> = (0..3).map(|j| system.nominal(j)).collect();
    let direction: Vec<c64> = vec![nominal[0] * c(0.5, 0.1), nominal[1] * c(-0.3, 0.02), nominal[2] * 0.4];
    let along = Along::new(&system, &direction);
    let radius = convergence_radius(&along, 0).unwrap();
    let t = 0.2 / radius.per_unit;
    let corrections: Vec<c64> = direction.iter().map(|d| d * t).collect();

    // Trained at corners of a box about the nominal values, which is where the derivatives are taken of.
    let mut subspace = Subspace::new(&case.experiment, &at).unwrap();
    let corner = |signs: [f64; 3]| {
        let mut moved = parameters.clone();
        for ((parameter, sign), correction) in moved.iter_mut().zip(signs).zip(&corrections) {
            let value = parameter.nominal.at(frequency_hz).unwrap() + correction * sign;
            parameter.nominal = frfit::material::Law::Constant(value);
        }
        Point { at: case.model.at(frequency_hz, &moved).unwrap(), correction: c64::default() }
    };
    let signs = [-1.0, 0.0, 1.0];
    let all = signs.into_iter().flat_map(|a| signs.into_iter().map(move |b| (a, b)));
    let points: Vec<Point<'_>> =
        all.flat_map(|(a, b)| signs.into_iter().map(move |c| [a, b, c])).map(corner).collect();
    let options = TrainOptions::default().with_tolerance(1e-10);
    assert!(subspace.train(&points, &options, &sequential).unwrap().converged);
    let reduced = subspace.projection().at(&at).unwrap();

    let assessed = subspace.projection().assess(&at, c64::default()).unwrap();
    let (whole, small) =
        (MixedSeries::new(&system, 3, 12).unwrap(), MixedSeries::new(&reduced, 3, 12).unwrap());
    let exact = system.solve_at(&corrections).unwrap();
    for (sensor, &exact) in exact.iter().enumerate() {
        let found = whole.respond(&corrections, 12)[sensor];
        // 0.2^13 = 8e-10 of the largest term is cut off; roundoff where metal and rubber meet was seen up to 1.2e-8.
        assert!((found - exact).norm() < 4e-8 * exact.norm(), "{found} {}", exact);
        // Order by order on the size of the correction, to what the subspace was trained to and what roundoff leaves where metal and rubber meet.
        let (a, b) = (whole.along(sensor, &corrections), small.along(sensor, &corrections));
        let left = 1e-10 * a[0].norm() + assessed.error(sensor);
        for (k, (a, b)) in a.iter().zip(&b).enumerate() {
            assert!((a - b).norm() < left, "order {k}: {a} against {b}, {left:e}");
        }
    }
}

#[test]
fn radius_along_a_direction_is_the_distance_to_the_nearest_pole() {
    // (E + t E′) λ = (ρ + t ρ′) ω² with the eigenvalues λ of the clamped–free chain.
    let (n, e, rho, f) = (40, c(1e4, 300.0), c(1.3, 0.0), 5.0);
    let model = chain(n, e, rho.re);
    let experiment = tip_load(&model, &[0]);
    let parameters = ["springs", "masses"].map(|name| Parameter::factor_of(&model, &[name]).unwrap());
    let system = FullModel::new(model.at(f, &parameters).unwrap(), &experiment).unwrap();
    let direction = [c(700.0, 40.0), c(-0.2, 0.0)];
    let omega2 = (std::f64::consts::TAU * f).powi(2);
    let distance = (1..=n)
        .map(|j| 4.0 * ((2 * j - 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64).sin().powi(2))
        .map(|lambda| ((e * lambda - rho * omega2) / (direction[1] * omega2 - direction[0] * lambda)).norm())
        .fold(f64::INFINITY, f64::min);
    let along = Along::new(&system, &direction);
    let radius = convergence_radius(&along, 0).unwrap();
    // The residual is below 1e-4, and the eigenvalue's error of the order of its square.
    assert!(radius.converged && (radius.per_unit * distance - 1.0).abs() < 1e-6);
    // A direction along one parameter is that parameter.
    let alone = convergence_radius(&Along::new(&system, &[c(1.0, 0.0), c64::default()]), 0).unwrap();
    let springs = convergence_radius(&system, 0).unwrap();
    assert!((alone.per_unit / springs.per_unit - 1.0).abs() < 1e-6);
}

/// A random model with a diagonal that dominates, and three parameters of the given powers.
fn random(n: usize, powers: [usize; 3], values: &[(f64, f64)]) -> (DynamicStiffness, [Parameter; 3]) {
    let number = |k: usize| c(values[k % values.len()].0, values[k % values.len()].1);
    let mut diagonal = frfit_linalg::sparse::Triplets::new(n);
    (0..n).for_each(|i| diagonal.add(i, i, 12.0));
    let matrix = |first: usize| full(n, &(first..first + 21).map(number).collect::<Vec<_>>());
    let one = c(1.0, 0.0);
    let model = DynamicStiffness::new(vec![
        term("dominant", Role::Stiffness, diagonal.assemble(), one),
        term("fixed", Role::Stiffness, matrix(0), one),
        term("a", Role::Stiffness, matrix(21), one),
        term("b", Role::Stiffness, matrix(42), one),
        term("c", Role::Stiffness, matrix(63), one),
    ])
    .unwrap();
    let nominal = [c(0.4, 0.1), c(0.7, -0.2), c(0.3, 0.0)];
    let parameters = std::array::from_fn(|j| unknown(j + 2, powers[j], nominal[j]));
    (model, parameters)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Parameters in another order have the same derivatives, in that order.
    #[test]
    fn order_of_the_parameters_is_of_no_matter(
        n in 2usize..7,
        powers in prop::array::uniform3(1usize..4),
        turn in 1usize..3,
        values in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 84),
    ) {
        let (model, parameters) = random(n, powers, &values);
        let experiment = Experiment::driven_at(
            n, Sensor { row: 0, sign: 1.0 }, vec![Sensor { row: n - 1, sign: -1.0 }]);
        let at = |order: [usize; 3]| {
            let parameters = order.map(|j| parameters[j].clone());
            let system = FullModel::new(model.at(1.0, &parameters).unwrap(), &experiment).unwrap();
            MixedSeries::new(&system, 3, 5).unwrap()
        };
        let order: [usize; 3] = std::array::from_fn(|j| (j + turn) % 3);
        let (straight, turned) = (at([0, 1, 2]), at(order));
        let size = straight.coefficients(0).iter().map(|t| t.norm()).fold(0.0, f64::max);
        for (k, alpha) in straight.indices().all().iter().enumerate() {
            let there = turned.indices().position(&order.map(|j| alpha[j])).unwrap();
            let (a, b) = (straight.coefficients(0)[k], turned.coefficients(0)[there]);
            // Sums of a few terms in another order.
            prop_assert!((a - b).norm() < 1e-13 * size, "{:?}: {} against {}", alpha, a, b);
        }
    }

    /// In a direction the series is that of one parameter with the combined matrices.
    #[test]
    fn a_direction_is_one_parameter(
        n in 2usize..7,
        powers in prop::array::uniform3(1usize..4),
        direction in prop::array::uniform3((-0.5f64..0.5, -0.5f64..0.5)),
        values in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 84),
    ) {
        let (model, parameters) = random(n, powers, &values);
        let experiment = Experiment::driven_at(
            n, Sensor { row: 0, sign: 1.0 }, vec![Sensor { row: n - 1, sign: -1.0 }]);
        let system = FullModel::new(model.at(1.0, &parameters).unwrap(), &experiment).unwrap();
        let direction = direction.map(|(re, im)| c(re, im));
        let mixed = MixedSeries::new(&system, 3, 6).unwrap().along(0, &direction);
        let one = NeumannSeries::new(&Along::new(&system, &direction), 0, 6).unwrap();
        let exact = system.solve_at(&direction.map(|d| d * 1e-2)).unwrap()[0];
        let sum = mixed.iter().rev().fold(c64::default(), |sum, a| sum * 1e-2 + a);
        // The seventh term is below 1e-14 of the response.
        prop_assert!((sum - exact).norm() < 1e-12 * mixed[0].norm());
        let size = mixed.iter().map(|a| a.norm()).fold(0.0, f64::max);
        for (k, a) in mixed.iter().enumerate() {
            let b = one.coefficients(0)[k] / one.scale().powi(k as i32);
            prop_assert!((a - b).norm() < 1e-12 * size, "order {}: {} against {}", k, a, b);
        }
    }
}
