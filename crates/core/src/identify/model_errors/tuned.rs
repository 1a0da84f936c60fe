//! Unknowns and natural frequencies one after the other, each tried all over its range.
//!
//! A mode that is off by many half-widths has no slope towards its place, and descent leaves it at a wrong one. Here the response is compared with the measured
//! one by a measure that is bounded at each line,
//! $$ \sum_{k,m} \frac{|u_m - x_m|^2}{|u_m|^2 + |x_m|^2} $$
//! so that a few resonances at wrong places do not hide that everything between them is right.

use super::search::{Fitting, Place};
use crate::c64;

/// By how much an unknown as a whole is changed, in its logarithm, and in how many steps to either side.
const SCALE_RANGE: f64 = 0.3;
const SCALE_STEPS: i32 = 100;

/// How far off a natural frequency is looked for, and in how many steps to either side: up to 1 % each is a half-width of a loss factor of 0.2 %.
const FREQUENCY_RANGE: f64 = 0.03;
const FREQUENCY_STEPS: i32 = 30;

/// An error of a natural frequency that counts as much as a line at which nothing fits.
const UNUSUAL_ERROR: f64 = 0.05;

/// How often all of them are gone through: where one is at a wrong place its neighbours have other shapes.
const SWEEPS: usize = 3;

/// What a sensor shows of a mode, over what it should: near a node of its shape that may be anything.
const MAX_SHARE: f64 = 3.0;

impl Fitting<'_, '_> {
    /// From a place to the least mismatch with the measured response, coordinate after coordinate: each smooth unknown as a whole, then each natural
    /// frequency of the band by the lines about it, with the shapes that suit best there. `used` says which (line, sensor) count.
    pub(super) fn tuned(&self, mut place: Place, used: &dyn Fn(usize, usize) -> bool) -> Option<Place> {
        for _ in 0..SWEEPS {
            place = self.with_best_scales(place, used)?;
            place = self.with_best_frequencies(place, used)?;
        }
        Some(place)
    }

    fn with_best_scales(&self, mut place: Place, used: &dyn Fn(usize, usize) -> bool) -> Option<Place> {
        for unknown in self.curves.smooth() {
            let scaled = |k: i32| -> Option<(f64, Place)> {
                let mut there = place.clone();
                self.curves.scale(&mut there, unknown, part(k, SCALE_STEPS) * SCALE_RANGE);
                let shown = self.responses(&there)?;
                Some(((0..self.sensors()).map(|m| self.mismatch(&shown, m, used)).sum(), there))
            };
            place = least((-SCALE_STEPS..=SCALE_STEPS).filter_map(scaled))?;
        }
        Some(place)
    }

    fn with_best_frequencies(&self, mut place: Place, used: &dyn Fn(usize, usize) -> bool) -> Option<Place> {
        let omega = &self.modes.omega_rad_s;
        let in_band = |&i: &usize| omega[i] > 0.0 && omega[i] <= self.highest_rad_s;
        let modes: Vec<usize> = (0..self.modes()).filter(in_band).collect();
        for &mode in &modes {
            // Where lines are far apart those up to the next mode say where this one is.
            let others = modes.iter().filter(|&&other| omega[other] != omega[mode]);
            let gap = others.map(|&other| (omega[other] / omega[mode] - 1.0).abs()).fold(1.0, f64::min);
            let near =
                |&line: &usize| (self.omegas[line] / omega[mode] - 1.0).abs() <= gap.max(FREQUENCY_RANGE);
            let lines: Vec<usize> = self.lines.iter().copied().filter(near).collect();
            let about = Fitting { lines: &lines, ..*self };
            let Some(error) = self.modes.frequency_errors(mode).next() else { continue };
            let coordinate = self.first_own() + error;
            let moved = |k: i32| -> Option<(f64, Place)> {
                let mut there = place.clone();
                there[coordinate] += part(k, FREQUENCY_STEPS) * FREQUENCY_RANGE;
                let unusual = (there[coordinate] / UNUSUAL_ERROR).powi(2);
                let (mismatch, there) = about.with_best_shapes(there, mode, used)?;
                Some((mismatch + unusual, there))
            };
            place = least((-FREQUENCY_STEPS..=FREQUENCY_STEPS).filter_map(moved))?;
        }
        Some(place)
    }

    /// A place with the shapes of a mode at the sensors that leave least of the measured response, relative to that, and their mismatch then.
    fn with_best_shapes(
        &self,
        mut place: Place,
        mode: usize,
        used: &dyn Fn(usize, usize) -> bool,
    ) -> Option<(f64, Place)> {
        place[self.first_load() + mode] = 0.0;
        let mut with_share = |share: f64| {
            (0..self.sensors()).for_each(|m| place[self.first_shape(m) + mode] = share - 1.0);
            self.responses(&place)
        };
        let (without, with) = (with_share(0.0)?, with_share(1.0)?);
        let mut mismatch = 0.0;
        for m in 0..self.sensors() {
            let (mut of_mode, mut square) = (0.0, 0.0);
            let lines = self.lines.iter().zip(without.iter().zip(&with));
            for (&i, (without, with)) in lines.filter(|(i, _)| used(**i, m)) {
                let (u, own) = (self.measured[i][m], with[m] - without[m]);
                of_mode += (own.conj() * (u - without[m])).re / u.norm_sqr();
                square += own.norm_sqr() / u.norm_sqr();
            }
            let share = Some(of_mode / square).filter(|share| share.is_finite()).unwrap_or(1.0);
            let share = share.clamp(-MAX_SHARE, MAX_SHARE);
            let between = |(x, y): (&Vec<c64>, &Vec<c64>)| -> Vec<c64> {
                x.iter().zip(y).map(|(x, y)| x + share * (y - x)).collect()
            };
            let shown: Vec<Vec<c64>> = without.iter().zip(&with).map(between).collect();
            mismatch += self.mismatch(&shown, m, used);
            place[self.first_shape(m) + mode] = share - 1.0;
        }
        Some((mismatch, place))
    }

    /// The mismatch of a sensor's response at the lines and the measured one: of each line 0 where they are the same, and 2 at most.
    fn mismatch(&self, shown: &[Vec<c64>], m: usize, used: &dyn Fn(usize, usize) -> bool) -> f64 {
        let bounded = |u: c64, x: c64| (u - x).norm_sqr() / (u.norm_sqr() + x.norm_sqr());
        let lines = self.lines.iter().zip(shown).filter(|(i, _)| used(**i, m));
        lines.map(|(&i, x)| bounded(self.measured[i][m], x[m])).filter(|mismatch| mismatch.is_finite()).sum()
    }
}

/// Part of a range, finer near where one is.
fn part(step: i32, steps: i32) -> f64 {
    let part = f64::from(step) / f64::from(steps);
    part * part.abs()
}

fn least(each: impl Iterator<Item = (f64, Place)>) -> Option<Place> {
    Some(each.min_by(|a, b| a.0.total_cmp(&b.0))?.1)
}
