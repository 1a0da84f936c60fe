//! What a check costs beside an identification.

use super::planted::{folder, receptance, run, table};
use frfit::frequency::linear_hz;

/// Both work on one reduced model: the case costs as many factorisations with a check as without, and finds the same.
#[test]
fn a_check_factorises_nothing_of_its_own() {
    let frequency_hz = linear_hz(12.0, 112.0, 41);
    let exact = receptance(&[], &[5, 7], &frequency_hz);
    let tables = [0, 1].map(|m| table(&frequency_hz, &exact.iter().map(|x| x[m]).collect::<Vec<_>>(), None));
    let [with, without] = [true, false].map(|check| {
        let keys = format!(
            "[[measurement]]\nfile = \"0.csv\"\nrow = 6\nquantity = \"receptance\"\n\
             [[measurement]]\nfile = \"1.csv\"\nrow = 8\nquantity = \"receptance\"\n\
             [identify]\nmatrix = \"springs\"\nband_hz = [12.0, 112.0]\nreduction = \"subspace\"\ncheck = {check}\n\
             bounds = {{ storage = [1e4, 1e7], loss_factor = [0.0, 1.0] }}\n"
        );
        run(&folder(&tables, &keys)).unwrap()
    });
    let factorisations =
        [&with, &without].map(|job| job.summary["counts"]["factorisations"].as_u64().unwrap());
    assert!(factorisations[0] == factorisations[1] && factorisations[0] > 0, "{factorisations:?}");
    // The check trained what the identification went on with.
    assert!(with.diagnosis.unwrap().work.factorisations as u64 <= factorisations[0]);
    assert!(without.diagnosis.is_none());
    assert_eq!(with.run.found, without.run.found);
}
