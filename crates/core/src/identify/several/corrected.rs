//! A band once more, corrected for the errors of the model, which are carried into every error bar (B-11).

use super::Task;
use super::at_frequency::{Solution, eliminate};
use super::coordinates::Own;
use super::neighbourhoods::Neighbourhoods;
use super::search::{BandSolution, Begin};
use crate::c64;
use crate::for_each::map;
use crate::frfs::{Noise, standard_deviations};
use crate::identify::band::{MAX_TRAINING_ROUNDS, law_through};
use crate::identify::form::Form;
use crate::identify::identification::Identification;
use crate::identify::model_errors::{
    Coarser, Curve, Curves, Estimated, Explanation, Leverage, Measured, NoiseScale, Spline,
    averaged_over_small_errors, estimate, estimate_with_laws,
};
use crate::identify::noise::{beside, levels, without};
use crate::identify::options::ModelErrors;
use crate::identify::unknown::{Unknown, Variation};
use crate::subspace::{Corrected, Point};

impl Task<'_, '_> {
    /// What is found when the errors of the model are estimated and corrected for; the same where a right model explains the band as well.
    pub(super) fn correct(
        &self,
        reduced: &mut Neighbourhoods<'_>,
        solution: &BandSolution,
        mut found: Identification,
    ) -> Identification {
        let is_smooth = self.asked.has_smooth();
        if self.options.model_errors.is_exact(self.problem.model) && !is_smooth {
            return found;
        }
        let (explanation, small, leverage) = self.errors(reduced, solution, &found);
        found.leverage = leverage;
        let errors = match explanation {
            // No smooth curve was found.
            Explanation::RightModel if is_smooth => return found.of_other_model(),
            Explanation::RightModel => {
                let Some(errors) = small else { return found };
                reduced.correct(&errors.modes, &errors.errors, self.context.for_each);
                let judged = self.judge(reduced, solution, Some(&errors));
                return Identification { leverage: found.leverage, ..judged };
            }
            Explanation::OtherModel => return found.of_other_model(),
            Explanation::Errors(errors) => *errors,
        };
        let has_errors = small.is_none() && errors.has_errors();
        let errors = small.unwrap_or(errors);
        reduced.correct(&errors.modes, &errors.errors, self.context.for_each);
        let middle = self.omegas.len() / 2;
        let Some(values) = errors.values(middle, self.problem.frfs.frequency_hz[middle]) else {
            return found;
        };
        let of_band = solution.coordinates.each.iter().flat_map(|own| errors.range(own.unknowns));
        let theta = of_band.chain(errors.channels().range()).map(|c| errors.theta()[c]).collect();
        let begin = Begin { coordinates: solution.coordinates.clone(), theta };
        let task = self.with_rest(errors.rest);
        let again = match is_smooth {
            true => task.along_curves(reduced, begin, &errors),
            false => task.search_from(reduced, begin, &values),
        };
        let again = BandSolution { starts: solution.starts.clone(), agreeing: solution.agreeing, ..again };
        let judged = task.judge(reduced, &again, Some(&errors));
        let is_contradicted = !errors.contradicted_assumptions.is_empty();
        let judged = if is_contradicted { judged.of_other_model() } else { judged };
        Identification {
            model_errors: has_errors.then(|| errors.found()),
            leverage: found.leverage,
            ..judged
        }
    }

    /// Every frequency at the curves that were found.
    fn along_curves(
        &self,
        reduced: &mut Neighbourhoods<'_>,
        begin: Begin,
        errors: &Estimated,
    ) -> BandSolution {
        let all: Vec<usize> = (0..self.omegas.len()).collect();
        let on = |reduced: &Neighbourhoods<'_>, i: usize| -> Option<Solution> {
            let frequency_hz = self.problem.frfs.frequency_hz[i];
            let shown = |x| begin.coordinates.channels.shown(&begin.theta, frequency_hz, x);
            let respond = |values: &[c64]| reduced.respond_on(reduced.model(i), i, values).map(shown);
            self.at_frequency(i).at(&[], &errors.values(i, frequency_hz)?, respond)
        };
        let found = |reduced: &Neighbourhoods<'_>| -> BandSolution {
            let one = |i: usize| on(reduced, i).into_iter().collect();
            let solutions: Vec<Vec<Solution>> = map(self.context.for_each, all.len(), one);
            let chosen = self.choose(&all, &solutions);
            BandSolution::new(begin.clone(), solutions, chosen)
        };
        let mut solution = found(reduced);
        for _ in 0..MAX_TRAINING_ROUNDS {
            if !reduced.refine(&solution.answers(), self.context) {
                break;
            }
            solution = found(reduced);
        }
        solution
    }

    /// The task that was asked, in which the response has this part of itself beside the noise.
    fn with_rest(&self, rest: f64) -> Self {
        let levels = levels(self.problem.frfs.receptance, self.problem.frfs.frequency_hz);
        Self {
            omegas: self.omegas.clone(),
            sigma: beside(&self.sigma, rest, &levels),
            left_out: self.left_out.clone(),
            problem: self.asked,
            ..*self
        }
    }

    /// What explains the band; of a right model also errors too small to be seen that its bars hold; how far known factors move the unknowns.
    fn errors(
        &self,
        reduced: &Neighbourhoods<'_>,
        solution: &BandSolution,
        found: &Identification,
    ) -> (Explanation, Option<Estimated>, Vec<Leverage>) {
        let unknowns = self.problem.unknowns;
        // A law that is wrong is no error of the model: smooth curves in place of laws say whether there are any.
        let is_law = |j: usize| matches!(unknowns[j].varies, Variation::Law(_));
        let of = |j: usize| solution.coordinates.each.iter().find(|own| own.unknowns == j);
        let curves = |laws: bool| {
            let curve = |(j, one): (usize, &Unknown)| match of(j).filter(|_| laws || !is_law(j)) {
                Some(own) => Curve::Form(own.form.clone()),
                None => Curve::Spline(Spline::new(&self.omegas, one.real)),
            };
            let curves = Curves::new(unknowns.iter().enumerate().map(curve).collect());
            let curves = curves.with_channels(solution.coordinates.channels.clone());
            let bounded = solution.coordinates.each.iter().filter(|own| !is_law(own.unknowns));
            bounded.fold(curves, |curves, own| {
                curves.within(own.unknowns, &solution.coordinates.limits[own.range.clone()])
            })
        };
        let constants = solution.coordinates.each.iter().filter(|own| !is_law(own.unknowns));
        let constants: Vec<_> = constants.map(|own| own.range.clone()).collect();
        let given = |theta: &Vec<f64>| -> Vec<f64> {
            let ranges = constants.iter().cloned().chain([solution.coordinates.channels.range()]);
            ranges.flat_map(|range| &theta[range]).copied().collect()
        };
        // A search that knows of no errors may have ended far from the start that was right.
        let others = solution.starts.iter().filter(|start| start.coordinates == solution.coordinates);
        let given: Vec<Vec<f64>> =
            [&solution.theta].into_iter().chain(others.map(|start| &start.theta)).map(given).collect();
        let own: Vec<usize> = (0..unknowns.len()).filter(|&j| unknowns[j].per_frequency() > 0).collect();
        let point =
            |i: usize, values: &[c64]| Some(Point { at: reduced.at(i, values)?, correction: c64::default() });
        let measured = Measured {
            point: &point,
            omegas: &self.omegas,
            nominal: self.nominal,
            given: &given,
            given_sizes: self.options.model_errors.sizes(),
            coarser: self.problem.coarser.map(|mesh| Coarser { mesh, unknowns }),
            measured: self.problem.frfs.receptance,
            sigma: &self.sigma,
            size: &without(
                &standard_deviations(
                    self.problem.frfs.frequency_hz,
                    self.problem.frfs.receptance,
                    Noise::Unknown,
                ),
                &self.left_out,
            ),
            levels: &levels(self.problem.frfs.receptance, self.problem.frfs.frequency_hz),
            noise_scale: NoiseScale::of(self.problem.frfs.noise),
            free: &found.lines,
            own: &own,
            // What holds for the band cannot show the noise: it is part of what is to be explained.
            level_per_frequency: found.noise.level.filter(|_| !own.is_empty()),
            fit: found.fit,
            may_be_wrong: self.options.model_errors != ModelErrors::None,
            wants_curves: self.asked.has_smooth(),
        };
        let (explanation, leverage) =
            estimate(reduced.whole(), &measured, &curves(false), self.context.for_each);
        let small = |theta: Vec<f64>| -> Option<Estimated> {
            let (model, for_each) = (reduced.whole(), self.context.for_each);
            let small = averaged_over_small_errors(model, &measured, &curves(true), &theta, for_each)?;
            Some(small.estimated)
        };
        let beside_curves = |errors: &Estimated| {
            let is_right = !errors.has_errors();
            is_right.then(|| small(errors.theta().to_vec())).flatten()
        };
        let errors = match explanation {
            Explanation::Errors(errors) if (0..unknowns.len()).any(is_law) => errors,
            Explanation::Errors(errors) => {
                let small = beside_curves(&errors);
                return (Explanation::Errors(errors), small, leverage);
            }
            Explanation::RightModel => {
                // θ as a right model has it, with smooth curves for what has a value at each frequency.
                let ranges = solution.coordinates.each.iter().map(|own| own.range.clone());
                let ranges = ranges.chain([solution.coordinates.channels.range()]);
                let theta: Vec<f64> = ranges.flat_map(|range| &solution.theta[range]).copied().collect();
                let small = measured.through_answers(&curves(true), &theta).and_then(small);
                return (Explanation::RightModel, small, leverage);
            }
            Explanation::OtherModel => return (Explanation::OtherModel, None, leverage),
        };
        let with = |of_law: &dyn Fn(&Own) -> Vec<f64>| -> Vec<f64> {
            let theta = |j: usize| match of(j).filter(|_| is_law(j)) {
                Some(own) => of_law(own),
                None => errors.theta()[errors.range(j)].to_vec(),
            };
            let of_channels = errors.theta()[errors.channels().range()].iter().copied();
            (0..unknowns.len()).flat_map(theta).chain(of_channels).collect()
        };
        let of_right_model = |own: &Own| solution.theta[own.range.clone()].to_vec();
        let through = |own: &Own| match &own.form {
            Form::Law(law) => law_through(law, &errors, own.unknowns, self.problem.frfs.frequency_hz),
            _ => None,
        };
        let of_smooth = |own: &Own| through(own).unwrap_or_else(|| of_right_model(own));
        let starts = [with(&of_smooth), with(&of_right_model)];
        let with_laws = estimate_with_laws(
            reduced.whole(),
            &measured,
            &errors,
            &curves(true),
            &starts,
            self.context.for_each,
        );
        let small = with_laws.as_ref().and_then(beside_curves);
        let explanation =
            with_laws.map_or(Explanation::OtherModel, |found| Explanation::Errors(Box::new(found)));
        (explanation, small, leverage)
    }

    /// ∂y/∂(error) of a frequency's own coordinates, `[error][own]`.
    pub(super) fn moved_by_errors(
        &self,
        reduced: &Neighbourhoods<'_>,
        i: usize,
        found: &BandSolution,
        solution: &Solution,
    ) -> Option<Vec<Vec<f64>>> {
        let Corrected { modes, errors, model } = reduced.corrected()?;
        let at = reduced.at(i, &solution.values)?;
        let slopes = model.respond_with_error_slopes((modes, errors), &at, c64::default()).ok()?;
        let channels = &found.coordinates.channels;
        let slopes = slopes.shown(&channels.shares(&found.theta, self.problem.frfs.frequency_hz[i]));
        let sensors = self.sigma[i].len();
        let column = |of: &dyn Fn(usize) -> c64| -> Vec<f64> {
            (0..sensors).map(|m| of(m) / self.sigma[i][m]).flat_map(|v| [v.re, v.im]).collect()
        };
        let shared =
            |of: &[Vec<c64>]| -> Vec<f64> { (0..of[0].len()).flat_map(|k| column(&|m| of[m][k])).collect() };
        let shape = |at: usize| {
            let one = |k: usize| column(&|m| if m == at { slopes.shape[m][k] } else { c64::default() });
            (0..modes.omega_rad_s.len()).flat_map(one).collect::<Vec<f64>>()
        };
        let of_all = [&slopes.stiffness, &slopes.factors, &slopes.masses, &slopes.gains, &slopes.load];
        let in_common = slopes.in_common(modes);
        let mut columns: Vec<f64> = in_common.flat_map(|of_sensors| column(&|m| of_sensors[m])).collect();
        columns.extend(of_all.into_iter().flat_map(|of| shared(of)));
        columns.extend((0..sensors).flat_map(shape));
        let contained = eliminate(&solution.of_own, &mut columns, 2 * sensors);
        Some(contained.into_iter().map(|x| x.into_iter().map(|x| -x).collect()).collect())
    }
}
