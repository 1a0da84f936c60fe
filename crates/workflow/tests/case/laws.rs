//! Laws in a case: as a factor, and as what is to be found.

use super::files::{edited, folder, refused, with};
use frfit::identify::{Reduction, Variation};
use frfit::laws::LawKind;
use frfit::material::{Branch, Law};
use frfit_workflow::load::{Overrides, Purpose, load};

fn varies(keys: &str) -> Variation {
    let text = edited("case.toml", "order = 20", &format!("order = 20\n{keys}"));
    let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify).unwrap();
    let identify = case.identify.unwrap();
    let varies = identify.unknowns[0].varies.clone();
    let reduction = if varies == Variation::PerFrequency { Reduction::Auto } else { Reduction::Subspace };
    assert_eq!(identify.options.reduction, reduction);
    varies
}

fn kinds(keys: &str) -> Vec<LawKind> {
    match varies(keys) {
        Variation::Law(kinds) => kinds,
        other => panic!("{keys}: {other:?}"),
    }
}

#[test]
fn laws_to_be_found() {
    assert_eq!(varies(""), Variation::PerFrequency);
    assert_eq!(varies("varies = \"frequency\""), Variation::PerFrequency);
    assert_eq!(varies("varies = \"smooth\""), Variation::Smooth);
    assert_eq!(varies("varies = \"smooth\"\nreal = true"), Variation::Smooth);
    assert_eq!(kinds("varies = \"law\""), LawKind::ALL);
    assert_eq!(kinds("varies = \"law\"\nlaw = \"zener\""), [LawKind::FractionalZener]);
    assert_eq!(
        kinds("varies = \"law\"\nlaw = [\"constant\", \"maxwell\"]\nbranches = 5"),
        [LawKind::Constant, LawKind::Maxwell { branches: 5 }]
    );
    assert_eq!(kinds("varies = \"law\"\nlaw = \"maxwell:2\""), [LawKind::Maxwell { branches: 2 }]);
}

#[test]
fn laws_that_cannot_be_found_are_refused() {
    let law =
        "\"constant\", \"fractional\", \"zener\" or \"maxwell\" (\"maxwell:N\" with N from 1 to 20 branches)";
    for (keys, message) in [
        ("law = \"zener\"", "case.toml:32:1: identify.law: expected varies = \"law\" beside it, found none".to_owned()),
        (
            "varies = \"laws\"",
            "case.toml:32:1: identify.varies: expected \"frequency\" (a value of its own at each), \"smooth\", \"constant\" or \"law\", found \"laws\"".into(),
        ),
        (
            "varies = \"law\"\nlaw = \"zenner\"",
            format!("case.toml:33:1: identify.law: expected {law}, found \"zenner\""),
        ),
        (
            "varies = \"law\"\nlaw = [\"zener\", \"zener\"]",
            "case.toml:33:17: identify.law: expected each law once, found \"zener\" a second time".into(),
        ),
        (
            "varies = \"law\"\nlaw = \"zener\"\nbranches = 2",
            "case.toml:34:1: identify.branches: expected law = \"maxwell\" beside it, found none".into(),
        ),
        (
            "varies = \"law\"\nlaw = \"maxwell\"\nbranches = 0",
            "case.toml:34:1: identify.branches: expected 1 to 20, found 0".into(),
        ),
        (
            "varies = \"law\"\nreal = true",
            "case.toml:32:1: identify.varies: expected \"frequency\", \"smooth\" or \"constant\" for a real unknown, found \"law\" with real = true".into(),
        ),
        (
            "varies = \"smooth\"\nlaw = \"zener\"",
            "case.toml:33:1: identify.law: expected varies = \"law\" beside it, found none".into(),
        ),
        (
            "varies = \"smooth\"\nreduction = \"full\"",
            "case.toml:32:1: identify.varies: expected \"frequency\", or the reduction \"subspace\", found \"smooth\" with reduction \"full\"".into(),
        ),
        (
            "varies = \"law\"\nreduction = \"full\"",
            "case.toml:32:1: identify.varies: expected \"frequency\", or the reduction \"subspace\", found \"law\" with reduction \"full\"".into(),
        ),
        (
            "varies = \"law\"\nmethod = \"series\"",
            "case.toml:32:1: identify.varies: expected \"frequency\", or selection = \"joint\", found \"law\" with selection \"smallest\"".into(),
        ),
    ] {
        refused("case.toml", &edited("case.toml", "order = 20", &format!("order = 20\n{keys}")), &message);
    }
}

#[test]
fn laws_as_factors() {
    for (text, law) in [
        (
            "{ law = \"zener\", e0 = 1e6, e_infinity = 2e9, tau = 1e-3, alpha = 0.6 }",
            Law::FractionalZener { e0: 1e6, e_infinity: 2e9, tau_s: 1e-3, alpha: 0.6 },
        ),
        (
            "{ law = \"maxwell\", e0 = 1e6, branches = [[2e6, 1e-3], [3, 0.5]] }",
            Law::Maxwell {
                e0: 1e6,
                branches: vec![Branch { modulus: 2e6, tau_s: 1e-3 }, Branch { modulus: 3.0, tau_s: 0.5 }],
            },
        ),
    ] {
        let folder =
            folder("case.toml", Some(edited("case.toml", "{ table = \"modulus.csv\" }", text).as_bytes()));
        let case = load(&folder.path().join("case.toml"), &Overrides::default(), Purpose::Respond).unwrap();
        assert_eq!(case.model.terms()[1].factor, law);
    }
    for (text, message) in [
        (
            "{ law = \"zener\", e0 = 1e6, e_infinity = 2e9, tau = 0, alpha = 0.6 }",
            "case.toml:11:55: matrix.factor.tau: expected a time above 0 s, found 0",
        ),
        (
            "{ law = \"zener\", e0 = 1e6, e_infinity = 2e9, tau = 1, alpha = 1.6 }",
            "case.toml:11:64: matrix.factor.alpha: expected a number from 0 (elastic) to 1 (viscous), found 1.6",
        ),
        (
            "{ law = \"zener\", e0 = 1e6, e1 = 2e9, tau = 1, alpha = 0.6 }",
            "case.toml:11:37: matrix.factor: expected a known key, of which \"e0\" is nearest, found \"e1\"",
        ),
        (
            "{ law = \"maxwell\", e0 = 1e6, branches = [] }",
            "case.toml:11:39: matrix.factor.branches: expected at least one branch [modulus, time], found the list []",
        ),
        (
            "{ law = \"maxwell\", e0 = 1e6, branches = [[1, 0]] }",
            "case.toml:11:39: matrix.factor.branches: expected branches [modulus, time] with times above 0 s, found the list [the list [1, 0]]",
        ),
        (
            "{ law = \"maxwell\", e0 = 1e6, branches = [1] }",
            "case.toml:11:51: matrix.factor.branches: expected two finite numbers [low, high], found 1",
        ),
    ] {
        refused("case.toml", &edited("case.toml", "{ table = \"modulus.csv\" }", text), message);
    }
}
