//! Masses of sensors and hammers, and the suspension.

use super::planted::{DIM, OnIt, folder, receptance, refusal, run, table, worst};
use frfit::frequency::linear_hz;
use frfit::model::Role;

/// The measurement of a structure with something on it, and a case that says so, or not.
fn measured(on_it: &[OnIt], keys: &str) -> tempfile::TempDir {
    let frequency_hz = linear_hz(10.0, 120.0, 56);
    let exact = receptance(on_it, &[5, 7], &frequency_hz);
    let tables = [0, 1].map(|m| table(&frequency_hz, &exact.iter().map(|x| x[m]).collect::<Vec<_>>(), None));
    let rest = "[[measurement]]\nfile = \"0.csv\"\nrow = 6\nquantity = \"receptance\"\n\
                [[measurement]]\nfile = \"1.csv\"\nrow = 8\nquantity = \"receptance\"\n\
                [identify]\nmatrix = \"springs\"\nband_hz = [10.0, 120.0]\n\
                bounds = { storage = [1e4, 1e7], loss_factor = [0.0, 1.0] }\n";
    folder(&tables, &format!("{keys}{rest}"))
}

/// An accelerometer at node 3 (rows 5 and 6 from 1), a hammer's tip in one direction, and a suspension at node 2.
const ON_IT: [OnIt; 5] = [
    (Role::Mass, 4, 0.05),
    (Role::Mass, 5, 0.05),
    (Role::Mass, 0, 0.02),
    (Role::Stiffness, 3, 1500.0),
    (Role::Viscous, 3, 4.0),
];

const SAID: &str = "[[attached]]\ndof = \"3+Z\"\nmass_kg = 0.05\n\
                    [[attached]]\ndof = \"1-X\"\nmass_kg = 0.02\ndirections = [\"X\"]\n\
                    [[attached]]\ndof = \"2+Z\"\nstiffness = 1500\ndamping = 4.0\n";

#[test]
fn what_is_on_the_structure_is_part_of_the_model() {
    let job = run(&measured(&ON_IT, SAID)).unwrap();
    assert_eq!(worst(&job).1, 56);
    // Exact data, and answers that are asked to 1e-6.
    assert!(worst(&job).0 < 1e-6, "{:?}", worst(&job));
    let names: Vec<_> = job.case.model.terms().iter().map(|term| term.name.as_str()).collect();
    assert_eq!(
        names[2..],
        [
            "attached 1 (mass at 3+Z)",
            "attached 2 (mass at 1-X)",
            "attached 3 (stiffness at 2+Z)",
            "attached 3 (damping at 2+Z)",
        ]
    );
    let without = run(&measured(&ON_IT, "")).unwrap();
    assert!(worst(&without).0 > 1e-2, "{:?}", worst(&without));
}

#[test]
fn a_row_number_means_that_row() {
    let said = "[[attached]]\nrow = 5\nmass_kg = 0.3\nstiffness = 100\n";
    let on_it = [(Role::Mass, 4, 0.3), (Role::Stiffness, 4, 100.0)];
    assert!(worst(&run(&measured(&on_it, said)).unwrap()).0 < 1e-6);
}

#[test]
fn what_cannot_be_attached_is_refused() {
    assert_eq!(DIM, 8);
    for (keys, message) in [
        ("mass_kg = 1", "attached: expected the key \"dof\" or \"row\", where it is, found none"),
        ("row = 9\nmass_kg = 1", "attached.row: expected 1 to 8, found 9"),
        (
            "dof = \"7+X\"\nmass_kg = 1",
            "attached.dof: expected a degree of freedom that [dofs] names, found 7+X (no node 7; the nearest is 4 with X, Z)",
        ),
        ("row = 1", "attached: expected one of the keys mass, mass_kg, stiffness and damping, found none"),
        ("row = 1\nmass_kg = 0", "attached.mass_kg: expected a mass above 0 kg, found 0"),
        ("row = 1\nmas = 0", "attached: expected a known key, of which \"mass\" is nearest, found \"mas\""),
        (
            "row = 1\nstiffness = -1",
            "attached.stiffness: expected a stiffness above 0: a number in the units of the case, or a text as \"3 N/mm\", found -1",
        ),
        (
            "row = 1\ndamping = nan",
            "attached.damping: expected a damping above 0: a number in the units of the case, or a text as \"0.2 N s/m\", found nan",
        ),
        (
            "row = 1\nmass_kg = 1\ndirections = [\"X\"]",
            "attached.directions: expected dof beside it, found row, which has no node",
        ),
        (
            "dof = \"1+X\"\nstiffness = 1\ndirections = [\"X\"]",
            "attached.directions: expected the key mass or mass_kg beside it, found none",
        ),
        (
            "dof = \"1+X\"\nmass_kg = 1\ndirections = [\"Y\"]",
            "attached.directions: expected a direction that [dofs] names at node 1 (X, Z), found Y",
        ),
        (
            "dof = \"1+X\"\nmass_kg = 1\ndirections = [\"RX\"]",
            "attached.directions: expected a list of \"X\", \"Y\" and \"Z\", each at most once, found \"RX\"",
        ),
        (
            "dof = \"1+X\"\nmass_kg = 1\ndirections = [\"X\", \"x\"]",
            "attached.directions: expected a list of \"X\", \"Y\" and \"Z\", each at most once, found the list [the text \"X\", the text \"x\"]",
        ),
    ] {
        let said = refusal(&measured(&[], &format!("[[attached]]\n{keys}\n")));
        assert!(said.ends_with(message), "{said}");
    }
}
