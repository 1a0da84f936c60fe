//! The exponential window of an impact test, planted in mobility and accelerance; and the Hann window of a random force.

use super::planted::{DIM, TRUTH, folder, receptance, refusal, run, springs, table, worst};
use frfit::c64;
use frfit::frequency::linear_hz;
use frfit::identify::{Line, Status};
use frfit::material::Law;
use frfit::model::{DynamicStiffness, Experiment, Role, Sensor, Term};
use frfit::response::{FullModel, Response};
use frfit_linalg::sparse::Triplets;
use frfit_workflow::job::{IdentifyJob, respond_case};
use frfit_workflow::load::{Choice, Overrides, Purpose, WindowSource, load, load_frf};
use frfit_workflow::modes::{ModesOptions, modes_case};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fs;
use tempfile::TempDir;

const DECAY: f64 = 6.0;

/// Viscous damping of the fourth row (from 1), N s/m.
const DAMPING: f64 = 4.0;

/// The modulus whose value at iω is [`TRUTH`], at s: a power law, whose loss factor is the same at all frequencies.
fn truth_at(s: c64) -> c64 {
    TRUTH * (s / c64::new(0.0, s.im)).powf(TRUTH.arg() / FRAC_PI_2)
}

/// Mobility of row 6 and accelerance of row 8 (from 1) behind the window: K + s C + s² M with s = α + iω, all three as stiffnesses of a model at one frequency.
fn measured(frequency_hz: &[f64]) -> [Vec<c64>; 2] {
    let (mut mass, mut damper) = (Triplets::new(DIM), Triplets::new(DIM));
    (0..DIM).for_each(|i| mass.add(i, i, 1.0));
    damper.add(3, 3, DAMPING);
    let matrices = [springs(), damper, mass].map(|triplets| triplets.assemble());
    let at = |f: f64| {
        let s = c64::new(DECAY, TAU * f);
        let terms = matrices.iter().zip([("k", truth_at(s)), ("c", s), ("m", s * s)]);
        let terms = terms.map(|(matrix, (name, factor))| Term {
            name: name.into(),
            role: Role::Stiffness,
            matrix: matrix.clone(),
            factor: Law::Constant(factor),
        });
        let model = DynamicStiffness::new(terms.collect()).unwrap();
        let sensor = |row: usize| Sensor { row, sign: 1.0 };
        let experiment = Experiment::driven_at(DIM, sensor(0), vec![sensor(5), sensor(7)]);
        let system = FullModel::new(model.at(f, &[]).unwrap(), &experiment).unwrap();
        let x = system.respond_nominal().unwrap();
        [s * x[0], s * s * x[1]]
    };
    let all: Vec<[c64; 2]> = frequency_hz.iter().map(|&f| at(f)).collect();
    [0, 1].map(|m| all.iter().map(|values| values[m]).collect())
}

const SPRINGS: &str = "[identify]\nmatrix = \"springs\"\nband_hz = [10.0, 120.0]\n\
                       bounds = { storage = [1e4, 1e7], loss_factor = [0.0, 1.0] }\n";

fn keys(first: &str, second: &str, identify: &str) -> String {
    format!(
        "[[attached]]\ndof = \"2+Z\"\ndamping = {DAMPING}\n\
         [[measurement]]\nfile = \"0.csv\"\nrow = 6\nquantity = \"mobility\"\n{first}\n\
         [[measurement]]\nfile = \"1.csv\"\nrow = 8\nquantity = \"accelerance\"\n{second}\n{identify}"
    )
}

fn tables(head: &str) -> [String; 2] {
    let frequency_hz = linear_hz(10.0, 120.0, 56);
    measured(&frequency_hz).map(|values| format!("{head}{}", table(&frequency_hz, &values, None)))
}

const SAID: &str = "decay_per_s = 6.0";

#[test]
fn the_window_is_part_of_the_model_by_key_or_by_file() {
    let by_key = run(&folder(&tables(""), &keys(SAID, SAID, SPRINGS))).unwrap();
    // Exact data, and answers that are asked to 1e-6.
    assert!(worst(&by_key).0 < 1e-6 && worst(&by_key).1 == 56, "{:?}", worst(&by_key));
    assert_eq!(by_key.summary["decay_per_s"], DECAY);
    let by_file = run(&folder(&tables("# decay_per_s = 6\n"), &keys("", SAID, SPRINGS))).unwrap();
    assert_eq!(worst(&by_file), worst(&by_key));
    let without = run(&folder(&tables(""), &keys("", "", SPRINGS))).unwrap();
    assert!(worst(&without).0 > 0.02, "{:?}", worst(&without));
    // Responses are given in the measured quantities, as measured.
    let folder = folder(&tables(""), &keys(SAID, SAID, SPRINGS));
    run(&folder).unwrap();
    let response = fs::read_to_string(folder.path().join("out/response.csv")).unwrap();
    let row: Vec<&str> = response.lines().nth(2).unwrap().split(',').collect();
    let value = c64::new(row[5].parse().unwrap(), row[6].parse().unwrap());
    let exact = measured(&[10.0])[1][0];
    assert!(row[2] == "accelerance" && (value - exact).norm() < 1e-12 * exact.norm(), "{row:?} {exact}");
}

#[test]
fn several_unknowns_have_the_window_too() {
    let identify = "[[identify]]\nmatrix = \"springs\"\nvaries = \"constant\"\nbounds = { storage = [1e5, 5e5], loss_factor = [0.0, 0.5] }\n\
                    [[identify]]\nmatrix = \"mass\"\nvaries = \"constant\"\nreal = true\nbounds = [0.7, 1.4]\n";
    let identify = identify.replacen("varies", "band_hz = [10.0, 120.0]\nvaries", 1);
    let job = run(&folder(&tables(""), &keys(SAID, SAID, &identify))).unwrap();
    let constants = &job.run.found.constants;
    let [springs, mass] = [0, 1].map(|j| constants[j].law.at(50.0).unwrap());
    assert!(
        (springs - TRUTH).norm() < 1e-5 * TRUTH.norm() && (mass.re - 1.0).abs() < 1e-5,
        "{springs} {mass}"
    );
}

#[test]
fn who_contradicts_whom_is_said() {
    for (head, keys_of, message) in [
        (
            "# decay_per_s = 6\n",
            ["decay_per_s = 5.0", ""],
            "decay_per_s: expected 6, as 0.csv says, or no such key, found 5",
        ),
        (
            "",
            [SAID, ""],
            "measurement.decay_per_s: expected the decay_per_s of all measurements, 6 as of the first, found 0",
        ),
        (
            "# decay_per_s = six\n",
            ["", ""],
            "0.csv:1: expected decay_per_s = a number of 1/s from 0 on, found decay_per_s = six",
        ),
    ] {
        let found = refusal(&folder(&tables(head), &keys(keys_of[0], keys_of[1], SPRINGS)));
        assert!(found.contains(message), "{found}");
    }
}

/// The modes of the model are those of the structure, whatever window the measurements have.
#[test]
fn natural_modes_have_no_window() {
    let poles = |said: &str| -> Vec<c64> {
        let folder = folder(&tables(""), &keys(said, said, SPRINGS));
        let case = folder.path().join("case.toml");
        let job = modes_case(&case, &Overrides::default(), &ModesOptions::default(), None).unwrap();
        job.run.model.modes.iter().map(|mode| mode.pole_per_s).collect()
    };
    let (behind, without) = (poles(SAID), poles(""));
    assert!(!behind.is_empty() && behind.len() == without.len());
    for (a, b) in behind.iter().zip(&without) {
        assert!((a - b).norm() < 1e-11 * b.norm(), "{a} {b}");
    }
}

/// A response behind a window says so in its file.
#[test]
fn a_response_of_a_windowed_case_is_what_would_be_measured() {
    let respond = "[respond]\nband_hz = [10.0, 120.0]\npoints = 56\n";
    let folder = folder(&tables(""), &keys(SAID, SAID, respond));
    let case = folder.path().join("case.toml");
    let text = fs::read_to_string(&case).unwrap();
    let exact = format!("factor = {{ storage = {}, loss_factor = {} }}", TRUTH.re, TRUTH.im / TRUTH.re);
    fs::write(&case, text.replace("factor = { storage = 2e5, loss_factor = 0.02 }", &exact)).unwrap();
    assert_eq!(load(&case, &Overrides::default(), Purpose::Respond).unwrap().model.decay_per_s(), DECAY);
    let out = folder.path().join("out");
    respond_case(&case, &Overrides::default(), None, Some(&out), &|_, _| {}).unwrap();
    let measured = measured(&linear_hz(10.0, 120.0, 56));
    for (m, values) in measured.iter().enumerate() {
        let choice = Choice { record: Some(m as i64 + 1), ..Choice::default() };
        let frf = load_frf(&out.join("frf.uff"), &choice).unwrap();
        assert_eq!(frf.decay_per_s, Some(DECAY));
        for (there, value) in frf.response.iter().zip(values) {
            assert!((there - value).norm() < 1e-10 * value.norm());
        }
    }
}

const HANN_RECORD_S: f64 = 2.0;

/// Receptances of rows 6 and 8 (from 1) as H1 of a random force shows them through a Hann window: their mean over frequencies with |W|² as the weight.
fn through_a_hann_window(frequency_hz: &[f64]) -> [Vec<c64>; 2] {
    let offsets: Vec<f64> = (-48..=48).map(|k| (f64::from(k) + 0.5) / 12.0).collect();
    let weight = |x: f64| ((PI * x).sin() / (PI * x * (1.0 - x * x))).powi(2);
    let sum: f64 = offsets.iter().map(|&x| weight(x)).sum();
    let mean = |f: &f64| {
        let shifted: Vec<f64> = offsets.iter().map(|x| f + x / HANN_RECORD_S).collect();
        let all = receptance(&[], &[5, 7], &shifted);
        [0, 1].map(|m| offsets.iter().zip(&all).map(|(x, row)| weight(*x) / sum * row[m]).sum::<c64>())
    };
    let all: Vec<[c64; 2]> = frequency_hz.iter().map(mean).collect();
    [0, 1].map(|m| all.iter().map(|values| values[m]).collect())
}

fn hann_folder(frequency_hz: &[f64], said: [&str; 2]) -> TempDir {
    let tables = through_a_hann_window(frequency_hz).map(|values| table(frequency_hz, &values, Some(0.003)));
    let one = |m: usize| {
        format!(
            "[[measurement]]\nfile = \"{m}.csv\"\nrow = {}\nquantity = \"receptance\"\n{}\n",
            6 + 2 * m,
            said[m]
        )
    };
    folder(&tables, &format!("{}{}{SPRINGS}", one(0), one(1)))
}

/// Whether a Hann window is said or shown by the data, its leakage is removed: two lines between half-power points at the lowest mode, where the loss factor would
/// be half as large again.
#[test]
fn the_leakage_of_a_hann_window_is_removed() {
    let frequency_hz: Vec<f64> = (20..250).map(|k| f64::from(k) / HANN_RECORD_S).collect();
    let farthest = |job: &IdentifyJob| {
        let off = |line: &Line| {
            let value = &line.values[0];
            let std = value.uncertainty.as_ref().unwrap().loss_factor_std;
            (line.status == Status::Ok)
                .then(|| (value.loss_factor().unwrap() - TRUTH.im / TRUTH.re).abs() / std.unwrap())
        };
        job.run.found.lines.iter().filter_map(off).fold(0.0, f64::max)
    };
    let shown = run(&hann_folder(&frequency_hz, ["", ""])).unwrap();
    let window = shown.case.corrections().unwrap().hann.as_ref().unwrap();
    assert!(
        window.source == WindowSource::Shown && window.nats > 100.0 && window.largest > 0.2,
        "{window:?}"
    );
    assert_eq!((window.record_s, shown.summary["window"]["kind"].as_str()), (HANN_RECORD_S, Some("hann")));
    assert!(shown.run.count(Status::Ok) > 150 && farthest(&shown) < 3.0, "{}", farthest(&shown));
    let said = run(&hann_folder(&frequency_hz, ["window = \"hann\""; 2])).unwrap();
    assert_eq!(said.run.found.lines, shown.run.found.lines);
    let none = run(&hann_folder(&frequency_hz, ["window = \"none\""; 2])).unwrap();
    assert!(none.case.corrections().unwrap().hann.is_none());
    assert!(farthest(&none) > 4.0, "{}", farthest(&none));
}

#[test]
fn a_window_that_cannot_be_is_refused() {
    // Lines that are no multiples of their spacing.
    let frequency_hz = linear_hz(10.3, 60.0, 90);
    let hann = "window = \"hann\"";
    for (said, message) in [
        (
            ["window = \"hamming\"", ""],
            "measurement.window: expected \"hann\" or \"none\" (an exponential window is decay_per_s), found \"hamming\"",
        ),
        (
            [hann, ""],
            "measurement.window: expected the window of all measurements to be the same, found another one",
        ),
        (
            [hann, hann],
            "measurement.window: expected record_s, because the frequencies are no whole multiples of their spacing, found none",
        ),
        (["record_s = 0.0", ""], "measurement.record_s: expected a number of seconds above 0, found 0.0"),
        (
            ["window = \"hann\"\ndecay_per_s = 6.0", "window = \"hann\"\ndecay_per_s = 6.0"],
            "measurement.window: expected one of window = \"hann\" and decay_per_s, found both",
        ),
    ] {
        let found = refusal(&hann_folder(&frequency_hz, said));
        assert!(found.contains(message), "{found}");
    }
}
