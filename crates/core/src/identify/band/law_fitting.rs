//! What a law is fitted to: a band, its sensors, and what of their channels is to be found.

use crate::frequency::omega_rad_s;
use crate::identify::channel::ChannelUnknowns;
use crate::identify::context::Context;
use crate::identify::measured::Band;
use crate::identify::options::Options;
use crate::model::ModelAt;

/// What is to be explained, and with what.
#[derive(Clone, Copy)]
pub(super) struct Fitting<'t, 'a> {
    pub(super) band: &'t Band<'a>,
    pub(super) at: &'t [ModelAt<'a>],
    /// Of real and imaginary part each.
    pub(super) sigma: &'t [Vec<f64>],
    /// What of each sensor's channel is to be found.
    pub(super) unknown: &'t [ChannelUnknowns],
    /// Of a factor over the nominal one that has the shape of what was measured.
    pub(super) ratio: f64,
    pub(super) options: &'t Options,
    pub(super) context: Context<'t>,
}

impl Fitting<'_, '_> {
    pub(super) fn omega(&self, i: usize) -> f64 {
        omega_rad_s(self.band.frequency_hz[i])
    }
}
