//! Which of several solutions at each frequency are one and the same structure over the band.

use super::Task;
use super::at_frequency::{FrequencyProblem, Solution};
use crate::identify::unknown::Unknown;
use crate::least_squares::inverse_information;
use crate::select::{Choice, Node, SelectOptions, choose};

/// What is chosen at a frequency.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Chosen {
    pub(super) solution: Option<usize>,
    pub(super) rivals: Vec<usize>,
}

/// Values nearer than this part of themselves are one.
const VALUE_MERGE_RTOL: f64 = 1e-6;

impl Task<'_, '_> {
    /// The choice at each frequency. Every unknown that is per frequency chooses its own path by continuity and causality (B-4); one solution has to be on all of them.
    pub(super) fn choose(&self, which: &[usize], solutions: &[Vec<Solution>]) -> Vec<Chosen> {
        let own: Vec<usize> = (0..self.problem.unknowns.len())
            .filter(|&j| self.problem.unknowns[j].per_frequency() > 0)
            .collect();
        if own.is_empty() {
            let one = |found: &Vec<Solution>| Chosen {
                solution: (!found.is_empty()).then_some(0),
                ..Chosen::default()
            };
            return solutions.iter().map(one).collect();
        }
        let options = SelectOptions {
            sensors: self.problem.experiment.sensors.len() - self.left_out.len(),
            sigma_known: self.problem.frfs.noise.is_known(),
        };
        let frequency_hz: Vec<f64> = which.iter().map(|&i| self.problem.frfs.frequency_hz[i]).collect();
        let stds: Vec<Vec<Vec<f64>>> = solutions
            .iter()
            .zip(which)
            .map(|(found, &i)| found.iter().map(|solution| self.at_frequency(i).stds(solution)).collect())
            .collect();
        let of = |&j: &usize| -> Vec<Choice> {
            let node = |(solution, stds): (&Solution, &Vec<f64>)| Node {
                factor: solution.values[j],
                misfit: solution.misfit,
                std: stds[j],
            };
            let nodes = solutions.iter().zip(&stds);
            let nodes: Vec<Vec<Node>> =
                nodes.map(|(found, stds)| found.iter().zip(stds).map(node).collect()).collect();
            choose(&frequency_hz, &nodes, &options)
        };
        let choices: Vec<Vec<Choice>> = own.iter().map(of).collect();
        (0..solutions.len()).map(|i| self.agreed(i, &solutions[i], &own, &choices)).collect()
    }

    /// The solution that every unknown's path goes through; those that some path cannot exclude are its rivals.
    fn agreed(&self, i: usize, found: &[Solution], own: &[usize], choices: &[Vec<Choice>]) -> Chosen {
        let same = |j: usize, a: usize, b: usize| {
            let (a, b) = (found[a].values[j], found[b].values[j]);
            (a - b).norm() <= VALUE_MERGE_RTOL * a.norm()
        };
        let is_on = |k: usize, (&j, choices): (&usize, &Vec<Choice>)| {
            choices[i].chosen.is_some_and(|chosen| chosen == k || same(j, chosen, k))
        };
        let on_all: Vec<usize> =
            (0..found.len()).filter(|&k| own.iter().zip(choices).all(|both| is_on(k, both))).collect();
        let mut others: Vec<usize> = choices.iter().flat_map(|choices| choices[i].rivals.clone()).collect();
        others.sort_unstable();
        others.dedup();
        match on_all.first() {
            // By their misfit: the first is the best.
            Some(&best) => {
                others.retain(|&k| k != best);
                // A value of one unknown is an alternative only if the other unknowns of its solution admit it.
                let possible = |k: usize| {
                    own.iter().zip(choices).all(|(&j, choices)| {
                        let near = |other: usize| other == k || same(j, other, k);
                        choices[i].chosen.is_some_and(near) || choices[i].rivals.iter().copied().any(near)
                    })
                };
                others.retain(|&k| possible(k));
                Chosen { solution: Some(best), rivals: others }
            }
            None => {
                others.extend(choices.iter().filter_map(|choices| choices[i].chosen));
                others.sort_unstable();
                others.dedup();
                Chosen { solution: None, rivals: others }
            }
        }
    }

    pub(super) fn at_frequency(&self, i: usize) -> FrequencyProblem<'_> {
        let size = self.nominal[i].iter().map(|p| if p.norm() > 0.0 { p.norm() } else { 1.0 }).collect();
        FrequencyProblem {
            unknowns: self.problem.unknowns,
            measured: &self.problem.frfs.receptance[i],
            sigma: &self.sigma[i],
            size,
        }
    }
}

impl FrequencyProblem<'_> {
    /// Covariance of a frequency's own coordinates for given θ, (JᵀJ)⁻¹ row by row; infinite where they are not identifiable.
    pub(super) fn covariance(&self, solution: &Solution) -> Vec<Vec<f64>> {
        let n = self.count();
        if n == 0 {
            return Vec::new();
        }
        let unknown = |a: usize, b: usize| if a == b { f64::INFINITY } else { 0.0 };
        let inverse = inverse_information(&solution.of_own, n);
        let entry = |a: usize, b: usize| {
            let finite = inverse.as_ref().map(|inverse| inverse[a][b]).filter(|value| value.is_finite());
            finite.unwrap_or_else(|| unknown(a, b))
        };
        (0..n).map(|a| (0..n).map(|b| entry(a, b)).collect()).collect()
    }

    /// Standard deviation of the parts of each unknown that the frequency has of its own, at σ; 0 for the others.
    fn stds(&self, solution: &Solution) -> Vec<f64> {
        let covariance = self.covariance(solution);
        let mut at = 0;
        let mut std = |(one, size): (&Unknown, &f64)| {
            let count = one.per_frequency();
            let largest = (at..at + count).map(|a| covariance[a][a]).fold(0.0, f64::max);
            at += count;
            size * largest.sqrt()
        };
        self.unknowns.iter().zip(&self.size).map(&mut std).collect()
    }
}
