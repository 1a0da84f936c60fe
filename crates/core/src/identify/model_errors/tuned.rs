//! Unknowns and natural frequencies one after the other, each tried all over its range.
//!
//! A mode that is off by many half-widths has no slope towards its place, and descent leaves it at a wrong one. Here the response is compared with the measured
//! one by a measure that is bounded at each line,
//! $$ \sum_{k,m} \frac{|u_m - x_m|^2}{|u_m|^2 + |x_m|^2} $$
//! so that a few resonances at wrong places do not hide that everything between them is right.

use super::fitting::{Fitting, Place};
use crate::c64;
use crate::for_each::map;
use crate::rational::{Poles, RationalResponse};
use crate::response::Response;
use crate::subspace::{AlongMode, Point, Projection};
use crate::thinned::thinned;

/// By how much an unknown as a whole is changed, in its logarithm, and in how many steps to either side.
const SCALE_RANGE: f64 = 0.3;
const SCALE_STEPS: i32 = 100;

/// The steps that are tried where it is about right: 3 %.
const NEAR_SCALE_STEPS: i32 = 32;

/// Lines that are looked at where an unknown is tried all over its range: the measure is bounded, and no single one of them rules.
const MAX_SCALE_LINES: usize = 150;

/// Order of the response along an unknown to begin with, and the residual with which it is good enough for a measure that is bounded.
const FIRST_ORDER: usize = 16;
const MAX_RESIDUAL: f64 = 1e-3;

/// The error within which a natural frequency is searched, and the number of steps to either side: up to 1 % each is a half-width of a loss factor of 0.2 %.
const FREQUENCY_RANGE: f64 = 0.03;
const FREQUENCY_STEPS: i32 = 30;

/// An error of a natural frequency that counts as much as a line at which nothing fits.
const UNUSUAL_ERROR: f64 = 0.05;

/// How often all of them are gone through: where one is at a wrong place its neighbours have other shapes.
const SWEEPS: usize = 2;

/// What a sensor shows of a mode, over what it should: near a node of its shape that may be anything.
pub(super) const MAX_SHARE: f64 = 3.0;

impl Fitting<'_, '_> {
    /// From a place to the least mismatch with the measured response, coordinate after coordinate: each smooth unknown as a whole near where it is, then each natural
    /// frequency of the band by the lines about it, with the shapes that suit best there. `used` says which (line, sensor) count.
    pub(super) fn tuned(&self, mut place: Place, used: &dyn Fn(usize, usize) -> bool) -> Option<Place> {
        for _ in 0..SWEEPS {
            place = self.with_best_frequencies(place, used)?;
            place = self.with_best_scales(place, NEAR_SCALE_STEPS, used)?.1;
        }
        self.with_best_frequencies(place, used)
    }

    /// With each smooth unknown as a whole where it leaves least mismatch, all over its range; and how much that is, of each line and sensor.
    pub(super) fn scaled(&self, place: Place, used: &dyn Fn(usize, usize) -> bool) -> Option<(f64, Place)> {
        let lines: Vec<usize> = thinned(self.lines, MAX_SCALE_LINES).copied().collect();
        let (mismatch, place) =
            Fitting { lines: &lines, ..*self }.with_best_scales(place, SCALE_STEPS, used)?;
        Some((mismatch / (lines.len() * self.sensors()) as f64, place))
    }

    /// The mismatch of all sensors with each smooth unknown where that is least, and the place.
    fn with_best_scales(
        &self,
        mut place: Place,
        most: i32,
        used: &dyn Fn(usize, usize) -> bool,
    ) -> Option<(f64, Place)> {
        let mut mismatch = 0.0;
        for unknown in self.curves.smooth() {
            let by = |k: i32| part(k, SCALE_STEPS) * SCALE_RANGE;
            let model = self.model.with_errors(self.modes, &self.errors(&place));
            let of_line =
                |k: usize| AlongUnknown::new(self, (&model, &place), self.lines[k], (unknown, by(most)));
            let along: Vec<AlongUnknown> =
                map(self.for_each, self.lines.len(), of_line).into_iter().collect::<Option<_>>()?;
            let scaled = |k: i32| -> Option<f64> {
                let respond = |(&i, along): (&usize, &AlongUnknown)| {
                    Some(self.curves.shown(&place, self.omegas[i], &along.respond(by(k))?))
                };
                let shown: Vec<Vec<c64>> =
                    self.lines.iter().zip(&along).map(respond).collect::<Option<_>>()?;
                let of_sensor = |m: usize| self.mismatch(shown.iter().map(|x| x[m]), m, used);
                Some((0..self.sensors()).map(of_sensor).sum())
            };
            let each = (-most..=most).filter_map(|k| Some((scaled(k)?, k)));
            let (least, k) = each.min_by(|a, b| a.0.total_cmp(&b.0))?;
            mismatch = least;
            self.curves.scale(&mut place, unknown, by(k));
        }
        Some((mismatch, place))
    }

    fn with_best_frequencies(&self, place: Place, used: &dyn Fn(usize, usize) -> bool) -> Option<Place> {
        self.with_best_frequencies_of(place, &self.modes_up_to_band(), used)
    }

    pub(super) fn with_best_frequencies_of(
        &self,
        mut place: Place,
        wanted: &[usize],
        used: &dyn Fn(usize, usize) -> bool,
    ) -> Option<Place> {
        let omega = &self.modes.omega_rad_s;
        let up_to_band = self.modes_up_to_band();
        for &mode in wanted {
            // Where lines are far apart those up to the next mode say where this one is.
            let others = up_to_band.iter().filter(|&&other| omega[other] != omega[mode]);
            let gap = others.map(|&other| (omega[other] / omega[mode] - 1.0).abs()).fold(1.0, f64::min);
            let near =
                |&line: &usize| (self.omegas[line] / omega[mode] - 1.0).abs() <= gap.max(FREQUENCY_RANGE);
            let lines: Vec<usize> = self.lines.iter().copied().filter(near).collect();
            place = Fitting { lines: &lines, ..*self }.with_best_frequency(place, mode, used)?;
        }
        Some(place)
    }

    fn with_best_frequency(
        &self,
        mut place: Place,
        mode: usize,
        used: &dyn Fn(usize, usize) -> bool,
    ) -> Option<Place> {
        let Some(error) = self.modes.frequency_errors(mode).next() else { return Some(place) };
        let coordinate = self.first_own() + error;
        place[self.first_load() + mode] = 0.0;
        let errors = self.errors(&place);
        let model = self.model.with_errors(self.modes, &errors);
        let along = |k: usize| -> Option<AlongMode> {
            let i = self.lines[k];
            let (values, _) = self.curves.values(&place, i, self.omegas[i])?;
            let point = (self.point)(i, &values)?;
            model.along_mode((self.modes, &errors), error, &point.at, point.correction).ok()
        };
        let along: Vec<AlongMode> =
            map(self.for_each, self.lines.len(), along).into_iter().collect::<Option<_>>()?;
        let moved = |k: i32| -> (f64, f64, Vec<f64>) {
            let by = part(k, FREQUENCY_STEPS) * FREQUENCY_RANGE;
            let change = self.modes.change(error, errors.stiffness[error] + by)[0].re;
            let (mismatch, shares) = self.with_best_shapes(&place, &along, change, used);
            (mismatch + ((place[coordinate] + by) / UNUSUAL_ERROR).powi(2), by, shares)
        };
        let each = (-FREQUENCY_STEPS..=FREQUENCY_STEPS).map(moved);
        let (_, by, shares) = each.min_by(|a, b| a.0.total_cmp(&b.0))?;
        place[coordinate] += by;
        for (m, share) in shares.iter().enumerate() {
            place[self.first_shape(m) + mode] += share - 1.0 - errors.shape[m][mode];
        }
        Some(place)
    }

    /// What sensors show of a mode whose natural frequency is elsewhere, over what they should, so that least of the measured response is left, relative to
    /// that; and the mismatch then.
    fn with_best_shapes(
        &self,
        place: &[f64],
        along: &[AlongMode],
        change: f64,
        used: &dyn Fn(usize, usize) -> bool,
    ) -> (f64, Vec<f64>) {
        let shown = |(&i, along): (&usize, &AlongMode)| -> [Vec<c64>; 2] {
            let (without, own): (Vec<c64>, Vec<c64>) =
                along.at(change).map(|[without, own]| (without, own)).unzip();
            [without, own].map(|x| self.curves.shown(place, self.omegas[i], &x))
        };
        let shown: Vec<[Vec<c64>; 2]> = self.lines.iter().zip(along).map(shown).collect();
        let mut mismatch = 0.0;
        let best = |m: usize| {
            let (mut of_mode, mut square) = (0.0, 0.0);
            for (&i, [without, own]) in self.lines.iter().zip(&shown).filter(|(i, _)| used(**i, m)) {
                let u = self.measured[i][m];
                of_mode += (own[m].conj() * (u - without[m])).re / u.norm_sqr();
                square += own[m].norm_sqr() / u.norm_sqr();
            }
            let share = Some(of_mode / square).filter(|share| share.is_finite()).unwrap_or(1.0);
            let share = share.clamp(-MAX_SHARE, MAX_SHARE);
            mismatch +=
                self.mismatch(shown.iter().map(|[without, own]| without[m] + share * own[m]), m, used);
            share
        };
        let shares = (0..self.sensors()).map(best).collect();
        (mismatch, shares)
    }

    /// The mismatch of a sensor's response at the lines and the measured one: of each line 0 where they are the same, and 2 at most.
    fn mismatch(
        &self,
        shown: impl Iterator<Item = c64>,
        m: usize,
        used: &dyn Fn(usize, usize) -> bool,
    ) -> f64 {
        let bounded = |u: c64, x: c64| (u - x).norm_sqr() / (u.norm_sqr() + x.norm_sqr());
        let lines = self.lines.iter().zip(shown).filter(|(i, _)| used(**i, m));
        lines.map(|(&i, x)| bounded(self.measured[i][m], x)).filter(|mismatch| mismatch.is_finite()).sum()
    }
}

/// The response at a line along the values of one unknown, on its Krylov space: each value costs some divisions.
struct AlongUnknown {
    response: RationalResponse,
    poles: Option<Poles>,
    /// The value, and the correction that it is.
    value: c64,
    correction: c64,
}

impl AlongUnknown {
    /// Good for values up to exp(±range) times the one that there is; `None` where the reduced system is singular.
    fn new(
        fitting: &Fitting<'_, '_>,
        (model, place): (&Projection, &[f64]),
        line: usize,
        (unknown, range): (usize, f64),
    ) -> Option<Self> {
        let (values, _) = fitting.curves.values(place, line, fitting.omegas[line])?;
        let Point { at, correction } = (fitting.point)(line, &values)?;
        at.parameters.get(unknown)?;
        let system = model.at(&at).ok()?;
        // Other unknowns than the first have their values as nominal ones.
        let correction = if unknown == 0 { correction } else { c64::default() };
        let mut order = FIRST_ORDER;
        let mut response = RationalResponse::new(&system, unknown, order).ok()?;
        let far = [range, -range].map(|by| correction + values[unknown] * by.exp_m1());
        let is_good =
            |response: &RationalResponse, c| response.residual(c).is_ok_and(|rest| rest <= MAX_RESIDUAL);
        let is_whole = |response: &RationalResponse, order| response.is_complete() || order >= system.dim();
        while !is_whole(&response, order) && !far.iter().all(|&c| is_good(&response, c)) {
            order *= 2;
            response = response.extended(&system, unknown, order).ok()?;
        }
        let poles = response.poles().ok()?;
        Some(Self { response, poles, value: values[unknown], correction })
    }

    /// x_m with exp(by) times the value.
    fn respond(&self, by: f64) -> Option<Vec<c64>> {
        let correction = self.correction + self.value * by.exp_m1();
        match &self.poles {
            Some(poles) => Some(poles.respond(correction)),
            None => self.response.respond(correction).ok(),
        }
    }
}

/// Part of a range, finer near where one is.
fn part(step: i32, steps: i32) -> f64 {
    let part = f64::from(step) / f64::from(steps);
    part * part.abs()
}
