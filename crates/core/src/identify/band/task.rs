//! What is to be explained in a band, and the choice among what was found.

use super::candidates::{Candidates, Fit, Solution};
use crate::c64;
use crate::identify::context::{Context, Stage};
use crate::identify::measured::Band;
use crate::identify::noise::{NoiseLevel, freedom, of_scatter, of_sensors};
use crate::identify::options::Options;
use crate::model::ModelAt;
use crate::select::{Choice, Node, SelectOptions, choose};

/// What is to be done, and with what.
pub(super) struct Task<'t, 'a> {
    pub(super) band: &'t Band<'a>,
    pub(super) at: &'t [ModelAt<'a>],
    /// σ of real and imaginary part each, `[frequency][sensor]`; infinite for a sensor that is left out.
    pub(super) sigma: &'t [Vec<f64>],
    /// Sensors that are not left out.
    pub(super) sensors: usize,
    pub(super) options: &'t Options,
    pub(super) context: Context<'t>,
}

/// One path through some frequencies.
pub(super) struct PathSelection {
    /// The choice at each.
    pub(super) choices: Vec<Choice>,
    /// Noise over σ.
    pub(super) level: Option<f64>,
}

impl PathSelection {
    /// The place and the factor of each frequency at which something is chosen.
    pub(super) fn path(&self, found: &[Candidates], nominal: impl Fn(usize) -> c64) -> Vec<(usize, c64)> {
        let chosen = |(k, choice): (usize, &Choice)| {
            Some((k, nominal(k) + found[k].solutions[choice.chosen?].correction))
        };
        self.choices.iter().enumerate().filter_map(chosen).collect()
    }
}

/// ln of the factor to which a path (place, factor) leads at a place: between its neighbours, or where the nearest one is.
pub(super) fn led_to(path: &[(usize, c64)], place: usize) -> Option<c64> {
    let after = path.partition_point(|&(k, _)| k < place);
    let neighbours = [after.checked_sub(1), Some(after)].map(|k| k.and_then(|k| path.get(k)));
    match neighbours {
        [Some(&(a, from)), Some(&(b, to))] => {
            Some(from.ln() + (to.ln() - from.ln()) * ((place - a) as f64 / (b - a) as f64))
        }
        [one, other] => one.or(other).map(|&(_, factor)| factor.ln()),
    }
}

/// What was found at every frequency, at how many frequencies all solutions were searched, and what was chosen.
pub(super) struct BandSolution {
    pub(super) found: Vec<Candidates>,
    pub(super) explored: usize,
    pub(super) selected: PathSelection,
}

impl Task<'_, '_> {
    /// Degrees of freedom of χ² at a frequency.
    pub(super) fn freedom(&self) -> usize {
        freedom(self.sensors, self.band.unknown.real)
    }

    /// What is to be explained at a frequency.
    pub(super) fn fit(&self, i: usize) -> Fit<'_> {
        let nominal = self.at[i].parameters[0].nominal;
        let Band { measured, unknown, .. } = *self.band;
        Fit { measured: &measured[i], sigma: &self.sigma[i], nominal, unknown, options: self.options }
    }

    /// How large the noise is, by all answers.
    pub(super) fn noise_level(&self, found: &[Candidates], choices: &[Choice]) -> NoiseLevel {
        let nominal = |i: usize| self.at[i].parameters[0].nominal;
        let nodes: Vec<Vec<Node>> = (0..found.len()).map(|i| nodes(&found[i], nominal(i))).collect();
        let chosen: Vec<Option<Node>> =
            nodes.iter().zip(choices).map(|(nodes, choice)| choice.chosen.map(|k| nodes[k])).collect();
        NoiseLevel::new(
            self.band.noise,
            of_sensors(&nodes, choices, self.freedom()),
            of_scatter(self.band.frequency_hz, &chosen, self.band.unknown.real),
        )
        .with_common(chosen.iter().flatten().count())
    }

    /// The choice among what was found at some frequencies.
    pub(super) fn select<'e>(
        &self,
        which: &[usize],
        found: impl Iterator<Item = &'e Candidates>,
    ) -> PathSelection {
        (self.context.progress)(Stage::Selection, 0, self.at.len());
        let frequency_hz: Vec<f64> = which.iter().map(|&i| self.band.frequency_hz[i]).collect();
        let nodes: Vec<Vec<Node>> = which
            .iter()
            .zip(found)
            .map(|(&i, found)| nodes(found, self.at[i].parameters[0].nominal))
            .collect();
        let options = SelectOptions { sensors: self.sensors, sigma_known: self.band.noise.is_known() };
        let choices = choose(&frequency_hz, &nodes, &options);
        let level = of_sensors(&nodes, &choices, self.freedom());
        let level = level.map(|level| if options.sigma_known { 1.0 } else { level });
        PathSelection { choices, level }
    }
}

fn nodes(found: &Candidates, nominal: c64) -> Vec<Node> {
    let node = |s: &Solution| Node { factor: nominal + s.correction, misfit: s.misfit, std: s.std };
    found.solutions.iter().map(node).collect()
}
