//! What is unknown: one table or several, and what each of them may say.

use super::files::{CASE, edited, refused, with};
use frfit::identify::{Reduction, Variation};
use frfit::laws::LawKind;
use frfit_workflow::load::{Check, IdentifyCase, Overrides, Purpose};

/// The case with other keys in place of its table `[identify]`.
fn case(keys: &str) -> String {
    let (before, _) = CASE.split_once("[identify]").unwrap();
    format!("{before}{keys}")
}

fn identify(text: &str) -> IdentifyCase {
    let case = with("case.toml", text.as_bytes(), &Overrides::default(), Purpose::Identify);
    case.unwrap_or_else(|error| panic!("{error}\n{text}")).identify.unwrap()
}

/// Two unknowns: `first` and `second` are more keys of theirs.
fn two(first: &str, second: &str) -> String {
    case(&format!(
        "[[identify]]\nmatrix = \"springs\"\nband_hz = [10, 30]\n{first}\n[[identify]]\nmatrix = \"mass\"\n{second}\n"
    ))
}

#[test]
fn a_table_is_a_list_of_one() {
    for keys in [
        "",
        "varies = \"smooth\"",
        "varies = \"law\"",
        "varies = \"law\"\nlaw = [\"zener\", \"maxwell\"]",
        "varies = \"law\"\nlaw = \"maxwell\"\nbranches = 5\nname = \"glue\"",
        "varies = \"constant\"",
        "real = true\nreduction = \"full\"\nreject_outliers = false",
        "start = \"bounds\"\ncheck = false\nexclude_hz = [20]",
    ] {
        // The order of the case is one of a single unknown that varies.
        let without = if keys.contains("constant") { keys.into() } else { format!("order = 20\n{keys}") };
        let text = edited("case.toml", "order = 20", &without);
        let list = text.replace("[identify]", "[[identify]]");
        assert_eq!(format!("{:?}", identify(&text)), format!("{:?}", identify(&list)), "{keys}");
    }
}

#[test]
fn the_data_are_checked_when_it_costs_least_or_never() {
    let check = |text: &str| identify(text).check;
    assert_eq!(check(CASE), Check::First);
    assert_eq!(check(&edited("case.toml", "order = 20", "check = false")), Check::Never);
    assert_eq!(check(&edited("case.toml", "order = 20", "varies = \"constant\"")), Check::IfUnexplained);
    let constant = "varies = \"constant\"";
    assert_eq!(check(&two("", constant)), Check::IfUnexplained);
    assert_eq!(check(&two("check = false", constant)), Check::Never);
}

#[test]
fn a_dimension_that_varies_is_found_with_all_its_solutions() {
    let dimension = "[identify]\nname = \"width\"\npowers = { springs = 3, mass = 1 }\nnominal = 1.1\n\
                     band_hz = [10, 30]\nreal = false\n";
    let found = identify(&case(dimension));
    assert_eq!((&found.unknowns[0].varies, found.check), (&Variation::Constant, Check::IfUnexplained));
    let found = identify(&case(&format!("{dimension}varies = \"frequency\"\norder = 7\n")));
    assert_eq!((found.options.order, found.check), (7, Check::First));
    let found = identify(&case(&format!("{dimension}varies = \"law\"\nlaw = \"zener\"\n")));
    assert_eq!(found.unknowns[0].varies, Variation::law(LawKind::FractionalZener));
    assert_eq!(found.options.reduction, Reduction::Subspace);
}

#[test]
fn what_cannot_be_unknown_is_refused() {
    let one_way = "expected nothing here: several unknowns, constants and negative powers have one method only, found a choice";
    let constant = "varies = \"constant\"";
    for (text, message) in [
        (two("order = 3", constant), format!("case.toml:31:1: identify.order: {}", one_way)),
        (
            two("", &format!("{constant}\nstart = \"bounds\"")),
            format!("case.toml:35:1: identify.start: {}", one_way),
        ),
        (
            case("[identify]\nname = \"l\"\npowers = { springs = -1 }\nnominal = 1\nvaries = \"frequency\"\nmethod = \"series\"\nband_hz = [10, 30]\n"),
            format!("case.toml:33:1: identify.method: {}", one_way),
        ),
        (
            case("[identify]\nname = \"l\"\npowers = { springs = 1 }\nnominal = 1\nvaries = \"frequency\"\nstart = \"bounds\"\nband_hz = [10, 30]\n"),
            "case.toml:33:1: identify.start: expected no such key with a dimension, which begins at its nominal value, found one".into(),
        ),
        (
            two("varies = \"smooth\"", "varies = \"frequency\""),
            "case.toml:34:1: identify.varies: expected \"smooth\", \"constant\" or \"law\" beside a smooth unknown (the data cannot show which of the two varies from line to line), found \"frequency\"".into(),
        ),
        (
            two("varies = \"law\"\nlaw = [\"zener\", \"maxwell\"]", constant),
            "case.toml:31:1: identify.varies: expected one law, by the key law, with several unknowns or a negative power, found 2 laws".into(),
        ),
        (
            two("varies = \"law\"", constant),
            format!("case.toml:31:1: identify.varies: expected one law, by the key law, with several unknowns or a negative power, found {} laws", LawKind::ALL.len()),
        ),
        (
            case("[identify]\nname = \"d\"\npowers = { springs = 1 }\nnominal = 1\nvaries = \"smooth\"\nband_hz = [10, 30]\n"),
            "case.toml:32:1: identify.varies: expected \"frequency\", \"constant\" or \"law\" for a dimension, found \"smooth\"".into(),
        ),
        (
            two("bounds = { storage = [1, 1] }", constant),
            "case.toml:31:12: identify.bounds.storage: expected [low, high] with low < high, found [1, 1]".into(),
        ),
        (
            two("real = true", constant),
            "case.toml:28:1: identify: expected a matrix with a real factor, for real = true, found a loss factor".into(),
        ),
        (
            two("", &format!("{constant}\ncheck = false")),
            "case.toml:35:1: identify.check: expected this key in the first [[identify]], for all, found it here".into(),
        ),
        (
            edited("case.toml", "order = 20", "nominal = 2e5"),
            "case.toml:31:1: identify.nominal: expected no nominal value: it is the factor of the matrix, found one".into(),
        ),
        (
            edited("case.toml", "bounds = { storage = [1e5, 1e6], loss_factor = [0.0, 1.0] }", "bounds = 3"),
            "case.toml:32:1: identify.bounds: expected a table, or [low, high] of a real unknown, found 3".into(),
        ),
        (
            edited("case.toml", "order = 20", "exclude_hz = [[0, 50]]"),
            "case.toml:31:1: identify.exclude_hz: expected a frequency of the band that is not left out, found none".into(),
        ),
    ] {
        refused("case.toml", &text, &message);
    }
    let overrides = Overrides { method: Some("series".into()), ..Overrides::default() };
    let error = with("case.toml", two("", constant).as_bytes(), &overrides, Purpose::Identify).unwrap_err();
    assert_eq!(error.to_string(), format!("--method: {}", one_way));
}
