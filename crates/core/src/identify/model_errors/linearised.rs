//! The responses near a place, and the normal equations there.

use super::fitting::{Fitting, Place, is_frequency_part};
use super::kinds::Damping;
use super::whitening::Whitening;
use crate::c64;
use crate::for_each::{ForEach, map};
use crate::subspace::{ErrorSlopes, ModalErrors, Projection};
use frfit_linalg::column_block::times_transpose;

/// Parts in which the lines are summed.
const LINE_CHUNKS: usize = 4;

/// The normal equations at a place: χ², ½ ∂χ²/∂p, JᵀJ (n × n).
pub(super) struct Normal {
    pub(super) chi_squared: f64,
    pub(super) gradient: Vec<f64>,
    pub(super) information: Vec<f64>,
}

impl Normal {
    /// JᵀJ and the prior's precision together, n × n.
    pub(super) fn with_prior(&self, precision: &[f64]) -> Vec<f64> {
        self.information.iter().zip(precision).map(|(data, prior)| data + prior).collect()
    }
}

/// The responses near a place, before they are weighed: what noise and priors are assumed does not change them.
pub(super) struct Linearised {
    pub(super) place: Place,
    /// Coordinates in all, and those on which the response at each sensor depends.
    count: usize,
    coordinates: Vec<Vec<usize>>,
    /// Of each line and sensor: slopes along these, then what is left of the measurement.
    rows: Vec<Vec<Vec<c64>>>,
}

impl Linearised {
    /// u_m − x_m at each of the lines.
    pub(super) fn residuals(&self) -> Vec<Vec<c64>> {
        let residual = |row: &Vec<c64>| row.last().copied().unwrap_or_default();
        self.rows.iter().map(|of_line| of_line.iter().map(residual).collect()).collect()
    }

    /// −Jᵀb of the bend b = x(p + s) − x(p) − J s on the way to another place p + s, both made white.
    pub(super) fn bend(&self, other: &Self, step: &[f64], whitening: &Whitening) -> Vec<f64> {
        let mut sum = vec![0.0; self.count];
        for (m, coordinates) in self.coordinates.iter().enumerate() {
            // J, then the bend.
            let row = |k: usize| {
                let mut row = self.rows[k][m].clone();
                if let (Some((bend, slopes)), Some(there)) = (row.split_last_mut(), other.rows[k][m].last()) {
                    let straight: c64 =
                        coordinates.iter().zip(&*slopes).map(|(&i, slope)| step[i] * slope).sum();
                    *bend -= there + straight;
                }
                row
            };
            for (_, row) in whitening.rows(m, row) {
                if let Some((bend, slopes)) = row.split_last() {
                    coordinates.iter().zip(slopes).for_each(|(&i, slope)| sum[i] -= (slope.conj() * bend).re);
                }
            }
        }
        sum
    }

    /// The normal equations; `None` where the response is not finite.
    pub(super) fn normal(&self, whitening: &Whitening, for_each: ForEach<'_>) -> Option<Normal> {
        let n = self.count;
        let sensors = self.coordinates.len();
        let chunks = self.rows.len().min(LINE_CHUNKS);
        // Of each sensor the white rows of [J r], real and imaginary parts, in chunks of lines.
        let white = |m: usize| -> Vec<Vec<f64>> {
            let mut stacked = vec![Vec::new(); chunks];
            for (k, row) in whitening.rows(m, |k| self.rows[k][m].clone()) {
                stacked[k % chunks].extend(row.iter().map(|x| x.re));
                stacked[k % chunks].extend(row.iter().map(|x| x.im));
            }
            stacked
        };
        let white = map(for_each, sensors, white);
        // All products of their columns.
        let part = |c: usize| -> Vec<Vec<f64>> {
            let of_sensor = |m: usize| times_transpose(&white[m][c], self.coordinates[m].len() + 1);
            (0..sensors).map(of_sensor).collect()
        };
        let mut sum = Normal { chi_squared: 0.0, gradient: vec![0.0; n], information: vec![0.0; n * n] };
        for products in map(for_each, chunks, part) {
            for (of_sensor, coordinates) in products.iter().zip(&self.coordinates) {
                let mut columns = of_sensor.chunks_exact(coordinates.len() + 1);
                for (&a, column) in coordinates.iter().zip(&mut columns) {
                    let information = &mut sum.information[a * n..][..n];
                    coordinates.iter().zip(column).for_each(|(&b, product)| information[b] += product);
                }
                let rest = columns.next().unwrap_or_default();
                coordinates.iter().zip(rest).for_each(|(&a, product)| sum.gradient[a] += product);
                sum.chi_squared += rest.last().unwrap_or(&0.0);
            }
        }
        Some(sum).filter(|sum| sum.chi_squared.is_finite())
    }
}

/// Slopes of the unknowns at a line, with the number of the unknown.
struct Slopes {
    /// ∂p/∂θ.
    of_theta: Vec<(usize, c64)>,
    /// ∂p/∂ε of the error that all loss factors have in common.
    of_loss: Vec<(usize, c64)>,
}

impl Fitting<'_, '_> {
    /// The responses near a place; `None` where they are not finite.
    pub(super) fn linearised(&self, place: Place) -> Option<Linearised> {
        let errors = self.errors(&place);
        let model = self.model.with_errors(self.modes, &errors);
        let common: Vec<Vec<f64>> = (0..self.stiffness_errors()).map(|i| self.common(i)).collect();
        let moving: Vec<usize> = (0..self.shared()).filter(|&i| self.moves(i)).collect();
        let coordinates = |m: usize| -> Vec<usize> {
            let shapes = self.first_shape(m)..self.first_shape(m) + self.modes();
            moving.iter().copied().chain(shapes).collect()
        };
        let coordinates = (0..self.sensors()).map(coordinates).collect();
        // In a row shapes at a sensor follow what is shared.
        let places: Vec<usize> =
            moving.iter().copied().chain(self.shared()..self.shared() + self.modes()).collect();
        let rows = |k: usize| -> Option<Vec<Vec<c64>>> {
            let i = self.lines[k];
            let (slopes, of_unknowns) = self.shown(&model, &errors, &place, i)?;
            let at_sensor = |m: usize| {
                let row = self.row(&slopes, (&of_unknowns, self.omegas[i]), &common, m);
                let rest = self.measured[i][m] - slopes.response[m];
                places.iter().map(|&place| row[place]).chain([rest]).collect()
            };
            Some((0..self.sensors()).map(at_sensor).collect())
        };
        let rows = map(self.for_each, self.lines.len(), rows).into_iter().collect::<Option<_>>()?;
        Some(Linearised { place, count: self.count(), coordinates, rows })
    }

    /// What the sensors show at a line, with its slopes, and those of the unknowns.
    fn shown(
        &self,
        model: &Projection,
        errors: &ModalErrors,
        place: &[f64],
        line: usize,
    ) -> Option<(ErrorSlopes, Slopes)> {
        let (values, of_unknowns) = self.unknowns_at(place, line)?;
        let point = (self.point)(line, &values)?;
        let slopes =
            model.respond_with_error_slopes((self.modes, errors), &point.at, point.correction).ok()?;
        Some((slopes.shown(&self.curves.shares(place, self.omegas[line])), of_unknowns))
    }

    /// The unknowns at a line with their errors, and their slopes.
    fn unknowns_at(&self, place: &[f64], line: usize) -> Option<(Vec<c64>, Slopes)> {
        let (mut values, mut of_theta) = self.curves.values(place, line, self.omegas[line])?;
        let mut of_loss = Vec::new();
        if let Some(error) = self.of_unknown_loss().map(|i| place[i]) {
            let with_error = |value: c64| c64::new(value.re, (1.0 + error) * value.im);
            let is_damped = |j: usize| self.damped.iter().any(|(own, _)| *own == j);
            let slopes = of_theta.iter_mut().filter(|(j, _)| is_damped(*j));
            slopes.for_each(|(_, slope)| *slope = with_error(*slope));
            for &(j, _) in self.damped {
                of_loss.push((j, c64::new(0.0, values[j].im)));
                values[j] = with_error(values[j]);
            }
        }
        Some((values, Slopes { of_theta, of_loss }))
    }

    /// Slopes of x_m by the shared coordinates, then by the shapes at the sensor. `common` is [`Self::common`] of each error.
    fn row(
        &self,
        slopes: &ErrorSlopes,
        (Slopes { of_theta, of_loss }, omega_rad_s): (&Slopes, f64),
        common: &[Vec<f64>],
        m: usize,
    ) -> Vec<c64> {
        let along = |(j, slope): &(usize, c64)| slopes.slopes[*j][m] * slope;
        let mut row: Vec<c64> = of_theta.iter().map(along).collect();
        row.extend(self.curves.channels().slopes(slopes.response[m], m, omega_rad_s));
        if self.modes() > 0 {
            let mut of_common = vec![c64::default(); self.common_errors()];
            for (parts, slope) in common.iter().zip(&slopes.stiffness[m]) {
                of_common.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part * slope);
            }
            of_common[0] = slopes.scale[m];
            if let Some(place) = self.of_unknown_loss() {
                of_common[place - self.curves.count()] = of_loss.iter().map(along).sum();
            }
            if let (Some(mesh), Some(last)) = (self.mesh, of_common.last_mut()) {
                let at = |by: &[f64], slopes: &[c64]| -> c64 {
                    by.iter().zip(slopes).map(|(by, slope)| *by * slope).sum()
                };
                *last += at(&mesh.load, &slopes.load[m]) + at(&mesh.shape[m], &slopes.shape[m]);
            }
            row.extend(of_common);
            row.extend(&slopes.stiffness[m]);
        }
        row.extend(&slopes.factors[m]);
        // Without modes masses and calibrations are no coordinates.
        if self.modes() > 0 {
            row.extend(&slopes.masses[m]);
            row.extend(&slopes.gains[m]);
        }
        row.extend(&slopes.load[m]);
        row.extend(&slopes.shape[m]);
        row
    }

    /// Coordinates that the search moves.
    fn moves(&self, coordinate: usize) -> bool {
        let is_mass = self.masses().contains(&coordinate);
        let is_own_damping = self.own().contains(&coordinate) && !self.is_frequency(coordinate);
        let shared = coordinate.checked_sub(self.curves.count()).filter(|_| coordinate < self.first_own());
        let is_common_damping =
            shared.is_some_and(|part| !is_frequency_part(part)) && self.of_unknown_loss() != Some(coordinate);
        let is_left_out = (is_mass && !self.kinds.masses)
            || (is_common_damping && self.kinds.damping == Damping::None)
            || (is_own_damping && self.kinds.damping != Damping::Own);
        !is_left_out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = i q p₁² + p₁ + 2 p₂ bends by i q s₁² along a step s, whatever s₂ is.
    #[test]
    fn the_bend_is_what_is_not_straight() {
        let (q, measured, sigma) = (3.0, c64::new(1.0, -2.0), 0.5);
        let near = |place: [f64; 2]| {
            let response = c64::new(place[0] + 2.0 * place[1], q * place[0].powi(2));
            let row = vec![c64::new(1.0, 2.0 * q * place[0]), c64::new(2.0, 0.0), measured - response];
            Linearised {
                place: place.to_vec(),
                count: 2,
                coordinates: vec![vec![0, 1]],
                rows: vec![vec![row]],
            }
        };
        let (from, step) = ([0.4, -0.7], [0.1, 0.2]);
        let there = near([from[0] + step[0], from[1] + step[1]]);
        let found = near(from).bend(&there, &step, &Whitening::of_noise(vec![vec![sigma]]));
        // −Re(J̄ᵢ b)/σ² with b = i q s₁².
        let expected = -2.0 * q * from[0] * q * step[0].powi(2) / sigma.powi(2);
        assert!((found[0] - expected).abs() < 1e-14 && found[1].abs() < 1e-14, "{found:?} {expected}");
        assert_eq!(near(from).bend(&there, &step, &Whitening::of_noise(vec![vec![f64::INFINITY]])), [0.0; 2]);
    }
}
