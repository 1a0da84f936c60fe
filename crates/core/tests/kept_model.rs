//! A reduced model that outlives its run, as arrays.

use crate::common;

use common::{Case, plate, sandwich};
use frfit::c64;
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{
    Context, Frfs, Identification, Noise, Options, Problem, ProblemError, ReducedBand, Unknown, Variation,
    identify_on,
};
use frfit::response::Work;
use frfit::roots::Bounds;
use frfit::subspace::{KeptArray, KeptError, KeptSubspace};
use std::borrow::Cow;

const CONTEXT: Context<'static> = Context { for_each: &sequential, progress: &|_, _, _| {} };

/// The measurements of a specimen whose modulus is this many times the nominal one.
fn measured(case: &Case, frequency_hz: &[f64], ratio: f64) -> Vec<Vec<c64>> {
    frequency_hz.iter().map(|&f| case.direct(f, case.correction(f, ratio)).unwrap()).collect()
}

/// Identifies on a new reduced model, or on one that was kept; what it was trained to in the end.
fn identified(
    case: &Case,
    unknowns: &[Unknown],
    frequency_hz: &[f64],
    ratio: f64,
    kept: Option<&KeptSubspace>,
) -> (Identification, KeptSubspace) {
    let receptance = measured(case, frequency_hz, ratio);
    let frfs = Frfs { frequency_hz, receptance: &receptance, noise: Noise::Unknown };
    let problem = Problem::new(&case.model, &case.experiment, unknowns, &[], frfs).unwrap();
    let options = Options::default();
    let mut reduced = match kept {
        Some(kept) => ReducedBand::of_kept(kept, &problem, &options, CONTEXT).unwrap(),
        None => ReducedBand::default(),
    };
    let found = identify_on(&mut reduced, &problem, &options, CONTEXT).unwrap();
    (found, reduced.kept().unwrap())
}

/// Only trained over the box.
fn trained(case: &Case, unknowns: &[Unknown], frequency_hz: &[f64]) -> KeptSubspace {
    let receptance = vec![vec![c64::new(1.0, 0.0); case.experiment.sensors.len()]; frequency_hz.len()];
    let frfs = Frfs { frequency_hz, receptance: &receptance, noise: Noise::Unknown };
    let problem = Problem::new(&case.model, &case.experiment, unknowns, &[], frfs).unwrap();
    let mut reduced = ReducedBand::default();
    reduced.train_for(&problem, &Options::default(), CONTEXT).unwrap();
    reduced.kept().unwrap()
}

/// As it comes back from a file.
fn read_again(case: &Case, kept: &KeptSubspace) -> KeptSubspace {
    let arrays = kept.arrays().into_iter();
    let owned = arrays.map(|array| KeptArray { values: Cow::Owned(array.values.into_owned()), ..array });
    KeptSubspace::new(&case.model, owned.collect()).unwrap()
}

fn without_work(mut found: Identification) -> String {
    found.search.work = Work::default();
    // Numbers that are not identifiable are NaN, which is not equal to itself.
    format!("{found:?}")
}

fn cases() -> [(Case, Vec<Unknown>, Vec<f64>); 2] {
    let one = plate(6, 0.27, 0.02);
    let unknown = Unknown::factor_of(&one.model, &["stiffness"]).unwrap();
    let two = sandwich(6, 1);
    let both = ["skins", "core"].map(|name| {
        let unknown = Unknown::factor_of(&two.model, &[name]).unwrap();
        Unknown { varies: Variation::Constant, ..unknown }
    });
    [(one, vec![unknown], linear_hz(150.0, 900.0, 24)), (two, both.to_vec(), linear_hz(20.0, 300.0, 12))]
}

/// The same bits as without it, whichever specimen comes first; its training is saved, and with that of its answers all work of size N.
#[test]
fn a_run_on_a_kept_model_is_the_run_without_it() {
    for (case, unknowns, frequency_hz) in cases() {
        let kept = read_again(&case, &trained(&case, &unknowns, &frequency_hz));
        for ratio in [1.1, 0.93] {
            let (fresh, _) = identified(&case, &unknowns, &frequency_hz, ratio, None);
            let (found, enriched) = identified(&case, &unknowns, &frequency_hz, ratio, Some(&kept));
            let [before, after] = [fresh.search.work, found.search.work];
            assert!(after.solves < before.solves, "{after:?} {before:?}");
            // One factorisation is done anew where the answers need more vectors.
            assert!(after.factorisations <= 1.min(after.solves), "{after:?}");
            assert_eq!(without_work(found.clone()), without_work(fresh), "{}", case.name);
            let (again, _) =
                identified(&case, &unknowns, &frequency_hz, ratio, Some(&read_again(&case, &enriched)));
            assert_eq!(again.search.work, Work::default());
            for (a, b) in again.lines.iter().zip(&found.lines) {
                let [a, b] = [a.values[0].value.unwrap(), b.values[0].value.unwrap()];
                // Vectors that were brought for other answers: both are right to this.
                assert!((a - b).norm() < 1e-6 * b.norm(), "{a} {b}");
            }
        }
    }
}

/// Where a problem goes beyond the box of the training, it is trained further; within it, it is not.
#[test]
fn only_what_is_beyond_the_box_is_trained() {
    let [(case, unknowns, frequency_hz), _] = cases();
    let kept = trained(&case, &unknowns, &frequency_hz);
    let nominal = unknowns[0].nominal.at(frequency_hz[0]).unwrap().re;
    let bounded = |low: f64, high: f64| {
        let bounds = Bounds { storage: Some([low * nominal, high * nominal]), ..Bounds::default() };
        [Unknown { bounds, ..unknowns[0].clone() }]
    };
    let work = |unknowns: &[Unknown], frequency_hz: &[f64]| {
        let receptance = measured(&case, frequency_hz, 1.0);
        let frfs = Frfs { frequency_hz, receptance: &receptance, noise: Noise::Unknown };
        let problem = Problem::new(&case.model, &case.experiment, unknowns, &[], frfs).unwrap();
        ReducedBand::of_kept(&kept, &problem, &Options::default(), CONTEXT).unwrap().work()
    };
    assert_eq!(work(&bounded(0.9, 1.2), &frequency_hz), Work::default());
    assert_eq!(work(&unknowns, &linear_hz(200.0, 850.0, 301)), Work::default());
    let higher = work(&unknowns, &linear_hz(150.0, 2700.0, 24));
    assert!(higher.factorisations > 0 && higher.solves > 0, "{higher:?}");
}

#[test]
fn a_kept_model_of_another_model_is_refused() {
    let [(plate, unknowns, frequency_hz), (sandwich, of_sandwich, its_hz)] = cases();
    let kept = trained(&plate, &unknowns, &frequency_hz);
    let receptance = measured(&sandwich, &its_hz, 1.0);
    let frfs = Frfs { frequency_hz: &its_hz, receptance: &receptance, noise: Noise::Unknown };
    let problem = Problem::new(&sandwich.model, &sandwich.experiment, &of_sandwich, &[], frfs).unwrap();
    let refused = ReducedBand::of_kept(&kept, &problem, &Options::default(), CONTEXT).unwrap_err();
    assert!(matches!(refused, ProblemError::Reduced(KeptError::Model { .. })), "{refused}");
    for name in KeptSubspace::ARRAYS {
        let all = || kept.arrays().into_iter();
        let missing = all().filter(|array| array.name != name).collect();
        let missing = KeptSubspace::new(&plate.model, missing).unwrap_err();
        assert_eq!(missing, KeptError::Missing(name));
        let cut = |array: KeptArray<'static>| match array.name == name {
            true => {
                let mut shape = array.shape;
                *shape.last_mut().unwrap() += 1;
                let count = shape.iter().product();
                KeptArray { name, shape, values: Cow::Owned(vec![1.0; count]) }
            }
            false => array,
        };
        let owned = all().map(|a| KeptArray { values: Cow::Owned(a.values.into_owned()), ..a }).map(cut);
        let other = KeptSubspace::new(&plate.model, owned.collect());
        assert!(other.is_err(), "{name}: {other:?}");
    }
}
