//! Natural modes of a structure with its damping, each a pole s of D(s) with its shape.
//!
//! With the factors f_g at the mode's own frequency, the poles are those s at which
//! $$ T(s) = \sum_g f_g\\, s^{q_g} S_g, \qquad q = 0, 1, 2 \text{ for stiffness, viscous damping and mass}, \qquad T(s)\\, x = 0 . $$
//! Modes of the real stiffness and mass are counted by inertia and found by Lanczos on the whole model. On the subspace that they span each is followed
//! from no damping to its own by inverse iteration with Rayleigh's functional, $y^T T(s) y = 0$. Where there are dampers, or much damping, a mode may so be led to
//! another's pole: all poles of the reduced model at one set of factors, from its state matrix, are starts as well. The residual T(s) Vy of the whole model brings the vectors that damping
//! adds to the shapes, until the pole is right: its error is of second order in them, as T is symmetric.
//!
//! # Source
//! P. Lancaster, Arch. Rational Mech. Anal. 8 (1961) 309–322 (inverse iteration with a functional); H. Voss, Handbook of Linear Algebra, ch. 115, 2nd ed. (2014).

use super::modes::is_rigid;
use super::shift::Shift;
use super::{Projection, Subspace};
use crate::c64;
use crate::frequency::{damping_ratio, natural_frequency_hz, omega_rad_s};
use crate::material::OutsideTable;
use crate::model::{Combination, DynamicStiffness, ModelAt, Role, WeightedTerm};
use frfit_linalg::dense::{Eigen, Ldlt, Matrix, combination, eigen};
use frfit_linalg::modes::{ModesError, lowest};
use frfit_linalg::sparse::{SymmetricMatrix, Values};
use frfit_linalg::vector::{dot, norm, orthogonalise, transpose_dot};
use std::fmt;

/// A mode of a structure.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalMode {
    /// s, 1/s; zero of a rigid body.
    pub pole_per_s: c64,
    /// Fᵀφ, with $\phi^T \frac{dT}{ds} \phi = 2s$: without damping φᵀMφ = 1.
    pub load: c64,
    /// ℓ_mᵀφ of each sensor.
    pub sensors: Vec<c64>,
    /// What of the strain energy is in each term of the model; zeros of a rigid body and of terms that are no stiffness.
    pub energy_shares: Vec<f64>,
    /// Estimated relative error of s by the reduction.
    pub error: f64,
}

impl NaturalMode {
    /// |s|/2π.
    pub fn frequency_hz(&self) -> f64 {
        natural_frequency_hz(self.pole_per_s)
    }

    /// −Re s/|s|; zero of a rigid body.
    pub fn damping_ratio(&self) -> f64 {
        if self.is_rigid_body() { 0.0 } else { damping_ratio(self.pole_per_s) }
    }

    /// Whether it has no stiffness.
    pub fn is_rigid_body(&self) -> bool {
        self.pole_per_s.norm() == 0.0
    }

    /// R_m = Fᵀφ ℓ_mᵀφ/2s of each sensor: its receptance has R_m/(iω − s) and its conjugate.
    pub fn residues(&self) -> Vec<c64> {
        self.sensors.iter().map(|own| self.load * own / (2.0 * self.pole_per_s)).collect()
    }
}

/// The modes up to a frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalModes {
    /// Lowest first, rigid bodies before all others.
    pub modes: Vec<NaturalMode>,
    /// Modes of the real stiffness and mass below that frequency, by inertia.
    pub count: usize,
}

/// Why there are no modes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum NaturalModesError {
    /// A table of a factor does not reach a frequency.
    OutsideTable(OutsideTable),
    /// The undamped modes were not found.
    Undamped(ModesError),
}

impl fmt::Display for NaturalModesError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideTable(error) => error.fmt(f),
            Self::Undamped(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for NaturalModesError {}

impl From<OutsideTable> for NaturalModesError {
    fn from(error: OutsideTable) -> Self {
        Self::OutsideTable(error)
    }
}

impl<E: Into<ModesError>> From<E> for NaturalModesError {
    fn from(error: E) -> Self {
        Self::Undamped(error.into())
    }
}

/// The model at a frequency, everything at the values whose modes are asked for.
pub type ModelAtFrequency<'a, 'm> = &'a dyn Fn(f64) -> Result<ModelAt<'m>, OutsideTable>;

/// Undamped modes beyond those below the highest frequency that are part of the subspace.
const MODES_BEYOND: usize = 4;

/// Mass that is added to the stiffness while undamped modes are searched, times the square of the highest frequency: shapes stay the same.
const SHIFT: f64 = 1e-2;

/// Relative error of a pole that the reduction may leave.
const POLE_RTOL: f64 = 1e-10;

/// Rounds in which vectors are added for it.
const MAX_ROUNDS: usize = 8;

/// A step of s below this part of it ends an iteration.
const STEP_RTOL: f64 = 1e-13;

/// Steps of an iteration, and the smallest part of the way from no damping to all of it that is gone at once.
const MAX_STEPS: usize = 40;
const MIN_WAY: f64 = 1.0 / 64.0;

/// Two shapes of one mode with more and with less damping have at least this in common.
const MIN_OVERLAP: f64 = 0.8;

/// Poles nearer than this part of them, with shapes that differ by less than this part, are one.
const TWIN_RTOL: f64 = 1e-6;
const TWIN_SHAPE_RTOL: f64 = 1e-2;

/// A mode with more damping than this may have changed places with another on the way.
const HEAVY_DAMPING_RATIO: f64 = 0.1;

/// A pole whose imaginary part is below this part of it is overdamped.
const MIN_OSCILLATION: f64 = 0.05;

/// Poles at fixed factors are searched up to this multiple of the highest frequency: at their own factors they are elsewhere.
const MARGIN: f64 = 1.1;

/// Vectors that are added to the subspace at once.
const VECTORS_AT_ONCE: usize = 16;

/// Vectors of the subspace up to which the eigenvalues of its state matrix are a matter of seconds.
const MAX_STATE_SIZE: usize = 200;

/// A pole with its reduced shape.
struct Followed {
    s: c64,
    y: Vec<c64>,
}

impl<'m> Subspace<'m> {
    /// All modes below a frequency, with the values that the model has at each mode's own frequency; above the highest frequency those there.
    ///
    /// One real factorisation for their number, one for Lanczos's iteration, and solves with the factor of this subspace.
    ///
    /// # Errors
    /// [`NaturalModesError`].
    ///
    /// # Limits
    /// Damping so large that a mode overtakes others on the way to it may lead two modes to one pole. One of them is left out then, and what is missing below
    /// the highest frequency is found from a state matrix, if the subspace has no more than 200 vectors: of an overdamped mode nothing is left, and the number of modes
    /// may differ from `count`.
    pub fn natural_modes(
        &mut self,
        at: ModelAtFrequency<'_, 'm>,
        highest_hz: f64,
    ) -> Result<NaturalModes, NaturalModesError> {
        let reference = at(highest_hz)?;
        let [stiffness, mass] = real_pencil(&reference);
        let omega_squared = omega_rad_s(highest_hz).powi(2);
        let model = reference.model;
        let count =
            Shift::new(&reference, -omega_squared)?.factor(model, &mut self.work)?.negative_eigenvalues();
        self.work.factorisations += 2;
        let symmetric =
            |values| SymmetricMatrix::new(model.analysis().pattern().clone(), Values::Real(values));
        // With a little of the mass a rigid body is not so far from the other modes that roundoff of its own covers them.
        let shifted = stiffness.iter().zip(&mass).map(|(k, m)| k + SHIFT * omega_squared * m).collect();
        let undamped = lowest(&symmetric(shifted), &symmetric(mass), count + MODES_BEYOND)?;
        self.append_within(&undamped.shapes.concat());
        let nominal = factors(&reference);
        let mut rounds = 0;
        loop {
            let modes = self.modes_of_reduced(at, &nominal, (&reference, highest_hz))?;
            let rest = self.rest(at, &modes, highest_hz)?;
            let worst = rest.iter().map(|(error, _)| *error).fold(0.0, f64::max);
            let before = self.size();
            if worst > POLE_RTOL && rounds < MAX_ROUNDS {
                rounds += 1;
                let large = rest.iter().filter(|(error, _)| *error > POLE_RTOL);
                let block: Vec<f64> = large.flat_map(|(_, directions)| directions).copied().collect();
                self.append_within(&block);
            }
            if self.size() == before {
                let each = modes.iter().zip(rest);
                let modes = each.map(|(mode, (error, _))| self.mode(at, mode, error, highest_hz));
                return Ok(NaturalModes { modes: modes.collect::<Result<_, _>>()?, count });
            }
        }
    }

    /// Adds vectors to the basis until it has as many as the model has rows: further ones would be roundoff.
    fn append_within(&mut self, block: &[f64]) {
        let n = self.model.dim();
        for some in block.chunks(n * VECTORS_AT_ONCE) {
            let room = n.saturating_sub(self.size());
            let one_by_one = room < VECTORS_AT_ONCE;
            for part in some.chunks(if one_by_one { n } else { some.len() }) {
                if self.size() < n {
                    self.basis.append(self.model, self.experiment, part.to_vec());
                }
            }
        }
    }

    /// The modes of the reduced model.
    fn modes_of_reduced(
        &self,
        at: ModelAtFrequency<'_, 'm>,
        nominal: &[(usize, c64)],
        (reference, highest_hz): (&ModelAt<'m>, f64),
    ) -> Result<Vec<Followed>, NaturalModesError> {
        let highest_rad_s = omega_rad_s(highest_hz);
        let undamped = self.projection().modes(reference, c64::default(), highest_rad_s, usize::MAX);
        let undamped = undamped.map_err(|_| ModesError::NotConverged { converged: 0 })?;
        let mut modes: Vec<Followed> = Vec::new();
        for (i, &omega) in undamped.omega_rad_s.iter().enumerate() {
            let y: Vec<c64> = undamped.shape(i).iter().map(|&y| c64::new(y, 0.0)).collect();
            let start = Followed { s: c64::new(0.0, omega), y };
            if omega == 0.0 {
                modes.push(start);
                continue;
            }
            let own = self.followed(at, nominal, start, highest_hz)?;
            if is_another(&own, &modes) {
                modes.push(own);
            }
        }
        let is_heavy = |mode: &Followed| mode.s.norm() > 0.0 && damping_ratio(mode.s) > HEAVY_DAMPING_RATIO;
        let has_dampers = nominal.iter().any(|(term, _)| self.model.terms()[*term].role == Role::Viscous);
        if has_dampers || modes.iter().any(is_heavy) {
            let own = |s: c64| -> Result<Vec<(usize, c64)>, OutsideTable> {
                Ok(factors(&at(frequency_of(s, highest_hz))?))
            };
            for start in self.projection().oscillations(self.model, nominal, highest_rad_s) {
                let Some(own) = self.projection().pole_near(self.model, &own, &start)? else { continue };
                let is_below = own.s.norm() <= highest_rad_s && is_oscillation(own.s);
                // A rigid body that a damper holds has a pole of rounding near zero.
                if is_below && !is_rigid(own.s.norm_sqr(), highest_rad_s) && is_another(&own, &modes) {
                    modes.push(own);
                }
            }
        }
        modes.sort_by(|a, b| a.s.norm().total_cmp(&b.s.norm()));
        Ok(modes)
    }

    /// An undamped mode followed to what its factors are at its own frequency.
    fn followed(
        &self,
        at: ModelAtFrequency<'_, 'm>,
        nominal: &[(usize, c64)],
        mut mode: Followed,
        highest_hz: f64,
    ) -> Result<Followed, NaturalModesError> {
        let (mut gone, mut step) = (0.0, 1.0);
        while gone < 1.0 {
            let way = f64::min(gone + step, 1.0);
            let part = |s: c64| -> Result<Vec<(usize, c64)>, OutsideTable> {
                let own = factors(&at(frequency_of(s, highest_hz))?);
                let mixed = |(&(term, real), (_, own)): (&(usize, c64), (usize, c64))| {
                    let undamped = if self.model.terms()[term].role == Role::Viscous { 0.0 } else { real.re };
                    (term, (1.0 - way) * undamped + way * own)
                };
                Ok(nominal.iter().zip(own).map(mixed).collect())
            };
            let next = self.projection().pole_near(self.model, &part, &mode)?;
            match next.filter(|next| overlap(&next.y, &mode.y) >= MIN_OVERLAP || step <= MIN_WAY) {
                Some(next) => (mode, gone, step) = (next, way, 2.0 * step),
                // Even the smallest step fails: the last pole stands, and its error is large.
                None if step <= MIN_WAY => return Ok(mode),
                None => step *= 0.5,
            }
        }
        Ok(mode)
    }

    /// For each mode the relative error of its pole, and what would make it smaller: S⁻¹ times real and imaginary part of T(s) Vy.
    fn rest(
        &mut self,
        at: ModelAtFrequency<'_, 'm>,
        modes: &[Followed],
        highest_hz: f64,
    ) -> Result<Vec<(f64, Vec<f64>)>, NaturalModesError> {
        let n = self.model.dim();
        let mut all = Vec::new();
        for Followed { s, y } in modes {
            if s.norm() == 0.0 {
                all.push((0.0, Vec::new()));
                continue;
            }
            let factors = factors(&at(frequency_of(*s, highest_hz))?);
            let shape = self.basis.vectors().combine(y);
            let mut force = vec![c64::default(); n];
            let of_term = |&(term, factor): &(usize, c64)| WeightedTerm {
                term,
                weight: factor * power(self.model.terms()[term].role, *s),
            };
            Combination { parts: factors.iter().map(of_term).collect() }.multiply_add(
                self.model,
                c64::new(1.0, 0.0),
                &shape,
                &mut force,
            );
            let mut directions: Vec<f64> =
                force.iter().map(|f| f.re).chain(force.iter().map(|f| f.im)).collect();
            self.shift.factor(self.model, &mut self.work)?.solve(&mut directions)?;
            let (re, im) = directions.split_at(n);
            let product: c64 =
                force.iter().zip(re.iter().zip(im)).map(|(f, (&re, &im))| f * c64::new(re, im)).sum();
            let slope = self.projection().slope_by_pole(self.model, &factors, *s, y);
            all.push(((product / (slope * s)).norm(), directions));
        }
        Ok(all)
    }

    fn mode(
        &self,
        at: ModelAtFrequency<'_, 'm>,
        Followed { s, y }: &Followed,
        error: f64,
        highest_hz: f64,
    ) -> Result<NaturalMode, NaturalModesError> {
        let small = self.projection();
        let terms = self.model.terms();
        let is_rigid = s.norm() == 0.0;
        let factors = factors(&at(frequency_of(*s, highest_hz))?);
        // Of a rigid body φᵀMφ = 1 already.
        let size = if is_rigid {
            c64::new(1.0, 0.0)
        } else {
            small.slope_by_pole(self.model, &factors, *s, y) / (2.0 * s)
        };
        let size = size.sqrt();
        let conjugate: Vec<c64> = y.iter().map(|y| y.conj()).collect();
        let mut energy_shares = vec![0.0; terms.len()];
        for &(term, factor) in
            factors.iter().filter(|(term, _)| terms[*term].role == Role::Stiffness && !is_rigid)
        {
            let theta = small.weights_of(&[(term, factor)]);
            let [of_term] = &small.multiply(&[theta], y)[..] else { continue };
            energy_shares[term] = transpose_dot(&conjugate, of_term).re;
        }
        let whole: f64 = energy_shares.iter().sum();
        energy_shares.iter_mut().for_each(|share| *share /= if whole > 0.0 { whole } else { 1.0 });
        let of_sensor = |l: &Vec<f64>| l.iter().zip(y).map(|(l, y)| l * y).sum::<c64>() / size;
        Ok(NaturalMode {
            pole_per_s: *s,
            load: transpose_dot(&small.load, y) / size,
            sensors: small.sensors.iter().map(of_sensor).collect(),
            energy_shares,
            error,
        })
    }
}

/// Whether a mode is not among some others: its pole is another, or its shape is no combination of those of the same pole.
fn is_another(one: &Followed, others: &[Followed]) -> bool {
    let mut units: Vec<Vec<c64>> = Vec::new();
    for other in others.iter().filter(|other| (one.s - other.s).norm() <= TWIN_RTOL * one.s.norm()) {
        let mut unit = other.y.clone();
        orthogonalise(&units, &mut unit);
        let size = norm(&unit);
        units.push(unit.into_iter().map(|entry| entry / size).collect());
    }
    let mut rest = one.y.clone();
    orthogonalise(&units, &mut rest);
    norm(&rest) > TWIN_SHAPE_RTOL * norm(&one.y)
}

/// Whether a pole oscillates: it is not overdamped.
fn is_oscillation(s: c64) -> bool {
    s.im > MIN_OSCILLATION * s.norm()
}

impl Projection {
    /// Poles with a positive frequency up to some |s|, with their shapes, at factors that are held. A large reduced model is left out.
    ///
    /// With z = (y, s y) and s = s₀ + 1/μ about a point s₀ that is no pole, (A − s B) z = 0 is (A − s₀ B)⁻¹ B z = μ z, regular with a singular mass.
    fn oscillations(
        &self,
        model: &DynamicStiffness,
        factors: &[(usize, c64)],
        highest_rad_s: f64,
    ) -> Vec<Followed> {
        let r = self.size;
        if r > MAX_STATE_SIZE {
            return Vec::new();
        }
        let of_role = |role: Role| {
            let of_role = |&(term, factor): &(usize, c64)| {
                (term, if model.terms()[term].role == role { factor } else { c64::default() })
            };
            let theta = self.weights_of(&factors.iter().map(of_role).collect::<Vec<_>>());
            let parts: Vec<(c64, &[f64])> =
                theta.into_iter().zip(&self.matrices).map(|(theta, s)| (theta, &s[..])).collect();
            combination(r, r, &parts)
        };
        let [stiffness, viscous, mass] = [Role::Stiffness, Role::Viscous, Role::Mass].map(of_role);
        // In units of the highest frequency all blocks are of one size. A point on neither axis.
        let [once, twice] = [highest_rad_s, highest_rad_s * highest_rad_s];
        let about = c64::new(0.3, 0.6);
        let dynamic = Matrix::from_fn(r, r, |i, j| {
            stiffness[(i, j)] + about * once * viscous[(i, j)] + about * about * twice * mass[(i, j)]
        });
        let Ok(factor) = Ldlt::new(&dynamic) else { return Vec::new() };
        // T(s₀)⁻¹ of (C + s₀ M) and of M: y = −μ T⁻¹[(C + s₀M) y + M v] and v = s₀ y + μ y eliminate to the matrix below.
        let damped = |i: usize, j: usize| once * viscous[(i, j)] + about * twice * mass[(i, j)];
        let entries = |of: &dyn Fn(usize, usize) -> c64| -> Vec<c64> {
            (0..r * r).map(|at| of(at % r, at / r)).collect()
        };
        let (mut first, mut second) = (entries(&damped), entries(&|i, j| twice * mass[(i, j)]));
        if factor.solve(&mut first).and(factor.solve(&mut second)).is_err() {
            return Vec::new();
        }
        let (first, second) = (|i: usize, j: usize| first[i + j * r], |i: usize, j: usize| second[i + j * r]);
        let state = Matrix::from_fn(2 * r, 2 * r, |i, j| {
            let unit = c64::from(f64::from(u8::from(i % r == j % r)));
            match (i < r, j < r) {
                (true, true) => -first(i, j),
                (true, false) => -second(i, j - r),
                (false, true) => unit - about * first(i - r, j),
                (false, false) => -about * second(i - r, j - r),
            }
        });
        let Ok(Eigen { values, vectors }) = eigen(&state) else { return Vec::new() };
        let pole = |(k, mu): (usize, &c64)| {
            let s = once * (about + mu.inv());
            let is_wanted = s.is_finite() && s.norm() <= MARGIN * highest_rad_s && is_oscillation(s);
            is_wanted.then(|| Followed { s, y: vectors.column(k)[..r].to_vec() })
        };
        values.iter().enumerate().filter_map(pole).collect()
    }

    /// θ_g of factors of terms, without powers of s.
    fn weights_of(&self, factors: &[(usize, c64)]) -> Vec<c64> {
        let of_term = |&(term, weight): &(usize, c64)| WeightedTerm { term, weight };
        // θ_g depends on the frequency only where the model has errors, and this one has none.
        self.parts.weights(&Combination { parts: factors.iter().map(of_term).collect() }, 0.0)
    }

    /// The pole to which inverse iteration leads; `None` where it leads nowhere.
    fn pole_near(
        &self,
        model: &DynamicStiffness,
        factors: &dyn Fn(c64) -> Result<Vec<(usize, c64)>, OutsideTable>,
        start: &Followed,
    ) -> Result<Option<Followed>, OutsideTable> {
        let (mut s, mut y) = (start.s, start.y.clone());
        for _ in 0..MAX_STEPS {
            let own = self.weights_of(&factors(s)?);
            let weighed = |s: c64, of: fn(Role, c64) -> c64| -> Vec<c64> {
                own.iter()
                    .enumerate()
                    .map(|(g, f)| f * of(model.terms()[self.parts.term(g)].role, s))
                    .collect()
            };
            let images = self.multiply(&[weighed(s, power), weighed(s, slope)], &y);
            let step = -transpose_dot(&y, &images[0]) / transpose_dot(&y, &images[1]);
            if !step.is_finite() {
                return Ok(None);
            }
            s += step;
            if step.norm() <= STEP_RTOL * s.norm() {
                return Ok(Some(Followed { s, y }));
            }
            let mut next = images.into_iter().nth(1).unwrap_or_default();
            // Singular to the last digit is as near as it gets.
            if self.solve(&weighed(s, power), &mut next).is_err() {
                return Ok(Some(Followed { s, y }));
            }
            let size = norm(&next);
            y = next.into_iter().map(|entry| entry / size).collect();
        }
        // A search that goes on has found nothing.
        Ok(None)
    }

    /// yᵀ dT/ds y with the factors held.
    fn slope_by_pole(&self, model: &DynamicStiffness, factors: &[(usize, c64)], s: c64, y: &[c64]) -> c64 {
        let of_term = |&(term, factor): &(usize, c64)| (term, factor * slope(model.terms()[term].role, s));
        let theta = self.weights_of(&factors.iter().map(of_term).collect::<Vec<_>>());
        transpose_dot(y, &self.multiply(&[theta], y)[0])
    }
}

/// s^q.
fn power(role: Role, s: c64) -> c64 {
    match role {
        Role::Stiffness => c64::new(1.0, 0.0),
        Role::Viscous => s,
        Role::Mass => s * s,
    }
}

/// d(s^q)/ds.
fn slope(role: Role, s: c64) -> c64 {
    match role {
        Role::Stiffness => c64::default(),
        Role::Viscous => c64::new(1.0, 0.0),
        Role::Mass => 2.0 * s,
    }
}

/// The frequency at which the factors of a mode are taken.
fn frequency_of(s: c64, highest_hz: f64) -> f64 {
    let least = 1e-6 * highest_hz;
    (s.im / omega_rad_s(1.0)).clamp(least, highest_hz)
}

/// The factor of each term.
fn factors(at: &ModelAt<'_>) -> Vec<(usize, c64)> {
    let of = |&WeightedTerm { term, weight }: &WeightedTerm| {
        (term, weight / at.model.weight(at.model.terms()[term].role, at.frequency_hz))
    };
    at.nominal.parts.iter().map(of).collect()
}

/// Re K and M on the model's pattern.
fn real_pencil(at: &ModelAt<'_>) -> [Vec<f64>; 2] {
    let mut pencil = [Role::Stiffness, Role::Mass].map(|_| vec![0.0; at.model.analysis().pattern().stored()]);
    for (term, factor) in factors(at) {
        let term = &at.model.terms()[term];
        match term.role {
            Role::Stiffness => term.matrix.accumulate_real_into(factor.re, &mut pencil[0]),
            Role::Mass => term.matrix.accumulate_real_into(factor.re, &mut pencil[1]),
            Role::Viscous => {}
        }
    }
    pencil
}

/// |xᴴy|/(‖x‖‖y‖).
fn overlap(x: &[c64], y: &[c64]) -> f64 {
    dot(x, y).norm() / (norm(x) * norm(y))
}
