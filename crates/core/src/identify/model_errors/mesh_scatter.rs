//! What the mesh adds to the errors of single modes.

use super::fitting::Fitting;

/// Standard deviation of the part of the mesh's error of a mode over that of all modes: they converge by somewhat different orders.
const ORDER_SCATTER: f64 = 0.3;

impl Fitting<'_, '_> {
    /// Δ_mi of the coordinate of an a, zero of any other: what of the amplitude of the mesh's error it has.
    pub(super) fn between_shapes(&self, coordinate: usize) -> f64 {
        let Some(mesh) = self.mesh else { return 0.0 };
        match coordinate.checked_sub(self.shapes().start) {
            Some(place) => {
                let (at, mode) = (place / self.modes(), place % self.modes());
                at.checked_sub(1).map_or(mesh.load[mode], |sensor| mesh.shape[sensor][mode])
            }
            None => 0.0,
        }
    }

    /// The standard deviation that the mesh adds to an own δ or a: modes converge by somewhat different orders, and those without a partner by an unknown one.
    /// Without a coarser mesh it is the least that any mesh adds to a δ.
    pub(super) fn scatter_of_mesh(&self, coordinate: usize) -> f64 {
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
