//! What all fits of a band have in common.

use super::curve::Curves;
use super::factor_prior::{FactorPrior, priors};
use super::fit::{ADDED_NOISE, Explained, FIRST_LINES, Fit};
use super::fitting::{Fitting, Place, middle};
use super::kinds::Kinds;
use super::measured::Measured;
use super::mesh::{BetweenMeshes, Coarser};
use super::sizes::KnownSizes;
use crate::c64;
use crate::for_each::ForEach;
use crate::subspace::{Modes, Point, Projection};
use crate::thinned::thinned;
use std::f64::consts::TAU;

/// Modes up to this many times the highest frequency, and so many at most.
const MODES_ABOVE_BAND: f64 = 4.0;
const MAX_MODES: usize = 30;

/// Lines that are used at most.
const MAX_LINES: usize = 240;

/// Points of the band at which a model of the neighbourhood is made good, and to which error.
const NEIGHBOURHOOD_POINTS: usize = 24;
pub(super) const NEIGHBOURHOOD_TOL: f64 = 1e-6;
pub(super) const ROUGH_NEIGHBOURHOOD_TOL: f64 = 1e-4;

/// What all fits of a band have in common.
pub(super) struct Search<'t, 'a> {
    pub(super) model: &'t Projection,
    pub(super) data: &'t Measured<'t, 'a>,
    pub(super) curves: &'t Curves,
    pub(super) centre: &'t [f64],
    pub(super) for_each: ForEach<'t>,
    /// Lines that are used, some of them, and those about which a smaller model is made.
    pub(super) lines: Vec<usize>,
    pub(super) some: Vec<usize>,
    pub(super) about: Vec<usize>,
    /// Of the whole reduced model.
    pub(super) modes: Modes,
    /// The values of the unknowns with which they are.
    pub(super) values_of_modes: Vec<c64>,
    /// Known factors that may be in error.
    pub(super) factors: Vec<FactorPrior>,
    /// Unknowns that enter stiffness alone, and are above zero.
    pub(super) stiffnesses: Vec<usize>,
    /// Unknown stiffnesses with damping, whose loss factors may have an error in common, and the terms of each.
    pub(super) damped: Vec<(usize, Vec<usize>)>,
    /// What lies between the meshes, where there are two.
    pub(super) mesh: Option<BetweenMeshes>,
}

impl<'t, 'a> Search<'t, 'a> {
    /// With the modes that the model has in the middle of the band.
    pub(super) fn new(
        model: &'t Projection,
        data: &'t Measured<'t, 'a>,
        (curves, centre): (&'t Curves, &'t [f64]),
        theta: &[f64],
        for_each: ForEach<'t>,
    ) -> Option<Self> {
        let all: Vec<usize> = (0..data.omegas.len()).filter(|&i| data.omegas[i] > 0.0).collect();
        let of = |most: usize| -> Vec<usize> { thinned(&all, most).copied().collect() };
        let lines = of(MAX_LINES);
        let (values_of_modes, _) = curves.values(theta, middle(&lines), data.omegas[middle(&lines)])?;
        let Point { at, correction } = data.on(curves, theta, middle(&lines))?;
        let highest = *data.omegas.last()?;
        let modes = model.modes(&at, correction, MODES_ABOVE_BAND * highest, MAX_MODES).ok()?;
        let all_unknowns = 0..values_of_modes.len();
        let is_stiffness = |&j: &usize| values_of_modes[j].re > 0.0 && at.is_stiffness(j);
        let is_damped = |&j: &usize| values_of_modes[j].im != 0.0 && at.is_stiffness(j);
        let with_terms = |j: usize| (j, at.terms_of(j).map(|(term, _)| term).collect());
        Some(Self {
            stiffnesses: all_unknowns.clone().filter(is_stiffness).collect(),
            damped: all_unknowns.filter(is_damped).map(with_terms).collect(),
            model,
            data,
            curves,
            centre,
            for_each,
            lines,
            some: of(FIRST_LINES),
            about: of(NEIGHBOURHOOD_POINTS),
            factors: priors(&at, data.given_sizes, modes.share_of_unknowns(highest)),
            modes,
            values_of_modes,
            mesh: None,
        })
    }

    /// The known factors whose accuracy is given.
    pub(super) fn given_factors(&self) -> Vec<FactorPrior> {
        self.factors.iter().filter(|factor| factor.is_given).copied().collect()
    }

    /// The fit of a model without errors, but for those of factors whose accuracy is given.
    pub(super) fn right(&self, model: &Projection, given: &[FactorPrior], start: Place) -> Option<Explained> {
        let none = Modes::none(model);
        let fitting = Fitting { factors: given, ..self.fitting(model, &none, &self.lines) };
        self.data.explain(&fitting, start, &ADDED_NOISE[2..])
    }

    /// The same from θ, with factors that are right to begin with.
    pub(super) fn right_from(&self, model: &Projection, theta: &[f64]) -> Option<Explained> {
        let given = self.given_factors();
        let start = theta.iter().copied().chain(given.iter().map(|_| 0.0)).collect();
        self.right(model, &given, start)
    }

    /// With what lies between this mesh and a coarser one, where there is one. The stiffness of an unknown then has no error of a usual size: the meshes
    /// say how large it is.
    pub(super) fn with_meshes(mut self, theta: &[f64]) -> Self {
        let between = |coarser: Coarser<'t>| {
            let on = |&line: &usize| -> Option<Point<'t>> {
                let omega = self.data.omegas[line];
                coarser.point(omega / TAU, &self.curves.values(theta, line, omega)?.0)
            };
            let points: Vec<Point<'t>> = self.about.iter().filter_map(on).collect();
            let middle = on(&middle(&self.lines))?;
            let modes = (&self.modes, *self.data.omegas.last()?);
            BetweenMeshes::new(coarser.mesh, &points, &middle, modes, self.for_each)
        };
        self.mesh = self.data.coarser.and_then(between);
        if self.mesh.is_some() {
            self.factors.retain(|factor| factor.is_known);
        }
        self
    }

    /// Points along some curves.
    pub(super) fn points(&self, theta: &[f64]) -> Vec<Point<'a>> {
        self.about.iter().filter_map(|&i| self.data.on(self.curves, theta, i)).collect()
    }

    /// A smaller model of the modes and of what is near some points, with its modes; the same where it would be no smaller.
    pub(super) fn smaller(&self, points: &[Point<'_>], tolerance: f64) -> (Projection, Modes) {
        let smaller = self.model.about_modes(&self.modes, points, tolerance);
        smaller.unwrap_or_else(|| (self.model.clone(), self.modes.clone()))
    }

    /// A fit on a model that is good near a place.
    pub(super) fn near(&self, place: Place, kinds: Kinds, fit: Fit<'_>) -> Option<Explained> {
        let (model, modes) = self.smaller(&self.points(&place), NEIGHBOURHOOD_TOL);
        fit(&Fitting { kinds, ..self.fitting(&model, &modes, &self.lines) }, place)
    }

    pub(super) fn fitting<'f>(
        &'f self,
        model: &'f Projection,
        modes: &'f Modes,
        lines: &'f [usize],
    ) -> Fitting<'f, 'a> {
        Fitting {
            model,
            modes,
            point: self.data.point,
            omegas: self.data.omegas,
            measured: self.data.measured,
            lines,
            curves: self.curves,
            centre: self.centre,
            highest_rad_s: self.data.omegas[self.data.omegas.len() - 1],
            factors: &self.factors,
            damped: &self.damped,
            kinds: Kinds::ALL,
            mesh: self.mesh.as_ref().filter(|_| !modes.omega_rad_s.is_empty()),
            known: KnownSizes::new(self.data.given_sizes, self.mesh.as_ref(), self.curves.is_beside_others()),
            free_nodes: true,
            for_each: self.for_each,
        }
    }
}
