//! A smaller model for a few neighbouring frequencies, from the band's.

use super::assess::AssessedSolution;
use super::{Assessment, Point, Projection};
use crate::c64;
use crate::model::ModelAt;
use frfit_linalg::column_block::times_transpose;
use frfit_linalg::dense::symmetric_eigen;
use frfit_linalg::vector::{norm, transpose_dot};

/// Below this part of itself a direction is roundoff of those there are.
const LOCAL_DIRECTION_RTOL: f64 = 1e-12;

/// A compressed model of more than this fraction of the size saves nothing.
const MAX_COMPRESSED_SHARE: f64 = 0.6;

/// Of the solutions of many sensors the directions are left out in which all of them, of unit length, have less than this times √(tolerance): what x and z_m lack is of
/// second order in the response.
const LEFT_OUT_OVER_ROOT_OF_TOL: f64 = 3e-3;

/// A local error of this many times the band's own is the band's.
const MAX_LOCAL_ERROR_RATIO: f64 = 3.0;

impl Projection {
    /// This model on the span of its own solutions at some of the points, as many as bring the estimated error at all of them under the tolerance, or
    /// near this model's own: a neighbourhood needs fewer vectors than a band. The same model where that is not so.
    ///
    /// # Limits
    /// Its [`Projection::assess`] estimates errors of the full model, not of this one.
    pub fn localised(&self, points: &[Point<'_>], tolerance: f64) -> Self {
        self.localised_with(points, tolerance, &[]).map_or_else(|| self.clone(), |(local, _)| local)
    }

    /// The same with some vectors in the span, and the coordinates W (r × q, column after column) of its basis VW; `None` where it would be no smaller.
    pub(super) fn localised_with(
        &self,
        points: &[Point<'_>],
        tolerance: f64,
        vectors: &[Vec<f64>],
    ) -> Option<(Self, Vec<f64>)> {
        let mut directions = orthonormal(vectors);
        let mut done = vec![false; points.len()];
        let all: Vec<usize> = (0..points.len()).collect();
        let mut watched = all.clone();
        // Ends and middle first; then where it is worst.
        let mut next: Vec<(usize, f64)> =
            [0, points.len() / 2, points.len().saturating_sub(1)].map(|i| (i, f64::INFINITY)).into();
        loop {
            for (i, error) in next.drain(..).filter(|&(i, _)| i < points.len()) {
                let point = &points[i];
                if !std::mem::replace(&mut done[i], true)
                    && let Ok(solved) = AssessedSolution::new(self, &point.at, point.correction)
                    && error > MAX_LOCAL_ERROR_RATIO * relative(&solved.assessment, point)
                {
                    solved.solutions.iter().for_each(|y| append(&mut directions, y));
                }
            }
            if directions.is_empty() || self.saves_nothing(&directions) {
                return None;
            }
            let basis = directions.concat();
            let local = self.compressed(&basis);
            let error = |i: usize| {
                let assessed = local.assess(&points[i].at, points[i].correction);
                assessed.map_or(f64::INFINITY, |assessed| relative(&assessed, &points[i]))
            };
            let lacking = |of: &[usize]| -> Vec<(usize, f64)> {
                let rest = of.iter().filter(|&&i| !done[i]).map(|&i| (i, error(i)));
                rest.filter(|(_, error)| *error > tolerance).collect()
            };
            // Those that were good are, most of them: all are looked at when no other is left.
            let mut bad = lacking(&watched);
            if bad.is_empty() {
                bad = lacking(&all);
            }
            match bad.iter().max_by(|a, b| a.1.total_cmp(&b.1)) {
                Some(&worst) => next.push(worst),
                None => return Some((local, basis)),
            }
            watched = bad.into_iter().map(|(i, _)| i).collect();
        }
    }

    /// As [`Self::localised_with`], for many sensors: their solutions at all points differ little, and the principal directions are far fewer.
    pub(super) fn localised_by_principal_directions(
        &self,
        points: &[Point<'_>],
        tolerance: f64,
        vectors: &[Vec<f64>],
    ) -> Option<(Self, Vec<f64>)> {
        let mut directions = orthonormal(vectors);
        let solved = |point: &Point<'_>| AssessedSolution::new(self, &point.at, point.correction).ok();
        let solved: Vec<AssessedSolution> = points.iter().map(solved).collect::<Option<_>>()?;
        let mut parts = Vec::new();
        for y in solved.iter().flat_map(|solved| &solved.solutions) {
            let length = norm(y);
            for part in [|y: &c64| y.re, |y: &c64| y.im] {
                let mut x: Vec<f64> = y.iter().map(|y| part(y) / length).collect();
                take_out(&mut x, &directions);
                parts.extend(x);
            }
        }
        let (values, vectors) = symmetric_eigen(self.size, &times_transpose(&parts, self.size)).ok()?;
        let left_out = LEFT_OUT_OVER_ROOT_OF_TOL.powi(2) * tolerance;
        let principal = vectors.chunks_exact(self.size).zip(values).rev();
        for (direction, _) in principal.take_while(|(_, value)| *value > left_out) {
            append_real(&mut directions, direction.to_vec());
        }
        if self.saves_nothing(&directions) {
            return None;
        }
        let basis = directions.concat();
        let local = self.compressed(&basis);
        let is_good = |(point, own): (&Point<'_>, &AssessedSolution)| {
            let most = tolerance.max(MAX_LOCAL_ERROR_RATIO * relative(&own.assessment, point));
            local.assess(&point.at, point.correction).is_ok_and(|local| relative(&local, point) <= most)
        };
        points.iter().zip(&solved).all(is_good).then_some((local, basis))
    }

    /// Whether a model of some directions would save nothing.
    fn saves_nothing(&self, directions: &[Vec<f64>]) -> bool {
        directions.len() as f64 > MAX_COMPRESSED_SHARE * self.size as f64
    }

    /// This model on the span of x, of every sensor's z_m and of their slopes by every parameter at the nominal values: response and slopes are exact there, and since residuals of
    /// x and of z_m are of second order, what they are off nearby is of fourth. `None` where the system is singular, where nothing responds, or where no vector would be saved.
    pub fn about(&self, at: &ModelAt<'_>) -> Option<Self> {
        let solutions = self.solutions_with_slopes(at).ok()?;
        let mut directions = Vec::new();
        for y in &solutions {
            append(&mut directions, y);
            if self.saves_nothing(&directions) {
                return None;
            }
        }
        (!directions.is_empty()).then(|| self.compressed(&directions.concat()))
    }
}

/// Some vectors, orthonormalised.
fn orthonormal(vectors: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut directions = Vec::new();
    vectors.iter().for_each(|vector| append_real(&mut directions, vector.clone()));
    directions
}

/// The relative error at a point.
fn relative(solved: &Assessment, point: &Point<'_>) -> f64 {
    let nominal = point.at.parameters.first().map_or(c64::default(), |p| p.nominal);
    solved.relative_truncation(nominal + point.correction)
}

/// x without its parts along some orthonormal directions.
fn take_out(x: &mut [f64], directions: &[Vec<f64>]) {
    for _ in 0..2 {
        for v in directions {
            let overlap = transpose_dot(v, x);
            x.iter_mut().zip(v).for_each(|(x, v)| *x -= overlap * v);
        }
    }
}

/// The real and the imaginary part of y, orthonormalised.
fn append(directions: &mut Vec<Vec<f64>>, y: &[c64]) {
    for part in [|y: &c64| y.re, |y: &c64| y.im] {
        append_real(directions, y.iter().map(part).collect());
    }
}

fn append_real(directions: &mut Vec<Vec<f64>>, mut x: Vec<f64>) {
    let length = |x: &[f64]| transpose_dot(x, x).sqrt();
    let before = length(&x);
    take_out(&mut x, directions);
    let rest = length(&x);
    if rest > LOCAL_DIRECTION_RTOL * before {
        x.iter_mut().for_each(|x| *x /= rest);
        directions.push(x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::for_each::sequential;
    use crate::material::Law;
    use crate::model::{DynamicStiffness, Experiment, Parameter, Role, Sensor, Term};
    use crate::subspace::{Subspace, TrainOptions};
    use frfit_linalg::sparse::Triplets;

    /// A chain of 80 masses with ten sensors: near the lowest of its modes the solutions of three frequencies alone are 66 directions.
    #[test]
    fn many_sensors_take_few_directions() {
        let n = 80;
        let (mut stiffness, mut mass) = (Triplets::new(n), Triplets::new(n));
        for i in 0..n {
            let ends = [i.checked_sub(1), Some(i)];
            stiffness.add_element(&ends, &[1.0, -1.0, -1.0, 1.0]);
            mass.add(i, i, 1.0);
        }
        let term = |name: &str, role, matrix, factor| Term {
            name: name.into(),
            role,
            matrix,
            factor: Law::Constant(factor),
        };
        let model = DynamicStiffness::new(vec![
            term("springs", Role::Stiffness, stiffness.assemble(), c64::new(1e6, 5e4)),
            term("mass", Role::Mass, mass.assemble(), c64::new(1.0, 0.0)),
        ])
        .unwrap();
        let parameter = Parameter::factor_of(&model, &["springs"]).unwrap();
        let sensor = |row| Sensor { row, sign: 1.0 };
        let experiment = Experiment::driven_at(n, sensor(79), (0..10).map(|m| sensor(7 * m + 5)).collect());
        let points: Vec<Point<'_>> = (1..=40)
            .map(|k| {
                let at = model.at(2.5 * f64::from(k), std::slice::from_ref(&parameter)).unwrap();
                Point { at, correction: c64::default() }
            })
            .collect();
        let mut subspace = Subspace::new(&experiment, &points[0].at).unwrap();
        subspace.train(&points, &TrainOptions::default(), &sequential).unwrap();
        let whole = subspace.projection();
        let few: Vec<Point<'_>> = points[..16].iter().step_by(3).cloned().collect();
        let tolerance = 1e-6;
        // One vector is given: it stays in the span.
        let given = vec![(0..whole.size()).map(|i| 1.0 / (1.0 + i as f64)).collect::<Vec<f64>>()];
        let (local, basis) = whole.localised_by_principal_directions(&few, tolerance, &given).unwrap();
        assert!(local.size() * 10 < whole.size() * 6, "{} of {}", local.size(), whole.size());
        let mut rest = given[0].clone();
        take_out(&mut rest, &basis.chunks_exact(whole.size()).map(<[f64]>::to_vec).collect::<Vec<_>>());
        assert!(transpose_dot(&rest, &rest) < 1e-20);
        for point in &points[..16] {
            let [own, all] = [&local, whole].map(|model| model.respond(&point.at).unwrap());
            for (own, all) in own.iter().zip(&all) {
                assert!((own - all).norm() < 30.0 * tolerance * all.norm(), "{own} {all}");
            }
        }
        assert!(whole.localised_by_principal_directions(&points, 1e-24, &given).is_none());
    }
}
