//! All solutions of two unknowns at a frequency, against many starts.

use super::at_frequency::distance;
use super::neighbourhoods::in_box;
use super::search::At;
use super::*;
use crate::for_each::sequential;
use crate::frfs::{Frfs, Noise};
use crate::identify::unknown::{Dependence, Unknown, Variation};
use crate::material::Law;
use crate::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use crate::roots::Bounds;
use frfit_linalg::sparse::Triplets;

/// Springs of a chain: the first half has one factor, the second another.
const SPRINGS: usize = 24;
const LOSSY: c64 = c64::new(1.0, 0.03);

fn chain() -> DynamicStiffness {
    let half = |first: usize, last: usize| {
        let mut k = Triplets::new(SPRINGS);
        for i in first..last {
            // clamped at its beginning
            match i.checked_sub(1) {
                None => k.add(0, 0, 1.0),
                Some(before) => k.add_element(&[Some(before), Some(i)], &[1.0, -1.0, -1.0, 1.0]),
            }
        }
        k.assemble()
    };
    let mut m = Triplets::new(SPRINGS);
    (0..SPRINGS).for_each(|i| m.add(i, i, 1.0));
    let term = |name: &str, role, matrix, factor: c64| Term {
        name: name.to_owned(),
        role,
        matrix,
        factor: Law::Constant(factor),
    };
    DynamicStiffness::new(vec![
        term("first", Role::Stiffness, half(0, SPRINGS / 2), 1.2 * LOSSY),
        term("second", Role::Stiffness, half(SPRINGS / 2, SPRINGS), 0.8 * LOSSY),
        term("masses", Role::Mass, m.assemble(), c64::new(1.0, 0.0)),
    ])
    .unwrap()
}

#[path = "../../../tests/tier/mod.rs"]
mod tier;

/// Two sensors, two complex unknowns, a dozen modes within reach of the bounds: as many equations as unknowns, and several solutions.
#[test]
fn all_solutions_of_two_unknowns_are_found() {
    let model = chain();
    let sensor = |row| Sensor { row, sign: 1.0 };
    let experiment =
        Experiment::driven_at(SPRINGS, sensor(SPRINGS - 1), vec![sensor(SPRINGS - 1), sensor(SPRINGS / 2)]);
    let frequency_hz = [0.1, 0.12, 0.14, 0.16, 0.18];
    let solve = |&f: &f64| {
        let factor = model.analysis().factor(&model.at(f, &[]).unwrap().assemble(&[])).unwrap();
        let mut x = experiment.load.clone();
        factor.solve(&mut x).unwrap();
        experiment.observe(&x)
    };
    let measured: Vec<Vec<c64>> = frequency_hz.iter().map(solve).collect();
    let unknowns = [0, 1].map(|term| Unknown {
        name: model.terms()[term].name.clone(),
        dependence: Dependence::Factor(vec![term]),
        nominal: Law::Constant(LOSSY),
        varies: Variation::PerFrequency,
        real: false,
        bounds: Bounds { storage: Some([0.4, 2.5]), loss_factor: Some([0.0, 0.3]) },
    });
    let frfs = Frfs { frequency_hz: &frequency_hz, receptance: &measured, noise: Noise::Unknown };
    let problem = Problem::new(&model, &experiment, &unknowns, &[], frfs).unwrap();
    let nominal = vec![vec![LOSSY; 2]; frequency_hz.len()];
    let context = Context { for_each: &sequential, progress: &|_, _, _| {} };
    let composite = Composite { model: &model, unknowns: &unknowns };
    let subspace = train(None, &problem, context).unwrap().unwrap();
    let reduced = Neighbourhoods::new(subspace, &problem, &nominal, context);
    let options = Options::default();
    let task = Task {
        problem: &problem,
        asked: &problem,
        nominal: &nominal,
        given: &nominal,
        omegas: frequency_hz.iter().map(|&f| omega_rad_s(f)).collect(),
        sigma: standard_deviations(&frequency_hz, &measured, Noise::Unknown),
        left_out: Vec::new(),
        options: &options,
        context,
    };
    let coordinates = task.coordinates();
    let at = At { reduced: &reduced, coordinates: &coordinates, theta: &[] };
    let (mut several, mut by_few) = (0, 0);
    for (i, nominal) in nominal.iter().enumerate() {
        let problem = task.at_frequency(i);
        let from = |count: usize| {
            let points = (1..=count).map(|k| problem.coordinates(&in_box(&composite, nominal, k)));
            problem.solutions(&points.collect::<Vec<_>>(), nominal, |values| reduced.respond(i, values))
        };
        let (many, few) = (from(many_starts()), from(FEW_STARTS));
        let found = task.everywhere(&at, i, nominal);
        for solution in &many {
            // Newton's last step is exact to far less than this
            let near = |other: &super::at_frequency::Solution| distance(&other.own, &solution.own) < 1e-6;
            let missed = &solution.values;
            assert!(found.iter().any(near), "{missed:?} is not among {}", found.len());
            by_few += usize::from(few.iter().any(near));
        }
        several += many.len();
    }
    assert!(several > frequency_hz.len(), "a case in which the truth is alone shows nothing");
    assert!(by_few < several, "a case that {FEW_STARTS} starts solve shows little");
}

/// Starts of the comparison; by day not all, which still find more than a few do.
fn many_starts() -> usize {
    tier::of_tier(500, 1500)
}

/// As many as were thought enough before.
const FEW_STARTS: usize = 16;
