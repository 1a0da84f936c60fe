//! The joint choice on made-up bands: a material's curve among smooth wrong ones, with gaps and strays.

use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::material::Law;
use frfit::select::{Choice, Node, SelectOptions, choose};
use proptest::prelude::*;

fn c(re: f64, im: f64) -> c64 {
    c64::new(re, im)
}

fn node(factor: c64) -> Node {
    Node { factor, misfit: 0.0, std: 0.0 }
}

/// A wrong branch: ln E = level + slope x + curvature x²/2 over x = ln(f/f₀), arg E alike.
#[derive(Debug, Clone)]
struct Branch {
    level: f64,
    slope: f64,
    curvature: f64,
    loss: [f64; 2],
}

impl Branch {
    fn at(&self, x: f64) -> c64 {
        let size = self.level + self.slope * x + self.curvature * x * x / 2.0;
        c64::from_polar(size.exp(), self.loss[0] + self.loss[1] * x)
    }

    /// Whether it rises more than causality allows, or falls, through two thirds of a band. If not, it may rightly be a rival.
    fn is_steep(&self, frequency_hz: &[f64]) -> bool {
        let is_steep_at = |f: f64| {
            let x = (f / 300.0).ln();
            let steepest = (self.loss[0] + self.loss[1] * x) / std::f64::consts::FRAC_PI_2;
            !(-0.1..=steepest + 0.1).contains(&(self.slope + self.curvature * x))
        };
        3 * frequency_hz.iter().filter(|&&f| is_steep_at(f)).count() > 2 * frequency_hz.len()
    }
}

/// A band as it could be found, with the truth at each frequency.
#[derive(Debug, Clone)]
struct Made {
    frequency_hz: Vec<f64>,
    truth: Vec<c64>,
    nodes: Vec<Vec<Node>>,
    /// Whether the true node was left out.
    lost: Vec<bool>,
}

/// Random numbers for a band: uniform in [0, 1) and normal.
struct Dice(u64);

impl Dice {
    /// D. E. Knuth's MMIX generator.
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> c64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        c64::from_polar(radius, std::f64::consts::TAU * self.uniform())
    }
}

fn laws() -> impl Strategy<Value = Law> {
    prop_oneof![
        // No causal material has a larger loss factor that is constant: another branch may be nearer to one.
        (-5.0f64..-0.5).prop_map(|eta| Law::complex_modulus(1.0, 10f64.powf(eta))),
        (0.0f64..1.0, 0.2f64..0.7).prop_map(|(part, alpha)| {
            // |E| is about one at 300 Hz, in the middle of most bands.
            Law::Fractional { e0: 1.0 - part, e1: part / (600.0 * std::f64::consts::PI).powf(alpha), alpha }
        }),
    ]
}

/// Wrong branches as x(ω²/E) makes them: steeper than materials, crossing the truth or not.
fn branches() -> impl Strategy<Value = Vec<Branch>> {
    let slope = prop_oneof![1.2f64..4.0, -4.0f64..-0.7];
    let branch = (-1.5f64..1.5, slope, -0.5f64..0.5, 0.0f64..0.6, -0.2f64..0.2).prop_map(
        |(level, slope, curvature, loss, drift)| Branch { level, slope, curvature, loss: [loss, drift] },
    );
    prop::collection::vec(branch, 0..6)
}

/// `std` is relative; `lost` and `strays` are per frequency.
fn make(
    law: &Law,
    branches: &[Branch],
    frequency_hz: Vec<f64>,
    std: f64,
    lost: f64,
    strays: f64,
    seed: u64,
) -> Made {
    let mut dice = Dice(seed);
    let truth: Vec<c64> = frequency_hz.iter().map(|&f| law.at(f).unwrap()).collect();
    let mut made = Made { truth, nodes: Vec::new(), lost: Vec::new(), frequency_hz };
    for (&f, &truth) in made.frequency_hz.iter().zip(&made.truth) {
        let x = (f / 300.0).ln();
        let bounds = |factor: &c64| {
            (0.2..=5.0).contains(&(factor.re / truth.re)) && factor.im >= 0.0 && factor.im <= 3.0 * factor.re
        };
        let mut factors: Vec<c64> = branches.iter().map(|branch| branch.at(x)).filter(bounds).collect();
        while dice.uniform() < strays {
            factors.push(truth.norm() * c64::from_polar((3.0 * dice.uniform() - 1.5).exp(), dice.uniform()));
        }
        let gone = dice.uniform() < lost;
        made.lost.push(gone);
        if !gone {
            // Anywhere among the others.
            factors.insert((dice.uniform() * (factors.len() + 1) as f64) as usize, truth);
        }
        let noisy = factors.iter().map(|factor| Node {
            factor: factor * (1.0 + std * dice.normal()),
            misfit: 0.0,
            std: std * factor.norm(),
        });
        made.nodes.push(noisy.collect());
    }
    made
}

impl Made {
    /// A node that stands for the truth: within 1e-5, where a crossing branch cannot be distinguished from it, or within its scatter. Where the true
    /// node is lost, within 5 %: one that lies where the curve is expected is rightly taken for it.
    fn is_right(&self, k: usize, index: usize) -> bool {
        let Node { factor, std, .. } = self.nodes[k][index];
        let off = (factor - self.truth[k]).norm();
        off <= if self.lost[k] { 0.05 } else { 1e-5 } * self.truth[k].norm() + 5.0 * std
    }

    /// (right, wrong without a word of warning).
    fn count(&self, choices: &[Choice]) -> (usize, usize) {
        let (mut right, mut wrong) = (0, 0);
        for (k, choice) in choices.iter().enumerate() {
            match choice.chosen {
                Some(index) if self.is_right(k, index) => right += 1,
                Some(_) if choice.rivals.is_empty() => wrong += 1,
                _ => {}
            }
        }
        (right, wrong)
    }

    fn present(&self) -> usize {
        self.lost.iter().filter(|lost| !**lost).count()
    }
}

#[test]
fn nothing_comes_of_nothing() {
    let none = Choice { chosen: None, rivals: Vec::new(), margin: f64::INFINITY };
    let options = SelectOptions::default();
    assert_eq!(choose(&[], &[], &options), []);
    assert_eq!(choose(&[1.0, 2.0], &[vec![], vec![]], &options), [none.clone(), none.clone()]);
    // Zero has no logarithm, neither as a frequency nor as a factor.
    let broken = [f64::NAN, f64::INFINITY, 0.0].map(|x| node(c(x, 0.0))).to_vec();
    assert_eq!(choose(&[0.0, 2.0], &[vec![node(c(1.0, 0.0))], broken], &options), [none.clone(), none]);
}

#[test]
fn one_frequency_tells_nothing_apart() {
    let nodes = [vec![node(c(1.0, 0.1)), node(c(2.0, 0.1))]];
    let choice = &choose(&[100.0], &nodes, &SelectOptions::default())[0];
    assert_eq!((choice.chosen, &choice.rivals[..], choice.margin), (Some(0), &[1][..], 0.0));
    // Another sensor does: a thousand to one is 7 nats, χ² = 14.
    for (misfit, rivals) in [(10.0, vec![1]), (20.0, vec![])] {
        let nodes = [vec![nodes[0][0], Node { misfit, ..nodes[0][1] }]];
        let choice = &choose(&[100.0], &nodes, &SelectOptions::default().with_sensors(2))[0];
        assert_eq!((choice.chosen, &choice.rivals), (Some(0), &rivals));
        assert!((choice.margin - misfit / 2.0).abs() < 1e-12);
    }
}

#[test]
fn two_materials_in_one_band_are_both_reported() {
    let frequency_hz = linear_hz(100.0, 1000.0, 50);
    let nodes = vec![vec![node(c(1.0, 0.1)), node(c(2.0, 0.1))]; 50];
    for choice in choose(&frequency_hz, &nodes, &SelectOptions::default()) {
        let mut both = choice.rivals.clone();
        both.extend(choice.chosen);
        both.sort_unstable();
        assert_eq!(both, [0, 1]);
    }
}

#[test]
fn nodes_that_are_one_are_no_alternatives() {
    let frequency_hz = linear_hz(100.0, 1000.0, 20);
    let twice = vec![node(c(1.0, 0.1)), node(c(1.0 + 1e-8, 0.1))];
    for choice in choose(&frequency_hz, &vec![twice; 20], &SelectOptions::default()) {
        assert!(choice.chosen.is_some() && choice.rivals.is_empty(), "{choice:?}");
    }
}

/// The material is a fractional law that scatters by 3 %; the wrong branch is perfectly constant, and the other sensor says so.
#[test]
fn another_sensor_counts_for_more_than_smoothness() {
    let law = Law::Fractional { e0: 1.0, e1: 0.01, alpha: 0.6 };
    let constant = Branch { level: 0.3, slope: 0.0, curvature: 0.0, loss: [0.1, 0.0] };
    let mut made = make(&law, &[], linear_hz(100.0, 1000.0, 100), 0.03, 0.0, 0.0, 1);
    let mut dice = Dice(2);
    for nodes in &mut made.nodes {
        // χ² of two degrees of freedom for the right one.
        nodes[0].misfit = -2.0 * (1.0 - dice.uniform()).ln();
        nodes.push(Node { misfit: 40.0, std: 0.01, factor: constant.at(0.0) });
    }
    let options = SelectOptions::default().with_sensors(2);
    assert_eq!(made.count(&choose(&made.frequency_hz, &made.nodes, &options)), (100, 0));
    // Without that sensor the wrong one cannot be excluded, for it could be a material as well.
    made.nodes.iter_mut().flatten().for_each(|node| node.misfit = 0.0);
    let (_, wrong) = made.count(&choose(&made.frequency_hz, &made.nodes, &SelectOptions::default()));
    assert_eq!(wrong, 0);
}

/// Misfits in any unit: the level is taken from the band.
#[test]
fn an_assumed_noise_level_is_corrected() {
    let constant = Branch { level: 0.3, slope: 0.0, curvature: 0.0, loss: [0.1, 0.0] };
    let mut made =
        make(&Law::complex_modulus(1.0, 0.01), &[constant], linear_hz(100.0, 900.0, 80), 0.0, 0.0, 0.0, 3);
    for unit in [1e-4, 1.0, 1e4] {
        let mut dice = Dice(4);
        for (nodes, truth) in made.nodes.iter_mut().zip(&made.truth) {
            for node in nodes {
                let usual = -2.0 * (1.0 - dice.uniform()).ln();
                node.misfit = unit * if node.factor == *truth { usual } else { 100.0 + usual };
            }
        }
        let options = SelectOptions::default().with_sensors(2).with_sigma_known(false);
        assert_eq!(made.count(&choose(&made.frequency_hz, &made.nodes, &options)), (80, 0), "{unit}");
    }
}

#[test]
fn a_gap_is_bridged_and_not_filled_with_what_is_wrong() {
    let law = Law::Fractional { e0: 1.0, e1: 0.01, alpha: 0.6 };
    let steep =
        [-1.0, -0.5, 0.5, 1.0].map(|level| Branch { level, slope: 2.0, curvature: 0.0, loss: [0.1, 0.0] });
    let mut made = make(&law, &steep, linear_hz(100.0, 1000.0, 150), 0.0, 0.0, 0.0, 5);
    for k in 50..80 {
        let truth = made.truth[k];
        made.nodes[k].retain(|node| node.factor != truth);
        made.lost[k] = true;
    }
    made.nodes[100..110].iter_mut().for_each(Vec::clear);
    made.lost[100..110].fill(true);
    assert_eq!(made.count(&choose(&made.frequency_hz, &made.nodes, &SelectOptions::default())), (110, 0));
}

/// Right where two branches cross the wrong one is close by. If the right one is missing there, a material that is known to be constant
/// everywhere else shows.
#[test]
fn what_the_band_says_of_curvature_is_used() {
    let mut made =
        make(&Law::complex_modulus(1.0, 0.01), &[], linear_hz(100.0, 1000.0, 100), 0.0, 0.0, 0.0, 7);
    made.nodes[50][0].factor *= 1.0 + 3e-5;
    let choices = choose(&made.frequency_hz, &made.nodes, &SelectOptions::default());
    assert_eq!(choices[50].chosen, None);
    assert_eq!(choices.iter().filter_map(|choice| choice.chosen).count(), 99);
}

/// Only branches like ω²/E = constant: better no answer than one of them.
#[test]
fn what_is_no_material_is_not_chosen() {
    let steep =
        [-2.0, -1.0, 0.0, 1.0].map(|level| Branch { level, slope: 2.0, curvature: 0.0, loss: [0.05, 0.0] });
    let made =
        make(&Law::complex_modulus(1.0, 0.01), &steep, linear_hz(100.0, 1000.0, 100), 0.0, 1.0, 0.0, 6);
    assert!(made.nodes.iter().filter(|nodes| !nodes.is_empty()).count() > 80);
    let choices = choose(&made.frequency_hz, &made.nodes, &SelectOptions::default());
    assert_eq!(choices.iter().filter_map(|choice| choice.chosen).count(), 0);
}

/// A wrong branch that falls with frequency is no material, and has what the right one lost. Allowed little curvature, the cheapest path would be that branch.
#[test]
fn what_is_no_material_stays_excluded() {
    let law = Law::Fractional { e0: 0.5, e1: 0.0043, alpha: 0.63 };
    let falling = Branch { level: -1.28, slope: -0.7, curvature: 0.0, loss: [0.46, -0.06] };
    let mut made = make(&law, &[falling], linear_hz(205.0, 470.0, 94), 0.0, 0.0, 0.0, 8);
    for k in (4..94).step_by(9) {
        let truth = made.truth[k];
        made.nodes[k].retain(|node| node.factor != truth);
        made.lost[k] = true;
    }
    let choices = choose(&made.frequency_hz, &made.nodes, &SelectOptions::default());
    assert_eq!((made.count(&choices), made.present()), ((84, 0), 84));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Never wrong without a warning, and right nearly everywhere, whatever else there is.
    #[test]
    fn a_material_is_told_from_steeper_branches(
        law in laws(),
        branches in branches(),
        band in (20.0f64..300.0, 2.0f64..20.0, 40usize..150),
        lost in 0.0f64..0.1,
        strays in 0.0f64..0.5,
        seed: u64,
    ) {
        let (first, ratio, count) = band;
        let frequency_hz = linear_hz(first, first * ratio, count);
        let are_steep = branches.iter().all(|branch| branch.is_steep(&frequency_hz));
        let made = make(&law, &branches, frequency_hz, 0.0, lost, strays, seed);
        let choices = choose(&made.frequency_hz, &made.nodes, &SelectOptions::default());
        let (right, wrong) = made.count(&choices);
        prop_assert_eq!(wrong, 0);
        prop_assert!(
            !are_steep || right as f64 >= 0.95 * made.present() as f64,
            "{right} of {}",
            made.present()
        );
    }

    /// The same with scatter, of a size that is given or not: then what scatters most is left out.
    #[test]
    fn scatter_is_no_excuse(
        law in laws(),
        branches in branches(),
        band in (20.0f64..300.0, 2.0f64..20.0, 40usize..150),
        std in -4.0f64..-2.0,
        is_given: bool,
        lost in 0.0f64..0.1,
        seed: u64,
    ) {
        let (first, ratio, count) = band;
        let frequency_hz = linear_hz(first, first * ratio, count);
        let made = make(&law, &branches, frequency_hz, 10f64.powf(std), lost, 0.2, seed);
        let mut nodes = made.nodes.clone();
        if !is_given {
            nodes.iter_mut().flatten().for_each(|node| node.std = 0.0);
        }
        let choices = choose(&made.frequency_hz, &nodes, &SelectOptions::default());
        let (right, wrong) = made.count(&choices);
        // Of 12 000 draws one had one wrong line: scatter may bring another branch nearer.
        prop_assert!(wrong <= 1, "{wrong}");
        prop_assert!(right as f64 >= 0.7 * made.present() as f64, "{right} of {}", made.present());
    }

    /// Where the right solution is missing through up to half of the band, no wrong one takes its place.
    #[test]
    fn a_lost_stretch_is_left_empty(
        law in laws(),
        branches in branches(),
        stretch in (0usize..100, 0usize..50),
        seed: u64,
    ) {
        let mut made = make(&law, &branches, linear_hz(50.0, 500.0, 100), 0.0, 0.0, 0.0, seed);
        let (first, length) = stretch;
        for k in first..(first + length).min(100) {
            let truth = made.truth[k];
            made.nodes[k].retain(|node| node.factor != truth);
            made.lost[k] = true;
        }
        let (right, wrong) = made.count(&choose(&made.frequency_hz, &made.nodes, &SelectOptions::default()));
        prop_assert_eq!(wrong, 0);
        prop_assert!(right as f64 >= 0.9 * made.present() as f64, "{right} of {}", made.present());
    }

    /// The answer does not depend on the unit of stress, nor on the order of the candidates.
    #[test]
    fn neither_units_nor_order_matter(law in laws(), branches in branches(), seed: u64, unit in -9i32..12) {
        let made = make(&law, &branches, linear_hz(50.0, 500.0, 60), 0.0, 0.05, 0.3, seed);
        let factors = |choices: Vec<Choice>, nodes: &[Vec<Node>]| -> Vec<Option<c64>> {
            choices.iter().zip(nodes).map(|(choice, nodes)| Some(nodes[choice.chosen?].factor)).collect()
        };
        let options = SelectOptions::default();
        let before = factors(choose(&made.frequency_hz, &made.nodes, &options), &made.nodes);
        let unit = 2f64.powi(3 * unit);
        let mut other = made.nodes.clone();
        for nodes in &mut other {
            nodes.reverse();
            nodes.iter_mut().for_each(|node| node.factor *= unit);
        }
        let after = factors(choose(&made.frequency_hz, &other, &options), &other);
        let scaled: Vec<_> = before.iter().map(|factor| factor.map(|factor| factor * unit)).collect();
        prop_assert_eq!(scaled, after);
    }
}
