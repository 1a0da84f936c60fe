//! What `frfit export` writes, read back: the modulus that comes out of a deck, by the solver's own formula, is the one that went in.

use crate::outside;

use frfit::c64;
use frfit_formats::csv::{read_modulus_data, read_modulus_rows};
use frfit_workflow::Reads;
use frfit_workflow::export::{ExportOptions, Target, UnitSystem, export};
use proptest::prelude::*;
use std::path::{Path, PathBuf};
use std::process::Command;

fn options(target: Target, units: UnitSystem) -> ExportOptions {
    ExportOptions {
        target,
        units: Some(units),
        poisson: Some(0.45),
        density: Some(1100.0),
        modulus: None,
        id: 7,
        name: "CORE".into(),
        all: false,
        unknown: None,
    }
}

/// A table in a folder of its own.
fn written(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("identified.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn table(points: &[(f64, c64)]) -> String {
    let rows = points.iter().map(|(f, e)| format!("{f:?},{:?},{:?},ok\n", e.re, e.im / e.re));
    "frequency_hz,storage,loss_factor,status\n".to_owned() + &rows.collect::<String>()
}

/// A number of a card, whose exponent may have no letter.
fn number(field: &str) -> f64 {
    let field = field.trim();
    match field.get(1..).and_then(|rest| rest.rfind(['+', '-'])) {
        Some(at) if !field.contains('E') => {
            format!("{}e{}", &field[..=at], &field[at + 1..]).parse().unwrap()
        }
        _ => field.parse().unwrap(),
    }
}

/// Name and fields of each entry in large fields.
fn bulk(text: &str) -> Vec<(String, Vec<String>)> {
    let mut entries: Vec<(String, Vec<String>)> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('$')) {
        assert!(line.len() <= 72 && line.is_ascii(), "{line}");
        let line = format!("{line:<72}");
        match line[..8].trim() {
            "*" => {}
            name => entries.push((name.trim_end_matches('*').to_owned(), Vec::new())),
        }
        let fields = (0..4).map(|k| line[8 + 16 * k..24 + 16 * k].trim().to_owned());
        entries.last_mut().unwrap().1.extend(fields);
    }
    entries
}

/// x and y of a TABLED1.
fn tabled1(fields: &[String]) -> Vec<(f64, f64)> {
    let end = fields.iter().position(|field| field == "ENDT").unwrap();
    fields[8..end].chunks(2).map(|pair| (number(&pair[0]), number(&pair[1]))).collect()
}

/// Nastran's stiffness over that of MAT1: 1 + GE (TR + i TI), times E of MAT1.
fn nastran_modulus(e: f64, ge: f64, real: &[(f64, f64)], imaginary: &[(f64, f64)]) -> Vec<(f64, c64)> {
    assert_eq!(real.len(), imaginary.len());
    let point = |(&(f, tr), &(g, ti)): (&(f64, f64), &(f64, f64))| {
        assert_eq!(f, g);
        (f, e * (1.0 + ge * c64::new(tr, ti)))
    };
    real.iter().zip(imaginary).map(point).collect()
}

fn from_nastran(text: &str) -> Vec<(f64, c64)> {
    let entries = bulk(text);
    let [(mat1, mat), (first, real), (second, imaginary)] = &entries[..] else { panic!("{entries:?}") };
    assert_eq!([&mat1[..], &first[..], &second[..]], ["MAT1", "TABLED1", "TABLED1"]);
    assert_eq!([&mat[0][..], &real[0], &imaginary[0]], ["7", "7", "8"]);
    assert_eq!((number(&mat[3]), mat[2].as_str()), (0.45, ""));
    nastran_modulus(number(&mat[1]), number(&mat[7]), &tabled1(real), &tabled1(imaginary))
}

/// Abaqus's G(ω) = G∞ (1 − ω Im g* + i ω Re g*), and the same of the bulk modulus, as E.
fn from_abaqus(text: &str) -> Vec<(f64, c64)> {
    let lines = text.lines().filter(|line| !line.starts_with("**"));
    let mut keyword = "";
    let (mut long_term, mut poisson) = (f64::NAN, f64::NAN);
    let mut points = Vec::new();
    for line in lines {
        assert!(line.len() <= 256 && line.is_ascii(), "{line}");
        if line.starts_with('*') {
            keyword = line;
            continue;
        }
        assert!(line.split(", ").all(|cell| cell.len() <= 20), "{line}");
        let cells: Vec<f64> = line.split(',').map(|cell| cell.trim().parse().unwrap()).collect();
        match (keyword, &cells[..]) {
            ("*DENSITY", [_]) => {}
            ("*ELASTIC, MODULI=LONG TERM", &[e, nu]) => (long_term, poisson) = (e, nu),
            ("*VISCOELASTIC, FREQUENCY=TABULAR", &[re_g, im_g, re_k, im_k, f]) => {
                let shear = long_term / (2.0 * (1.0 + poisson)) * c64::new(1.0 - im_g, re_g);
                let bulk = long_term / (3.0 * (1.0 - 2.0 * poisson)) * c64::new(1.0 - im_k, re_k);
                points.push((f, 9.0 * bulk * shear / (3.0 * bulk + shear)));
            }
            other => panic!("{other:?}"),
        }
    }
    assert!(text.contains("\n*MATERIAL, NAME=CORE\n"));
    points
}

/// Ansys's E′ (1 + ig).
fn from_ansys(text: &str) -> Vec<(f64, c64)> {
    let mut tables: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    let mut at = f64::NAN;
    for line in text.lines().filter(|line| !line.starts_with('!')) {
        let cells: Vec<&str> = line.split(',').collect();
        match &cells[..] {
            ["MP", "DENS", "7", _] => {}
            ["TB", kind, "7", "", "", option] => tables.push((format!("{kind} {option}"), Vec::new())),
            ["TBFIELD", "FREQ", f] => at = f.parse().unwrap(),
            ["TBDATA", "1", value, rest @ ..] => {
                assert!(rest.is_empty() || *rest == ["0.45"]);
                tables.last_mut().unwrap().1.push((at, value.parse().unwrap()));
            }
            other => panic!("{other:?}"),
        }
    }
    let [(elastic, storage), (damping, loss)] = &tables[..] else { panic!("{tables:?}") };
    assert_eq!([&elastic[..], &damping[..]], ["ELASTIC ISOT", "SDAMP STRU"]);
    let point = |(&(f, e), &(g, eta)): (&(f64, f64), &(f64, f64))| {
        assert_eq!(f, g);
        (f, e * c64::new(1.0, eta))
    };
    storage.iter().zip(loss).map(point).collect()
}

const UNITS: [(UnitSystem, f64); 2] = [(UnitSystem::Si, 1.0), (UnitSystem::MillimetreTonne, 1e6)];

/// Moduli of one material within a factor of a hundred, at ascending frequencies.
fn points() -> impl Strategy<Value = Vec<(f64, c64)>> {
    let level = (3.0..12.0f64).prop_map(|exponent| 10f64.powf(exponent));
    let steps = prop::collection::vec((1e-3..50.0f64, 0.1..10.0f64, -0.01..3.0f64), 2..30);
    (level, steps).prop_map(|(level, steps)| {
        let mut f = 0.0;
        let point = |(step, times, eta): (f64, f64, f64)| {
            f += step;
            (f, level * times * c64::new(1.0, eta))
        };
        steps.into_iter().map(point).collect()
    })
}

proptest! {
    #[test]
    fn every_deck_gives_back_the_modulus(points in points()) {
        let (_folder, path) = written(&table(&points));
        // Digits of a field: Nastran's sixteen columns hold twelve of TR and TI (5e-12), whose parts are at most a hundred times the sum; an exponent of two digits takes one more.
        // Abaqus's twenty hold fourteen; Ansys has all, and η is divided out once.
        type Read = fn(&str) -> Vec<(f64, c64)>;
        let decks: [(Target, Read, f64); 3] = [
            (Target::Nastran, from_nastran, 1e-8),
            (Target::Abaqus, from_abaqus, 1e-10),
            (Target::Ansys, from_ansys, 1e-14),
        ];
        for (target, read, within) in decks {
            for (units, unit) in UNITS {
                let done = export(&path, None, &options(target, units), &mut Reads::default()).unwrap();
                let found = read(&done.text);
                prop_assert_eq!(found.len(), points.len());
                for ((f, e), (at, value)) in points.iter().zip(found) {
                    // Frequencies of twelve digits.
                    prop_assert!((at / f - 1.0).abs() < 5e-12, "{target:?}: {f} {at}");
                    let off = (unit * value - e).norm() / e.norm();
                    prop_assert!(off < within, "{target:?} {units:?}: {off:e} at {f} Hz");
                }
            }
        }
    }
}

const IDENTIFIED: &str = "frequency_hz,storage,loss_factor,status,storage_std,loss_factor_std\n\
                          100,2.5e6,0.21,ok,1e4,0.004\n125.5,2.75e6,0.25,ok,2e4,0.005\n\
                          150,9e9,0.3,ambiguous,,\n175,,,no_root,,\n200,3.5e6,0.31,ok,3e4,0.01\n";

#[test]
fn tables_are_read_by_frfit_itself() {
    let (_folder, path) = written(IDENTIFIED);
    let all = read_modulus_rows(IDENTIFIED.as_bytes()).unwrap();
    for (units, unit) in UNITS {
        let done = export(&path, None, &options(Target::Csv, units), &mut Reads::default()).unwrap();
        let again = read_modulus_data(done.text.as_bytes()).unwrap();
        let known = read_modulus_data(IDENTIFIED.as_bytes()).unwrap();
        assert_eq!((&again.frequency_hz, &again.loss_factor), (&known.frequency_hz, &known.loss_factor));
        // MPa and back is two roundings.
        let same = |a: f64, b: f64| (a / b - 1.0).abs() < 4.0 * f64::EPSILON;
        assert!(again.storage.iter().zip(&known.storage).all(|(&a, &b)| same(a, b)));
        let (again, known) = (again.std.unwrap(), known.std.unwrap());
        assert!(again.iter().zip(&known).all(|(a, b)| same(a[0], b[0]) && a[1] == b[1]));
        // Everything that has a modulus, with its status.
        let everything = ExportOptions { all: true, ..options(Target::Json, units) };
        let done = export(&path, None, &everything, &mut Reads::default()).unwrap();
        assert_eq!(done.modulus.rows, all.answered);
        assert_eq!(done.modulus.left_out, [("no_root".to_owned(), 1)]);
        let json: serde_json::Value = serde_json::from_str(&done.text).unwrap();
        assert_eq!(json["status"], serde_json::json!(["ok", "ok", "ambiguous", "ok"]));
        assert_eq!(json["units"]["storage"], units.modulus_unit());
        assert_eq!(json["storage_std"][2], serde_json::Value::Null);
        assert!(same(unit * json["loss"][0].as_f64().unwrap(), 2.5e6 * 0.21), "{}", json["loss"][0]);
    }
}

#[test]
fn only_what_is_ok_is_written_and_the_rest_is_reported() {
    let (_folder, path) = written(IDENTIFIED);
    let done = export(&path, None, &options(Target::Ansys, UnitSystem::Si), &mut Reads::default()).unwrap();
    assert_eq!(done.modulus.left_out_words().unwrap(), "1 ambiguous, 1 no_root");
    assert_eq!(from_ansys(&done.text).len(), 3);
    assert!(done.text.contains("left out: 1 ambiguous, 1 no_root"), "{}", done.text);
}

#[test]
fn relative_factors_are_multiplied_by_their_modulus() {
    let (_folder, path) = written("f,storage,eta\n10,1.1,0.2\n20,1.2,0.3\n");
    let plain = options(Target::Ansys, UnitSystem::MillimetreTonne);
    let error = export(&path, None, &plain, &mut Reads::default()).unwrap_err().to_string();
    assert!(
        error.contains("expected moduli in Pa (--modulus") && error.contains("found at most 1.2"),
        "{error}"
    );
    let scaled = ExportOptions { modulus: Some(2e9), ..plain };
    let found = from_ansys(&export(&path, None, &scaled, &mut Reads::default()).unwrap().text);
    // In MPa; one multiplication and one division.
    assert!((found[1].1 - 2.4e3 * c64::new(1.0, 0.3)).norm() < 1e-15 * 2.4e3, "{found:?}");
}

#[test]
fn a_law_answers_at_every_frequency_of_the_table() {
    let (folder, path) = written(IDENTIFIED);
    let law = folder.path().join("law.json");
    let factor = "factor = { law = \"zener\", e0 = 4e6, e_infinity = 2.9e7, tau = 1e-3, alpha = 0.7 }";
    let other = "factor = { storage = 1e6, loss_factor = 0.1 }";
    let text = serde_json::json!({"best": "zener", "laws": [
        {"law": "constant", "factor": other}, {"law": "zener", "factor": factor},
    ]});
    std::fs::write(&law, text.to_string()).unwrap();
    let done =
        export(&path, Some(&law), &options(Target::Abaqus, UnitSystem::Si), &mut Reads::default()).unwrap();
    let zener = frfit::material::Law::FractionalZener { e0: 4e6, e_infinity: 2.9e7, tau_s: 1e-3, alpha: 0.7 };
    let found = from_abaqus(&done.text);
    let at: Vec<f64> = found.iter().map(|point| point.0).collect();
    assert_eq!(at, [100.0, 125.5, 150.0, 175.0, 200.0]);
    for (f, e) in found {
        let expected = zener.at(f).unwrap();
        // As many digits as above.
        assert!((e - expected).norm() < 1e-12 * expected.norm(), "{f} Hz: {e} {expected}");
    }
    assert!(done.text.contains("law = \"zener\""));
    for (wrong, said) in [
        ("[", "EOF"),
        ("{}", "found no law that is best"),
        ("{\"best\": \"zener\", \"laws\": []}", "found no factor of the law \"zener\""),
    ] {
        std::fs::write(&law, wrong).unwrap();
        let error = export(&path, Some(&law), &options(Target::Csv, UnitSystem::Si), &mut Reads::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains("law.json: expected a law.json of frfit") && error.contains(said), "{error}");
    }
}

#[test]
fn what_cannot_be_written_is_refused() {
    let (_folder, path) = written(IDENTIFIED);
    let plain = |target| options(target, UnitSystem::Si);
    let refused = |path: &Path, options: ExportOptions| {
        export(path, None, &options, &mut Reads::default()).unwrap_err().to_string()
    };
    for (options, said) in [
        (ExportOptions { poisson: None, ..plain(Target::Nastran) }, "--poisson: expected Poisson's ratio"),
        (ExportOptions { poisson: Some(0.5), ..plain(Target::Abaqus) }, "found 0.5"),
        (
            ExportOptions { density: Some(0.0), ..plain(Target::Ansys) },
            "--density: expected a density above 0",
        ),
        (
            ExportOptions { modulus: Some(-1.0), ..plain(Target::Csv) },
            "--modulus: expected a modulus above 0",
        ),
        (ExportOptions { id: 0, ..plain(Target::Nastran) }, "--id: expected a number from 1 to 99999998"),
        (ExportOptions { id: 99_999_999, ..plain(Target::Nastran) }, "found 99999999"),
        (ExportOptions { id: 0, ..plain(Target::Ansys) }, "--id: expected a number from 1 on, found 0"),
        (ExportOptions { name: "a,b".into(), ..plain(Target::Abaqus) }, "--name: expected a word"),
    ] {
        let error = refused(&path, options);
        assert!(error.contains(said), "{error}");
    }
    for (text, target, said) in [
        ("f,storage,eta\n10,2e6,0.1\n", Target::Nastran, "expected at least two frequencies for a TABLED1"),
        (
            "f,storage,eta,status\n10,,,no_root\n",
            Target::Csv,
            "expected a row that is ok (or --all), found 1 no_root",
        ),
        (
            "f,storage,eta\n10,-2e6,0.1\n",
            Target::Csv,
            "expected finite storage moduli above 0, found -2e6 at 10 Hz",
        ),
        ("f,storage\n10,2e6\n", Target::Csv, "identified.csv:1: expected a column \"loss_factor\""),
    ] {
        let (_folder, path) = written(text);
        let error = refused(&path, plain(target));
        assert!(error.contains(said), "{error}");
    }
}

const PYNASTRAN: &str = "
import json, sys
from pyNastran.bdf.bdf import BDF
model = BDF(debug=None)
model.read_bdf(sys.argv[1], punch=True, xref=False)
mat = model.materials[7]
print(json.dumps({
    'mat': [mat.e, mat.nu, mat.rho, mat.ge], 'g': mat.g,
    'tables': {tid: {'x': list(t.x), 'y': list(t.y), 'axes': [t.xaxis, t.yaxis]} for tid, t in model.tables_d.items()},
}))
";

#[test]
#[ignore = "needs Python with pyNastran"]
fn pynastran_reads_the_deck_needs_pynastran() {
    let python = outside::python_with("pyNastran");
    let law = frfit::material::Law::FractionalZener { e0: 4e6, e_infinity: 2.9e7, tau_s: 1e-3, alpha: 0.7 };
    let points: Vec<(f64, c64)> =
        (1..=301).map(|k| 7.3 * f64::from(k)).map(|f| (f, law.at(f).unwrap())).collect();
    for (units, unit) in UNITS {
        let (folder, path) = written(&table(&points));
        let done = export(&path, None, &options(Target::Nastran, units), &mut Reads::default()).unwrap();
        let deck = folder.path().join("core.bdf");
        std::fs::write(&deck, &done.text).unwrap();
        let output = Command::new(&python).args(["-c", PYNASTRAN]).arg(&deck).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let deck: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let [e, nu, rho, ge] = [0, 1, 2, 3].map(|k| deck["mat"][k].as_f64().unwrap());
        // 1100 kg/m³ is 1.1e-9 t/mm³.
        let density = if unit == 1.0 { 1100.0 } else { 1.1e-9 };
        assert!(nu == 0.45 && (rho / density - 1.0).abs() < 1e-15, "{deck:#}");
        let column = |table: &str, name: &str| {
            let values = deck["tables"][table][name].as_array().unwrap().iter();
            values.map(|value| value.as_f64().unwrap()).collect::<Vec<f64>>()
        };
        let of = |table: &str| {
            assert_eq!(deck["tables"][table]["axes"], serde_json::json!(["LINEAR", "LINEAR"]));
            column(table, "x").into_iter().zip(column(table, "y")).collect::<Vec<_>>()
        };
        let found = nastran_modulus(e, ge, &of("7"), &of("8"));
        assert_eq!(found.len(), points.len());
        for ((f, expected), (at, value)) in points.iter().zip(found) {
            // Twelve digits, of numbers that are near the median.
            let off = (unit * value - expected).norm() / expected.norm();
            assert!((at / f - 1.0).abs() < 5e-12 && off < 1e-10, "{f} Hz: {at} {off:e}");
        }
    }
}
