//! Errors of the model, estimated with the factor (B-11).
//!
//! A model's natural frequencies are some tenths of a per cent off, its mode shapes and the factors of its known parts some per cent. A factor that is
//! fitted to each frequency alone absorbs all of these errors. A band separates the two: each mode has one real error over its whole resonance,
//! a material has one smooth complex modulus. What is searched: a smooth ln E(ω; θ) (a law, or a spline), and relative errors δ_i = e + d_i of natural frequencies, a_mi of mode shapes at
//! the sensors, g_m of calibrations, ν_t of known factors (and Δη_t of their loss factors). On the reduced model
//! $$ \sum_{k,m} \frac{|u_m - x_m(\omega_k; \theta, \delta, a, \nu)|^2}{\sigma_m^2} + \frac{e^2 + \sum_i d_i^2}{s^2} + \frac{\sum a_{mi}^2}{s_a^2} + \frac{\sum g_m^2}{s_g^2} + \frac{\sum \nu_t^2}{s_\nu^2} $$
//! is made least, with the noise approached from above; s, s_a and s_g are those of largest evidence. Whether there are errors at all is decided by
//! the evidence of three explanations: a smooth modulus and a right model, a modulus that scatters from line to line and a right model, a smooth modulus and errors.
//! It is a right model only where it is better by some nats. Of several unknowns each is a constant, a law or a spline.
//!
//! The errors of a mesh grow with ω_i, those of a support fall with 1/ω_i²: e is a sum of such parts, and so is what loss factors have in common. A rigid body has no stiffness that could be in error; its δ is that of a
//! support that the model does not have. An error that all loss factors have in common is one of the unknown, Re p + i(1 + ε) Im p.
//!
//! A file uses files of its own line and of lines above, and none of a line below:
//!
//! | file | contents |
//! |---|---|
//! | `natural_spline`, `causality`, `curve` | unknowns over the band: constants, laws, smooth curves |
//! | `mesh`, `found` | what lies between two meshes, and what is reported of errors |
//! | `kinds`, `sizes`, `factor_prior` | kinds of errors, and what is known of their sizes before the data |
//! | `whitening` | what noise and errors leave of a response, made white |
//! | `measured` | what was measured, and what it says by itself |
//! | `fitting`, `prior` | what is fitted, which coordinate is what, and what is known of it before the data |
//! | `linearised`, `descent` | the responses near a place, and the way to a minimum |
//! | `plausible` | whether errors are small, and agree with what is taken for known |
//! | `shown_sizes`, `fit` | fits with the noise approached from above, and the sizes of largest evidence |
//! | `band_search` | what all fits of a band have in common |
//! | `tuned`, `paired` | other starts: coordinates one by one, and modes of the measurement |
//! | `small_errors`, `scatter` | the evidence of small errors, and of unknowns that scatter from line to line |
//! | `local_stiffness`, `modal_loss`, `estimated`, `posterior`, `split` | the answer with its covariance |
//! | `leverage` | how far an error of what is taken for known moves the unknowns |
//! | `error_search`, `explanation`, `laws`, `averaged` | what explains a band, and the entries |
//!
//! # Source
//! M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63 (2001) 425–464 (errors of a model beside its parameters); D. J. C. MacKay, Neural Comput. 4 (1992) 415–447
//! (evidence, and the number of well-determined parameters).

mod averaged;
mod band_search;
mod causality;
mod curve;
mod descent;
mod error_search;
mod estimated;
mod explanation;
mod factor_prior;
mod fit;
mod fitting;
mod found;
mod kinds;
mod laws;
mod leverage;
mod linearised;
mod local_stiffness;
mod measured;
mod mesh;
mod modal_loss;
mod natural_spline;
mod paired;
mod plausible;
mod posterior;
mod prior;
mod scatter;
mod shown_sizes;
mod sizes;
mod small_errors;
mod split;
mod tuned;
mod whitening;

pub(super) use averaged::{AveragedModel, averaged_over_small_errors};
pub(super) use curve::{Curve, Curves, Spline};
pub(super) use estimated::{Estimated, covariance};
pub(super) use explanation::{Explanation, estimate};
pub use found::{
    Assumption, CalibrationError, ContradictedAssumption, FactorError, Leverage, LeverageOf, ModeError,
    ModelErrorsFound, SensorMass,
};
pub(super) use laws::{estimate_beside_a_smooth_modulus, estimate_with_laws};
pub(super) use measured::{Measured, NoiseScale, PointAt};
pub(super) use mesh::Coarser;
pub use mesh::MeshError;
pub(super) use split::Split;
