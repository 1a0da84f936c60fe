//! The page of several unknowns.

use crate::made::several::{MadeSeveral, several};
use frfit_report::{FILES, html};
use proptest::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;

type Files = BTreeMap<&'static str, Vec<u8>>;

fn page(files: &Files) -> Result<String, String> {
    html(&|name| files.get(name).cloned()).map_err(|error| error.to_string())
}

/// The JSON in the page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

/// The page without its scripts: what is read.
fn text(made: &MadeSeveral) -> String {
    let page = page(&several(made)).unwrap();
    page.split_once("<body>").unwrap().1.split_once("<script").unwrap().0.to_owned()
}

fn says(made: &MadeSeveral, sentences: &[&str]) {
    let text = text(made);
    for sentence in sentences {
        assert!(text.contains(sentence), "{sentence:?} is not in\n{text}");
    }
}

#[test]
fn the_verdict_names_each_unknown_with_its_bar() {
    says(
        &MadeSeveral::default(),
        &[
            "Can be used",
            "mass and skins are known for the whole band; core is known at 50 of 50 frequencies (100 %), and the model explains all sensors within the noise.",
            "<td>mass</td><td>0.065000 ± 0.000020</td><td>0.04</td><td>trusted</td>",
            "<td>skins storage</td><td>(6.90000 ± 0.00018)·10¹⁰</td><td>7.3·10¹⁰</td>",
            "<td>skins loss factor</td><td>0.003000 ± 0.000020</td><td>0.001</td>",
            "core: a value at every frequency; mass: one value for the band",
            "id=\"plot-modulus-1\"",
            "id=\"plot-correlation\"",
            "id=\"plot-profile\"",
            "mass larger, skins storage smaller (by 0.33 of this), skins loss factor smaller (by 0.33 of this)",
            "core: off by 1·10⁻⁵ % (median), by 2·10⁻⁵ % at most where trusted",
            "mass: off by 0.01 % (0.8 of its standard deviations)",
        ],
    );
}

#[test]
fn what_is_not_told_comes_before_the_numbers_and_has_none() {
    let made = MadeSeveral { unclear: true, ..MadeSeveral::default() };
    says(
        &made,
        &[
            "Use with care",
            "skins is known for the whole band; mass is not;",
            "Not identifiable from these measurements: mass larger with skins storage smaller: not identifiable.",
            "<td>mass</td><td>not identifiable</td>",
            "<dd class=\"value\">not identifiable</dd>",
            "the measurements do not limit this combination",
        ],
    );
    assert!(!text(&made).contains("0.065 "));
    let constants = MadeSeveral { varies: false, ..MadeSeveral::default() };
    says(
        &constants,
        &[
            "Frequencies that are explained",
            "<b>50 explained</b>: the values that hold for the band explain all sensors there",
        ],
    );
    let nothing = MadeSeveral { unclear: true, varies: false, constants: 1, ..MadeSeveral::default() };
    says(&nothing, &["Do not use yet", "No value of mass is trusted"]);
}

#[test]
fn the_level_follows_fit_and_band() {
    let with = |fit: &'static str, bad: usize| MadeSeveral { fit, bad, ..MadeSeveral::default() };
    says(&with("not explained", 0), &["Do not use yet", "larger than the noise"]);
    says(&with("nearly explained", 0), &["Use with care", "a little larger than the noise"]);
    says(&with("untested", 0), &["Use with care", "no independent measurement tests the fit"]);
    says(&with("explained", 20), &["Use with care", "core is known at 30 of 50 frequencies (60 %)"]);
    let core = MadeSeveral { bad: 50, constants: 0, ..MadeSeveral::default() };
    says(&core, &["Do not use yet", "No frequency has a trusted storage modulus of core"]);
    // Constants stand where a modulus at single frequencies does not.
    says(
        &with("explained", 50),
        &["Use with care", "mass and skins are known for the whole band; core is known at 0 of 50"],
    );
}

#[test]
fn pictures_without_anything_to_show_are_left_out() {
    let one = MadeSeveral { constants: 1, varies: false, ..MadeSeveral::default() };
    says(&one, &["id=\"plot-profile\""]);
    assert!(!text(&one).contains("id=\"plot-correlation\"") && !text(&one).contains("id=\"plot-modulus"));
    let none = MadeSeveral { constants: 0, ..MadeSeveral::default() };
    // One unknown with a value at each frequency has no correlation.
    for absent in ["Correlation", "plot-profile", "Values for the whole band"] {
        assert!(!text(&none).contains(absent), "{absent}");
    }
}

#[test]
fn data_has_the_curves_of_what_varies_and_the_picture_of_the_rest() {
    let data = data(&page(&several(&MadeSeveral::default())).unwrap());
    let unknowns = data["unknowns"].as_array().unwrap();
    assert_eq!((unknowns.len(), &unknowns[0]["label"]), (1, &Value::from("core")));
    for part in ["storage", "storage_std", "loss_factor", "loss_factor_std"] {
        let column = &data["columns"][unknowns[0]["columns"][part].as_str().unwrap()];
        assert_eq!(column.as_array().unwrap().len(), 50, "{part}");
    }
    assert_eq!(unknowns[0]["reference"]["storage"][0], 1_000_000);
    // A constant has one number, not a column of it.
    assert!(data["columns"].get("mass.storage").is_none());
    let together = &data["together"];
    assert_eq!(together["coordinates"].as_array().unwrap().len(), 3);
    assert_eq!(together["correlation"][0], serde_json::json!([1, 0.25, 0.25]));
    // (2e-4 / 1e-4)².
    assert_eq!(
        (&together["profile"]["distance"][7], &together["profile"]["linear"][7]),
        (&2e-4.into(), &4.into())
    );
}

#[test]
fn names_of_users_are_text() {
    let made = MadeSeveral { name: "</script><img src=x onerror=alert(2)>", ..MadeSeveral::default() };
    let page = page(&several(&made)).unwrap();
    assert!(!page.contains("<img") && page.contains("&lt;img src=x onerror=alert(2)&gt;"));
    assert_eq!(data(&page)["together"]["coordinates"][0], made.name);
}

#[test]
fn what_is_missing_or_broken_is_told_with_its_place() {
    for (name, from, to, expected) in [
        ("summary.json", "\"coordinates\"", "\"ordinates\"", "summary.json: expected a list in coordinates"),
        (
            "summary.json",
            "\"skins loss_factor\"\n",
            "\"skins loss_factor\", \"x\"\n",
            "summary.json: expected 4 rows of 4 in correlation",
        ),
        ("summary.json", "\"ok\"", "\"fine\"", "summary.json: expected a status of each in unknowns"),
        (
            "reference.csv",
            "core.nominal_re",
            "core.nominal",
            "reference.csv:1: expected a column core.nominal_re",
        ),
        ("reference.csv", "\n20.0,", "\n20.5,", "reference.csv:2:1: expected 20.0, as in identified.csv"),
        (
            "identified.csv",
            "core.storage_std",
            "core.std",
            "identified.csv:1: expected a column .storage_std, as .std is called now",
        ),
    ] {
        let mut files = several(&MadeSeveral::default());
        let text = String::from_utf8(files[name].clone()).unwrap();
        assert!(text.contains(from), "{name}: {from}");
        files.insert(name, text.replacen(from, to, 1).into_bytes());
        let found = page(&files).unwrap_err();
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    let mut files = several(&MadeSeveral::default());
    files.remove("reference.csv");
    assert!(page(&files).unwrap_err().starts_with("reference.csv: expected this file"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn broken_bytes_give_a_page_or_an_error(name in 0..4_usize, at in 0.0..1.0_f64, byte in any::<u8>(), cut in any::<bool>()) {
        let mut files = several(&MadeSeveral { frequencies: 6, ..MadeSeveral::default() });
        let name = *files.keys().nth(name).unwrap();
        let bytes = files.get_mut(name).unwrap();
        let at = (at * bytes.len() as f64) as usize;
        match cut {
            true => bytes.truncate(at),
            false => bytes[at] = byte,
        }
        match page(&files) {
            Ok(page) => { data(&page); }
            Err(message) => prop_assert!(message.contains("expected") && FILES.iter().any(|name| message.starts_with(name)), "{}", message),
        }
    }
}
