//! The page of results that are made here, whole and broken.

use crate::made;
use crate::tier::of_tier;

use frfit::identify::Status;
use frfit_report::{FILES, LARGEST, html};
use made::{Made, results};
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
fn text(page: &str) -> &str {
    page.split_once("<body>").unwrap().1.split_once("<script").unwrap().0
}

#[test]
fn the_same_files_give_the_same_page_and_nothing_is_loaded() {
    let files = results(&Made::default());
    let one = page(&files).unwrap();
    assert_eq!(one, page(&files).unwrap());
    assert!(one.starts_with("<!doctype html>\n<html lang=\"en\">") && one.ends_with("</html>\n"));
    // No element has an address of anything outside: the policy forbids it, and nothing asks for it.
    let own = one.replace(include_str!("../vendor/plotly-cartesian.min.js"), "");
    for word in ["http://", "https://", " src=", "@import", "url("] {
        assert!(!own.contains(word), "{word}");
    }
    assert!(own.contains("default-src 'none'"));
}

#[test]
fn the_library_is_the_one_whose_sum_is_told() {
    use sha2::{Digest, Sha256};
    let sum = Sha256::digest(include_bytes!("../vendor/plotly-cartesian.min.js"));
    let sum: String = sum.iter().map(|byte| format!("{byte:02x}")).collect();
    assert!(include_str!("../vendor/README.md").contains(&sum), "{sum}");
    // It stands in a script element as it is.
    assert!(!include_str!("../vendor/plotly-cartesian.min.js").to_ascii_lowercase().contains("</script"));
}

#[test]
fn text_of_users_is_text() {
    let evil = "</title></script><script>alert('1')</script>\"<img src=x onerror=alert(2)>";
    let files = results(&Made { title: evil, label: evil, file: evil, ..Made::default() });
    let page = page(&files).unwrap();
    assert!(!page.contains("<script>alert") && !page.contains("<img") && !page.contains("<i>"));
    assert_eq!(
        page.matches("<script").count()
            - include_str!("../vendor/plotly-cartesian.min.js").matches("<script").count(),
        3
    );
    let data = data(&page);
    assert_eq!(data["sensors"][0]["label"], evil);
    assert!(text(&page).contains("&lt;img src=x onerror=alert(2)&gt;"));
}

/// Numbers of one length, finite or null.
fn is_curve(values: &Value, length: usize) -> bool {
    let is_number = |value: &Value| value.is_null() || value.as_f64().is_some_and(f64::is_finite);
    values.as_array().is_some_and(|values| values.len() == length && values.iter().all(is_number))
}

#[test]
fn every_curve_is_as_long_as_its_axis() {
    let made = Made { free: true, error_map: true, std: true, ..Made::default() };
    let data = data(&page(&results(&made)).unwrap());
    let length = |value: &Value| value.as_array().unwrap().len();
    let rows = length(&data["frequency_hz"]);
    assert_eq!(rows, made.frequencies);
    for (name, column) in data["columns"].as_object().unwrap() {
        assert!(is_curve(column, rows), "{name}");
    }
    for pointer in [
        "/nominal_error",
        "/unknowns/0/nominal/storage",
        "/unknowns/0/nominal/loss_factor",
        "/unknowns/0/reference/storage",
        "/unknowns/0/free/storage",
        "/unknowns/0/free/loss_factor",
        "/status",
    ] {
        assert!(is_curve(data.pointer(pointer).unwrap(), rows), "{pointer}");
    }
    let sensors = data["sensors"].as_array().unwrap();
    assert_eq!(sensors.len(), made.sensors);
    for sensor in sensors {
        let rows = length(&sensor["frequency_hz"]);
        for pointer in [
            "/nominal/re",
            "/nominal/im",
            "/measured/re",
            "/measured/im",
            "/updated/re",
            "/updated/im",
            "/measured_std",
        ] {
            assert!(is_curve(sensor.pointer(pointer).unwrap(), rows), "{pointer}");
        }
        // The updated response is the measured one; the nominal is another.
        assert!(sensor["frac"]["updated"].as_f64().unwrap() > 0.999_999, "{}", sensor["frac"]);
        assert!(sensor["frac"]["nominal"].as_f64().unwrap() < 0.9, "{}", sensor["frac"]);
    }
    let map = &data["error_map"];
    assert_eq!(length(&map["log_error"]), length(&map["order"]));
    assert!(
        map["log_error"].as_array().unwrap().iter().all(|row| is_curve(row, length(&map["frequency_hz"])))
    );
    for kind in ["alternative", "admissible", "refused"] {
        let found = &data["unknowns"][0]["candidates"][kind];
        let rows = length(&found["frequency_hz"]);
        assert!(is_curve(&found["storage"], rows) && is_curve(&found["loss_factor"], rows), "{kind}");
        assert!(rows > 0, "{kind}");
    }
}

#[test]
fn the_verdict_says_how_much_can_be_trusted_and_why_not_the_rest() {
    let made = Made { bad: 10, ..Made::default() };
    let page = page(&results(&made)).unwrap();
    let text = text(&page);
    // 10 of 100 frequencies are not identifiable: the others can be used.
    for expected in [
        "Can be used",
        "90 of 100",
        "90 %",
        "<b>90 trusted</b>",
        "<b>10 not identifiable</b>",
        "noise leaves the value unknown",
        "found no fault",
    ] {
        assert!(text.contains(expected), "{expected}");
    }
    let care = Made { bad: 40, ..Made::default() };
    assert!(text_of(&care).contains("Use with care"));
    let none = Made { bad: 100, ..Made::default() };
    assert!(
        text_of(&none).contains("Do not use yet")
            && text_of(&none).contains("Cole–Cole plot</b>: not drawn, for no frequency is trusted")
    );
    let unexplained = Made { fit: "not explained", ..Made::default() };
    assert!(
        text_of(&unexplained).contains("Do not use yet")
            && text_of(&unexplained).contains("larger than the noise")
    );
    let untested = Made { fit: "untested", ..Made::default() };
    assert!(
        text_of(&untested).contains("Use with care")
            && text_of(&untested).contains("no independent measurement tests")
    );
    let found = Made { finding: true, ..Made::default() };
    assert!(
        text_of(&found).contains("Use with care")
            && text_of(&found).contains("accelerance is taken for mobility")
    );
    assert!(text_of(&found).contains("Change <code>quantity of [[measurement]] 2</code>"));
}

/// Explanations between which the data do not decide are listed, and the verdict is "with care". Beside a finding that is decided there is
/// only the likeliest of them.
#[test]
fn what_may_be_wrong_is_told_as_such() {
    let mut files = results(&Made::default());
    let mut summary: Value = serde_json::from_slice(&files["summary.json"]).unwrap();
    summary["other_explanations"] = serde_json::json!([
        {"faults": [{"kind": "sign", "sensors": ["a<b"], "what": "the sign is reversed"},
                    {"kind": "delay", "sensors": [], "what": "late by 1 ms"}], "misfit": 0.213, "nats_behind": 0.0},
        {"faults": [{"kind": "factor", "sensors": ["c"], "what": "1000 times too large"}], "misfit": 0.25, "nats_behind": 4.41},
    ]);
    files.insert("summary.json", summary.to_string().into_bytes());
    let undecided = page(&files).unwrap();
    for expected in [
        "Use with care",
        "<b>a&lt;b: the sign is reversed; and late by 1 ms</b>. Misfit of ln(measured/model) 0.21; log-likelihood 0 below the best (in nats).",
        "<b>c: 1000 times too large</b>. Misfit of ln(measured/model) 0.25; log-likelihood 4.4 below the best (in nats).",
    ] {
        assert!(text(&undecided).contains(expected), "{expected}\n{}", text(&undecided));
    }
    assert!(!text(&undecided).contains("found no fault"));
    summary["findings"] = serde_json::json!([{"kind": "conjugated", "sensors": [], "what": "conjugated", "change": "nothing", "evidence": {}}]);
    files.insert("summary.json", summary.to_string().into_bytes());
    let decided = page(&files).unwrap();
    assert!(text(&decided).contains("conjugated") && !text(&decided).contains("1000 times too large"));
    assert!(
        text(&decided).contains("The likeliest other explanation: <b>a&lt;b: the sign is reversed; and late")
    );
}

/// Where the band is not explained the report lists the modes above the plots: pairs with their differences, and modes without a partner.
#[test]
fn modes_stand_side_by_side_where_nothing_is_explained() {
    let mut files = results(&Made { fit: "not explained", ..Made::default() });
    let summary: Value = serde_json::from_slice(&files["summary.json"]).unwrap();
    let mode =
        |number: u64, hz: f64| serde_json::json!({"mode": number, "frequency_hz": hz, "damping_ratio": 0.01});
    let mut with_modes = summary.clone();
    with_modes["modes"] = serde_json::json!({
        "model": {"modes": [
            {"mode": 1, "frequency_hz": 1e-4, "damping_ratio": 0.0, "is_rigid_body": true},
            mode(2, 31.5), mode(3, 48.25), mode(4, 66.0),
        ]},
        "measured": {
            "modes": [mode(1, 30.0), mode(2, 64.5)],
            "pairs": [
                {"model": 2, "measured": 1, "frequency_difference": 0.05, "difference_at_factor": 0.001, "mac": 0.987},
                {"model": 4, "measured": 2, "frequency_difference": -0.0233, "difference_at_factor": -0.0004, "mac": null},
            ],
            "stiffness_factor": 1.31,
            "comac": {"a<b": 0.998, "c": 0.611},
        },
    });
    files.insert("summary.json", with_modes.to_string().into_bytes());
    let whole = page(&files).unwrap();
    let text = text(&whole);
    let section = text.split_once("<section id=\"modes\"").unwrap().1.split_once("</section>").unwrap().0;
    let row =
        |cells: [&str; 7]| format!("<tr>{}</tr>", cells.map(|cell| format!("<td>{cell}</td>")).concat());
    assert!(section.contains(&row(["31.5", "30", "+5.00", "+0.10", "1", "1", "0.99"])), "{section}");
    assert!(section.contains(&row(["48.25", "–", "–", "–", "1", "–", "–"])), "{section}");
    assert!(section.contains("−2.33") && section.contains("multiplied by 1.31"), "{section}");
    assert!(section.contains("a&lt;b 1.00, c 0.61"), "{section}");
    // The rigid-body mode is not drawn.
    assert_eq!(section.matches("<title>").count(), 5, "{section}");
    assert_eq!([section.matches("class=\"pair\"").count(), section.matches(" alone\"").count()], [2, 1]);
    files.insert("summary.json", summary.to_string().into_bytes());
    assert!(!page(&files).unwrap().contains("<section id=\"modes\""));
}

#[test]
fn doubts_about_sensors_come_before_the_numbers() {
    let mut files = results(&Made::default());
    let summary = String::from_utf8(files["summary.json"].clone()).unwrap();
    let doubtful = summary.replacen(
        "\"contradicts\": false",
        "\"contradicts\": true, \"scale\": 9.80665, \"scale_std\": 0.001, \"delay_s\": null",
        1,
    );
    let doubtful = doubtful.replacen("\"left_out\": false", "\"left_out\": true", 1);
    assert_ne!(doubtful, summary);
    files.insert("summary.json", doubtful.into_bytes());
    let page = page(&files).unwrap();
    for expected in [
        "Use with care",
        "Sensor S1 contradicts all others. It was left out.",
        "The scale of sensor S1 was unknown and found: 9.8066 ± 0.0020 times what the file says.",
        "The delay of sensor S1 was unknown, and is not identifiable from the data: it was left out.",
    ] {
        assert!(text(&page).contains(expected), "{expected}");
    }
}

#[test]
fn a_solution_at_infinity_is_no_fault() {
    let mut files = results(&Made::default());
    let table = String::from_utf8(files["candidates.csv"].clone()).unwrap();
    let without = table.replacen(",0.2,0.0,0.0,far", ",,0.0,0.0,far", 1);
    let line = without.lines().position(|line| line.ends_with(",,0.0,0.0,far")).unwrap();
    let mut lines: Vec<&str> = without.lines().collect();
    lines[line] = "20.0,,,0.0,0.0,far";
    files.insert("candidates.csv", (lines.join("\n") + "\n").into_bytes());
    assert!(
        data(&page(&files).unwrap())["unknowns"][0]["candidates"]["refused"]["storage"]
            .as_array()
            .unwrap()
            .iter()
            .any(Value::is_null)
    );
}

fn text_of(made: &Made) -> String {
    text(&page(&results(made)).unwrap()).to_owned()
}

#[test]
fn a_plot_without_data_is_left_out_with_a_sentence() {
    let with = page(&results(&Made { error_map: true, ..Made::default() })).unwrap();
    assert!(with.contains("id=\"plot-error-map\"") && with.contains("id=\"plot-reduction-error\""));
    let without = page(&results(&Made { reduction_error: false, real: true, ..Made::default() })).unwrap();
    for (id, expected) in [
        ("plot-error-map", "not drawn, for it needs method = \"series\""),
        ("plot-reduction-error", "not drawn, for the full model was solved"),
    ] {
        assert!(!without.contains(&format!("id=\"{id}\"")), "{id}");
        assert!(without.contains(expected), "{expected}");
    }
    // A real factor has no loss: nothing is missing.
    for word in ["plot-cole-cole", "plot-wicket", "Cole–Cole", "Wicket"] {
        assert!(!text(&without).contains(word), "{word}");
    }
}

/// The verdict first, how it was computed last and folded away; each heading with an id is in the table of contents.
#[test]
fn the_parts_come_in_the_order_in_which_they_are_needed_and_are_listed() {
    let page = page(&results(&Made { error_map: true, ..Made::default() })).unwrap();
    let text = text(&page);
    let (contents, main) = text.split_once("<main>").unwrap();
    let place = |id: &str| main.find(&format!("<section id=\"{id}\"")).unwrap_or_else(|| panic!("no {id}"));
    let order = ["verdict", "result", "fit", "uncertainty", "choice", "convergence", "table", "provenance"]
        .map(place);
    assert!(order.is_sorted(), "{order:?}");
    let folded = main.match_indices("<details>").map(|(at, _)| at).collect::<Vec<_>>();
    assert_eq!(folded.len(), 4);
    assert!(folded.iter().all(|&at| at > order[3]), "{folded:?}");
    let ids = |html: &str, before: &str| -> Vec<String> {
        html.split(before).skip(1).map(|rest| rest.split('"').next().unwrap().to_owned()).collect()
    };
    let mut listed = ids(contents, "<a href=\"#");
    // Of what is folded away the title alone.
    let mut there = [ids(main, "<h2 id=\""), ids(&main[..folded[0]], "<h3 id=\"")].concat();
    assert!(listed.len() > 12, "{listed:?}");
    listed.sort();
    there.sort();
    assert_eq!(listed, there);
    // Every link within the page has its place, and no place is there twice.
    for target in ids(text, "href=\"#") {
        assert_eq!(text.matches(&format!("id=\"{target}\"")).count(), 1, "{target}");
    }
}

/// The summary is for programs: the page links to it, and shows none of its keys.
#[test]
fn no_key_of_the_summary_is_on_the_page() {
    let whole = page(&results(&Made::default())).unwrap();
    assert!(text(&whole).contains("<a href=\"summary.json\" download>summary.json</a>"));
    for key in
        ["chi2_per_freedom", "chi2 per freedom", "band hz", "subspace size", "reject outliers", "{&quot;"]
    {
        assert!(!text(&whole).contains(key), "{key}");
    }
}

/// One sensor or the rule of the smallest correction leaves an answer untested, but for a reference with which every value agrees.
#[test]
fn known_values_that_agree_confirm_an_answer_that_nothing_else_tests() {
    let verdict_with = |wrong: Value, bad: usize, fit: &'static str| {
        let mut files = results(&Made { fit, bad, sensors: 1, ..Made::default() });
        let mut summary: Value = serde_json::from_slice(&files["summary.json"]).unwrap();
        summary["identify"]["selection"] = "smallest".into();
        summary["unknowns"][0]["reference"] = serde_json::json!({
            "within": 1e-6, "wrong_and_ok": wrong, "deviation": {"median_ok": 1e-9, "max_ok": 2e-9},
        });
        files.insert("summary.json", summary.to_string().into_bytes());
        text(&page(&files).unwrap()).to_owned()
    };
    let green = verdict_with(0.into(), 0, "untested");
    for expected in [
        "✓ Can be used",
        "class=\"good\"",
        "agrees with the values that this case gives as known",
        "use a second sensor and selection = &quot;joint&quot;",
    ] {
        assert!(green.contains(expected), "{expected}\n{green}");
    }
    for (wrong, bad, fit, level) in [
        (1.into(), 0, "untested", "Use with care"),
        (Value::Null, 0, "untested", "Use with care"),
        (0.into(), 40, "untested", "Use with care"),
        (0.into(), 0, "not explained", "Do not use yet"),
        (0.into(), 100, "untested", "Do not use yet"),
    ] {
        assert!(verdict_with(wrong, bad, fit).contains(level), "{fit} {bad} {level}");
    }
}

#[test]
fn a_single_frequency_makes_a_page() {
    let made = Made { frequencies: 1, ..Made::default() };
    let page = page(&results(&made)).unwrap();
    assert!(
        text(&page).contains("1 of 1") && text(&page).contains("<figcaption><span>20 Hz</span><span></span>")
    );
}

#[test]
fn tables_of_another_run_are_not_read() {
    let mut files = results(&Made::default());
    let whole = page(&files).unwrap();
    // A run with a law has left its table: the summary does not name it.
    files.insert("free.csv", b"no table of this run".to_vec());
    assert_eq!(page(&files).unwrap(), whole);
}

#[test]
fn what_is_missing_or_broken_is_reported_with_its_place() {
    let statuses = Status::ALL.map(Status::name).join(", ");
    for name in FILES.iter().filter(|name| !["free.csv", "error_map.csv"].contains(name)) {
        let mut files = results(&Made::default());
        files.remove(name);
        let message = page(&files).unwrap_err();
        assert_eq!(
            message,
            format!("{name}: expected this file, as frfit identify of this version writes it, found none")
        );
    }
    for (name, from, to, expected) in [
        ("summary.json", "{", "{{", "summary.json:1:2: expected JSON, found"),
        (
            "summary.json",
            "\"tables\"",
            "\"sheets\"",
            "summary.json: expected a list in tables, as frfit identify of this version writes it, found none",
        ),
        ("identified.csv", ",status", ",state", "identified.csv:1: expected a column status, found"),
        (
            "identified.csv",
            ",reduction_error",
            ",certificate",
            "identified.csv:1: expected a column reduction_error, as certificate is called now: run frfit identify again, found certificate",
        ),
        (
            "identified.csv",
            ",ok,",
            ",fine,",
            &format!("expected one of {statuses} in column \"status\", found \"fine\""),
        ),
        (
            "reference.csv",
            "\n20.0,",
            "\n20.5,",
            "reference.csv:2:1: expected 20.0, as in identified.csv in column \"frequency_hz\", found 20.5",
        ),
        (
            "response.csv",
            ",S1,",
            ",S9,",
            "expected \"S1\", as in summary.json in column \"sensor\", found \"S9\"",
        ),
        ("candidates.csv", "chosen", "liked", "candidates.csv:2:"),
        ("identified.csv", "\n20.0,", "\nx,", "identified.csv:2:1: expected a finite number"),
    ] {
        let mut files = results(&Made::default());
        let text = String::from_utf8(files[name].clone()).unwrap();
        assert!(text.contains(from), "{name}: {from}");
        files.insert(name, text.replacen(from, to, 1).into_bytes());
        let found = page(&files).unwrap_err();
        assert!(found.contains(expected) && found.starts_with(name), "{found}\n{expected}");
    }
}

#[test]
fn large_results_make_a_page_that_is_not_large() {
    // Ten thousand frequencies with everything a page can have; and more than any measurement has, by day less.
    for (frequencies, sensors) in
        [(of_tier(4_000, 10_000), 8), (of_tier(15_000, 60_000), 4), (1_000, of_tier(60, 120))]
    {
        let made = Made {
            frequencies,
            sensors,
            bad: frequencies / 3,
            free: true,
            std: true,
            error_map: true,
            ..Made::default()
        };
        let page = page(&results(&made)).unwrap();
        assert!(page.len() < LARGEST, "{frequencies} × {sensors}: {} bytes", page.len());
        let says_so = ["drawn with", "sensors are drawn"].iter().any(|words| text(&page).contains(words));
        assert!(says_so, "{frequencies} × {sensors}");
        // The extremes of a column are among what is drawn.
        let data = data(&page);
        let storage = data["columns"]["storage"].as_array().unwrap();
        let most =
            |values: &mut dyn Iterator<Item = &Value>| values.filter_map(Value::as_f64).fold(0.0, f64::max);
        let drawn =
            data["drawn"].as_array().unwrap().iter().map(|row| &storage[row.as_u64().unwrap() as usize]);
        assert!((most(&mut drawn.into_iter()) / made.largest() - 1.0).abs() < 1e-5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn broken_bytes_give_a_page_or_an_error(name in 0..FILES.len(), at in 0.0..1.0_f64, byte in any::<u8>(), cut in any::<bool>()) {
        let mut files = results(&Made { frequencies: 6, free: true, error_map: true, ..Made::default() });
        let bytes = files.get_mut(FILES[name]).unwrap();
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
