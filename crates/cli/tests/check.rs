//! `frfit check`, and what `frfit identify` says of it.

use crate::common;
use crate::tier::of_tier;

use common::{done, frfit, refused};
use std::fs;
use std::path::Path;

/// The bar that is struck at its end, in `bar/`, its second measurement said to be a mobility.
fn faulty(folder: &Path) {
    done(folder, &["example", "rubber-bar-end", "bar"]);
    let file = folder.join("bar/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    let wrong = text.replace("record = 2\n", "record = 2\nquantity = \"mobility\"\n");
    assert_ne!(text, wrong);
    fs::write(file, wrong).unwrap();
}

#[test]
fn a_fault_is_told_in_words_with_the_key_to_change() {
    let folder = tempfile::tempdir().unwrap();
    faulty(folder.path());
    insta::assert_snapshot!("check_fault", done(folder.path(), &["check", "bar/case.toml"]));
    let strict = frfit(folder.path(), &["check", "bar/case.toml", "--strict"]);
    assert_eq!(strict.status.code(), Some(1));
    let found: serde_json::Value =
        serde_json::from_str(&done(folder.path(), &["check", "bar/case.toml", "--json"])).unwrap();
    assert_eq!(found["findings"][0]["kind"], "quantity");
    assert_eq!(found["findings"].as_array().unwrap().len(), 1);
}

/// As on the page about the report: both sensors are elsewhere. A factor without a name beside another row fits nearly as well.
#[test]
fn two_wrong_rows_are_found_together() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["example", "rubber-bar-end", "bar"]);
    let file = folder.path().join("bar/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    let wrong = text.replace("row = 101", "row = 81").replace("row = 51", "row = 31");
    fs::write(file, wrong).unwrap();
    let found: serde_json::Value =
        serde_json::from_str(&done(folder.path(), &["check", "bar/case.toml", "--json"])).unwrap();
    let words: Vec<&str> =
        found["findings"].as_array().unwrap().iter().map(|one| one["what"].as_str().unwrap()).collect();
    assert!(words.len() == 2 && words[0].contains("row 51") && words[1].contains("row 101"), "{words:?}");
}

#[test]
fn a_clean_case_has_no_finding() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["example", "rubber-bar-end", "bar"]);
    insta::assert_snapshot!("check_clean", done(folder.path(), &["check", "bar/case.toml", "--strict"]));
    assert!(refused(folder.path(), &["check", "none.toml"]).contains("none.toml"));
}

#[test]
fn identify_looks_first_unless_it_shall_not() {
    let folder = tempfile::tempdir().unwrap();
    faulty(folder.path());
    let file = folder.path().join("bar/case.toml");
    let lines = format!("[identify]\nmax_lines = {}\n", of_tier(12, 40));
    let text = fs::read_to_string(&file).unwrap().replace("[identify]\n", &lines);
    fs::write(&file, &text).unwrap();
    let findings = || -> serde_json::Value {
        let text = fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()["findings"].clone()
    };
    let said = done(folder.path(), &["identify", "bar/case.toml", "--out", "out"]);
    let at = |word: &str| said.find(word).unwrap_or_else(|| panic!("{word}: {said}"));
    assert!(at("is taken for mobility") < at("status"));
    assert_eq!(findings()[0]["kind"], "quantity");
    fs::write(&file, text.replace("[identify]\n", "[identify]\ncheck = false\n")).unwrap();
    let said = done(folder.path(), &["identify", "bar/case.toml", "--out", "out"]);
    assert!(!said.contains("is taken for"));
    assert!(findings().is_null());
}
