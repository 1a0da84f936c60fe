//! The sandwich panel of benchmarks over the size of the model.

use frfit_examples::{Error, Model, sandwich};

/// The sandwich of the example with `nx` elements along it, an eighth of them across and four through the thickness.
///
/// # Errors
/// As [`sandwich`].
pub fn panel(nx: usize) -> Result<Model, Error> {
    sandwich(nx, nx / 8, 2)
}

/// Its degrees of freedom, before it is made.
pub fn panel_dofs(nx: usize) -> usize {
    15 * nx * (nx / 8 + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_of_freedom_are_those_of_the_panel() {
        for nx in [8, 20] {
            assert_eq!(panel(nx).unwrap().stiffness.dim(), panel_dofs(nx));
        }
    }
}
