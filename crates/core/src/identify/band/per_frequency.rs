//! Each frequency alone, on the full model or on the subspace.

use super::neighbourhoods::{MAX_REDUCTION_ERROR, Neighbourhoods, reduction_error};
use super::outcome::BandOutcome;
use crate::for_each::map;
use crate::identify::context::{Context, Stage};
use crate::identify::measured::Band;
use crate::identify::one::identify_at;
use crate::identify::options::Options;
use crate::identify::outcome::{Line, Status};
use crate::model::ModelAt;
use crate::response::{FullModel, Work};
use crate::subspace::Projection;
use frfit_linalg::solve::Breakdown;
use std::sync::atomic::{AtomicUsize, Ordering};

pub(super) fn identify(
    band: &Band<'_>,
    at: &[ModelAt<'_>],
    reduced: Option<&mut Neighbourhoods<'_, '_>>,
    options: &Options,
    context: Context<'_>,
) -> BandOutcome {
    let broken = |i: usize, breakdown: Breakdown| {
        Line::broken(band.frequency_hz[i], &[at[i].parameters[0].nominal], options.order, breakdown)
    };
    match reduced {
        Some(reduced) => {
            let find = |i: usize, model: &Projection| match model.at(&at[i]) {
                Ok(system) => identify_at(&system, &band.measured[i], band.unknown, options),
                Err(breakdown) => broken(i, breakdown),
            };
            let answers = |found: &[Line]| {
                let corrections =
                    found.iter().enumerate().filter_map(|(i, line)| Some((i, line.correction()?)));
                corrections.collect()
            };
            let all: Vec<usize> = (0..at.len()).collect();
            let found = reduced.find(&all, context, find);
            let found = reduced.certify(&all, found, context, |i, model, _| find(i, model), answers);
            let lines = found.into_iter().enumerate().map(|(i, mut line)| {
                if let Some(correction) = line.correction() {
                    let assessed = reduced.assess(i, correction);
                    let certified =
                        assessed.map(|a| reduction_error(&a, line.nominal() + correction, &band.measured[i]));
                    line.reduction_error =
                        certified.map(|certified| certified.response).filter(|c| c.is_finite());
                    if line.status == Status::Ok && certified.is_none_or(|c| c.factor > MAX_REDUCTION_ERROR) {
                        line.status = Status::Failed;
                    }
                }
                line
            });
            BandOutcome::of_lines(lines.collect(), reduced.work(), Some(reduced.size()), at.len())
        }
        None => {
            let done = AtomicUsize::new(0);
            let lines = map(context.for_each, at.len(), |i| {
                let line = match FullModel::new(at[i].clone(), band.experiment) {
                    Ok(system) => identify_at(&system, &band.measured[i], band.unknown, options),
                    Err(breakdown) => broken(i, breakdown),
                };
                (context.progress)(Stage::Solutions, done.fetch_add(1, Ordering::Relaxed) + 1, at.len());
                line
            });
            let mut work = Work::default();
            lines.iter().for_each(|line| work += line.work);
            BandOutcome::of_lines(lines, work, None, at.len())
        }
    }
}
