//! What is known of curves and errors before the data: the prior of a fit.

use super::fitting::Fitting;
use super::kinds::Damping;
use super::sizes::{Sizes, UNDAMPED_SHARE_RATIO};

/// The standard deviation of an error that is not searched: practically zero.
pub(super) const NEGLIGIBLE_STD: f64 = 1e-7;

/// Standard deviation of δ of a rigid body: a usual suspension has natural frequencies below a third of the first other one.
const RIGID_BODY_STD: f64 = 0.05;

/// Standard deviation of the mean error of the shapes at a place whose scale is unknown: practically zero.
const MEAN_SHAPE_STD: f64 = 1e-3;

/// Standard deviation of the part of the mesh's error of a mode over that of all modes: they converge by somewhat different orders.
const ORDER_SCATTER: f64 = 0.3;

impl Fitting<'_, '_> {
    /// What a coordinate is before the data.
    pub(super) fn expected(&self, coordinate: usize) -> f64 {
        match self.of_mesh().filter(|(place, _)| *place == coordinate) {
            Some((_, mesh)) => mesh.remainder,
            None => self.centre.get(coordinate).copied().unwrap_or(0.0),
        }
    }

    /// The prior's precision, n × n: curve and errors.
    pub(super) fn precision(&self, sizes: &Sizes) -> Vec<f64> {
        let (n, own) = (self.count(), self.curves.count());
        let mut all = vec![0.0; n * n];
        let curve = self.curves.precision(self.centre, sizes.bend);
        for i in 0..own {
            all[i * n..i * n + own].copy_from_slice(&curve[i * own..(i + 1) * own]);
        }
        let mut set = |i: usize, std: f64| all[i * n + i] = std.powi(-2);
        let least = |i: usize| if self.is_of_mesh(i) { self.known.least_of_mesh } else { 0.0 };
        // The scale. Further groups have places for one too, which nothing hangs on.
        self.in_common(true).for_each(|i| set(i, sizes.scale));
        for (kind, size) in sizes.trends.iter().enumerate() {
            self.trend(kind).for_each(|i| set(i, size.max(least(i))));
        }
        let only_if = |is_looked_for: bool, std: f64| if is_looked_for { std } else { NEGLIGIBLE_STD };
        let damping = |std: f64| only_if(self.kinds.damping == Damping::Own, std);
        let common_loss = |i: usize| {
            let std = sizes.common_loss.max(UNDAMPED_SHARE_RATIO * least(i));
            only_if(self.kinds.damping != Damping::None, std)
        };
        let mass = only_if(self.kinds.masses, sizes.mass);
        self.in_common(false).for_each(|i| set(i, common_loss(i)));
        // No response shows the error of the unknown's loss factor, however little there is of errors of damping.
        let of_unknown = sizes.common_loss.max(self.known.least_of_unknown_loss);
        self.of_unknown_loss().into_iter().for_each(|i| set(i, of_unknown));
        if let Some((place, mesh)) = self.of_mesh() {
            set(place, mesh.remainder);
        }
        let own = |i: usize| match (self.is_frequency(i), self.is_rigid(i)) {
            (true, false) => (sizes.frequency * self.growth(i)).hypot(self.scatter_of_mesh(i)),
            (false, false) => damping(sizes.loss_factor * self.growth(i)),
            (true, true) => RIGID_BODY_STD,
            // Of a support without damping ε is −2δ.
            (false, true) => damping(2.0 * RIGID_BODY_STD),
        };
        self.own().for_each(|i| set(i, own(i)));
        (self.first_factor()..).zip(self.factors).for_each(|(i, prior)| set(i, prior.std));
        self.masses().for_each(|i| set(i, mass));
        self.gains().for_each(|i| set(i, sizes.calibration));
        self.shapes().for_each(|i| set(i, (sizes.shape * self.growth(i)).hypot(self.scatter_of_mesh(i))));
        for weights in self.means_of_shapes() {
            for (i, a) in &weights {
                weights.iter().for_each(|(j, b)| all[i * n + j] += a * b / MEAN_SHAPE_STD.powi(2));
            }
        }
        all
    }

    /// The mean error of the shapes of the band at each place whose scale is unknown, as coordinates with their weights: the scale is what they have in common.
    fn means_of_shapes(&self) -> Vec<Vec<(usize, f64)>> {
        let lowest_rad_s = self.omegas.iter().copied().find(|omega| *omega > 0.0).unwrap_or(0.0);
        let is_in_band = |&mode: &usize| self.modes.omega_rad_s[mode] >= lowest_rad_s;
        let in_band: Vec<usize> = self.modes_up_to_band().into_iter().filter(is_in_band).collect();
        let mean = |first: usize| {
            let weights = in_band.iter().map(|&mode| (first + mode, 1.0 / self.growth(first + mode)));
            let all: f64 = weights.clone().map(|(_, weight)| weight).sum();
            weights.map(|(coordinate, weight)| (coordinate, weight / all)).collect()
        };
        let of_unknown_scale = self.curves.channels().of_unknown_scale();
        let of_load = (of_unknown_scale.len() == self.sensors()).then(|| self.first_load());
        let of_sensors = of_unknown_scale.iter().map(|&m| self.first_shape(m));
        if in_band.is_empty() {
            Vec::new()
        } else {
            of_load.into_iter().chain(of_sensors).map(mean).collect()
        }
    }

    /// The standard deviation that the mesh adds to an own δ or a: modes converge by somewhat different orders, and those without a partner by an unknown one.
    /// Without a coarser mesh it is the least that any mesh adds to a δ.
    fn scatter_of_mesh(&self, coordinate: usize) -> f64 {
        let is_own = self.own().contains(&coordinate);
        let mode = self.mode_of(coordinate);
        let Some(mesh) = self.mesh else {
            let least = if is_own { self.known.least_of_modes } else { 0.0 };
            return least * self.over_highest_squared(mode);
        };
        let between = match mesh.is_paired(mode) {
            true if is_own => mesh.largest_below[mode],
            true => self.between_shapes(coordinate).abs(),
            false => mesh.usual * self.growth(coordinate),
        };
        ORDER_SCATTER * mesh.remainder * between
    }
}
