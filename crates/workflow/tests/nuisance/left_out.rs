//! Lines and bands that are left out.

use super::planted::{folder, receptance, refusal, run, table, worst};
use frfit::frequency::linear_hz;
use frfit::identify::Status;
use std::fs;

const KEYS: &str = "[[measurement]]\nfile = \"0.csv\"\nrow = 6\nquantity = \"receptance\"\n\
                    [[measurement]]\nfile = \"1.csv\"\nrow = 8\nquantity = \"receptance\"\n\
                    [identify]\nmatrix = \"springs\"\nband_hz = [20.0, 110.0]\n\
                    bounds = { storage = [1e4, 1e7], loss_factor = [0.0, 1.0] }\n";

/// Two sensors, with mains hum at 50 Hz and about, and between two lines at 100.5 Hz.
fn hum() -> [String; 2] {
    let frequency_hz = linear_hz(10.0, 120.0, 111);
    let exact = receptance(&[], &[5, 7], &frequency_hz);
    [0, 1].map(|m| {
        let values = frequency_hz.iter().zip(&exact).map(|(&f, x)| match f {
            49.0..=51.0 => 3.0 * x[m],
            100.0..=101.0 => x[m] * frfit::c64::new(0.0, 1.0),
            _ => x[m],
        });
        table(&frequency_hz, &values.collect::<Vec<_>>(), None)
    })
}

#[test]
fn hum_is_left_out_and_its_rows_are_marked() {
    for law in ["", "varies = \"law\"\nlaw = \"constant\"\n"] {
        let keys = format!("{KEYS}exclude_hz = [[49.0, 51.0], 100.5]\n{law}");
        let folder = folder(&hum(), &keys);
        let job = run(&folder).unwrap();
        assert_eq!(job.run.found.lines.len(), 91);
        let out: Vec<f64> = (job.run.found.lines.iter())
            .filter(|o| o.status == Status::OutOfBand)
            .map(|o| o.frequency_hz)
            .collect();
        assert_eq!(out, [49.0, 50.0, 51.0, 100.0, 101.0]);
        // All others have the truth: exact data, and answers that are asked to 1e-6.
        assert_eq!(worst(&job).1, 86);
        assert!(worst(&job).0 < 1e-6, "{:?}", worst(&job));
        assert_eq!(
            (&job.summary["status"]["out_of_band"], &job.summary["identify"]["left_out"]),
            (&5.into(), &5.into())
        );
        assert_eq!(job.summary["bands_hz"]["out_of_band"], serde_json::json!([[49.0, 51.0], [100.0, 101.0]]));
        let identified = fs::read_to_string(folder.path().join("out/identified.csv")).unwrap();
        let rows: Vec<&str> = identified.lines().filter(|line| line.contains("out_of_band")).collect();
        assert_eq!(rows.len(), 5);
        assert!(rows.iter().all(|row| row.ends_with(",,,,,,,,,0,0,out_of_band,,,,,,,,,,")), "{rows:?}");
        // What was measured there is given all the same.
        let response = fs::read_to_string(folder.path().join("out/response.csv")).unwrap();
        assert_eq!(
            response.lines().filter(|line| line.ends_with(",,") && !line.contains(",,,,,")).count(),
            10
        );
    }
}

#[test]
fn hum_that_is_left_in_has_no_answer_or_a_wrong_one() {
    let job = run(&folder(&hum(), KEYS)).unwrap();
    assert_eq!((job.run.count(Status::OutOfBand), job.run.count(Status::Ok)), (0, 86));
    let law = run(&folder(&hum(), &format!("{KEYS}varies = \"law\"\nlaw = \"constant\"\n"))).unwrap();
    assert!(law.run.count(Status::Ok) < 91 || worst(&law).0 > 1e-6, "{:?}", worst(&law));
}

#[test]
fn what_cannot_be_left_out_is_refused() {
    let listed = "a list of frequencies and bands [low, high] in Hz, as [100.0, [49.0, 51.0]]";
    for (value, message) in [
        ("50.0", format!("expected {listed}, found 50.0")),
        ("[-1]", "expected a frequency in Hz that is not negative, found -1".into()),
        ("[\"50\"]", "expected a frequency or a band [low, high] in Hz, found the text \"50\"".into()),
        (
            "[[51, 49]]",
            "expected two frequencies [low, high] in Hz with 0 <= low <= high, found [51, 49]".into(),
        ),
        ("[[1, 2, 3]]", "expected two finite numbers [low, high], found the list [1, 2, 3]".into()),
        ("[[0, 1e4]]", "expected a frequency of the band that is not left out, found none".into()),
    ] {
        let folder = folder(&hum(), &format!("{KEYS}exclude_hz = {value}\n"));
        let said = refusal(&folder);
        assert!(said.starts_with("case.toml:") && said.contains("identify.exclude_hz"), "{said}");
        assert!(said.ends_with(&message), "{said}");
    }
}
