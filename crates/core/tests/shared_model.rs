//! One reduced model for diagnostics and identification.

use crate::common;
use crate::tier::of_tier;

use common::{Case, plate, sandwich};
use frfit::c64;
use frfit::diagnostics::{Depth, Diagnosis, diagnose, diagnose_on};
use frfit::for_each::sequential;
use frfit::frequency::linear_hz;
use frfit::identify::{
    Context, Frfs, Identification, Noise, Options, Problem, ReducedBand, Unknown, Variation, identify,
    identify_on,
};
use frfit::laws::LawKind;
use frfit::quantity::Quantity;

const CONTEXT: Context<'static> = Context { for_each: &sequential, progress: &|_, _, _| {} };

/// What is found of a problem apart, and on one reduced model, which is diagnosed once more at the end.
fn apart_and_shared(
    case: &Case,
    unknowns: &[Unknown],
    frequency_hz: &[f64],
    wrong: f64,
) -> [(Diagnosis, Identification); 2] {
    let exact: Vec<Vec<c64>> =
        frequency_hz.iter().map(|&f| case.direct(f, case.correction(f, 1.1)).unwrap()).collect();
    let receptance: Vec<Vec<c64>> = exact.iter().map(|row| row.iter().map(|x| wrong * x).collect()).collect();
    let frfs = Frfs { frequency_hz, receptance: &receptance, noise: Noise::Unknown };
    let problem = Problem::new(&case.model, &case.experiment, unknowns, &[], frfs).unwrap();
    let (options, quantities) =
        (Options::default(), vec![Quantity::Receptance; case.experiment.sensors.len()]);
    let apart = (
        diagnose(&problem, &quantities, &options, &sequential).unwrap(),
        identify(&problem, &options, CONTEXT).unwrap(),
    );
    let mut reduced = ReducedBand::default();
    let shared = (
        diagnose_on(&mut reduced, Depth::Quick, &problem, &quantities, &options, &sequential).unwrap(),
        identify_on(&mut reduced, &problem, &options, CONTEXT).unwrap(),
    );
    // The work of the model is that of diagnosis and identification together, of which the latter knows all.
    assert_eq!(reduced.work(), shared.1.search.work);
    let again =
        diagnose_on(&mut reduced, Depth::Quick, &problem, &quantities, &options, &sequential).unwrap();
    assert_eq!(again.work.factorisations, 0, "{again:?}");
    assert_eq!(kinds(&again), kinds(&shared.0));
    [apart, shared]
}

fn kinds(diagnosis: &Diagnosis) -> Vec<std::mem::Discriminant<frfit::diagnostics::Fault>> {
    diagnosis.findings.iter().map(|finding| std::mem::discriminant(&finding.fault)).collect()
}

/// Checking and identifying a modulus cost the factorisations of identifying it, however it varies, and nothing that is found is another.
#[test]
fn one_training_for_a_check_and_an_identification() {
    let case = plate(6, 0.27, 0.02);
    let frequency_hz = linear_hz(150.0, 900.0, of_tier(24, 40));
    let all =
        [Variation::PerFrequency, Variation::Constant, Variation::law(LawKind::Constant), Variation::Smooth];
    for varies in all.into_iter().take(of_tier(2, 4)) {
        for (wrong, findings) in [(1.0, 0), (-1.0, 1)] {
            let unknown = Unknown::factor_of(&case.model, &["stiffness"]).unwrap();
            let unknowns = [Unknown { varies: varies.clone(), ..unknown }];
            let [apart, shared] = apart_and_shared(&case, &unknowns, &frequency_hz, wrong);
            assert_eq!(shared.0.findings.len(), findings, "{:?}", shared.0);
            assert_eq!(kinds(&apart.0), kinds(&shared.0));
            // Numbers that are not identifiable are NaN, which is not equal to itself.
            assert_eq!(format!("{:?}", apart.1), format!("{:?}", shared.1), "{varies:?}");
            assert!(apart.0.work.factorisations > 0);
        }
    }
}

/// Of two unknowns too, each of which had a model of its own.
#[test]
fn one_training_for_two_unknowns() {
    let case = sandwich(6, 1);
    let frequency_hz = linear_hz(20.0, of_tier(300.0, 1000.0), of_tier(8, 24));
    let unknowns = ["skins", "core"].map(|name| {
        let unknown = Unknown::factor_of(&case.model, &[name]).unwrap();
        let law = unknown.nominal.clone();
        Unknown { varies: Variation::Constant, nominal: law, ..unknown }
    });
    let [apart, shared] = apart_and_shared(&case, &unknowns, &frequency_hz, 1.0);
    // One training for both unknowns; over a longer band two more for other rows, which seem likelier at first.
    assert_eq!(apart.0.work.factorisations, of_tier(1, 3));
    assert_eq!(shared.1.search.work.factorisations, apart.1.search.work.factorisations);
    assert_eq!(apart.1, shared.1);
    assert_eq!(kinds(&apart.0), kinds(&shared.0));
}
